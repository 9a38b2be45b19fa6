"""Second derivatives of the structural law: over motions of a configuration's parts, then over the nodal vectors.

Turns of one frame about its own axes do not commute; the directors' own derivatives put that right.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import sympy as sp

from ...algebra.gram import DIRECTIONS
from ...algebra.gram_tangent import from_others
from ...algebra.tangent_frame import spatial
from ...codegen.program import DirectionalDerivative
from .forces import ZERO, Forces, Slot, Velocity, across
from .structural import Configuration


@dataclass(frozen=True)
class Moved:
    """A unit motion: derivatives of the forces on the parts, and what derives the forces on the directors, by node."""

    changes: np.ndarray
    directors: list[DirectionalDerivative]


class Tangent(Forces):
    """Derivatives of the forces: first over the motions of the parts, then over the nodal vectors.

    `parts` (motions, motions) is the derivative of the force along a motion (row) by a motion (column), `late` that by
    the rate of a spin.
    """

    def __init__(self, configuration: Configuration, resultants: Sequence[sp.Expr]):
        super().__init__(configuration, resultants)
        self.program.stage("derivatives at constant resultants, over motions of the parts")
        count, first = len(configuration.motions), configuration.turn(0, self.law.spins[0])
        self.parts = np.full((count, count), ZERO, dtype=object)
        forces = np.array([*(f for slope in self.slopes for f in slope),
                           *(moment[k] for moment in self.moments for k in self.law.spins)])
        hessian = self.midspan.hessian()
        for column in [*(configuration.stretch(1, i) for i in self.law.axes), *range(first, count)]:
            motion = configuration.motions[column]
            moved = self._scalars_moved[column]
            by_scalar = {v: self.program.define(f"dV_{s.name}_{column}", row.dot(moved))
                         for v, s, row in zip(self.midspan.gradient, self.midspan.scalars, hessian, strict=True)}
            rate = DirectionalDerivative(self.program, f"turn{column}", self.constant_resultants | motion | by_scalar)
            for row in range(column + 1):
                self.parts[row, column] = self.program.define(f"P_{row}_{column}", rate(forces[row]))
        self._mirror()
        self.velocity: Velocity | None = None
        self.late: np.ndarray | None = None
        self.across: dict[tuple[Slot, Slot], np.ndarray] = {}

    @cached_property
    def _scalars_moved(self) -> list[np.ndarray]:
        """Return the rates of the scalars of the middle by motion."""
        return [self._moved_by(motion) for motion in self.configuration.motions]

    def _moved_by(self, motion: dict[sp.Symbol, sp.Expr]) -> np.ndarray:
        configuration = self.configuration
        of_mean = [self.program.define("moved", (motion[a] + motion[b]) / 2)
                   for a, b in zip(*configuration.between, strict=True) if a.is_Symbol]
        return np.array([*of_mean, *(motion[g] for g in configuration.gibbs if g.is_Symbol)])

    def _mirror(self) -> None:
        """Fill the half below the diagonal: motions commute but for the spins of one frame, of which (k, l) and (l, k)
        differ by the third.
        """
        for row in range(len(self.parts)):
            for column in range(row + 1, len(self.parts)):
                self.parts[column, row] = self.parts[row, column]
        if len(self.law.spins) == 3:
            for node, moment in enumerate(self.moments):
                for k in range(3):
                    row, column = sorted((self.configuration.turn(node, k), self.configuration.turn(node, (k + 1) % 3)))
                    sign = 1 if k < 2 else -1
                    self.parts[column, row] = self.parts[row, column] + sign * moment[(k + 2) % 3]

    def add_material(self, stiffness: Sequence[sp.Expr], velocity: Velocity | None = None,
                     rate: sp.Expr = None) -> None:
        """Add the stages of what the resultants change by, for the elastic law, or the viscous one at a velocity."""
        self.program.stage("strains by motions of the parts")
        B = self._strain_motions()
        moved = B
        if velocity:
            moved = np.array([[self.program.define("Bv", velocity.rate(b) + rate * b) for b in row] for row in B])
        self.program.stage("resultants by motions of the parts")
        first = self.configuration.turn(0, self.law.spins[0])
        self.parts = self._add_form(self.parts, B, stiffness, moved, "K")
        if velocity:
            self.late = self._add_form(np.full((len(B[0]), len(B[0]) - first), ZERO, dtype=object), B, stiffness,
                                       B[:, first:], "L")
        self.velocity = velocity
        self._add_across(stiffness, velocity, rate)

    def _add_across(self, stiffness: Sequence[sp.Expr], velocity: Velocity | None, rate: sp.Expr | None) -> None:
        """Add the strains of the section, which only directors move."""
        terms, dim, directors = across(self.configuration), self.law.element.dim, self.configuration.directors
        for q, own in terms.items():
            resultants = self.law.resultants(stiffness, [sp.Integer(i == q) for i in range(self.law.n_strains)])
            for node, i, j in own:
                change = directors[node][j]
                if velocity:
                    change = velocity.directors[node][j] + rate * change
                for p in (p for p in terms if resultants[p] != 0):
                    scaled = self.program.vector(f"t_{self.law.names[p]}_{self.law.names[q]}", resultants[p] * change)
                    for to, a, b in terms[p]:
                        self._add(("yz"[a], to), ("yz"[i], node), np.outer(directors[to][b][:dim], scaled[:dim]))
                self._add(("yz"[i], node), ("yz"[j], node), self.resultants[q] * np.eye(dim, dtype=int))

    def _add(self, of: Slot, to: Slot, block: np.ndarray) -> None:
        self.across[of, to] = self.across.get((of, to), 0) + block

    def _add_form(self, K: np.ndarray, B: np.ndarray, stiffness: Sequence[sp.Expr], columns: np.ndarray,
                  name: str) -> np.ndarray:
        """Return K + B' C columns, named entry by entry; B' C B is symmetric."""
        C = np.array([[self.program.define("C", r) for r in self.law.resultants(stiffness, column)]
                      for column in columns.T]).T
        form = np.full(K.shape, ZERO, dtype=object)
        for i, j in np.ndindex(*K.shape):
            form[i, j] = (form[j, i] if columns is B and j < i else
                          self.program.define(f"{name}_{i}_{j}", B[:, i].dot(C[:, j])))
        return np.array([[self.program.define("sum", a + b) for a, b in zip(*rows, strict=True)]
                         for rows in zip(K, form, strict=True)])

    def _strain_motions(self) -> np.ndarray:
        """Return the strains by motions of the parts: (strains, motions); those of the section do not see them."""
        configuration, n = self.configuration, len(self.law.axes)
        B = np.full((self.law.n_strains, len(configuration.motions)), ZERO, dtype=object)
        for column, motion in enumerate(configuration.motions):
            values = [self.program.define(f"B_{row}_{column}", v)
                      for row, v in enumerate(self.midspan.strains.dot(self._scalars_moved[column]))]
            for i in self.law.axes:
                for node in range(2):
                    B[2 * n * node + i, column] = motion[configuration.along[node][i]]
                B[n + i, column] = values[i]
            B[3 * n:3 * n + len(self.law.spins), column] = values[n:]
        return B

    def nodal(self) -> np.ndarray:
        """Return the tangent (n, n): over the directors first, then over the nodal vectors."""
        symmetric = self.velocity is None
        self.program.stage("over r_x at the three places and directors")
        places = [("x", place) for place in range(3)]
        slots = places + [(d, n) for n in range(2) for d in "yz"[: self.law.element.dim - 1]]
        K = {}
        for column, to in enumerate(slots):
            moved = [self._moved(to, j) for j in self.law.axes]
            for row, of in enumerate(slots):
                if not symmetric or row <= column:
                    K[of, to] = self._block(of, to, moved, symmetric and of == to)
        return self._over_nodes(K, symmetric)

    def _moved(self, slot: Slot, j: int) -> Moved:
        """Return what changes when component j of r_x at a place or of a director moves."""
        configuration, program = self.configuration, self.program
        vector, n = slot
        if vector == "x":
            changes, rates = self.parts[:, configuration.stretch(n, j)], {}
        else:
            unit = spatial([int(i == j) for i in range(3)])
            pair = (unit, 0 * unit) if vector == "y" else (0 * unit, unit)
            spin = np.array([program.define(f"W{k + 1}_{vector}{n + 1}_{DIRECTIONS[j]}", s)
                             for k, s in enumerate(configuration.frames[n].spin(*pair))])
            columns = np.array([configuration.turn(n, k) for k in self.law.spins])
            changes = self.parts[:, columns].dot(spin[list(self.law.spins)])
            if self.velocity and self.late is not None:
                late = np.array([program.define("dW", self.velocity.rate(spin[k])) for k in self.law.spins])
                changes = changes + self.late[:, columns - configuration.turn(0, self.law.spins[0])].dot(late)
            rates = configuration.frames[n].rates(spin, *pair)
        changes = np.array([program.define("change", c) for c in changes])
        by_node = []
        for node, frame in enumerate(configuration.frames):
            still = dict.fromkeys(frame.rates(*np.zeros((3, 3), dtype=int)), ZERO)
            moments = {self.moments[node][k]: changes[configuration.turn(node, k)] for k in self.law.spins}
            of_frame = rates if vector != "x" and node == n else {}
            by_node.append(DirectionalDerivative(program, f"by_{vector}{n + 1}_{j}", still | of_frame | moments))
        return Moved(changes, by_node)

    def _block(self, of: Slot, to: Slot, moved: list[Moved], symmetric: bool) -> np.ndarray:
        """Return the derivative of the force on one slot by another, (dim, dim)."""
        dim, (vector, n) = self.law.element.dim, of
        name = f"K_{vector}{n + 1}_{to[0]}{to[1] + 1}"
        block = np.full((dim, dim), ZERO, dtype=object)
        for j, by in enumerate(moved):
            for i in range(dim):
                block[i, j] = (by.changes[self.configuration.stretch(n, i)] if vector == "x" else
                               by.directors[n](self.directors[n]["yz".index(vector)][i]))
        return self._defined(name, block + self.across.get((of, to), np.zeros((dim, dim), dtype=int)), symmetric)

    def _defined(self, name: str, block: np.ndarray, symmetric: bool) -> np.ndarray:
        found = np.array([[self.program.define(f"{name}_{DIRECTIONS[i]}{DIRECTIONS[j]}", value)
                           if not symmetric or i <= j else ZERO for j, value in enumerate(row)]
                          for i, row in enumerate(block)])
        return np.triu(found) + np.triu(found, 1).T if symmetric else found

    def _over_nodes(self, K: dict[Any, np.ndarray], symmetric: bool) -> np.ndarray:
        element, program = self.law.element, self.program
        program.stage("over the nodal vectors")
        n, dim = element.n_vectors, element.dim
        nodal = np.full((n, n, dim, dim), ZERO, dtype=object)
        for j in range(1, n):
            for k in range(j if symmetric else 1, n):
                block = sum(a * b * (K[s, t] if (s, t) in K else K[t, s].T)
                            for s, a in self.slots[j] for t, b in self.slots[k])
                name = f"K_{element.names[j]}_{element.names[k]}"
                nodal[j, k] = self._defined(name, block, symmetric and j == k)
                if symmetric:
                    nodal[k, j] = nodal[j, k].T
        return from_others(element, program, nodal, symmetric)
