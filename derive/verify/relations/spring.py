"""Springs under verification: energy, damper and force by plain formulas along finite changes of the gap."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...couplings.spring import SPRINGS
from ...spec import Family
from ..invariances.element import Invariance, relative
from ..methods import Relation
from ..motion import cross
from ..numbers import EPS, Numbers, State
from .element import entry, from_kernel


def sample(family: Family, random: np.random.Generator) -> dict[str, np.ndarray]:
    """Return the arguments of every kernel of a spring."""
    dim = family.dim
    gap = random.normal(size=dim)
    return {"stiffness": np.float64(5.3), "damping": np.float64(0.7),
            "rest_length": np.float64(0.4 * np.linalg.norm(gap) * SPRINGS[family.name].has_length),
            "h": np.float64(0.13), "gap": gap, "gap_rate": random.normal(size=dim),
            "gap_next": gap + 0.3 * random.normal(size=dim)}


def _extension(k: Numbers, family: Family, s: State, gap: np.ndarray) -> np.ndarray:
    return np.array([k.sqrt(gap.dot(gap)) - s["rest_length"]]) if SPRINGS[family.name].has_length else gap


def relations(family: Family) -> list[Relation]:
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
        """U + f . change - h P."""
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


def invariances(family: Family, k: Numbers, s: State) -> Iterator[Invariance]:
    """Yield what no spring may do: turn the pair of points, push with no extension, be singular without a length."""
    gap, rest = s["gap"], 0 * s["gap_rate"]
    if SPRINGS[family.name].has_length:
        f = k("force", s)["f"]
        yield "no moment on the pair of points", _moment(gap, f), 8 * EPS
        f = k("discrete_force", s)["f"]
        yield "step: no moment about the mean points", _moment(gap + s["gap_next"], f), 8 * EPS
        unit = gap / np.linalg.norm(gap)
        f = k("force", s, gap=s["rest_length"] * unit, gap_rate=rest)["f"]
        yield "no force at the rest length", relative(f, s["stiffness"] * s["rest_length"]), 4 * EPS
    else:
        f = k("force", s, gap=0 * gap)["f"]
        yield "the damper's force where the points meet", relative(f - s["damping"] * s["gap_rate"], f), 2 * EPS
    K = k("tangent", s, gap_rate=rest)["K"]
    yield "stiffness symmetric", relative(K - K.T, K), 4 * EPS


def _moment(arm: np.ndarray, force: np.ndarray) -> float:
    """Moment of a force over its size times that of its arm."""
    flat = np.zeros(3 - len(arm))
    moment = cross(np.concatenate([arm, flat]), np.concatenate([force, flat]))
    return float(np.linalg.norm(moment) / np.linalg.norm(arm) / np.linalg.norm(force))
