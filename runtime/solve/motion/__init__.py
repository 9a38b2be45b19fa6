"""Runs through time."""
