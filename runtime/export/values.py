"""Names of the numbers in a row: the results of a run that are entries of the engine's arrays, up to a sign.

Each result is computed from rows whose numbers all differ; a component that equals an entry is a candidate. Rows of
other signs, and with zeros, follow: a candidate must equal its entry in all of them, so that results which depend on
further entries, such as the ends of the part of a cable that touches a surface, have no value in C.
"""

from __future__ import annotations

import numpy as np

from ..engine import Engine
from ..model.model import Model
from ..parts.scene_data import SceneData
from ..results.quantities import Variable, labelled
from ..results.recording import coordinates, named
from .image import Value

SMALL = 1e-7
"""Relative change that makes all numbers different."""
CHECKS = 10
"""Rows of random signs and zeros: one of 2^10 conditions on an entry escapes them."""


def values_of_row(model: Model, scene: SceneData, engine: Engine) -> tuple[list[Value], list[str]]:
    """Return the values of a row, and the names of results that have none; engine: ready, its rows are overwritten."""
    random, arrays = np.random.default_rng(1), engine.record_arrays()
    _fill(engine, model, random)
    numbers = np.concatenate([*arrays.values()])
    place = {sign * number: (k, sign) for sign in (-1.0, 1.0) for k, number in enumerate(numbers.tolist())}
    results = _results(model, scene, engine)
    found = {name: [place.get(number) for number in np.ravel(result.values).tolist()]
             for name, result in results.items()}
    for _ in range(CHECKS):
        _fill(engine, model, random, changed=True)
        numbers = np.concatenate([*arrays.values()])
        for name, result in _results(model, scene, engine).items():
            found[name] = [at if at and at[1] * numbers[at[0]] == number else None
                           for at, number in zip(found[name], np.ravel(result.values).tolist(), strict=True)]
    entries = [(k, i) for k, array in enumerate(arrays.values()) for i in range(len(array))]
    values, missing = [Value("time", "s", list(arrays).index("time"), 0, 1.0)], set()
    coords = coordinates(model, np.zeros(1))
    for name, result in results.items():
        for label, at, number in zip(_labels(result, coords), found[name], np.ravel(result.values), strict=True):
            if at is not None:
                values.append(Value(name + label, result.units, *entries[at[0]], at[1]))
            elif number:  # planar results have components that are zero
                missing.add(name)
    return values, sorted(missing)


def _fill(engine: Engine, model: Model, random: np.random.Generator, changed: bool = False) -> None:
    """Fill a row with numbers that all differ, near the start; changed: those beside positions by signs and zeros."""
    start = {"q": model.q, "v": model.v}
    for name, array in engine.record_arrays().items():
        array[:] = 0.0
        like = start.get(name, np.zeros(0))
        array[: len(like)] = like
        array *= 1 + SMALL * random.random(len(array))
        array += SMALL * (1 + random.random(len(array)))
        if changed and name != "q":
            array *= random.integers(-1, 2, len(array))


def _results(model: Model, scene: SceneData, engine: Engine) -> dict[str, Variable]:
    """Return the results over time of the row."""
    with np.errstate(all="ignore"):
        found = labelled(named(model, scene, engine.arrays))
    return {name: result for name, result in found.items() if result.dims[:1] == ("time",)}


def _labels(variable: Variable, coords: dict[str, Variable]) -> list[str]:
    """Return the ends of the names of a variable's components: .x along axes with names, [3] along others."""
    found = [""]
    for dim, size in zip(variable.dims[1:], variable.values.shape[1:], strict=True):
        known = coords[dim].values if dim in coords else np.arange(size)
        each = [f".{label}" if isinstance(label, str) else f"[{k}]" for k, label in enumerate(known.tolist())]
        found = [begin + end for begin in found for end in each]
    return found
