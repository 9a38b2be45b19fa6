"""Values of a state of rest by name, such as ``A.position.y`` or ``wire@12.5.tension``: what a scene is adjusted for.

A name is that of a result and, of a vector, a component; or ``cable@s``, s in m, then ``position`` and a component,
or a section force of the cable there. Places on a cable keep their part of its length where that changes.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from ..errors import SceneError, near
from ..parts.cable import EXACT
from ..parts.paths import COMPONENTS
from .equilibrium import Equilibrium
from .quantities import QUANTITIES
from .section_components import labels
from .section_forces import GLOBAL

PLACE = re.compile(r"(?P<cable>[^@.]+)@(?P<s>[-+0-9.eE]+?)\.(?P<rest>[A-Za-z_].*)")
"""The name of a value at a place of a cable."""


@dataclass(frozen=True)
class Target:
    """A value of a state: of the result or section force ``quantity``, a component of it, or all of it (None).

    part: the name of what has the result; support: the number of the support that has it, else None; cable: at the
    part ``along`` of whose length the value is; unit as a text.
    """

    name: str
    quantity: str
    component: int | None
    unit: str
    part: str = ""
    support: int | None = None
    cable: str | None = None
    along: float = 0.0

    def of(self, state: Equilibrium) -> float:
        """Return the value in a state."""
        if self.cable is not None:
            cable = state.scene.cables[self.cable]
            s = self.along * cable.length
            if self.quantity == "position":
                value = cable.point_between(state[f"{self.cable}.nodal_vectors"], s)
            else:
                value = state.section_forces(self.cable, s=[s])[self.quantity].values[0]
        else:
            part = self.part if self.support is None else state.scene.supports[self.support].label
            value = state[f"{part}.{self.quantity}"]
        return float(value if self.component is None else value[self.component])


def reader(state: Equilibrium, names: Sequence[str]) -> tuple[Callable[[Equilibrium], np.ndarray], np.ndarray]:
    """Return the function that reads these values (n,) of a state like this one, and which of them are in m (n,).

    Raises SceneError where a name is that of no value.
    """
    targets = [target_of(state, name) for name in names]
    return (lambda other: np.array([target.of(other) for target in targets]),
            np.array([target.unit == "m" for target in targets]))


def target_of(state: Equilibrium, name: str) -> Target:
    """Return what a name asks for. Raises SceneError where that is no value of the state."""
    where = f'target "{name}"'
    whole, _, last = name.rpartition(".")
    component = COMPONENTS.get(last)
    result = name if component is None else whole
    if result in state.quantities:
        target = _of_result(state, name, result, component)
        value = np.asarray(state.quantities[result])
        _check_component(where, value.shape == (3,), value.ndim == 0, component)
        return target
    if (place := PLACE.fullmatch(result)) is None or place["cable"] not in state.scene.cables:
        raise SceneError(where, "is no value of the state of rest", f"{near(result, state.quantities)}, or write such "
                         'as "wire@2.5.position.y", of a point of a cable')
    cable, quantity = state.scene.cables[place["cable"]], place["rest"]
    try:
        s = float(place["s"])
    except ValueError:
        raise SceneError(where, f"{place['s']} is no arc-length", f'write such as "{cable.name}@2.5.position.y"'
                         ) from None
    if not -EXACT * cable.length <= s <= (1 + EXACT) * cable.length:
        raise SceneError(where, f"s must lie on the cable, in [0, {cable.length:.9g}] m, got {s:.9g} m")
    units = {"position": "m"} | {key: unit for key, (unit, _) in (GLOBAL | labels(cable)).items()}
    if quantity not in units:
        raise SceneError(where, f'there is no "{quantity}" at a place of a cable', near(quantity, units))
    vector = quantity in ("position", *GLOBAL)
    _check_component(where, vector, not vector, component)
    return Target(name, quantity, component, units[quantity], cable=cable.name, along=min(max(s / cable.length, 0), 1))


def _of_result(state: Equilibrium, name: str, result: str, component: int | None) -> Target:
    """Return a value of a result of a state, with its unit where results have one."""
    part, _, quantity = result.rpartition(".")
    units = {each[quantity].units for each in QUANTITIES.values() if quantity in each}
    unit = "m" if quantity in ("position", "length", "s") else units.pop() if len(units) == 1 else ""
    supports = [k for k, support in enumerate(state.scene.supports) if support.label == part]
    return Target(name, quantity, component, unit, part=part, support=supports[0] if supports else None)


def _check_component(where: str, vector: bool, number: bool, component: int | None) -> None:
    """Raise SceneError unless the name is that of one number."""
    if vector and component is None:
        raise SceneError(where, "has three components", "add .x, .y or .z")
    if number and component is not None:
        raise SceneError(where, "has no components", "leave .x, .y or .z out")
    if not vector and not number:
        raise SceneError(where, "is not one number, but many", 'write such as "wire@2.5.position.y", of a point of a '
                         "cable")
