"""Works in step: the order of stages, errors, the size of groups; and runs of sweeps, whose times are their own."""

import time
from functools import partial

import funicular as fu
import numpy as np
import pytest
from funicular.base.stages import StageClock, at_once
from funicular.results import recording
from funicular.sweeps import in_step as module
from funicular.sweeps.in_step import in_step
from funicular.sweeps.stored_points import Keep
from funicular.sweeps.subject import SceneSubject
from sweep_subjects import ALONE, SHORT, scene

MASSES = {"A.mass": [0.5 + 0.05 * k for k in range(24)]}


def work(name, done, size=0, error=None):
    """Note three stages, and return the name, or raise an error in the second one."""
    for stage in range(2):
        done.append((name, stage))
        yield size
        if error is not None:
            raise error
    done.append((name, 2))
    return name


def ended(names, done, **given):
    """Return the results of works in step."""
    return [end.result for end in in_step(partial(work, name, done, **given) for name in names)]


def test_a_stage_of_all_works_comes_before_the_next():
    done = []
    assert ended("abc", done) == ["a", "b", "c"]
    assert done == [(name, stage) for stage in range(3) for name in "abc"]
    assert at_once(work("d", done)) == "d" and done[-3:] == [("d", 0), ("d", 1), ("d", 2)]


def test_an_error_does_not_stop_the_others_but_an_interruption_does():
    done, error = [], ValueError("wrong")
    first, second = in_step([partial(work, "a", done, error=error), partial(work, "b", done)])
    assert first.result is error and second.result == "b"
    with pytest.raises(KeyboardInterrupt):
        ended("abc", done := [], error=KeyboardInterrupt())
    assert done == [(name, 0) for name in "abc"]


@pytest.mark.parametrize("given, limit, most", [
    ({}, {"MAX_GROUP": 3}, 3), ({"size": 10}, {"MAX_GROUP_BYTES": 15}, 2), ({}, {"MAX_GROUP_SECONDS": 0.0}, 1)])
def test_groups_are_limited(given, limit, most, monkeypatch):
    for name, value in limit.items():
        monkeypatch.setattr(module, name, value)
    done = []
    assert ended("abcdef", done, **given) == [*"abcdef"]
    assert done[:most + 1] == [*((name, 0) for name in "abcdef"[:most]), ("a", 1)]


def test_a_clock_leaves_out_the_time_between_stages():
    clock, begin = StageClock(of_thread=True), (time.perf_counter(), time.thread_time())
    own = clock.wall, clock.cpu
    for _ in clock.pause(0):
        while time.thread_time() < begin[1] + 0.02:
            pass
    own = clock.wall - own[0], clock.cpu - own[1]
    for each, since, now in zip(own, begin, (time.perf_counter(), time.thread_time()), strict=True):
        assert each < now - since - 0.019


def test_times_of_runs_in_step_are_their_own():
    begin = time.perf_counter()
    found = fu.sweep(scene(), MASSES, keep={"total": lambda run: run.report["time_s"]["total"]}, **ALONE)
    assert found["total"].values.sum() < found.seconds.values.sum() < time.perf_counter() - begin


def test_slides_are_timed_where_reports_are_read(monkeypatch):
    timed, costs = [], recording._costs
    monkeypatch.setattr(recording, "_costs", lambda *given: timed.append(given) or costs(*given))
    fu.sweep(scene(), MASSES, keep=["A.position"], **ALONE)
    [*fu.run_many([scene()], keep=["A.position"])]
    assert not timed
    assert next(fu.run_many([scene()])).report["us_per_step"]["trolley"] > 0
    found = fu.sweep(scene(), MASSES, keep={"cost": lambda run: run.report["us_per_step"]["trolley"]}, **ALONE)
    assert (found["cost"].values > 0).all() and len(timed) == 1 + len(MASSES["A.mass"])


def test_runs_in_step_are_those_of_their_scenes():
    """Two of the group leave the cable."""
    speeds = [1.0, 60.0, 1.5, -60.0, 2.0, 2.5]
    found = fu.sweep(scene(), {"A.velocity.x": speeds}, keep=["A.position"], **ALONE)
    for k, speed in enumerate(speeds):
        alone = scene().replace("A", velocity=(speed, 0.0, 0.0))
        try:
            run, status = alone.run(**SHORT), "completed"
        except fu.EndOfCableError as error:
            run, status = error, "failed"
        assert found.status.values[k] == status
        if status == "failed":
            assert str(found.message.values[k]) == str(run)
        else:
            assert np.array_equal(found["A.position"].values[k], run["A.position"])


def test_an_interrupted_run_ends_those_in_step_with_it():
    """The runs after it in its group do not go on."""
    reached = []

    def watch(time):
        reached.append(time)
        raise KeyboardInterrupt

    subject = SceneSubject.of(scene(), [*MASSES], Keep.of(["A.position"]))
    with pytest.raises(KeyboardInterrupt):
        subject.compute([{"A.mass": mass} for mass in MASSES["A.mass"][:8]], watch)
    assert len(reached) == 1
