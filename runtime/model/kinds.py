"""The kinds of couplings of a model, in the order of the engine's list, which is that of its sums.

The module of this package that is called as a group of parts makes the couplings of these parts: its `KINDS` say how.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from importlib import import_module
from importlib.util import find_spec

from ..engine import COUPLING_TYPES
from ..parts.kinds import KINDS
from .coupling import CouplingKind, CouplingModel


def _kinds() -> Iterator[CouplingKind]:
    for module in dict.fromkeys(f"{__package__}.{part.group}" for part in KINDS):
        if find_spec(module) is not None:
            yield from getattr(import_module(module), "KINDS", ())


def _in_engine_order() -> tuple[CouplingKind, ...]:
    found = {kind.name: kind for kind in _kinds()}
    if {*found} != {*COUPLING_TYPES}:
        raise ImportError("runtime/engine/events/list.c and KINDS of the modules of runtime/model do not agree on: "
                          + ", ".join(sorted({*found} ^ {*COUPLING_TYPES})))
    return tuple(found[name] for name in COUPLING_TYPES)


COUPLINGS = _in_engine_order()


def in_order(couplings: Iterable[CouplingModel]) -> list[CouplingModel]:
    """Return couplings in the order of their kinds, those of one kind in the order given."""
    return sorted(couplings, key=lambda coupling: COUPLING_TYPES.index(coupling.type))
