"""Pictures as files and within HTML, and the packages of extras. Matplotlib is imported when a picture is made."""

from __future__ import annotations

import base64
import importlib
import io
import os
from collections.abc import Iterable
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..base.notebook import in_notebook
from ..base.written_files import unwritable, write_whole
from ..errors import FunicularError
from .plot import STYLE

if TYPE_CHECKING:
    from matplotlib.figure import Figure

NOTEBOOK_DPI = 80
PICTURES = "the pictures"
"""The files in messages."""


def folder_for_pictures(path: str | os.PathLike[str]) -> Path:
    """Return a folder, created if necessary. Raises ResultFileError."""
    folder = Path(path)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except (OSError, ValueError) as error:
        raise unwritable(path, PICTURES, error) from error
    return folder


def new_figure() -> Figure:
    """Return an empty figure, shown by a notebook as output and by pyplot.show() in a script."""
    from matplotlib import pyplot, rc_context

    with rc_context(STYLE):
        figure = pyplot.figure()
    if in_notebook():
        pyplot.close(figure)  # else it is shown twice
    return figure


def save_figure(figure: Figure, path: str | os.PathLike[str]) -> Path:
    """Write a figure to a file, in the format of its suffix, and return its path. Raises ResultFileError."""
    from matplotlib import rc_context

    with rc_context(STYLE):
        return write_whole(path, figure.savefig, PICTURES)


def image_tag(figure: Figure) -> str:
    """Return a figure as an image within HTML."""
    written = io.BytesIO()
    figure.savefig(written, format="png", dpi=NOTEBOOK_DPI)
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


def extra(module: str, name: str) -> Any:
    """Return a module of an extra of this package. Raises FunicularError with the command that installs it."""
    try:
        return importlib.import_module(module)
    except ModuleNotFoundError as error:
        raise FunicularError(f"this needs {error.name}, which is not installed; "
                             f"pip install 'funicular[{name}]'") from error
