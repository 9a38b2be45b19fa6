"""Animations as files for ParaView: a .vtu file for each frame, and a .pvd file that names them with their times."""

from __future__ import annotations

import os
from functools import partial
from pathlib import Path
from typing import Any
from xml.sax.saxutils import quoteattr

import numpy as np

from ..base.written_files import write_text, write_whole
from ..errors import FunicularError
from .animation import Animation, Clip
from .extras import extra
from .files import PICTURES, folder_for_pictures
from .placed import placed_surface


def write_vtk(animation: Animation, folder: str | os.PathLike) -> Path:
    """Write the frames into a folder and return the path of its .pvd file; see `Viewable.save_vtk`.

    Each clip, such as a mode or one of two runs, is a part of the collection. Points have the quantities along cables,
    NaN where there is none, the direction and the diameter of the section, and the number of the cable or body that
    they are of, cables first. Raises ResultFileError; FunicularError.
    """
    meshio = extra("meshio", "vtk")
    folder = folder_for_pictures(folder)
    named = folder / f"{folder.name or 'frames'}.pvd"
    lines = ['<?xml version="1.0"?>', '<VTKFile type="Collection" version="0.1">', "<Collection>"]
    for part, clip in enumerate(animation.clips):
        digits = len(str(len(clip.time) - 1))
        for frame, time in enumerate(clip.time):
            file = f"part{part}_frame{frame:0{digits}}.vtu"
            points, cells, data = frame_arrays(clip, frame)
            mesh = meshio.Mesh(points, cells, point_data=data)
            write_whole(folder / file, partial(meshio.write, mesh=mesh), PICTURES)
            lines.append(f'<DataSet timestep="{float(time)!r}" group="" part="{part}" file={quoteattr(file)}/>')
    return write_text(named, "\n".join([*lines, "</Collection>", "</VTKFile>", ""]), PICTURES)


def frame_arrays(clip: Clip, frame: int) -> tuple[np.ndarray, list[tuple[str, np.ndarray]], dict[str, np.ndarray]]:
    """Return the points (N, 3), cells by kind, and data of points of one frame."""
    points: list[np.ndarray] = []
    lines: list[np.ndarray] = []
    triangles: list[np.ndarray] = []
    part: list[np.ndarray] = []
    first = 0
    for number, cable in enumerate(clip.cables):
        points.append(cable.position[frame])
        here = first + np.arange(len(cable.s))
        lines.append(np.stack([here[:-1], here[1:]], axis=1))
        part.append(np.full(len(cable.s), number))
        first += len(cable.s)
    for number, body in enumerate(clip.bodies, start=len(clip.cables)):
        vertices, faces = placed_surface(body, frame)
        points.append(vertices)
        triangles.append(first + faces)
        part.append(np.full(len(vertices), number))
        first += len(vertices)
    if not points:
        raise FunicularError("there are no cables and no bodies to write for ParaView")
    cells = [(kind, np.concatenate(each)) for kind, each in (("line", lines), ("triangle", triangles)) if each]
    return np.concatenate(points), cells, {"part": np.concatenate(part), **_point_data(clip, frame, first)}


def _point_data(clip: Clip, frame: int, count: int) -> dict[str, np.ndarray]:
    """Return what the stations of cables have, NaN at the points of bodies and where a cable lacks a quantity."""
    found: dict[str, np.ndarray] = {}

    def put(key: str, first: int, values: np.ndarray) -> None:
        array = found.setdefault(key, np.full((count, *values.shape[1:]), np.nan))
        array[first : first + len(values)] = values

    first = 0
    for cable in clip.cables:
        put("s", first, cable.s)
        put("diameter", first, np.full(len(cable.s), _diameter(cable.section)))
        if cable.section_y is not None:
            put("section_y", first, cable.section_y[frame])
        for quantity in cable.quantities:
            put(quantity.key, first, quantity.values[frame])
        first += len(cable.s)
    return found


def _diameter(section: Any) -> float:
    """Return the diameter of the circle that stands for a section in tubes, in m."""
    match section["shape"]:
        case "rectangle":
            return float(np.sqrt(section["height"] * section["width"] * 4 / np.pi))
        case "unknown":
            return float(section["size"])
    return float(section["diameter"])
