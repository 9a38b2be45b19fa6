"""The metric of a curved stress-free shape at a point: from components of F'F to strain in its tangent frame."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import sympy as sp

from ...algebra.gram import DIRECTIONS, Gram
from ...algebra.gram_point import Expansion, expansion
from ...algebra.tangent_frame import cross, tangent_frame, unit
from ...codegen.program import Program


def voigt(dim: int) -> list[tuple[int, int]]:
    """Return the order of components: normal, then shear."""
    return [(i, i) for i in range(dim)] + [(i, j) for i in range(dim) for j in range(i + 1, dim)]


def columns(gram: Gram, c: np.ndarray, X: sp.Expr, w: sp.Expr) -> list[Expansion]:
    """Return the columns of F as polynomials in y and z."""
    return [expansion([g[i] for g in gram.gradient], c, X, w) for i in range(gram.element.dim)]


def at_point(program: Program, name: str, F: list[Expansion], y: sp.Expr, z: sp.Expr) -> list[np.ndarray]:
    """Return F at a point, column by column."""
    return [program.vector(f"{name}{DIRECTIONS[i]}", sum(v * y**a * z**b for (a, b), v in column.items()))
            for i, column in enumerate(F)]


def frame(program: Program, F: list[Expansion], director: int) -> np.ndarray:
    """Return the tangent frame of the axis, by columns."""
    tangent = program.vector("t0", F[0][0, 0])
    if len(F) == 2:
        i = unit(program, "i0", tangent)
        return np.array([[i[0], -i[1]], [i[1], i[0]]], dtype=object)
    return tangent_frame(program, tangent, program.vector("director0", F[director][0, 0]))


class Metric:
    """N = (R' J0)^-1 and det J0 from J0 by columns, R the tangent frame of the stress-free axis: D = F N R' (eq 5)."""

    def __init__(self, program: Program, tag: str, R: np.ndarray, J0: list[np.ndarray]):
        self.program, self.dim = program, len(J0)
        M = [program.vector(f"M{DIRECTIONS[i]}{tag}", R.T.dot(column)) for i, column in enumerate(J0)]
        if self.dim == 2:
            adjugate = [np.array([M[1][1], -M[1][0]]), np.array([-M[0][1], M[0][0]])]
        else:
            adjugate = [program.vector(f"adj{i}{tag}", cross(M[(i + 1) % 3], M[(i + 2) % 3])) for i in range(3)]
        self.det = program.define(f"det{tag}", M[0].dot(adjugate[0]))
        inverse = program.define(f"inv_det{tag}", 1 / self.det)
        self.N = np.array([program.vector(f"N{DIRECTIONS[i]}{tag}", inverse * row) for i, row in enumerate(adjugate)])

    def transform(self) -> list[list[sp.Expr]]:
        """Return T: from (F'F - F0'F0)_ii/2, (F'F - F0'F0)_ij to E_ii, 2 E_ij in the tangent frame."""
        N, order = self.N, voigt(self.dim)
        T = []
        for a, b in order:
            row = []
            for i, j in order:
                if i == j:
                    value = N[i, a] * N[i, b]
                else:
                    value = N[i, a] * N[j, b] + N[j, a] * N[i, b]
                row.append(value * (2 if a != b and i == j else sp.Rational(1, 2) if a == b and i != j else 1))
            T.append([self.program.define(f"T{a}{b}_{i}{j}", v) for v, (i, j) in zip(row, order, strict=True)])
        return T

    def pulled(self, D: np.ndarray, elasticity: Mapping[Any, Any]) -> list[list[sp.Expr]]:
        """Return T' D T det J0, symmetric."""
        T, order, n = self.transform(), voigt(self.dim), range(len(voigt(self.dim)))
        right = [[self.program.define(f"DT{i}_{k}", self.det * sum(
            D[elasticity[order[i], order[j]]] * T[j][k] for j in n if (order[i], order[j]) in elasticity))
            for k in n] for i in n]
        C = [[self.program.define(f"C{i}_{k}", sum(T[j][i] * right[j][k] for j in n)) if k >= i else None for k in n]
             for i in n]
        return [[C[min(i, k)][max(i, k)] for k in n] for i in n]
