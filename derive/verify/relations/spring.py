"""Springs under verification: energy, damper and force by plain formulas along finite changes of the gap."""

from __future__ import annotations

import numpy as np

from ...codegen.family import CouplingFamily
from ...couplings.spring import SPRINGS
from ..methods import Relation
from ..numbers import Numbers, State
from .paths import entry, from_kernel


def _extension(k: Numbers, family: CouplingFamily, s: State, gap: np.ndarray) -> np.ndarray:
    return np.array([k.sqrt(gap.dot(gap)) - s["rest_length"]]) if SPRINGS[family.name].has_length else gap


def spring(family: CouplingFamily) -> list[Relation]:
    """Return what every output of a spring's kernels is."""
    dim, has_length = family.dim, SPRINGS[family.name].has_length

    def energy(k, s, t, j, at="gap"):
        e = _extension(k, family, s, s[at])
        return s["stiffness"] * e.dot(e) / 2

    def power(k, s, t, j):
        gap, rate = s["gap"], s["gap_rate"]
        return s["damping"] * (gap.dot(rate) ** 2 / gap.dot(gap) if has_length else rate.dot(rate))

    def power_of_step(k, s, t, j):
        change = (_extension(k, family, s, s["gap_next"]) - _extension(k, family, s, s["gap"])) / s["h"]
        return s["damping"] * change.dot(change)

    def half_power(k, s, t, j):
        return from_kernel("dissipation", "P", gap_rate=entry("gap_rate"))(k, s, t, j) / 2

    def at_rest(kernel):
        return lambda k, s: k(kernel, s, gap_rate=0 * s["gap_rate"])["f"]

    def of_damper(kernel):
        return lambda k, s: k(kernel, s, stiffness=0 * s["stiffness"])["f"]

    def work(k, s):
        """Return U + f . change - h P."""
        out = k("discrete_force", s)
        return k("energy", s)["U"] + out["f"].dot(s["gap_next"] - s["gap"]) - s["h"] * out["P"]

    stored = from_kernel("energy", "U", gap=entry("gap"))
    forces = [relation for kernel in ("force", "tangent") for relation in (
        Relation(kernel, "f", "dU/dgap at rest", 1, stored, dim, of=at_rest(kernel)),
        Relation(kernel, "f", "d(P/2)/dgap' without the spring", 1, half_power, dim, of=of_damper(kernel)))]
    return [
        Relation("energy", "U", "k e.e/2", 0, energy),
        Relation("dissipation", "P", "c e'.e'", 0, power),
        *forces,
        Relation("tangent", "K", "df/dgap", 1, from_kernel("force", "f", gap=entry("gap")), dim),
        Relation("tangent", "D", "df/dgap'", 1, from_kernel("force", "f", gap_rate=entry("gap_rate")), dim),
        Relation("discrete_force", "f", "U + f . (gap_next - gap) - h P is U at gap_next", 0,
                 lambda k, s, t, j: energy(k, s, t, j, "gap_next"), of=work),
        Relation("discrete_force", "f", "dU/dgap where gap_next is gap", 1, stored, dim,
                 of=lambda k, s: k("discrete_force", s, gap_next=s["gap"])["f"]),
        Relation("discrete_force", "P", "c times the square of the extension's mean rate", 0, power_of_step),
    ]
