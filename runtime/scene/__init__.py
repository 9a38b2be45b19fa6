"""A scene: what a user describes, reads from a file, and runs."""
