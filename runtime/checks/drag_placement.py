"""Checks of fluids and drags against their scene."""

from __future__ import annotations

from collections.abc import Callable, Iterable

import numpy as np

from ..errors import SceneError, near
from ..parts.cable import Cable
from ..parts.drag import OF_BODY, OF_CABLE, OF_MASS, OF_ROPE, Drag
from ..parts.fluid import NO_SURFACE, Fluid
from ..parts.locations import point_of
from ..parts.rope import Rope
from ..parts.scene_data import SceneData
from ..parts.stretches import overlap
from ..parts.validation import LENGTH_TOLERANCE, show
from ..parts.velocity_table import VelocityTable
from .frames import draws_section
from .ice_placement import check_beside_ice
from .placement import check_between, check_has_mass, placed_attachment

PLACES = 65
"""Number of points of a cable that are checked."""


def placed_drag(scene: SceneData, drag: Drag) -> Drag:
    """Return the drag complete, checked to have an effect. Raises SceneError."""
    drag = drag.completed({"fluid": _fluid(scene, drag)})
    _check_surfaces(scene, drag)
    if drag.on in scene.cables:
        _check_cable(scene, drag)
        cable = scene.cables[drag.on]
        _check_table(scene, drag, lambda: cable.points_at(np.linspace(0, cable.length, PLACES)))
        return drag
    if (rope := scene.ropes.get(drag.on)) is not None:
        _check_rope(scene, drag, rope)
        points = [point for span in scene.route_of(rope).spans for point in (span.start, span.end)]
        _check_table(scene, drag, lambda: np.array([[*point, 0.0][:3] for point in points]))
        return drag
    mass = scene.point_masses.get(drag.on)
    end = drag.attachment(scene.point_masses)
    placed = placed_attachment(scene, end, drag.where)
    _refuse(drag, "body" if mass is None else "point_mass")
    if mass is None:
        _check_foil(scene, drag)
    elif isinstance(drag.added_mass, tuple):
        raise SceneError(drag.where, f"acts on {mass.where}, whose added_mass is one number",
                         "give that of a sphere, 0.5, or take a rigid body on a joint")
    acts = drag.area * (drag.drag_coefficient or drag.lift) != 0 or (drag.area != 0 and drag.polar is not None)
    if not acts and drag.volume == 0:
        raise SceneError(drag.where, "has neither drag nor buoyancy", "give an area with a coefficient, or a volume")
    _check_added_mass(drag, drag.volume, "volume, in m³")
    _check_table(scene, drag, lambda: point_of(scene, placed)[None])
    return drag.completed({"at": placed.at})


def _check_table(scene: SceneData, drag: Drag, places_of: Callable[[], np.ndarray]) -> None:
    """Raise SceneError where a drag starts outside of the table of its fluid; places_of: returns points (n, 3), m."""
    for fluid in scene.fluids_of(drag):
        if fluid.table is not None:
            places = fluid.nearest(places_of(), scene.up, scene.fluids.values())
            _check_in_table(drag, fluid, fluid.table, places)


def _check_in_table(drag: Drag, fluid: Fluid, table: VelocityTable, places: np.ndarray) -> None:
    margin, axis = table.margin(np.zeros(len(places)), places)
    if margin < -LENGTH_TOLERANCE:
        values = table.grid.axes[axis]
        at = 0.0 if axis == "time" else float(max(places[:, "xyz".index(axis)], key=lambda x: abs(x - values.mean())))
        unit = "s" if axis == "time" else "m"
        raise SceneError(drag.where, f'begins at {axis} = {show(at, unit)}, outside of the table of {fluid.where}, '
                         f"which goes from {show(float(values[0]), unit)} to {show(float(values[-1]), unit)}",
                         "take a larger table, or leave out what the velocity does not depend on")


MAX_STEEPNESS = 1 / 7
"""Height over length of the steepest wave; times tanh(k depth) in water of a depth (Miche 1944)."""
MAX_URSELL = 26.0
"""Height length²/depth³ up to which linear waves are long enough (Hedges 1995: 40 between Stokes' and cnoidal)."""


def _check_waves(scene: SceneData, fluid: Fluid) -> None:
    """Raise SceneError for waves that the linear theory does not have, in the gravity of a scene."""
    if not any(scene.gravity):
        raise SceneError(fluid.where, "has waves, in a scene without gravity", "give the scene gravity")
    for wave, k in zip(fluid.waves or (), fluid.wave_numbers(float(np.linalg.norm(scene.gravity))), strict=True):
        length, height = 2 * np.pi / k, 2 * wave.amplitude
        who = (f"the wave of {show(wave.period, 's')} has the height {show(height, 'm')} and the length "
               f"{show(length, 'm')}")
        if abs(wave.ahead @ scene.up) > 1e-9:
            raise SceneError(fluid.where, f"a wave runs along {show(wave.direction)}, which is not level",
                             "give a direction square to gravity")
        limit = MAX_STEEPNESS * (1.0 if fluid.depth is None else float(np.tanh(k * fluid.depth)))
        if height > limit * length:
            raise SceneError(fluid.where, f"{who}: it breaks, at {limit:.3g} of the length", "take a smaller amplitude")
        if fluid.depth is not None and height * length**2 > MAX_URSELL * fluid.depth**3:
            number = height * length**2 / fluid.depth**3
            raise SceneError(fluid.where, f"{who}, too long for the linear theory in a depth of "
                             f"{show(fluid.depth, 'm')}: its Ursell number is {number:.3g}, over {MAX_URSELL:.0f}",
                             "take a smaller amplitude, or a table of velocities")
    if drag := next((each for each in scene.drags.values() if each.on in scene.ropes), None):
        raise SceneError(fluid.where, *_beside_rope(drag))


def _beside_rope(drag: Drag) -> tuple[str, str]:
    """Return cause and remedy for waves beside a drag on a rope, whose material flows past its points."""
    return (f'has waves, and the {drag.where} is on rope "{drag.on}", whose equations have a surface at rest',
            "take a cable, or leave waves out")


def _check_alone_with_waves(fluid: Fluid, fluids: Iterable[Fluid]) -> None:
    """Raise SceneError for waves beside another surface."""
    for other in (each for each in fluids if each.surface is not None and each.name != fluid.name):
        if fluid.surface is not None and (fluid.waves or other.waves):
            raise SceneError(fluid.where, f"has a surface beside that of the {other.where}, and one of them has waves",
                             "leave waves out, or one of the surfaces")


def placed_fluid(scene: SceneData, fluid: Fluid) -> Fluid:
    """Return the fluid, checked to share no surface with another one, and to suit the drags. Raises SceneError."""
    fluids = list(scene.fluids.values())
    if fluid.waves is not None:
        _check_waves(scene, fluid)
    _check_alone_with_waves(fluid, fluids)
    if fluid.surface is None:
        if other := next((each for each in fluids if each.surface is None), None):
            for drag in (each for each in scene.drags.values() if each.fluid is None):
                raise SceneError(fluid.where, f"fills the same place as the {other.where}, and the {drag.where} is in "
                                 "all fluids", "give one of them a surface, or name the fluid of the drag")
        return fluid
    if other := next((each for each in fluids if each.surface == fluid.surface), None):
        raise SceneError(fluid.where, f"has its surface at {show(fluid.surface, 'm')}, as the {other.where} has",
                         "two fluids cannot fill the same place: give another level")
    for drag in scene.drags.values():
        if any(each.top > fluid.top for each in scene.fluids_of(drag)):
            _check_cut(scene, drag)
    return fluid


def _check_surfaces(scene: SceneData, drag: Drag) -> None:
    """Raise SceneError where a surface may cut a section whose wet part is not known."""
    if any(fluid.surface is not None or fluid.bottom(scene.fluids.values()) > -NO_SURFACE
           for fluid in scene.fluids_of(drag)):
        _check_cut(scene, drag)


def _check_cut(scene: SceneData, drag: Drag) -> None:
    if drag.polar is not None and drag.on in scene.cables:
        raise SceneError(drag.where, f'has a polar on cable "{drag.on}", in a fluid with a surface: the wet part of a '
                         "section that turns is not known", "take normal and lift, or leave surface out")


def _fluid(scene: SceneData, drag: Drag) -> str | None:
    """Return the name of the fluid that a drag is in; None: it is in all of them."""
    if drag.fluid is None and len(scene.fluids) == 1:
        return next(iter(scene.fluids))
    if drag.fluid is None:
        everywhere = [name for name, fluid in scene.fluids.items() if fluid.surface is None]
        if not scene.fluids:
            raise SceneError(drag.where, "needs a fluid, of which the scene has none",
                             "add one before: scene.fluid(density=...)")
        if len(everywhere) > 1:
            raise SceneError(drag.where, f"needs a fluid, of which the scene has {len(scene.fluids)}, and "
                             f"{', '.join(everywhere)} fill the same place",
                             "name it with fluid, or give them surfaces")
        return None
    if drag.fluid not in scene.fluids:
        raise SceneError(drag.where, f'there is no fluid "{drag.fluid}"', near(drag.fluid, scene.fluids))
    return drag.fluid


def _are_apart(scene: SceneData, one: Drag, other: Drag) -> bool:
    """Return whether surfaces separate the fluids of two drags."""
    tops = {fluid.top for drag in (one, other) for fluid in scene.fluids_of(drag)}
    return len(tops) > 1


def _check_cable(scene: SceneData, drag: Drag) -> None:
    """Raise SceneError for a drag that its cable does not admit."""
    _refuse(drag, "cable")
    cable = scene.cables[drag.on]
    check_between(scene, drag, drag.on)
    _check_added_mass_of_line(drag, cable)
    _check_alone(scene, drag, cable)
    if drag.lift != 0 and cable.dim == 2:
        raise SceneError(drag.where, f'lift of cable "{drag.on}" leaves the plane of its element {cable.element}',
                         "take a spatial element, or leave lift out")
    _check_section(drag, cable)
    _check_acts(drag, cable)
    check_beside_ice(scene, drag, drag.on)


def _check_rope(scene: SceneData, drag: Drag, rope: Rope) -> None:
    """Raise SceneError for a drag that its rope does not admit."""
    check_has_mass(rope, drag.where)
    if drag.polar is not None:
        raise SceneError(drag.where, f'acts on rope "{rope.name}", and has a polar, but its sections have no rotation',
                         "give normal and lift")
    _refuse(drag, "rope")
    _check_added_mass_of_line(drag, rope)
    _check_alone(scene, drag, rope)
    if waving := next((fluid for fluid in scene.fluids.values() if fluid.waves is not None), None):
        raise SceneError(waving.where, *_beside_rope(drag))
    if drag.lift != 0 and rope.dim == 2:
        raise SceneError(drag.where, f'lift of rope "{rope.name}" leaves the plane of its element {rope.element}',
                         'take element="cable12", or leave lift out')
    _check_acts(drag, rope)


def _check_alone(scene: SceneData, drag: Drag, line: Cable | Rope) -> None:
    """Raise SceneError where a cable or a rope has another drag in the same fluid, and on the same elements."""
    if other := next((each for each in scene.drags.values() if each.on == drag.on
                      and overlap((each.start, each.stop), (drag.start, drag.stop))
                      and (None in (each.fluid, drag.fluid) or each.fluid == drag.fluid
                           or not _are_apart(scene, each, drag))), None):
        raise SceneError(drag.where, f'{line.where} has the {other.where} already', "leave one of them out"
                         + ", or give them start and stop" * isinstance(line, Cable))


def _check_acts(drag: Drag, line: Cable | Rope) -> None:
    """Raise SceneError for a drag without an effect on a cable or a rope, or without a diameter."""
    if drag.normal == 0 and drag.tangential == 0 and drag.lift == 0 and drag.polar is None:
        if drag.displaced(line.uniform_pieces[0].section) == 0:
            raise SceneError(drag.where, "has neither drag nor buoyancy", "give normal, tangential or displaced_area")
        return
    try:
        drag.stretches(line)
    except ValueError as error:
        raise SceneError(drag.where, str(error), "give diameter, in m: the width across the flow") from None


def _check_section(drag: Drag, cable: Cable) -> None:
    """Raise SceneError for a polar that the sections of its cable do not admit, or with a second coefficient."""
    if drag.polar is None:
        _refuse_chord(drag)
        return
    if cable.dim == 2:
        raise SceneError(drag.where, f'has a polar, and cable "{drag.on}" has the planar element {cable.element}, '
                         "past whose sections a fluid flows only along their height", "take the element beam24")
    if not draws_section(cable):
        raise SceneError(drag.where, f'has a polar, and cable "{drag.on}" has the element {cable.element} '
                         "without rotation of its section", "take the element beam24, or normal and lift")
    for name in ("normal", "lift"):
        if getattr(drag, name) != 0:
            raise SceneError(drag.where, f"has a polar and {name}",
                             "leave it out: the polar has all coefficients except tangential")
    if drag.chord is None:
        raise SceneError(drag.where, "chord is missing, from which the polar counts its angle",
                         "give chord, a direction across the axis in local axes: (0, 1, 0) is the section's height")
    if abs(drag.foil_axes[1][0]) > 1e-6:
        raise SceneError(drag.where, f"chord must be square to the axis of the cable, x, got {show(drag.chord)}",
                         "give a direction in local axes: y is the section's height, z its width")


def _refuse_chord(drag: Drag) -> None:
    """Raise SceneError for a chord without a polar."""
    if drag.chord is not None:
        raise SceneError(drag.where, "chord is given without a polar", "give polar, or leave chord out")


def _check_foil(scene: SceneData, drag: Drag) -> None:
    """Raise SceneError for lift of a body without its axes, or with a second coefficient."""
    if drag.polar is None:
        _refuse_chord(drag)
        if drag.lift == 0 and drag.span is not None:
            raise SceneError(drag.where, "span is given without lift or a polar", "give one of them, or leave span out")
    elif drag.lift != 0 or drag.coefficient is not None:
        raise SceneError(drag.where, "has a polar and " + ("lift" if drag.lift else "a coefficient"),
                         "leave it out: the polar has both coefficients")
    elif drag.chord is None:
        raise SceneError(drag.where, "chord is missing, from which the polar counts its angle",
                         "give chord, a direction in body axes")
    if drag.polar is None and drag.lift == 0:
        return
    if drag.polar is not None and drag.polar.moment is not None:
        raise SceneError(drag.where, f'acts on body "{drag.on}", and its polar has a moment, which only beams take',
                         "leave it out, and place the drag where the moment is zero")
    if drag.area == 0:
        raise SceneError(drag.where, "has lift without an area", "give area, in m²")
    if drag.span is None and scene.dim == 3:
        raise SceneError(drag.where, "span is missing, across which lift acts", "give span, a direction in body axes")
    span, chord = drag.foil_axes
    if abs(span @ chord) > 1e-6:
        raise SceneError(drag.where, f"chord must be square to span, got {show(drag.chord or ())} and "
                         f"{show(drag.span or (0, 0, 1))}", "turn one of them")


def _check_added_mass(drag: Drag, displaced: float, name: str) -> None:
    """Raise SceneError for added mass without a displaced volume; name: of the entry for this volume."""
    if drag.added_mass is None and drag.added_mass_tangential:
        raise SceneError(drag.where, "added_mass_tangential is given without added_mass",
                         "give added_mass, that across the cable: 1 for a round one, 0 for none")
    if drag.added_mass is None and drag.added_mass_form != Drag.model_fields["added_mass_form"].default:
        raise SceneError(drag.where, "added_mass_form is given without added_mass",
                         "give added_mass: 0 for the acceleration of the fluid alone")
    if drag.added_mass is not None and displaced == 0:
        raise SceneError(drag.where, "added_mass is a multiple of the displaced mass, which is zero",
                         f"give {name}")


def _check_added_mass_of_line(drag: Drag, line: Cable | Rope) -> None:
    """Raise SceneError for added mass that a cable or a rope does not take."""
    _check_added_mass(drag, drag.displaced(line.uniform_pieces[0].section), "displaced_area, in m²")
    if isinstance(drag.added_mass, tuple):
        raise SceneError(drag.where, f"acts on {line.where}, whose added_mass is one number",
                         "give that across the axis, and added_mass_tangential along it")


def _refuse(drag: Drag, kind: str) -> None:
    """Raise SceneError for values that a drag on this kind of part, a body of either kind as "body", does not take."""
    defaults = {name: field.default for name, field in Drag.model_fields.items()}
    takes = {"cable": OF_CABLE, "rope": OF_ROPE, "body": OF_BODY, "point_mass": OF_MASS}[kind]
    for name in (name for name in OF_BODY + OF_CABLE if name not in takes):
        if getattr(drag, name) != defaults[name]:
            raise SceneError(drag.where, f'acts on {kind} "{drag.on}" and takes no {name}', f"takes {', '.join(takes)}")
