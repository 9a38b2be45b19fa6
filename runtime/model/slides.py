"""Slides as the engine takes them."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..parts.end_stops import Buffer, HardStop
from ..parts.rigid_body import RigidBody
from ..parts.scene_data import SceneData
from ..parts.signal import Signal
from ..parts.slide import Slide
from .attachments import AttachmentBuilder
from .bodies import BODIES
from .model import SlideModel

RESISTANCES = {2: "planar_resistance", 3: "resistance"}
"""Kernels of friction and buffers, by dimension of the scene."""
RIDERS = {2: "planar_point", 3: "point"}
"""Kernels of a slide whose rider is a point of anything else than a rigid body."""


def slide_model(slide: Slide, scene: SceneData, attachments: AttachmentBuilder,
                signal: Callable[[Signal], int]) -> SlideModel:
    """Make the model of a slide; signal(s): number of a signal."""
    along, dim = scene.cables[slide.along], scene.dim
    axes = along.axes_at(slide.s)
    at = slide.s / along.length * along.elements
    node = along.node_at(slide.s)
    body = scene.bodies.get(slide.body)
    rider_is_rigid = isinstance(body, RigidBody)
    if node is not None:  # on a node: the element that the rider moves into
        forward = body is None or np.dot(axes[0], body.velocity) >= 0
        at = node if forward else node - 1
    rider = attachments.model(slide.rider)
    driven, ends, friction = slide.prescribed is not None, (slide.at_start, slide.at_end), slide.friction
    may_be_locked = (driven or (friction is not None and friction.sticks)
                     or any(isinstance(end, HardStop) for end in ends))
    resistances = friction is not None or any(isinstance(end, Buffer) for end in ends)
    return SlideModel(
        f"slide_{along.element}_{BODIES[dim][0] if rider_is_rigid else RIDERS[dim]}",
        attachments.cable_index[slide.along],
        rider,
        rider_is_rigid,
        -1 if slide.prescribed is None else signal(slide.prescribed),
        dim == 3 and not along.kind_of_element.director,
        rider.mass,
        slide.s,
        int(np.clip(np.floor(at), 0, along.elements - 1)),
        axes[1],
        RESISTANCES[dim] * resistances,
        friction if resistances else None,
        ends,
        name=slide.name,
        n_unknowns=1 + dim,
        n_multipliers=dim - 1 + may_be_locked,
    )
