"""Distributed forces on the elements of cables, and the added mass of fluids."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ...base.quadrature import gauss
from ...model.contacts import ContactModel
from ...model.drag_forces import Turning
from ...model.drags import DragModel
from ...model.ices import IceModel
from ...model.model import CableModel
from ...model.states import spatial
from ...parts.validation import LENGTH_TOLERANCE
from ..shape_functions import on_axis


@dataclass
class Quadrature:
    """Points x and weights (n,) in m on an element, from start to stop (m)."""

    element: int
    start: float
    stop: float
    x: np.ndarray
    weights: np.ndarray


@dataclass
class Spread(Quadrature):
    """A force per length on a part of an element.

    density (T, n, 3): force per length at the points, N/m, interpolated by a polynomial; f (T, vectors, dim): its
    generalised force. on_slope (T, n, 3): generalised force per length on r_x, N; couple (T, n, 3): moment per length,
    N; both as the density, or None.
    """

    density: np.ndarray
    f: np.ndarray
    on_slope: np.ndarray | None = None
    couple: np.ndarray | None = None

    def holds(self, x: np.ndarray, length: float) -> np.ndarray:
        """Return whether places x lie on it; the ends of the element, of this length, if it reaches them."""
        near = LENGTH_TOLERANCE * length
        return ((x >= self.start) | (self.start < near)) & ((x < self.stop) | (self.stop > length - near))


@dataclass
class Rule(Quadrature):
    """Shape functions (n, vectors) at the points: N of positions, N_x of r_x, N_chord of the chord of a foil."""

    N: np.ndarray
    N_x: np.ndarray
    N_chord: np.ndarray | None = None

    @classmethod
    def between_cuts(cls, cable: CableModel, element: int, x: np.ndarray, weights: np.ndarray) -> Rule:
        """Return the rule of a part between two cuts; its weights are symmetric and add up to its length.

        A part that reaches an end of the element but for rounding ends there: a section at the end has all of it.
        """
        length, whole = weights.sum(), cable.mesh.length(element)
        middle, near = weights @ x / length, LENGTH_TOLERANCE * whole
        start, stop = middle - length / 2, middle + length / 2
        start, stop = 0.0 if abs(start) < near else start, whole if abs(stop - whole) < near else stop
        return cls(element, start, stop, x, weights, *on_axis(cable, element, x))

    def spread(self, dim: int, density: np.ndarray, on_slope: np.ndarray | None = None,
               turning: Turning | None = None) -> Spread:
        """Return the force of a density (T, n, 3), of `Spread.on_slope`, and of a fluid that turns sections."""
        acting = [(self.N, density)] if on_slope is None else [(self.N, density), (self.N_x, on_slope)]
        if turning is not None:
            assert self.N_chord is not None, "only foils are turned"
            acting += [(self.N_x, turning.on_slope), (self.N_chord, turning.on_chord)]
        f = sum(np.einsum("g,gk,tgd->tkd", self.weights, shape, forces[..., :dim]) for shape, forces in acting)
        return Spread(self.element, self.start, self.stop, self.x, self.weights, density, np.asarray(f), on_slope,
                      None if turning is None else turning.couple)


def rules_of(cable: CableModel, of: DragModel | ContactModel | IceModel) -> list[Rule]:
    """Return the rules of a drag, a contact or ice, one for each element of its cable."""
    places = (1 + gauss(of.n_points)[0]) / 2
    N_x, N_chord = getattr(of, "N_x", of.N), getattr(of, "N_chord", np.zeros(0))
    found = []
    for element in range(of.first, of.first + of.n_elements):
        k, length = 0 if cable.mesh.is_even else element - of.first, cable.mesh.length(element)
        found.append(Rule(element, 0.0, length, length * places, of.weights[k], of.N[k], N_x[k],
                          N_chord[k] if N_chord.size else None))
    return found


@dataclass
class AddedMass:
    """Mass of fluids that moves with a cable: rules with M (T, n, dim, dim), kg/m, at their points."""

    cable: CableModel
    parts: list[tuple[Rule, np.ndarray]]

    def matrices(self) -> np.ndarray:
        """Return (T, elements, n, n): mass matrices of the elements, n = vectors dim."""
        times, n = len(self.parts[0][1]), 2 * self.cable.shape[1] * self.cable.shape[2]
        found = np.zeros((times, self.cable.n_elements, n, n))
        for rule, M in self.parts:
            of = np.einsum("g,gk,tgij,gl->tkilj", rule.weights, rule.N, M, rule.N)
            found[:, rule.element] += of.reshape(times, n, n)
        return found

    def spreads(self, a: np.ndarray) -> Iterator[Spread]:
        """Yield the force of the fluid due to accelerations a (T, elements, vectors, dim) of the elements."""
        for rule, M in self.parts:
            density = -np.einsum("tgij,gk,tkj->tgi", M, rule.N, a[:, rule.element])
            yield rule.spread(self.cable.shape[2], spatial(density))
