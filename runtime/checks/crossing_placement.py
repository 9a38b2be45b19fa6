"""Checks of crossings against their scene."""

from __future__ import annotations

import numpy as np

from ..errors import SceneError, near
from ..parts.attachment import Attachment
from ..parts.crossing import Crossing
from ..parts.crossing_start import Start, radii, sign_of, start_of
from ..parts.modal_body import ModalBody
from ..parts.scene_data import OfDrawing, SceneData
from ..parts.validation import LENGTH_TOLERANCE, show
from .ice_placement import check_beside_ice
from .placement import check_without_hinge, placed_attachment, report

MIN_CROSSING_SINE = 1e-3
"""Sine of the angle between lines as drawn below which their closest points are not those of a crossing."""


def placed_crossing(scene: SceneData, part: Crossing) -> Crossing:
    """Return the crossing complete, checked to be of lines that cross and are apart. Raises SceneError."""
    if part.a not in scene.cables:
        raise SceneError(part.where, f'there is no cable "{part.a}"', near(part.a, scene.cables))
    if part.b in scene.cables:
        _check_cables(scene, part)
    else:
        part = _placed_bar(scene, part)
    for name in (part.a, part.b or ""):
        if name in scene.cables:
            check_without_hinge(part.where, scene.cables[name])
            check_beside_ice(scene, part, name)
    try:
        radius = radii(scene, part)
    except ValueError as error:
        raise SceneError(part.where, str(error), "give radius, in m: the distance of the axes at contact") from None
    _check_start(scene, part, start_of(scene, part), radius)
    return part


def _check_cables(scene: SceneData, part: Crossing) -> None:
    """Raise SceneError where two cables cannot cross, or the part has fields of a bar."""
    given = [name for name in ("at", "axis", "length") if getattr(part, name) is not None]
    if given:
        raise SceneError(part.where, f'{given[0]} is given, but b is the cable "{part.b}"', "leave it out")
    if scene.dim == 2:
        raise SceneError(part.where, "two planar cables lie in one plane and do not cross",
                         "draw them with spatial elements")


def _placed_bar(scene: SceneData, part: Crossing) -> Crossing:
    """Return a crossing with a bar that is complete. Raises SceneError."""
    if part.b is not None and part.b not in scene.bodies:
        raise SceneError(part.where, f'there is no cable or body "{part.b}"',
                         near(part.b, [*scene.cables, *scene.bodies]))
    if part.b is None and part.at is None:
        raise SceneError(part.where, "needs b, a cable or a body, or at, the middle of a bar on the ground")
    given = [name for name in ("axis", "length") if getattr(part, name) is not None]
    if scene.dim == 2 and given:
        raise SceneError(part.where, f"{given[0]} is given, but in the plane a bar is square to it", "leave it out")
    if scene.dim == 3 and len(given) < 2:
        missing = "axis" if part.axis is None else "length"
        raise SceneError(part.where, f"{missing} of the bar is missing",
                         "give axis, its direction in the axes of what carries it, and length, to each side, in m")
    if scene.dim == 3 and isinstance(scene.bodies.get(part.b or ""), ModalBody):
        raise SceneError(part.where, f'modal_body "{part.b}" carries no bars in space', "weld a rigid body to it")
    placed = placed_attachment(scene, Attachment(on=part.b, at=part.at), part.where)
    return part.completed({"at": placed.at})


def _check_start(scene: SceneData, part: Crossing, start: Start, radius: float) -> None:
    """Raise SceneError where lines are parallel, meet, or overlap as drawn."""
    if start.sine < MIN_CROSSING_SINE:
        raise SceneError(part.where, "the lines are parallel where they are closest as drawn",
                         "draw them at an angle: a crossing has one point of contact")
    size = scene.cables[part.a].length
    gap = float(np.dot(start.d, start.normal))
    if part.side is None and abs(gap) <= LENGTH_TOLERANCE * size:
        place = scene.cables[part.a].point(float(start.s[0]))
        raise SceneError(part.where, f"the lines meet as drawn, at {show(place, 'm')}",
                         "give side, the direction in which a is of b, or draw them apart")
    if part.side is not None and abs(np.dot(part.side, start.normal)) < MIN_CROSSING_SINE * np.linalg.norm(part.side):
        raise SceneError(part.where, f"side {show(part.side)} is not across both lines",
                         f"give a direction such as {show(start.normal)} or its opposite")
    overlap = radius - gap * sign_of(part, start.normal, start.d)
    if overlap > 2 * radius + LENGTH_TOLERANCE * size:
        raise SceneError(part.where, f"the lines are on the other side of each other as drawn, {abs(gap):.6g} m apart",
                         "draw them on their side, or give the opposite side")
    if overlap > LENGTH_TOLERANCE * size and np.linalg.norm(start.d) < radius:  # else past an end
        message = (f"{part.where}: the lines overlap by {overlap:.6g} m as drawn, where the contact force is "
                   f"{part.stiffness * overlap**part.exponent:.4g} N; draw them apart, or start with "
                   'initial="equilibrium"')
        report(scene, OfDrawing(message))
