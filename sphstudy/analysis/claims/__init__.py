"""Claims about results, each a rule that computes a verdict from stored data."""
