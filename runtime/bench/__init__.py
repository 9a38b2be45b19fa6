"""The benchmark of a scene: accuracy and time."""
