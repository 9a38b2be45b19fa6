"""What can be seen: runs, scenes, equilibria and modes have the same methods for it.

What makes pictures is imported only when one is asked for: `import funicular` does without.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from ..base.notebook import in_notebook
from ..errors import FunicularError
from ..parts.scene_data import SceneData

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..view.animation import Animation
    from ..view.showing import Frame


class Viewable:
    """Base of what has an animation."""

    def animation(self, title: str | None = None) -> Animation:
        """Return what pictures show of it, as plain data; title: what they are called."""
        raise NotImplementedError

    def sketch(self) -> Animation:
        """Return as much of its animation as a picture without quantities needs."""
        return self.animation()

    def overview(self) -> list[tuple[str, str]]:
        """Return what a notebook tells of it: pairs of a heading and a text."""
        raise NotImplementedError

    def view(self, *others: Viewable) -> Path | Frame:
        """Open an interactive page in three dimensions: in a notebook as its output, else in the browser.

        others: more runs or scenes, drawn over this one. Returns the page's path, of a file in the system's folder for
        passing files, or what a notebook shows.
        """
        from ..view.showing import framed, opened

        made = self._with(others)
        return framed(made) if in_notebook() else opened(made)

    def save_html(self, path: str | os.PathLike, *others: Viewable) -> Path:
        """Write the page to a file, which is complete: it opens from disk, without a network. Raises ResultFileError.

        others: as of `view`. Returns the path.
        """
        from ..view.page import write_page

        return write_page(self._with(others), path)

    def save_video(self, path: str | os.PathLike, *others: Viewable, speed: float | None = None,
                   colour: str | None = None) -> Path:
        """Write a film: path ends in .gif, or in .mp4, which needs imageio-ffmpeg (pip install 'funicular[video]').

        speed: how many times as fast as the motion it plays, about 8 s in all if not given; colour: a quantity along
        cables, such as "tension", that colours them. Returns the path. Raises ResultFileError; FunicularError.
        """
        from ..view.video import write_video

        return write_video(self._with(others), path, speed, colour)

    def save_png(self, path: str | os.PathLike, *others: Viewable) -> Path:
        """Write a picture with several views: in perspective, from the front, from the side and from above.

        Returns the path. Raises ResultFileError.
        """
        from ..view.files import save_figure
        from ..view.plot import shape_figure

        return save_figure(shape_figure(self._with(others), every_view=True), path)

    def save_vtk(self, folder: str | os.PathLike) -> Path:
        """Write a folder of .vtu files with a .pvd file, for ParaView; needs meshio (pip install 'funicular[vtk]').

        Cables are lines with tension and the like at their points, bodies are surfaces. Returns the path of the .pvd
        file. Raises ResultFileError; FunicularError.
        """
        from ..view.vtk import write_vtk

        return write_vtk(self.animation(), folder)

    def plot(self) -> Figure:
        """Return a Matplotlib figure of its shape, at a few times if it moves, coloured by time.

        A notebook shows it, `matplotlib.pyplot.show` in a script.
        """
        from ..view.files import new_figure
        from ..view.plot import shape_figure

        return shape_figure(self.animation(), new_figure())

    def _with(self, others: Sequence[Viewable]) -> Animation:
        """Return its animation with those of others over it."""
        if not others:
            return self.animation()
        from .animation.clips import overlaid

        return overlaid([each.animation() for each in (self, *others)])

    def _repr_html_(self) -> str:
        """Return a table and a picture, for notebooks; `view` gives the interactive page."""
        from ..view.files import table_tag

        return table_tag(self.overview()) + self._picture()

    def _picture(self) -> str:
        from ..view.files import image_tag, text_tag
        from ..view.plot import shape_figure

        try:
            return image_tag(shape_figure(self.sketch()))
        except FunicularError as error:  # a table without a picture is better than none
            return text_tag(str(error))


def titled(scene: SceneData, state: str) -> str:
    """Return what a picture of a state of a scene is called; nothing of a scene without a title."""
    return f"{scene.title}, {state}" if scene.title else ""
