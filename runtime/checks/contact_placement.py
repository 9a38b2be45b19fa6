"""Checks of surfaces and contacts against their scene, and the resolution of contact by cables."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from ..base.deferred import dataclass
from ..base.quadrature import gauss
from ..base.rotations import conjugate, rotate
from ..engine import MAX_HARD_CONTACTS
from ..errors import SceneError, near
from ..parts.cable import Cable
from ..parts.contact import GAUSS_POINTS, Contact
from ..parts.modal_body import ModalBody
from ..parts.piece import UniformPiece
from ..parts.rigid_body import RigidBody
from ..parts.rope import Rope
from ..parts.scene_data import SceneData
from ..parts.stretches import overlap, stretches
from ..parts.surface import Surface
from ..parts.surface_shapes import HeightField
from ..parts.validation import show
from .frames import plane_normal
from .ice_placement import check_beside_ice
from .placement import check_between, check_has_mass

WEIGHT_PENETRATION = 0.01
"""Penetration under the weight with the default stiffness, as a fraction of the radius."""
MAX_START_PENETRATION = 0.5
"""Penetration at the start above which a contact is refused, as a fraction of the radius."""
SAMPLES = 8
"""Points of an element at which the penetration at the start is checked."""
HARD_PENETRATION_ROUNDING = 1e-9
"""Rounding of the penetration of hard contact at the start, as a fraction of the lengths in it."""
MAX_UNSEEN_PENETRATION = 1e-2
"""Penetration between points of a cable without a radius above which a note is given, as a fraction of the surface's
radius."""
MIN_CONTACT_RADIUS = 0.01
"""Radius of contact below which it is that of the centreline, over the radius of a circle of the section's area."""


def placed_surface(scene: SceneData, surface: Surface) -> Surface:
    """Return the surface, checked to be on the ground or on a rigid body. Raises SceneError."""
    if surface.on is None:
        return surface
    if surface.on not in scene.bodies:
        what = "a cable" if surface.on in scene.cables else None
        raise SceneError(surface.where, f'"{surface.on}" is {what}, not a body' if what else
                         f'there is no body "{surface.on}"', near(surface.on, scene.bodies))
    if isinstance(scene.bodies[surface.on], ModalBody):
        raise SceneError(surface.where, f'modal_body "{surface.on}" cannot have a surface, which would not bend',
                         "take a rigid body")
    return surface


def placed_contact(scene: SceneData, contact: Contact) -> Contact:
    """Return the contact complete and checked to be open at the start. Raises SceneError."""
    return placed_contacts(scene, contact, [{}])[0]


def placed_contacts(scene: SceneData, one: Contact, names: Iterable[Mapping[str, Any]]) -> list[Contact]:
    """Return contacts as `placed_contact` does, with one evaluation of each surface and of what a cable or body adds.

    names: what differs from one in each, of its name and both sides. Raises SceneError.
    """
    made: list[Contact] = []
    starts: list[_Start] = []
    own: dict[tuple[str, str], Contact] = {}
    known, complete = scene.contact_of_pair, dict[str, Contact]()
    for each in names:
        contact = _like(scene, complete, each, known, own)
        if contact is None:
            contact = _complete(scene, _of_surface(scene, one.model_copy(update=each), known, own))
            if contact.a not in scene.ropes:
                complete[contact.a] = contact
        made.append(contact)
        _check_fits(scene, contact)
        own[contact.a, contact.b] = contact
        starts.append(_start_of(scene, contact, starts[-1] if starts else None))
    if one.is_hard:
        n_hard = sum(_hard_points(scene, contact) for contact in made)
        for contact in made:
            _check_hard(scene, contact, n_hard)
    _check_penetrations(scene, made, starts)
    return made


def _like(scene: SceneData, complete: Mapping[str, Contact], names: Mapping[str, Any],
          *pairs: Mapping[tuple[str, str], Any]) -> Contact | None:
    """Return a contact like that of the same cable or body with another surface; None without one, and for names that
    are not valid.
    """
    a, b = names.get("a"), names.get("b")
    if a in scene.surfaces and b not in scene.surfaces:
        a, b = b, a
    if (like := complete.get(a or "")) is None or (surface := scene.surfaces.get(b or "")) is None:
        return None
    if surface.on == a or any((a, b) in pairs_of for pairs_of in pairs):
        return None
    return like.model_copy(update={**names, "a": a, "b": b})


def _of_surface(scene: SceneData, contact: Contact, known: Mapping[tuple[str, str], str],
                own: Mapping[tuple[str, str], Contact]) -> Contact:
    """Return a contact with the surface second; known: names of the scene's contacts, own: contacts added with it, both
    by pair.
    """
    if contact.a in scene.surfaces and contact.b not in scene.surfaces:
        contact = contact.model_copy(update={"a": contact.b, "b": contact.a})
    if contact.b not in scene.surfaces:
        raise SceneError(contact.where, f'there is no surface "{contact.b}"',
                         near(contact.b, scene.surfaces) if scene.surfaces else
                         'add one before: scene.surface("ground", fu.Plane())')
    pair = (contact.a, contact.b)
    if pair in known or pair in own:
        _check_alone(contact, [each for each in (*scene.contacts.values(), *own.values()) if (each.a, each.b) == pair],
                     "" if scene.cables.get(contact.a) is None else ", or give them start and stop")
    return contact


def _check_alone(contact: Contact, others: list[Contact], remedy: str) -> None:
    """Raise SceneError where another contact of the same two acts on the same part of a cable."""
    part = contact.start, contact.stop
    if other := next((each for each in others if overlap((each.start, each.stop), part)), None):
        raise SceneError(contact.where, f'"{contact.a}" and "{contact.b}" have the {other.where} already',
                         "leave one of them out" + remedy)


def _complete(scene: SceneData, contact: Contact) -> Contact:
    if contact.a in scene.cables:
        contact = _of_cable(scene, contact, scene.cables[contact.a])
    elif contact.a in scene.ropes:
        contact = _of_rope(scene, contact, scene.ropes[contact.a])
    elif contact.a in scene.bodies:
        contact = _of_body(scene, contact, scene.bodies[contact.a], scene.surfaces[contact.b])
    else:
        raise SceneError(contact.where, f'there is no cable or body "{contact.a}"',
                         near(contact.a, [*scene.cables, *scene.ropes, *scene.bodies]))
    given = next((name for name in ("start", "stop") if getattr(contact, name) is not None), None)
    if given is not None and contact.a not in scene.cables:
        raise SceneError(contact.where, f'{given} is an arc-length of a cable, and "{contact.a}" is a '
                         f'{"rope" if contact.a in scene.ropes else "body"}', f"leave {given} out")
    if contact.a not in scene.ropes and contact.friction is not None and contact.friction.model == "regularised":
        raise SceneError(contact.where, "has no regularised friction", 'leave model="regularised" out')
    if contact.has_friction_spring and contact.exponent != 1.0 and contact.tangential_stiffness is None:
        raise SceneError(contact.where, "tangential_stiffness is missing, which the stiffness of the exponent 1.5 is "
                         "not", "give it, in N/m (a length of a cable)")
    return contact


@dataclass
class _Start:
    """Points of a cable or body as drawn, (n, 3) in m, with the radius of contact at each (n,) in m, or of all, and its
    weight, N or N/m.
    """

    of: tuple[str, Any]
    drawn: np.ndarray
    weight: float
    radius: np.ndarray | float


def _start_of(scene: SceneData, contact: Contact, last: _Start | None) -> _Start:
    """Return the start of a contact, that of the last one for the same points."""
    key = contact.a, contact.points
    if last is not None and last.of == key:
        return last
    radius: np.ndarray | float = contact.radius or 0.0
    if contact.a in scene.cables:
        cable = scene.cables[contact.a]
        s, radius = _samples(contact, cable)
        drawn = cable.points_at(s)
    elif contact.a in scene.ropes:
        rope = scene.ropes[contact.a]
        drawn = np.zeros((rope.n_spans * (SAMPLES + 1), 3))
        drawn[:, : rope.dim] = np.concatenate([np.linspace(span.start, span.end, SAMPLES + 1)
                                               for span in scene.route_of(rope).spans])
    else:
        drawn = np.array([scene.bodies[contact.a].point(point) for point in contact.points or ()])
    return _Start(key, drawn, _weight(scene, contact), radius)


def _samples(contact: Contact, cable: Cable) -> tuple[np.ndarray, np.ndarray]:
    """Return arc-lengths (n,) in m of sample points on the part of a cable in contact, and the radius at each, m."""
    every = cable.samples(SAMPLES)
    if cable.is_open:
        start, stop = (contact.start or 0.0), cable.length if contact.stop is None else contact.stop
        s = every[(every >= start) & (every <= stop)]
        return s, np.full(len(s), contact.radius)
    found = [(every[piece.first * SAMPLES : piece.end * SAMPLES + 1], contact.radius_of(piece.section))
             for piece in contact.stretches(cable)]
    return (np.concatenate([s for s, _ in found]),
            np.concatenate([np.full(len(s), radius, dtype=float) for s, radius in found]))


def _of_cable(scene: SceneData, contact: Contact, cable: Cable) -> Contact:
    if contact.is_hard:
        raise SceneError(contact.where, f'hard contact is of points of bodies, and "{cable.name}" is a cable',
                         "leave restitution out and give stiffness, in N/m a length")
    if contact.points is not None:
        raise SceneError(contact.where, f'acts along cable "{cable.name}" and takes no points', "leave points out")
    check_beside_ice(scene, contact, contact.a)
    check_between(scene, contact, contact.a)
    radii = [contact.radius_of(piece.section) for piece in contact.stretches(cable)]
    if None in radii:
        raise SceneError(contact.where, "radius is missing, which does not follow from the section of the cable",
                         "give radius, in m: the distance of the surface from the axis at contact")
    found = _with_stiffness(scene, contact, min(radius for radius in radii if radius is not None))
    return found if len(radii) == 1 else found.completed({"radius": None})


def radii_of(scene: SceneData, contact: Contact) -> list[float]:
    """Return the radii of a contact, m: one, or those of the pieces of a cable."""
    if contact.radius is not None:
        return [contact.radius]
    return [radius for piece in contact.stretches(scene.cables[contact.a])
            if (radius := contact.radius_of(piece.section)) is not None]


def _of_rope(scene: SceneData, contact: Contact, rope: Rope) -> Contact:
    check_has_mass(rope, contact.where)
    if contact.is_hard:
        raise SceneError(contact.where, f'hard contact is of points of bodies, and "{rope.name}" is a rope',
                         "leave restitution out and give stiffness, in N/m a length")
    if contact.points is not None:
        raise SceneError(contact.where, f'acts along rope "{rope.name}" and takes no points', "leave points out")
    sticks = contact.friction is not None and contact.friction.sticks
    if contact.tangential_stiffness is not None and not sticks:
        raise SceneError(contact.where, f'acts along rope "{rope.name}" and takes no tangential_stiffness: its '
                         "friction is regularised", 'leave it out, or give friction model="stick"')
    radius = rope.radius if contact.radius is None else contact.radius
    if not radius:
        raise SceneError(contact.where, "radius is missing, which does not follow from the section of the rope",
                         "give radius, in m: the distance of the surface from the axis at contact")
    others = {} if contact.friction is None or sticks else {
        "friction": contact.friction.completed({"model": "regularised"})}
    contact = _with_stiffness(scene, contact, radius, others)
    _check_resolution(scene, contact, rope)
    return contact


def _check_resolution(scene: SceneData, contact: Contact, rope: Rope) -> None:
    """Raise SceneError where elements of a rope as drawn are too long for the shape of a surface."""
    if (limit := resolved(scene, contact, contact.radius or 0.0)) is None:
        return
    spans = zip(scene.route_of(rope).spans, rope.elements_of_spans, strict=True)
    longest, most = max(span.length / n for span, n in spans), limit.chord / max_point_distance()
    if longest > most:
        raise SceneError(contact.where, f'"{rope.name}" has elements of {show(float(longest), "m")}, between whose '
                         f'points of contact it may be more than {show(float(limit.allowed), "m")} below "{contact.b}"',
                         f"take elements of at most {most:.3g} m")


def _of_body(scene: SceneData, contact: Contact, body: RigidBody | ModalBody, surface: Surface) -> Contact:
    if isinstance(body, ModalBody):
        raise SceneError(contact.where, f'modal_body "{body.name}" has no contact with surfaces', "take a rigid body")
    if surface.on == body.name:
        raise SceneError(contact.where, f'surface "{surface.name}" is on that body itself', "name another one")
    points = contact.points if contact.points is not None else ((0.0, 0.0, 0.0),)
    if contact.is_hard:
        return contact.completed({"points": points, "radius": contact.radius or 0.0})
    return _with_stiffness(scene, contact, 0.0 if contact.radius is None else contact.radius, {"points": points})


def _weight(scene: SceneData, contact: Contact) -> float:
    """Return the weight of a cable or a rope per length, N/m, or of a body, N."""
    line = scene.line(contact.a)
    mass = scene.bodies[contact.a].mass if line is None else max(
        piece.material.density * piece.section.area for piece in _pieces(line, contact))
    return mass * float(np.linalg.norm(scene.gravity))


def _pieces(line: Cable | Rope, contact: Contact) -> Sequence[UniformPiece]:
    """Return the pieces of a cable or a rope in contact."""
    if contact.start is None and contact.stop is None:
        return line.uniform_pieces
    return stretches(line, contact.start, contact.stop, lambda section: section)


def _with_stiffness(scene: SceneData, contact: Contact, radius: float,
                    others: Mapping[str, Any] | None = None) -> Contact:
    """Return the contact with its radius, other values and, by default, a stiffness that follows from the weight."""
    found: dict[str, Any] = {"radius": radius, **(others or {})}
    if contact.stiffness is None:
        weight = _weight(scene, contact)
        if not weight > 0 or not radius > 0:
            lacks = "gravity" if not weight > 0 else "a radius"
            raise SceneError(contact.where, f"stiffness is missing, and without {lacks} there is none to begin with",
                             "give stiffness, in N/m (a length of a cable)")
        found["stiffness"] = weight / (WEIGHT_PENETRATION * radius) ** contact.exponent
    return contact.completed(found)


def _check_hard(scene: SceneData, contact: Contact, added: int) -> None:
    """Raise SceneError for too many points in hard contact, and for a surface without exact distances.

    added: number of points in hard contact that are being added.
    """
    n = added + sum(_hard_points(scene, other) for other in scene.contacts.values() if other.is_hard)
    if n > MAX_HARD_CONTACTS:
        raise SceneError(contact.where, f"the scene has {n} points in hard contact, and {MAX_HARD_CONTACTS} are the "
                         "most", "give some of the contacts stiffness in place of restitution")
    if contact.radius and isinstance(scene.surfaces[contact.b].shape, HeightField):
        raise SceneError(contact.where, "distances from a height field are exact only on it: hard contact with it is "
                         "that of points without radius", "leave radius out, or give stiffness in place of restitution")


def _hard_points(scene: SceneData, contact: Contact) -> int:
    """Return the number of constraints of a hard contact: one per point, in a hollow box one per point and wall."""
    return len(contact.points or ()) * len(scene.surfaces[contact.b].geometry.walls(scene.dim))


def _check_fits(scene: SceneData, contact: Contact) -> None:
    """Raise SceneError where a cable or body in a hollow is too thick for it."""
    surface = scene.surfaces[contact.b]
    if not surface.inside:
        return
    shape, radius = surface.geometry, max(radii_of(scene, contact))
    if scene.dim == 2:
        normal, body = plane_normal(scene), scene.bodies.get(surface.on or "")
        shape = shape.in_plane(normal if body is None else rotate(conjugate(body.frame[1]), normal))
    if not radius < shape.inner_radius:
        raise SceneError(contact.where, f'"{contact.a}" does not fit into "{contact.b}": its radius is '
                         f"{show(radius, 'm')}, that of the hollow {show(shape.inner_radius, 'm')}",
                         "take a wider hollow, or a smaller radius")


def _allowed(scene: SceneData, contact: Contact, start: _Start) -> tuple[float, str]:
    """Return the allowed penetration at the start, m, and its reason in words."""
    if contact.is_hard:
        return HARD_PENETRATION_ROUNDING * _largest_length(scene, contact), ": a hard contact has no depth"
    assert contact.stiffness is not None, f"{contact.where} is not complete"
    sinks = (start.weight / contact.stiffness) ** (1 / contact.exponent)
    allowed = max(MAX_START_PENETRATION * min(radii_of(scene, contact)), 10 * sinks)
    return allowed, f"; {show(float(allowed), 'm')} is allowed"


def _largest_length(scene: SceneData, contact: Contact) -> float:
    """Return the largest length in the computation of the distance of a body from a surface, m."""
    surface = scene.surfaces[contact.b]
    carriers = [scene.bodies[name].frame[0] for name in (contact.a, surface.on) if name is not None]
    return max(float(np.abs(np.array([*(contact.points or ()), *carriers])).max()), contact.radius or 0.0,
               surface.geometry.largest_length)


def _check_penetrations(scene: SceneData, contacts: list[Contact], starts: list[_Start]) -> None:
    """Raise SceneError where a point starts deeper below its surface than allowed."""
    of_surface: dict[str, list[int]] = {}
    for k, contact in enumerate(contacts):
        of_surface.setdefault(contact.b, []).append(k)
    normal = plane_normal(scene) if scene.dim == 2 else None
    found: list[tuple[int, SceneError]] = []
    for name, numbers in of_surface.items():
        surface = scene.surfaces[name]
        drawn = [starts[k].drawn for k in numbers]
        first = np.cumsum([0, *map(len, drawn)])
        distance = surface.distance(scene.bodies.get(surface.on or ""), np.concatenate(drawn), normal)
        radii = np.concatenate([np.broadcast_to(starts[k].radius, len(starts[k].drawn)) for k in numbers])
        below = radii - distance > 0
        for at in np.unique(np.searchsorted(first, np.flatnonzero(below), "right") - 1).tolist():
            k = numbers[at]
            error = _too_deep(scene, contacts[k], starts[k], distance[first[at] : first[at + 1]])
            if error is not None:
                found.append((k, error))
                break
    if found:
        raise min(found, key=lambda each: each[0])[1]


def _too_deep(scene: SceneData, contact: Contact, start: _Start, distance: np.ndarray) -> SceneError | None:
    """Return an error where a point is too deep; distance: of the points (n,) from the surface, m."""
    allowed, why = _allowed(scene, contact, start)
    depths = start.radius - distance
    k = int(depths.argmax())
    depth = depths[k]
    if not depth > allowed:
        return None
    return SceneError(
        contact.where, f'"{contact.a}" starts {show(float(depth), "m")} below the surface "{contact.b}", at '
        f"{show(start.drawn[k], 'm')}", f"draw it higher, or the surface lower{why}")


def radius_of(scene: SceneData, contact: Contact, radius: float) -> float:
    """Return a radius of a contact, m, 0 where it is negligible beside the section of the cable."""
    line = scene.line(contact.a)
    least = 0.0 if line is None else MIN_CONTACT_RADIUS * float(np.sqrt(
        min(piece.section.area for piece in line.uniform_pieces) / np.pi))
    return radius if radius > least else 0.0


class Resolution(NamedTuple):
    """Penetration of a cable between its points, and the chord of the surface of that height, m."""

    allowed: float
    chord: float


def max_point_distance() -> float:
    """Return the largest distance of neighbouring points of quadrature, as a fraction of the element.

    Across a node it is smaller.
    """
    return float(np.diff(gauss(GAUSS_POINTS)[0]).max()) / 2


def resolved(scene: SceneData, contact: Contact, radius: float) -> Resolution | None:
    """Return the resolution of a surface that the points of a cable of a radius, m, need; None for a flat one."""
    radius = radius_of(scene, contact, radius)
    bend = _bend_radius(scene.surfaces[contact.b], radius)
    if not np.isfinite(bend):
        return None
    allowed = min(radius or MAX_UNSEEN_PENETRATION * bend, bend)
    return Resolution(allowed, float(2 * np.sqrt(allowed * (2 * bend - allowed))))


def _bend_radius(surface: Surface, own: float) -> float:
    """Return the least radius of curvature of a cable's axis bent over a surface, m.

    own: the radius of the cable, m. For a box, whose edges have no radius, its least size counts. In a hollow, a chord
    between two points stays inside, so that the cable is bent only over its ends.
    """
    shape = surface.geometry
    if shape.inside:
        return np.inf if shape.word == "round" and shape.direction.any() else shape.inner_radius - own
    if shape.word == "terrain":
        return own + 1 / shape.bend if shape.bend > 0 else np.inf
    return own + {"flat": np.inf, "box": float(shape.half_size.min())}.get(shape.word, shape.radius)
