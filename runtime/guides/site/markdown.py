"""Docstrings as Markdown, for the printed pages."""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterable
from functools import partial

QUOTED = re.compile(r"^>>> .*(?:\n.+)*|\0[^\0]*\0|`[^`]*`|\(\".*?\)|\"([\w.@]+)\"", re.MULTILINE)
"""Words in quotes, such as a value, outside of examples, code and tuples."""


def prose(thing: object) -> str:
    """Return the docstring of a class or a function as Markdown."""
    return markdown(inspect.getdoc(thing) or "")


def markdown(docstring: str) -> str:
    """Return the text of a docstring as Markdown, with code and examples marked."""
    text = re.sub(r"``([^`]+)``", "\0\\1\0", docstring)
    text = QUOTED.sub(lambda found: f"\0{found[0]}\0" if found[1] else found[0], text)
    return re.sub(r"^>>> .*(?:\n.+)*", r"```pycon\n\g<0>\n```", text.replace("\0", "`"), flags=re.MULTILINE)


HEADING = re.compile(r"^##+ (\S+)$", re.MULTILINE)
OF_PACKAGE = re.compile(r"fu\.|catenary\.(?=[A-Z])")
"""Prefixes of names in headings that docstrings leave out."""


def link(pages: dict[str, str]) -> dict[str, str]:
    """Return pages by file name with links from names in code to their headings on any of them."""
    targets = {OF_PACKAGE.sub("", heading[:1].upper() + heading[1:] if heading.startswith("scene.") else heading):
               (file, anchor(heading)) for file, text in pages.items() for heading in HEADING.findall(text)}

    def linked(file: str, found: re.Match[str]) -> str:
        if (target := targets.get(found[1])) is None:
            return found[0]
        return f"[{found[0]}]({target[0] if target[0] != file else ''}#{target[1]})"

    return {file: re.sub(r"(?<!\[)`([\w.]+)`", partial(linked, file), text) for file, text in pages.items()}


ARGUMENT = re.compile(r"^(\w+(?:, \w+)*): (.*(?:\n    .*)*)\n?", re.MULTILINE)
"""A line of a docstring on one or more arguments, with its continuation."""


def split(docstring: str, names: Iterable[str]) -> tuple[str, dict[str, str]]:
    """Return a docstring without the lines on arguments, and the texts of these by argument; names: of all."""
    known, meanings = set(names), dict[str, str]()

    def taken(found: re.Match[str]) -> str:
        of = found[1].split(", ")
        if not known.issuperset(of):
            return found[0]
        meanings.update(dict.fromkeys(of, re.sub(r"\s+", " ", found[2]).strip()))
        return ""

    rest = ARGUMENT.sub(taken, docstring)
    return re.sub(r"\n{3,}", "\n\n", rest).strip(), meanings


def anchor(heading: str) -> str:
    """Return the anchor of a heading, as on repository hosts."""
    return re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")


def table(head: Iterable[str], rows: Iterable[Iterable[str]]) -> list[str]:
    """Return the lines of a table and an empty one; none where there are no rows."""
    columns = list(head)
    cells = [" | ".join(cell.replace("|", r"\|") for cell in row) for row in rows]
    lines = [f"| {line} |" for line in (" | ".join(columns), *cells)]
    return [lines[0], "|---" * len(columns) + "|", *lines[1:], ""] if cells else []
