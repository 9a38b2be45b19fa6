"""Results on disk while a run goes on, and checkpoints from which a run that was stopped goes on.

A run that is saved as OUT.nc writes its rows there as it goes. At some of its pauses (pauses.py) it replaces
OUT.nc.state, the checkpoint. At which of them depends on the clock, but results do not: the engine is brought into a
state that a checkpoint holds in full at all of them. Runs that end by themselves leave no checkpoint.
"""

from __future__ import annotations

import os
import shutil
import time
from collections.abc import Callable, Mapping
from pathlib import Path

from ..base.operating_system import BYTES
from ..engine import Engine
from ..errors import ResultFileError
from ..model.model import Model
from ..parts.file_paths import GIVE, FilePath
from ..parts.scene_data import SceneData
from ..parts.scene_text import dumps, parts_text
from ..parts.settings import RunSettings
from ..solve.motion.pauses import Pauses
from ..solve.notes.row_notes import RowNotes
from .checkpoints import Checkpoint, DamagedCheckpointError, Facts, checkpoint_of
from .files import check_writable, create_file, file_text, open_file, over_time
from .locks import Taken, being_written, claimed_for, is_at, lock
from .netcdf import File
from .opening import opened
from .quantities import Variable, labelled
from .recording import Recording, Rows, named
from .resume_facts import facts_of, start_of
from .run import ReadScene, Run

ROWS_INTERVAL = 0.5
"""Seconds between two times that rows are written, at most."""
CHECKPOINT_INTERVAL = 0.5
"""Seconds between two checkpoints, at least, where the buffer lasts so long."""
REPORT_SPARE = 8192
"""Bytes for what the report will say at the end."""
RUN = "run"
"""What writes such files, in messages."""
GOES_ON = ("unfinished", "interrupted")
"""What the status of a run is that can be resumed."""


class Stream:
    """The file of a run while it goes on, and its checkpoint."""

    def __init__(self, path: str | os.PathLike, scene: SceneData, settings: RunSettings, resume: bool,
                 read_scene: ReadScene):
        """Check that the file can be written or, to resume, that it holds a run of this scene and these settings.

        From here to the end no other run can write it. Raises ResultFileError, and SceneError for a path that a scene
        file may not name.
        """
        self._path = check_writable(path.placed() if isinstance(path, FilePath) else path)
        self._state, self._part = checkpoint_of(self._path), _part_of(self._path)
        self._scene, self._settings, self._read_scene = scene, settings, read_scene
        self._opened: File | None = None
        self._has_name = self._may_begin_anew = False
        self._new = self._older = -1  # descriptors of the part file, and of the file that it will take the place of
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
            self._let_go()
            raise

    def __enter__(self) -> Stream:
        """Return the stream itself."""
        return self

    def __exit__(self, *exception: object) -> None:
        """Let other runs have the file."""
        self._let_go()

    def _let_go(self) -> None:
        if self._new >= 0 or (self._opened is not None and not self._has_name):  # it did not become the file
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
        """Return the seconds that the run took before it was resumed."""
        return self._kept.facts.elapsed_s if self._kept else 0.0

    @property
    def integrator(self) -> str | None:
        """Return the name of the integrator of a run that is resumed, None where one begins."""
        return self._kept.facts.integrator if self._kept else None

    @property
    def free(self) -> int:
        """Return the bytes that the file can have: those that are free, and those of the one that is there."""
        return shutil.disk_usage(self._path.parent).free + (self._path.stat().st_size if self._path.exists() else 0)

    def start(self, model: Model, engine: Engine, pace: Pauses, events: list[dict], row_notes: RowNotes,
              on_trial: bool) -> None:
        """Follow a run from its first row, or make it go on where the checkpoint was taken.

        events: those that have happened, a list to which more are added; row_notes: sees all rows; on_trial: whether
        the run may begin anew, with another call of `start`. Until it is `settled`, rows stay in the engine or, if they
        are too many, go to a file without a name: an older file stays what it is.
        """
        self._model, self._engine, self._pace, self._events = model, engine, pace, events
        self._row_notes = row_notes
        self._begin = time.monotonic()
        self._facts |= {"start": start_of(model), "integrator": engine.integrator}
        self._may_begin_anew = on_trial
        if self._kept is None:
            self._forget()
            if not on_trial:
                self._name()
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
        self._report(self._unfinished())  # first: the older one may tell the number of times
        self._written(lambda: self._file.truncate(self._taken))

    def settled(self) -> None:
        """Let the rows so far be those of the run, which does not begin anew: they get the file at the next pause."""
        self._may_begin_anew = False

    @property
    def has_begun(self) -> bool:
        """Return whether the file is there, and a checkpoint from which the run can go on."""
        return self._has_name

    def pause(self) -> None:
        """Write rows and a checkpoint if it is time to, or if the buffer does not last to the next pause."""
        if not (self._has_name or self._may_begin_anew):
            self._name()
            return
        free_rows = self._pace.capacity - (self._engine.n_rows - self._taken)
        due = self._has_name and time.monotonic() - self._checked > CHECKPOINT_INTERVAL
        if due or free_rows < self._pace.every + 1:
            self._take()
            if self._has_name:
                self._checkpoint()

    def between(self) -> None:
        """Write rows if it is time to."""
        if (self._has_name and time.monotonic() - self._added > ROWS_INTERVAL
                and self._engine.n_rows > self._taken):
            self._take()

    def _rows(self) -> Rows:
        """Return the rows that the engine has, by name."""
        return named(self._model, self._scene, self._engine)

    def _take(self) -> None:
        self._add(self._rows())
        self._clear()
        self._added = time.monotonic()

    def _clear(self) -> None:
        """Let the engine write over the rows that it has."""
        self._row_notes.see(self._engine)
        self._engine.take_rows()

    def finish(self, recording: Recording) -> Run:
        """Write the last rows and the report; the run as read from the file. Raises ResultFileError.

        A run that has failed before its first row leaves no file, or an older one as it was; it is returned, too.
        """
        last = Run.from_recording(recording, self._scene, self._settings, self._read_scene)
        if self._resumed:
            last.report["resumed_at_s"] = self._resumed
        if self._opened is None and not len(recording.time):
            return last
        self._add(recording)
        if not self._has_name:
            self._rename()
        self._report(last.report, self._file.rows)
        if recording.status not in GOES_ON:
            self._state.unlink(missing_ok=True)
        file = open_file(self._path)
        if not is_at(self._file.descriptor, self._path):
            raise self._lost()
        return opened(file, self._read_scene, self._scene.libraries, check=False)  # it is what was just written

    def add_to_report(self, report: dict) -> None:
        """Write the report of a finished run, to which something was added."""
        if self._opened is not None:
            self._report(report, self._file.rows)

    def _unfinished(self) -> dict:
        return {"status": "unfinished", "message": "the run goes on, or was killed", "resumed_at_s": self._resumed,
                "messages": self._scene.messages, "settings": self._settings.field_values()}

    def _name(self) -> None:
        """Give the rows so far the name of the file, in place of an older one, and write the first checkpoint."""
        self._take()
        self._rename()
        self._checkpoint()

    def _rename(self) -> None:
        """Let the part file take the place of an older one, whose checkpoint goes first."""
        def rename() -> None:
            self._state.unlink(missing_ok=True)
            self._file.rename(self._path)

        self._written(rename)
        self._has_name = True

    def _forget(self) -> None:
        """Remove the rows of a run that begins anew."""
        self._taken = 0
        if self._opened is not None:
            self._written(lambda: self._file.truncate(0))

    def _replace(self, coords: Mapping[str, Variable], variables: Mapping[str, Variable], report: dict,
                 rows: int | None = None) -> None:
        """Replace the older file by the part file, whole but for its rows."""
        descriptor, self._new = self._new if self._new >= 0 else claimed_for(self._part, self._path, RUN), -1
        self._opened = create_file(self._part, coords, variables, dumps(self._scene), file_text(report, rows),
                                 REPORT_SPARE, descriptor)

    def _add(self, rows: Rows) -> None:
        variables, coords = labelled(rows)

        def add() -> None:
            if self._opened is None:
                self._replace(coords, variables, self._unfinished())
            self._file.write(self._taken, over_time(coords, variables))

        self._written(add)
        self._taken = self._file.rows

    def _report(self, report: dict, rows: int | None = None) -> None:
        """Write a report; rows: number of rows of a file that is whole."""
        def add() -> None:
            if not self._file.add_report(file_text(report, rows)):  # it does not fit: a file with more space for it
                old = self._file
                self._replace(old.described(over_time=False), old.described(over_time=True), report, rows)
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
                             "leave it where it is until the run has come to its end")

    def _written(self, write: Callable[[], None]) -> None:
        try:
            write()
        except OSError as error:
            whole = f"its first {self._file.rows} times are whole; " if self._has_name and self._path.exists() else ""
            raise ResultFileError(f"{self._path}: the results could not be written: {error.strerror}; {whole}"
                                  "make room, and go on with resume where there is a checkpoint") from error

    def _claim_older(self) -> int:
        """Return a descriptor of the file that is there already, which no other run can then write; -1 where there is
        none.
        """
        while self._path.exists():
            try:
                descriptor = os.open(self._path, os.O_RDWR | BYTES)
            except FileNotFoundError:
                return -1
            except OSError as error:
                raise self._unwritable(error) from None
            try:
                lock(descriptor)
            except Taken:
                os.close(descriptor)
                raise being_written(self._path, RUN) from None
            if is_at(descriptor, self._path):
                return descriptor
            os.close(descriptor)  # replaced while it was opened
        return -1

    def _check_own(self, path: FilePath) -> None:
        """Refuse to replace anything but results of this scene where a scene file names the path."""
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

    def _unwritable(self, error: OSError) -> ResultFileError:
        return self._refused(f"the results cannot be written here: {error.strerror}", "give another path")

    def _refused(self, cause: str, remedy: str = "start the run anew, without resume") -> ResultFileError:
        return ResultFileError(f"{self._path}: {cause}; {remedy}")

    def _compare(self, facts: Facts, name: str, difference: str) -> None:
        if getattr(facts, name) != self._facts[name]:
            raise self._refused(f"its run cannot go on {difference}")

    def _to_resume(self) -> Checkpoint:
        """Return the checkpoint, if it is one of this scene and these settings; opens the file."""
        if self._older < 0:
            raise self._refused("there is no run to resume: there is no such file")
        status = opened(open_file(self._path), self._read_scene, check=False).status
        if status not in GOES_ON:
            raise self._refused(f"its run has come to its end ({status}): there is nothing to resume")
        kept = self._read_checkpoint()
        for name, now in self._facts["settings"].items():
            if (before := kept.facts.settings.get(name)) != now:
                raise self._refused(f"its run was started with {name} = {before}, and cannot go on with {now}",
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
    """Return what becomes the file when it is whole; the same for all runs, so that a killed one's is written over."""
    return path.with_name(f".{path.name}.part")
