"""Creep of slides and joints that regularised friction holds under a load."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...engine import outputs_by_name
from ...model.joints import JointFrictionModel
from ...model.model import SlideModel
from ...parts.joint import Joint
from ...parts.slide import Slide
from .note import Note, Rows

LEAST, MOST, STEADY = 1e-3, 1.0, 0.1
"""Speeds of creep over the velocity of the friction, between which a load is held; its largest relative change in the
last output interval."""


class Creep(Note):
    """The speed in m/s of each slide and joint with regularised friction in the last two output rows."""

    measures = (SlideModel, JointFrictionModel)

    def see(self, rows: Rows) -> None:
        """Measure further output rows."""
        for part, speeds in self._speeds({name: values[-2:] for name, values in _of_rows(rows)}):
            last = self.found.get(part.given_name or "", [0.0, 0.0])
            self.found[part.given_name or ""] = [*last, *speeds.tolist()][-2:]

    def _speeds(self, rows: Rows) -> Iterator[tuple[Slide | Joint, np.ndarray]]:
        """Yield the parts with their speeds in these rows."""
        for k, slide in enumerate(self.scene.slides.values()):
            if not slide.is_driven and slide.friction is not None and slide.friction.creeps:
                yield slide, np.abs(outputs_by_name("slide", rows["slide"][:, k])["s_rate"])
        numbers = {joint.number: k for k, joint in enumerate(self.model.joints)}
        for k, friction in enumerate(self.model.of(JointFrictionModel)):
            if friction.friction_scale < 0 and friction.coefficient > 0 and not friction.viscous:
                force, moment = _wrench("joint_friction", rows, k)
                press, _ = _wrench("joint", rows, numbers[friction.of.number])
                yield self.scene.joints[friction.name], _speed_of(friction, force, moment, press)

    def notes(self) -> list[str]:
        """Return the notes on a run."""
        found = []
        for part in self.scene.rubbing:
            before, now = self.found.get(part.given_name or "", [0.0, 0.0])
            velocity = part.friction.velocity if part.friction else np.inf
            if LEAST * velocity < now < MOST * velocity and abs(now - before) <= STEADY * now:
                found.append(f"{part.where}: its friction is regularised, and creeps under the load that it holds, at "
                             f'{now:.3g} m/s at the end. Take model="stick", which holds it, or a smaller velocity')
        return found


def _of_rows(rows: Rows) -> Iterator[tuple[str, np.ndarray]]:
    for name in ("slide", "joint", "joint_friction"):
        if name in rows:
            yield name, rows[name]


def _wrench(kind: str, rows: Rows, k: int) -> tuple[np.ndarray, np.ndarray]:
    """Return force and moment (T, 3) of coupling number k of a kind."""
    outputs = outputs_by_name(kind, rows[kind][:, k])
    return outputs["force"], outputs["moment"]


def _speed_of(friction: JointFrictionModel, force: np.ndarray, moment: np.ndarray, press: np.ndarray) -> np.ndarray:
    """Return the speeds (T,) in m/s with which the law has this friction: x = u/sqrt(u² + v0²) of its limit."""
    turns = friction.kernel.endswith("turning")
    along = moment if turns else force
    size = np.linalg.norm(along, axis=1)
    axis = along / np.maximum(size, np.finfo(float).tiny)[:, None]
    across = press - np.sum(press * axis, axis=1)[:, None] * axis
    normal = np.linalg.norm(across, axis=1) if friction.needs_reactions else friction.normal_force
    limit = friction.coefficient * normal * (friction.arms[0] if turns else 1.0)
    share = np.divide(size, limit, out=np.zeros_like(size), where=limit > size)
    speed: np.ndarray = friction.velocity * share / np.sqrt(1 - share**2)
    return speed
