"""Samples of a rope on a sheave or a drum."""

from __future__ import annotations

import numpy as np

from ...codegen.family import CouplingFamily
from ..numbers import Numbers, State


def sample(family: CouplingFamily, exact: Numbers, random: np.random.Generator) -> State:
    """Return a tangent point not far from the groove, a zone of the wrap after a turn, and a wound rope: all stretched
    and moving.
    """
    vectors = ("slope", "slope_rate", "g", "c", "c_rate", "c_acc", "phi_rate", "phi_acc", "s_rate", "s_acc", "f")
    found: State = {name: random.normal(size=2) for name in vectors}
    # off the axes, rates both along and across x, and none that cancel: entries that nearly vanish have few digits
    turn, R = np.pi / 4 * random.choice([1, 3, 5, 7]) + random.uniform(-0.4, 0.4), random.uniform(0.6, 0.9)
    polar = np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
    found |= {"x": (R + 0.1 * random.normal()) * polar[0],
              "x_rate": random.uniform(0.5, 1.5, 2) @ polar, "x_acc": random.uniform(0.5, 1.5, 2) * [1, -1] @ polar}
    sense = float(random.choice([-1, 1]))
    phi_a, angle = 2 * np.pi + turn, sense * random.uniform(1.0, 2.5)
    angles, lengths = phi_a + angle * np.array([0.0, 0.4, 1.0]), abs(angle) * R * random.uniform(0.8, 0.9)
    found |= {"angles3": angles, "angles2": angles[[0, 2]], "lengths2": lengths * np.array([0.41, 0.58]),
              "lengths1": np.array([lengths]), "span_slope": random.uniform(1.1, 1.3) * polar[1],
              "angle_rate": np.float64(random.uniform(0.02, 0.1)), "spin": np.float64(random.uniform(0.2, 0.4)),
              "flow": np.float64(random.choice([-1, 1]) * random.uniform(0.05, 0.1)), "mu": np.float64(0.3),
              "v0": np.float64(0.2), "direction": np.float64(0.7)}
    found |= {"R": np.float64(R), "phi": np.array([phi_a, phi_a + angle]), "sense": np.float64(sense),
              "l": np.float64(abs(angle) * R * random.uniform(0.8, 0.9)), "A": random.uniform(2, 5, 2),
              "rho": np.float64(1.3), "tau": np.float64(0.37)}
    found["span_slope_rate"] = random.normal(size=2)
    found |= {"V": random.normal(size=3), "u_change": np.float64(random.uniform(0.1, 0.3)),
              "turn_change": np.float64(random.uniform(0.1, 0.3))}
    found |= {"P": random.normal(size=2), "c_change": 0.1 * random.normal(size=2),
              "s_change": found["l"] / 20 * random.normal(size=2)} | {name: np.float64(random.uniform(*limits))
              for name, limits in {"h": (0.1, 0.2), "xi": (0.2, 0.8), "angle_at": (0.3, 1.2), "turn": (0.5, 1),
                                   "angle_change": (0.1, 0.3), "alpha": (0.5, 1), "alpha_change": (0.1, 0.2)}.items()}
    # winds is 0 or 1 in a run; between these both stretches count
    found |= {name: np.float64(random.uniform(*limits)) for name, limits in {
        "tension": (2, 4), "winds": (0.3, 0.7), "wound": (1.1, 1.3), "span_stretch": (1.4, 1.6), "u": (2, 4),
        "u_rate": (0.5, 1), "spin_acc": (0.5, 1), "l_rate": (0.5, 1), "held": (1, 2), "angle_acc": (0.5, 1)}.items()}
    return found | {f"{name}_rate": random.uniform(0.5, 1, np.size(found[name]))
                    for name in ("angles3", "angles2", "lengths2", "lengths1")}
