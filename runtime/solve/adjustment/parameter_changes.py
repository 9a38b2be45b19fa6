"""The change of the residual at a state of rest by parameters of few of its equations.

A unit of a load, a weight, a length or a position adds the forces f to those on all dofs and g to the equations of
couplings; a unit of a prescribed motion moves the prescribed dofs by c. By the unknowns x

    dR/dp = T' (f + K c) + g,    q = T x + c p,

with K the tangent over all dofs, and T that of the dofs by the unknowns (model/unknowns.py). For the length of a cable,
x are the coordinates in which its points stay (solve/adjustment/cable_changes.py).

These columns spare two models of the scene per parameter: 1.2 s in place of 88 s for 90 loads on 10 spans.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import singledispatchmethod

import numpy as np
from scipy.sparse import csc_array, csr_array

from ...errors import SceneError
from ...model.bodies import body_gravity
from ...model.border import ACCELERATIONS, NEWTON, elimination
from ...model.build import elements_of
from ...model.cables import cable_gravity
from ...model.combinations import Combinations
from ...model.kinds import COUPLINGS
from ...model.model import Model
from ...model.numbering import as_drawn
from ...model.unknowns import by_unknowns
from ...parts.attachment import Attachment
from ...parts.cable import Cable
from ...parts.load import DistributedForce, Force, Moment
from ...parts.locations import on_cables
from ...parts.part import Part
from ...parts.paths import TEMPERATURE, Path, changes_of, value_at
from ...parts.point_force import PointForce
from ...parts.rigid_body import RigidBody
from ...parts.support import Motion
from ..statics.static_problem import StaticProblem
from .cable_changes import Own, by_temperature
from .change import Change, Rest, altered
from .length_changes import NOT_SCALING_GROUPS, by_length, hangs_plainly, lengthens_plainly
from .load_changes import AnyLoad, by_end, by_place, by_values, unit_of
from .snapshots import Reader

SECTION_INDEPENDENT_GROUPS = "loads", "slides", "joints", "point_forces"
SECTION_DEPENDENT_GROUPS = tuple({kind.group for kind in COUPLINGS} - {*SECTION_INDEPENDENT_GROUPS})
"""Groups of parts that may depend on the size and the weight of a cable's section."""
DIFFERENCE_STEP = 1e-6
"""Relative step of a number of a section, to either side, of differences of the forces of its cable."""


class Changes:
    """The changes by parameters at a state of rest.

    found: by the number of a parameter, for those that change few equations.
    """

    def __init__(self, problem: StaticProblem, paths: Mapping[int, Path], reader: Reader):
        """paths: of parameters, by their numbers; reader: see `Rest`."""
        self.rest = Rest(problem, reader)
        self.scene, self.model = self.rest.scene, self.rest.model
        self.found: dict[int, Change] = {}
        parts = list(self.scene.as_drawn.parts())
        loads: dict[int, AnyLoad] = {}
        for k, path in paths.items():
            part = None if path.part is None else parts[path.part]
            if isinstance(part, Force | DistributedForce | Moment) and path.entries[0] == "value":
                if (unit := unit_of(self.rest, part, path.entries)) is not None:
                    loads[k] = unit
            elif (change := self._of_all(path) if part is None else self._of(part, path)) is not None:
                self.found[k] = change
        self.found |= by_values(self.rest, loads)
        self._keep_places(paths)

    def columns(self) -> dict[int, np.ndarray]:
        """Return dR/dp (unknowns,) of each parameter found."""
        model = self.model
        forces = {k: np.concatenate([change.f, change.g]) for k, change in self.found.items()}
        if moves := [k for k, change in self.found.items() if change.c.any()]:
            K = self._tangent_over_dofs()[:, : model.n_dof]
            for k in moves:
                forces[k] += K @ self.found[k].c
        by_unknowns = _by_unknowns(model).T
        return {k: by_unknowns @ force for k, force in forces.items()}

    def _keep_places(self, paths: Mapping[int, Path]) -> None:
        """Subtract from the changes by lengths of cables those by positions along them that are parameters, too, and so
        stay; remove a length with such a position for which there is no change.
        """
        parts = list(self.scene.as_drawn.parts())
        for k, path in paths.items():
            cable = None if path.part is None else parts[path.part]
            change = self.found.get(k)
            if not isinstance(cable, Cable) or path.entries != ("rest_length",) or change is None:
                continue
            for j, other in paths.items():
                s = None if other.part is None else _place(parts[other.part], other, cable.name)
                if s is not None and j not in self.found:
                    del self.found[k]
                    break
                if s is not None:
                    change.subtract(s / cable.length, self.found[j])

    def _weighs_plainly(self, *names: str) -> bool:
        """Return whether weight is a force of constant direction on each dof, and nothing else depends on the weight of
        these cables and bodies, such as the default stiffness of a contact.
        """
        found = any(contact.a in names and contact.as_made().stiffness is None and not contact.is_hard
                    for contact in self.scene.contacts.values())
        modal = any(body.modes for body in self.model.bodies)
        return not (found or modal or self.rest.reader.sections or self.scene.drags or self.scene.ices)

    def _of_all(self, path: Path) -> Change | None:
        """Return the change by gravity or by the temperature of the scene, None where it is more than a `Change`."""
        if path.head != TEMPERATURE:
            return self._gravity(path)
        if self.scene.ropes:
            return None
        return self._warmer([cable for cable in self.scene.cables.values()
                             if "temperature" not in cable.model_fields_set])

    def _warmer(self, cables: Iterable[Cable]) -> Change | None:
        """Return the change by the temperature of cables."""
        change, reader = Change(self.model), self.rest.reader
        for cable in cables:
            if reader.sections or cable.name in reader.parts:
                return None
            model = self.rest.model_of(cable.name)
            change.f[model.coordinates] = by_temperature(model, cable, self.rest.problem.keep()["q"])
        return change

    def _gravity(self, path: Path) -> Change | None:
        """Return the change by a component of gravity, None for another path."""
        direction = self.rest.along(path.entries[0])
        hanging = [cable for cable in self.scene.cables.values() if cable.shape == "hanging"]
        if path.head != "gravity" or direction is None or not self._weighs_plainly(*self.scene.cables,
                                                                                   *self.scene.bodies):
            return None
        if any(self.rest.names(cable.name, NOT_SCALING_GROUPS) or not hangs_plainly(self.rest, cable)
               for cable in hanging):
            return None
        cables = [cable_gravity(self.scene.cables[model.name], direction) for model in self.model.cables]
        bodies = [body_gravity(body, direction) for body in self.model.bodies]
        change = Change(self.model)
        change.f -= np.concatenate([*cables, *bodies])
        return change

    @singledispatchmethod
    def _of(self, part: Part, path: Path) -> Change | None:
        """Return the change by an entry of a part, None where it changes more than a `Change` holds."""
        return None

    @_of.register
    def _of_cable(self, part: Cable, path: Path) -> Change | None:
        cable = self.scene.cables[part.name]
        if path.entries == ("material", "density"):
            change, at = Change(self.model), self.rest.model_of(cable.name).coordinates
            change.f[at] = -self.model.gravity[at] / cable.material.density
            return change if self._weighs_plainly(cable.name) else None
        if self.rest.reader.sections or cable.name in self.rest.reader.parts:
            return None
        if path.entries == ("rest_length",):
            return by_length(self.rest, cable) if lengthens_plainly(self.rest, cable) else None
        if path.entries == ("temperature",):
            return self._warmer([cable])
        if path.entries == ("material", "thermal_expansion"):
            return None
        if path.entries[0] not in ("section", "material") or self.rest.names(cable.name, SECTION_DEPENDENT_GROUPS):
            return None
        return self._of_section(cable, path)

    @_of.register
    def _of_body(self, part: RigidBody, path: Path) -> Change | None:
        if path.entries != ("mass",) or not self._weighs_plainly(part.name):
            return None
        model = next(body for body in self.model.bodies if body.name == part.name)
        change, dofs = Change(self.model), slice(model.dof, model.dof + self.model.dim)
        change.f[dofs] = -self.model.gravity[dofs] / part.mass
        return change

    @_of.register
    def _of_motion(self, part: Motion, path: Path) -> Change | None:
        entries = path.entries
        direction = self.rest.along(entries[1]) if len(entries) == 2 and entries[0] == "displacement" else None
        if direction is None:
            return None
        model, change = self.model, Change(self.model)
        node = model.nodes[part.cable][self.scene.cables[part.cable].node(part.s)]
        moved = dict(zip(node.dofs("r"), direction.tolist(), strict=True))
        signals = {motion.signal: moved[motion.dof] for motion in model.motions if moved.get(motion.dof)}
        for motion in model.motions:
            change.c[motion.dof] += motion.linear * signals.get(motion.signal, 0.0)
        return change

    def _of_section(self, cable: Cable, path: Path) -> Change | None:
        """Return the change by a number of a cable's section or material: the difference of its elastic forces and
        weight, exact for Young's modulus, in which they are linear at a given Poisson ratio by the laws of this
        package.
        """
        model, drawn = self.rest.model_of(cable.name), self.scene.as_drawn
        value = value_at(drawn, path)
        linear = (path.entries == ("material", "youngs_modulus") and cable.material.poisson_ratio is not None
                  and cable.library is None)
        h = abs(value) if linear else DIFFERENCE_STEP * abs(value) or DIFFERENCE_STEP
        ends = (value, value + h) if linear else (value - h, value + h)
        assert path.part is not None, f"{path.text} is of a cable"
        if path.entries[0] == "section" and self.scene.drags:
            return None
        own = Own(model, self.rest.problem.keep()["q"], np.array(self.scene.gravity)[: self.model.dim])
        try:
            below, above = (own.of(cable.remade(changes_of(drawn, {path: end})[path.part])) for end in ends)
        except SceneError:  # at a bound of the section or material
            return None
        change = Change(self.model)
        change.f[model.coordinates] = (above - below) / (ends[1] - ends[0])
        return change

    @_of.register
    def _of_point_force(self, part: PointForce, path: Path) -> Change | None:
        return by_end(self.rest, part, path)

    @_of.register(Force)
    @_of.register(DistributedForce)
    def _of_place(self, part: Force | DistributedForce, path: Path) -> Change | None:
        return by_place(self.rest, part, path)

    def _tangent_over_dofs(self) -> csc_array:
        """Return dR/dx at the state with each dof as an unknown: (n_dof + n_extra, the same)."""
        model = self.model
        n = model.cables[-1].coordinates.stop
        numbering = as_drawn(elements_of(model.cables), np.arange(n))
        free = altered(model, motions=[], unknown_of_dof=np.arange(model.n_dof), combinations=Combinations.of([]),
                     n_band=n, n_border_dof=model.n_dof - n, width=numbering.width, chains=numbering.chains)
        free.newton, free.accelerations = elimination(free, NEWTON), elimination(free, ACCELERATIONS)
        return self.rest.engine(free).matrix(0.0, 0.0, 1.0)


def _place(part: Part, path: Path, cable: str) -> float | None:
    """Return the arc-length in m on a cable to which a path to an entry of this part leads; None for another entry."""
    for keyword, on, s in on_cables(part):
        if (keyword,) == path.entries and on == cable:
            return s
    end = getattr(part, path.entries[0], None)
    return end.s if isinstance(end, Attachment) and end.on == cable else None


def _by_unknowns(model: Model) -> csr_array:
    """Return T (n_dof + n_extra, unknowns): the derivatives of the dofs by the unknowns."""
    n = model.n_band + model.n_border_dof
    own = n + np.arange(model.n_extra)
    return by_unknowns(np.append(model.unknown_of_dof, own), model.combinations, n + model.n_extra)
