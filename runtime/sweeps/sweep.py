"""Sweeps: a scene or a function over many points of its parameters, into one labelled dataset on disk."""

from __future__ import annotations

import importlib.util
import logging
import os
import time
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, ExitStack, contextmanager, nullcontext
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.interruptions import interruptible, uninterrupted
from ..base.notebook import in_notebook
from ..errors import FunicularError, FunicularWarning, ResultFileError, SceneError, near
from ..parts.paths import unit_of
from ..parts.scene_text import dumps
from ..parts.settings import RunSettings
from ..parts.validation import shown
from ..results.resume_facts import programs_of
from ..solve.linear.threads import available
from ..solve.motion.progress import is_watched
from .batches import Batch, Batches, Done, Task, versions
from .cost import SweepCost, sample, seconds_of
from .layout import Layout
from .parameters import SWEEP, Points, check_whole, points_of
from .store import Store, new_store, stored
from .stored_points import Keep
from .subject import FAILED, Outcome, SceneSubject, Subject, subject_of
from .thread_workers import ThreadWorkers
from .workers import Workers, workers_of

if TYPE_CHECKING:
    import xarray

    from ..scene.scene import Scene

LOG = logging.getLogger(__name__)

MAX_BYTES_IN_MEMORY = 4e9
"""Bytes of results of a sweep without a file."""
MIN_SECONDS_FOR_WORKERS = 2.0
"""Seconds of work of a function below which this process computes alone, since processes take as long to start."""
PROCESSES_START_SECONDS, LOCKED_SHARE, MIN_GAIN = 4.0, 0.4, 0.05
"""Seconds that processes take to start, the share of short runs in which a thread holds Python's lock, and the least
gain of processes over threads that counts, as a share of the work.
"""

OnPoints = Callable[[int, int], None]
"""Takes the number of finished points, and of those that failed."""


@dataclass(frozen=True)
class Plan:
    """A checked sweep that has not begun; own_times: the most output times of a point, None where all share theirs."""

    subject: Subject
    points: Points
    keep: Keep
    units: Mapping[str, str]
    own_times: int | None
    seed: int
    programs: str

    @classmethod
    def of(cls, subject: Any, parameters: Mapping[str, Any], keep: Any, method: str, samples: int | None, seed: int,
           settings: Mapping[str, Any], record_invalid: bool) -> Plan:
        """Return the plan of a sweep; see `sweep`. Raises SceneError."""
        known = [name for name in RunSettings.keywords() if name != "save"]
        for name in settings:
            if name not in known:
                known += sweep.__kwdefaults__ or ()
                raise SceneError(SWEEP, f'"{name}" is not known here', near(name, known))
        points, kept = points_of(parameters, method, samples, seed), Keep.of(keep)
        made = subject_of(subject, [*points.columns], kept, settings)
        units: dict[str, str] = {}
        times: int | None = None
        libraries: tuple[str, ...] = ()
        if isinstance(made, SceneSubject):
            if not record_invalid:
                made.check(points)
            first = made.scene_at(points.point(0))
            units = {name: unit_of(first, made.paths[name]) for name in points.columns}
            times, libraries = made.own_times(points), made.scene.libraries
        return cls(made, points, kept, units, times, int(seed), programs_of(libraries))

    @property
    def facts(self) -> dict[str, Any]:
        """Return the facts of the sweep in its file, some of which must be equal in a resumed sweep."""
        described = [{"name": name, "units": self.units.get(name, ""), "kind": type(column[0].item()).__name__,
                      "values": column.tolist() if self.points.is_grid else None}
                     for name, column in self.points.columns.items()]
        return {"number": self.points.number, "method": self.points.method, "seed": self.seed,
                "parameters": described, "subject": self.subject.digest, "points": self.points.digest,
                "keep": self.keep.digest, "programs": self.programs}

    @property
    def scene_text(self) -> str:
        """Return the text of the scene, empty of a function."""
        return dumps(self.subject.scene) if isinstance(self.subject, SceneSubject) else ""

    def layout(self, sampled: Mapping[int, Outcome]) -> Layout:
        """Return the layout from a sample. Raises FunicularError where all of it failed."""
        stored = [outcome.stored for outcome in sampled.values() if outcome.stored is not None]
        if not stored:
            first = next(iter(sampled.values()))
            raise FunicularError(f"{SWEEP}: all {len(sampled)} points that were tried first failed; one of them: "
                                 f"{first.message}")
        times = [each.time for each in stored if each.time is not None]
        own = self.own_times
        if own is None and any(not np.array_equal(each, times[0]) for each in times):
            own = max(map(len, times))
        return Layout.of(self.points, self.units, stored, own if times else None)


def sweep(subject: Scene | Callable[..., Any], parameters: Mapping[str, Any], *,
          keep: Sequence[str] | Mapping[str, Any] | None = None, method: str = "grid", samples: int | None = None,
          seed: int = 0, save: str | os.PathLike[str] | None = None, workers: int | None = None,
          cluster: str | None = None, batch: int | None = None, progress: bool | OnPoints | None = None,
          record_invalid: bool = False, retry_failed: bool = False,
          on_cost: Callable[[SweepCost], None] | None = None, **settings: Any) -> xarray.Dataset:
    """Run a scene, or call a function, at many points of its parameters; return one labelled xarray.Dataset.

    subject: a scene, whose parameters are paths such as "wire.material.youngs_modulus", "A.velocity.x", "gravity.y",
    "temperature" or "run.tol"; or a function that takes the parameters as keywords and returns a Scene, a Run, or a
    dict of numbers and arrays. parameters: lists of values for ``method="grid"`` (all combinations) and "list" (the
    first values of all, the second ones, ...); distributions (`Uniform`, `LogUniform`, or of scipy.stats) for "random"
    and "latin" (Latin hypercube), of which ``samples`` points are drawn with ``seed``. keep: names of results, with
    ".x", ".y" or ".z" for a component; or a dict from names to such names, or to functions of the run that return a
    number or an array. settings: of the runs, as `Scene.run` takes them.

    save: the netCDF file, written while the sweep runs; the same call resumes a stopped sweep without computing
    finished points again. Without it results are in memory. workers: processes, or for short work with scenes threads,
    one for each processor if None, 0 for this process alone; cluster: the address of a Dask scheduler, whose workers
    are taken instead. batch: points that a worker gets at once, chosen by their time if None. progress: as in
    `Scene.run`; a function takes the numbers of finished and of failed points. on_cost: takes the `SweepCost` before
    the work.

    A row of the file has at most 2 GiB, the file 2^31 - 1 points.

    Dimensions of the dataset are the parameters of a grid, else ``point`` with the parameters along it. A point that
    fails has NaN, the ``status`` "failed" and its error in ``message``. record_invalid: record scenes that cannot be
    simulated in this way instead of refusing them before the work; retry_failed: compute failed points again.

    Raises SceneError, ResultFileError, FunicularError. Ctrl-C returns the finished points, with a `FunicularWarning`.
    """
    _check_workers(workers, cluster, batch)
    plan = Plan.of(subject, parameters, keep, method, samples, seed, settings, record_invalid)
    _check_dask(plan, workers, cluster)
    with uninterrupted(), _begun(plan, save, retry_failed) as (store, layout, missing, sampled):
        cost = _cost(plan, layout, len(missing), sampled, workers)
        tell = on_cost or (lambda cost: None)
        try:
            if len(missing):
                with _computing(plan, cost, workers, cluster) as computing:
                    cost = replace(cost, workers=computing.number)
                    LOG.info("sweep: %s", cost)
                    with interruptible():
                        tell(cost)
                        _compute(plan, store, layout, missing, cost, computing, batch, progress)
            else:
                tell(cost)
        except KeyboardInterrupt:
            goes_on = "" if save is None else f" are in {os.fspath(save)}, and the same sweep goes on with the others"
            warnings.warn(f"sweep: interrupted; {int(store.finished.sum())} of {plan.points.number} points{goes_on}",
                          FunicularWarning, stacklevel=2)
        from .dataset import dataset_of  # brings xarray, 0.5 s

        dataset = dataset_of(store.file, dict(store.facts), store.finished)
        return dataset.load() if save is None else dataset


def sweep_cost(subject: Scene | Callable[..., Any], parameters: Mapping[str, Any], *,
               keep: Sequence[str] | Mapping[str, Any] | None = None, method: str = "grid",
               samples: int | None = None, seed: int = 0, workers: int | None = None, record_invalid: bool = False,
               **settings: Any) -> SweepCost:
    """Return the estimated cost of `sweep` with the same arguments, from a sample of its points; writes nothing."""
    plan = Plan.of(subject, parameters, keep, method, samples, seed, settings, record_invalid)
    sampled = sample(plan.subject, plan.points, np.arange(plan.points.number))
    return _cost(plan, plan.layout(sampled), plan.points.number, sampled, workers)


def _check_workers(workers: int | None, cluster: str | None, batch: int | None) -> None:
    """Raise SceneError for wrong numbers, and for an address that is none."""
    for name, value, least in (("workers", workers, 0), ("batch", batch, 1)):
        if value is not None:
            check_whole(name, value, least)
    if cluster is not None and workers is not None:
        raise SceneError(SWEEP, "a cluster has its own workers", "leave out workers")
    if cluster is not None and not isinstance(cluster, str):
        raise SceneError(SWEEP, f"cluster must be the address of a Dask scheduler, got {shown(cluster)}",
                         'give such as "tcp://127.0.0.1:8786"')


def _check_dask(plan: Plan, workers: int | None, cluster: str | None) -> None:
    """Raise FunicularError for a sweep that lacks Dask; scenes without a cluster compute on threads."""
    missing = _missing_package()
    if missing and workers != 0 and (cluster is not None or not plan.subject.takes_threads):
        raise FunicularError(f'sweep: needs Dask to compute on more than one core, and the package "{missing}" is '
                             "missing; pip install 'funicular[sweep]', or compute in this process alone "
                             "(workers=0, --serial)")


def _missing_package() -> str | None:
    """Return the package of Dask that is missing, None where it is installed."""
    return next((name for name in ("dask", "distributed") if importlib.util.find_spec(name) is None), None)


@contextmanager
def _begun(plan: Plan, save: str | os.PathLike[str] | None,
           retry_failed: bool) -> Iterator[tuple[Store, Layout, np.ndarray, dict[int, Outcome]]]:
    """Yield the file, new or of a resumed sweep, its layout, the remaining points, and a sample, which it contains."""
    store = None if save is None else stored(save, plan.facts)
    with ExitStack() as files:
        if store is None:
            missing = np.arange(plan.points.number)
        else:
            files.callback(store.file.close)
            missing = np.sort(np.concatenate([store.missing, store.failed()])) if retry_failed else store.missing
        with interruptible():
            sampled = sample(plan.subject, plan.points, missing)
        if store is None:
            layout = plan.layout(sampled)
            if save is None and layout.row_bytes * plan.points.number > MAX_BYTES_IN_MEMORY:
                raise ResultFileError(f"sweep: {plan.points.number} points of {layout.row_bytes} bytes are more than "
                                      f"the {MAX_BYTES_IN_MEMORY:.3g} that a sweep may keep in memory; name a file "
                                      "with save")
            store = new_store(save, layout, plan.facts, plan.scene_text)
            files.callback(store.file.close)
        else:
            layout = Layout.in_file(store.file, [*plan.points.columns])
        numbers = np.array([*sampled], int)
        if len(numbers):
            store.put(numbers, layout.pack(store.file.row_dtype, plan.points.at(numbers), [*sampled.values()]))
        yield store, layout, np.delete(missing, np.searchsorted(missing, numbers)), sampled


def _computing(plan: Plan, cost: SweepCost, workers: int | None, cluster: str | None) -> (
        AbstractContextManager[Workers]):
    """Return the workers of a sweep: its cluster, processes, or for short work threads or this process alone; threads
    of scenes also where Dask is missing.
    """
    work, number = cost.points * cost.point_seconds[1], workers or available()
    if cluster is not None or workers == 0:
        return workers_of(workers, cluster)
    is_short = work * max(LOCKED_SHARE - 1 / number, MIN_GAIN) < PROCESSES_START_SECONDS
    if plan.subject.takes_threads and (is_short or _missing_package()):
        return nullcontext(ThreadWorkers(number))
    return workers_of(0 if workers is None and work < MIN_SECONDS_FOR_WORKERS else workers, None)


def _cost(plan: Plan, layout: Layout, left: int, sampled: dict[int, Outcome], workers: int | None) -> SweepCost:
    return SweepCost(left, len(sampled), seconds_of(sampled), available() if workers is None else max(workers, 1),
                     layout.row_bytes)


def _compute(plan: Plan, store: Store, layout: Layout, missing: np.ndarray, cost: SweepCost, computing: Workers,
             batch: int | None, progress: bool | OnPoints | None) -> None:
    """Compute the remaining points, and write each batch when it is done."""
    task = Task(plan.subject, layout, store.file.row_dtype, versions())
    total, failed = plan.points.number, 0

    def lost(dead: Batch, message: str) -> Done:
        outcome = Outcome(None, FAILED, message, 0.0)
        rows = layout.pack(store.file.row_dtype, dead.values, [outcome] * len(dead.numbers))
        return Done(rows, 0.0, len(rows))

    begin = time.monotonic()
    with point_bar(total, total - len(missing), progress) as show:
        batches = Batches(plan.points, missing, layout.row_bytes, computing.number, cost.point_seconds[1], batch)
        done = total - len(missing)
        for each, result in computing.compute(task, batches, lost):
            with uninterrupted():
                store.put(each.numbers, result.rows)
            batches.learn(len(each.numbers), result.seconds)
            done, failed = done + len(each.numbers), failed + result.failed
            show(done, failed)
    LOG.info("sweep: %d points in %.3g s", len(missing), time.monotonic() - begin)


@contextmanager
def point_bar(total: int, before: int, progress: bool | OnPoints | None) -> Iterator[OnPoints]:
    """Yield the function to call with the numbers of finished and failed points.

    before: points that were finished before; progress: a bar (True), none (False), a bar if a terminal watches (None),
    or a function.
    """
    if callable(progress):
        yield progress
        return
    if not (progress is True or (progress is None and is_watched())):
        yield lambda done, failed: None
        return
    from rich.console import Console  # for sweeps that a person watches
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    columns = MofNCompleteColumn(), BarColumn(), TimeRemainingColumn(), TextColumn("{task.description}")
    begin = time.monotonic()
    with Progress(*columns, console=Console(stderr=not in_notebook()), transient=True) as bar:
        task = bar.add_task("", total=total, completed=before)

        def show(done: int, failed: int) -> None:
            rate = (done - before) / max(time.monotonic() - begin, 1e-3)
            bar.update(task, completed=done, description=f"{rate:.3g} points/s" + f", {failed} failed" * bool(failed))

        yield show
