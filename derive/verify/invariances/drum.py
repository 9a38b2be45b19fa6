"""Drums in cases known without derivation, and under motions of the frame."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from ..numbers import EPS, Numbers, State
from .measures import Invariance, relative

Scene = tuple[str, State, np.ndarray, float]
"""The text of a change of the frame, the changed state, the matrix of vectors, the sign of angles."""
CENTRE, LENGTH = slice(1, 3), 3
"""Where the centre and the wound length are among the forces of the wound rope; the rotation is first."""


def drum(k: Numbers, s: State, scenes: Sequence[Scene]) -> Iterator[Invariance]:
    """Yield signs, symmetries, turned and mirrored scenes, rolling, a drum at rest or in free fall, and winding without
    loss.
    """
    yield from _signs(k, s)
    for scene in scenes:
        yield from _frame(k, s, *scene)
    yield from _rolling(k, s)
    yield from _motion(k, s)
    yield from _even(k, s)


def _signs(k: Numbers, s: State) -> Iterator[Invariance]:
    rates, T, M = np.array([s["spin"], *s["c_rate"]]), k("store_energy", s)["T"], k("store_mass", s)["M"]
    yield "wound rope: T > 0", float(not T[0] > 0), 0.0
    yield "wound rope: v . M v = 2 T", relative(rates @ M @ rates - 2 * T, T), 64 * EPS
    yield "wound rope: M symmetric", relative(M - M.T, M), 0.0
    yield "wound rope: M has positive eigenvalues", float(not np.linalg.eigvalsh(M)[0] > 0), 0.0
    still = s | {"spin_acc": 0 * s["spin_acc"], "c_acc": 0 * s["c_acc"]}
    on_length = k("store", still)["F"][LENGTH] - k("store", s)["F"][LENGTH]
    yield "wound rope: no inertia of the length", float(np.max(np.abs(on_length))), 0.0
    for difference in (0.0, 1e-12, 1e-9, 1e-6, 1e-3, 0.1):
        for sign in (-1, 1):
            span = s["wound"] + sign * difference
            yield "loss >= 0", float(k("creep", s, span_stretch=span)["loss"][0] < 0), 0.0
    exchanged = k("creep", s, wound=s["span_stretch"], span_stretch=s["wound"])["loss"]
    yield "loss: same with the stretches exchanged", relative(exchanged - k("creep", s)["loss"], exchanged), 64 * EPS


def _frame(k: Numbers, s: State, text: str, other: State, about: np.ndarray, sign: float) -> Iterator[Invariance]:
    other = other | {name: sign * s[name] for name in ("spin", "spin_acc")}
    for kernel, output in (("winding_motion", "Q_d"), ("store_energy", "T"), ("store_energy", "V")):
        value = k(kernel, s)[output]
        yield f"{text} scene: same {output} of {kernel}", relative(k(kernel, other)[output] - value, value), 512 * EPS
    J, F = k("winding", s)["J"], k("store", s)["F"]
    of_winding = np.array([*about @ J[:2], sign * J[2], J[3]])
    yield f"{text} scene: J of winding follows", relative(k("winding", other)["J"] - of_winding, J), 512 * EPS
    of_store = np.array([sign * F[0], *about @ F[CENTRE], F[LENGTH]])
    yield f"{text} scene: store follows", relative(k("store", other)["F"] - of_store, F), 512 * EPS


def _rolling(k: Numbers, s: State) -> Iterator[Invariance]:
    """Yield motions that keep the condition of winding: a rope that rolls on a drum at rest, a drum that turns under
    its tangent point, and both together without winding.
    """
    winding = s | {"winds": np.float64(1.0)}
    J, turn = k("winding", winding)["J"], 0.7
    across = turn * np.array([-s["x"][1], s["x"][0]])
    wound = s["sense"] * s["R"] * turn / np.sqrt(s["slope"] @ s["slope"])
    for text, rates in (("a rope that rolls on a drum at rest is wound", [*across, 0.0, wound]),
                        ("a drum that turns winds", [0.0, 0.0, -turn, wound]),
                        ("a rope that turns with its drum is not wound", [*across, turn, 0.0])):
        yield text, relative(J @ np.array(rates), J), 64 * EPS
    still = winding | {"x_rate": np.zeros(2), "slope_rate": np.zeros(2)}
    yield "steady winding at a tangent point at rest", relative(k("winding_motion", still)["Q_d"], J), 0.0


def _motion(k: Numbers, s: State) -> Iterator[Invariance]:
    """Yield a drum at rest, whose rope has weight and W alone, one in free fall, and one that turns steadily."""
    still, none = np.zeros(2), np.float64(0.0)
    rest = s | {"winds": np.float64(1.0), "spin": none, "spin_acc": none, "u_rate": none, "c_rate": still,
                "c_acc": still}
    weight = s["rho"] * s["u"] * s["g"]
    W = k("creep", s, wound=np.sqrt(s["slope"] @ s["slope"]))["W"][0]
    F = k("store", rest)["F"]
    expected = np.array([0.0, *-weight, W - s["rho"] * s["g"] @ s["c"]])
    yield "drum at rest: weight, and energies of a length", relative(F - expected, expected), 64 * EPS
    falling = k("store", rest | {"c_acc": s["g"]})["F"]
    yield "drum in free fall: no force on the centre", relative(falling[CENTRE], weight), 16 * EPS
    turning = k("store", rest | {"spin": s["spin"]})["F"] - F
    expected[:] = [0.0, 0.0, 0.0, -s["rho"] * (s["R"] * s["spin"]) ** 2 / 2]
    yield "steady turn: kinetic energy of a length alone", relative(turning - expected, F), 64 * EPS
    u_rate = s["u_rate"]
    wound = k("store", rest | {"spin": s["spin"], "u_rate": u_rate})["F"] - F - turning
    expected[:] = [s["rho"] * s["R"] ** 2 * u_rate * s["spin"], 0.0, 0.0, 0.0]
    yield "steady winding: the moment that spins up what is wound", relative(wound - expected, F), 64 * EPS


def _even(k: Numbers, s: State) -> Iterator[Invariance]:
    """Yield that evenly stretched rope is wound and paid out with the same forces and without loss."""
    stretch = np.sqrt(s["slope"] @ s["slope"])
    even = s | {"wound": stretch, "span_stretch": stretch}
    wound, paid_out = (even | {"winds": np.float64(value)} for value in (1.0, 0.0))
    yield "even stretch: no loss", relative(k("creep", even)["loss"], k("creep", even)["W"]), (16 * EPS) ** 2
    for kernel, output in (("winding", "J"), ("store", "F")):
        value = k(kernel, wound)[output]
        yield f"even stretch: same {output} of {kernel} wound and paid out", relative(
            k(kernel, paid_out)[output] - value, value), 64 * EPS
    found = k("creep", s, span_stretch=stretch)
    on_length = k("store", s | {"winds": np.float64(0.0)})["F"] - k("store", wound)["F"]
    W = k("creep", even)["W"]
    yield "paid out: W of the wound stretch less the loss", relative(
        on_length[LENGTH] - (found["W"] - found["loss"] - W)[0], W), 64 * EPS
