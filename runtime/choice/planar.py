"""Spatial scenes that stay in a plane, and the same scenes of planar elements.

A scene that is symmetric about a plane has a motion in that plane. Planar elements have the same motion with at most
two thirds of the unknowns. They do not show the effect of small disturbances out of the plane, such as lateral
buckling.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Generic

import numpy as np

from ..errors import SceneError
from ..kernels.libraries import of_library
from ..parts.cable import Cable
from ..parts.in_plane import into_plane
from ..parts.load import DistributedForce, Force
from ..parts.part import Part
from ..parts.plane import Plane, aligned, called, normal_of
from ..parts.rigid_body import RigidBody
from ..parts.scene_data import SceneData
from ..parts.section import GeneralSection, Rectangle, Section
from ..parts.support import Tie
from ..parts.validation import show
from .remeshing import S

PARALLEL_SINE = 1e-9
"""Sine of the angle up to which directions count as parallel."""


@dataclass(frozen=True)
class Planar(Generic[S]):
    """A scene of planar elements with the motion of a spatial one, or the reasons against it.

    scene: of planar elements, None where there is none; reasons: parts that leave the plane or differ there, a line
    each; elements: the planar element of each cable; plane: the plane of the scene, None for z = 0.
    """

    scene: S | None
    reasons: tuple[str, ...] = ()
    elements: tuple[tuple[str, str], ...] = ()
    plane: Plane | None = None

    def __str__(self) -> str:
        """Return the result in a line."""
        if self.scene is None:
            return "the scene is spatial: " + "; ".join(self.reasons)
        changed = ", ".join(f"{name} of {element}" for name, element in self.elements)
        return (f"the scene stays in {called(self.plane)}: {changed}; motion out of the plane, such as lateral "
                "buckling, is not in it")


def planar_of(scene: S) -> Planar[S]:
    """Return the scene with planar elements in place of spatial ones, where it has the same motion.

    Within rounding this holds for cable elements, for beams with the structural law, and for beams of the other laws
    with a Poisson ratio of 0.
    """
    if not scene.cables or scene.dim == 2:
        return Planar(None, ("it has no cables of spatial elements",))
    found = _planar_in(scene, None)
    if found.scene is None and (plane := likely_plane(scene)) is not None:
        return _planar_in(scene, plane)
    return found


def _planar_in(scene: S, plane: Plane | None) -> Planar[S]:
    """Return the scene with planar elements in a plane, None for z = 0."""
    try:
        flat = scene if plane is None else into_plane(scene, plane)
    except SceneError as error:
        return Planar(None, (str(error),))
    pairs = list(zip(scene.parts(), flat.parts(), strict=True))
    following = {id(given): own for given, seen in pairs if isinstance(seen, Force | DistributedForce)
                 and (own := _on_planar_cable(flat, seen)) is not seen}
    reasons = [f"gravity {show(scene.gravity, 'm/s²')} leaves {called(plane)}"] if flat.gravity[2] else []
    for given, seen in pairs:
        found = _reasons(flat, following.get(id(given), seen), called(plane))
        reasons += [f"{given.where}: {reason}" for reason in found]
    if reasons:
        return Planar(None, tuple(reasons))
    try:
        made = scene.with_parts(_planar(part, seen, plane, following) for part, seen in pairs)
    except SceneError as error:
        return Planar(None, (str(error),))
    return Planar(made, (), tuple((name, cable.element) for name, cable in made.cables.items()), plane)


def likely_plane(scene: SceneData) -> Plane | None:
    """Return the only plane that a scene can lie in; None for z = 0, and where it is not determined.

    With its normal, the first cable's ``up`` is the side of the height of planar elements.
    """
    cables = list(scene.cables.values())
    start = np.array(cables[0].drawn_through[0])
    forces = [load.value for load in scene.loads.values() if isinstance(load, Force | DistributedForce)
              and not load.follower]
    groups = [np.concatenate([np.array(cable.drawn_through) - start for cable in cables]), [scene.gravity],
              [body.frame[0] - start for body in scene.bodies.values()], [cable.velocity for cable in cables],
              [body.velocity for body in scene.bodies.values()], forces, [cables[0].up]]
    normal = normal_of([np.array(group, dtype=float).reshape(-1, 3) for group in groups])
    if normal is None:
        return None
    if np.dot(normal, np.cross(cables[0].axes_at(0.0)[0], cables[0].up)) < 0:
        normal = -normal
    plane = Plane.across(aligned(normal), start)
    return None if abs(plane.normal[2]) == 1.0 and not plane.origin.any() else plane


def _on_planar_cable(scene: SceneData, load: Force | DistributedForce) -> Force | DistributedForce:
    """Return a follower force across a cable in the axes of the planar cable; another load as it is.

    The height of a planar cable is z x tangent, whatever ``up`` is. The scene is in the axes of the plane.
    """
    on, s = (load.cable, load.start) if isinstance(load, DistributedForce) else (load.on, load.s)
    if not (load.follower and on in scene.cables and any(load.value[1:])):
        return load
    axes = scene.cables[on].axes_at(s if isinstance(s, float) else 0.0)
    planar = np.array([axes[0], np.cross((0.0, 0.0, 1.0), axes[0]), (0.0, 0.0, 1.0)])
    return load.model_copy(update={"value": tuple(aligned(planar @ axes.T @ load.value).tolist())})


def _planar(part: Part, seen: Part, plane: Plane | None, following: Mapping[int, Part]) -> Part:
    """Return a part of the planar scene; seen: the part in the axes of the plane; following: turned loads by id."""
    if not isinstance(part, Cable) or not isinstance(seen, Cable):
        return following.get(id(part), part)
    if plane is None:
        return planar_cable(part)
    height = np.cross((0.0, 0.0, 1.0), seen.axes_at(0.0)[0])
    made = planar_cable(seen)
    sections = {name: value for name, value in made.entries().items() if name in ("section", "pieces")}
    return Cable(**part.entries() | sections | {"element": made.element, "up": tuple(plane.out(height).tolist())})


def planar_element(cable: Cable) -> str | None:
    """Return the planar element with the same nodal vectors in the plane; None where there is none."""
    own = cable.kind_of_element
    left = tuple(vector for vector in own.nodal_vectors if vector != "r_z")
    return next((name for name, kind in of_library(cable.library).items()
                 if kind.dim == 2 and kind.nodal_vectors == left and kind.is_cable == own.is_cable), None)


def planar_cable(cable: Cable) -> Cable:
    """Return the cable of planar elements. Raises SceneError, and ValueError where it has no planar form."""
    entries = {name: value for name, value in cable.entries().items() if name != "up"}
    if not _height_is_in_plane(cable):
        entries |= ({"section": turned(cable.section)} if cable.pieces is None else
                    {"pieces": [piece.remade({"section": turned(piece.section)}) for piece in cable.pieces]})
    return Cable(**entries | {"element": planar_element(cable)})


def turned(section: Section) -> Section | None:
    """Return the section with height and width exchanged; None where its kind does not define them."""
    if isinstance(section, Rectangle):
        entries = section.entries() | {"height": section.width, "width": section.height}
        if "shear_factors" in entries:
            entries["shear_factors"] = entries["shear_factors"][::-1]
        return Rectangle(**entries)
    return None if isinstance(section, GeneralSection) else section


def _height_is_in_plane(cable: Cable) -> bool:
    """Return whether the height of the section lies in the plane z = 0 all along."""
    return not np.any(cable.axes_at(cable.node_s)[:, 1, 2])


def _reasons(scene: SceneData, part: Part, plane: str) -> Iterator[str]:
    """Yield the features of a part, in the axes of the plane, that leave it or differ in planar elements."""
    for what in part.off_plane():
        yield f"{what} leaves {plane}" + ", in whose axes it is" * (scene.plane_axes is not None)
    if isinstance(part, Cable):
        yield from _reasons_of_cable(part, plane)
    elif isinstance(part, RigidBody):
        (_, _, xz), (_, _, yz), _ = part.inertia
        if xz or yz:
            yield f"its products of inertia {show((xz, yz), 'kg m²')} with z turn it out of the plane"
    elif isinstance(part, Tie) and part.rotation == "rigid" and not _is_in_line(scene, part):
        yield "a rigid corner of spatial elements is softer than that of planar ones"


def _reasons_of_cable(cable: Cable, plane: str) -> Iterator[str]:
    """Yield the features of a cable that leave the plane or differ in planar elements."""
    if np.any(cable.nodal_vectors[:, 0, 2]) or np.any(cable.rest_nodal_vectors[:, 0, 2]):
        yield f"its line leaves {plane}"
        return
    if cable.velocity[2] or cable.angular_velocity[0] or cable.angular_velocity[1]:
        yield f"its velocity leaves {plane}"
    if planar_element(cable) is None:
        yield f"{cable.element} has no planar form"
        return
    ratio = max((piece.material.poisson_ratio or 0.0 for piece in cable.uniform_pieces), key=abs)
    if not cable.kind_of_element.is_cable and ratio and cable.stiffness_law != "structural":
        yield (f'the law "{cable.law}" is of three-dimensional stress in {cable.element}, of plane stress in '
               f"{planar_element(cable)}, which differ with a Poisson ratio of {ratio:g}")
    if not cable.kind_of_element.is_cable:
        axes = cable.axes_at(cable.node_s)
        if np.any(np.abs(axes[:, 1, 2] * axes[:, 2, 2]) > PARALLEL_SINE):
            yield f"up is neither in {plane} nor across it: bending leaves the plane"
        elif not _height_is_in_plane(cable) and any(turned(piece.section) is None for piece in cable.uniform_pieces):
            yield f"up lies across {plane}, where the section's width bends: draw its height in the plane"


def _is_in_line(scene: SceneData, tie: Tie) -> bool:
    """Return whether the cables of a tie have the same element, and one tangent at it."""
    one, other = scene.cables[tie.cable], scene.cables[tie.to]
    a, b = one.axes_at(tie.s)[0], other.axes_at(tie.at)[0]
    return one.element == other.element and float(np.linalg.norm(np.cross(a, b))) <= PARALLEL_SINE
