"""Scenes in which ropes stick to the sheaves on which they have friction, whatever its model is in motion."""

from __future__ import annotations

import numpy as np

from ...engine import Engine
from ...model.model import Model
from ...parts.rope_items import RouteItem, Sheave
from ...parts.scene_data import SceneData


def with_sticking_wraps(scene: SceneData) -> SceneData:
    """Return a scene in which friction of ropes on sheaves sticks that touch them as drawn."""
    made = scene.copied()
    for rope in scene.ropes.values():
        if rope.mass:
            made.put(rope.model_copy(update={"route": tuple(_sticking(item) for item in rope.route)}))
    return made


def _sticking(item: RouteItem) -> RouteItem:
    """Return an item of a route, with friction that sticks if it has any."""
    if not isinstance(item, Sheave) or item.friction is None or not (item.coefficient and item.contact):
        return item
    return item.model_copy(update={"friction": item.friction.model_copy(update={"model": "stick"})})


def held_friction(model: Model, engine: Engine) -> dict[str, np.ndarray]:
    """Return friction over its limit at the points of wraps that stick in the engine's static state, by the names of
    their sheaves (zones + 1,); zero without a normal force.
    """
    f, limit, _ = engine.held_wraps()[1].T
    part = np.divide(f, limit, out=np.zeros_like(f), where=limit > 0)
    sheaves = [sheave for sheave in model.sheaves if sheave.sticks]
    ends = np.cumsum([len(sheave.points) for sheave in sheaves], dtype=int)
    return {sheave.name: of for sheave, of in zip(sheaves, np.split(part, ends[:-1]), strict=True)}
