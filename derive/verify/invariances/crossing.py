"""Lines in contact in cases known without derivation."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...codegen.family import CouplingFamily
from ..numbers import EPS, Numbers, State
from .measures import Invariance, relative, spins


def crossing(family: CouplingFamily, k: Numbers, s: State) -> Iterator[Invariance]:
    """Yield that the force turns with the scene, is along the common normal, and keeps the balance of power."""
    out, told = k("force", s), k("contact", s)
    F, n = out["F"], told["n"]
    for spin in spins(family.dim):
        slopes = (s["t"] @ spin.T).ravel()
        turned = out["F_d"] @ (spin @ s["d"]) + out["F_u"] @ (spin @ s["u"]) + out["F_t"] @ slopes
        points = out["s_d"] @ (spin @ s["d"]) + out["s_t"] @ slopes
        yield "the force turns with the scene", relative(turned - spin @ F, F), 512 * EPS
        yield "closest points stay where the scene turns", float(np.max(np.abs(points))), 512 * EPS
    yield "the force along the normal is that of the law", relative(F @ n - told["N"], F), 64 * EPS
    without = k("contact", {**s, "c": np.where(np.arange(8) == 6, 0.0, s["c"])})["f"]
    yield "without friction the force is along the normal", relative(without - told["N"][0] * n, F), 64 * EPS
    yield "the normal is square to the lines", float(np.max(np.abs(s["t"] @ n))), 64 * EPS
    yield "the points are closest: no step is left", float(np.max(np.abs(k("closest", s)["step"]))), 64 * EPS
    depth, rate = told["p"]
    yield "distance and penetration make the radii", abs(float(np.linalg.norm(s["d"])) + depth - s["c"][0]), 64 * EPS
    elastic = k("contact", {**s, "u": 0 * s["u"]})["N"][0]
    power = relative(-F @ s["u"] - elastic * rate - told["P"], told["P"])
    yield "the force's power is stored or dissipated", power, 256 * EPS
    stretch, sliding = k("stretch", s), k("sliding", s)["F"]
    now = stretch["now"]
    yield "the stretch is square to the normal", float(abs(now @ n)), 64 * EPS
    yield "what was stretched turns with the lines", relative(stretch["old"] @ stretch["old"] - s["x"] @ s["x"],
                                                              s["x"] @ s["x"]), 64 * EPS
    yield "what slides is as large as friction", relative(sliding @ sliding - (s["mu"] * told["N"]) ** 2,
                                                          sliding @ sliding), 256 * EPS
    sliding = k("sliding", {**s, "slid": 0.0, "turns": 0.0})["F"]
    yield "what slides is against the stretch", relative(sliding @ now + np.sqrt((sliding @ sliding) * (now @ now)),
                                                         sliding @ now), 64 * EPS
    step = k("step", s)
    before, after = (k("contact", {**s, "d": (s["c"][0] - s[key]) * n})["U"][0] for key in ("p", "p_next"))
    work = step["F"] @ s["displacement"] + np.sum(step["M"] * s["turn"])
    scale = np.abs([before, after, *step["lost"], *step["F"] * s["displacement"], *np.ravel(step["M"] * s["turn"])])
    left = relative(work - before + after + step["lost"], scale)
    yield "work over a step is what is stored less, and lost", left, 512 * EPS
