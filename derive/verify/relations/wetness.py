"""Relations of the kernels of wet parts: the mean depth and its derivatives."""

from __future__ import annotations

from typing import Any

import mpmath
import numpy as np

from ..methods import Relation
from .paths import entry, from_kernel


def wetness() -> list[Relation]:
    """Return the relations of wet parts."""
    def per_root(output: str) -> Any:
        """Return an output of a section over the derivative of u by the angle, at an angle moved by t."""
        def moved(k, s, t, j):
            phi = s["phi"][0]
            root = mpmath.cos(phi) if isinstance(phi, mpmath.mpf) else np.cos(phi)
            return k("wet_section", s, phi=s["phi"] + t)[output] / root
        return moved

    def depth(edge: float, density: Any) -> Any:
        """Return the mean depth: the integral over heights y up to the surface of depth times the density of volume."""
        def integral(k, s, t, j):
            low = -1 - (s["delta"][0] if edge else 0)
            u = mpmath.sin(s["phi"][0]) if density is circle else s["u"][0]
            return np.array([mpmath.quad(lambda y: density(s, y) * (u - y), [low, u])])
        return integral

    def circle(s, y):
        return 2 / mpmath.pi * mpmath.sqrt(1 - y * y)

    def sphere(s, y):
        return 3 * (1 - y * y) / 4

    def column(s, y):
        return (1 + y + s["delta"][0]) / (4 * s["delta"][0])

    rates = ("e", "c"), ("c", "c_u"), ("c_u", "c_uu")
    return [
        Relation("wet_sphere", "e", "integral of depth over the volume", 0, depth(0, sphere)),
        Relation("wet_section", "e", "integral of depth over the area", 0, depth(0, circle)),
        Relation("wet_column", "e", "integral of depth over the volume", 0, depth(1, column)),
        *(Relation(kernel, rate, f"d {of} by u", 1, from_kernel(kernel, of, u=entry("u")), 1)
          for kernel in ("wet_sphere", "wet_column") for of, rate in rates),
        *(Relation("wet_section", rate, f"d {of} by u", 1, per_root(of), 1) for of, rate in rates),
    ]
