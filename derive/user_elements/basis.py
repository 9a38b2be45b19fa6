"""Checks of an element's spec before its derivation: names, basis, nodal conditions."""

from __future__ import annotations

import keyword
import re
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Any

import sympy as sp
from funicular.errors import near

from ..laws import LAWS, TRAITS, law_name, stiffness_of
from ..spec import Element, l, x, y, z
from .load import SpecError, taken

SECTION_DEGREE = {"element": 2, "continuum": 1}  # in y, z: what the section moments up to degree 4 can integrate
SIZES = {"nodal_vectors": (tuple, "a tuple of names"), "basis": (tuple, "a tuple of monomials"),
         "laws": (tuple, "a tuple of names or classes"), "name": (str, "text"), "doc": (str, "text"),
         "source": (str, "text"), "director": (str, "the name of a nodal vector, or empty")}
C_WORDS = {"auto", "case", "char", "const", "default", "do", "double", "enum", "extern", "float", "goto", "inline",
           "int", "long", "register", "restrict", "short", "signed", "sizeof", "static", "struct", "switch", "typedef",
           "union", "unsigned", "void", "volatile"}


def check(element: Element, file: str) -> None:
    """Raise SpecError for the first property that the element lacks."""
    place = f'{file}: element "{element.name}"'
    for cause, remedy in _faults(element):
        raise SpecError(place, cause, remedy)


def _faults(element: Element) -> Iterator[tuple[str, str]]:
    yield from _fields(element)
    yield from _names(element)
    yield from _vectors(element)
    yield from _monomials(element)
    yield from _laws(element)
    yield from _functionals(element)
    yield from _conditions(element)


def _fields(element: Element) -> Iterator[tuple[str, str]]:
    for name, (kind, text) in SIZES.items():
        if not isinstance(getattr(element, name), kind):
            comma = " (a tuple of one needs a comma)" if kind is tuple else ""
            yield f"{name} must be {text}, got {getattr(element, name)!r}{comma}", ""
    if element.dim not in (2, 3):
        yield f"dim must be 2 or 3, got {element.dim!r}", ""


def _names(element: Element) -> Iterator[tuple[str, str]]:
    name = element.name
    if not re.fullmatch(r"[a-zA-Z][a-zA-Z0-9_]*", name) or keyword.iskeyword(name) or name in C_WORDS:
        yield "the name must be letters, digits and _, begin with a letter, and be no word of C or Python", ""
    classes = [law for law in element.laws if isinstance(law, type)]
    nameless = [law.__name__ for law in classes if not isinstance(getattr(law, "name", None), str)]
    if nameless:
        yield (f"law {nameless[0]} has no class attribute name",
               'such as name = "own"; what __init__ sets comes too late')
        return
    for of_own in (name, *(f"{name}_{law_name(law)}" for law in element.laws)):
        if of_own in taken():
            yield f'funicular has a family "{of_own}" of its own', "give another name"


def _vectors(element: Element) -> Iterator[tuple[str, str]]:
    vectors, axes = element.nodal_vectors, "xyz"[: element.dim]
    for vector in vectors:
        if not (isinstance(vector, str) and re.fullmatch(f"r(_[{axes}]+)?", vector)):
            yield (f"nodal vector {vector!r} is not known in {element.dim} dimensions",
                   f'give "r", or "r_" with the coordinates of a derivative out of {axes}, such as "r_x", "r_xx"')
    orders = ["".join(sorted(v)) for v in vectors]
    if len(set(orders)) < len(orders):
        yield f"a nodal vector stands twice in {', '.join(vectors)}", "leave one out"
    if not vectors or vectors[0] != "r":
        yield f"the first nodal vector must be the position r, got {', '.join(vectors) or 'none'}", ""
    if tuple(map(sp.sympify, element.nodes)) != (sp.S.Zero, l):
        yield f"nodes must be at 0 and l, got {element.nodes}", "leave nodes out"
    if element.director and element.director not in set(vectors) & {"r_y", "r_z"}:
        yield (f'the director "{element.director}" is no nodal vector r_y or r_z of the element',
               'leave it empty where there is none: director=""')


def _monomials(element: Element) -> Iterator[tuple[str, str]]:
    """Yield what is wrong with the monomials of the basis, one by one and together."""
    found: list[tuple[int, int, int]] = []
    for number, given in enumerate(element.basis):
        f, here = sp.sympify(given), f"basis[{number}] = {given}"
        yield from _monomial(f, here, element.dim)
        powers = sp.Poly(f, x, y, z).monoms()[0]
        if powers in found:
            yield f"{here} stands twice in the basis", "leave one out"
        found.append(powers)
    yield from _span(found)


def _monomial(f: sp.Expr, here: str, dim: int) -> Iterator[tuple[str, str]]:
    """Yield what is wrong with a function of the basis, which `here` names."""
    allowed = (x, y, z)[:dim]
    strange = sorted(map(str, f.free_symbols - {x, y, z}))
    if strange:
        yield (f"r is not linear in the nodal vectors: {here} depends on {', '.join(strange)}, but the basis "
               "must be the same in every configuration", f"give monomials of {', '.join(map(str, allowed))} alone")
    if not f.is_polynomial(x, y, z):
        yield f"{here} is not a polynomial", f"give monomials of {', '.join(map(str, allowed))}"
    poly = sp.Poly(f, x, y, z)
    if len(poly.terms()) != 1 or poly.LC() != 1:
        yield (f"{here} is not a monomial; r is any combination of the basis, so sums and factors say nothing more",
               "list the monomials that it is made of")
    powers = poly.monoms()[0]
    if dim == 2 and powers[2]:
        yield f"{here} has z, but dim is 2", ""
    if sum(powers[1:]) > SECTION_DEGREE["element"]:
        yield f"{here} is of degree {sum(powers[1:])} across the section; section moments serve up to degree 2", ""


def _span(found: list[tuple[int, int, int]]) -> Iterator[tuple[str, str]]:
    """Yield what the span of monomials with these powers of x, y, z lacks."""
    if (0, 0, 0) not in found:
        yield "no rigid motion: the basis has no constant, so that the element cannot be moved", "add 1 as the first"
    if (1, 0, 0) not in found:
        yield "no constant strain: the basis has no x, so that the element cannot be straight or turned", "add x"
    if found[0] != (0, 0, 0):
        yield "the constant 1 must be the first of the basis", ""
    for a, b, c in found:
        if a and (a - 1, b, c) not in found:
            have, lack = (x**n * y**b * z**c for n in (a, a - 1))
            yield f"the basis has {have} without {lack}: its span changes with the place where x begins", f"add {lack}"
    for axis, powers in zip((y, z), ((0, 1, 0), (0, 0, 1)), strict=True):
        if powers not in found and any(p[1 + (axis == z)] for p in found):
            yield f"no constant strain: the basis has powers of {axis}, but not {axis} itself", f"add {axis}"


def _laws(element: Element) -> Iterator[tuple[str, str]]:
    """Yield what is wrong with the laws: their names, and what they need of the basis."""
    if not element.laws:
        yield "there is no law", 'give laws=("green_exact",), say'
    for law in element.laws:
        if isinstance(law, str) and law not in LAWS:
            yield f'law "{law}" is not known', near(law, LAWS)
        if not isinstance(law, str):
            yield from _own_law(law)
    names = [law_name(law) for law in element.laws]
    if len(set(names)) < len(names) or any(n in LAWS and not isinstance(law, str)
                                           for n, law in zip(names, element.laws, strict=True)):
        yield f"a law stands twice, or has the name of one of funicular's: {', '.join(names)}", "give another name"
    for law in element.laws:
        yield from _law_on_basis(element, law)


def _own_law(law: type) -> Iterator[tuple[str, str]]:
    """Yield what a class of the user's lacks to be a law."""
    name, borrowed = getattr(law, "name", None), getattr(law, "stiffness_of", None)
    if not isinstance(name, str) or not re.fullmatch(r"[a-z][a-z0-9_]*", name):
        yield f"law {law!r} must have a name of small letters, digits and _, got {name!r}", 'write name = "..."'
    if borrowed not in LAWS:
        yield (f'law "{name}" must say in `stiffness_of` the law of funicular whose section stiffness it '
               f"takes, got {borrowed!r}", "known: " + ", ".join(LAWS))


def _law_on_basis(element: Element, law: str | type) -> Iterator[tuple[str, str]]:
    """Yield what keeps a law from the element's basis."""
    name, across = law_name(law), {v for v in (y, z) if any(sp.sympify(f).has(v) for f in element.basis)}
    if TRAITS[stiffness_of(law)].kind == "cable":
        if across:
            more = ", ".join(sorted(map(str, across)))
            yield (f"law {name} knows the centreline alone, but the basis has {more}: "
                   "nothing resists the deformation of the section", "take the law continuum")
        if isinstance(law, str) and all(sp.diff(sp.sympify(f), x, 2) == 0 for f in element.basis):
            yield (f"law {name} resists bending, but no function of the basis is curved along x: elements would be "
                   "straight, with hinges between them", "add x**2 and x**3, and r_x to the nodal vectors")
        return
    if len(across) < element.dim - 1:
        missing = ", ".join(str(v) for v in (y, z)[: element.dim - 1] if v not in across)
        yield f"law {name} needs the section's deformation, but the basis has no {missing}", "take a law of cables"
    for f in element.basis:
        if sum(sp.Poly(f, x, y, z).monoms()[0][1:]) > SECTION_DEGREE["continuum"]:
            yield f"law {name} takes a basis linear across the section, but this one has {f}", ""


def _functionals(element: Element) -> Iterator[tuple[str, str]]:
    """Yield the nodal conditions that are not linear in the function, of a class derived from Element."""
    basis = [sp.sympify(f) for f in element.basis]
    for f, g in pairwise(basis):
        alone, both = element.nodal_conditions([f, g]), element.nodal_conditions([2 * f + 3 * g])
        for row, name in enumerate(element.names):
            if sp.simplify(2 * alone[row, 0] + 3 * alone[row, 1] - both[row, 0]) != 0:
                yield f"r is not linear in the nodal vectors: the nodal condition {name} is not linear in r", ""


def _conditions(element: Element) -> Iterator[tuple[str, str]]:
    """Yield why the nodal conditions do not fix the basis: which of them depend on others, what stays undetermined."""
    basis = [sp.sympify(f) for f in element.basis]
    conditions = element.nodal_conditions(basis)
    rows, columns = conditions.shape
    depend = [_combination(v, element.names) for v in conditions.T.nullspace()]
    free = [_combination(v, basis) for v in conditions.nullspace()]
    if depend or free:
        parts = [f"dependent conditions: {', '.join(f'{d} = 0 for every function of the basis' for d in depend)}"
                 ] * bool(depend)
        parts += [f"undetermined: {', '.join(free)}, zero in every nodal condition"] * bool(free)
        count = "" if rows == columns else f" ({rows} conditions, {columns} functions)"
        yield (f"the nodal conditions are singular{count}: " + "; ".join(parts),
               "as many nodal vectors over the two nodes as functions in the basis, each fixing one of its own")


def _combination(vector: sp.Matrix, of: Sequence[Any]) -> str:
    """Return the sum of a null vector's entries times what they stand for."""
    terms = [(sp.factor(c), name) for c, name in zip(vector, of, strict=True) if c != 0]
    lead = terms[0][0]
    return str(sp.Add(*(sp.cancel(c / lead) * (name if isinstance(name, sp.Basic) else sp.Symbol(name))
                        for c, name in terms)))
