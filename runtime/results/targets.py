"""Values of a state of rest by name, such as ``A.position.y`` or ``wire@12.5.tension``: the targets of an adjustment.

A name is that of a result, with a component of a vector; or ``cable@s``, s in m, followed by ``position`` and a
component, or by a section force. A place on a cable keeps its part of the length when the length changes.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..errors import SceneError, near
from ..model.part_states import part_states
from ..model.states import element_coordinates, spatial
from ..parts.paths import COMPONENTS
from ..parts.validation import LENGTH_TOLERANCE
from ..solve.adjustment.snapshots import Reader, Snapshots
from ..solve.statics.static_problem import StaticState
from .equilibrium import Equilibrium
from .quantities import QUANTITIES
from .section_forces.cable_loads import Instants
from .section_forces.components import labels
from .section_forces.forces import GLOBAL, along_ground, cut_forces
from .shape_functions import on_axis

PLACE = r"(?P<cable>[^@.]+)@(?P<s>[-+0-9.eE]+?)\.(?P<rest>[A-Za-z_].*)"
"""The name of a value at a place of a cable."""


@dataclass(frozen=True)
class Target:
    """A value of a state: a component of the result or section force ``quantity``, or all of it (None).

    part: the name of the part with the result; support: its number if it is a support; cable, along: the cable of a
    place, and the place over the length of the cable.
    """

    name: str
    quantity: str
    component: int | None
    unit: str
    part: str = ""
    support: int | None = None
    cable: str | None = None
    along: float = 0.0

    @property
    def is_place(self) -> bool:
        """Return whether it is the position of a point of a cable."""
        return self.cable is not None and self.quantity == "position"


class _Values:
    """Values of targets in states of a scene, each result computed once for all states."""

    def __init__(self, problem: StaticState, at: Snapshots):
        self.problem, self.at, self.model, self.scene = problem, at, problem.model, problem.scene.as_drawn
        self.found: dict[str, dict[str, np.ndarray]] = {}
        self.cuts: dict[str, dict[float, dict[str, np.ndarray]]] = {}

    def of(self, targets: Sequence[Target]) -> np.ndarray:
        """Return the values of targets, (T, targets)."""
        for name in {target.cable for target in targets if target.cable is not None and not target.is_place}:
            self._cut(name, [target.along for target in targets if target.cable == name and not target.is_place])
        return np.stack([self._of(target) for target in targets], axis=1)

    def _of(self, target: Target) -> np.ndarray:
        """Return the values of a target, (T,)."""
        if target.is_place:
            value = self._place(target)
        elif target.cable is not None:
            value = self.cuts[target.cable][target.along][target.quantity]
        else:
            part = target.part if target.support is None else self.scene.supports[target.support].label
            value = self._result(f"{part}.{target.quantity}")
        return value if target.component is None else value[:, target.component]

    def _place(self, target: Target) -> np.ndarray:
        """Return the positions (T, 3) of a point of a cable in m."""
        assert target.cable is not None, "a place is on a cable"
        cable = next(cable for cable in self.model.cables if cable.name == target.cable)
        s = target.along * self.scene.cables[target.cable].length
        element, x = cable.mesh.place(s)
        e = element_coordinates(cable, self.at.q)[:, element]
        position = spatial(np.einsum("k,tkd->td", on_axis(cable, element, x)[0], e))
        return self.model.results(target.cable, {"position": position})["position"]

    def _result(self, name: str) -> np.ndarray:
        """Return (T, ...): a result by its name, along the ground's axes."""
        part, _, quantity = name.rpartition(".")
        if part not in self.found:
            self.found[part] = part_states(self.model, self.scene, self.at.states(), part).by_label().get(part, {})
        return self.found[part][quantity]

    def _cut(self, name: str, along: Sequence[float]) -> None:
        """Compute the section forces of a cable at places over its length."""
        problem, model, places = self.problem, self.model, sorted(set(along))
        s = np.array(places)[None] * self.scene.cables[name].length
        weight = problem.fraction if problem.settings.scale_gravity else 1.0
        instants = Instants(np.zeros(len(self.at)), self.at.q, np.zeros((len(self.at), model.n_dof)),
                            lambda each: model.as_in_model(each, self._result(each)), problem.fraction, weight,
                            is_rest=True)
        found = along_ground(model, name, cut_forces(problem.scene, model, instants, name, s))
        self.cuts[name] = {place: {quantity: values[:, k] for quantity, values in found.items()}
                           for k, place in enumerate(places)}


def reader(state: Equilibrium, names: Sequence[str]) -> Reader:
    """Return the reader of these values of similar states. Raises SceneError for an unknown name."""
    targets = [target_of(state, name) for name in names]
    of_supports = any(target.support is not None or target.part in state.scene.ties or target.part in state.scene.ropes
                      for target in targets)  # the ends of ropes, too
    return Reader(lambda problem, at: _Values(problem, at).of(targets),
                  np.array([target.unit == "m" for target in targets]), of_supports,
                  frozenset(target.part for target in targets),
                  any(target.cable is not None and not target.is_place for target in targets))


def target_of(state: Equilibrium, name: str) -> Target:
    """Return the target of a name. Raises SceneError if the state has no such value."""
    where = f'target "{name}"'
    whole, _, last = name.rpartition(".")
    component = COMPONENTS.get(last)
    result = name if component is None else whole
    if result in state.quantities:
        target = _of_result(state, name, result, component)
        value = np.asarray(state.quantities[result])
        _check_component(where, value.shape == (3,), value.ndim == 0, component)
        return target
    if (place := re.fullmatch(PLACE, result)) is None or place["cable"] not in state.scene.cables:
        raise SceneError(where, "is no value of the state of rest", f"{near(result, state.quantities)}, or write such "
                         'as "wire@2.5.position.y", of a point of a cable')
    cable, quantity = state.scene.cables[place["cable"]], place["rest"]
    try:
        s = float(place["s"])
    except ValueError:
        raise SceneError(where, f"{place['s']} is no arc-length", f'write such as "{cable.name}@2.5.position.y"'
                         ) from None
    if not -LENGTH_TOLERANCE * cable.length <= s <= (1 + LENGTH_TOLERANCE) * cable.length:
        raise SceneError(where, f"s must lie on the cable, in [0, {cable.length:.9g}] m, got {s:.9g} m")
    units = {"position": "m"} | {key: unit for key, (unit, _) in (GLOBAL | labels(cable)).items()}
    if quantity not in units:
        raise SceneError(where, f'there is no "{quantity}" at a place of a cable', near(quantity, units))
    vector = quantity in ("position", *GLOBAL)
    _check_component(where, vector, not vector, component)
    return Target(name, quantity, component, units[quantity], cable=cable.name, along=min(max(s / cable.length, 0), 1))


def _of_result(state: Equilibrium, name: str, result: str, component: int | None) -> Target:
    """Return the target of a result, with its unit if results have one of this quantity."""
    part, _, quantity = result.rpartition(".")
    units = {each[quantity].units for each in QUANTITIES.values() if quantity in each}
    unit = "m" if quantity in ("position", "length", "s") else units.pop() if len(units) == 1 else ""
    supports = [k for k, support in enumerate(state.scene.supports) if support.label == part]
    return Target(name, quantity, component, unit, part=part, support=supports[0] if supports else None)


def _check_component(where: str, vector: bool, number: bool, component: int | None) -> None:
    """Raise SceneError unless the name refers to one number."""
    if vector and component is None:
        raise SceneError(where, "has three components", "add .x, .y or .z")
    if number and component is not None:
        raise SceneError(where, "has no components", "leave .x, .y or .z out")
    if not vector and not number:
        raise SceneError(where, "is not one number, but many", 'write such as "wire@2.5.position.y", of a point of a '
                         "cable")
