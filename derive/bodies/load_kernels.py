"""The kernels of loads on a body: a force at a point, one that turns with the body, a moment.

The generalised force g has the force in global axes and the moment about body axes; K is its derivative by translation
and rotation.
"""

from __future__ import annotations

import numpy as np

from ..codegen.program import Program
from .body import Body
from .modal import vector_product


def build(body: Body) -> list[Program]:
    """Return the load kernels of a body."""
    return [force(body), follower_force(body), moment(body)]


class _Load:
    """Input b; stage: the axes."""

    def __init__(self, body: Body, kernel: str, doc: str):
        self.program = Program(f"{body.NAME}_{kernel}", doc, body.SOURCE)
        self.body, self.b = body, body.configuration(self.program)
        self.turns = body.N_VELOCITY - body.DIM

    def axes(self) -> np.ndarray:
        """Define A in a stage of its own and return it."""
        self.program.stage("axes")
        self.A = self.body.axes(self.program, self.b)
        return np.asarray(self.A)

    def outputs(self, force: np.ndarray, moment: np.ndarray) -> Program:
        """Declare the outputs g and K of a force in global axes and a moment about body axes."""
        p = self.program
        p.stage("generalised force and its derivatives")
        g = np.array([p.define(f"g{k}", x) for k, x in enumerate([*force, *moment])])
        p.output("g", g, "N, N m", "generalised force")
        p.output("K", np.stack([d.array(g) for d in self.body.tangents(p, self.b, self.A)], axis=1), "N, N m",
                 "derivatives of g by translation and rotation")
        return p


def force(body: Body) -> Program:
    """Return the kernel of a force that keeps its direction: f, and u x A'f about body axes."""
    load = _Load(body, "force", "generalised force of a force at a point")
    p = load.program
    u, f = body.attachment(p), p.input("f", body.DIM, "N", "force in global axes")
    A = load.axes()
    return load.outputs(f, vector_product(u, p.vector("local", A.T.dot(f))))


def follower_force(body: Body) -> Program:
    """Return the kernel of a force that turns with the body: A c, and u x c about body axes."""
    load = _Load(body, "follower_force", "generalised force of a force at a point that turns with the body")
    p = load.program
    u, c = body.attachment(p), p.input("c", body.DIM, "N", "force in body axes")
    return load.outputs(load.axes().dot(c), vector_product(u, c))


def moment(body: Body) -> Program:
    """Return the kernel of a moment that keeps its direction: A'm about body axes."""
    load = _Load(body, "moment", "generalised force of a moment")
    m = load.program.input("m", load.turns, "N m", "moment in global axes")
    A = load.axes()
    return load.outputs(np.zeros(body.DIM, dtype=int), A.T.dot(m) if load.turns == body.DIM else m)
