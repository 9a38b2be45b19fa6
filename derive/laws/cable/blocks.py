"""Second derivatives along a cable, point by point: by r' and r'', and spread over strain vectors.

Gauss points come in pairs at X and -X, where the Legendre series of r' have the same value but for a sign: each pair is
summed, or subtracted, before it is spread over the strain vectors, which halves the work.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import sympy as sp

from ...algebra.gram import DIRECTIONS
from ...codegen.program import Program

PointBlocks = Mapping[tuple[int, int], np.ndarray]
"""Derivatives of the forces on a point's vectors i by its vectors k; (i, k) stands for its transpose (k, i) too."""


def by_vectors(program: Program, tag: str, names: str, vectors: Sequence[np.ndarray], D: Sequence[Any],
               H: np.ndarray) -> PointBlocks:
    """Return, from derivatives of twice the energy by invariants, D and H, those of the energy by the vectors that they
    are products of.

    names: "a" (r1.r1) or "c" (r2.r2) of the one vector given, or "abc" (r1.r1, r1.r2, r2.r2) of two.
    """
    eye = np.eye(len(vectors[0]), dtype=int)
    if len(vectors) == 1:
        r = vectors[0]
        along = program.vector(f"{names}1_{tag}", program.define(f"H_{tag}", 2 * H[0, 0]) * r)
        return {(0, 0): named_block(program, f"K_{tag}", D[0] * eye + np.outer(r, along), symmetric=True)}
    r1, r2 = vectors
    half = program.define(f"half_{tag}", D[1] / 2)
    factors = {"aa": 2, "ab": 1, "bb": sp.Rational(1, 2), "ac": 2, "bc": 1, "cc": 2}
    pairs = {names[i] + names[j]: H[i, j] for i in range(3) for j in range(i, 3)}
    second = {pair: program.define(f"H_{pair}_{tag}", factors[pair] * value) for pair, value in pairs.items()}

    def combined(name: str, first: np.ndarray, last: np.ndarray) -> np.ndarray:
        return program.vector(f"{name}_{tag}", first * r1 + last * r2)

    a1, b1, c1 = (combined(f"{x}1", second[p], second[q]) for x, p, q in
                  (("a", "aa", "ab"), ("b", "ab", "bb"), ("c", "ac", "bc")))
    b2, c2 = combined("b2", second["bb"], second["bc"]), combined("c2", second["bc"], second["cc"])
    K11 = D[0] * eye + np.outer(r1, a1) + np.outer(r2, b1)
    K12 = half * eye + np.outer(b1, r1) + np.outer(c1, r2)
    K22 = D[2] * eye + np.outer(r1, b2) + np.outer(r2, c2)
    return {(0, 0): named_block(program, f"K11_{tag}", K11, symmetric=True),
            (0, 1): named_block(program, f"K12_{tag}", K12),
            (1, 1): named_block(program, f"K22_{tag}", K22, symmetric=True)}


def spread(program: Program, tag: str, points: Sequence[Sequence[Any]], blocks: Sequence[PointBlocks],
           symmetric: bool) -> np.ndarray:
    """Return the sum over the points of their blocks, spread over the strain vectors -> (n, n, dim, dim).

    points: for each, the series over the strain vectors of the vectors that its blocks are of. Of a symmetric sum the
    part below the diagonal is left out.
    """
    n, dim = len(points[0][0]), blocks[0][0, 0].shape[0]
    folded = [(factors, _Folded(program, f"{tag}{g}", blocks[g], blocks[-1 - g] if 2 * g + 1 < len(points) else None))
              for g, factors in enumerate(points[: (len(points) + 1) // 2])]
    total = np.zeros((n, n, dim, dim), dtype=object)
    for m in range(n):
        for k in range(m if symmetric else 0, n):
            for factors, block in folded:
                for i, x in enumerate(factors):
                    for j, y in enumerate(factors):
                        if x[m] * y[k] != 0:
                            total[m, k] = total[m, k] + x[m] * y[k] * block(i, j, (m + k + i + j) % 2)
    return total


class _Folded:
    """Sums (0) and differences (1) of the blocks of two points that mirror each other; a lone point in the middle."""

    def __init__(self, program: Program, tag: str, one: PointBlocks, other: PointBlocks | None):
        self._program, self._tag, self._one, self._other = program, tag, one, other
        self._known: dict[tuple[int, int, int], np.ndarray] = {}

    def __call__(self, i: int, j: int, odd: int) -> np.ndarray:
        if (i, j) not in self._one:
            return self(j, i, odd).T
        if self._other is None:
            return self._one[i, j]
        if (i, j, odd) not in self._known:
            one, other = self._one[i, j], self._other[i, j]
            name = f"{'difference' if odd else 'sum'}{i + 1}{j + 1}_{self._tag}"
            self._known[i, j, odd] = named_block(self._program, name, one - other if odd else one + other,
                                                 symmetric=bool(np.all(one == one.T)))
        return self._known[i, j, odd]


def named_block(program: Program, name: str, value: np.ndarray, symmetric: bool = False) -> np.ndarray:
    """Return a block with its entries named."""
    named = np.array(value, dtype=object)
    for i, j in np.ndindex(value.shape):
        named[i, j] = (named[j, i] if symmetric and j < i
                       else program.define(f"{name}_{DIRECTIONS[i]}{DIRECTIONS[j]}", sp.sympify(value[i, j])))
    return named


def named_blocks(program: Program, names: Sequence[str], block: np.ndarray, symmetric: bool) -> np.ndarray:
    """Return blocks over the strain vectors with their entries named."""
    named = np.array(block, dtype=object)
    for m, k in np.ndindex(block.shape[:2]):
        named[m, k] = (named[k, m].T if symmetric and k < m
                       else named_block(program, f"K_{names[m]}_{names[k]}", block[m, k], symmetric and m == k))
    return named
