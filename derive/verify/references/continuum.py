"""The root of verification of a continuum: energy, dissipated power and section forces by quadrature, at 50 digits."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import mpmath
import numpy as np

from ...spec import Element
from ..motion import cross
from .element import Shape, density, gauss, section_points, spatial, stress

mp = mpmath.mp


def energy(element: Element, law: str, s: Any) -> Any:
    """Return the energy of eq 5-7 by quadrature, J."""
    total = mp.mpf(0)
    for N, weight, D in _material_points(element, s):
        F = s["e"].T.dot(N)
        total += weight * density(D, (F.T.dot(F) - np.eye(element.dim, dtype=int)) / 2)
    return total


def dissipation(element: Element, law: str, s: Any) -> Any:
    """Return the power of the viscous stress tau D dE/dt by quadrature."""
    total = mp.mpf(0)
    for N, weight, D in _material_points(element, s):
        F, rate = s["e"].T.dot(N), s["v"].T.dot(N)
        total += weight * 2 * density(D, (F.T.dot(rate) + rate.T.dot(F)) / 2)
    return s["tau"].item() * total


def _material_points(element: Element, s) -> Iterator[tuple[Any, ...]]:
    """Yield gradient of the shape functions, weight and elastic constants: D over the volume, D_axis on the axis alone.
    """
    shape = Shape(element, s["l"].item())
    height, width = s["rectangle"]
    for at, weight in shape.points(height, width):
        yield shape.gradient(at), weight, s["D"]
    for t, weight in gauss(2 * max(p[0] for p in shape.powers) + 1):
        yield shape.gradient((shape.l / 2 * (1 + t), 0, 0)), weight * shape.l / 2 * height * width, s["D_axis"]


def section(element: Element, law: str, s: Any) -> dict[str, np.ndarray]:
    """Return force (3,) in N, moment (3,) in N m and strain (6,) at x, see TEXTS of references/section.py."""
    shape, dim, x = Shape(element, s["l"].item()), element.dim, s["x"].item()
    force, moment = np.zeros(3, dtype=object), np.zeros(3, dtype=object)
    axis = shape((x, 0, 0)).dot(s["e"])
    for y, z, area, D in section_points(s):
        at = (x, y, z)
        F = s["e"].T.dot(shape.gradient(at))
        traction = area * spatial(F.dot(stress(D, green(F)))[:, 0])
        force = force + traction
        moment = moment + cross(spatial(shape(at).dot(s["e"]) - axis), traction)

    def strain(y, z):
        F = s["e"].T.dot(shape.gradient((x, y, z)))
        E = np.zeros((3, 3), dtype=object)
        E[:dim, :dim] = green(F)
        return E

    h = mp.mpf(1)  # polynomials of the second degree in y and z: central differences are exact
    here = strain(0, 0)
    by_y, by_z = ((strain(h * (k == 0), h * k) - strain(-h * (k == 0), -h * k)) / (2 * h) for k in (0, 1))
    measures = [here[0, 0], 2 * here[0, 1], 2 * here[0, 2], by_y[0, 2] - by_z[0, 1],
                by_z[0, 0], -by_y[0, 0]]
    return {"force": force, "moment": moment, "strain": np.array(measures)}


def green(F: np.ndarray) -> np.ndarray:
    """Return Green's strain (F'F - I)/2."""
    return (F.T.dot(F) - np.eye(len(F), dtype=int)) / 2
