"""Relations between the outputs of kernels and derivatives, for any element and any rider.

The module and the function called as the role of a family have its relations.
"""

from __future__ import annotations

from importlib import import_module

from ...codegen.family import Family
from ..methods import Relation


def relations(family: Family) -> list[Relation]:
    """Return the relations of a family's kernels."""
    found: list[Relation] = getattr(import_module(f".{family.role}", __name__), family.role)(family)
    return found
