"""Straight parts of ropes without mass in space in cases known without derivation."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...codegen.family import CouplingFamily
from ..numbers import EPS, Numbers, State
from ..samples.shapes import rotation
from .measures import Invariance, relative


def taut_part(family: CouplingFamily, k: Numbers, s: State) -> Iterator[Invariance]:
    """Yield the symmetry of second derivatives, a turned scene, and the geodesic of a cylinder."""
    found = k("feet", s)
    yield "F_zz symmetric", relative(found["F_zz"] - found["F_zz"].T, found["F_zz"]), 64 * EPS
    Q = rotation(np.random.default_rng(3), 3)
    turned = s | {name: Q @ s[name] for name in ("d", "one", "other")}
    for name in ("l", "F_z", "F_zz"):
        yield f"turned scene: {name}", relative(k("feet", turned)[name] - found[name], found[name]), 256 * EPS
    gradient = k("moves", s)["F_p"]
    d, one, other = gradient.reshape(3, 3)
    yield "forces: u on the second foot", relative(d - found["u"], d), 16 * EPS
    arms = -np.cross(found["s"][0], d), np.cross(found["s"][1], d)
    yield "moments: of u on both feet", relative(np.array([one, other]) - arms, gradient), 16 * EPS
    yield "no moment on the whole", relative(one + other + np.cross(s["d"], d), gradient), 64 * EPS
    yield from _geodesic(k, s)


def _geodesic(k: Numbers, s: State) -> Iterator[Invariance]:
    """Yield that F is stationary for a taut string from one cylinder to another."""
    fleet, length = np.array([0.23, -0.31]), 2.1
    # the part along the first axis of the ground; each groove is turned about its foot's radius by the fleet angle
    frames, feet, R = [], [], s["R"]
    for f, b, radius, aside in zip(fleet, s["angle"], R, s["aside"], strict=True):
        t, axis = np.array([np.cos(f), np.sin(f), 0]), np.array([-np.sin(f), np.cos(f), 0])
        out = np.cross(t, axis)  # to the right of t, about the axis
        x, y = np.sin(b) * out + np.cos(b) * t, np.sin(b) * t - np.cos(b) * out
        frames.append(np.stack([x, y, axis], axis=1))
        feet.append(radius / np.cos(f) * out + aside * axis)
    d = np.array([length, 0, 0]) + feet[0] - feet[1]
    at = s | {"one": frames[0], "other": frames[1], "d": d, "reach": R / np.cos(fleet)}
    found = k("feet", at)
    yield "geodesic: F is stationary", relative(found["F_z"], R), 64 * EPS
    by_wheel = k("moves", at)["F_p"][3:].reshape(2, 3)
    moments = [m @ A[:, 2] for m, A in zip(by_wheel, frames, strict=True)]
    yield "geodesic: the moments about the axes are R", relative(np.array(moments) - R * [-1, 1], R), 64 * EPS
