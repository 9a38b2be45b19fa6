"""Pictures of a run, of `Run.plot` and `funicular run --plot`. Matplotlib is imported when a picture is made."""

from __future__ import annotations

import os
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from ..errors import FunicularError, near
from ..view.files import folder_for_pictures, save_figure
from ..view.plot import STYLE, shape_figure
from . import charts
from .animation.clips import of_run
from .recorded import Recorded

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Drawer = Callable[[Recorded, "Figure"], bool]


def drawers(run: Recorded, forces: bool) -> dict[str, Drawer]:
    """Return the functions that draw pictures of a run, by name; forces: with those in each cable."""
    found: dict[str, Drawer] = {"shape": shape, "acceleration": charts.acceleration, "slide": charts.slide,
                                "rope": charts.rope, "energy": charts.energy}
    if forces:
        found |= {f"forces-{name}": partial(charts.section_forces, cable=name) for name in run.scene.cables}
    return found


def shape(run: Recorded, figure: Figure) -> bool:
    """Draw cables, ropes and bodies at a few times; False without any."""
    if not (run.scene.cables or run.scene.ropes or run.scene.bodies):
        return False
    shape_figure(of_run(run, "run", with_results=False), figure)
    return True


def plot(run: Recorded, what: str, figure: Figure) -> Figure:
    """Draw one picture of a run, by its name; return the figure. Raises FunicularError."""
    from matplotlib import rc_context

    known = drawers(run, forces=True)
    if what not in known:
        raise FunicularError(f'there is no picture "{what}" of a run; {near(what, known)}')
    with rc_context(STYLE):
        if not known[what](run, figure):
            raise FunicularError(f'the run has nothing that the picture "{what}" shows')
    return figure


def save_plots(run: Recorded, directory: str | os.PathLike[str], prefix: str = "", forces: bool = False) -> list[Path]:
    """Write the pictures of a run: shape, acceleration, slide, rope, energy; with ``forces`` also those in each cable.

    The files are ``directory/<prefix><picture>.png``; empty pictures are omitted. Returns their paths. Raises
    ResultFileError.
    """
    from matplotlib import rc_context
    from matplotlib.figure import Figure

    directory, written = folder_for_pictures(directory), []
    for name, draw in drawers(run, forces).items():
        with rc_context(STYLE):
            figure = Figure()
            if draw(run, figure):
                written.append(save_figure(figure, directory / f"{prefix}{name}.png"))
    return written
