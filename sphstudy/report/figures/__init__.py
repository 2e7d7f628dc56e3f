"""The figures, by subject: each a function from results to a matplotlib figure."""
