"""Notes on numbers that suggest other units, and on missing contacts."""

from __future__ import annotations

import math
from collections.abc import Iterator

from ..parts.cable import Cable
from ..parts.material import Material
from ..parts.rope import Rope
from ..parts.scene_data import SceneData
from ..parts.solids import Solid
from ..parts.validation import show

MODULI = 1e3, 2e12
"""Range of moduli, Pa: soft gels have 1e3, diamond 1.1e12."""
DENSITIES = 20.0, 2.5e4
"""Range of densities, kg/m³: foams have 20, osmium 22,600."""
WAVE_SPEED = 2.5e4
"""Bound of the speed of axial waves, sqrt(E / density), m/s; diamond has 18,000."""
GRAVITY = 300.0
"""Bound of gravity, m/s², above that of the Sun."""


def implausible(scene: SceneData) -> list[str]:
    """Return notes on numbers that do not look like SI, on surfaces without contact, and on bodies with a shape whose
    only point of contact is the origin.
    """
    return [*_gravity(scene), *_materials(scene), *_surfaces(scene), *_origins(scene)]


def _surfaces(scene: SceneData) -> Iterator[str]:
    in_contact = {contact.b for contact in scene.contacts.values()}
    yield from (f"{surface.where} has no contact and exerts no force; add scene.contact(..., \"{name}\")"
                for name, surface in scene.surfaces.items() if name not in in_contact)


def _origins(scene: SceneData) -> Iterator[str]:
    if not scene.contacts:
        return
    shaped = {name for name, body in scene.bodies.items() if isinstance(getattr(body, "shape", None), Solid)}
    shaped |= {surface.on for surface in scene.surfaces.values() if surface.on}
    yield from (f"{contact.where} acts at the origin of \"{contact.a}\" alone, not on the surface of that "
                "body: give points=, such as corners of a box, or a radius= about them"
                for contact in (each.as_made() for each in scene.contacts.values())
                if contact.a in shaped and contact.points is None and not contact.radius)


def _gravity(scene: SceneData) -> Iterator[str]:
    size = math.hypot(*scene.gravity)
    if size > GRAVITY:
        yield f"gravity is {show(size, 'm/s²')}: is it in m/s², and are all lengths in m?"


def _materials(scene: SceneData) -> Iterator[str]:
    parts: list[Cable | Rope] = [*scene.cables.values(), *scene.ropes.values()]
    for part in parts:
        materials = list(dict.fromkeys(piece.material for piece in part.uniform_pieces))
        yield from (f"{part.where}: {note}" for material in materials for note in _material(material))


def _material(material: Material) -> Iterator[str]:
    modulus, density = material.youngs_modulus, material.density
    if not MODULI[0] <= modulus <= MODULI[1]:
        yield f"youngs_modulus is {show(modulus, 'Pa')}: is it in Pa? Steel has 2e11, rubber 1e6"
    if not DENSITIES[0] <= density <= DENSITIES[1]:
        yield f"density is {show(density, 'kg/m³')}: is it in kg/m³? Steel has 7850, water 1000"
    elif (speed := (modulus / density) ** 0.5) > WAVE_SPEED:
        yield (f"youngs_modulus {show(modulus, 'Pa')} and density {show(density, 'kg/m³')} make axial waves of "
               f"{speed:.3g} m/s, steel has 5200: are they in Pa and kg/m³?")
