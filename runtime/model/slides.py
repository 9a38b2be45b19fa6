"""Models of slides: rider, cable, drive, resistances and end stops."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..parts.attachment import Attachment
from ..parts.end_stops import Buffer, HardStop, Stop
from ..parts.friction import Friction
from ..parts.rigid_body import RigidBody
from ..parts.slide import Slide
from .attachments import ModelBuilder
from .bodies import BODIES
from .coupling import CouplingKind
from .model import SlideModel

RESISTANCES = {2: "planar_resistance", 3: "resistance"}
"""Kernels of friction and buffers, by dimension of the scene."""
RIDERS = {2: "planar_point", 3: "point"}
"""Kernels of a slide whose rider is no point of a rigid body."""


def _slide(slide: Slide, builder: ModelBuilder) -> SlideModel:
    scene = builder.scene
    along, dim = scene.cables[slide.along], scene.dim
    axes = along.axes_at(slide.arc_length)
    node = along.node_at(slide.arc_length)
    body = scene.bodies.get(slide.body or "")
    rider_is_rigid = isinstance(body, RigidBody)
    element = along.element_at(slide.arc_length)
    if node is not None:  # on a node: the element that the rider moves into
        forward = body is None or np.dot(axes[0], body.velocity) >= 0
        element = node if forward else node - 1
    rider = builder.attachment(slide.rider)
    driven, ends, friction = slide.is_driven, (slide.at_start, slide.at_end), slide.friction
    may_be_locked = (driven or (friction is not None and friction.sticks)
                     or any(isinstance(end, HardStop) for end in ends))
    mass = rider.mass or builder.attachment(Attachment(on=slide.along, s=slide.arc_length)).mass  # the ground has none
    resists = friction is not None or any(isinstance(end, Buffer) for end in ends)
    return SlideModel(
        type="slide", name=slide.name,
        kernel=f"slide_{along.element}_{BODIES[dim][0] if rider_is_rigid else RIDERS[dim]}",
        cable=builder.cable_index[slide.along], rider=rider, rider_is_rigid=rider_is_rigid, s=slide.arc_length,
        element=min(max(element, 0), along.elements - 1), director=axes[1], resistance=RESISTANCES[dim] * resists,
        n_coordinates=1, scale=[mass] * dim, n_multipliers=dim - 1 + may_be_locked,
        needs_reactions=resists, is_damped=resists, drive=builder.signals.add(slide.prescribed),
        entries={"carries_director": dim == 3 and not along.kind_of_element.director}
        | _friction(friction) | _stops(ends))


def _friction(friction: Friction | None) -> dict[str, Any]:
    """Return the fields of friction; without it the velocity is not zero, as the kernels divide by it."""
    if friction is None:
        return {"sticks": False, "friction": 0.0, "static_friction": 0.0, "viscous": 0.0, "velocity": 1.0}
    return {"sticks": friction.sticks, "friction": friction.sliding, "static_friction": friction.static_friction,
            "viscous": friction.viscous, "velocity": friction.velocity}


def _stops(ends: Sequence[str | Stop]) -> dict[str, Any]:
    """Return the fields of the stops at the start and the end of the cable."""
    return {"stop_kinds": [end if isinstance(end, str) else end.stop for end in ends],
            "restitutions": [end.restitution if isinstance(end, HardStop) else 0.0 for end in ends],
            **{f"buffer_{plural}": [getattr(end, each) if isinstance(end, Buffer) else 0.0 for end in ends]
               for each, plural in (("length", "lengths"), ("stiffness", "stiffnesses"), ("damping", "dampings"))}}


KINDS = (CouplingKind("slide", Slide.group,
                      lambda builder: [_slide(slide, builder) for slide in builder.scene.slides.values()]),)
