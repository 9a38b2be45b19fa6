"""Ends of a cable: a hard stop, a buffer, nothing. Energy and momentum across each, in closed form.

Other tolerances have a reason beside them: the motion of the wire itself (see wires.py), or rounding.
"""

import numpy as np
import pytest
from expectations import energy_error, largest, slide_events, to_the_end
from funicular import Buffer, EndOfCableError, Friction, HardStop, Material, Rectangle, Scene, TableSignal
from scipy.optimize import brentq
from shared_scenes import LENGTH, MASS, G, block

every_integrator = pytest.mark.parametrize("integrator", ["genalpha", "radau", "explicit"])
both_ends = pytest.mark.parametrize(("end", "way"), [("at_end", 1), ("at_start", -1)])


def near(end: str, distance: float) -> float:
    """Return s at a distance from an end."""
    return LENGTH - distance if end == "at_end" else distance


# ---- a hard stop


@every_integrator
@both_ends
@pytest.mark.parametrize("restitution", [0, 0.5, 1])
@pytest.mark.parametrize("dim", [2, 3])
def test_a_rider_comes_back_from_a_hard_stop(integrator, end, way, restitution, dim):
    scene = block(near(end, 0.5), way * 1.0, weight=0, dim=dim, **{end: HardStop(restitution=restitution)})
    run = scene.run(1.0, integrator=integrator, tol=1e-6)
    (event,) = run.report["events"]
    assert (event["name"], event["what"]) == ("trolley", "struck the end")
    assert event["time"] == pytest.approx(0.5, abs=1e-12)
    t = run.time
    s = np.where(t < 0.5, 0.5 - t, restitution * (t - 0.5))
    np.testing.assert_allclose(run["trolley.s"], [near(end, d) for d in s], atol=5e-11)
    assert run["A.velocity"][-1, 0] == pytest.approx(-way * restitution, abs=5e-11)
    assert run["energy.dissipated"][-1] == pytest.approx(0.5 * MASS * (1 - restitution**2), abs=5e-11)
    assert run["energy.kinetic"][-1] == pytest.approx(0.5 * MASS * restitution**2, abs=5e-11)


@every_integrator
@pytest.mark.parametrize("restitution", [0, 0.4, 1])
def test_momentum_passes_to_a_cable_that_can_move(integrator, restitution):
    """A free cable of 10 kg, its mass distributed over nodal vectors: both momenta are constant.

    The impulse acts between rider and cable alone; the rider leaves the particle at the end with the restitution times
    its speed of approach.
    """
    scene = Scene(gravity=(0, 0, 0))
    scene.cable("wire", start=(0, 0, 0), end=(1, 0, 0), elements=2, element="cable12",
                section=Rectangle(height=0.05, width=0.05),
                material=Material(youngs_modulus=1e6, poisson_ratio=0.0, density=4000))
    block(0.95, 1.0, weight=0, scene=scene, at_end=HardStop(restitution=restitution))
    run = scene.run(0.1, integrator=integrator, tol=1e-8, output_step=1e-3)
    assert slide_events(run)[0] == "struck the end"
    lengths = np.array([0.25, 0.5, 0.25])  # of cubic Hermite elements: a node's r has half of both, slopes l^2/12
    slopes = np.array([0.5**2 / 12, 0, -(0.5**2) / 12])
    v = run["wire.nodal_velocity"]
    momentum = 10 * (np.einsum("k,tkd->td", lengths, v[:, :, 0]) + np.einsum("k,tkd->td", slopes, v[:, :, 1]))
    whole = momentum + MASS * run["A.velocity"]
    np.testing.assert_allclose(whole, np.broadcast_to([2.0, 0, 0], whole.shape), atol=1e-9)
    # genalpha changes the energy of vibrations at the limit of its resolution
    assert energy_error(run) < (1e-3 if integrator == "genalpha" else 1e-6)


@every_integrator
def test_a_block_bounces_until_it_rests(integrator):
    """On a slope against a stop: flight times halve, and the stop finally holds the block."""
    run = block(3.0, slope=0.5, at_end=HardStop(restitution=0.5)).run(3.0, integrator=integrator, tol=1e-6)
    down = G * np.sin(0.5)
    first = np.sqrt(2 / down)
    events = run.report["events"]
    assert slide_events(run) == ["struck the end"] * 8 + ["came to rest at the end"]
    times = [event["time"] for event in events]
    flights = first * 2 * 0.5 ** np.arange(1, 9)
    np.testing.assert_allclose(times, first + np.concatenate([[0], np.cumsum(flights)]), atol=1e-9)
    np.testing.assert_allclose(run["trolley.s"][-30:], LENGTH, atol=1e-11)
    # a ninth flight would rise by 3e-6 of the wire, a tenth below the threshold
    assert run["trolley.traction"][-1] == pytest.approx(-MASS * down, abs=5e-8)  # the wire has been bent
    assert energy_error(run) < 1e-9


@every_integrator
def test_a_stop_pushes_and_never_pulls(integrator):
    """The force on a rider at the stop reverses at 1 s and moves it away with 20 N (t - 1)."""
    scene = block(3.5, 1.0, weight=0, at_end=HardStop(restitution=0))
    scene.force("A", value=(1, 0, 0), scale=TableSignal(time=(0, 2), value=(20, -20), interpolation="linear"))
    run = scene.run(1.5, integrator=integrator, tol=1e-6)
    assert slide_events(run) == ["struck the end", "left the end"]
    assert run.report["events"][1]["time"] == pytest.approx(1.0, abs=1e-10)
    assert run["trolley.s"][-1] == pytest.approx(LENGTH - 20 * 0.5**3 / 6 / MASS, abs=1e-6)
    resting = (run.time > 0.3) & (run.time < 0.99)
    np.testing.assert_allclose(run["trolley.traction"][resting], -20 * (1 - run.time[resting]), atol=1e-9)


def test_friction_helps_a_stop_to_hold():
    """It is released where the force exceeds 0.5 20 N, not where it reverses."""
    scene = block(3.5, 1.0, weight=20.0, slope=0.0, at_end=HardStop(restitution=0),
                  friction=Friction(coefficient=0.1, static_coefficient=0.5, model="stick"))
    scene.force("A", value=(1, 0, 0), scale=TableSignal(time=(0, 2), value=(20, -20), interpolation="linear"))
    run = scene.run(1.8, integrator="radau")
    assert slide_events(run) == ["struck the end", "left the end"]
    assert run.report["events"][1]["time"] == pytest.approx(1.5, abs=1e-9)


# ---- a buffer


@every_integrator
@both_ends
@pytest.mark.parametrize("damping", [0.0, 20.0])
def test_a_buffer_takes_a_rider_and_gives_it_back(integrator, end, way, damping):
    """A half-period of the spring, less the part in which the damper would pull."""
    k, at = 800.0, near(end, 1.0)
    scene = block(at, way * 1.0, weight=0, **{end: Buffer(length=0.5, stiffness=k, damping=damping)})
    run = scene.run(1.0, integrator=integrator, tol=1e-6, output_step=2e-3)
    omega, zeta = np.sqrt(k / MASS), damping / (2 * np.sqrt(k * MASS))
    fast = omega * np.sqrt(1 - zeta**2)

    def x(t):
        return np.exp(-zeta * omega * t) * np.sin(fast * t) / fast

    def rate(t):
        return np.exp(-zeta * omega * t) * (np.cos(fast * t) - zeta * omega / fast * np.sin(fast * t))

    contact = brentq(lambda t: k * x(t) + damping * rate(t), 0.3 * np.pi / fast, 1.01 * np.pi / fast, xtol=1e-15)
    entered, left = run.report["events"]
    assert (entered["what"], left["what"]) == ("entered the buffer", "left the buffer")
    close = 2e-6 if integrator == "genalpha" else 1e-10  # of order 2 at tol = 1e-6: measured 3e-7
    assert entered["time"] == pytest.approx(0.5, abs=1e-12)
    assert left["time"] - entered["time"] == pytest.approx(contact, abs=close)
    inside = (run.time > 0.5) & (run.time < 0.5 + contact - 1e-4)
    deep = np.abs(run["trolley.s"] - near(end, 0.5))
    np.testing.assert_allclose(deep[inside], x(run.time[inside] - 0.5), atol=close)
    back = run["A.velocity"][-1, 0]
    assert back == pytest.approx(way * rate(contact), abs=1e-4 if integrator == "genalpha" else 1e-8)
    np.testing.assert_allclose(run["energy.elastic"][inside], 0.5 * k * deep[inside] ** 2, atol=1e-10)
    # each method integrates the damper's power by its own quadrature: measured 1.2e-5, 3e-8, 1e-12
    assert energy_error(run) < {"genalpha": 3e-5, "radau": 1e-7, "explicit": 1e-10}[integrator]
    # dissipated by the damper and the released spring
    assert run["energy.dissipated"][-1] == pytest.approx(0.5 * MASS * (1 - rate(contact) ** 2), abs=1e-4)


@every_integrator
def test_a_buffer_holds_a_block_on_a_slope(integrator):
    """It comes to rest where the spring carries it, in equilibrium too."""
    scene = block(3.2, slope=0.5, at_end=Buffer(length=0.5, stiffness=400.0, damping=60.0))
    run = scene.run(4.0, integrator=integrator, tol=1e-6)
    rests = 3.5 + MASS * G * np.sin(0.5) / 400
    assert run["trolley.s"][-1] == pytest.approx(rests, abs=1e-6)
    assert slide_events(run)[0] == "entered the buffer"


def test_equilibrium_leans_on_a_buffer():
    """2 N against a spring of the rider and, from s = 3.5 m on, the buffer."""
    scene = Scene(gravity=(1.0, -9.81, 0))
    scene.cable("wire", start=(0, 0, 0), end=(4, 0, 0), elements=4, element="cable12",
                section=Rectangle(height=0.05, width=0.05),
                material=Material(youngs_modulus=2e11, poisson_ratio=0.0, density=1.0))
    for k in range(5):
        scene.clamp("wire", s=k)
    scene.rigid_body("A", mass=MASS, inertia=(1e-2,) * 3, position=(3.4, 0, 0))
    scene.slide("A", along="wire", s=3.4, frame="tangent", roll="fixed", name="trolley",
                at_end=Buffer(length=0.5, stiffness=20.0))
    scene.spring("A", (2.4, 0, 0), stiffness=5.0, length=1.0)
    state = scene.equilibrium()
    assert state["trolley.s"] == pytest.approx((2 + 5 * 3.4 + 20 * 3.5) / 25, abs=1e-6)
    run = scene.run(0.1, initial=state, integrator="radau")
    np.testing.assert_allclose(run["trolley.s"], state["trolley.s"], atol=1e-6)


def test_a_rider_that_goes_through_a_buffer_runs_off():
    run, message = to_the_end(block(3.0, 5.0, weight=0, at_end=Buffer(length=0.5, stiffness=10.0)), 1.0)
    assert slide_events(run) == ["entered the buffer"]
    assert 'slide "trolley": ran off the end of cable "wire"' in message


# ---- nothing


@every_integrator
@both_ends
@pytest.mark.parametrize("dim", [2, 3])
def test_a_rider_flies_on(integrator, end, way, dim):
    """A parabola from the end, at the speed after friction; s is constant, and the force zero."""
    scene = block(near(end, 0.5), way * 2.0, slope=0.0, dim=dim,
                  friction=Friction(coefficient=0.2, model="stick"), **{end: "leave"})
    run = scene.run(1.0, integrator=integrator, tol=1e-6)
    speed = np.sqrt(4 - 2 * 0.2 * G * 0.5)
    leaves = (2 - speed) / (0.2 * G)
    (event,) = run.report["events"]
    assert event["what"] == "left" and event["time"] == pytest.approx(leaves, abs=1e-11)
    since = run.time - leaves
    flies = since > 0
    path = np.zeros((flies.sum(), 3))
    path[:, 0] = near(end, 0) + way * speed * since[flies]
    path[:, 1] = -G * since[flies] ** 2 / 2
    np.testing.assert_allclose(run["A.position"][flies], path, atol=5e-11)
    np.testing.assert_allclose(run["trolley.s"][flies], near(end, 0), atol=1e-11)
    for name in ("force", "s_rate", "traction", "residual"):
        assert largest(run[f"trolley.{name}"][flies]) == 0
    assert energy_error(run) < 1e-12


@every_integrator
def test_a_rider_whose_axes_are_tied_turns_freely_afterwards(integrator):
    """The slide also releases its moment about the end of the wire."""
    scene = block(3.8, 1.0, slope=0.0, frame="tangent", at_end="leave")
    scene.moment("A", value=(0, 0, 0.3))
    run = scene.run(0.5, integrator=integrator, tol=1e-6)
    since = run.time - 0.2
    np.testing.assert_allclose(run["A.angular_velocity"][:, 2], np.maximum(since, 0) * 0.3 / 1e-2, atol=1e-6)
    assert largest(run["trolley.moment"][since > 0]) == 0
    assert run["trolley.moment"][5, 2] == pytest.approx(-0.3, abs=1e-6)


def test_others_go_on_as_they_were():
    """One rider leaves, another reaches the other end, whose action is an error."""
    scene = block(3.5, 1.0, weight=0, at_end="leave")
    block(0.7, -1.0, weight=0, scene=scene, name="B", slide="other")
    with pytest.raises(EndOfCableError, match=r'slide "other": ran off the start of cable "wire" at t = 0\.7 s'):
        scene.run(1.0)


@pytest.mark.parametrize("at", [0.0, LENGTH])
def test_a_rider_that_starts_against_a_stop_stays(at):
    way = 1 if at else -1
    run = block(at, slope=way * 0.5, at_end=HardStop(restitution=0.5), at_start=HardStop(restitution=0.5)).run(0.5)
    np.testing.assert_allclose(run["trolley.s"], at, atol=1e-11)
    assert slide_events(run) == ["came to rest at the end"]
