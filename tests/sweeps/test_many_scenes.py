"""fu.run_many has the bits of scene.run, for one shape and several, on any number of threads; failures stay separate.
"""

import gc
import threading
import weakref
from functools import partial

import difficult_scenes
import funicular as fu
import numpy as np
import pytest
from choice_scenes import SCENES
from funicular.engine import Engine
from funicular.solve.motion import run as solve_run
from funicular.sweeps import many_scenes
from setup import forget
from shared_scenes import cable_scene, one_rider
from sliding import sliding_mass

DURATION = 0.05
SETTINGS = {"duration": DURATION, "tol": 1e-3, "output_step": 0.01}


def variants(make, n: int = 3) -> list[fu.Scene]:
    """Return scenes of one shape whose gravity differs."""
    made = []
    for k in range(n):
        scene = make()
        scene.gravity = tuple(np.array(scene.gravity) * (1 + 0.1 * k))
        made.append(scene)
    return made


def assert_same_bits(run: fu.Run, alone: fu.Run):
    assert run.status == alone.status
    assert list(run.keys()) == list(alone.keys())
    for name, values in alone.items():
        assert run[name].tobytes() == values.tobytes(), name
    assert run.time.tobytes() == alone.time.tobytes()
    for count in ("steps", "rejected_steps", "evaluations", "newton_iterations", "factorisations", "integrator",
                  "messages", "events"):
        assert run.report[count] == alone.report[count], count
    reasons = [one.report["integrator_reason"].partition(" on trial ") for one in (run, alone)]
    assert reasons[0][:2] == reasons[1][:2]  # what a trial came to may be known from another scene


SHAPES = {
    "rider": partial(one_rider, elements=2),
    "planar": difficult_scenes.planar,
    "tied": difficult_scenes.tied,
    "joints": difficult_scenes.jointed,
    "modal body": difficult_scenes.modal,
    "modal joints": difficult_scenes.modal_in_joints,
    "friction": difficult_scenes.resisted,
    "stick": SCENES["stick"].make,
    "hard stop": SCENES["hard stop"].make,
    "buffer": SCENES["buffer"].make,
}


@pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")
@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.slow_cases("tied")
def test_bits_of_each_by_itself(shape):
    alone = [scene.run(**SETTINGS) for scene in variants(SHAPES[shape])]
    assert alone[0].time[-1] == DURATION
    together = list(fu.run_many(variants(SHAPES[shape]), threads=3, **SETTINGS))
    for run, expected in zip(together, alone, strict=True):
        assert_same_bits(run, expected)


@pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")
@pytest.mark.parametrize("threads", [1, 2, 7, None])
@pytest.mark.slow_cases("1", "7")
def test_mixed_shapes_in_order(threads):
    makers = [make for name in ("rider", "joints", "planar", "rider", "stick") for make in [SHAPES[name]]] * 2
    alone = [make().run(**SETTINGS) for make in makers]
    together = list(fu.run_many(makers, threads=threads, **SETTINGS))  # functions that return a scene
    for run, expected in zip(together, alone, strict=True):
        assert_same_bits(run, expected)


def falling_off() -> fu.Scene:
    return one_rider(s=1.49, speed=5.0, elements=2)


def misplaced() -> fu.Scene:
    return one_rider(s=7.0, elements=2)


def test_failures_are_alone():
    good = partial(one_rider, elements=2)
    results = list(fu.run_many([good, misplaced, good, falling_off, good], threads=2, **SETTINGS))
    alone = good().run(**SETTINGS)
    for k in (0, 2, 4):
        assert_same_bits(results[k], alone)
    assert isinstance(results[1], fu.SceneError)
    assert "7" in str(results[1])
    assert isinstance(results[3], fu.EndOfCableError)
    with pytest.raises(fu.EndOfCableError) as alone_error:
        falling_off().run(**SETTINGS)
    assert str(results[3]) == str(alone_error.value)
    assert results[3].run["A.position"].tobytes() == alone_error.value.run["A.position"].tobytes()
    assert results[3].__traceback__ is None


def test_short_scenes_in_groups(monkeypatch):
    """Groups grow once the time of a scene is known; failures stay separate there, too."""
    def recorded(works):
        groups.append(len(begun := [*works]))
        return in_step(begun)

    groups, in_step = [], many_scenes.in_step
    monkeypatch.setattr(many_scenes, "in_step", recorded)
    monkeypatch.setattr(many_scenes, "GROUP_SECONDS", 10.0)
    makers = [partial(one_rider, elements=2, speed=1.0 + 0.1 * k) for k in range(20)]
    makers[9], makers[13] = misplaced, falling_off
    results = [*fu.run_many(makers, threads=1, **SETTINGS)]
    assert max(groups) > 9
    for k, (make, result) in enumerate(zip(makers, results, strict=True)):
        if k in (9, 13):
            assert type(result) is {9: fu.SceneError, 13: fu.EndOfCableError}[k] and result.__traceback__ is None
        else:
            assert_same_bits(result, make().run(**SETTINGS))


def test_kept_arrays_alone():
    run = one_rider(elements=2).run(**SETTINGS)
    (kept,) = fu.run_many([one_rider(elements=2)], keep=["A.position", "trolley.s"], **SETTINGS)
    assert set(kept) == {"time", "A.position", "trolley.s"}
    for name in ("A.position", "trolley.s"):
        assert kept[name].tobytes() == run[name].tobytes()
    (error,) = fu.run_many([one_rider(elements=2)], keep=["B.position"], **SETTINGS)
    assert isinstance(error, fu.UnknownResultError)


def test_memory_does_not_grow_with_their_number():
    """Scenes are taken as results are requested, and none is kept afterwards."""
    taken, alive = 0, weakref.WeakSet()

    def endless():
        nonlocal taken
        while True:
            taken += 1
            scene = cable_scene(pins=(0,), elements=1, element="cable12")
            alive.add(scene)
            yield scene

    results = fu.run_many(endless(), threads=2, keep=["wire.position"], duration=0.01, output_step=0.005)
    assert taken == 0
    in_advance = 2 * many_scenes.GROUPS_PER_THREAD * many_scenes.MAX_GROUP
    for k, kept in zip(range(3 * in_advance), results, strict=False):
        assert kept["wire.position"].shape == (3, 2, 3)
        assert taken <= k + 1 + in_advance
        assert len(alive) <= in_advance + 4
    results.close()
    assert not [t for t in threading.enumerate() if t.name.startswith("funicular")]


@pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")
@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.slow_cases("tied")
def test_a_run_is_freed_as_its_last_reference_goes(shape):
    """Its engine has no cycle, which Python's collector would leave for long: it counts objects, not their bytes."""
    def engines() -> int:
        return sum(type(each) is Engine for each in gc.get_objects())

    gc.collect()
    before, scene = engines(), SHAPES[shape]()
    freed = weakref.ref(scene)
    gc.disable()
    try:
        run = scene.run(**SETTINGS)
        assert run.status
        del run
        assert engines() == before
        del scene
        assert freed() is None
    finally:
        gc.enable()


def test_what_is_left_is_given_up_at_once():
    """Abandoned runs end at once."""
    def pendulum(duration: float) -> fu.Scene:
        scene = cable_scene(pins=(0,), elements=1, element="cable12")
        scene.run_settings = {"duration": duration, "step": 1e-3, "output_step": duration / 10}
        return scene

    durations = [0.01, 1e6, 1e6, 1e6, 1e6, 1e6]
    for run in fu.run_many([partial(pendulum, duration) for duration in durations], threads=1):
        assert run.time[-1] == 0.01
        break
    assert not [thread for thread in threading.enumerate() if thread.name.startswith("funicular")]


def test_other_errors_end_the_iteration():
    def broken():
        raise ZeroDivisionError

    for before in (1, 8):  # the latter in a group of several
        good = [partial(one_rider, elements=2)] * before
        results = fu.run_many([*good, broken, *good], threads=2, **SETTINGS)
        for _ in good:
            assert isinstance(next(results), fu.Run)
        with pytest.raises(ZeroDivisionError):
            next(results)
        assert list(results) == []


@pytest.mark.parametrize(("given", "message"), [
    ({"save": "many.nc"}, "save"), ({"resume": True}, "resume"), ({"progress": True}, "progress"),
    ({"tol": -1.0}, "tol"), ({"tolerance": 1e-3}, "tolerance"), ({"threads": 0}, "threads"),
    ({"threads": 1.5}, "threads"), ({"keep": "A.position"}, "keep")])
def test_settings_that_no_scene_takes_are_refused_at_once(given, message):
    with pytest.raises(fu.SceneError, match=message):
        fu.run_many([one_rider(elements=2)], duration=0.1, **given)


def test_what_is_no_scene():
    with pytest.raises(fu.SceneError, match="many scenes"):
        fu.run_many(one_rider(elements=2), duration=0.1)
    (error,) = fu.run_many([3], duration=0.1)
    assert isinstance(error, fu.SceneError)
    assert "not a scene" in str(error)


def test_a_file_of_one_run():
    scene = one_rider(elements=2)
    scene.run_settings = {"duration": 0.1, "save": "one.nc"}
    (error,) = fu.run_many([scene])
    assert isinstance(error, fu.SceneError)
    assert "save" in str(error)


def test_cpu_time_is_that_of_one_scene(monkeypatch):
    """The clock of the process would include the other threads."""
    monkeypatch.setattr("funicular.base.stages.time.process_time", lambda: pytest.fail("the clock of the process"))
    (run,) = fu.run_many([partial(one_rider, elements=2)], **SETTINGS)
    assert 0.0 < run.report["time_s"]["solve_cpu"] < run.report["time_s"]["total"]


LOST = {"duration": 0.15, "tol": 1e-5, "output_step": 0.01}
"""Settings with which radau loses its trial in the scene "buckling"."""


def counted_trials(monkeypatch) -> list[str]:
    """Return a list that records the name of each method on trial."""
    tried = []

    def on_trial(engine, rival, method, *others, **more):
        tried.append(method.name)
        return given(engine, rival, method, *others, **more)

    given = solve_run.on_trial
    monkeypatch.setattr(solve_run, "on_trial", on_trial)
    return tried


@pytest.mark.parametrize("threads", [1, 3])
def test_a_method_that_lost_with_the_first_scene_is_not_tried_again(threads, monkeypatch):
    scenes = variants(SCENES["buckling"].make, 5)
    alone = [scene.run(**LOST) for scene in scenes]
    assert all(one.report["integrator"] == "explicit" for one in alone)
    tried = counted_trials(monkeypatch)
    together = list(fu.run_many(scenes, threads=threads, **LOST))
    assert tried == ["radau"]
    assert_same_bits(together[0], alone[0])
    for one, expected in zip(together[1:], alone[1:], strict=True):
        assert one.report["integrator"] == "explicit"
        assert one.report["integrator_reason"].endswith("radau on trial lost in the first scene, which has the same "
                                                        "shape")
        for name, values in expected.items():
            assert one[name].tobytes() == values.tobytes(), name


def test_other_shapes_and_dearer_scenes_have_their_own_trials(monkeypatch):
    make = SCENES["buckling"].make
    first, cable = make(), next(iter(make().cables.values()))
    finer = first.replace(cable.name, elements=cable.elements + 2)
    stiffer = first.replace(cable.name, material=fu.Material(**cable.material.entries() | {
        "youngs_modulus": 16 * cable.material.youngs_modulus}))
    tried = counted_trials(monkeypatch)
    list(fu.run_many([first, finer, stiffer, first], threads=2, **LOST))
    assert tried == ["radau"] * 3


@pytest.mark.parametrize("integrator", ["genalpha", "radau"])
def test_a_run_keeps_its_bits_after_runs_of_its_shape(integrator):
    """Arrays of equal cables and of the topology are kept; those of other cables and of another topology are not used.
    """
    def positions(elements: int, mass: float, density: float) -> np.ndarray:
        scene = sliding_mass(elements, mass=mass).replace("wire", material=fu.Material(
            youngs_modulus=0.4e9, poisson_ratio=0.0, density=density))
        return scene.run(0.05, tol=1e-3, integrator=integrator, progress=False)["A.position"]

    variants = [(3, 1.0, 4200.0), (3, 2.0, 4200.0), (3, 1.0, 5000.0), (4, 1.0, 4200.0)]
    alone = []
    for variant in variants:
        forget()
        alone.append(positions(*variant))
    assert all(np.array_equal(positions(*variant), each) for variant, each in zip(variants, alone, strict=True))
    assert len({each.tobytes() for each in alone}) == len(variants)
