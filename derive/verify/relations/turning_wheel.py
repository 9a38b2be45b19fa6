"""Relations of the kernels of wheels of ropes in space on bodies that rotate."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...algebra.tangent_frame import cross
from ..methods import Relation
from ..numbers import State
from ..references import turning_wheel as reference
from .paths import along, of, root, unit

ACCELERATIONS = (("phi_acc", 2), ("c_acc", 3), ("omega_acc", 2), ("s_acc", 2))
"""Second rates, in the order of the forces."""
TILTS = 2


def turning_wheel() -> list[Relation]:
    """Return the relations of the kernels."""
    return [*_of_motion(), *_of_weight(), *_of_ring()]


def _of_motion() -> list[Relation]:
    def seen(k, s, t, j):
        """Return the rate of the place at the time t in axes that turn about 1 and 2 alone."""
        tilt = np.array([s["omega"][0], s["omega"][1], 0 * s["omega"][2]])
        return (s["x_rate"] + t * s["x_acc"] - t * cross(tilt, s["x_rate"]))[:TILTS]

    return [Relation("turned_acc", "acc", "rate of x_rate in axes that tilt with the groove", 1, seen),
            Relation("wrap_energy", "E", "rho/2 ∫ |dr/dt|² of material points", 0, root(reference.kinetic_energy)),
            Relation("wrap_inertia", "f", "d/dt dT/dv - dT/dq of material points", 0, root(reference.inertia)),
            Relation("wrap_mass", "M", "df by second rates", 1, along(of("wrap_inertia", "f"), ACCELERATIONS), 9)]


def _turned(s: State, t: Any, k: int) -> State:
    """Return the state in axes that have turned by t about the k-th vector of the groove: gravity turns back."""
    return {"gravity": s["gravity"] + t * cross(s["gravity"], unit(s["gravity"], k))}


def _of_weight() -> list[Relation]:
    def turning(kernel: str, output: str) -> Any:
        return lambda k, s, t, j: k(kernel, s | _turned(s, t, j))[output]

    def by_place(output: str) -> Any:
        def path(k, s, t, j):
            moved = {"x": s["x"] + t * unit(s["x"], j)} if j < TILTS else _turned(s, t, j - TILTS)
            return k("laid_weight", s | moved)[output]
        return path

    def height(s):
        x, g = s["x"][:TILTS], s["gravity"]
        return [s["laid"].item() * (g[1] * x[0] - g[0] * x[1]) / x.dot(x) ** 0.5]

    return [Relation("wrap_weight", "moment", "-rho ∫ arm x g of material points", 0, root(reference.moment_of_weight)),
            Relation("wrap_weight", "M_q", "d(moment) by phi_a, phi_b, l", 1,
                     along(of("wrap_weight", "moment"), (("phi", 2), ("l", 1))), 3),
            Relation("wrap_weight", "M_turn", "d(moment) by rotations", 1, turning("wrap_weight", "moment"), TILTS),
            Relation("laid_weight", "V", "rho sigma R²/lambda g x n", 0, root(height)),
            Relation("laid_weight", "F", "dV by x and rotations", 1, by_place("V"), 2 * TILTS),
            Relation("laid_weight", "K", "dF by x and rotations", 1, by_place("F"), 2 * TILTS)]


def _of_ring() -> list[Relation]:
    def momentum(k, s, t, j):
        """Return the angular momentum at the time t in axes that were those of the groove."""
        about, axial = s["inertia"]
        tilt = s["omega"][:TILTS] + t * s["omega_acc"]
        L = np.array([*((about + t * s["growth"]) * tilt), axial * s["spin"]])
        return (L + t * cross(s["omega"], L))[:TILTS]

    def energy(s):
        return [s["inertia"][0] * s["omega"][:TILTS].dot(s["omega"][:TILTS]) / 2]

    return [Relation("ring", "E", "I omega²/2 about diameters", 0, root(energy)),
            Relation("ring", "moment", "dL/dt in fixed axes", 1, momentum)]
