"""Friction of slides: a block on a straight inclined wire against closed forms, by every integrator.

Other tolerances have a reason beside them: the motion of the wire itself (see wires.py), or rounding.
"""

import numpy as np
import pytest
from expectations import energy_error, largest, slide_events
from funicular import Buffer, Friction, HardStop, Material, Ramp, Rectangle, Scene, SceneError, TableSignal, load_run
from funicular.results import streaming
from interrupted_runs import Killed, content, failing
from shared_scenes import MASS, SLOPE, G, add_cable, block, heavy_wire

DOWN, ACROSS = G * np.sin(SLOPE), G * np.cos(SLOPE)
INTEGRATORS = ("genalpha", "radau", "explicit")
every_integrator = pytest.mark.parametrize("integrator", INTEGRATORS)


def stick(coefficient: float, **given) -> Friction:
    return Friction(coefficient=coefficient, model="stick", **given)


@every_integrator
@pytest.mark.parametrize("dim", [2, 3])
def test_a_block_slides_down(integrator, dim, validated):
    run = block(0.3, dim=dim, friction=stick(0.2)).run(1.0, integrator=integrator, tol=1e-6)
    t = run.time
    validated("Slides", "slide with friction 0.2 down a wire", "arc-length", 0.3 + (DOWN - 0.2 * ACROSS) * t**2 / 2,
              run["trolley.s"], unit="m", scale=1.0, bound=2e-11, source="closed form",
              variant=f"{integrator}, dim {dim}")
    force = np.broadcast_to(MASS * ACROSS * np.array([-0.2, 1, 0]), (len(t), 3))
    np.testing.assert_allclose(run["trolley.force"], force, atol=1e-9)
    np.testing.assert_allclose(run["trolley.traction"], -0.2 * MASS * ACROSS, atol=1e-9)
    np.testing.assert_allclose(run["energy.dissipated"], 0.2 * MASS * ACROSS * (run["trolley.s"] - 0.3), atol=1e-10)
    assert energy_error(run) < 1e-12 and slide_events(run) == []


@every_integrator
def test_a_block_sticks(integrator):
    """Up to the static coefficient, even with a sliding coefficient below the slope."""
    run = block(0.3, friction=stick(0.2, static_coefficient=0.6)).run(1.0, integrator=integrator, tol=1e-6)
    np.testing.assert_allclose(run["trolley.s"], 0.3, atol=1e-12)
    np.testing.assert_allclose(run["trolley.traction"], -MASS * DOWN, atol=1e-9)
    assert largest(run["energy.dissipated"]) == 0


@every_integrator
def test_a_block_creeps_where_friction_is_regularised(integrator):
    """mu v/sqrt(v^2 + v0^2) equals the slope, to the rounding of s over an output step, at most 4e-8."""
    run = block(0.3, friction=Friction(coefficient=0.7, velocity=0.01)).run(1.0, integrator=integrator, tol=1e-6)
    tau = np.tan(SLOPE) / 0.7
    assert run["trolley.s_rate"][-1] == pytest.approx(0.01 * tau / np.sqrt(1 - tau**2), rel=1e-6)
    # genalpha integrates power by the trapezoidal rule, of order 2, for a motion that stops within 1e-3 s
    assert energy_error(run) < {"genalpha": 1e-6, "radau": 1e-7, "explicit": 1e-9}[integrator]


@every_integrator
@pytest.mark.parametrize("mu", [0.2, 0.7])
def test_thrown_upwards_it_stops_then_slides_back_or_sticks(integrator, mu):
    run = block(2.0, -2.0, friction=stick(mu)).run(1.0, integrator=integrator, tol=1e-6)
    braking = DOWN + mu * ACROSS
    (event,) = run.report["events"]
    assert (event["name"], event["what"]) == ("trolley", "stuck" if mu > np.tan(SLOPE) else "turned round")
    assert event["time"] == pytest.approx(2 / braking, abs=1e-12)
    assert event["s"] == pytest.approx(2 - 2 / braking, abs=1e-11)
    back = max(DOWN - mu * ACROSS, 0) * (1 - 2 / braking) ** 2 / 2
    assert run["trolley.s"][-1] == pytest.approx(2 - 2 / braking + back, abs=1e-11)
    assert energy_error(run) < 1e-12


@every_integrator
def test_it_breaks_loose_where_the_force_exceeds_the_grip(integrator):
    """A force of 20 N/s against 0.5 20 N; then the block slides against 0.3 20 N."""
    scene = block(1.0, weight=20.0, slope=0.0, friction=stick(0.3, static_coefficient=0.5))
    scene.force("A", value=(1, 0, 0), scale=TableSignal(time=(0, 2), value=(0, 40), interpolation="linear"))
    run = scene.run(1.0, integrator=integrator, tol=1e-5)
    (event,) = run.report["events"]
    assert event["what"] == "broke loose" and event["time"] == pytest.approx(0.5, abs=1e-10)  # measured 2.5e-12
    since = np.maximum(run.time - 0.5, 0)
    way = (20 * since**3 / 6 + (10 - 6) * since**2 / 2) / MASS
    # genalpha is of order 2: to tol of the motion
    np.testing.assert_allclose(run["trolley.s"], 1 + way, atol=1e-5 if integrator == "genalpha" else 5e-11)


@every_integrator
def test_viscous_friction_ends_at_a_terminal_speed(integrator, validated):
    run = block(0, slope=0.1, friction=Friction(viscous=20.0)).run(3.0, integrator=integrator, tol=1e-6)
    speed, T, t = MASS * G * np.sin(0.1) / 20, MASS / 20, run.time
    np.testing.assert_allclose(run["trolley.s"], speed * (t - T * (1 - np.exp(-t / T))), atol=1e-6)  # tol of the motion
    validated("Slides", "slide with viscous friction down a wire", "terminal speed", speed,
              float(run["trolley.s_rate"][-1]), unit="m/s", bound=1e-8, source="closed form", variant=integrator)


def test_rolling_resistance_stops_a_wheel():
    """5 s and 2.5 m, in which the weight tilts the wire by 5e-10."""
    run = block(0, 1.0, slope=0.0, friction=Friction(rolling=0.02, model="stick")).run(6.0, integrator="radau")
    assert slide_events(run) == ["stuck"]
    assert run.report["events"][0]["time"] == pytest.approx(1 / (0.02 * G), abs=1e-8)
    assert run["trolley.s"][-1] == pytest.approx(1 / (2 * 0.02 * G), abs=1e-8)


@every_integrator
def test_two_that_stop_at_one_instant(integrator):
    scene = block(1.0, 1.0, slope=0.0, friction=stick(0.2))
    run = block(3.0, -1.0, slope=0.0, friction=stick(0.2), scene=scene, name="B", slide="other").run(
        1.0, integrator=integrator, tol=1e-6)
    assert sorted((event["name"], event["what"]) for event in run.report["events"]) == [
        ("other", "stuck"), ("trolley", "stuck")]
    for event in run.report["events"]:
        assert event["time"] == pytest.approx(1 / (0.2 * G), abs=1e-11)


@pytest.mark.parametrize("model", ["stick", "regularised"])
def test_integrators_agree_on_a_cable_that_gives_way(model):
    """Their energy balances agree to tol. The normal force vibrates with the cable: genalpha at 1e-5 differs by 3e-4 m.
    """
    runs = {}
    for integrator in INTEGRATORS:
        scene = Scene()
        add_cable(scene, material={"youngs_modulus": 4e8, "poisson_ratio": 0.0, "density": 4200, "damping_time": 1e-4})
        scene.rigid_body("A", mass=1.0, inertia=(1e-3,) * 3, position=(0.25, 0, 0), velocity=(1.5, 0, 0))
        scene.slide("A", along="wire", s=0.25, name="trolley", friction=Friction(coefficient=0.2, model=model))
        runs[integrator] = scene.run(0.4, integrator=integrator, tol=1e-6)
    for integrator in ("genalpha", "radau"):
        np.testing.assert_allclose(runs[integrator]["trolley.s"], runs["explicit"]["trolley.s"], atol=1e-5)
    for integrator, most in (("genalpha", 5e-6), ("radau", 1e-6), ("explicit", 1e-7)):
        assert energy_error(runs[integrator]) < most
        assert runs[integrator]["energy.dissipated"][-1] > 0.5


# ---- reaction-dependent friction: a rod whose point on the wire is ahead of its centre or behind, and far from it


def rod(ahead: float, mu: float) -> Scene:
    """Return a rod with a radius of gyration of 0.1 m: a normal force of MASS G/2, plus or minus 5 times the friction.
    """
    scene = heavy_wire(2)
    scene.rigid_body("A", mass=MASS, inertia=(0.02, 0.02, 0.02), position=(2 - ahead, -1, 0), velocity=(1, 0, 0))
    scene.slide("A", along="wire", s=2.0, at=(ahead, 1, 0), name="trolley", friction=stick(mu))
    scene.force("A", value=(0, -MASS * G, 0))
    return scene


@every_integrator
@pytest.mark.parametrize(("ahead", "mu"), [(0.1, 0.1), (0.1, 0.5), (-0.1, 0.1)])
def test_friction_follows_the_normal_force_that_it_makes(integrator, ahead, mu):
    run = rod(ahead, mu).run(0.01, integrator=integrator, tol=1e-7)
    N = MASS * G / 2 / (1 + np.sign(ahead) * 5 * mu)
    np.testing.assert_allclose(run["trolley.force"][0], [-mu * N, N, 0], atol=1e-10)
    assert energy_error(run) < 1e-5


def test_friction_that_has_no_solution_is_reported():
    with pytest.raises(SceneError, match=r'slide "trolley": friction is self-locking at the start: .*; take a smal'):
        rod(-0.1, 0.5).run(0.01)


# ---- other parts


def test_the_energy_integrator_refuses():
    for given in ({"friction": Friction(viscous=1.0)}, {"at_end": "leave"}):
        with pytest.raises(SceneError, match='integrator "energy" supports neither friction nor ends of cables'):
            block(1.0, **given).run(0.1, integrator="energy")


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_run_goes_on_exactly_from_a_checkpoint(tmp_path, monkeypatch, integrator):
    """A block that sticks, one in a buffer, one against a stop, and one that has left."""
    def scene() -> Scene:
        made = block(1.0, 0.3, slope=0.0, friction=stick(0.2), at_end=HardStop(restitution=0.5))
        block(3.5, 1.0, scene=made, name="B", slide="b", friction=stick(0.1),
              at_end=Buffer(length=0.45, stiffness=400.0, damping=3.0))
        block(3.9, 0.0, scene=made, name="C", slide="c", at_end=HardStop(restitution=0.5))
        return block(0.1, -1.0, scene=made, name="D", slide="d", at_start="leave")

    settings = {"duration": 0.6, "output_step": 0.01, "tol": 1e-4, "integrator": integrator}
    scene().run(**settings, save=tmp_path / "whole.nc")
    monkeypatch.setattr(streaming, "CHECKPOINT_INTERVAL", -1.0)
    for writes, resume in ((60, False), (60, True)):
        with monkeypatch.context() as patch:
            failing(patch, writes, Killed())
            with pytest.raises(Killed):
                scene().run(**settings, save=tmp_path / "x.nc", resume=resume)
    scene().run(**settings, save=tmp_path / "x.nc", resume=True)
    assert content(tmp_path / "x.nc") == content(tmp_path / "whole.nc")
    events = load_run(tmp_path / "whole.nc").events
    assert {event["what"] for event in events} >= {"stuck", "entered the buffer", "left", "struck the end"}
    assert load_run(tmp_path / "x.nc").events == events


def on_an_arc(**tied) -> Scene:
    """Return a body that sticks beside the middle of a hanging arc, under a growing moment."""
    def arc(u: float):
        angle = 0.85 * (2 * u - 1)
        return 2 * np.sin(angle), -2 * np.cos(angle), 0

    scene = Scene()
    material = Material(youngs_modulus=2e7, poisson_ratio=0, density=2000, damping_time=2e-3, mass_damping=3)
    scene.cable("rope", curve=arc, elements=6, element="cable12", section=Rectangle(height=0.02, width=0.02),
                rest="straight", material=material)
    for s in (0.0, 3.4):
        scene.pin("rope", s=s)
    scene.rigid_body("A", mass=2.0, inertia=(0.02, 0.03, 0.04), position=(0.05, -1.99937, 0))
    scene.slide("A", along="rope", s=1.75, name="trolley", friction=Friction(coefficient=0.3, model="stick"), **tied)
    scene.moment("A", value=(0, 0, 1), scale=Ramp(start=0.1, end=2.1, after=40))
    return scene


@pytest.mark.filterwarnings("ignore")
def test_friction_holds_what_the_moment_on_a_tied_frame_puts_along_the_cable():
    """On a curve a moment acts along the cable as well.

    The run ends soon after the rider breaks loose at 0.7196 s: it reverses ever faster then, until rounding decides
    whether its friction is self-locking.
    """
    began = []
    for integrator in ("radau", "genalpha"):
        run = on_an_arc(frame="tangent").run(0.7197, initial="equilibrium", integrator=integrator, tol=1e-5,
                                             output_step=2e-3, progress=False)
        began.append(next(event["time"] for event in run.events
                          if event["what"] == "broke loose" and event["time"] > 0.7))  # 0.65 s: it touches the limit
        grip = np.abs(run["trolley.traction"]) / np.linalg.norm(run["trolley.multiplier"], axis=1)
        stuck = run.time < began[-1]
        assert grip[stuck].max() < 0.3 * (1 + 1e-9) and np.ptp(run["trolley.s"][stuck]) < 1e-9
        assert np.polyval(np.polyfit(run.time[stuck][-4:] - began[-1], grip[stuck][-4:], 3), 0) == pytest.approx(
            0.3, rel=1e-3)
    assert began[0] == pytest.approx(began[1], abs=1e-4)


@pytest.mark.filterwarnings("ignore")
def test_a_tied_frame_that_is_trapped_at_a_node_makes_no_energy_and_is_noted():
    """At each node the frame must take the tangent of the next element; a rotation within one step created 7.7 J at
    1.026 s. The mesh decides where the rider stays: cable18 releases it.
    """
    run = on_an_arc(frame="tangent").run(1.03, initial="equilibrium", integrator="genalpha", tol=1e-4,
                                         output_step=2e-3, progress=False)
    assert run.status == "completed"
    assert energy_error(run) < 3e-3
    assert 'the frame of "trolley" back to the node. Take more elements, or on a cable' in str(run.report["messages"])


def test_a_slide_that_may_stick_stands_beside_joints():
    """Such a scene is not over-constrained."""
    scene = on_an_arc()
    scene.rigid_body("B", mass=1.0, inertia=(1, 1, 1), position=(0, -5, 0))
    scene.joint("spherical", (0, -4, 0), ("B", (0, 1, 0)))
    assert scene.run(1e-3, progress=False).status == "completed"
