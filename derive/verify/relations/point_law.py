"""Forces between two points under verification: energy, damper and force along changes of the gap, for any law."""

from __future__ import annotations

from ...codegen.family import PointLawFamily
from ..methods import Relation
from ..references import point_law as reference
from ..samples.point_law import damping
from .paths import entry, from_kernel


def point_law(family: PointLawFamily) -> list[Relation]:
    """Return the relations of the kernels of a law."""
    dim, U, e, rates = family.dim, reference.energy(family), reference.measures(family), reference.rates(family)

    def energy(k, s, t, j, at="gap"):
        return U(s["parameters"], s[at])

    def power(k, s, t, j):
        e_rate = rates(s["parameters"], s["gap"], s["gap_rate"])
        return damping(family, s["parameters"]) * e_rate.dot(e_rate)

    def power_of_step(k, s, t, j):
        change = (e(s["parameters"], s["gap_next"]) - e(s["parameters"], s["gap"])) / s["h"]
        return damping(family, s["parameters"]) * change.dot(change)

    def half_power(k, s, t, j):
        return from_kernel("dissipation", "P", gap_rate=entry("gap_rate"))(k, s, t, j) / 2

    def at_rest(kernel):
        return lambda k, s: k(kernel, s, gap_rate=0 * s["gap_rate"])["f"]

    def of_damper(kernel):
        return lambda k, s: k(kernel, s)["f"] - at_rest(kernel)(k, s)

    def work(k, s):
        """U + f . change - h P."""
        out = k("discrete_force", s)
        return k("energy", s)["U"] + out["f"].dot(s["gap_next"] - s["gap"]) - s["h"] * out["P"]

    stored = from_kernel("energy", "U", gap=entry("gap"))
    found = [
        Relation("energy", "U", "U of the spec", 0, energy),
        Relation("tangent", "K", "df/dgap", 1, from_kernel("force", "f", gap=entry("gap")), dim),
        Relation("tangent", "D", "df/dgap'", 1, from_kernel("force", "f", gap_rate=entry("gap_rate")), dim),
        Relation("discrete_force", "f", "U + f . (gap_next - gap) - h P is U at gap_next", 0,
                 lambda k, s, t, j: energy(k, s, t, j, "gap_next"), of=work),
        Relation("discrete_force", "f", "dU/dgap where gap_next is gap", 1, stored, dim,
                 of=lambda k, s: k("discrete_force", s, gap_next=s["gap"])["f"]),
        Relation("discrete_force", "P", "c times the square of the mean rate of e", 0, power_of_step),
    ]
    for kernel in ("force", "tangent"):
        found.append(Relation(kernel, "f", "dU/dgap at rest", 1, stored, dim, of=at_rest(kernel)))
        if family.point_law.damping:
            found.append(Relation(kernel, "f", "d(P/2)/dgap' more in motion", 1, half_power, dim, of=of_damper(kernel)))
    if family.point_law.damping:
        found.append(Relation("dissipation", "P", "c e'.e'", 0, power))
    return found
