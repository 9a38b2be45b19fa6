"""Discrete derivatives by stages give exact differences, and derivatives where arguments are equal."""

import numpy as np
import pytest
import sympy as sp
from funicular.derive.algebra.discrete_gradient import DiscreteGradient
from funicular.derive.codegen.program import Program


def staged():
    """Return a function of two inputs with products, quotients, roots, and a value with a constant in it."""
    law = Program("law", "", "")
    x, y = law.input("x", (), "1", ""), law.input("y", (), "1", "")
    law.stage("function")
    root = law.define("root", sp.sqrt(x**2 + y))
    strain = law.define("strain", (x**2 + y - 1) / (root + 1), derivative_of=root)
    inverse = law.define("inverse", 1 / (x * y + 2))
    return law, (x, y), 3 * strain**2 * inverse**3 - x * y**2 + sp.sqrt(y) ** 3 + 7


def evaluated(program: Program, expr, values):
    known = dict(values)
    for stage in program.stages:
        for symbol, definition in stage.definitions:
            known[symbol] = definition.xreplace(known)
    return sp.N(sp.sympify(expr).xreplace(known), 30)


def gradient(now, then):
    """Return the discrete derivatives by both inputs, and the values of the function, with 30 digits."""
    law, inputs, expr = staged()
    program = Program("step", "", "")
    ends = [tuple(program.input(f"{s}{k}", (), "1", "") for k in (0, 1)) for s in inputs]
    discrete = DiscreteGradient(program, law, dict(zip(inputs, ends, strict=True)))
    program.stage("gradient")
    D = discrete.gradient(expr, inputs)
    values = {symbol: sp.Rational(v) for pair, both in zip(ends, zip(now, then, strict=True), strict=True)
              for symbol, v in zip(pair, both, strict=True)}
    return [evaluated(program, d, values) for d in D], [evaluated(program, v, values) for v in discrete.pair(expr)]


def test_it_is_the_difference():
    now, then = ("1.25", "0.5"), ("0.75", "2")
    D, (before, after) = gradient(now, then)
    moved = sum(d * (sp.Rational(b) - sp.Rational(a)) for d, a, b in zip(D, now, then, strict=True))
    assert abs(moved - (after - before)) < 1e-25
    assert abs(after - before) > 0.1


def test_it_is_the_same_backwards():
    now, then = ("1.25", "0.5"), ("0.75", "2")
    np.testing.assert_allclose(np.array(gradient(now, then)[0], float), np.array(gradient(then, now)[0], float),
                               rtol=1e-15)


def test_it_is_the_derivative_where_nothing_moves():
    at = ("1.25", "0.5")
    law, inputs, expr = staged()
    plain = expr
    for _ in range(3):
        plain = plain.xreplace(dict(d for stage in law.stages for d in stage.definitions))
    values = dict(zip(inputs, map(sp.Rational, at), strict=True))
    D, _ = gradient(at, at)
    for d, symbol in zip(D, inputs, strict=True):
        assert abs(d - sp.N(sp.diff(plain, symbol).xreplace(values), 30)) < 1e-25


def test_other_powers_are_refused():
    law = Program("law", "", "")
    x = law.input("x", (), "1", "")
    law.stage("function")
    program = Program("step", "", "")
    ends = tuple(program.input(f"x{k}", (), "1", "") for k in (0, 1))
    discrete = DiscreteGradient(program, law, {x: ends})
    program.stage("gradient")
    with pytest.raises(ValueError, match="kernels have products, quotients and square roots"):
        discrete.gradient(x ** sp.Rational(1, 3), [x])
