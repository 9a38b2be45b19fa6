"""Formulas that are made from the specs and programs, for the chapters that ask for them."""

from __future__ import annotations

from collections.abc import Callable

import sympy as sp

from ..algebra.gram import Gram
from ..codegen.program import Program
from ..elements import ELEMENTS
from ..spec import Element, l, x
from .markdown import Line
from .notation.from_sympy import formula, plain_names, signed_sum
from .notation.latex import latex
from .notation.tree import Equation, Matrix, Name, Node, Number, Product, Transpose
from .scopes import Scope, ends_of, programs_of

XI = sp.Symbol("xi", positive=True)
TABLE = {XI: Name("xi")}


def _element(scope: Scope) -> Element:
    assert scope.family.element is not None
    return scope.family.element


def equation(left: Node, right: Node) -> str:
    """Return left = right in LaTeX."""
    return latex(Equation((left, right)))


def coordinates(scope: Scope) -> list[Line]:
    """Return the nodal vectors one below the other, by their names and by their numbers, eq 1."""
    element = _element(scope)
    named = [Name("r", bold=True, sub=(*_slopes(v), str(node + 1))) for node in range(len(element.nodes))
             for v in element.nodal_vectors]
    numbered = [Name("e", bold=True, sub=(str(k + 1),)) for k in range(element.n_vectors)]
    e = Name("e", bold=True)

    def stack(vectors: list[Name]) -> Node:
        return Transpose(Matrix((tuple(Transpose(v) for v in vectors),)))

    return [Line(latex(Equation((e, stack(named)))), kind="shown"),
            Line(latex(Equation((e, stack(numbered)))), kind="holds")]


def _slopes(vector: str) -> tuple[str, ...]:
    slope = vector.partition("_")[2]
    return (slope,) if slope else ()


def shape_functions(scope: Scope) -> list[Line]:
    """Return the shape functions that solve the nodal conditions of the spec, in xi = x/l."""
    lines = [Line(r"\xi = \frac{x}{l}")]
    element = _element(scope)
    for k, (name, f) in enumerate(zip(element.names, element.shape_functions, strict=True)):
        power = name.count("x")
        polynomial = sp.expand(f.subs(x, XI * l) / l**power)
        right = formula(polynomial, plain_names(TABLE))
        if power:
            scale = Name("l") if power == 1 else formula(l**power, plain_names(TABLE))
            right = Product((scale, right))
        lines.append(Line(equation(Name("N", sub=(str(k + 1),)), right)))
    if scope.family.role == "slide" or (scope.family.traits and scope.family.traits.kind == "cable"):
        return lines
    column = Transpose(Matrix((tuple(Name("N", sub=(str(k + 1),)) for k in range(element.n_vectors)),)))
    lines.append(Line(equation(Name("N", bold=True), column),
                      output="position.N" if scope.family.role == "element" else ""))
    return lines


def basis(scope: Scope) -> list[Line]:
    """Return the monomials of the basis."""
    names = plain_names({})
    row = Matrix((tuple(formula(sp.sympify(b), names) for b in _element(scope).basis),))
    return [Line(latex(row), kind="shown")]


def mass(scope: Scope) -> list[Line]:
    """Return the mass matrix, entry by entry, from the program of its kernel."""
    program = programs_of(scope.family.name)["mass"]
    table: dict[sp.Symbol, Name] = {program.symbols["density"].item(): Name("rho")} if hasattr(
        program.symbols["density"], "item") else {sp.Symbol("density"): Name("rho")}
    for symbol, text in zip(program.symbols["section"], ("A", "yy", "zz", "yyyy", "yyzz", "zzzz"), strict=True):
        table[symbol] = Name("A") if text == "A" else Name("I", sub=(text,))
    density = sp.Symbol("density")
    entries = program.values["m"]

    def entry(value: sp.Expr) -> Node:
        defined = program.definition.get(value, value)
        return formula(sp.expand(defined / density), plain_names(table))

    rows = tuple(tuple(entry(v) for v in row) for row in entries)
    return [Line(equation(Name("m", bold=True), Product((Name("rho"), Matrix(rows)))), output="mass.m")]


def strain_vectors(scope: Scope) -> list[Line]:
    """Return the strain vectors as combinations of nodal vectors: the rows of the transform of the Gram products."""
    element = _element(scope)
    gram = Gram(element)
    lines = []
    for m, name in enumerate(gram.names):
        terms: list[tuple[int, Node]] = []
        for k in range(element.n_vectors):
            value = gram.transform[m, k]
            if value != 0:
                node = formula(value, plain_names({}))
                sign, factor = (1, node) if not _negative(value) else (-1, formula(-value, plain_names({})))
                vector = Name("e", bold=True, sub=(str(k + 1),))
                terms.append((sign, vector if factor == Number("1") else Product((factor, vector))))
        terms.sort(key=lambda term: term[0] < 0)
        lines.append(Line(equation(Name("c", bold=True, sub=(name,)), signed_sum(terms))))
    return lines


def _negative(value: sp.Expr) -> bool:
    return bool(value.subs(l, 1) < 0)


def gauss(scope: Scope, count: int) -> list[Line]:
    """Return weights and places of the Gauss-Legendre rule, as the kernels have them."""
    import numpy as np

    nodes, weights = np.polynomial.legendre.leggauss(count)
    lines = []
    for g, (place, weight) in enumerate(zip(nodes.tolist(), weights.tolist(), strict=True)):
        for letter, value in (("X", place), ("w", weight)):
            lines.append(Line(equation(Name(letter, sub=(str(g + 1),)), formula(sp.Float(value, 17), plain_names({}))
                                       if abs(value) > 1e-15 else Number("0"))))
    return lines


Printer = Callable[[Scope], list[Line]]
PRINTERS: dict[str, Printer] = {"coordinates": coordinates, "shape_functions": shape_functions, "basis": basis,
                                "mass": mass, "strain_vectors": strain_vectors}

__all__ = ["ELEMENTS", "PRINTERS", "Program"]


def rider(scope: Scope) -> list[Line]:
    """Return the attitude of a rider, with small turns theta about its axes, and its point p."""
    dim, point = scope.family.facts["dim"], scope.family.rider in ("point", "planar_point")
    if point:
        return [Line(r"\mathbf{p} = \mathbf{R} + \mathbf{u}")]
    first = (r"\mathbf{A}_{0} = \mathbf{I} + 2 \left( q_{0} \widetilde{\mathbf{q}} + \widetilde{\mathbf{q}} "
             r"\widetilde{\mathbf{q}} \right)" if dim == 3 else
             r"\mathbf{A}_{0} = \begin{bmatrix} c & -\sigma \\ \sigma & c \end{bmatrix}")
    return [Line(first), Line(r"\mathbf{A} = \mathbf{A}_{0} \left( \mathbf{I} + \widetilde{\boldsymbol{\theta}_{0}} "
                              r"\right) \left( \mathbf{I} + \widetilde{\boldsymbol{\theta}} \right)"),
            Line(r"\mathbf{p} = \mathbf{R} + \mathbf{A} \mathbf{u}")]


def tangent_frame(scope: Scope) -> list[Line]:
    """Return the tangent frame of a slide's cable, with where its normal comes from."""
    lines = [Line(r"\mathbf{i} = \frac{\mathbf{r}_{x}}{\lvert \mathbf{r}_{x} \rvert}")]
    element = _element(scope)
    if element.dim == 2:
        return [*lines, Line(r"\mathbf{j} = 1 \times \mathbf{i}"),
                Line(r"\mathbf{A}_{t} = \begin{bmatrix} \mathbf{i} & \mathbf{j} \end{bmatrix}",
                     output="constraint.A_t")]
    return [*lines, *normal(scope),
            Line(r"\mathbf{k} = \frac{\mathbf{i} \times \mathbf{n}}{\lvert \mathbf{i} \times \mathbf{n} \rvert}"),
            Line(r"\mathbf{j} = \mathbf{k} \times \mathbf{i}"),
            Line(r"\mathbf{A}_{t} = \begin{bmatrix} \mathbf{i} & \mathbf{j} & \mathbf{k} \end{bmatrix}",
                 output="constraint.A_t")]


def parted(scope: Scope) -> list[Line]:
    """Return C_L and C_M, eq 21."""
    across = ["j"] if scope.family.facts["dim"] == 2 else ["j", "k"]
    rows = r" \\ ".join(rf"\mathbf{{{a}}} \cdot \boldsymbol{{\Phi}}" for a in across)
    return [Line(r"C_{L} = \mathbf{i} \cdot \boldsymbol{\Phi}"),
            Line(rf"\mathbf{{C}}_{{M}} = \begin{{bmatrix}} {rows} \end{{bmatrix}}")]


PRINTERS |= {"rider": rider, "tangent_frame": tangent_frame, "parted": parted}


def _is_point(scope: Scope) -> bool:
    return scope.family.rider in ("point", "planar_point")


def place_on_cable(scope: Scope) -> list[Line]:
    """Return the place of a slide in its element, of a rope from the material coordinates of the nodes."""
    return [Line("x = s - s_{1}"), Line("l = s_{2} - s_{1}")] if ends_of(scope.family) else [Line("x = s")]


def velocities(scope: Scope) -> list[Line]:
    """Return the velocities of cable and rider, one below the other."""
    turn = "" if _is_point(scope) else r" \\ \boldsymbol{\omega}"
    ends = r"\dot{s}_{1} \\ \dot{s}_{2} \\ " if ends_of(scope.family) else ""
    return [Line(r"\dot{\mathbf{q}} = \begin{bmatrix} \dot{\mathbf{e}} \\ " + ends + r"\dot{\mathbf{R}}" + turn
                 + r" \end{bmatrix}")]


def moved_along(changes: dict[str, str], of: str) -> list[Line]:
    """Return what quantities become along a motion, each marked by an asterisk, and what a function of them becomes."""
    lines = [Line(rf"{starred(name)} = {value}") for name, value in changes.items()]
    every = ", ".join(rf"{name} \to {starred(name)}" for name in changes)
    return [*lines, Line(rf"{starred(of)} = \left. {of} \right|_{{{every}}}")]


def starred(name: str) -> str:
    """Return a quantity with an asterisk, its value along a motion."""
    return rf"{name}^{{\ast}}"


def motion(scope: Scope) -> list[Line]:
    """Return C along the motion at constant velocities."""
    changes = {r"\mathbf{e}": r"\mathbf{e} + t \dot{\mathbf{e}}", r"\mathbf{R}": r"\mathbf{R} + t \dot{\mathbf{R}}",
               "s": r"s + t \dot{s}"}
    if ends_of(scope.family):
        changes |= {rf"s_{{{k}}}": rf"s_{{{k}}} + t \dot{{s}}_{{{k}}}" for k in (1, 2)}
    if not _is_point(scope):
        spin = r"\widetilde{\boldsymbol{\omega}}"
        turned = rf"\left( \mathbf{{I}} + t {spin} + \frac{{1}}{{2}} t^{{2}} {spin} {spin} \right)"
        changes[r"\mathbf{A}"] = rf"\mathbf{{A}}_{{0}} {turned}"
    return moved_along(changes, r"\mathbf{C}")


def parted_bias(scope: Scope) -> list[Line]:
    """Return the parts of Q_d."""
    if scope.family.facts["dim"] == 2:
        first, rest = r"\begin{bmatrix} 1 & 0 \end{bmatrix}", r"\begin{bmatrix} 0 & 1 \end{bmatrix}"
    else:
        first = r"\begin{bmatrix} 1 & 0 & 0 \end{bmatrix}"
        rest = r"\begin{bmatrix} 0 & 1 & 0 \\ 0 & 0 & 1 \end{bmatrix}"
    return [Line(rf"Q_{{d,L}} = {first} \mathbf{{Q}}_{{d}}"),
            Line(rf"\mathbf{{Q}}_{{d,M}} = {rest} \mathbf{{Q}}_{{d}}")]


def slide_tangent(scope: Scope) -> list[Line]:
    """Return the derivatives of g; turns come before those by which g is made."""
    turns = [] if _is_point(scope) else [r"\boldsymbol{\theta}_{0}"]
    by = [r"\mathbf{e}", *ends_of(scope.family), r"\mathbf{R}", *turns, "s"]
    columns = " & ".join(rf"\frac{{\partial \mathbf{{g}}}}{{\partial {q}}}" for q in by)
    return [Line(rf"\mathbf{{K}} = \begin{{bmatrix}} {columns} \end{{bmatrix}}", output="tangent.K")]


PRINTERS |= {"place_on_cable": place_on_cable, "velocities": velocities, "motion": motion, "parted_bias": parted_bias,
             "slide_tangent": slide_tangent}


def normal(scope: Scope) -> list[Line]:
    """Return where the frame takes its normal from."""
    element = _element(scope)
    if not element.director:
        return [Line(r"\mathbf{n} = \mathbf{d}")]
    return [Line(rf"\mathbf{{n}} = \frac{{\partial \mathbf{{r}}}}{{\partial {element.director[-1]}}}")]


PRINTERS |= {"normal": normal}
