"""The root of verification of a continuum with a curved stress-free shape e0: eq 5 and 7 by quadrature, at 50 digits.

Strain is J0^-T (F'F - F0'F0) J0^-1 / 2 in global axes, turned to the tangent frame by Gram-Schmidt; volume is det J0 of
the straight one.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import mpmath
import numpy as np

from ...spec import Element
from ..motion import cross, frame
from .element import Shape, density, gauss, section_points, spatial, stress

mp = mpmath.mp
ALONG = 5  # Gauss points of the sample's A, of which A is the sum


class Body:
    """An element in space with its stress-free shape."""

    def __init__(self, element: Element, s: Any):
        self.shape, self.s, self.dim = Shape(element, s["l"].item()), s, element.dim
        self.director = "xyz".index(element.director[-1])

    def gradient(self, name: str, at: Any) -> np.ndarray:
        """Return F of the nodal vectors e, e0 or v."""
        return self.s[name].T.dot(self.shape.gradient(at))

    def frame(self, x: Any) -> np.ndarray:
        """Return the tangent frame of the stress-free axis, by columns."""
        F0 = self.gradient("e0", (x, 0, 0))
        return frame(mp, F0[:, 0], F0[:, self.director])

    def turned(self, at: Any, change: np.ndarray) -> np.ndarray:
        """Return J0^-T change J0^-1 in the tangent frame."""
        inverse = _inverse(self.gradient("e0", at)).dot(self.frame(at[0]))
        return inverse.T.dot(change).dot(inverse)

    def strain(self, at: Any) -> np.ndarray:
        """Return the Green strain E in the tangent frame."""
        F, F0 = self.gradient("e", at), self.gradient("e0", at)
        return self.turned(at, (F.T.dot(F) - F0.T.dot(F0)) / 2)

    def volume(self, at: Any) -> Any:
        """Return det J0, the volume by that of the straight element."""
        return mp.det(mp.matrix(self.gradient("e0", at)))


def _inverse(matrix: np.ndarray) -> np.ndarray:
    return np.array(mp.inverse(mp.matrix(matrix)).tolist(), dtype=object)


def weighted_points(element: Element, s: Any) -> Iterator[tuple[Any, ...]]:
    """Yield the points of the volume and the elastic constants times what each stands for."""
    half = mp.mpf(s["l"].item()) / 2
    for t, p in gauss(ALONG):
        for y, z, area, D in section_points(s):
            yield np.array([half * (1 + t), y, z]), half * p * area * D


def energy(element: Element, law: str, s: Any) -> Any:
    """Return the elastic energy by quadrature, J."""
    body = Body(element, s)
    return sum(body.volume(at) * density(D, body.strain(at)) for at, D in weighted_points(element, s))


def density_at(element: Element, s: Any) -> Any:
    """Return the energy that the point `at` adds with the elastic constants D."""
    body = Body(element, s)
    return body.volume(s["at"]) * density(s["D"], body.strain(s["at"]))


def section(element: Element, law: str, s: Any) -> dict[str, np.ndarray]:
    """Return the resultants of P N dA, N dA = det J0 J0^-T e_x dy dz, and strain on the axis with its changes along y
    and z.
    """
    body, x = Body(element, s), s["x"].item()
    R, axis = body.frame(x), body.shape((x, 0, 0)).dot(s["e"])
    force, moment = np.zeros(3, dtype=object), np.zeros(3, dtype=object)
    for y, z, area, D in section_points(s):
        at = (x, y, z)
        F0_inverse = _inverse(body.gradient("e0", at))
        second = R.dot(stress(D, body.strain(at))).dot(R.T)
        P = body.gradient("e", at).dot(F0_inverse).dot(second)
        traction = area * body.volume(at) * spatial(P.dot(F0_inverse[0]))
        force = force + traction
        moment = moment + cross(spatial(body.shape(at).dot(s["e"]) - axis), traction)

    def change(y, z):
        F, F0 = body.gradient("e", (x, y, z)), body.gradient("e0", (x, y, z))
        E = np.zeros((3, 3), dtype=object)
        E[: body.dim, : body.dim] = body.turned((x, 0, 0), (F.T.dot(F) - F0.T.dot(F0)) / 2)
        return E

    here = change(0, 0)
    by_y, by_z = ((change(k == 0, k) - change(-(k == 0), -k)) / 2 for k in (0, 1))
    strain = [here[0, 0], 2 * here[0, 1], 2 * here[0, 2], by_y[0, 2] - by_z[0, 1], by_z[0, 0], -by_y[0, 0]]
    return {"force": force, "moment": moment, "strain": np.array(strain)}
