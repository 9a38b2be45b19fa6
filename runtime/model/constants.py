"""Constants of an elastic law on the elements of a cable, A of the law's kernels."""

from __future__ import annotations

from collections.abc import Callable, Iterator
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
PLANAR = 4
"""Elastic constants of a planar continuum; a spatial one has nine."""


def constants(cable: Cable, axial: float = 1.0,
              change: Callable[[np.ndarray], np.ndarray] | None = None) -> np.ndarray:
    """Return (elements, n), or (1, n) for equal elements with a straight stress-free shape.

    axial: a factor of EA, of a cable's law alone; change: of the stiffness of a section.
    """
    growth, reference = cable.growth.start, cable.reference
    lengths = growth * (cable.mesh.all_lengths if cable.is_curved and reference is not None else cable.mesh.lengths)
    if reference is not None and growth != 1.0:
        reference = grown_shape(cable, reference, np.array(growth))
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
