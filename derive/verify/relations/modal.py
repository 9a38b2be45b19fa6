"""Modal bodies under verification: a handful of mass points with two modes, moved for real.

The kernels see integrals over the points; the paths here sum over the points themselves, along finite motions.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...bodies.modal import axial, vector_product
from ...spec import Family
from ..invariances.element import FAR, Invariance, quantised, relative
from ..methods import Relation
from ..motion import RIDERS, cross, swung
from ..numbers import EPS, Numbers, State

POINTS, MODES = 4, 2
RATES = ("eta", "eta1", "eta2")


def sample(random: np.random.Generator, dim: int) -> dict[str, np.ndarray]:
    """Mass points, modes and their coordinates; the modes at one more point, which an anchor takes."""
    turns = 1 if dim == 2 else 3
    made = {"points": random.normal(size=(POINTS, dim)), "modes": random.normal(size=(MODES, POINTS, dim)) / 2,
            "masses": random.uniform(0.5, 1.5, POINTS), "g": random.normal(size=dim),
            "place": random.normal(size=dim), "phis": random.normal(size=(MODES, dim)),
            "psis": random.uniform(0.5, 1.5, (MODES, turns)), "m": random.normal(size=turns)}
    # of one sign: what cancels by chance would be held to digits that it has not
    made |= {name: random.uniform(-0.8, -0.2, MODES) for name in RATES}
    made["c"] = random.uniform(0.5, 1.5, dim)
    return made | integrals(made)


def integrals(s: State, **moved: np.ndarray) -> dict[str, np.ndarray]:
    """What the kernels take at these coordinates, some of them moved."""
    s = {**s, **moved}
    rho = s["masses"]
    fields = [s["points"] + np.tensordot(s["eta"], s["modes"], 1),
              *(np.tensordot(s[name], s["modes"], 1) for name in RATES[1:])]
    mode, other = s["modes"]

    def second(a, b):
        return (rho[:, None] * a).T.dot(b)

    made = {"mass": rho.sum(), "s": rho.dot(mode), "X_kl": second(mode, other),
            "X11": second(fields[1], fields[1]).trace()}
    for k, field in enumerate(fields):
        made |= {f"S{k or ''}": rho.dot(field), f"X{k or ''}": second(fields[0], field),
                 f"Y{k or ''}": second(mode, field)}
    theta = [s[name].dot(s["psis"]) for name in RATES[:2]]
    return made | {"u": s["place"] + s["eta"].dot(s["phis"]), "u1": s["eta1"].dot(s["phis"]), "theta": theta[0],
                   "theta1": theta[1], "phi": s["phis"][0], "psi": s["psis"][0], "phi_l": s["phis"][1],
                   "psi_l": s["psis"][1]}


def unit(n: int, j: int) -> np.ndarray:
    """Zeros with a one at entry j."""
    return np.array([int(i == j) for i in range(n)])


class Paths:
    """Finite motions of a body on a frame."""

    def __init__(self, family: Family):
        self.rider = RIDERS[family.rider]
        self.dim, self.n = self.rider.dim, self.rider.n_velocity

    def axes(self, b: np.ndarray) -> np.ndarray:
        """A."""
        still = np.concatenate([0 * b[: self.dim], b[self.dim :]])
        return np.stack([self.rider.point(still, e) for e in np.eye(self.dim, dtype=int)], axis=1)

    def velocity(self, s: State, u: np.ndarray, u1: np.ndarray) -> np.ndarray:
        """Of a point."""
        omega = np.concatenate([[0 * u[0]] * (3 - (self.n - self.dim)), s["w"][self.dim :]])
        return s["w"][: self.dim] + self.axes(s["b"]).dot(swung(omega, u) + u1)

    def falling(self, k: Numbers, s: State, t, j=0) -> np.ndarray:
        """Mass points along the motion with all accelerations, seen from the falling ground."""
        b = self.rider.moved(k, s["b"], t * s["w"] + t * t * s["a"] / 2)
        eta = s["eta"] + t * s["eta1"] + t * t * s["eta2"] / 2
        at = s["points"] + np.tensordot(eta, s["modes"], 1)
        return np.array([self.rider.point(b, u) for u in at]) - t * t * s["g"] / 2

    def work(self, k: Numbers, s: State, t, j=0) -> np.ndarray:
        """Masses times the places, along what the frame's coordinates move."""
        moved, A = self.falling(k, s, t), self.axes(s["b"])
        at = s["points"] + np.tensordot(s["eta"], s["modes"], 1)
        rho = s["masses"]
        return np.concatenate([rho.dot(moved), axial((rho[:, None] * at).T.dot(moved.dot(A)))])

    def work_of_mode(self, k: Numbers, s: State, t, j=0):
        """The same along a mode."""
        return (s["masses"][:, None] * s["modes"][0].dot(self.axes(s["b"]).T) * self.falling(k, s, t)).sum()

    def anchored(self, k: Numbers, s: State, motion: np.ndarray, eta: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Place and axes of the anchor's point; the section turned by quaternions."""
        b = self.rider.moved(k, s["b"], motion)
        theta = (s["eta"] + eta).dot(s["psis"])
        if self.dim == 2:
            tangent = theta[0] / 2
            c, d = (1 - tangent**2) / (1 + tangent**2), 2 * tangent / (1 + tangent**2)
            C = np.array([[c, -d], [d, c]])
        else:  # Cayley's formula from its definition: (1 - theta~/2) C = 1 + theta~/2
            C = np.stack([e + (cross(theta, e) + cross(theta, cross(theta, e)) / 2) / (1 + theta.dot(theta) / 4)
                          for e in np.eye(3, dtype=int)], axis=1)
        return self.rider.point(b, s["place"] + (s["eta"] + eta).dot(s["phis"])), self.axes(b).dot(C)


def modal(family: Family) -> list[Relation]:
    """Every output of a modal body's kernels."""
    p = Paths(family)
    rider, n, zero = p.rider, p.n, np.zeros(MODES, dtype=int)

    def frame_moved(kernel: str, output: str) -> Relation:
        return lambda k, s, t, j: k(kernel, s, b=rider.moved(k, s["b"], t * unit(n, j)))[output]

    def along(kernel: str, name: str):
        return lambda k, s, t, j: k(kernel, s, **{name: s[name] + t * unit(len(s[name]), j)})["f"]

    def mode_moved(kernel: str, name: str, mode: int = 0):
        return lambda k, s, t, j: k(kernel, s, **integrals(s, **{name: s[name] + t * unit(MODES, mode)}))["f"]

    def power(k, s):
        """f . w + sum f_k eta_k' without weight."""
        still = {**s, "g": 0 * s["g"]}
        other = integrals({**still, "modes": s["modes"][::-1], **{name: s[name][::-1] for name in RATES}})
        return (k("inertia_force", still)["f"].dot(s["w"]) + k("mode_force", still)["f"][0] * s["eta1"][0]
                + k("mode_force", {**still, **other})["f"][0] * s["eta1"][1])

    def energy(k, s, t, j):
        b = rider.moved(k, s["b"], t * s["w"] + t * t * s["a"] / 2)
        moved = integrals(s, eta=s["eta"] + t * s["eta1"], eta1=s["eta1"] + t * s["eta2"])
        return k("kinetic_energy", s, b=b, w=s["w"] + t * s["a"], **moved)["T"]

    def kinetic(k, s, t, j):
        at, rate = (x + np.tensordot(s[name], s["modes"], 1) for x, name in ((s["points"], "eta"), (0, "eta1")))
        speeds = [p.velocity(s, u, u1) for u, u1 in zip(at, rate, strict=True)]
        return sum(m * v.dot(v) / 2 for m, v in zip(s["masses"], speeds, strict=True))

    def potential(k, s, t, j):
        at = s["points"] + np.tensordot(s["eta"], s["modes"], 1)
        return -sum(m * s["g"].dot(rider.point(s["b"], u)) for m, u in zip(s["masses"], at, strict=True))

    def point(which: int, by: str):
        def path(k, s, t, j):
            motion, eta = {"frame": (t * unit(n, j), zero), "mode": (0 * s["w"], t * unit(MODES, 0)),
                           "time": (t * s["w"], t * s["eta1"])}[by]
            return p.anchored(k, s, motion, eta)[which]
        return path

    def turning(kernel: str, output: str, columns: bool = True):
        """What turns the axes by each column (or by the one vector) of an output."""
        def of(k, s):
            axes, T = k("anchor", s)["axes"], k(kernel, s)[output]
            T = T if columns else T[:, None]
            return np.stack([_swung(T[:, j], axes) for j in range(T.shape[1])], axis=-1)
        return of

    def second(k, s):
        out = k("anchor", s)
        return _swung(out["omega_bias"], out["axes"]) + _swung(out["omega"], _swung(out["omega"], out["axes"]))

    def pulled(k, s, **changes):
        out = k("anchor", s, **changes)
        return out["P"].T.dot(s["f"]) + out["T"].T.dot(s["m"])

    def mode_pulled(k, s, **changes):
        out = k("anchor_mode", s, **changes)
        return out["P"].dot(s["f"]) + out["T"].dot(s["m"])

    def followed(k, s, **changes):
        return k("anchor", s, **changes)["axes"].dot(s["c"])

    def follower(kernel):
        return lambda k, s, **changes: k(kernel, s, **changes)["g"]

    def by_frame(pull):
        return lambda k, s, t, j: pull(k, s, b=rider.moved(k, s["b"], t * unit(n, j)))

    def by_mode(pull, mode: int):
        def path(k, s, t, j):
            moved = integrals(s, eta=s["eta"] + t * unit(MODES, mode))
            return pull(k, s, u=moved["u"], theta=moved["theta"])
        return path

    return [
        Relation("inertia_force", "f", "Σ m (p'' - g) over mass points, along the frame's motions", 2, p.work),
        Relation("inertia_force", "f", "all power is the rate of the kinetic energy", 1, energy, of=power),
        Relation("mass_matrix", "M", "df/da", 1, along("inertia_force", "a"), n),
        Relation("inertia_tangent", "D", "df/dw", 1, along("inertia_force", "w"), n),
        Relation("inertia_tangent", "K", "df by translation and rotation", 1, frame_moved("inertia_force", "f"), n),
        Relation("mode_force", "f", "Σ m phi.(p'' - g) over mass points", 2, p.work_of_mode),
        Relation("mode_mass", "M", "df/da of the mode", 1, along("mode_force", "a"), n),
        Relation("mode_mass", "M", "df of the frame by eta''", 1, mode_moved("inertia_force", "eta2")),
        Relation("mode_tangent", "D", "df/dw", 1, along("mode_force", "w"), n),
        Relation("mode_tangent", "K", "df by translation and rotation", 1, frame_moved("mode_force", "f"), n),
        Relation("mode_tangent", "D_frame", "df of the frame by eta'", 1, mode_moved("inertia_force", "eta1")),
        Relation("mode_tangent", "K_frame", "df of the frame by eta", 1, mode_moved("inertia_force", "eta")),
        Relation("pair_tangent", "D", "df by eta' of the other", 1, mode_moved("mode_force", "eta1", 1)),
        Relation("pair_tangent", "K", "df by eta of the other", 1, mode_moved("mode_force", "eta", 1)),
        Relation("kinetic_energy", "T", "Σ ½ m v² of mass points", 0, kinetic),
        Relation("potential_energy", "V", "-Σ m g.p of mass points", 0, potential),
        Relation("anchor", "p", "R + A (x + Σ phi eta)", 0, point(0, "time")),
        Relation("anchor", "axes", "A C by Cayley's formula", 0, point(1, "time")),
        Relation("anchor", "P", "dp by translation and rotation", 1, point(0, "frame"), n),
        Relation("anchor", "T", "d axes = (T dq)~ axes", 1, point(1, "frame"), n, of=turning("anchor", "T")),
        Relation("anchor", "velocity", "dp/dt", 1, point(0, "time")),
        Relation("anchor", "omega", "d axes/dt", 1, point(1, "time"), of=turning("anchor", "omega", columns=False)),
        Relation("anchor", "bias", "d²p/dt² at constant velocities", 2, point(0, "time")),
        Relation("anchor", "omega_bias", "d² axes/dt² at constant velocities", 2, point(1, "time"), of=second),
        Relation("anchor_mode", "P", "dp by eta", 1, point(0, "mode")),
        Relation("anchor_mode", "T", "d axes by eta", 1, point(1, "mode"),
                 of=turning("anchor_mode", "T", columns=False)),
        Relation("anchor_force", "K", "d(P' f + T' m) by translation and rotation", 1, by_frame(pulled), n),
        Relation("anchor_mode_force", "K", "d(P' f + T' m) of the mode by translation and rotation", 1,
                 by_frame(mode_pulled), n),
        Relation("anchor_mode_force", "K_frame", "d(P' f + T' m) of the frame by eta", 1, by_mode(pulled, 0)),
        Relation("anchor_pair_force", "K", "d(P' f + T' m) of the mode by eta of the other", 1,
                 by_mode(mode_pulled, 1)),
        Relation("anchor_follower", "g", "P' (axes c)", 0,
                 lambda k, s, t, j: k("anchor", s)["P"].T.dot(followed(k, s))),
        Relation("anchor_follower", "K", "dg by translation and rotation", 1, by_frame(follower("anchor_follower")), n),
        Relation("anchor_mode_follower", "g", "P' (axes c) of the mode", 0,
                 lambda k, s, t, j: k("anchor_mode", s)["P"].dot(followed(k, s))),
        Relation("anchor_mode_follower", "K_frame", "dg of the frame by eta", 1,
                 by_mode(follower("anchor_follower"), 0)),
        Relation("anchor_pair_follower", "K", "dg of the mode by eta of the other", 1,
                 by_mode(follower("anchor_mode_follower"), 1)),
    ]


def _swung(theta: np.ndarray, axes: np.ndarray) -> np.ndarray:
    """theta x each column."""
    spatial = np.concatenate([[0 * theta[0]] * (3 - len(theta)), theta])
    return np.stack([swung(spatial, column) for column in axes.T], axis=1)


def invariances(family: Family, k: Numbers, s: State) -> Iterator[Invariance]:
    """Symmetry, momentum, digits."""
    p = Paths(family)
    M = k("mass_matrix", s)["M"]
    yield "M symmetric", relative(M - M.T, M), 8 * EPS
    least = float(np.linalg.eigvalsh((M + M.T) / 2)[0]) if np.isfinite(M).all() else -np.inf
    yield "M positive definite (least eigenvalue below zero)", max(-least, 0.0), 0.0
    axes = k("anchor", s)["axes"]
    yield "axes' axes = 1", relative(axes.T @ axes - np.eye(len(axes)), 1), 8 * EPS
    b = np.concatenate([quantised(s["b"][: p.dim]) + FAR, s["b"][p.dim :]])
    yield "forces: same digits at 10⁴ lengths", max(
        relative(k(name, s, b=b)["f"] - k(name, s)["f"], 1) for name in ("inertia_force", "mode_force")), 0.0
    along = vector_product(s["S"], s["g"])
    weight = k("inertia_force", {**s, "w": 0 * s["w"], "a": 0 * s["a"], "S1": 0 * s["S1"], "S2": 0 * s["S2"],
                                 "X1": 0 * s["X1"], "X2": 0 * s["X2"], "b": np.eye(len(s["b"]))[p.dim]})["f"]
    yield "weight is m g, its moment S x g", relative(
        weight + np.concatenate([s["mass"] * s["g"], along]), weight), 8 * EPS
