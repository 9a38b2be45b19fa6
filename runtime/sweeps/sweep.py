"""Sweeps: a scene or a function over many points of its parameters, into one labelled dataset on disk."""

from __future__ import annotations

import importlib.util
import logging
import os
import time
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from numbers import Integral
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.interruptions import interruptible, uninterrupted
from ..errors import FunicularError, FunicularWarning, ResultFileError, SceneError, near
from ..parts.scene_text import dumps
from ..parts.settings import RunSettings
from ..parts.validation import shown
from ..results.resume_facts import programs_of
from ..solve.linear.threads import available
from .batches import Batch, Batches, Done, Task, versions
from .checks import check_points, own_times
from .cost import SweepCost, sample, seconds_of
from .layout import Layout
from .parameters import SWEEP, Points, points_of
from .points import FAILED, Outcome
from .progress import OnPoints, point_bar
from .store import Store, new_store, stored
from .stored_points import Keep
from .subject import SceneSubject, Subject, subject_of
from .workers import MISSING, Workers, workers_of

if TYPE_CHECKING:
    import xarray

    from ..scene.scene import Scene

LOG = logging.getLogger(__name__)

MOST_IN_MEMORY = 4e9
"""Bytes of results that a sweep without a file may have."""
NOT_WORTH_WORKERS = 2.0
"""Seconds of work that this process does itself, since workers take as long to start."""


@dataclass(frozen=True)
class Plan:
    """A checked sweep that has not begun."""

    subject: Subject
    points: Points
    keep: Keep
    units: Mapping[str, str]
    most_times: int | None
    seed: int
    programs: str

    @classmethod
    def of(cls, subject: Any, parameters: Mapping[str, Any], keep: Any, method: str, samples: int | None, seed: int,
           settings: Mapping[str, Any], record_invalid: bool) -> Plan:
        """Return the plan of a sweep; see `sweep`. Raises SceneError."""
        known = [name for name in RunSettings.keywords() if name != "save"]
        for name in settings:
            if name not in known:
                raise SceneError(SWEEP, f'"{name}" is not known here', near(name, [*known, *OPTIONS]))
        points, kept = points_of(parameters, method, samples, seed), Keep.of(keep)
        made = subject_of(subject, [*points.columns], kept, settings)
        units: dict[str, str] = {}
        times: int | None = None
        libraries: tuple[str, ...] = ()
        if isinstance(made, SceneSubject):
            if not record_invalid:
                check_points(made, points)
            units = {name: made.unit(name, points.point(0)) for name in points.columns}
            times, libraries = own_times(made, points), made.scene.libraries
        return cls(made, points, kept, units, times, int(seed), programs_of(libraries))

    @property
    def facts(self) -> dict[str, Any]:
        """Return what the file says of the sweep, and what must be the same for it to go on."""
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
        """Return the layout that a sample shows. Raises FunicularError where all of it failed."""
        kept = [outcome.kept for outcome in sampled.values() if outcome.kept is not None]
        if not kept:
            first = next(iter(sampled.values()))
            raise FunicularError(f"{SWEEP}: all {len(sampled)} points that were tried first failed; one of them: "
                                 f"{first.message}")
        times = [each.time for each in kept if each.time is not None]
        own = self.most_times
        if own is None and any(not np.array_equal(each, times[0]) for each in times):
            own = max(map(len, times))
        return Layout.of(self.points, self.units, kept, own if times else None)


OPTIONS = ("keep", "method", "samples", "seed", "save", "workers", "cluster", "batch", "progress", "record_invalid",
           "retry_failed", "on_cost")


def sweep(subject: Scene | Callable[..., Any], parameters: Mapping[str, Any], *,
          keep: Sequence[str] | Mapping[str, Any] | None = None, method: str = "grid", samples: int | None = None,
          seed: int = 0, save: str | os.PathLike | None = None, workers: int | None = None,
          cluster: str | None = None, batch: int | None = None, progress: bool | OnPoints | None = None,
          record_invalid: bool = False, retry_failed: bool = False,
          on_cost: Callable[[SweepCost], None] | None = None, **settings: Any) -> xarray.Dataset:
    """Run a scene, or call a function, at many points of its parameters; return one labelled xarray.Dataset.

    subject: a scene, whose parameters are paths such as "wire.material.youngs_modulus", "A.velocity.x", "gravity.y" or
    "run.tol"; or a function that takes the parameters as keywords and returns a Scene, a Run, or a dict of numbers and
    arrays. parameters: lists of values for ``method="grid"`` (all combinations) and "list" (the first values of all,
    the second ones, ...); distributions (`Uniform`, `LogUniform`, or of scipy.stats) for "random" and "latin" (Latin
    hypercube), of which ``samples`` points are drawn with ``seed``. keep: names of results, with ".x", ".y" or ".z" for
    a component; or a dict from names to such names, or to functions of the run that return a number or an array.
    settings: of the runs, as `Scene.run` takes them.

    save: the netCDF file, written while the sweep goes on; a sweep that was stopped goes on with the same call, and a
    finished point is not computed again. Without it results are in memory. workers: processes, one for each processor
    if None, 0 for this process alone; cluster: the address of a Dask scheduler, whose workers are taken instead.
    batch: points that a worker gets at once, chosen by what they cost if None. progress: as in `Scene.run`; a function
    is given the points done and those that failed. on_cost: is given the `SweepCost` before the work.

    A row of the file has at most 2 GiB, the file 2^31 - 1 points.

    Dimensions of the dataset are the parameters of a grid, else ``point`` with the parameters along it. A point that
    fails has NaN, the ``status`` "failed" and its error in ``message``. record_invalid: do so for scenes that cannot be
    simulated as well, which else are refused before the work; retry_failed: compute those that failed before again.

    Raises SceneError, ResultFileError, FunicularError. Ctrl-C returns what was computed, with a `FunicularWarning`.
    """
    _check_workers(workers, cluster, batch)
    plan = Plan.of(subject, parameters, keep, method, samples, seed, settings, record_invalid)
    with uninterrupted(), _begun(plan, save, retry_failed) as (store, layout, missing, sampled):
        cost = _cost(plan, layout, len(missing), sampled, workers)
        tell = on_cost or (lambda cost: None)
        alone = cluster is None and workers is None and cost.points * cost.point_seconds[1] < NOT_WORTH_WORKERS
        try:
            if len(missing):
                with workers_of(0 if alone else workers, cluster) as computing:
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
    """Return what `sweep` of the same arguments would cost, from a sample of its points; nothing is written."""
    plan = Plan.of(subject, parameters, keep, method, samples, seed, settings, record_invalid)
    sampled = sample(plan.subject, plan.points, np.arange(plan.points.number))
    return _cost(plan, plan.layout(sampled), plan.points.number, sampled, workers)


def _check_workers(workers: int | None, cluster: str | None, batch: int | None) -> None:
    """Refuse numbers that are none, and a sweep that lacks Dask. Raises FunicularError."""
    for name, value, least in (("workers", workers, 0), ("batch", batch, 1)):
        if value is not None and (isinstance(value, bool) or not isinstance(value, Integral) or value < least):
            raise SceneError(SWEEP, f"{name} must be a whole number, {least} or more, got {shown(value)}")
    if cluster is not None and workers is not None:
        raise SceneError(SWEEP, "a cluster has its own workers", "leave out workers")
    if cluster is not None and not isinstance(cluster, str):
        raise SceneError(SWEEP, f"cluster must be the address of a Dask scheduler, got {shown(cluster)}",
                         'give such as "tcp://127.0.0.1:8786"')
    if workers != 0:
        for name in ("dask", "distributed"):
            if importlib.util.find_spec(name) is None:
                raise FunicularError(MISSING.format(name=f'"{name}"'))


@contextmanager
def _begun(plan: Plan, save: str | os.PathLike | None,
           retry_failed: bool) -> Iterator[tuple[Store, Layout, np.ndarray, dict[int, Outcome]]]:
    """Yield the file, new or of the sweep that goes on, its layout, the points that are left, and a sample that is in
    the file already.
    """
    facts = plan.facts
    store = None if save is None else stored(save, facts)
    if store is None:
        missing = np.arange(plan.points.number)
        with interruptible():
            sampled = sample(plan.subject, plan.points, missing)
            layout = plan.layout(sampled)
        if save is None and layout.row_bytes * plan.points.number > MOST_IN_MEMORY:
            raise ResultFileError(f"sweep: {plan.points.number} points of {layout.row_bytes} bytes are more than the "
                                  f"{MOST_IN_MEMORY:.3g} that a sweep may keep in memory; name a file with save")
        store = new_store(save, layout, facts, plan.scene_text)
    else:
        layout = Layout.in_file(store.file, [*plan.points.columns])
        missing = np.sort(np.concatenate([store.missing, store.failed()])) if retry_failed else store.missing
        try:
            with interruptible():
                sampled = sample(plan.subject, plan.points, missing)
        except BaseException:
            store.close()
            raise
    try:
        numbers = np.array([*sampled], int)
        if len(numbers):
            store.put(numbers, layout.pack(store.dtype, plan.points.at(numbers), [*sampled.values()]))
        yield store, layout, np.delete(missing, np.searchsorted(missing, numbers)), sampled
    finally:
        store.close()


def _cost(plan: Plan, layout: Layout, left: int, sampled: dict[int, Outcome], workers: int | None) -> SweepCost:
    return SweepCost(left, len(sampled), seconds_of(sampled), available() if workers is None else max(workers, 1),
                     layout.row_bytes)


def _compute(plan: Plan, store: Store, layout: Layout, missing: np.ndarray, cost: SweepCost, computing: Workers,
             batch: int | None, progress: bool | OnPoints | None) -> None:
    """Compute the points that are left, and write them as they come."""
    task = Task(plan.subject, layout, store.dtype, versions())
    total, failed = plan.points.number, 0

    def lost(dead: Batch, message: str) -> Done:
        outcome = Outcome(None, FAILED, message, 0.0)
        return Done(layout.pack(store.dtype, dead.values, [outcome] * len(dead.numbers)), 0.0, len(dead.numbers))

    begin = time.monotonic()
    with point_bar(total, total - len(missing), progress) as show:
        batches = Batches(plan.points, missing, layout.row_bytes, computing.number, cost.point_seconds[1], batch)
        done = total - len(missing)
        for each, came in computing.compute(task, batches, lost):
            with uninterrupted():
                store.put(each.numbers, came.rows)
            batches.learn(len(each.numbers), came.seconds)
            done, failed = done + len(each.numbers), failed + came.failed
            show(done, failed)
    LOG.info("sweep: %d points in %.3g s", len(missing), time.monotonic() - begin)
