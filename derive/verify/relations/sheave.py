"""Relations of the kernels of sheaves: a tangent point, its angle, and the zone of the wrap; of drums see drum.py."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from ...codegen.family import CouplingFamily
from ..methods import Relation
from ..numbers import Numbers, State
from ..references import sheave as reference
from .drum import drum
from .paths import along, entry, from_kernel, half, of, root, unit
from .sheave_step import sheave_step

COORDINATES = (("phi", 2), ("c", 2), ("l", 1))
"""Names and sizes of the coordinates of a zone; those of its rates and of its accelerations follow."""
RATES = (("phi_rate", 2), ("c_rate", 2), ("s_rate", 2))
SECOND_RATES = (("phi_acc", 2), ("c_acc", 2), ("s_acc", 2))
N = sum(size for _, size in RATES)
BESIDE_A_SPAN = (("angles2", 2), ("lengths1", 1), ("span_slope", 2))
FRICTION = {"": (("angles3", 3), ("lengths2", 2)), "_on": BESIDE_A_SPAN, "_off": BESIDE_A_SPAN,
            "_short": (("angles2", 2), ("slope", 2), ("span_slope", 2))}
"""Ends of the names of kernels of friction, with their coordinates."""
SLIDING = (("angle_rate", 1), ("spin", 1), ("flow", 1))


def sheave(family: CouplingFamily) -> list[Relation]:
    """Return the relations of a sheave's kernels."""
    return [*_of_tangent_point(), *_of_angle(), *_of_energies(), *_of_inertia(), *_of_damping(),
            *(each for suffix in FRICTION for each in _of_friction(suffix)),
            *(each for suffix in FRICTION for each in _of_coulomb(suffix)),
            *_of_short_wrap(), *sheave_step(), *drum()]


def without(names: tuple[tuple[str, int], ...], one: str) -> tuple[tuple[str, int], ...]:
    """Return names but for one of them."""
    return tuple(pair for pair in names if pair[0] != one)


def _of_tangent_point() -> list[Relation]:
    inputs = (("x", 2), ("slope", 2))

    def conditions(s):
        return [s["x"].dot(s["x"]) ** 0.5 - s["R"].item(), s["slope"].dot(s["x"])]

    def forces(k, s):
        return k("tangent_point", s)["J"].T.dot(s["f"])

    def drifting(k, s, t, j):
        return k("tangent_point", s, x=s["x"] + t * s["x_rate"], slope=s["slope"] + t * s["slope_rate"])["phi"]

    return [Relation("tangent_point", "phi", "|x| - R, r_S . x", 0, root(conditions)),
            Relation("tangent_point", "J", "dphi by x and the slope", 1, along(of("tangent_point", "phi"), inputs), 4),
            Relation("tangent_point", "K", "d(J' f) by x and the slope", 1, along(forces, inputs), 4),
            Relation("tangent_point_motion", "Q_d", "d²phi/dt² at zero accelerations", 2, drifting)]


def _of_angle() -> list[Relation]:
    """Return those of the angle: the sine of its change has the same first and second derivatives where it is zero."""
    def change(s: State, x: np.ndarray) -> Any:
        return (s["x"][0] * x[1] - s["x"][1] * x[0]) / (s["x"].dot(s["x"]) * x.dot(x)) ** 0.5

    def in_polar(k: Any, s: State) -> dict[str, Any]:
        """Return the kernel's outputs on a motion in polar coordinates R, phi with the rates x_rate, x_acc of these."""
        radius, phi = s["R"], s["phi"][0]
        (radius_rate, phi_rate), (radius_acc, phi_acc) = s["x_rate"], s["x_acc"]
        n, t = np.array([k.cos(phi), k.sin(phi)]), np.array([-k.sin(phi), k.cos(phi)])
        return k("angle", s, x=radius * n, x_rate=radius_rate * n + radius * phi_rate * t,
                 x_acc=(radius_acc - radius * phi_rate**2) * n + (radius * phi_acc + 2 * radius_rate * phi_rate) * t)

    def by(output: str, name: str) -> Callable[..., Any]:
        return from_kernel("angle", output, **{name: entry(name)})

    return [
        Relation("angle", "rate", "d/dt of the angle of x", 1, lambda k, s, t, j: change(s, s["x"] + t * s["x_rate"])),
        Relation("angle", "rate", "that of polar coordinates", 0, root(lambda s: s["x_rate"][1]),
                 of=lambda k, s: in_polar(k, s)["rate"]),
        Relation("angle", "acc", "d²/dt² of the angle of x", 2,
                 lambda k, s, t, j: change(s, s["x"] + s["x_rate"] * t + s["x_acc"] * t * t / 2)),
        Relation("angle", "acc", "that of polar coordinates", 0, root(lambda s: s["x_acc"][1]),
                 of=lambda k, s: in_polar(k, s)["acc"]),
        Relation("angle", "phi_x", "d(angle) by x", 1, lambda k, s, t, j: change(s, s["x"] + t * unit(s["x"], j)), 2),
        Relation("angle", "phi_x", "d(rate) by x'", 1, by("rate", "x_rate"), 2),
        Relation("angle", "phi_x", "d(acc) by x''", 1, by("acc", "x_acc"), 2),
        Relation("angle", "phi_xx", "d(phi_x) by x", 1, by("phi_x", "x"), 2),
        Relation("angle", "rate_x", "d(rate) by x", 1, by("rate", "x"), 2),
        Relation("angle", "acc_x", "d(acc) by x", 1, by("acc", "x"), 2),
        Relation("angle", "acc_v", "d(acc) by x'", 1, by("acc", "x_rate"), 2)]


def _of_energies() -> list[Relation]:
    def total(k, s):
        return k("energy", s)["U"] + k("weight", s)["V"]

    return [Relation("energy", "U", "∫ EA strain² + EI curvature² dS/2 by quadrature", 0, root(reference.energy)),
            Relation("weight", "V", "-rho ∫ g . r dS by quadrature", 0, root(reference.gravity)),
            Relation("force", "f", "d(U + V) by the angles, c and l", 1, along(total, COORDINATES), 5),
            Relation("tangent", "K", "df by the angles, c and l", 1, along(of("force", "f"), COORDINATES), 5)]


def _of_inertia() -> list[Relation]:
    places = [(rate, second, k) for (rate, size), (second, _) in zip(RATES, SECOND_RATES, strict=True)
              for k in range(size)]

    def energy(k, s, **changes):
        return k("kinetic_energy", s, **changes)["T"]

    def moved(s: State, t: Any) -> State:
        """Return the zone at the time t of a motion with the state's rates and accelerations."""
        return {"phi": s["phi"] + t * s["phi_rate"], "l": s["l"] + t * (s["s_rate"][1] - s["s_rate"][0]),
                **{rate: s[rate] + t * s[second] for (rate, _), (second, _) in zip(RATES, SECOND_RATES, strict=True)}}

    def momentum(k: Numbers, s: State, j: int) -> Any:
        """Return dT by a rate: the difference over a unit is exact, as T is quadratic in the rates."""
        name, _, at = places[j]
        step = unit(s[name], at)
        return (energy(k, s, **{name: s[name] + step}) - energy(k, s, **{name: s[name] - step})) / 2

    def lagrange(k, s, t, j):
        name, _, at = places[j]
        displaced: State = {}  # of the centre: T does not depend on its place
        if name == "phi_rate":
            displaced = {"phi": s["phi"] + t * unit(s["phi"], at)}
        if name == "s_rate":
            displaced = {"l": s["l"] + t * (2 * at - 1)}
        return momentum(k, s | moved(s, t), j) - energy(k, s, **displaced)

    def power(k, s):
        return k("inertia", s)["f"].dot(np.concatenate([s[name] for name, _ in RATES]))

    inertia = of("inertia", "f")
    return [Relation("kinetic_energy", "T", "rho/2 ∫ |dr/dt|² dS by quadrature over the material", 0,
                     root(reference.kinetic_energy)),
            Relation("inertia", "f", "d/dt dT/dv - dT/dq", 1, lagrange, N),
            Relation("inertia", "f", "power: dT/dt", 1, lambda k, s, t, j: energy(k, s, **moved(s, t)), of=power),
            Relation("mass_matrix", "M", "df by accelerations", 1, along(inertia, SECOND_RATES), N),
            Relation("inertia_tangent", "D", "df by rates", 1, along(inertia, RATES), N),
            Relation("inertia_tangent", "K", "df by the angles and l", 1,
                     along(inertia, without(COORDINATES, "c")), 3)]


def _of_damping() -> list[Relation]:
    rates, power, force = without(RATES, "c_rate"), of("dissipation", "P"), of("damping_force", "f")

    def work(k, s):
        return force(k, s).dot(np.concatenate([s[name] for name, _ in rates]))

    return [Relation("dissipation", "P", "tau ∫ EA strain'² + EI curvature'² dS by quadrature", 0,
                     root(reference.dissipation)),
            Relation("damping_force", "f", "d(P/2) by rates of the angles and ends", 1, half(along(power, rates)), 4),
            Relation("damping_force", "f", "power P", 0, lambda k, s, t, j: power(k, s), of=work),
            Relation("damping_tangent", "D", "df by rates", 1, along(force, rates), 4),
            Relation("damping_tangent", "K", "df by the angles and l", 1, along(force, without(COORDINATES, "c")), 3)]


def _of_forces(suffix: str, kernel: str, forces: Callable[..., Any]) -> list[Relation]:
    """Return those of the derivatives of forces at a point of friction."""
    places = FRICTION[suffix]
    return [Relation(kernel, "K", "dF by angles, lengths and slopes", 1, along(forces, places),
                     sum(size for _, size in places)),
            Relation(kernel, "D", "dF by rates of the angle, of the sheave, and of s", 1, along(forces, SLIDING), 3)]


def _of_friction(suffix: str) -> list[Relation]:
    kernel = f"friction{suffix}"

    def forces(s):
        return reference.friction_forces(suffix, reference.friction(suffix, s)[2], s)

    def power(k, s, t, j):
        rates = [s[name] for name, _ in SLIDING]
        return sum(force * rate for force, rate in zip(k(kernel, s)["F"], rates, strict=True))

    return [Relation(kernel, "numbers", "speed of sliding, P- + P+, Euler's jump of the tension", 0,
                     root(reference.friction, suffix)),
            Relation(kernel, "F", "R f and its opposite on the angles, -f times the mean stretch on s", 0,
                     root(forces)),
            Relation(kernel, "power", "F times the rates", 0, power),
            *_of_forces(suffix, f"{kernel}_tangent", of(kernel, "F"))]


def _of_coulomb(suffix: str) -> list[Relation]:
    kernel, places = f"coulomb{suffix}", FRICTION[suffix]

    def numbers(s):
        sliding, _, limit = reference.coulomb(suffix, s)
        return [sliding, limit]

    def sliding(k, s):
        return k(kernel, s)["numbers"][0]

    def forces(k, s):
        out = k(kernel, s)
        return (s["held"].item() + s["direction"].item() * out["numbers"][1]) * out["column"]

    def moving(k, s, t, j):
        moved = {name: s[name] + t * s[f"{name}_rate"] for name, _ in places if f"{name}_rate" in s}
        return sliding(k, s | moved | {"angle_rate": s["angle_rate"] + t * s["angle_acc"]})

    return [Relation(kernel, "numbers", "speed of sliding, Euler's limit of the jump of the tension", 0, root(numbers)),
            Relation(kernel, "row", "dw by rates of the angle, of the sheave, and of s", 1, along(sliding, SLIDING), 3),
            Relation(kernel, "column", "R and its opposite on the angles, the mean stretch on s", 0,
                     root(lambda s: reference.friction_forces(suffix, 1, s))),
            *_of_forces(suffix, f"{kernel}_tangent", forces),
            Relation(f"{kernel}_motion", "Q_d", "dw/dt at zero accelerations of the sheave and s", 1, moving)]


def _of_short_wrap() -> list[Relation]:
    inputs = (("phi", 2), ("slope", 2), ("span_slope", 2), ("l", 1))

    def forces(k, s):
        out = k("short_wrap", s)
        return out["F"] + out["J"] * s["tension"]

    def condition(k, s, t, j):
        moved = {name: s[name] + t * s[f"{name}_rate"] for name in ("slope", "span_slope", "l")}
        return k("short_wrap", s, **moved)["h"]

    return [Relation("short_wrap", "h", "arc less the drawn length", 0, root(reference.short_wrap)),
            Relation("short_wrap", "U", "elastic energy of an arc of the drawn length", 0,
                     root(reference.short_wrap_energy)),
            Relation("short_wrap", "J", "dh by the angles, both slopes and the length", 1,
                     along(of("short_wrap", "h"), inputs), 7),
            Relation("short_wrap", "F", "dU by these", 1, along(of("short_wrap", "U"), inputs), 7),
            Relation("short_wrap", "K", "d(F + J' tension) by these", 1, along(forces, inputs), 7),
            Relation("short_wrap_motion", "Q_d", "d²h/dt² at zero accelerations", 2, condition),
            Relation("short_wrap_motion", "Q_d", "that of the arc less the drawn length", 0,
                     root(reference.short_wrap_motion))]
