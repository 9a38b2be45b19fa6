"""Fluids that act on cables and bodies: wind and water."""

from collections.abc import Iterable, Iterator
from typing import Annotated

import numpy as np
from pydantic import model_validator

from ..base.linear_waves import elevation
from .flow_profile import AnyProfile
from .part import Part
from .signal import ONE, AnySignal
from .validation import Name, Vector, finite, positive, xyz
from .velocity_table import VelocityTable
from .wave import Waves

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
    waves: on the surface, linear `Wave` s or those of `jonswap`, with the current added. What is wet, buoyancy with it,
        follows their elevation at the place; the acceleration of the fluid acts where a `Drag` has added_mass, also 0.
        Statics and modes have none, in their pictures, too.
        The velocity at the height z above the still level is that at (z - elevation)/(1 + elevation/depth) (Wheeler)
    depth: of the water below the still level, m; None: infinite
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
    waves: Waves | None = None
    depth: Annotated[float, positive("m")] | None = None

    @model_validator(mode="after")
    def _has_waves_on_a_surface(self) -> "Fluid":
        if self.waves is None:
            if self.depth is not None:
                raise ValueError("has a depth without waves", "give waves, or leave it out")
            return self
        for name, cause in (("table", "which is all of the velocity"), ("surface", "on which they run")):
            if (getattr(self, name) is None) == (name == "surface"):
                raise ValueError(f"has waves with{'out' * (name == 'surface')} a {name}, {cause}",
                                 "give surface" if name == "surface" else "leave one of them out")
        return self

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

    def off_plane(self) -> Iterator[str]:
        """Yield its quantities that leave the plane z = 0, see `Part.off_plane`."""
        yield from super().off_plane()
        for wave in self.waves or ():
            yield from (f"waves {quantity}" for quantity in wave.off_plane())

    def wave_numbers(self, gravity: float) -> np.ndarray:
        """Return k of its waves, 1/m, in the gravity in m/s²."""
        return np.array([wave.wave_number(gravity, self.depth) for wave in self.waves or ()])

    def components(self, gravity: float) -> np.ndarray:
        """Return its waves (n, 6) as `funicular.base.linear_waves` takes them, in the gravity in m/s²."""
        rows = [[wave.amplitude, wave.frequency, wave.phase, *(k * wave.ahead)]
                for wave, k in zip(self.waves or (), self.wave_numbers(gravity), strict=True)]
        return np.array(rows).reshape(-1, 6)

    def elevation(self, time: np.ndarray, place: np.ndarray, gravity: float = 9.81) -> np.ndarray:
        """Return the elevation of its surface above the still level, m, at times (s) and places (..., 3) in m.

        gravity: m/s².
        """
        return elevation(self.components(gravity), time, place)

    def velocity_at(self, time: np.ndarray, height: np.ndarray, place: np.ndarray | None = None) -> np.ndarray:
        """Return the velocity (..., 3) in m/s at times (s), heights (m) and, for a table, places (..., 3) in m."""
        if self.table is not None:
            assert place is not None, f"{self.where} has a table, which depends on the place"
            return self.scale.value(time)[..., None] * self.table.value(time, place)
        factor = np.ones(np.shape(height)) if self.profile is None else self.profile.factor(height)
        return (self.scale.value(time) * factor)[..., None] * np.array(self.velocity)
