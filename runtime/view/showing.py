"""Display of pages: in a browser from a temporary file, in a notebook within a frame."""

from __future__ import annotations

import html
import sys
import tempfile
import webbrowser
from pathlib import Path

from ..errors import ResultFileError
from .animation import Animation
from .page import page, write_page

FRAME_HEIGHT = 560
"""Height of a page in a notebook, pixels."""


class Frame:
    """A page in a notebook."""

    def __init__(self, text: str, height: int = FRAME_HEIGHT):
        """text: of the page; height: in pixels."""
        self.text, self.height = text, height

    def __repr__(self) -> str:
        """Return a description with the size."""
        return f"<a page of {len(self.text) / 1e6:.2g} MB>"

    def _repr_html_(self) -> str:
        """Return a frame with the page, isolated from the scripts of the notebook."""
        return (f'<iframe srcdoc="{html.escape(self.text)}" sandbox="allow-scripts" allow="fullscreen" '
                f'style="width: 100%; height: {self.height}px; border: 0"></iframe>')


def framed(animation: Animation) -> Frame:
    """Return the page of an animation for a notebook."""
    return Frame(page(animation))


def opened(animation: Animation) -> Path:
    """Write the page of an animation to a new temporary file, open it, and return its path."""
    try:
        folder = Path(tempfile.mkdtemp(prefix="funicular-"))
    except OSError as error:
        raise ResultFileError(f"no page can be written for a browser: {error}; save one with save_html") from error
    path = write_page(animation, folder / "view.html")
    show_in_browser(path)
    return path


def show_in_browser(path: Path) -> None:
    """Open a page in the browser, or print its path without one."""
    if not webbrowser.open(path.resolve().as_uri()):
        print(f"no browser was found; open {path}", file=sys.stderr)
