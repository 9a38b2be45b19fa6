"""Readers of the input files of other programs."""
