"""The root of verification of cables: energy and dissipated power by quadrature, from their definitions, at 50 digits.

r' and r'' are formed at each point from the shape functions of verify/references/element.py, and nothing goes through
Gram products or invariants. Where a law is a polynomial, its kernels claim the exact integral; where it is not
(engineering strain, exact curvature, damping), the number of Gauss points is part of what it is.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import mpmath
import numpy as np

from ...algebra.gram import Gram
from ...laws import LAWS, TRAITS
from ...spec import Element
from ..motion import cross
from . import curved_cable
from .element import Shape, gauss, spatial

mp = mpmath.mp


def energy(element: Element, law: str, s: Any) -> Any:
    """Return 1/2 EA strain^2 + 1/2 EI curvature^2 along the axis; strain and curvature from the stress-free shape's."""
    traits, kernels = TRAITS[law], LAWS[law](Gram(element))
    strain, curvature = traits.strain, traits.curvature
    EI = s["S"][1]
    n_axial, n_bending = axial_points(element, law), len(kernels.bending_points)
    if traits.straight:
        return curved_cable.energy(element, strain, s, n_bending)
    total = mp.mpf(0)
    if traits.membrane == "assumed":
        l = s["l"].item()
        for m, (mode, stiffness) in enumerate(strain_modes(element, law, s)):
            total += l * stiffness * mode**2 / (2 * m + 1) / 2
    else:
        for weight, r_x, _, _, _ in _along(element, s, n_axial):
            total += weight * membrane_energy(law, axial_strain(strain, r_x), s)
    # two points more, where the kernels' number is claimed to be exact
    for weight, r_x, r_xx, _, _ in _along(element, s, n_bending + 2 * (curvature == "linear")):
        normal, length = cross(r_x, r_xx), mp.sqrt(r_x.dot(r_x))
        kappa = normal / length ** (3 if strain == "green" else 2) if curvature == "exact" else r_xx
        total += weight * EI * kappa.dot(kappa) / 2
    return total


def membrane_energy(law: str, strain: Any, s: Any) -> Any:
    """Return the energy per length of an axial strain. A cable that gives way in compression has a part of EA left
    there, and of the rest the force whose energy is (strain^2 + strain hypot(strain, t) - strain t)/4 times it.
    """
    EA, membrane = s["S"][0], TRAITS[law].membrane
    if membrane == "tabulated":
        return _work(s["S"][2:], strain)
    if membrane != "tension_only":
        return EA * strain**2 / 2
    left, transition = s["S"][2:]
    rest = strain**2 + strain * mp.sqrt(strain**2 + transition**2) - strain * transition
    return EA * (left * strain**2 / 2 + (1 - left) * rest / 4)


def _work(table: np.ndarray, strain: Any) -> Any:
    """Return the integral of a force by cubic segments, from the start of the first one."""
    segments = np.array(table[1 : 1 + 6 * int(table[0])]).reshape(-1, 6)
    held = [k for k, segment in enumerate(segments) if k == 0 or segment[0] <= strain][-1]
    start, energy, *force = segments[held]
    return energy + sum(factor * (strain - start) ** (k + 1) / (k + 1) for k, factor in enumerate(force))


def axial_points(element: Element, law: str) -> int:
    """Return the number of Gauss points of the membrane; two more than the kernels take, where their number is claimed
    to be exact.
    """
    kernels, traits = LAWS[law](Gram(element)), TRAITS[law]
    n, degree = len(kernels.axial_points), kernels.degree
    exact = (3 * degree - 1) // 2 if traits.membrane == "assumed" else 2 * degree - 1
    return n + 2 * (traits.strain == "green" and n >= exact)


def axial_strain(strain: str, r_x: np.ndarray) -> Any:
    """Return the Green or the engineering strain."""
    square = r_x.dot(r_x)
    return (square - 1) / 2 if strain == "green" else mp.sqrt(square) - 1


def strain_modes(element: Element, law: str, s: Any) -> list[tuple[Any, ...]]:
    """Return the Legendre modes of the axial strain that an assumed one has, and the axial stiffness of each.

    One mode a power of the slope; those beyond what a node has along the cable take the third stiffness.
    """
    strain, n = TRAITS[law].strain, max(p[0] for p in Shape(element, s["l"].item()).powers)
    full, _, upper = s["S"]
    found, l = [mp.mpf(0)] * n, s["l"].item()
    points = axial_points(element, law)
    for (t, _), (weight, r_x, *_) in zip(gauss(points), _along(element, s, points), strict=True):
        for m in range(n):
            found[m] += weight * (2 * m + 1) / l * mp.legendre(m, t) * axial_strain(strain, r_x)
    nodes = len(element.nodes)
    return [(mode, full if m < (n + 1) // nodes else upper) for m, mode in enumerate(found)]


def dissipation(element: Element, law: str, s: Any) -> Any:
    """Return W_strain,strain tau strain'^2 + EI tau |D_t r''|^2, W the energy per length of the strain, D_t the rate as
    seen from a frame that turns with the tangent.
    """
    strain, EI = TRAITS[law].strain, s["S"][1]
    degree = max(p[0] for p in Shape(element, s["l"].item()).powers)
    total = mp.mpf(0)
    for weight, r_x, _, v_x, _ in _along(element, s, degree):
        rate = r_x.dot(v_x) / (1 if strain == "green" else mp.sqrt(r_x.dot(r_x)))
        stiffness = mp.diff(lambda at: membrane_energy(law, at, s), axial_strain(strain, r_x), 2)
        total += weight * stiffness * rate**2
    for weight, r_x, r_xx, v_x, v_xx in _along(element, s, degree - 1):
        seen = v_xx - cross(cross(r_x, v_x) / r_x.dot(r_x), r_xx)  # the tangent turns with r' x dr'/dt / r'.r'
        total += weight * EI * seen.dot(seen)
    return s["tau"].item() * total


def turning(element: Element, law: str, s: Any) -> Any:
    """Return EA |dr'|^2/8 over N' N'; of an assumed strain by its modes."""
    shape, half = Shape(element, s["l"].item()), s["l"].item() / 2
    degree = max(p[0] for p in shape.powers)
    assumed = TRAITS[law].membrane == "assumed"
    points = []
    for t, weight in gauss(2 * degree if assumed else degree):
        N_x = shape((half * (1 + t), 0, 0), (1, 0, 0))
        change = N_x.dot(s["e_next"] - s["e"])
        points.append((t, weight, N_x, change.dot(change) / 8))
    if not assumed:
        return sum(weight * half * s["A"][0] * strain * np.outer(N_x, N_x) for _, weight, N_x, strain in points)
    total = mp.mpf(0)
    for m in range(degree):
        mode = sum(weight * mp.legendre(m, t) * strain for t, weight, _, strain in points) * (2 * m + 1) / 2
        EA = s["A"][0 if m < (degree + 1) // len(element.nodes) else 2]
        total = total + sum(weight * half * EA * mode * mp.legendre(m, t) * np.outer(N_x, N_x)
                            for t, weight, N_x, _ in points)
    return total


def _along(element: Element, s, n: int) -> Iterator[tuple[Any, ...]]:
    """Yield, at n Gauss points of the axis, weight, r', r'' and their rates, all in three dimensions."""
    shape, half = Shape(element, s["l"].item()), s["l"].item() / 2
    for t, weight in gauss(n):
        at = (half * (1 + t), 0, 0)
        N_x, N_xx = shape(at, (1, 0, 0)), shape(at, (2, 0, 0))
        yield weight * half, *(spatial(N.dot(d)) for d in (s["e"], s["v"]) for N in (N_x, N_xx))
