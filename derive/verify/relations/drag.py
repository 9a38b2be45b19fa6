"""What the kernels of drag are derivatives of: the force, of a potential by the relative velocity."""

from __future__ import annotations

from typing import Any

from ...codegen.family import CouplingFamily
from ..methods import Relation
from .added_mass import added_mass
from .paths import entry, from_kernel


def _cube(vector: Any) -> Any:
    """Return the cube of a vector's length."""
    return vector.dot(vector) ** 1.5


def drag(family: CouplingFamily) -> list[Relation]:
    """Return the relations of force and derivatives.

    The potential is a third of the power, |t| (c_n |w_n|^3 + c_t |w_t|^3)/3, which shares nothing with the derivation.
    """
    dim = family.dim

    def potential(k, s, t, j):
        slope, w = s["t"], s["w"] + t * entry("w")(s, j)
        along = slope * (slope.dot(w) / slope.dot(slope))
        normal, tangential, _ = s["c"]
        return slope.dot(slope) ** 0.5 * (normal * _cube(w - along) + tangential * _cube(along)) / 3

    def of_point(k, s, t, j):
        return s["c_point"][0] * _cube(s["w"] + t * entry("w")(s, j)) / 3

    return [Relation("along_cable", "f", "derivative by w of |t| (c_n |w_n|^3 + c_t |w_t|^3)/3", 1, potential, dim),
            *(Relation("along_cable", f"f_{name}", f"df by {name}", 1,
                       from_kernel("along_cable", "f", **{name: entry(name)}), dim) for name in "tw"),
            Relation("on_point", "f", "derivative by w of c |w|^3/3", 1, of_point, dim),
            Relation("on_point", "f_w", "df by w", 1, from_kernel("on_point", "f", w=entry("w")), dim),
            *added_mass(family)]
