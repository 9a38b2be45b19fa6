"""Checkpoints: files from which a stopped run is resumed.

A file holds a line with the sha256 of the rest, a line of JSON with facts on the run, and the state of the engine.
"""

from __future__ import annotations

import hashlib
import json
import os
from pathlib import Path
from typing import Annotated, Any, NamedTuple

from pydantic import BaseModel, ConfigDict, Field

from .locks import created

Seconds = Annotated[float, Field(ge=0, allow_inf_nan=False)]


class DamagedCheckpointError(Exception):
    """The file differs from what was written; the text is the predicate of a message."""


class Facts(BaseModel):
    """Facts on a run: digests of scene, programs and start, which must be the same on resuming, and its progress.

    rows: output times so far; elapsed_s: wall time so far in s; resumed_at_s: times of the motion at which it was
    resumed; events: those so far; row_notes: the state of the notes on rows (solve/notes/row_notes.py).
    """

    model_config = ConfigDict(strict=True, extra="forbid", defer_build=True)

    scene: str
    settings: dict[str, Any]
    programs: str
    start: str
    integrator: str
    rows: Annotated[int, Field(ge=1, lt=2**31)]
    elapsed_s: Seconds
    resumed_at_s: list[Seconds]
    events: list[dict[str, Any]]
    row_notes: dict[str, Any]


class Checkpoint(NamedTuple):
    """Facts on a run and the state of its engine."""

    facts: Facts
    state: bytes

    def write(self, path: Path) -> None:
        """Replace the file of an older checkpoint. Raises OSError."""
        content = json.dumps(self.facts.model_dump()).encode() + b"\n" + self.state
        part = path.with_name(f".{path.name}.part")
        try:
            with open(created(part), "wb") as file:
                file.write(hashlib.sha256(content).hexdigest().encode() + b"\n" + content)
            os.replace(part, path)
        finally:
            part.unlink(missing_ok=True)

    @classmethod
    def read(cls, path: Path) -> Checkpoint:
        """Read a file. Raises OSError, DamagedCheckpointError."""
        digest, _, content = path.read_bytes().partition(b"\n")
        if digest.startswith(b"{"):
            raise DamagedCheckpointError("is of an older version of funicular")
        if hashlib.sha256(content).hexdigest().encode() != digest:
            raise DamagedCheckpointError("is damaged")
        facts, _, state = content.partition(b"\n")
        try:
            return cls(Facts.model_validate(json.loads(facts)), state)
        except (ValueError, RecursionError):
            raise DamagedCheckpointError("is damaged") from None


def checkpoint_of(path: Path) -> Path:
    """Return the path of the checkpoint of a result file."""
    return path.with_name(f"{path.name}.state")


def add_events(report: dict[str, Any], path: Path) -> None:
    """Add the events up to the checkpoint to the report of an unfinished run."""
    try:
        report["events"] = Checkpoint.read(checkpoint_of(path)).facts.events
    except (OSError, DamagedCheckpointError):
        report["events"] = []
        report["messages"].append(f"its events are unknown: there is no valid checkpoint {checkpoint_of(path).name}")
