"""Relations of the kernels of joints. Axes are turned by quaternions, which the derivation does not use."""

from __future__ import annotations

import numpy as np

from ...codegen.family import CouplingFamily
from ...couplings.frame import TURNS
from ...couplings.joint import is_of_points
from ..methods import Relation
from ..motion import turned_axes
from .paths import from_kernel


def joint(family: CouplingFamily) -> list[Relation]:
    """Return the relations of the equations of a joint along finite motions of its frames."""
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

    def over_step(k, s):
        return phi(k, s) + k("discrete", s)["J"].dot(s["gap_next"] - s["gap"])

    return [
        *([Relation("discrete", "J", "phi + J (gap_next - gap) is phi at the end", 0,
                    lambda k, s, t, j: phi(k, s, gap=s["gap_next"]), of=over_step),
           Relation("discrete", "J", "dphi by the gap, over no step", 1,
                    lambda k, s, t, j: phi(k, s, gap=s["gap"] + t * np.eye(dim, dtype=int)[j]), dim,
                    of=lambda k, s: k("discrete", s, gap_next=s["gap"])["J"])]
          if is_of_points(family.name.removeprefix("joint_")) else []),
        Relation("force", "phi", "at 50 digits; see what the joint lets pass", 0, from_kernel("force", "phi")),
        Relation("force", "J", "dphi by gap and turns", 1,
                 lambda k, s, t, j: phi(k, s, **by_coordinate(k, s, t, j)), n),
        Relation("force", "K", "d(J' f) by gap and turns", 1,
                 lambda k, s, t, j: k("force", s, **by_coordinate(k, s, t, j))["J"].T.dot(s["f"]), n),
        Relation("motion", "phi_t", "dphi/dt at rest", 1, lambda k, s, t, j: phi(k, s, **driven(k, s, t))),
        Relation("motion", "Q_d", "d²phi/dt² at zero accelerations", 2,
                 lambda k, s, t, j: phi(k, s, **in_motion(k, s, t))),
    ]
