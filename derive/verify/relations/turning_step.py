"""Relations of the kernels of a rope on a sheave in space over a step that conserves energy."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from ...algebra.tangent_frame import cross
from ...couplings.turning_step import PRODUCTS
from ...elements import ELEMENTS
from ..methods import Relation
from ..numbers import Numbers, State
from ..references.element import Shape
from .paths import along, of, root

CHANGES = ("s_change", "c_change", "angle_change", "alpha_change", "theta")
STEP = "momentum_step"


def turning_step() -> list[Relation]:
    """Return the relations of the kernels."""
    return [*_of_momentum(), *_of_step(), *_of_products(), *_of_chord()]


def _of_momentum() -> list[Relation]:
    def drifting(k: Numbers, s: State, t: Any, j: int) -> Any:
        s_rate = (1 - s["xi"]) * s["s_rate"][0] + s["xi"] * s["s_rate"][1]
        place = s["axes"].dot(_direction(k, s["angle_at"] + t * (s["turn"] - s["alpha"] * s_rate / s["l"])))
        return s["l"] * (t * s["c_rate"] + s["R"] * (place + t * cross(s["omega"], place)))

    return [Relation("momentum", "P", "l times the velocity of a point that stays in the material", 1, drifting),
            Relation("momentum_energy", "T", "rho P.P/(2 l)", 0,
                     lambda k, s, t, j: s["rho"] * s["P"].dot(s["P"]) / (2 * s["l"]))]


def _of_step() -> list[Relation]:
    def moment(k: Numbers, s: State) -> Any:
        found = k(STEP, s)
        return found["moment"] + cross(s["c_change"], found["on_c"]) / 2

    def angular_momentum(k: Numbers, s: State) -> Any:
        def place(sign: int, angle: Any) -> Any:
            n = s["axes"].dot(_direction(k, angle))
            return s["R"] * (n + sign * cross(s["theta"], n) / 2)
        places = [place(-1, s["angle_at"]), s["c_change"] + place(1, s["angle_at"] + s["angle_change"])]
        return s["rho"] / s["h"] * (cross(places[1], k(STEP, s)["P_next"]) - cross(places[0], s["P"]))

    return [
        Relation(STEP, "on_c", "rho dP/h", 0, lambda k, s, t, j: s["rho"] * (k(STEP, s)["P_next"] - s["P"]) / s["h"]),
        Relation(STEP, "moment", "with on_c: the change of the angular momentum", 0,
                 lambda k, s, t, j: angular_momentum(k, s), of=moment),
        *(_of_work(output, changing) for output, changing in (
            ("on_turn", CHANGES), ("on_alpha", ("alpha_change", "theta")), ("on_s", ("s_change",)),
            ("moment", ("theta",)), ("on_turn", ("angle_change", "theta")))),
        Relation(STEP, "P_next", "2 l dc/h - P where all else is at rest", 0,
                 lambda k, s, t, j: 2 * s["l"] * s["c_change"] / s["h"] - s["P"],
                 of=lambda k, s: k(STEP, _only(s, ("c_change",)))["P_next"])]


def _of_work(output: str, changing: tuple[str, ...]) -> Relation:
    """Return the relation of the work over a step where these alone change."""
    def work(k: Numbers, s: State) -> Any:
        s = _only(s, changing)
        found, half = k(STEP, s), np.asarray(s["angle_change"] / 2).item()
        return (found["on_c"].dot(s["c_change"]) + found["moment"].dot(s["theta"])
                + found["on_turn"] * 2 * (k.sin(half) / k.cos(half)) + found["on_alpha"] * s["alpha_change"]
                + found["on_s"].dot(s["s_change"]))

    def gain(k: Numbers, s: State) -> Any:
        s = _only(s, changing)
        energy: Callable[[Any, Any], Any] = lambda P, length: k("momentum_energy", s, P=P, l=length)["T"]  # noqa: E731
        return energy(k(STEP, s)["P_next"], s["l"] + s["s_change"][1] - s["s_change"][0]) - energy(s["P"], s["l"])

    return Relation(STEP, output, f"work where {', '.join(changing)} change: that of the kinetic energy", 0,
                    lambda k, s, t, j: gain(k, s), of=work)


def _only(s: State, changing: tuple[str, ...]) -> State:
    return s | {name: 0 * s[name] for name in CHANGES if name not in changing}


def _direction(k: Numbers, angle: Any) -> np.ndarray:
    at = np.asarray(angle).item()
    return np.array([k.cos(at), k.sin(at)])


def _of_products() -> list[Relation]:
    def products(s: State) -> State:
        vectors = {"x": s["x"], "a": s["axis"], "d": s["chord"], "w": s["weight"]}
        return s | {"products": np.array([*(vectors[name[0]].dot(vectors[name[2]]) for name in PRODUCTS),
                                          np.asarray(s["b"]).item()]),
                    "weight_square": s["weight"].dot(s["weight"]), "by_chord": 0 * s["b"] + 1}

    return [Relation("by_products", "phi", "that of the conditions across the chord", 0,
                     lambda k, s, t, j: k("conditions", products(s))["phi"],
                     of=lambda k, s: k("by_products", products(s))["phi"]),
            Relation("by_products", "J", "dphi by the products and b", 1,
                     along(of("by_products", "phi"), (("products", len(PRODUCTS) + 1),)), len(PRODUCTS) + 1)]


def _of_chord() -> list[Relation]:
    spec = ELEMENTS["cable12"]

    def shapes(s: Any) -> Any:
        return [Shape(spec, 1)((at, 0, 0), (0, 0, 0)) for at in s["xis"]]

    def quotient(k: Numbers, s: State, t: Any, j: int) -> Any:
        N = k("chord_step", s)["N"]
        return (N[1] - N[0]) / (s["xis"][1] - s["xis"][0])

    return [Relation("chord_step", "N", "shape functions at 50 digits", 0, root(shapes)),
            Relation("chord_step", "N_xi", "the change of N over that of xi", 0, quotient)]
