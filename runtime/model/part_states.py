"""Results of parts in states of a model, of a run or of rest, by group, label and quantity.

The quantities are those in ``results`` of the parts. All are along the ground's axes, with the time first.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import field

import numpy as np

from ..base.deferred import dataclass
from ..base.rotations import sizes
from ..engine import OUTPUTS, Engine, outputs_by_name
from ..parts.scene_data import SceneData
from ..parts.slide import Slide
from ..parts.support import Support
from .coupling import CouplingModel
from .joints import JointFrictionModel, JointStickingModel
from .kinds import COUPLINGS
from .model import Model
from .rope_states import coordinates, end_forces, rope_state
from .ropes import AnchorModel
from .states import (
    body_rates,
    body_state,
    joint_state,
    modal_state,
    point_force_state,
    spatial,
    support_force,
    support_reaction,
    tie_force,
)
from .taut_rope_states import taut_rope_state
from .taut_ropes import TautPointModel, wheel_results


@dataclass(frozen=True)
class States:
    """T states of a model.

    q (T, n_q), v and a (T, n_dof): configurations, velocities, accelerations; s (T, slides) in m; reaction (T, n_dof):
    of supports; numbers: outputs of couplings by kind of OUTPUTS, (T, couplings, numbers of one).
    """

    q: np.ndarray
    v: np.ndarray
    a: np.ndarray
    s: np.ndarray
    reaction: np.ndarray
    numbers: dict[str, np.ndarray]

    @classmethod
    def of_rows(cls, rows: Mapping[str, np.ndarray]) -> States:
        """Return the states in rows of output of the engine."""
        return cls(rows["q"], rows["v"], rows["acceleration"], rows["s"], rows["reaction"],
                   {kind: rows[kind] for kind in OUTPUTS})

    def outputs(self, kind: str, k: int) -> dict[str, np.ndarray]:
        """Return the outputs of coupling number k of a kind by name: numbers (T,), vectors (T, components)."""
        return outputs_by_name(kind, self.numbers[kind][:, k])

    @classmethod
    def at_rest(cls, q: np.ndarray, s: np.ndarray, reaction: np.ndarray, numbers: dict[str, np.ndarray]) -> States:
        """Return states of rest, whose velocities and accelerations are zero."""
        still = np.zeros_like(reaction)
        return cls(q, still, still, s, reaction, numbers)


def numbers_at_rest(engine: Engine) -> dict[str, np.ndarray]:
    """Return the outputs of couplings in the static state of an engine, by kind, (couplings, numbers of one)."""
    return {kind: engine.static_outputs(kind) for kind in OUTPUTS}


Values = dict[str, dict[str, np.ndarray]]
"""Arrays by label and quantity."""
Asked = Callable[[str], bool]
"""Whether results of a label are requested."""


@dataclass(eq=False, repr=False)
class PartStates:
    """Results of parts: nodal vectors of cables, coordinates of modal bodies, and by group the results of classes."""

    cables: Values
    modal: Values
    parts: dict[str, Values] = field(default_factory=dict)

    def by_label(self) -> Values:
        """Return all results by label and quantity."""
        found: Values = {}
        for values in (self.cables, self.modal, *self.parts.values()):
            for label, each in values.items():
                found.setdefault(label, {}).update(each)
        return found


def part_states(model: Model, scene: SceneData, at: States, alone: str | None = None) -> PartStates:
    """Return the results of parts in states; alone: only those of this label."""
    def asked(label: str) -> bool:
        return alone is None or label == alone

    cables = {}
    for cable in model.cables:
        if asked(cable.name):
            vectors, rates = (spatial(cable.nodal(x)) for x in (at.q, at.v))
            cables[cable.name] = model.results(cable.name, {"nodal_vectors": vectors, "nodal_velocity": rates})
    bodies, modal = {}, {}
    for body in model.bodies:
        if asked(body.name):
            state = body_state(model, body, at.q)
            bodies[body.name] = model.results(body.name, state | body_rates(model, body, state["orientation"], at.v,
                                                                            at.a))
            if body.modes:
                modal[body.name] = model.results(body.name, modal_state(model, body, state, at.q, at.v))
    if alone is not None and (cables or bodies):  # a label belongs to one part
        return PartStates(cables, modal, {"bodies": bodies})
    connections = {group: {label: model.results(label, values) for label, values in of.items() if asked(label)}
                   for group, of in _connections(model, scene, at, asked).items()}
    return PartStates(cables, modal, {"bodies": bodies, **connections})


def _connections(model: Model, scene: SceneData, at: States, asked: Asked) -> dict[str, Values]:
    """Return the results of supports, ties and couplings, along the axes of the model."""
    def reactions(supports: Iterable[Support]) -> Values:
        return {support.label: support_reaction(model, scene, support, at.reaction, at.q) for support in supports
                if asked(support.label)}

    couplings: dict[str, Values] = {kind.group: {} for kind in COUPLINGS if kind.name in OUTPUTS}
    for kind in COUPLINGS:
        if kind.name in OUTPUTS:
            couplings[kind.group] |= RESULTS.get(kind.name, _outputs)(model, at, kind.name, asked)
    return {
        Slide.group: couplings.pop(Slide.group),
        "pins": {pin.label: {"force": support_force(model, scene, pin, at.reaction)} for pin in scene.pins
                 if asked(pin.label)},
        "clamps": reactions(scene.clamps),
        "motions": reactions(scene.motions),
        "ties": {name: tie_force(model, scene, tie, at.reaction, at.q) for name, tie in scene.ties.items()
                 if asked(name)},
    } | couplings


def _outputs(model: Model, at: States, kind: str, asked: Asked) -> Values:
    """Return the outputs of all couplings of a kind by name."""
    named = [coupling.name for coupling in model.couplings if coupling.type == kind]
    return {name: at.outputs(kind, k) for k, name in enumerate(named) if asked(name)}


def _slides(model: Model, at: States, kind: str, asked: Asked) -> Values:
    """Return arc-length and outputs of slides, the norm of the residual, and the moment of those that hold axes."""
    found: Values = {}
    for k, slide in enumerate(model.slides):
        if not asked(slide.name):
            continue
        outputs = at.outputs(kind, k)
        found[slide.name] = {"s": at.s[:, k]} | outputs | {"residual": sizes(outputs["residual"])}
    for k, joint in enumerate(model.joints):
        if joint.slide in found:
            found[joint.slide]["moment"] = joint_state(joint, at.outputs("joint", k))["moment"]
    return found


def _joints(model: Model, at: States, kind: str, asked: Asked) -> Values:
    """Return the results of the scene's joints, without those that hold the axes of slides, and with friction."""
    found = {joint.name: joint_state(joint, at.outputs(kind, k)) for k, joint in enumerate(model.joints)
             if joint.is_of_scene and asked(joint.name)}
    numbers: Counter[str] = Counter()
    for friction in model.of(JointFrictionModel, JointStickingModel):
        numbers[friction.type] += 1
        if (of := found.get(friction.name)) is not None:
            by = joint_state(friction.of, at.outputs(friction.type, numbers[friction.type] - 1))
            of |= {name: of[name] + by[name] for name in ("force", "moment")}
    return found


def _point_forces(model: Model, at: States, kind: str, asked: Asked) -> Values:
    """Return the forces between two points, with length and tension."""
    return {force.name: point_force_state(model, force, at.outputs(kind, k)["force"], at.q)
            for k, force in enumerate(model.point_forces) if asked(force.name)}


def _contacts(model: Model, at: States, kind: str, asked: Asked) -> Values:
    """Return the results of contacts, of stretches of a cable together; a body has no arc-lengths."""
    found: Values = {}
    none = np.full(len(at.q), np.nan)
    for name, own in _by_name(model.contacts, asked).items():
        if model.contacts[own[0]].cable >= 0:
            found[name] = _along_line(at, kind, own)
        else:
            found[name] = at.outputs(kind, own[0]) | {"first": none, "last": none, "gap": none}
    return found


def _rope_contacts(model: Model, at: States, kind: str, asked: Asked) -> Values:
    """Return the results of contacts of ropes by name."""
    return {name: _along_line(at, kind, own) for name, own in _by_name(model.rope_contacts, asked).items()}


def _by_name(models: Sequence[CouplingModel], asked: Asked) -> dict[str, list[int]]:
    """Return the numbers of models by the names of their parts that are asked for."""
    numbers: dict[str, list[int]] = {}
    for k, each in enumerate(models):
        if asked(each.name):
            numbers.setdefault(each.name, []).append(k)
    return numbers


def _along_line(at: States, kind: str, numbers: list[int]) -> dict[str, np.ndarray]:
    """Return the results of a contact along a line: sums and extremes over the outputs of its parts, by number."""
    of = outputs_by_name(kind, at.numbers[kind][:, numbers])
    touches = of["touching"] > 0
    ends = {"first": np.where(touches, of["first"], np.inf).min(axis=1),
            "last": np.where(touches, of["last"], -np.inf).max(axis=1)}
    return {"force": of["force"].sum(axis=1), "friction_force": of["friction_force"].sum(axis=1),
            "penetration": of["penetration"].max(axis=1), "touching": of["touching"].sum(axis=1),
            **{end: np.where(np.isfinite(s), s, np.nan) for end, s in ends.items()}, "gap": np.full(len(at.q), np.nan)}


def _hard_contacts(model: Model, at: States, kind: str, asked: Asked) -> Values:
    """Return the results of hard contacts by name: sums and extremes over the outputs of their points."""
    found: Values = {}
    for name, points in _by_name(model.hard_contacts, asked).items():
        of = outputs_by_name(kind, at.numbers[kind][:, points])
        none, depth = np.full(len(at.q), np.nan), -of["gap"].min(axis=1)
        found[name] = {"force": of["force"].sum(axis=1), "friction_force": of["friction_force"].sum(axis=1),
                       "penetration": np.maximum(depth, 0.0),
                       "touching": np.any(of["force"] != 0, axis=2).sum(axis=1).astype(float), "first": none,
                       "last": none, "gap": -depth}
    return found


def _drags(model: Model, at: States, kind: str, asked: Asked) -> Values:
    """Return the results of drags by name: the sum of the forces of all their fluids."""
    found: Values = {}
    for k, drag in enumerate(model.drags):
        force = at.outputs(kind, k)["force"]
        found[drag.name] = {"force": force + (found[drag.name]["force"] if drag.name in found else 0.0)}
    return found


def _ices(model: Model, at: States, kind: str, asked: Asked) -> Values:
    """Return the results of ice by name: the mass of all its stretches."""
    found: Values = {}
    for name, own in _by_name(model.ices, asked).items():
        of = outputs_by_name(kind, at.numbers[kind][:, own])
        found[name] = {"thickness": of["thickness"][:, 0], "mass": of["mass"].sum(axis=1)}
    return found


def _branches(model: Model, at: States, kind: str, asked: Asked) -> Values:
    """Return the results of branches by name, at the points of their elements."""
    found: Values = {}
    for name, elements in _by_name(model.branches, asked).items():
        of = outputs_by_name(kind, at.numbers[kind][:, elements])
        shape = len(at.q), of["sliding"].shape[1] * of["sliding"].shape[2]
        points = {"moment": of["moment"].reshape(*shape, 3)} | {
            key: of[key].reshape(shape) for key in ("tension", "sliding")}
        found[name] = {key: points[key] for key in model.branches[elements[0]].results}
    return found


def _working_curves(model: Model, at: States, kind: str, asked: Asked) -> Values:
    """Return the results of working curves by name, at the points of their elements."""
    found: Values = {}
    for name, elements in _by_name(model.working_curves, asked).items():
        of = outputs_by_name(kind, at.numbers[kind][:, elements])
        found[name] = {key: points.reshape(len(at.q), points.shape[1] * points.shape[2]) for key, points in of.items()}
    return found


def _ropes(model: Model, at: States, kind: str, asked: Asked) -> Values:
    """Return points along ropes, and the forces at their ends."""
    anchors = model.of(AnchorModel)
    forces = {k: at.outputs(kind, k)["force"] for k in range(len(anchors))}
    return {rope.part.name: (rope_state(model, rope, at.q) | end_forces(model, rope, at.reaction, forces, anchors)
                             if rope.part.mass else taut_rope_state(model, rope, at.q, at.outputs))
            | coordinates(rope, at.q, at.v)
            for rope in model.ropes if asked(rope.part.name)}


def _taut_points(model: Model, at: States, kind: str, asked: Asked) -> Values:
    """Return the results of sheaves and drums of ropes without mass."""
    return {point.name: wheel_results(at.outputs(kind, k), point) for k, point in enumerate(model.of(TautPointModel))
            if point.radius and asked(point.name)}


def _none(model: Model, at: States, kind: str, asked: Asked) -> Values:
    """Return no results: those of others contain them."""
    return {}


RESULTS = {"slide": _slides, "anchor": _ropes, "joint": _joints, "joint_friction": _none, "joint_sticking": _none,
           "point_force": _point_forces, "drag": _drags, "ice": _ices, "branch": _branches,
           "working_curve": _working_curves, "contact": _contacts,
           "rope contact": _rope_contacts, "hard_contact": _hard_contacts,
           "taut_point": _taut_points, "taut_rope": _none}
"""Functions from outputs to results, of the kinds of couplings whose results are not the outputs themselves."""
