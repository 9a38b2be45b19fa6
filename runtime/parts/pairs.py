"""Parts between two others, such as contacts, added for many pairs at once by lists or by "all"."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import product
from typing import Any

from ..errors import SceneError
from .modal_body import ModalBody
from .part import Part
from .scene_data import SceneData
from .validation import shown

ALL = "all"
"""All parts of the scene, unless one has this name."""


def _is_list(scene: SceneData, value: Any) -> bool:
    named = scene.cables, scene.bodies, scene.surfaces
    return isinstance(value, list | tuple) or (value == ALL and all(ALL not in names for names in named))


def are_lists(scene: SceneData, kind: type[Part], entries: Mapping[str, Any]) -> bool:
    """Return whether the entries of a part describe several pairs."""
    return kind.takes_lists and any(_is_list(scene, entries.get(end)) for end in kind.positional)


def pairs_of(scene: SceneData, kind: type[Part], entries: Mapping[str, Any]) -> list[tuple[str | None, str | None]]:
    """Return the pairs of names in the entries: each first name with each second one.

    "all" leaves out a body with a surface that it carries, pairs of the scene, and a pair in the other order. Raises
    SceneError where there is no pair.
    """
    where = kind.title(dict(entries))
    first, second = (_names(scene, where, kind.kind, end, entries.get(end)) for end in kind.positional)
    chosen = any(_is_list(scene, entries.get(end)) and entries.get(end) == ALL for end in kind.positional)
    taken = {frozenset((part.a, part.b)) for part in getattr(scene, kind.group).values()} if chosen else set()
    found: list[tuple[str | None, str | None]] = []
    for a, b in product(first, second):
        pair = frozenset((a, b))
        if chosen and (pair in taken or a == b or getattr(scene.surfaces.get(b or ""), "on", None) == a):
            continue
        if chosen:
            taken.add(pair)
        found.append((a, b))
    if not found:
        raise SceneError(where, "the named parts form no new pair for contact",
                         "add cables, bodies and surfaces before")
    return found


def _names(scene: SceneData, where: str, kind: str, end: str, value: Any) -> list[str | None]:
    if not _is_list(scene, value):
        return [None if value is None else getattr(value, "name", value)]
    if value == ALL:
        return [*_all_of(scene, kind, end)]
    names = [getattr(each, "name", each) for each in value]
    if wrong := next((each for each in names if not isinstance(each, str)), None):
        raise SceneError(where, f"{end} must be a list of names of parts, got {shown(wrong)} in it", entry=end)
    if not names:
        raise SceneError(where, f"{end} is an empty list", 'name one part at least, or give "all"', entry=end)
    if twice := next((name for k, name in enumerate(names) if name in names[:k]), None):
        raise SceneError(where, f'{end} names "{twice}" twice', "leave one of them out", entry=end)
    return names


def _all_of(scene: SceneData, kind: str, end: str) -> list[str]:
    """Return the names of "all": for a contact cables and rigid bodies, or surfaces; for a crossing cables."""
    if kind == "contact" and end == "b":
        return list(scene.surfaces)
    bodies = [name for name, body in scene.bodies.items() if not isinstance(body, ModalBody)]
    return [*scene.cables, *(bodies if kind == "contact" else [])]
