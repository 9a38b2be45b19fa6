"""How the configuration of a body moves: by a step of finite rotation, and by velocities.

A step psi is a translation and a turn in body axes: a rotation vector for `move`, a Cayley vector (twice the tangent of
half the angle, about the axis) for `cayley_move`. The tangents T say how the body turns about its axes where psi
changes: dtheta = T dpsi. A body gives the product of its attitudes, the attitude of a turn, and its WINDING, the angle
of the body over that of the attitude: 2 for quaternions, 1 for complex numbers.
"""

from __future__ import annotations

import numpy as np
import sympy as sp

from ..codegen.program import Program
from .body import Body


def build(body: Body) -> list[Program]:
    """Return the kernels of a body's moves."""
    return [make(body) for make in (move, move_tangent, cayley_move, cayley_tangent, cayley_error, halfway, rate,
                                    increment)]


def _step(p: Program, body: Body, turn: str) -> np.ndarray:
    return p.input("step", body.N_VELOCITY, "m, rad", f"translation, and turn in body axes by its {turn}")


def _normalised(p: Program, attitude: np.ndarray) -> np.ndarray:
    """Define an attitude of unit size in a stage of its own and return it."""
    p.stage("attitude of unit size")
    parts = [p.define(f"part{k}", x) for k, x in enumerate(attitude)]
    inverse = p.define("inv_size", 1 / p.define("size", sp.sqrt(sum(x * x for x in parts))))
    return np.array([inverse * x for x in parts])


def _moved(p: Program, body: Body, b: np.ndarray, step: np.ndarray, turn: np.ndarray) -> Program:
    attitude = _normalised(p, body.product(b[body.DIM :], turn))
    p.output("b_next", np.concatenate([b[: body.DIM] + step[: body.DIM], attitude]), "m, 1", "b moved by the step")
    return p


def move(body: Body) -> Program:
    """Return the kernel that moves b by a rotation vector."""
    p = Program(f"{body.NAME}_move", "configuration moved by a translation and a rotation vector", "exponential map")
    b, step = body.configuration(p), _step(p, body, "rotation vector")
    return _moved(p, body, b, step, body.exponential(p, step[body.DIM :]))


def move_tangent(body: Body) -> Program:
    """Return the kernel of T of `move`."""
    p = Program(f"{body.NAME}_move_tangent", "turn in body axes by a change of the rotation vector",
                "derivative of the exponential map")
    step = _step(p, body, "rotation vector")
    p.output("T", body.exponential_tangent(p, step[body.DIM :]), "1", "dtheta = T dpsi, for the turn")
    return p


def cayley_move(body: Body) -> Program:
    """Return the kernel that moves b by a Cayley vector."""
    p = Program(f"{body.NAME}_cayley_move", "configuration moved by a translation and a Cayley vector", "Cayley's map")
    b, step = body.configuration(p), _step(p, body, "Cayley vector")
    p.stage("half of the Cayley vector")
    return _moved(p, body, b, step, body.cayley(p.vector("half", step[body.DIM :] / 2)))


def cayley_tangent(body: Body) -> Program:
    """Return the kernel of T of `cayley_move`: conj(r) dr over |r|^2 of the attitude r that the turn is."""
    p = Program(f"{body.NAME}_cayley_tangent", "turn in body axes by a change of the Cayley vector",
                "derivative of Cayley's map")
    theta = _step(p, body, "Cayley vector")[body.DIM :]
    p.stage("half of the Cayley vector")
    half = p.vector("half", theta / 2)
    turn = body.cayley(half)
    conjugate = _conjugate(turn)
    p.stage("scale")
    T = np.zeros((len(theta), len(theta)), dtype=object)
    for k, symbol in enumerate(half):
        by_theta = np.array([sp.diff(x, symbol) / 2 for x in turn])
        spin = body.WINDING * body.product(conjugate, by_theta)[1:]
        for i, value in enumerate(spin):
            above, below = sp.fraction(sp.cancel(value / turn.dot(turn)))
            T[i, k] = above * p.define_once("scale", 1 / below) if below.free_symbols else above / below
    p.output("T", T, "1", "dtheta = T dpsi, for the turn")
    return p


def cayley_error(body: Body) -> Program:
    """Return the kernel of the leading error of a step by Cayley's vector: its turn less that of the motion, over h^3.

    The attitude q solves q' = q (0, omega)/WINDING with a rate of turn omega that is linear in time, of which the step
    takes the value half-way. The series of q about the middle of the step and that of Cayley's map differ from h^3 on.
    """
    p = Program(f"{body.NAME}_cayley_error", "error of the turn by a Cayley vector over the cube of the step",
                "Taylor series of the attitude")
    w = body.velocity(p)[body.DIM :]
    a = p.input("a", body.N_VELOCITY, "m/s^2, rad/s^2", "accelerations R'', omega'")[body.DIM :]
    h = sp.Symbol("h")
    omega, change = np.array([0, *w]) / body.WINDING, np.array([0, *a]) / body.WINDING
    q = [np.array([1, *(0 * w)]), omega]
    q.append(body.product(q[1], omega) + change)
    q.append(body.product(q[2], omega) + 2 * body.product(q[1], change))
    begin, end = (sum(each * t**k / sp.factorial(k) for k, each in enumerate(q)) for t in (-h / 2, h / 2))
    turn = body.product(_conjugate(begin), end)
    off = body.product(_conjugate(turn), body.cayley(h * w / 2))[1:]
    third = [sp.diff(x, h, 3, simplify=False).subs(h, 0).expand() / 6 for x in off]
    p.output("error", body.WINDING * np.array(third), "rad/s^3", "error over h^3, about body axes")
    return p


def _conjugate(attitude: np.ndarray) -> np.ndarray:
    return np.array([attitude[0], *-attitude[1:]])


def halfway(body: Body) -> Program:
    """Return the kernel of the configuration in the middle of a step."""
    p = Program(f"{body.NAME}_halfway", "configuration half-way, turned by half of the turn", body.SOURCE)
    b = body.configuration(p)
    b_next = p.input("b_next", body.N_CONFIGURATION, "m, 1", "b at the end of the step")
    attitude = _normalised(p, (b + b_next)[body.DIM :])
    p.output("b_half", np.concatenate([(b + b_next)[: body.DIM] / 2, attitude]), "m, 1", "b half-way")
    return p


def _turning(body: Body, b: np.ndarray) -> np.ndarray:
    """Return the derivatives of the attitude by small turns about body axes times WINDING, a column for each."""
    half = sp.symbols(f"half:{body.N_VELOCITY - body.DIM}")
    moved = body.product(b[body.DIM :], body.cayley(np.array(half)))
    still = dict.fromkeys(half, 0)
    return np.array([[body.WINDING * sp.diff(x, symbol).subs(still) / 2 for symbol in half] for x in moved])


def rate(body: Body) -> Program:
    """Return the kernel of b'."""
    p = Program(f"{body.NAME}_rate", "rate of the configuration", body.SOURCE)
    b, w = body.configuration(p), body.velocity(p)
    p.stage("rate of turning of the attitude")
    attitude = _turning(body, b).dot(p.vector("turning", w[body.DIM :] / body.WINDING))
    p.output("b_rate", np.concatenate([w[: body.DIM], attitude]), "m/s, 1/s", "rate of b")
    return p


def increment(body: Body) -> Program:
    """Return the kernel that undoes `rate`: the columns of small turns are normal to each other and equally long."""
    p = Program(f"{body.NAME}_increment", "translation and small turn of a change of b", body.SOURCE)
    b = body.configuration(p)
    change = p.input("change", body.N_CONFIGURATION, "m, 1", "small change of b")
    p.stage("turn of the attitude")
    turn = p.vector("turn", _turning(body, b).T.dot(change[body.DIM :]))
    p.output("step", np.concatenate([change[: body.DIM], body.WINDING * turn]), "m, rad",
             "translation and turn in body axes")
    return p
