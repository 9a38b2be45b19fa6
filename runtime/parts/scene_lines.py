"""Where a scene file says something: the line of a table, and of an entry in it."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable

LONGEST = 1000
"""Characters of a name that is looked for: a pattern of a million takes seconds."""


def line_of(text: str, table: str, index: int | None = None, entry: str | None = None) -> int | None:
    """Return the number of a line of a scene file, from 1: of an entry of a table, else of the head of the table.

    table: its name; index: of an array of tables, which one, from 0; entry: its name. None where it is not found, such
    as an entry that is missing from a table written in one line.
    """
    if max(len(table), len(entry or "")) > LONGEST:
        return None
    lines = text.splitlines(keepends=True)
    head = _first(lines, rf"\s*\[{{{1 if index is None else 2}}}\s*[\"']?{re.escape(table)}[\"']?\s*\]",
                  lambda before: index is None or len(before.get(table, [])) == index, skip=index or 0)
    if head is None:
        return None if entry is not None else _number(_first(lines, _entry(table)))
    if entry is None:
        return head + 1
    end = _first(lines, rf"\s*\[+\s*(?!{re.escape(table)}\s*\.)", after=head)
    within = lines[: len(lines) if end is None else end]
    found = _first(within, rf"{_entry(entry)}|\s*\[+\s*{re.escape(table)}\s*\.\s*{re.escape(entry)}\b", after=head)
    return (head if found is None else found) + 1


def _entry(name: str) -> str:
    return rf"\s*[\"']?{re.escape(name)}[\"']?\s*[=.]"


def _number(index: int | None) -> int | None:
    return None if index is None else index + 1


def _first(lines: list[str], pattern: str, fits: Callable[[dict], bool] = lambda before: True,
           after: int = -1, skip: int = 0) -> int | None:
    """Return the index of the first line after one that matches, where the lines before it are TOML that fits.

    A line inside a text or a list of several lines has before it what is no TOML of itself. skip: how many matches
    come before at least, which are not looked at: each look reads all lines before.
    """
    matches = [k for k in range(after + 1, len(lines)) if re.match(pattern, lines[k])]
    return next((k for k in matches[skip:] if (before := _parsed(lines[:k])) is not None and fits(before)), None)


def _parsed(lines: list[str]) -> dict | None:
    try:
        return tomllib.loads("".join(lines))
    except (ValueError, RecursionError):
        return None
