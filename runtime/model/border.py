"""The graph of the border: groups of its unknowns, from the bodies, couplings and cables of a model."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from itertools import chain, pairwise, permutations, product

import numpy as np

from .attachments import AttachmentModel
from .coupling import CouplingModel
from .cutting import has_many
from .elimination import MAX_DENSE_BORDER, BorderGraph, Elimination, dense_beside
from .model import Model, SlideModel

NEWTON, ACCELERATIONS = "newton", "accelerations"
"""Systems with a border: of Newton's method, with internal unknowns of couplings; of eq 38, with multipliers."""


def elimination(model: Model, system: str) -> Elimination:
    """Return the elimination of the border of a system; a small border is dense."""
    m = model.n_border_dof + (model.n_extra if system == NEWTON else model.n_multipliers)
    if m > MAX_DENSE_BORDER:
        found = _Border(model, system).graph.eliminate()
        # a slide may come to all substructures of its cable, but is in one of them at a time
        return replace(found, banded_front=found.largest_last) if has_many(len(model.slides)) else found
    return dense_beside(m, len(model.chains) - 1)


class _Place:
    """Groups of the border and chains of the band that belong to a part of the scene."""

    def __init__(self, groups: Iterable[int] = (), chains: Iterable[int] = ()):
        self.groups, self.chains = set(groups), set(chains)

    def __or__(self, other: _Place) -> _Place:
        return _Place(self.groups | other.groups, self.chains | other.chains)


class _Border:
    """The graph of a border; `bodies`, `slides`: numbers of groups; `cables`: their places."""

    def __init__(self, model: Model, system: str):
        self.model, self.system, self.graph = model, system, BorderGraph()
        self.group_of_node: dict[int, int] = {}
        self._nodes()
        self.bodies = []
        self._ropes()
        ends = [*(body.dof for body in model.bodies), model.n_dof]
        for body, (first, end) in zip(model.bodies, pairwise(ends), strict=True):
            turns = first + model.dim if body.turns_alone else end
            self.bodies.append(self._group(model.unknown_of_dof[first:turns]))
            self._group(model.unknown_of_dof[turns:end])
        self.cables = [self._place(cable.coordinates) for cable in model.cables]
        self.slides: list[int] = []
        for coupling in model.couplings:
            self._coupling(coupling)

    def _nodes(self) -> None:
        """Add the unknowns of cables in the border: those that the same elements share are a group."""
        model = self.model
        shared: dict[int, list[int]] = {}
        elements: list[np.ndarray] = []
        for cable in model.cables:
            if not np.any(self._unknowns(cable.coordinates) >= model.n_band):
                continue
            for k in range(cable.n_elements):
                at = self._unknowns(cable.dofs_of(k))
                for unknown in at[at >= model.n_band]:
                    shared.setdefault(int(unknown), []).append(len(elements))
                elements.append(at)
        groups: dict[tuple[int, ...], list[int]] = {}
        for unknown, of in shared.items():
            groups.setdefault(tuple(of), []).append(unknown)
        for unknowns in groups.values():
            number = self.graph.group(np.sort(unknowns) - model.n_band)
            self.group_of_node.update(dict.fromkeys(unknowns, number))
        for at in elements:
            place = self._of_unknowns(at)
            self._couple(place.groups, place)

    def _ropes(self) -> None:
        """Add the unknowns of ropes: each node and each material coordinate is a group."""
        for rope in self.model.ropes:
            for span in rope.spans:
                nodes = [span.node(k) for k in range(span.n_elements + 1)]
                for dofs in (*nodes, *(slice(s, s + 1) for s in span.s)):
                    unknowns = self._unknowns(dofs)
                    self._group(unknowns)
            for sheave in rope.sheaves:
                self._group(self._unknowns(np.r_[sheave.s[1:-1], sheave.turns].astype(int)))
            for drum in rope.drums:
                self._group(self._unknowns(np.array(drum.turns, dtype=int)))

    def _group(self, unknowns: np.ndarray) -> int:
        """Add a group of unknowns and return its number, -1 where there are none."""
        if not len(unknowns):
            return -1
        group = self.graph.group(unknowns - self.model.n_band)
        self.group_of_node.update(dict.fromkeys(unknowns.tolist(), group))
        return group

    def _unknowns(self, dofs: slice | np.ndarray) -> np.ndarray:
        """Return the unknowns on which these dofs depend."""
        model = self.model
        unknown = model.unknown_of_dof[dofs]
        if (combined := -2 - unknown[unknown < -1]).size:
            unknown = np.append(unknown, model.combinations.entries(combined)[1])
        return np.unique(unknown[unknown >= 0])

    def _of_unknowns(self, at: np.ndarray) -> _Place:
        model = self.model
        chains = np.unique(np.searchsorted(model.chains, at[at < model.n_band], "right") - 1)
        return _Place((self.group_of_node[int(k)] for k in at[at >= model.n_band]), map(int, chains))

    def _place(self, dofs: slice) -> _Place:
        return self._of_unknowns(self._unknowns(dofs))

    def _couple(self, groups: Iterable[int], place: _Place) -> None:
        """Make groups adjacent to each other and to a place."""
        self.graph.join({*groups, *place.groups})
        for group in groups:
            self.graph.couple(group, place.chains)

    def _coupling(self, coupling: CouplingModel) -> None:
        """Add the unknowns of a coupling and its connections."""
        newton = self.system == NEWTON
        first, count = ((coupling.unknown, coupling.n_coordinates + coupling.n_forces) if newton
                        else (coupling.multiplier, coupling.n_multipliers))
        ties = newton and bool(coupling.ends) and coupling.ties_ends(self.model.dim)
        adjacent = [self._of_unknowns(self._unknowns(dofs)) for dofs in coupling.adjacent]
        for place in adjacent:
            self._couple(place.groups, place)
        if not count and not ties and not adjacent:
            return
        sides = [*(self._elements_of(end) for end in coupling.ends), *([place] for place in adjacent)]
        if count:
            first += self.model.n_border_dof
            self._add_internal(coupling, range(first, first + count), [*chain.from_iterable(sides)])
        if ties or (adjacent and coupling.ends and coupling.ties_adjacent):
            for one, other in permutations([*sides, *([self.cables[k]] for k in coupling.along)], 2):
                for place, across in product(one, other):
                    self._couple(place.groups, across)

    def _add_internal(self, coupling: CouplingModel, unknowns: range, places: list[_Place]) -> None:
        """Add the internal unknowns of a coupling, adjacent to all its places."""
        bodies = {body for end in coupling.ends for body in self._bodies_of(end)}
        bodies |= {group for dofs in coupling.adjacent for group in self._of_unknowns(self._unknowns(dofs)).groups}
        law_alone = coupling.follows_law and not coupling.n_multipliers
        internal = self.graph.group(unknowns, None if law_alone else bodies)
        for place in places:
            self._couple({internal}, place)
        if not isinstance(coupling, SlideModel):
            for k in coupling.along:
                self._couple({internal}, self.cables[k])
            return
        self.slides.append(internal)
        for k in coupling.along:  # it is on one element at a time, whose unknowns of the band are in one chain
            self.graph.join({internal, *self.cables[k].groups})
            if chains := self.cables[k].chains:
                self.graph.follow(internal, max(chains, key=np.diff(self.model.chains).__getitem__), chains)

    def _bodies_of(self, end: AttachmentModel) -> set[int]:
        """Return the groups of the body of an attachment, on a slide those of the rider."""
        if end.slide < 0 and (end.node >= 0 or end.span is not None):
            return self._end(end).groups
        body = self.model.slides[end.slide].rider.body if end.slide >= 0 else end.body
        return {self.bodies[body]} if body >= 0 else set()

    def _elements_of(self, end: AttachmentModel) -> list[_Place]:
        """Return the place of an attachment; on a rope one for each element, of which one at a time has entries."""
        if end.span is None:
            return [self._end(end)]
        nodes = [end.span.node(k) for k in range(end.span.n_elements + 1)]
        places = [self._of_unknowns(self._unknowns(np.r_[one, other, end.span.s])) for one, other in pairwise(nodes)]
        return places if end.slide < 0 else [place | self._place_of_slide(end.slide) for place in places]

    def _place_of_slide(self, number: int) -> _Place:
        """Return the place of what a slide adds to that of its cable: its own unknowns, or its rider."""
        if self.system == NEWTON:
            return _Place({self.slides[number]})
        return self._end(self.model.slides[number].rider)

    def _end(self, end: AttachmentModel) -> _Place:
        """Return the place for which the equations of an attachment have entries."""
        if end.slide >= 0:
            span = end.span
            along = self.cables[end.cable] if span is None else self._of_unknowns(
                self._unknowns(np.r_[span.nodes, span.s]))
            return along | self._place_of_slide(end.slide)
        if end.body >= 0:
            return _Place({self.bodies[end.body]})
        if end.span is not None:
            return self._of_unknowns(self._unknowns(np.r_[end.span.nodes, end.span.s]))
        if end.node >= 0:
            return self._of_unknowns(self._unknowns(slice(end.node, end.node + self.model.dim)))
        if end.cable < 0:
            return _Place()
        cable = self.model.cables[end.cable]
        return self._place(cable.dofs_of(end.element))
