"""Results on disk during a run, and checkpoints from which a stopped run is resumed.

A run saved as OUT.nc writes its rows there. At some of its pauses (row_stream.py) it replaces the checkpoint
OUT.nc.state. The clock selects these pauses without an effect on results: at every pause the state of the engine is
one that a checkpoint holds completely. A completed run leaves no checkpoint.
"""

from __future__ import annotations

import os
import shutil
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from ..engine import Engine
from ..errors import ResultFileError
from ..model.model import Model
from ..parts.file_paths import GIVE, FilePath
from ..parts.scene_data import SceneData
from ..parts.scene_text import dumps, parts_text
from ..parts.settings import RunSettings
from ..solve.motion.row_stream import RowBlocks
from ..solve.notes.row_notes import RowNotes
from .checkpoints import Checkpoint, DamagedCheckpointError, Facts, checkpoint_of
from .files import check_writable, create_file, file_text, open_file, over_time
from .locks import claimed_for, is_at, locked
from .netcdf import File
from .opening import opened
from .quantities import Variable, labelled
from .recording import Recording, coordinates, named
from .resume_facts import facts_of, start_of
from .run import ReadScene, Run

ROWS_INTERVAL = 0.5
"""Longest time between two writes of rows, s."""
CHECKPOINT_INTERVAL = 0.5
"""Shortest time between two checkpoints, s, if the buffer lasts that long."""
REPORT_SPARE = 8192
"""Bytes reserved for the final report."""
RUN = "run"
"""The writer of these files in messages."""
RESUMABLE = ("unfinished", "interrupted")
"""Status of a run that can be resumed."""


class Stream:
    """The file of an active run, and its checkpoint."""

    def __init__(self, path: str | os.PathLike[str], scene: SceneData, settings: RunSettings, resume: bool,
                 read_scene: ReadScene):
        """Check that the file can be written or, to resume, that it holds a run of this scene and these settings.

        No other run can write the file until this one ends. Raises ResultFileError, and SceneError for a path that a
        scene file may not name.
        """
        self._path = check_writable(path.placed() if isinstance(path, FilePath) else path)
        self._state, self._part = checkpoint_of(self._path), _part_of(self._path)
        self._scene, self._settings, self._read_scene = scene, settings, read_scene
        self._opened: File | None = None
        self._has_name = self._on_trial = False
        self._new = self._older = -1  # descriptors of the part file and of the file that it replaces
        self._taken = 0
        self._resumed: list[float] = []
        self._added = self._checked = time.monotonic()
        self._facts = facts_of(scene, settings)
        try:
            if not resume:
                self._new = claimed_for(self._part, self._path, RUN)
            self._older = self._claim_older()
            if isinstance(path, FilePath):
                self._check_own(path)
            self._kept = self._to_resume() if resume else None
        except BaseException:
            self._release()
            raise

    def __enter__(self) -> Stream:
        """Return the stream itself."""
        return self

    def __exit__(self, *exception: object) -> None:
        """Release the file of results."""
        self._release()

    def _release(self) -> None:
        if self._new >= 0 or (self._opened is not None and not self._has_name):  # was not renamed
            self._part.unlink(missing_ok=True)
        for descriptor in (self._new, self._older):
            if descriptor >= 0:
                os.close(descriptor)
        self._new = self._older = -1
        if self._opened is not None:
            self._opened.close()

    @property
    def _file(self) -> File:
        assert self._opened is not None, "the run has no file yet"
        return self._opened

    @property
    def elapsed(self) -> float:
        """Return the wall time in s before the run was resumed."""
        return self._kept.facts.elapsed_s if self._kept else 0.0

    @property
    def integrator(self) -> str | None:
        """Return the integrator of a resumed run, None of a new one."""
        return self._kept.facts.integrator if self._kept else None

    @property
    def free(self) -> int:
        """Return the bytes available to the file: free space plus the older file."""
        return shutil.disk_usage(self._path.parent).free + (self._path.stat().st_size if self._path.exists() else 0)

    def start(self, model: Model, engine: Engine, blocks: RowBlocks, events: list[dict[str, Any]], row_notes: RowNotes,
              on_trial: bool) -> None:
        """Record a run from its first row, or restore its checkpoint.

        events: a list to which the run adds its events; row_notes: receives all rows; on_trial: whether the run may
        restart with another call of `start`. Until it is `settled`, rows stay in the engine or, if they are too many,
        in the part file: an older file stays unchanged.
        """
        self._model, self._engine, self._blocks, self._events = model, engine, blocks, events
        self._row_notes = row_notes
        self._begin = time.monotonic()
        self._facts |= {"start": start_of(model), "integrator": engine.integrator}
        self._on_trial = on_trial
        if self._kept is None:
            self._taken = 0
            if self._opened is not None:  # rows of the previous trial
                self._written(lambda: self._file.truncate(0))
            if not on_trial:
                self._publish()
            return
        facts, state = self._kept
        self._compare(facts, "start", "from another state")
        self._compare(facts, "integrator", f'with integrator "{engine.integrator}"')
        try:
            engine.restore(state, facts.rows)
        except ValueError:
            raise self._refused(f"its checkpoint {self._state.name} is damaged") from None
        self._taken = facts.rows
        events[:] = facts.events
        row_notes.go_on(facts.row_notes)
        self._resumed = [*facts.resumed_at_s, engine.time]
        self._report(self._unfinished())  # first: the older report may give the number of times
        self._written(lambda: self._file.truncate(self._taken))

    def settled(self) -> None:
        """End the trial: the rows so far are those of the run, and the next pause replaces the older file."""
        self._on_trial = False

    @property
    def has_begun(self) -> bool:
        """Return whether there are a file and a checkpoint from which the run can be resumed."""
        return self._has_name

    def pause(self) -> None:
        """Write rows and a checkpoint if due, or if the buffer would overflow before the next pause."""
        if not (self._has_name or self._on_trial):
            self._publish()
            return
        free_rows = self._blocks.capacity - (self._engine.n_rows - self._taken)
        due = self._has_name and time.monotonic() - self._checked > CHECKPOINT_INTERVAL
        if due or free_rows < self._blocks.every + 1:
            self._take()
            if self._has_name:
                self._checkpoint()

    def between(self) -> None:
        """Write rows if due."""
        if (self._has_name and time.monotonic() - self._added > ROWS_INTERVAL
                and self._engine.n_rows > self._taken):
            self._take()

    def _take(self) -> None:
        """Write the rows of the engine, which may then overwrite them."""
        rows = self._engine.rows()
        self._add(labelled(named(self._model, self._scene, rows)), coordinates(self._model, rows["time"]))
        self._row_notes.see(self._engine)
        self._engine.take_rows()
        self._added = time.monotonic()

    def finish(self, recording: Recording) -> Run:
        """Write the last rows and the report, and return the run as read from the file. Raises ResultFileError.

        A run that failed before its first row is returned without a file; an older file stays unchanged.
        """
        last = Run.from_recording(recording, self._scene, self._settings, self._read_scene)
        if self._resumed:
            last.report["resumed_at_s"] = self._resumed
        if self._opened is None and not len(recording.rows["time"]):
            return last
        self._add(recording.variables(), recording.coords)
        if not self._has_name:
            self._rename()
        self._report(last.report, self._file.rows)
        if recording.status not in RESUMABLE:
            self._state.unlink(missing_ok=True)
        file = open_file(self._path)
        if not is_at(self._file.descriptor, self._path):
            raise self._lost()
        return opened(file, self._read_scene, self._scene.libraries, check=False)  # just written

    def add_to_report(self, report: dict[str, Any]) -> None:
        """Write the extended report of a finished run."""
        if self._opened is not None:
            self._report(report, self._file.rows)

    def _unfinished(self) -> dict[str, Any]:
        return {"status": "unfinished", "message": "the run is active, or was killed", "resumed_at_s": self._resumed,
                "messages": self._scene.messages, "settings": self._settings.field_values()}

    def _publish(self) -> None:
        """Replace an older file by the rows so far, and write the first checkpoint."""
        self._take()
        self._rename()
        self._checkpoint()

    def _rename(self) -> None:
        """Replace an older file by the part file; its checkpoint is removed first."""
        def rename() -> None:
            self._state.unlink(missing_ok=True)
            self._file.rename(self._path)

        self._written(rename)
        self._has_name = True

    def _open_part(self, coords: Mapping[str, Variable], variables: Mapping[str, Variable], report: dict[str, Any],
                 rows: int | None = None) -> None:
        """Open a new part file without rows."""
        descriptor, self._new = self._new if self._new >= 0 else claimed_for(self._part, self._path, RUN), -1
        self._opened = create_file(self._part, coords, variables, dumps(self._scene), file_text(report, rows),
                                   REPORT_SPARE, descriptor)

    def _add(self, variables: Mapping[str, Variable], coords: Mapping[str, Variable]) -> None:
        def add() -> None:
            if self._opened is None:
                self._open_part(coords, variables, self._unfinished())
            self._file.write(self._taken, over_time(coords, variables))

        self._written(add)
        self._taken = self._file.rows

    def _report(self, report: dict[str, Any], rows: int | None = None) -> None:
        """Write a report; rows: the number of rows of a complete file."""
        def add() -> None:
            if not self._file.add_report(file_text(report, rows)):  # too long: a file with more space
                old = self._file
                self._open_part(old.described(over_time=False), old.described(over_time=True), report, rows)
                self._file.copy_rows(old)
                self._file.rename(self._path)

        self._written(add)

    def _checkpoint(self) -> None:
        if not is_at(self._file.descriptor, self._path):
            raise self._lost()
        elapsed = self.elapsed + time.monotonic() - self._begin
        facts = Facts(**self._facts, rows=self._taken, elapsed_s=elapsed, resumed_at_s=self._resumed,
                      events=self._events, row_notes=self._row_notes.found)
        self._written(lambda: Checkpoint(facts, self._engine.checkpoint()).write(self._state))
        self._checked = time.monotonic()

    def _lost(self) -> ResultFileError:
        return self._refused("it was removed or replaced while the run was writing it",
                             "leave it unchanged until the run has ended")

    def _written(self, write: Callable[[], None]) -> None:
        try:
            write()
        except OSError as error:
            kept = self._has_name and self._path.exists()
            complete = f"its first {self._file.rows} times are whole; " if kept else ""
            raise ResultFileError(f"{self._path}: the results could not be written: {error.strerror}; {complete}"
                                  "free disk space, and resume the run if there is a checkpoint") from error

    def _claim_older(self) -> int:
        """Return a locked descriptor of the existing file, -1 if there is none."""
        while self._path.exists():
            try:
                descriptor = locked(self._path, RUN)
            except FileNotFoundError:
                return -1
            except OSError as error:
                raise self._refused(f"the results cannot be written here: {error.strerror}", "give another path"
                                    ) from None
            if is_at(descriptor, self._path):
                return descriptor
            os.close(descriptor)  # replaced while it was opened
        return -1

    def _check_own(self, path: FilePath) -> None:
        """Refuse to replace other files than results of this scene if a scene file names the path."""
        if self._older < 0:
            if self._state.exists():
                raise self._refused(f"there is a file {self._state.name}, which the run would replace",
                                    f"delete it, or {GIVE}")
            return
        try:
            scene = open_file(self._path).attributes["scene"]
        except (ResultFileError, KeyError):
            scene = None
        if not isinstance(scene, str) or parts_text(scene) != parts_text(dumps(self._scene)):
            raise self._refused(f'save = "{path}" in a scene file replaces results of the same scene alone',
                                f"delete what is there, choose another name, or {GIVE}")

    def _refused(self, cause: str, remedy: str = "start the run anew, without resume") -> ResultFileError:
        return ResultFileError(f"{self._path}: {cause}; {remedy}")

    def _compare(self, facts: Facts, name: str, difference: str) -> None:
        if getattr(facts, name) != self._facts[name]:
            raise self._refused(f"its run cannot be resumed {difference}")

    def _to_resume(self) -> Checkpoint:
        """Return the checkpoint, checked against scene and settings, and open the file."""
        if self._older < 0:
            raise self._refused("there is no run to resume: there is no such file")
        status = opened(open_file(self._path), self._read_scene, check=False).status
        if status not in RESUMABLE:
            raise self._refused(f"its run has ended ({status}): there is nothing to resume")
        kept = self._read_checkpoint()
        for name, now in self._facts["settings"].items():
            if (before := kept.facts.settings.get(name)) != now:
                raise self._refused(f"its run was started with {name} = {before}, and cannot be resumed with {now}",
                                    "resume it with the settings that it was started with, or start it anew")
        self._compare(kept.facts, "scene", "with another scene")
        self._compare(kept.facts, "programs", "with another version of funicular, NumPy or SciPy")
        descriptor, self._older = self._older, -1
        self._opened, self._has_name = File(self._path, descriptor=descriptor), True
        if kept.facts.rows > self._file.rows:
            raise self._refused(f"it has {self._file.rows} times, but its checkpoint is of the one after "
                                f"{kept.facts.rows}")
        if len(damaged := self._file.damaged_rows(kept.facts.rows)):
            raise self._refused(f"{len(damaged)} of the output times up to its checkpoint are damaged, the first is "
                                f"that of row {damaged[0]}")
        return kept

    def _read_checkpoint(self) -> Checkpoint:
        try:
            return Checkpoint.read(self._state)
        except FileNotFoundError:
            raise self._refused(f"its checkpoint {self._state.name} is missing") from None
        except DamagedCheckpointError as error:
            raise self._refused(f"its checkpoint {self._state.name} {error}") from None
        except OSError as error:
            raise self._refused(f"its checkpoint {self._state.name} cannot be read: {error.strerror}") from None


def _part_of(path: Path) -> Path:
    """Return the path of the part file: the same for all runs, so that the next one overwrites that of a killed run."""
    return path.with_name(f".{path.name}.part")
