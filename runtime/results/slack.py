"""Slack elements of cables, over time."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..engine import SLACK_STRAIN
from ..model.middle_strain import middle_strain
from ..parts.cable import Cable
from ..solve.statics.rest_state import RestState
from .recorded import Recorded
from .section_forces.forces import no_cable

if TYPE_CHECKING:
    import xarray


def slack_elements(state: Recorded | RestState, cable: Cable | str) -> xarray.DataArray:
    """Return the slack elements, see `Run.slack_elements`; without time at rest. Raises UnknownResultError."""
    import xarray  # 0.5 s, for those who ask for it

    name, over_time = cable.name if isinstance(cable, Cable) else cable, not isinstance(state, RestState)
    if name not in state.scene.cables:
        raise no_cable(state.scene, name)
    of = next(each for each in state.model.cables if each.name == name)
    vectors = state[f"{name}.nodal_vectors"]
    growth = state.scene.cables[name].growth_at(np.zeros(1) if isinstance(state, RestState) else state.time)
    vectors = (vectors if over_time else vectors[None]) / growth[:, of.mesh.element_of_node, None, None]
    slack = middle_strain(of, vectors) < -SLACK_STRAIN
    s = of.mesh.boundaries
    middle = {"units": "m", "long_name": "middle of the element"}
    coords: dict[str, Any] = {"s": ("element", (s[:-1] + s[1:]) / 2, middle)}
    if not isinstance(state, RestState):
        coords["time"] = ("time", state.time, {"units": "s", "long_name": "time"})
    return xarray.DataArray(slack if over_time else slack[0],
                            dims=("time", "element") if over_time else ("element",), coords=coords, name="slack",
                            attrs={"cable": name, "long_name": "shorter in the middle than at rest"})
