"""Nodes of cables as nodes of strings: nodes shared by ties, smooth continuations, clamps."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...model.contacts import ContactModel
from ...model.crossings import CrossingModel
from ...model.drags import DragModel
from ...model.ices import IceModel
from ...model.joints import JointModel
from ...model.loads import AnyLoadModel
from ...model.model import Model
from ...model.point_forces import PointForceModel

STRING_VECTORS = {"r", "r_x", "r_y", "r_z", "r_xx"}
"""Nodal vectors that the shape of a string determines."""


@dataclass
class SmoothTie:
    """Two ends of cables that a tie makes one node, with one direction.

    first, second: nodes of the tie; sense: 1 where the second cable continues in the sense of the first one, else -1.
    """

    first: int
    second: int
    sense: float


class StringNodes:
    """The nodes of all cables of a model, numbered cable by cable.

    first: the number of the first node of each cable, and their end. r, slope (nodes, dim): dofs of position and of
    r_x. held (nodes,): those that joints and springs hold to the ground or to bodies, which stay as drawn. acted_on:
    cables under other actions than supports, ties, loads, fluids, fixed planes, and joints to ground and bodies;
    joined: cables on which other cables act, except by ties; in_contact: cables in contact with what strings would pass
    through; above_plane: with fixed planes or height fields.
    """

    def __init__(self, model: Model):
        self.model, dim = model, model.dim
        counts = [cable.shape[0] for cable in model.cables]
        self.first = np.cumsum([0, *counts])
        self.cable = np.repeat(np.arange(len(counts)), counts)
        starts = np.concatenate([cable.first + np.arange(cable.shape[0]) * cable.shape[1] * dim
                                 for cable in model.cables])
        self.r, self.slope = (
            (starts + np.repeat([cable.vectors.index(name) * dim for cable in model.cables], counts))[:, None]
            + np.arange(dim) for name in ("r", "r_x"))
        self.unknown = model.unknown_of_dof[self.r]
        self._hold()

    @property
    def fixed(self) -> np.ndarray:
        """Return (nodes, dim): which coordinates of positions are fixed."""
        return np.asarray((self.unknown == -1) | self.held[:, None])

    @cached_property
    def string_node(self) -> np.ndarray:
        """Return (nodes,): the first node that ties make the same as each node."""
        stands_for = np.arange(len(self.unknown))
        first: dict[tuple[int, ...], int] = {}
        for node in np.flatnonzero((self.unknown >= 0).any(axis=1)).tolist():
            stands_for[node] = first.setdefault(tuple(self.unknown[node].tolist()), node)
        return stands_for

    @cached_property
    def groups(self) -> list[np.ndarray]:
        """Return the numbers of the cables of each group that ties connect."""
        group = np.arange(len(self.model.cables))
        for node in np.flatnonzero(self.string_node != np.arange(len(self.string_node))).tolist():
            one, other = group[self.cable[node]], group[self.cable[self.string_node[node]]]
            group[group == max(one, other)] = min(one, other)
        return [np.flatnonzero(group == label) for label in np.unique(group).tolist()]

    def of(self, group: np.ndarray) -> np.ndarray:
        """Return the nodes of a group of cables."""
        return np.concatenate([np.arange(*self.first[c : c + 2]) for c in group])

    def can_hang(self, group: np.ndarray) -> bool:
        """Return whether a group is supported, acts on no other cables, has contact with planes only, and no unknown
        nodal vectors.
        """
        own = self.of(group)
        return bool(self.fixed[own].any() and (self.unknown[own] >= -1).all()
                    and (self.joined | self.in_contact).isdisjoint(group.tolist())
                    and all(STRING_VECTORS.issuperset(self.model.cables[c].vectors) for c in group))

    def is_alone(self, group: np.ndarray, q: np.ndarray) -> bool:
        """Return whether a group is one cable on two supports, which hold the positions of its ends and no direction,
        with no plane below it.
        """
        if len(group) > 1 or group[0] in self.above_plane:
            return False
        own = self.of(group)
        fixed = self.fixed[own]
        return bool(fixed[[0, -1]].all() and not fixed[1:-1].any() and np.array_equal(self.string_node[own], own)
                    and not self.clamped(group, q))

    def smooth_ties(self, group: np.ndarray) -> list[SmoothTie]:
        """Return the ties of a group that join only two ends of cables, with one direction."""
        own = self.of(group)
        inward = {int(node): sense for c in group for node, sense in ((self.first[c], 1), (self.first[c + 1] - 1, -1))}
        at_node: dict[int, list[int]] = {}
        for node in own[self.string_node[own] != own].tolist():
            at_node.setdefault(int(self.string_node[node]), []).append(node)
        return [SmoothTie(first, others[0], -float(inward[first] * inward[others[0]]))
                for first, others in at_node.items() if len(others) == 1 and first in inward and others[0] in inward
                and self._share_slopes(first, others[0])]

    def _share_slopes(self, a: int, b: int) -> bool:
        of_a, of_b = (self.model.unknown_of_dof[self.slope[node]] for node in (a, b))
        return bool(np.array_equal(of_a, of_b) or (of_a < -1).any() or (of_b < -1).any())

    def clamped(self, group: np.ndarray, q: np.ndarray) -> dict[int, np.ndarray]:
        """Return the unit vector (dim,) along the cable at each node with a fixed direction."""
        own = self.of(group)
        fixed = own[(self.unknown[own] == -1).all(axis=1)]
        return {node: along for node in fixed.tolist() if (along := self._held_direction(node, q)) is not None}

    def _held_direction(self, node: int, q: np.ndarray) -> np.ndarray | None:
        cable = self.model.cables[self.cable[node]]
        k = node - self.first[self.cable[node]]
        unknown, values = (dict(zip(cable.vectors, cable.nodal(of)[k], strict=True))
                           for of in (self.model.unknown_of_dof, q))
        if "r_y" in values:
            if (unknown["r_y"] != -1).any():
                return None
            height = values["r_y"]
            along = np.cross(height, values["r_z"]) if "r_z" in values else np.array([height[1], -height[0]])
        else:
            if not ((unknown["r_x"] == -1).any() or np.count_nonzero(unknown["r_x"] >= 0) == 1):
                return None
            along = values["r_x"]
        return np.asarray(along / np.linalg.norm(along))

    def _hold(self) -> None:
        """Find the actions of couplings on cables except loads, fluids and fixed planes."""
        self.held = np.zeros(len(self.cable), dtype=bool)
        self.acted_on, self.joined, self.in_contact, self.above_plane = set[int](), set[int](), set[int](), set[int]()
        for coupling in self.model.couplings:
            if rests(coupling):
                self.above_plane |= _cables_of(coupling)
            if isinstance(coupling, AnyLoadModel | DragModel | IceModel) or rests(coupling) or _joins_pieces(coupling):
                continue
            cables = _cables_of(coupling)
            node = self._node_of(coupling) if len(cables) == 1 else None
            if node is not None:
                self.held[node] = True
            if node is None or not isinstance(coupling, JointModel):
                self.acted_on |= cables
            if len(cables) > 1:
                self.joined |= cables
            if isinstance(coupling, ContactModel | CrossingModel):
                self.in_contact |= cables

    def _node_of(self, coupling: object) -> int | None:
        """Return the node that a joint, or a force on an end of a cable, holds to ground or bodies; else None."""
        if not isinstance(coupling, JointModel | PointForceModel):
            return None
        at = next(end for end in coupling.attachments if end.cable >= 0)
        if at.slide >= 0:
            return None
        cable, first = self.model.cables[at.cable], int(self.first[at.cable])
        own = at.N.reshape(2, -1)[:, cable.vectors.index("r")]
        if not np.isclose(own.max(), 1.0, rtol=0, atol=1e-9):
            return None
        node = int(cable.mesh.first_node(at.element)) + int(np.argmax(own))
        return first + node if isinstance(coupling, JointModel) or node in (0, cable.shape[0] - 1) else None


def _joins_pieces(coupling: object) -> bool:
    """Return whether a coupling joins two pieces of a cable."""
    return isinstance(coupling, JointModel) and coupling.joins_pieces


def rests(coupling: object) -> bool:
    """Return whether a coupling is a cable's contact with a fixed plane or height field."""
    return (isinstance(coupling, ContactModel) and coupling.cable >= 0 and coupling.shape in ("flat", "terrain")
            and all(on.cable == on.body == on.slide == -1 for on in coupling.on))


def _cables_of(coupling: object) -> set[int]:
    """Return the numbers of the cables of a coupling."""
    found = {getattr(coupling, "cable", -1), *getattr(coupling, "cables", ())}
    found |= {end.cable for end in (*getattr(coupling, "attachments", ()), *getattr(coupling, "on", ()))}
    if (rider := getattr(coupling, "rider", None)) is not None:
        found.add(rider.cable)
    return found - {-1}
