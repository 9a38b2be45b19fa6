"""Checkpoints: files of the engine's state and of facts on its run, from which a run that was stopped goes on.

In the file: a line with the sha256 of all that follows, a line of JSON, and the engine's bytes.
"""

from __future__ import annotations

import hashlib
import json
import os
from pathlib import Path
from typing import Annotated, NamedTuple

from pydantic import BaseModel, ConfigDict, Field

from .locks import created

Seconds = Annotated[float, Field(ge=0, allow_inf_nan=False)]


class DamagedCheckpointError(Exception):
    """The file is not what was written; the text says what it is."""


class Facts(BaseModel):
    """On the run: digests of scene, programs and start, which must be the same for it to go on, and how far it is.

    rows: output times so far; elapsed_s: seconds that it has taken; resumed_at_s: times at which it was resumed;
    events: what has happened; row_notes: what notes on rows have found (solve/notes/row_notes.py).
    """

    model_config = ConfigDict(strict=True, extra="forbid", defer_build=True)

    scene: str
    settings: dict
    programs: str
    start: str
    integrator: str
    rows: Annotated[int, Field(ge=1, lt=2**31)]
    elapsed_s: Seconds
    resumed_at_s: list[Seconds]
    events: list[dict]
    row_notes: dict


class Checkpoint(NamedTuple):
    """What a file holds: facts on the run, and the engine's bytes."""

    facts: Facts
    state: bytes

    def write(self, path: Path) -> None:
        """Write the checkpoint in the place of an older file. Raises OSError."""
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
    """Return the checkpoint beside the file of a run."""
    return path.with_name(f"{path.name}.state")


def add_events(report: dict, path: Path) -> None:
    """Put into the report of a run that has not come to its end what events have found up to its checkpoint."""
    try:
        report["events"] = Checkpoint.read(checkpoint_of(path)).facts.events
    except (OSError, DamagedCheckpointError):
        report["events"] = []
        report["messages"].append(f"what events have found is not known: there is no whole checkpoint "
                                  f"{checkpoint_of(path).name}")
