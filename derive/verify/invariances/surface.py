"""Surfaces and contact in cases known without derivation."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...codegen.family import CouplingFamily
from ..numbers import EPS, Numbers, State
from .measures import Invariance, relative


def surface(family: CouplingFamily, k: Numbers, s: State) -> Iterator[Invariance]:
    """Yield that distances and forces are those of cases that need no kernel."""
    y, axis, dim = s["y"], s["axis"], family.dim
    out = k("rounded", s)
    yield "the normal of what is round has the length one", abs(float(out["g_y"] @ out["g_y"]) - 1), 64 * EPS
    across = y - (axis @ y) * axis
    yield "the distance of a cylinder is that from its axis", relative(
        np.atleast_1d(out["g"]) - (np.linalg.norm(across) - s["radius"]), y), 64 * EPS
    level = k("terrain", {**s, "h": np.append(s["h"][:1], 0 * s["h"][1:])})
    yield "the distance of level ground is the height above it", relative(
        np.atleast_1d(level["g"]) - (y[1] - s["h"][0]), y), 64 * EPS
    if dim == 3:
        slope = 0 * s["h"]
        slope[:3] = s["h"][:3]
        normal = np.array([-slope[1], 1.0, -slope[2]]) / np.sqrt(1 + slope[1] ** 2 + slope[2] ** 2)
        yield "the normal of a slope is that of a plane", relative(k("terrain", {**s, "h": slope})["g_y"] - normal,
                                                                  normal), 64 * EPS
    for name in ("push", "push_hertz"):
        now = k(name, s)
        later = k(name, {**s, "depth": s["depth_next"]})
        work = now["mean"] * (s["depth_next"] - s["depth"])
        yield f"{name}: the mean force of a step gives the change of the stored energy", relative(
            np.atleast_1d(later["U"] - now["U"] - work), np.atleast_1d(now["U"])), 64 * EPS
        still = k(name, {**s, "depth_rate": 0 * s["depth_rate"]})
        yield f"{name}: at zero rate the force is elastic", relative(
            np.atleast_1d(still["p"] - still["p_e"]), np.atleast_1d(still["p"])), 64 * EPS
    slides = k("sliding", s)["f"]
    yield "friction is along the surface", relative(np.atleast_1d(slides @ s["n"]), slides), 64 * EPS
    yield "friction that slides has its coefficient's size", abs(
        float(np.linalg.norm(slides)) / float(s["mu"] * s["normal_force"][0]) - 1), 64 * EPS
    slips, fast = (k("slipping", {**s, "w": factor * s["w"]})["f"] for factor in (1.0, 1e9))
    yield "regularised friction is along the surface", relative(np.atleast_1d(slips @ s["n"]), slips), 64 * EPS
    yield "regularised friction opposes the slip", max(0.0, float(slips @ s["w"])), 0.0
    yield "regularised friction of a fast slip has its coefficient's size", abs(
        float(np.linalg.norm(fast)) / float(s["mu"] * s["normal_force"][0]) - 1), 64 * EPS
    sticks = k("sticking", s)
    yield "friction that sticks is a spring along the surface", relative(sticks["f"] + s["k_t"] * sticks["t"],
                                                                        sticks["f"]), 64 * EPS
