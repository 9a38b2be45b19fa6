"""Constants of an elastic law on the elements of a cable, A of the law's kernels."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import chain
from typing import Any

import numpy as np

from ..base.quadrature import gauss
from ..kernels.elements import part_of_manifest
from ..kernels.libraries import kernels_of, of_library
from ..parts.cable import Cable
from ..parts.section_stiffness import section_stiffness

GROWTH_POWERS = {"r": 1.0, "r_xx": -1.0}
"""Powers of the growth factor of the vectors of a stress-free shape."""
POINTS = 5
"""Gauss points along an element: exact for a straight stress-free shape, of the eighth degree."""
DIFFERENCE = 1e-3
"""Step of differences by a growth factor, over the least factor: of the sixth order, they are exact to rounding."""
POLE, MORE_TERMS = 0.25, 4
"""Factor over the least one beyond which no law's constants have a pole, but for 0 those of straight beams; terms of a
series beyond those of a simple pole."""
PLANAR = 4
"""Elastic constants of a planar continuum; a spatial one has nine."""


def constants(cable: Cable, axial: float = 1.0, change: Callable[[np.ndarray], np.ndarray] | None = None,
              growth: Sequence[float] | None = None) -> np.ndarray:
    """Return (elements, n), or (1, n) for equal elements with a straight stress-free shape.

    axial: a factor of EA, of a cable's law alone; change: of the stiffness of a section; growth: factors of the
    stress-free lengths of the pieces, by default those at t = 0.
    """
    growth = [each.start for each in cable.growth] if growth is None else growth
    factors, reference = cable.repeated(growth), cable.reference
    each_own = (cable.is_curved and reference is not None) or not cable.mesh.is_even
    lengths = factors * cable.mesh.all_lengths if each_own else growth[0] * cable.mesh.lengths
    if reference is not None and any(factor != 1.0 for factor in growth):
        reference = grown_shape(cable, reference, factors)
    sections = [section_stiffness(cable.stiffness_law, piece.section, piece.material, cable.dim)
                for piece in cable.uniform_pieces]
    if axial != 1.0:  # of EA, EI, and EA of the upper modes of an assumed strain
        sections = [S * [axial, 1.0, axial][: len(S)] for S in sections]
    if change is not None:
        sections = [change(S) for S in sections]
    shapes = [None] * len(lengths) if reference is None else reference[: len(lengths)]
    each = sections * len(lengths) if len(sections) == 1 else list(
        chain.from_iterable([S] * (piece.end - piece.first)
                            for piece, S in zip(cable.uniform_pieces, sections, strict=True)))
    return np.array([element_constants(cable.library, cable.element, cable.kernel_law, float(length), S, e0)
                     for length, S, e0 in zip(lengths, each, shapes, strict=True)])


def series(cable: Cable) -> np.ndarray:
    """Return (1 or elements, 3 + terms n): `constants` as Chebyshev polynomials of the growth factors between the
    bounds of their signals, to rounding (Trefethen, Approximation Theory and Approximation Practice, ch. 3 and 8).

    First come the middle of the factors, the inverse of half their range, and the step of differences by a factor,
    three of which lie beyond the bounds.
    """
    chebyshev = np.polynomial.chebyshev
    step = [DIFFERENCE * driven.least for driven in cable.growth]
    low = np.array([driven.least - 4 * h for driven, h in zip(cable.growth, step, strict=True)])
    high = np.array([driven.greatest + 4 * h for driven, h in zip(cable.growth, step, strict=True)])
    middle, half = (low + high) / 2, (high - low) / 2
    pole = float(((low + high - 2 * POLE * low) / (high - low)).min())
    terms = MORE_TERMS + int(np.log(1 / np.finfo(float).eps) / np.log(pole + np.sqrt(pole**2 - 1)))
    places = chebyshev.chebpts1(terms)
    each = np.array([constants(cable, growth=(middle + half * x).tolist()) for x in places])
    found = chebyshev.chebfit(places, each.reshape(terms, -1), terms - 1).reshape(each.shape)
    head = np.stack([middle, 1 / half, step], axis=1)
    head = head[:1] if each.shape[1] == 1 else cable.repeated(head)
    return np.concatenate([head, np.moveaxis(found, 1, 0).reshape(len(head), -1)], axis=1)


def grown_shape(cable: Cable, shape: np.ndarray, growth: np.ndarray) -> np.ndarray:
    """Return stress-free shapes of elements (..., 2 vectors, dim) after growth by factors (...): their angles stay."""
    powers = np.array([GROWTH_POWERS.get(name, 0.0) for name in cable.kind_of_element.nodal_vectors] * 2)
    return np.asarray(shape * growth[..., None, None] ** powers[:, None])


def element_constants(library: str | None, element: str, law: str, length: float, S: np.ndarray,
                      e0: np.ndarray | None = None) -> np.ndarray:
    """Return (n,): A of one element of a library, or of this package.

    e0 (nodal vectors, dim): its stress-free shape, for laws that depend on it.
    """
    kernels, traits = kernels_of(library), of_library(library)[element].laws[law]
    if traits.kind == "continuum" and traits.straight:
        straight = getattr(kernels, f"{element}_{traits.straight}_stiffness")
        return np.concatenate([straight(length, S),
                               *integral_over_volume(getattr(kernels, f"{element}_{law}_stiffness_at"), length, e0, S)])
    return np.asarray(getattr(kernels, f"{element}_{law}_stiffness")(length, *([] if e0 is None else [e0]), S))


def integral_over_volume(stiffness_at: Callable[..., Any], length: float, e0: np.ndarray | None,
                         S: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the integral of the kernel `stiffness_at`: the form over Gram products, and the Gram products of e0."""
    places, weights = gauss(POINTS)
    shares = []
    for x, weight in zip(length / 2 * (1 + places), length / 2 * weights, strict=True):
        shares += [stiffness_at(length, e0, np.array([x, y, z]), weight * D) for y, z, D in section_points(S)]
    return sum(form for form, _ in shares), shares[0][1]


def section_points(S: np.ndarray) -> Iterator[tuple[float, float, np.ndarray]]:
    """Yield the nine points of a section, three of a planar one, that reproduce its table S, as in kernels of stress.

    S: (9, 6) or, planar, (4, 6), see `section_stiffness`. Yields y, z in m and the elastic constants times the area of
    the point, in N.
    """
    full, by_y, by_z, _, by_both, _ = S.T
    y2, z2 = S[0, 3] / S[0, 1], S[0, 5] / S[0, 2]
    of_y, of_z, of_both = by_y / y2, by_z / z2, by_both / (y2 * z2)
    if len(S) == PLANAR:
        of_z, of_both = 0 * of_z, 0 * of_both
    for i, k, shares in part_of_manifest("section_points"):
        D = sum(share * integral for share, integral in zip(shares, (full, of_y, of_z, of_both), strict=True))
        if len(S) != PLANAR or k == 0:
            yield from ((y * np.sqrt(y2), z * np.sqrt(z2), D) for y in sorted({i, -i}) for z in sorted({k, -k}))
