"""Checks of a scene as a whole: its plane, its consistency, its start, and whether it can come to rest."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

import numpy as np

from ..errors import SceneError, near
from ..kernels.elements import built_in
from ..parts.cable import Cable
from ..parts.friction import Friction
from ..parts.in_plane import turned_alone
from ..parts.load import Load
from ..parts.modal_body import ModalBody
from ..parts.part import Part
from ..parts.plane import aligned, called
from ..parts.rope import Rope
from ..parts.scene_data import SceneData
from ..parts.signal import Signal, signals_of
from ..parts.validation import LENGTH_TOLERANCE, show
from .joint_placement import check_drive, check_joint
from .placement import check_grips
from .slide_placement import check_on_cable


def check_plane(scene: SceneData, part: Part | None = None) -> None:
    """Raise SceneError where a part, by default any part of the scene, leaves the plane of planar cables or ropes."""
    lines: list[Cable | Rope] = [*scene.cables.values(), *scene.ropes.values()]
    planar = next((each for each in lines if each.dim == 2), None)
    if planar is None:
        return
    own, remedy = scene.plane, "let it stay in the plane"
    if own is not None and isinstance(part, Rope):
        return  # `placed_rope` refuses it
    if not scene.ropes:
        spatial = ", ".join(f'"{name}"' for name, kind in built_in().items() if kind.dim == 3)
        remedy += f", or take spatial elements: {spatial}"
    elif isinstance(planar, Rope):
        remedy += ', or take element="cable12" for the rope'
    plane = f'leaves {called(own)} of the {planar.element} {planar.kind} "{planar.name}"'
    gravity = scene.gravity if own is None else aligned(own.into(np.array(scene.gravity)))
    if part is None and gravity[2]:
        raise SceneError("scene", f"gravity {show(scene.gravity, 'm/s²')} {plane}", remedy)
    for each in scene.parts() if part is None else [part]:
        seen = each if own is None else turned_alone(scene, own, each)
        for what in seen.off_plane():
            raise SceneError(each.where, f"{what} {plane}" + ", in whose axes it is" * (own is not None), remedy)


def check_scene(scene: SceneData) -> None:
    """Raise SceneError where the parts of a scene are inconsistent."""
    if not scene.cables and not scene.bodies and not scene.ropes:
        raise SceneError("scene", "is empty: there is nothing to simulate", "add a cable or a rigid body")
    check_plane(scene)
    check_grips(scene)
    _check_events(scene)
    for joint in scene.joints.values():
        check_joint(scene, joint)
    for body in scene.bodies.values():
        if isinstance(body, ModalBody) and (massless := body.shape.indefinite(scene.dim)):
            raise SceneError(body.where, f"its mass matrix is not positive definite: {massless}",
                             "leave such a mode out, or give masses off the line that the others are on")
    riders = Counter(slide.body for slide in scene.slides.values())
    for slide in scene.slides.values():
        if riders[slide.body] > 1 or slide.along in scene.ropes:
            check_on_cable(scene, slide)


def _check_events(scene: SceneData) -> None:
    """Raise SceneError for loads and friction that begin or end with an event which is not there, or ends the run."""
    waiting: list[tuple[str, Load | Friction]] = [(load.where, load) for load in scene.loads.values()]
    waiting += [(part.where, part.friction) for part in scene.rubbing if part.friction is not None]
    for where, part in waiting:
        for keyword, name in (("when", part.when), ("until", part.until)):
            if name is not None and name not in scene.events:
                raise SceneError(where, f'{keyword}: there is no event "{name}"', near(name, scene.events))
            if name is not None and scene.events[name].action == "stop":
                raise SceneError(where, f'{keyword}: event "{name}" ends the run', 'give it action="record"')


def check_start_as_drawn(scene: SceneData) -> None:
    """Raise SceneError where a run as drawn would begin with a jump of a motion or a driven joint."""
    for motion in scene.motions:
        length = scene.cables[motion.cable].length
        starts = [(f"displacement {axis}", signal, length, "m")
                  for axis, signal in zip("xyz", motion.displacement or (), strict=False)
                  if signal is not None]
        starts += [("rotation", motion.rotation.angle, 1.0, "rad")] if motion.rotation else []
        for name, signal, size, unit in starts:
            if abs(value := float(signal.value(0.0))) > LENGTH_TOLERANCE * size:
                raise SceneError(motion.where, f"{name} is {show(value, unit)} at t = 0, but counts from the place "
                                 "drawn", 'let it start from 0, or start with initial="equilibrium"')
    for joint in scene.joints.values():
        check_drive(scene, joint)


def check_comes_to_rest(scene: SceneData) -> None:
    """Raise SceneError for loads and drives that change with time, and for friction that creeps."""
    for part in scene.parts():
        for name, signal in _given(part):
            if not _is_constant(signal):
                raise SceneError(part.where, f"{name} changes with time, so that the scene does not come to rest",
                                 "take a constant value, with scene.replace")
    for part in scene.rubbing:
        if part.friction is not None and part.friction.creeps:
            raise SceneError(part.where, "its friction is regularised, so that it creeps and never comes to rest",
                             'take model="stick", which holds it, or leave friction out')
    for contact in scene.contacts.values():
        if contact.a in scene.ropes and contact.friction_coefficient:
            why = ("its friction has no part in a state of rest: springs along a rope begin a motion without stretch"
                   if contact.has_friction_spring else
                   "its friction is regularised, so that the rope creeps and never comes to rest")
            raise SceneError(contact.where, why, "leave friction out")
    for rope in scene.ropes.values():
        for sheave in rope.rough_sheaves:
            why = ("its friction has part in a state of rest, which has no tensions of ropes that stick"
                   if sheave.sticks else "its friction is regularised, so that the rope creeps and never comes to rest")
            raise SceneError(f"{rope.where}: {sheave.where}", why,
                             'leave friction out, or take equilibrium(wraps="stick")')


def check_impending(scene: SceneData, motion: str) -> None:
    """Raise SceneError where no rope can be about to slide in this motion, "hoisting" or "lowering", or a closed one
    would: all around it the tension cannot rise.
    """
    if not any(rope.differing_sheaves for rope in scene.ropes.values()):
        raise SceneError("equilibrium", f'impending="{motion}" needs a rope with friction on a sheave that is held or '
                         "whose rotation is prescribed", "give the friction of a sheave, or leave impending out")
    for rope in scene.ropes.values():
        if rope.closed and rope.differing_sheaves:
            raise SceneError(f"{rope.where}: {rope.differing_sheaves[0].where}", f'impending="{motion}" lets the '
                             "tension change in one sense all around a closed rope, which is at rest with none",
                             "leave the friction out, or impending")


def check_sticking(scene: SceneData) -> None:
    """Raise SceneError where no rope can stick to a sheave."""
    if not any(sheave.contact for rope in scene.ropes.values() for sheave in rope.rough_sheaves):
        raise SceneError("equilibrium", 'wraps="stick" needs a rope with mass and with friction on a sheave',
                         'give the friction of a sheave, or take wraps="slip"')


def _given(part: Part) -> Iterator[tuple[str, Signal]]:
    """Yield all signals of a part with their names, the integral of a rate included."""
    yield from signals_of(part)
    prescribed = getattr(part, "prescribed", None)
    if isinstance(prescribed, Signal):
        yield "its drive", prescribed


def _is_constant(signal: Signal) -> bool:
    """Return whether a signal has one value for all times."""
    _, coefficients = signal.pieces()
    return not signal.sine.amplitude and not np.any(coefficients[:, 1:]) and not np.any(np.diff(coefficients[:, 0]))
