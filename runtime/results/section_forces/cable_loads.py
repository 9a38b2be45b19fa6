"""Loads on cables between their nodes at given instants, as generalised forces: loads, springs, joints, riders, fluids.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import dataclass, field, fields
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...base.quadrature import gauss
from ...base.rotations import rotate
from ...engine import Engine
from ...errors import SceneError
from ...kernels.libraries import kernels_of
from ...model.attachments import CARRIED, UP, AttachmentModel
from ...model.drag_forces import Turning, densities
from ...model.drags import DragModel
from ...model.kinds import COUPLINGS
from ...model.loads import GAUSS_POINTS
from ...model.model import CableModel, Model
from ...model.states import attachment_points, element_coordinates, positions, spatial
from ...parts.load import DistributedForce, Force, Moment
from ...parts.point_mass import PointMass
from ...parts.scene_data import SceneData
from ...parts.signal import Signal
from ..shape_functions import of_slopes, on_axis
from .spreads import AddedMass, Rule, Spread, rules_of

if TYPE_CHECKING:
    from numpy.typing import ArrayLike  # 9 ms, for type checkers alone


@dataclass
class Instants:
    """A scene at T instants: q (T, n_q) and v (T, n_dof) of the cables, zero of bodies; value(name): a result (T, ...).

    load, weight: the applied parts of the loads and of gravity; is_rest: whether it is a state of rest; start(name): a
    result (1, ...) at the start of a run by the linear model about it; happened: the first times of events, s.
    """

    time: np.ndarray
    q: np.ndarray
    v: np.ndarray
    value: Callable[[str], np.ndarray]
    load: float = 1.0
    weight: float = 1.0
    is_rest: bool = False
    start: Callable[[str], np.ndarray] | None = None
    happened: Mapping[str, float] = field(default_factory=dict)

    def one(self, k: int) -> Instants:
        """Return instant number k alone."""
        here = slice(k, k + 1)
        return Instants(self.time[here], self.q[here], self.v[here], lambda name: self.value(name)[here], self.load,
                        self.weight, self.is_rest, self.start, self.happened)


class PointLoad(NamedTuple):
    """A force at a point of a cable: element and x (m) in it (T,), generalised force f (T, vectors, dim)."""

    element: np.ndarray
    x: np.ndarray
    f: np.ndarray


class FluidPart(NamedTuple):
    """Action of a fluid on a part of an element at the n points of its rule.

    density (T, n, 3): N/m; on_slope (T, n, 3): generalised force per length on r_x, N; M (T, n, dim, dim): added mass,
    kg/m; turning: of a foil; None where absent.
    """

    rule: Rule
    density: np.ndarray
    on_slope: np.ndarray | None = None
    M: np.ndarray | None = None
    turning: Turning | None = None


class CableLoads:
    """The forces on cables between nodes, without gravity and inertia.

    cables: numbers of the cables whose contacts and fluids are collected. By number of the cable: points, spreads, and
    added, the masses of fluids that move with it.
    """

    def __init__(self, scene: SceneData, model: Model, at: Instants, cables: Collection[int]):
        self.scene, self.model, self.at, self.dim = scene, model, at, model.dim
        self.times, self.gravity = len(at.time), at.weight * np.array(scene.gravity)[: self.dim]
        self.points: dict[int, list[PointLoad]] = {}
        self.spreads: dict[int, list[Spread]] = {}
        self.added: dict[int, AddedMass] = {}
        self.cables = cables
        self.number = {cable.name: k for k, cable in enumerate(model.cables)}
        for kind in COUPLINGS:
            collect = COLLECTED.get(kind.name)
            if collect is None:
                self._between_ends(kind.name)
            else:
                collect(self)

    def _add(self, cable: int, element: ArrayLike, x: ArrayLike, f: np.ndarray) -> None:
        of, at = (np.broadcast_to(value, self.times) for value in (element, x))
        self.points.setdefault(cable, []).append(PointLoad(of, at, f))

    def of_mass(self, number: int, mass: PointMass, inertia: np.ndarray) -> PointLoad:
        """Return the inertia of a point mass of a cable, less its weight, as a force on the cable.

        inertia: of the elements, see `ElementForces`.
        """
        cable = self.model.cables[number]
        element, x = cable.mesh.place(min(max(mass.s, 0.0), cable.mesh.total))
        N = on_axis(cable, element, x)[0]
        f = -mass.mass * np.einsum("k,l,tld->tkd", N, N, inertia[:, int(element)])
        return PointLoad(np.broadcast_to(element, self.times), np.broadcast_to(x, self.times), f)

    def _add_at(self, number: int, s: np.ndarray, force: np.ndarray) -> None:
        """Add a force (T, 3) at arc-lengths s (T,) of a cable."""
        cable = self.model.cables[number]
        element, x = cable.mesh.place(np.clip(s, 0.0, cable.mesh.total))
        self._add(number, element, x, on_axis(cable, element, x)[0][:, :, None] * force[:, None, : self.dim])

    def _loads(self) -> None:
        for load in self.scene.loads.values():
            on = load.cable if isinstance(load, DistributedForce) else load.on
            if on not in self.number:
                continue
            scale = self.at.load * load.factor(self.at.time, self.at.happened)
            if isinstance(load, DistributedForce):
                self._distributed(load, self.number[on], scale)
                continue
            cable = self.model.cables[self.number[on]]
            if isinstance(load, Force) and isinstance(load.s, Signal):
                self._moving(load, self.number[on], scale)
                continue
            assert isinstance(load.s, float), f"{load.where} is not complete"
            element, x = cable.mesh.place(load.s)
            if isinstance(load, Moment):
                component = np.array(load.value)[slice(2, 3) if self.dim == 2 else slice(0, 3)]
                f = self._turning(cable, "moment", element, x, component)
            else:
                f = self._force(cable, element, x, np.array(load.value), load.follower)
            self._add(self.number[on], element, x, scale[:, None, None] * f)

    def _moving(self, load: Force, number: int, scale: np.ndarray) -> None:
        """Add the axles of a load that moves along a cable."""
        cable, value = self.model.cables[number], np.array(load.value)
        for at, share in load.axles_at(self.at.time, cable.mesh.total):
            element, x = cable.mesh.place(at)
            f = self._force(cable, element, x, value, load.follower)
            self._add(number, element, x, (share * scale)[:, None, None] * f)

    def _turning(self, cable: CableModel, kernel: str, element: ArrayLike, x: ArrayLike, c: np.ndarray) -> np.ndarray:
        """Return the generalised force (T, vectors, dim) of a load that turns with the section."""
        e = element_coordinates(cable, self.at.q, np.broadcast_to(element, self.times))
        length = np.broadcast_to(cable.mesh.each_length(element), self.times)
        found: np.ndarray = cable.kernel(kernel).rows(self.times, length, x, e, c)[0]
        return found

    def _force(self, cable: CableModel, element: ArrayLike, x: ArrayLike, value: np.ndarray, follower: bool
               ) -> np.ndarray:
        """Return the generalised force (T, vectors, dim) of a force along the ground's axes, or the local ones."""
        if follower:
            components = cable.kernel("follower_force").shapes["c"][0]
            return self._turning(cable, "follower_force", element, x, value[:components])
        f = on_axis(cable, element, x)[0][..., None] * value[: self.dim]
        return np.broadcast_to(f, (self.times, *f.shape[-2:]))

    def _distributed(self, load: DistributedForce, number: int, scale: np.ndarray) -> None:
        cable, value = self.model.cables[number], np.array(load.value)
        assert load.start is not None and load.stop is not None, f"{load.where} is not complete"
        is_r = positions(cable)
        for element, start, stop in cable.mesh.covered(load.start, load.stop):
            half = (stop - start) / 2
            places, weights = gauss(GAUSS_POINTS)
            places = (start + stop) / 2 + half * places
            each = [scale[:, None, None] * self._force(cable, element, x, value, load.follower) for x in places]
            density = spatial(np.stack([f[:, is_r].sum(axis=1) for f in each], axis=1))
            f = sum(half * w * part for w, part in zip(weights, each, strict=True))
            self.spreads.setdefault(number, []).append(
                Spread(element, start, stop, places, half * weights, density, np.asarray(f)))

    @cached_property
    def _engine(self) -> Engine:
        return Engine(self.model)

    def _at_points(self, *shape: int, compute: Callable[..., tuple[np.ndarray, ...]]) -> list[np.ndarray]:
        """Return compute(n, t, q, v) at n points of quadrature, each (T, elements, points, ...).

        shape: (elements, points).
        """
        each = [compute(shape[0] * shape[1], t, q, v)
                for t, q, v in zip(self.at.time, self.at.q, self.at.v, strict=True)]
        return [np.stack(values).reshape(self.times, *shape, *values[0].shape[1:])
                for values in zip(*each, strict=True)]

    def _drags(self) -> None:
        """Add drag, buoyancy, and the inertia of fluids without the accelerations of the cables."""
        for name, end in {drag.name: drag.attachments[0] for drag in self.model.drags if drag.on_cable}.items():
            self._on_end(end, self.at.value(f"{name}.force"), None)
        for number, drag in enumerate(self.model.drags):
            if drag.cable not in self.cables:
                continue
            cable = self.model.cables[drag.cable]
            for part in (self._immersed if drag.wet == "all" else self._wet)(number, drag, cable):
                slope, turning = part.on_slope, part.turning
                if turning is not None:
                    turning = Turning(*(self.at.load * getattr(turning, field.name) for field in fields(turning)))
                spread = part.rule.spread(self.dim, self.at.load * part.density,
                                          None if slope is None else self.at.load * slope, turning)
                self.spreads.setdefault(drag.cable, []).append(spread)
                if part.M is not None:
                    self.added.setdefault(drag.cable, AddedMass(cable, [])).parts.append((part.rule, part.M))

    def _immersed(self, number: int, drag: DragModel, cable: CableModel) -> Iterator[FluidPart]:
        """Yield the parts of a cable in a fluid without a surface: its elements."""
        density, turning = densities(self.model, drag, self.at.time, self.at.q, self.at.v)
        on_slope = M = None
        if drag.has_inertia:
            force, on_slope, M = self._at_points(
                drag.n_elements, drag.n_points, compute=lambda *at: self._engine.added_mass_densities(number, *at))
            density = density + force
        for k, rule in enumerate(rules_of(cable, drag)):
            turned = None if turning is None else Turning(*(getattr(turning, field.name)[:, k]
                                                            for field in fields(turning)))
            yield FluidPart(rule, density[:, k], None if on_slope is None else on_slope[:, k],
                            None if M is None else M[:, k], turned)

    def _wet(self, number: int, drag: DragModel, cable: CableModel) -> Iterator[FluidPart]:
        """Yield the wet parts of a cable that surfaces of fluids cut, at one instant: each instant has its own."""
        assert self.times == 1, "wet parts are those of one instant"
        (t,), (q,), (v,) = self.at.time, self.at.q, self.at.v
        found = self._engine.drag_densities(number, drag.n_elements, t, q, v)
        density, on_slope, M = found[:, 4:], None, None
        if len(found) and drag.has_inertia:
            force, on_slope, M = self._engine.added_mass_densities(number, len(found), t, q, v)
            density = density + force
        changes = np.flatnonzero(np.any(np.diff(found[:, :2], axis=0) != 0, axis=1)) + 1  # of element or part
        for rows in np.split(np.arange(len(found)), changes) if len(found) else []:
            rule = Rule.between_cuts(cable, int(found[rows[0], 0]), found[rows, 2], found[rows, 3])
            yield FluidPart(rule, density[rows][None], None if on_slope is None else on_slope[rows][None],
                            None if M is None else M[rows][None])

    def _ices(self) -> None:
        """Add the weight and the mass of ice."""
        for ice in self.model.ices:
            if ice.cable not in self.cables:
                continue
            cable, mass = self.model.cables[ice.cable], ice.mass_at(self.at.time)
            weight = self.at.load * spatial(mass[:, None] * ice.gravity)
            M = mass[:, None, None] * np.eye(self.dim)
            for rule in rules_of(cable, ice):
                points = len(rule.x)
                self.spreads.setdefault(ice.cable, []).append(
                    rule.spread(self.dim, np.repeat(weight[:, None], points, axis=1)))
                self.added.setdefault(ice.cable, AddedMass(cable, [])).parts.append(
                    (rule, np.repeat(M[:, None], points, axis=1)))

    def _contacts(self) -> None:
        """Add the pressure of surfaces; `out_of_balance` says which contacts are known."""
        for number, contact in enumerate(self.model.contacts):
            if contact.cable not in self.cables:
                continue
            cable = self.model.cables[contact.cable]
            density, = self._at_points(
                contact.n_elements, contact.n_points,
                compute=lambda *at, number=number: (self._engine.contact_densities(number, *at),))
            self.spreads.setdefault(contact.cable, []).extend(
                rule.spread(self.dim, density[:, k]) for k, rule in enumerate(rules_of(cable, contact)))

    def _slides(self) -> None:
        """Add riders: their force at s and its opposite on the rider; and moments of slides that keep axes."""
        for slide in self.model.slides:
            force = self.at.value(f"{slide.name}.force")
            if slide.cable >= 0:
                self._add_at(slide.cable, self.at.value(f"{slide.name}.s"), -force)
            self._on_end(slide.rider, force, None)
        for joint in self.model.joints:
            if joint.slide is None:
                continue
            moment = self.at.value(f"{joint.slide}.moment")
            slide = next(each for each in self.model.slides if each.name == joint.slide)
            if slide.cable >= 0:
                cable = self.model.cables[slide.cable]
                element, x = cable.mesh.place(np.clip(self.at.value(f"{joint.slide}.s"), 0.0, cable.mesh.total))
                self._add(slide.cable, element, x, self._couple(cable, joint.attachments[0], element, x, -moment))
            self._on_end(joint.attachments[1], None, moment)

    def _joints(self) -> None:
        for joint in self.model.joints:
            if not joint.is_of_scene or all(end.cable < 0 for end in joint.attachments):
                continue
            force, moment = self.at.value(f"{joint.name}.force"), self.at.value(f"{joint.name}.moment")
            one, other = joint.attachments[::-1] if joint.reversed else joint.attachments
            self._on_end(other, force, moment)
            if one.cable >= 0:  # balances the moment of the other end, and the forces if the ends are apart
                gap = self._end_point(other) - self._end_point(one)
                self._on_end(one, -force, -moment - np.cross(gap, force))

    def _end_point(self, end: AttachmentModel) -> np.ndarray:
        """Return the position (T, 3) of an end, m."""
        if end.body < 0:
            return attachment_points(self.model, end, self.at.q)
        body = self.model.bodies[end.body]
        arm = body.centre + end.u
        if end.modal is not None:
            arm = spatial(end.modal[0] + self.at.value(f"{body.name}.modal_coordinates") @ end.modal[1])
        arm = rotate(self.at.value(f"{body.name}.orientation"), arm)
        return np.asarray(self.at.value(f"{body.name}.position") + arm)

    def _between_ends(self, kind: str) -> None:
        """Add the force of each coupling of a kind on its first end, and the opposite on a second one.

        Raises SceneError for a coupling that acts on cables in another way.
        """
        for coupling in self.model.couplings:
            if coupling.type != kind or not (coupling.along or any(end.cable >= 0 for end in coupling.ends)):
                continue
            if coupling.along or len(coupling.ends) > 2:
                raise SceneError(f'{kind} "{coupling.name}"', "acts on a cable, and no balance of forces knows how",
                                 'take method="constitutive", which follows from the strains')
            force = self.at.value(f"{coupling.name}.force")
            for end, sign in zip(coupling.ends, (1.0, -1.0), strict=False):
                self._on_end(end, sign * force, None)

    def _crossings(self) -> None:
        """Add contact forces at closest points, with the opposite on the other cable."""
        for crossing in self.model.crossings:
            force = self.at.value(f"{crossing.name}.force")
            for number, sign, quantity in zip(crossing.cables, (1.0, -1.0), ("s", "s_b"), strict=True):
                if number >= 0:
                    self._add_at(number, self.at.value(f"{crossing.name}.{quantity}"), sign * force)

    def _on_end(self, end: AttachmentModel, force: np.ndarray | None, moment: np.ndarray | None) -> None:
        """Add a force and a moment (T, 3) at an attachment on a cable; others are skipped."""
        if end.cable < 0:
            return
        cable = self.model.cables[end.cable]
        x = self._x_of(cable, end)
        f = np.zeros((self.times, len(end.N), self.dim))
        if force is not None:
            f = f + end.N[:, None] * force[:, None, : self.dim]
        if moment is not None and end.frame:
            f = f + self._couple(cable, end, np.full(self.times, end.element), np.full(self.times, x), moment)
        self._add(end.cable, end.element, x, f)

    def _couple(self, cable: CableModel, end: AttachmentModel, element: np.ndarray, x: np.ndarray,
                moment: np.ndarray) -> np.ndarray:
        """Return (T, vectors, dim): T' m of a moment m (T, 3) on the frame of an attachment to a cable."""
        e = element_coordinates(cable, self.at.q, element)
        S = of_slopes(cable, element, x)
        e_local = e - np.where(positions(cable)[:, None], e[:, :1], 0.0)
        vectors = []
        for slope in end.slopes:
            if slope >= 0:
                vectors.append(np.einsum("tk,tkd->td", S[:, slope], e_local))
            else:
                vectors.append(np.broadcast_to(np.asarray(end.up, dtype=float)[: self.dim], (self.times, self.dim)))
        if end.slopes[1] == CARRIED:  # any transverse direction serves: it turns with the tangent
            vectors[1] = across(vectors[0])
        if self.dim == 2 and end.slopes[1] == UP:
            vectors[1] = np.zeros_like(vectors[0])
        m = moment[:, 2:] if self.dim == 2 else moment
        kernel: Any = getattr(kernels_of(None), f"{end.frame}_moment")
        g = kernel.rows(self.times, *vectors, m)[0].reshape(self.times, 2, self.dim)
        return np.asarray(sum(S[:, slope, :, None] * g[:, k, None] for k, slope in enumerate(end.slopes) if slope >= 0))

    @staticmethod
    def _x_of(cable: CableModel, end: AttachmentModel) -> float:
        """Return x of an attachment in its element: its shape functions reproduce the points of a straight line."""
        length, n = cable.mesh.length(end.element), len(cable.vectors)
        straight = np.array([1.0 if name == "r_x" else length if name == "r" and k >= n else 0.0
                             for k, name in enumerate(cable.vectors * 2)])
        return float(np.clip(end.N @ straight, 0.0, length))


COLLECTED: dict[str, Callable[[CableLoads], None]] = {
    "dead load": CableLoads._loads, "slide": CableLoads._slides, "joint": CableLoads._joints,
    "drag": CableLoads._drags, "ice": CableLoads._ices, "crossing": CableLoads._crossings,
    "contact": CableLoads._contacts}
"""Methods by kind of coupling, "dead load" for all loads. Other kinds act on one end, or on two by opposite forces."""


def across(tangent: np.ndarray) -> np.ndarray:
    """Return unit vectors (T, dim) orthogonal to others."""
    axis = np.eye(tangent.shape[-1])[np.argmin(np.abs(tangent), axis=-1)]
    part = axis - tangent * (np.sum(axis * tangent, axis=-1) / np.sum(tangent**2, axis=-1))[:, None]
    return np.asarray(part / np.linalg.norm(part, axis=-1)[:, None])
