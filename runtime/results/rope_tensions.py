"""Tensions of the spans of ropes at rest, between both limits of friction."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING

import numpy as np

from ..errors import FunicularError, FunicularWarning, UnknownResultError, near
from ..parts.in_plane import in_plane
from ..parts.rope import Rope
from ..parts.rope_items import Drum, RouteItem, Sheave
from ..parts.settings import IMPENDING, EquilibriumSettings
from ..solve.statics.rest_state import RestState
from ..solve.statics.static import equilibrium

if TYPE_CHECKING:
    import xarray

ENDS = ("start", "end")


def rope_tensions(state: RestState, rope: Rope | str) -> xarray.DataArray:
    """Return the tensions at both limits of friction, see `Equilibrium.rope_tensions`."""
    import xarray  # 0.5 s, for those who ask for it

    name = rope.name if isinstance(rope, Rope) else rope
    if name not in state.scene.ropes:
        raise UnknownResultError(f'there is no rope "{name}"; {near(name, state.scene.ropes)}')
    if state.load_fraction != 1.0:
        raise FunicularError(f'rope "{name}": the limits of its tension are those under all loads, but the state is '
                             f"under {state.load_fraction:g} of them")
    part = state.scene.ropes[name]
    values = np.stack([span_tensions(_at_limit(state, motion), part) for motion in IMPENDING], axis=-1)
    labels = [f"{_label(one)} to {_label(other)}" for one, other in part.ends_of_spans]
    return xarray.DataArray(values, dims=("span", "end", "limit"), name="tension",
                            coords={"span": labels, "end": list(ENDS), "limit": list(IMPENDING)},
                            attrs={"units": "N", "long_name": "tension of the rope", "rope": name})


def span_tensions(state: RestState, rope: Rope) -> np.ndarray:
    """Return the tensions of a rope at both ends of its spans in a state, (span, 2) in N."""
    found = np.empty((rope.n_spans, len(ENDS)))
    for k, items in enumerate(rope.ends_of_spans):
        for e, (item, beside, of_end) in enumerate(zip(items, ("tension_off", "tension_on"), ENDS, strict=True)):
            if isinstance(item, Sheave):
                found[k, e] = state[f"{item.name}.{beside}"]
            elif isinstance(item, Drum):
                found[k, e] = state[f"{item.name}.tension"]
            else:
                found[k, e] = np.linalg.norm(state[f"{rope.name}.{of_end}_force"])
    return found


def _at_limit(state: RestState, motion: str) -> RestState:
    """Return the state in which ropes are about to slide in a motion."""
    settings = EquilibriumSettings(impending=motion, seek_stable=state.stable)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", FunicularWarning)  # the state has the same messages
        return equilibrium(in_plane(state.scene), settings, state, RestState)


def _label(item: RouteItem) -> str:
    """Return the name of an item of a route, of an anchor what it is on."""
    return str(getattr(item, "name", None) or item.end.on or "ground")
