"""Relations of the kernels of modal bodies: sums over mass points, moved along finite motions."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from ...bodies.modal import axial
from ...codegen.family import BodyFamily
from ..methods import Relation
from ..motion import RIDERS, cross, swung
from ..numbers import Numbers, State
from ..samples.modal import MODES, RATES, integrals


def unit(n: int, j: int) -> np.ndarray:
    """Return zeros with a one at entry j."""
    return np.array([int(i == j) for i in range(n)])


class Paths:
    """Finite motions of a body on a frame."""

    def __init__(self, family: BodyFamily):
        self.rider = RIDERS[family.rider]
        self.dim, self.n = self.rider.dim, self.rider.n_velocity

    def axes(self, b: np.ndarray) -> np.ndarray:
        """Return the body's axes A (dim, dim) at b."""
        still = np.concatenate([0 * b[: self.dim], b[self.dim :]])
        return np.stack([self.rider.point(still, e) for e in np.eye(self.dim, dtype=int)], axis=1)

    def velocity(self, s: State, u: np.ndarray, u1: np.ndarray) -> np.ndarray:
        """Return the velocity of a point u with the rate u1, in body axes."""
        omega = np.concatenate([[0 * u[0]] * (3 - (self.n - self.dim)), s["w"][self.dim :]])
        return s["w"][: self.dim] + self.axes(s["b"]).dot(swung(omega, u) + u1)

    def falling(self, k: Numbers, s: State, t: Any, j: int = 0) -> np.ndarray:
        """Return mass points along the motion with all accelerations, seen from the falling ground."""
        b = self.rider.moved(k, s["b"], t * s["w"] + t * t * s["a"] / 2)
        eta = s["eta"] + t * s["eta1"] + t * t * s["eta2"] / 2
        at = s["points"] + np.tensordot(eta, s["modes"], 1)
        return np.array([self.rider.point(b, u) for u in at]) - t * t * s["g"] / 2

    def work(self, k: Numbers, s: State, t: Any, j: int = 0) -> np.ndarray:
        """Return the masses times the places, along the motion by the frame's coordinates."""
        moved, A = self.falling(k, s, t), self.axes(s["b"])
        at = s["points"] + np.tensordot(s["eta"], s["modes"], 1)
        rho = s["masses"]
        return np.concatenate([rho.dot(moved), axial((rho[:, None] * at).T.dot(moved.dot(A)))])

    def work_of_mode(self, k: Numbers, s: State, t: Any, j: int = 0) -> Any:
        """Return the same along a mode."""
        return (s["masses"][:, None] * s["modes"][0].dot(self.axes(s["b"]).T) * self.falling(k, s, t)).sum()

    def attached(self, k: Numbers, s: State, motion: np.ndarray, eta: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the position and axes of the attachment; its section is turned by Cayley's formula."""
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

    # --- kernels moved --------------------------------------------------------------------------------------------

    def frame_moved(self, kernel: str, output: str) -> Callable[..., Any]:
        """Return the path of an output along translations and rotations of the frame."""
        return lambda k, s, t, j: k(kernel, s, b=self.rider.moved(k, s["b"], t * unit(self.n, j)))[output]

    def point(self, which: int, by: str) -> Callable[..., Any]:
        """Return the path of the attachment's position (which 0) or axes (1), by "frame", "mode" or "time"."""
        def path(k, s, t, j):
            motion, eta = {"frame": (t * unit(self.n, j), np.zeros(MODES, dtype=int)),
                           "mode": (0 * s["w"], t * unit(MODES, 0)), "time": (t * s["w"], t * s["eta1"])}[by]
            return self.attached(k, s, motion, eta)[which]
        return path

    def by_frame(self, pull: Callable[..., Any]) -> Callable[..., Any]:
        """Return the path of a force along translations and rotations of the frame."""
        return lambda k, s, t, j: pull(k, s, b=self.rider.moved(k, s["b"], t * unit(self.n, j)))

    # --- energies -------------------------------------------------------------------------------------------------

    def energy(self, k: Numbers, s: State, t: Any, j: int = 0) -> Any:
        """Return the kinetic energy along the motion with all accelerations, of the kernel."""
        b = self.rider.moved(k, s["b"], t * s["w"] + t * t * s["a"] / 2)
        moved = integrals(s, eta=s["eta"] + t * s["eta1"], eta1=s["eta1"] + t * s["eta2"])
        return k("kinetic_energy", s, b=b, w=s["w"] + t * s["a"], **moved)["T"]

    def kinetic(self, k: Numbers, s: State, t: Any, j: int = 0) -> Any:
        """Return the kinetic energy of the mass points."""
        at, rate = (x + np.tensordot(s[name], s["modes"], 1) for x, name in ((s["points"], "eta"), (0, "eta1")))
        speeds = [self.velocity(s, u, u1) for u, u1 in zip(at, rate, strict=True)]
        return sum(m * v.dot(v) / 2 for m, v in zip(s["masses"], speeds, strict=True))

    def potential(self, k: Numbers, s: State, t: Any, j: int = 0) -> Any:
        """Return the potential energy of the mass points."""
        at = s["points"] + np.tensordot(s["eta"], s["modes"], 1)
        return -sum(m * s["g"].dot(self.rider.point(s["b"], u)) for m, u in zip(s["masses"], at, strict=True))


def along(kernel: str, name: str) -> Callable[..., Any]:
    """Return the path of a kernel's force along the entries of an input."""
    return lambda k, s, t, j: k(kernel, s, **{name: s[name] + t * unit(len(s[name]), j)})["f"]


def mode_moved(kernel: str, name: str, mode: int = 0) -> Callable[..., Any]:
    """Return the path of a kernel's force along eta, eta' or eta'' of a mode."""
    return lambda k, s, t, j: k(kernel, s, **integrals(s, **{name: s[name] + t * unit(MODES, mode)}))["f"]


def by_mode(pull: Callable[..., Any], mode: int) -> Callable[..., Any]:
    """Return the path of a force along eta of a mode."""
    def path(k, s, t, j):
        moved = integrals(s, eta=s["eta"] + t * unit(MODES, mode))
        return pull(k, s, u=moved["u"], theta=moved["theta"])
    return path


def power(k: Numbers, s: State) -> Any:
    """Return f . w + sum f_k eta_k' without weight."""
    still = {**s, "g": 0 * s["g"]}
    other = integrals({**still, "modes": s["modes"][::-1], **{name: s[name][::-1] for name in RATES}})
    return (k("inertia_force", still)["f"].dot(s["w"]) + k("mode_force", still)["f"][0] * s["eta1"][0]
            + k("mode_force", {**still, **other})["f"][0] * s["eta1"][1])


def turning(kernel: str, output: str, columns: bool = True) -> Callable[..., Any]:
    """Return the turn of the axes by each column, or by the one vector, of an output."""
    def of(k, s):
        axes, T = k("attachment", s)["axes"], k(kernel, s)[output]
        T = T if columns else T[:, None]
        return np.stack([_swung(T[:, j], axes) for j in range(T.shape[1])], axis=-1)
    return of


def turning_rate(k: Numbers, s: State) -> np.ndarray:
    """Return the second rate of the axes at constant velocities."""
    out = k("attachment", s)
    return _swung(out["omega_bias"], out["axes"]) + _swung(out["omega"], _swung(out["omega"], out["axes"]))


def pulled(k: Numbers, s: State, **changes) -> np.ndarray:
    """Return the frame's rows of P' f + T' m."""
    out = k("attachment", s, **changes)
    return out["P"].T.dot(s["f"]) + out["T"].T.dot(s["m"])


def mode_pulled(k: Numbers, s: State, **changes) -> np.ndarray:
    """Return a mode's row of P' f + T' m."""
    out = k("attachment_mode", s, **changes)
    return out["P"].dot(s["f"]) + out["T"].dot(s["m"])


RATES_OF = (("v", "velocity"), ("omega", "omega"))
"""Names of velocities in the kernels of derivatives, and in `attachment`."""


def modal(family: BodyFamily) -> list[Relation]:
    """Return the relations of every output of a modal body's kernels."""
    p = Paths(family)
    return [*_of_inertia(p), *_of_attachment(p)]


def _of_inertia(p: Paths) -> list[Relation]:
    n = p.n
    return [
        Relation("inertia_force", "f", "Σ m (p'' - g) over mass points, along the frame's motions", 2, p.work),
        Relation("inertia_force", "f", "all power is the rate of the kinetic energy", 1, p.energy, of=power),
        Relation("mass_matrix", "M", "df/da", 1, along("inertia_force", "a"), n),
        Relation("inertia_tangent", "D", "df/dw", 1, along("inertia_force", "w"), n),
        Relation("inertia_tangent", "K", "df by translation and rotation", 1, p.frame_moved("inertia_force", "f"), n),
        Relation("mode_force", "f", "Σ m phi.(p'' - g) over mass points", 2, p.work_of_mode),
        Relation("mode_mass", "M", "df/da of the mode", 1, along("mode_force", "a"), n),
        Relation("mode_mass", "M", "df of the frame by eta''", 1, mode_moved("inertia_force", "eta2")),
        Relation("mode_tangent", "D", "df/dw", 1, along("mode_force", "w"), n),
        Relation("mode_tangent", "K", "df by translation and rotation", 1, p.frame_moved("mode_force", "f"), n),
        Relation("mode_tangent", "D_frame", "df of the frame by eta'", 1, mode_moved("inertia_force", "eta1")),
        Relation("mode_tangent", "K_frame", "df of the frame by eta", 1, mode_moved("inertia_force", "eta")),
        Relation("pair_tangent", "D", "df by eta' of the other", 1, mode_moved("mode_force", "eta1", 1)),
        Relation("pair_tangent", "K", "df by eta of the other", 1, mode_moved("mode_force", "eta", 1)),
        Relation("kinetic_energy", "T", "Σ ½ m v² of mass points", 0, p.kinetic),
        Relation("potential_energy", "V", "-Σ m g.p of mass points", 0, p.potential),
    ]


def _of_attachment(p: Paths) -> list[Relation]:
    n = p.n
    return [
        Relation("attachment", "p", "R + A (x + Σ phi eta)", 0, p.point(0, "time")),
        Relation("attachment", "axes", "A C by Cayley's formula", 0, p.point(1, "time")),
        Relation("attachment", "P", "dp by translation and rotation", 1, p.point(0, "frame"), n),
        Relation("attachment", "T", "d axes = (T dq)~ axes", 1, p.point(1, "frame"), n, of=turning("attachment", "T")),
        Relation("attachment", "velocity", "dp/dt", 1, p.point(0, "time")),
        Relation("attachment", "omega", "d axes/dt", 1, p.point(1, "time"),
                 of=turning("attachment", "omega", columns=False)),
        Relation("attachment", "bias", "d²p/dt² at constant velocities", 2, p.point(0, "time")),
        Relation("attachment", "omega_bias", "d² axes/dt² at constant velocities", 2, p.point(1, "time"),
                 of=turning_rate),
        Relation("attachment_mode", "P", "dp by eta", 1, p.point(0, "mode")),
        Relation("attachment_mode", "T", "d axes by eta", 1, p.point(1, "mode"),
                 of=turning("attachment_mode", "T", columns=False)),
        Relation("attachment_wrench", "K", "d(P' f + T' m) by translation and rotation", 1, p.by_frame(pulled), n),
        Relation("attachment_mode_wrench", "K", "d(P' f + T' m) of the mode by translation and rotation", 1,
                 p.by_frame(mode_pulled), n),
        Relation("attachment_mode_wrench", "K_frame", "d(P' f + T' m) of the frame by eta", 1, by_mode(pulled, 0)),
        *(Relation("attachment_wrench", f"{rate}_q", f"d({output}) by translation and rotation at fixed rates", 1,
                   p.frame_moved("attachment", output), n) for rate, output in RATES_OF),
        *(Relation("attachment_mode_wrench", f"{rate}_eta", f"d({output}) by eta at fixed rates", 1,
                   by_mode(lambda k, s, output=output, **changes: k("attachment", s, **changes)[output], 0))
          for rate, output in RATES_OF),
        Relation("attachment_pair_wrench", "K", "d(P' f + T' m) of the mode by eta of the other", 1,
                 by_mode(mode_pulled, 1)),
    ]


def _swung(theta: np.ndarray, axes: np.ndarray) -> np.ndarray:
    """Return theta x each column."""
    spatial = np.concatenate([[0 * theta[0]] * (3 - len(theta)), theta])
    return np.stack([swung(spatial, column) for column in axes.T], axis=1)
