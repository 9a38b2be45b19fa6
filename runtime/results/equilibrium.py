"""What `scene.equilibrium()` returns: a state of rest with the forces in sections of its cables."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..parts.cable import Cable
from ..parts.slide import Slide
from ..solve.rest_state import CriticalPoint, RestState
from .section_forces import dataset

if TYPE_CHECKING:
    import xarray
    from numpy.typing import ArrayLike

__all__ = ["CriticalPoint", "Equilibrium"]


class Equilibrium(RestState):
    """A state of rest of a scene, see `RestState`, and the forces in sections of its cables."""

    def section_forces(self, cable: Cable | str, s: ArrayLike | Slide | None = None, *, method: str = "balance",
                       side: str = "after") -> xarray.Dataset:
        """Return the forces and moments in sections of ``cable`` as `Run.section_forces` has them, over s alone.

        Where no s is given, both sides of riders are among the places.
        """
        return dataset(self, cable, s, method=method, side=side)
