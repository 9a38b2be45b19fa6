"""Which definitions of a program differ in direction only.

Definitions name_x, name_y, name_z are entries of an array name[3], name_xx ... name_zz of an array name[3][3]; inputs
are arrays by themselves. `Layout.match` finds the one expression, with the direction as a parameter, that stands for
those of a group.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import product
from math import prod

import sympy as sp

from .program import AXES, Program

Index = tuple[int, ...]
Pattern = tuple[int | str, ...]
"""An index whose entries are numbers or loop variables."""
NAME = re.compile(r"(.*?)_([xyz]{1,2})(_\d+)?")
SYMBOL = re.compile(r"[A-Za-z_]\w*(\[\d+\])?")
LOOP_VARIABLES = (("i", "j"), ("row", "col"), ("along", "across"))
"""Names of loop variables, by preference: the first pair that no symbol of the program has."""
MAX_DIAGONAL_OPERATIONS = 6
"""Largest number of additional operations of a diagonal entry in a group with one expression."""


@dataclass(frozen=True)
class Array:
    """A C array: its name, the sizes of its axes, whether its axes are one in C, and whether it is symmetric: only
    entries on and above the diagonal have symbols.
    """

    name: str
    sizes: Index
    flat: bool = False
    symmetric: bool = False

    def entry(self, index: Sequence[int | str | tuple[str, int]]) -> str:
        """Return the C text of an entry; the index has numbers, loop variables, and pairs (loop variable, offset)."""
        if not self.flat:
            return self.name + "".join(f"[{k}]" for k in index)
        offset, terms = 0, []
        for axis, k in enumerate(index):
            stride = prod(self.sizes[axis + 1:])
            name, by = ("", k) if isinstance(k, int) else (k, 0) if isinstance(k, str) else k
            offset += stride * by
            if name:
                terms.append(name if stride == 1 else f"{stride}*{name}")
        return f"{self.name}[{' + '.join([*terms, *([str(offset)] if offset or not terms else [])])}]"


@dataclass(frozen=True)
class Place:
    """Where a symbol stands: its array and index."""

    array: Array
    index: Index


@dataclass(frozen=True)
class Match:
    """One expression for several: that of the first turn (0,) or (0, 1) of the loop variables, the index of each symbol
    in it that moves with them, and by turn what entries on the diagonal have besides.
    """

    expr: sp.Expr
    patterns: dict[sp.Symbol, Pattern]
    rest: dict[Index, sp.Expr] = field(default_factory=dict)


class Layout:
    """The arrays of a program by symbol, and what its expressions have in common.

    groups: the symbols of each array of definitions, by index. dim: the directions of most of these arrays, 0 without.
    variables: names for loop variables.
    """

    def __init__(self, program: Program):
        self.places: dict[sp.Symbol, Place] = {}
        self.groups: dict[str, dict[Index, sp.Symbol]] = {}
        self._inputs(program)
        names = {s.name for stage in program.stages for s, _ in stage.definitions}
        names |= {a.name for a in (*program.inputs, *program.outputs)}
        self._definitions(program, names)
        self.variables = next(v for v in LOOP_VARIABLES if (names | self.groups.keys()).isdisjoint(v))
        self._symbol = {(p.array.name, p.index): s for s, p in self.places.items()}
        self.array = {p.array.name: p.array for p in self.places.values()}
        common = Counter(self.array[base].sizes[0] for base in self.groups).most_common(1)
        self.dim = common[0][0] if common else 0

    def _inputs(self, program: Program) -> None:
        for argument in program.inputs:
            if argument.shape:
                array = Array(argument.name, argument.shape, flat=True)
                for index, symbol in zip(product(*map(range, argument.shape)), program.symbols[argument.name].ravel(),
                                         strict=True):
                    self.places[symbol] = Place(array, index)

    def _definitions(self, program: Program, names: set[str]) -> None:
        found: dict[str, dict[Index, list[sp.Symbol]]] = {}
        for stage in program.stages:
            for symbol, _ in stage.definitions:
                if match := NAME.fullmatch(symbol.name):
                    base, index = match[1] + (match[3] or ""), tuple(map(AXES.index, match[2]))
                    found.setdefault(base, {}).setdefault(index, []).append(symbol)
        for base, group in found.items():
            sizes = _sizes(set(group))
            if sizes and base not in names and base.isidentifier() and all(len(s) == 1 for s in group.values()):
                self.groups[base] = {index: symbol for index, (symbol,) in group.items()}
                array = Array(base, sizes, symmetric=len(group) < prod(sizes))
                self.places.update((symbol, Place(array, index)) for index, symbol in self.groups[base].items())

    def keep(self, needed: set[str]) -> None:
        """Drop the arrays of definitions that are not needed; their symbols become single numbers."""
        for base in self.groups.keys() - needed:
            for symbol in self.groups.pop(base).values():
                del self.places[symbol]

    def match(self, exprs: Mapping[Index, sp.Expr], dim: int) -> Match | None:
        """Return the one expression for all of these, by turn; None where there is none."""
        rank = len(next(iter(exprs)))
        first = tuple(range(rank))
        turns: dict[Index, Mapping[str, int]] = {turn: dict(zip(self.variables, turn, strict=False)) for turn in exprs}
        others = [(turns[turn], expr.free_symbols) for turn, expr in exprs.items()
                  if turn != first and (rank == 1 or turn[0] != turn[1])]
        patterns: dict[sp.Symbol, Pattern] = {}
        for symbol in exprs[first].free_symbols & self.places.keys():
            pattern = self._pattern(self.places[symbol], dim, turns[first], others)
            if pattern is None:
                return None
            if not all(isinstance(k, int) for k in pattern):
                patterns[symbol] = pattern
        rest = self._rest(exprs, first, patterns, turns)
        if rest is None or (rest and (rank == 1 or rest.keys() != {(k, k) for k in range(dim)}
                                     or any(sp.count_ops(r) > MAX_DIAGONAL_OPERATIONS for r in rest.values()))):
            return None
        return Match(exprs[first], patterns, rest)

    def _rest(self, exprs: Mapping[Index, sp.Expr], first: Index, patterns: Mapping[sp.Symbol, Pattern],
              turns: Mapping[Index, Mapping[str, int]]) -> dict[Index, sp.Expr] | None:
        """Return the additional terms of expressions beyond the image of the first, by turn; None without an image."""
        rest = {}
        for turn, expr in exprs.items():
            images = {s: self._image(self.places[s], pattern, turns[turn]) for s, pattern in patterns.items()}
            if None in images.values():
                return None
            image = exprs[first].xreplace(images)
            if image != expr:
                rest[turn] = expr - image
        return rest

    def _pattern(self, place: Place, dim: int, first: Mapping[str, int],
                 others: Sequence[tuple[Mapping[str, int], set[sp.Symbol]]]) -> Pattern | None:
        """Return the index with most loop variables whose images are in the other expressions."""
        choices: list[list[int | str]] = [
            [*(name for name, at in first.items() if size == dim and at == k), k]
            for size, k in zip(place.array.sizes, place.index, strict=True)]
        for pattern in sorted(product(*choices), key=lambda p: sum(isinstance(k, int) for k in p)):
            if all(self._image(place, pattern, turn) in symbols for turn, symbols in others):
                return pattern
        return None

    def _image(self, place: Place, pattern: Pattern, turn: Mapping[str, int]) -> sp.Symbol | None:
        index = tuple(turn[k] if isinstance(k, str) else k for k in pattern)
        return self._symbol.get((place.array.name, tuple(sorted(index)) if place.array.symmetric else index))

    def text(self, expr: sp.Expr, patterns: Mapping[sp.Symbol, Pattern], number: Callable[[sp.Expr], str]) -> str:
        """Return the C text of an expression over the arrays; terms and factors stand in the order of the symbols' own
        names.
        """
        entries = {s.name: self.places[s].array.entry(patterns.get(s, self.places[s].index))
                   for s in expr.free_symbols & self.places.keys()}
        return SYMBOL.sub(lambda found: entries.get(found[0], found[0]), number(expr))


def _sizes(indices: set[Index]) -> Index | None:
    """Return the sizes of the array with these entries, on and above its diagonal if it is symmetric; None where some
    are missing.
    """
    for dim in (3, 2):
        pairs = set(product(range(dim), repeat=2))
        if indices == set(product(range(dim))):
            return (dim,)
        if indices in (pairs, {(i, j) for i, j in pairs if i <= j}):
            return (dim, dim)
    return None
