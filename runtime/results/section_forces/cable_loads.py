"""What acts on cables between their nodes at given instants: loads, springs, joints, riders, as generalised forces."""

from __future__ import annotations

from collections.abc import Callable, Collection
from dataclasses import dataclass, fields
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.rotations import rotate
from ...engine import Engine
from ...errors import SceneError
from ...kernels.libraries import kernels_of
from ...model.attachments import CARRIED, UP, AttachmentModel
from ...model.drag_forces import Turning, densities
from ...model.drags import DragModel
from ...model.element_coordinates import element_coordinates, positions
from ...model.kinds import COUPLINGS
from ...model.loads import GAUSS
from ...model.model import CableModel, Model
from ...model.states import attachment_points, spatial
from ...parts.load import DistributedForce, Moment
from ...parts.scene_data import SceneData
from .spreads import AddedMass, Spread, at_element, lengths_of_rows, rows, shape_on_axis, spread_along
from .wet_parts import AddedOfParts, WetPart

if TYPE_CHECKING:
    from numpy.typing import ArrayLike  # 9 ms, and for type checkers alone

@dataclass
class Instants:
    """A scene at T instants: q (T, n_q), v (T, n_dof) of the cables, nil of bodies, and quantities of its parts.

    value(name): a result by name, (T, ...); load, weight: how much of the loads and of gravity is on; is_rest: whether
    it is a state of rest.
    """

    time: np.ndarray
    q: np.ndarray
    v: np.ndarray
    value: Callable[[str], np.ndarray]
    load: float = 1.0
    weight: float = 1.0
    is_rest: bool = False

    def one(self, k: int) -> Instants:
        """Return instant number k alone."""
        here = slice(k, k + 1)
        return Instants(self.time[here], self.q[here], self.v[here], lambda name: self.value(name)[here], self.load,
                        self.weight, self.is_rest)


@dataclass
class PointLoad:
    """A force at a place of a cable: element and x (m) in it (T,), generalised force f (T, vectors, dim)."""

    element: np.ndarray
    x: np.ndarray
    f: np.ndarray


def _parts(found: np.ndarray) -> list[np.ndarray]:
    """Return the numbers of the rows of each part, of rows that begin with the numbers of element and part."""
    changes = np.flatnonzero(np.any(np.diff(found[:, :2], axis=0) != 0, axis=1)) + 1
    return [rows_of for rows_of in np.split(np.arange(len(found)), changes) if len(rows_of)]


class CableLoads:
    """Collects what acts on cables between nodes. Gravity, inertia and what is given to nodes are not in it.

    cables: numbers of those whose contacts and fluids are of interest. added: masses of fluids that move with them.
    """

    def __init__(self, scene: SceneData, model: Model, at: Instants, cables: Collection[int]):
        self.scene, self.model, self.at, self.dim = scene, model, at, model.dim
        self.times, self.gravity = len(at.time), at.weight * np.array(scene.gravity)[: self.dim]
        self.points: dict[int, list[PointLoad]] = {}
        self.spreads: dict[int, list[Spread]] = {}
        self.added: dict[int, Any] = {}  # AddedMass, or AddedOfParts of a cable that surfaces cut; else it has one drag
        self.cables = cables
        names = [cable.name for cable in model.cables]
        self.number = {name: k for k, name in enumerate(names)}
        for kind in COUPLINGS:
            collect = COLLECTED.get(kind.name)
            if collect is None:
                self._between_ends(kind.name)
            else:
                collect(self)

    def _add(self, cable: int, element: ArrayLike, x: ArrayLike, f: np.ndarray) -> None:
        of, at = (np.broadcast_to(value, self.times) for value in (element, x))
        self.points.setdefault(cable, []).append(PointLoad(of, at, f))

    def _loads(self) -> None:
        for load in self.scene.loads.values():
            on = load.cable if isinstance(load, DistributedForce) else load.on
            if on not in self.number:
                continue
            scale = self.at.load * load.scale.value(self.at.time)
            if isinstance(load, DistributedForce):
                self._distributed(load, self.number[on], scale)
                continue
            cable = self.model.cables[self.number[on]]
            assert load.s is not None, f"{load.where} is not complete"
            element, x = at_element(cable, load.s)
            if isinstance(load, Moment):
                component = np.array(load.value)[slice(2, 3) if self.dim == 2 else slice(0, 3)]
                f = self._turning(cable, "moment", element, x, component)
            else:
                f = self._force(cable, element, x, np.array(load.value), load.follower)
            self._add(self.number[on], element, x, scale[:, None, None] * f)

    def _turning(self, cable: CableModel, kernel: str, element: np.ndarray | int, x: np.ndarray | float,
                 c: np.ndarray) -> np.ndarray:
        """Return (T, vectors, dim): of a load that turns with the section."""
        e = element_coordinates(cable, self.at.q, np.broadcast_to(element, self.times))
        length = lengths_of_rows(cable.mesh, element, (self.times,))
        return rows(cable.kernel(kernel), self.times, length, x, e, c)[0]

    def _force(self, cable: CableModel, element: np.ndarray | int, x: np.ndarray | float, value: np.ndarray,
               follower: bool) -> np.ndarray:
        """Return (T, vectors, dim): of a force along the ground's axes, or the local ones."""
        if follower:
            return self._turning(cable, "follower_force", element, x, value[: self._follower_components(cable)])
        f = np.outer(shape_on_axis(cable, element, x), value[: self.dim])
        return np.broadcast_to(f, (self.times, *f.shape))

    @staticmethod
    def _follower_components(cable: CableModel) -> int:
        return cable.kernel("follower_force").shapes["c"][0]

    def _distributed(self, load: DistributedForce, number: int, scale: np.ndarray) -> None:
        cable, value = self.model.cables[number], np.array(load.value)
        assert load.start is not None and load.stop is not None, f"{load.where} is not complete"
        is_r = positions(cable)
        for element, start, stop in cable.mesh.covered(load.start, load.stop):
            half = (stop - start) / 2
            places = (start + stop) / 2 + half * GAUSS[0]
            each = [scale[:, None, None] * self._force(cable, element, x, value, load.follower) for x in places]
            density = spatial(np.stack([f[:, is_r].sum(axis=1) for f in each], axis=1))
            f = sum(half * w * part for w, part in zip(GAUSS[1], each, strict=True))
            self.spreads.setdefault(number, []).append(Spread(element, start, stop, places, density, f))

    @cached_property
    def _engine(self) -> Engine:
        return Engine(self.model)

    def _at_points(self, n: int, compute: Callable) -> list[np.ndarray]:
        """Return what compute(n, t, q, v) has at n points of quadrature, at all instants: each (T, n, ...)."""
        each = [compute(n, t, q, v) for t, q, v in zip(self.at.time, self.at.q, self.at.v, strict=True)]
        return [np.stack(values) for values in zip(*each, strict=True)]

    def _drags(self) -> None:
        """Add what fluids do to cables: drag, buoyancy, and their inertia but for the accelerations of the cables."""
        for number, drag in enumerate(self.model.drags):
            if drag.cable not in self.cables:
                continue
            cable = self.model.cables[drag.cable]
            if drag.wet != "all":
                self._wet_parts(number, drag, cable)
                continue
            density, turning = densities(self.model, drag, self.at.time, self.at.q, self.at.v)
            density, on_slope = self.at.load * density, None
            if turning is not None:
                turning = Turning(*(self.at.load * getattr(turning, field.name) for field in fields(turning)))
            if drag.has_inertia:
                shape = self.times, cable.n_elements, drag.n_points
                found = self._at_points(shape[1] * shape[2], partial(self._engine.fluid_inertia_densities, number))
                force, on_slope, M = (values.reshape(*shape, *values.shape[2:]) for values in found)
                density, on_slope = density + self.at.load * force, self.at.load * on_slope
                self.added[drag.cable] = AddedMass(M, drag)
            self.spreads.setdefault(drag.cable, []).extend(spread_along(cable, drag, density, on_slope, turning))

    def _wet_parts(self, number: int, drag: DragModel, cable: CableModel) -> None:
        """Add what a fluid with a surface does to the wet parts of a cable, at one instant: they are others at each."""
        assert self.times == 1, "wet parts are those of one instant"
        (t,), (q,), (v,) = self.at.time, self.at.q, self.at.v
        found = self._engine.drag_densities(number, cable.n_elements, t, q, v)
        density, on_slope, M = self.at.load * found[:, 4:], None, None
        if len(found) == 0:
            return
        if drag.has_inertia:
            force, on_slope, M = self._engine.fluid_inertia_densities(number, len(found), t, q, v)
            density, on_slope = density + self.at.load * force, self.at.load * on_slope
        parts = []
        for rows_of in _parts(found):
            part = WetPart.of(cable, int(found[rows_of[0], 0]), found[rows_of, 2], found[rows_of, 3])
            slope = None if on_slope is None else on_slope[rows_of]
            self.spreads.setdefault(drag.cable, []).append(part.spread(density[rows_of], slope))
            parts.append((part, None if M is None else M[rows_of]))
        if drag.has_inertia:
            self.added.setdefault(drag.cable, AddedOfParts(cable, [])).parts.extend(parts)

    def _contacts(self) -> None:
        """Add what surfaces press on cables with, of which `out_of_balance` tells that it is known."""
        for number, contact in enumerate(self.model.contacts):
            if contact.cable not in self.cables:
                continue
            cable = self.model.cables[contact.cable]
            n = cable.n_elements * contact.n_points
            density, = self._at_points(n, lambda *at, number=number: (self._engine.contact_densities(number, *at),))
            density = density.reshape(self.times, cable.n_elements, contact.n_points, 3)
            self.spreads.setdefault(contact.cable, []).extend(spread_along(cable, contact, density))

    def _slides(self) -> None:
        """Add riders: their force at s, with the opposite on what rides; and moments of slides that keep axes."""
        for slide in self.model.slides:
            force, s = self.at.value(f"{slide.name}.force"), self.at.value(f"{slide.name}.s")
            cable = self.model.cables[slide.cable]
            element, x = at_element(cable, np.clip(s, 0.0, cable.mesh.total))
            N = shape_on_axis(cable, element, x)
            self._add(slide.cable, element, x, -N[:, :, None] * force[:, None, : self.dim])
            self._on_end(slide.rider, force, None)
        for joint in self.model.joints:
            if joint.slide is None:
                continue
            moment = self.at.value(f"{joint.slide}.moment")
            slide = next(each for each in self.model.slides if each.name == joint.slide)
            cable = self.model.cables[slide.cable]
            s = np.clip(self.at.value(f"{joint.slide}.s"), 0.0, cable.mesh.total)
            element, x = at_element(cable, s)
            f = self._couple(cable, joint.attachments[0], element, x, -moment)
            self._add(slide.cable, element, x, f)
            self._on_end(joint.attachments[1], None, moment)

    def _joints(self) -> None:
        for joint in self.model.joints:
            if joint.slide is not None or all(end.cable < 0 for end in joint.attachments):
                continue
            force, moment = self.at.value(f"{joint.name}.force"), self.at.value(f"{joint.name}.moment")
            one, other = joint.attachments[::-1] if joint.reversed else joint.attachments
            self._on_end(other, force, moment)
            if one.cable >= 0:  # its moment balances the other end's, and the forces where these stand apart
                gap = self._end_point(other) - self._end_point(one)
                self._on_end(one, -force, -moment - np.cross(gap, force))

    def _end_point(self, end: AttachmentModel) -> np.ndarray:
        """Return (T, 3): where an end is."""
        if end.body < 0:
            return attachment_points(self.model, end, self.at.q)
        body = self.model.bodies[end.body]
        arm = body.centre + end.u
        if end.modal is not None:
            arm = spatial(end.modal[0] + self.at.value(f"{body.name}.modal_coordinates") @ end.modal[1])
        return self.at.value(f"{body.name}.position") + rotate(self.at.value(f"{body.name}.orientation"), arm)

    def _between_ends(self, kind: str) -> None:
        """Add the force of each coupling of a kind on its first end, and the opposite on a second one.

        Raises SceneError for one that acts on cables in another way.
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
                if number < 0:
                    continue
                cable = self.model.cables[number]
                s = np.clip(self.at.value(f"{crossing.name}.{quantity}"), 0.0, cable.mesh.total)
                element, x = at_element(cable, s)
                N = shape_on_axis(cable, element, x)
                self._add(number, element, x, sign * N[:, :, None] * force[:, None, : self.dim])

    def _on_end(self, end: AttachmentModel, force: np.ndarray | None, moment: np.ndarray | None) -> None:
        """Add a force and a moment (T, 3) on what carries an attachment, where that is a cable."""
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
        """Return (T, vectors, dim): of a moment (T, 3) on the frame that an end has of its cable, T' m."""
        e = element_coordinates(cable, self.at.q, element)
        length = lengths_of_rows(cable.mesh, element, (self.times,))
        S = rows(cable.kernel("slopes"), self.times, length, x)[:, :, 0]  # (T, xyz, vectors)
        e_local = e - np.where(positions(cable)[:, None], e[:, :1], 0.0)
        vectors = []
        for slope in end.slopes:
            if slope >= 0:
                vectors.append(np.einsum("tk,tkd->td", S[:, slope], e_local))
            else:
                vectors.append(np.broadcast_to(np.asarray(end.up, dtype=float)[: self.dim], (self.times, self.dim)))
        if end.slopes[1] == CARRIED:  # any direction across does: it turns with the tangent
            vectors[1] = across(vectors[0])
        if self.dim == 2 and end.slopes[1] == UP:
            vectors[1] = np.zeros_like(vectors[0])
        m = moment[:, 2:] if self.dim == 2 else moment
        kernel = getattr(kernels_of(None), f"{end.frame}_moment")
        g = rows(kernel, self.times, *vectors, m)[0].reshape(self.times, 2, self.dim)
        return sum(S[:, slope, :, None] * g[:, k, None] for k, slope in enumerate(end.slopes) if slope >= 0)

    def _x_of(self, cable: CableModel, end: AttachmentModel) -> float:
        """Return x of an attachment in its element, from its shape functions: those of positions and slopes weigh a
        line's points.
        """
        straight, length = np.zeros(len(end.N)), cable.mesh.length(end.element)
        names = [*cable.vectors, *cable.vectors]
        for k, name in enumerate(names):
            if name == "r_x":
                straight[k] = 1.0
            elif name == "r" and k >= len(cable.vectors):
                straight[k] = length
        return float(np.clip(end.N @ straight, 0.0, length))


COLLECTED: dict[str, Callable[[CableLoads], None]] = {
    "dead load": CableLoads._loads, "slide": CableLoads._slides, "joint": CableLoads._joints,
    "drag": CableLoads._drags, "crossing": CableLoads._crossings, "contact": CableLoads._contacts}
"""What collects the couplings of a kind, "dead load" all loads; others act on one end, or on two by opposite forces."""


def across(tangent: np.ndarray) -> np.ndarray:
    """Return (T, dim): unit vectors square to others."""
    least = np.eye(tangent.shape[-1])[np.argmin(np.abs(tangent), axis=-1)]
    part = least - tangent * (np.sum(least * tangent, axis=-1) / np.sum(tangent**2, axis=-1))[:, None]
    return part / np.linalg.norm(part, axis=-1)[:, None]
