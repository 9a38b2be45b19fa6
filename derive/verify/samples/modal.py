"""Samples of modal bodies: a handful of mass points with two modes.

The kernels see integrals over the points; relations sum over the points themselves, along finite motions.
"""

from __future__ import annotations

import numpy as np

from ...codegen.family import BodyFamily
from ..motion import RIDERS
from ..numbers import Numbers, State
from . import body

POINTS, MODES = 4, 2
RATES = ("eta", "eta1", "eta2")


def sample(family: BodyFamily, exact: Numbers, random: np.random.Generator) -> State:
    """Return a body with mass points, modes and their coordinates, and the integrals that the kernels take."""
    return body.sample(family, exact, random) | _points(random, RIDERS[family.rider].dim)


def at_rest(family: BodyFamily, exact: Numbers, first: State) -> State:
    """Return the first sample, not turned and undeformed."""
    rest = body.at_rest(family, exact, first)
    rest |= {name: 0 * rest[name] for name in RATES}
    return rest | integrals(rest)


def _points(random: np.random.Generator, dim: int) -> State:
    """Return mass points, modes and their coordinates; the modes at one more point, which an attachment takes."""
    turns = 1 if dim == 2 else 3
    made = {"points": random.normal(size=(POINTS, dim)), "modes": random.normal(size=(MODES, POINTS, dim)) / 2,
            "masses": random.uniform(0.5, 1.5, POINTS), "g": random.normal(size=dim),
            "place": random.normal(size=dim), "phis": random.normal(size=(MODES, dim)),
            "psis": random.uniform(0.5, 1.5, (MODES, turns)), "m": random.normal(size=turns)}
    # of one sign: what cancels by chance would be held to digits that it has not
    made |= {name: random.uniform(-0.8, -0.2, MODES) for name in RATES}
    made["c"] = random.uniform(0.5, 1.5, dim)
    return made | integrals(made)


def integrals(s: State, **moved: np.ndarray) -> State:
    """Return what the kernels take at these coordinates, some of them moved."""
    s = {**s, **moved}
    rho = s["masses"]
    fields = [s["points"] + np.tensordot(s["eta"], s["modes"], 1),
              *(np.tensordot(s[name], s["modes"], 1) for name in RATES[1:])]
    mode, other = s["modes"]

    def second(a: np.ndarray, b: np.ndarray) -> np.ndarray:
        return np.asarray((rho[:, None] * a).T.dot(b))

    made = {"mass": rho.sum(), "s": rho.dot(mode), "X_kl": second(mode, other),
            "X11": second(fields[1], fields[1]).trace()}
    for k, field in enumerate(fields):
        made |= {f"S{k or ''}": rho.dot(field), f"X{k or ''}": second(fields[0], field),
                 f"Y{k or ''}": second(mode, field)}
    theta = [s[name].dot(s["psis"]) for name in RATES[:2]]
    return made | {"u": s["place"] + s["eta"].dot(s["phis"]), "u1": s["eta1"].dot(s["phis"]), "theta": theta[0],
                   "theta1": theta[1], "phi": s["phis"][0], "psi": s["psis"][0], "phi_l": s["phis"][1],
                   "psi_l": s["psis"][1]}
