"""Loads, forces between points and signals of a scene, as the engine takes them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..checks.placement import placed_attachment
from ..kernels.libraries import kernels_of
from ..kernels.point_laws import point_law
from ..parts.attachment import Attachment
from ..parts.force_pieces import HAS_NO_FORCE, PULLS_AND_PUSHES
from ..parts.load import DistributedForce, Force, Moment
from ..parts.point_force import PointForce
from ..parts.scene_data import SceneData
from ..parts.signal import Constant, Signal, Sine, value_at
from ..parts.spring import Spring
from .attachments import AttachmentBuilder, AttachmentModel
from .coupling import CouplingModel

GAUSS = np.polynomial.legendre.leggauss(4)
"""Points along an element of a distributed force: exact to degree 7."""


@dataclass
class SignalModel:
    """f(t) = polynomial piece of t - break + amplitude sin(angular_frequency t + phase)."""

    breaks: np.ndarray
    coefficients: np.ndarray
    amplitude: float
    angular_frequency: float
    phase: float

    def value(self, time: np.ndarray, derivative: int = 0) -> np.ndarray:
        """Return the signal, or a derivative of it, at the times ``time``, s."""
        sine = Sine(self.amplitude, self.angular_frequency, self.phase)
        return value_at(sine, self.breaks, self.coefficients, time, derivative)

    def at(self, time: float) -> float:
        """Return the signal at a time in s."""
        return float(self.value(np.asarray(time)))


@dataclass
class DeadLoadModel(CouplingModel):
    """A force of constant direction in the dofs, times a signal (number, -1: one)."""

    signal: int
    dofs: list[int]
    values: list[float]

    @property
    def n(self) -> int:
        """Return the number of dofs that it acts on."""
        return len(self.dofs)


@dataclass
class LoadModel(CouplingModel):
    """A load that turns with what it acts on, or whose lever does.

    kind: cable_follower, cable_moment, body_force, body_follower or body_moment; modal: of a modal body, as of an
    `AttachmentModel`.
    """

    kind: str
    signal: int
    on: int
    element: int
    x: float
    u: tuple[float, ...]
    c: tuple[float, float, float]
    modal: tuple[np.ndarray, np.ndarray, np.ndarray] | None = None


@dataclass
class ForceLaw:
    """The law of a force between two points.

    law: the name of its kernels; parameters: in the order in which the kernels take them, for one piece of it after the
    other. bounds (n_pieces - 1), in m: distances of the points at which a piece ends and the next begins. senses
    (n_pieces): what each piece may do. compliance: in m/N, that of the stiffest piece.
    """

    law: str
    dim: int
    parameters: tuple[float, ...]
    n_pieces: int = 1
    n_parameters: int = 0
    bounds: tuple[float, ...] = ()
    senses: tuple[int, ...] = (PULLS_AND_PUSHES,)
    compliance: float = 0.0

    @classmethod
    def of(cls, part: PointForce, dim: int) -> ForceLaw:
        """Return the law of a part, which is complete, in so many dimensions."""
        name = ("planar_" if dim == 2 else "") + part.law
        names = list(point_law(name).parameters)
        if isinstance(part, Spring) and part.has_pieces:
            return cls(name, dim, n_parameters=len(names), **_pieces(part, names))
        return cls(name, dim, tuple(float(getattr(part, each)) for each in names), n_parameters=len(names))

    def at_rest(self, gap: np.ndarray) -> np.ndarray:
        """Return the force (dim,) on the first point, in N, from the way (dim,) to the second one, which rests."""
        parameters = self._at(gap)
        if parameters is None:
            return np.zeros(self.dim)
        return np.asarray(getattr(kernels_of(None), f"{self.law}_force")(parameters, gap, np.zeros(self.dim)))

    def tangent_at_rest(self, gap: np.ndarray) -> np.ndarray:
        """Return (dim, dim): the derivative of `at_rest` by the way (dim,), in N/m."""
        parameters = self._at(gap)
        if parameters is None:
            return np.zeros((self.dim, self.dim))
        return np.asarray(getattr(kernels_of(None), f"{self.law}_tangent")(parameters, gap, np.zeros(self.dim))[1])

    def _at(self, gap: np.ndarray) -> np.ndarray | None:
        """Return what the kernels take of the piece that a way (dim,) is in; None where it has no force."""
        piece = int(np.searchsorted(self.bounds, np.linalg.norm(gap)))
        if self.senses[piece] == HAS_NO_FORCE:
            return None
        return np.array(self.parameters[piece * self.n_parameters :][: self.n_parameters])


@dataclass(kw_only=True)
class PointForceModel(CouplingModel, ForceLaw):
    """A force between two points, whose unknowns are its components."""

    attachments: list[AttachmentModel]

    @property
    def kernel_families(self) -> list[str]:
        """Return the name of the kernels of its law."""
        return [self.law]


class LoadBuilder:
    """Translates the loads and springs of a scene."""

    def __init__(self, scene: SceneData, attachments: AttachmentBuilder):
        self.scene, self.attachments, self.cables = scene, attachments, attachments.cables
        self.cable_index, self.body_index = attachments.cable_index, attachments.body_index
        self.signals: list[SignalModel] = []
        self.dead: list[DeadLoadModel] = []
        self.turning: list[LoadModel] = []

    def signal(self, signal: Signal) -> int:
        """Store a signal and return its number."""
        breaks, coefficients = signal.pieces()
        self.signals.append(SignalModel(np.asarray(breaks, dtype=float), np.asarray(coefficients, dtype=float),
                                        *signal.sine))
        return len(self.signals) - 1

    def scale(self, signal: Signal) -> tuple[int, float]:
        """Return the number and constant factor of a load's scale."""
        return (-1, float(signal.value(0.0))) if isinstance(signal, Constant) else (self.signal(signal), 1.0)

    def load(self, load: Force | DistributedForce | Moment) -> None:
        """Add the model of a load to `dead` or `turning`."""
        number, factor = self.scale(load.scale)
        value = factor * np.array(load.value)
        if isinstance(load, DistributedForce):
            self._distributed(load, number, value)
        elif load.on in self.cable_index:
            assert load.s is not None, f"{load.where} is not complete"
            points = [(*self.attachments.element(load.on, load.s), 1.0)]
            if isinstance(load, Moment):
                self._turning("cable_moment", number, load.on, points, value)
            else:
                self._along_cable(load.on, number, points, value, load.follower)
        else:
            kind = "body_moment" if isinstance(load, Moment) else "body_follower" if load.follower else "body_force"
            attachment = Attachment(on=load.on, s=load.s, at=getattr(load, "at", None))
            on = self.attachments.model(placed_attachment(self.scene, attachment, load.where))
            self.turning.append(LoadModel(kind, number, on.body, 0, 0.0, on.u, (value[0], value[1], value[2]), on.modal,
                                          type="load"))

    def _distributed(self, load: DistributedForce, number: int, value: np.ndarray) -> None:
        model = self.cables[self.cable_index[load.cable]]
        points = [(element, (start + stop) / 2 + (stop - start) / 2 * x, (stop - start) / 2 * w)
                  for element, start, stop in model.mesh.covered(load.start, load.stop)
                  for x, w in zip(*GAUSS, strict=True)]
        self._along_cable(load.cable, number, points, value, load.follower)

    def _along_cable(self, cable: str, number: int, points: Iterable[tuple[int, float, float]], value: np.ndarray,
                     follower: bool) -> None:
        """Add a distributed load as forces, value times weight, at points (element, x, weight)."""
        if follower:
            self._turning("cable_follower", number, cable, points, value)
            return
        model = self.cables[self.cable_index[cable]]
        dim = model.shape[2]
        total = np.zeros(int(np.prod(model.shape)))
        for element, x, weight in points:
            at = element * model.shape[1] * dim
            N = model.kernel("on_axis")(model.mesh.length(element), x)[0]
            total[at : at + len(N) * dim] += weight * np.outer(N, value[:dim]).ravel()
        used = np.flatnonzero(total)
        self.dead.append(DeadLoadModel(number, list(model.first + used), list(total[used]), type="dead load"))

    def _turning(self, kind: str, number: int, cable: str, points: Iterable[tuple[int, float, float]],
                 value: np.ndarray) -> None:
        c = np.array([value[2], 0.0, 0.0]) if kind == "cable_moment" and self.scene.dim == 2 else value
        self.turning += [LoadModel(kind, number, self.cable_index[cable], element, x, (0.0, 0.0, 0.0),
                                   tuple(weight * c), type="load") for element, x, weight in points]

    def point_force(self, part: PointForce) -> PointForceModel:
        """Return the model of a force between two points."""
        ends = [self.attachments.model(part.a), self.attachments.model(part.b)]
        law = ForceLaw.of(part, self.scene.dim)
        damping = point_law(law.law).damping
        return PointForceModel(
            type="point_force", name=part.name or "", scale=[max(end.mass for end in ends)] * law.dim,
            is_damped=bool(damping) and getattr(part, damping) != 0, follows_law=True, attachments=ends, **vars(law))


def _pieces(part: Spring, names: list[str]) -> dict[str, Any]:
    """Return what a model has of the pieces of a spring: of those that a distance, which is not negative, reaches."""
    assert part.length is not None, f"{part.where} is not complete"
    pieces = [piece for piece in part.pieces() if part.length + piece.end > 0]
    values = [{"stiffness": piece.stiffness, "damping": part.damping * (piece.sense != HAS_NO_FORCE),
               "reference": part.length + piece.at, "tension": piece.tension, "energy": piece.energy}
              for piece in pieces]
    return {"parameters": tuple(float(of[name]) for of in values for name in names), "n_pieces": len(pieces),
            "bounds": tuple(part.length + piece.end for piece in pieces[:-1]),
            "senses": tuple(piece.sense for piece in pieces),
            "compliance": 1 / max((abs(piece.stiffness) for piece in pieces), default=1.0)}
