"""The line numbers of tables and entries in a scene file."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable
from typing import Any

MAX_NAME_LENGTH = 1000
"""Characters of a name that is sought: a pattern of a million takes seconds."""


def line_of(text: str, table: str, index: int | None = None, entry: str | None = None) -> int | None:
    """Return the line number, from 1, of an entry of a table in a scene file, else of the head of the table.

    table: its name; index: in an array of tables, from 0; entry: its name. None where the line is not found, such as
    that of a missing entry of a table in one line.
    """
    if max(len(table), len(entry or "")) > MAX_NAME_LENGTH:
        return None
    lines = text.splitlines(keepends=True)
    head = _first(lines, rf"\s*\[{{{1 if index is None else 2}}}\s*[\"']?{re.escape(table)}[\"']?\s*\]",
                  lambda before: index is None or len(before.get(table, [])) == index, skip=index or 0)
    if head is None:
        found = None if entry is not None else _first(lines, _entry(table))
        return None if found is None else found + 1
    if entry is None:
        return head + 1
    end = _first(lines, rf"\s*\[+\s*(?!{re.escape(table)}\s*\.)", after=head)
    within = lines[: len(lines) if end is None else end]
    found = _first(within, rf"{_entry(entry)}|\s*\[+\s*{re.escape(table)}\s*\.\s*{re.escape(entry)}\b", after=head)
    return (head if found is None else found) + 1


def _entry(name: str) -> str:
    return rf"\s*[\"']?{re.escape(name)}[\"']?\s*[=.]"


def _first(lines: list[str], pattern: str, fits: Callable[[dict[str, Any]], bool] = lambda before: True,
           after: int = -1, skip: int = 0) -> int | None:
    """Return the index of the first matching line whose preceding lines are TOML that fits.

    Lines before one inside a multi-line text or list are no TOML. after: a line that precedes it; skip: number of
    matches that cannot be it, as each test parses all lines before.
    """
    matches = [k for k in range(after + 1, len(lines)) if re.match(pattern, lines[k])]
    return next((k for k in matches[skip:] if (before := _parsed(lines[:k])) is not None and fits(before)), None)


def _parsed(lines: list[str]) -> dict[str, Any] | None:
    try:
        return tomllib.loads("".join(lines))
    except (ValueError, RecursionError):
        return None
