"""Models of slides: rider, cable or rope, drive, resistances and end stops."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..base.deferred import dataclass
from ..parts.attachment import Attachment
from ..parts.end_stops import Buffer, HardStop, Stop
from ..parts.friction import Friction
from ..parts.rigid_body import RigidBody
from ..parts.slide import Slide
from ..parts.validation import LENGTH_TOLERANCE
from .attachments import ModelBuilder
from .bodies import BODIES
from .coupling import CouplingKind
from .model import SlideModel
from .ropes import items_beside
from .signals import Signals
from .span_coordinates import KERNELS

RESISTANCES = {2: "planar_resistance", 3: "resistance"}
"""Kernels of friction and buffers, by dimension of the scene."""
RIDERS = {2: "planar_point", 3: "point"}
"""Kernels of a slide whose rider is no point of a rigid body."""


@dataclass(eq=False, repr=False)
class _Line:
    """Where a slide starts: prefix of its kernels, the fields of `SlideModel` about its cable or rope, and the element
    with its neighbour, if s is at a node between both.
    """

    kernel: str
    fields: dict[str, Any]
    elements: tuple[int, ...]
    tangent: np.ndarray
    has_director: bool


def _on_cable(slide: Slide, builder: ModelBuilder) -> _Line:
    along = builder.scene.cables[slide.along]
    node, axes = along.node_at(slide.arc_length), along.axes_at(slide.arc_length)
    elements = (along.element_at(slide.arc_length),) if node is None else (node - 1, node)
    inside = tuple(min(max(element, 0), along.elements - 1) for element in elements)
    return _Line(along.element, {"line": along, "cable": builder.cable_index[slide.along], "director": axes[1]},
                 inside, axes[0], bool(along.kind_of_element.director))


def _on_rope(slide: Slide, builder: ModelBuilder) -> _Line:
    rope = next(each for each in builder.ropes if each.part.name == slide.along)
    number = rope.part.span_at(rope.route, slide.arc_length)
    span, drawn = rope.spans[number], rope.route.spans[number]
    start, end = rope.route.arc_lengths(rope.part.first_arc_length)[number]
    share = (slide.arc_length - start) / (end - start)
    node = int(np.argmin(np.abs(span.share - share)))
    at_node = abs(span.share[node] - share) <= LENGTH_TOLERANCE and 0 < node < span.n_elements
    elements = (node - 1, node) if at_node else (int(np.searchsorted(span.share, share)) - 1,)
    tangent = (drawn.end - drawn.start) / np.linalg.norm(drawn.end - drawn.start)
    across = np.eye(span.dim)[np.argmin(np.abs(tangent))]
    return _Line(KERNELS[span.dim],
                 {"line": rope.part, "cable": -1, "director": across - (across @ tangent) * tangent,
                  "coordinates": span, "beside": items_beside(rope.part)[number]}, elements, tangent, False)


def _slide(slide: Slide, builder: ModelBuilder) -> SlideModel:
    scene, dim = builder.scene, builder.scene.dim
    line = (_on_rope if slide.along in scene.ropes else _on_cable)(slide, builder)
    body = scene.bodies.get(slide.body or "")
    rider_is_rigid = isinstance(body, RigidBody)
    # on a node: the element that the rider moves into
    forward = body is None or np.dot(line.tangent, np.array(body.velocity)[: len(line.tangent)]) >= 0
    rider = builder.attachment(slide.rider)
    driven, ends, friction = slide.is_driven, (slide.at_start, slide.at_end), slide.friction
    may_be_locked = (driven or (friction is not None and friction.sticks)
                     or any(isinstance(end, HardStop) for end in ends))
    mass = rider.mass or builder.attachment(Attachment(on=slide.along, s=slide.arc_length)).mass  # the ground has none
    resists = friction is not None or any(isinstance(end, Buffer) for end in ends)
    return SlideModel(
        type="slide", name=slide.name, **line.fields,
        kernel=f"slide_{line.kernel}_{BODIES[dim][0] if rider_is_rigid else RIDERS[dim]}",
        rider=rider, rider_is_rigid=rider_is_rigid, s=slide.arc_length,
        element=line.elements[-1 if forward else 0], resistance=RESISTANCES[dim] * resists,
        n_coordinates=1, scale=[mass] * dim, n_multipliers=dim - 1 + may_be_locked,
        needs_reactions=resists, is_damped=resists, drive=builder.signals.add(slide.prescribed),
        entries={"carries_director": dim == 3 and not line.has_director} | _friction(friction, builder.signals)
        | _stops(ends))


def _friction(friction: Friction | None, signals: Signals) -> dict[str, Any]:
    """Return the fields of friction; without it the velocity is not zero, as the kernels divide by it."""
    if friction is None:
        return {"sticks": False, "friction": 0.0, "static_friction": 0.0, "viscous": 0.0, "velocity": 1.0,
                "friction_scale": -1}
    number, factor = signals.scale(friction.scale, friction.when, friction.until)
    return {"sticks": friction.sticks, "friction": factor * friction.sliding,
            "static_friction": factor * friction.static_friction, "viscous": factor * friction.viscous,
            "velocity": friction.velocity, "friction_scale": number}


def _stops(ends: Sequence[str | Stop]) -> dict[str, Any]:
    """Return the fields of the stops at the start and the end of the cable."""
    return {"stop_kinds": [end if isinstance(end, str) else end.stop for end in ends],
            "restitutions": [end.restitution if isinstance(end, HardStop) else 0.0 for end in ends],
            **{f"buffer_{plural}": [getattr(end, each) if isinstance(end, Buffer) else 0.0 for end in ends]
               for each, plural in (("length", "lengths"), ("stiffness", "stiffnesses"), ("damping", "dampings"))}}


KINDS = (CouplingKind("slide", Slide.group,
                      lambda builder: [_slide(slide, builder) for slide in builder.scene.slides.values()]),)
