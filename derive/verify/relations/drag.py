"""Relations of the kernels of drag: the force is the derivative of a potential by the relative velocity."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...codegen.family import CouplingFamily
from ..methods import Relation
from ..motion import cross
from .added_mass import added_mass
from .paths import entry, from_kernel, unit
from .section_flow import section_flow
from .waves import waves
from .wetness import wetness


def _cube(vector: Any) -> Any:
    """Return the cube of a vector's length."""
    return vector.dot(vector) ** 1.5


def _normal(s: Any) -> Any:
    return s["w"] - s["t"] * (s["t"].dot(s["w"]) / s["t"].dot(s["t"]))


def _across(s: Any, w: Any) -> Any:
    """Return the part of w across the span."""
    return w - s["s"] * s["s"].dot(w) if len(w) == 3 else w


def _turned(s: Any, w: Any) -> Any:
    """Return the span times w, a quarter of a turn in the plane."""
    return cross(s["s"], w) if len(w) == 3 else s["s"][0] * np.array([-w[1], w[0]])


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

    def of_foil(k, s, t, j):
        """Return the force with the coefficients at the angle that w, moved by t along entry j, has turned by."""
        moved = s["w"] + t * unit(s["w"], j)
        before, after = (_across(s, w) for w in (s["w"], moved))
        angle = _turned(s, before).dot(after) / before.dot(before)  # to first order in t
        drag, drag_rate, lift, lift_rate = s["coefficients"]
        size = after.dot(after) ** 0.5
        along, up = drag + drag_rate * angle, lift + lift_rate * angle
        return s["c_foil"][0] * size * (along * after + up * _turned(s, after))

    lift = [Relation("lift_along_cable", "f", "c |w_n| t x w", 0, lambda k, s, t, j: s["c_lift"][0] * cross(
                s["t"], s["w"]) * (_normal(s).dot(_normal(s))) ** 0.5),
            *(Relation("lift_along_cable", f"f_{name}", f"df by {name}", 1,
                       from_kernel("lift_along_cable", "f", **{name: entry(name)}), dim) for name in "tw")]
    return [*([*lift, *section_flow()] if dim == 3 else []),
            Relation("on_foil", "f", "c |w_p| (C_D w_p + C_L s x w_p)", 0, lambda k, s, t, j: of_foil(k, s, 0, 0)),
            Relation("on_foil", "f_w", "df by w, coefficients with the angle", 1, of_foil, dim),
            *(Relation(kernel, "f", "derivative by w of |t| (c_n |w_n|^3 + c_t |w_t|^3)/3", 1, potential, dim)
              for kernel in ("along_cable", "force_along_cable")),
            *(Relation("along_cable", f"f_{name}", f"df by {name}", 1,
                       from_kernel("along_cable", "f", **{name: entry(name)}), dim) for name in "tw"),
            Relation("on_point", "f", "derivative by w of c |w|^3/3", 1, of_point, dim),
            Relation("on_point", "f_w", "df by w", 1, from_kernel("on_point", "f", w=entry("w")), dim),
            *added_mass(family), *wetness(), *waves(dim)]
