"""Discrete derivatives: finite differences of staged expressions between two states, in closed form.

With mean x~ = (x0 + x1)/2 and difference dx = x1 - x0,

    d(x + y) = dx + dy,   d(x y) = x~ dy + y~ dx,   d(1/x) = -dx/(x0 x1),   d(sqrt x) = dx/(sqrt x0 + sqrt x1),
    d(integral of a function by segments) = its mean from x0 to x1 dx

hold exactly, divide by no difference, are symmetric in 0 and 1, and equal the derivative where the two states coincide.
Carried through a law's stages they give D with U1 - U0 = sum D dI over its invariants I: the discrete
gradient of an energy-momentum scheme (Gonzalez, J. Nonlinear Sci. 6 (1996) 449-467).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import sympy as sp

from ..codegen.piecewise import CubicIntegral, CubicMean
from ..codegen.program import Program

STATES = ("now", "next")


class DiscreteGradient:
    """The values at two states of a law staged in the program `law`; `program` takes the definitions.

    inputs: for each input symbol of `law` that differs between the states, its two values; others are the same.
    """

    def __init__(self, program: Program, law: Program, inputs: dict[sp.Symbol, tuple[sp.Expr, sp.Expr]]):
        self.program = program
        self._moves = law.definition
        self._pairs: dict[sp.Symbol, tuple[sp.Expr, sp.Expr]] = dict(inputs)
        for stage in law.stages:
            program.stage(stage.title)
            for symbol, expr in stage.definitions:
                self._pairs[symbol] = self._both(symbol.name, expr)

    def _both(self, name: str, expr: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
        now, then = self.pair(expr)
        if now == then:
            value = self.program.define(name, now)
            return value, value
        return tuple(self.program.define(f"{state}_{name}", value)
                     for state, value in zip(STATES, (now, then), strict=True))

    def pair(self, expr: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
        """Return the values of an expression at the two states."""
        expr = sp.sympify(expr)
        known = [(s, self._pairs[s]) for s in expr.free_symbols if s in self._pairs]
        return tuple(expr.xreplace({s: pair[k] for s, pair in known}) for k in (0, 1))

    def mean(self, expr: sp.Expr) -> sp.Expr:
        """Return half the sum of the values of an expression at the two states."""
        now, then = self.pair(expr)
        return now if now == then else (now + then) / 2

    def means(self, name: str, vector: np.ndarray) -> np.ndarray:
        """Return a vector of mean values."""
        return self.program.vector(name, [self.mean(x) for x in vector])

    def gradient(self, expr: sp.Expr, by: Sequence[sp.Symbol], constant: Sequence[sp.Symbol] = ()) -> list[sp.Expr]:
        """Return D with the difference of expr = sum D times the differences of the symbols `by`.

        Definitions in `constant` stand for their mean values: a factor x of them contributes x~ dy to d(x y).
        """
        return [_Along(self, symbol, by, constant)(expr) for symbol in by]

    def moves(self, symbol: sp.Symbol) -> sp.Expr | None:
        """Return an expression that differs from a symbol by a constant."""
        return self._moves.get(symbol)


class _Along:
    """Discrete derivatives by one symbol, the others of `by` held."""

    def __init__(self, discrete: DiscreteGradient, symbol: sp.Symbol, by: Sequence[sp.Symbol],
                 constant: Sequence[sp.Symbol]):
        self.discrete, self.tag = discrete, symbol.name
        self.known: dict[sp.Symbol, sp.Expr] = {s: sp.Integer(s == symbol) for s in by}
        self.known.update(dict.fromkeys(constant, sp.S.Zero))

    def __call__(self, expr: sp.Expr) -> sp.Expr:
        if expr.is_Symbol:
            return self._symbol(expr)
        if expr.is_Add:
            return sp.Add(*map(self, expr.args))
        if expr.is_Mul:
            return self._product(expr.args)
        if expr.is_Pow:
            return self._power(expr, *self.discrete.pair(_root(expr)))
        if isinstance(expr, CubicIntegral):
            table, at = expr.args
            return self(at) * CubicMean(table, *self.discrete.pair(at))
        if any(self(symbol) != 0 for symbol in expr.free_symbols):
            raise ValueError(f"{expr}: a discrete gradient goes through sums, products, quotients and roots only")
        return sp.S.Zero

    def _symbol(self, symbol: sp.Symbol) -> sp.Expr:
        if symbol not in self.known:
            expr, value = self.discrete.moves(symbol), sp.S.Zero
            if expr is not None and expr.is_Pow and abs(expr.exp) in (1, sp.Rational(1, 2)):
                now, then = self.discrete.pair(symbol)  # the value itself: no second root or quotient
                value = self._power(expr, *((now, then) if expr.exp > 0 else (1 / now, 1 / then)))
            elif expr is not None:
                value = self(expr)
            self.known[symbol] = self.discrete.program.define(f"D_{symbol.name}_{self.tag}", value)
        return self.known[symbol]

    def _product(self, factors: Sequence[sp.Expr]) -> sp.Expr:
        product, change = sp.S.One, sp.S.Zero
        for factor in factors:
            moved = self(factor)
            change = self.discrete.mean(factor) * change + (self.discrete.mean(product) * moved if moved != 0 else 0)
            product = product * factor
        return change

    def _power(self, expr: sp.Expr, now: sp.Expr, then: sp.Expr) -> sp.Expr:
        """Return the discrete derivative of a power n/2, or n, of a base; now and then: the values of its root, or of
        the base.
        """
        moved = self(expr.base)
        if moved == 0:
            return moved
        n = expr.exp
        if not n.is_Integer:
            moved, n = moved / (now + then), 2 * n
        m = abs(n)
        change = moved * sum(now**k * then ** (m - 1 - k) for k in range(m))
        return change if n > 0 else -change / (now**m * then**m)


def _root(expr: sp.Expr) -> sp.Expr:
    if not (2 * expr.exp).is_Integer:
        raise ValueError(f"{expr}: kernels have products, quotients and square roots")
    return expr.base if expr.exp.is_Integer else sp.sqrt(expr.base)


def staged(program: Program, vectors: np.ndarray) -> tuple[Program, np.ndarray]:
    """Return a program for `DiscreteGradient` with the symbols of `program`, whose one input c has the shape of these
    vectors; and c.
    """
    law = Program("law", "a law at one state", "")
    law.symbols.update(program.symbols)
    return law, law.input("c", vectors.shape, "1", "strain vectors")
