"""Models of loads: dead forces on dofs, and loads that depend on the state."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from ..base.deferred import dataclass
from ..base.quadrature import gauss
from ..checks.placement import placed_attachment
from ..parts.attachment import Attachment
from ..parts.load import DistributedForce, Force, Load, Moment
from ..parts.signal import Signal, presence_of
from .attachments import AttachmentModel, ModelBuilder
from .coupling import CouplingKind, CouplingModel
from .span_coordinates import AlongSpan, SpanCoordinates

EVERYWHERE = 1e300
"""m, beyond the ends of all ropes."""
GAUSS_POINTS = 4
"""Points along an element of a distributed force: exact to degree 7."""


@dataclass(eq=False, repr=False)
class DeadLoadModel(CouplingModel):
    """A force of constant direction in the dofs, times a signal (number, -1: one)."""

    signal: int
    dofs: list[int]
    values: list[float]

    @property
    def n(self) -> int:
        """Return the number of dofs that it acts on."""
        return len(self.dofs)


@dataclass(eq=False, repr=False)
class LoadModel(CouplingModel):
    """A load that depends on rotations of its cable or body, or a force on a point of a rope.

    kind: cable_follower, cable_moment, cable_force, body_force, also on a rope, body_follower or body_moment; x: place
    in an element, m. Of one that moves along its cable, place and presence are the numbers of the signals of its
    arc-length, from which x is an offset, and of whether it is on the cable (-1: always).
    """

    kind: str
    signal: int
    on: AttachmentModel
    x: float
    c: tuple[float, float, float]
    place: int = -1
    presence: int = -1

    @property
    def kernel_families(self) -> list[str]:
        """Return the names of the kernel families that it uses beside those of its carrier."""
        return [self.on.rope_point] if self.on.rope_point else []


@dataclass(eq=False, repr=False, kw_only=True)
class LineLoadModel(AlongSpan, CouplingModel):
    """A force of a stress-free length on the material of a rope in a span, times a signal (number, -1: one).

    value (3,): N/m; between: material coordinates of its ends, m.
    """

    coordinates: SpanCoordinates
    signal: int
    value: np.ndarray
    between: tuple[float, ...]


AnyLoadModel = DeadLoadModel | LoadModel | LineLoadModel


class LoadBuilder:
    """Builds the models of loads: dead ones, constant in the dofs, those along spans of ropes, and others."""

    def __init__(self, builder: ModelBuilder):
        self.builder, self.scene, self.cables = builder, builder.scene, builder.cables
        self.dead: list[DeadLoadModel] = []
        self.turning: list[LoadModel] = []
        self.along: list[LineLoadModel] = []

    def load(self, load: Force | DistributedForce | Moment) -> None:
        """Add the model of a load to `dead`, `turning` or `along`."""
        number, factor = self.builder.signals.scale(load.scale, load.when, load.until)
        value = factor * np.array(load.value)
        if isinstance(load, DistributedForce):
            self._distributed(load, number, value)
        elif isinstance(load.s, Signal):
            assert isinstance(load, Force), f"{load.where} does not move"
            self._moving(load, load.s, number, value)
        elif load.on in self.builder.cable_index:
            assert load.s is not None, f"{load.where} is not complete"
            points = [(*self.builder.element(load.on, load.s), 1.0)]
            if isinstance(load, Moment):
                self._turning("cable_moment", number, load.on, points, value)
            else:
                self._along_cable(load.on, number, points, value, load.follower)
        else:
            kind = "body_moment" if isinstance(load, Moment) else "body_follower" if load.follower else "body_force"
            attachment = Attachment(on=load.on, s=load.s, at=getattr(load, "at", None))
            on = self.builder.attachment(placed_attachment(self.scene, attachment, load.where))
            on.axes = np.eye(self.scene.dim)
            self.turning.append(LoadModel(kind, number, on, 0.0, (value[0], value[1], value[2]), type="load"))

    @property
    def all(self) -> list[AnyLoadModel]:
        """Return the models in the engine's order."""
        return [*self.dead, *self.turning, *self.along]

    def _moving(self, load: Force, s: Signal, number: int, value: np.ndarray) -> None:
        """Add the axles of a load that moves along its cable."""
        on, place = self.builder.cable_index[load.on], self.builder.signals.add(s)
        kind = "cable_follower" if load.follower else "cable_force"
        for offset, share in load.axles:
            presence = presence_of(s, offset, self.cables[on].mesh.total)
            assert presence is not None, f"{load.where} leaves the cable"
            x, y, z = share * value
            self.turning.append(LoadModel(kind, number, AttachmentModel(cable=on), offset, (x, y, z), place,
                                          self.builder.signals.add_steps(*presence), type="load"))

    def _distributed(self, load: DistributedForce, number: int, value: np.ndarray) -> None:
        if load.cable in self.scene.ropes:
            between = tuple(end if given is None else given
                            for given, end in ((load.start, -EVERYWHERE), (load.stop, EVERYWHERE)))
            rope = next(each for each in self.builder.ropes if each.part.name == load.cable)
            self.along += [LineLoadModel(type="line load", coordinates=span, signal=number, value=value,
                                         between=between) for span in rope.spans]
            return
        model = self.cables[self.builder.cable_index[load.cable]]
        points = [(element, (start + stop) / 2 + (stop - start) / 2 * x, (stop - start) / 2 * w)
                  for element, start, stop in model.mesh.covered(load.start, load.stop)
                  for x, w in zip(*gauss(GAUSS_POINTS), strict=True)]
        self._along_cable(load.cable, number, points, value, load.follower)

    def _along_cable(self, cable: str, number: int, points: Iterable[tuple[int, float, float]], value: np.ndarray,
                     follower: bool) -> None:
        """Add a distributed load as forces, value times weight, at points (element, x, weight)."""
        if follower:
            self._turning("cable_follower", number, cable, points, value)
            return
        model = self.cables[self.builder.cable_index[cable]]
        dim = model.shape[2]
        total = np.zeros(model.coordinates.stop)
        for element, x, weight in points:
            N = model.kernel("on_axis")(model.mesh.length(element), x)[0]
            total[model.dofs_of(element)] += weight * np.outer(N, value[:dim]).ravel()
        used = np.flatnonzero(total)
        self.dead.append(DeadLoadModel(number, list(used), list(total[used]), type="dead load"))

    def _turning(self, kind: str, number: int, cable: str, points: Iterable[tuple[int, float, float]],
                 value: np.ndarray) -> None:
        c = np.array([value[2], 0.0, 0.0]) if kind == "cable_moment" and self.scene.dim == 2 else value
        on = self.builder.cable_index[cable]
        self.turning += [LoadModel(kind, number, AttachmentModel(cable=on, element=element), x, tuple(weight * c),
                                   type="load") for element, x, weight in points]


def _loads(builder: ModelBuilder) -> tuple[list[DeadLoadModel], list[LoadModel], list[LineLoadModel]]:
    """Return the loads of a scene, translated once."""
    made = LoadBuilder(builder)
    for load in builder.scene.loads.values():
        made.load(load)
    return made.dead, made.turning, made.along  # not the builder, which would keep its scene in memory


KINDS = (
    CouplingKind("dead load", Load.group, lambda builder: builder.once("loads", _loads)[0], has_state=False),
    CouplingKind("load", Load.group, lambda builder: builder.once("loads", _loads)[1], has_state=False),
    CouplingKind("line load", Load.group, lambda builder: builder.once("loads", _loads)[2], has_state=False))
