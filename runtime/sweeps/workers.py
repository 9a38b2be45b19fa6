"""The workers of a sweep: this process, or processes of a Dask cluster, which may die, and whose scheduler may, too.

Dask gives the batch of a worker that died to another one. A batch whose workers die again and again is divided, down to
single points. Dask blames all that a worker had when it died; so such points are computed last, one alone at a time,
and those whose workers die even then are recorded as failed. Where the scheduler is lost, this process connects anew,
and hands out again what had not come back.
"""

from __future__ import annotations

import importlib
import logging
import os
import queue
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import partial
from typing import Any, Protocol

import numpy as np

from ..base.interruptions import interruptible
from ..errors import FunicularError
from ..solve.linear.threads import available
from .batches import Batch, Batches, Done

LOG = logging.getLogger(__name__)

PATIENCE = 60.0
"""Seconds that the scheduler, and workers, may take to come, or to come back."""
IN_FLIGHT = 3
"""Batches a worker that are handed out at once: one to compute, and others so that it need not wait."""
POLL = 1.0
"""Seconds between two looks whether the scheduler is there, and how many workers it has."""
MISSING = ("sweep: needs Dask to compute on more than one core, and the package {name} is missing; pip install "
           "'funicular[sweep]', or compute in this process alone (workers=0, --serial)")


class Workers(Protocol):
    """Compute batches."""

    @property
    def number(self) -> int:
        """Return how many batches are computed at once."""

    def compute(self, task: Callable[[Batch], Done], batches: Batches,
                lost: Callable[[Batch, str], Done]) -> Iterator[tuple[Batch, Done]]:
        """Yield batches with what they came to, in any order; lost: what a point came to that ends its process."""


class ThisProcess:
    """Computes in this process."""

    number = 1

    def compute(self, task: Callable[[Batch], Done], batches: Batches,
                lost: Callable[[Batch, str], Done]) -> Iterator[tuple[Batch, Done]]:
        """Yield batches with what they came to."""
        for batch in batches:
            yield batch, task(batch)


def dask_module(name: str) -> Any:
    """Return a module of Dask's. Raises FunicularError where it is not installed."""
    try:
        return importlib.import_module(name)
    except ModuleNotFoundError as error:
        raise FunicularError(MISSING.format(name=f'"{error.name}"')) from None


@contextmanager
def workers_of(number: int | None, cluster: str | None) -> Iterator[Workers]:
    """Yield the workers that are asked for.

    number: 0 for this process alone, None for all processors of this machine; cluster: the address of a Dask scheduler,
    whose workers are taken. Raises FunicularError.
    """
    if cluster is None and number == 0:
        yield ThisProcess()
        return
    dask_module("dask")
    dask_module("distributed")
    if cluster is not None:
        with _closing(DaskWorkers(cluster)) as workers:
            yield workers
        return
    with local_cluster(number or available()) as address, _closing(DaskWorkers(address)) as workers:
        yield workers


@contextmanager
def _closing(workers: DaskWorkers) -> Iterator[DaskWorkers]:
    try:
        with interruptible():
            workers.connect()
        yield workers
    finally:
        workers.close()


@contextmanager
def local_cluster(number: int) -> Iterator[str]:
    """Yield the address of a scheduler in this process, which has so many worker processes of one thread each.

    They are started by the command `dask worker`, so that a script needs no ``if __name__ == "__main__"``, and end with
    this process, also where it is killed. Raises FunicularError.
    """
    distributed = dask_module("distributed")
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
    with tempfile.TemporaryDirectory(prefix="funicular-", ignore_cleanup_errors=True) as folder:
        cluster = distributed.LocalCluster(n_workers=0, processes=True, dashboard_address="127.0.0.1:0",
                                           scheduler_kwargs={"dashboard": False}, silence_logs=logging.CRITICAL)
        command = [sys.executable, "-m", "dask", "worker", cluster.scheduler_address, "--nworkers", str(number),
                   "--nthreads", "1", "--no-dashboard", "--local-directory", folder, "--death-timeout", "60",
                   "--host", "127.0.0.1", "--dashboard-address", "127.0.0.1:0"]  # not on the network: they run any code
        with cluster, open(os.path.join(folder, "log"), "w+") as log:
            running = subprocess.Popen(command, env=environment, stdin=subprocess.DEVNULL, stdout=log, stderr=log,
                                       start_new_session=True)  # Ctrl-C is for this process alone
            try:
                with interruptible():
                    _await_workers(cluster, running, number, log)
                yield cluster.scheduler_address
            finally:
                with suppress(ProcessLookupError):
                    os.killpg(running.pid, signal.SIGKILL)  # the workers, too: they have nothing left to do
                running.wait()


def _await_workers(cluster: Any, running: subprocess.Popen, number: int, log: Any) -> None:
    """Wait for the workers of a local cluster. Raises FunicularError where they do not come."""
    begin = time.monotonic()
    while len(cluster.scheduler.workers) < number:
        if running.poll() is not None or time.monotonic() - begin > PATIENCE:
            log.seek(0)
            said = log.read().strip().splitlines()[-1:] or ["nothing"]
            raise FunicularError(f"sweep: worker processes did not start; the last they said was: {said[0]}; "
                                 "compute in this process alone (workers=0, --serial)")
        time.sleep(0.02)


class DaskWorkers:
    """The workers of a Dask scheduler."""

    def __init__(self, address: str):
        self._address, self._distributed = address, dask_module("distributed")
        self._client: Any = None
        self._threads, self._counted_at = 1, -POLL
        self._suspects: list[Batch] = []
        self._alone = False
        self._ended: queue.SimpleQueue[Any] = queue.SimpleQueue()

    @property
    def number(self) -> int:
        """Return how many threads the workers have together; asked for now and then, since they come and go."""
        if time.monotonic() - self._counted_at > POLL:
            self._threads, self._counted_at = max(1, sum(self._client.nthreads().values())), time.monotonic()
        return self._threads

    def connect(self) -> None:
        """Connect to the scheduler, and wait for its workers. Raises FunicularError where that takes too long."""
        begin, cause = time.monotonic(), "it does not answer"
        while (left := PATIENCE - (time.monotonic() - begin)) > 0:
            try:
                self._ended = queue.SimpleQueue()  # what the scheduler lost stays in the older one
                self._client = self._distributed.Client(self._address, timeout=min(left, 5.0), set_as_default=False)
                self._client.wait_for_workers(1, timeout=max(left, 1.0))
                return
            except (OSError, TimeoutError, ValueError, self._distributed.comm.CommClosedError) as error:
                cause = str(error) or cause
                self.close()
                if isinstance(error, ValueError):  # it is no address
                    break
                time.sleep(min(POLL, max(left, 0.0)))
        raise FunicularError(f"sweep: no Dask scheduler with workers at {self._address}: {cause}; start it and its "
                             "workers, and repeat the sweep: points that are written are not computed again")

    def close(self) -> None:
        """Leave the scheduler, if it is still there."""
        if self._client is not None:
            with suppress(OSError, TimeoutError, RuntimeError):
                self._client.close(timeout=2.0)
        self._client = None

    def compute(self, task: Callable[[Batch], Done], batches: Batches,
                lost: Callable[[Batch, str], Done]) -> Iterator[tuple[Batch, Done]]:
        """Yield batches with what they came to, as they come. Raises FunicularError where the scheduler is lost."""
        pending: dict[Any, Batch] = {}
        while True:
            came: list[tuple[Batch, Done]] = []
            try:
                self._hand_out(task, batches, pending)
                if not pending:
                    return
                ended = self._finished()
                results = self._results(ended)
                for future in ended:
                    status = "fetched" if future in results else future.status
                    if status in ("pending", "finished"):  # its worker died with it: is computed anew, or was
                        future.add_done_callback(self._ended.put)
                        continue
                    batch = pending[future]
                    if status == "fetched":
                        came.append((batch, results[future]))
                    elif status == "error":
                        came += self._dead(future, batch, batches, lost)
                    else:  # lost or cancelled, and stays so where no worker is left
                        batches.give_back([batch])
                    del pending[future]  # and not before: what is raised here gives back what is pending
            except (OSError, TimeoutError, RuntimeError, self._distributed.comm.CommClosedError,
                    self._distributed.CancelledError) as error:
                LOG.warning("sweep: lost the scheduler, and connect anew: %s", error or type(error).__name__)
                batches.give_back(list(pending.values()))
                pending.clear()
                self.close()
                self.connect()
            yield from came

    def _hand_out(self, task: Callable[[Batch], Done], batches: Batches, pending: dict[Any, Batch]) -> None:
        """Hand out batches until all workers have enough; when all are done, a suspect alone."""
        room = IN_FLIGHT * self.number
        while len(pending) < room and (batch := batches.take()) is not None:
            self._submit(task, batch, pending)
        self._alone = not pending and bool(self._suspects)
        if self._alone:
            self._submit(task, self._suspects.pop(), pending)

    def _submit(self, task: Callable[[Batch], Done], batch: Batch, pending: dict[Any, Batch]) -> None:
        future = self._client.submit(task, batch, pure=False)
        pending[future] = batch
        future.add_done_callback(self._ended.put)

    def _finished(self) -> list[Any]:
        """Return the futures that have come to an end, once there is one. Raises CancelledError where the scheduler is
        lost.
        """
        seen = time.monotonic()
        while self._client.status == "running":
            try:
                found = [self._ended.get(timeout=POLL)]
            except queue.Empty:
                if self._client.nthreads():
                    seen = time.monotonic()
                elif time.monotonic() - seen > PATIENCE:
                    raise self._without_workers() from None
                continue
            while not self._ended.empty():
                found.append(self._ended.get())
            return found
        raise self._distributed.CancelledError("it is gone")

    def _results(self, futures: list[Any]) -> dict[Any, Done]:
        """Return the results of those that have one, all fetched at once."""
        whole = [future for future in futures if future.status == "finished"]
        try:
            return dict(zip(whole, self._gathered(whole), strict=True))
        except self._distributed.scheduler.KilledWorker:  # some were lost with their worker, and killed others
            return {future: future.result() for future in whole if future.status == "finished"}

    def _gathered(self, futures: list[Any]) -> list[Done]:
        """Return the results of futures. Raises FunicularError where those that have them are gone, and no others come.
        """
        fetch = partial(self._client.gather, futures, asynchronous=True)
        while True:
            try:
                return self._client.sync(fetch, callback_timeout=PATIENCE)
            except TimeoutError:
                if not self._client.nthreads():
                    raise self._without_workers() from None

    def _without_workers(self) -> FunicularError:
        """Return the error of a scheduler that has lost its workers."""
        return FunicularError(f"sweep: the scheduler at {self._address} has no workers any more; start some, and "
                              "repeat the sweep: points that are written are not computed again")

    def _dead(self, future: Any, batch: Batch, batches: Batches,
              lost: Callable[[Batch, str], Done]) -> list[tuple[Batch, Done]]:
        """Divide a batch whose workers died, put its only point aside, or return what that came to alone.

        Raises FunicularError where a worker could not do it at all, and CancelledError where the scheduler is lost.
        """
        error = future.exception()
        if not isinstance(error, self._distributed.scheduler.KilledWorker):
            if isinstance(error, FunicularError | self._distributed.CancelledError):
                raise error
            cause = f"{type(error).__name__}: {error}"
            raise FunicularError(f"sweep: a worker could not compute a batch: {cause}") from error
        if len(batch.numbers) == 1 and not self._alone:
            self._suspects.append(batch)
            return []
        if len(batch.numbers) == 1:
            message = "the worker process died while it computed this point, each time that it was tried"
            return [(batch, lost(batch, message))]
        halves = np.array_split(np.arange(len(batch.numbers)), 2)
        batches.give_back([Batch(batch.numbers[k], {name: column[k] for name, column in batch.values.items()})
                           for k in halves])
        return []
