"""Pages that open: in a browser from a file of their own, in a notebook within a frame."""

from __future__ import annotations

import html
import sys
import tempfile
import webbrowser
from pathlib import Path

from ..errors import ResultFileError
from .animation import Animation
from .page import page, write_page

HEIGHT = 560
"""Of a page in a notebook, in pixels."""


class Frame:
    """A page in a notebook."""

    def __init__(self, text: str, height: int = HEIGHT):
        """text: of the page."""
        self.text, self.height = text, height

    def __repr__(self) -> str:
        """Return what it is, in a line."""
        return f"<a page of {len(self.text) / 1e6:.2g} MB>"

    def _repr_html_(self) -> str:
        """Return a frame with the page in it, cut off from the notebook's own scripts."""
        return (f'<iframe srcdoc="{html.escape(self.text)}" sandbox="allow-scripts" allow="fullscreen" '
                f'style="width: 100%; height: {self.height}px; border: 0"></iframe>')


def framed(animation: Animation) -> Frame:
    """Return the page of an animation as a notebook shows it."""
    return Frame(page(animation))


def opened(animation: Animation) -> Path:
    """Write the page of an animation to a new file of the system's folder for them, open it, and return its path."""
    try:
        folder = Path(tempfile.mkdtemp(prefix="funicular-"))
    except OSError as error:
        raise ResultFileError(f"no page can be written for a browser: {error}; save one with save_html") from error
    path = write_page(animation, folder / "view.html")
    show_in_browser(path)
    return path


def show_in_browser(path: Path) -> None:
    """Open a page; where there is no browser, say where it is."""
    if not webbrowser.open(path.resolve().as_uri()):
        print(f"no browser was found; open {path}", file=sys.stderr)
