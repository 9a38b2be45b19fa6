"""What no spring may do."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...codegen.family import CouplingFamily
from ...couplings.spring import SPRINGS
from ..motion import spatial
from ..numbers import EPS, Numbers, State
from .measures import Invariance, relative


def spring(family: CouplingFamily, k: Numbers, s: State) -> Iterator[Invariance]:
    """Yield what no spring may do: turn the pair of points, push with no extension, be singular without a length."""
    gap, rest = s["gap"], 0 * s["gap_rate"]
    if SPRINGS[family.name].has_length:
        f = k("force", s)["f"]
        yield "no moment on the pair of points", _moment(gap, f), 8 * EPS
        f = k("discrete_force", s)["f"]
        yield "step: no moment about the mean points", _moment(gap + s["gap_next"], f), 8 * EPS
        unit = gap / np.linalg.norm(gap)
        f = k("force", s, gap=s["rest_length"] * unit, gap_rate=rest)["f"]
        yield "no force at the rest length", relative(f, s["stiffness"] * s["rest_length"]), 4 * EPS
    else:
        f = k("force", s, gap=0 * gap)["f"]
        yield "the damper's force where the points meet", relative(f - s["damping"] * s["gap_rate"], f), 2 * EPS
    K = k("tangent", s, gap_rate=rest)["K"]
    yield "stiffness symmetric", relative(K - K.T, K), 4 * EPS


def _moment(arm: np.ndarray, force: np.ndarray) -> float:
    """Return the moment of a force over its size times that of its arm."""
    moment = np.cross(spatial(arm), spatial(force))
    return float(np.linalg.norm(moment) / np.linalg.norm(arm) / np.linalg.norm(force))
