"""Paths into a scene, such as ``wire.material.youngs_modulus`` or ``run.tol``, and scenes with other values there.

A path begins with the name of a part (of a pin, clamp or motion its name in results, ``wire@0``), or with ``gravity``,
``run`` or ``equilibrium``, or is ``temperature``; then come entries as a scene file names them. ``x``, ``y``, ``z`` are
components of vectors, and numbers, from 0, are entries of lists.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from functools import cache
from typing import Any, Generic, TypeVar

from ..base.deferred import dataclass
from ..errors import SceneError, near
from .part import Part
from .scene_data import SceneData
from .scene_text import OF_ALL, SETTINGS, plain_data
from .validation import show, shown

COMPONENTS = {"x": 0, "y": 1, "z": 2}
GRAVITY, TEMPERATURE = OF_ALL


@dataclass(frozen=True)
class Path:
    """A path: its head, the entries after it, and the number of its part in the order of the scene.

    part: None for gravity, temperature and settings; use: purpose of the path in messages, such as "sweep".
    """

    text: str
    head: str
    entries: tuple[str, ...]
    part: int | None
    use: str = "sweep"

    @property
    def where(self) -> str:
        """Return the name of the path in messages."""
        return f'{self.use} of "{self.text}"'


def label_of(part: Part) -> str | None:
    """Return the name of a part in paths: its own, or that of a support in results."""
    return part.given_name or getattr(part, "label", None)


def path_of(scene: SceneData, text: str, use: str = "sweep") -> Path:
    """Return the path of a text in a scene; use: see `Path`. Raises SceneError for an unknown path."""
    where = f'{use} of "{text}"'
    heads: dict[str, int | None] = dict.fromkeys((*OF_ALL, *SETTINGS))
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
    """Raise SceneError for a path whose part has no such entry."""
    if path.head == TEMPERATURE and path.part is None:
        _check_end(path, 0)
        return
    if path.head == GRAVITY:
        known: Iterable[str] = COMPONENTS
    elif path.part is None:
        known = [name for name in SETTINGS[path.head].keywords() if name != "save"]
    else:
        known = [name for name in [*scene.parts()][path.part].keywords() if name != "name"]
    if not path.entries:
        example = f"{path.head}.{next(iter(known))}"
        raise SceneError(path.where, "names no entry", f'write such as "{example}" (known: '
                         + ", ".join(known) + ")")
    if path.entries[0] not in known:
        raise SceneError(path.where, f'{path.head} has no "{path.entries[0]}"',
                         _nearest(path.entries[0], known))


def _nearest(name: str, known: Iterable[str]) -> str:
    """Return the remedy for an unknown name: the nearest known name and all names."""
    nearest, listed = near(name, known), f"known: {', '.join(known)}"
    return nearest if nearest == listed else f"{nearest} ({listed})"


def check_each_once(paths: Iterable[Path]) -> None:
    """Raise SceneError for two paths to the same number, such as a.y and a.1."""
    first: dict[tuple[str, ...], str] = {}
    for path in paths:
        entries = tuple(str(COMPONENTS.get(entry, entry)) for entry in path.entries)
        if (other := first.setdefault((path.head, *entries), path.text)) != path.text:
            raise SceneError(path.where, f'is the same number as "{other}"', "name each number once")


S = TypeVar("S", bound=SceneData)


class Variants(Generic[S]):
    """Scenes with other values at the same paths, each changed at once.

    Parts before the first one that changes, in the order of the scene, are added and checked once: the others, which
    come later, have no effect on them.
    """

    def __init__(self, scene: S, paths: Iterable[Path]):
        """paths: of `path_of`. Raises SceneError."""
        self._scene, self._parts = scene, [*scene.parts()]
        changing = [0 if path.head in OF_ALL else path.part for path in paths]
        self._first = min((number for number in changing if number is not None), default=len(self._parts))
        self._begun = scene.with_parts(self._parts[:self._first]) if self._first else None

    def at(self, values: Mapping[Path, Any]) -> S:
        """Return the scene with other values. Raises SceneError."""
        scene, first = self._scene, self._first
        settings: dict[str, dict[str, Any]] = {name: {} for name in SETTINGS}
        for path, value in values.items():
            if path.part is None and path.head not in OF_ALL:
                settings[path.head][path.entries[0]] = value
                _check_end(path, 1)
        changes, gravity = changes_of(scene, values), gravity_of(scene, values)
        parts = (part.remade(changes[k]) if k in changes else part for k, part in enumerate(self._parts[first:], first))
        made = scene.with_parts(parts, gravity, self._begun, temperature_of(values))
        for name, table in settings.items():
            if table:
                setattr(made, f"{name}_settings", getattr(scene, f"{name}_settings") | table)
        return made


def gravity_of(scene: SceneData, values: Mapping[Path, Any]) -> list[Any]:
    """Return gravity with other values. Raises SceneError."""
    gravity: list[Any] = list(scene.gravity)
    for path, value in values.items():
        if path.head == GRAVITY and path.part is None:
            gravity[COMPONENTS[path.entries[0]]] = value
            _check_end(path, 1)
    return gravity


def temperature_of(values: Mapping[Path, Any]) -> Any:
    """Return the other value of the temperature of the scene, None where there is none."""
    return next((value for path, value in values.items() if path.head == TEMPERATURE and path.part is None), None)


def changes_of(scene: SceneData, values: Mapping[Path, Any]) -> dict[int, dict[str, Any]]:
    """Return the changes of parts, values by keyword by the number of a part. Raises SceneError."""
    parts = [*scene.parts()]
    changes: dict[int, dict[str, Any]] = {}
    for path, value in values.items():
        if path.part is not None:
            entries, first = changes.setdefault(path.part, {}), path.entries[0]
            before = (entries[first] if first in entries
                      else plain_data(parts[path.part].as_made().entries().get(first)))
            entries[first] = _with(path, before, 1, value)
    return changes


def value_at(scene: SceneData, path: Path) -> Any:
    """Return the value at a path in a scene as plain data, None where the part has no such entry.

    Raises SceneError for entries of a component of gravity.
    """
    if path.part is None and path.head == TEMPERATURE:
        return plain_data(scene.temperature)
    if path.part is None and path.head != GRAVITY:
        return None
    if path.part is None:
        _check_end(path, 1)
        return scene.gravity[COMPONENTS[path.entries[0]]]
    data: Any = plain_data([*scene.parts()][path.part].entries().get(path.entries[0]))
    for entry in path.entries[1:]:
        if isinstance(data, list):
            index = _index(entry, len(data))
            data = data[index] if index < len(data) else None
        else:
            data = data.get(entry) if isinstance(data, dict) else None
    return data


def _index(entry: str, size: int) -> int:
    """Return the index that an entry of a path names in a list, its size for an unknown one."""
    return COMPONENTS.get(entry, int(entry) if entry.isdecimal() else size)


def _with(path: Path, data: Any, at: int, value: Any) -> Any:
    """Return plain data with a value at the entries of a path from number `at` on."""
    if at == len(path.entries):
        return value
    entry = path.entries[at]
    match data:
        case None:  # such as the friction of a slide without friction: a table of this entry
            return {entry: _with(path, None, at + 1, value)}
        case dict():
            return data | {entry: _with(path, data.get(entry), at + 1, value)}
        case list() | tuple():
            index = _index(entry, len(data))
            if index >= len(data):
                raise SceneError(path.where, f"{shown(data)} has no entry \"{entry}\"",
                                 f"write x, y, z, or a number below {len(data)}")
            return [_with(path, each, at + 1, value) if k == index else each for k, each in enumerate(data)]
    _check_end(path, at, data)
    return None


def _check_end(path: Path, at: int, data: Any = None) -> None:
    """Raise SceneError for entries of a number or a name."""
    if len(path.entries) > at:
        what = ".".join([path.head, *path.entries[:at]])
        is_now = "" if data is None else f", {show(data) if isinstance(data, float) else shown(data)},"
        raise SceneError(path.where, f'{what}{is_now} has no entries', f'write "{what}"')


def unit_of(scene: SceneData, path: Path) -> str:
    """Return the unit of the value at a path in a scene, empty for a number without unit."""
    if path.part is None and path.head in OF_ALL:
        return "K" if path.head == TEMPERATURE else "m/s²"
    kind, entries = SETTINGS.get(path.head), list(path.entries)
    if path.part is not None:
        part = [*scene.parts()][path.part]
        while len(entries) > 1 and isinstance(part.entries().get(entries[0]), Part):
            part = part.entries()[entries.pop(0)]
        kind = type(part)
    assert kind is not None, "a path begins with gravity, settings or a part"
    return _unit_of_entry(kind, entries[0])


@cache
def _unit_of_entry(kind: type[Part], entry: str) -> str:
    """Return the unit of an entry of a kind of part."""
    return _unit(kind.model_json_schema(mode="validation").get("properties", {}).get(entry, {}))


def _unit(schema: Any) -> str:
    """Return the unit in the schema of an entry."""
    if isinstance(schema, list):
        return next((unit for each in schema if (unit := _unit(each))), "")
    if not isinstance(schema, dict):
        return ""
    found = re.fullmatch(r"in ((?:N )?\S+)", schema.get("description", ""))
    return found[1] if found else _unit(schema.get("anyOf"))
