"""Relations of the kernels of a point of a wrap over a step that conserves energy."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from ..methods import Relation
from ..numbers import Numbers, State

CHANGES = ("s_change", "c_change", "angle_change", "alpha_change")
STEP = "momentum_step"


def sheave_step() -> list[Relation]:
    """Return the relations of the momentum and of its step."""
    def drifting(k: Numbers, s: State, t: Any, j: int) -> Any:
        s_rate = (1 - s["xi"]) * s["s_rate"][0] + s["xi"] * s["s_rate"][1]
        angle = s["angle_at"] + t * (s["turn"] - s["alpha"] * s_rate / s["l"])
        return s["l"] * (t * s["c_rate"] + s["R"] * _direction(k, angle))

    def moment(k: Numbers, s: State) -> Any:
        found = k(STEP, s)
        return found["on_turn"][0] + _cross(s["c_change"], found["on_c"]) / 2

    def angular_momentum(k: Numbers, s: State) -> Any:
        places = [s["R"] * _direction(k, s["angle_at"]),
                  s["c_change"] + s["R"] * _direction(k, s["angle_at"] + s["angle_change"])]
        return s["rho"] / s["h"] * (_cross(places[1], k(STEP, s)["P_next"]) - _cross(places[0], s["P"]))

    return [
        Relation("momentum", "P", "l times the velocity of a point that stays in the material", 1, drifting),
        Relation("momentum_energy", "T", "rho P.P/(2 l)", 0,
                 lambda k, s, t, j: s["rho"] * s["P"].dot(s["P"]) / (2 * s["l"])),
        Relation(STEP, "on_c", "rho dP/h", 0, lambda k, s, t, j: s["rho"] * (k(STEP, s)["P_next"] - s["P"]) / s["h"]),
        Relation(STEP, "on_turn", "with on_c, moment: the change of the angular momentum", 0,
                 lambda k, s, t, j: angular_momentum(k, s), of=moment),
        *_of_work("on_turn", CHANGES), *_of_work("on_alpha", ("alpha_change",)), *_of_work("on_s", ("s_change",)),
        Relation(STEP, "P_next", "2 l dc/h - P where all else is at rest", 0,
                 lambda k, s, t, j: 2 * s["l"] * s["c_change"] / s["h"] - s["P"],
                 of=lambda k, s: k(STEP, _only(s, ("c_change",)))["P_next"])]


def _of_work(output: str, changing: tuple[str, ...]) -> list[Relation]:
    """Return the relation of the work over a step where these alone change."""
    def work(k: Numbers, s: State) -> Any:
        s = _only(s, changing)
        found, half = k(STEP, s), s["angle_change"] / 2
        return (found["on_c"].dot(s["c_change"]) + found["on_turn"] * 2 * _tangent(k, half)
                + found["on_alpha"] * s["alpha_change"] + found["on_s"].dot(s["s_change"]))

    def gain(k: Numbers, s: State) -> Any:
        s = _only(s, changing)
        energy: Callable[[Any, Any], Any] = lambda P, length: k("momentum_energy", s, P=P, l=length)["T"]  # noqa: E731
        return energy(k(STEP, s)["P_next"], s["l"] + s["s_change"][1] - s["s_change"][0]) - energy(s["P"], s["l"])

    return [Relation(STEP, output, f"work where {', '.join(changing)} change: that of the kinetic energy", 0,
                     lambda k, s, t, j: gain(k, s), of=work)]


def _only(s: State, changing: tuple[str, ...]) -> State:
    return s | {name: 0 * s[name] for name in CHANGES if name not in changing}


def _direction(k: Numbers, angle: Any) -> np.ndarray:
    at = np.asarray(angle).item()
    return np.array([k.cos(at), k.sin(at)])


def _tangent(k: Numbers, angle: Any) -> Any:
    at = np.asarray(angle).item()
    return k.sin(at) / k.cos(at)


def _cross(a: np.ndarray, b: np.ndarray) -> Any:
    return a[0] * b[1] - a[1] * b[0]
