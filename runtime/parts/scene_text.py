"""Scenes as text, and back: TOML tables with the names of the Python API.

``gravity``, one array of tables for each kind of part (``[[cable]]``, ``[[pin]]``, ...), ``[equilibrium]``,
``[relax]`` and ``[run]``. All checks are those of the parts, the settings and `funicular.Scene`.
"""

from __future__ import annotations

import json
import os
import re
import tomllib
from collections.abc import Callable, Iterable, Iterator, Mapping
from itertools import takewhile
from typing import Any, Protocol, TypeVar

from ..errors import SceneError, SceneFileError, near, shown_path
from ..kernels.libraries import check_allowed, resolved
from .event import Event
from .file_paths import FilePath
from .kinds import PARTS
from .pairs import are_lists
from .part import Part
from .scene_data import SceneData
from .scene_lines import line_of
from .settings import EquilibriumSettings, RelaxationSettings, RunSettings

BARE = re.compile(r"[A-Za-z0-9_-]+")
"""A key that a scene file need not quote."""
SETTINGS = {"run": RunSettings, "equilibrium": EquilibriumSettings, "relax": RelaxationSettings}

TABLES = ("gravity", *PARTS, *SETTINGS)


DOTTED = re.compile(r"""\.[ \t]*+(?:[A-Za-z0-9_-]++|"[^"\n]*+"|'[^'\n]*+')[ \t]*+(?=\.)""")
"""A part in the middle of a key with dots."""
MOST_DEPTH = 100
"""Parts of a key; those of scene files have three."""

MOST_ERRORS = 20
"""That are looked for in a file; each is sought in its text, and nobody reads more."""


class Addable(Protocol):
    """A scene to which parts can be added."""

    def add(self, part: Part) -> Part:
        """Add a part. Raises SceneError."""

    def add_pairs(self, kind: type[Part], entries: Mapping[str, Any]) -> list[Part]:
        """Add the parts of many pairs. Raises SceneError."""


S = TypeVar("S", bound=Addable)


def read(text: str, origin: str, new: Callable[..., S], directory: str | os.PathLike = "",
         libraries: Iterable[str | os.PathLike] = ()) -> S:
    """Return a scene from the text of a scene file; ``origin`` is what error messages call it.

    new: makes an empty scene, of the keyword gravity; directory: where paths in the text start from, by default the
    working directory; libraries: directories of elements that the text may load. Raises SceneError.
    """
    _check_depth(text, origin)
    try:
        tables = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:  # its text gives line and column
        raise SceneError(origin, f"is not valid TOML: {error}") from None
    except RecursionError:
        raise SceneError(origin, "is nested too deeply") from None
    except ValueError:  # Python refuses to read an integer of thousands of digits
        raise SceneError(origin, "has an integer of too many digits", "write it as a number such as 1e9") from None
    try:
        _check_libraries(tables, directory, [libraries] if isinstance(libraries, str | os.PathLike) else [*libraries])
    except SceneError as error:
        raise error.inside(origin) from None
    reader = _Reader(text, tables, directory)
    try:
        scene = new(**{name: tables[name] for name in ("gravity",) if name in tables})
    except SceneError as error:
        reader.note(error, "gravity")
        scene = new()
    reader.read_all(scene)
    if reader.found:
        raise SceneFileError(origin, reader.found, more=len(reader.found) == MOST_ERRORS)
    return scene


def _check_depth(text: str, origin: str) -> None:
    """Refuse keys of very many parts, which take tomllib time and memory by their square. Raises SceneError."""
    depth = end = 0
    for found in DOTTED.finditer(text):
        depth = depth + 1 if found.start() == end else 1
        end = found.end()
        if depth > MOST_DEPTH:
            line = text.count("\n", 0, end) + 1
            raise SceneError(f"{origin}, line {line}", f"has a key of more than {MOST_DEPTH} parts with dots between")


class _Reader:
    """Adds the parts of a file to a scene, and goes on where one is wrong, so that all errors are found at once."""

    def __init__(self, text: str, tables: dict, directory: str | os.PathLike):
        self.text, self.tables, self.directory = text, tables, directory
        self.found: list[tuple[int | None, SceneError]] = []
        self.refused: set[str] = set()
        """Names of parts that are not in the scene: what refers to them is checked no further."""

    def note(self, error: SceneError, table: str, index: int | None = None) -> None:
        """Keep what is wrong with a table of the file."""
        for each in error.errors[: MOST_ERRORS - len(self.found)]:
            self.found.append((line_of(self.text, table, index, each.entry), each))

    def read_all(self, scene: Addable) -> None:
        """Add all parts and settings to an empty scene."""
        for name in self.tables:
            if len(self.found) == MOST_ERRORS:
                return
            if name not in TABLES:
                self.note(SceneError("scene", f'"{shown_path(name)}" is not known here', near(name, TABLES)), name,
                          0 if _is_array(self.tables[name]) else None)
        for kind in PARTS:
            try:
                array = _array(self.tables, kind)
            except SceneError as error:
                self.note(error, kind)
                continue
            for index, table in enumerate(array):
                if len(self.found) == MOST_ERRORS:
                    return
                self._add(scene, kind, index, table)
        for name in SETTINGS:
            if name in self.tables:
                try:
                    setattr(scene, f"{name}_settings", _settings(name, self.tables[name], self.directory))
                except SceneError as error:
                    self.note(error, name)

    def _add(self, scene: Addable, kind: str, index: int, table: dict) -> None:
        try:
            self._add_parts(scene, PARTS[kind], _placed(table, self.directory), index + 1)
        except SceneError as error:
            self.note(error, kind, index)
            if isinstance(table.get("name"), str):
                self.refused.add(table["name"])


    def _add_parts(self, scene: Any, kind: type[Part], table: dict, number: int) -> None:
        """Add what a table describes, unless it refers to what is not in the scene."""
        refers = not self.refused & set(_words(table))
        if not are_lists(scene, kind, table):
            part = _part(kind, table, number)
            if refers:
                scene.add(part)
        elif refers:
            try:
                scene.add_pairs(kind, table)
            except SceneError as error:
                if error.place != kind.kind:
                    raise
                raise _numbered(error, kind, number) from None


def _words(value: Any) -> Iterator[str]:
    """Yield all texts in a table, at any depth."""
    match value:
        case str():
            yield value
        case dict():
            for each in value.values():
                yield from _words(each)
        case list():
            for each in value:
                yield from _words(each)


def _is_array(value: Any) -> bool:
    return isinstance(value, list) and all(isinstance(table, dict) for table in value)


def _array(tables: dict, kind: str) -> list:
    array = tables.get(kind, [])
    if not _is_array(array):
        raise SceneError(f"[{kind}]", "must be an array of tables", f"write [[{kind}]], in two brackets")
    return array


def _check_libraries(tables: dict, directory: str | os.PathLike, allowed: list[str | os.PathLike]) -> None:
    """Refuse libraries that the caller does not allow, before any of them is loaded. Raises SceneError."""
    for kind, part in PARTS.items():
        for index, table in enumerate(_array(tables, kind), start=1):
            if isinstance(library := table.get("library"), str):
                place = part.title(table) if isinstance(table.get("name"), str) else f"[[{kind}]] {index}"
                try:
                    asked = resolved(os.path.join(directory, library))
                except ValueError as error:
                    raise SceneError(place, f"library {error}") from None
                check_allowed(asked, allowed, place)


def _placed(table: dict, directory: str | os.PathLike) -> dict:
    """Return a table with its library, data and mesh seen from the working directory, and not from the scene file's."""
    here = {name: os.path.join(directory, table[name]) for name in ("library", "data", "file")
            if isinstance(table.get(name), str)}
    return table | here | {name: _placed(table[name], directory) for name in ("shape", "table")
                           if isinstance(table.get(name), dict)}


def _part(part: type[Part], table: dict, index: int) -> Part:
    try:
        return part(**table)
    except SceneError as error:
        if isinstance(table.get("name"), str):
            raise
        raise _numbered(error, part, index) from None


def _numbered(error: SceneError, part: type[Part], index: int) -> SceneError:
    """Return an error of a table of parts without a name, with the number of the table."""
    unnamed = [SceneError(f"[[{part.kind}]] {index}", each.cause, each.remedy, each.entry) for each in error.errors]
    unnamed[0].errors = tuple(unnamed)
    return unnamed[0]


def _settings(name: str, table: Any, directory: str | os.PathLike) -> dict:
    """Return what a table of settings sets, checked; directory: of the file."""
    if not isinstance(table, dict):
        raise SceneError(f"[{name}]", "must be a table")
    settings = SETTINGS[name](**table).field_values(given=True)
    if settings.get("save") is not None:
        settings["save"] = FilePath(settings["save"], directory)
        try:
            settings["save"].check()
        except ValueError as error:
            raise SceneError(f"[{name}]", error.args[0], error.args[1], "save") from None
    return settings


def dumps(scene: SceneData) -> str:
    """Return the text of a scene file, such that `loads` makes the same scene of it."""
    lines, parts = [f"gravity = {as_toml(scene.gravity)}"], list(scene.parts())
    for kind in PARTS:
        for part in parts:
            if part.kind == kind and isinstance(part, Event) and part.function is not None:
                lines += ["", f"# {part.where} watches a function, which a file cannot describe"]
            elif part.kind == kind:
                lines += ["", f"[[{kind}]]", *_lines(plain_data(part))]
    for name in SETTINGS:
        if settings := getattr(scene, f"{name}_settings"):
            lines += ["", f"[{name}]", *_lines(settings)]
    return "\n".join(lines) + "\n"


def parts_text(text: str) -> str:
    """Return the text of a scene that `dumps` made without its settings, which come last."""
    heads = {f"[{name}]" for name in SETTINGS}
    return "\n".join(takewhile(lambda line: line not in heads, text.split("\n"))).rstrip()


def plain_data(value: Any) -> Any:
    """Return a value as plain data: of a part all that is set, defaults too, which a later version may change."""
    match value:
        case Part():
            if (short := value.as_given()) is not value:
                return plain_data(short)
            tag = {value.tag: getattr(value, value.tag)} if value.tag else {}
            return tag | {keyword: plain_data(each) for keyword, each in value.entries().items()}
        case list() | tuple():
            return [plain_data(each) for each in value]
    return value


def _lines(table: dict) -> list[str]:
    return [f"{name if BARE.fullmatch(name) else as_toml(name)} = {as_toml(value)}" for name, value in table.items()]


def as_toml(value: Any) -> str:
    """Return a value as the text of a scene file."""
    match value:
        case str():
            return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
        case bool():
            return str(value).lower()
        case dict():
            return "{" + ", ".join(_lines(value)) + "}"
        case list() | tuple():
            return "[" + ", ".join(map(as_toml, value)) + "]"
        case _:
            return repr(value)
