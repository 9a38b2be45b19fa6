"""Check of the emitted text: formulas are read back from HTML and LaTeX, evaluated, and compared with the kernels."""

from __future__ import annotations

import re

from .document import Document, evaluate
from .notation.evaluate import UndefinedError
from .notation.mathml import to_latex
from .notation.parse import FormulaError, parse
from .notation.tree import Node
from .scopes import TOLERANCE
from .tex import formulas as tex_formulas

MATH = re.compile(r'<math id="([^"]+)".*?</math>', re.DOTALL)


def read_html(page: str) -> dict[str, Node]:
    """Return the displayed formulas of a page, by identifier. Raises FormulaError or ValueError for what cannot be
    read.
    """
    return {found[1]: parse(to_latex(found[0])) for found in MATH.finditer(page)}


def read_tex(source: str) -> dict[str, Node]:
    """Return the displayed formulas of a LaTeX file, by identifier."""
    return {name: parse(formula) for name, formula in tex_formulas(source).items()}


def measure(document: Document, trees: dict[str, Node] | None = None) -> None:
    """Evaluate a document's formulas against the kernels and keep the deviations with them."""
    found = evaluate(document, trees)
    for _, formula in document.formulas():
        formula.deviation = found.get(formula.identifier)


def faults(document: Document, page: str, source: str) -> list[str]:
    """Return the faults of the emitted texts, a sentence each."""
    try:
        of_page, of_source = read_html(page), read_tex(source)
    except (FormulaError, ValueError) as problem:
        return [f"a formula cannot be read back: {problem}"]
    wanted = [f.identifier for _, f in document.formulas()]
    found = [f"{name} is missing from the {kind}" for kind, trees in (("page", of_page), ("LaTeX", of_source))
             for name in wanted if name not in trees]
    found += [f"{name} is not the same formula in the page and in the LaTeX" for name in wanted
              if name in of_page and name in of_source and of_page[name] != of_source[name]]
    if found:
        return found
    try:
        deviations = evaluate(document, of_page)
    except UndefinedError as problem:
        return [f"the page is not complete: {problem}"]
    for _, formula in document.formulas():
        deviation = deviations.get(formula.identifier)
        if deviation is not None and not deviation <= TOLERANCE:
            about = ".".join(formula.kernel) if formula.kernel else "its two sides"
            found.append(f"{formula.identifier}: {formula.line.latex} is off {about} by {deviation:.2g}, may be "
                         f"{TOLERANCE:.0e}")
    return found
