"""Parameters that a search adjusts: their values, limits, and the scene with other values."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from typing import Generic, TypeVar

import numpy as np

from ...errors import FunicularWarning, SceneError
from ...parts.cable import Cable
from ...parts.locations import following, remade
from ...parts.paths import (
    Path,
    changes_of,
    check_each_once,
    gravity_of,
    path_of,
    temperature_of,
    unit_of,
    value_at,
)
from ...parts.point_force import PointForce
from ...parts.scene_data import SceneData
from ...parts.scene_text import OF_ALL
from ...parts.settings import Limits
from ...parts.validation import shown

ADJUST = "adjust"
ENDS = "a", "b"
"""Of forces between two points."""
MIN_VALUE_RATIO = 1e-6
"""Smallest value of a positive parameter, as a fraction of its first value."""

S = TypeVar("S", bound=SceneData)


class Parameters(Generic[S]):
    """Numbers in a scene, by their paths.

    names: their paths; values (n,): those of the scene; low, high (n,): limits; units (n,) as texts; natural (n,):
    whether the lower limit is that of the part itself, which refuses values of zero or less.
    """

    def __init__(self, scene: S, adjust: Mapping[str, Limits]):
        """adjust: limits by path. Raises SceneError for paths that lead to no number, and for values beyond limits."""
        self.scene, self.names = scene, list(adjust)
        self.paths = [path_of(scene, name, ADJUST) for name in adjust]
        check_each_once(self.paths)
        self.parts = list(scene.parts())
        self.values = np.array([self._value(path) for path in self.paths])
        self.units = [unit_of(scene, path) for path in self.paths]
        given = np.array([(-np.inf, np.inf) if isinstance(limits, str) else limits for limits in adjust.values()])
        self.low, self.high = given.T
        for name, value, low, high in zip(self.names, self.values, self.low, self.high, strict=True):
            if not low <= value <= high:
                raise SceneError(f'{ADJUST} of "{name}"', f"its value {value:.9g} is not within its limits {low:.9g} "
                                 f"and {high:.9g}", "begin within them, or give others")
        positive = np.array([self._must_be_positive(path, value)
                             for path, value in zip(self.paths, self.values, strict=True)])
        least = MIN_VALUE_RATIO * self.values
        self.natural = positive & (self.low < least)
        self.low = np.where(self.natural, least, self.low)

    def _value(self, path: Path) -> float:
        """Return the number at a path. Raises SceneError where there is none."""
        if path.part is None and path.head not in OF_ALL:
            raise SceneError(path.where, "settings cannot be adjusted", "give a path into a part, or "
                             + " or ".join(OF_ALL))
        value = value_at(self.scene, path)
        part = None if path.part is None else self.parts[path.part]
        if value is None and isinstance(part, Cable) and path.entries == ("rest_length",):
            value = part.length
        if not isinstance(value, float):
            is_now = "has no value yet" if value is None else f"is {shown(value)}, not a number that can be adjusted"
            raise SceneError(path.where, is_now, "give a value to begin with" if value is None else
                             "name one number, such as a length, or a component such as value.y")
        return value

    def _must_be_positive(self, path: Path, value: float) -> bool:
        """Return whether a value is positive, and its part refuses negative ones."""
        if path.part is None or not value > 0:
            return False
        part = self.parts[path.part]
        try:
            remade(part, changes_of(self.scene, {path: -MIN_VALUE_RATIO * value})[path.part])
        except SceneError:
            return True
        return False

    def scene_at(self, values: np.ndarray) -> S:
        """Return the scene with these values (n,); positions on cables keep their relative arc-length. Raises
        SceneError.
        """
        given = dict(zip(self.paths, values.tolist(), strict=True))
        changes = following(self.scene, changes_of(self.scene, given))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", FunicularWarning)  # the scene's messages have them
            made = self.scene.changed([(self.parts[k], entries) for k, entries in changes.items()],
                                      gravity_of(self.scene, given), temperature_of(given))
        made.equilibrium_settings = {name: value for name, value in made.equilibrium_settings.items()
                                     if name not in ("adjust", "to")}
        return made

    def law_of(self, k: int) -> str | None:
        """Return the name of the force between two points whose law has parameter k, None where there is none."""
        path = self.paths[k]
        part = None if path.part is None else self.parts[path.part]
        return part.name if isinstance(part, PointForce) and path.entries[0] not in ENDS else None

    def force_with(self, scene: S, k: int, value: float) -> PointForce:
        """Return the force between two points with another value of parameter k of its law, see `law_of`. Raises
        SceneError.
        """
        path, name = self.paths[k], self.law_of(k)
        assert name is not None, f"{path.text} is of no force between two points"
        assert path.part is not None, f"{path.text} is of no part"
        part = scene.point_forces[name]
        return type(part)(**{**part.entries(), **changes_of(scene, {path: value})[path.part]})

    def sizes(self, length: float) -> np.ndarray:
        """Return (n,): reference of changes: the value; for a value of zero a thousandth of this length in m, or 1 in
        another unit.
        """
        natural = np.array([1e-3 * length if unit == "m" else 1.0 for unit in self.units])
        return np.where(self.values != 0, np.abs(self.values), natural)
