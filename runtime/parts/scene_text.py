"""Reading and writing of scenes as TOML, with the names of the Python API.

``gravity``, an array of tables for each kind of part (``[[cable]]``, ``[[pin]]``, ...), ``[equilibrium]``, ``[relax]``
and ``[run]``. The checks are those of parts, settings and `funicular.Scene`.
"""

from __future__ import annotations

import json
import os
import re
from collections.abc import Callable, Iterable, Iterator
from functools import cache
from itertools import takewhile
from typing import Any, TypeVar

from ..errors import SceneError, SceneFileError, near, shown_path
from ..kernels.libraries import check_allowed, resolved
from .event import Event
from .file_paths import FilePath
from .kinds import PARTS
from .pairs import are_lists
from .part import Part, about_fields
from .scene_data import SceneData
from .schemas import FileEntry
from .settings import EquilibriumSettings, RelaxationSettings, RunSettings

Directory = str | os.PathLike[str]
BARE = r"[A-Za-z0-9_-]+"
"""A key without quotes."""
SETTINGS = {"run": RunSettings, "equilibrium": EquilibriumSettings, "relax": RelaxationSettings}
OF_ALL = ("gravity", "temperature")
"""Entries of a scene as a whole."""
TABLES = (*OF_ALL, *PARTS, *SETTINGS)

DOTTED = r"""\.[ \t]*+(?:[A-Za-z0-9_-]++|"[^"\n]*+"|'[^'\n]*+')[ \t]*+(?=\.)"""
"""A part in the middle of a key with dots."""
MAX_KEY_PARTS = 100
"""Keys of scene files have three."""
MAX_ERRORS = 20
"""Of a file in a message; each one is located in the text."""
MAX_PATTERN_LENGTH = 1000
"""Characters of a name that is located: a pattern of a million takes seconds."""

S = TypeVar("S", bound=SceneData)


def read(text: str, origin: str, new: Callable[..., S], directory: Directory = "",
         libraries: Iterable[Directory] = ()) -> S:
    """Return a scene from the text of a scene file; origin: its name in messages.

    new: makes an empty scene from the keywords `OF_ALL`; directory: of relative paths in the text, by default the
    working directory; libraries: directories of elements that the text may load. Raises SceneError.
    """
    _check_depth(text, origin)
    import tomllib  # compiles its expressions, as long as a small scene takes to run

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
        scene = new(**{name: tables[name] for name in OF_ALL if name in tables})
    except SceneError as error:
        reader.note(error, next((name for name in OF_ALL if error.cause.startswith(name)), OF_ALL[0]))
        scene = new()
    reader.read_all(scene)
    if reader.found:
        raise SceneFileError(origin, reader.found, more=len(reader.found) == MAX_ERRORS)
    return scene


def _check_depth(text: str, origin: str) -> None:
    """Raise SceneError for very long keys: time and memory of tomllib grow with the square of their parts."""
    depth = end = 0
    for found in re.finditer(DOTTED, text):
        depth = depth + 1 if found.start() == end else 1
        end = found.end()
        if depth > MAX_KEY_PARTS:
            line = text.count("\n", 0, end) + 1
            raise SceneError(f"{origin}, line {line}",
                             f"has a key of more than {MAX_KEY_PARTS} parts with dots between")


class _Reader:
    """Adds the parts of a file to a scene, and continues after errors to find all of them."""

    def __init__(self, text: str, tables: dict[str, Any], directory: Directory):
        self.text, self.tables, self.directory = text, tables, directory
        self.found: list[tuple[int | None, SceneError]] = []
        self.refused: set[str] = set()
        """Names of refused parts; parts that refer to them are not added."""

    def note(self, error: SceneError, table: str, index: int | None = None) -> None:
        """Store the errors of a table of the file."""
        for each in error.errors[: MAX_ERRORS - len(self.found)]:
            self.found.append((line_of(self.text, table, index, each.entry), each))

    def read_all(self, scene: SceneData) -> None:
        """Add all parts and settings to an empty scene."""
        for name in self.tables:
            if len(self.found) == MAX_ERRORS:
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
                if len(self.found) == MAX_ERRORS:
                    return
                self._add(scene, kind, index, table)
        for name in SETTINGS:
            if name in self.tables:
                try:
                    setattr(scene, f"{name}_settings", _settings(name, self.tables[name], self.directory))
                except SceneError as error:
                    self.note(error, name)

    def _add(self, scene: SceneData, kind: str, index: int, table: dict[str, Any]) -> None:
        try:
            self._add_parts(scene, PARTS[kind], _placed(table, self.directory), index + 1)
        except SceneError as error:
            self.note(error, kind, index)
            if isinstance(table.get("name"), str):
                self.refused.add(table["name"])

    def _add_parts(self, scene: SceneData, kind: type[Part], table: dict[str, Any], number: int) -> None:
        """Add the parts of a table, unless it refers to refused ones."""
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
    """Yield all texts in a table."""
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


def _array(tables: dict[str, Any], kind: str) -> list[dict[str, Any]]:
    array: list[dict[str, Any]] = tables.get(kind, [])
    if not _is_array(array):
        raise SceneError(f"[{kind}]", "must be an array of tables", f"write [[{kind}]], in two brackets")
    return array


def _check_libraries(tables: dict[str, Any], directory: Directory, allowed: list[Directory]) -> None:
    """Raise SceneError for libraries that the caller does not allow, before any is loaded."""
    for kind, part in PARTS.items():
        for index, table in enumerate(_array(tables, kind), start=1):
            if isinstance(library := table.get("library"), str):
                place = part.title(table) if isinstance(table.get("name"), str) else f"[[{kind}]] {index}"
                try:
                    asked = resolved(os.path.join(directory, library))
                except ValueError as error:
                    raise SceneError(place, f"library {error}") from None
                check_allowed(asked, allowed, place)


def _placed(table: dict[str, Any], directory: Directory) -> dict[str, Any]:
    """Return a table of a part with its paths, also those of tables in it, relative to the working directory."""
    made = dict(table)
    for name, value in table.items():
        if isinstance(value, dict):
            made[name] = _placed(value, directory)
        elif isinstance(value, str) and name in _paths():
            made[name] = os.path.join(directory, value)
    return made


@cache
def _paths() -> set[str]:
    """Return the keywords of parts that are paths."""
    kinds = [Part]
    for kind in kinds:
        kinds += kind.__subclasses__()
    return {keyword for kind in kinds for keyword, name in kind.keywords().items()
            if isinstance(about_fields(kind).get(name), FileEntry)}


def _part(part: type[Part], table: dict[str, Any], index: int) -> Part:
    try:
        return part(**table)
    except SceneError as error:
        if isinstance(table.get("name"), str):
            raise
        raise _numbered(error, part, index) from None


def _numbered(error: SceneError, part: type[Part], index: int) -> SceneError:
    """Return an error with the number of its table in place of a name."""
    unnamed = [SceneError(f"[[{part.kind}]] {index}", each.cause, each.remedy, each.entry) for each in error.errors]
    unnamed[0].errors = tuple(unnamed)
    return unnamed[0]


def _settings(name: str, table: Any, directory: Directory) -> dict[str, Any]:
    """Return the checked settings of a table; directory: of the file."""
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
    """Return the text of a scene file that `read` turns into the same scene."""
    whole = {name: plain_data(value) for name in OF_ALL if (value := getattr(scene, name)) is not None}
    lines, parts = _lines(whole), list(scene.parts())
    for kind in PARTS:
        for part in parts:
            if part.kind == kind and isinstance(part, Event) and part.function is not None:
                lines += ["", f"# {part.where} watches a function, which a file cannot describe"]
            elif part.kind == kind:
                found = {name for name in part.of_scene if name not in part.model_fields_set}
                lines += ["", f"[[{kind}]]", *_lines({name: value for name, value in plain_data(part).items()
                                                      if name not in found})]
    for name in SETTINGS:
        if settings := getattr(scene, f"{name}_settings"):
            lines += ["", f"[{name}]", *_lines(settings)]
    return "\n".join(lines) + "\n"


def parts_text(text: str) -> str:
    """Return a text of `dumps` without its settings, which come last."""
    heads = {f"[{name}]" for name in SETTINGS}
    return "\n".join(takewhile(lambda line: line not in heads, text.split("\n"))).rstrip()


def plain_data(value: Any) -> Any:
    """Return a value as plain data, a part with its defaults, which a later version may change."""
    match value:
        case Part():
            if (short := value.as_given()) is not value:
                return plain_data(short)
            tag = {value.tag: getattr(value, value.tag)} if value.tag else {}
            return tag | {keyword: plain_data(each) for keyword, each in value.entries().items()}
        case list() | tuple():
            return [plain_data(each) for each in value]
    return value


def _lines(table: dict[str, Any]) -> list[str]:
    return [f"{name if re.fullmatch(BARE, name) else as_toml(name)} = {as_toml(value)}"
            for name, value in table.items()]


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


def line_of(text: str, table: str, index: int | None = None, entry: str | None = None) -> int | None:
    """Return the line number, from 1, of an entry of a table in a scene file, else of the head of the table.

    table: its name; index: in an array of tables, from 0; entry: its name. None where the line is not found, such as
    that of a missing entry of a table in one line.
    """
    if max(len(table), len(entry or "")) > MAX_PATTERN_LENGTH:
        return None
    lines = text.splitlines(keepends=True)
    head = _first(lines, rf"\s*\[{{{1 if index is None else 2}}}\s*[\"']?{re.escape(table)}[\"']?\s*\]",
                  lambda before: index is None or len(before.get(table, [])) == index, skip=index or 0)
    if head is None:
        found = None if entry is not None else _first(lines, _entry(table))
        return None if found is None else found + 1
    if entry is None:
        return head + 1
    end = _first(lines, rf"\s*\[+\s*(?!{re.escape(table)}\s*\.)", after=head)
    within = lines[: len(lines) if end is None else end]
    found = _first(within, rf"{_entry(entry)}|\s*\[+\s*{re.escape(table)}\s*\.\s*{re.escape(entry)}\b", after=head)
    return (head if found is None else found) + 1


def _entry(name: str) -> str:
    return rf"\s*[\"']?{re.escape(name)}[\"']?\s*[=.]"


def _first(lines: list[str], pattern: str, fits: Callable[[dict[str, Any]], bool] = lambda before: True,
           after: int = -1, skip: int = 0) -> int | None:
    """Return the index of the first matching line whose preceding lines are TOML that fits.

    Lines before one inside a multi-line text or list are no TOML. after: a line that precedes it; skip: number of
    matches that cannot be it, as each test parses all lines before.
    """
    matches = [k for k in range(after + 1, len(lines)) if re.match(pattern, lines[k])]
    return next((k for k in matches[skip:] if (before := _parsed(lines[:k])) is not None and fits(before)), None)


def _parsed(lines: list[str]) -> dict[str, Any] | None:
    import tomllib  # likewise: only for lines of errors

    try:
        return tomllib.loads("".join(lines))
    except (ValueError, RecursionError):
        return None
