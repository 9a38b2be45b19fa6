"""Relations of the kernels of drums: the condition of winding, and the wound rope."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..methods import Relation
from ..numbers import Numbers, State
from ..references import drum as reference
from .paths import along, of, root, unit

RATES = (("spin", 1), ("c_rate", 2))
"""Names and sizes of the rates on which the kinetic energy depends; those of their accelerations follow."""
SECOND_RATES = (("spin_acc", 1), ("c_acc", 2))
COORDINATES = (("c", 2), ("u", 1))
CENTRE, LENGTH = slice(1, 3), 3
"""Where the centre and the wound length are among the forces of the wound rope; the rotation is first."""
N = 4


def drum() -> list[Relation]:
    """Return the relations of a drum's kernels."""
    return [*_of_winding(), *_of_motion(), *_of_energies(), *_of_forces(), *_of_tangent(), *_of_step()]


def passing(s: State) -> Any:
    """Return the stretch of what passes."""
    return s["winds"] * _span_stretch(s) + (1 - s["winds"]) * s["wound"]


def _span_stretch(s: State) -> Any:
    return s["slope"].dot(s["slope"]) ** 0.5


def _of_winding() -> list[Relation]:
    def condition(k, s, t, j):
        """Return the way on the rim less the drawn length, x, the drum or the wound length moved by t."""
        arm = s["sense"] * s["R"]
        if j < 2:
            x = s["x"] + t * unit(s["x"], j)  # the sine of the angle's change has the same derivative
            return arm * (s["x"][0] * x[1] - s["x"][1] * x[0]) / (s["x"].dot(s["x"]) * x.dot(x)) ** 0.5
        return -(arm if j == 2 else passing(s)) * t

    def rate(k, s):
        return k("winding", s)["J"].dot(_rates(s))

    def force(k, s):
        J = k("winding", s)["J"]
        return np.array([J[0], J[1], J[3]]) * s["tension"]

    return [Relation("winding", "J", "d(way on the rim - drawn length) by x, turn and length", 1, condition,
                     4),
            Relation("winding", "J", "rates: those of the way on the rim less the drawn length", 0,
                     root(reference.winding), of=rate),
            Relation("winding", "K", "d(J' tension) by x and the slope", 1, along(force, (("x", 2), ("slope", 2))), 4)]


def _rates(s: State) -> np.ndarray:
    return np.array([*s["x_rate"], s["spin"].item(), s["u_rate"].item()])


def _of_motion() -> list[Relation]:
    def drifting(k, s, t, j):
        return k("winding", s, x=s["x"] + t * s["x_rate"], slope=s["slope"] + t * s["slope_rate"])["J"].dot(_rates(s))

    return [Relation("winding_motion", "Q_d", "d(J v)/dt at zero accelerations", 1, drifting),
            Relation("winding_motion", "Q_d", "second rate of the way on the rim less the drawn length", 0,
                     root(reference.winding_motion))]


def _of_energies() -> list[Relation]:
    def elastic_energy(s: State) -> Any:
        return reference.elastic_energy(s, s["wound"].item())

    def paid_out(k, s, t, j):
        """Return the growth of energies over t of the wound length, less that of the work on it."""
        s = s | {"winds": 0 * s["winds"], "slope": s["slope"] * s["span_stretch"] / _span_stretch(s)}
        work = k("store", s)["F"][LENGTH] * t
        return k("creep", s)["W"] * t + _total(k, s, {"u": s["u"] + t}) - work

    return [Relation("store_energy", "T", "rho u/2 mean of |dr/dt|² over points on a turn", 0,
                     root(reference.kinetic_energy)),
            Relation("store_energy", "V", "-rho u mean of g . r over points on a turn", 0, root(reference.gravity)),
            Relation("laying", "V", "-rho/2 ∫ g . x over the lengths of the half turn before the point", 0,
                     root(reference.laying)),
            Relation("laying", "F", "dV by x", 1, along(of("laying", "V"), (("x", 2),)), 2),
            Relation("creep", "W", "(EA strain² + EI curvature²)/2 of rope on the rim", 0, root(elastic_energy)),
            Relation("creep", "loss", "∫ W' - W'(span) from the span's stretch to the wound one", 0,
                     root(reference.loss)),
            Relation("creep", "loss", "d(V - T + W u) by u less its force, as rope is paid out", 1, paid_out)]


def _total(k: Numbers, s: State, changes: State) -> Any:
    """Return V - T."""
    energy = k("store_energy", s, **changes)
    return energy["V"] - energy["T"]


def _moved(s: State, t: Any) -> State:
    """Return the wound rope at the time t of a motion with the state's rates and accelerations."""
    changes: State = {"u": s["u"] + t * s["u_rate"], "c": s["c"] + t * s["c_rate"]}
    return changes | {rate: s[rate] + t * s[second]
                      for (rate, _), (second, _) in zip(RATES, SECOND_RATES, strict=True)}


def _elastic(k: Numbers, s: State) -> Any:
    """Return the elastic energy a length that the rope takes along or gives back where it passes."""
    found = k("creep", s, wound=passing(s), span_stretch=_span_stretch(s))
    return found["W"] - found["loss"]


def _of_forces() -> list[Relation]:
    places = [(name, k, size) for name, size in RATES for k in range(size)]

    def momentum(k: Numbers, s: State, j: int) -> Any:
        """Return dT by a rate: the difference over a unit is exact, as T is quadratic in the rates."""
        name, at, size = places[j]
        step = unit(s[name], at) if size > 1 else 1
        return (k("store_energy", s, **{name: s[name] + step})["T"]
                - k("store_energy", s, **{name: s[name] - step})["T"]) / 2

    def lagrange(k, s, t, j):
        if j == LENGTH:
            return _total(k, s, {"u": s["u"] + t}) + t * _elastic(k, s)
        displaced: State = {"c": s["c"] + t * unit(s["c"], j - CENTRE.start)} if j in (1, 2) else {}
        return momentum(k, s | _moved(s, t), j) + _total(k, s, displaced)

    def energy(k, s, t, j):
        found = k("store_energy", s, **_moved(s, t))
        return found["T"] + found["V"] + t * s["u_rate"] * _elastic(k, s)

    def power(k, s):
        return k("store", s)["F"].dot(np.array([s["spin"].item(), *s["c_rate"], s["u_rate"].item()]))

    return [Relation("store", "F", "d/dt dT/dv - dT/dq + dV/dq, and the elastic energy that passes", 1, lagrange, N),
            Relation("store", "F", "power: d(T + V)/dt, and the elastic energy that passes", 1, energy, of=power),
            Relation("store", "F", "rates of momenta of points on a turn, and energies of a length", 0,
                     root(reference.forces))]


def _of_tangent() -> list[Relation]:
    force = of("store", "F")

    def on_both(k, s):
        return force(k, s)[:LENGTH]

    return [Relation("store_mass", "M", "dF by accelerations", 1, along(on_both, SECOND_RATES), 3),
            Relation("store_tangent", "D", "dF by rates", 1, along(force, (*RATES, ("u_rate", 1))), N),
            Relation("store_tangent", "K", "dF by the centre, the length and the slope", 1,
                     along(force, (*COORDINATES, ("slope", 2))), 5)]


CHANGES = ("u_change", "c_change", "turn_change")


def _of_step() -> list[Relation]:
    def ends(k: Numbers, s: State) -> tuple[State, State]:
        """Return the wound rope at both ends of a step, its velocities as spin and c_rate."""
        after = s | {"u": s["u"] + s["u_change"], "c": s["c"] + s["c_change"], "V": k("store_step", s)["V_next"]}
        one, other = (at | {"spin": at["V"][0] / s["R"], "c_rate": at["V"][1:]} for at in (s, after))
        return one, other

    def energies(k: Numbers, s: State) -> Any:
        one, other = (k("store_energy", at) for at in ends(k, s))
        return other["T"] + other["V"] - one["T"] - one["V"]

    def angular_momentum(k: Numbers, s: State) -> Any:
        """Return the change of the angular momentum over h, less the moment of the weight."""
        one, other = (s["rho"] * at["u"] * (s["R"] * at["V"][0] + _cross(at["c"], at["V"][1:])) for at in ends(k, s))
        weight = s["rho"] * (s["u"] + s["u_change"] / 2) * s["g"]
        return (other - one) / s["h"] - _cross(s["c"] + s["c_change"] / 2, weight)

    def moment(k: Numbers, s: State) -> Any:
        F = k("store_step", s)["F"]
        return F[0] + _cross(s["c"] + s["c_change"] / 2, F[CENTRE])

    def work(k: Numbers, s: State) -> Any:
        F = k("store_step", s)["F"]
        return F[0] * s["turn_change"] + F[CENTRE].dot(s["c_change"]) + F[LENGTH] * s["u_change"]

    def only(s: State, changing: tuple[str, ...]) -> State:
        return s | {name: 0 * s[name] for name in CHANGES if name not in changing}

    def of_work(changing: tuple[str, ...]) -> Relation:
        return Relation("store_step", "F", f"work where {', '.join(changing)} change: that of the energies", 0,
                        lambda k, s, t, j: energies(k, only(s, changing)), of=lambda k, s: work(k, only(s, changing)))

    return [*(of_work(changing) for changing in (CHANGES, *((name,) for name in CHANGES))),
            Relation("store_step", "F", "moment: the change of the angular momentum", 0,
                     lambda k, s, t, j: angular_momentum(k, s), of=moment),
            Relation("store_step", "V_next", "with V, the mean: displacements over h", 0,
                     lambda k, s, t, j: 2 / s["h"] * np.array([s["R"] * s["turn_change"], *s["c_change"]]),
                     of=lambda k, s: k("store_step", s)["V_next"] + s["V"])]


def _cross(a: np.ndarray, b: np.ndarray) -> Any:
    return a[0] * b[1] - a[1] * b[0]
