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
    return [*_of_momentum(), *_of_step(), *_of_products(), *_of_chord(), *_of_store(), *_of_laying()]


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


OF_STORE = ("u_change", "c_change", "own_change", "theta")


def _turned(s: State, sign: int, vector: Any) -> Any:
    """Return a vector of the groove at an end of the step, by its mean over the step."""
    return vector + sign * cross(s["theta"], vector) / 2


def _of_store() -> list[Relation]:
    def ends(k: Numbers, s: State) -> list[tuple[Any, Any, Any]]:
        return [(s["u"], s["c"], s["V"]),
                (s["u"] + s["u_change"], s["c"] + s["c_change"], k("store_step", s)["V_next"])]

    def energies(k: Numbers, s: State) -> Any:
        one, other = (s["rho"] * u * (V[0] ** 2 / 2 + V[1:3].dot(V[1:3]) / 4 + V[3:].dot(V[3:]) / 2
                                      - s["gravity"].dot(c)) for u, c, V in ends(k, s))
        return other - one

    def work(k: Numbers, s: State) -> Any:
        found = k("store_step", s)
        return (found["on_c"].dot(s["c_change"]) + found["moment"].dot(s["theta"])
                + found["on_turn"] * s["own_change"] + found["on_u"] * s["u_change"])

    def angular_momentum(k: Numbers, s: State) -> Any:
        """Return the change of the angular momentum over h, less the moment of the weight."""
        frame = [s["axis"], s["axes"][:, 0] / 2, s["axes"][:, 1] / 2]
        one, other = (s["rho"] * u * (cross(c, V[3:]) + s["R"] * sum(V[j] * _turned(s, sign, frame[j])
                                                                     for j in range(3)))
                      for sign, (u, c, V) in zip((-1, 1), ends(k, s), strict=True))
        weight = s["rho"] * (s["u"] + s["u_change"] / 2) * s["gravity"]
        return (other - one) / s["h"] - cross(s["c"] + s["c_change"] / 2, weight)

    def moment(k: Numbers, s: State) -> Any:
        found = k("store_step", s)
        return found["moment"] + cross(s["c"] + s["c_change"] / 2, found["on_c"])

    def only(s: State, changing: tuple[str, ...]) -> State:
        return s | {name: 0 * s[name] for name in OF_STORE if name not in changing}

    def of_work(output: str, *changing: str) -> Relation:
        return Relation("store_step", output, f"work where {', '.join(changing)} change: that of the energies", 0,
                        lambda k, s, t, j: energies(k, only(s, changing)), of=lambda k, s: work(k, only(s, changing)))

    return [of_work("on_u", *OF_STORE), of_work("on_c", "c_change"), of_work("on_turn", "own_change"),
            Relation("store_step", "moment", "with on_c: the change of the angular momentum", 0,
                     lambda k, s, t, j: angular_momentum(k, s), of=moment),
            Relation("store_step", "V_next", "2 dc/h - V where all else is at rest", 0,
                     lambda k, s, t, j: np.array([0, 0, 0, *(2 * s["c_change"] / s["h"])]) - s["V"],
                     of=lambda k, s: k("store_step", only(s, ("c_change",)))["V_next"])]


def _of_laying() -> list[Relation]:
    def height(k: Numbers, s: State, sign: int, angle: Any) -> Any:
        cosine, sine = _direction(k, angle)
        return s["laid"] * s["gravity"].dot(_turned(s, sign, s["axes"].dot(np.array([-sine, cosine]))))

    def gain(k: Numbers, s: State) -> Any:
        return height(k, s, 1, s["angle_at"] + s["angle_change"]) - height(k, s, -1, s["angle_at"])

    def work(k: Numbers, s: State) -> Any:
        found, half = k("laid_step", s), np.asarray(s["angle_change"] / 2).item()
        return found["on_turn"] * 2 * (k.sin(half) / k.cos(half)) + found["moment"].dot(s["theta"])

    def of_work(output: str, fixed: str, text: str) -> Relation:
        return Relation("laid_step", output, text, 0, lambda k, s, t, j: gain(k, s | {fixed: 0 * s[fixed]}),
                        of=lambda k, s: work(k, s | {fixed: 0 * s[fixed]}))

    return [of_work("on_turn", "theta", "work where the angle changes: that of the energy"),
            of_work("moment", "angle_change", "work where the groove turns: that of the energy"),
            Relation("laid_step", "moment", "with on_turn, work: that of the energy", 0,
                     lambda k, s, t, j: gain(k, s), of=work)]
