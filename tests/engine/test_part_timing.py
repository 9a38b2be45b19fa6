"""The report contains the cost of slides and joints."""

import subprocess
import time
from pathlib import Path

import numpy as np
import pytest
from difficult_scenes import tied
from expectations import INTEGRATORS
from funicular import Scene
from funicular.derive.codegen import drift
from funicular.derive.verify.compiled import compiler
from funicular.engine import Engine
from funicular.integrators import GeneralisedAlpha
from funicular.model.build import build
from shared_scenes import one_rider
from test_joints import of_bodies


@pytest.mark.filterwarnings("ignore:initial velocities broke a joint")
@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_each_slide_and_joint_is_in_the_report(integrator):
    scene = tied()
    scene.joint("distance", ("link", 1.0), (1.1, -1, 1), name="stay")
    for _ in range(5):  # costs are elapsed time: on a busy machine something else may be among them
        run = scene.run(0.01, output_step=0.01, tol=1e-3, integrator=integrator)
        costs, report = run.report["us_per_step"], run.report
        assert set(costs) == {*scene.slides, *scene.joints}
        assert min(costs.values()) > 0
        if sum(costs.values()) < 1e6 * report["time_s"]["solve_cpu"] / report["steps"]:
            break
    else:
        pytest.fail("costs of slides and joints are more than all of a step")
    text = dict(run.summary_rows())["slides and joints"]
    assert text.startswith(f"{sum(costs.values()):.3g} µs of a step: ")
    assert max(costs, key=costs.__getitem__) in text and text.endswith("and 2 more")


def test_a_conserving_run_has_them_too():
    run = one_rider().run(0.02, step=1e-3, integrator="energy")
    assert run.report["us_per_step"]["trolley"] > 0


def test_without_slides_and_joints_there_is_none():
    scene = Scene()
    scene.rigid_body("A", mass=1.0, inertia=(1, 1, 1), position=(0, 0, 0))
    run = scene.run(0.1)
    assert run.report["us_per_step"] == {}
    assert "slides and joints" not in run.summary()


def test_timing_takes_little_and_changes_nothing():
    """A run with timed steps continues bit for bit."""
    ends, taken = [], []

    def look(_):
        begin = time.perf_counter()
        assert engine.costs().min() > 0
        taken.append(time.perf_counter() - begin)

    for after_each in (lambda _: None, look):
        engine = Engine(build(of_bodies("universal", axis=(0, 0, 1), second_axis=(1, 1, 0))))
        engine.start(duration=0.02, output_step=0.01, tol=1e-4, step=0.0, method=GeneralisedAlpha(0.8), first_step=1e-4)
        assert engine.advance(after_each, interval=0.0) == "completed"
        rows = engine.rows()
        ends.append(np.concatenate([rows[name][-1].ravel() for name in ("q", "v", "acceleration", "joint")]))
    assert (ends[0] == ends[1]).all()
    assert len(taken) > 10 and min(taken) < 1e-3  # measured: 0.25 ms


def test_an_interrupted_call_does_not_count(tmp_path):
    """An interruption of the first call of a coupling does not count: it once gave 56 ms instead of 4 µs."""
    program, here = tmp_path / "part_timing", Path(__file__).parent
    engine = here.parents[1] / "runtime" / "engine"
    subprocess.run([*compiler(), "-std=c11", "-Wall", "-Wextra", "-Wpedantic", "-Werror", f"-I{drift.folder()}",
                    f"-I{engine}", here / "part_timing.c", "-lm", "-o", program],
                   check=True)
    done = subprocess.run([program], capture_output=True, text=True, check=True)
    assert float(done.stdout) == pytest.approx(4e-6, rel=1e-6)


def test_an_engine_starts_once():
    """A second start would write rows beyond the arrays of the first one."""
    engine = Engine(build(one_rider()))
    settings = {"duration": 0.02, "output_step": 0.01, "tol": 1e-4, "step": 0.0, "method": GeneralisedAlpha(0.8),
                "first_step": 1e-4}
    for early in (lambda: engine.advance(lambda _: None), engine.checkpoint, lambda: engine.restore(b"", 0)):
        with pytest.raises(RuntimeError, match="has not started; call start first"):
            early()
    engine.start(**settings)
    with pytest.raises(RuntimeError, match="has started already; make another one of the model"):
        engine.start(**settings)
    assert engine.advance(lambda _: None) == "completed"
    assert len(engine.rows()["time"]) == 3
