"""The work of setting up a run, counted in calls; unneeded work is not done.

tests/benchmarks/setup.py prints the same calls with their times.
"""

import funicular as fu
import numpy as np
import pytest
from funicular import load_scene
from funicular.base.rotations import cross, rotate
from funicular.engine import Engine
from funicular.model.build import build
from funicular.model.redundant_constraints import _in_loops
from funicular.solve.motion import integrator_choice
from setup import bodies, calls, rope, set_up

CEILINGS = {"paper51": (3230, 1200), "cable_car": (7130, 3720), "zip_line": (5220, 2470)}
"""Calls of Python and C functions that it takes to make a scene and to set its run up, up to an eleventh above those
counted; a ceiling moves up only on purpose.
"""
RUN_CEILINGS = {"paper51": 1950}
"""The same of a whole run with one of its results read, and with its notes."""


def count(make):
    """Return the calls that make a scene and set up its run, after all late imports."""
    scene = make()
    set_up(lambda: scene)
    return calls(make), calls(lambda: set_up(lambda: scene))


@pytest.mark.parametrize("name", CEILINGS)
def test_set_up_takes_few_calls(name):
    for counted, ceiling in zip(count(lambda: load_scene(name)), CEILINGS[name], strict=True):
        assert counted <= ceiling


@pytest.mark.parametrize("name", RUN_CEILINGS)
def test_a_run_takes_few_calls(name):
    scene = load_scene(name)

    def run():
        made = scene.run(0.1, output_step=0.01, tol=1e-3, integrator="genalpha", progress=False)
        return made["A.position"]

    run()
    assert calls(run) <= RUN_CEILINGS[name]


def test_set_up_is_linear_in_bodies_and_joints():
    few, many = (count(lambda n=n: bodies(n)) for n in (15, 60))
    for one, other in zip(few, many, strict=True):
        assert other <= 4.5 * one  # four times as many bodies


def test_set_up_takes_no_more_than_a_node_for_each_element():
    few, many = (count(lambda n=n: rope(n)) for n in (150, 600))
    assert many[0] == few[0] and many[1] <= few[1] + 4 * 450


def ring(tail: int = 0) -> fu.Scene:
    """Return a ring of four bodies with a chain at the first one."""
    scene = fu.Scene()
    for k, at in enumerate([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), *((-1 - k, 0, 0) for k in range(tail))]):
        scene.rigid_body(f"b{k}", mass=1, inertia=(1, 1, 1), position=at)
    for a, b in ((0, 1), (1, 2), (2, 3), (3, 0), *((0 if k == 0 else 3 + k, 4 + k) for k in range(tail))):
        one, other = (np.array(scene.bodies[f"b{k}"].position) for k in (a, b))
        scene.joint("spherical", (f"b{a}", (other - one) / 2), (f"b{b}", (one - other) / 2))
    return scene


def in_loops(scene):
    """Return the multipliers of joints and slides among which redundant constraints are sought."""
    return _in_loops(build(scene), two_riders=False).tolist()


def test_redundant_constraints_are_sought_in_loops_alone():
    assert in_loops(bodies(5)) == []
    assert in_loops(ring()) == list(range(12))
    assert in_loops(ring(tail=3)) == list(range(12))


def test_links_with_a_cable_may_follow_from_others():
    """Supports may fix both ends of a connection between two cables; a body that hangs from one cable is free."""
    scene = rope(4)
    scene.rigid_body("load", mass=1, inertia=(1, 1, 1), position=(0.4, 0, 0))
    scene.joint("spherical", ("rope", 0.4), "load")
    assert in_loops(scene) == []
    scene.joint("spherical", ("rope", 0.2), (0.2, 0, 0))
    assert in_loops(scene) == [3, 4, 5]


@pytest.mark.parametrize("name", ["paper51", "cable_car"])
def test_rates_by_sparse_matrices_are_those_by_arrays(name, monkeypatch):
    model = build(load_scene(name))
    monkeypatch.setattr(integrator_choice, "MAX_DENSE_UNKNOWNS", 10**9)
    by_arrays = integrator_choice.fastest_rates(model, Engine(model))
    monkeypatch.setattr(integrator_choice, "MAX_DENSE_UNKNOWNS", 0)
    assert integrator_choice.fastest_rates(model, Engine(model)) == pytest.approx(by_arrays, rel=1e-9)


def test_what_is_not_damped_has_no_rate_of_decay(monkeypatch):
    """The damping is zero, without evaluation, where the model has none."""
    model = build(load_scene("paper51"))
    assert not model.is_damped
    monkeypatch.setattr(type(model), "is_damped", True)
    assert integrator_choice.fastest_rates(model, Engine(model))[1] == 0.0


def test_the_text_of_a_run_is_that_of_the_scene_as_it_was_run():
    scene = bodies(1)
    run, text = scene.run(1e-3, progress=False), scene.to_toml()
    scene.rigid_body("later", mass=1, inertia=(1, 1, 1), position=(5, 0, 0))
    assert run.scene_toml == text != scene.to_toml()


def test_the_report_has_a_part_for_all_that_takes_time():
    for integrator in ("explicit", "radau", "genalpha", "energy"):
        seconds = load_scene("paper51").run(0.05, integrator=integrator, progress=False).report["time_s"]
        parts = {"set_up", "start", "residual", "factorisation", "solve", "step", "error", "output", "results"}
        assert parts | {"total", "solve_cpu"} == set(seconds)
        assert min(seconds.values()) >= 0.0 and seconds["residual"] > 0.0 < seconds["error"]
        assert sum(seconds[part] for part in parts) <= seconds["total"]


def test_no_time_is_counted_twice_where_an_integrator_is_on_trial():
    """The steps of a trial count as steps of the run; discarded steps count as its start."""
    scene = load_scene("paper51")
    run = scene.run(0.5, tol=1e-4, step=None, progress=False)
    assert "on trial" in run.report["integrator_reason"] or run.report["integrator"] == "radau"
    seconds = run.report["time_s"]
    assert sum(each for part, each in seconds.items() if part not in ("total", "solve_cpu")) <= seconds["total"]


def test_vector_products_are_those_of_numpy():
    one, other = np.random.default_rng(0).normal(size=(2, 7, 4, 3))
    one[0] = 0.0
    assert np.array_equal(cross(one, other), np.cross(one, other))
    assert np.array_equal(cross(one[1, 1], other), np.cross(one[1, 1], other))
    assert np.array_equal(cross((1.0, 2.0, 3.0), (0.5, -1.0, 2.0)), np.cross((1.0, 2.0, 3.0), (0.5, -1.0, 2.0)))


def test_one_vector_is_turned_like_many():
    vectors, quaternions = np.random.default_rng(1).normal(size=(5, 3)), np.random.default_rng(2).normal(size=(5, 4))
    turned = rotate(quaternions, vectors)
    for quaternion, vector, expected in zip(quaternions, vectors, turned, strict=True):
        assert np.array_equal(rotate(tuple(quaternion.tolist()), tuple(vector.tolist())), expected)
