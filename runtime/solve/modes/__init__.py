"""Small vibrations about a state."""
