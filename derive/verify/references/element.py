"""The roots of verification: shape functions and integrals that share nothing with the derivation but the spec.

Shape functions come from a numerical solve of the nodal conditions, integrals from Gauss quadrature with as many
points as the integrand's degree asks for, all at 50 digits. Nothing goes through algebra/gram.py or
algebra/section_integrals.py.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache
from itertools import product
from typing import Any

import mpmath
import numpy as np
import sympy as sp

from ...spec import Element, x, y, z
from ..exact import DIGITS

mp = mpmath.mp


@lru_cache
def gauss(n: int) -> tuple[tuple[Any, ...], ...]:
    """Return the points and weights on [-1, 1], Newton from the double values."""
    rule = []
    with mpmath.workdps(DIGITS + 10):
        for start in np.polynomial.legendre.leggauss(n)[0]:
            t = mp.mpf(start)
            for _ in range(4):
                last, value = mp.legendre(n - 1, t), mp.legendre(n, t)
                slope = n * (last - t * value) / (1 - t * t)
                t -= value / slope
            slope = n * mp.legendre(n - 1, t) / (1 - t * t)
            rule.append((t, 2 / ((1 - t * t) * slope * slope)))
    return tuple(rule)


class Shape:
    """N_k(x, y, z) of an element of length l, from a numerical solve of its nodal conditions."""

    def __init__(self, element: Element, l: Any):
        self.element, self.l = element, mp.mpf(l)
        self.powers = [sp.Poly(b, x, y, z).monoms()[0] for b in element.basis]
        conditions = mp.matrix([[_monomial(p, by, (node, 0, 0)) for p in self.powers]
                                for node, by in self._functionals()])
        self._coefficients = mp.inverse(conditions)

    def _functionals(self) -> Iterator[tuple[Any, ...]]:
        for ratio in self.element.node_ratios:
            for vector in self.element.nodal_vectors:
                by = tuple(vector.partition("_")[2].count(c) for c in "xyz")
                yield self.l * int(ratio.p) / int(ratio.q), by

    def __call__(self, at: Any, by: tuple[int, int, int] = (0, 0, 0)) -> np.ndarray:
        """Return N at a point, or the derivative `by` times in x, y, z."""
        basis = mp.matrix([[_monomial(p, by, at) for p in self.powers]])
        return np.array(list(basis * self._coefficients), dtype=object)

    def gradient(self, at: Any) -> np.ndarray:
        """Return dN_k/dx_i, (vectors, dim)."""
        return np.stack([self(at, by) for by in np.eye(3, dtype=int)[: self.element.dim].tolist()], axis=1)

    def points(self, height: Any, width: Any) -> list[tuple[tuple[Any, ...], object]]:
        """Return the points and weights of a rectangle times the length, exact for the energy and for the kinetic
        energy.
        """
        highest = np.max(self.powers, axis=0)
        rules = [gauss(2 * int(d) + 1) for d in highest]
        half = (self.l / 2, mp.mpf(height) / 2, mp.mpf(width) / 2)
        found = []
        for (a, p), (b, q), (c, r) in product(*rules):
            at = (half[0] * (1 + a), half[1] * b, half[2] * c)
            found.append((at, p * q * r * half[0] * half[1] * half[2]))
        return found


def _monomial(powers, by, at):
    value = mp.mpf(1)
    for n, k, t in zip(powers, by, at, strict=True):
        if k > n:
            return mp.mpf(0)
        value *= mp.ff(n, k) * mp.mpf(t) ** (n - k)
    return value


def mass(element: Element, s: Any) -> np.ndarray:
    """Return the mass matrix m of eq 4 by quadrature."""
    shape = Shape(element, s["l"].item())
    return s["density"].item() * sum(weight * np.outer(N := shape(at), N) for at, weight in
                                     shape.points(*s["rectangle"]))


def gravity(element: Element, s: Any) -> np.ndarray:
    """Return the generalised force of gravity by quadrature."""
    shape = Shape(element, s["l"].item())
    weights = sum(weight * shape(at) for at, weight in shape.points(*s["rectangle"]))
    return np.outer(s["density"].item() * weights, s["g"])


def density(D: np.ndarray, E: np.ndarray) -> Any:
    """Return the strain energy density of the orthotropic law: 1/2 sum D_ij E_ii E_jj + 1/2 sum G (2 E_ij)^2."""
    dim = len(E)
    off = [(i, j) for i in range(dim) for j in range(i + 1, dim)]
    normal, cross, shear = D[:dim], D[dim : dim + len(off)], D[dim + len(off) :]
    total = sum(normal[i] * E[i, i] ** 2 for i in range(dim)) / 2
    total += sum(d * E[i, i] * E[j, j] for d, (i, j) in zip(cross, off, strict=True))
    return total + 2 * sum(g * E[i, j] ** 2 for g, (i, j) in zip(shear, off, strict=True))


def stress(D: np.ndarray, E: np.ndarray) -> np.ndarray:
    """Return the second Piola-Kirchhoff stress of the orthotropic law."""
    dim = len(E)
    off = [(i, j) for i in range(dim) for j in range(i + 1, dim)]
    law = np.diag(list(D[:dim]))
    found = np.zeros((dim, dim), dtype=object)
    for k, (i, j) in enumerate(off):
        law[i, j] = law[j, i] = D[dim + k]
        found[i, j] = found[j, i] = 2 * D[dim + len(off) + k] * E[i, j]
    normal = law.dot(np.diag(E))
    for i in range(dim):
        found[i, i] = normal[i]
    return found


def section_points(s: Any) -> Iterator[tuple[Any, ...]]:
    """Yield y, z, area and elastic constants of the sample's section: D all over it, D_axis on the axis alone."""
    height, width = (mp.mpf(v) for v in s["rectangle"])
    for (a, p), (b, q) in product(gauss(3), gauss(3)):
        yield a * height / 2, b * width / 2, p * q * height * width / 4, s["D"]
    yield mp.mpf(0), mp.mpf(0), height * width, s["D_axis"]


def spatial(vector: np.ndarray) -> np.ndarray:
    """Return a vector of the plane or of space with three components."""
    return np.concatenate([vector, [mp.mpf(0)] * (3 - len(vector))])
