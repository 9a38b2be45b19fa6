"""Formulas of elastic laws, made from their Gram products, quadratic forms and quadrature rules."""

from __future__ import annotations

from typing import Any

import numpy as np
import sympy as sp

from ..algebra.gram import Gram
from ..laws import law_class
from .markdown import Line
from .notation.from_sympy import formula, plain_names, signed_sum
from .notation.latex import latex
from .notation.tree import Binary, Equation, Matrix, Name, Node, Number, Product, Transpose
from .printed import _element, equation, shape_functions
from .scopes import Scope

AXES = "xyz"


def _law(scope: Scope) -> Any:
    assert scope.family.law is not None
    return law_class(scope.family.law)(Gram(_element(scope)))


def solid_shape_functions(scope: Scope) -> list[Line]:
    """Return shape functions, their row of blocks, and both positions."""
    return [*shape_functions(scope), Line(r"\mathbf{S} = \mathbf{N}^{\mathsf{T}} \otimes \mathbf{I}")]


def gradients(scope: Scope) -> list[Line]:
    """Return the gradients of position and of the stress-free shape by the coordinates of the element."""
    axes = AXES[: _element(scope).dim]
    lines = []
    for left, e in ((r"\mathbf{J}", r"\mathbf{e}"), (r"\mathbf{J}_{0}", r"\mathbf{e}_{0}")):
        columns = " & ".join(rf"\frac{{\partial ( \mathbf{{S}} {e} )}}{{\partial {a}}}" for a in axes)
        lines.append(Line(rf"{left} = \begin{{bmatrix}} {columns} \end{{bmatrix}}"))
    return lines


def voigt(scope: Scope) -> list[Line]:
    """Return the strain as a vector and the matrix of elastic constants."""
    dim = _element(scope).dim
    pairs = [(i, j) for i in range(1, dim + 1) for j in range(i + 1, dim + 1)]
    units = [Matrix((tuple(Number(str(int(k == i))) for k in range(dim)),)) for i in range(dim)]
    names = [Name("u", bold=True, sub=(str(i + 1),)) for i in range(dim)]
    lines = [Line(equation(name, Transpose(unit))) for name, unit in zip(names, units, strict=True)]
    entries = {(i, j): rf"\varepsilon_{{{i}{j}}}" for i, j in [*((i, i) for i in range(1, dim + 1)), *pairs]}
    lines += [Line(rf"{name} = \mathbf{{u}}_{{{i}}}^{{\mathsf{{T}}}} \boldsymbol{{\varepsilon}}_{{m}} "
                   rf"\mathbf{{u}}_{{{j}}}") for (i, j), name in entries.items()]
    row = " & ".join(name if i == j else f"2 {name}" for (i, j), name in entries.items())
    lines.append(Line(rf"\boldsymbol{{\varepsilon}} = \begin{{bmatrix}} {row} \end{{bmatrix}}^{{\mathsf{{T}}}}"))
    size = dim + len(pairs)
    rows = [["0"] * size for _ in range(size)]
    for i in range(dim):
        for j in range(dim):
            rows[i][j] = f"D_{{{min(i, j) + 1}{max(i, j) + 1}}}"
    for k, (i, j) in enumerate(pairs):
        rows[dim + k][dim + k] = f"G_{{{i}{j}}}"
    table = r" \\ ".join(" & ".join(row) for row in rows)
    return [*lines, Line(rf"\mathbf{{E}} = \begin{{bmatrix}} {table} \end{{bmatrix}}")]


# --- the quadratic form in Gram products ------------------------------------------------------------------------


def _strain(gram: Gram, p: int) -> Name:
    a, b = gram.pairs[p]
    return Name("g", sub=(gram.names[a], gram.names[b]))


def _stress(gram: Gram, p: int) -> Name:
    a, b = gram.pairs[p]
    return Name("u", sub=(gram.names[a], gram.names[b]))


def gram_products(scope: Scope) -> list[Line]:
    """Return the Gram products of the strain vectors less those of the straight reference."""
    gram = Gram(_element(scope))
    lines = []
    for p, (a, b) in enumerate(gram.pairs):
        product: Node = Binary("cdot", *(Name("c", bold=True, sub=(gram.names[m],)) for m in (a, b)))
        value = signed_sum([(1, product), (-1, Number("1"))]) if gram.reference[p] else product
        lines.append(Line(equation(_strain(gram, p), value)))
    return lines


def elastic_constants(scope: Scope) -> list[Line]:
    """Return the different entries of the quadratic form, from the exact integrals."""
    form = _law(scope).form
    lines, names = [], {}
    for k, m in {(k, m) for entry in form.constants for (k, m, _), _ in entry}:
        names[sp.Symbol(f"S_{k}_{m}")] = Name("S", sub=(str(k + 1), str(m + 1)))
    for i, entry in enumerate(form.constants):
        value = sum(sp.Rational(int(c.numerator), int(c.denominator)) * sp.Symbol(f"S_{k}_{m}")
                    * sp.Symbol("l")**power for (k, m, power), c in entry)
        lines.append(Line(equation(Name("a", sub=(str(i + 1),)), formula(value, plain_names(names)))))
    column = Transpose(Matrix((tuple(Name("a", sub=(str(i + 1),)) for i in range(len(form.constants))),)))
    return [*lines, Line(equation(Name("a", bold=True), column), output="stiffness.A")]


def stresses(scope: Scope) -> list[Line]:
    """Return the form times the strains, a sum for each Gram product."""
    law = _law(scope)
    gram, form = law.gram, law.form
    lines = []
    for p in range(len(gram.pairs)):
        alike: dict[int, list[int]] = {}
        for q in range(len(gram.pairs)):
            if (p, q) in form.index:
                alike.setdefault(form.index[p, q], []).append(q)
        terms: list[tuple[int, Node]] = []
        for k, of in alike.items():
            total = signed_sum([(1, _strain(gram, q)) for q in of])
            terms.append((1, Product((Name("a", sub=(str(k + 1),)), total))))
        lines.append(Line(equation(_stress(gram, p), signed_sum(terms) if terms else Number("0"))))
    return lines


def gram_energy(scope: Scope) -> list[Line]:
    """Return the energy as half of stress times strain."""
    gram = Gram(_element(scope))
    terms: list[tuple[int, Node]] = [(1, Product((_stress(gram, p), _strain(gram, p)))) for p in range(len(gram.pairs))]
    half = Product((formula(sp.Rational(1, 2), plain_names({})), signed_sum(terms)))
    return [Line(equation(Name("U", sub=("G",)), half), output="energy.U")]


# --- cables -----------------------------------------------------------------------------------------------------


def measures(scope: Scope) -> list[Line]:
    """Return strain and curvature of the law."""
    traits = scope.family.traits
    assert traits is not None
    green = traits.strain == "green"
    if traits.takes_shape:
        return curved_measures(green)
    strain = (r"\frac{1}{2} \left( \mathbf{r}^{\prime} \cdot \mathbf{r}^{\prime} - 1 \right)" if green else
              r"\lvert \mathbf{r}^{\prime} \rvert - 1")
    bend = r"\lvert \mathbf{r}^{\prime} \times \mathbf{r}^{\prime \prime} \rvert"
    curvature = (r"\lvert \mathbf{r}^{\prime \prime} \rvert" if traits.curvature == "linear" else
                 rf"\frac{{{bend}}}{{\lvert \mathbf{{r}}^{{\prime}} \rvert^{{{3 if green else 2}}}}}")
    return [Line(rf"\varepsilon = {strain}"), Line(rf"\kappa = {curvature}")]


def curved_measures(green: bool) -> list[Line]:
    """Return strain, curvature and energy per length against those of a curved stress-free shape."""
    bend = r"\lvert \mathbf{r}^{\prime} \times \mathbf{r}^{\prime \prime} \rvert"
    bend_0 = r"\lvert \mathbf{r}_{0}^{\prime} \times \mathbf{r}_{0}^{\prime \prime} \rvert"
    square = r"\mathbf{r}^{\prime} \cdot \mathbf{r}^{\prime}"
    strain = (rf"\frac{{1}}{{2}} \left( \frac{{{square}}}{{j^{{2}}}} - 1 \right)" if green else
              r"\frac{\lvert \mathbf{r}^{\prime} \rvert}{j} - 1")
    below = r"\lvert \mathbf{r}^{\prime} \rvert^{3}" if green else r"j \lvert \mathbf{r}^{\prime} \rvert^{2}"
    return [Line(text) for text in (
        r"\mathbf{r}_{0} = \sum_{k=1}^{n} N_{k} \mathbf{e}_{0,k}",
        r"\mathbf{r}_{0}^{\prime} = \frac{\partial \mathbf{r}_{0}}{\partial x}",
        r"\mathbf{r}_{0}^{\prime \prime} = \frac{\partial^{2} \mathbf{r}_{0}}{\partial x^{2}}",
        r"j = \lvert \mathbf{r}_{0}^{\prime} \rvert", rf"\varepsilon = {strain}",
        rf"\kappa = \frac{{{bend}}}{{{below}}}",
        rf"\kappa_{{0}} = \frac{{{bend_0}}}{{j^{{3}}}}",
        r"\phi = \frac{4}{10^{12} l^{2}}", r"\beta = \frac{\kappa_{0}^{2}}{10^{6}} + \phi",
        r"\bar{\kappa} = \sqrt{\kappa^{2} + \beta}", r"\bar{\kappa}_{0} = \sqrt{\kappa_{0}^{2} + \beta}",
        r"\Delta = \bar{\kappa} - \bar{\kappa}_{0}",
        r"\sigma = \frac{\phi^{2} \bar{\kappa}_{0}}{\kappa_{0}^{4} + \phi^{2}}",
        r"W = j \left( \frac{1}{2} \mathrm{EA} \varepsilon^{2} + \mathrm{EI} \Delta \left( \frac{1}{2} \Delta + \sigma "
        r"\right) \right)")]


def _rule(letters: tuple[str, str], points: int) -> list[Line]:
    """Return places and weights of a Gauss-Legendre rule, in the digits of a double."""
    nodes, weights = np.polynomial.legendre.leggauss(points)
    lines = []
    for g, pair in enumerate(zip(nodes.tolist(), weights.tolist(), strict=True)):
        for letter, value in zip(letters, pair, strict=True):
            node = formula(sp.Float(value, 17), plain_names({})) if abs(value) > 1e-15 else Number("0")
            lines.append(Line(equation(Name(letter, sub=(str(g + 1),)), node)))
    return lines


def _curved(scope: Scope) -> bool:
    return bool(scope.family.traits and scope.family.traits.takes_shape)


def _at(name: str, letter: str, index: str) -> Line:
    """Return the value of a quantity at the place of a quadrature point, for each of them."""
    place = rf"\frac{{l}}{{2}} \left( 1 + {letter}_{{{index}}} \right)"
    return Line(rf"{name}_{{{index}}} = \left. {name} \right|_{{x \to {place}}}", index=index)


def quadrature(scope: Scope) -> list[Line]:
    """Return the places and weights of the rules, and strain and curvature there."""
    law = _law(scope)
    axial, bending = len(law.axial_points), len(law.bending_points)
    if _curved(scope):
        return [*_rule(("X", "w"), axial), _at("W", "X", "g")]
    if axial == bending:
        return [*_rule(("X", "w"), axial), _at(r"\varepsilon", "X", "g"), _at(r"\kappa", "X", "g")]
    return [*_rule(("X", "w"), axial), *_rule(("Y", "v"), bending), _at(r"\varepsilon", "X", "g"),
            _at(r"\kappa", "Y", "h")]


def cable_energy(scope: Scope) -> list[Line]:
    """Return the energy as a sum over the points."""
    law, traits = _law(scope), scope.family.traits
    assert traits is not None
    axial, bending = len(law.axial_points), len(law.bending_points)
    if _curved(scope):
        return [Line(rf"U = \frac{{l}}{{2}} \sum_{{g=1}}^{{{axial}}} w_{{g}} W_{{g}}", output="energy.U")]
    g, w = ("g", "w") if axial == bending else ("h", "v")
    bend = rf"\frac{{l}}{{4}} \mathrm{{EI}} \sum_{{{g}=1}}^{{{bending}}} {w}_{{{g}}} \kappa_{{{g}}}^{{2}}"
    if traits.membrane == "tension_only":
        one = r"\varepsilon_{g}"
        smooth = rf"\sqrt{{{one}^{{2}} + \varepsilon_{{t}}^{{2}}}} + \varepsilon_{{t}}"
        twice = (rf"{one}^{{2}} \left( \rho + \frac{{1 - \rho}}{{2}} \left( 1 + \frac{{{one}}}{{{smooth}}} "
                 r"\right) \right)")
        stretch = rf"\frac{{l}}{{4}} \mathrm{{EA}} \sum_{{g=1}}^{{{axial}}} w_{{g}} {twice}"
        return [Line(rf"U = {stretch} + {bend}", output="energy.U")]
    if traits.membrane != "assumed":
        stretch = rf"\frac{{l}}{{4}} \mathrm{{EA}} \sum_{{g=1}}^{{{axial}}} w_{{g}} \varepsilon_{{g}}^{{2}}"
        return [Line(rf"U = {stretch} + {bend}", output="energy.U")]
    lines, terms = [], []
    X = sp.Symbol("X")
    for m in range(law.degree):
        p = latex(formula(sp.legendre(m, X), lambda s: Name("X", sub=("g",))))
        factor = rf"w_{{g}} \varepsilon_{{g}} \left( {p} \right)" if m else r"w_{g} \varepsilon_{g}"
        lines.append(Line(rf"\eta_{{{m}}} = \frac{{{2 * m + 1}}}{{2}} \sum_{{g=1}}^{{{axial}}} {factor}"))
        stiffness = r"\mathrm{EA}" if m < law.n_full else r"\mathrm{EA}_{u}"
        terms.append(rf"\frac{{1}}{{{2 * m + 1}}} {stiffness} \eta_{{{m}}}^{{2}}" if m else
                     rf"{stiffness} \eta_{{{m}}}^{{2}}")
    return [*lines, Line(rf"U = \frac{{l}}{{2}} \left( {' + '.join(terms)} \right) + {bend}", output="energy.U")]


def cable_damping(scope: Scope) -> list[Line]:
    """Return the rates of strain and bending, the dissipated power, and the force; nothing of a law that has the
    damping kernels of another. A span's rates are those at material points.
    """
    law, traits, flows = _law(scope), scope.family.traits, scope.family.role == "span"
    assert traits is not None
    if traits.damped_like and not flows:
        return []
    moved = r"\mathbf{e} \to \mathbf{e} + t \dot{\mathbf{e}}"
    if flows:
        moved = rf"x \to x - t \dot{{s}}_{{1}}, l \to l + t \dot{{l}}, {moved}"
    lines = [Line(r"\mathbf{i} = \frac{\mathbf{r}^{\prime}}{\lvert \mathbf{r}^{\prime} \rvert}")]
    for name in (r"\varepsilon", r"\mathbf{i}", r"\mathbf{r}^{\prime \prime}"):
        star = {r"\varepsilon": r"\varepsilon^{\ast}", r"\mathbf{i}": r"\mathbf{i}^{\ast}"}.get(
            name, r"\mathbf{b}^{\ast}")
        rate = {r"\varepsilon": r"\dot{\varepsilon}", r"\mathbf{i}": r"\dot{\mathbf{i}}"}.get(name, r"\dot{\mathbf{b}}")
        lines += [Line(rf"{star} = \left. {name} \right|_{{{moved}}}"),
                  Line(rf"{rate} = \frac{{\mathrm{{d}} {star}}}{{\mathrm{{d}} t}}")]
    b, i = r"\mathbf{r}^{\prime \prime}", r"\mathbf{i}"
    lines.append(Line(rf"\mathbf{{D}} = \dot{{\mathbf{{b}}}} - \left( {i} \cdot {b} \right) \dot{{{i}}} + "
                      rf"\left( \dot{{{i}}} \cdot {b} \right) {i}"))
    lines += [*_rule(("P", "p"), law.degree), *_rule(("B", "b"), law.degree - 1)]
    lines += [_at(r"\dot{\varepsilon}", "P", "j"), _at(r"\mathbf{D}", "B", "k")]
    share = ""
    if traits.membrane == "tension_only":
        u = r"\frac{\varepsilon}{\sqrt{\varepsilon^{2} + \varepsilon_{t}^{2}}}"
        lines += [Line(rf"u = {u}"), _at("u", "P", "j")]
        share = (r" \left( \rho + \frac{1 - \rho}{4} \left( 1 + u_{j} \right)^{2} \left( 2 - u_{j} \right) \right)")
    power = (rf"\frac{{l}}{{2}} \mathrm{{EA}} \sum_{{j=1}}^{{{law.degree}}} p_{{j}}{share} "
             r"\dot{\varepsilon}_{j}^{2} + "
             rf"\frac{{l}}{{2}} \mathrm{{EI}} \sum_{{k=1}}^{{{law.degree - 1}}} b_{{k}} "
             r"\left( \mathbf{D}_{k} \cdot \mathbf{D}_{k} \right)")
    lines.append(Line(rf"P = \tau \left( {power} \right)", output="dissipation.P"))
    lines.append(Line(r"\mathbf{Q}_{d} = -\frac{1}{2} \left( \frac{\partial P}{\partial \dot{\mathbf{e}}} "
                      r"\right)^{\mathsf{T}}", output="-damping_force.f"))
    return lines


LAW_PRINTERS = {
    "solid_shape_functions": solid_shape_functions, "gradients": gradients, "voigt": voigt, "gram": gram_products,
    "elastic_constants": elastic_constants, "stresses": stresses, "gram_energy": gram_energy,
    "measures": measures, "quadrature": quadrature, "cable_energy": cable_energy,
    "cable_damping": cable_damping, "cable_shape_functions": shape_functions}

__all__ = ["LAW_PRINTERS", "Equation"]
