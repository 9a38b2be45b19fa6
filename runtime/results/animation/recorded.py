"""What pictures take of a run; runs themselves stand above them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol

import numpy as np

from ...model.model import Model
from ...parts.scene_data import SceneData
from ..quantities import Variable


class Balance(Protocol):
    """How well the energies of a run balance."""

    @property
    def residual(self) -> np.ndarray:
        """Return what is missing (time,) in J."""

    @property
    def relative(self) -> np.ndarray:
        """Return what is missing (time,) over the energy that was exchanged."""


class Recorded(Protocol):
    """What pictures take of a run."""

    report: dict

    @property
    def variables(self) -> Mapping[str, Variable]:
        """Return the results by name."""

    @property
    def coords(self) -> Mapping[str, Variable]:
        """Return the coordinates of the results by name."""

    @property
    def scene(self) -> SceneData:
        """Return the scene that was run."""

    @property
    def model(self) -> Model:
        """Return the model of the scene."""

    @property
    def time(self) -> np.ndarray:
        """Return the times (time,) in s."""

    def keys(self) -> list[str]:
        """Return the names of all results."""

    def __contains__(self, name: str) -> bool:
        """Return whether there is a result of that name."""

    def __getitem__(self, name: str) -> np.ndarray:
        """Return the result of a name, time first."""

    def energy_balance(self) -> Balance:
        """Return how well the energies balance."""

    def summary_rows(self) -> list[tuple[str, str]]:
        """Return what to tell about the run in short."""
