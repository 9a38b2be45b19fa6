"""Inputs of a scene: values of loads and drives that are given from outside while it runs."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any, NamedTuple, TypeVar

import numpy as np

from ..errors import SceneError
from .fluid import Fluid
from .joint import Joint
from .load import Load
from .part import Part
from .paths import COMPONENTS, Path, Variants, path_of, unit_of, value_at
from .rope_items import Wheel
from .scene_data import SceneData
from .signal import DEGREE, CombinedSignal, Constant, Integral, Signal, at_start, signal
from .slide import Slide
from .support import Motion
from .validation import shown

S = TypeVar("S", bound=SceneData)

INPUTS: dict[type[Part], tuple[str, ...]] = {
    Load: ("value", "scale"), Fluid: ("velocity", "scale"), Slide: ("drive", "velocity"),
    Joint: ("angle", "distance", "velocity"), Wheel: ("torque", "angle", "velocity"),
    Motion: ("displacement", "rotation")}
"""The entries of parts that can be inputs: loads, drives, motions, velocities of fluids."""
VECTORS = "value", "velocity"
"""The entries whose components are inputs."""


class Held(Signal):
    """A signal that an input gives while the scene runs: ``start`` at t = 0, then a polynomial at a time; only in code.
    """

    form = "held"
    start: float

    @property
    def is_known(self) -> bool:
        """Return False, see `Signal.is_known`."""
        return False

    def pieces(self) -> tuple[np.ndarray, np.ndarray]:
        """Return its polynomials between breaks, see `Signal.pieces`."""
        return np.array([0.0, 1.0]), np.eye(1, DEGREE + 1) * self.start


class Input(NamedTuple):
    """An input: its path, its unit, and the signal that gives it."""

    path: str
    unit: str
    held: Held


class Term(NamedTuple):
    """A part of a signal: factor times an input, integrated over time ``order`` times; input None: the constant one."""

    factor: float
    order: int
    held: Held | None


def terms_of(made: Signal, factor: float = 1.0, order: int = 0) -> Iterator[Term]:
    """Yield the terms of a signal. Raises ValueError for other functions of time in it."""
    match made:
        case Held():
            yield Term(factor, order, made)
        case Constant() if order == 0:
            yield Term(factor * made.constant, order, None)
        case Integral():
            yield from terms_of(made.rate, factor, order + 1)
        case CombinedSignal():
            for each, part in zip(made.factors, made.signals, strict=True):
                yield from terms_of(part, factor * each, order)
        case _:
            raise ValueError(f"acts together with a signal of time, a {made.form}, in the axes of the plane")


def with_inputs(scene: S, paths: Iterable[str], use: str) -> tuple[S, list[Input]]:
    """Return the scene with signals of inputs in the place of what it has at paths, as those of sweeps, and the inputs.

    A component of a load's value, or of the velocity of a fluid, is an input, too. use: of the inputs, in messages.
    Raises SceneError for paths to anything but loads, drives, motions and velocities of fluids, and for a drive that
    the scene does not have.
    """
    given = [path_of(scene, text, use) for text in _texts(paths, use)]
    inputs = [Input(path.text, unit_of(scene, path), Held(start=_start(scene, path))) for path in given]
    for path, made in zip(given, inputs, strict=True):
        scene = _with(scene, path_of(scene, path.text, use), made.held)
    return scene, inputs


def _texts(paths: Iterable[str], use: str) -> list[str]:
    """Return the texts of paths. Raises SceneError."""
    texts = [paths] if isinstance(paths, str) else list(paths)
    for k, text in enumerate(texts):
        if not isinstance(text, str) or not text:
            raise SceneError(use, f"names an input by its path, got {shown(text)}", 'give such as "push.value.x"')
        if text in texts[:k]:
            raise SceneError(use, f'names "{text}" twice', "name each input once")
    return texts


def _start(scene: SceneData, path: Path) -> float:
    """Return the value of an input in a scene. Raises SceneError for what is no input."""
    part, entry, component = _place(scene, path)
    value = value_at(scene, path)
    if value is None:
        raise SceneError(path.where, f"the scene has no {entry} there", "give one that the input replaces, such as "
                         f"{entry}=0")
    if component is None and entry in VECTORS and not isinstance(value, int | float):
        if isinstance(part, Load | Fluid):
            raise SceneError(path.where, "is a vector", f'name a component, such as "{path.text}.x"')
    return float(value) if isinstance(value, int | float) else at_start(signal(value))


def _place(scene: SceneData, path: Path) -> tuple[Part, str, int | None]:
    """Return the part of a path, or the part in it, its entry, and the component. Raises SceneError."""
    part: Any = None if path.part is None else [*scene.parts()][path.part]
    entries = list(path.entries)
    while isinstance(part, Part):
        known = next((names for kind, names in INPUTS.items() if isinstance(part, kind)), ())
        if entries and entries[0] in known:
            return part, entries[0], _component(path, part, entries)
        part = part.entries().get(entries.pop(0)) if entries else None
        while isinstance(part, tuple | list) and entries and entries[0].isdecimal() and int(entries[0]) < len(part):
            part = part[int(entries.pop(0))]
    kinds = "; ".join(f"{kind.__name__.lower()}: {', '.join(names)}" for kind, names in INPUTS.items())
    raise SceneError(path.where, "is no load, drive, motion, nor velocity of a fluid", f"inputs are, of each kind of "
                     f"part: {kinds}")


def _component(path: Path, part: Part, entries: list[str]) -> int | None:
    """Return the component that entries of a path name, of a part's vector. Raises SceneError."""
    if len(entries) == 1 or not isinstance(part, Load | Fluid):
        return None
    if entries[0] not in VECTORS or entries[1] not in COMPONENTS or len(entries) > 2:
        raise SceneError(path.where, f'{entries[0]} has no "{".".join(entries[1:])}"', f'write "{entries[0]}'
                         + ('.x" or another component"' if entries[0] in VECTORS else '"'))
    return COMPONENTS[entries[1]]


def _with(scene: S, path: Path, held: Held) -> S:
    """Return the scene with a signal at a path."""
    part, _, component = _place(scene, path)
    if isinstance(part, Load):
        return _with_load(scene, path, part, component, held)
    if isinstance(part, Fluid) and component is not None:
        others = [value for k, value in enumerate(part.velocity) if k != component]
        if any(others) or not isinstance(part.scale, Constant) or part.table is not None:
            raise SceneError(path.where, "the fluid has other components of velocity, a scale or a table, which an "
                             "input of one component would leave out", f'take "{path.head}.scale" as the input')
        along = [float(k == component) for k in range(3)]
        start = held.start * part.scale.constant
        return scene.changed([(part, {"velocity": along, "scale": held.model_copy(update={"start": start})
                                      if start != held.start else held})])
    return Variants(scene, [path]).at({path: held})


def _with_load(scene: S, path: Path, load: Load, component: int | None, held: Held) -> S:
    """Return the scene with the factor of a load, or one component of its value, as a signal.

    The component is a load of its own beside the others.
    """
    if load.when is not None or load.until is not None:
        raise SceneError(path.where, "the load begins or ends with an event, and an input would not",
                         "leave when and until out")
    if component is None:
        return scene.changed([(load, {"scale": held})])
    if not isinstance(load.scale, Constant):
        raise SceneError(path.where, "the load has a scale over time, by which the input would be multiplied",
                         f'leave it out, or take "{path.head}.scale" as the input')
    value: tuple[float, ...] = load.entries()["value"]
    alone = {"value": [load.scale.constant * (k == component) for k in range(3)], "scale": held}
    rest = [0.0 if k == component else each for k, each in enumerate(value)]
    if not any(rest):
        return scene.changed([(load, alone)])
    name = scene.free_names(type(load), f"{load.given_name}_{path.entries[-1]}", 1)[0]
    parts: list[Part] = []
    for part in scene.parts():
        parts += [part.remade({"value": rest}), part.remade(alone | {"name": name})] if part is load else [part]
    return scene.with_parts(parts)
