"""Samples of tangent points of ropes on sheaves in space."""

from __future__ import annotations

import numpy as np

from ...codegen.family import CouplingFamily
from ...couplings.turning_step import PRODUCTS
from ...elements import ELEMENTS
from ..numbers import Numbers, State
from .element import element_state
from .shapes import rotation


def sample(family: CouplingFamily, exact: Numbers, random: np.random.Generator) -> State:
    """Return a tangent point not far from the groove, with a fleet angle, and a point of a bent element."""
    found: State = {name: random.normal(size=3) for name in (
        "x_rate", "chord_rate", "f", "axis_rate", "omega", "c_rate", "c_acc", "x_acc", "gravity")}
    found |= {name: random.normal(size=2) for name in ("omega_acc", "phi_rate", "phi_acc", "s_acc")}
    angle = random.uniform(0.7, 1.5)
    found |= {"phi": random.uniform(-3, 3) + np.array([0.0, angle]), "spin": np.float64(random.normal()),
              "growth": np.float64(random.normal()), "inertia": random.uniform(0.5, 1.5, 2),
              "laid": np.float64(random.uniform(0.5, 1.5))}
    Q = rotation(random, 3)  # columns: from the centre, along the groove, along the axis
    R, length = random.uniform(0.6, 0.9), random.uniform(0.7, 1.1)
    direction = Q @ np.array([random.uniform(0.1, 0.2), 1.0, random.uniform(0.2, 0.4)])
    found |= {"axis": Q[:, 2], "x": Q @ [R + 0.1 * random.normal(), *random.uniform(0.1, 0.2, 2)], "R": np.float64(R),
              "b": np.float64(length * random.uniform(0.85, 0.95)), "weight": random.uniform(-0.2, 0.2, 3),
              "EA": np.float64(random.uniform(7, 12)), "limit": np.float64(random.uniform(0.2, 0.4)),
              "b_rate": np.float64(random.uniform(0.2, 0.5)), "chord": length * direction / np.linalg.norm(direction)}
    found |= _step(random)
    vectors = {"x": found["x"], "a": found["axis"], "d": found["chord"], "w": found["weight"]}
    found["products"] = np.array([*(vectors[name[0]] @ vectors[name[2]] for name in PRODUCTS), found["b"]])
    element = element_state(ELEMENTS["cable12"], random)
    return found | {"e": element["e"], "l": element["l"], "s": element["l"] * random.uniform(0.2, 0.8),
                    "rho": np.float64(1.3), "w": np.float64(random.normal()),
                    "g": np.float64(random.normal()), "w_rate": np.float64(random.normal()),
                    "w_acc": np.float64(random.normal()), "s_rate": random.normal(size=2),
                    "by_L": np.array([random.uniform(-0.9, -0.5), random.uniform(0.3, 0.6)]),
                    "slope": Q @ np.array([random.uniform(0.1, 0.2), 1.1, random.uniform(0.2, 0.4)]),
                    "slope_rate": random.normal(size=3), "by_chord": np.float64(random.uniform(0.2, 0.8))}


def _step(random: np.random.Generator) -> State:
    """Return a step of a groove that turns."""
    axes = rotation(random, 3)[:, :2]
    found: State = {"axes": axes, "theta": 0.3 * random.normal(size=3), "P": random.normal(size=3),
                    "c_change": 0.1 * random.normal(size=3), "s_change": 0.03 * random.normal(size=2),
                    "xis": np.sort(random.uniform(0.1, 0.9, 2)), "weight_square": np.float64(random.uniform(0.1, 0.2)),
                    "V": random.normal(size=6), "c": random.normal(size=3)}
    return found | {name: np.float64(random.uniform(*limits)) for name, limits in {
        "h": (0.1, 0.2), "xi": (0.2, 0.8), "angle_at": (0.3, 1.2), "turn": (0.5, 1), "angle_change": (0.1, 0.3),
        "alpha": (0.5, 1), "alpha_change": (0.1, 0.2), "u": (2, 4), "u_change": (0.1, 0.3),
        "own_change": (0.1, 0.3)}.items()}
