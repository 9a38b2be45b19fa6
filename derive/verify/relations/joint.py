"""What the kernels of frames and joints are derivatives of, and which motions a joint lets pass.

Axes are turned by quaternions, which the derivation knows nothing of.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...couplings.frame import TURNS
from ...spec import Family
from ..methods import Relation
from ..motion import cross, exponential, frame, turned
from ..numbers import EPS, Numbers, State
from .element import from_kernel

# Motions of the second frame along and about axes of the first that a joint lets pass; c is driven by its own rate.
FREE = {"spherical": "rx ry rz", "revolute": "rz", "revolute_angle": "", "universal": "rx rz", "cylindrical": "z rz",
        "cylindrical_angle": "z", "cylindrical_distance": "rz", "prismatic": "z", "prismatic_distance": "", "weld": "",
        "distance": None, "aligned": "x y z rz", "locked": "x y z",
        "planar_spherical": "rz", "planar_revolute_angle": "", "planar_prismatic": "x", "planar_prismatic_distance": "",
        "planar_weld": "", "planar_distance": None, "planar_locked": "x y"}


def samples(family: Family, random: np.random.Generator) -> dict[str, np.ndarray]:
    """Inputs of the kernels of a frame, a joint or a resistance."""
    dim, turns = family.dim, TURNS[family.dim]
    if family.role == "frame":
        names = ("a", "b", "a_rate", "b_rate", "a_second", "b_second")
        return {name: random.normal(size=dim) for name in names} | {"m": random.normal(size=turns)}
    if family.role == "resistance":
        return ({name: random.normal(size=dim) for name in ("t", "u", "f")}
                | {"friction": np.array([0.4, 0.7, 0.3, 0.0, 1e-30]), "buffer": np.array([5.0, 0.6, 0.2, -1.0])})
    c = random.uniform(0.3, 1.2)
    return {"gap": random.normal(size=dim), "A1": _attitude(random, dim), "A2": _attitude(random, dim),
            "c": np.array([c, np.cos(c), np.sin(c)]), "f": random.normal(size=family.facts["rows"]),
            "gap_rate": random.normal(size=dim), "c_rate": random.normal(size=2),
            "omega1": random.uniform(0.5, 1.5, turns), "omega2": -random.uniform(0.5, 1.5, turns)}


def _attitude(random: np.random.Generator, dim: int) -> np.ndarray:
    turn = random.normal(size=3)
    turn[: 3 - TURNS[dim]] = 0
    return turned_axes(np, turn[3 - TURNS[dim] :], np.eye(dim))


def spatial(vector: np.ndarray) -> np.ndarray:
    """In three dimensions: a rotation about z where it is one number."""
    zero = 0 * vector[:1]
    return {1: lambda: np.concatenate([zero, zero, vector]), 2: lambda: np.concatenate([vector, zero]),
            3: lambda: vector}[len(vector)]()


def turned_axes(numbers, theta: np.ndarray, A: np.ndarray) -> np.ndarray:
    """Axes after a finite rotation about global axes."""
    q = exponential(numbers, spatial(theta))
    return np.stack([turned(q, spatial(column))[: len(column)] for column in A.T], axis=1)


def swung_axes(theta: np.ndarray, A: np.ndarray) -> np.ndarray:
    """theta~ A."""
    return np.stack([cross(spatial(theta), spatial(column))[: len(column)] for column in A.T], axis=1)


def frame_relations(family: Family) -> list[Relation]:
    """eq 13-18 for two vectors."""
    dim = family.dim

    def moved(s, t, j):
        """Entry j of (a, b) moved by t."""
        motion = t * np.eye(2 * dim, dtype=int)[j]
        return {"a": s["a"] + motion[:dim], "b": s["b"] + motion[dim:]}

    def along(s, t):
        names = ("a", "b")
        return ({n: s[n] + t * s[f"{n}_rate"] + t * t / 2 * s[f"{n}_second"] for n in names}
                | {f"{n}_rate": s[f"{n}_rate"] + t * s[f"{n}_second"] for n in names})

    def turn(k, s):
        out = k("axes", s)
        return np.stack([swung_axes(column, out["A"]) for column in out["T"].T], axis=-1)

    return [
        Relation("axes", "A", "Gram-Schmidt of a and b", 0, lambda k, s, t, j: frame(k, s["a"], s["b"])),
        Relation("axes", "T", "dA is T's turn of A", 1, lambda k, s, t, j: k("axes", s, **moved(s, t, j))["A"], 2 * dim,
                 of=turn),
        Relation("motion", "omega", "dA/dt is omega's turn of A", 1,
                 lambda k, s, t, j: k("axes", s, **along(s, t))["A"],
                 of=lambda k, s: swung_axes(k("motion", s)["omega"], k("axes", s)["A"])),
        Relation("motion", "alpha", "rate of omega", 1, lambda k, s, t, j: k("motion", s, **along(s, t))["omega"]),
        Relation("moment", "g", "T' m", 0, lambda k, s, t, j: k("axes", s)["T"].T.dot(s["m"])),
        Relation("moment", "K", "d(T' m) by a and b", 1, lambda k, s, t, j: k("moment", s, **moved(s, t, j))["g"],
                 2 * dim),
    ]


def joint_relations(family: Family) -> list[Relation]:
    """The equations of a joint along finite motions of its frames."""
    dim, turns = family.dim, TURNS[family.dim]
    n = dim + 2 * turns

    def by_coordinate(k, s, t, j):
        gap, turn_1, turn_2 = np.split(t * np.eye(n, dtype=int)[j], [dim, dim + turns])
        return {"gap": s["gap"] + gap, "A1": turned_axes(k, turn_1, s["A1"]), "A2": turned_axes(k, turn_2, s["A2"])}

    def driven(k, s, t):
        c = s["c"][0] + t * s["c_rate"][0] + t * t / 2 * s["c_rate"][1]
        return {"c": np.array([c, k.cos(c), k.sin(c)])}

    def in_motion(k, s, t):
        return driven(k, s, t) | {"gap": s["gap"] + t * s["gap_rate"], "A1": turned_axes(k, t * s["omega1"], s["A1"]),
                                  "A2": turned_axes(k, t * s["omega2"], s["A2"])}

    def phi(k, s, **changes):
        return k("force", s, **changes)["phi"]

    return [
        Relation("force", "phi", "at 50 digits; see what the joint lets pass", 0, from_kernel("force", "phi")),
        Relation("force", "J", "dphi by gap and turns", 1,
                 lambda k, s, t, j: phi(k, s, **by_coordinate(k, s, t, j)), n),
        Relation("force", "K", "d(J' f) by gap and turns", 1,
                 lambda k, s, t, j: k("force", s, **by_coordinate(k, s, t, j))["J"].T.dot(s["f"]), n),
        Relation("motion", "phi_t", "dphi/dt at rest", 1, lambda k, s, t, j: phi(k, s, **driven(k, s, t))),
        Relation("motion", "Q_d", "d²phi/dt² at zero accelerations", 2,
                 lambda k, s, t, j: phi(k, s, **in_motion(k, s, t))),
    ]


def body_frame_relations(rider) -> list[Relation]:
    """Axes of a body, and moments on them."""
    n, dim = rider.n_velocity, rider.dim

    def moved(k, s, t, j):
        return k("frame", s, b=rider.moved(k, s["b"], t * np.eye(n, dtype=int)[j]))

    def axes(k, s, t, j):
        origin = 0 * s["b"][:dim]
        return np.stack([rider.point(np.concatenate([origin, s["b"][dim:]]), axis) for axis in np.eye(dim, dtype=int)],
                        axis=1)

    def turn(k, s):
        out = k("frame", s)
        return np.stack([swung_axes(column, out["A"]) for column in out["T"].T], axis=-1)

    return [
        Relation("frame", "A", "axes by quaternions or complex numbers", 0, axes),
        Relation("frame", "T", "dA is T's turn of A", 1, lambda k, s, t, j: moved(k, s, t, j)["A"], n, of=turn),
        Relation("frame", "K", "d(T' m) by translation and rotation", 1,
                 lambda k, s, t, j: moved(k, s, t, j)["T"].T.dot(s["m"]), n),
    ]


def frame_invariances(family: Family, k: Numbers, s: State) -> Iterator[tuple[str, float, float]]:
    """Orthonormal, right-handed; a turn of both vectors turns the frame; length does not matter."""
    out = k("axes", s)
    A, T = out["A"], out["T"]
    off = np.abs(A.T @ A - np.eye(len(A))).max()
    yield "A' A = I, right-handed", max(float(off), abs(np.linalg.det(A) - 1)), 8 * EPS
    for theta in np.eye(len(T)):
        both = np.concatenate([swung_axes(theta, s[name][:, None])[:, 0] for name in "ab"])
        yield "turned vectors turn the frame", float(np.abs(T @ both - theta).max()), 64 * EPS
    stretched = T @ np.concatenate([s["a"], 0 * s["b"]])
    yield "their lengths do not", float(np.abs(stretched).max()), 16 * EPS


def joint_invariances(family: Family, k: Numbers, s: State) -> Iterator[tuple[str, float, float]]:
    """Zero where the joint holds, blind to what it lets pass and to nothing else."""
    dim, turns = family.dim, TURNS[family.dim]
    name = family.name.removeprefix("joint_")
    c = float(s["c"][0])
    A1 = s["A1"]
    axis = "xz"[dim - 2]
    along, about = name.endswith("_distance"), name.endswith("_angle")
    turn = np.array([*[0.0] * (turns - 1), c]) if about else np.zeros(turns)
    A2 = A1 @ turned_axes(np, turn, np.eye(dim))
    if name == "universal":  # z of the first is normal to x of the second already
        A2 = A2 @ turned_axes(np, np.array([0.7, 0.0, 0.0]), np.eye(3))
    gap = c * A1[:, "xyz".index(axis)] * along
    allowed = FREE[name]
    if allowed is None:
        gap = c * s["gap"] / np.linalg.norm(s["gap"])
    out = k("force", {**s, "gap": gap, "A2": A2})
    yield "phi is zero where the joint holds", float(np.abs(out["phi"]).max()), 16 * EPS
    J = out["J"]
    spanned = np.linalg.matrix_rank(J, tol=1e-10)
    yield "its equations do not repeat each other", float(len(J) - spanned), 0.0
    both = np.concatenate([np.zeros((dim, turns)), np.eye(turns), np.eye(turns)])
    both[:dim] = np.stack([swung_axes(theta, gap[:, None])[:, 0] for theta in np.eye(turns)], axis=1)
    yield "a turn of both frames changes nothing", float(np.abs(J @ both).max()), 16 * EPS
    if allowed is None:
        return
    for motion in allowed.split():
        direction = np.zeros(dim + 2 * turns)
        if motion.startswith("r"):
            axes_of = A2 if name == "universal" and motion == "rx" else A1
            direction[dim + turns :] = axes_of[:, "xyz".index(motion[1])] if turns == 3 else [1.0]
        else:
            direction[:dim] = A1[:, "xyz".index(motion)]
        yield "what it lets pass makes no difference", float(np.abs(J @ direction).max()), 16 * EPS
    yield "it holds as many motions as it has equations", float(
        dim + turns - len(allowed.split()) - len(J)), 0.0




def resistance_relations(family: Family) -> list[Relation]:
    """What each derivative of R is one of."""
    dim = family.dim

    def moved(name, at=0):
        return from_kernel("force", "R", **{name: lambda s, j: np.eye(len(s[name]), dtype=int)[j + at]})

    return [Relation("force", "R", "at 50 digits; see friction and buffer below", 0, from_kernel("force", "R")),
            *(Relation("force", f"R_{name}", f"dR by {name}", 1, moved(name), dim) for name in "tuf"),
            Relation("force", "R_x", "dR by x", 1, moved("buffer", 2), 1)]


def resistance_invariances(family: Family, k: Numbers, s: State) -> Iterator[tuple[str, float, float]]:
    """Friction against the motion, as large as the normal force makes it; a buffer of its own."""
    i = s["t"] / np.linalg.norm(s["t"])
    length, v = np.linalg.norm(s["t"]), i @ s["u"]
    N = np.linalg.norm(s["f"] - (s["f"] @ i) * i)
    none = np.zeros(4)
    for way in (1.0, -1.0):
        R = k("force", {**s, "friction": np.array([0.4, 0.0, 0.3, way, 1e-30]), "buffer": none})["R"][0]
        yield "friction with a way is the coefficient's", abs(R + way * 0.4 * N * length), 64 * EPS
    fast = k("force", {**s, "friction": np.array([0.4, 0.0, 1e-12 * abs(v), 0.0, 1e-30]), "buffer": none})["R"][0]
    yield "fast friction has the way of the motion", abs(fast + np.sign(v) * 0.4 * N * length), 64 * EPS
    slow = k("force", {**s, "friction": np.array([0.0, 0.7, 0.3, 0.0, 1e-30]), "buffer": none})["R"][0]
    yield "viscous friction goes with the speed", abs(slow + 0.7 * v * length), 64 * EPS
    held = k("force", {**s, "u": 0 * i, "friction": np.array([0.4, 0.7, 0.3, 0.0, 1e-30])})["R"][0]
    yield "at rest there is the buffer's spring alone", abs(held - 5.0 * 0.2), 64 * EPS
