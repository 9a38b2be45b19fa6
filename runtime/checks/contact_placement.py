"""Checks of surfaces, and of contact with them, against the scene that they join."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..errors import SceneError, near
from ..parts.cable import Cable
from ..parts.contact import Contact
from ..parts.modal_body import ModalBody
from ..parts.rigid_body import RigidBody
from ..parts.scene_data import SceneData
from ..parts.section import outer_radius_of
from ..parts.surface import Surface
from ..parts.surface_shapes import HeightField
from ..parts.validation import show

SUNK = 0.01
"""Of the radius: what the weight sinks in by with the stiffness that is taken where none is given."""
OVERLAP = 0.5
"""Of the radius: a start deeper below the surface is refused."""

SAMPLES = 8
"""Of an element, at which it is looked at for that."""
OVERLAP_HARD = 1e-9
"""Of 1 m and of the largest coordinate: rounding of places, by which a start of hard contact may be below."""
MOST_HARD = 48
"""Points in hard contact of a scene: FU_MOST_HARD_CONTACTS of engine/include/hard_contacts.h."""


def placed_surface(scene: SceneData, surface: Surface) -> Surface:
    """Return the surface, sure to be on the ground or on a rigid body. Raises SceneError."""
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
    """Return the contact complete, sure to be of a cable or body with a surface, apart at the start.

    Raises SceneError.
    """
    if contact.a in scene.surfaces and contact.b not in scene.surfaces:
        contact = contact.model_copy(update={"a": contact.b, "b": contact.a})
    if contact.b not in scene.surfaces:
        raise SceneError(contact.where, f'there is no surface "{contact.b}"',
                         near(contact.b, scene.surfaces) if scene.surfaces else
                         'add one before: scene.surface("ground", fu.Plane())')
    if (other := scene.touching.get((contact.a, contact.b))) is not None:
        where = scene.contacts[other].where
        raise SceneError(contact.where, f'"{contact.a}" and "{contact.b}" have the {where} already',
                         "leave one of them out")
    surface = scene.surfaces[contact.b]
    if contact.a in scene.cables:
        contact = _of_cable(scene, contact, scene.cables[contact.a])
        drawn = scene.cables[contact.a].points_at(scene.cables[contact.a].samples(SAMPLES))
    elif contact.a in scene.bodies:
        contact = _of_body(scene, contact, scene.bodies[contact.a], surface)
        drawn = np.array([scene.bodies[contact.a].point(point) for point in contact.points or ()])
    else:
        raise SceneError(contact.where, f'there is no cable or body "{contact.a}"',
                         near(contact.a, [*scene.cables, *scene.bodies]))
    if contact.is_hard:
        _check_hard_start(scene, contact, surface, drawn)
        return contact
    if contact.exponent != 1.0 and contact.friction_coefficient and contact.tangential_stiffness is None:
        raise SceneError(contact.where, "tangential_stiffness is missing, which the stiffness of the exponent 1.5 is "
                         "not", "give it, in N/m (a length of a cable)")
    _check_start(scene, contact, surface, drawn)
    return contact


def _of_cable(scene: SceneData, contact: Contact, cable: Cable) -> Contact:
    if contact.is_hard:
        raise SceneError(contact.where, f'hard contact is of points of bodies, and "{cable.name}" is a cable',
                         "leave restitution out and give stiffness, in N/m a length")
    if contact.points is not None:
        raise SceneError(contact.where, f'acts along cable "{cable.name}" and takes no points', "leave points out")
    radius = outer_radius_of(cable.section) if contact.radius is None else contact.radius
    if radius is None:
        raise SceneError(contact.where, "radius is missing, which the section of the cable does not tell",
                         "give radius, in m: how far the surface is from the axis where they touch")
    return _with_stiffness(scene, contact, radius)


def _of_body(scene: SceneData, contact: Contact, body: RigidBody | ModalBody, surface: Surface) -> Contact:
    if isinstance(body, ModalBody):
        raise SceneError(contact.where, f'modal_body "{body.name}" cannot touch surfaces', "take a rigid body")
    if surface.on == body.name:
        raise SceneError(contact.where, f'surface "{surface.name}" is on that body itself', "name another one")
    points = contact.points if contact.points is not None else ((0.0, 0.0, 0.0),)
    if contact.is_hard:
        return contact.completed({"points": points, "radius": contact.radius or 0.0})
    made = _with_stiffness(scene, contact, 0.0 if contact.radius is None else contact.radius)
    return made.completed({"points": points})


def _weight(scene: SceneData, contact: Contact) -> float:
    """Return the weight of what has the contact: of a length of a cable, in N/m, or of a body, in N."""
    cable = scene.cables.get(contact.a)
    mass = scene.bodies[contact.a].mass if cable is None else cable.material.density * cable.section.area
    return mass * float(np.linalg.norm(scene.gravity))


def _with_stiffness(scene: SceneData, contact: Contact, radius: float) -> Contact:
    """Return the contact with its radius and, where none is given, the stiffness that the weight asks for."""
    found: dict[str, Any] = {"radius": radius}
    if contact.stiffness is None:
        weight = _weight(scene, contact)
        if not weight > 0 or not radius > 0:
            lacks = "gravity" if not weight > 0 else "a radius"
            raise SceneError(contact.where, f"stiffness is missing, and without {lacks} there is none to begin with",
                             "give stiffness, in N/m (a length of a cable)")
        found["stiffness"] = weight / (SUNK * radius) ** contact.exponent
    return contact.completed(found)


def _check_hard_start(scene: SceneData, contact: Contact, surface: Surface, drawn: np.ndarray) -> None:
    """Raise SceneError where a point with a hard contact starts below the surface, or there are too many points."""
    n = len(drawn) + sum(len(other.points or ()) for other in scene.contacts.values() if other.is_hard)
    if n > MOST_HARD:
        raise SceneError(contact.where, f"the scene has {n} points in hard contact, and {MOST_HARD} are the most",
                         "give some of the contacts stiffness in place of restitution")
    if contact.radius and isinstance(surface.shape, HeightField):
        raise SceneError(contact.where, "a height field tells distances where they are nil: hard contact with it is of "
                         "points without radius", "leave radius out, or give stiffness in place of restitution")
    _check_depth(scene, contact, surface, drawn, OVERLAP_HARD * (1 + np.abs(drawn).max()),
                 ": a hard contact has no depth")


def _check_start(scene: SceneData, contact: Contact, surface: Surface, drawn: np.ndarray) -> None:
    """Raise SceneError where a start is too deep below the surface, by more than a radius allows, or what it sinks."""
    assert contact.radius is not None and contact.stiffness is not None, f"{contact.where} is not complete"
    sinks = (_weight(scene, contact) / contact.stiffness) ** (1 / contact.exponent)
    allowed = max(OVERLAP * contact.radius, 10 * sinks)
    _check_depth(scene, contact, surface, drawn, allowed, f"; {show(float(allowed), 'm')} is allowed")


def _normal(scene: SceneData) -> np.ndarray | None:
    """Return the unit vector (3,) across the plane of a planar scene, None in space."""
    if scene.dim == 3:
        return None
    return np.array([0.0, 0.0, 1.0]) if scene.plane is None else scene.plane.normal


def _check_depth(scene: SceneData, contact: Contact, surface: Surface, drawn: np.ndarray, allowed: float,
                 why: str) -> None:
    """Raise SceneError where one of the points drawn (n, 3) is deeper below the surface than is allowed, in m."""
    depth = (contact.radius or 0.0) - surface.distance(scene.bodies.get(surface.on or ""), drawn, _normal(scene))
    k = int(np.argmax(depth))
    if depth[k] > allowed:
        raise SceneError(
            contact.where, f'"{contact.a}" starts {show(float(depth[k]), "m")} below the surface "{contact.b}", at '
            f"{show(drawn[k], 'm')}", f"draw it higher, or the surface lower{why}")
