"""Fluids that act on cables and bodies: wind and water."""

from collections.abc import Iterable
from typing import Annotated

import numpy as np
from pydantic import model_validator

from .flow_profile import AnyProfile
from .part import Part
from .signal import ONE, AnySignal
from .validation import Name, Vector, finite, positive, xyz
from .velocity_table import VelocityTable

NO_SURFACE = 1e300
"""m, above all heights."""


class Fluid(Part):
    """Air or water, at rest or in motion, that acts through a `Drag`.

    It fills the scene, or the space below its ``surface``. A point is in the fluid with the lowest surface above it; a
    fluid without a surface is above all others. Heights are from the origin, against gravity, along y without gravity.

    density: kg/m³
    surface: level of the surface, m
    velocity: m/s
    scale: factor of the velocity over time, a signal
    profile: factor of the velocity by height, a `PowerProfile` or a `TableProfile`
    table: velocity in time and space, a `VelocityTable`, in the place of velocity and profile
    """

    kind = "fluid"
    group = "fluids"
    name: Name | None = None
    density: Annotated[float, positive("kg/m³")]
    surface: Annotated[float, finite("m")] | None = None
    velocity: Annotated[Vector, xyz("m/s")] = (0.0, 0.0, 0.0)
    scale: AnySignal = ONE
    profile: AnyProfile | None = None
    table: VelocityTable | None = None

    @model_validator(mode="after")
    def _has_one_velocity(self) -> "Fluid":
        if self.table is not None and (self.profile is not None or any(self.velocity)):
            raise ValueError(f"has a table and a {'velocity' if any(self.velocity) else 'profile'}",
                             "leave one of them out: the table is all of the velocity")
        return self

    @property
    def moves(self) -> bool:
        """Return whether it has a velocity anywhere."""
        return any(self.velocity) or (self.table is not None and bool(np.any(self.table.grid.velocity)))

    @property
    def top(self) -> float:
        """Return the upper height of the fluid in m, `NO_SURFACE` without a surface."""
        return NO_SURFACE if self.surface is None else self.surface

    def bottom(self, fluids: "Iterable[Fluid]") -> float:
        """Return the lower height of the fluid in m among the fluids of its scene, else -`NO_SURFACE`."""
        return max((other.top for other in fluids if other.top < self.top), default=-NO_SURFACE)

    def nearest(self, places: np.ndarray, up: np.ndarray, fluids: "Iterable[Fluid]") -> np.ndarray:
        """Return the places (..., 3) in the fluid vertically nearest to other places, in m."""
        height = places @ up
        return places + (np.clip(height, self.bottom(fluids), self.top) - height)[..., None] * up

    def velocity_at(self, time: np.ndarray, height: np.ndarray, place: np.ndarray | None = None) -> np.ndarray:
        """Return the velocity (..., 3) in m/s at times (s), heights (m) and, for a table, places (..., 3) in m."""
        if self.table is not None:
            assert place is not None, f"{self.where} has a table, which depends on the place"
            return self.scale.value(time)[..., None] * self.table.value(time, place)
        factor = np.ones(np.shape(height)) if self.profile is None else self.profile.factor(height)
        return (self.scale.value(time) * factor)[..., None] * np.array(self.velocity)
