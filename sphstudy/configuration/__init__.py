"""From words to valid points: composition, overrides, run settings, study files."""
