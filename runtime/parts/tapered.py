"""Pieces of cables whose section changes along them: tapered tethers, bend stiffeners."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

from ..errors import SceneError
from .material import Material
from .piece import Piece
from .section import Circle, Section, Tube
from .validation import check_function, number, positive_number, show, vector, whole_number

WHERE = "tapered"
MAX_PIECES = 1000


def tapered(s: Sequence[float], diameter: Sequence[float], *, material: Material,
            inner_diameter: Sequence[float] | None = None, elements: int = 1, tol: float = 1e-2) -> list[Piece]:
    """Return pieces of a cable with round sections by a table, linear between its places.

    s: arc-lengths from 0, m. diameter, inner_diameter: there, m; without the inner one sections are solid. elements: of
    each piece. tol: of the bending stiffness of a piece. Each piece has the section in its middle; its compliance in
    bending errs by less than the square of the change of the diameter along it over the least diameter (of tubes with
    walls that stay thin likewise), in tension and mass by a sixth of that. Raises SceneError.

    >>> import funicular as fu
    >>> steel = fu.Material(youngs_modulus=2e11, poisson_ratio=0.3, density=7800)
    >>> len(fu.tapered([0, 1, 2], [0.2, 0.1, 0.1], material=steel))
    11
    """
    try:
        places, outer = (vector(each, "m", len(each)) for each in (s, diameter))
        inner = None if inner_diameter is None else vector(inner_diameter, "m", len(inner_diameter))
        check_function(places, "s", "m", outer, "diameter")
        if inner is not None:
            check_function(places, "s", "m", inner, "inner_diameter")
        if len(places) < 2 or places[0] != 0:
            raise ValueError(f"s must begin at 0 and have 2 places or more, got {show(places, 'm')}")
        for value in outer:
            positive_number(value, "m")
        error, of_each = positive_number(number(tol)), whole_number(elements)
    except (TypeError, ValueError) as error_of_value:
        raise SceneError(WHERE, *error_of_value.args) from None
    found: list[Piece] = []
    for k, (begin, end) in enumerate(pairwise(places)):
        n = max(1, math.ceil(abs(outer[k + 1] - outer[k]) / (min(outer[k : k + 2]) * math.sqrt(error))))
        if len(found) + n > MAX_PIECES:
            raise SceneError(WHERE, f"takes more than {MAX_PIECES} pieces", "give a larger tol")
        for part in range(n):
            share = (part + 0.5) / n
            found.append(Piece(length=(end - begin) / n, section=_section(k, share, outer, inner), material=material,
                               elements=of_each))
    return found


def _section(k: int, share: float, outer: tuple[float, ...], inner: tuple[float, ...] | None) -> Section:
    """Return the section at a share of interval number k of a table of diameters, m. Raises SceneError."""
    radius = (outer[k] + share * (outer[k + 1] - outer[k])) / 2
    hollow = 0.0 if inner is None else (inner[k] + share * (inner[k + 1] - inner[k])) / 2
    return Tube(outer_radius=radius, inner_radius=hollow) if hollow > 0 else Circle(radius=radius)
