"""Notes on a run that take all of its output rows and steps, also those that are on disk already."""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np

from ...engine import Engine
from ...model.model import Model
from ...parts.scene_data import SceneData
from .coarse_meshes import CoarseMeshes
from .coarse_slides import CoarseSlides
from .coincident_points import MeetingPoints
from .fast_turns import FastTurns
from .folds import Folds
from .normal_forces import NormalForces
from .penetrations import Penetrations
from .reduced_strain import ReducedStrain
from .sensitivity import Sensitivity
from .slack_growth import SlackMotion
from .spinning_sections import SpinningSections
from .straight_struts import StraightStruts
from .straightened import Straightened
from .surface_ends import SurfaceEnds
from .unseen_contact import UnseenContact


class Noted(Protocol):
    """Keeps what has been found of a run, as JSON takes it, by the names of parts."""

    found: dict[str, Any]

    def notes(self) -> list[str]:
        """Return the notes on all that was seen."""


class Watched(Noted, Protocol):
    """Sees output rows."""

    def see(self, rows: dict[str, np.ndarray]) -> None:
        """Take further output rows, by name, time first."""


class SeenInSteps(Noted, Protocol):
    """Sees what the engine keeps of the ends of its steps."""

    def see(self, engine: Engine) -> None:
        """Take what the engine has found."""


class RowNotes:
    """What is noted of output rows and of steps, which are seen as they come, a batch after the other."""

    def __init__(self, scene: SceneData, model: Model, step: float = 0.0, duration: float = 1.0):
        self.sensitivity, self.turns = Sensitivity(scene, model), FastTurns(model, step)
        self.slack = SlackMotion(scene, model, duration)
        self.normal_forces = NormalForces(scene, model)
        self._seen_in_steps: dict[str, SeenInSteps] = {"penetrations": Penetrations(scene, model),
                                                       "surface ends": SurfaceEnds(scene, model)}
        self._watched: dict[str, Watched] = {
            "straight struts": StraightStruts(scene, model), "reduced strain": ReducedStrain(scene, model),
            "coarse meshes": CoarseMeshes(scene, model), "coarse slides": CoarseSlides(scene, model),
            "straightened": Straightened(scene, model), "sensitivity": self.sensitivity, "slack motion": self.slack,
            "meeting points": MeetingPoints(scene, model), "fast turns": self.turns,
            "folds": Folds(scene, model), "unseen contact": UnseenContact(scene, model),
            "normal forces": self.normal_forces, "spinning sections": SpinningSections(scene, model)}
        self._noted: dict[str, Noted] = {**self._watched, **self._seen_in_steps}

    def see(self, engine: Engine) -> None:
        """Take further rows, which the engine has, and what it has found at the ends of its steps."""
        rows = engine.rows()
        for each in self._seen_in_steps.values():
            each.see(engine)
        if len(rows["time"]):
            for watched in self._watched.values():
                watched.see(rows)

    def notes(self) -> list[str]:
        """Return the notes on all that was seen."""
        return [note for each in self._noted.values() for note in each.notes()]

    @property
    def found(self) -> dict[str, Any]:
        """What rows and steps have shown so far, as JSON takes it, for a checkpoint."""
        return {name: each.found for name, each in self._noted.items()}

    def go_on(self, found: dict[str, Any]) -> None:
        """Go on from what the rows before a checkpoint had shown."""
        for name, each in self._noted.items():
            each.found = found.get(name, {})
