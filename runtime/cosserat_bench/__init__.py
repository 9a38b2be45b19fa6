"""The solver of cosseratbench, a benchmark of rods (PyPI); the extra of that name installs it by an entry point."""
