"""Second derivatives of elastic energies and damping forces, staged over strain vectors, then over nodal vectors."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import sympy as sp

from ..codegen.program import Program
from ..spec import Element
from .gram import DIRECTIONS, Gram

Moduli = Mapping[tuple[int, int], sp.Expr]


def blocks(gram: Gram, program: Program, c: np.ndarray, b: np.ndarray, moduli: Moduli,
           u: Sequence[sp.Expr]) -> np.ndarray:
    """Return B(c)' A B(b) + u (x) I over strain vectors -> (n, n, dim, dim), B(c) = dG/dc, A by its non-zero entries.

    With b = c this is the elastic tangent; with b = tau (dc/dt + rate c) that of the damping force.
    """
    n, dim, symmetric = len(gram.names), gram.element.dim, c is b
    resultants = _resultants(gram, program, b, moduli)
    program.stage("B' A B + u (x) I: blocks over strain vectors")
    block = np.zeros((n, n, dim, dim), dtype=object)
    for m in range(n):
        for k in range(m if symmetric else 0, n):
            p = gram.pairs.index((min(m, k), max(m, k)))
            stress = np.eye(dim, dtype=int) * (2 * u[p] if m == k else u[p])
            name = f"K_{gram.names[m]}_{gram.names[k]}"
            block[m, k] = _named(program, name, _outer(gram, c, resultants, m, k) + stress, symmetric and m == k)
            if symmetric:
                block[k, m] = block[m, k].T
    return block


def _resultants(gram: Gram, program: Program, b: np.ndarray, moduli: Moduli) -> dict[tuple[int, int], np.ndarray]:
    """Return A B(b) by (Gram pair, strain vector), each (dim,), zeros left out."""
    program.stage("A B: stress resultants per strain vector")
    found = {}
    for p in range(len(gram.pairs)):
        for m in range(len(gram.names)):
            alike: dict[sp.Expr, np.ndarray] = {}
            for q in range(len(gram.pairs)):
                g = gram.by_vector(b, q, m)
                if g is not None and (p, q) in moduli:
                    alike[moduli[p, q]] = alike.get(moduli[p, q], 0) + g
            if alike:
                name = f"t_{gram.pair(p)}_{gram.names[m]}"
                found[p, m] = program.vector(name, sum(k * v for k, v in alike.items()))
    return found


def _outer(gram: Gram, c: np.ndarray, resultants: Mapping[tuple[int, int], np.ndarray], m: int, k: int) -> np.ndarray:
    """Return the block (dim, dim) of B(c)' A B(b) of the strain vectors m and k."""
    dim = gram.element.dim
    total = np.zeros((dim, dim), dtype=object)
    for p in range(len(gram.pairs)):
        g = gram.by_vector(c, p, m)
        if g is not None and (p, k) in resultants:
            total = total + np.outer(g, resultants[p, k])
    return total


def _named(program: Program, name: str, block: np.ndarray, symmetric: bool) -> np.ndarray:
    """Return a block (dim, dim) with its entries named, those below the diagonal of a symmetric one after the others'.
    """
    named = np.zeros(block.shape, dtype=object)
    for i, j in np.ndindex(*block.shape):
        if not (symmetric and j < i):
            named[i, j] = program.define(f"{name}_{DIRECTIONS[i]}{DIRECTIONS[j]}", block[i, j])
    return np.triu(named) + np.triu(named, 1).T if symmetric else named


def nodal_tangent(gram: Gram, program: Program, block: np.ndarray, w: sp.Expr, symmetric: bool) -> np.ndarray:
    """Return T' K T over nodal coordinates -> (n, n); the first position is minus the sum of the others.

    Blocks are over the directions of space, or (1, 1) where all directions have the same.
    """
    n, dim, count = len(gram.names), block.shape[-1], gram.element.n_vectors
    position = gram.element.is_position
    scale = [w if p else sp.S.One for p in position]
    program.stage("over nodal vectors: K T")
    right = np.zeros((n, count, dim, dim), dtype=object)
    for a in range(n):
        for k in range(1, count):
            value = scale[k] * sum(gram.scaled[m][k] * block[a, m] for m in range(n)
                                   if gram.scaled[m][k] != 0)
            right[a, k] = _define_block(program, f"KT_{gram.names[a]}_{gram.element.names[k]}", value)
    program.stage("over nodal vectors: T' K T")
    K = np.zeros((count, count, dim, dim), dtype=object)
    for j in range(1, count):
        for k in range(j if symmetric else 1, count):
            value = scale[j] * sum(gram.scaled[m][j] * right[m, k] for m in range(n)
                                   if gram.scaled[m][j] != 0)
            K[j, k] = _define_block(program, f"K_{gram.element.names[j]}_{gram.element.names[k]}", value)
            if symmetric:
                if j == k:
                    K[j, j] = np.triu(K[j, j]) + np.triu(K[j, j], 1).T
                K[k, j] = K[j, k].T
    return from_others(gram.element, program, K, symmetric)


def from_others(element: Element, program: Program, K: np.ndarray, symmetric: bool) -> np.ndarray:
    """Return the tangent (n, n) from blocks (k, k, dim, dim): the first position takes minus the sum of the others."""
    position, count, dim = element.is_position, element.n_vectors, K.shape[-1]
    others = [k for k in range(1, count) if position[k]]
    program.stage("the first position: rigid translation makes no force")
    for k in range(1, count):
        value = -sum(K[j, k] for j in others)
        K[0, k] = _define_block(program, f"K_{element.names[0]}_{element.names[k]}", value)
        K[k, 0] = K[0, k].T if symmetric else -sum(K[k, j] for j in others)
    K[0, 0] = -sum(K[0, j] for j in others)
    return K.transpose(0, 2, 1, 3).reshape(count * dim, count * dim)


def _define_block(program: Program, name: str, value: np.ndarray) -> np.ndarray:
    return np.array([[program.define(f"{name}_{DIRECTIONS[i]}{DIRECTIONS[j]}", v) for j, v in enumerate(row)]
                     for i, row in enumerate(value)], dtype=object)
