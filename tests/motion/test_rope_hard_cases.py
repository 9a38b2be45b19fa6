"""Hard cases of ropes over sheaves: each agrees with a closed form or explains its energy, or ends with a named error
that says cause and remedy. The normal force is never negative.
"""

from math import exp, pi, sin, sqrt

import funicular as fu
import numpy as np
import pytest
from ropes.scenes import GRAVITY, over_one, rope_of, swing, weight
from scipy.integrate import solve_ivp

pytestmark = pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")
R = 0.2


def presses(run: fu.Run, *sheaves: str, last: bool = True) -> None:
    """Assert that ropes press on sheaves, but for the last instant of a run that ended with an error."""
    for name in sheaves:
        assert (run[f"{name}.normal_force"][: None if last else -1] > 0).all()


def explained(run: fu.Run, bound: float) -> None:
    assert np.abs(run.energy_balance().relative).max() < bound


def ended(scene: fu.Scene, match: str, remedy: str, **settings: object) -> fu.Run:
    """Return the results of a run that ends with a named error."""
    with pytest.raises(fu.RopeLeftError, match=match) as caught:
        scene.run(**settings, progress=False)
    assert remedy in str(caught.value)
    return caught.value.run


def between_rails(tension: float, drive: fu.TableSignal, *, EA: float, rho: float, behind: float = 3.0,
                  damping_time: float = 1e-4, **sheave: object) -> fu.Scene:
    """Return a rope that is hauled down on the right side of a sheave, with a constant pull on the left side."""
    scene = fu.Scene(gravity=(0, 0, 0))
    for name, x, y, given in (("slack", -R, -behind, {}), ("tight", R, -1.0, {"velocity": drive})):
        weight(scene, name, 1e-3, x, y)
        scene.joint("prismatic", (x, y, 0), name, axis=(0, 1, 0), **given)
    scene.force("slack", value=(0, -tension, 0))
    over_one(scene, R, ("slack", "tight"), elements=1, tension=tension, given=rope_of(EA, rho, 0, damping_time),
             **sheave)
    return scene


def table(time: list[float], value: list[float]) -> fu.TableSignal:
    return fu.TableSignal(time=time, value=value, interpolation="linear")


# ---- speeds above those of waves

@pytest.mark.parametrize("integrator", ["genalpha", "radau"])
def test_a_wrap_is_lost_above_the_speed_of_waves(integrator):
    """The free end is pulled with 20 N + the inertia of its side; a slow rise keeps it at rho (l - x) a: the wrap is
    lost where rho v² is the tension that is left.
    """
    a, rho, tension, behind = 10.0, 0.5, 20.0, 8.0
    scene = between_rails(tension, table([0, 2], [0, -20.0]), EA=1e6, rho=rho, behind=behind)
    run = ended(scene, "lifts off sheave .top.", "take a higher tension or a lower speed", duration=2.0,
                output_step=0.02, tol=1e-5, integrator=integrator)
    speed = run["slack.velocity"][-1, 1]
    left = behind - speed**2 / (2 * a)
    assert speed == pytest.approx(sqrt((tension + (rho * left + 1e-3) * a) / rho), rel=3e-3)
    presses(run, "top", last=False)


def belt(speed: float, tension: float, EA: float = 1e4, rho: float = 0.5) -> fu.Scene:
    """Return a belt whose driver speeds up to a speed of its surface within 1 s."""
    scene = fu.Scene(gravity=(0, 0, 0))
    rough = {"radius": 0.1, "side": "left", "friction": fu.Friction(coefficient=0.4, velocity=1e-3), "zones": 2}
    scene.rope("belt", closed=True, tension=tension, elements=1, route=[
        fu.Sheave("driver", at=(0, 0, 0), velocity=table([0, 1, 2], [0, speed / 0.1, speed / 0.1]), **rough),
        fu.Sheave("driven", at=(0.4, 0, 0), inertia=1e-4, **rough)], **rope_of(EA, rho, 0, 1e-3))
    return scene


def test_a_belt_is_thrown_off():
    """The length of a belt on its pulleys is given, and thus its tension T, at any speed: it leaves them as the speed
    reaches sqrt(T lambda/rho), lambda its stretch of 1.01.
    """
    run = ended(belt(30.0, 100.0), "lifts off sheave .driv", "take a higher tension or a lower speed", duration=1.5,
                output_step=0.05, tol=1e-4, integrator="radau")
    assert 1.01 * run["driven.material_speed"][-1] == pytest.approx(sqrt(100.0 * 1.01 / 0.5), rel=1e-3)
    presses(run, "driver", "driven", last=False)


def test_a_belt_stays_on_below_this_speed():
    run = belt(13.0, 100.0).run(1.5, output_step=0.05, tol=1e-4, integrator="radau", progress=False)
    assert run["driver.normal_force"][-1] == pytest.approx(100.0 - 0.5 * 13.0**2 / 1.01, rel=1e-3)
    presses(run, "driver", "driven")
    explained(run, 1e-3)


# ---- friction

def test_slip_reverses():
    """A sheave that turns to and fro below a held rope: the ratio of the tensions is exp(mu pi) in both directions."""
    scene = fu.Scene(gravity=(0, 0, 0))
    time = np.linspace(0, 2, 401)
    scene.rope("rope", route=[fu.Anchor(at=(-R, -1, 0)),
                              fu.Sheave("top", at=(0, 0, 0), radius=R, side="right", zones=4,
                                        friction=fu.Friction(coefficient=0.3, velocity=1e-4),
                                        velocity=fu.TableSignal(time=time, value=np.sin(2 * pi * time))),
                              fu.Anchor(at=(R, -1, 0))], elements=1, tension=100.0, **rope_of(1e5, 0.1, 0, 1e-3))
    run = scene.run(2.0, output_step=0.25, tol=1e-5, integrator="radau", progress=False)
    ratio = run["top.tension_off"] / run["top.tension_on"]
    assert ratio[[1, 5]] == pytest.approx(exp(0.3 * pi), rel=1e-5)
    assert ratio[[3, 7]] == pytest.approx(exp(-0.3 * pi), rel=1e-5)
    explained(run, 1e-6)
    presses(run, "top")


@pytest.mark.parametrize("integrator", ["genalpha", "radau"])
def test_a_sheave_stops_in_one_step(integrator):
    """Two weights lower each other at 1 m/s; the sheave stops within 1e-9 s. The rope slides on, slowed down by
    a = g (m2 - m1 e)/(m2 + m1 e), e = exp(mu pi), with the masses of both sides.
    """
    m1, m2, mu, v, rho = 1.0, 1.5, 0.3, 1.0, 1e-2
    scene = swing(m1, m2, R, 3.0, 2.0, 0.0)
    over_one(scene, R, ("counterweight", "load"), elements=1, tension=12.0, given=rope_of(1e5, rho, 0, 1e-3), zones=4,
             friction=fu.Friction(coefficient=mu, velocity=1e-3),
             velocity=table([0, 0.1, 0.2, 0.2 + 1e-9, 2], [0, -v / R, -v / R, 0, 0]))
    run = scene.run(0.38, output_step=0.02, tol=1e-5, integrator=integrator, progress=False)
    e, up, down = exp(mu * pi), m1 + 3 * rho, m2 + 2 * rho
    slowed = (run["load.velocity"][-1, 1] - run["load.velocity"][11, 1]) / 0.16
    assert slowed == pytest.approx(-GRAVITY * (down - up * e) / (down + up * e), rel=0.02)
    presses(run, "top")
    explained(run, 1e-5)


# ---- wrap angles

def test_a_wrap_near_zero():
    """A wrap of 3e-3 rad: it bears 2 T sin(wrap/2)."""
    scene = fu.Scene(gravity=(0, 0, 0))
    low = -sin(1.5e-3)
    scene.rope("rope", route=[fu.Anchor(at=(-1, low, 0)), fu.Sheave("top", at=(0, -R, 0), radius=R, side="right"),
                              fu.Anchor(at=(1, low, 0))], elements=1, tension=100.0, **rope_of(1e5, 0.1, 0, 1e-3))
    run = scene.run(0.1, output_step=0.05, tol=1e-6, integrator="radau", progress=False)
    assert run["top.wrap_angle"] == pytest.approx(3e-3, rel=1e-3)
    assert -run["top.force"][:, 1] == pytest.approx(2 * 100.0 * np.sin(run["top.wrap_angle"] / 2), rel=1e-6)
    presses(run, "top")


@pytest.mark.parametrize("integrator", ["genalpha", "radau"])
def test_a_taut_rope_leaves_a_peg(integrator):
    """A pendulum swings back from around a peg (ropes.swings.peg) and leaves it as by the equation of the line's angle
    a, l a'' = R a'² - g sin(a) with the free length l.
    """
    length, radius, centre, start = 2.0, 0.1, np.array([0.3, -1.0]), 0.9
    away = np.linalg.norm(centre)
    touched = np.arctan2(centre[0], -centre[1]) - np.arcsin(radius / away)

    def left(a):
        return length - sqrt(away**2 - radius**2) - radius * (a - touched)

    def lost(t, y):
        return y[0] - touched

    lost.terminal = True
    def rates(t, y):
        return [y[1], (radius * y[1] ** 2 - GRAVITY * sin(y[0])) / left(y[0])]

    swing_back = solve_ivp(rates, (0, 3), [start, 0], events=lost, rtol=1e-10, atol=1e-12)
    radial, along = np.array([np.cos(start), sin(start)]), np.array([sin(start), -np.cos(start)])
    place = centre - radius * radial + left(start) * along
    scene = fu.Scene(gravity=(0, -GRAVITY, 0))
    weight(scene, "load", 5.0, *place)
    scene.rope("rope", route=[fu.Anchor(at=(0, 0, 0)), fu.Sheave("peg", at=(*centre, 0), radius=radius, side="left"),
                              fu.Anchor("load")], elements=1, tension=5 * GRAVITY * np.cos(start),
               **rope_of(1e6, 1e-2, 0, 1e-3))
    run = scene.run(1.0, output_step=0.05, tol=1e-5, integrator=integrator, progress=False)
    assert [event["what"] for event in run.events] == ["left the sheave"]
    assert run.events[0]["time"] == pytest.approx(swing_back.t[-1], abs=3e-4)
    before = run.time < run.events[0]["time"]
    assert (run["peg.normal_force"][before] > 0).all()
    assert (run["peg.gap"][~before] > 0).all()
    explained(run, 1e-5)


def test_a_load_winds_itself_up_beyond_a_turn():
    """Without gravity and friction the speed v of a load on a light held rope is kept: R phi²/2 - l phi = -v t for the
    angle phi by which the wrap grows, and l from the foot to the load.
    """
    l, v, radius = 2.0, 4.0, 0.4
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.rigid_body("load", mass=5.0, inertia=(5.0,) * 3, position=(radius, -l, 0), velocity=(-v, 0, 0))
    scene.rope("rope", route=[fu.Anchor(at=(-radius, -1, 0)),
                              fu.Sheave("top", at=(0, 0, 0), radius=radius, side="right"), fu.Anchor("load")],
               elements=1, tension=5.0 * v**2 / l, **rope_of(1e6, 2e-3, 0, 1e-3))
    run = scene.run(1.15, output_step=0.05, tol=1e-5, integrator="radau", progress=False)
    grown = (l - np.sqrt(l**2 - 2 * radius * v * run.time)) / radius
    assert run["top.wrap_angle"] - pi == pytest.approx(grown, abs=0.01)
    assert run["top.wrap_angle"][-1] > 2 * pi + 0.4
    assert np.linalg.norm(run["load.velocity"], axis=1) == pytest.approx(v, rel=1e-3)
    explained(run, 1e-5)
    presses(run, "top")


def test_turns_change_nothing_without_friction():
    """A load that swings, with 3 whole turns on the sheave: as with none, but for a light rope's mass there."""
    loads = []
    for turns in (0, 3):
        scene = swing(5.5, 5.0, 0.3, 3.0, 4.0, 0.5)
        over_one(scene, 0.3, ("counterweight", "load"), elements=1, tension=50.0, turns=turns,
                 given=rope_of(1e7, 1e-4, 0, 1e-3))
        run = scene.run(0.5, output_step=0.1, tol=1e-5, integrator="radau", progress=False)
        presses(run, "top")
        assert run["top.wrap_angle"][-1] > pi + 2 * pi * turns - 0.5
        loads.append(run["load.position"])
    assert np.abs(loads[1] - loads[0]).max() < 2e-5


# ---- spans

def test_a_span_between_two_sheaves_shrinks_to_its_limit():
    """A span can be modelled down to R/20 of stress-free length; a sheave on a carriage comes that near."""
    scene = fu.Scene(gravity=(0, 0, 0))
    weight(scene, "carriage", 1.0, 1.0, 0.0)
    scene.joint("prismatic", (1.0, 0, 0), "carriage", axis=(1, 0, 0), velocity=table([0, 0.1, 5], [0, -1, -1]))
    for name, x in (("A", -R), ("B", 1.0 + R)):
        weight(scene, name, 1.0, x, -3.0)
        scene.force(name, value=(0, -50.0, 0))
    scene.rope("rope", route=[fu.Anchor("A"), fu.Sheave("one", at=(0, 0, 0), radius=R, side="right"),
                              fu.Sheave("other", at="carriage", radius=R, side="right"), fu.Anchor("B")],
               elements=1, tension=50.0, **rope_of(1e5, 0.05, 0, 1e-3))
    run = ended(scene, "a span of rope .rope. becomes too short", "keep what is at the ends of the span apart",
                duration=3.0, output_step=0.02, tol=1e-4, integrator="radau")
    assert run["carriage.position"][-1, 0] == pytest.approx(0.05 * R * (1 + 50.0 / 1e5), rel=1e-5)
    presses(run, "one", "other")
    explained(run, 1e-5)


# ---- masses

@pytest.mark.parametrize(("share", "bound"), [(1e-3, 2e-4), (1e3, 2e-5)])
def test_a_rope_far_lighter_and_far_heavier_than_its_loads(share, bound):
    """(m1 + m2 + rho L + I/R²) x'' = (m2 - m1) g + 2 rho g x from x0, free lengths 5 m -+ x0."""
    rho, x0, side = 0.5, 0.2, 5.0
    mass = rho * (2 * side + pi * R) / share / 2
    scene = swing(mass, 1.1 * mass, R, side - x0, side + x0, 0.0)
    over_one(scene, R, ("counterweight", "load"), elements=2, tension=(mass + rho * side) * GRAVITY,
             given=rope_of(1e7 if share > 1 else 1e8, rho, 0, 1e-4))
    run = scene.run(1.0, output_step=0.5, tol=1e-5, integrator="radau", progress=False)
    total = 2.1 * mass + rho * (2 * side + pi * R)
    rate, level = sqrt(2 * rho * GRAVITY / total), 0.1 * mass / (2 * rho)
    x = (x0 + level) * np.cosh(rate * run.time) - level
    assert x0 + run["load.position"][0, 1] - run["load.position"][:, 1] == pytest.approx(x, abs=bound)
    presses(run, "top")
    explained(run, 1e-5)


@pytest.mark.slow
def test_forty_sheaves_in_a_row():
    """Without friction, over and under 40 sheaves: the acceleration of two weights and a light rope."""
    scene = fu.Scene(gravity=(0, -GRAVITY, 0))
    n, rho = 40, 1e-3
    weight(scene, "A", 2.0, -R, -1)
    weight(scene, "B", 2.2, n - 1 - R, -1)
    sheaves = [fu.Sheave(f"s{k}", at=(k, -0.5 * (k % 2), 0), radius=R, side=("right", "left")[k % 2]) for k in range(n)]
    scene.rope("rope", route=[fu.Anchor("A"), *sheaves, fu.Anchor("B")], tension=20.6, elements=1,
               **rope_of(1e6, rho, 0, 1e-3))
    length = scene.route_of(scene.ropes["rope"]).length
    run = scene.run(0.1, output_step=0.02, tol=1e-4, integrator="genalpha", progress=False)
    fallen = -0.2 * GRAVITY / (4.2 + rho * length) * 0.1**2 / 2
    assert run["B.position"][-1, 1] + 1 == pytest.approx(fallen, rel=1e-3)
    assert run["A.position"][-1, 1] + 1 == pytest.approx(-fallen, rel=1e-3)
    presses(run, *(sheave.name for sheave in sheaves))
    explained(run, 1e-6)


# ---- little tension

def hung(tension: float, mass: float = 2.0, EA: float = 2e3, damping_time: float = 1e-3) -> tuple[fu.Scene, float]:
    """Return a weight on a light rope that is held behind a sheave, and the rate of its vibration, 1/s."""
    scene = fu.Scene(gravity=(0, -GRAVITY, 0))
    weight(scene, "B", mass, R, -2.0)
    scene.rope("rope", route=[fu.Anchor(at=(-R, -2.0, 0)), fu.Sheave("top", at=(0, 0, 0), radius=R, side="right"),
                              fu.Anchor("B")], elements=1, tension=tension, **rope_of(EA, 1e-4, 0, damping_time))
    return scene, sqrt(EA / scene.route_of(scene.ropes["rope"]).free_length / mass)


def test_a_rope_goes_slack_at_its_sheave():
    """T = m g (1 + 2 cos w t) from three times the weight is zero at w t = 2 pi/3, where the run ends."""
    scene, w = hung(6 * GRAVITY, damping_time=0.0)
    run = ended(scene, "lifts off sheave .top.", "take a higher tension", duration=2.0, output_step=0.01, tol=1e-6,
                integrator="radau")
    assert run.time[-1] == pytest.approx(2 * pi / 3 / w, rel=1e-4)
    presses(run, "top", last=False)


def test_a_start_almost_without_tension():
    """T = m g (1 - cos w t), to twice the weight, and never below zero; then it dies down."""
    scene, w = hung(1e-3)
    run = scene.run(1.0, output_step=0.002, tol=1e-6, integrator="radau", progress=False)
    falls = run.time < 1.5 * pi / w
    expected = 2 * GRAVITY * (1 - np.cos(w * run.time[falls]))
    assert run["top.tension_on"][falls] == pytest.approx(expected, abs=0.03 * 2 * GRAVITY)  # its damping
    presses(run, "top")
    explained(run, 1e-6)


def test_a_start_without_tension_for_the_arc():
    """The tension does not bear the weight of the rope on the sheave: a named error at once."""
    scene, _ = hung(1e-6)
    run = ended(scene, "lifts off sheave .top.*at t = 0 s", "take a higher tension", duration=1.0, output_step=0.1)
    assert run.time.tolist() == [0.0]


def test_almost_slack_and_taut_again():
    """Down to 3 % of its largest value, the tension rises again."""
    scene, _ = hung(1.99 * 2 * GRAVITY)
    run = scene.run(1.0, output_step=0.002, tol=1e-6, integrator="radau", progress=False)
    assert 0 < run["top.tension_on"].min() < 0.03 * run["top.tension_on"].max()
    presses(run, "top")
    explained(run, 1e-7)


# ---- neighbours, interruptions

def on_arm(with_rope: bool) -> fu.Scene:
    """Return a modal cantilever with a sheave at its end below a rope with 50 N on both sides, or 100 N there."""
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.modal_body("arm", start=(-1, 0, 0), end=(0, 0, 0), section=fu.Rectangle(height=0.02, width=0.02),
                     material=fu.Material(youngs_modulus=2e11, poisson_ratio=0.3, density=7800), modes=3,
                     boundary="attached", element="beam12p")
    scene.joint("weld", (-1, 0, 0), ("arm", (0, 0, 0)))
    if not with_rope:
        scene.force("arm", value=(0, -100.0, 0), s=1.0)
        return scene
    for name, x in (("A", -R), ("B", R)):
        weight(scene, name, 5.0, x, -2.0)
        scene.joint("prismatic", (x, -2.0, 0), name, axis=(0, 1, 0))
        scene.spring(name, (x, -3.0, 0), stiffness=100.0, length=0.5)
    time = np.linspace(0, 1, 201)
    scene.force("A", value=(0, -10.0, 0), scale=fu.TableSignal(time=time, value=np.sin(20 * time) ** 2))
    scene.rope("rope", route=[fu.Anchor("A"), fu.Sheave("top", at=("arm", (1.0, 0, 0)), radius=R, side="right"),
                              fu.Anchor("B")], elements=1, tension=50.0, **rope_of(1e5, 0.01, 0, 1e-3))
    return scene


def test_a_sheave_on_a_modal_body():
    """At rest the arm bends as by the force on the sheave; in motion the energy is explained, and integrators agree."""
    scene = on_arm(True)
    rest = scene.equilibrium()
    force, tip = -rest["top.force"][1], rest["arm.modal_coordinates"]
    assert tip == pytest.approx(on_arm(False).equilibrium()["arm.modal_coordinates"] * force / 100.0, rel=1e-4)
    runs = [scene.run(0.2, output_step=0.02, tol=1e-6, integrator=each, progress=False, initial=rest)
            for each in ("genalpha", "radau")]
    for run in runs:
        presses(run, "top")
        explained(run, 1e-5)
    assert np.abs(runs[0]["A.position"] - runs[1]["A.position"]).max() < 1e-6
    assert np.ptp(runs[0]["A.position"][:, 1]) > 5e-3
    assert np.ptp(runs[0]["arm.modal_coordinates"][:, 0]) > 5e-4


def test_paused_resumed_and_replaced():
    """A run that goes on from its middle as the whole run, and with another load from the same state."""
    scene = swing(5.5, 5.0, 0.3, 3.0, 4.0, 0.5)
    over_one(scene, 0.3, ("counterweight", "load"), tension=50.0, given=rope_of(1e5, 0.05, 0, 1e-3))
    settings = {"output_step": 0.1, "tol": 1e-6, "integrator": "radau", "progress": False}
    whole = scene.run(0.4, **settings)
    later = scene.run(0.2, initial=whole.at(0.2), **settings)
    assert np.abs(later["load.position"][-1] - whole["load.position"][-1]).max() < 1e-9
    other = scene.replace("load", mass=6.0).run(0.2, initial=whole.at(0.2), **settings)
    assert np.array_equal(other["load.position"][0], whole["load.position"][2])
    assert np.abs(other["load.position"][-1] - whole["load.position"][-1]).max() > 1e-3
    explained(other, 1e-8)
    presses(other, "top")
