"""Scenes as programs in C: packed scenes, and folders with their sources."""
