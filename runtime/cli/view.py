"""`funicular view`: runs and scenes from their files as pages, pictures and films."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from ..errors import FunicularError
from ..results.animation.clips import overlaid
from ..results.viewable import Viewable
from ..scene.file import load_run, load_scene
from ..view.files import save_figure
from ..view.page import write_page
from ..view.plot import shape_figure
from ..view.showing import show_in_browser
from ..view.video import write_video
from ..view.vtk import write_vtk

LOAD_STEPS = 10
"""Default steps of a load path."""


@dataclass(frozen=True)
class Wanted:
    """The wanted states of a scene: as drawn, at rest, relaxed, along its load path, or modes.

    as_drawn: modes also about a drawn state without balance of forces.
    """

    equilibrium: bool = False
    relaxed: bool = False
    path: bool = False
    modes: int | None = None
    as_drawn: bool = False


@dataclass(frozen=True)
class Outputs:
    """Paths of a page, a picture, films and files for ParaView, and the settings of films."""

    page: Path | None = None
    png: Path | None = None
    films: Sequence[Path] = ()
    vtk: Path | None = None
    speed: float | None = None
    colour: str | None = None


def seen(file: str, wanted: Wanted, libraries: Iterable[str | os.PathLike[str]]) -> Viewable:
    """Return the wanted states of a file of results or of a scene. Raises FunicularError."""
    if Path(file).suffix == ".nc":
        if wanted != Wanted(as_drawn=wanted.as_drawn):
            raise FunicularError(f"{file}: --equilibrium, --relaxed, --path and --modes are for scenes, not for "
                                 "results of runs")
        return load_run(file, libraries)
    scene = load_scene(file, libraries)
    if not (wanted.equilibrium or wanted.relaxed or wanted.path):
        return scene if wanted.modes is None else scene.modes(wanted.modes, as_drawn=wanted.as_drawn)
    steps = LOAD_STEPS if wanted.path and not {"method", "load_steps"} & set(scene.equilibrium_settings) else None
    rest = scene.relax() if wanted.relaxed else scene.equilibrium(load_steps=steps)
    if wanted.modes is not None:
        return scene.modes(wanted.modes, about=rest)
    return rest.load_path if wanted.path else rest


def view(files: Sequence[str], wanted: Wanted, outputs: Outputs, open_it: bool,
         libraries: Iterable[str | os.PathLike[str]]) -> list[Path]:
    """Write the outputs, by default the page FILE.html, and return their paths. Raises FunicularError."""
    shown = overlaid([seen(file, wanted, libraries).animation() for file in files])
    written = [write_video(shown, film, outputs.speed, outputs.colour) for film in outputs.films]
    if outputs.png:
        written.append(save_figure(shape_figure(shown, every_view=True), outputs.png))
    if outputs.vtk:
        written.append(write_vtk(shown, outputs.vtk))
    if outputs.page or open_it or not written:
        page = write_page(shown, outputs.page or f"{Path(files[0]).stem}.html")
        written.append(page)
        if open_it:
            show_in_browser(page)
    return written
