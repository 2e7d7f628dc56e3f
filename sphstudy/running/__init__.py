"""Getting runs done: plan, launch, workers, one run, progress."""
