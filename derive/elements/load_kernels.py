"""The kernels of loads at a point of an element's centreline: shape functions, follower forces, moments."""

from __future__ import annotations

import numpy as np

from ..algebra.axis import Axis
from ..algebra.tangent_frame import cross, tangent_frame, turning
from ..codegen.program import Program, jacobian
from ..spec import Element


def build(element: Element) -> list[Program]:
    """Return the load kernels of an element."""
    return [on_axis(element), slopes(element), follower_force(element), moment(element)]


def on_axis(element: Element) -> Program:
    """Return the kernel of the shape functions and their slopes on the centreline."""
    p = Program(f"{element.name}_on_axis", "shape functions and slopes of a point of the centreline", "eq 2")
    axis = Axis(p, element)
    p.stage("shape functions")
    p.output("N", axis.shape(), "1, m", "shape functions at (x, 0, 0)")
    p.output("N_x", axis.shape("x"), "1/m, 1", "their derivatives by x")
    return p


def slopes(element: Element) -> Program:
    """Return the kernel of the vectors of a frame along the centreline: r_x, r_y, r_z and their derivatives by x."""
    p = Program(f"{element.name}_slopes", "slopes of a point of the centreline, and their derivatives by x", "eq 13-16")
    axis = Axis(p, element)
    p.stage("derivatives of the shape functions")
    p.output("S", [[axis.shape(letter + order) for order in ("", "x", "xx")] for letter in "xyz"], "1/m, 1",
             "shape functions by x, y, z (zeros where there is no such slope), and their first two derivatives by x")
    return p


def follower_force(element: Element) -> Program:
    """Return the kernel of f = N' A_t c, of a force that turns with the tangent frame, and of its derivative."""
    p = Program(f"{element.name}_follower_force", "generalised force of a force that turns with the tangent frame",
                "N' A_t c, A_t of eq 18")
    axis = Axis(p, element)
    e = axis.coordinates()
    p.stage("tangent and director")
    N = axis.shape()
    slopes = ["x", *([element.director.partition("_")[2]] if element.dim == 3 and element.director else [])]
    shapes = [axis.shape(c) for c in slopes]
    tangent, *director = [axis.vector(f"r{c}", n, e) for c, n in zip(slopes, shapes, strict=True)]
    p.stage("tangent frame (eq 13-18) and force")
    A_t = tangent_frame(p, tangent, director[0] if director else None)
    c = p.input("c", A_t.shape[1], "N", f"components along {' '.join('ijk'[: A_t.shape[1]])} of the tangent frame")
    force = p.vector("F", A_t.dot(c))
    p.stage("rotation of the frame by tangent and director, derivatives of the force")
    rotation = turning(p, A_t, tangent, *director)
    _generalised(p, element, [N], [force], shapes, np.stack([cross(omega, force) for omega in rotation], axis=1))
    return p


def turning_slopes(element: Element) -> list[str]:
    """Return the slopes, by x, y, z, that define the turn of a section: those across, with the tangent where one lacks.
    """
    across = [c for c in "yz" if f"r_{c}" in element.nodal_vectors]
    return across if len(across) >= element.dim - 1 else ["x", *across]


def moment(element: Element) -> Program:
    """Return the kernel of f from M . omega = f . v, omega the rotation rate of the section.

    omega is the least-squares fit of the rates of the section's slopes: sum |a' - omega x a|^2 is minimal. A tangent
    alone in space turns across itself only: the moment along it does no work.
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
    couple = _on_one if len(vectors) == 1 else _on_two
    forces, by_vectors = couple(p, M, *vectors)
    _generalised(p, element, shapes, forces, shapes, by_vectors)
    return p


def _on_one(p: Program, M: np.ndarray, a: np.ndarray) -> tuple[list[np.ndarray], np.ndarray]:
    """Define, in a stage, the force F on a slope with a x F = M up to the part of M along a; return it and its
    derivative.
    """
    p.stage("force on the slope")
    F = p.vector("F", cross(p.define("inv_T", 1 / p.define("T", a.dot(a))) * M, a))
    p.stage("derivatives of the force by the slope")
    return [F], jacobian(p, F, a)


def _on_two(p: Program, M: np.ndarray, a: np.ndarray, b: np.ndarray) -> tuple[list[np.ndarray], np.ndarray]:
    """Define, in a stage, the forces mu x a, mu x b on two slopes with a x F_a + b x F_b = M; return them and their
    derivatives.

    The plane's normal n = a x b is a principal axis of this system: along it both slopes turn alike, across it M is
    the sum of two couples of forces along n. Derivatives of the latter in the dual basis of a, b, n: the change of
    nu = n/n.n with a is -(nu.da a* + a*.da nu), and the common part of M.da nu cancels.
    """
    p.stage("forces on the slopes")
    n = p.vector("n", cross(a, b))
    inverse = p.define("inv_nn", 1 / p.define("nn", n.dot(n)))
    nu = p.vector("nu", inverse * n)
    M_a, M_b, M_n = (p.define(f"M_{name}", M.dot(v)) for name, v in (("a", a), ("b", b), ("n", n)))
    twist = p.define("twist", inverse * M_n * p.define("inv_T", 1 / p.define("T", a.dot(a) + b.dot(b))))
    turned = [p.vector(f"turn_{name}", twist * cross(n, v)) for name, v in (("a", a), ("b", b))]
    forces = [p.vector("F_a", turned[0] - M_b * nu), p.vector("F_b", turned[1] + M_a * nu)]
    p.stage("derivatives of the forces by the slopes")
    dual_a, dual_b = p.vector("dual_a", inverse * cross(b, n)), p.vector("dual_b", inverse * cross(n, a))
    by_a, by_b = p.vector("by_a", M_b * dual_b + M_n * nu), p.vector("by_b", M_a * dual_a + M_n * nu)
    bent = np.block([
        [M_b * (np.outer(nu, dual_a) + np.outer(dual_a, nu)), M_b * np.outer(dual_b, nu) - np.outer(nu, by_b)],
        [np.outer(nu, by_a) - M_a * np.outer(dual_a, nu), -M_a * (np.outer(nu, dual_b) + np.outer(dual_b, nu))]])
    return forces, bent + jacobian(p, np.concatenate(turned), np.concatenate([a, b]))


def _generalised(p: Program, element: Element, acting: list[np.ndarray], forces: list[np.ndarray],
                 shapes: list[np.ndarray], by_vectors: np.ndarray) -> None:
    """Declare the outputs f = acting' forces, and K from the forces' derivatives by the vectors shapes e."""
    p.stage("derivatives of the forces by e")
    force = np.concatenate(forces)
    acts, moved = (np.kron(np.array(n), np.eye(element.dim, dtype=int)) for n in (acting, shapes))
    by_e = np.array([[p.define(f"d{component}_de{m}", entry) for m, entry in enumerate(row)]
                     for component, row in zip(force, by_vectors.dot(moved), strict=True)])
    p.output("f", acts.T.dot(force).reshape(element.n_vectors, element.dim), "N, N m", "generalised force")
    p.output("K", acts.T.dot(by_e), "N/m, N, N m", "derivatives of f by e, not symmetric")
