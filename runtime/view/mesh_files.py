"""Surfaces in files, STL and glTF, by trimesh."""

from __future__ import annotations

import os

import numpy as np

from ..errors import FunicularError, shown_path
from .extras import extra


def read_mesh(path: str | os.PathLike) -> tuple[np.ndarray, np.ndarray]:
    """Return the vertices (V, 3) and triangles (F, 3) of all surfaces in a file, in its units and axes.

    Raises FunicularError where there is no such file, no surface in it, or no trimesh.
    """
    where = shown_path(path)
    if not os.path.isfile(path):
        raise FunicularError(f"{where}: there is no such file")
    trimesh = extra("trimesh", "meshes")
    try:
        mesh = trimesh.load_scene(os.fspath(path)).to_mesh()
        vertices, triangles = np.asarray(mesh.vertices, dtype=float), np.asarray(mesh.faces, dtype=int)
    except Exception as error:  # its readers raise what the damage leads them to
        raise FunicularError(f"{where}: cannot be read as a mesh: {error}") from error
    if not len(triangles) or not np.isfinite(vertices).all():
        raise FunicularError(f"{where}: has no surface, or one that is not finite")
    return vertices, triangles
