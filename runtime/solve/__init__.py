"""Runs, equilibria and modes of a model."""
