"""Checks of parts against their scene, and their completion."""

from __future__ import annotations

import warnings
from typing import Any, TypeVar

import numpy as np

from ..base.rotations import unit
from ..errors import FunicularWarning, SceneError, near
from ..kernels.elements import built_in
from ..parts.attachment import Attachment
from ..parts.cable import Cable
from ..parts.contact import Contact
from ..parts.drag import Drag
from ..parts.event import Event
from ..parts.ice import Ice
from ..parts.load import DistributedForce, Force, Moment
from ..parts.locations import Node, grips, joined, node_of, point_of, support_of
from ..parts.modal_body import ModalBody
from ..parts.part import Part
from ..parts.point_force import PointForce
from ..parts.point_mass import PointMass
from ..parts.rope import Rope
from ..parts.scene_data import SceneData
from ..parts.signal import Signal, presence_of
from ..parts.support import Clamp, Support, Tie
from ..parts.validation import LENGTH_TOLERANCE, show
from .frames import plane_normal

P = TypeVar("P", bound=Part)
L = TypeVar("L", Cable, Rope)

SUPPORTED = {"pin": "pinned", "clamp": "clamped", "motion": "moved as prescribed"}


AXES = ("x", "y", "z")
LEAST_COSINE = -0.999
"""Of the angle between a clamp's direction and the tangent as drawn, beyond which the shortest turn is not known."""
WATCHABLE = {"rigid_body": ("position", "velocity"), "modal_body": ("position", "velocity"),
             "cable": ("position", "velocity", "least_strain"), "slide": ("s", "s_rate", "traction")}
"""Quantities with thresholds, by kind of part."""
WHOLE = ("s", "s_rate", "traction", "least_strain")
"""Quantities without components and without a place on a cable."""


def report(scene: SceneData, message: str, level: int = 5) -> None:
    """Add a message to the scene, and warn at the caller's `level` of the stack."""
    scene.messages.append(message)
    warnings.warn(message, FunicularWarning, stacklevel=level)


def cable_of(scene: SceneData, name: str, place: str) -> Cable:
    """Return the cable ``name``. Raises SceneError."""
    if name not in scene.cables:
        raise SceneError(place, f'there is no cable "{name}"', near(name, scene.cables))
    return scene.cables[name]


def cable_at(scene: SceneData, name: str, place: str, s: float, keyword: str = "s") -> Cable:
    """Return the cable ``name``, on which ``s`` must lie."""
    cable = cable_of(scene, name, place)
    if not -LENGTH_TOLERANCE * cable.length <= s <= (1 + LENGTH_TOLERANCE) * cable.length:
        raise SceneError(place, f"{keyword} must lie on the cable, in [0, {cable.length:.9g}] m, got {s:.9g} m")
    return cable


def node_at(scene: SceneData, name: str, place: str, s: float, keyword: str = "s") -> Node:
    """Return the node of the cable ``name`` at ``s``; there must be one."""
    cable = cable_at(scene, name, place, s, keyword)
    node = cable.node_at(s)
    if node is not None:
        return name, node
    nodes = cable.mesh.boundaries
    if len(nodes) > 12:  # of a long list only the two neighbours
        right = int(np.searchsorted(nodes, s))
        nodes = nodes[right - 1 : right + 1]
    raise SceneError(
        place,
        f"{keyword} must be a node of the cable, got {show(s, 'm')}",
        f"nodes {'near it ' if cable.elements > 11 else ''}are at " + ", ".join(f"{s:.9g}" for s in nodes) + " m")


def check_without_hinge(where: str, cable: Cable) -> None:
    """Raise SceneError for what moves along a cable whose tangent may jump."""
    if cable.hinges:
        raise SceneError(where, f"moves along {cable.where}, whose tangent may jump at the hinge at "
                         f"{show(cable.mesh.start(cable.hinges[0]), 'm')}",
                         "leave the hinge out, or end a cable on each side and join them by a tie")


def placed_support(scene: SceneData, support: Support) -> Support:
    """Return the support, checked to be on a free node."""
    node = node_at(scene, support.cable, support.where, support.s)
    if isinstance(support, Clamp) and support.direction is not None:
        drawn, along = (unit(np.asarray(each)) for each in (scene.cables[support.cable].axes_at(support.s)[0],
                                                            support.direction))
        if drawn @ along < LEAST_COSINE:
            raise SceneError(support.where, f"direction {show(support.direction)} is opposite to the tangent as drawn, "
                             f"{show(drawn)}, towards larger s", "draw the cable to leave the clamp in this direction")
    if (other := support_of(scene, node)) is None:
        return support
    if node_of(scene, other) == node:
        raise SceneError(support.where, f"the node at s = {show(support.s, 'm')} is already {SUPPORTED[other.kind]}")
    raise SceneError(support.where, f"the node at s = {show(support.s, 'm')} is joined to that at {other.label}, which "
                     f"is already {SUPPORTED[other.kind]}")


def placed_tie(scene: SceneData, tie: Tie) -> Tie:
    """Return the tie, checked to be between two nodes at one place, not yet joined, at most one of them supported."""
    one = node_at(scene, tie.cable, tie.where, tie.s)
    other = node_at(scene, tie.to, tie.where, tie.at, "at")
    if other in joined(scene, one):
        raise SceneError(tie.where, f"the nodes are {'one and the same' if one == other else 'already joined'}")
    a, b = scene.cables[tie.cable], scene.cables[tie.to]
    gap = float(np.linalg.norm(a.point(tie.s) - b.point(tie.at)))
    if gap > LENGTH_TOLERANCE * max(a.length, b.length):
        raise SceneError(tie.where, f"the nodes are {gap:.6g} m apart, at {show(a.point(tie.s))} and "
                         f"{show(b.point(tie.at), 'm')}", "draw both cables through the same point")
    first, second = support_of(scene, one), support_of(scene, other)
    if first is not None and second is not None:
        raise SceneError(tie.where, f"both nodes are fixed already, by the {first.where} and the {second.where}",
                         "leave one of them out")
    if tie.rotation == "rigid" and _shears_the_end(a, tie.s, b, tie.at):
        message = (f"{tie.where}: the tie shares the slopes of both cables, so that a moment on one shears the last "
                   "element of the other: the corner is too soft, the more so the shorter the elements are; "
                   'take scene.joint("weld", ...) instead, with up for an element without section axes')
        report(scene, message)
    return tie


def _shears_the_end(a: Cable, s: float, b: Cable, at: float) -> bool:
    """Return whether a rigid tie in space joins the tangent of one cable to the section of the other.

    In the plane, ties at an angle share only the rotation of the section (model/unknowns.py), which is nonlinear in
    space.
    """
    if 2 in (a.dim, b.dim):
        return False
    directors = [bool(cable.kind_of_element.director) for cable in (a, b)]
    return any(directors) and (not all(directors) or
                               float(np.linalg.norm(np.cross(a.axes_at(s)[0], b.axes_at(at)[0]))) > LENGTH_TOLERANCE)


def check_between(scene: SceneData, part: Contact | Drag | Ice, name: str) -> None:
    """Raise SceneError unless start and stop of what acts on a cable are nodes of it in this order."""
    for keyword in ("start", "stop"):
        if (s := getattr(part, keyword)) is not None:
            node_at(scene, name, part.where, s, keyword)
    if part.start is not None and part.stop is not None and not part.start < part.stop:
        raise SceneError(part.where, f"stop must be beyond start {show(part.start, 'm')}, got {show(part.stop, 'm')}")


def warmed(scene: SceneData, line: L) -> L:
    """Return a cable or a rope with the temperature of the scene where it has none. Raises SceneError."""
    if line.temperature is not None or scene.temperature is None:
        return line
    warm = line.completed({"temperature": scene.temperature})
    try:
        warm.check_growth()
    except ValueError as error:
        raise SceneError(line.where, *error.args) from None
    return warm


def check_strained_by_forces(cable: Cable, where: str, what: str) -> None:
    """Raise SceneError for a cable whose stress-free length changes, which what stands at `where` takes for strain."""
    if cable.temperature is not None or cable.grows:
        raise SceneError(where, f"{cable.where} has a temperature or a rest_length that changes, which the {what} "
                         "would take for strain", "leave it out")


def placed_load(scene: SceneData, load: Force | DistributedForce | Moment) -> Part:
    """Return the load with its place complete, checked to be admissible for the element."""
    if isinstance(load, DistributedForce):
        along = cable_at(scene, load.cable, load.where, load.start or 0.0, "start")
        start, stop = load.start or 0.0, along.length if load.stop is None else load.stop
        cable_at(scene, load.cable, load.where, stop, "stop")
        start, stop = max(start, 0.0), min(stop, along.length)
        if not start < stop:
            raise SceneError(load.where, f"stop must be beyond start {show(start, 'm')}, got {show(stop, 'm')}")
        load = load.completed({"start": start, "stop": stop})
    elif isinstance(load, Force) and isinstance(load.s, Signal):
        _check_moving(scene, load, load.s)
    else:
        at = getattr(load, "at", None)
        end = placed_attachment(scene, Attachment(on=load.on, s=load.s, at=at), load.where)
        update: dict[str, Any] = {}
        if not isinstance(scene.bodies.get(load.on), ModalBody):  # a moment's s is complete
            update = {"s": end.s}
        update |= {"at": end.at, "s": end.s} if isinstance(load, Force) else {}
        load = load.completed(update)
    cable = scene.cables.get(load.cable if isinstance(load, DistributedForce) else load.on)
    if cable is not None and cable.dim == 3 and not cable.kind_of_element.director:
        _check_without_section(load, cable)
    return load


def _check_moving(scene: SceneData, load: Force, s: Signal) -> None:
    """Raise SceneError for a force that cannot move, or is never on its cable, or whose sine leaves it."""
    if load.on in scene.bodies or load.on in scene.ropes:
        raise SceneError(load.where, f'moves along "{load.on}", which is no cable', "give s as a number")
    cable = cable_at(scene, load.on, load.where, 0.0)
    if load.at is not None:
        raise SceneError(load.where, f'acts on cable "{load.on}" and takes no point at', "leave at out")
    for offset in load.offsets:
        presence = presence_of(s, offset, cable.length)
        if presence is None:
            raise SceneError(load.where, f"s is a sine that leaves the cable, [0, {cable.length:.9g}] m, at the offset "
                             f"{show(offset, 'm')}", "take a smaller amplitude, or a TableSignal")
        if not presence[1].any():
            raise SceneError(load.where, f"is never on the cable, [0, {cable.length:.9g}] m, at the offset "
                             f"{show(offset, 'm')}: s starts at {show(float(s.value(0.0)), 'm')}")


def _check_without_section(load: Force | DistributedForce | Moment, cable: Cable) -> None:
    """Raise SceneError for a load that needs section axes on elements without them."""
    if isinstance(load, Moment):
        assert load.s is not None, f"{load.where} is not complete"
        value, tangent = np.array(load.value), cable.axes_at(load.s)[0]
        twist = float(np.dot(value, tangent))
        if abs(twist) > LENGTH_TOLERANCE * np.linalg.norm(value):
            raise SceneError(
                load.where, f'twists cable "{cable.name}" by {twist:.6g} N m about its tangent {show(tangent)}, but '
                f"{cable.element} has no torsion",
                f"give a moment across the tangent, or take {elements_with_sections()}")
    elif load.follower and any(load.value[1:]):
        raise SceneError(
            load.where, f'follower force across cable "{cable.name}", but {cable.element} has no section axes that it '
            f"could follow, got {show(load.value, 'N' if isinstance(load, Force) else 'N/m')}",
            f"possible is one along the tangent, (F, 0, 0), or take {elements_with_sections()}")


def elements_with_sections() -> str:
    """Return the spatial elements with section axes, for a remedy."""
    return "element=" + " or ".join(f'"{n}"' for n, kind in built_in().items() if kind.director and kind.dim == 3)


def placed_attachment(scene: SceneData, end: Attachment, where: str, prefix: str = "") -> Attachment:
    """Return an attachment complete. Raises SceneError."""
    if end.on is None:
        return end
    if end.on in scene.cables:
        if end.s is None or end.at is not None:
            raise SceneError(where, f'{prefix}acts on cable "{end.on}" and needs the arc-length s there'
                             + (", not a point at" if end.at else ""))
        cable = cable_at(scene, end.on, where, end.s, f"{prefix}s")
        return end.model_copy(update={"s": min(max(end.s, 0.0), cable.length)})
    if end.on in scene.bodies:
        if isinstance(body := scene.bodies[end.on], ModalBody):
            try:
                at = body.located(end.at, end.s)
                body.attachment_modes(at)
            except ValueError as error:
                cause, *remedy = error.args
                raise SceneError(where, f'{prefix}modal_body "{end.on}": {cause}', *remedy) from None
            return end.model_copy(update={"at": at, "s": None})
        if end.s is not None:
            raise SceneError(where, f'{prefix}acts on body "{end.on}" and takes no arc-length s',
                             "give a point in body axes, or nothing for its origin")
        return end.model_copy(update={"at": end.at or (0.0, 0.0, 0.0)})
    if end.on in scene.ropes:
        return placed_on_rope(scene, end, where, prefix)
    known = [*scene.cables, *scene.bodies]
    raise SceneError(where, f'{prefix}there is no cable or body "{end.on}"', near(end.on, known))


def placed_on_rope(scene: SceneData, end: Attachment, where: str, prefix: str) -> Attachment:
    """Return an attachment to a rope, checked to lie in one of its spans as drawn. Raises SceneError."""
    assert end.on is not None
    if end.s is None or end.at is not None:
        raise SceneError(where, f'{prefix}acts on rope "{end.on}" and needs the stress-free arc-length s there'
                         + (", not a point at" if end.at else ""))
    rope = scene.ropes[end.on]
    check_has_mass(rope, where, prefix)
    try:
        rope.span_at(scene.route_of(rope), end.s)
    except ValueError as error:
        cause, *remedy = error.args
        raise SceneError(where, f'{prefix}s of rope "{rope.name}" {cause}', *remedy) from None
    return end


def check_has_mass(rope: Rope, where: str, prefix: str = "") -> None:
    """Raise SceneError for a part that acts on a rope without mass."""
    if not rope.mass:
        raise SceneError(where, f'{prefix}acts on rope "{rope.name}", which has mass=False: it is straight and carries '
                         "no load", "give it a mass, or act on a body that an end or a sheave is on")


def check_grips(scene: SceneData) -> None:
    """Raise SceneError for joints, springs and forces whose place on a rope is no longer in a span."""
    for part, name, end in grips(scene):
        placed_on_rope(scene, end, part.where, f"{name}: " if name else "")


def placed_between(scene: SceneData, part: P) -> P:
    """Return a part with its attachments complete."""
    attachments = {name: value for name, value in vars(part).items() if isinstance(value, Attachment)}
    return part.model_copy(update={name: placed_attachment(scene, value, part.where, f"{name}: ")
                                   for name, value in attachments.items()}) if attachments else part


def placed_point_force(scene: SceneData, force: PointForce) -> PointForce:
    """Return a force between two points with complete ends, and with fields that follow from their distance."""
    force = placed_between(scene, force)
    points = point_of(scene, force.a), point_of(scene, force.b)
    distance = float(np.linalg.norm(points[1] - points[0]))
    if force.loses_direction and not distance > 1e-12 * (1 + np.abs(points).max()):
        raise SceneError(force.where, f"both ends are at {show(points[0], 'm')}: its direction is lost",
                         "join the points, draw them apart, or give a spring length=0")
    return force.at_distance(distance)


def placed_mass(scene: SceneData, mass: PointMass) -> PointMass:
    """Return the point mass, checked to be on a cable. Raises SceneError."""
    if (body := scene.bodies.get(mass.on)) is not None:
        raise SceneError(mass.where, f"is on {body.where}, and no cable", "count it in the mass of the body")
    if (rope := scene.ropes.get(mass.on)) is not None:
        raise SceneError(mass.where, f"is on {rope.where}, whose material runs over sheaves",
                         f'take a rigid_body, and a spherical joint with ("{rope.name}", s)')
    cable_at(scene, mass.on, mass.where, mass.s)
    return mass


def placed_event(scene: SceneData, event: Event) -> Event:
    """Return the event, checked to watch a function or a quantity of the scene. Raises SceneError."""
    if event.quantity is None:
        return event
    name, _, quantity = event.quantity.partition(".")
    what, _, axis = quantity.partition(".")
    parts = {**scene.bodies, **scene.cables, **scene.slides}
    if name not in parts:
        raise SceneError(event.where, f'there is no body, cable or slide "{name}"', near(name, parts))
    part = parts[name]
    known = WATCHABLE[part.kind]
    if what not in known or (axis if what in WHOLE else axis not in AXES):
        forms = ", ".join(f"{name}.{k}" if k in WHOLE else f"{name}.{k}.x" for k in known)
        raise SceneError(event.where, f'"{event.quantity}" cannot be watched', f"{forms}, with x, y or z, can"
                         if part.kind != "slide" else f"{forms} can")
    if scene.dim == 2 and axis and abs(plane_normal(scene)[AXES.index(axis)]) == 1.0:
        same = "always 0" if scene.plane is None else "always the same"
        others = " or ".join(each for each in AXES if each != axis)
        raise SceneError(event.where, f'"{event.quantity}" is {same}: the scene is planar', f"watch {others}")
    if part.kind == "cable" and what not in WHOLE:
        if event.s is None:
            raise SceneError(event.where, "s is missing: where on the cable?", "give the s of a node")
        node_at(scene, name, event.where, event.s)
    elif event.s is not None:
        raise SceneError(event.where, f'"{event.quantity}" has no place s', "leave it out")
    return event
