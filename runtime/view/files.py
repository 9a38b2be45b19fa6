"""Pictures as files and as parts of pages.

Matplotlib is imported only when a picture is made.
"""

from __future__ import annotations

import base64
import io
import os
from collections.abc import Iterable
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING

from ..base.notebook import in_notebook
from ..base.written_files import unwritable, write_whole
from .plot import STYLE

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SMALL = 80
"""Dots an inch of a picture in a notebook's table."""


PICTURES = "the pictures"
"""What is written, in messages."""


def folder_for_pictures(path: str | os.PathLike) -> Path:
    """Return a folder, which is made where there is none. Raises ResultFileError."""
    folder = Path(path)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except (OSError, ValueError) as error:
        raise unwritable(path, PICTURES, error) from error
    return folder


def new_figure() -> Figure:
    """Return an empty figure that a notebook shows where it is returned, and pyplot.show() in a script."""
    from matplotlib import pyplot, rc_context

    with rc_context(STYLE):
        figure = pyplot.figure()
    if in_notebook():
        pyplot.close(figure)  # which would show it a second time
    return figure


def save_figure(figure: Figure, path: str | os.PathLike) -> Path:
    """Write a figure to a file of the kind that its name ends in, and return its path. Raises ResultFileError."""
    from matplotlib import rc_context

    with rc_context(STYLE):
        return write_whole(path, figure.savefig, PICTURES)


def image_tag(figure: Figure) -> str:
    """Return a figure as an image within HTML."""
    written = io.BytesIO()
    figure.savefig(written, format="png", dpi=SMALL)
    return f'<img alt="" src="data:image/png;base64,{base64.b64encode(written.getvalue()).decode("ascii")}">'


def table_tag(rows: Iterable[tuple[str, str]]) -> str:
    """Return headings and texts as a table within HTML."""
    lines = "".join(f'<tr><th style="text-align: left">{escape(heading)}</th>'
                    f'<td style="text-align: left; white-space: pre-line">{escape(text)}</td></tr>'
                    for heading, text in rows)
    return f"<table>{lines}</table>"


def text_tag(text: str) -> str:
    """Return a text as a paragraph within HTML."""
    return f"<p>{escape(text)}</p>"
