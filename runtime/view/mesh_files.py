"""Surfaces from STL and glTF files, by trimesh."""

from __future__ import annotations

import io
import json
import os
from pathlib import Path
from typing import Any

import numpy as np

from ..base.bounded_files import MAX_MESH_BYTES, TooLargeError, check_numbers, read_bytes
from ..errors import FunicularError, shown_path
from .files import extra

COARSER = "take a coarser mesh"
"""The remedy for a mesh that is too large."""
COMPONENTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}
"""Numbers per element of a glTF array, by type."""


def read_mesh(path: str | os.PathLike[str]) -> tuple[np.ndarray, np.ndarray]:
    """Return the vertices (V, 3) and triangles (F, 3) of all surfaces in a file, in its units and axes.

    Raises FunicularError for a file that is missing, too large or without a surface, and without trimesh.
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
    except Exception as error:  # readers raise any error for damaged files
        raise FunicularError(f"{where}: cannot be read as a mesh: {error}") from error
    if not len(triangles) or not np.isfinite(vertices).all():
        raise FunicularError(f"{where}: has no surface, or one that is not finite")
    return vertices, triangles


def _surfaces(trimesh: Any, path: Path) -> Any:
    """Return all surfaces in a file as one mesh of trimesh. Raises TooLargeError, and any error for a damaged file."""
    kind, data = path.suffix.lower().removeprefix("."), read_bytes(path, MAX_MESH_BYTES, COARSER)
    if kind == "stl":
        return trimesh.load_scene(io.BytesIO(data), file_type=kind).to_mesh()
    check_numbers(_sizes_in_gltf(data), "surfaces")
    scene = trimesh.load_scene(io.BytesIO(data), file_type=kind, resolver=_Beside(path, MAX_MESH_BYTES - len(data)),
                               skip_materials=True)
    shown = [scene.graph[node][1] for node in scene.graph.nodes_geometry]  # a surface may occur several times
    check_numbers(((name, 9 * len(getattr(scene.geometry[name], "faces", ()))) for name in shown), "surfaces")
    return scene.to_mesh()


def _sizes_in_gltf(data: bytes) -> list[tuple[str, int]]:
    """Return the sizes of the arrays of a glTF file and of its surfaces. Raises any error for a damaged file."""
    if data.startswith(b"glTF"):  # 12 bytes of header, length and type of the first chunk, this chunk
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
    """Reader of the files that a glTF file names, in its folder or below, within a total size in bytes."""

    def __init__(self, path: Path, max_bytes: int):
        self._folder, self._remaining = Path(os.path.realpath(path)).parent, max_bytes

    def get(self, name: str) -> bytes:
        """Return the bytes of a file. Raises ValueError, TooLargeError and OSError."""
        path = Path(os.path.realpath(self._folder / name))
        if not path.is_relative_to(self._folder) or not path.is_file():
            raise ValueError(f'it names "{shown_path(name)}", which is no file in its folder or below')
        data = read_bytes(path, self._remaining, COARSER)
        self._remaining -= len(data)
        return data

    __getitem__ = get
