"""What pictures take of a run; runs themselves stand above them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol

import numpy as np

from ..quantities import Variable
from ..section_forces.forces import Results


class Balance(Protocol):
    """How well the energies of a run balance."""

    @property
    def residual(self) -> np.ndarray:
        """Return what is missing (time,) in J."""

    @property
    def relative(self) -> np.ndarray:
        """Return what is missing (time,) over the energy that was exchanged."""


class Recorded(Results, Protocol):
    """What pictures take of a run."""

    report: dict

    @property
    def variables(self) -> Mapping[str, Variable]:
        """Return the results by name."""

    @property
    def coords(self) -> Mapping[str, Variable]:
        """Return the coordinates of the results by name."""

    def keys(self) -> list[str]:
        """Return the names of all results."""

    def __contains__(self, name: str) -> bool:
        """Return whether there is a result of that name."""

    def energy_balance(self) -> Balance:
        """Return how well the energies balance."""

    def summary_rows(self) -> list[tuple[str, str]]:
        """Return what to tell about the run in short."""
