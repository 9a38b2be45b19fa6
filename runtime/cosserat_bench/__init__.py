"""The package as a solver of cosseratbench, a benchmark of rods by others (PyPI): `solver` is its entry point."""
