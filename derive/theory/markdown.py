"""The text between the formulas: a small Markdown with formulas that can be evaluated, from files beside the specs.

    # Title                  a chapter; ## a section
    ```scope slide           what the symbols of the formulas that follow stand for (scopes.py)
    ```formula 20            display formulas, one a line, of this equation of the paper; each may end with
                             % = kernel.output   its left side is this output of this kernel
                             % for k             it holds for each value of the index k
                             % holds             its sides are equal, and it defines nothing
                             % shown             it stands for the reader; nothing is evaluated
    ```print shape_functions formulas that are made from the specs (printed.py)
    ```proof sign_of_34      a number that a reader can check, computed now (proofs.py)
    ```print-note 34         where the print of the paper is wrong

Paragraphs, lists and tables have `code`, *stress*, [links](...) and $formulas$.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field

FENCE = re.compile(r"^```(\S+)\s*(.*)$")


@dataclass(frozen=True)
class Line:
    """One formula: its LaTeX as written, and what it says of itself."""

    latex: str
    output: str = ""
    index: str = ""
    kind: str = "definition"


@dataclass
class Block:
    """A block of a chapter: kind is heading, paragraph, list, table, or the word of a fence."""

    kind: str
    text: str = ""
    about: str = ""
    level: int = 0
    items: list[str] = field(default_factory=list)
    rows: list[list[str]] = field(default_factory=list)
    lines: list[Line] = field(default_factory=list)


def blocks(text: str) -> Iterator[Block]:
    """Yield the blocks of a text, in order. Raises ValueError for a fence without an end."""
    lines = text.splitlines()
    at = 0
    while at < len(lines):
        line = lines[at]
        if fence := FENCE.match(line):
            end = next((k for k in range(at + 1, len(lines)) if lines[k] == "```"), None)
            if end is None:
                raise ValueError(f"{line} has no end")
            yield _fenced(fence[1], fence[2], lines[at + 1: end])
            at = end + 1
        elif line.startswith("#"):
            marks, _, title = line.partition(" ")
            yield Block("heading", title, level=len(marks))
            at += 1
        elif not line.strip():
            at += 1
        else:
            end = next((k for k in range(at, len(lines)) if not lines[k].strip() or lines[k].startswith("```")),
                       len(lines))
            yield _plain(lines[at:end])
            at = end


def _fenced(kind: str, about: str, lines: list[str]) -> Block:
    if kind == "formula":
        return Block(kind, about=about, lines=[formula(line) for line in lines if line.strip()])
    return Block(kind, "\n".join(lines), about)


def formula(line: str) -> Line:
    """Return a line of formulas from its text."""
    latex, _, comment = line.partition("%")
    comment = comment.strip()
    if comment.startswith("="):
        return Line(latex.strip(), output=comment[1:].strip())
    if comment.startswith("for"):
        return Line(latex.strip(), index=comment.split()[1])
    return Line(latex.strip(), kind=comment or "definition")


def _plain(lines: list[str]) -> Block:
    if lines[0].startswith("|"):
        rows = [[cell.strip() for cell in line.strip().strip("|").split("|")] for line in lines]
        return Block("table", rows=[row for row in rows if not all(re.fullmatch(":?-+:?", cell) for cell in row)])
    if lines[0].startswith("- "):
        return Block("list", items=[item.replace("\n", " ") for item in re.split(r"\n- ", "\n".join(lines)[2:])])
    return Block("paragraph", " ".join(lines))


INLINE = re.compile(r"(?P<code>`[^`]+`)|(?P<math>\$[^$]+\$)|(?P<stress>\*[^*]+\*)|(?P<link>\[[^\]]+\]\([^)]+\))")


def inline(text: str) -> Iterator[tuple[str, str]]:
    """Yield (kind, text) of the parts of a paragraph: plain, code, math, stress; a link is "words](address"."""
    at = 0
    for found in INLINE.finditer(text):
        if found.start() > at:
            yield "plain", text[at: found.start()]
        yield str(found.lastgroup), found[0][1:-1]
        at = found.end()
    if at < len(text):
        yield "plain", text[at:]
