"""The workers of a sweep: this process, or processes of a Dask cluster. Workers and scheduler may die.

Dask gives the batch of a dead worker to another one. A batch that kills its workers repeatedly is divided, down to
single points. Dask blames all batches of a dead worker; so such points are computed last, one at a time, and a point
that kills its worker even then is recorded as failed. When the scheduler is lost, this process connects anew and hands
out the missing batches again. A simpler form, in which a dead worker ends the sweep, would lose hours of work on a
cluster to one bad point.
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
from contextlib import contextmanager, nullcontext, suppress
from functools import partial
from typing import Any, TextIO

import numpy as np

from ..base.interruptions import interruptible
from ..errors import FunicularError
from ..solve.linear.threads import available
from .batches import Batch, Batches, Done, Task

LOG = logging.getLogger(__name__)

PATIENCE = 60.0
"""Seconds to wait for the scheduler and its workers, at the start and after a loss."""
BATCHES_PER_WORKER = 3
"""Batches that a worker has at once: one to compute, and others so that it need not wait."""
POLL = 1.0
"""Seconds between two checks of the scheduler and the number of its workers."""


class Workers:
    """This process as the only worker."""

    @property
    def number(self) -> int:
        """Return the number of batches that are computed at once."""
        return 1

    def compute(self, task: Task, batches: Batches,
                lost: Callable[[Batch, str], Done]) -> Iterator[tuple[Batch, Done]]:
        """Yield batches with their results, in any order; lost: returns the result of a point that kills its process.
        """
        for batch in batches:
            yield batch, task(batch)


@contextmanager
def workers_of(number: int | None, cluster: str | None) -> Iterator[Workers]:
    """Yield the workers.

    number: 0 for this process alone, None for all processors of this machine; cluster: the address of a Dask scheduler,
    whose workers are taken. Raises FunicularError.
    """
    if cluster is None and number == 0:
        yield Workers()
        return
    with local_cluster(number or available()) if cluster is None else nullcontext(cluster) as address:
        workers = DaskWorkers(address)
        try:
            with interruptible():
                workers.connect()
            yield workers
        finally:
            workers.close()


@contextmanager
def local_cluster(number: int) -> Iterator[str]:
    """Yield the address of a scheduler in this process with a number of worker processes of one thread each.

    The command `dask worker` starts them, so that a script needs no ``if __name__ == "__main__"``. They end with this
    process, also where it is killed. Raises FunicularError.
    """
    distributed: Any = importlib.import_module("distributed")  # of an extra
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
                    os.killpg(running.pid, signal.SIGKILL)  # the workers, too
                running.wait()


def _await_workers(cluster: Any, running: subprocess.Popen[bytes], number: int, log: TextIO) -> None:
    """Wait for the workers of a local cluster. Raises FunicularError where they do not start."""
    begin = time.monotonic()
    while len(cluster.scheduler.workers) < number:
        if running.poll() is not None or time.monotonic() - begin > PATIENCE:
            log.seek(0)
            output = log.read().strip().splitlines()[-1:] or ["nothing"]
            raise FunicularError(f"sweep: worker processes did not start; their last output was: {output[0]}; "
                                 "compute in this process alone (workers=0, --serial)")
        time.sleep(0.02)


class DaskWorkers(Workers):
    """The workers of a Dask scheduler."""

    def __init__(self, address: str):
        self._distributed: Any = importlib.import_module("distributed")
        self._address = address
        self._client: Any = None
        self._threads, self._counted_at = 1, -POLL
        self._suspects: list[Batch] = []
        self._alone = False
        self._ended: queue.SimpleQueue[Any] = queue.SimpleQueue()

    @property
    def number(self) -> int:
        """Return the number of threads of all workers, updated from time to time, since it changes."""
        if time.monotonic() - self._counted_at > POLL:
            self._threads, self._counted_at = max(1, sum(self._client.nthreads().values())), time.monotonic()
        return self._threads

    def connect(self) -> None:
        """Connect to the scheduler, and wait for its workers. Raises FunicularError after `PATIENCE`."""
        begin, cause = time.monotonic(), "it does not answer"
        while (left := PATIENCE - (time.monotonic() - begin)) > 0:
            try:
                self._ended = queue.SimpleQueue()  # futures that the scheduler lost stay in the older one
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

    def compute(self, task: Task, batches: Batches,
                lost: Callable[[Batch, str], Done]) -> Iterator[tuple[Batch, Done]]:
        """Yield batches with their results in order of completion. Raises FunicularError where the scheduler is lost.
        """
        pending: dict[Any, Batch] = {}
        while True:
            done: list[tuple[Batch, Done]] = []
            try:
                self._hand_out(task, batches, pending)
                if not pending:
                    return
                ended = self._finished()
                results = self._results(ended)
                for future in ended:
                    status = "fetched" if future in results else future.status
                    if status in ("pending", "finished"):  # its worker died: it is computed again, or was
                        future.add_done_callback(self._ended.put)
                        continue
                    batch = pending[future]
                    if status == "fetched":
                        done.append((batch, results[future]))
                    elif status == "error":
                        done += self._dead(future, batch, batches, lost)
                    else:  # lost or cancelled, and stays so where no worker is left
                        batches.give_back([batch])
                    del pending[future]  # last, since the handler of an error gives back all pending batches
            except (OSError, TimeoutError, RuntimeError, self._distributed.comm.CommClosedError,
                    self._distributed.CancelledError) as error:
                LOG.warning("sweep: lost the scheduler, and connect anew: %s", error or type(error).__name__)
                batches.give_back(list(pending.values()))
                pending.clear()
                self.close()
                self.connect()
            yield from done

    def _hand_out(self, task: Task, batches: Batches, pending: dict[Any, Batch]) -> None:
        """Hand out batches until all workers have enough; when all are done, one suspect."""
        room = BATCHES_PER_WORKER * self.number
        while len(pending) < room and (batch := batches.take()) is not None:
            self._submit(task, batch, pending)
        self._alone = not pending and bool(self._suspects)
        if self._alone:
            self._submit(task, self._suspects.pop(), pending)

    def _submit(self, task: Task, batch: Batch, pending: dict[Any, Batch]) -> None:
        future = self._client.submit(task, batch, pure=False)
        pending[future] = batch
        future.add_done_callback(self._ended.put)

    def _finished(self) -> list[Any]:
        """Return the futures that ended, at least one. Raises CancelledError where the scheduler is lost."""
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
        """Return the results of finished futures, all fetched at once."""
        finished = [future for future in futures if future.status == "finished"]
        try:
            return dict(zip(finished, self._gathered(finished), strict=True))
        except self._distributed.scheduler.KilledWorker:  # some were lost with their worker, and killed others
            return {future: future.result() for future in finished if future.status == "finished"}

    def _gathered(self, futures: list[Any]) -> list[Done]:
        """Return the results of futures. Raises FunicularError where all workers are gone."""
        fetch = partial(self._client.gather, futures, asynchronous=True)
        while True:
            try:
                found: list[Done] = self._client.sync(fetch, callback_timeout=PATIENCE)
                return found
            except TimeoutError:
                if not self._client.nthreads():
                    raise self._without_workers() from None

    def _without_workers(self) -> FunicularError:
        """Return the error of a scheduler without workers."""
        return FunicularError(f"sweep: the scheduler at {self._address} has no workers any more; start some, and "
                              "repeat the sweep: points that are written are not computed again")

    def _dead(self, future: Any, batch: Batch, batches: Batches,
              lost: Callable[[Batch, str], Done]) -> list[tuple[Batch, Done]]:
        """Divide a batch whose workers died; set a single point aside, or return its result if it was alone.

        Raises FunicularError where a worker could not compute it, and CancelledError where the scheduler is lost.
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
