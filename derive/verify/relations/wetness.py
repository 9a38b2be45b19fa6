"""Relations of the kernels of wet parts: the mean depth, and the energy of the fluid."""

from __future__ import annotations

from typing import Any

import mpmath
import numpy as np

from ...codegen.family import CouplingFamily
from ..methods import Relation
from ..motion import swung_axes
from ..numbers import State
from .paths import entry, from_kernel, unit


def wetness(family: CouplingFamily) -> list[Relation]:
    """Return the relations of wet parts, and of the inertia of the fluid from their change."""
    return [*_wet_parts(), *_entry(family.dim)]


def _wet_parts() -> list[Relation]:
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


def _entry(dim: int) -> list[Relation]:
    turns = 3 if dim == 3 else 1

    def impulse(k: Any, s: State, kernel: str) -> Any:
        return k("impulse_of_point" if kernel == point else "impulse_of_cable", s)["p"]

    def rate(kernel):
        return lambda k, s, t, j: s["n"].dot(s["v"]) * impulse(k, s, kernel)

    def energy(kernel):
        return lambda k, s, t, j: impulse(k, s, kernel).dot(s["w"]) / 2 * s["n"]

    def force(kernel, change):
        def moved(k, s, t, j):
            out = k(kernel, change(s, t, j))
            return out["p_rate"] - out["g"]
        return moved

    def along(name):
        return lambda s, t, j: {**s, name: s[name] + t * unit(s[name], j)}

    def swung(s, t, j):
        return {**s, "A": s["A"] + t * swung_axes(np.eye(turns, dtype=int)[j], s["A"])}

    cable, point = "entry_of_cable", "entry_of_point"
    return [
        *(Relation(kernel, "p_rate", "rate of c times the impulse", 0, rate(kernel)) for kernel in (cable, point)),
        *(Relation(kernel, "g", "energy times the derivative of c", 0, energy(kernel)) for kernel in (cable, point)),
        *(Relation(kernel, f"f_{name}", f"d (p_rate - g) by {name}", 1, force(kernel, along(name)), dim)
          for kernel, names in ((cable, "twvn"), (point, "wvn")) for name in names),
        Relation(point, "f_turn", "d (p_rate - g) by a turn", 1, force(point, swung), turns),
    ]
