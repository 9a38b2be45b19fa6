"""Joints between two frames of any bodies: each a few scalar equations between their points and axes.

A frame has a point p and axes A = [x y z] (in the plane [x y]); gap = p_2 - p_1. The axis of a joint is z of both, in
the plane x. Derivatives are by the gap and by the turns of both frames about global axes: the engine applies the chain
rule from there to the coordinates of the bodies. Haug, Computer Aided Kinematics and Dynamics (1989), ch. 3 and 9.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import sympy as sp

from ..algebra.discrete_gradient import DiscreteGradient
from ..codegen.family import CouplingFamily
from ..codegen.program import DirectionalDerivative, Program
from .frame import TURNS, spun


class TwoFrames:
    """Inputs of a kernel: the gap, the axes of both frames, and the driven quantity."""

    def __init__(self, program: Program, dim: int):
        self.program, self.dim, self.turns = program, dim, TURNS[dim]
        self.gap = program.input("gap", dim, "m", "p_2 - p_1")
        self.A1 = program.input("A1", (dim, dim), "1", "axes of the first frame, by columns")
        self.A2 = program.input("A2", (dim, dim), "1", "axes of the second frame, by columns")
        self.c = program.input("c", 3, "m or rad, 1, 1", "driven quantity (else unused), its cosine and sine")

    def along(self, tag: str, gap: np.ndarray, turn_1: np.ndarray, turn_2: np.ndarray,
              more: dict[str, Any] | None = None) -> DirectionalDerivative:
        """Return the derivative along a motion that moves the gap and turns both frames."""
        on = dict(zip(self.gap, gap, strict=True)) | (more or {})
        for A, turn in ((self.A1, turn_1), (self.A2, turn_2)):
            on |= dict(zip(A.ravel(), spun(np.array(turn), A).ravel(), strict=True))
        return DirectionalDerivative(self.program, tag, on)

    def moves(self) -> list[DirectionalDerivative]:
        """Return the derivatives by the gap, by the turn of the first frame, by that of the second."""
        n = self.dim + 2 * self.turns
        found = []
        for k, unit in enumerate(np.eye(n, dtype=int)):
            gap, turn_1, turn_2 = np.split(unit, [self.dim, self.dim + self.turns])
            found.append(self.along(f"d{k}", gap, turn_1, turn_2))
        return found


def _meet(p: TwoFrames) -> list[sp.Expr]:
    return [*p.gap]


def _offset(axes: str) -> Callable[..., Any]:
    """Return the equations that keep the second point at zero along these axes of the first frame."""
    return lambda p: [p.gap.dot(p.A1[:, "xyz".index(a)]) for a in axes]


def _across(*pairs: str) -> Callable[..., Any]:
    """Return the equations that keep axes of both frames normal: "xz" is x of the first and z of the second."""
    return lambda p: [p.A1[:, "xyz".index(a)].dot(p.A2[:, "xyz".index(b)]) for a, b in map(tuple, pairs)]


def _moved(axis: str) -> Callable[..., Any]:
    """Return the equation that keeps the second point at c along this axis of the first frame."""
    return lambda p: [p.gap.dot(p.A1[:, "xyz".index(axis)]) - p.c[0]]


def _turned(p: TwoFrames) -> list[sp.Expr]:
    """Return the sine of the second frame's angle, from x of the first towards y, less c: one solution within half a
    turn.
    """
    x = p.A2[:, 0]
    return [p.A1[:, 1].dot(x) * p.c[1] - p.A1[:, 0].dot(x) * p.c[2]]


def _distant(p: TwoFrames) -> list[sp.Expr]:
    return [p.program.define("distance", sp.sqrt(p.gap.dot(p.gap))) - p.c[0]]


_AXIS, _LOCK = _across("xz", "yz"), _across("xz", "yz", "yx")
JOINTS = {3: {"spherical": [_meet],
              "revolute": [_meet, _AXIS],
              "revolute_angle": [_meet, _AXIS, _turned],
              "universal": [_meet, _across("zx")],
              "cylindrical": [_offset("xy"), _AXIS],
              "cylindrical_angle": [_offset("xy"), _AXIS, _turned],
              "cylindrical_distance": [_offset("xy"), _AXIS, _moved("z")],
              "prismatic": [_offset("xy"), _LOCK],
              "prismatic_distance": [_offset("xy"), _LOCK, _moved("z")],
              "weld": [_meet, _LOCK],
              "distance": [_distant],
              "aligned": [_AXIS],
              "locked": [_LOCK],
              "turning": [_turned],
              "sliding": [_moved("z")],
              "turning_sliding": [_turned, _moved("z")]},
          2: {"planar_spherical": [_meet],
              "planar_revolute_angle": [_meet, _turned],
              "planar_prismatic": [_offset("y"), _across("yx")],
              "planar_prismatic_distance": [_offset("y"), _across("yx"), _moved("x")],
              "planar_weld": [_meet, _across("yx")],
              "planar_distance": [_distant],
              "planar_locked": [_across("yx")],
              "planar_turning": [_turned],
              "planar_sliding": [_moved("x")]}}
"""The equations of each joint, by dimension; aligned and locked, beside a slide, constrain axes alone; turning and
sliding are motions that a joint leaves free, against which friction acts."""


def rows(dim: int, name: str) -> int:
    """Return the number of equations of a joint."""
    return len(_equations(TwoFrames(Program(name, "", ""), dim), name))


def _equations(frames: TwoFrames, name: str) -> np.ndarray:
    frames.program.stage("equations of the joint")
    every = [e for equations in JOINTS[frames.dim][name] for e in equations(frames)]
    return np.array([frames.program.define(f"phi_{k}", e) for k, e in enumerate(every)])


OF_POINTS = ("spherical", "distance")
"""Joints whose equations depend on the gap alone."""


def is_of_points(name: str) -> bool:
    """Return whether the equations of a joint depend on the gap alone: these have a discrete gradient."""
    return name.removeprefix("planar_") in OF_POINTS


def families() -> list[CouplingFamily]:
    """Return the families of all kinds of joints."""
    return [CouplingFamily(f"joint_{name}", f"{name.replace('_', ' ')} joint between two frames",
                           partial(build, dim, name), ("couplings.joint",), role="joint",
                           missing=() if is_of_points(name) else ("discrete",),
                           facts={"dim": dim, "rows": rows(dim, name)}, dim=dim)
            for dim, of_dim in JOINTS.items() for name in of_dim]


def build(dim: int, name: str) -> list[Program]:
    """Return the kernels of a joint."""
    kernels = [force(dim, name), motion(dim, name)]
    return [*kernels, discrete(dim, name)] if is_of_points(name) else kernels


def force(dim: int, name: str) -> Program:
    """Return the kernel of phi, its Jacobian J, and the derivative of J' f."""
    p = Program(f"joint_{name}_force", "equations, their derivatives, and those of the force J' f", "eq 19, 28")
    frames = TwoFrames(p, dim)
    phi = _equations(frames, name)
    f = p.input("f", len(phi), "N, N m", "multipliers, held fixed")
    by = frames.moves()
    p.stage("derivatives")
    J = np.stack([d.array(phi) for d in by], axis=1)
    p.stage("force")
    g = np.array([p.define(f"g_{k}", f.dot(column)) for k, column in enumerate(J.T)])
    p.stage("derivative of the force")
    p.output("phi", phi, "m, 1", "residual of the equations")
    p.output("J", J, "1, m", "derivatives by the gap and the turns of both frames about global axes")
    p.output("K", np.stack([d.array(g) for d in by], axis=1), "N/m, N, N m", "derivatives of J' f by the same")
    return p


def motion(dim: int, name: str) -> Program:
    """Return the kernel of phi' at rest, and of phi'' without accelerations: -gamma (eq 10)."""
    p = Program(f"joint_{name}_motion", "derivatives of the equations in time", "eq 33")
    frames = TwoFrames(p, dim)
    phi = _equations(frames, name)
    gap_rate = p.input("gap_rate", dim, "m/s", "rate of the gap")
    turn_1, turn_2 = (p.input(f"omega{k}", frames.turns, "rad/s", f"angular velocity of frame {k}, global axes")
                      for k in (1, 2))
    c_rate = p.input("c_rate", 2, "m/s or rad/s, and per s", "rate of c and its rate")
    c, rest = frames.c, np.zeros(dim, dtype=int)
    driving = dict(zip(c, c_rate[0] * np.array([1, -c[2], c[1]]), strict=True)) | {c_rate[0]: c_rate[1]}
    p.stage("derivatives in time")
    still = np.zeros(frames.turns, dtype=int)
    driven = frames.along("dc", rest, still, still, driving)
    moved = frames.along("dt", gap_rate, turn_1, turn_2, driving)
    p.output("phi_t", driven.array(phi), "m/s, 1/s", "rate at rest, of the driven quantity")
    p.output("Q_d", moved.array(moved.array(phi)), "m/s^2, 1/s^2", "second rate at zero accelerations")
    return p


def discrete(dim: int, name: str) -> Program:
    """Return the kernel of the Jacobian of equations of the gap alone: phi_next - phi = J (gap_next - gap)."""
    p = Program(f"joint_{name}_discrete", "Jacobian of the equations over a step that conserves energy",
                "Gonzalez, Comput. Methods Appl. Mech. Eng. 174 (1999) 165-174")
    gap = p.input("gap", dim, "m", "p_2 - p_1 at the start of the step")
    gap_next = p.input("gap_next", dim, "m", "p_2 - p_1 at the end of the step")
    law = TwoFrames(Program("law", "equations at one state", ""), dim)
    law.gap = np.array([law.program.input(f"gap_{axis}", (), "m", "p_2 - p_1") for axis in "xyz"[:dim]])
    law.c = np.zeros(3, dtype=int)  # its change is not that of the gap
    phi = _equations(law, name)
    over_step = DiscreteGradient(p, law.program, {one: (now, then) for one, now, then
                                                  in zip(law.gap, gap, gap_next, strict=True)})
    p.stage("discrete derivatives")
    p.output("J", np.array([over_step.gradient(equation, [*law.gap]) for equation in phi]), "1",
             "derivatives by the gap over a step")
    return p
