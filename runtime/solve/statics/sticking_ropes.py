"""Scenes in which ropes stick to the sheaves on which they have friction, whatever its model is in motion."""

from __future__ import annotations

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
