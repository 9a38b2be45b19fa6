"""The lowest layer of the package: files, interruptions, rotations, the operating system."""
