"""The document as data: chapters with their formulas parsed, each with the kernel output that it is."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from .markdown import Block, Line, blocks
from .notation.evaluate import Definitions, Value
from .notation.jet import plain
from .notation.latex import latex
from .notation.parse import FormulaError, parse
from .notation.tree import Equation, Name, Node
from .printed import PRINTERS as GENERAL
from .printed_bodies import BODY_PRINTERS
from .printed_laws import LAW_PRINTERS
from .proofs import PROOFS, Proof
from .scopes import Scope, compiled, ends_of, programs_of, scope
from .staged import staged_scope

PRINTERS = GENERAL | LAW_PRINTERS | BODY_PRINTERS
"""What makes the formulas of a ```print by its name."""
DERIVE = Path(__file__).parents[1]


@dataclass
class Formula:
    """One displayed formula: its tree, whether it defines, holds or is only shown, and the kernel output that it is.

    deviation is the largest difference from the compiled kernel, or between its sides, relative to the largest entry,
    over the sample states; None before it is evaluated, and where it is only shown.
    """

    identifier: str
    tree: Node
    line: Line
    deviation: float | None = None

    @property
    def kernel(self) -> tuple[str, str] | None:
        """Return kernel and output, without the family's name."""
        if not self.line.output:
            return None
        kernel, _, output = self.line.output.removeprefix("-").partition(".")
        return kernel, output

    @property
    def sign(self) -> int:
        """Return -1 where the kernel gives minus what the formula says."""
        return -1 if self.line.output.startswith("-") else 1


@dataclass
class Item:
    """A block of the document in its scope; a formula block has formulas, a proof its numbers."""

    block: Block
    scope: Scope | None = None
    formulas: list[Formula] = field(default_factory=list)
    proof: Proof | None = None
    opens_scope: bool = False


@dataclass
class Document:
    """A title and the items in order."""

    title: str
    lead: str
    items: list[Item] = field(default_factory=list)

    def formulas(self) -> Iterator[tuple[Item, Formula]]:
        """Yield every formula with its item."""
        for item in self.items:
            for formula in item.formulas:
                yield item, formula


@cache
def text_of(chapter: str) -> str:
    """Return the text of a chapter, a file below derive/."""
    return (DERIVE / f"{chapter}.md").read_text(encoding="utf-8")


class Composer:
    """Makes a document from chapters; `families` says which family a role of a scope stands for."""

    def __init__(self, title: str, lead: str, prefix: str = "f"):
        self.document = Document(title, lead)
        self._prefix, self._count = prefix, 0
        self._scope: Scope | None = None

    def add(self, chapter: str, families: dict[str, str]) -> None:
        """Append a chapter."""
        self.add_text(text_of(chapter), families, chapter)

    def add_text(self, text: str, families: dict[str, str], where: str = "") -> None:
        """Append the text of a chapter. Raises FormulaError, with the chapter, for a formula that cannot be read."""
        for block in blocks(text):
            try:
                self._block(block, families)
            except FormulaError as problem:
                raise FormulaError(f"{where}: {problem}") from None

    def _block(self, block: Block, families: dict[str, str]) -> None:
        item = Item(block, self._scope)
        if block.kind == "scope":
            self._scope = item.scope = scope(block.about, families[block.about])
            item.opens_scope = True
        elif block.kind == "formula":
            item.formulas = [self._formula(expanded(line, self._scope)) for line in block.lines]
        elif block.kind in ("print", "print-folded"):
            assert self._scope is not None
            name, *about = block.about.split()
            item.formulas = [self._formula(line) for line in PRINTERS[name](self._scope)]
            if not item.formulas:
                self._nothing(self._scope)
                return
            folded = block.kind == "print-folded"
            item.block = Block("formula-folded" if folded else "formula", text=" ".join(about).replace("_", " "),
                               about="" if folded else " ".join(about))
        elif block.kind == "staged":
            self._staged(block)
            return
        elif block.kind == "proof":
            item.proof = PROOFS[block.about]()
        self.document.items.append(item)

    def _nothing(self, here: Scope) -> None:
        """Say whose kernels a family has where it has none of its own."""
        if here.family.shared:
            other = next(iter(here.family.shared.values()))
            self.document.items.append(Item(Block("paragraph", f"The kernels are those of `{other}`."), here))

    def _staged(self, block: Block) -> None:
        """Append a kernel stage by stage, in a scope of its own names."""
        assert self._scope is not None
        kernel, *outputs = block.about.split()
        own, stages = staged_scope(self._scope, kernel, tuple(outputs))
        for k, (title, lines) in enumerate(stages):
            item = Item(Block("stage", title), own, [self._formula(line) for line in lines], opens_scope=k == 0)
            self.document.items.append(item)

    def _formula(self, line: Line) -> Formula:
        self._count += 1
        return Formula(f"{self._prefix}{self._count}", parse(line.latex), line)


COLUMNS = re.compile(r"@(q|qs)\{(.*?)\}@")


def expanded(line: Line, scope: Scope | None) -> Line:
    """Return a line with @q{X}@ written out: the derivatives of X by the coordinates of cable and rider, side by side.

    @qs{X}@ has the one by s, too. A rider that is a point does not turn.
    """
    if scope is None or "@" not in line.latex:
        return line
    turns = [] if scope.family.rider in ("point", "planar_point") else [r"\boldsymbol{\theta}"]

    def columns(found: re.Match[str]) -> str:
        by = [r"\mathbf{e}", *ends_of(scope.family), r"\mathbf{R}", *turns, *(["s"] if found[1] == "qs" else [])]
        return (r"\begin{bmatrix} " + " & ".join(rf"\frac{{\partial {found[2]}}}{{\partial {q}}}" for q in by)
                + r" \end{bmatrix}")

    return replace(line, latex=COLUMNS.sub(columns, line.latex))


# --- what the formulas say --------------------------------------------------------------------------------------


def evaluate(document: Document, trees: dict[str, Node] | None = None) -> dict[str, float]:
    """Return the deviation of each formula that can be evaluated, by its identifier; largest over the samples.

    trees takes the place of the document's own formulas: those that were read back from its emitted text.
    """
    return _evaluated(document, trees)[0]


def unused(document: Document) -> list[str]:
    """Return the formulas that no comparison with a kernel depends on, so that nothing checks them."""
    return _evaluated(document, None)[1]


def _evaluated(document: Document, trees: dict[str, Node] | None) -> tuple[dict[str, float], list[str]]:
    """Return the deviations as `evaluate` does, and the formulas that `unused` returns."""
    found: dict[str, float] = {}
    unchecked: list[str] = []
    for items in _by_scope(document):
        here = items[0].scope
        if here is None:
            continue
        formulas = [(f, trees[f.identifier] if trees else f.tree)
                    for item in items for f in item.formulas if f.line.kind != "shown"]
        definitions = _definitions(here, formulas)
        deviations = _deviations(here, definitions, formulas)
        found |= deviations
        unchecked += [f.line.latex for f, tree in formulas
                      if f.identifier not in deviations and not _is_used(tree, definitions)]
    return found, unchecked


def _definitions(here: Scope, formulas: list[tuple[Formula, Node]]) -> Definitions:
    """Return the definitions of a scope, with those that its formulas add."""
    definitions = here.definitions()
    for formula, tree in formulas:
        if formula.line.kind == "definition" and isinstance(tree, Equation) and isinstance(tree.sides[0], Name):
            definitions.add(tree, formula.line.index)
    return definitions


def _deviations(here: Scope, definitions: Definitions, formulas: list[tuple[Formula, Node]]) -> dict[str, float]:
    """Return the largest deviation over the states of a scope of each formula that can be compared."""
    found: dict[str, float] = {}
    for state in here.states:
        value = here.evaluation(definitions, state)
        for formula, tree in formulas:
            deviation = _deviation(formula, tree, value, here, state)
            if deviation is not None:
                found[formula.identifier] = max(found.get(formula.identifier, 0.0), deviation)
    return found


def _is_used(tree: Node, definitions: Definitions) -> bool:
    """Return whether an evaluation has asked for what a formula defines."""
    return isinstance(tree, Equation) and isinstance(tree.sides[0], Name) and tree.sides[0].key in definitions.used


def _by_scope(document: Document) -> Iterator[list[Item]]:
    found: list[Item] = []
    for item in document.items:
        if item.opens_scope and found:
            yield found
            found = []
        found.append(item)
    if found:
        yield found


def _deviation(formula: Formula, tree: Node, value: Callable[[Node], Any], here: Scope, state: Any) -> float | None:
    if formula.kernel and formula.kernel[0] in programs_of(here.family.name):
        sides = tree.sides if isinstance(tree, Equation) else (tree,)
        kernel, output = formula.kernel
        expected = formula.sign * compiled(here.family.name, kernel, state)[output]
        return max(difference(floats(value(side)), expected) for side in sides[-1:])
    if formula.line.kind == "holds":
        assert isinstance(tree, Equation)
        first, *others = (floats(value(side)) for side in tree.sides)
        return max(difference(other, first, floor=1.0) for other in others)
    return None


def floats(value: Value) -> np.ndarray:
    """Return numbers without derivatives, flat, row by row."""
    return np.array([plain(v) for v in np.atleast_1d(np.array(value, dtype=object)).ravel()])


def difference(found: np.ndarray, expected: np.ndarray, floor: float = 0.0) -> float:
    """Return the largest difference over the largest entry; infinite where the sizes differ or a number is none."""
    expected = np.asarray(expected, dtype=float).ravel()
    if found.size == 1 and expected.size > 1:  # a zero or a one that stands for a matrix
        found = np.full(expected.size, found.item())
    if found.size != expected.size or not np.all(np.isfinite(found)):
        return float("inf")
    scale = max(float(np.max(np.abs(expected), initial=0.0)), floor)
    error = float(np.max(np.abs(found - expected), initial=0.0))
    return error / scale if scale else error


__all__ = ["Composer", "Document", "Formula", "Item", "evaluate", "latex"]
