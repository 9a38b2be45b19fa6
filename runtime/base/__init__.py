"""What all other packages stand on: files, interruptions, rotations, the operating system."""
