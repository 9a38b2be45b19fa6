"""Ends of a rope for a slide: stops at anchors as on a cable, and riders that leave the rope."""

import funicular as fu
import numpy as np
import pytest
from expectations import slide_events
from interrupted_runs import killed_and_resumed
from ropes.scenes import on_rope_and_cable, rope_of
from test_grips import SETTINGS
from test_ropes import momenta
from test_slides_on_ropes import hauled

pytestmark = pytest.mark.filterwarnings("ignore:.*youngs_modulus|.*density|.*initial velocities:"
                                        "funicular.FunicularWarning")
HARD, SOFT = fu.HardStop(restitution=0.5), fu.Buffer(length=1.0, stiffness=2e3, damping=50.0)


def towards_the_anchor(stop: object, friction: object = None) -> list[fu.Scene]:
    """Return a load that slides at 6 m/s towards the end of a rope, and of a cable."""
    rope, cable, line = on_rope_and_cable(0.01)
    for scene in (rope, cable):
        scene.rigid_body("load", mass=20, inertia=(1, 1, 1), position=line.point(rope.bodies, 2.0).tolist(),
                         velocity=(-6, 0, 0))
        scene.slide("load", along="line", s=2.0, name="trolley", at_start=stop, friction=friction)
    return [rope, cable]


@pytest.mark.parametrize(("stop", "friction", "what"), [
    (HARD, None, ["struck the end"]), (fu.HardStop(restitution=0), 0.1, ["struck the end"]),
    (SOFT, None, ["entered the buffer", "left the buffer"]), ("leave", None, ["left"])])
@pytest.mark.slow_cases("stop1-0.1-what1")
def test_agrees_with_a_stop_on_a_cable(stop, friction, what):
    """Beside a sheave of 1 cm and a rope of 1 cm beyond it, to which the difference is in proportion."""
    runs = [scene.run(0.8, **SETTINGS | {"tol": 1e-6}) for scene in towards_the_anchor(stop, friction)]
    events = [slide_events(run) for run in runs]
    assert events[0] == events[1] and events[0][: len(what)] == what
    times = [[event["time"] for event in run.report["events"]] for run in runs]
    assert np.abs(np.subtract(*times)).max() < 2e-5
    assert np.abs(runs[0]["trolley.s"] - runs[1]["trolley.s"]).max() < 2e-4  # measured: 9e-5 m of 2 m
    assert np.abs(runs[0]["load.position"] - runs[1]["load.position"]).max() < 1e-3
    lost = [run["energy.dissipated"][-1] for run in runs]
    assert lost[0] == pytest.approx(lost[1], rel=1e-3)  # measured: 3.4e-4
    assert np.abs(runs[0].energy_balance().relative).max() < 1e-6


STOPS = pytest.mark.parametrize("stop", [HARD, fu.Buffer(length=0.3, stiffness=2e3, damping=5.0)],
                                ids=["hard", "buffer"])


def struck(stop: object) -> fu.Scene:
    """Return a rope over a sheave on a free body, with bodies at its ends, one of which another on the rope strikes."""
    scene = fu.Scene(gravity=(0, 0, 0))
    for name, mass, start, speed in (("A", 2.0, (-0.2, -1.5, 0), -0.2), ("B", 2.5, (0.2, -1.5, 0), -0.2),
                                     ("C", 3.0, (0, 0, 0), -0.2), ("D", 1.0, (0.2, -1.0, 0), -4.0)):
        scene.rigid_body(name, mass=mass, inertia=(1, 1, 0.1), position=start, velocity=(0.3, speed, 0))
    for name in "AB":
        scene.spring(name, "C", stiffness=100.0, length=2.0)
    scene.rope("rope", route=[fu.Anchor("A"), fu.Sheave("top", at="C", radius=0.2, side="right"), fu.Anchor("B")],
               tension=50.0, elements=3, **rope_of(2e4, 0.1, 0, 1e-4))
    scene.slide("D", along="rope", name="trolley", at_end=stop)
    return scene


@STOPS
@pytest.mark.parametrize("integrator", ["genalpha", "explicit"])
@pytest.mark.slow_cases("genalpha-hard", "explicit-buffer")
def test_integrators_agree(integrator, stop):
    scene = struck(stop)
    run, other = (scene.run(0.16, **SETTINGS | {"tol": 1e-6, "output_step": 0.02, "integrator": name})
                  for name in ("radau", integrator))
    assert slide_events(run) == slide_events(other)
    assert np.abs(run["D.position"] - other["D.position"]).max() < 1e-5


@STOPS
def test_momentum_passes_to_the_body_at_the_anchor(stop):
    scene = struck(stop)
    run = scene.run(0.16, **SETTINGS | {"tol": 1e-7, "output_step": 0.02})
    assert slide_events(run)[0] == ("struck the end" if stop is HARD else "entered the buffer")
    found = np.array([momenta(scene, run, k) for k in range(len(run.time))])
    assert np.abs(found - found[0]).max() < 1e-6 * np.abs(found).max()


@pytest.mark.parametrize("integrator", ["radau", "genalpha"])
@pytest.mark.slow_cases("genalpha")
def test_a_rider_leaves_the_rope_at_a_sheave(integrator):
    """It then falls freely."""
    scene = hauled(speed=0.5, along=2.5, s=23.5, at_end="leave")
    run = scene.run(1.2, **SETTINGS | {"tol": 1e-6, "integrator": integrator})
    assert slide_events(run) == ["left"]
    left = run.report["events"][0]["time"]
    after = run.time > left + 1e-6
    times, velocity = run.time[after], run["carriage.velocity"][after]
    assert np.abs(velocity[:, 1] - velocity[0, 1] + 9.81 * (times - times[0])).max() < 1e-9
    assert np.abs(velocity[:, 0] - velocity[0, 0]).max() < 1e-9
    assert np.abs(run.energy_balance().relative).max() < 1e-6


def test_resumed_bit_for_bit(tmp_path):
    scene = towards_the_anchor(SOFT)[0]
    settings = SETTINGS | {"duration": 0.6, "output_step": 0.02}
    whole = scene.run(**settings)
    resumed = killed_and_resumed(scene, tmp_path / "run.nc", 15, **settings)
    assert all(np.array_equal(whole[name], resumed[name]) for name in whole)
