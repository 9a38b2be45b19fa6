"""The general form of a note: one quantity, measured part by part in a run or at rest, and a text above its limit.

`row_notes.NOTES` lists them. Quantities, limits and the measurements behind these stand in the file of each note.
"""

from __future__ import annotations

from typing import Any, ClassVar, NamedTuple

import numpy as np

from ...engine import Engine
from ...model.model import CableModel, Model
from ...parts.cable import Cable
from ...parts.piece import UniformPiece
from ...parts.rope import Rope
from ...parts.scene_data import SceneData
from ...parts.settings import RunSettings

Rows = dict[str, np.ndarray]
"""Output rows by name, time (T,) first: q (T, n_q), v (T, n_dof), s (T, slides), and outputs of couplings by kind."""
FIXED_STEP_ERROR_LIMIT = 5e-3
"""Error of a fixed step that a note reports, as a fraction of the largest motion."""


class Note:
    """One quantity, measured part by part.

    found: the measurements by the name of the part, in types of JSON: a checkpoint keeps them.
    """

    assesses_rest = False
    """Whether it assesses states of rest, too."""
    row_interval = 1
    """The note sees one in this number of output rows."""
    measures: ClassVar[tuple[type, ...]]
    """Classes of the parts of a model that it measures: without any of them there is no such note."""

    def __init__(self, scene: SceneData, model: Model, step: float = 0.0, duration: float = 1.0):
        """step: in s, 0 where tol chooses it; duration: of the run, in s."""
        self.scene, self.model, self.step, self.duration = scene, model, step, duration
        self.found: dict[str, Any] = {}
        self.prepare()

    def prepare(self) -> None:
        """Select the parts to measure."""

    def see(self, rows: Rows) -> None:
        """Measure further output rows."""

    def see_steps(self, engine: Engine) -> None:
        """Measure extremes that the engine records at the ends of its steps."""

    def see_rest(self, rows: Rows, engine: Engine) -> None:
        """Measure a state of rest: one row, and the engine whose static state it is."""
        self.see(rows)

    def notes(self) -> list[str]:
        """Return the notes on a run."""
        return []

    def notes_at_rest(self) -> list[str]:
        """Return the notes on a state of rest."""
        return self.notes()

    def keep(self, name: str, value: float, *where: float) -> None:
        """Keep the largest value of a part, above 0, and where it was found."""
        if value > self.found.get(name, (0.0,))[0]:
            self.found[name] = np.array([value, *where]).tolist()


class LineStiffness(NamedTuple):
    """EA of a cable or rope in N, or the mean slope of a table of its force, its smaller and larger EI in N m², of a
    planar scene that in its plane, and its mass in kg/m; of a cable of several pieces (elements,) each.
    """

    EA: Any
    EI_weak: Any
    EI_strong: Any
    mass: Any

    @classmethod
    def of(cls, part: Cable | Rope, dim: int) -> LineStiffness:
        """Return those of the section and material of a cable or rope."""
        pieces = part.uniform_pieces
        each = [cls._of(piece, dim) for piece in pieces]
        if len(each) == 1:
            return each[0]
        return cls(*np.repeat(each, [piece.end - piece.first for piece in pieces], axis=0).T)

    @property
    def least(self) -> LineStiffness:
        """Return the least of each along a cable or rope."""
        return self if isinstance(self.mass, float) else LineStiffness(*map(np.min, self))

    @classmethod
    def _of(cls, piece: UniformPiece, dim: int) -> LineStiffness:
        E, (area, *bending) = piece.material.youngs_modulus, piece.section.moments().tolist()
        weak, strong = (bending[0],) * 2 if dim == 2 else sorted(bending[:2])
        return cls(piece.axial_stiffness, E * weak, E * strong, piece.material.density * area)


def element_place(cable: CableModel, k: int) -> str:
    """Return the number and the arc-lengths of an element as a text."""
    start = cable.mesh.start(k)
    return f"element {k}, from s = {start:.6g} m to {start + cable.mesh.length(k):.6g} m"


def intervals(time: np.ndarray, before: float) -> np.ndarray:
    """Return (T,): the times in s from each output row to the next one, to the first one from that before it."""
    found = time.copy()
    found[0] -= before
    found[1:] -= time[:-1]
    return found


def allowed_error(engine: Engine, settings: RunSettings) -> float:
    """Return the error in m that a run allows: by tol, or with a fixed step by the limit of notes."""
    if settings.step is not None:
        return FIXED_STEP_ERROR_LIMIT * engine.controlled_motion
    return settings.tol * engine.controlled_motion + max(engine.absolute_tol, 0.0)
