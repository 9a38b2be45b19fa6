"""The page of the parts of a scene: arguments, bounds, defaults and results, from their fields and docstrings."""

from __future__ import annotations

import inspect
import json
import re
from collections.abc import Iterator
from itertools import takewhile
from typing import Any

from funicular.kernels.elements import ElementKind, built_in
from funicular.parts.cable_laws import MEASURES, possible_laws
from funicular.parts.kinds import KINDS
from funicular.parts.part import FAMILIES, Part, names_a_part, parameters_of
from funicular.parts.scene_text import SETTINGS
from funicular.parts.section_stiffness import measures_of_law
from funicular.parts.validation import LIMITS, OTHER_LIMITS
from funicular.results.quantities import ENERGIES
from funicular.scene.file import bundled_scenes
from funicular.scene.schema import scene_schema

from .markdown import anchor, markdown, split, table

HEAD = """# Parts of a scene

Printed by `python -m funicular.guides.site.printed` from the fields and docstrings of the parts: change those.

A part is made by a method of the scene, such as `scene.spring(...)`, or stands in a scene file as a table of the same
name, `[[spring]]`. Arguments are keywords and entries of the table alike. Tables within it, such as a section, are
classes of the package: `fu.Circle(radius=0.01)` is `{ shape = "circle", radius = 0.01 }` in a file. Results of a part
have its name in front: `run["dropper.tension"]`.
"""

BOUNDS = {"minimum": "≥", "exclusiveMinimum": ">", "maximum": "≤", "exclusiveMaximum": "<"}


def parts_page() -> str:
    """Return the page as Markdown."""
    schema = scene_schema()
    kinds: list[tuple[str, list[type[Part]]]] = [
        ("Parts", list(KINDS)), ("Settings", list(SETTINGS.values())), *_groups(schema)]
    lines = [HEAD]
    for title, parts in kinds:
        links = ", ".join(f"[{part.__name__}](#{anchor(part.__name__)})" for part in parts)
        lines.append(f"- [{title}](#{anchor(title)}): {links}")
    lines += [f"- [{title}](#{anchor(title)})" for title in LISTS] + [""]
    for title, parts in kinds:
        lines += [f"## {title}", ""]
        for part in parts:
            lines += _section(part, schema)
    for title, printed in LISTS.items():
        lines += [f"## {title}", "", *printed()]
    return "\n".join(lines).rstrip() + "\n"


def _groups(schema: dict[str, Any]) -> Iterator[tuple[str, list[type[Part]]]]:
    """Yield the titles and classes of the tables within parts, each class once."""
    seen = set[type[Part]]()
    for name, title in TITLES.items():
        new = [part for part in FAMILIES[name].kinds if part not in seen]
        seen.update(new)
        yield title, new
    alone = {part.__name__: part for part in _classes(Part) if part.__name__ in schema["$defs"]}
    yield "Other tables", [alone[name] for name in schema["$defs"] if name in alone]


TITLES = {"section": "Sections", "signal": "Signals", "stop": "Ends of cables", "solid": "Shapes of bodies",
          "route_item": "Items of a rope's route", "profile": "Profiles of a flow",
          "surface_shape": "Shapes of surfaces alone"}
"""Of the families of tables, in this order."""


def _classes(base: type[Part]) -> Iterator[type[Part]]:
    """Yield all classes derived from a class of parts."""
    for part in base.__subclasses__():
        yield part
        yield from _classes(part)


def _section(part: type[Part], schema: dict[str, Any]) -> list[str]:
    """Return heading, syntax, docstring, arguments and results of a part."""
    entries, tag = _entries(part, schema)
    text, _ = split(inspect.getdoc(part) or "", part.keywords())
    lines = [f"### {part.__name__}", "", _written(part, tag), "", markdown(text), ""]
    required, meanings, rows = set(entries.get("required", [])), meanings_of(part), []
    for parameter in parameters_of(part):
        name = parameter.name
        field = entries["properties"].get(name, {})
        meaning = _without_unit(meanings.get(name, ""), field.get("description", "").removeprefix("in "))
        rows.append((f"`{name}`", markdown(meaning), _taken(part, name, entries["properties"]),
                     "required" if name in required else _default(parameter.default)))
    lines += table(("argument", "is", "takes", "default"), rows)
    return lines + table(("result", "unit", "is"), [
        (f"`{name}`", quantity.units, quantity.long_name) for name, quantity in part.results.items()])


def meanings_of(part: type[Part]) -> dict[str, str]:
    """Return the texts of the docstrings of a part and of its bases on its arguments."""
    found = {"name": "by which the scene and its results know it"}
    for base in reversed(part.__mro__):
        if issubclass(base, Part):
            found |= split(inspect.cleandoc(base.__doc__ or ""), part.keywords())[1]
    return found


def _without_unit(meaning: str, unit: str) -> str:
    """Return the text of an argument without its unit, which is in another column."""
    return re.sub(rf"(?:^|, ){re.escape(unit)}(?=$|[;.:,])", "", meaning, count=1).lstrip("; ,") if unit else meaning


def _taken(part: type[Part], keyword: str, properties: dict[str, Any]) -> str:
    """Return in words the values that a part takes for a keyword."""
    field = properties.get(keyword, {"type": "a function; in Python only"})
    named = names_a_part(part.model_fields[part.keywords()[keyword]]) and "description" not in field
    return "a part or its name" if named else _words(field)


def _default(value: Any) -> str:
    """Return a default as code; nothing where there is none."""
    return "" if value in (None, inspect.Parameter.empty) else f"`{_code(value)}`"


def _code(value: Any) -> str:
    """Return a value in the form that users write."""
    if isinstance(value, tuple | list):
        return f"({', '.join(map(_code, value))})"
    return f"{value:g}" if isinstance(value, float) else json.dumps(value)


def _written(part: type[Part], tag: tuple[str, str] | None) -> str:
    """Return the syntax of a part in Python and in a file."""
    if part in KINDS:
        return f"`scene.{part.kind}()`, `[[{part.kind}]]`"
    for name, settings in SETTINGS.items():
        if part is settings:
            return f"`scene.{name}()`, `[{name}]`"
    return f"`fu.{part.__name__}`" + (f', `{tag[0]} = "{tag[1]}"`' if tag else "")


def _entries(part: type[Part], schema: dict[str, Any]) -> tuple[dict[str, Any], tuple[str, str] | None]:
    """Return the schema of a part's table, and the entry that names the part."""
    for name, settings in SETTINGS.items():
        if part is settings:
            return schema["properties"][name], None
    if part in KINDS:
        return schema["properties"][part.kind]["items"], None
    for name, family in FAMILIES.items():
        if part in family.kinds:
            return schema["$defs"][name]["oneOf"][family.kinds.index(part)], (part.tag, getattr(part, part.tag))
    return schema["$defs"][part.__name__], None


def _words(field: dict[str, Any]) -> str:
    """Return in words the values of a field."""
    note = f" {field['description']}" if field.get("description", "in 1") != "in 1" else ""
    if "$ref" in field:
        name = field["$ref"].rsplit("/", 1)[1]
        title = TITLES.get(name, name)
        return f"[{title.lower() if name in TITLES else name}](#{anchor(title)})"
    if "enum" in field:
        return ", ".join(f'`"{word}"`' for word in field["enum"])
    if "const" in field:
        return f'`"{field["const"]}"`'
    if "anyOf" in field:
        each = [_words(one) for one in field["anyOf"] if one != {"type": "null"}]
        return " or ".join(dict.fromkeys(each)) + note
    if field.get("type") == "array":
        least, most = field.get("minItems"), field.get("maxItems")
        count = f" of {least}" if least == most else f" of {least} to {most}" if most else f" of {least} or more"
        count = " of" if least is None else count
        of = field.get("items", {})
        unit = of.get("description", "") if not note else ""
        of_what = "lists" if of.get("type") == "array" else "numbers" if of else "entries"
        of_what = _words(of) if "$ref" in of else of_what
        return f"list{count} {of_what}{note}{' ' * bool(unit)}{unit}"
    bounds = [f"{sign} {field[key]:,}" for key, sign in BOUNDS.items() if key in field]
    bounds += [f"at most {field['maxLength']} characters"] if "maxLength" in field else []
    return WORDS.get(field.get("type", "anything"), field.get("type", "anything")) + note + "".join(
        f", {bound}" for bound in bounds)


WORDS = {"string": "text", "boolean": "true or false", "object": "table"}
"""Words for types of JSON."""


def _limits() -> list[str]:
    """Return the bounds of all numbers."""
    rows = [(unit, f"{least:g}", f"{most:g}") for unit, (least, most) in LIMITS.items()]
    least, most = OTHER_LIMITS
    return ["A number has at most the larger size, and at least the smaller one where it must be positive. What lies "
            "outside is refused.", "", *table(("unit", "from", "to"), [*rows, ("other", f"{least:g}", f"{most:g}")])]


def _elements() -> list[str]:
    """Return the elements of cables with their laws."""
    return table(("element", "in", "nodal vectors", "laws, the first is the default"), [
        (f'`"{name}"`', "the plane" if kind.dim == 2 else "space", ", ".join(kind.nodal_vectors), _laws(kind))
        for name, kind in built_in().items()])


def _laws(kind: ElementKind) -> str:
    """Return the names of an element's laws: by ``law``, or by the measures of a cable."""
    laws = possible_laws(kind)
    if not kind.is_cable:
        return ", ".join(f'`law="{law}"`' for law in laws)
    measures = [measures_of_law(law) for law in laws]
    found = ((name, dict.fromkeys(each[name] for each in measures)) for name in MEASURES)
    return "; ".join(", ".join(f'`{name}="{value}"`' for value in values) for name, values in found)


def _energies() -> list[str]:
    """Return the energies among the results of a run."""
    return table(("result", "unit", "is"), [(f"`energy.{name}`", "J", what) for name, what in ENERGIES.items()])


def _scenes() -> list[str]:
    """Return the scenes of the package, with the first paragraph of their files."""
    return table(("scene", "is"), [(f"[`{name}`](../../scenes/{path.name})", _first_paragraph(path.read_text("utf-8")))
                                   for name, path in bundled_scenes().items()])


def _first_paragraph(text: str) -> str:
    """Return the first paragraph of the comment at the head of a file."""
    return " ".join(line.removeprefix("#").strip() for line in takewhile(lambda line: len(line) > 1, text.splitlines()))


LISTS = {"Elements of cables": _elements, "Energies": _energies, "Bounds of numbers": _limits,
         "Bundled scenes": _scenes}
"""Titles of the sections after those of parts, and their functions."""
