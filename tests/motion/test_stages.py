"""From specs to C: staged programs, derivatives, the printer, exact integrals."""

import math
import random
import re

import mpmath
import numpy as np
import pytest
import sympy as sp
from funicular.derive.algebra import section_integrals as moments
from funicular.derive.algebra.stumpff import SERIES_BELOW, stumpff
from funicular.derive.codegen.c_printer import c_expression
from funicular.derive.codegen.program import DirectionalDerivative, Program, jacobian
from funicular.derive.verify.exact import ExactProgram, source

a, b, c = sp.symbols("a b c")


def chain() -> tuple[Program, np.ndarray, list[sp.Symbol]]:
    """Return a program with a root, a reciprocal and a product, three stages deep."""
    p = Program("test", "a test", "none")
    v = p.input("v", 3, "1", "anything")
    p.stage("lengths")
    length = p.define("length", sp.sqrt(v.dot(v)))
    inverse = p.define("inverse", 1 / length)
    p.stage("direction")
    n = p.vector("n", inverse * v)
    p.stage("result")
    return p, np.array([p.define("r", n[0] * n[1] ** 2 + length), p.define("q", inverse**2 * v[2])]), list(v)


def expanded(p: Program, expr: sp.Expr) -> sp.Expr:
    """Return an expression in the inputs alone."""
    while True:
        below = {s: p.definition[s] for s in expr.free_symbols if s in p.definition}
        if not below:
            return expr
        expr = expr.subs(below)


def test_derivations_through_stages_agree_with_sympy():
    p, values, v = chain()
    plain = [expanded(p, value) for value in values]
    staged = jacobian(p, values, v)
    point = {s: sp.Rational(k, 7) for s, k in zip(v, (3, -5, 4), strict=True)}
    for i, value in enumerate(plain):
        for j, s in enumerate(v):
            assert sp.simplify(expanded(p, staged[i, j]).subs(point) - sp.diff(value, s).subs(point)) == 0


def test_a_second_derivation_follows_a_path():
    p, values, v = chain()
    t = sp.Symbol("t")
    velocity = (2, -1, 3)
    along = DirectionalDerivative(p, "dt", dict(zip(v, velocity, strict=True)))
    second = along(along(values[0]))
    path = expanded(p, values[0]).subs({s: s + t * w for s, w in zip(v, velocity, strict=True)}, simultaneous=True)
    point = {s: sp.Rational(k, 7) for s, k in zip(v, (3, -5, 4), strict=True)}
    expected = sp.diff(path, t, 2).subs(t, 0).subs(point)
    assert abs(sp.N(expanded(p, second).subs(point) - expected, 40)) < 1e-38


def test_a_cut_hides_what_is_below_it():
    p, _, v = chain()
    length = p.symbols["v"][0]
    cut = sp.Symbol("length")
    assert DirectionalDerivative(p, "d", {cut: 1})(p.definition[sp.Symbol("inverse")]) == -(cut**-2)
    assert DirectionalDerivative(p, "e", {cut: 0, **dict.fromkeys(v, 0), length: 1})(cut) == 0


def test_a_definition_that_moves_as_another_is_differentiated_as_that_one():
    """|r| - 1 without cancellation has the derivative of |r|."""
    p = Program("stretch", "", "")
    square = p.input("square", (), "1", "r . r - 1")
    p.stage("all")
    length = p.define("length", sp.sqrt(1 + square))
    strain = p.define("strain", square / (1 + length), derivative_of=length)
    point = {square: sp.Rational(9, 16)}
    d = jacobian(p, np.array([strain]), [square])[0, 0]
    assert expanded(p, d).subs(point) == sp.diff(sp.sqrt(1 + square) - 1, square).subs(point) == sp.Rational(2, 5)
    assert dict(p.stages[0].definitions)[strain] == square / (1 + length), "its value stays as it was written"


def test_inputs_that_nothing_depends_on_are_reported():
    p, values, _ = chain()
    p.input("idle", 2, "1", "no output needs it")
    p.input("idler", (), "1", "nor this")
    p.output("out", values, "1", "r, q")
    assert p.unused() == ["idle", "idler"]


def test_numbers_and_symbols_need_no_name():
    p, _, v = chain()
    before = len(p.definition)
    assert p.define("zero", 0) == 0
    assert p.define("same", v[0]) is v[0]
    assert len(p.definition) == before


def test_a_name_is_given_once():
    p, _, _ = chain()
    assert p.define("length", a + b).name == "length_2"
    with pytest.raises(ValueError, match="input name n_x is taken"):
        p.input("n_x", (), "1", "would hide a definition in C")
    with pytest.raises(ValueError, match="output name v is taken"):
        p.output("v", [a], "1", "would hide an input in C")


def test_prune_keeps_what_the_outputs_need():
    p, values, _ = chain()
    p.define("idle", a * b)
    p.output("out", values[1:], "1", "q alone")
    names = {s.name for s, _ in (d for stage in p.prune().stages for d in stage.definitions)}
    assert names == {"length", "inverse", "q"}


def test_operations_are_counted():
    p = Program("count", "", "")
    p.stage("all")
    p.define("x1", a * b + c - 2 * a)  # 2 products, 2 sums
    p.define("x2", a**3 / b)  # 2 products, 1 division
    p.define("x3", -a / (b * c))  # 1 product, 1 division; the sign is free
    p.define("x4", sp.sqrt(a))
    assert p.operations() == {"add": 2, "mul": 5, "div": 2, "sqrt": 1}


@pytest.mark.parametrize(("expr", "text"), [
    (a**3, "a*a*a"),
    (a / b, "a/b"),
    (a / (b * c), "a/(b*c)"),
    (1 / a**2, "1.0/(a*a)"),
    (-a, "-a"),
    (sp.Rational(1, 3), "1.0/3.0"),
    (sp.sqrt(a), "FU_SQRT(a)"),
    (b * sp.sin(2 * a), "b*FU_SIN(2.0*a)"),
    (b * sp.Piecewise((a + 1, a < 2), (sp.cos(a), True)), "b*(FU_REAL(a) < 2.0 ? a + 1.0 : FU_COS(a))"),
    ((a + b) ** 2, "(a + b)*(a + b)"),
    (a - (b + c), "a - b - c"),
    (sp.Float(0.1) * a - sp.Float(0.7745966692414834) * b, "0.1*a - 0.7745966692414834*b"),
])
def test_printed_c(expr, text):
    assert c_expression(expr) == text


@pytest.mark.parametrize("expr", [sp.tan(a), a**sp.Rational(1, 3), sp.pi, a**b])
def test_the_printer_refuses_what_is_not_arithmetic(expr):
    with pytest.raises(ValueError, match="kernel form"):
        c_expression(expr)


@pytest.mark.parametrize("condition", [a <= 2, a > 2, sp.And(a < 2, b < 2)])
def test_a_choice_is_between_two_cases(condition):
    for expr in (sp.Piecewise((a, condition), (b, True)), sp.Piecewise((a, a < 1), (b, a < 2), (c, True)),
                 sp.Piecewise((a, a < 1))):
        with pytest.raises(ValueError, match="two cases"):
            c_expression(expr)


@pytest.mark.parametrize("k", range(4))
def test_stumpff_functions_keep_their_digits(k):
    """In doubles against 50 digits, on both sides of the change from series to quotients."""
    p = Program("stumpff", "", "")
    x = p.input("x", (), "1", "")
    p.stage("all")
    p.output("c", stumpff(p, "value", k, x, p.define("root", sp.sqrt(x))), "1", "")
    in_c = c_expression(p.definition[sp.Symbol("value")])
    choice = re.fullmatch(r"\(FU_REAL\(x\) < [^ ]* \? (.*) : (.*)\)", in_c)
    for value in (0.0, 1e-300, 1e-8, 0.1, 0.249, 0.25, 0.5, 0.999, 1.0, 1.001, 4.0, 30.0):
        names = {"x": value, "root": math.sqrt(value), "FU_SIN": math.sin, "FU_COS": math.cos}
        with mpmath.workdps(60):
            exact = sum((-mpmath.mpf(value))**j / mpmath.factorial(2 * j + k) for j in range(60))
            error = abs(eval(choice[1 if value < SERIES_BELOW[k] else 2], names) - exact)
        assert error < 1e-15 / math.factorial(k)


def test_printed_c_and_exact_source_say_the_same():
    """Random trees: the C text evaluated by Python's arithmetic, the exact source at 50 digits."""
    chance = random.Random(3)
    values = {"a": 1.25, "b": -0.5, "c": 2.0}

    def tree(depth: int) -> sp.Expr:
        if depth == 0:
            return chance.choice([a, b, c, sp.Integer(chance.randint(-3, 3)), sp.Rational(chance.randint(-5, 5), 3)])
        left, right = tree(depth - 1), tree(depth - 1)
        return chance.choice([left + right, left - right, left * right, -left, left**2, left / (3 + right**2),
                              sp.sqrt(1 + left**2), 1 / sp.sqrt(2 + left**2) if left != 0 else left])

    compared = 0
    for _ in range(300):
        expr = tree(3)
        try:
            text = c_expression(expr)
        except ValueError:  # half-integer powers beyond the root are staged in a derivation, not printed
            continue
        compared += 1
        in_c = eval(text, {"FU_SQRT": math.sqrt, **values})
        exact = eval(source(expr), {"sqrt": mpmath.sqrt, "q": lambda p, q: mpmath.mpf(p) / q,
                                    **{k: mpmath.mpf(v) for k, v in values.items()}})
        assert in_c == pytest.approx(float(exact), rel=1e-13, abs=1e-13)
    assert compared > 200


def test_exact_programs_keep_50_digits():
    p, values, _ = chain()
    p.output("out", values, "1", "r, q")
    with mpmath.workdps(50):
        v = np.array([mpmath.mpf(3), mpmath.mpf(4), mpmath.mpf(12)], dtype=object)
        out = ExactProgram(p.prune())([v])["out"]
        assert abs(out[0] - (mpmath.mpf(3) * 16 / 13**3 + 13)) < mpmath.mpf(10) ** -48
        assert abs(out[1] - mpmath.mpf(12) / 169) < mpmath.mpf(10) ** -48


def test_legendre_polynomials_are_orthogonal():
    for m in range(5):
        for n in range(5):
            integral = moments.over_element(moments.legendre(m) * moments.legendre(n))
            assert integral == ({(0, 1): sp.QQ(1, 2 * n + 1)} if m == n else {})


def test_integrals_over_an_element_against_sympy():
    x, y, z, l, h, w = sp.symbols("x y z l h w", positive=True)
    p = (moments.L * (1 + moments.X) / 2) ** 3 * moments.Y**2 * moments.W + 5 * moments.Z**2 + moments.Y**4 * 2
    p += 7 * moments.Y * moments.Z**2  # odd in y: nothing on a doubly symmetric section
    integrand = x**3 * y**2 / l + 5 * z**2 + 2 * y**4
    expected = sp.integrate(integrand, (x, 0, l), (y, -h / 2, h / 2), (z, -w / 2, w / 2))
    section = {k: sp.integrate(y**i * z**j, (y, -h / 2, h / 2), (z, -w / 2, w / 2))
               for (i, j), k in moments.SECTION.items()}
    found = sum(sp.Rational(int(c.numerator), int(c.denominator)) * section[k] * l**n
                for (k, n), c in moments.over_element(p).items())
    assert sp.expand(found - expected) == 0


def test_d_dx_is_the_derivative_along_the_element():
    x = moments.L * (1 + moments.X) / 2
    assert moments.d_dx(x**3) == 3 * x**2 * moments.L * moments.W
