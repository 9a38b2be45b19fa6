"""Checks of ropes against their scene, and notes on their bending at sheaves."""

from __future__ import annotations

from ..errors import SceneError, near
from ..parts.attachment import Attachment
from ..parts.cable import Cable
from ..parts.contact import Contact
from ..parts.drag import Drag
from ..parts.event import Event
from ..parts.joint import Joint
from ..parts.load import Load
from ..parts.part import Part
from ..parts.plane import called
from ..parts.point_force import PointForce
from ..parts.rope import Rope
from ..parts.rope_route import MAX_LAYER, MAX_PLAUSIBLE_WRAP, DrawnRoute
from ..parts.rope_route_space import fleet_angle, fleet_angles, groove_of
from ..parts.scene_data import SceneData
from ..parts.signal import Signal
from ..parts.slide import Slide
from ..parts.validation import show
from .placement import placed_attachment, report, warmed
from .whole_scene import check_plane

ON_ROPES = (Joint, PointForce, Slide, Load, Drag, Contact)
"""Parts that act on ropes."""
MIN_RADIUS_RATIO = 10.0
"""Radius of a sheave over the diameter of its rope below which the bending stress is reported."""
MAX_RADIUS_OF_ELEMENTS = 20.0
"""Radius of a sheave over the length of an element beside it above which steps may not converge: the place of the
tangent point on an almost straight rope then has little inertia."""


def placed_rope(scene: SceneData, rope: Rope) -> Rope:
    """Return the rope with complete attachments, checked to lie in the plane and to have a possible route."""
    rope = _warmed(scene, rope)
    for cable in scene.cables.values():
        _check_pair(rope.where, rope, cable)
    if other := next((each for each in scene.ropes.values() if each.dim != rope.dim), None):
        raise SceneError(rope.where, f'its element is "{rope.element}", but that of rope "{other.name}" is '
                         f'"{other.element}"', "take the same element for all ropes")
    held = [item.held_at(_held(scene, rope, k, item.end)) for k, item in enumerate(rope.route)]
    rope = rope.model_copy(update={"route": tuple(held)})
    others = scene.copied()
    others.put(rope)
    check_plane(others)
    for message in _notes(scene, rope):
        report(scene, message)
    return rope


def _warmed(scene: SceneData, rope: Rope) -> Rope:
    """Return a rope with the temperature of the scene where it has none. Raises SceneError."""
    if rope.temperature is None and isinstance(scene.temperature, Signal):
        raise SceneError(rope.where, "the temperature of the scene is a signal, but a rope takes a number alone: its "
                         "material runs through the spans by its stress-free length, which must not change",
                         "give the rope its own temperature in K, or let a drum pay out what it lengthens by")
    return warmed(scene, rope)


def check_apart_from_ropes(scene: SceneData, part: Part) -> None:
    """Raise SceneError for a part that names a sheave or a rope, on which only some can act (`ON_ROPES`)."""
    if not scene.ropes:
        return
    for name in part.refers_to():
        rope = next((rope for rope in scene.ropes.values()
                     if name == rope.name or any(name == wheel.name for wheel in rope.wheels)), None)
        if rope is None or (name == rope.name and isinstance(part, ON_ROPES)):
            continue
        wheel = next((f'a {wheel.kind} of rope "{rope.name}"' for wheel in rope.wheels if wheel.name == name), "")
        what = wheel or "a rope"
        if isinstance(part, Event):
            raise SceneError(part.where, f'"{name}" is {what}, whose results cannot be watched',
                             f"""watch a body, or give function=, which gets state["{rope.name}.position"]""")
        connects = "no other part" if wheel else "only joints, springs, slides, loads, drags and contacts"
        raise SceneError(part.where, f'"{name}" is {what}, to which {connects} can be connected',
                         "take a body that an end or a sheave of the rope is on"
                         + ("" if wheel else f', or that a joint to ("{rope.name}", s) holds'))


def check_beside_ropes(scene: SceneData, cable: Cable) -> None:
    """Raise SceneError for a cable in space, or in another plane, beside ropes."""
    for rope in scene.ropes.values():
        _check_pair(cable.where, rope, cable)


def _check_pair(where: str, rope: Rope, cable: Cable) -> None:
    """Raise SceneError unless a cable is in the plane of a planar rope, or in space as the rope."""
    if cable.dim != rope.dim:
        kinds = {2: "planar", 3: "spatial"}
        raise SceneError(where, f'rope "{rope.name}" is {kinds[rope.dim]}, but the elements of cable "{cable.name}" '
                         f"({cable.element}) are {kinds[cable.dim]}",
                         'take planar elements for all of them, or spatial ones: element="cable12" for ropes')
    if rope.dim == 2 and cable.plane is not None:
        raise SceneError(where, f'rope "{rope.name}" lies in {called(None)}, but cable "{cable.name}" in '
                         f"{called(cable.plane)}", f"draw the scene in {called(None)}")


def _held(scene: SceneData, rope: Rope, k: int, end: Attachment) -> Attachment:
    """Return the complete attachment of an item of a route to a body, to a cable or to the ground."""
    if end.on is not None and end.on not in scene.holders:
        raise SceneError(rope.where, f'route.{k}: there is no body or cable "{end.on}"', near(end.on, scene.holders))
    return placed_attachment(scene, end, rope.where, f"route.{k}: ")


def _notes(scene: SceneData, rope: Rope) -> list[str]:
    """Return notes on a rope as drawn. Raises SceneError for an impossible route."""
    try:
        route = scene.route_of(rope)
    except ValueError as error:
        raise SceneError(rope.where, *error.args) from None
    EA, EI = rope.stiffness
    diameter, notes = 2 * rope.radius, list[str]()
    elements = [span.length / n for span, n in zip(route.spans, rope.elements_of_spans, strict=True)]
    spans_beside = {drum.where: [end] for end, drum in rope.drums.items()} | {
        sheave.where: spans for sheave, spans in zip(rope.sheaves, route.beside_sheaves, strict=True)}
    for item in rope.wheels:
        wheel, spans = f"{rope.where}: {item.where}", spans_beside[item.where]
        beside, tension = min(elements[k] for k in spans), EA * (min(route.stretch_of(k) for k in spans) - 1)
        if item.radius > MAX_RADIUS_OF_ELEMENTS * beside:
            notes.append(f"{wheel}: its radius {show(item.radius, 'm')} is above {MAX_RADIUS_OF_ELEMENTS:g} lengths of "
                         f"the elements beside it, {show(beside, 'm')}: steps may be very short or not converge; take "
                         "fewer elements")
        if EI > tension * (MAX_LAYER * item.radius)**2:
            notes.append(f"{wheel}: at a tension of {show(tension, 'N')} the rope's bending reaches further than "
                         f"{MAX_LAYER:g} of the radius {show(item.radius, 'm')} along the span: sqrt(EI / T) is "
                         f"{show((EI / tension)**0.5, 'm') if tension else 'infinite'}, so that its tangent points are "
                         "inaccurate; take a thinner rope, a larger radius, or more tension")
        if item.radius < MIN_RADIUS_RATIO * diameter:
            stress = rope.material.youngs_modulus * rope.radius / item.radius
            notes.append(f"{wheel}: its radius {show(item.radius, 'm')} is below {MIN_RADIUS_RATIO:g} diameters of the "
                         f"rope, {show(diameter, 'm')}: a bending stress of {stress:.3g} Pa, E d / (2 R)")
    for item, arc in zip(rope.sheaves, route.sheaves, strict=True):
        if arc.wrap > MAX_PLAUSIBLE_WRAP and not item.turns:
            notes.append(f"{rope.where}: {item.where}: the rope runs around it by {show(arc.wrap, 'rad')} and crosses "
                         "itself; give the other side if that is not meant")
    return (notes + (_notes_in_space(rope, route) if rope.dim == 3 else [])
            + ([] if rope.mass else _notes_without_mass(scene, rope, route)))


def _notes_without_mass(scene: SceneData, rope: Rope, route: DrawnRoute) -> list[str]:
    """Return notes on sheaves that a rope without mass passes as drawn, and one with mass would run around."""
    passed = [item for item, arc in zip(rope.sheaves, route.sheaves, strict=True) if not arc.wrap]
    if not passed:
        return []
    try:
        arcs = {arc.name: arc for arc in scene.route_of(rope.model_copy(update={"mass": True})).sheaves}
    except ValueError:
        return []
    return [f"{rope.where}: {item.where}: the rope passes it without touching it as drawn; a rope with mass would run "
            f"around it by {arcs[item.name].wrap:.3g} rad: give friction, or the rope a small mass, if that is meant"
            for item in passed if arcs[item.name].wrap <= MAX_PLAUSIBLE_WRAP]


def _notes_in_space(rope: Rope, route: DrawnRoute) -> list[str]:
    """Return notes on the fleet angles of a rope as drawn."""
    found = []
    at_drums = [(drum, (fleet_angle(groove_of(drum.axis), route.spans[end]),)) for end, drum in rope.drums.items()]
    at_sheaves = [(item, angles) for item, angles, arc in zip(rope.sheaves, fleet_angles(route), route.sheaves,
                                                              strict=True) if arc.wrap]
    for item, angles in [*at_sheaves, *at_drums]:
        if (largest := max(angles)) > item.max_fleet_angle:
            found.append(f"{rope.where}: {item.where}: the fleet angle {show(largest, 'rad')} exceeds max_fleet_angle, "
                         f"{show(item.max_fleet_angle, 'rad')}: a rope may leave its groove; turn the axis, or move it "
                         "away")
    return found
