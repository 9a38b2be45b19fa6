"""Fluids that act on cables and bodies: wind and water."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, ClassVar

import numpy as np

from .flow_profile import AnyProfile
from .part import Part
from .plane import across
from .signal import AnySignal, Constant
from .validation import Name, Vector, positive, xyz


class Fluid(Part):
    """Air or water that fills the scene, at rest or in motion; it acts on what a `Drag` names.

    density in kg/m³; velocity in m/s, times the signal ``scale`` of time and the ``profile``, a `PowerProfile` or a
    `TableProfile` of the height above the origin. Heights are counted against gravity, along y without gravity.
    """

    kind: ClassVar[str] = "fluid"
    group: ClassVar[str] = "fluids"
    name: Name | None = None
    density: Annotated[float, positive("kg/m³")]
    velocity: Annotated[Vector, xyz("m/s")] = (0.0, 0.0, 0.0)
    scale: AnySignal = Constant(constant=1.0)
    profile: AnyProfile = None

    def off_plane(self) -> Iterator[str]:
        """Yield its quantities that leave the plane z = 0, see `Part.off_plane`."""
        return across("velocity", self.velocity, "m/s")

    def velocity_at(self, time: np.ndarray, height: np.ndarray) -> np.ndarray:
        """Return the velocity (..., 3) in m/s at times (s) and heights (m), which are broadcast."""
        factor = np.ones(np.shape(height)) if self.profile is None else self.profile.factor(height)
        return (self.scale.value(time) * factor)[..., None] * np.array(self.velocity)
