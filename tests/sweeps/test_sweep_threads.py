"""Sweeps of scenes on threads: results equal those of this process alone, and an interrupted sweep ends its runs."""

import threading
import warnings

import funicular as fu
import pytest
from funicular.sweeps import subject
from funicular.sweeps import sweep as module
from funicular.sweeps.abandonment import Abandoned, Abandonment
from funicular.sweeps.silence import silence
from funicular.sweeps.thread_workers import ThreadWorkers
from funicular.sweeps.workers import workers_of
from sweep_subjects import GRID, KEPT, SHORT, same, scene, square

MASSES = {"A.mass": [0.5 + 0.05 * k for k in range(24)]}


@pytest.fixture
def no_processes(monkeypatch):
    """Refuse to start processes."""
    monkeypatch.setattr(module, "workers_of", None)
    return monkeypatch


@pytest.mark.parametrize("threads", [1, 2, 5])
def test_on_threads_as_alone(threads, no_processes):
    done = []
    found = fu.sweep(scene(), GRID | MASSES, keep=KEPT, workers=threads, batch=3,
                     progress=lambda count, failed: done.append((count, failed)))
    assert done[-1] == (144, 0) and ("ignore", None, Warning, None, 0) not in warnings.filters
    no_processes.setattr(module, "workers_of", workers_of)
    assert same(found, fu.sweep(scene(), GRID | MASSES, keep=KEPT, workers=0, progress=False))


def test_a_point_that_fails_does_not_stop_the_others(no_processes):
    found = fu.sweep(scene(), {"A.velocity.x": [1.0, 60.0, *(1.1 + 0.1 * k for k in range(10))]}, keep=["A.position"],
                     duration=0.03, workers=2, batch=1, progress=False)
    assert [status for status in found.status.values] == ["completed", "failed", *["completed"] * 10]
    assert "ran off the end" in str(found.message.values[1])


def test_short_work_of_scenes_takes_threads_and_functions_do_not(no_processes):
    told = []
    fu.sweep(scene(), MASSES, keep=KEPT, workers=3, progress=False, on_cost=told.append)
    assert told[0].workers == 3
    with pytest.raises(TypeError):  # it asks for processes
        fu.sweep(square, {"x": [1], "y": [*range(30)]}, workers=3, progress=False)


def test_long_work_takes_processes(monkeypatch):
    asked = []

    def processes(number, cluster):
        asked.append((number, cluster))
        return workers_of(0, None)

    monkeypatch.setattr(module, "workers_of", processes)
    monkeypatch.setattr(module, "PROCESSES_START_SECONDS", 0.0)
    fu.sweep(scene(), MASSES, keep=KEPT, workers=3, progress=False)
    assert asked == [(3, None)]


def test_an_interrupted_sweep_ends_its_runs(no_processes):
    """A run of a thousand seconds is under way when the first batch is done; the sample leaves it out."""
    def interrupt(done: int, failed: int) -> None:
        raise KeyboardInterrupt

    durations = [1e3 if k == 3 else 0.02 for k in range(15)]
    with pytest.warns(fu.FunicularWarning, match="interrupted; 9 of 15 points"):
        fu.sweep(scene(), {"run.duration": durations}, method="list", keep=["A.position.x"], output_step=0.02,
                 workers=2, batch=1, progress=interrupt)
    assert not [each for each in threading.enumerate() if each.name.startswith("funicular")]


def test_threads_end_where_a_task_fails():
    class Batches(list):
        def take(self):
            return self.pop() if self else None

    def task(batch, watch):
        raise fu.FunicularError("it fails")

    with pytest.raises(fu.FunicularError, match="it fails"):
        list(ThreadWorkers(2).compute(task, Batches([1, 2, 3]), None))
    assert not [each for each in threading.enumerate() if each.name.startswith("funicular")]


def test_silence_ends_with_its_last_context():
    """Two threads leave it in the order in which they entered."""
    before, entered, left = list(warnings.filters), threading.Event(), threading.Event()

    def first():
        with silence:
            entered.set()
            left.wait()

    other = threading.Thread(target=first)
    other.start()
    entered.wait()
    with silence:
        left.set()
        other.join()
        assert warnings.filters[0][0] == "ignore"
    assert warnings.filters == before


def test_abandoned_runs_raise():
    abandonment = Abandonment()
    abandonment.watch(0.0)
    abandonment.begin()
    with pytest.raises(Abandoned):
        fu.load_scene("paper51").run(**SHORT, progress=abandonment.watch)


def test_an_empty_scene_is_refused():
    with pytest.raises(fu.SceneError, match="is empty"):
        fu.sweep(fu.Scene(), {"gravity.y": [-1.0, -2.0]}, keep=["energy.kinetic"], duration=1.0)


def test_scenes_of_many_parts_are_made_again(monkeypatch):
    """They would take much memory."""
    expected = fu.sweep(scene(), MASSES, keep=KEPT, workers=0, progress=False)
    monkeypatch.setattr(subject, "MAX_KEPT_PARTS", 0)
    assert same(expected, fu.sweep(scene(), MASSES, keep=KEPT, workers=0, progress=False))
