"""The model of a scene: what can be left out of it, and what a tolerance needs."""
