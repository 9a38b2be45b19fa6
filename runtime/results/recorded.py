"""The part of a run that pictures and section forces need; runs themselves stand above them."""

# ruff: noqa: D102

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from ..parts.scene_data import SceneData
from .quantities import EnergyBalance, Variable

if TYPE_CHECKING:
    from ..model.model import Model  # brings SciPy, which results alone do not need


class Recorded(Protocol):
    """A run, for modules below it; `funicular.Run` documents its members."""

    report: dict[str, Any]

    @property
    def scene(self) -> SceneData: ...

    @property
    def model(self) -> Model: ...

    @property
    def time(self) -> np.ndarray: ...

    @property
    def variables(self) -> Mapping[str, Variable]: ...

    @property
    def coords(self) -> Mapping[str, Variable]: ...

    def __getitem__(self, name: str) -> np.ndarray: ...

    def __contains__(self, name: str) -> bool: ...

    def energy_balance(self) -> EnergyBalance: ...

    def summary_rows(self) -> list[tuple[str, str]]: ...
