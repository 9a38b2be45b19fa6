"""Springs and distance joints whose two points meet: there the direction of their force is lost."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ...model.attachments import AttachmentModel
from ...model.model import Model
from ...model.states import attachment_points
from ...parts.scene_data import SceneData
from ...parts.validation import show

COINCIDENCE_TOLERANCE = 1e-9
"""Distance of two coincident points, as a fraction of their distance at the start."""
POSITION_DECIMALS = 9
"""Decimals of a position in m in messages."""


class _Directed(NamedTuple):
    """A part whose force lies along the line between two points: its name, and what to do where they meet."""

    where: str
    ends: tuple[AttachmentModel, AttachmentModel]
    start: float
    remedy: str


class MeetingPoints:
    """The first time at which the points of each spring or distance joint were at one place.

    found: time in s and the place, by the part's name in messages.
    """

    def __init__(self, scene: SceneData, model: Model):
        self._model, self._parts = model, _directed(scene, model)
        self.found: dict[str, Any] = {}

    def see(self, rows: dict[str, np.ndarray]) -> None:
        """Take further output rows: their time (n,) in s and coordinates q (n, coordinates)."""
        for part in self._parts:
            a, b = (attachment_points(self._model, end, rows["q"]) for end in part.ends)
            met = np.flatnonzero(np.linalg.norm(b - a, axis=1) <= COINCIDENCE_TOLERANCE * part.start)
            if len(met):
                place = self._model.results(part.where, {"position": a[met[0]]})["position"]
                place = place.round(POSITION_DECIMALS) + 0.0  # no -0
                self.found.setdefault(part.where, [float(rows["time"][met[0]]), place.tolist()])

    def notes(self) -> list[str]:
        """Return a note for each of them."""
        return [f"{part.where}: at t = {self.found[part.where][0]:.6g} s both ends are at "
                f"{show(tuple(self.found[part.where][1]), 'm')}: its direction is lost; {part.remedy}"
                for part in self._parts if part.where in self.found]


def _directed(scene: SceneData, model: Model) -> list[_Directed]:
    """Return the parts whose force has no direction where their points meet."""
    springs = [(part, of.attachments, "keep them apart, or take length=0 where they may meet")
               for part, of in zip(scene.point_forces.values(), model.point_forces, strict=True)
               if part.loses_direction]
    joints = [(scene.joints[of.name], of.attachments,
               'keep them apart, or take kind="spherical" for points that stay one')
              for of in model.joints if of.slide is None and scene.joints[of.name].joint_kind == "distance"]
    found = []
    for part, ends, remedy in [*springs, *joints]:
        a, b = (attachment_points(model, end, model.q[None])[0] for end in ends)
        found.append(_Directed(part.where, (ends[0], ends[1]), float(np.linalg.norm(b - a)), remedy))
    return found
