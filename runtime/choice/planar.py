"""Spatial scenes that stay in the plane z = 0, and the same scenes of planar elements.

A scene that the reflection z -> -z leaves as it is has a motion in the plane. Planar elements have that motion, with
two thirds or fewer of the unknowns. What a small disturbance out of the plane would make of it, such as lateral
buckling, they do not show.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Generic

import numpy as np

from ..errors import SceneError
from ..kernels.libraries import of_library
from ..parts.cable import Cable
from ..parts.part import Part
from ..parts.rigid_body import RigidBody
from ..parts.scene_data import SceneData
from ..parts.section import GeneralSection, Rectangle, Section
from ..parts.support import Tie
from ..parts.validation import show
from .remaking import S

ALONG = 1e-9
"""Sine of the angle up to which directions count as parallel."""


@dataclass(frozen=True)
class Planar(Generic[S]):
    """A scene of planar elements with the motion of a spatial one, or why there is none.

    scene: of planar elements, None where the spatial one has another motion or leaves the plane; reasons: what leaves
    the plane, or differs there, a line each; elements: of each cable, the planar element in place of its own.
    """

    scene: S | None
    reasons: tuple[str, ...] = ()
    elements: tuple[tuple[str, str], ...] = ()

    def __str__(self) -> str:
        """Return what was found, in a line."""
        if self.scene is None:
            return "the scene is spatial: " + "; ".join(self.reasons)
        changed = ", ".join(f"{name} of {element}" for name, element in self.elements)
        return (f"the scene stays in the plane z = 0: {changed}; what would leave the plane, such as lateral buckling, "
                "is not in it")


def planar_of(scene: S) -> Planar[S]:
    """Return the scene with planar elements in place of spatial ones, where that has the same motion.

    The motion of a scene in the plane z = 0 is the same, but for rounding, for cable elements, for beams with the
    structural law, and for beams of the other laws with a Poisson ratio of 0.
    """
    if not scene.cables or scene.dim == 2:
        return Planar(None, ("it has no cables of spatial elements",))
    reasons = [f"gravity {show(scene.gravity, 'm/s²')} leaves the plane z = 0"] if scene.gravity[2] else []
    for part in scene.parts():
        reasons += [f"{part.where}: {reason}" for reason in _reasons(scene, part)]
    if reasons:
        return Planar(None, tuple(reasons))
    try:
        made = scene.with_parts(planar_cable(part) if isinstance(part, Cable) else part for part in scene.parts())
    except SceneError as error:
        return Planar(None, (str(error),))
    return Planar(made, (), tuple((name, cable.element) for name, cable in made.cables.items()))


def planar_element(cable: Cable) -> str | None:
    """Return the planar element with the nodal vectors of the cable's own one in the plane; None where there is none.
    """
    own = cable.kind_of_element
    left = tuple(vector for vector in own.nodal_vectors if vector != "r_z")
    return next((name for name, kind in of_library(cable.library).items()
                 if kind.dim == 2 and kind.nodal_vectors == left and kind.is_cable == own.is_cable), None)


def planar_cable(cable: Cable) -> Cable:
    """Return the cable of planar elements. Raises SceneError, and ValueError where it has no planar form."""
    entries = {name: value for name, value in cable.entries().items() if name != "up"}
    section = cable.section if _height_is_in_plane(cable) else turned(cable.section)
    return Cable(**entries | {"element": planar_element(cable), "section": section})


def turned(section: Section) -> Section | None:
    """Return the section with height and width exchanged; None where its kind does not tell."""
    if isinstance(section, Rectangle):
        entries = section.entries() | {"height": section.width, "width": section.height}
        if "shear_factors" in entries:
            entries["shear_factors"] = entries["shear_factors"][::-1]
        return Rectangle(**entries)
    return None if isinstance(section, GeneralSection) else section


def _height_is_in_plane(cable: Cable) -> bool:
    """Return whether the height of the section lies in the plane z = 0 all along, not across it."""
    return not np.any(cable.axes_at(cable.node_s)[:, 1, 2])


def _reasons(scene: SceneData, part: Part) -> Iterator[str]:
    """Yield what of a part leaves the plane, or is another thing in planar elements."""
    for what in part.off_plane():
        yield f"{what} leaves the plane z = 0"
    if isinstance(part, Cable):
        yield from _reasons_of_cable(part)
    elif isinstance(part, RigidBody):
        (_, _, xz), (_, _, yz), _ = part.inertia
        if xz or yz:
            yield f"its products of inertia {show((xz, yz), 'kg m²')} with z turn it out of the plane"
    elif isinstance(part, Tie) and part.rotation == "rigid" and not _is_in_line(scene, part):
        yield "a rigid corner of spatial elements is softer than that of planar ones"


def _reasons_of_cable(cable: Cable) -> Iterator[str]:
    """Yield what of a cable leaves the plane, or is another thing in planar elements."""
    if np.any(cable.nodal_vectors[:, 0, 2]) or np.any(cable.rest_nodal_vectors[:, 0, 2]):
        yield "its line leaves the plane z = 0"
        return
    if cable.velocity[2] or cable.angular_velocity[0] or cable.angular_velocity[1]:
        yield "its velocity leaves the plane z = 0"
    if planar_element(cable) is None:
        yield f"{cable.element} has no planar form"
        return
    if not cable.kind_of_element.is_cable and cable.material.poisson_ratio and cable.stiffness_law != "structural":
        yield (f'the law "{cable.law}" is of three-dimensional stress in {cable.element}, of plane stress in '
               f"{planar_element(cable)}, which differ with a Poisson ratio of {cable.material.poisson_ratio:g}")
    if not cable.kind_of_element.is_cable:
        axes = cable.axes_at(cable.node_s)
        if np.any(np.abs(axes[:, 1, 2] * axes[:, 2, 2]) > ALONG):
            yield "up is neither in the plane z = 0 nor across it: bending leaves the plane"
        elif not _height_is_in_plane(cable) and turned(cable.section) is None:
            yield "up lies across the plane z = 0, where the section's width bends: draw its height in the plane"


def _is_in_line(scene: SceneData, tie: Tie) -> bool:
    """Return whether the cables of a tie have the same element, and one tangent at it."""
    one, other = scene.cables[tie.cable], scene.cables[tie.to]
    a, b = one.axes_at(tie.s)[0], other.axes_at(tie.at)[0]
    return one.element == other.element and float(np.linalg.norm(np.cross(a, b))) <= ALONG
