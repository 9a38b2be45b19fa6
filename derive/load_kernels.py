"""The kernels of loads at a point of an element's centreline: what they hold on to, and how they turn with it."""

from __future__ import annotations

import numpy as np
from funicular.derive.axis import Axis
from funicular.derive.frames import cross, tangent_frame
from funicular.derive.spec import Element
from funicular.derive.stages import Program, jacobian


def build(element: Element) -> list[Program]:
    """The load kernels of an element."""
    return [on_axis(element), follower_force(element), moment(element)]


def on_axis(element: Element) -> Program:
    """eq 2 on the centreline."""
    p = Program(f"{element.name}_on_axis", "shape functions and slopes of a point of the centreline", "eq 2")
    axis = Axis(p, element)
    p.stage("shape functions")
    p.output("N", axis.shape(), "1, m", "shape functions at (x, 0, 0)")
    p.output("N_x", axis.shape("x"), "1/m, 1", "their derivatives by x")
    return p


def follower_force(element: Element) -> Program:
    """f = N' A_t c."""
    p = Program(f"{element.name}_follower_force", "generalised force of a force that turns with the tangent frame",
                "N' A_t c, A_t of eq 18")
    axis = Axis(p, element)
    e = axis.coordinates()
    p.stage("tangent and director")
    N = axis.shape()
    slopes = ["x", *([element.director.partition("_")[2]] if element.dim == 3 and element.director else [])]
    shapes = [axis.shape(c) for c in slopes]
    tangent, *director = vectors = [axis.vector(f"r{c}", n, e) for c, n in zip(slopes, shapes, strict=True)]
    p.stage("tangent frame (eq 13-18) and force")
    A_t = tangent_frame(p, tangent, *(director or [None]))
    c = p.input("c", A_t.shape[1], "N", f"components along {' '.join('ijk'[: A_t.shape[1]])} of the tangent frame")
    force = p.vector("F", A_t.dot(c))
    _generalised(p, element, [N], [force], shapes, vectors)
    return p


def turning_slopes(element: Element) -> list[str]:
    """The slopes, by x, y, z, that say how a section turns: those across, and the tangent where they are too few."""
    across = [c for c in "yz" if f"r_{c}" in element.nodal_vectors]
    return across if len(across) >= element.dim - 1 else ["x", *across]


def moment(element: Element) -> Program:
    """f from M . omega = f . v, omega the rotation rate of the section.

    It is the one that fits the rates of the section's slopes best: sum |a' - omega x a|^2 is least, hence
    T omega = sum a x a' with T = sum (a.a I - a a'). A tangent alone in space turns across itself only: the moment
    along it does no work.
    """
    p = Program(f"{element.name}_moment", "generalised force of a moment in global axes",
                "work on the rotation of the section")
    axis = Axis(p, element)
    e = axis.coordinates()
    M = p.input("M", {2: 1, 3: 3}[element.dim], "N m", {2: "moment about z", 3: "moment"}[element.dim])
    p.stage("slopes that turn")
    slopes = turning_slopes(element)
    shapes = [axis.shape(c) for c in slopes]
    vectors = [axis.vector(f"r{c}", n, e) for c, n in zip(slopes, shapes, strict=True)]
    p.stage("moment over T")
    if len(vectors) == 1:
        over = p.vector("mu", M * p.define("inv_T", 1 / p.define("T", vectors[0].dot(vectors[0]))))
    else:
        over = _solve(p, M, vectors)
    forces = [p.vector(f"F{c}", cross(over, a)) for c, a in zip(slopes, vectors, strict=True)]
    _generalised(p, element, shapes, forces, shapes, vectors)
    return p


def _solve(p: Program, M: np.ndarray, vectors: list[np.ndarray]) -> np.ndarray:
    """Stage: mu of T mu = M by Cramer's rule, T = sum (a.a I - a a')."""
    square = sum(a.dot(a) for a in vectors)
    T = np.empty((3, 3), dtype=object)
    for i in range(3):
        for j in range(i, 3):
            entry = (square if i == j else 0) - sum(a[i] * a[j] for a in vectors)
            T[i, j] = T[j, i] = p.define(f"T{i + 1}{j + 1}", entry)
    cofactors = np.array([p.vector(f"T_co{i + 1}", cross(T[i - 2], T[i - 1])) for i in range(3)])
    inverse = p.define("inv_det", 1 / p.define("det", T[0].dot(cofactors[0])))
    return p.vector("mu", inverse * cofactors.dot(M))


def _generalised(p: Program, element: Element, holds, forces, shapes, vectors) -> None:
    """Outputs f = holds' forces and K, where the forces are functions of the vectors = shapes e."""
    p.stage("derivatives of the force by the vectors that it turns with")
    force = np.concatenate(forces)
    by_vectors = jacobian(p, force, np.concatenate(vectors))
    p.stage("derivatives of the force by e")
    holds, shapes = (np.kron(np.array(n), np.eye(element.dim, dtype=int)) for n in (holds, shapes))
    by_e = np.array([[p.define(f"d{component}_de{m}", entry) for m, entry in enumerate(row)]
                     for component, row in zip(force, by_vectors.dot(shapes), strict=True)])
    p.output("f", holds.T.dot(force).reshape(element.n_vectors, element.dim), "N, N m", "generalised force")
    p.output("K", holds.T.dot(by_e), "N/m, N, N m", "derivatives of f by e, not symmetric")
