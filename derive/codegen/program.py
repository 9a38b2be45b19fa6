"""Staged programs: the form between a symbolic derivation and a C function.

A `Program` is one kernel: inputs, then named stages of scalar definitions (each may use the inputs and every
earlier definition), then outputs. Enters: SymPy expressions. Leaves: the same, ordered and named, for
`c_printer`, `verify` (50 digits) and the operation counts.

Differentiation goes through the stages by the chain rule and never expands them: a `DirectionalDerivative` is fixed by
its value on the inputs (or on a cut of intermediate symbols) and adds its own definitions to the program.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import sympy as sp

AXES = "xyz"


@dataclass(frozen=True)
class Argument:
    """An input or output: C name, shape (() for a scalar), unit and meaning."""

    name: str
    shape: tuple[int, ...]
    unit: str
    doc: str

    @property
    def size(self) -> int:
        """Return the number of scalars in it."""
        return int(np.prod(self.shape, dtype=int))


@dataclass
class Stage:
    """A titled run of definitions, in order."""

    title: str
    definitions: list[tuple[sp.Symbol, sp.Expr]] = field(default_factory=list)


class Program:
    """One kernel under construction; see the module docstring."""

    def __init__(self, name: str, doc: str, source: str):
        self.name, self.doc, self.source = name, doc, source
        self.inputs: list[Argument] = []
        self.symbols: dict[str, np.ndarray] = {}
        self.stages: list[Stage] = []
        self.outputs: list[Argument] = []
        self.values: dict[str, np.ndarray] = {}
        self.definition: dict[sp.Symbol, sp.Expr] = {}
        self._taken: set[str] = set()

    def input(self, name: str, shape: Sequence[int] | int, unit: str, doc: str) -> np.ndarray:
        """Declare an input; returns its symbols in the given shape (a bare symbol for shape ())."""
        if name in self._taken:
            raise ValueError(f"{self.name}: the input name {name} is taken by an earlier input or definition")
        shape = (shape,) if isinstance(shape, int) else tuple(shape)
        argument = Argument(name, shape, unit, doc)
        flat = [sp.Symbol(name)] if shape == () else [sp.Symbol(f"{name}[{i}]") for i in range(argument.size)]
        self.inputs.append(argument)
        self.symbols[name] = np.array(flat, dtype=object).reshape(shape)
        self._taken.add(name)
        return flat[0] if shape == () else self.symbols[name]

    def stage(self, title: str) -> None:
        """Open a stage; the definitions that follow belong to it."""
        self.stages.append(Stage(title))

    def define(self, name: str, expr: sp.Expr, derivative_of: sp.Expr | None = None, alias: bool = False) -> sp.Expr:
        """Give an expression a name. Numbers and bare symbols need none and are returned.

        `derivative_of` is an expression that differs from this one by a constant: derivatives are taken of that one
        instead. With `alias` a bare symbol gets the name too, as at other points.
        """
        expr = sp.sympify(expr)
        if expr.is_Number or (expr.is_Symbol and not alias):
            return expr
        unique, n = name, 2
        while unique in self._taken:
            unique, n = f"{name}_{n}", n + 1
        self._taken.add(unique)
        symbol = sp.Symbol(unique)
        self.stages[-1].definitions.append((symbol, expr))
        self.definition[symbol] = expr if derivative_of is None else derivative_of
        return symbol

    def define_once(self, name: str, expr: sp.Expr) -> sp.Expr:
        """Give an expression a name; the same expression keeps the name."""
        symbol = sp.Symbol(name)
        return symbol if self.definition.get(symbol) == expr else self.define(name, expr)

    def vector(self, name: str, components: Iterable[sp.Expr], alias: bool = False) -> np.ndarray:
        """Define a vector component by component: name_x, name_y, name_z; `alias` as in `define`."""
        return np.array([self.define(f"{name}_{axis}", c, alias=alias)
                         for axis, c in zip(AXES, components, strict=False)])

    def output(self, name: str, value: Any, unit: str, doc: str) -> None:
        """Declare an output and its expressions (array_like; a scalar becomes shape (1,))."""
        if name in self._taken:
            raise ValueError(f"{self.name}: the output name {name} is taken by an input or a definition")
        value = np.atleast_1d(np.array(value, dtype=object))
        self.outputs.append(Argument(name, value.shape, unit, doc))
        self.values[name] = np.array([sp.sympify(v) for v in value.ravel()], dtype=object).reshape(value.shape)
        self._taken.add(name)

    def operations(self) -> dict[str, int]:
        """Return the arithmetic operations of one call: additions, multiplications, divisions, square roots; sines,
        cosines and exponentials where there are any. Of a choice both cases count.
        """
        exprs = [e for s in self.stages for _, e in s.definitions]
        exprs += [e for v in self.values.values() for e in v.ravel()]
        return operations_of(exprs)

    def unused(self) -> list[str]:
        """Return the names of the inputs that nothing depends on."""
        used = {s for stage in self.stages for _, e in stage.definitions for s in e.free_symbols}
        used |= {s for v in self.values.values() for e in v.ravel() for s in e.free_symbols}
        return [a.name for a in self.inputs if used.isdisjoint(np.atleast_1d(self.symbols[a.name]).ravel())]

    def prune(self) -> Program:
        """Drop definitions that no output needs; empty stages go with them."""
        needed = {s for v in self.values.values() for e in v.ravel() for s in e.free_symbols}
        for stage in reversed(self.stages):
            kept = []
            for symbol, expr in reversed(stage.definitions):
                if symbol in needed:
                    needed |= expr.free_symbols
                    kept.append((symbol, expr))
            stage.definitions = kept[::-1]
        self.stages = [s for s in self.stages if s.definitions]
        return self


def operations_of(exprs: Iterable[sp.Expr]) -> dict[str, int]:
    """Return the arithmetic operations of expressions by kind; see `Program.operations`."""
    count = dict.fromkeys(("add", "mul", "div", "sqrt"), 0)
    for expr in exprs:
        _count(expr, count)
    return count


def _count(expr: sp.Expr, count: dict[str, int]) -> None:
    if expr.is_Atom:
        return
    args = expr.args
    if expr.is_Piecewise:
        args = two_cases(expr)[:2]
    elif expr.is_Function:
        name = expr.func.__name__
        count[name] = count.get(name, 0) + 1
    elif expr.is_Add:
        count["add"] += len(args) - 1
    elif expr.is_Mul:
        args = [a for a in args if a is not sp.S.NegativeOne]
        below = [a for a in args if _is_below(a)]
        count["div"] += bool(below)
        count["mul"] += max(len(args) - len(below) - 1, 0) + max(len(below) - 1, 0)
        args = [1 / a if a in below else a for a in args]
    elif expr.is_Pow:
        count["div"] += _is_below(expr)
        exponent = abs(expr.exp)
        if exponent == sp.Rational(1, 2):
            count["sqrt"] += 1
        elif exponent.is_Integer:
            count["mul"] += int(exponent) - 1
        else:
            raise ValueError(f"a power {expr.exp} has no cheap form in C: stage it")
    for arg in args:
        _count(arg, count)


def two_cases(expr: sp.Piecewise) -> tuple[sp.Expr, sp.Expr, sp.StrictLessThan]:
    """Split "a where x < y, else b" into a, b and the condition.

    Raises ValueError for any other choice.
    """
    (below, condition), *others = expr.args
    if len(others) != 1 or others[0][1] != True or not isinstance(condition, sp.StrictLessThan):  # noqa: E712 (SymPy's)
        raise ValueError(f"{expr}: kernels choose between two cases by a < b")
    return below, others[0][0], condition


def _is_below(expr: sp.Expr) -> bool:
    """Return whether it stands below the line of a fraction."""
    return bool(expr.is_Pow and expr.exp.is_Rational and expr.exp < 0)


class DirectionalDerivative:
    """A first-order differential operator on a program, fixed by its values on some of its symbols.

    `on` gives its value there (an input, or a definition taken as independent: a cut); every other definition
    follows by the chain rule, once, under the name `<tag>_<name>`.
    """

    def __init__(self, program: Program, tag: str, on: Mapping[sp.Symbol, sp.Expr]):
        self.program, self.tag = program, tag
        self.known: dict[sp.Symbol, sp.Expr] = {s: sp.sympify(v) for s, v in on.items()}

    def __call__(self, expr: sp.Expr) -> sp.Expr:
        """Return the derivative of an expression, in terms of the program's symbols."""
        expr = sp.sympify(expr)
        total = sp.S.Zero
        for symbol in sorted(expr.free_symbols, key=lambda s: s.name):
            rate = self._of_symbol(symbol)
            if rate != 0:
                total += sp.diff(expr, symbol) * rate
        return total

    def _of_symbol(self, symbol: sp.Symbol) -> sp.Expr:
        if symbol not in self.known:
            definition = self.program.definition.get(symbol)
            rate = sp.S.Zero if definition is None else self._of_definition(symbol, definition)
            self.known[symbol] = self.program.define(f"{self.tag}_{symbol.name}", rate)
        return self.known[symbol]

    def _of_definition(self, symbol: sp.Symbol, definition: sp.Expr) -> sp.Expr:
        # roots and reciprocals reuse their own value: no second root, no power -3/2
        if definition.is_Pow and definition.exp == sp.Rational(1, 2):
            # half of each term: the twos of a sum of squares go
            half = sp.Add(*(term / 2 for term in sp.Add.make_args(self(definition.base))))
            inverse = (s for s, value in self.program.definition.items() if value == 1 / symbol)
            return half * next(inverse, 1 / symbol)
        if definition.is_Pow and definition.exp == -1:
            return -(symbol**2) * self(definition.base)
        return self(definition)

    def array(self, values: np.ndarray) -> np.ndarray:
        """Apply to every entry."""
        return np.asarray(np.vectorize(self, otypes=[object])(values))


def jacobian(program: Program, values: np.ndarray, wrt: Sequence[sp.Symbol] | np.ndarray,
             constant: Sequence[sp.Symbol] = ()) -> np.ndarray:
    """Return the partial derivatives of `values` (n,) by the symbols `wrt` (m,) taken as independent -> (n, m).

    Definitions in `constant` count as constants, whatever they depend on.
    """
    fixed = dict.fromkeys(constant, 0)
    columns = [DirectionalDerivative(program, f"d_{_plain(s)}", dict.fromkeys(wrt, 0) | {s: 1} | fixed).array(values)
               for s in wrt]
    return np.stack(columns, axis=-1)


def _plain(symbol: sp.Symbol) -> str:
    return str(symbol.name.replace("[", "").replace("]", ""))
