"""Sweeps on Dask with a real scheduler and worker processes, some of them killed; results equal those of one process.

Waiting has no limit but that of the whole test run, since the machine may be busy.
"""

import os
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path

import funicular as fu
import numpy as np
import pytest
from funicular.sweeps import workers as module
from funicular.sweeps.batches import Batches
from funicular.sweeps.parameters import points_of
from sweep_subjects import GRID, KEPT, counted, deadly, scene, square

distributed = pytest.importorskip("distributed")
HERE = Path(__file__).parent


@pytest.fixture(scope="module")
def cluster():
    """Return a scheduler with two workers that are threads of this process."""
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=False,
                                  dashboard_address="127.0.0.1:0", scheduler_kwargs={"dashboard": False}) as found:
        yield found.scheduler_address


@pytest.fixture
def subjects_found(monkeypatch):
    """Make the sweep's functions importable in worker processes."""
    monkeypatch.setenv("PYTHONPATH", str(HERE))


def test_on_a_cluster_as_alone(cluster):
    alone = fu.sweep(square, {"x": [1, 2, 3], "y": [*range(30)]}, workers=0, progress=False)
    done = []
    found = fu.sweep(square, {"x": [1, 2, 3], "y": [*range(30)]}, cluster=cluster, batch=4,
                     progress=lambda count, failed: done.append((count, failed)))
    assert found.drop_vars("seconds").identical(alone.drop_vars("seconds"))
    assert done[-1][0] == 90 and int((found.status == "failed").sum()) == 30


def test_functions_without_a_module_are_sent_along(cluster):
    factor = 3
    found = fu.sweep(lambda x: {"y": factor * x}, {"x": [*range(20)]}, cluster=cluster, batch=2, progress=False)
    np.testing.assert_array_equal(found.y, 3.0 * np.arange(20))


def test_a_worker_with_another_version_is_refused(cluster, monkeypatch):
    monkeypatch.setattr("funicular.sweeps.sweep.versions", lambda: "funicular 0.0")
    with pytest.raises(fu.FunicularError, match=r"a worker has funicular .* started with funicular 0.0; install"):
        fu.sweep(square, {"x": [1], "y": [*range(30)]}, cluster=cluster, progress=False)


def test_no_scheduler_is_said(monkeypatch):
    monkeypatch.setattr(module, "PATIENCE", 0.5)
    for address in (f"tcp://127.0.0.1:{free_port()}", "nonsense://1"):
        with pytest.raises(fu.FunicularError, match=f"no Dask scheduler with workers at {address}"):
            fu.sweep(square, {"x": [1], "y": [*range(30)]}, cluster=address, progress=False)


def test_a_cluster_that_lost_its_workers_is_said(monkeypatch):
    monkeypatch.setattr(module, "PATIENCE", 1.0)
    with distributed.LocalCluster(n_workers=1, threads_per_worker=1, processes=False, scheduler_kwargs={
            "dashboard": False}, dashboard_address="127.0.0.1:0") as own:
        with pytest.raises(fu.FunicularError, match="has no workers any more; start some"):
            fu.sweep(square, {"x": [1], "y": [*range(100)]}, cluster=own.scheduler_address, batch=1,
                     progress=lambda done, failed: own.scale(0))


def test_a_batch_whose_result_is_lost_is_computed_again(cluster, monkeypatch):
    """A future that was lost with the last worker stays lost; its batch must be submitted anew."""
    losses = []

    def finished_but_one(self, finished=module.DaskWorkers._finished):
        found = finished(self)
        if not losses:
            losses.append(found[0])
            found[0]._state.lose()
        return found

    monkeypatch.setattr(module.DaskWorkers, "_finished", finished_but_one)
    alone = fu.sweep(square, {"x": [1], "y": [*range(30)]}, workers=0, progress=False)
    found = fu.sweep(square, {"x": [1], "y": [*range(30)]}, cluster=cluster, batch=4, progress=False)
    assert losses and found.drop_vars("seconds").identical(alone.drop_vars("seconds"))


def test_a_batch_that_fails_as_the_scheduler_is_lost_is_computed_again(cluster, monkeypatch):
    failures = []

    def finished_but_one(self, finished=module.DaskWorkers._finished):
        found = finished(self)
        if not failures:
            failures.append(found[0])
            found[0]._state.set_error(distributed.scheduler.KilledWorker(found[0].key, None, 1), None)
        return found

    def lost_with_it(self, future, batch, batches, lost):
        raise distributed.CancelledError("it is gone")

    monkeypatch.setattr(module.DaskWorkers, "_finished", finished_but_one)
    monkeypatch.setattr(module.DaskWorkers, "_dead", lost_with_it)
    alone = fu.sweep(square, {"x": [1], "y": [*range(30)]}, workers=0, progress=False)
    found = fu.sweep(square, {"x": [1], "y": [*range(30)]}, cluster=cluster, batch=4, progress=False)
    assert failures and found.drop_vars("seconds").identical(alone.drop_vars("seconds"))


def test_the_cost_counts_the_workers_of_the_cluster(cluster):
    told = []
    fu.sweep(square, {"x": [1], "y": [*range(30)]}, cluster=cluster, progress=False, on_cost=told.append)
    assert told[0].workers == 2
    fu.sweep(square, {"x": [1], "y": [*range(30)]}, progress=False, on_cost=told.append)
    assert told[1].workers == 1  # some ms of work, which no worker is started for


def test_batches_are_as_long_as_points_are_short():
    points = points_of({"x": [*range(100_000)]})
    for seconds, length in ((0.01, 50), (10.0, 1), (1e-6, 10_485)):
        assert Batches(points, np.arange(100_000), 400, 2, seconds).length == length
    batches = Batches(points, np.arange(100_000), 400, 2, 0.01)
    first = batches.take()
    batches.learn(50, 50 * 0.1)  # it took ten times as long
    assert 5 <= batches.length <= 7
    batches.give_back([first])
    numbers = [batch.numbers for batch in batches]
    assert numbers[0] is first.numbers and sorted(np.concatenate(numbers)) == list(range(100_000))


def free_port() -> int:
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        return free.getsockname()[1]


@pytest.mark.slow
def test_a_local_cluster_is_not_on_the_network():
    """Workers execute any code that reaches them."""
    import psutil

    with module.local_cluster(1):
        for process in (psutil.Process(), *psutil.Process().children(recursive=True)):
            for connection in process.net_connections():
                assert connection.status != "LISTEN" or connection.laddr.ip == "127.0.0.1"


@pytest.mark.slow
def test_scenes_on_worker_processes_as_in_a_loop(tmp_path):
    grid = GRID | {"A.mass": [1.0, 1.5, 2.0, 3.0]}
    alone = fu.sweep(scene(), grid, keep=KEPT, workers=0, progress=False)
    found = fu.sweep(scene(), grid, keep=KEPT, workers=2, save=tmp_path / "x.nc", progress=False)
    assert found.compute().drop_vars("seconds").identical(alone.drop_vars("seconds"))


@pytest.mark.slow
def test_a_worker_killed_in_the_middle_changes_nothing(tmp_path, subjects_found):
    found = fu.sweep(deadly, {"x": [*range(1, 60)], "folder": [str(tmp_path)]}, workers=2, batch=4, progress=False)
    assert (tmp_path / "died").exists()
    np.testing.assert_array_equal(found.twice.values.ravel(), 2.0 * np.arange(1, 60))


@pytest.mark.slow
def test_a_point_that_kills_its_worker_each_time_is_recorded(tmp_path, subjects_found):
    (tmp_path / "always").touch()
    found = fu.sweep(deadly, {"x": [*range(1, 60)], "folder": [str(tmp_path)]}, workers=2, batch=3, progress=False)
    failed = found.sel(x=5).isel(folder=0)
    assert failed.status == "failed" and "the worker process died while it computed this point" in str(failed.message)
    others = found.drop_sel(x=5)
    np.testing.assert_array_equal(others.twice.values.ravel(), 2.0 * others.x)


CHILD = """
import sys
sys.path.insert(0, sys.argv[1])
import funicular as fu
from sweep_subjects import counted
fu.sweep(counted, {"x": range(400), "folder": [sys.argv[2]]}, save=sys.argv[2] + "/x.nc", workers=2, batch=5)
"""


def descendants(pid: int) -> list[int]:
    import psutil

    return [child.pid for child in psutil.Process(pid).children(recursive=True)]


@pytest.mark.slow
def test_a_killed_sweep_goes_on_and_its_workers_end(tmp_path):
    workers: list[int] = []
    for least in (50, 200):
        running = subprocess.Popen([sys.executable, "-c", CHILD, str(HERE), str(tmp_path)])
        while running.poll() is None and finished(tmp_path / "x.nc") < least:
            time.sleep(0.05)
        workers += descendants(running.pid)
        running.kill()
        assert running.wait() == -signal.SIGKILL
        assert least <= finished(tmp_path / "x.nc") < 400
    while any(is_alive(pid) for pid in workers):
        time.sleep(0.1)
    before = finished(tmp_path / "x.nc")
    computed = len((tmp_path / "computed").read_text().split())
    found = fu.sweep(counted, {"x": range(400), "folder": [str(tmp_path)]}, save=tmp_path / "x.nc", workers=0, batch=5,
                     progress=False)
    np.testing.assert_array_equal(found.twice.values.ravel(), 2.0 * np.arange(400))
    again = len((tmp_path / "computed").read_text().split()) - computed
    assert again == 400 - before  # no point that was in the file


def finished(path: Path) -> int:
    return fu.load_sweep(path).attrs["finished"] if path.exists() else 0


def is_alive(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    return "Z" not in Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[:1]


class Cluster:
    """A scheduler and two worker processes, started as by hand."""

    def __init__(self, folder: Path):
        self.port, self.folder = free_port(), folder
        self.start()

    @property
    def address(self) -> str:
        return f"tcp://127.0.0.1:{self.port}"

    def start(self) -> None:
        environment = os.environ | {"PYTHONPATH": str(HERE)}
        own = {"env": environment, "stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL,
               "start_new_session": True}
        python = [sys.executable, "-m", "dask"]
        self.processes = [
            subprocess.Popen([*python, "scheduler", "--host", "127.0.0.1", "--port", str(self.port), "--no-dashboard",
                              "--dashboard-address", "127.0.0.1:0"],
                             **own),
            subprocess.Popen([*python, "worker", self.address, "--nworkers", "2", "--nthreads", "1", "--no-dashboard",
                              "--local-directory", str(self.folder)], **own)]

    def kill(self) -> None:
        for process in self.processes:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()


@pytest.mark.slow
def test_the_scheduler_is_restarted_in_the_middle(tmp_path):
    cluster = Cluster(tmp_path / "scratch")
    restarted = []

    def restart_once(done: int, failed: int) -> None:
        if done > 60 and not restarted:
            restarted.append(done)
            cluster.kill()
            cluster.start()

    try:
        found = fu.sweep(counted, {"x": range(200), "folder": [str(tmp_path)]}, cluster=cluster.address, batch=4,
                         save=tmp_path / "x.nc", progress=restart_once)
    finally:
        cluster.kill()
    assert restarted
    np.testing.assert_array_equal(found.twice.values.ravel(), 2.0 * np.arange(200))
    assert (found.status == "returned").all()


MEMORY = """
import resource, sys
sys.path.insert(0, {tests!r})
import numpy as np
import funicular as fu
def make(x):
    return {{"array": np.full(2000, x)}}
def peak():
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
fu.sweep(make, {{"x": fu.Uniform(0, 1)}}, method="random", samples={points}, save="{points}.nc", workers=0)
written = peak()
float(fu.load_sweep("{points}.nc")["array"][5, 7])
print(written, peak())
"""


@pytest.mark.slow
def test_memory_does_not_grow_with_points(tmp_path):
    """1,000 points are 16 MB of results, 12,000 are 190 MB; the mapped pages of the file must not hold all of them."""
    peaks = []
    for points in (1000, 12_000):
        code = MEMORY.format(tests=str(HERE), points=points)
        done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=True)
        peaks.append([float(word) for word in done.stdout.split()])
    assert os.path.getsize(tmp_path / "12000.nc") > 190e6
    assert peaks[1][0] < peaks[0][0] + 40 and peaks[1][1] < peaks[0][1] + 40
