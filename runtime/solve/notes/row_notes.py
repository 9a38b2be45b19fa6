"""The list of notes, and their measurements of a run, whose rows come in batches, and of a state of rest."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, TypeVar, cast

import numpy as np

from ...engine import Engine
from ...model.model import Model
from ...parts.scene_data import SceneData
from .coarse_contact import CoarseContact
from .coarse_meshes import CoarseMeshes
from .coarse_slides import CoarseSlides
from .coincident_points import CoincidentPoints
from .creep import Creep
from .fast_turns import FastTurns
from .fleet_angles import FleetAngles
from .folds import Folds
from .note import Note, Rows
from .penetrations import Penetrations
from .reduced_strain import ReducedStrain
from .sensitivity import Sensitivity
from .slack_growth import SlackMotion
from .slack_ropes import SlackRopes
from .spinning_sections import SpinningSections
from .straight_struts import StraightStruts
from .straightened import Straightened
from .surface_ends import SurfaceEnds
from .uncontrolled_errors import NormalForces

NOTES: tuple[type[Note], ...] = (
    StraightStruts, Folds, ReducedStrain, CoarseMeshes, CoarseSlides, Straightened, Sensitivity, SlackMotion,
    CoincidentPoints, FastTurns, NormalForces, SpinningSections, Penetrations, SurfaceEnds, CoarseContact,
    FleetAngles, SlackRopes, Creep)

N = TypeVar("N", bound=Note)


class _Thinned(dict[str, np.ndarray]):
    """One in a number of output rows, of the arrays that a note reads."""

    def __init__(self, rows: Rows, begin: int, interval: int):
        """begin: the first row."""
        super().__init__()
        self._rows, self._taken = rows, slice(begin, None, interval)

    def __missing__(self, name: str) -> np.ndarray:
        """Return these rows of an array, which is kept."""
        self[name] = found = self._rows[name][self._taken]
        return found


def _kinds_for(model: Model) -> list[type[Note]]:
    """Return the notes that have something to measure in a model."""
    present = {type(part) for part in (*model.cables, *model.ropes, *model.bodies, *model.couplings)}
    return [kind for kind in NOTES if not present.isdisjoint(kind.measures)]


class RowNotes:
    """The measurements of all notes on a run."""

    def __init__(self, scene: SceneData, model: Model, step: float = 0.0, duration: float = 1.0):
        """step: in s, 0 where tol chooses it; duration: of the run, in s."""
        self._rows = 0
        self._notes = {kind: kind(scene, model, step, duration) for kind in _kinds_for(model)}

    def __getitem__(self, kind: type[N]) -> N | None:
        """Return the note of a class, None where the scene has nothing that it measures."""
        return cast("N | None", self._notes.get(kind))

    def see(self, engine: Engine) -> None:
        """Measure the rows that the engine has, and the ends of its steps."""
        rows = engine.rows()
        found = {1: rows}
        for note in self._notes.values():
            note.see_steps(engine)
            interval = note.row_interval
            if interval not in found:
                found[interval] = _Thinned(rows, (1 - self._rows) % interval, interval)
            if len(found[interval]["time"]):
                note.see(found[interval])
        self._rows += len(rows["time"])

    def notes(self) -> list[str]:
        """Return the notes on all rows and steps."""
        return [text for note in self._notes.values() for text in note.notes()]

    @property
    def found(self) -> dict[str, Any]:
        """All measurements, in types of JSON, for a checkpoint."""
        return {"rows": self._rows, "notes": {kind.__name__: note.found for kind, note in self._notes.items()}}

    def go_on(self, found: dict[str, Any]) -> None:
        """Go on from the measurements of a checkpoint."""
        self._rows = found["rows"]
        for kind, note in self._notes.items():
            note.found = found["notes"][kind.__name__]


def rest_notes(scene: SceneData, model: Model, engine: Engine, state: Mapping[str, np.ndarray],
               couplings: Mapping[str, np.ndarray]) -> list[str]:
    """Return the notes on a state of rest.

    state: coordinates "q" (n_q,) and arc-lengths "s" (slides,); couplings: their outputs by kind, (couplings, numbers).
    """
    rows = {"time": np.zeros(1), "q": state["q"][None], "v": np.zeros((1, model.n_dof)), "s": state["s"][None],
            **{kind: numbers[None] for kind, numbers in couplings.items()}}
    texts = []
    for kind in _kinds_for(model):
        if kind.assesses_rest:
            note = kind(scene, model)
            note.see_rest(rows, engine)
            texts += note.notes_at_rest()
    return texts
