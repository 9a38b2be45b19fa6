"""Notes on the errors of runs and states of rest: quantity, limit, cause and remedy."""
