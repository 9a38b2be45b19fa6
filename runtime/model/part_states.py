"""What parts tell of a model's states, those of a run or of rest, by group, label and quantity.

The quantities are those that the ``results`` of parts list. All are along the ground's axes, with the time first.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field

import numpy as np

from ..engine import OUTPUT_KINDS, SLIDE_OUTPUTS, Engine
from ..parts.contact import Contact
from ..parts.crossing import Crossing
from ..parts.drag import Drag
from ..parts.point_force import PointForce
from ..parts.scene_data import SceneData
from ..parts.support import Support
from .model import Model
from .states import (
    body_rates,
    body_state,
    contact_state,
    crossing_state,
    drag_states,
    hard_contact_states,
    joint_state,
    modal_state,
    point_force_state,
    spatial,
    support_reaction,
    tie_force,
)


@dataclass(frozen=True)
class States:
    """States of a model as the engine has them, T of them.

    q (T, n_q), v and a (T, n_dof): configurations, velocities, accelerations; s (T, slides) in m; reaction (T, n_dof):
    what supports give; numbers: of couplings by kind of OUTPUT_KINDS, (T, couplings, numbers of one).
    """

    q: np.ndarray
    v: np.ndarray
    a: np.ndarray
    s: np.ndarray
    reaction: np.ndarray
    numbers: dict[str, np.ndarray]

    @classmethod
    def of_rows(cls, rows: Mapping[str, np.ndarray]) -> States:
        """Return the states of an engine's rows of output."""
        return cls(rows["q"], rows["v"], rows["acceleration"], rows["s"], rows["reaction"],
                   {kind: rows[kind] for kind in OUTPUT_KINDS})

    @classmethod
    def at_rest(cls, q: np.ndarray, s: np.ndarray, reaction: np.ndarray, numbers: dict[str, np.ndarray]) -> States:
        """Return states of rest: without velocities and accelerations."""
        still = np.zeros_like(reaction)
        return cls(q, still, still, s, reaction, numbers)


def numbers_at_rest(engine: Engine) -> dict[str, np.ndarray]:
    """Return the numbers of couplings in an engine's static state, by kind, (couplings, numbers of one)."""
    return {kind: engine.static_outputs(kind) for kind in OUTPUT_KINDS}


Values = dict[str, dict[str, np.ndarray]]
"""Arrays by label and quantity."""


@dataclass
class PartStates:
    """What parts tell: of cables their nodal vectors, of modal bodies their coordinates, of all the results of their
    class, by group.
    """

    cables: Values
    modal: Values
    parts: dict[str, Values] = field(default_factory=dict)

    def by_label(self) -> Values:
        """Return all of it by label and quantity."""
        found: Values = {}
        for values in (self.cables, self.modal, *self.parts.values()):
            for label, each in values.items():
                found.setdefault(label, {}).update(each)
        return found


def part_states(model: Model, scene: SceneData, at: States, alone: str | None = None) -> PartStates:
    """Return what parts tell of states; alone: those of this label, None: all."""
    def asked(label: str) -> bool:
        return alone is None or label == alone

    cables = {}
    for cable in model.cables:
        if asked(cable.name):
            vectors, rates = (spatial(x[:, cable.coordinates].reshape(len(x), *cable.shape)) for x in (at.q, at.v))
            cables[cable.name] = model.results(cable.name, {"nodal_vectors": vectors, "nodal_velocity": rates})
    bodies, modal = {}, {}
    for body in model.bodies:
        if asked(body.name):
            state = body_state(model, body, at.q)
            bodies[body.name] = model.results(body.name, state | body_rates(model, body, state["orientation"], at.v,
                                                                            at.a))
            if body.modes:
                modal[body.name] = model.results(body.name, modal_state(model, body, state, at.q, at.v))
    connections = {group: {label: model.results(label, values) for label, values in of.items() if asked(label)}
                   for group, of in _connections(model, scene, at, asked).items()}
    return PartStates(cables, modal, {"bodies": bodies, **connections})


def _connections(model: Model, scene: SceneData, at: States, asked: Callable[[str], bool]) -> dict[str, Values]:
    """Return what slides, supports, ties, joints and forces tell, along the axes of the model."""
    def reactions(supports: Iterable[Support]) -> Values:
        return {support.label: support_reaction(model, scene, support, at.reaction, at.q) for support in supports
                if asked(support.label)}

    of_joints = [(joint, joint_state(joint, at.numbers["joint"][:, k])) for k, joint in enumerate(model.joints)]
    slides = {slide.name: {"s": at.s[:, k]} | _slide_state(at.numbers["slide"][:, k])
              for k, slide in enumerate(model.slides)}
    for joint, state in of_joints:
        if joint.slide is not None:
            slides[joint.slide]["moment"] = state["moment"]
    numbers = at.numbers
    return {
        "slides": slides,
        "pins": {label: {"force": of["force"]} for label, of in reactions(scene.pins).items()},
        "clamps": reactions(scene.clamps),
        "motions": reactions(scene.motions),
        "ties": {name: tie_force(model, scene, tie, at.reaction, at.q) for name, tie in scene.ties.items()
                 if asked(name)},
        "joints": {joint.name: state for joint, state in of_joints if joint.slide is None},
        PointForce.group: {force.name: point_force_state(model, force, at.numbers["point_force"][:, k], at.q)
                           for k, force in enumerate(model.point_forces) if asked(force.name)},
        Drag.group: drag_states(model, numbers["drag"]),
        Crossing.group: {crossing.name: crossing_state(numbers["crossing"][:, k])
                         for k, crossing in enumerate(model.crossings)},
        Contact.group: {contact.name: contact_state(contact, numbers["contact"][:, k])
                        for k, contact in enumerate(model.contacts)}
        | hard_contact_states(model, numbers["hard_contact"]),
    }


def _slide_state(numbers: np.ndarray) -> dict[str, np.ndarray]:
    """Return what results tell of a slide, from the engine's numbers (T, numbers) of it; see fu_slide_output."""
    ends = np.cumsum(list(SLIDE_OUTPUTS.values()))
    if numbers.shape[-1] != ends[-1]:
        raise ValueError(f"a slide has {numbers.shape[-1]} numbers, not {ends[-1]}")
    found = {name: numbers[..., end - size : end] if size > 1 else numbers[..., end - 1]
             for (name, size), end in zip(SLIDE_OUTPUTS.items(), ends, strict=True)}
    return found | {"residual": np.linalg.norm(found["residual"], axis=-1)}
