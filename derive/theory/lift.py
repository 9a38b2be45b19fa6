"""Vector notation of a kernel, stage by stage, from the scalar definitions of its program.

Programs define vectors component by component: name_x, name_y, name_z. Where the components of an expression are the
same but for the axis, one vector formula stands for all of them; sums over the axes become scalar products, cyclic
differences vector products. Other expressions are printed component by component.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import count
from typing import Any

import numpy as np
import sympy as sp

from ..codegen.program import Argument, Program, Stage
from .notation.from_sympy import formula, signed_sum
from .notation.tree import Binary, Equation, Matrix, Name, Node, Number, Product

AXES = "xyz"


@dataclass
class Vectors:
    """Symbols that are components of vectors, the names of both, and products that have been recognised."""

    dim: int
    component: dict[sp.Symbol, tuple[int, int]] = field(default_factory=dict)
    groups: list[tuple[Name, tuple[sp.Expr, ...]]] = field(default_factory=list)
    names: dict[sp.Symbol, Name] = field(default_factory=dict)
    products: dict[sp.Symbol, Node] = field(default_factory=dict)
    _known: dict[sp.Expr, sp.Symbol] = field(default_factory=dict)
    _count: Iterator[int] = field(default_factory=count)

    def add(self, name: Name, components: Sequence[sp.Expr]) -> None:
        """Take symbols as the components of a vector; numbers among them are left as they are."""
        self.groups.append((name, tuple(components)))
        for axis, symbol in enumerate(components):
            if symbol.is_Symbol and symbol not in self.component:
                self.component[symbol] = len(self.groups) - 1, axis
                self.names.setdefault(symbol, Name(name.base, accent=name.accent, sub=(*name.sub, AXES[axis]),
                                                         primes=name.primes))

    def axes_of(self, expr: sp.Expr) -> set[int]:
        """Return the axes of the components in an expression."""
        return {self.component[s][1] for s in expr.free_symbols if s in self.component}

    def turned(self, expr: sp.Expr, axes: dict[int, int]) -> sp.Expr | None:
        """Return an expression with components along other axes; None where a vector has no symbol there."""
        table = {}
        for s in expr.free_symbols:
            if s in self.component:
                group, axis = self.component[s]
                if axes[axis] >= len(self.groups[group][1]):
                    return None
                other = self.groups[group][1][axes[axis]]
                table[s] = other
        return expr.xreplace(table)

    def product(self, node: Node, key: sp.Expr) -> sp.Symbol:
        """Return the symbol that stands for a product of vectors."""
        if key not in self._known:
            self._known[key] = sp.Symbol(f"product{next(self._count)}", real=True)
            self.products[self._known[key]] = node
        return self._known[key]

    def node(self, symbol: sp.Symbol) -> Node:
        """Return what stands for a symbol in a formula."""
        return self.products.get(symbol) or self.names.get(symbol) or scalar_name(symbol.name)


def scalar_name(text: str) -> Name:
    """Return the quantity of a name in a program: what follows the first underscore is subscripts."""
    primes, accent = 0, ""
    while text.startswith(("ds_", "dt_")):
        primes, accent = (primes + 1, accent) if text.startswith("ds_") else (primes, "d" * bool(accent) + "dot")
        text = text[3:]
    base, *sub = text.replace("[", "_").replace("]", "").split("_")
    base = {"eps": "varepsilon", "sdot": "s"}.get(base, base)
    accent = "dot" if text == "sdot" else accent
    letter = base.rstrip("0123456789")
    if letter != base and len(letter) == 2 and letter[0] == "d":
        letter, accent = letter[1], "dot"
    if letter and letter != base and (len(letter) == 1 or letter in ("chord", "mean")):
        sub.insert(0, base.removeprefix("d" if accent and base[0] == "d" else "")[len(letter):])
        base = letter
    return Name(base, accent=accent, sub=tuple(s for s in sub if s), primes=primes)


def vector_name(text: str) -> Name:
    """Return the quantity of a vector of a program."""
    plain = scalar_name(text)
    return Name(plain.base, bold=True, accent=plain.accent, sub=plain.sub, primes=plain.primes)


def only(program: Program, *outputs: str) -> Program:
    """Return a program with some of its outputs, and with what these need."""
    part = Program(program.name, program.doc, program.source)
    part.inputs, part.symbols, part.definition = program.inputs, program.symbols, program.definition
    part.stages = [Stage(s.title, list(s.definitions)) for s in program.stages]
    part.outputs = [a for a in program.outputs if a.name in outputs]
    part.values = {a.name: program.values[a.name] for a in part.outputs}
    return part.prune()


class Lift:
    """A program in vector notation."""

    def __init__(self, program: Program, dim: int):
        self.program, self.vectors = program, Vectors(dim)
        for argument in program.inputs:
            self._input(argument)

    def _input(self, argument: Argument) -> None:
        """Name the vectors of an input: itself, or its rows; the columns of a matrix of axes."""
        dim, symbols = self.vectors.dim, np.atleast_1d(self.program.symbols[argument.name])
        if argument.shape == (dim,) and "," not in argument.unit:  # entries of one unit
            self.vectors.add(vector_name(argument.name), tuple(symbols))
        elif argument.name in ("A1", "A2"):
            for k in range(dim):
                self.vectors.add(Name(AXES[k], bold=True, sub=(argument.name[1:],)), tuple(symbols[:, k]))
        elif len(argument.shape) == 2 and argument.shape[1] == dim:
            for k, row in enumerate(symbols):
                whole = vector_name(argument.name)
                self.vectors.add(Name(whole.base, True, whole.accent, (*whole.sub, str(k + 1))), tuple(row))

    # --- stages ---------------------------------------------------------------------------------------------

    def stages(self) -> Iterator[tuple[str, list[Equation]]]:
        """Yield the title of each stage with its equations."""
        for stage in self.program.stages:
            equations = []
            for symbols, exprs, name in self._grouped(stage.definitions):
                if len(symbols) == 1:
                    left: Node = self.vectors.node(symbols[0])
                    equations.append(Equation((left, self.scalar(exprs[0]))))
                else:
                    equations.append(Equation((name, self.vector(exprs))))
                    self.vectors.add(name, symbols)
            yield stage.title, equations

    def _grouped(self, definitions: Sequence[tuple[sp.Symbol, sp.Expr]],
                 ) -> Iterator[tuple[tuple[Any, ...], tuple[Any, ...], Name]]:
        """Yield definitions, those of name_x, name_y, name_z together."""
        at, dim = 0, self.vectors.dim
        while at < len(definitions):
            symbol, expr = definitions[at]
            stem = symbol.name.removesuffix("_x")
            run = definitions[at: at + dim]
            if stem != symbol.name and [s.name for s, _ in run] == [f"{stem}_{a}" for a in AXES[:dim]]:
                yield tuple(s for s, _ in run), tuple(e for _, e in run), vector_name(stem)
                at += dim
            else:
                yield (symbol,), (expr,), scalar_name(symbol.name)
                at += 1

    def outputs(self) -> list[tuple[str, Equation]]:
        """Return a formula for each output, by its name."""
        found = []
        for argument in self.program.outputs:
            values = self.program.values[argument.name]
            left = Name(argument.name if len(argument.name) == 1 else argument.name.partition("_")[0],
                        bold=values.size > 1, sub=("out", *argument.name.split("_")[1:]))
            found.append((argument.name, Equation((left, self._output(values)))))
        return found

    def _output(self, values: np.ndarray) -> Node:
        dim = self.vectors.dim
        if values.size == 1:
            return self.scalar(values.item())
        if values.shape == (dim,):
            return self.vector(tuple(values))
        if values.shape == (dim, dim):
            return Matrix((tuple(self.vector(tuple(column)) for column in values.T),))
        if values.ndim == 2 and values.shape[1] == dim:  # nodal vectors, one below the other
            return Matrix(tuple((self.vector(tuple(row)),) for row in values))
        if values.ndim == 2 and values.shape[0] == dim:
            return Matrix((tuple(self.vector(tuple(column)) for column in values.T),))
        rows = values if values.ndim == 2 else values[:, None]
        return Matrix(tuple(tuple(self.scalar(v) for v in row) for row in rows))

    # --- scalars --------------------------------------------------------------------------------------------

    def scalar(self, expr: sp.Expr) -> Node:
        """Return the formula of a number, sums over axes as scalar products."""
        return formula(self.contracted(sp.sympify(expr)), self.vectors.node)

    def contracted(self, expr: sp.Expr) -> sp.Expr:
        """Return an expression with symbols for the scalar products in it."""
        if expr.is_Atom or not self.vectors.axes_of(expr):
            return expr
        args = [self.contracted(arg) for arg in expr.args]
        if not expr.is_Add:
            return expr.func(*args)
        return sp.Add(*self._contract_terms(args))

    def _contract_terms(self, terms: list[sp.Expr]) -> list[sp.Expr]:
        dim, waiting, done = self.vectors.dim, list(terms), []
        while waiting:
            term = waiting.pop(0)
            if self.vectors.axes_of(term) != {0}:
                done.append(term)
                continue
            others = [self.vectors.turned(term, {0: axis}) for axis in range(1, dim)]
            product = self._dot(term) if all(o is not None and o in [*waiting, *done] for o in others) else None
            if product is None:
                done.append(term)
                continue
            for other in others:
                (waiting if other in waiting else done).remove(other)
            done.append(product)
        return done

    def _dot(self, term: sp.Expr) -> sp.Expr | None:
        """Return a term along x, which stands for the sum over the axes, with a symbol for its scalar product."""
        scale, factors = sp.S.One, []
        for factor in sp.Mul.make_args(term):
            if not self.vectors.axes_of(factor):
                scale *= factor
            elif factor.is_Pow and factor.exp == 2:
                factors += [factor.base, factor.base]
            else:
                factors.append(factor)
        if len(factors) != 2:
            return None
        vectors = [self._linear(f) for f in factors]
        if None in vectors:
            return None
        left, right = (v for v in vectors if v is not None)
        return scale * self.vectors.product(Binary("cdot", left, right), factors[0] * factors[1])

    # --- vectors --------------------------------------------------------------------------------------------

    def vector(self, exprs: Sequence[sp.Expr]) -> Node:
        """Return the formula of a vector from its components; a column of them where they do not lift."""
        parts = [self.contracted(sp.sympify(e)) for e in exprs]
        lifted = self._lifted(parts)
        if lifted is not None:
            return lifted
        return Matrix(tuple((formula(p, self.vectors.node),) for p in parts))

    def _lifted(self, parts: list[sp.Expr]) -> Node | None:
        turns = [{0: a, 1: (a + 1) % 3, 2: (a + 2) % 3} for a in range(3)]
        first = parts[0]
        if self.vectors.dim == 3:
            turned = [self.vectors.turned(first, turns[axis]) for axis in range(1, 3)]
        else:
            if self.vectors.axes_of(first) - {0}:
                return None
            turned = [self.vectors.turned(first, {0: 1})]
        if any(t is None or sp.expand(t - p) != 0 for t, p in zip(turned, parts[1:], strict=True)):
            return None
        return self._linear(first)

    def _linear(self, first: sp.Expr) -> Node | None:
        """Return a vector from its component along x: a sum of scaled vectors and of vector products."""
        if first.is_Symbol and first in self.vectors.component:
            group, axis = self.vectors.component[first]
            return self.vectors.groups[group][0] if axis == 0 else None
        if first.is_Mul:
            inner = [f for f in first.args if self.vectors.axes_of(f)]
            if len(inner) == 1 and inner[0].is_Add:
                vector = self._linear(inner[0])
                return None if vector is None else self._scaled(first / inner[0], vector)
        terms: list[tuple[int, Node]] = []
        waiting = list(first.as_ordered_terms() if first.is_Add else [first])
        while waiting:
            term = waiting.pop(0)
            axes = self.vectors.axes_of(term)
            found = self._along(term) if axes == {0} else self._cross(term, waiting) if axes == {1, 2} else None
            if found is None:
                return None
            terms.append(found)
        terms.sort(key=lambda pair: pair[0] < 0)
        return signed_sum(terms)

    def _along(self, term: sp.Expr) -> tuple[int, Node] | None:
        inner = [f for f in sp.Mul.make_args(term) if self.vectors.axes_of(f)]
        if len(inner) != 1 or inner[0].is_Pow:
            return None
        vector = self._linear(inner[0]) if inner[0].is_Symbol or inner[0].is_Add else None
        if vector is None:
            return None
        return self._signed(term / inner[0], vector)

    def _cross(self, term: sp.Expr, waiting: list[sp.Expr]) -> tuple[int, Node] | None:
        """Return scale (a x b) of a term scale a_y b_z, whose partner -scale a_z b_y is taken from those that wait."""
        other = self.vectors.turned(term, {1: 2, 2: 1})
        if other is None or -other not in waiting:
            return None
        inner = [f for f in sp.Mul.make_args(term) if self.vectors.axes_of(f)]
        if len(inner) != 2 or {tuple(self.vectors.axes_of(f)) for f in inner} != {(1,), (2,)}:
            return None
        waiting.remove(-other)
        y, z = sorted(inner, key=lambda f: min(self.vectors.axes_of(f)))
        along = [self.vectors.turned(y, {1: 0}), self.vectors.turned(z, {2: 0})]
        vectors = [None if a is None else self._linear(a) for a in along]
        if None in vectors:
            return None
        left, right = (v for v in vectors if v is not None)
        scale = term / (y * z)
        if scale.could_extract_minus_sign():
            left, right, scale = right, left, -scale
        return self._signed(scale, Binary("times", left, right))

    def _signed(self, scale: sp.Expr, vector: Node) -> tuple[int, Node]:
        if scale.could_extract_minus_sign():
            return -1, self._scaled(-scale, vector)
        return 1, self._scaled(scale, vector)

    def _scaled(self, scale: sp.Expr, vector: Node) -> Node:
        if scale == 1:
            return vector
        front = formula(scale, self.vectors.node)
        if front == Number("1"):
            return vector
        factors = front.factors if isinstance(front, Product) else (front,)
        return Product((*factors, vector))
