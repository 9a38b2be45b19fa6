"""Repeated blocks of assignments with other names, such as those at quadrature points, are printed once.

Corresponding names become entries of an array: a_0, a_1, a_2 are a[0], a[1], a[2]. FU_EACH (kernels.h) repeats the
block with a constant index. The order of the assignments does not change.

Enters: items, texts of one or more assignments each. Leaves: items of which some stand for several, and the arrays.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

NAME = re.compile(r"(?<![\w.])[A-Za-z_]\w*")
PLACE = re.compile(r"(?<![\w.])[A-Za-z_]\w*|(?<=\[)\d+(?=\])")
"""Names and indices, which may change from one repetition to the next."""
MAX_REPETITIONS, MAX_BLOCK_ITEMS = 12, 90
"""Largest count of FU_EACH in kernels.h, and largest number of items in a block."""
MIN_SAVED_ITEMS = 3
"""Smallest number of items that a repetition saves."""


@dataclass
class Item:
    """A text of one or more assignments, or a block of items, how often it repeats, and the variable for that.

    constant: the name that is declared with its value, empty where it is an array's entry; macro: whether the text is
    the name of a macro, which stands for items.
    """

    text: str
    constant: str = ""
    block: list[Item] = field(default_factory=list)
    times: int = 0
    macro: bool = False

    @cached_property
    def shape(self) -> tuple[Any, ...]:
        """Return what corresponding items of repeated blocks share: kind, count, and text without names and indices."""
        return bool(self.constant), self.times, PLACE.sub("#", self.text)

    @cached_property
    def places(self) -> list[str]:
        """Return the names and indices in the text."""
        return PLACE.findall(self.text)

    def lines(self) -> list[str]:
        """Return the lines of C."""
        if not self.times:
            whole = self.macro or self.text.startswith("FU_") or self.text.endswith(";")
            return [self.text if whole else f"{self.text};"]
        inner = [line for item in self.block for line in item.lines()]
        return [f"FU_EACH({self.text}, {self.times},", *(f"    {line}" for line in inner[:-1]), f"    {inner[-1]})"]


@dataclass
class Arrays:
    """Arrays over repetitions: names of the entries by array, with the C sizes that each entry has itself."""

    sizes: Mapping[str, str]
    taken: set[str]
    entries: dict[str, list[str]] = field(default_factory=dict)
    of: dict[str, tuple[str, int]] = field(default_factory=dict)

    def index(self, names: Sequence[str], variable: str, new: dict[tuple[str, ...], str]) -> str | None:
        """Return the text for corresponding names of a block, by repetition; `new` collects new arrays. None where they
        form no array.
        """
        if len(set(names)) == 1:
            return names[0]
        if any(name not in self.sizes or self.sizes[name] != self.sizes[names[0]] for name in names):
            return None
        if any(name in self.of for name in names):
            return self._entry(names, variable)
        return self._new_entry(names, variable, new)

    def _entry(self, names: Sequence[str], variable: str) -> str | None:
        """Return the entry of an existing array for these names; None where they belong to several arrays."""
        found = [self.of.get(name, ("", -1)) for name in names]
        arrays = {array for array, _ in found}
        if len(arrays) > 1:
            return None
        place = _progression([k for _, k in found], variable)
        return place and f"{arrays.pop()}[{place}]"

    def _new_entry(self, names: Sequence[str], variable: str, new: dict[tuple[str, ...], str]) -> str | None:
        """Return the entry of a new array, which joins `new`; None where another array has some of the names."""
        distinct = next((other for other in new if set(names) <= set(other)), tuple(dict.fromkeys(names)))
        if any(set(other) & set(distinct) for other in new if other != distinct):
            return None
        place = _progression([distinct.index(name) for name in names], variable)
        base = new.get(distinct) or self._base(distinct, set(new.values()))
        if not (place and base):
            return None
        new[distinct] = base
        return f"{base}[{place}]"

    def _base(self, names: Sequence[str], others: set[str]) -> str:
        """Return the common part of names that differ in numbers alone; empty without one, or where it is taken."""
        parts = [re.split(r"(\d+)", name) for name in names]
        if len({len(p) for p in parts}) > 1:
            return ""
        base = ""
        for number, column in enumerate(zip(*parts, strict=True)):
            alike = len(set(column)) == 1
            if not alike and number % 2 == 0:
                return ""
            base = base + column[0] if alike else base.removesuffix("_")
        free = (name for name in (base, f"{base}_at") if name not in self.taken and name not in others)
        return next(free, "") if base.isidentifier() else ""

    def add(self, names: Sequence[str], base: str) -> None:
        """Make an array of these names."""
        self.entries[base] = list(names)
        self.taken.add(base)
        self.of.update((name, (base, k)) for k, name in enumerate(names))

    def placed(self, text: str) -> str:
        """Return a text with the entries of arrays in place of names."""
        def entry(found: re.Match[str]) -> str:
            name, place = self.of.get(found[0], (found[0], None))
            return name if place is None else f"{name}[{place}]"

        return NAME.sub(entry, text)


def _steps(indices: Sequence[int], variable: str) -> str | None:
    """Return the expression in a variable 0, 1, ... that gives these indices by equal steps, or None."""
    first, step = indices[0], indices[1] - indices[0]
    if step == 0 or any(k != first + t * step for t, k in enumerate(indices)):
        return str(first) if len(set(indices)) == 1 else None
    if step < 0:
        return f"{first} - {variable}" if step == -1 else None
    moving = variable if step == 1 else f"{step}*{variable}"
    return f"{moving} + {first}" if first else moving


def _progression(places: Sequence[int], variable: str) -> str | None:
    """Return the expression in a variable 0, 1, ... with these values: a step of one up, down, or up and down."""
    first, last = places[0], places[-1]
    turns = range(len(places))
    if all(k == first for k in places):
        return str(first)
    if all(k == first + t for t, k in zip(turns, places, strict=True)):
        return f"{variable} + {first}" if first else variable
    if all(k == first - t for t, k in zip(turns, places, strict=True)):
        return f"{first} - {variable}"
    if first == last == 0 and all(k == min(t, len(places) - 1 - t) for t, k in zip(turns, places, strict=True)):
        return f"{variable} < {len(places) // 2} ? {variable} : {len(places) - 1} - {variable}"
    return None


def fold(stages: Sequence[list[Item]], sizes: Mapping[str, str], taken: set[str], variable: str) -> Arrays:
    """Replace repeated blocks in the stages by items that stand for them; returns the arrays that this makes.

    sizes: C sizes by local name, "" for a number; taken: names that no array may have. The last stage, the outputs,
    makes no array: compilers keep its values in registers and write two at a time.
    """
    arrays = Arrays(sizes, set(taken))
    numbers: dict[tuple[Any, ...], int] = {}
    for times in range(MAX_REPETITIONS, 1, -1):
        for items in stages:
            shapes = [numbers.setdefault(item.shape, len(numbers)) for item in items]
            start = 0
            while start < len(items):
                found = _longest(items, shapes, start, times, arrays, variable, items is not stages[-1])
                if found:
                    block = slice(start, start + times * len(found))
                    items[block] = [Item(variable, block=found, times=times)]
                    shapes[block] = [numbers.setdefault(items[start].shape, len(numbers))]
                start += 1
    for items in stages:
        for item in items:
            _place(item, arrays)
    return arrays


def _place(item: Item, arrays: Arrays) -> None:
    item.text = arrays.placed(item.text)
    if item.constant in arrays.of:
        item.constant = ""
    for inner in item.block:
        _place(inner, arrays)


def _longest(items: Sequence[Item], shapes: Sequence[int], start: int, times: int, arrays: Arrays,
             variable: str, may_add: bool) -> list[Item] | None:
    """Return the longest block at a place that repeats `times` times, with the variable in it.

    shapes: a number for the shape of each item, the same for the same shape; may_add: whether it may make arrays.
    """
    for length in range(min(MAX_BLOCK_ITEMS, (len(items) - start) // times), 0, -1):
        if length * (times - 1) < MIN_SAVED_ITEMS:
            return None
        if shapes[start] != shapes[start + length]:
            continue
        places, first = range(start, start + times * length, length), shapes[start:start + length]
        if all(shapes[k:k + length] == first for k in places) and not any(items[k].times for k in range(*places[:2])):
            found = _block([items[k:k + length] for k in places], arrays, variable, may_add)
            if found:
                return found
    return None


def _block(blocks: Sequence[Sequence[Item]], arrays: Arrays, variable: str, may_add: bool) -> list[Item] | None:
    """Return one block for several, None where their names form no arrays."""
    new: dict[tuple[str, ...], str] = {}
    found = []
    for items in zip(*blocks, strict=True):
        item = _folded(items, arrays, variable, new)
        if item is None or (new and not may_add):
            return None
        found.append(item)
    for names, base in new.items():
        arrays.add(names, base)
    return found


def _folded(items: Sequence[Item], arrays: Arrays, variable: str, new: dict[tuple[str, ...], str]) -> Item | None:
    """Return one item for several, None where their names form no arrays."""
    found = []
    for names in zip(*(item.places for item in items), strict=True):
        if all(name.isdigit() for name in names):
            entry = _steps([int(name) for name in names], variable)
        else:
            entry = arrays.index(names, variable, new)
        if entry is None:
            return None
        found.append(entry)
    entries = iter(found)
    return Item(PLACE.sub(lambda _: next(entries), items[0].text))
