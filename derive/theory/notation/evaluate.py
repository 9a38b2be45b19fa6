"""The value of formulas: definitions by name, evaluated when they are asked for, differentiated as they are written."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import reduce
from typing import Any

import numpy as np

from . import jet
from .jet import plain
from .tree import (
    At,
    Binary,
    Call,
    Cases,
    Derivative,
    Equation,
    Fraction,
    Integral,
    Matrix,
    Name,
    Node,
    Number,
    Power,
    Product,
    Root,
    Series,
    Size,
    Skew,
    Sum,
    Transpose,
)

AXES = "xyz"
Value = Any
"""A number, or a matrix (2-D array); vectors are columns."""
POINTS = {"x": 6, "y": 3, "z": 3}
"""Of the Gauss rules by which integrals are evaluated: exact for the squares of all shape functions and of all strains
of a solid."""


class UndefinedError(LookupError):
    """A formula uses a quantity that nothing before it defines."""


@dataclass
class Definitions:
    """What each name stands for: formulas by key, families of them by an index, inputs that are made of blocks.

    `used` fills with the keys of what an evaluation has asked for.
    """

    by_key: dict[str, Node] = field(default_factory=dict)
    families: list[tuple[Name, str, Node]] = field(default_factory=list)
    blocks: dict[str, int] = field(default_factory=dict)
    used: set[str] = field(default_factory=set)

    def add(self, equation: Equation, index: str = "") -> None:
        """Take an equation as the definition of its left side; with an index, for each of its values."""
        name, value = equation.sides[0], equation.sides[-1]
        if not isinstance(name, Name):
            raise TypeError(f"the left side of {equation} is no quantity")
        if index:
            self.families.append((name, index, value))
        else:
            self.by_key[name.key] = value


class Evaluation:
    """Values of names in one setting: inputs, indices of sums, what is differentiated by."""

    def __init__(self, definitions: Definitions, values: Mapping[str, Value], indices: Mapping[str, int] | None = None,
                 level: int = 0, known: dict[str, Value] | None = None):
        self.definitions, self.values, self.level = definitions, dict(values), level
        self.indices = dict(indices or {})
        self.known: dict[str, Value] = {} if known is None else known

    def with_values(self, more: Mapping[str, Value], deeper: int = 0) -> Evaluation:
        """Return a setting where some quantities have other values."""
        return Evaluation(self.definitions, self.values | dict(more), self.indices, self.level + deeper)

    def with_indices(self, indices: Mapping[str, int]) -> Evaluation:
        """Return a setting where indices have these values, with the same values of names."""
        return Evaluation(self.definitions, self.values, indices, self.level, self.known)

    # --- names --------------------------------------------------------------------------------------------------

    def resolved(self, name: Name) -> Name:
        """Return a name with the values of the indices in its subscripts."""
        sub = tuple(str(self.indices.get(s, s)) for s in name.sub)
        return Name(name.base, name.bold, name.accent, sub, name.primes, name.above)

    def name(self, written: Name) -> Value:
        """Return the value of a quantity: an input, a block of one, a definition, a member of a family."""
        if written.base in self.indices and written == Name(written.base):
            return float(self.indices[written.base])
        name = self.resolved(written)
        key = name.key
        if key in self.values:
            return self.values[key]
        if key not in self.known:
            self.known[key] = self._found(name)
        return self.known[key]

    def _found(self, name: Name) -> Value:
        if name.key in self.definitions.by_key:
            self.definitions.used.add(name.key)
            return self.with_indices({})(self.definitions.by_key[name.key])
        whole = Name(name.base, name.bold, name.accent, name.sub[:-1], name.primes, name.above)
        if name.sub and name.sub[-1].isdigit() and whole.key in self.definitions.blocks:
            size, k = self.definitions.blocks[whole.key], int(name.sub[-1])
            return self.name(whole)[size * (k - 1): size * k]
        if name.sub and name.sub[-1] in AXES and not name.bold:  # a component of a vector
            vector = Name(name.base, True, name.accent, name.sub[:-1], name.primes, name.above)
            return self.name(vector)[AXES.index(name.sub[-1]), 0]
        for member, index, value in self.definitions.families:
            found = _index_of(member, name, index)
            if found is not None:
                self.definitions.used.add(member.key)
                return self.with_indices({index: found})(value)
        raise UndefinedError(f"nothing defines {name.key}")

    # --- formulas -----------------------------------------------------------------------------------------------

    def __call__(self, node: Node) -> Value:
        """Return the value of a formula."""
        match node:
            case Number():
                return float(node.text)
            case Name():
                return self.name(node)
            case Sum():
                return reduce(_add, (self(term) if sign > 0 else _times(-1.0, self(term))
                                     for sign, term in node.terms))
            case Product():
                return reduce(_times, (self(f) for f in node.factors))
            case Binary():
                return _BINARY[node.sign](self(node.left), self(node.right))
            case Fraction():
                below = self(node.below)
                return _times(1.0 / below, self(node.above))
            case Power():
                return _power(self(node.base), node.exponent)
            case Transpose() | Root() | Size() | Skew():
                return _OF_ONE[type(node)](self(node.of))
            case Matrix():
                return _block([[self(entry) for entry in row] for row in node.rows])
            case _:
                return self._large(node)

    def _large(self, node: Node) -> Value:
        match node:
            case Call():
                return _CALLS[node.name](self(node.of))
            case Cases():
                return self(node.below if plain(self(node.left)) < plain(self(node.right)) else node.other)
            case Derivative():
                return self._derivative(node)
            case At():
                return self.with_values({self.resolved(name).key: self(value) for name, value in node.changes})(node.of)
            case Series():
                first, last = (round(plain(self(bound))) for bound in (node.first, node.last))
                return reduce(_add, (self.with_indices(self.indices | {node.index: k})(node.of)
                                     for k in range(first, last + 1)))
            case Integral():
                return self._integral(node)
        raise TypeError(f"no value of {node!r}")

    def _derivative(self, node: Derivative) -> Value:
        name = self.resolved(node.by)
        here = self.name(name)
        column = here if isinstance(here, np.ndarray) else np.array([[here]], dtype=object)
        moved = jet.seeded(self.level + 1, column)
        value: Any = moved if isinstance(here, np.ndarray) else moved.item()
        of = node.of
        if node.order > 1:
            of = Derivative(node.of, node.by, node.order - 1, node.partial)
        f = self.with_values(self._replaced(name, value), deeper=1)(of)
        n = column.size
        slopes = [jet.slope_of(entry, self.level + 1, n) for entry in np.atleast_1d(f).ravel()]
        if not isinstance(here, np.ndarray):
            flat = [s[0] for s in slopes]
            return np.array(flat, dtype=object).reshape(f.shape) if isinstance(f, np.ndarray) else flat[0]
        return np.array(slopes, dtype=object).reshape(len(slopes), n)

    def _replaced(self, name: Name, value: Value) -> dict[str, Value]:
        """Return what takes the place of a quantity; of a block the whole of which it is part."""
        whole = Name(name.base, name.bold, name.accent, name.sub[:-1], name.primes, name.above)
        if name.key in self.values or not (name.sub and whole.key in self.definitions.blocks):
            return {name.key: value}
        size, k = self.definitions.blocks[whole.key], int(name.sub[-1])
        moved = np.array(self.name(whole), dtype=object)
        moved[size * (k - 1): size * k] = value
        return {whole.key: moved}

    def _integral(self, node: Integral) -> Value:
        axes = {"V": "xyz", "A": "yz", "l": "x"}[node.over]
        total: Value = None
        for place, weight in self._places(axes):
            value = _times(weight, self.with_values(place)(node.of))
            total = value if total is None else _add(total, value)
        return total

    def _places(self, axes: str) -> Sequence[tuple[dict[str, Value], Value]]:
        """Return Gauss points of a bar of rectangular section h (along y) times b (along z), and their weights."""
        found: list[tuple[dict[str, Value], Value]] = [({}, 1.0)]
        for axis in axes:
            nodes, weights = np.polynomial.legendre.leggauss(POINTS[axis])
            length = self.name(Name({"x": "l", "y": "h", "z": "b"}[axis]))
            middle = 1.0 if axis == "x" else 0.0
            rule = list(zip(nodes.tolist(), weights.tolist(), strict=True))
            found = [(place | {axis: length * (middle + node) / 2}, weight * (length * w / 2))
                     for place, weight in found for node, w in rule]
        return found


def _index_of(member: Name, name: Name, index: str) -> int | None:
    """Return the value of the index for which a member of a family has this name."""
    same = Name(member.base, name.bold, member.accent, name.sub, member.primes, member.above)
    if same != name or len(member.sub) != len(name.sub):
        return None
    found = None
    for pattern, given in zip(member.sub, name.sub, strict=True):
        if pattern == index and given.isdigit():
            found = int(given)
        elif pattern != given:
            return None
    return found


# --- numbers and matrices ---------------------------------------------------------------------------------------


def _collapsed(value: Value) -> Value:
    return value[0, 0] if isinstance(value, np.ndarray) and value.size == 1 else value


def _add(a: Value, b: Value) -> Value:
    return _collapsed(a) + _collapsed(b)


def _times(a: Value, b: Value) -> Value:
    a, b = _collapsed(a), _collapsed(b)
    if isinstance(a, np.ndarray) and isinstance(b, np.ndarray):
        return _collapsed(a @ b)
    return a * b


def _dot(a: Value, b: Value) -> Value:
    a, b = _collapsed(a), _collapsed(b)
    if isinstance(a, np.ndarray) and isinstance(b, np.ndarray):
        return sum((x * y for x, y in zip(a.ravel(), b.ravel(), strict=True)), 0.0)
    return a * b


def _cross(a: Value, b: Value) -> Value:
    """Vector product; in the plane of a number and a vector, or of two vectors to a number."""
    a, b = _collapsed(a), _collapsed(b)
    if not isinstance(a, np.ndarray):
        return np.array([[-a * b[1, 0]], [a * b[0, 0]]], dtype=object)
    if a.size == 2:
        return a[0, 0] * b[1, 0] - a[1, 0] * b[0, 0]
    return skew(a) @ b


def _kron(a: Value, b: Value) -> Value:
    a, b = (np.atleast_2d(np.array(v, dtype=object)) for v in (a, b))
    return np.block([[entry * b for entry in row] for row in a])


def skew(v: Value) -> np.ndarray:
    """Return v~ with v~ u = v x u; of a number, the quarter turn of the plane times it."""
    v = _collapsed(v)
    if not isinstance(v, np.ndarray):
        return np.array([[0.0, -v], [v, 0.0]], dtype=object)
    x, y, z = v.ravel()
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]], dtype=object)


def _axial(m: np.ndarray) -> Value:
    """Return the vector that is a x b of a b', and linear in the matrix; in the plane a number."""
    if m.shape == (2, 2):
        return m[0, 1] - m[1, 0]
    return np.array([[m[1, 2] - m[2, 1]], [m[2, 0] - m[0, 2]], [m[0, 1] - m[1, 0]]], dtype=object)


def _trace(m: Value) -> Value:
    return sum((m[k, k] for k in range(len(m))), 0.0) if isinstance(m, np.ndarray) else m


def _size(v: Value) -> Value:
    return jet.sqrt(_dot(v, v))


def _block(rows: list[list[Value]]) -> np.ndarray:
    return np.block([[np.atleast_2d(np.array(v, dtype=object)) for v in row] for row in rows])


def _power(base: Value, exponent: int) -> Value:
    """Return a power of a number; of a matrix the inverse, its only power in formulas. Raises TypeError."""
    base = _collapsed(base)
    if not isinstance(base, np.ndarray):
        return base**exponent
    if exponent != -1 or base.shape[0] != base.shape[1]:
        raise TypeError(f"no power {exponent} of a matrix of {base.shape[0]} by {base.shape[1]}")
    return _inverse(base)


def _transpose(value: Value) -> Value:
    return value.T if isinstance(value, np.ndarray) else value


def _inverse(m: np.ndarray) -> np.ndarray:
    """Return the inverse of a matrix of up to three rows by its adjugate."""
    if len(m) == 2:
        adjugate = np.array([[m[1, 1], -m[0, 1]], [-m[1, 0], m[0, 0]]], dtype=object)
    else:
        a, b, c = (m[:, k:k + 1] for k in range(3))
        adjugate = np.concatenate([_cross(b, c), _cross(c, a), _cross(a, b)], axis=1).T
    return np.asarray(adjugate * (1.0 / _dot(adjugate[0], m[:, 0])))


_OF_ONE: dict[type[Node], Callable[[Value], Value]] = {Transpose: _transpose, Root: jet.sqrt, Size: _size, Skew: skew}
_BINARY = {"cdot": _dot, "times": _cross, "otimes": _kron}
_CALLS = {"sin": jet.sin, "cos": jet.cos, "axial": _axial, "tr": _trace}
