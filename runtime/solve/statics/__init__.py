"""States of rest: the static problem, its paths, stability, and starts of the search."""
