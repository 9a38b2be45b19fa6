"""Names of parts of which lists may be given where a part of two is added."""

from __future__ import annotations

from typing import Annotated, Any

from .schemas import checked
from .validation import NAMES_A_PART, shown


def _listed(value: Any) -> str:
    name = getattr(value, "name", value)
    if not isinstance(name, str):
        raise ValueError(f"must be the name of a part, got {shown(value)}")
    return name


Listed = Annotated[str, checked(_listed, {"anyOf": [
    {"type": "string"}, {"type": "array", "items": {"type": "string"}, "minItems": 1}]}), NAMES_A_PART]
"""The name of a part, given as that or as the part itself; where parts are added, a list of them or "all", too."""
