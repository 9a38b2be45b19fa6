"""JSON Schema beside each check of a value, from which `scene.schema` makes one document."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping
from dataclasses import field
from typing import Any

from pydantic import GetCoreSchemaHandler, PlainValidator
from pydantic_core.core_schema import CoreSchema, any_schema

from ..base.deferred import dataclass


class GivenAs:
    """The JSON Schema of a field in a scene file; pydantic's own class takes 15 ms to import."""

    def __init__(self, schema: Mapping[str, Any]):
        self.schema = schema

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        """Return pydantic's schema of the annotated values, of any where this stands for their type."""
        return any_schema() if source is self else handler(source)

    def __get_pydantic_json_schema__(self, core_schema: Any, handler: Any) -> dict[str, Any]:
        """Return the schema, for pydantic."""
        return dict(self.schema)


POINT, DIRECTION, AXIS, ORIENTATION, TENSOR, LENGTHS = "point", "direction", "axis", "orientation", "tensor", "lengths"
HOLDER = "holder"


@dataclass(frozen=True)
class Turning:
    """How other axes change the vectors of a field, see `in_plane`: as a POINT, DIRECTION, AXIS of rotation, the unit
    quaternion of an ORIENTATION or a symmetric TENSOR. LENGTHS along axes of their own stay.

    of: the attribute of the part that names the body whose axes they are along, None for the ground's; HOLDER: those of
    the part that holds this one. unit: in messages. lies: whether a planar scene must have the vector in its plane, an
    axis across it.
    """

    turns: str
    of: str | None = None
    unit: str = field(default="", compare=False)
    lies: bool = field(default=True, compare=False)


@dataclass(frozen=True)
class Place:
    """An arc-length along the cable that the attribute ``of`` names; moves: as the scene moves."""

    of: str
    moves: bool = False


@dataclass(frozen=True)
class FileEntry:
    """A path, in a scene file relative to the folder of the file."""


About = Turning | Place | FileEntry


@dataclasses.dataclass(frozen=True)  # as the class of pydantic that it extends
class Check(PlainValidator):
    """A check of values; about: how vectors turn, the cable of an arc-length, or that it is a path."""

    about: About | None = None


def checked(check: Callable[..., Any], schema: Mapping[str, Any], about: About | None = None) -> Check:
    """Return a check of values; schema: JSON Schema of the values in scene files."""
    return Check(check, json_schema_input_type=GivenAs(schema), about=about)


ONLY_PYTHON: dict[str, Any] = {"not": {}}
"""JSON Schema of a value that no scene file can hold."""


def some(n: int) -> dict[str, Any]:
    """Return the JSON Schema of a list of n things."""
    return {"type": "array", "minItems": n, "maxItems": n}


TABLE_OF = "table of"
"""Stands for a reference to the tables of a `Family`, which pydantic would look up itself."""


def number_schema(unit: str = "", **bounds: float) -> dict[str, Any]:
    """Return the JSON Schema of a number; its description is the unit."""
    return {"type": "number", **bounds} | ({"description": f"in {unit}"} if unit else {})


def list_schema(unit: str = "", least: int = 3, most: int | None = 3) -> dict[str, Any]:
    """Return the JSON Schema of a list of numbers, by default of three."""
    lengths = {"minItems": least} | ({} if most is None else {"maxItems": most})
    return {"type": "array", "items": {"type": "number"}, **lengths} | ({"description": f"in {unit}"} if unit else {})


def list_of_lists(unit: str) -> dict[str, Any]:
    """Return the JSON Schema of a list of lists of three numbers."""
    return {"type": "array", "items": list_schema(), "minItems": 2, "description": f"in {unit}"}


def attachment_schema(more: str) -> dict[str, Any]:
    """Return the JSON Schema of an attachment; more: other forms than "A" and ["wire", s]."""
    return {"description": f'"A", ["wire", s], {more}, in m',
            "anyOf": [{"type": "string"}, {"type": "array", "minItems": 2, "maxItems": 3}]}
