"""Events: instants that are found and stepped to, recorded or ending the run."""

import funicular as fu
import numpy as np
import pytest
from funicular.scene.file import loads
from shared_scenes import add_rider, cable_scene

G = 9.81
INTEGRATORS = ("genalpha", "explicit")


def falling() -> fu.Scene:
    """Return a body thrown up: y = 3 t - g t^2 / 2, x = 2 t."""
    scene = fu.Scene()
    scene.rigid_body("A", mass=2.0, inertia=(0.1, 0.2, 0.3), position=(0, 0, 0), velocity=(2, 3, 0),
                     angular_velocity=(0.0, 0.0, 5.0))
    return scene


def riding() -> fu.Scene:
    """Return a body that slides over nodes of a soft cable."""
    scene = cable_scene(length=10, pins="ends", elements=6, element="cable12",
                        material=fu.Material(youngs_modulus=2e6, density=1000, poisson_ratio=0.0))
    add_rider(scene, 2.0, 4, mass=5.0, inertia=(0.1, 0.2, 0.3), position=(2, 0, 0))
    return scene


def roots(height: float) -> list[float]:
    """Return the times at which the thrown body passes a height."""
    return sorted(np.roots([-G / 2, 3.0, -height]).real)


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_times_are_those_of_the_parabola(integrator):
    scene = falling()
    scene.event("there", quantity="A.position.y", value=0.4)
    scene.event("up", quantity="A.position.y", value=0.3, direction="rising")
    scene.event("down", quantity="A.position.y", value=0.3, direction="falling")
    scene.event("top", quantity="A.velocity.y")
    scene.event("far", function=lambda time, state: state["A.position"][0] - 1.0)
    scene.event("never", quantity="A.position.y", value=0.5)
    run = scene.run(1.0, integrator=integrator, output_step=0.5)
    expected = sorted([(t, "there") for t in roots(0.4)] + [(roots(0.3)[0], "up"), (roots(0.3)[1], "down"),
                                                            (3.0 / G, "top"), (0.5, "far")])
    assert [event["name"] for event in run.events] == [name for _, name in expected]
    np.testing.assert_allclose([event["time"] for event in run.events], [time for time, _ in expected], rtol=1e-9)
    top = run.events[[e["name"] for e in run.events].index("top")]["state"]
    assert top["A.position"][1] == pytest.approx(4.5 / G, rel=1e-9)
    assert len(run.time) == 3, "events that are noted add no rows"


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_one_that_stops_ends_the_run_there(integrator):
    scene = falling()
    scene.event("floor", quantity="A.position.y", value=-0.2, action="stop")
    run = scene.run(1.0, integrator=integrator)
    assert (run.status, run.events[-1]["name"]) == ("event", "floor")
    assert run.time[-1] == pytest.approx(roots(-0.2)[1], rel=1e-9)
    assert run["A.position"][-1, 1] == pytest.approx(-0.2, abs=1e-9)
    assert 'stopped by event "floor" at t = 0.672' in run.report["message"]


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_on_a_node_and_at_one_instant(integrator):
    """Two events at an element boundary at one instant: each is recorded once."""
    scene = riding()
    scene.event("a", quantity="trolley.s", value=5.0)
    scene.event("b", quantity="trolley.s", value=5.0, direction="rising")
    scene.event("not", quantity="trolley.s", value=5.0, direction="falling")
    scene.event("node", quantity="wire.position.y", s=5.0, value=-0.5)
    run = scene.run(1.0, integrator=integrator)
    assert sorted(event["name"] for event in run.events) == ["a", "b", "node"]
    times = {event["name"]: event["time"] for event in run.events}
    assert times["a"] == pytest.approx(times["b"], abs=1e-11)
    assert run.report["element_crossings"] == 2
    assert next(e for e in run.events if e["name"] == "a")["state"]["trolley.s"] == pytest.approx(5.0, abs=1e-10)


def test_of_a_scene_file_and_back():
    scene = riding()
    scene.event("mid", quantity="trolley.s", value=5.0, direction="rising", action="stop")
    again = loads(scene.to_toml(), "again")
    assert again.events == scene.events
    scene.event("function", function=lambda time, state: 1.0)
    assert "a file cannot describe" in scene.to_toml()
    assert list(loads(scene.to_toml(), "again").events) == ["mid"]


@pytest.mark.parametrize(("wrong", "message"), [
    ({"quantity": "B.position.y"}, 'event "e": there is no body, cable or slide "B"'),
    ({"quantity": "A.position"}, 'event "e": "A.position" cannot be watched; A.position.x, A.velocity.x'),
    ({"quantity": "trolley.force"}, 'event "e": "trolley.force" cannot be watched; trolley.s, trolley.s_rate, '
     "trolley.traction can"),
    ({"quantity": "wire.position.y"}, "s is missing"),
    ({"quantity": "wire.position.y", "s": 4.9}, "node"),
    ({"quantity": "A.position.y", "s": 1.0}, "has no place s"),
    ({}, "must have either a quantity or a function"),
    ({"quantity": "A.position.y", "action": "halt"}, '"halt" is not known'),
    ({"function": 3}, "must be a function of"),
    ({"function": abs, "value": 1.0}, "takes neither value nor s"),
])
def test_what_cannot_be_watched(wrong, message):
    with pytest.raises(fu.SceneError) as error:
        riding().event("e", **wrong)
    assert message in str(error.value)


@pytest.mark.parametrize(("function", "message"), [
    (lambda time, state: state["A.speed"], "KeyError"),
    (lambda time, state: float("nan"), "gave nan at t = 0"),
    (lambda time, state: "text", "ValueError"),
])
def test_a_function_that_fails_is_named(function, message):
    scene = falling()
    scene.event("e", function=function)
    with pytest.raises(fu.SceneError, match='event "e"') as error:
        scene.run(0.1)
    assert message in str(error.value)


@pytest.mark.parametrize("integrator", ["genalpha", "explicit", "radau"])
@pytest.mark.parametrize(("quantity", "value", "direction"), [
    ("s_rate", 3.6, "falling"), ("s_rate", 3.0, "both"), ("traction", -60.0, "falling"), ("traction", -44.0, "both")])
def test_a_slides_rate_and_traction(integrator, quantity, value, direction):
    """A run that stops there ends with that rate, or force along the cable, here of friction."""
    scene = riding()
    dict.clear(scene.slides)
    scene.slide("A", along="wire", s=2.0, name="trolley", friction=fu.Friction(coefficient=0.1, viscous=10.0))
    scene.event("there", quantity=f"trolley.{quantity}", value=value, direction=direction, action="stop")
    run = scene.run(1.5, integrator=integrator, tol=1e-4)
    assert (run.status, run.events[-1]["name"]) == ("event", "there")
    last, before = run[f"trolley.{quantity}"][-1], run[f"trolley.{quantity}"][-2]
    assert last == pytest.approx(value, rel=1e-6)
    assert direction == "both" or (last > before) == (direction == "rising")


def test_the_traction_of_a_driven_slide():
    """v = 0.5 sin(4 t) on a straight, stiff cable: the drive's force 2 m cos(4 t) passes 5 N three times."""
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.cable("wire", start=(0, 0, 0), end=(10, 0, 0), elements=6, element="cable12",
                section=fu.Rectangle(height=0.05, width=0.05),
                material=fu.Material(youngs_modulus=2e9, density=1000, poisson_ratio=0.0, damping_time=1e-2))
    scene.pin("wire", s=0.0)
    scene.pin("wire", s=10.0)
    scene.rigid_body("A", mass=5.0, inertia=(0.1, 0.2, 0.3), position=(2, 0, 0))
    scene.slide("A", along="wire", s=2.0, name="trolley", velocity=fu.Harmonic(amplitude=0.5, frequency=4 / 2 / np.pi))
    scene.event("force", quantity="trolley.traction", value=5.0)
    scene.event("speed", quantity="trolley.s_rate", value=0.25, direction="rising")
    run = scene.run(2.0, integrator="radau", tol=1e-6)
    times = {name: [e["time"] for e in run.events if e["name"] == name] for name in ("force", "speed")}
    assert times["force"][0] < 1e-3, "it starts with a jump, which the cable's damping smooths"
    np.testing.assert_allclose(times["force"][1:], np.array([np.pi / 3, 5 * np.pi / 3, 7 * np.pi / 3]) / 4, atol=5e-3)
    np.testing.assert_allclose(times["speed"], np.array([np.pi / 6, 13 * np.pi / 6]) / 4, atol=1e-6)


def test_what_a_slide_has_to_watch():
    with pytest.raises(fu.SceneError, match=r'"trolley.rate" cannot be watched; trolley.s, trolley.s_rate, '
                                            r"trolley\.traction can"):
        riding().event("fast", quantity="trolley.rate")
