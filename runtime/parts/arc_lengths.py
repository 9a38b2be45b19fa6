"""Arc-lengths of parts on a cable whose length changes."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, cast

from .attachment import Attachment
from .cable import Cable
from .hanging import hangs
from .locations import on_cables
from .part import Part
from .scene_data import SceneData


def remade(part: Part, changes: Mapping[str, Any]) -> Part:
    """Return a part with other values, by keyword; a cable without its given nodes. Raises SceneError."""
    if isinstance(part, Cable) and part.nodes is not None and "nodes" not in changes:
        changes = {**changes, "nodes": None}
    return part.remade(changes)


def following(scene: SceneData, changes: Mapping[int, Mapping[str, Any]]) -> dict[int, dict[str, Any]]:
    """Return changes of the parts of a scene with those of arc-lengths and nodes on cables that change in length.

    An arc-length keeps its ratio to the length of the cable, unless it is among the changes.

    changes: values by keyword, by the number of the part. A hanging cable that becomes shorter than its span is drawn
    straight. Raises SceneError.
    """
    parts = list(scene.parts())
    stretch = {}
    found = {k: dict(entries) for k, entries in changes.items()}
    for k, entries in found.items():
        if isinstance(part := parts[k], Cable) and entries:
            changed = cast(Cable, remade(part, entries))
            ratio = stretch[part.name] = changed.length / part.length
            if part.nodes is not None and ratio != 1.0:
                entries.setdefault("nodes", [s * ratio for s in part.nodes])
            if changed.shape == "hanging" and not hangs(changed.drawn_length, changed.length):
                entries["shape"] = "straight"
    stretch = {name: ratio for name, ratio in stretch.items() if ratio != 1.0}
    if not stretch:
        return found
    for k, part in enumerate(part.as_made() for part in parts):
        moved: dict[str, Any] = {keyword: s * stretch[on] for keyword, on, s in on_cables(part) if on in stretch}
        for name, value in part:
            if isinstance(value, Attachment) and value.on in stretch and value.s is not None:
                moved[name] = value.model_copy(update={"s": value.s * stretch[value.on]})
        if moved:
            found[k] = moved | found.get(k, {})
    return found
