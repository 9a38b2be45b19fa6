"""A simulation in steps has the bits of a run, takes inputs, and returns to its states."""

import gc
import threading
import weakref
from itertools import pairwise

import funicular as fu
import numpy as np
import pytest
from choice_scenes import SCENES
from difficult_scenes import jointed, modal_in_joints, planar, resisted
from funicular.parts.inputs import INPUTS
from shared_scenes import cable_scene, one_rider

pytestmark = pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")

MASS, G = 2.0, 9.81
SETTINGS = {"duration": 0.05, "tol": 1e-3, "output_step": 0.005}
METHODS = ("radau", "genalpha", "explicit", "energy")

MADE = {
    "rider": one_rider, "planar": planar, "joints": jointed, "modal joints": modal_in_joints, "friction": resisted,
    "stick": SCENES["stick"].make, "hard stop": SCENES["hard stop"].make, "buffer": SCENES["buffer"].make,
}


def cart(**force) -> fu.Scene:
    """Return a body on a rail along x, with a force along it, and one across it."""
    scene = fu.Scene(gravity=(0, -G, 0))
    scene.rigid_body("cart", mass=MASS, inertia=(1.0, 1.0, 1.0), position=(0, 0, 0))
    scene.joint("prismatic", (0, 0, 0), "cart", axis=(1, 0, 0), name="rail")
    scene.force("cart", name="push", **{"value": (0.0, 3.0, 0.0), **force})
    return scene


def assert_same(run: fu.Run, other: fu.Run):
    assert [*run.keys()] == [*other.keys()] and run.time.tobytes() == other.time.tobytes()
    for name, values in run.items():
        assert other[name].tobytes() == values.tobytes(), name
    for fact in ("steps", "rejected_steps", "newton_iterations", "factorisations", "integrator", "integrator_reason",
                 "events", "status", "messages"):
        assert other.report[fact] == run.report[fact], fact


@pytest.mark.parametrize("made", MADE)
@pytest.mark.parametrize("integrator", ["auto", *METHODS])
def test_bits_of_a_run(made, integrator):
    settings = SETTINGS | {"integrator": integrator}
    try:
        run = MADE[made]().run(**settings)
    except fu.SceneError as refused:
        with pytest.raises(fu.SceneError) as also:
            MADE[made]().simulation(**settings)
        assert str(also.value) == str(refused)
        return
    assert_same(run, MADE[made]().simulation(**settings).run())
    sim = MADE[made]().simulation(**settings)
    for k in range(1, 6):
        sim.step(SETTINGS["output_step"])
        assert sim.time == run.time[k]
        for name in sim.keys():
            assert sim[name].tobytes() == run[name][k].tobytes(), name


@pytest.mark.slow
@pytest.mark.parametrize("name", fu.bundled_scenes())
def test_bits_of_a_run_of_each_bundled_scene(name):
    scene = fu.load_scene(name)
    settings = {} if "duration" in scene.run_settings else {"duration": 0.5}
    assert_same(scene.run(**settings, progress=False), fu.load_scene(name).simulation(**settings).run())


@pytest.mark.parametrize("made", MADE)
@pytest.mark.parametrize("integrator", METHODS)
def test_states_are_returned_to_with_the_same_bits(made, integrator):
    """Also over events, unequal steps, and a later end; a state that is kept changes nothing."""
    def rows(sim: fu.Simulation, steps) -> list[bytes]:
        found = []
        for length in steps:
            sim.step(length)
            found.append(b"".join(sim[name].tobytes() for name in sim.keys()))
        return found

    settings = {"tol": 1e-3, "integrator": integrator, "duration": 0.03, "output_step": 0.01}
    try:
        sim = MADE[made]().simulation(**settings)
    except fu.SceneError as refused:
        with pytest.raises(fu.SceneError) as also:
            MADE[made]().run(**settings)
        assert str(also.value) == str(refused)
        return
    before, after = (0.004, 0.004, 0.0017), (0.003, 0.01, 0.01, 0.02)
    through = rows(MADE[made]().simulation(**settings), before + after)
    assert rows(sim, before) == through[:3]
    kept, events = sim.state, sim.events
    assert rows(sim, after) == through[3:]
    happened = sim.events
    for _ in range(2):
        sim.state = kept
        assert sim.time == kept.time == pytest.approx(sum(before)) and sim.events == events
        assert rows(sim, after) == through[3:] and sim.events == happened


@pytest.mark.parametrize("settings", [{"tol": 1e-6}, {"step": 1e-3}, {"tol": 1e-6, "integrator": "radau"},
                                      {"tol": 1e-6, "integrator": "explicit"}])
@pytest.mark.parametrize("scale", [1.0, 2.0])
def test_a_held_force_in_closed_form(settings, scale):
    sim = cart(scale=scale).simulation(["push.value.x"], **settings)
    position = velocity = work = 0.0
    for force in (3.0, 0.0, -5.0, 1.0):
        sim["push.value.x"] = force
        assert sim.inputs == {"push.value.x": force} and sim["push.value.x"] == force
        sim.step(0.1)
        a = scale * force / MASS
        moved = velocity * 0.1 + a * 0.1**2 / 2
        position, velocity, work = position + moved, velocity + 0.1 * a, work + scale * force * moved
        assert sim["cart.position"][0] == pytest.approx(position, abs=1e-12)
        assert sim["cart.velocity"][0] == pytest.approx(velocity, abs=1e-12)
        assert sim["energy.external"] == pytest.approx(work, abs=1e-10)
        assert sim["rail.force"][1] == pytest.approx(MASS * G - 3.0 * scale, rel=1e-12)  # the other component stays


def test_a_force_that_rises_at_a_rate():
    sim = cart().simulation(["push.value.x"], tol=1e-8)
    sim.set("push.value.x", 2.0, rate=30.0)
    for _ in range(4):
        sim.step(0.05)
    assert sim["push.value.x"] == pytest.approx(2.0 + 30.0 * 0.2)
    assert sim["cart.velocity"][0] == pytest.approx((2.0 * 0.2 + 30.0 * 0.2**2 / 2) / MASS, rel=1e-9)
    assert sim["cart.position"][0] == pytest.approx((2.0 * 0.2**2 / 2 + 30.0 * 0.2**3 / 6) / MASS, rel=1e-9)


@pytest.mark.parametrize("integrator", ["radau", "genalpha", "explicit"])
def test_an_input_is_the_signal_of_the_same_values(integrator):
    """A force by steps, on a hanging wire with a rider, as one run with a table of these values."""
    values = [1.0, 4.0, -2.0, 0.0]
    times = [0.0, 0.01, 0.02, 0.03]
    table = fu.TableSignal(time=[0.0, *(t + d for t in times[1:] for d in (0.0, 1e-9))],
                           value=[values[0], *(v for pair in pairwise(values) for v in pair)], interpolation="linear")

    def made(scale):
        scene = one_rider(elements=2)
        scene.force("A", value=(0.0, 5.0, 2.0), scale=scale, name="push")
        return scene

    run = made(table).run(0.04, output_step=0.01, tol=1e-7, integrator=integrator)
    sim = made(1.0).simulation(["push.scale"], tol=1e-7, duration=0.04, output_step=0.01, integrator=integrator)
    for k, value in enumerate(values, 1):
        sim["push.scale"] = value
        sim.step()
        for name, tolerance in {"A.position": 2e-7, "wire.position": 2e-7, "trolley.s": 2e-7,
                                "energy.external": 1e-6}.items():
            assert sim[name] == pytest.approx(run[name][k], abs=tolerance), name


DRIVES = {
    "velocity of a joint": ("rail", {"velocity": 0.0}, "rail.velocity", 0.8, lambda t: 0.8 * t),
    "distance of a joint": ("rail", {"distance": 0.0}, "rail.distance", 0.2, lambda t: 0.2 * min(t, 0.1) / 0.1),
}


@pytest.mark.parametrize("case", DRIVES)
@pytest.mark.parametrize("integrator", METHODS[:3])
def test_driven_joints(case, integrator):
    """A velocity is held; a position is reached at the end of the step."""
    part, given, path, value, place = DRIVES[case]
    scene = cart().replace(part, **given)
    sim = scene.simulation([path], step=1e-3, integrator=integrator)
    sim[path] = value
    for k in range(1, 4):
        sim.step(0.1)
        assert sim["cart.position"][0] == pytest.approx(place(0.1 * k), abs=1e-9)
    kinetic = MASS * sim["cart.velocity"][0] ** 2 / 2
    assert sim["energy.external"] - 3.0 * sim["cart.position"][1] == pytest.approx(kinetic, abs=1e-9)


def test_a_support_that_moves_and_a_fluid_that_flows():
    scene = cable_scene(pins=(), elements=2, element="cable12", gravity=(0, 0, 0))
    scene.motion("wire", s=0.0, displacement=(0.0, 0.0, 0.0))
    scene.fluid("wind", density=1.2, velocity=(0.0, 0.0, 0.0))
    scene.drag("wire", fluid="wind", normal=1.0, diameter=0.02, name="drag")
    sim = scene.simulation(["wire@0.displacement.1", "wind.velocity.z"], tol=1e-5)
    sim["wire@0.displacement.1"] = 0.01
    sim.step(0.02)
    assert sim["wire.position"][0] == pytest.approx([0.0, 0.01, 0.0], abs=1e-12)
    assert abs(sim["drag.force"][2]) < 1e-15
    sim["wind.velocity.z"] = 20.0
    sim.step(1e-3)
    assert sim["drag.force"][2] > 0.01
    sim.step(0.02)
    assert sim["wire.position"][0] == pytest.approx([0.0, 0.01, 0.0], abs=1e-12)


def test_inputs_in_a_plane_that_is_turned():
    """A factor is an input there; one component alone would leave the plane."""
    def pendulum(factor: float) -> fu.Scene:
        scene = fu.Scene(gravity=(0, -G, 0))
        scene.cable("rod", start=(0, 0, 0), end=(0.6, -0.5, 0.8), elements=2, element="cable8p",
                    section=fu.Circle(radius=0.01),
                    material=fu.Material(youngs_modulus=1e8, poisson_ratio=0.3, density=2000.0))
        scene.pin("rod", s=0.0)
        scene.force("rod", s=scene.cables["rod"].length, value=(3.0, 1.0, 4.0), scale=factor, name="push")
        return scene

    sim = pendulum(0.0).simulation(["push.scale"], tol=1e-6, integrator="radau")
    sim["push.scale"] = 2.0
    sim.step(0.05)
    run = pendulum(2.0).run(0.05, tol=1e-6, integrator="radau")
    assert sim["rod.position"] == pytest.approx(run["rod.position"][-1], abs=1e-7)
    with pytest.raises(fu.SceneError, match="leaves the plane"):
        pendulum(1.0).simulation(["push.value.x"])


def test_steps_of_any_length_and_no_known_end():
    sim = cart().simulation(["push.value.x"], tol=1e-6)
    sim["push.value.x"] = 2.0
    for length in (1e-9, 1e-3, 100.0):
        sim.step(length)
    assert sim.time == pytest.approx(100.001000001, rel=1e-15)
    assert sim["cart.position"][0] == pytest.approx(0.5 * sim.time**2, rel=1e-9)
    with pytest.raises(fu.SceneError, match="no known end"):
        sim.run()
    with pytest.raises(fu.SceneError, match=r"not above .* of the duration"):
        sim.step(1e-10)
    run = sim.run(duration=120.0)
    assert run.time[0] == pytest.approx(100.001000001) and run.time[-1] == 120.0 and run.status == "completed"
    with pytest.raises(fu.SceneError, match="already"):
        sim.run(duration=120.0)


def test_a_signal_goes_on_beyond_the_first_end():
    """One jumps at that end, one after it."""
    pulse = fu.TableSignal(time=[0.0, 1.0, 1.0 + 1e-9, 1.5, 1.5 + 1e-9], value=[1.0, 1.0, 3.0, 3.0, 0.0],
                           interpolation="linear")
    scene = cart(value=(MASS, 0.0, 0.0), scale=pulse)
    sim = scene.simulation(duration=1.0, output_step=0.5, tol=1e-9)
    for _ in range(4):
        sim.step()
    assert sim.time == 2.0
    assert sim["cart.velocity"][0] == pytest.approx(1.0 + 3.0 * 0.5, abs=1e-7)


def test_an_event_stops_it_and_another_switches_a_load():
    scene = cart(value=(MASS, 0.0, 0.0))
    scene.force("cart", value=(2 * MASS, 0.0, 0.0), when="near", name="more")
    scene.event("near", quantity="cart.position.x", value=0.5, action="record")
    scene.event("far", quantity="cart.position.x", value=2.0, action="stop")
    sim = scene.simulation(["push.value.x"], tol=1e-8)
    sim.step(0.9)
    kept = sim.state
    sim.step(10.0)
    assert sim.status == "event" and [each["name"] for each in sim.events] == ["near", "far"]
    end = 1.0 + (-1.0 + np.sqrt(1.0 + 2 * 3.0 * 1.5)) / 3.0
    assert sim.time == pytest.approx(end, abs=1e-7)
    with pytest.raises(fu.SceneError, match=r'has ended .* stopped by event "far"'):
        sim.step(0.1)
    sim.state = kept
    assert sim.status == "running" and sim.events == []
    sim["push.value.x"] = -10 * MASS
    sim.step(2.0)
    assert [each["name"] for each in sim.events] == [] and sim.status == "running"
    sim.state = kept
    run = sim.run(duration=5.0)
    assert run.status == "event" and run.time[-1] == pytest.approx(end, abs=1e-7) and len(run.events) == 2


def test_errors_of_runs():
    sim = one_rider(s=1.4, speed=5.0, elements=2).simulation(tol=1e-3)
    with pytest.raises(fu.EndOfCableError, match="ran off the end") as error:
        sim.step(1.0)
    assert error.value.run.time[-1] == sim.time and sim.status == "end_of_cable"
    with pytest.raises(fu.SceneError, match="has ended"):
        sim.step(1.0)


def test_notes_of_runs():
    """Notes see every row."""
    run = MADE["friction"]().run(duration=0.08, output_step=0.001, tol=1e-3)
    sim = MADE["friction"]().simulation(tol=1e-3, duration=0.08, output_step=0.001)
    for _ in range(80):
        sim.step()
    for note in run.report["messages"]:
        assert note in sim.messages


BAD = {
    "a name": (["pull.value.x"], 'no part "pull"'),
    "an entry": (["push.valu.x"], 'no "valu"'),
    "a vector": (["push.value"], "is a vector"),
    "a component": (["push.value.w"], 'value has no "w"'),
    "a component of a number": (["push.scale.x"], 'scale has no "x"'),
    "a mass": (["cart.mass"], "no load, drive"),
    "gravity": (["gravity.y"], "no load, drive"),
    "a drive that is not there": (["rail.velocity"], "has no velocity there"),
    "twice": (["push.value.x", "push.value.x"], "twice"),
    "no text": ([3], "by its path"),
    "a setting": (["run.tol"], "no load, drive"),
}


@pytest.mark.parametrize("case", BAD)
def test_inputs_that_are_refused(case):
    paths, cause = BAD[case]
    with pytest.raises(fu.SceneError, match=cause):
        cart().simulation(paths)


def test_what_acts_over_time_is_no_input():
    switched = cart(when="near")
    switched.event("near", quantity="cart.position.x", value=0.5, action="record")
    rising = cart(scale=fu.Ramp(start=0, end=1))
    wind = cart()
    wind.fluid("wind", density=1.2, velocity=(1.0, 2.0, 0.0))
    for scene, path, cause in ((switched, "push.value.x", "with an event"), (rising, "push.value.x", "scale over time"),
                               (wind, "wind.velocity.x", "other components")):
        with pytest.raises(fu.SceneError, match=cause):
            scene.simulation([path])


@pytest.mark.parametrize(("call", "cause"), [
    (lambda sim: sim.step(-1.0), "positive"), (lambda sim: sim.step("1"), "number"),
    (lambda sim: sim.step(np.nan), "finite"),
    (lambda sim: sim.set("push.value.y", 1.0), "is no input"), (lambda sim: sim.set("push.value.x", "a"), "number"),
    (lambda sim: sim.set("push.value.x", np.inf), "finite"), (lambda sim: setattr(sim, "state", 3), "no state"),
    (lambda sim: setattr(sim, "state", cart().simulation().state), "no state")])
def test_calls_that_are_refused(call, cause):
    sim = cart().simulation(["push.value.x"], tol=1e-3)
    with pytest.raises(fu.SceneError, match=cause):
        call(sim)
    sim["push.value.x"] = 1
    sim.step(np.float64(0.1))
    assert sim["cart.position"][0] == pytest.approx(0.1**2 / 2 / MASS)


def test_settings_that_are_refused():
    for settings, cause in (({"tolerance": 1e-3}, '"tol"'), ({"save": "a.nc"}, "save"), ({"tol": -1.0}, "tol")):
        with pytest.raises(fu.SceneError, match=cause):
            cart().simulation(**settings)
    with pytest.raises(fu.UnknownResultError, match=r"cart\.position"):
        cart().simulation()["cart.positio"]


def test_simulations_do_not_meet():
    """Two of one scene in turn, and two on threads, have the numbers of each alone."""
    def pushed(sim: fu.Simulation, force: float, found: list) -> None:
        sim["push.value.x"] = force
        for _ in range(20):
            sim.step(0.01)
            found.append(sim["cart.position"][0])

    scene = cart()
    alone = {force: [] for force in (1.0, 2.0)}
    for force, found in alone.items():
        pushed(scene.simulation(["push.value.x"], tol=1e-5), force, found)
    one, other = (scene.simulation(["push.value.x"], tol=1e-5) for _ in range(2))
    one["push.value.x"], other["push.value.x"] = 1.0, 2.0
    turns = []
    for _ in range(20):
        one.step(0.01)
        other.step(0.01)
        turns.append((one["cart.position"][0], other["cart.position"][0]))
    assert turns == list(zip(*alone.values(), strict=True))
    threaded = {force: [] for force in alone}
    threads = [threading.Thread(target=pushed, args=(scene.simulation(["push.value.x"], tol=1e-5), force, found))
               for force, found in threaded.items()]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert threaded == alone


def test_memory_stays():
    """A simulation without a known end keeps few rows; one that is dropped is freed at once."""
    sim = cart().simulation(["push.value.x"], tol=1e-3)
    sim.step(1e-3)
    before = sim._stepping.engine.memory
    for k in range(300):
        sim["push.value.x"] = float(k % 3)
        sim.step(1e-3)
    assert sim._stepping.engine.memory == before
    gone = weakref.ref(sim._stepping)
    gc.disable()
    try:
        del sim
        assert gone() is None
    finally:
        gc.enable()


def test_each_kind_of_input_has_a_test():
    """A new entry in the list asks for one."""
    names = {(kind.__name__, entry) for kind, entries in INPUTS.items() for entry in entries}
    assert names >= {("Load", "value"), ("Fluid", "velocity"), ("Joint", "distance"), ("Motion", "displacement")}
