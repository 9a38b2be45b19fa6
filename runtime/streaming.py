"""Results on disk while a run goes on, and checkpoints from which a run that was stopped goes on.

A run that is saved as OUT.nc writes its rows there as it goes. At some of its pauses (see `pauses`) it replaces
OUT.nc.state, the checkpoint. At which of them depends on the clock, but results do not: the engine is brought into a
state that a checkpoint holds in full at all of them. Runs that end by themselves leave no checkpoint.
"""

from __future__ import annotations

import fcntl
import hashlib
import json
import os
import time
from collections.abc import Callable
from copy import copy
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from funicular.errors import ResultFileError
from funicular.netcdf import File
from funicular.results import Run, check_writable, create_file, file_text, labelled, load_run, over_time

if TYPE_CHECKING:
    from funicular.model import Model
    from funicular.recording import Recording, Rows
    from funicular.scene import Scene
    from funicular.settings import RunSettings

PAUSES = 100
"""The least number of pauses of a run with so many output times."""
BUFFER = 8e6
"""Bytes of rows that are kept in memory."""
ROWS_INTERVAL = 0.5
"""Seconds between two times that rows are written, at most."""
CHECKPOINT_INTERVAL = 0.5
"""Seconds between two checkpoints, at least, where the buffer lasts so long."""
REPORT_ROOM = 8192
"""Bytes for what the report will say at the end."""
GOES_ON = ("unfinished", "interrupted")
"""What the status of a run is that can be resumed."""


class Pauses(NamedTuple):
    """Output rows from one pause to the next, and rows that are kept in memory."""

    every: int
    room: int


def pauses(rows: int, row_bytes: int) -> Pauses:
    """When a run pauses: it must not depend on the clock, nor on whether results are saved."""
    most = max(1, int(BUFFER // row_bytes))
    every = min(most, -(-rows // PAUSES))
    return Pauses(every, min(rows, most // every * every) + 2)  # the start, and where a run is cut short


class Checkpoint(NamedTuple):
    """What a file of the engine's state holds: facts on the run, and the engine's bytes."""

    facts: dict
    state: bytes

    def write(self, path: Path) -> None:
        """Replace the file. Raises OSError."""
        facts = self.facts | {"size": len(self.state), "sha256": hashlib.sha256(self.state).hexdigest()}
        part = _part_of(path)
        try:
            part.write_bytes(json.dumps(facts).encode() + b"\n" + self.state)
            part.replace(path)
        finally:
            part.unlink(missing_ok=True)

    @classmethod
    def read(cls, path: Path) -> Checkpoint:
        """Read a file. Raises OSError; ValueError, KeyError or TypeError where it is damaged."""
        head, _, state = path.read_bytes().partition(b"\n")
        facts = json.loads(head)
        if (len(state), hashlib.sha256(state).hexdigest()) != (facts.pop("size"), facts.pop("sha256")):
            raise ValueError
        return cls(facts, state)


class Stream:
    """The file of a run while it goes on, and its checkpoint."""

    def __init__(self, path: str | os.PathLike, scene: Scene, settings: RunSettings, resume: bool):
        """Check that the file can be written or, to resume, that it holds a run of this scene and these settings.

        Raises ResultFileError.
        """
        self._path = Path(path).resolve()
        self._state = _state_of(self._path)
        self._scene, self._settings = scene, settings
        self._file: File | None = None
        self._taken, self._resumed = 0, []
        self._added = self._checked = time.monotonic()
        if not resume:
            check_writable(path)
            if self._path.exists():
                with open(self._path) as older:
                    self._claim(older.fileno())
        self._facts = _facts(scene, settings)
        self._kept = self._to_resume() if resume else None

    def __enter__(self) -> Stream:
        """The stream."""
        return self

    def __exit__(self, *exception) -> None:
        """Let other runs have the file."""
        _part_of(self._path).unlink(missing_ok=True)
        if self._file is not None:
            fcntl.flock(self._file.descriptor, fcntl.LOCK_UN)

    @property
    def elapsed(self) -> float:
        """Seconds that the run took before it was resumed."""
        return self._kept.facts["elapsed_s"] if self._kept else 0.0

    @property
    def free(self) -> int:
        """Bytes that the file can have: those that are free, and those of the one that is there."""
        disk = os.statvfs(self._path.parent)
        return disk.f_bavail * disk.f_frsize + (self._path.stat().st_size if self._path.exists() else 0)

    def start(self, model: Model, engine, rows: Callable[[], Rows], pace: Pauses, events: list[dict]) -> None:
        """Make the file, with the first row, or go on where the checkpoint was taken.

        rows: those of the engine, by name; events: those that have happened, a list to which more are added.
        """
        self._engine, self._rows, self._pace, self._events = engine, rows, pace, events
        self._begin = time.monotonic()
        self._facts |= {"start": _start_of(model), "integrator": engine.integrator}
        if self._kept is None:
            self._make(labelled(rows()))
            engine.take_rows()
            self._checkpoint()
            return
        facts, state = self._kept
        self._compare(facts, "start", "from another state")
        self._compare(facts, "integrator", f'with integrator "{engine.integrator}"')
        engine.restore(state)
        self._taken = facts["rows"]
        events[:] = facts["events"]
        self._resumed = [*facts["resumed_at_s"], engine.time]
        self._written(lambda: self._file.truncate(self._taken))
        self._report(self._unfinished())

    def pause(self) -> None:
        """Write rows and a checkpoint if it is time to, or if the buffer does not last to the next pause."""
        room = self._pace.room - (self._engine.n_rows - self._taken)
        if time.monotonic() - self._checked > CHECKPOINT_INTERVAL or room < self._pace.every + 1:
            self._take()
            self._checkpoint()

    def between(self) -> None:
        """Write rows if it is time to."""
        if time.monotonic() - self._added > ROWS_INTERVAL and self._engine.n_rows > self._taken:
            self._take()

    def _take(self) -> None:
        self._add(self._rows())
        self._engine.take_rows()
        self._added = time.monotonic()

    def finish(self, recording: Recording) -> Run:
        """Write the last rows and the report; the run as read from the file. Raises ResultFileError."""
        last = Run.from_recording(recording, self._scene, self._settings)
        if self._resumed:
            last.report["resumed_at_s"] = self._resumed
        if self._file is None:
            self._make((last.variables, last.coords))
        else:
            self._add(recording)
        self._report(last.report)
        if recording.status not in GOES_ON:
            self._state.unlink(missing_ok=True)
        return load_run(self._path, libraries=self._scene.libraries)

    def _unfinished(self) -> dict:
        return {"status": "unfinished", "message": "the run goes on, or was killed", "resumed_at_s": self._resumed,
                "messages": self._scene.messages, "settings": self._settings.model_dump()}

    def _make(self, arrays: tuple[dict, dict]) -> None:
        """A new file with these rows, in the place of an older one, whose checkpoint goes first."""
        variables, coords = arrays

        def make() -> None:
            self._replace(coords, variables, self._unfinished())
            self._file.write(0, over_time(coords, variables))
            self._state.unlink(missing_ok=True)
            self._file.rename(self._path)

        self._written(make)
        self._taken = self._file.rows

    def _replace(self, coords: dict, variables: dict, report: dict) -> None:
        self._file = create_file(_part_of(self._path), coords, variables, self._scene.to_toml(), report, REPORT_ROOM)
        self._claim(self._file.descriptor)

    def _add(self, rows: Rows) -> None:
        variables, coords = labelled(rows)
        self._written(lambda: self._file.write(self._taken, over_time(coords, variables)))
        self._taken = self._file.rows

    def _report(self, report: dict) -> None:
        def add() -> None:
            if not self._file.add_report(file_text(report)):  # with more room, then
                old = self._file
                self._replace(old.described(over_time=False), old.described(over_time=True), report)
                self._file.copy_rows(old)
                self._file.rename(self._path)

        self._written(add)

    def _checkpoint(self) -> None:
        elapsed = self.elapsed + time.monotonic() - self._begin
        facts = self._facts | {"rows": self._taken, "elapsed_s": elapsed, "resumed_at_s": self._resumed,
                               "events": self._events}
        self._written(lambda: Checkpoint(facts, self._engine.checkpoint()).write(self._state))
        self._checked = time.monotonic()

    def _written(self, write: Callable[[], None]) -> None:
        try:
            write()
        except OSError as error:
            whole = f"its first {self._file.rows} times are whole; " if self._file and self._path.exists() else ""
            raise ResultFileError(f"{self._path}: the results could not be written: {error.strerror}; {whole}"
                                  "make room, and go on with resume where there is a checkpoint") from error

    def _claim(self, descriptor: int) -> None:
        """A lock, which also a killed run gives back."""
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise self._refused("another run is writing it", "wait for its end, or give another name") from None
        except OSError:
            return  # a file system without locks

    def _refused(self, cause: str, remedy: str = "start the run anew, without resume") -> ResultFileError:
        return ResultFileError(f"{self._path}: {cause}; {remedy}")

    def _compare(self, facts: dict, name: str, difference: str) -> None:
        if facts[name] != self._facts[name]:
            raise self._refused(f"its run cannot go on {difference}")

    def _to_resume(self) -> Checkpoint:
        """The checkpoint, if it is one of this scene and these settings; opens the file."""
        if not self._path.exists():
            raise self._refused("there is no run to resume: there is no such file")
        status = load_run(self._path).status
        if status not in GOES_ON:
            raise self._refused(f"its run has come to its end ({status}): there is nothing to resume")
        try:
            kept = Checkpoint.read(self._state)
            settings, rows = kept.facts["settings"], kept.facts["rows"]
        except FileNotFoundError:
            raise self._refused(f"its checkpoint {self._state.name} is missing") from None
        except (OSError, ValueError, KeyError, TypeError):
            raise self._refused(f"its checkpoint {self._state.name} is damaged") from None
        for name, now in self._facts["settings"].items():
            if (before := settings.get(name)) != now:
                raise self._refused(f"its run was started with {name} = {before}, and cannot go on with {now}",
                                    "resume it with the settings that it was started with, or start it anew")
        self._compare(kept.facts, "scene", "with another scene")
        self._compare(kept.facts, "programs", "with another version of funicular, NumPy or SciPy")
        check_writable(self._path)
        self._file = File(self._path, writable=True)
        self._claim(self._file.descriptor)
        if rows > self._file.rows:
            raise self._refused(f"it has {self._file.rows} times, but its checkpoint is of the one after {rows}")
        return kept


def events_kept(path: Path) -> list[dict]:
    """What the events of a run that has not come to its end have found up to its checkpoint."""
    try:
        return Checkpoint.read(_state_of(path)).facts["events"]
    except (OSError, ValueError, KeyError, TypeError):
        return []


def _state_of(path: Path) -> Path:
    return path.with_name(f"{path.name}.state")


def _part_of(path: Path) -> Path:
    """What becomes the file when it is whole; the same for all runs, so that a killed one's is written over."""
    return path.with_name(f".{path.name}.part")


def _facts(scene: Scene, settings: RunSettings) -> dict:
    """What must be the same for a run to go on."""
    alone = copy(scene)
    alone.run_settings = {}
    said = {name: value for name, value in settings.model_dump().items() if name != "save"}
    return {"scene": _digest(alone.to_toml().encode()), "settings": json.loads(json.dumps(said, default=str)),
            "programs": _programs(scene)}


def _digest(*parts: bytes) -> str:
    digest = hashlib.sha256()
    for part in parts:
        digest.update(part)
    return digest.hexdigest()


def _programs(scene: Scene) -> str:
    """Digest of the machine code that computes the run."""
    import numpy
    import scipy
    from funicular import engine
    from funicular.generated import kernels
    from funicular.libraries import load

    files = [engine.__file__, kernels.__file__]
    versions = f"{numpy.__version__} {scipy.__version__}"
    return _digest(versions.encode(), *(Path(file).read_bytes() for file in files),
                   *(load(library).digest.encode() for library in scene.libraries))


def _start_of(model: Model) -> str:
    """Digest of the state that a run starts from."""
    places = [(joint.s, joint.element, joint.director.tolist()) for joint in model.joints]
    return _digest(model.q.tobytes(), model.v.tobytes(), repr(places).encode())
