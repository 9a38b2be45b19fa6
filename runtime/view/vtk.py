"""Animations as files for ParaView: a .vtu file per frame, and a .pvd file with their times."""

from __future__ import annotations

import os
from functools import partial
from pathlib import Path
from xml.sax.saxutils import quoteattr

import numpy as np

from ..base.written_files import write_text, write_whole
from ..errors import FunicularError
from .animation import Animation, Clip, at_frame, section_sides
from .files import PICTURES, extra, folder_for_pictures
from .surfaces import placed_surface


def write_vtk(animation: Animation, folder: str | os.PathLike[str]) -> Path:
    """Write the frames into a folder and return the path of its .pvd file; see `Viewable.save_vtk`.

    Each clip, such as a mode or one of two runs, is a part of the collection. Point data are the quantities along
    cables, NaN elsewhere, direction and diameter of the section, and the number of the cable or body, cables first.
    Raises ResultFileError; FunicularError.
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
    meshes = [(cable.position[frame], np.arange(len(cable.s) - 1)[:, None] + [0, 1]) for cable in clip.cables]
    meshes += [placed_surface(body, frame, float(clip.time[frame])) for body in clip.bodies]
    if not meshes:
        raise FunicularError("there are no cables and no bodies to write for ParaView")
    sizes = [len(points) for points, _ in meshes]
    cells = [cell + first for (_, cell), first in zip(meshes, np.cumsum([0, *sizes[:-1]]), strict=True)]
    n = len(clip.cables)
    return (np.concatenate([points for points, _ in meshes]),
            [(kind, np.concatenate(each)) for kind, each in (("line", cells[:n]), ("triangle", cells[n:])) if each],
            {"part": np.repeat(np.arange(len(sizes)), sizes), **_point_data(clip, frame, sum(sizes))})


def _point_data(clip: Clip, frame: int, count: int) -> dict[str, np.ndarray]:
    """Return the data of the stations of cables, NaN at points of bodies and where a cable lacks a quantity."""
    found: dict[str, np.ndarray] = {}

    def put(key: str, first: int, values: np.ndarray) -> None:
        array = found.setdefault(key, np.full((count, *values.shape[1:]), np.nan))
        array[first : first + len(values)] = values

    first = 0
    for cable in clip.cables:
        put("s", first, cable.s if cable.material_s is None else at_frame(cable.material_s, frame))
        height, width = section_sides(cable.section)
        of_area = np.sqrt(height * width * 4 / np.pi)
        put("diameter", first, np.full(len(cable.s), of_area if cable.section["shape"] == "rectangle" else height))
        if cable.section_y is not None:
            put("section_y", first, cable.section_y[frame])
        for quantity in cable.quantities:
            put(quantity.key, first, quantity.values[frame])
        first += len(cable.s)
    return found
