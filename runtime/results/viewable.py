"""Pictures of runs, scenes, equilibria and modes by the same methods.

Modules for pictures are imported when one is made, not by `import funicular`.
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
    """Base of the classes with an animation."""

    def animation(self, title: str | None = None) -> Animation:
        """Return the content of pictures as plain data; title: of the pictures."""
        raise NotImplementedError

    def sketch(self) -> Animation:
        """Return the animation without quantities and curves."""
        return self.animation()

    def overview(self) -> list[tuple[str, str]]:
        """Return the description in a notebook as pairs of a heading and a text."""
        raise NotImplementedError

    def view(self, *others: Viewable) -> Path | Frame:
        """Open an interactive page in three dimensions: in a notebook as its output, else in the browser.

        others: more runs or scenes, drawn over this one. Returns the path of the page, a temporary file, or the output
        of the notebook.
        """
        from ..view.showing import framed, opened

        made = self._with(others)
        return framed(made) if in_notebook() else opened(made)

    def save_html(self, path: str | os.PathLike[str], *others: Viewable) -> Path:
        """Write the page to one file that opens from disk without a network. Raises ResultFileError.

        others: as for `view`. Returns the path.
        """
        from ..view.page import write_page

        return write_page(self._with(others), path)

    def save_video(self, path: str | os.PathLike[str], *others: Viewable, speed: float | None = None,
                   colour: str | None = None) -> Path:
        """Write a film: path ends in .gif, or in .mp4, which needs imageio-ffmpeg (pip install 'funicular[video]').

        speed: motion time over film time, by default for a film of about 8 s; colour: a quantity along cables, such as
        "tension", that colours them. Returns the path. Raises ResultFileError; FunicularError.
        """
        from ..view.video import write_video

        return write_video(self._with(others), path, speed, colour)

    def save_png(self, path: str | os.PathLike[str], *others: Viewable) -> Path:
        """Write a picture with several views: in perspective, from the front, from the side and from above.

        Returns the path. Raises ResultFileError.
        """
        from ..view.files import save_figure
        from ..view.plot import shape_figure

        return save_figure(shape_figure(self._with(others), every_view=True), path)

    def save_vtk(self, folder: str | os.PathLike[str]) -> Path:
        """Write a folder of .vtu files with a .pvd file, for ParaView; needs meshio (pip install 'funicular[vtk]').

        Cables are lines with tension and other quantities at their points, bodies are surfaces. Returns the path of the
        .pvd file. Raises ResultFileError; FunicularError.
        """
        from ..view.vtk import write_vtk

        return write_vtk(self.animation(), folder)

    def plot(self) -> Figure:
        """Return a Matplotlib figure of the shape, of a motion at a few times, coloured by time.

        A notebook shows it, `matplotlib.pyplot.show` in a script.
        """
        from ..view.files import new_figure
        from ..view.plot import shape_figure

        return shape_figure(self.animation(), new_figure())

    def _with(self, others: Sequence[Viewable]) -> Animation:
        """Return the animation with those of others over it."""
        if not others:
            return self.animation()
        from .animation.clips import overlaid

        return overlaid([each.animation() for each in (self, *others)])

    def _repr_html_(self) -> str:
        """Return a table and a picture, for notebooks; `view` gives the interactive page."""
        from ..view.files import image_tag, table_tag, text_tag
        from ..view.plot import shape_figure

        try:
            picture = image_tag(shape_figure(self.sketch()))
        except FunicularError as error:  # the table is useful without a picture
            picture = text_tag(str(error))
        return table_tag(self.overview()) + picture


def titled(scene: SceneData, state: str) -> str:
    """Return the title of a picture of a state; empty for a scene without a title."""
    return f"{scene.title}, {state}" if scene.title else ""
