"""What is checked of a sweep of a scene before any work: points, as far as that is cheap, and their output times."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from ..errors import SceneError
from .parameters import SWEEP, Points
from .subject import SceneSubject

MOST_CHECKED = 1000
"""Points that are checked before work begins, 1 ms each; and values of each parameter of a grid."""


def check_points(subject: SceneSubject, points: Points) -> None:
    """Refuse a sweep with a scene that cannot be simulated. Raises SceneError that names the point.

    All points are checked where they are few. Of many: each value of a grid's parameters with the first ones of the
    others, the smallest and the largest value of all parameters of samples, and points spread over all of them.
    """
    for number in _numbers(points):
        point = points.point(number)
        try:
            subject.check(point)
        except SceneError as error:
            raise error.inside(f"{SWEEP} at {described(point)}") from None


def described(point: Mapping[str, Any]) -> str:
    """Return a point in words."""
    return ", ".join(f"{name} = {value:.9g}" if isinstance(value, float) else f"{name} = {value}"
                     for name, value in point.items())


def _numbers(points: Points) -> list[int]:
    """Return the numbers of the points to check, each once."""
    if points.number <= MOST_CHECKED:
        return list(range(points.number))
    found: dict[int, None] = {}
    if points.is_grid:
        for axis, size in enumerate(points.shape):
            stride = int(np.prod(points.shape[axis + 1:], dtype=int))
            found |= dict.fromkeys(stride * k for k in range(min(size, MOST_CHECKED)))
    else:
        for values in points.columns.values():
            if values.dtype.kind in "if":
                found |= {int(values.argmin()): None, int(values.argmax()): None}
    spread = np.linspace(0, points.number - 1, MOST_CHECKED).astype(int)
    return [*(found | dict.fromkeys(spread.tolist()))]


def own_times(subject: SceneSubject, points: Points) -> int | None:
    """Return the largest number of output times of a point, None where all points have the same times."""
    settings = subject.settings_at(points.point(0))
    paths = {path.entries[0]: name for name, path in subject.paths.items() if path.head == "run"}
    duration = points.columns[paths["duration"]] if "duration" in paths else np.array([settings.duration])
    output = points.columns[paths["output_step"]] if "output_step" in paths else None
    if output is None and "output_step" in settings.model_fields_set:
        output = np.array([settings.output_step])
    stops = any(event.action == "stop" for event in subject.scene.events.values())
    if len(duration) == 1 and (output is None or len(output) == 1) and not stops:
        return None
    if output is None:  # a part of the duration, as `RunSettings` has it
        return round(settings.duration / settings.output_step) + 2
    if points.is_grid or 1 in (len(duration), len(output)):
        return int(np.ceil(duration.max() / output.min())) + 2
    return int(np.ceil((duration / output).max())) + 2
