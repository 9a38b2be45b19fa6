"""Scenes: described, read from files, run."""
