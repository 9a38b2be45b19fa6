"""Angles that motions and driven joints prescribe, followed by statics from those of a state.

A whole turn of a section restores its axes, but not the moment of a rod that it twists. A search for rest follows a
change of angle larger than `ANGLE_STEP` in steps, each from the state of rest of the previous one.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from ...engine import Engine
from ...model.model import CableModel, Model
from ...parts.joint import DRIVEN
from ...parts.locations import node_of
from ...parts.scene_data import SceneData
from ...parts.validation import show
from ..notes.note import element_place

ANGLE_STEP = np.pi / 3
"""Step of an angle in rad, with which Newton's method finds the nearest of the states that differ by whole turns."""
MIN_STEP_FRACTION = 1 / 32
"""The search ends if steps of this fraction of `ANGLE_STEP` do not converge."""
MAX_DIRECTION_TURN = np.pi / 2
"""Turn of nodal directions in a step, in rad, up to which the state belongs to the prescribed angle."""
MAX_TURN_BETWEEN_NODES = np.radians(120.0)
"""Angle in rad between directions of adjacent nodes: an element that turns further loses a turn."""
ACCURATE_TURN_BETWEEN_NODES = np.radians(20.0)
"""The same up to which a shaft's moment is accurate to about 1 %."""


def turning(scene: SceneData, model: Model) -> Iterator[tuple[str, int]]:
    """Yield the label of each motion and joint that prescribes an angle, and the number of the angle's signal."""
    signals = {motion.dof: motion.signal for motion in model.motions if motion.cosine or motion.sine}
    for motion in scene.motions:
        cable, k = node_of(scene, motion)
        node = model.nodes[cable][k]
        found = [signals[dof] for name in node.names for dof in node.dofs(name) if dof in signals]
        if motion.rotation is not None and found:
            yield motion.label, found[0]
    for joint in model.joints:
        if joint.drive >= 0 and joint.is_of_scene and DRIVEN[scene.joints[joint.name].joint_kind] == "angle":
            yield joint.name, joint.drive


def prescribed_angles(scene: SceneData, model: Model) -> dict[str, float]:
    """Return the angles at t = 0 that motions and joints prescribe, by label, rad."""
    return {label: model.signals[signal].at(0.0) for label, signal in turning(scene, model)}


class Turns:
    """The prescribed angles at t = 0 and those that a static state has reached, in rad by label."""

    def __init__(self, scene: SceneData, model: Model, engine: Engine, begin: Mapping[str, float] | None):
        """begin: angles of the state, 0 if left out; None: those prescribed."""
        self._engine, self._signals = engine, dict(turning(scene, model))
        self.prescribed = prescribed_angles(scene, model)
        self._begin = {label: (begin or {}).get(label, 0.0) for label in self.prescribed}
        self.largest = 0.0 if begin is None else max(
            (abs(angle - self._begin[label]) for label, angle in self.prescribed.items()), default=0.0)
        self.fraction, self.furthest = 1.0, 0.0
        self.lost = ""
        """Why the angles cannot be followed."""
        if self.largest > ANGLE_STEP:
            self.go(0.0)

    @property
    def reached(self) -> dict[str, float]:
        """Return the angles of the state, by label, in rad."""
        return {label: self._at(label, self.fraction) for label in self.prescribed}

    def go(self, fraction: float) -> None:
        """Prescribe angles at a fraction between those of the first state, 0, and those of the scene, 1."""
        self.fraction = fraction
        for label, signal in self._signals.items():
            self._engine.hold(signal, None if fraction == 1.0 else self._at(label, fraction))

    def _at(self, label: str, fraction: float) -> float:
        return self._begin[label] * (1 - fraction) + self.prescribed[label] * fraction

    def __str__(self) -> str:
        """Return in words the value up to which the largest change of angle was followed."""
        label = max(self.prescribed, key=lambda name: abs(self.prescribed[name] - self._begin[name]))
        reached, whole = (show(self._at(label, fraction), "rad") for fraction in (self.furthest, 1.0))
        return f'the angle of "{label}" was followed to {reached} of {whole}'


def directions(cable: CableModel, q: np.ndarray) -> np.ndarray:
    """Return (nodes, vectors, dim): the unit vectors along a cable's slopes at a configuration."""
    vectors = cable.nodal(q)[:, [name in ("r_x", "r_y", "r_z") for name in cable.vectors]]
    return np.asarray(vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), np.finfo(float).tiny))


def angles(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Return (nodes,): the largest angle between directions (nodes, vectors, dim) and others, rad."""
    return np.asarray(np.arccos(np.clip(np.sum(one * other, axis=-1).min(axis=1), -1, 1)))


def largest_turn(model: Model, before: np.ndarray, after: np.ndarray) -> float:
    """Return the largest angle, rad, by which a direction of a cable's node has turned between two configurations."""
    return max((float(angles(directions(cable, before), directions(cable, after)).max()) for cable in model.cables),
               default=0.0)


def too_long(model: Model, q: np.ndarray, begin: np.ndarray) -> str:
    """Return the element that turns so far between its nodes that the next steps would lose a turn; empty without one.

    begin: the configuration before the first step, at which an element may turn as far already.
    """
    for cable in model.cables:
        turned, before = (angles(at[cable.mesh.first], at[cable.mesh.last])
                          for at in (directions(cable, q), directions(cable, begin)))
        turned[before > MAX_TURN_BETWEEN_NODES] = 0.0
        k = int(np.argmax(turned))
        if turned[k] > MAX_TURN_BETWEEN_NODES:
            length = cable.mesh.length(k) * ACCURATE_TURN_BETWEEN_NODES / turned[k]
            return (f'cable "{cable.name}" turns by {np.degrees(turned[k]):.0f} degrees within '
                    f"{element_place(cable, k)}, and would lose a turn: take elements of at most {length:.2g} m there")
    return ""
