"""The JSON Schema of scene files, from the fields of parts, for completion and checks in editors."""

from __future__ import annotations

from typing import Any

from ..parts.kinds import PARTS
from ..parts.part import FAMILIES, Part
from ..parts.scene_text import SETTINGS
from ..parts.schemas import TABLE_OF
from ..parts.signal import SIGNALS

DIALECT = "http://json-schema.org/draft-07/schema#"
"""The newest dialect that TOML editors support."""


def scene_schema() -> dict[str, Any]:
    """Return the JSON Schema of scene files, as data for `json.dump`."""
    definitions: dict[str, Any] = {}
    for name, family in FAMILIES.items():
        definitions[name] = {"oneOf": [_table(part, definitions) for part in family.kinds]}
    tables: dict[str, Any] = {"gravity": {
        "type": "array", "items": {"type": "number"}, "minItems": 3, "maxItems": 3, "description": "in m/s²"}}
    tables["temperature"] = {"anyOf": [{"type": "number", "description": "in K"}, _linked(SIGNALS.schema)]}
    for name, part in PARTS.items():
        tables[name] = {"type": "array", "items": _table(part, definitions)}
    for name, settings in SETTINGS.items():
        tables[name] = _table(settings, definitions)
    return {"$schema": DIALECT, "title": "A funicular scene", "type": "object", "properties": tables,
            "additionalProperties": False, "$defs": definitions}


def _table(part: type[Part], definitions: dict[str, Any]) -> dict[str, Any]:
    """Return the schema of a table that describes a part; the tables in it are added to the definitions."""
    schema = _linked(part.model_json_schema(mode="validation"))
    for name, found in schema.pop("$defs", {}).items():
        definitions.setdefault(name, _closed(found))
    schema = _closed(schema)
    if part.tag:
        schema["properties"] = {part.tag: {"const": getattr(part, part.tag)}} | schema["properties"]
        schema["required"] = [part.tag, *schema.get("required", [])]
    return schema


def _linked(schema: Any) -> Any:
    """Return a schema with references to the families of parts."""
    if isinstance(schema, list):
        return [_linked(each) for each in schema]
    if not isinstance(schema, dict):
        return schema
    if TABLE_OF in schema:
        return {"$ref": f"#/$defs/{schema[TABLE_OF]}"}
    return {name: _linked(each) for name, each in schema.items()}


def _closed(schema: dict[str, Any]) -> dict[str, Any]:
    """Return the schema of a table without other entries, and without those that only Python can give."""
    properties = {name: _without_null(field) for name, field in schema.get("properties", {}).items()
                  if field.get("not") != {}}
    return schema | {"properties": properties, "additionalProperties": False}


def _without_null(field: dict[str, Any]) -> dict[str, Any]:
    """Return the schema of an entry without null, which TOML lacks, and without a title that repeats its name."""
    kept = {key: each for key, each in field.items() if key != "title" and (key, each) != ("default", None)}
    some = [each for each in kept.get("anyOf", []) if each != {"type": "null"}]
    return {key: each for key, each in kept.items() if key != "anyOf"} | some[0] if len(some) == 1 else kept
