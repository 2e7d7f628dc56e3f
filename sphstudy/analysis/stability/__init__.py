"""What a sound run keeps, and which runs keep it: bounds, indicators, judgement, the map of a study."""
