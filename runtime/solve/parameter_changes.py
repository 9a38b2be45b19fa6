"""What parameters change of the residual at a state of rest, where no equation of an element depends on them.

Loads, weights, and what motions prescribe enter R linearly. A unit of such a parameter adds the forces f to those on
all dofs and moves the prescribed ones by c, so that by the unknowns x

    dR/dp = T' (f + K c),    q = T x + c p,

with K the tangent over all dofs, and T that of the dofs by the unknowns (model/unknowns.py).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import singledispatchmethod
from typing import Any, cast

import numpy as np
from scipy.sparse import csc_array, csr_array

from ..engine import Engine
from ..model.attachments import AttachmentBuilder
from ..model.bodies import body_gravity
from ..model.border import ACCELERATIONS, NEWTON, elimination
from ..model.cables import cable_gravity
from ..model.loads import LoadBuilder
from ..model.model import Model
from ..model.numbering import as_drawn
from ..model.unknowns import by_unknowns
from ..parts.cable import Cable
from ..parts.laid import turned
from ..parts.load import DistributedForce, Force, Moment
from ..parts.part import Part
from ..parts.paths import COMPONENTS, Path
from ..parts.plane import aligned
from ..parts.rigid_body import RigidBody
from ..parts.support import Motion
from .static_problem import StaticProblem

AnyLoad = Force | DistributedForce | Moment


@dataclass
class Change:
    """What a unit of a parameter adds to the forces on the dofs, f (n_dof,), and by how much it moves what is
    prescribed, c (n_dof,); None: nothing.
    """

    f: np.ndarray | None = None
    c: np.ndarray | None = None


class Changes:
    """What parameters change at a state of rest.

    found: by the number of a parameter, of those that enter the residual linearly.
    """

    def __init__(self, problem: StaticProblem, paths: Mapping[int, Path], of_sections: bool):
        """paths: of parameters, by their numbers; of_sections: whether forces in sections of cables are asked for,
        which depend on loads themselves.
        """
        self.problem, self.scene, self.model, self.of_sections = problem, problem.scene, problem.model, of_sections
        self.found: dict[int, Change] = {}
        parts = list(self.scene.as_drawn.parts())
        loads: dict[int, AnyLoad] = {}
        for k, path in paths.items():
            part = None if path.part is None else parts[path.part]
            if isinstance(part, Force | DistributedForce | Moment):
                if (unit := self._unit(part, path.entries)) is not None:
                    loads[k] = unit
            elif (change := self._gravity(path) if part is None else self._of(part, path.entries)) is not None:
                self.found[k] = change
        self.found |= self._of_loads(loads)

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
        by_unknowns = _by_unknowns(model).T
        return {k: by_unknowns @ force for k, force in forces.items()}

    def along(self, component: str) -> np.ndarray | None:
        """Return an axis of the ground along the axes of the model, (dim,); None where it leaves the plane."""
        direction = np.array(_axis(component))
        if self.scene.plane_axes is not None:
            direction = aligned(self.scene.plane_axes.plane.into(direction))
        stays = direction.any() and not direction[self.model.dim :].any()
        return direction[: self.model.dim] if stays else None

    def _weighs_plainly(self) -> bool:
        """Return whether weight is a force of constant direction on each dof, and nothing else depends on it."""
        return not (self.of_sections or self.scene.drags or any(body.modes for body in self.model.bodies))

    def _gravity(self, path: Path) -> Change | None:
        """Return what a component of gravity changes, None where the path is of something else."""
        direction = self.along(path.entries[0])
        if path.head != "gravity" or direction is None or not self._weighs_plainly():
            return None
        cables = [cable_gravity(model, self.scene.cables[model.name], direction) for model in self.model.cables]
        bodies = [body_gravity(body, direction) for body in self.model.bodies]
        return Change(-np.concatenate([*cables, *bodies]))

    @singledispatchmethod
    def _of(self, part: Part, entries: tuple[str, ...]) -> Change | None:
        """Return what an entry of a part changes, None where it changes more than forces and what is prescribed."""
        return None

    @_of.register
    def _of_cable(self, part: Cable, entries: tuple[str, ...]) -> Change | None:
        if entries != ("material", "density") or not self._weighs_plainly():
            return None
        model = next(cable for cable in self.model.cables if cable.name == part.name)
        f = np.zeros(self.model.n_dof)
        f[model.coordinates] = -self.model.gravity[model.coordinates] / part.material.density
        return Change(f)

    @_of.register
    def _of_body(self, part: RigidBody, entries: tuple[str, ...]) -> Change | None:
        if entries != ("mass",) or not self._weighs_plainly():
            return None
        model = next(body for body in self.model.bodies if body.name == part.name)
        f = np.zeros(self.model.n_dof)
        dofs = slice(model.dof, model.dof + self.model.dim)
        f[dofs] = -self.model.gravity[dofs] / part.mass
        return Change(f)

    @_of.register
    def _of_motion(self, part: Motion, entries: tuple[str, ...]) -> Change | None:
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
