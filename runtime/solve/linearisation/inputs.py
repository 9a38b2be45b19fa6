"""Inputs of a linear model: the change of the engine's residual by values that load or drive a scene.

The residual is differenced on both sides of the value of the scene, with the state as it is. It is linear in loads and
gravity; by others steps are halved twice, and the terms of the first and second order of the step eliminated. An input
that is a position moves the prescribed dofs by c; of one that is a velocity the position becomes a state.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from ...errors import FunicularWarning, SceneError
from ...model.model import Model
from ...parts.in_plane import in_plane
from ...parts.inputs import INPUTS
from ...parts.joint import Joint
from ...parts.load import Load
from ...parts.part import Part
from ...parts.paths import COMPONENTS, GRAVITY, Path, Variants, check_each_once, path_of, unit_of, value_at
from ...parts.scene_data import SceneData
from ...parts.signal import Signal, at_start
from ...parts.slide import Slide
from ...parts.support import Motion
from ..statics.static_problem import StaticState, without_waves

USE = "linearise"
STEP = 1e-4
"""Of a value in which forces are not linear, over the larger of the value and one unit."""
KINK_TOLERANCE = 1e-5
"""Error of a difference over the largest entry above which forces are not smooth in an input."""
REMEDY = ("inputs are gravity, values and scales of loads, displacements and rotations of motions, drives of joints "
          "and slides, and velocities of fluids")


class Side(NamedTuple):
    """A step of an input, and states at rest with the input above and below its value by it."""

    step: float
    above: StaticState
    below: StaticState


@dataclass(frozen=True, eq=False)
class Input:
    """An input: name and unit, value at rest, and the change by one unit of it.

    residual (unknowns,): of the residual, with prescribed dofs moved; c (n_dof,): of prescribed dofs. moves: whether it
    moves something as prescribed; is_rate: whether c and residual are those of the integral of the input. sides: states
    with the input changed, where results may depend on it beside the motion.
    """

    name: str
    unit: str
    value: float
    residual: np.ndarray
    c: np.ndarray
    moves: bool = False
    is_rate: bool = False
    sides: tuple[Side, ...] = ()


def inputs_of(static: StaticState, scene: SceneData, drawn: SceneData, names: Sequence[str],
              build_for: Callable[[SceneData], Model]) -> list[Input]:
    """Return the inputs of these names about the present state of a scene; drawn: the scene as its user drew it;
    build_for: returns the model of a scene for this state. Raises SceneError.
    """
    paths = [path_of(drawn, name, USE) for name in names]
    values = [_value(drawn, path) for path in paths]
    check_each_once(paths)
    return [_Differences(static, drawn, path, value, build_for).found()
            for path, value in zip(paths, values, strict=True)]


def _value(scene: SceneData, path: Path) -> float:
    """Return the value at t = 0 of an input. Raises SceneError for what is none."""
    part = None if path.part is None else [*scene.parts()][path.part]
    known = next((entries for kind, entries in INPUTS.items() if isinstance(part, kind)), ())
    if (path.head != GRAVITY if part is None else path.entries[0] not in known):
        what = f"{path.head} is a setting" if part is None else f"{path.entries[0]} of a {part.kind} is no input"
        raise SceneError(path.where, what, REMEDY)
    found: Any = scene.gravity if part is None else getattr(part, path.entries[0])
    for entry in path.entries[0 if part is None else 1:]:
        found = _at(found, entry)
    if isinstance(found, Signal):
        return float(at_start(found))
    if isinstance(found, tuple | list):
        raise SceneError(path.where, "is a vector", f'name a component, such as "{path.text}.x"')
    if not isinstance(found, float | int):
        given = value_at(scene, path)
        raise SceneError(path.where, "has no value" if given is None else "is no number and no signal",
                         "give it a value in the scene, such as 0" if given is None else REMEDY)
    return float(found)


def _at(found: Any, entry: str) -> Any:
    """Return an entry of a vector or a part, None where there is none."""
    if isinstance(found, tuple | list):
        index = COMPONENTS.get(entry, int(entry) if entry.isdecimal() else len(found))
        return found[index] if index < len(found) else None
    return None if found is None or isinstance(found, Signal) else getattr(found, entry, None)


@dataclass
class _Differences:
    """The differences by one input."""

    static: StaticState
    drawn: SceneData
    path: Path
    value: float
    build_for: Callable[[SceneData], Model]

    def found(self) -> Input:
        """Return the input. Raises SceneError."""
        part = None if self.path.part is None else [*self.drawn.parts()][self.path.part]
        unit = unit_of(self.drawn, self.path)
        if self.path.entries[-1] == "velocity" and isinstance(part, Joint | Slide):
            rate_of = self._signals_at(1.0)
            residual, c = _romberg(lambda h: self._held(rate_of, h), STEP, self.path)
            return Input(self.path.text, unit or self._rate_unit(part), self.value, residual, c, True, True)
        if isinstance(part, Load):
            residual = self._changed(1.0).residual() - self.static.residual()
            return Input(self.path.text, unit, self.value, residual, np.zeros(self._n_dof))
        if part is None and not (self.drawn.contacts or self.drawn.drags):  # stiffness of contacts, buoyancy
            above, below = self._changed(1.0).residual(), self._changed(-1.0).residual()
            return Input(self.path.text, unit, self.value, (above - below) / 2, np.zeros(self._n_dof))
        sides: list[Side] = []
        residual, c = _romberg(lambda h: self._both_sides(h, sides), STEP * max(1.0, abs(self.value)), self.path)
        moves = isinstance(part, Motion | Joint | Slide)
        return Input(self.path.text, unit or self._unit_of_drive(part), self.value, residual,
                     c if moves else np.zeros_like(c), moves, sides=() if moves else tuple(sides))

    @property
    def _n_dof(self) -> int:
        return int(self.static.model.n_dof)

    def _unit_of_drive(self, part: Part | None) -> str:
        """Return the unit of a signal, whose schema has none."""
        first = self.path.entries[0]
        return {"displacement": "m", "rotation": "rad", "angle": "rad", "distance": "m", "drive": "m"}.get(first, "")

    def _rate_unit(self, part: Part | None) -> str:
        """Return the unit of the velocity of a drive."""
        turns = isinstance(part, Joint) and part.joint_kind in ("revolute", "cylindrical")
        return "rad/s" if turns else "m/s"

    def _both_sides(self, h: float, sides: list[Side]) -> tuple[np.ndarray, np.ndarray]:
        """Return the central differences of the residual and of the prescribed dofs with a step; append the states."""
        above, below = self._changed(h), self._changed(-h)
        sides.append(Side(h, above, below))
        return ((above.residual() - below.residual()) / (2 * h),
                (self._dofs(above) - self._dofs(below)) / (2 * h))

    def _changed(self, change: float) -> StaticState:
        """Return the present state with the input changed."""
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", FunicularWarning)
            scene = in_plane(Variants(self.drawn, [self.path]).at({self.path: self.value + change}))
            model = self.build_for(scene)
            without_waves(model)
            static = StaticState(scene, self.static.settings, model)
        if model.dim != self.static.model.dim or static.engine.unknowns != self.static.engine.unknowns:
            raise SceneError(self.path.where, "it moves the scene out of its plane, in which the scene is computed",
                             'draw it in space, such as with element="cable12"')
        static.restore(self.static.keep())
        return static

    def _signals_at(self, change: float) -> dict[int, float]:
        """Return the signals of the model that change with the input, and their rates by it."""
        scene = in_plane(Variants(self.drawn, [self.path]).at({self.path: self.value + change}))
        other = self.build_for(scene).signals
        rates = {k: float(signal.value(np.zeros(1), 1)[0] - was.value(np.zeros(1), 1)[0]) / change
                 for k, (signal, was) in enumerate(zip(other, self.static.model.signals, strict=True))}
        return {k: rate for k, rate in rates.items() if rate}

    def _held(self, rates: dict[int, float], h: float) -> tuple[np.ndarray, np.ndarray]:
        """Return the same as `_both_sides` by the integral of the input."""
        static, kept = self.static, self.static.keep()
        sides = []
        for side in (h, -h):
            for k, rate in rates.items():
                static.engine.hold(k, static.model.signals[k].at(0.0) + side * rate)
            static.restore(kept)
            sides.append((static.residual(), self._dofs(static)))
        for k in rates:
            static.engine.hold(k, None)
        static.restore(kept)
        return (sides[0][0] - sides[1][0]) / (2 * h), (sides[0][1] - sides[1][1]) / (2 * h)

    def _dofs(self, static: StaticState) -> np.ndarray:
        """Return the prescribed dofs (n_dof,) of a state, others zero; those of bodies are never prescribed."""
        first = min((body.dof for body in static.model.bodies), default=self._n_dof)
        found = np.zeros(self._n_dof)
        found[:first] = static.keep()["q"][:first]
        return found


def _not_smooth(path: Path) -> SceneError:
    return SceneError(path.where, "forces have a kink at this value of the input, where no linear model exists",
                      "linearise about a state beside it")


def _romberg(difference: Callable[[float], tuple[np.ndarray, np.ndarray]], h: float, path: Path
             ) -> tuple[np.ndarray, np.ndarray]:
    """Return both derivatives from differences with steps h, h/2, h/4, without terms of h and h². Raises SceneError
    where forces are not smooth.
    """
    steps = [difference(h / 2**k) for k in range(3)]
    residual, c = (eliminated([step[k] for step in steps]) for k in range(2))
    error = np.max(np.abs(residual - (2 * steps[2][0] - steps[1][0])), initial=0.0)
    size = max(np.max(np.abs(each), initial=0.0) for each in (residual, steps[0][0]))
    if error > KINK_TOLERANCE * max(size, 1.0):
        raise _not_smooth(path)
    return residual, c


def eliminated(steps: Sequence[np.ndarray]) -> np.ndarray:
    """Return a derivative from differences with steps h, h/2, h/4, without the terms of h and h²."""
    coarse, fine = (2 * b - a for a, b in pairwise(steps))
    return np.asarray((4 * fine - coarse) / 3)
