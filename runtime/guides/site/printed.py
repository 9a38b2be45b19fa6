"""Writes the pages that are printed from the code: ``python -m funicular.guides.site.printed``."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

from .markdown import link
from .methods_page import methods_page
from .parts_page import parts_page

FOLDER = Path(__file__).parents[1] / "pages"
PRINTED: dict[str, Callable[[], str]] = {"parts.md": parts_page, "methods.md": methods_page}
"""The functions that print them, without links between them."""


def printed() -> dict[str, str]:
    """Return the texts of the pages by their file names."""
    return link({name: page() for name, page in PRINTED.items()})


def main() -> int:
    """Write the pages into the folder `guides/pages` of the repository; returns 0, or 1 where there is none."""
    if not FOLDER.is_dir():
        print(f"error: {FOLDER} does not exist: an installed funicular is without these pages; print them in a copy of "
              "the repository", file=sys.stderr)
        return 1
    for name, text in printed().items():
        (FOLDER / name).write_text(text, encoding="utf-8")
        print(FOLDER / name)
    return 0


if __name__ == "__main__":
    sys.exit(main())
