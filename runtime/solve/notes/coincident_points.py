"""Springs and distance joints whose two points coincide: there the direction of their force is lost."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...model.attachments import AttachmentModel
from ...model.joints import JointModel
from ...model.point_forces import PointForceModel
from ...model.states import attachment_points
from ...parts.validation import show
from .note import Note, Rows

COINCIDENCE_TOLERANCE = 1e-9
"""Distance of two coincident points, as a fraction of their distance at the start."""
POSITION_DECIMALS = 9
"""Decimals of a position in m in messages."""


class _Directed(NamedTuple):
    """A part whose force lies along the line between two points, their first distance in m, and the remedy."""

    where: str
    ends: tuple[AttachmentModel, AttachmentModel]
    start: float
    remedy: str


class CoincidentPoints(Note):
    """The first time in s at which the points of each spring or distance joint coincided, and their position in m."""

    measures = (PointForceModel, JointModel)

    def prepare(self) -> None:
        """Select the parts to measure."""
        scene, model = self.scene, self.model
        springs = [(part, of.attachments, "keep them apart, or take length=0 where they may coincide")
                   for part, of in zip(scene.point_forces.values(), model.point_forces, strict=True)
                   if part.loses_direction]
        joints = [(scene.joints[of.name], of.attachments,
                   'keep them apart, or take kind="spherical" for points that coincide')
                  for of in model.joints if of.is_of_scene and scene.joints[of.name].joint_kind == "distance"]
        self._parts = []
        for part, (first, second), remedy in [*springs, *joints]:
            a, b = (attachment_points(model, end, model.q[None])[0] for end in (first, second))
            self._parts.append(_Directed(part.where, (first, second), float(np.linalg.norm(b - a)), remedy))

    def see(self, rows: Rows) -> None:
        """Measure further output rows: their time and coordinates."""
        for part in self._parts:
            a, b = (attachment_points(self.model, end, rows["q"]) for end in part.ends)
            coincide = np.flatnonzero(np.linalg.norm(b - a, axis=1) <= COINCIDENCE_TOLERANCE * part.start)
            if len(coincide):
                place = self.model.results(part.where, {"position": a[coincide[0]]})["position"]
                place = place.round(POSITION_DECIMALS) + 0.0  # no -0
                self.found.setdefault(part.where, [float(rows["time"][coincide[0]]), place.tolist()])

    def notes(self) -> list[str]:
        """Return a note for each of them."""
        return [f"{part.where}: at t = {self.found[part.where][0]:.6g} s both ends are at "
                f"{show(tuple(self.found[part.where][1]), 'm')}: its direction is lost; {part.remedy}"
                for part in self._parts if part.where in self.found]
