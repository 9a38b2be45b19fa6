"""Check that a scene can come to rest: nothing in it goes on by itself."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..errors import SceneError
from ..parts.part import Part
from ..parts.scene_data import SceneData
from ..parts.signal import Signal, signals_of


def check_comes_to_rest(scene: SceneData) -> None:
    """Raise SceneError for loads and drives that change with time, and for friction that lets riders creep."""
    for part in scene.parts():
        for name, signal in _given(part):
            if not _is_constant(signal):
                raise SceneError(part.where, f"{name} changes with time, so that the scene does not come to rest",
                                 "take the value at which it shall rest, with scene.replace")
    for slide in scene.slides.values():
        if slide.friction is not None and not slide.friction.sticks and slide.friction.sliding > 0:
            raise SceneError(slide.where, "its friction is regularised, so that a rider creeps and never comes to rest",
                             'take model="stick", which holds it, or leave friction out')


def _given(part: Part) -> Iterator[tuple[str, Signal]]:
    """Yield all signals of a part with their names, and what a rate of it adds up to."""
    yield from signals_of(part)
    prescribed = getattr(part, "prescribed", None)
    if isinstance(prescribed, Signal):
        yield "its drive", prescribed


def _is_constant(signal: Signal) -> bool:
    """Return whether a signal has one value for all times."""
    _, coefficients = signal.pieces()
    return not signal.sine.amplitude and not np.any(coefficients[:, 1:]) and not np.any(np.diff(coefficients[:, 0]))
