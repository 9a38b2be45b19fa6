"""Sheaves in cases known without derivation, and under motions of the frame."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...codegen.family import CouplingFamily
from ..numbers import EPS, Numbers, State
from ..samples.shapes import rotation
from .drum import Scene, drum
from .measures import Invariance, relative

VECTORS = ("g", "c", "c_rate", "c_acc", "x", "slope", "x_rate", "slope_rate", "x_acc", "span_slope",
           "span_slope_rate")
SCALARS = (("energy", "U"), ("weight", "V"), ("kinetic_energy", "T"), ("dissipation", "P"), ("angle", "rate"),
           ("angle", "acc"), ("tangent_point_motion", "Q_d"), ("short_wrap", "h"), ("short_wrap", "U"),
           ("short_wrap_motion", "Q_d"))
CENTRE = slice(2, 4)
"""Where the centre of the sheave is among the coordinates of a zone."""


def sheave(family: CouplingFamily, k: Numbers, s: State) -> Iterator[Invariance]:
    """Yield signs, symmetries, turned and mirrored scenes, steady flow around a sheave, a rope at rest on it; drums."""
    yield from _signs(k, s)
    yield from _frame(k, s)
    yield from _steady(k, s)
    yield from _resting(k, s)
    yield from drum(k, s, _scenes(s))


def _signs(k: Numbers, s: State) -> Iterator[Invariance]:
    rates = np.concatenate([s["phi_rate"], s["c_rate"], s["s_rate"]])
    T, P = k("kinetic_energy", s)["T"], k("dissipation", s)["P"]
    M, D = k("mass_matrix", s)["M"], k("damping_tangent", s)["D"]
    yield "T > 0 and P > 0", float(not (T[0] > 0 and P[0] > 0)), 0.0
    yield "v . M v = 2 T", relative(rates @ M @ rates - 2 * T, 2 * T), 256 * EPS
    yield "M has no negative eigenvalue", max(0.0, -np.linalg.eigvalsh(M)[0] / relative(M, 1)), 64 * EPS
    of_zone = rates[[0, 1, 4, 5]]
    yield "damping: v . D v = P", relative(of_zone @ D @ of_zone - P, P), 256 * EPS
    for name, matrix in (("M", M), ("K", k("tangent", s)["K"]), ("D of damping", D),
                         ("K of a tangent point", k("tangent_point", s)["K"])):
        yield f"{name} symmetric", relative(matrix - matrix.T, matrix), 64 * EPS


def _scenes(s: State) -> list[Scene]:
    """Return the scene turned as a whole, and reflected."""
    turn = 0.7
    Q = rotation(np.random.default_rng(3), 2, angle=turn)
    turned = s | {name: s[name] @ Q.T for name in VECTORS} | {"phi": s["phi"] + turn}
    mirror = np.diag([1.0, -1.0])
    mirrored = s | {name: s[name] @ mirror for name in VECTORS} | {
        "phi": -s["phi"], "sense": -s["sense"], "phi_rate": -s["phi_rate"], "phi_acc": -s["phi_acc"]}
    return [("turned", turned, Q, 1.0), ("mirrored", mirrored, mirror, -1.0)]


def _frame(k: Numbers, s: State) -> Iterator[Invariance]:
    """Yield the changes by a turn of the whole scene, by a full turn of the angles, and by a reflection."""
    for text, other, about, sign in _scenes(s):
        for kernel, output in SCALARS:
            value = k(kernel, s)[output]
            expected = sign * value if kernel == "angle" else value
            yield f"{text} scene: same {output} of {kernel}", relative(k(kernel, other)[output] - expected, value), \
                512 * EPS
        for kernel in ("force", "inertia"):
            value = k(kernel, s)["f"]
            expected = value.copy()
            expected[:2] *= sign
            expected[CENTRE] = about @ value[CENTRE]
            yield f"{text} scene: {kernel} follows", relative(k(kernel, other)["f"] - expected, value), 512 * EPS
    over = s | {"phi": s["phi"] + 2 * np.pi}
    for kernel, output in SCALARS[:4]:
        value = k(kernel, s)[output]
        yield "angles count over turns", relative(k(kernel, over)[output] - value, value), 512 * EPS


def _steady(k: Numbers, s: State) -> Iterator[Invariance]:
    """Yield steady flow around a fixed sheave: T = m v^2/2, and the force of the angle is that of a tension rho v u."""
    still, u = np.zeros(2), 1.7
    flow = s | {"phi_rate": still, "phi_acc": still, "c_rate": still, "c_acc": still, "s_acc": still,
                "s_rate": np.full(2, u)}
    angle = s["phi"][1] - s["phi"][0]
    speed = float(angle * s["R"] / s["l"] * u)  # of the material, along the groove
    T = float(s["rho"] * s["l"]) * speed**2 / 2
    force = k("inertia", flow)["f"]
    yield "steady flow: T = m v²/2", relative(k("kinetic_energy", flow)["T"] - T, T), 64 * EPS
    yield "steady flow: dT/d(angle) on both ends", relative(force[:2] * angle - 2 * T * np.array([1, -1]), T), 512 * EPS
    yield "steady flow: no force on the centre", relative(force[CENTRE], T / s["R"]), 512 * EPS
    yield "steady flow: T/l on both ends of the material", relative(
        force[4:] * s["l"] - T * np.array([-1.0, 1.0]), T), 512 * EPS
    yield "steady flow: no damping", relative(k("dissipation", flow)["P"], T), (64 * EPS) ** 2


def _resting(k: Numbers, s: State) -> Iterator[Invariance]:
    """Yield that the ends of the wrap may move along an evenly stretched rope at rest: phi' = phi_S s'."""
    per_length = (s["phi"][1] - s["phi"][0]) / s["l"]
    still = np.zeros(2)
    rest = s | {"c_rate": still, "c_acc": still, "phi_rate": per_length * s["s_rate"],
                "phi_acc": per_length * s["s_acc"]}
    size = float(s["rho"] * s["l"] * np.max(np.abs(s["s_rate"])) ** 2)
    yield "rope at rest, ends flow: no T", relative(k("kinetic_energy", rest)["T"], size), (64 * EPS) ** 2
    yield "rope at rest, ends flow: no inertial force", relative(k("inertia", rest)["f"], size), 1024 * EPS
    yield "rope at rest, ends flow: no damping", relative(k("dissipation", rest)["P"], size), (64 * EPS) ** 2
