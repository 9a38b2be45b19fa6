"""Fluids and the drag in them, as the engine takes them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..parts.attachment import Attachment
from ..parts.drag import Drag
from ..parts.flow_profile import PowerProfile, TableProfile
from ..parts.fluid import NO_SURFACE, Fluid
from ..parts.polar import Polar
from ..parts.scene_data import SceneData
from ..parts.velocity_table import AXES
from .attachments import AttachmentModel, ModelBuilder
from .coupling import CouplingKind, CouplingModel
from .loads import GAUSS
from .quadrature import along_elements

LEAST_SPEED = 1e-30
"""m/s: what sizes of velocities are not below in the kernels, lest derivatives at rest be 0/0."""

KERNELS = {2: "planar_drag", 3: "drag"}


@dataclass
class DragModel(CouplingModel):
    """The force of a fluid on a cable, or on a point of a body; cable -1: it is on a body, at the one attachment.

    velocity (dim), in m/s, times the signal of that number (-1: one) and the profile, as couplings/fluid/drag.h has it,
    at the height base + up . r. coefficients: as the kernel takes them. buoyancy (dim): N/m of a cable, N of a body.
    lift, foil, section: likewise, is_foil: a body with a span, or a beam with a chord; n_angles, angles, polar_drag,
    polar_lift, polar_moment: its polar, see `Polar.pieces`.
    wet: what a surface cuts, all: nothing; extent: half the height of that, m; surface, bottom: heights, m.
    displaced: mass of the fluid displaced, added: that it adds, as couplings/fluid/drag.h has them, where has_inertia.
    weights (1 or elements, n_points), in m, N, N_x and N_chord, of a beam's chord (1 or elements, n_points, vectors):
    of the quadrature on the elements of the cable, once where they are equal; stride: points from one element's to the
    next's. degree, n_splines (4), knots, table: of splines in time and space, degree 0 without; origin (3,), axes (9):
    those of the model, of the ground. fluid, polar: the scene's, of which the engine takes nothing.
    """

    kernel: str
    velocity: np.ndarray
    up: np.ndarray
    base: float
    signal: int
    profile: str
    reference: float
    exponent: float
    least: float
    n_pieces: int
    breaks: np.ndarray
    coefficients_of_profile: np.ndarray
    degree: int
    n_splines: tuple[int, ...]
    knots: np.ndarray
    table: np.ndarray
    origin: np.ndarray
    axes: np.ndarray
    cable: int
    coefficients: tuple[float, ...]
    lift: tuple[float, ...]
    is_foil: bool
    foil: tuple[float, float]
    span: tuple[float, ...]
    chord: tuple[float, ...]
    foil_lift: float
    section: tuple[float, ...]
    n_angles: int
    angles: np.ndarray
    polar_drag: np.ndarray
    polar_lift: np.ndarray
    polar_moment: np.ndarray
    buoyancy: np.ndarray
    wet: str
    extent: float
    surface: float
    bottom: float
    displaced: float
    added: tuple[float, ...]
    n_points: int
    stride: int
    weights: np.ndarray
    N: np.ndarray
    N_x: np.ndarray
    N_chord: np.ndarray
    attachments: list[AttachmentModel]
    fluid: Fluid
    polar: Polar | None


def drag_models(builder: ModelBuilder) -> Iterator[DragModel]:
    """Yield the models of the drags of a scene, one for each fluid that acts on a part."""
    return (_in_fluid(part, fluid, builder) for part in builder.scene.drags.values()
            for fluid in builder.scene.fluids_of(part))


def _in_fluid(part: Drag, fluid: Fluid, builder: ModelBuilder) -> DragModel:
    scene, dim = builder.scene, builder.scene.dim
    signal, factor = builder.signals.scale(fluid.scale)
    gravity = np.array(scene.gravity)[:dim]
    up, base = _height(scene)
    displaced, none = part.displaced(scene.cables.get(part.on)), np.zeros(0)
    model = DragModel(
        kernel=KERNELS[dim], velocity=factor * np.array(fluid.velocity)[:dim], up=up[:dim], base=base, signal=signal,
        **_profile(fluid), **_foil(part, fluid, dim, part.on in scene.bodies), **_table(fluid, scene),
        **_wet(part, fluid, scene), cable=-1, coefficients=(),
        buoyancy=-fluid.density * displaced * gravity, displaced=fluid.density * displaced, added=(),
        has_inertia=part.added_mass is not None, n_points=0, stride=0, weights=none, N=none, N_x=none,
        N_chord=none, attachments=[], fluid=fluid, polar=part.polar, type="drag", name=part.name or "", is_damped=True)
    if model.has_inertia:
        added = part.added_of_cable() if part.on in builder.cable_index else part.added_of_body(dim)
        model.added = tuple((model.displaced * added).ravel().tolist())
    pressure = fluid.density / 2
    if part.on in builder.cable_index:
        model.cable = builder.cable_index[part.on]
        cable = builder.cables[model.cable]
        has_width = part.normal or part.tangential or part.lift or part.polar
        width = part.width(scene.cables[part.on]) if has_width else 0.0
        model.lift = (pressure * width * part.lift, LEAST_SPEED)
        model.coefficients = (pressure * width * part.normal, pressure * np.pi * width * part.tangential, LEAST_SPEED)
        model.n_points = len(GAUSS[0])
        lengths = cable.mesh.lengths
        model.N, model.N_x, model.weights = along_elements(cable.kernel("on_axis"), lengths, GAUSS)
        if part.polar is not None:
            model.is_foil, model.section = True, (pressure * width, width, LEAST_SPEED)
            slopes = [[cable.kernel("slopes")(length, length * (1 + x) / 2) for x in GAUSS[0]] for length in lengths]
            model.N_chord = np.einsum("c,egck->egk", part.foil_axes[1], np.array(slopes)[..., 0, :])
        model.stride = 0 if cable.mesh.is_even else model.n_points
    else:
        of_drag = part.coefficient if part.polar is None else 0.0
        model.coefficients = (pressure * part.area * of_drag, LEAST_SPEED)
        model.attachments = [builder.attachment(Attachment(on=part.on, at=part.at), np.eye(3))]
    return model


def _foil(part: Drag, fluid: Fluid, dim: int, on_body: bool) -> dict[str, Any]:
    """Return what a model has of lift."""
    breaks, drag, lift, moment = (np.zeros(0),) * 4 if part.polar is None else part.polar.pieces()
    span, chord = part.foil_axes
    is_foil = on_body and (part.lift != 0 or part.polar is not None)
    return {"lift": (0.0, LEAST_SPEED), "is_foil": is_foil, "foil": (fluid.density / 2 * part.area, LEAST_SPEED),
            "span": tuple(span) if dim == 3 else (float(np.sign(span[2])),), "chord": tuple(chord[:dim]),
            "foil_lift": part.lift, "section": (0.0, 0.0, LEAST_SPEED), "n_angles": len(drag), "angles": breaks,
            "polar_drag": drag, "polar_lift": lift, "polar_moment": moment}


def _wet(part: Drag, fluid: Fluid, scene: SceneData) -> dict[str, Any]:
    """Return what a model has of the surfaces of a fluid, and of what they cut."""
    cable, bottom = scene.cables.get(part.on), fluid.bottom(scene.fluids.values())
    kind = "section" if cable is not None else "sphere" if part.height is None else "column"
    is_cut = fluid.surface is not None or bottom > -NO_SURFACE
    return {"wet": kind if is_cut else "all", "extent": part.extent(cable), "surface": fluid.top, "bottom": bottom}


def _height(scene: SceneData) -> tuple[np.ndarray, float]:
    """Return up (3,) along the axes of the model, and the height of their origin, m; those of a plane are not the
    ground's.
    """
    axes, up = scene.plane_axes, scene.as_drawn.up
    return (up, 0.0) if axes is None else (axes.plane.into(up), float(up @ axes.plane.origin))


def _profile(fluid: Fluid) -> dict[str, Any]:
    """Return what a model has of the profile of a fluid."""
    breaks, coefficients = np.zeros(0), np.zeros((0, 7))
    power = fluid.profile if isinstance(fluid.profile, PowerProfile) else PowerProfile(exponent=0, reference_height=1)
    kind = "uniform" if fluid.profile is None else fluid.profile.form
    if isinstance(fluid.profile, TableProfile):
        breaks, coefficients = fluid.profile.pieces()
    return {"profile": kind, "reference": power.reference_height, "exponent": power.exponent,
            "least": power.least_height, "n_pieces": len(coefficients), "breaks": breaks,
            "coefficients_of_profile": coefficients}


def _table(fluid: Fluid, scene: SceneData) -> dict[str, Any]:
    """Return what a model has of the table of a fluid, and of the axes that it is on."""
    plane = None if scene.plane_axes is None else scene.plane_axes.plane
    origin, axes = (np.zeros(3), np.eye(3)) if plane is None else (plane.origin, plane.axes)
    common = {"origin": origin, "axes": axes.ravel()}
    if fluid.table is None:
        return common | {"degree": 0, "n_splines": (1,) * len(AXES), "knots": np.zeros(0), "table": np.zeros(0)}
    degree, knots, coefficients = fluid.table.splines(scene.dim)
    return common | {"degree": degree, "n_splines": coefficients.shape[:-1],
                     "knots": np.concatenate(list(knots.values())), "table": coefficients.ravel()}


KINDS = (CouplingKind("drag", Drag.group, drag_models, has_state=False),)
