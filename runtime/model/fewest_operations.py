"""The numbering of the unknowns with the fewest operations: as drawn, by reverse Cuthill and McKee, or in chains."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from scipy.sparse import coo_array, csr_array, triu
from scipy.sparse.csgraph import reverse_cuthill_mckee

from .numbering import Incidence, Numbering, extents, numbered, ranges

SOLVE_WEIGHT = 30
"""Weight of solves per factorisation: about ten, three times as slow per operation, as they read from memory."""


def cheapest(elements: np.ndarray, made_of: np.ndarray, shape: tuple[int, int]) -> Numbering:
    """Return the numbering of the unknowns with the fewest operations: as drawn, or in another order.

    elements (n, 2): first dof and number of dofs of each; made_of (k, 2): a dof, an unknown of it; shape: the numbers
    of dofs and of unknowns. Scenes of one topology share the search and the arrays.
    """
    return ordered(elements.tobytes(), made_of.tobytes(), shape)


@lru_cache(maxsize=32)
def ordered(of_elements: bytes, of_dofs: bytes, shape: tuple[int, int]) -> Numbering:
    """Return `cheapest` of arrays given by their bytes, cached."""
    elements, made_of = (np.frombuffer(given, dtype=int).reshape(-1, 2) for given in (of_elements, of_dofs))
    incidence = _incidence_matrix(elements, made_of, shape)
    entry = incidence.tocoo()
    entries = Incidence(entry.row, entry.col, len(elements))
    orders = ((np.arange(shape[1]), shape[1]), _reverse_cuthill_mckee(incidence), _in_chains(incidence))
    return min((numbered(entries, *order) for order in orders),
               key=lambda one: _operations(one, entries))


def _incidence_matrix(elements: np.ndarray, made_of: np.ndarray, shape: tuple[int, int]) -> csr_array:
    """Return (elements, unknowns): 1 where an element has an unknown; made_of (k, 2): a dof, an unknown of it."""
    dofs = ranges(*elements.T)  # of each element, one element after the other
    has = csr_array((np.ones(len(dofs)), dofs, np.append(0, np.cumsum(elements[:, 1]))),
                    shape=(len(elements), shape[0]))
    incidence = has @ coo_array((np.ones(len(made_of)), (made_of[:, 0], made_of[:, 1])), shape=shape).tocsr()
    incidence.data[:] = 1.0
    return incidence


def _reverse_cuthill_mckee(incidence: csr_array) -> tuple[np.ndarray, int]:
    """Return the numbers of the unknowns and the size of the band: all in the band, by reverse Cuthill and McKee."""
    order = reverse_cuthill_mckee((incidence.T @ incidence).tocsr(), symmetric_mode=True)
    return np.argsort(order), len(order)


def _in_chains(incidence: csr_array) -> tuple[np.ndarray, int]:
    """Return the numbers of the unknowns and the size of the band: elements in chains, most shared unknowns first.

    Unknowns that other elements share than two consecutive ones of a chain are the border: nodes of more than two ends,
    and one node of each ring.
    """
    n_elements, n = incidence.shape
    shared = triu(incidence @ incidence.T, 1).tocoo()
    beside: list[list[int]] = [[] for _ in range(n_elements)]
    chain = list(range(n_elements))

    def root(e: int) -> int:
        while chain[e] != e:
            chain[e] = e = chain[chain[e]]
        return e

    for k in np.lexsort((shared.col, shared.row, -shared.data)):
        a, b = int(shared.row[k]), int(shared.col[k])
        if len(beside[a]) < 2 and len(beside[b]) < 2 and root(a) != root(b):
            beside[a].append(b)
            beside[b].append(a)
            chain[root(a)] = root(b)
    sequence: list[int] = []
    at = np.full(n_elements, -1)
    for end in (e for e in range(n_elements) if len(beside[e]) < 2):
        following = [end] if at[end] < 0 else []
        while following:
            at[following[0]] = len(sequence)
            sequence.append(following[0])
            following = [e for e in beside[sequence[-1]] if at[e] < 0]
    entry = incidence.tocoo()
    first, last = np.full(n, n_elements), np.full(n, -1)
    np.minimum.at(first, entry.col, at[entry.row])
    np.maximum.at(last, entry.col, at[entry.row])
    follows = np.array([b in beside[a] for a, b in zip(sequence, sequence[1:] + sequence[:1], strict=True)])
    border = (last > first + 1) | (last > first) & ~follows[first]
    return np.argsort(np.lexsort((np.arange(n), first, last, border))), n - int(border.sum())


def incidence_of(elements: np.ndarray, made_of: np.ndarray, shape: tuple[int, int]) -> Incidence:
    """Return the incidence of elements and unknowns, by the arguments of `cheapest`."""
    entry = _incidence_matrix(elements, made_of, shape).tocoo()
    return Incidence(entry.row, entry.col, len(elements))


def _operations(numbering: Numbering, incidence: Incidence) -> float:
    """Return the operations of a factorisation and of its solves (engine/linear/bordered.c)."""
    n_band, width, chains = numbering.n_band, numbering.width, numbering.chains
    low, high = extents(incidence, numbering.number, n_band)
    at = numbering.number[incidence.unknown]
    outside = (at >= n_band) & (high >= 0)[incidence.element]
    of = np.searchsorted(chains, low, "right") - 1
    columns = np.unique(np.stack([at[outside], of[incidence.element[outside]]]), axis=1)  # of the border, by chain
    coupled, m = float(np.diff(chains)[columns[1]].sum()), len(numbering.number) - n_band
    factor = n_band * width**2 / 2 + 2 * width * coupled + m**3 / 3
    return factor + SOLVE_WEIGHT * (2 * width * n_band + coupled + m**2)
