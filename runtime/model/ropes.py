"""Models of the couplings of ropes: spans, ends on bodies and cables, and the list of all kinds."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import field

import numpy as np

from ..base.deferred import dataclass
from ..parts.load import Force
from ..parts.locations import grips
from ..parts.rope import Rope
from ..parts.rope_items import Anchor, RouteItem
from ..parts.rope_route import MIN_SPAN_RATIO
from ..parts.scene_data import SceneData
from .attachments import AttachmentModel, ModelBuilder
from .coupling import CouplingKind, CouplingModel
from .rope_model import RopeModel, anchored_ends
from .rope_wheels import drum_models, sheave_models, wrap_points
from .span_coordinates import AlongSpan, SpanCoordinates
from .taut_ropes import taut_points, taut_ropes

JOINTS = {2: "joint_planar_spherical", 3: "joint_spherical"}
"""The kernel of an end on a body."""


@dataclass(eq=False, repr=False, kw_only=True)
class SpanModel(AlongSpan, CouplingModel):
    """A span between two tangent points or ends: fu_span_coupling of the engine.

    held: material coordinates in m to which parts hold or on which they act, increasing, with the words of messages for
    that; beside: what the rope meets at both ends of the span.
    """

    coordinates: SpanCoordinates
    rho: float
    tau: float
    g: np.ndarray
    A: np.ndarray
    least_length: float
    held: list[tuple[float, str]] = field(default_factory=list)
    beside: tuple[str, str] = ("", "")

    @property
    def is_gripped(self) -> int:
        """Return whether anything holds to material points of it."""
        return int(bool(self.held))

    @property
    def grips(self) -> list[float]:
        """Return the first and the last material coordinate of these, m."""
        return [self.held[0][0], self.held[-1][0]] if self.held else []

    def reached(self, end: int) -> str:
        """Return in words that what holds to it has come to its first end, 0, or to its last one, 1."""
        s, part = self.held[-end]
        return f'{part} rope "{self.name}" at s = {s:.9g} m, which reaches {self.beside[end]}'

    def end_of_grips(self, q: np.ndarray) -> int | None:
        """Return the end, 0 or 1, that a material point to which a part holds has passed in a configuration q (n,)."""
        passed = [self.is_gripped and (2 * end - 1) * (self.grips[end] - q[self.span_s[end]]) > 0 for end in range(2)]
        return passed.index(True) if any(passed) else None


def span_models(builder: ModelBuilder) -> Iterator[SpanModel]:
    """Yield the spans of all ropes."""
    gravity = np.array(builder.scene.gravity)
    for rope in builder.ropes:
        held, beside = grips_of(builder.scene, rope), items_beside(rope.part)
        radii = [getattr(item, "radius", 0.0) for item in rope.part.route]
        radii += radii[: rope.part.closed]
        for k, span in enumerate(rope.spans):
            least = max(MIN_SPAN_RATIO * max(radii[k : k + 2]), rope.part.radius)
            yield SpanModel(type="span", name=rope.part.name, coordinates=span,
                            rho=rope.rho, tau=rope.part.material.damping_time, g=gravity, A=rope.stiffness,
                            least_length=least, has_inertia=True, is_damped=rope.part.material.damping_time > 0,
                            held=held[k], beside=beside[k])


def grips_of(scene: SceneData, rope: RopeModel) -> list[list[tuple[float, str]]]:
    """Return for each span of a rope the arc-lengths at which parts of the scene hold it or act on it, m, and the words
    of messages for that.
    """
    found: list[list[tuple[float, str]]] = [[] for _ in rope.spans]
    for part, _, end in grips(scene):
        if end.on == rope.part.name:
            acts = "acts on" if isinstance(part, Force) else "holds"
            found[rope.part.span_at(rope.route, end.arc_length)].append((end.arc_length, f"{part.where} {acts}"))
    return [sorted(each) for each in found]


def items_beside(rope: Rope) -> list[tuple[str, str]]:
    """Return what a rope meets at both ends of each span, as messages name it."""
    return [(_called(one), _called(other)) for one, other in rope.ends_of_spans]


def _called(item: RouteItem) -> str:
    """Return an item of a route as messages name it."""
    return "an anchor" if isinstance(item, Anchor) else item.where


@dataclass(eq=False, repr=False, kw_only=True)
class AnchorModel(CouplingModel):
    """An end of a rope on a body: a spherical joint, fu_joint of the engine."""

    kernel: str
    attachments: tuple[AttachmentModel, AttachmentModel]
    base: float = 0.0
    of_points: bool = True


def anchor_models(builder: ModelBuilder) -> Iterator[AnchorModel]:
    """Yield the ends of ropes on bodies; those at the ground are fixed dofs."""
    for rope in builder.ropes:
        for span, node, item in anchored_ends(rope):
            if item.end.on is None:
                continue
            body = builder.attachment(item.end)
            yield AnchorModel(type="anchor", name=rope.part.name, kernel=JOINTS[rope.part.dim],
                              attachments=(AttachmentModel(node=span.node(node).start), body),
                              scale=[body.mass] * rope.part.dim, n_multipliers=rope.part.dim)


KINDS = (CouplingKind("anchor", Rope.group, anchor_models), CouplingKind("span", Rope.group, span_models),
         CouplingKind("sheave", Rope.group, sheave_models),
         CouplingKind("wrap_point", Rope.group, wrap_points), CouplingKind("drum", Rope.group, drum_models),
         CouplingKind("taut_point", Rope.group, taut_points), CouplingKind("taut_rope", Rope.group, taut_ropes))
