"""The JSON Schema of scene files, from the parts' fields: editors complete and check scene files by it."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from ..parts.end_stops import STOPS
from ..parts.flow_profile import PROFILES
from ..parts.kinds import PARTS
from ..parts.part import Part
from ..parts.scene_text import SETTINGS
from ..parts.schemas import TABLE_OF
from ..parts.section import SHAPES
from ..parts.signal import FORMS
from ..parts.solids import SOLIDS
from ..parts.surface_shapes import SURFACE_SHAPES

DIALECT = "http://json-schema.org/draft-07/schema#"
"""The newest one that editors of TOML know."""

GROUPS: dict[str, tuple[str, Iterable[type[Part]]]] = {
    "section": ("shape", SHAPES.values()), "signal": ("form", FORMS.values()), "stop": ("stop", STOPS.values()),
    "solid": ("kind", SOLIDS.values()), "profile": ("form", PROFILES.values()),
    "surface_shape": ("kind", SURFACE_SHAPES.values())}
"""What tables describe that say by an entry which of several parts they are: that entry, and the parts."""


def scene_schema() -> dict[str, Any]:
    """Return the JSON Schema of scene files, as data for `json.dump`."""
    definitions: dict[str, Any] = {}
    for name, (tag, parts) in GROUPS.items():
        definitions[name] = {"oneOf": [_table(part, definitions, tag) for part in parts]}
    tables: dict[str, Any] = {"gravity": {
        "type": "array", "items": {"type": "number"}, "minItems": 3, "maxItems": 3, "description": "in m/s²"}}
    for name, part in PARTS.items():
        tables[name] = {"type": "array", "items": _table(part, definitions)}
    for name, settings in SETTINGS.items():
        tables[name] = _table(settings, definitions)
    return {"$schema": DIALECT, "title": "A funicular scene", "type": "object", "properties": tables,
            "additionalProperties": False, "$defs": definitions}


def _table(part: type[Part], definitions: dict[str, Any], tag: str | None = None) -> dict[str, Any]:
    """Return the schema of a table that describes a part; what it refers to is added to the definitions."""
    schema = _linked(part.model_json_schema(mode="validation"))
    for name, found in schema.pop("$defs", {}).items():
        definitions.setdefault(name, _closed(found))
    schema = _closed(schema)
    if tag is not None:
        schema["properties"] = {tag: {"const": getattr(part, tag)}} | schema["properties"]
        schema["required"] = [tag, *schema.get("required", [])]
    return schema


def _linked(schema: Any) -> Any:
    """Return a schema with references to the groups of tables."""
    if isinstance(schema, list):
        return [_linked(each) for each in schema]
    if not isinstance(schema, dict):
        return schema
    if TABLE_OF in schema:
        return {"$ref": f"#/$defs/{schema[TABLE_OF]}"}
    return {name: _linked(each) for name, each in schema.items()}


def _closed(schema: dict[str, Any]) -> dict[str, Any]:
    """Return the schema of a table that holds nothing else, without what only Python can give."""
    properties = {name: _without_null(field) for name, field in schema.get("properties", {}).items()
                  if field.get("not") != {}}
    return schema | {"properties": properties, "additionalProperties": False}


def _without_null(field: dict[str, Any]) -> dict[str, Any]:
    """Return the schema of an entry without null, which TOML has not, and without a title that repeats its name."""
    kept = {key: each for key, each in field.items() if key != "title" and (key, each) != ("default", None)}
    some = [each for each in kept.get("anyOf", []) if each != {"type": "null"}]
    return {key: each for key, each in kept.items() if key != "anyOf"} | some[0] if len(some) == 1 else kept
