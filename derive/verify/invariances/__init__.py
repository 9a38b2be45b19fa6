"""Invariances of kernels under motions of the frame, each as (text, error, ceiling).

The module and the function called as the role of a family have its invariances. The error is relative to the scale that
the text's quantity has in the sample.
"""

from __future__ import annotations

from collections.abc import Iterator
from importlib import import_module

from ...codegen.family import Family
from ..numbers import Numbers, State
from .measures import Invariance


def invariances(family: Family, k: Numbers, states: list[State]) -> Iterator[Invariance]:
    """Yield the invariances of a family at each of its states; the caller keeps the worst of each."""
    of_role = getattr(import_module(f".{family.role}", __name__), family.role)
    for s in states:
        yield from of_role(family, k, s)
