"""Sweeps: a scene, or a function that makes scenes, over many values of its parameters."""
