"""Models of fluids and of drag in them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import field
from itertools import pairwise
from typing import Any

import numpy as np

from ..base.deferred import dataclass
from ..base.quadrature import gauss
from ..kernels.element_line import along_elements
from ..parts.cable import Cable
from ..parts.drag import Drag
from ..parts.flow_profile import PowerProfile, TableProfile
from ..parts.fluid import NO_SURFACE, Fluid
from ..parts.ice import Ice
from ..parts.piece import UniformPiece
from ..parts.polar import Polar
from ..parts.scene_data import SceneData
from ..parts.section import Section
from ..parts.velocity_table import AXES
from .attachments import AttachmentModel, ModelBuilder
from .coupling import CouplingKind, CouplingModel, no_numbers
from .ices import signal_of, thickness_at
from .loads import GAUSS_POINTS
from .signals import SignalModel
from .span_coordinates import AlongSpan, SpanCoordinates

MIN_SPEED = 1e-30
"""Lower bound of speeds in the kernels, m/s: derivatives at rest would be 0/0 without it."""
NONE = np.zeros(0)
WAVE_NUMBERS = 5
"""Of a wave: amplitude, frequency, phase, size of k, and exp(-2 k depth), 0 for infinite depth."""

KERNELS = {2: "planar_drag", 3: "drag"}


@dataclass(eq=False, repr=False)
class Iced:
    """Growth of a drag with ice: number, factor in m and model of the signal of the thickness, diameters of drag and of
    the cable under the ice, m, and the buoyancy of a ring by thickness (diameter + thickness), N/m³ (dim,).
    """

    signal: int
    factor: float
    thickness: SignalModel | None
    width: float
    diameter: float
    buoyancy: np.ndarray

    @property
    def entries(self) -> dict[str, Any]:
        """Return the fields that the engine reads."""
        return {"ice_has_ice": 1, "ice_signal": self.signal, "ice_factor": self.factor, "ice_width": self.width,
                "ice_diameter": self.diameter, "ice_buoyancy": self.buoyancy}

    def at(self, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the factor of drag (T,), and the buoyancy (T, dim) in N/m that is added, at times (T,) in s."""
        t = thickness_at(self.thickness, self.factor, time)
        growth = 1 + 2 * t / self.width if self.width else np.ones(len(t))
        return growth, (t * (self.diameter + t))[:, None] * self.buoyancy


@dataclass(eq=False, repr=False)
class DragModel(AlongSpan, CouplingModel):
    """The force of a fluid on a cable, on a span of a rope, or on a point; cable -1: along the span of the coordinates,
    or at the one attachment, to a body or a cable.

    velocity (dim): m/s, multiplied by the signal of that number (-1: one) and the profile of the fluid at the
    height base + up . r. degree: of the splines of its table, 0 without. origin (3,), axes (9,): those of the
    model, along the ground's. first, n_elements: elements of the cable on which it acts. coefficients, lift,
    section: arguments of the kernels. buoyancy (dim): N/m of a cable, N of a body. wet: the section that a surface
    cuts, "all" for none. surface, bottom: heights, m. weights (1 or elements, n_points), in m, and N, N_x and
    N_chord, of a beam's chord (1 or elements, n_points, vectors): quadrature on the elements of the cable, once
    where they are equal; stride: points from one element to the next.
    """

    kernel: str
    velocity: np.ndarray
    up: np.ndarray
    base: float
    signal: int
    degree: int
    origin: np.ndarray
    axes: np.ndarray
    buoyancy: np.ndarray
    wet: str
    surface: float
    bottom: float
    fluid: Fluid
    polar: Polar | None
    iced: Iced | None = None
    cable: int = -1
    first: int = 0
    n_elements: int = 0
    coordinates: SpanCoordinates | None = None
    coefficients: tuple[float, ...] = ()
    lift: tuple[float, ...] = (0.0, MIN_SPEED)
    section: tuple[float, ...] = (0.0, 0.0, MIN_SPEED)
    n_points: int = 0
    stride: int = 0
    weights: np.ndarray = field(default_factory=no_numbers)
    N: np.ndarray = field(default_factory=no_numbers)
    N_x: np.ndarray = field(default_factory=no_numbers)
    N_chord: np.ndarray = field(default_factory=no_numbers)
    attachments: Sequence[AttachmentModel] = ()

    @property
    def on_cable(self) -> bool:
        """Return whether it acts at a point of a cable."""
        return any(end.cable >= 0 for end in self.attachments)


def drag_models(builder: ModelBuilder) -> Iterator[DragModel]:
    """Yield the models of the drags of a scene, one for each fluid that acts on a part, of a rope for each span, of a
    cable for each of its stretches.
    """
    spans = {rope.part.name: rope.spans for rope in builder.ropes}
    for part in builder.scene.drags.values():
        line = builder.scene.line(part.on)
        for fluid in builder.scene.fluids_of(part):
            for stretch in (None,) if line is None else part.stretches(line):
                for own, ice in _iced(part, stretch, builder.scene):
                    for span in spans.get(part.on, (None,)):
                        yield _in_fluid(part, fluid, builder, own, span, ice)


def _iced(part: Drag, stretch: UniformPiece | None, scene: SceneData
          ) -> Iterator[tuple[UniformPiece | None, Ice | None]]:
    """Yield the parts of a stretch of a cable with and without ice, and the ice."""
    ices = [(under, ice) for ice in scene.ices.values() if ice.cable == part.on
            for under in ice.stretches(scene.cables[part.on])]
    if stretch is None or not ices:
        yield stretch, None
        return
    cuts = {stretch.first, stretch.end, *(at for under, _ in ices for at in (under.first, under.end)
                                          if stretch.first < at < stretch.end)}
    for first, end in pairwise(sorted(cuts)):
        on = next(((under, ice) for under, ice in ices if under.first <= first and end <= under.end), None)
        yield stretch._replace(first=first, end=end), None if on is None else on[1]


def _in_fluid(part: Drag, fluid: Fluid, builder: ModelBuilder, stretch: UniformPiece | None,
              span: SpanCoordinates | None, ice: Ice | None) -> DragModel:
    """Return the model of a drag in a fluid on a stretch of a cable, on a span of a rope, or on a body."""
    section = None if stretch is None else stretch.section
    scene, dim = builder.scene, builder.scene.dim
    signal, factor = builder.signals.scale(fluid.scale)
    up, base = _height(scene)
    line, plane = scene.line(part.on), None if scene.plane_axes is None else scene.plane_axes.plane
    origin, axes = (np.zeros(3), np.eye(3)) if plane is None else (plane.origin, plane.axes)
    displaced, bottom = fluid.density * part.displaced(section), fluid.bottom(scene.fluids.values())
    cut = "section" if line is not None else "sphere" if part.height is None else "column"
    degree, table = _table(fluid, dim)
    model = DragModel(
        type="drag", name=part.name or "", is_damped=True, has_inertia=part.added_mass is not None,
        kernel=KERNELS[dim], velocity=factor * np.array(fluid.velocity)[:dim], up=up[:dim], base=base, signal=signal,
        degree=degree, origin=origin, axes=axes.ravel(), buoyancy=-displaced * np.array(scene.gravity)[:dim],
        wet=cut if fluid.surface is not None or bottom > -NO_SURFACE else "all", surface=fluid.top, bottom=bottom,
        fluid=fluid, polar=part.polar,
        entries=table | _profile(fluid) | _waves(fluid, scene, up[:dim]) | _foil(part, fluid, dim) | {
            "extent": part.extent(section), "displaced": displaced, "added": (),
            "is_morison": part.added_mass_form == "morison",
            "is_foil": part.polar is not None or (line is None and part.lift != 0), **_without_ice()})
    if ice is not None and section is not None:
        model.iced = _growing(part, fluid, ice, section, builder)
        model.entries |= model.iced.entries
    if model.has_inertia:
        added = part.added_of_body(dim) if line is None else part.added_of_cable()
        model.entries["added"] = (displaced * added).ravel()
    if line is None or stretch is None:
        coefficient = part.drag_coefficient if part.polar is None else 0.0
        model.coefficients = (fluid.density / 2 * part.area * coefficient, MIN_SPEED)
        model.attachments = [_point(part, builder)]
    else:
        _along_line(model, part, stretch.section)
        if isinstance(line, Cable):
            _along_cable(model, part, line, stretch, builder)
        else:
            model.coordinates = span
    return model


def _without_ice() -> dict[str, Any]:
    return {"ice_has_ice": 0, "ice_signal": -1, "ice_factor": 0.0, "ice_width": 0.0, "ice_diameter": 0.0,
            "ice_buoyancy": ()}


def _growing(part: Drag, fluid: Fluid, ice: Ice, section: Section, builder: ModelBuilder) -> Iced:
    """Return how a drag grows with the ice on its cable; a displaced area that is given does not."""
    has_width = part.normal or part.tangential or part.lift
    diameter = ice.diameter_of(section)
    assert diameter is not None, f"{ice.where} has no diameter"
    displaced = fluid.density * np.pi if part.displaced_area is None else 0.0
    return Iced(*signal_of(ice, builder), part.width(section) if has_width else 0.0, diameter,
                -displaced * np.array(builder.scene.gravity)[: builder.scene.dim])


def _point(part: Drag, builder: ModelBuilder) -> AttachmentModel:
    """Return the point of a body, with its axes, or of a cable, with those of the ground."""
    end = builder.attachment(part.attachment(builder.scene.point_masses), np.eye(3))
    if end.cable >= 0:
        end.frame, end.axes = "", np.eye(builder.scene.dim)
    return end


def _along_line(model: DragModel, part: Drag, section: Section) -> None:
    """Add the coefficients per length of a cable or a rope."""
    pressure, has_width = model.fluid.density / 2, part.normal or part.tangential or part.lift or part.polar
    width = part.width(section) if has_width else 0.0
    model.lift = (pressure * width * part.lift, MIN_SPEED)
    model.coefficients = (pressure * width * part.normal, pressure * np.pi * width * part.tangential, MIN_SPEED)
    model.n_points = GAUSS_POINTS
    if part.polar is not None:
        model.section = (pressure * width, width, MIN_SPEED)


def _along_cable(model: DragModel, part: Drag, cable: Cable, stretch: UniformPiece, builder: ModelBuilder) -> None:
    """Add the quadrature on a stretch of a cable."""
    model.cable = builder.cable_index[cable.name]
    on = builder.cables[model.cable]
    model.first, model.n_elements = stretch.first, stretch.end - stretch.first
    lengths = on.mesh.lengths if on.mesh.is_even else on.mesh.lengths[stretch.first : stretch.end]
    model.stride = 0 if on.mesh.is_even else GAUSS_POINTS
    rule = gauss(GAUSS_POINTS)
    model.N, model.N_x, model.weights = along_elements(on.kernel("on_axis"), lengths, rule)
    if part.polar is not None:
        slopes = [[on.kernel("slopes")(length, length * (1 + x) / 2) for x in rule[0]] for length in lengths]
        model.N_chord = np.einsum("c,egck->egk", part.foil_axes[1], np.array(slopes)[..., 0, :])


def _foil(part: Drag, fluid: Fluid, dim: int) -> dict[str, Any]:
    """Return the fields of lift and of the polar, whose pieces are those of `Polar.pieces`."""
    angles, drag, lift, moment = (NONE,) * 4 if part.polar is None else part.polar.pieces()
    span, chord = part.foil_axes
    return {"foil": (fluid.density / 2 * part.area, MIN_SPEED), "foil_lift": part.lift,
            "span": span if dim == 3 else (np.sign(span[2]),), "chord": chord[:dim],
            "n_angles": len(drag), "angles": angles, "polar_drag": drag, "polar_lift": lift, "polar_moment": moment}


def _height(scene: SceneData) -> tuple[np.ndarray, float]:
    """Return up (3,) along the axes of the model, and the height of their origin, m; those of a plane are not the
    ground's.
    """
    axes, up = scene.plane_axes, scene.as_drawn.up
    return (up, 0.0) if axes is None else (axes.plane.into(up), float(up @ axes.plane.origin))


def _profile(fluid: Fluid) -> dict[str, Any]:
    """Return the fields of the profile of a fluid."""
    breaks, coefficients = fluid.profile.pieces() if isinstance(fluid.profile, TableProfile) else (NONE, NONE)
    power = fluid.profile if isinstance(fluid.profile, PowerProfile) else PowerProfile(exponent=0, reference_height=1)
    return {"profile": "uniform" if fluid.profile is None else fluid.profile.form, "reference": power.reference_height,
            "exponent": power.exponent, "least": power.least_height, "n_segments": len(coefficients), "breaks": breaks,
            "coefficients_of_profile": coefficients}


def _waves(fluid: Fluid, scene: SceneData, up: np.ndarray) -> dict[str, Any]:
    """Return the fields of the waves on a fluid's surface, or on that of the fluid below it, which move its lower end.
    """
    own = next((each for each in scene.fluids.values() if each.waves is not None and each.top <= fluid.top), fluid)
    waves, gravity = own.waves or (), float(np.linalg.norm(scene.gravity))
    k = own.wave_numbers(gravity)
    vectors = k[:, None] * np.array([wave.ahead for wave in waves]).reshape(-1, 3)
    decay = np.zeros(len(k)) if own.depth is None else np.exp(-2 * k * own.depth)
    numbers = [[wave.amplitude, wave.frequency, wave.phase, *each] for wave, *each in zip(waves, k, decay, strict=True)]
    return {"n_waves": len(waves), "move_fluid": bool(waves) and own is fluid,
            "wave_vectors": vectors[:, : len(up)], "wave_numbers": np.array(numbers).reshape(-1, WAVE_NUMBERS),
            "inv_depth": 0.0 if own.depth is None else 1 / own.depth,
            "max_elevation": sum(wave.amplitude for wave in waves)}


def _table(fluid: Fluid, dim: int) -> tuple[int, dict[str, Any]]:
    """Return the degree of the splines of a fluid's table, 0 without one, and the fields of the table."""
    if fluid.table is None:
        return 0, {"n_splines": (1,) * len(AXES), "knots": NONE, "table": NONE}
    degree, knots, coefficients = fluid.table.splines(dim)
    return degree, {"n_splines": coefficients.shape[:-1], "knots": np.concatenate(list(knots.values())),
                    "table": coefficients}


KINDS = (CouplingKind("drag", Drag.group, drag_models, has_state=False),)
