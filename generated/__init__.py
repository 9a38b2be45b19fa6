"""Generated kernels: C, a Python face in `kernels`, and manifest.json. Written by `funicular derive`."""
