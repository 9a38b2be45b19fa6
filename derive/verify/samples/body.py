"""Samples of a body's kernels, and of all kernels that take a rider."""

from __future__ import annotations

import numpy as np

from ...codegen.family import BodyFamily
from ..motion import RIDERS
from ..numbers import Numbers, State
from .shapes import LENGTH
from .step import following


def sample(family: BodyFamily, exact: Numbers, random: np.random.Generator) -> State:
    """Return a body in any attitude with velocities and accelerations, its mass and inertia, a force on a point, a
    step, a change of the configuration, and a force c in body axes.
    """
    rider = RIDERS[family.rider]
    dim = rider.dim
    state = rider_state(family, random.normal(size=dim), random)
    state |= following(family, state, random.spawn(1)[0])
    of_step = random.spawn(1)[0]
    return state | {"f": random.normal(size=dim), "step": of_step.normal(size=rider.n_velocity),
                    "change": of_step.normal(size=len(state["b"])), "c": of_step.normal(size=dim)}


def at_rest(family: BodyFamily, exact: Numbers, first: State) -> State:
    """Return the first sample, not turned, its point on the x axis, with a step of zero."""
    return first | unturned(family) | {"step": 0 * first["step"]}


def rider_state(family: BodyFamily, near: np.ndarray, random: np.random.Generator) -> State:
    """Return the configuration and velocities of a rider with its point not far from `near`, its mass and inertia,
    accelerations a, and a moment m.
    """
    rider = RIDERS[family.rider]
    state: State = rider.sample(random, near)
    state |= {"mass": np.float64(1.7), "J": _inertia(random), "a": random.normal(size=len(state["w"]))}
    return state | {"m": random.normal(size=len(state["w"]) - rider.dim)}


def unturned(family: BodyFamily) -> State:
    """Return the rider not turned, its point half-way along the straight reference, and a director across."""
    rider = RIDERS[family.rider]
    return rider.at_rest(LENGTH / 2 * np.eye(rider.dim)[0]) | {"director": np.eye(rider.dim)[1]}


def _inertia(random: np.random.Generator) -> np.ndarray:
    root = random.normal(size=(3, 3))
    return root @ root.T + np.eye(3)
