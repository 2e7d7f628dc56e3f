"""What came out: datasets, comparison, extrapolation, work against precision. Reads only."""
