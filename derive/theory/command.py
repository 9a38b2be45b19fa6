"""`funicular theory`: builds the documents, reads their formulas back, and compares these with the compiled kernels."""

from __future__ import annotations

import difflib
import sys
import time
from pathlib import Path

from funicular.base.written_files import write_text

from ..catalogue import families
from ..elements import ELEMENTS
from .check import faults, measure
from .contents import page, theory
from .document import Document
from .html import html
from .pages import element_page
from .tex import tex

WHOLE = "theory"


def document(name: str) -> Document:
    """Return the document of a name: the whole theory, an element, or one family of kernels.

    Raises KeyError for an unknown name, naming the near ones.
    """
    if name == WHOLE:
        return theory()
    if name in ELEMENTS:
        return element_page(name)
    if name not in families():
        near = difflib.get_close_matches(name, [WHOLE, *families()], n=3) or [WHOLE, *ELEMENTS]
        raise KeyError(f'no element or family "{name}"; did you mean {", ".join(near)}?')
    return page(name)


def build(name: str, folder: Path) -> tuple[list[Path], list[str]]:
    """Write NAME.html and NAME.tex into a folder; return the files, and what is wrong with them."""
    made = document(name)
    measure(made)
    texts = {f"{name}.html": html(made), f"{name}.tex": tex(made)}
    folder.mkdir(parents=True, exist_ok=True)
    paths = []
    for file, text in texts.items():
        paths.append(write_text(folder / file, text))
    return paths, faults(made, *texts.values())


def main(name: str | None, folder: Path) -> int:
    """Build one document, or the theory and the pages of all elements; return the exit code of the command."""
    wrong = 0
    for wanted in [name] if name else [WHOLE, *ELEMENTS]:
        start = time.perf_counter()
        try:
            paths, found = build(wanted, folder)
        except (KeyError, OSError) as problem:
            print(f"funicular theory: {problem.args[0] if isinstance(problem, KeyError) else problem}", file=sys.stderr)
            return 1
        for fault in found:
            print(f"{wanted}: {fault}", file=sys.stderr)
        wrong += len(found)
        print(f"written: {', '.join(map(str, paths))} ({time.perf_counter() - start:.0f} s)"
              + ("" if found else "; every formula agrees with the kernels"))
    return 1 if wrong else 0
