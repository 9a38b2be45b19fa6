"""Surfaces in files, STL and glTF, by trimesh."""

from __future__ import annotations

import io
import json
import os
from pathlib import Path
from typing import Any

import numpy as np

from ..base.bounded_files import MAX_MESH_BYTES, TooLargeError, check_numbers, read_bytes
from ..errors import FunicularError, shown_path
from .extras import extra

COARSER = "take a coarser mesh"
"""What to do with a mesh that is too large."""
COMPONENTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}
"""Numbers of an element of an array of glTF, by its type."""


def read_mesh(path: str | os.PathLike) -> tuple[np.ndarray, np.ndarray]:
    """Return the vertices (V, 3) and triangles (F, 3) of all surfaces in a file, in its units and axes.

    Raises FunicularError where there is no such file, no surface in it, more than is read, or no trimesh.
    """
    where = shown_path(path)
    if not os.path.isfile(path):
        raise FunicularError(f"{where}: there is no such file")
    trimesh = extra("trimesh", "meshes")
    try:
        mesh = _surfaces(trimesh, Path(path))
        vertices, triangles = np.asarray(mesh.vertices, dtype=float), np.asarray(mesh.faces, dtype=int)
    except TooLargeError as error:
        raise FunicularError(f"{where}: {error.args[0]}; {COARSER}") from None
    except Exception as error:  # its readers raise what the damage leads them to
        raise FunicularError(f"{where}: cannot be read as a mesh: {error}") from error
    if not len(triangles) or not np.isfinite(vertices).all():
        raise FunicularError(f"{where}: has no surface, or one that is not finite")
    return vertices, triangles


def _surfaces(trimesh: Any, path: Path) -> Any:
    """Return all surfaces in a file as one mesh of trimesh. Raises TooLargeError, and what damage leads to."""
    kind, data = path.suffix.lower().removeprefix("."), read_bytes(path, MAX_MESH_BYTES, COARSER)
    if kind == "stl":
        return trimesh.load_scene(io.BytesIO(data), file_type=kind).to_mesh()
    check_numbers(_sizes_in_gltf(data), "surfaces")
    scene = trimesh.load_scene(io.BytesIO(data), file_type=kind, resolver=_Beside(path, MAX_MESH_BYTES - len(data)),
                               skip_materials=True)
    shown = [scene.graph[node][1] for node in scene.graph.nodes_geometry]  # one may be there many times
    check_numbers(((name, 9 * len(getattr(scene.geometry[name], "faces", ()))) for name in shown), "surfaces")
    return scene.to_mesh()


def _sizes_in_gltf(data: bytes) -> list[tuple[str, int]]:
    """Return the numbers in each array of a glTF file and in each surface, which may share arrays. Raises what damage
    leads to.
    """
    if data.startswith(b"glTF"):  # a head of 12 bytes, the length and kind of the first part, and that part
        data = data[20 : 20 + int.from_bytes(data[12:16], "little")]
    content = json.loads(data)
    arrays = [int(each["count"]) * COMPONENTS[each["type"]] for each in content.get("accessors", ())]
    sizes = [(f"array {k}", size) for k, size in enumerate(arrays)]
    for mesh in content.get("meshes", ()):
        for part in mesh["primitives"]:
            used = [*part["attributes"].values(), *([part["indices"]] if "indices" in part else [])]
            sizes.append((f'mesh "{shown_path(str(mesh.get("name", "")))}"', sum(arrays[k] for k in used)))
    if min((size for _, size in sizes), default=0) < 0:
        raise ValueError("an array has a negative length")
    return sizes


class _Beside:
    """The files that a glTF file names, in its folder or below, of so many bytes together."""

    def __init__(self, path: Path, left: int):
        self._folder, self._left = Path(os.path.realpath(path)).parent, left

    def get(self, name: str) -> bytes:
        """Return the bytes of a file. Raises ValueError, TooLargeError and OSError."""
        path = Path(os.path.realpath(self._folder / name))
        if not path.is_relative_to(self._folder) or not path.is_file():
            raise ValueError(f'it names "{shown_path(name)}", which is no file in its folder or below')
        data = read_bytes(path, self._left, COARSER)
        self._left -= len(data)
        return data

    __getitem__ = get
