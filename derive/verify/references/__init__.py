"""Independent definitions, at 50 digits."""
