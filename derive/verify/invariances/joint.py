"""Which motions a joint lets pass, and which it does not."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...codegen.family import CouplingFamily
from ...couplings.frame import TURNS
from ..motion import swung_axes, turned_axes
from ..numbers import EPS, Numbers, State
from .measures import Invariance

# Motions of the second frame along and about axes of the first that a joint lets pass; c is driven by its own rate.
FREE = {"spherical": "rx ry rz", "revolute": "rz", "revolute_angle": "", "universal": "rx rz", "cylindrical": "z rz",
        "cylindrical_angle": "z", "cylindrical_distance": "rz", "prismatic": "z", "prismatic_distance": "", "weld": "",
        "distance": None, "aligned": "x y z rz", "locked": "x y z",
        "planar_spherical": "rz", "planar_revolute_angle": "", "planar_prismatic": "x", "planar_prismatic_distance": "",
        "planar_weld": "", "planar_distance": None, "planar_locked": "x y", "turning": "x y z rx ry",
        "sliding": "x y rx ry rz", "turning_sliding": "x y rx ry", "planar_turning": "x y", "planar_sliding": "y rz"}


def joint(family: CouplingFamily, k: Numbers, s: State) -> Iterator[Invariance]:
    """Yield that phi is zero on the joint, and changes with all motions but those that the joint leaves free."""
    dim, turns = family.dim, TURNS[family.dim]
    name = family.name.removeprefix("joint_")
    c = float(s["c"][0])
    A1 = s["A1"]
    axis = "xz"[dim - 2]
    along, about = name.endswith(("_distance", "sliding")), name.endswith("_angle") or "turning" in name
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
