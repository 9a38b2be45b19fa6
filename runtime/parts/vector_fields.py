"""The fields of parts that other axes change: read from the checks of their values."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from typing import Any, get_args

from .part import Part
from .schemas import Check, Turning


@cache
def turnings_of(kind: type[Part]) -> dict[str, Turning]:
    """Return how other axes change the vectors of a kind of part, by field."""
    found = {}
    for name, field in kind.model_fields.items():
        for check in (*field.metadata, *_parts_of(field.annotation)):
            if isinstance(check, Check) and check.turning is not None:
                found[name] = check.turning
    return found


def _parts_of(annotation: Any) -> Iterator[Any]:
    """Yield all that an annotation is made of, checks among them."""
    for each in (*get_args(annotation), *getattr(annotation, "__metadata__", ())):
        yield each
        yield from _parts_of(each)
