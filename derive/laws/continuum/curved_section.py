"""Force and moment resultants of a continuum with a curved stress-free shape, at a point of its axis.

The stress is no polynomial in y and z: it is summed over points of the section (section_points.py). The elastic
constants all have the ratios of the fourth moments to the second of D11, or none.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import sympy as sp

from ...algebra.gram import DIRECTIONS, Gram
from ...algebra.gram_point import Expansion, expansion
from ...algebra.section_points import KINDS
from ...algebra.tangent_frame import cross, spatial
from ...codegen.program import Program
from .curved_point import Metric, at_point, columns, frame, voigt


def resultants(gram: Gram, elasticity: Mapping[Any, Any], program: Program, S: np.ndarray, c: np.ndarray,
               c0: np.ndarray, X: sp.Expr, w: sp.Expr) -> tuple[Any, ...]:
    """Return force and moment in space, and strain."""
    dim = gram.element.dim
    program.stage("columns of F and J0, and the arm, as polynomials in y and z")
    F, F0 = (_named(program, name, columns(gram, vectors, X, w)) for name, vectors in (("F", c), ("F0", c0)))
    arm = {power: v for power, v in expansion(gram.psi, c, X, w).items() if any(power)}
    R = frame(program, F0, DIRECTIONS.index(gram.element.director[-1]))
    force, moment = np.full(3, sp.S.Zero), np.full(3, sp.S.Zero)
    for g, (y, z, D) in enumerate(_points(program, S, dim)):
        program.stage(f"stress at point {g} of the section")
        Fg, F0g = at_point(program, f"F_{g}_", F, y, z), at_point(program, f"F0_{g}_", F0, y, z)
        metric = Metric(program, f"_{g}", R, F0g)
        strain = _strain(program, f"_{g}", metric, _green(Fg, F0g))
        stress = [[sp.S.Zero] * dim for _ in range(dim)]
        for a, b in voigt(dim):
            stress[a][b] = stress[b][a] = program.define(f"S{a}{b}_{g}", metric.det * sum(
                D[elasticity[(a, b), kl]] * strain[k] for k, kl in enumerate(voigt(dim)) if ((a, b), kl) in elasticity))
        toward = program.vector(f"s_{g}", np.array(stress).dot(metric.N[0]))
        along = metric.N.dot(toward)
        traction = program.vector(f"p_{g}", sum(s * column for s, column in zip(along, Fg, strict=True)))
        lever = program.vector(f"arm_{g}", sum(v * y**a * z**b for (a, b), v in arm.items()))
        force = force + spatial(traction)
        moment = moment + cross(spatial(lever), spatial(traction))
    return force, moment, _measures(program, R, F, F0)


def _named(program: Program, name: str, parts: list[Expansion]) -> list[Expansion]:
    return [{(a, b): program.vector(f"{name}{DIRECTIONS[i]}_{'y' * a}{'z' * b}", v) for (a, b), v in column.items()}
            for i, column in enumerate(parts)]


def _points(program: Program, S: np.ndarray, dim: int) -> list[tuple[Any, ...]]:
    """Return y, z and the elastic constants times the share of the section, for each point."""
    program.stage("points of the section")
    (y, per_y), (z, per_z) = (_place(program, name, S[0, second], S[0, fourth])
                              for name, second, fourth in (("y", 1, 3), ("z", 2, 5)))
    integrals: list[tuple[Any, ...]] = []
    for k, row in enumerate(S):
        of_y, of_z, both = program.define(f"D{k}_y", row[1] * per_y), sp.S.Zero, sp.S.Zero
        if dim == 3:
            of_z, both = program.define(f"D{k}_z", row[2] * per_z), program.define(f"D{k}_yz", row[4] * per_y * per_z)
        integrals.append((row[0], of_y, of_z, both))
    kinds = [(name, *kind) for name, kind in zip(("middle", "side_y", "side_z", "corner"), KINDS, strict=True)
             if dim == 3 or kind[1] == 0]
    found = []
    for name, i, k, shares in kinds:
        D = [program.define(f"{name}{row}", sum(sp.Rational(share) * value
                                                for share, value in zip(shares, values, strict=True)))
             for row, values in enumerate(integrals)]
        found += [(s * y, t * z, D) for s in ((1, -1) if i else (0,)) for t in ((1, -1) if k else (0,))]
    return found


def _place(program: Program, name: str, second: sp.Expr, fourth: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
    """Return where points have both moments, and the inverse of its square."""
    square = program.define(f"{name}2", fourth / second)
    return program.define(name, sp.sqrt(square)), program.define(f"per_{name}2", 1 / square)


def _green(F: list[np.ndarray], F0: list[np.ndarray]) -> list[sp.Expr]:
    """Return (F'F - F0'F0)_ii/2 and (F'F - F0'F0)_ij."""
    return [(F[i].dot(F[j]) - F0[i].dot(F0[j])) * (sp.Rational(1, 2) if i == j else 1) for i, j in voigt(len(F))]


def _strain(program: Program, tag: str, metric: Metric, change: list[sp.Expr]) -> list[sp.Expr]:
    """Return E_ii and 2 E_ij in the tangent frame: N' change N."""
    dim, order = metric.dim, voigt(metric.dim)
    half = {}
    for (i, j), value in zip(order, change, strict=True):
        name = program.define(f"d{i}{j}{tag}", value)
        half[i, j] = half[j, i] = name if i == j else name / 2
    N, axes = metric.N, range(dim)
    right = [[program.define(f"dN{i}{b}{tag}", sum(half[i, j] * N[j, b] for j in axes)) for b in axes] for i in axes]
    return [program.define(f"E{a}{b}{tag}", (1 if a == b else 2) * sum(N[i, a] * right[i][b] for i in axes))
            for a, b in order]


def _measures(program: Program, R: np.ndarray, F: list[Expansion], F0: list[Expansion]) -> list[sp.Expr]:
    """Return the strain on the axis, and what varies along y and z of F'F - F0'F0, per length of the stress-free axis.
    """
    program.stage("strain on the axis")
    metric = Metric(program, "_axis", R, [column[0, 0] for column in F0])
    dim, parts = metric.dim, {}
    for power, tag in (((0, 0), "_0"), ((1, 0), "_1"), ((0, 1), "_2")):
        change = []
        for i, j in voigt(dim):
            value = _coefficient(F, i, j, power) - _coefficient(F0, i, j, power)
            change.append(value / 2 if i == j else value)
        parts[power] = dict(zip(voigt(dim), _strain(program, tag, metric, change), strict=True))

    def of(power: tuple[int, int], i: int, j: int) -> sp.Expr:
        return parts[power].get((i, j), sp.S.Zero)

    o, y, z = (0, 0), (1, 0), (0, 1)
    return [of(o, 0, 0), of(o, 0, 1), of(o, 0, 2), (of(y, 0, 2) - of(z, 0, 1)) / 2, of(z, 0, 0), -of(y, 0, 0)]


def _coefficient(F: list[Expansion], i: int, j: int, power: tuple[int, int]) -> sp.Expr:
    """Return the coefficient of a power of y and z in (F'F)_ij."""
    return sum((u.dot(v) for (a, b), u in F[i].items() for (c, d), v in F[j].items() if (a + c, b + d) == power),
               sp.S.Zero)
