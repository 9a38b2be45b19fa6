"""Paths into a scene, such as ``wire.material.youngs_modulus`` or ``run.tol``: what a scene with other values there is.

A path begins with the name of a part (of a pin, clamp or motion its name in results, ``wire@0``), or with ``gravity``,
``run`` or ``equilibrium``; then come entries as a scene file names them. ``x``, ``y``, ``z`` are components of vectors,
and numbers, from 0, are entries of lists.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any, TypeVar

from ..errors import SceneError, near
from .part import Part
from .scene_data import SceneData
from .scene_text import SETTINGS, plain_data
from .validation import show, shown

COMPONENTS = {"x": 0, "y": 1, "z": 2}
GRAVITY = "gravity"


@dataclass(frozen=True)
class Path:
    """A path, split: what it begins with, the entries behind it, and the number of the part in the scene's order.

    part: None of gravity and settings; use: what takes the path, such as "sweep", as messages call it.
    """

    text: str
    head: str
    entries: tuple[str, ...]
    part: int | None
    use: str = "sweep"

    @property
    def where(self) -> str:
        """Return how messages name the path."""
        return f'{self.use} of "{self.text}"'


def label_of(part: Part) -> str | None:
    """Return what a path calls a part: its name, or the name of a support in results."""
    return part.given_name or getattr(part, "label", None)


def path_of(scene: SceneData, text: str, use: str = "sweep") -> Path:
    """Return the path that a text is in this scene; use: as in `Path`. Raises SceneError where it leads nowhere."""
    where = f'{use} of "{text}"'
    heads: dict[str, int | None] = {GRAVITY: None, **dict.fromkeys(SETTINGS)}
    labels = {label: k for k, part in enumerate(scene.parts()) if (label := label_of(part)) is not None}
    head = max((name for name in (*heads, *labels) if text == name or text.startswith(f"{name}.")), key=len, default="")
    if not head:
        known = [*labels, *heads]
        first = text.partition(".")[0]
        raise SceneError(where, f'there is no part "{first}", nor a table of settings of that name',
                         f"{near(first, known)} (there are {', '.join(known)})")
    if head in heads and head in labels:
        raise SceneError(where, f'"{head}" is a part of the scene and a table of a scene file',
                         "name the part otherwise")
    path = Path(text, head, tuple(text[len(head) + 1:].split(".")) if len(text) > len(head) else (), labels.get(head),
                use)
    _check_entry(scene, path)
    return path


def _check_entry(scene: SceneData, path: Path) -> None:
    """Refuse a path whose first entry is none of its part. Raises SceneError."""
    if path.head == GRAVITY:
        known: Iterable[str] = COMPONENTS
    elif path.part is None:
        known = [name for name in SETTINGS[path.head].keywords() if name != "save"]
    else:
        known = [name for name in _parts(scene)[path.part].keywords() if name != "name"]
    if not path.entries:
        example = f"{path.head}.{next(iter(known))}"
        raise SceneError(path.where, "names no entry", f'write such as "{example}" (known: '
                         + ", ".join(known) + ")")
    if path.entries[0] not in known:
        raise SceneError(path.where, f'{path.head} has no "{path.entries[0]}"',
                         _nearest(path.entries[0], known))


def _nearest(name: str, known: Iterable[str]) -> str:
    """Return the remedy for an unknown name: the nearest known one, and the list of them, once."""
    nearest, listed = near(name, known), f"known: {', '.join(known)}"
    return nearest if nearest == listed else f"{nearest} ({listed})"


def check_each_once(paths: Iterable[Path]) -> None:
    """Raise SceneError where two of several paths lead to the same number, as a.y and a.1 do."""
    first: dict[tuple[str, ...], str] = {}
    for path in paths:
        entries = tuple(str(COMPONENTS.get(entry, entry)) for entry in path.entries)
        if (other := first.setdefault((path.head, *entries), path.text)) != path.text:
            raise SceneError(path.where, f'is the same number as "{other}"', "name each number once")


def _parts(scene: SceneData) -> list[Part]:
    return list(scene.parts())


S = TypeVar("S", bound=SceneData)


def changed(scene: S, values: Mapping[Path, Any]) -> S:
    """Return a scene like this one with these values, all changed at once. Raises SceneError."""
    parts = _parts(scene)
    settings: dict[str, dict[str, Any]] = {name: {} for name in SETTINGS}
    for path, value in values.items():
        if path.part is None and path.head != GRAVITY:
            settings[path.head][path.entries[0]] = value
            _check_end(path, 1)
    made = scene.changed([(parts[k], entries) for k, entries in changes_of(scene, values).items()],
                         gravity_of(scene, values))
    for name, table in settings.items():
        if table:
            setattr(made, f"{name}_settings", getattr(scene, f"{name}_settings") | table)
    return made


def gravity_of(scene: SceneData, values: Mapping[Path, Any]) -> list[Any]:
    """Return gravity with these values. Raises SceneError."""
    gravity: list[Any] = list(scene.gravity)
    for path, value in values.items():
        if path.head == GRAVITY and path.part is None:
            gravity[COMPONENTS[path.entries[0]]] = value
            _check_end(path, 1)
    return gravity


def changes_of(scene: SceneData, values: Mapping[Path, Any]) -> dict[int, dict[str, Any]]:
    """Return what these values change of parts: by the number of a part, values by keyword. Raises SceneError."""
    parts = _parts(scene)
    changes: dict[int, dict[str, Any]] = {}
    for path, value in values.items():
        if path.part is not None:
            _put(path, changes.setdefault(path.part, {}), parts[path.part].as_made().entries(), value)
    return changes


def value_at(scene: SceneData, path: Path) -> Any:
    """Return what a path leads to in a scene, as plain data; None where the part has no such entry.

    Raises SceneError for entries of a component of gravity.
    """
    if path.part is None and path.head != GRAVITY:
        return None
    if path.part is None:
        _check_end(path, 1)
        return scene.gravity[COMPONENTS[path.entries[0]]]
    data: Any = plain_data(_parts(scene)[path.part].entries().get(path.entries[0]))
    for entry in path.entries[1:]:
        if isinstance(data, list):
            index = COMPONENTS.get(entry, int(entry) if entry.isdecimal() else len(data))
            data = data[index] if index < len(data) else None
        else:
            data = data.get(entry) if isinstance(data, dict) else None
    return data


def _put(path: Path, entries: dict[str, Any], old: Mapping[str, Any], value: Any) -> None:
    """Put a value into the changes of a part, by keyword; entries: those before it; old: what the part has."""
    first = path.entries[0]
    before = entries[first] if first in entries else plain_data(old.get(first))
    entries[first] = _with(path, before, 1, value)


def _with(path: Path, data: Any, at: int, value: Any) -> Any:
    """Return plain data with the value at the entries of a path from number `at` on."""
    if at == len(path.entries):
        return value
    entry = path.entries[at]
    match data:
        case None:  # such as the friction of a slide without one: a table with this entry alone
            return {entry: _with(path, None, at + 1, value)}
        case dict():
            return data | {entry: _with(path, data.get(entry), at + 1, value)}
        case list() | tuple():
            index = COMPONENTS.get(entry, int(entry) if entry.isdecimal() else len(data))
            if index >= len(data):
                raise SceneError(path.where, f"{shown(data)} has no entry \"{entry}\"",
                                 f"write x, y, z, or a number below {len(data)}")
            return [_with(path, each, at + 1, value) if k == index else each for k, each in enumerate(data)]
    _check_end(path, at, data)
    return None


def _check_end(path: Path, at: int, data: Any = None) -> None:
    """Refuse entries of a number or a name. Raises SceneError."""
    if len(path.entries) > at:
        what = ".".join([path.head, *path.entries[:at]])
        is_now = "" if data is None else f", {show(data) if isinstance(data, float) else shown(data)},"
        raise SceneError(path.where, f'{what}{is_now} has no entries', f'write "{what}"')


def unit_of(scene: SceneData, path: Path) -> str:
    """Return the unit of what a path leads to in a scene that has a value there; empty where it has none."""
    if path.head == GRAVITY:
        return "m/s²"
    kind, entries = SETTINGS.get(path.head), list(path.entries)
    if path.part is not None:
        part = _parts(scene)[path.part]
        while len(entries) > 1 and isinstance(part.entries().get(entries[0]), Part):
            part = part.entries()[entries.pop(0)]
        kind = type(part)
    assert kind is not None, "gravity, settings and parts are all there is"
    return _unit_of_entry(kind, entries[0])


@cache
def _unit_of_entry(kind: type[Part], entry: str) -> str:
    """Return the unit of an entry of a kind of part."""
    return _unit(kind.model_json_schema(mode="validation").get("properties", {}).get(entry, {}))


def _unit(schema: Any) -> str:
    """Return the unit that the schema of an entry tells, also of one that may be left out."""
    if isinstance(schema, list):
        return next((unit for each in schema if (unit := _unit(each))), "")
    if not isinstance(schema, dict):
        return ""
    found = re.fullmatch(r"in ((?:N )?\S+)", schema.get("description", ""))
    return found[1] if found else _unit(schema.get("anyOf"))
