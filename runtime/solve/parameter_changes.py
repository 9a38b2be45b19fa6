"""What parameters change of the residual at a state of rest, where they change few of its equations.

A unit of a load, a weight, a length or a place adds the forces f to those on all dofs and g to the equations of
couplings; a unit of what a motion prescribes moves the prescribed dofs by c. So by the unknowns x

    dR/dp = T' (f + K c) + g,    q = T x + c p,

with K the tangent over all dofs, and T that of the dofs by the unknowns (model/unknowns.py). Where a cable becomes
longer, x are the coordinates by which its points stay (solve/cable_changes.py).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from functools import singledispatchmethod
from typing import Any, cast

import numpy as np
from scipy.sparse import csc_array, csr_array

from ..engine import Engine
from ..errors import SceneError
from ..model.attachments import AttachmentBuilder
from ..model.bodies import body_gravity
from ..model.border import ACCELERATIONS, NEWTON, elimination
from ..model.cables import cable_gravity
from ..model.loads import LoadBuilder
from ..model.model import CableModel, Model
from ..model.numbering import as_drawn
from ..model.states import attachment_points
from ..model.unknowns import by_unknowns
from ..parts.arc_lengths import on_cables
from ..parts.attachment import Attachment
from ..parts.cable import Cable
from ..parts.laid import turned
from ..parts.load import DistributedForce, Force, Moment
from ..parts.part import Part
from ..parts.paths import COMPONENTS, Path, changes_of, value_at
from ..parts.plane import aligned
from ..parts.point_force import PointForce
from ..parts.rigid_body import RigidBody
from ..parts.support import Motion
from .cable_changes import Own, by_length, same_points
from .snapshots import Reader
from .static_problem import StaticProblem

AnyLoad = Force | DistributedForce | Moment
SLIDING = "slides", "crossings", "drags"
"""Groups of parts that have places on a cable that are no part of its length, or forces of its length and size."""
OF_SECTIONS = "contacts", "crossings", "drags"
"""Groups of parts that depend on the size and the weight of a cable's section."""
STEP = 1e-6
"""Of a number of a section, to either side: where the forces of its cable are differenced."""


@dataclass
class Change:
    """What a unit of a parameter adds to the forces on the dofs, f (n_dof,), and to the equations of couplings, g
    (n_extra,); by how much it moves what is prescribed, c (n_dof,), and by how much the unknowns of a state change
    whose points stay, same (unknowns,); None: nothing.
    """

    f: np.ndarray | None = None
    c: np.ndarray | None = None
    g: np.ndarray | None = None
    same: np.ndarray | None = None

    def less(self, factor: float, other: Change) -> Change:
        """Return this without so many times the forces and equations that another parameter changes."""
        return replace(self, f=_less(self.f, factor, other.f), g=_less(self.g, factor, other.g))


class Changes:
    """What parameters change at a state of rest.

    found: by the number of a parameter, of those that enter the residual linearly.
    """

    def __init__(self, problem: StaticProblem, paths: Mapping[int, Path], reader: Reader):
        """paths: of parameters, by their numbers; reader: of the values asked for, which depend on some parameters
        themselves: forces in sections of cables on loads.
        """
        self.problem, self.scene, self.model, self.reader = problem, problem.scene, problem.model, reader
        self.of_sections = reader.sections
        self.found: dict[int, Change] = {}
        parts = list(self.scene.as_drawn.parts())
        loads: dict[int, AnyLoad] = {}
        for k, path in paths.items():
            part = None if path.part is None else parts[path.part]
            if isinstance(part, Force | DistributedForce | Moment) and path.entries[0] == "value":
                if (unit := self._unit(part, path.entries)) is not None:
                    loads[k] = unit
            elif (change := self._gravity(path) if part is None else self._of(part, path)) is not None:
                self.found[k] = change
        self.found |= self._of_loads(loads)
        self._keep_places(paths)

    def columns(self) -> dict[int, np.ndarray]:
        """Return dR/dp (unknowns,) of each parameter found."""
        model = self.model
        forces = {k: np.zeros(model.n_dof + model.n_extra) for k in self.found}
        moves = any(change.c is not None for change in self.found.values())
        K = self._tangent_over_dofs() if moves else None
        for k, change in self.found.items():
            if change.f is not None:
                forces[k][: model.n_dof] += change.f
            if change.c is not None:
                assert K is not None, "what is prescribed moves"
                forces[k] += K[:, : model.n_dof] @ change.c
            if change.g is not None:
                forces[k][model.n_dof :] += change.g
        by_unknowns = _by_unknowns(model).T
        return {k: by_unknowns @ force for k, force in forces.items()}

    def _keep_places(self, paths: Mapping[int, Path]) -> None:
        """Take off what lengths of cables change by places along them that are parameters, too, and stay where they
        are; a length with such a place for which nothing is found is left out.
        """
        parts = list(self.scene.as_drawn.parts())
        for k, path in paths.items():
            cable = None if path.part is None else parts[path.part]
            change = self.found.get(k)
            if not isinstance(cable, Cable) or path.entries != ("rest_length",) or change is None:
                continue
            for j, other in paths.items():
                s = None if other.part is None else _place(parts[other.part], other, cable.name)
                if s is not None:
                    change = None if change is None or j not in self.found else change.less(s / cable.length,
                                                                                            self.found[j])
            if change is None:
                del self.found[k]
            else:
                self.found[k] = change

    def along(self, component: str) -> np.ndarray | None:
        """Return an axis of the ground along the axes of the model, (dim,); None where it leaves the plane."""
        direction = np.array(_axis(component))
        if self.scene.plane_axes is not None:
            direction = aligned(self.scene.plane_axes.plane.into(direction))
        stays = direction.any() and not direction[self.model.dim :].any()
        return direction[: self.model.dim] if stays else None

    def _weighs_plainly(self, *names: str) -> bool:
        """Return whether weight is a force of constant direction on each dof, and nothing else depends on that of these
        cables and bodies, as the stiffness of a contact does where none is given.
        """
        found = any(contact.a in names and contact.as_made().stiffness is None and not contact.is_hard
                    for contact in self.scene.contacts.values())
        return not (found or self.of_sections or self.scene.drags or any(body.modes for body in self.model.bodies))

    def _gravity(self, path: Path) -> Change | None:
        """Return what a component of gravity changes, None where the path is of something else."""
        direction = self.along(path.entries[0])
        hanging = [cable for cable in self.scene.cables.values() if cable.shape == "hanging"]
        if path.head != "gravity" or direction is None or not self._weighs_plainly(*self.scene.cables,
                                                                                   *self.scene.bodies):
            return None
        if any(self._names(cable.name, SLIDING) or not self._hangs_plainly(cable) for cable in hanging):
            return None
        cables = [cable_gravity(model, self.scene.cables[model.name], direction) for model in self.model.cables]
        bodies = [body_gravity(body, direction) for body in self.model.bodies]
        return Change(-np.concatenate([*cables, *bodies]))

    @singledispatchmethod
    def _of(self, part: Part, path: Path) -> Change | None:
        """Return what an entry of a part changes, None where it changes more than `Change` has."""
        return None

    @_of.register
    def _of_cable(self, part: Cable, path: Path) -> Change | None:
        cable = self.scene.cables[part.name]
        if path.entries == ("material", "density"):
            f = np.zeros(self.model.n_dof)
            at = self._model_of(cable).coordinates
            f[at] = -self.model.gravity[at] / cable.material.density
            return Change(f) if self._weighs_plainly(cable.name) else None
        if self.of_sections or cable.name in self.reader.parts:
            return None
        if path.entries == ("rest_length",):
            return self._of_length(cable) if self._lengthens_plainly(cable) else None
        if path.entries[0] not in ("section", "material") or self._names(cable.name, OF_SECTIONS):
            return None
        return self._of_section(cable, path)

    @_of.register
    def _of_body(self, part: RigidBody, path: Path) -> Change | None:
        if path.entries != ("mass",) or not self._weighs_plainly(part.name):
            return None
        model = next(body for body in self.model.bodies if body.name == part.name)
        f = np.zeros(self.model.n_dof)
        dofs = slice(model.dof, model.dof + self.model.dim)
        f[dofs] = -self.model.gravity[dofs] / part.mass
        return Change(f)

    @_of.register
    def _of_motion(self, part: Motion, path: Path) -> Change | None:
        entries = path.entries
        direction = self.along(entries[1]) if len(entries) == 2 and entries[0] == "displacement" else None
        if direction is None:
            return None
        model, c = self.model, np.zeros(self.model.n_dof)
        node = model.nodes[part.cable][self.scene.cables[part.cable].node(part.s)]
        moved = dict(zip(node.dofs("r"), direction.tolist(), strict=True))
        signals = {motion.signal: moved[motion.dof] for motion in model.motions if moved.get(motion.dof)}
        for motion in model.motions:
            c[motion.dof] += motion.linear * signals.get(motion.signal, 0.0)
        return Change(c=c)

    @_of.register
    def _of_point_force(self, part: PointForce, path: Path) -> Change | None:
        """Return what changes where an end on the ground or its place along a cable does: the gap of its law, and where
        its force acts; None where the law itself is that of a gap as drawn.
        """
        model, ends = self.model, {"a": part.a, "b": part.b}
        place = ends.get(path.entries[0])
        if place is None or len(path.entries) != 2 or part.name in self.reader.parts or part.as_made() is not part:
            return None
        number = next(k for k, force in enumerate(model.point_forces) if force.name == part.name)
        force, kept = model.point_forces[number], self.problem.keep()
        sign, f = -1.0 if path.entries[0] == "a" else 1.0, np.zeros(model.n_dof)
        if place.on is None:
            moved = self.along(path.entries[1])
            if moved is None:
                return None
        elif place.on in self.scene.cables and not self.of_sections:
            N, at = self._shape(place.on, place.arc_length, derivative=1)
            moved = N @ kept["q"][at].reshape(len(N), model.dim)
            f[at] = sign * np.outer(N, kept["point_force"][number][: model.dim]).ravel()
        else:
            return None
        a, b = (attachment_points(model, end, kept["q"][None])[0, : model.dim] for end in force.attachments)
        g = np.zeros(model.n_extra)
        g[force.unknown : force.unknown + model.dim] = -sign * force.tangent_at_rest(b - a) @ moved
        return Change(f, g=g)

    @_of.register(Force)
    @_of.register(DistributedForce)
    def _of_place(self, part: Force | DistributedForce, path: Path) -> Change | None:
        """Return what the place of a load along a cable changes: of a distributed one, where it begins or ends."""
        load = next(mine for mine, drawn in zip(self.scene.parts(), self.scene.as_drawn.parts(), strict=True)
                    if drawn is part)
        s = getattr(load, path.entries[0]) if path.entries[0] in ("s", "start", "stop") else None
        on = getattr(load, "cable", None) or getattr(load, "on", None)
        if s is None or on not in self.scene.cables or self.of_sections or load.follower:
            return None
        N, at = self._shape(on, s, derivative=int(path.entries[0] == "s"))
        value = float(load.scale.value(0.0)) * np.array(load.value)[: self.model.dim]
        f = np.zeros(self.model.n_dof)
        f[at] = (1.0 if path.entries[0] == "start" else -1.0) * np.outer(N, value).ravel()
        return Change(f)

    def _shape(self, cable: str, s: float, derivative: int = 0) -> tuple[np.ndarray, slice]:
        """Return the shape functions (vectors,) at s on a cable, or their derivatives, and the dofs of its element."""
        model = next(each for each in self.model.cables if each.name == cable)
        element = int(model.mesh.element_at(s))
        N = model.kernel("on_axis")(model.mesh.length(element), s - model.mesh.start(element))[derivative]
        first = model.first + element * model.shape[1] * model.shape[2]
        return N, slice(first, first + len(N) * model.shape[2])

    def _model_of(self, cable: Cable) -> CableModel:
        return next(model for model in self.model.cables if model.name == cable.name)

    def _names(self, cable: str, groups: Iterable[str]) -> bool:
        """Return whether a part of these groups of the scene is on a cable."""
        return any(cable in _named(part) for group in groups for part in getattr(self.scene, group).values())

    def _lengthens_plainly(self, cable: Cable) -> bool:
        """Return whether all that is on a cable keeps its part of the length, and nothing else depends on that.

        What slides on it has its arc-length as a coordinate. What is tied rigidly to it shares its slopes. One that
        hangs is drawn otherwise where it is longer.
        """
        scene, name = self.scene, cable.name
        rigid = any(tie.rotation == "rigid" and name in (tie.cable, tie.to) for tie in scene.ties.values())
        touches = [contact for contact in scene.contacts.values() if contact.a == name]
        if rigid or self._names(name, SLIDING) or any(contact.name in self.reader.parts for contact in touches):
            return False
        return cable.shape != "hanging" or self._hangs_plainly(cable)

    def _hangs_plainly(self, cable: Cable) -> bool:
        """Return whether nothing on a cable depends on how it hangs as it is drawn."""
        scene, model, name = self.scene, self._model_of(cable), cable.name
        held = self.model.unknown_of_dof[model.coordinates].reshape(model.shape) < 0
        held[[0, -1], model.vectors.index("r")] = False
        rough = any(contact.a == name and contact.friction is not None for contact in scene.contacts.values())
        as_drawn = any(name in _named(force) and force.as_made() is not force for force in scene.point_forces.values())
        tied = any(name in (tie.cable, tie.to) for tie in scene.ties.values())
        return not (held.any() or rough or as_drawn or tied or self._names(name, ("joints",)))

    def _of_length(self, cable: Cable) -> Change:
        """Return what the length of a cable changes: all that acts on each length of it."""
        model, q = self._model_of(cable), self.problem.keep()["q"]
        at, f = model.coordinates, np.zeros(self.model.n_dof)
        f[at] = by_length(model, cable, q) - self.model.gravity[at]
        spread = {k: load for k, load in enumerate(self.scene.loads.values())
                  if isinstance(load, DistributedForce) and load.cable == cable.name}
        for k in spread:
            change = self._of_loads({k: spread[k]})[k]
            assert change.f is not None, "loads are forces"
            f += change.f
        f += self._touching(self.model.cables.index(model))
        same, unknown = np.zeros(len(self.problem.weight)), self.model.unknown_of_dof[at]
        free = unknown >= 0
        same[unknown[free]] = same_points(model, q)[free]
        return Change(f / cable.length, same=same / cable.length)

    def _touching(self, cable: int) -> np.ndarray:
        """Return (n_dof,): what surfaces that a cable touches give to the residual."""
        model = self.model
        if not any(contact.cable == cable for contact in model.contacts):
            return np.zeros(model.n_dof)
        doubled = [replace(contact, stiffness=2 * contact.stiffness, tangential=2 * contact.tangential)
                   if contact.cable == cable else contact for contact in model.contacts]
        found = []
        for contacts in (model.contacts, doubled):
            engine = self._engine(_with(model, contacts=contacts))
            engine.static_residual()
            found.append(engine.reaction())
        return np.asarray(found[1] - found[0])

    def _of_section(self, cable: Cable, path: Path) -> Change | None:
        """Return what a number of a cable's section or material changes: its elastic forces and weight, differenced,
        exactly by Young's modulus, in which they are linear at a given Poisson ratio by the laws of this package.
        """
        model, drawn = self._model_of(cable), self.scene.as_drawn
        value = value_at(drawn, path)
        linear = (path.entries == ("material", "youngs_modulus") and cable.material.poisson_ratio is not None
                  and cable.library is None)
        h = abs(value) if linear else STEP * abs(value) or STEP
        ends = (value, value + h) if linear else (value - h, value + h)
        assert path.part is not None, f"{path.text} is of a cable"
        if path.entries[0] == "section" and self.scene.drags:
            return None
        own = Own(model, self.problem.keep()["q"], np.array(self.scene.gravity)[: self.model.dim])
        try:
            below, above = (own.of(cable.remade(changes_of(drawn, {path: end})[path.part])) for end in ends)
        except SceneError:  # at the edge of what a section or a material takes
            return None
        f = np.zeros(self.model.n_dof)
        f[model.coordinates] = (above - below) / (ends[1] - ends[0])
        return Change(f)

    def _unit(self, part: AnyLoad, entries: tuple[str, ...]) -> AnyLoad | None:
        """Return a load whose value is a unit along one axis, None where the entry is of something else."""
        if len(entries) != 2 or entries[0] != "value" or self.of_sections:
            return None
        unit = part.model_copy(update={"value": _axis(entries[1])})
        if self.scene.plane_axes is not None:
            unit = cast(AnyLoad, turned(unit, self.scene.plane_axes, self.scene.as_drawn))
        return unit if any(unit.value) and not (self.model.dim == 2 and any(unit.off_plane())) else None

    def _of_loads(self, units: Mapping[int, AnyLoad]) -> dict[int, Change]:
        """Return what loads of unit values change, by the numbers of their parameters."""
        if not units:
            return {}
        model = self.model
        builder = LoadBuilder(self.scene, AttachmentBuilder(self.scene, model.cables, model.bodies))
        builder.signals = list(model.signals)
        owners: dict[str, list[int]] = {"dead": [], "turning": []}
        for k, unit in units.items():
            builder.load(unit)
            owners["dead"] += [k] * (len(builder.dead) - len(owners["dead"]))
            owners["turning"] += [k] * (len(builder.turning) - len(owners["turning"]))
        loaded = _with(model, loads=[*builder.dead, *builder.turning], signals=builder.signals)
        engine = self._engine(loaded)
        found = {k: np.zeros(model.n_dof) for k in units}
        for number, k in enumerate([*owners["dead"], *owners["turning"]]):
            found[k] += engine.external_forces(number, number + 1)[0]
        return {k: Change(f) for k, f in found.items()}

    def _tangent_over_dofs(self) -> csc_array:
        """Return dR/dx at the state where each dof is an unknown of its own: (n_dof + own of couplings, the same)."""
        model = self.model
        n = model.cables[-1].coordinates.stop
        elements = np.array([(node.first, 2 * node.vectors.size) for nodes in model.nodes.values()
                             for node in nodes[:-1]], dtype=int).reshape(-1, 2)
        numbering = as_drawn(elements, np.arange(n))
        free = _with(model, motions=[], unknown_of_dof=np.arange(model.n_dof), combinations=csr_array((0, n)),
                     n_band=n, n_border_dof=model.n_dof - n, width=numbering.width, chains=numbering.chains)
        free.newton, free.accelerations = elimination(free, NEWTON), elimination(free, ACCELERATIONS)
        return self._engine(free).matrix(0.0, 0.0, 1.0)

    def _engine(self, model: Model) -> Engine:
        """Return an engine of another model of the scene, in the state of the problem."""
        engine = Engine(model)
        engine.redundant_rows([(k, row) for k, joint in enumerate(model.joints) for row in joint.redundant_rows])
        engine.set_state(0.0, **self.problem.keep(), prescribe=False)
        return engine


def _named(part: Part) -> set[str]:
    """Return the names that a part has of others that it is on."""
    return {name for _, value in part for name in (value, getattr(value, "on", None)) if isinstance(name, str)}


def _less(a: np.ndarray | None, factor: float, b: np.ndarray | None) -> np.ndarray | None:
    """Return a - factor b, of which None is nothing."""
    return a if b is None else -factor * b + (0.0 if a is None else a)


def _place(part: Part, path: Path, cable: str) -> float | None:
    """Return the arc-length on a cable that a path to an entry of this part leads to, in m; None where to no such."""
    for keyword, on, s in on_cables(part):
        if (keyword,) == path.entries and on == cable:
            return s
    end = getattr(part, path.entries[0], None)
    return end.s if isinstance(end, Attachment) and end.on == cable else None


def _axis(component: str) -> tuple[float, ...]:
    """Return the unit vector (3,) along an axis, x or 0 and so on; zeros where it is none."""
    return tuple(float(component in (name, str(k))) for name, k in COMPONENTS.items())


def _with(model: Model, **changes: Any) -> Model:
    """Return a model with some arrays or couplings of other values, and the border as it is."""
    made = replace(model, **changes)
    made.newton, made.accelerations = model.newton, model.accelerations
    return made


def _by_unknowns(model: Model) -> csr_array:
    """Return T (n_dof + own of couplings, unknowns): of what unknowns the dofs are made."""
    n = model.n_band + model.n_border_dof
    own = n + np.arange(model.n_extra)
    return by_unknowns(np.append(model.unknown_of_dof, own), model.combinations, n + model.n_extra)
