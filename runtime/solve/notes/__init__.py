"""Notes on results: what a run or a state of rest is worth, and why."""
