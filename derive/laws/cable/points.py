"""Vectors along a cable at its Gauss points, and forces on them back to strain vectors.

Gauss points come in pairs at X and -X, where the Legendre series of r' and r'' have the same values but for signs: sums
and differences do the work of both points of a pair.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import sympy as sp

from ...codegen.program import Program


@dataclass(frozen=True)
class Point:
    """A quadrature point on [-1, 1]: weight, and the Legendre series of r' and (l/2) r'' there."""

    weight: sp.Float
    value: tuple[sp.Float, ...]
    slope: tuple[sp.Float, ...]


Series = Sequence[Sequence[sp.Expr]]
"""Factors of the strain vectors in a vector, point by point."""


def values(program: Program, name: str, series: Series, c: Sequence[np.ndarray]) -> list[np.ndarray]:
    """Return the vectors at the points: sums of strain vectors c."""
    found: list[Any] = [None] * len(series)
    for here, there in _pairs(series):
        alike = _sum(f * v for f, v, same in zip(series[here], c, _alike(series, here, there), strict=True) if same)
        if here != there:
            opposite = _sum(f * v for f, v, same in zip(series[here], c, _alike(series, here, there), strict=True)
                            if not same)
            alike, opposite = (_vector(program, f"{name}_{kind}{here}", part)
                               for kind, part in (("even", alike), ("odd", opposite)))
            found[there] = program.vector(f"{name}_{there}", alike - opposite, alias=True)
            alike = alike + opposite
        found[here] = program.vector(f"{name}_{here}", alike, alias=True)
    return found


def on_vectors(program: Program, tag: str, vectors: Sequence[np.ndarray], D: Sequence[sp.Expr]) -> list[np.ndarray]:
    """Return the forces on the vectors of a point from derivatives of twice the energy by their products: r1.r1, or
    r1.r1, r1.r2, r2.r2.
    """
    if len(vectors) == 1:
        return [program.vector(f"F_{tag}", D[0] * vectors[0])]
    r1, r2 = vectors
    half = program.define(f"half_{tag}", D[1] / 2)
    return [program.vector(f"F1_{tag}", D[0] * r1 + half * r2), program.vector(f"F2_{tag}", half * r1 + D[2] * r2)]


def gathered(program: Program, name: str, series: Series, forces: Sequence[np.ndarray]) -> np.ndarray:
    """Return the forces on the strain vectors (n, dim) from those on the vectors of the points."""
    total = np.zeros((len(series[0]), len(forces[0])), dtype=object)
    for here, there in _pairs(series):
        alike, opposite = forces[here], np.array(0)
        if here != there:
            alike, opposite = (program.vector(f"{kind}_{name}_{here}", forces[here] + sign * forces[there])
                               for kind, sign in (("sum", 1), ("difference", -1)))
        for m, (f, same) in enumerate(zip(series[here], _alike(series, here, there), strict=True)):
            if f != 0:
                total[m] = total[m] + f * (alike if same else opposite)
    return total


def _pairs(series: Series) -> list[tuple[int, int]]:
    """Return the points that mirror each other; the middle one mirrors itself."""
    return [(g, len(series) - 1 - g) for g in range((len(series) + 1) // 2)]


def _alike(series: Series, here: int, there: int) -> list[bool]:
    """Return, for every strain vector, whether its factor is the same at both points; else it is opposite."""
    return [f == g for f, g in zip(series[here], series[there], strict=True)]


def _sum(terms: Iterable[np.ndarray]) -> np.ndarray:
    return sum(terms, np.array(0))


def _vector(program: Program, name: str, value: np.ndarray) -> np.ndarray:
    """Return a vector with its entries named, where it is one."""
    return program.vector(name, value) if value.ndim else value
