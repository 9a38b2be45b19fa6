"""Lines of C of a program. Statements that differ in direction alone become one loop over directions.

FU_EACH and its like (kernels.h) repeat a statement with the loop variable a constant: compilers keep the arrays in
registers, and a kernel costs what it costs written out. Outputs that are copies of a group are written where the group
is computed, once no input is read any more.

Enters: a Program. Leaves: lines of C by stage. Names and order of the definitions are those of the Program.
"""

from __future__ import annotations

import math
import re
import textwrap
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import groupby, product
from typing import Any

import numpy as np
import sympy as sp

from .c_printer import c_expression
from .directions import Array, Index, Layout, Match, Pattern
from .program import Program
from .repeats import NAME, Arrays, Item, fold

WIDTH = 120
REPETITIONS = ("g", "point", "repetition")
"""Names of the variable of repeated blocks, by preference: the first that no symbol has."""
HEADS = {(1, False): "FU_EACH", (2, False): "FU_PAIRS", (2, True): "FU_UPPER"}
"""Macros of kernels.h: for directions i, pairs of directions (i, j), and pairs with i <= j."""
MAX_ASSIGNMENT_SHARE = {150: 0.6, math.inf: 0.8}
"""Largest share of assignments that remain with loops, by their number without; above it the kernel has no loops.
Small kernels gain little from loops, and compilers may emit a few per cent more instructions.
"""


@dataclass
class Section:
    """A titled part of a kernel: lines that declare arrays, assignments."""

    title: str
    declared: list[str]
    items: list[Item]

    @property
    def lines(self) -> list[str]:
        """Return the lines of C."""
        return [*self.declared, *lines_of(self.items)]


def lines_of(items: Iterable[Item]) -> list[str]:
    """Return the lines of C of assignments: constants in lists, all else line by line."""
    lines: list[str] = []
    for constant, run in groupby(items, key=lambda item: bool(item.constant)):
        texts = [item.text for item in run] if constant else []
        if len(texts) == 1:
            lines.append(f"const fu_real {texts[0]};")
        elif constant:
            lines += ["const fu_real", *(f"    {text}," for text in texts[:-1]), f"    {texts[-1]};"]
        for item in run if not constant else ():
            lines += item.lines()
    return lines


@dataclass(eq=False)
class Block:
    """Entries of an output that differ in direction, by turn; `index` is that of a turn's entry, `start` the first."""

    array: Array
    start: Index
    index: Callable[[Sequence[Any]], list[Any]]
    exprs: dict[Index, sp.Expr]
    match: Match | None


def sections(program: Program, number: Callable[[sp.Expr], str] = c_expression) -> list[Section]:
    """Return the stages of a program and its outputs, as lines of C.

    number: C text of an expression that is assigned.
    """
    return _Writer(program, number).sections()


class _Writer:
    def __init__(self, program: Program, number: Callable[[sp.Expr], str]):
        self.program, self.number, self.layout = program, number, Layout(program)
        self.exprs = {symbol: expr for stage in program.stages for symbol, expr in stage.definitions}
        self.at = {symbol: k for k, symbol in enumerate(self.exprs)}
        self.matches = {base: match for base, group in self.layout.groups.items()
                        if (match := self._matched(base, group))}
        self.blocks = [block for a in program.outputs for block in self._blocks(a.name)]
        if not self._worth_it():
            self.matches, self.blocks = {}, [b for a in program.outputs for b in self._entries(a.name)]
        used = [match for match in (*self.matches.values(), *(b.match for b in self.blocks)) if match]
        self.layout.keep({*self.matches, *(self.layout.places[s].array.name for m in used for s in m.patterns)})
        self.in_place = self._in_place()
        self.local = self._local()
        self.mirrored = self._mirrored()
        self.items: list[Item] = []
        self._known: set[str] = set()
        self.stages = [(stage.title, stage.definitions) for stage in program.stages] + [("outputs", [])]

    def sections(self) -> list[Section]:
        """Return the sections, stage by stage, then the outputs."""
        written: set[sp.Symbol] = set()
        stages = []
        for title, definitions in self.stages:
            self.items = []
            for symbol, expr in definitions:
                if symbol not in written:
                    written |= self._define(symbol, expr)
            if title == "outputs" and not definitions:
                for block in self.blocks:
                    if not any(block in copies for copies in self.in_place.values()):
                        self._output(block)
            stages.append(self.items)
        sizes = {symbol.name: "" for symbol in self.exprs if symbol not in self.layout.places}
        sizes |= {base: "".join(f"[{n}]" for n in self.layout.array[base].sizes) for base in self.local}
        taken = {*sizes, *(a.name for a in (*self.program.inputs, *self.program.outputs)), *self.layout.variables}
        arrays = fold(stages, sizes, taken, next(v for v in REPETITIONS if v not in taken))
        found = []
        for (title, _), items in zip(self.stages, stages, strict=True):
            found.append(Section(title, self._declared(items, sizes, arrays), items))
        return [section for section in found if section.lines]

    # --- what is a loop -------------------------------------------------------------------------------------------

    def _matched(self, base: str, group: Mapping[Index, sp.Symbol]) -> Match | None:
        """Return the one expression of a group, where all of its definitions can stand at the place of the first."""
        first = min(self.at[s] for s in group.values())
        if any(self.at.get(s, -1) >= first for symbol in group.values() for s in self.exprs[symbol].free_symbols):
            return None
        return self.layout.match({index: self.exprs[s] for index, s in group.items()},
                                 self.layout.array[base].sizes[0])

    def _worth_it(self) -> bool:
        """Return whether loops leave few enough assignments."""
        before = len(self.exprs) + sum(len(block.exprs) for block in self.blocks)
        saved = sum(len(self.layout.groups[base]) - 1 for base in self.matches)
        saved += sum(len(block.exprs) - 1 for block in self.blocks)
        return before - saved <= before * next(share for most, share in MAX_ASSIGNMENT_SHARE.items() if before < most)

    def _entries(self, name: str) -> list[Block]:
        """Return an output in blocks of one entry each."""
        values = self.program.values[name]
        array = Array(name, values.shape, flat=True)
        return [Block(array, at, partial(_fixed, at), {(): values[at]}, None) for at in np.ndindex(*values.shape)]

    def _blocks(self, name: str) -> list[Block]:
        """Return an output in blocks of directions along its last axes."""
        values, dim = self.program.values[name], self.layout.dim
        array = Array(name, values.shape, flat=True)
        moving = [axis for axis, size in enumerate(values.shape) if dim and size % dim == 0][-2:]
        found = self._split(array, values, moving, [range(size) for size in values.shape])
        return sorted(found, key=lambda block: block.start)

    def _split(self, array: Array, values: np.ndarray, moving: list[int], within: list[range]) -> Iterator[Block]:
        """Yield blocks over the `moving` axes; those that are not alike are split again, over fewer axes."""
        dim = self.layout.dim
        for start in product(*(span[::dim] if axis in moving else span for axis, span in enumerate(within))):
            def index(turn: Sequence[Any], start: tuple[int, ...] = start) -> list[Any]:
                at: list[Any] = list(start)
                for axis, k in zip(moving, turn, strict=True):
                    at[axis] = k + start[axis] if isinstance(k, int) else (k, start[axis])
                return at

            exprs = {turn: values[tuple(index(turn))] for turn in product(range(dim), repeat=len(moving))}
            match = self.layout.match(exprs, dim) if moving else None
            if match or not moving:
                yield Block(array, start, index, exprs, match)
            else:
                spans = [range(k, k + dim) if axis in moving else range(k, k + 1) for axis, k in enumerate(start)]
                yield from self._split(array, values, moving[1:], spans)

    def _in_place(self) -> dict[str, list[Block]]:
        """Return, by group, the outputs that copy it and can be written where it is computed: no input is read later.
        """
        inputs = {s for a in self.program.inputs for s in np.ravel(self.program.symbols[a.name])}
        last = max((self.at[s] for s, expr in self.exprs.items() if expr.free_symbols & inputs), default=-1)
        found: dict[str, list[Block]] = {}
        for block in self.blocks:
            if block.match and block.match.expr in block.match.patterns and block.match.expr not in inputs:
                base = self.layout.places[block.match.expr].array.name
                pattern = block.match.patterns[block.match.expr]
                turn = self._turn(len(next(iter(block.exprs))))
                late = min(self.at[s] for s in self.layout.groups[base].values()) >= last
                if base in self.matches and late and sorted(pattern, key=str) == sorted(turn):
                    found.setdefault(base, []).append(block)
        return found

    def _local(self) -> set[str]:
        """Return the groups that expressions or other outputs use."""
        copied = {block for blocks in self.in_place.values() for block in blocks}
        used = {s for expr in self.exprs.values() for s in expr.free_symbols}
        used |= {s for b in self.blocks if b not in copied for e in b.exprs.values() for s in e.free_symbols}
        return {base for base, group in self.layout.groups.items()
                if base not in self.in_place or self.matches[base].rest or not used.isdisjoint(group.values())}

    def _mirrored(self) -> set[str]:
        """Return the symmetric groups whose entries below the diagonal are used, with the same groups at other points.
        """
        found = set()
        uses = [(match, self.layout.array[base].symmetric) for base, match in self.matches.items()]
        copied = {block for blocks in self.in_place.values() for block in blocks}
        uses += [(b.match, False) for b in self.blocks if b.match and b not in copied]
        for match, upper in uses:
            for symbol in match.patterns:
                if self.layout.places[symbol].array.symmetric and not upper:
                    found.add(_kind(self.layout.places[symbol].array.name))
        return {base for base in self.layout.groups if self.layout.array[base].symmetric and _kind(base) in found}

    # --- text -----------------------------------------------------------------------------------------------------

    def _turn(self, rank: int) -> Pattern:
        return self.layout.variables[:rank]

    def _define(self, symbol: sp.Symbol, expr: sp.Expr) -> set[sp.Symbol]:
        """Print a definition, or the loop that its group is; returns the symbols that have their values now."""
        place = self.layout.places.get(symbol)
        if place is None:
            self.items.append(Item(f"{symbol.name} = {self.layout.text(expr, {}, self.number)}", symbol.name))
            return {symbol}
        array, group = place.array, self.layout.groups[place.array.name]
        if array.name in self.matches:
            self._loop(array, self.matches[array.name])
            return set(group.values())
        self._plain(array.entry(place.index), expr)
        if array.name in self.mirrored and self.at[symbol] == max(self.at[s] for s in group.values()):
            self._repeat(array.sizes[0], 2, True, [self._mirror(array)])
        return {symbol}

    def _mirror(self, array: Array) -> str:
        i, j = self._turn(2)
        return f"{array.entry((j, i))} = {array.entry((i, j))};"

    def _loop(self, array: Array, match: Match) -> None:
        """Print a group as a loop."""
        rank, dim = len(array.sizes), array.sizes[0]
        turn = self._turn(rank)
        targets = [array.entry(turn)] if array.name in self.local else []
        copies = [target for block in self.in_place.get(array.name, ()) for target in self._targets(block, array)]
        mirror = [self._mirror(array)] if array.name in self.mirrored else []
        if match.rest:
            self._repeat(dim, rank, array.symmetric, self._assign(targets, match, array.symmetric))
            self._diagonal(array, match, dim)
            if copies or mirror:
                self._repeat(dim, rank, array.symmetric,
                             [*mirror, *(f"{copy} = {array.entry(turn)};" for copy in copies)])
            return
        assigned = self._assign([*targets, *copies], match, array.symmetric)
        self._repeat(dim, rank, array.symmetric, [*assigned, *mirror])

    def _sorted(self, symbol: sp.Symbol, pattern: Pattern, upper: bool) -> Pattern:
        """Return the index of a symbol in a loop over pairs i <= j: of a symmetric array [i][j] stands for [j][i]."""
        both = upper and self.layout.places[symbol].array.symmetric and set(pattern) == set(self._turn(2))
        return self._turn(2) if both else pattern

    def _text(self, match: Match, upper: bool) -> str:
        patterns = {s: self._sorted(s, p, upper) for s, p in match.patterns.items()}
        return self.layout.text(match.expr, patterns, self.number)

    def _assign(self, targets: list[str], match: Match, upper: bool) -> list[str]:
        text = self._text(match, upper)
        if not upper:
            return [" = ".join([*targets, text]) + ";"]
        return [f"{targets[0]} = {text};", *(f"{target} = {targets[0]};" for target in targets[1:])]

    def _targets(self, block: Block, array: Array) -> list[str]:
        """Return the entries of an output that a turn of a group's loop writes."""
        rank = len(array.sizes)
        turn = self._turn(rank)
        if array.symmetric:
            return [block.array.entry(block.index(turn)), block.array.entry(block.index(turn[::-1]))]
        assert block.match is not None
        return [block.array.entry(block.index(turn if block.match.patterns[block.match.expr] == turn else turn[::-1]))]

    def _diagonal(self, array: Array, match: Match, dim: int) -> None:
        """Print the additional terms of entries on the diagonal."""
        i, = self._turn(1)
        found = self.layout.match({(k,): match.rest[k, k] for k in range(dim)}, dim)
        if found:
            self._repeat(dim, 1, False, [f"{array.entry((i, i))} += {self._text(found, False)};"])
            return
        for k in range(dim):
            self._plain(array.entry((k, k)), match.rest[k, k], "+=")

    def _plain(self, target: str, expr: sp.Expr, sign: str = "=") -> None:
        self.items.append(Item(f"{target} {sign} {self.layout.text(expr, {}, self.number)};"))

    def _repeat(self, dim: int, rank: int, upper: bool, lines: list[str]) -> None:
        """Print lines for each direction, each pair of them, or each pair i <= j."""
        variables = ", ".join(self.layout.variables[:rank])
        self.items.append(Item(f"{HEADS[rank, upper]}({variables}, {dim}, {' '.join(lines)})"))

    def _output(self, block: Block) -> None:
        """Print the entries of an output that no loop has written."""
        if block.match is None:
            self._plain(block.array.entry(block.index(())), block.exprs[()])
            return
        rank = len(next(iter(block.exprs)))
        turn, dim = self._turn(rank), self.layout.dim
        line = f"{block.array.entry(block.index(turn))} = {self._text(block.match, False)};"
        self._repeat(dim, rank, False, [line])
        for k in range(dim) if block.match.rest else ():
            self._plain(block.array.entry(block.index((k, k))), block.match.rest[k, k], "+=")

    def _declared(self, items: Iterable[Item], sizes: Mapping[str, str], arrays: Arrays) -> list[str]:
        """Return the declaration of the arrays that are used here first."""
        named = dict.fromkeys(name for item in items for text in (item.text, *(i.text for i in item.block))
                              for name in NAME.findall(text))
        found = []
        for name in named:
            if name not in self._known and (name in arrays.entries or sizes.get(name)):
                self._known.add(name)
                entries = arrays.entries.get(name)
                found.append(f"{name}[{len(entries)}]{sizes[entries[0]]}" if entries else name + sizes[name])
        text = f"fu_real {', '.join(found)};"
        return textwrap.wrap(text, WIDTH - 4, subsequent_indent="    ", break_long_words=False) if found else []


def _fixed(at: Index, turn: Sequence[Any]) -> list[Any]:
    """Return the index `at` for any turn."""
    return list(at)


def _kind(name: str) -> str:
    """Return a name without its numbers."""
    return re.sub(r"\d+", "#", name)
