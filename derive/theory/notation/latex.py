"""Formulas as LaTeX."""

from __future__ import annotations

import re
from collections.abc import Sequence
from itertools import pairwise

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

GREEK = ("alpha", "beta", "gamma", "delta", "varepsilon", "zeta", "eta", "theta", "kappa", "lambda", "mu", "nu", "xi",
         "pi", "rho", "sigma", "tau", "phi", "varphi", "chi", "psi", "omega", "Gamma", "Delta", "Theta", "Lambda", "Xi",
         "Pi", "Sigma", "Phi", "Psi", "Omega")
FUNCTIONS = ("sin", "cos", "axial", "tr", "skew", "diag")
TRANSPOSE = r"\mathsf{T}"


def latex(node: Node) -> str:
    """Return the LaTeX of a formula, without delimiters."""
    match node:
        case Number():
            return node.text
        case Name():
            return quantity(node)
        case Equation():
            return " = ".join(latex(side) for side in node.sides)
        case Sum():
            return _sum(node)
        case Product():
            return joined(node.factors, [_factor(f, first=k == 0, last=k == len(node.factors) - 1)
                                         for k, f in enumerate(node.factors)], " ", r" \; ")
        case Binary():
            return f"{_side(node.left)} \\{node.sign} {_side(node.right)}"
        case Fraction():
            return f"\\frac{{{latex(node.above)}}}{{{latex(node.below)}}}"
        case Power():
            return f"{_base(node.base)}^{{{node.exponent}}}"
        case Transpose():
            return f"{_base(node.of)}^{{{TRANSPOSE}}}"
        case Root():
            return f"\\sqrt{{{latex(node.of)}}}"
        case Size():
            return f"\\lvert {latex(node.of)} \\rvert"
        case Skew():
            return _skew(node.of)
        case Call():
            return f"\\operatorname{{{node.name}}} {bracket(latex(node.of))}"
        case _:
            return _large(node)


WIDTH = 110
"""Rough width of a line, in letters, above which a sum goes on below."""


def display(node: Node) -> str:
    """Return the LaTeX of a displayed formula: a long sum on its right goes over several lines (macros is and wrap)."""
    rows = wrapped(node)
    if rows is None:
        return latex(node)
    assert isinstance(node, Equation)
    text = r" \wrap ".join(_terms(row, begins=k == 0) for k, row in enumerate(rows))
    return rf"\begin{{aligned}} {latex(node.sides[0])} \is {text} \end{{aligned}}"


def wrapped(node: Node) -> list[list[tuple[int, Node]]] | None:
    """Return the terms of an equation's right side line by line; None where one line holds them."""
    if not (isinstance(node, Equation) and len(node.sides) == 2 and isinstance(node.sides[1], Sum)):
        return None
    rows: list[list[tuple[int, Node]]] = [[]]
    taken = width(node.sides[0])
    for sign, term in node.sides[1].terms:
        if taken + width(term) > WIDTH and rows[-1]:
            rows.append([])
            taken = 0
        rows[-1].append((sign, term))
        taken += width(term) + 3
    return rows if len(rows) > 1 else None


def width(node: Node) -> int:
    """Return roughly how many letters wide a formula is."""
    text = re.sub(r"\\(mathbf|mathrm|boldsymbol|left|right|widetilde|dot|operatorname|mathsf)|[{}_^ ]", "", latex(node))
    return len(re.sub(r"\\[a-zA-Z]+", "x", text))


def joined(factors: Sequence[Node], texts: Sequence[str], close: str, apart: str) -> str:
    """Return the texts of factors one after the other, words kept apart."""
    text = texts[0]
    for (before, after), more in zip(pairwise(factors), texts[1:], strict=True):
        text += (apart if is_word(before) or is_word(after) else close) + more
    return text


def is_word(node: Node) -> bool:
    """Return whether a factor is a name of several letters."""
    return isinstance(node, Name) and len(node.base) > 1 and node.base not in GREEK


def _large(node: Node) -> str:
    match node:
        case Matrix():
            rows = r" \\ ".join(" & ".join(latex(entry) for entry in row) for row in node.rows)
            return f"\\begin{{bmatrix}} {rows} \\end{{bmatrix}}"
        case Cases():
            return (f"\\begin{{cases}} {latex(node.below)} & {latex(node.left)} < {latex(node.right)} \\\\ "
                    f"{latex(node.other)} & \\text{{else}} \\end{{cases}}")
        case Derivative():
            d = r"\partial" if node.partial else r"\mathrm{d}"
            order = f"^{{{node.order}}}" if node.order > 1 else ""
            of = latex(node.of) if isinstance(node.of, Name) else bracket(latex(node.of))
            return f"\\frac{{{d}{order} {of}}}{{{d} {latex(node.by)}{order}}}"
        case At():
            changes = ", ".join(f"{latex(name)} \\to {latex(value)}" for name, value in node.changes)
            return f"\\left. {latex(node.of)} \\right|_{{{changes}}}"
        case Series():
            return f"\\sum_{{{node.index} = {latex(node.first)}}}^{{{latex(node.last)}}} {_factor(node.of, last=True)}"
        case Integral():
            at, d = {"V": ("_{V}", "V"), "A": ("_{A}", "A"), "l": ("_{0}^{l}", "x")}[node.over]
            return f"\\int{at} {_factor(node.of)} \\, \\mathrm{{d}} {d}"
    raise TypeError(f"no LaTeX of {node!r}")


def _skew(of: Node) -> str:
    """Return a tilde above; a subscript stays outside of it."""
    if isinstance(of, Name) and of.sub and not (of.primes or of.above):
        letter_alone = Name(of.base, of.bold, of.accent)
        return f"\\widetilde{{{quantity(letter_alone)}}}_{{{','.join(map(subscript, of.sub))}}}"
    return f"\\widetilde{{{latex(of)}}}"


def bracket(text: str) -> str:
    """Return text in round brackets of its size."""
    return f"\\left( {text} \\right)"


def letter(base: str) -> str:
    """Return a letter or a Greek one's command; words stand upright."""
    if base in GREEK:
        return f"\\{base}"
    return base if len(base) == 1 else f"\\mathrm{{{base}}}"


def quantity(node: Name) -> str:
    """Return a quantity."""
    text = letter(node.base)
    if node.bold:
        text = f"\\boldsymbol{{{text}}}" if node.base in GREEK else f"\\mathbf{{{node.base}}}"
    if node.accent:
        text = f"\\{node.accent}{{{text}}}"
    if node.sub:
        text += f"_{{{','.join(subscript(s) for s in node.sub)}}}"
    marks = r"\prime " * node.primes + node.above.replace("*", r"\ast ")
    return text + (f"^{{{marks.strip()}}}" if marks else "")


def subscript(text: str) -> str:
    """Return one subscript: letters and numbers as they are, Greek letters as commands, words upright."""
    if text in GREEK:
        return f"\\{text}"
    return text if len(text) <= 2 or text.isdigit() else f"\\mathrm{{{text}}}"


def _sum(node: Sum) -> str:
    return _terms(node.terms)


def _terms(terms: Sequence[tuple[int, Node]], begins: bool = True) -> str:
    text = ""
    for k, (sign, term) in enumerate(terms):
        inner = bracket(latex(term)) if isinstance(term, Sum) else latex(term)
        first = begins and k == 0
        text += ("-" if sign < 0 else "") + inner if first else f" {'-' if sign < 0 else '+'} {inner}"
    return text.strip()


def _factor(node: Node, first: bool = False, last: bool = False) -> str:
    """Return a factor; sums, and all that would go on to the right of it, in brackets."""
    if isinstance(node, Sum) or isinstance(node, Binary) or (isinstance(node, (Series, Integral)) and not last):
        return bracket(latex(node))
    if isinstance(node, Number) and not first:
        return bracket(latex(node))
    return latex(node)


def _side(node: Node) -> str:
    return bracket(latex(node)) if isinstance(node, (Sum, Binary, Series, Integral)) else latex(node)


def _base(node: Node) -> str:
    """Return what a power is of; all but quantities, numbers, sizes and matrices in brackets."""
    if isinstance(node, Name) and not (node.primes or node.above):
        return latex(node)
    if isinstance(node, (Matrix, Size, Skew)) or (isinstance(node, Number) and not node.text.startswith("-")):
        return latex(node)
    return bracket(latex(node))
