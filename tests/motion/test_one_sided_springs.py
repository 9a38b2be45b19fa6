"""Tension-only springs, free play, tables of tension: closed forms, order of events, energy, equilibrium, refusals."""

import funicular as fu
import numpy as np
import pytest
from expectations import drift
from funicular.model.build import build
from funicular.solve.notes.diagnosis import describe_dof
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicHermiteSpline

MASS, GRAVITY, STIFFNESS = 2.0, 9.81, 400.0
BY_TOL = ("explicit", "radau")
BY_STEP = ("genalpha", "energy")


def hanging(speed, drawn=0.0, **law):
    """Return a mass on a spring of 1 m with an initial extension and a downward speed."""
    scene = fu.Scene(gravity=(0, 0, -GRAVITY))
    scene.rigid_body("m", mass=MASS, inertia=(1, 1, 1), position=(0, 0, -1.0 - drawn), velocity=(0, 0, -speed))
    scene.spring((0, 0, 0), "m", length=1.0, name="dropper", **law)
    return scene


def extension(run):
    return -run["m.position"][:, 2] - 1.0


class Thrown:
    """A mass on a tension-only spring: sines while taut, parabolas while slack, from zero extension."""

    def __init__(self, speed, duration):
        self.omega, self.shift = np.sqrt(STIFFNESS / MASS), MASS * GRAVITY / STIFFNESS
        self.speed, self.instants = speed, [0.0]
        radius = np.hypot(self.shift, speed / self.omega)
        self.taut = 2 * (np.pi - np.arctan2(speed / self.omega, self.shift)) / self.omega
        self.slack = 2 * speed / GRAVITY
        assert radius > self.shift
        while self.instants[-1] < duration:
            self.instants.append(self.instants[-1] + (self.taut if len(self.instants) % 2 else self.slack))

    def __call__(self, time):
        k = np.searchsorted(self.instants, time, side="right") - 1
        t = time - np.array(self.instants)[k]
        sine = (self.shift * (1 - np.cos(self.omega * t)) + self.speed / self.omega * np.sin(self.omega * t))
        return np.where(k % 2 == 0, sine, -self.speed * t + GRAVITY * t**2 / 2)


@pytest.mark.parametrize("integrator", BY_TOL)
def test_a_mass_thrown_up_follows_sines_and_parabolas(integrator):
    run = hanging(0.5, stiffness=STIFFNESS, tension_only=True).run(
        duration=2.0, output_step=0.01, integrator=integrator, tol=1e-9)
    exact = Thrown(0.5, 2.0)
    assert np.abs(extension(run) - exact(run.time)).max() < 1e-8
    events = [event for event in run.report["events"] if event["time"] > 1e-6]
    assert [event["what"] for event in events] == (["became slack", "became taut"] * 9)[:len(events)]
    assert len(events) == len([t for t in exact.instants if 0 < t < 2.0])
    assert np.abs(np.subtract([event["time"] for event in events], exact.instants[1:len(events) + 1])).max() < 1e-9
    assert drift(run) < 1e-8


@pytest.mark.parametrize("integrator", BY_STEP)
def test_integrators_of_order_two_follow_the_same_by_tol(integrator):
    run = hanging(0.5, stiffness=STIFFNESS, tension_only=True).run(
        duration=0.6, output_step=0.01, integrator=integrator, tol=1e-8)
    exact = Thrown(0.5, 0.6)
    assert np.abs(extension(run) - exact(run.time)).max() < 1e-8
    events = [event["time"] for event in run.report["events"] if event["time"] > 1e-6]
    assert np.abs(np.subtract(events, exact.instants[1:3])).max() < 1e-8
    assert drift(run) < (1e-12 if integrator == "energy" else 1e-9)


@pytest.mark.parametrize("integrator", BY_STEP)
def test_fixed_steps_keep_their_order_where_it_becomes_slack(integrator):
    exact, errors = Thrown(0.5, 1.0), []
    for step in (2e-3, 1e-3):
        run = hanging(0.5, stiffness=STIFFNESS, tension_only=True).run(
            duration=1.0, output_step=0.02, integrator=integrator, step=step)
        errors.append(np.abs(extension(run) - exact(run.time)).max())
    assert errors[1] < 3e-5
    assert np.log2(errors[0] / errors[1]) > 1.7
    if integrator == "energy":
        assert drift(run) < 1e-12


TABLE = {"extension": [-0.1, 0, 0.05, 0.1], "tension": [-30, 0, 10, 60]}
FROM_TABLE = ([-1.1, -0.1, 0, 0.05, 0.1, 1.1], [-330, -30, 0, 10, 60, 1060])
DAMPING = 12.0
LAWS = {
    "damper never pushes": ({"stiffness": STIFFNESS, "damping": DAMPING, "tension_only": True},
                            lambda x, v: max(0.0, STIFFNESS * x + DAMPING * v) if x > 0 else 0.0),
    "free play": ({"stiffness": STIFFNESS, "free_play": 0.1},
                  lambda x, v: STIFFNESS * (x - np.clip(x, -0.05, 0.05))),
    "damped free play": ({"stiffness": STIFFNESS, "free_play": 0.1, "damping": DAMPING},
                         lambda x, v: (max(0.0, STIFFNESS * (x - 0.05) + DAMPING * v) if x > 0.05 else
                                       min(0.0, STIFFNESS * (x + 0.05) + DAMPING * v) if x < -0.05 else 0.0)),
    "table": ({"table": TABLE}, lambda x, v: np.interp(x, *FROM_TABLE)),
    "table that pulls alone": ({"table": TABLE, "tension_only": True, "damping": DAMPING},
                               lambda x, v: max(0.0, np.interp(x, *FROM_TABLE) + DAMPING * v) if x > 0 else 0.0),
}


@pytest.fixture(scope="module")
def references():
    """Return the motion by law, from a Runge-Kutta method with short steps, at the times of rows."""
    time = np.linspace(0, 1, 51)
    return {name: solve_ivp(lambda t, y, force=force: [y[1], GRAVITY - force(*y) / MASS], (0, 1), [0, 1.5],
                            rtol=1e-8, atol=1e-10, t_eval=time, max_step=2e-4).y[0]
            for name, (_, force) in LAWS.items()}


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("integrator", (*BY_TOL, *BY_STEP))
@pytest.mark.slow_cases("explicit-damper never pushes")
def test_laws_of_pieces(law, integrator, references):
    size = {"tol": 1e-8} if integrator in BY_TOL else {"step": 5e-4}
    run = hanging(1.5, **LAWS[law][0]).run(duration=1.0, output_step=0.02, integrator=integrator, **size)
    assert np.abs(extension(run) - references[law]).max() < (1e-6 if integrator in BY_TOL else 2e-5)
    assert drift(run) < {"explicit": 1e-7, "radau": 1e-7, "genalpha": 1e-4, "energy": 1e-12}[integrator]
    if LAWS[law][0].get("tension_only"):
        assert run["dropper.tension"].min() >= 0.0


@pytest.mark.parametrize("integrator", BY_TOL)
def test_a_damped_spring_that_pulls_alone_dissipates_what_it_does_not_give_back(integrator):
    run = hanging(-4.0, 0.3, stiffness=STIFFNESS, damping=40.0, tension_only=True).run(
        duration=2.0, output_step=0.001, integrator=integrator, tol=1e-8)
    cut = (extension(run) > 1e-4) & (run["dropper.tension"] == 0.0)
    assert cut[:50].all()  # slack though longer than its length: the damper would push
    assert run["dropper.tension"].max() > 10.0
    assert np.diff(run["energy.dissipated"]).min() > -1e-9
    assert drift(run) < 1e-7


def test_droppers_unload_and_reload_between_two_wires():
    """A wire under two droppers is lifted in its middle and lowered: the droppers lose their force and regain it."""
    scene = fu.Scene(gravity=(0, 0, -9.81))
    wire = scene.cable("wire", start=(0, 0, 0), end=(10, 0, 0), elements=20, element="cable12",
                       section=fu.Circle(radius=6e-3),
                       material=fu.Material(youngs_modulus=1e11, poisson_ratio=0.3, density=8900),
                       rest_length=10 / (1 + 7e-4))
    length = wire.rest_length
    for s in (0.0, length):
        scene.pin(wire, s=s)
    for k, s in enumerate((0.3, 0.7)):
        scene.spring((10 * s, 0, 1.0), (wire, s * length), stiffness=1e5, length=0.998, tension_only=True,
                     name=f"dropper{k}")
    lift = fu.TableSignal(time=[0, 0.3, 0.5, 0.8], value=[0, 1, 1, 0])
    scene.force(wire, s=length / 2, value=(0, 0, 120.0), scale=lift)
    run = scene.run(duration=1.5, output_step=0.005, tol=1e-5, initial="equilibrium")
    force = run["dropper0.tension"]
    assert force[0] > 20.0
    assert force.min() == 0.0
    assert np.abs(force - run["dropper1.tension"]).max() < 1e-2 * force.max()  # symmetric
    slack = [event for event in run.report["events"] if event["what"] == "became slack"]
    taut = [event for event in run.report["events"] if event["what"] == "became taut"]
    assert slack and len(taut) >= len(slack) - 2
    for event in (e for e in slack + taut if e["name"] == "dropper0"):
        side = np.interp([event["time"] - 0.006, event["time"] + 0.006], run.time, run["dropper0.length"]) - 0.998
        assert side.min() < 2e-5  # the passage is near: neither is deep in a spring of 1e5 N/m


def between_two_droppers(speed, preload):
    """Return the instants of half a period, and a function of time: a mass between two tension-only droppers.

    It begins in the middle with this speed, while both pull, each extended by the preload (m). Beyond it one is slack,
    and the other pulls with more than twice the preload.
    """
    both, one = np.sqrt(2 * STIFFNESS / MASS), np.sqrt(STIFFNESS / MASS)
    slack = np.arcsin(preload * both / speed) / both
    left = speed * np.cos(both * slack) / one
    taut = slack + (np.pi - 2 * np.arctan2(2 * preload, left)) / one
    half = slack + taut

    def place(time):
        side, t = np.where(time % (2 * half) < half, 1, -1), time % half
        t_one = one * (t - slack)
        alone = 2 * preload * np.cos(t_one) + left * np.sin(t_one) - preload
        return side * np.where((t > slack) & (t < taut), alone, speed / both * np.sin(both * np.minimum(t, half - t)))

    return (slack, taut, half), place


@pytest.mark.parametrize("integrator", (*BY_TOL, *BY_STEP))
@pytest.mark.slow_cases("energy")
def test_a_pair_of_droppers_unloads_and_reloads_as_sines(integrator):
    (slack, taut, half), place = between_two_droppers(0.6, 0.02)
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.rigid_body("m", mass=MASS, inertia=(1, 1, 1), position=(0, 0, 0), velocity=(0.6, 0, 0))
    for name, x in (("left", -1), ("right", 1)):
        scene.spring((x, 0, 0), "m", stiffness=STIFFNESS, length=0.98, tension_only=True, name=name)
    run = scene.run(duration=1.0, output_step=0.01, integrator=integrator, tol=1e-8)
    assert np.abs(run["m.position"][:, 0] - place(run.time)).max() < 1e-8
    exact = [(k * half + t, "right" if k % 2 == 0 else "left", what) for k in range(int(1 / half) + 1)
             for t, what in ((slack, "became slack"), (taut, "became taut")) if k * half + t < 1.0]
    assert [(event["name"], event["what"]) for event in run.events] == [each[1:] for each in exact]
    assert np.abs(np.subtract([event["time"] for event in run.events], [each[0] for each in exact])).max() < (
        1e-9 if integrator in BY_TOL else 1e-8)
    assert drift(run) < (1e-12 if integrator == "energy" else 1e-8)


def test_rest_on_droppers_takes_those_that_are_taut():
    scene = fu.Scene(gravity=(0, 0, -10.0))
    scene.rigid_body("m", mass=1.0, inertia=(1, 1, 1), position=(0, 0, -1.0))
    scene.spring((0, 0, 0), "m", stiffness=100.0, length=1.0, tension_only=True, name="upper")
    scene.spring("m", (0, 0, -2.0), stiffness=1e4, length=1.5, tension_only=True, name="lower")
    rest = scene.equilibrium()
    assert rest["m.position"][2] == pytest.approx(-1.1, abs=1e-9)
    assert rest["upper.tension"] == pytest.approx(10.0, rel=1e-9)
    assert rest["lower.tension"] == 0.0


@pytest.mark.parametrize("law, cause", [
    ({"tension_only": True}, "needs a stiffness"),
    ({"free_play": 0.1}, "needs a stiffness"),
    ({"stiffness": 1.0, "table": TABLE}, "both a stiffness and a table"),
    ({"free_play": 0.1, "table": TABLE}, "both free play and a table"),
    ({"table": {"extension": [0, 1], "tension": [0, 1, 2]}}, "equal length"),
    ({"table": {"extension": [0, 0], "tension": [0, 1]}}, "must increase"),
    ({"table": {"extension": [0, 1, 2], "tension": [0, 5, 0]}, "tension_only": True}, "at large extensions"),
    ({"table": {"extension": [0, 1, 2, 3], "tension": [0, 5, -1, 9]}, "tension_only": True}, "lose its tension"),
    ({"table": {"extension": [0, 1], "tension": [5, 5]}, "tension_only": True}, "at small extensions"),
])
def test_laws_that_are_none_are_refused(law, cause):
    with pytest.raises(fu.SceneError, match=cause):
        hanging(0.0, **law)


def test_scene_files_have_them(tmp_path):
    scene = hanging(0.5, table=TABLE, tension_only=True)
    file = tmp_path / "scene.toml"
    file.write_text(scene.to_toml())
    again = fu.load_scene(file)
    assert again.point_forces["dropper"] == scene.point_forces["dropper"]


@pytest.mark.parametrize("law, loses", [
    ({"stiffness": 100.0, "tension_only": True}, False), ({"stiffness": 100.0, "free_play": 1.2}, False),
    ({"stiffness": 100.0, "free_play": 0.1}, True), ({"table": TABLE}, True),
    ({"table": TABLE, "tension_only": True}, False)])
def test_ends_that_meet_are_refused_where_the_spring_then_has_a_force(law, loses):
    scene = fu.Scene()
    scene.rigid_body("m", mass=MASS, inertia=(1, 1, 1), position=(0, 0, 0))
    if loses:
        with pytest.raises(fu.SceneError, match="its direction is lost"):
            scene.spring("m", (0, 0, 0), length=0.5, **law)
        return
    scene.spring("m", (0, 0, 0), length=0.5, **law)
    run = scene.run(duration=0.1, tol=1e-6)
    assert run["m.position"][-1, 1] == pytest.approx(-GRAVITY * 0.1**2 / 2, rel=1e-9)


@pytest.mark.parametrize("tol", [3e-2, 1e-2])
def test_steps_go_over_what_tol_allows_and_tell_when(tol):
    scene = hanging(0.5, stiffness=STIFFNESS, tension_only=True)
    run = scene.run(duration=2.0, output_step=0.01, integrator="genalpha", tol=tol)
    events = [event for event in run.report["events"] if event["time"] > 1e-6]
    assert [event["what"] for event in events] == (["became slack", "became taut"] * 4)[:len(events)]
    assert [event["time"] for event in events] == sorted(event["time"] for event in events)
    passed = [event for event in events if event.get("passed")]
    assert passed
    along = CubicHermiteSpline(run.time, extension(run), -run["m.velocity"][:, 2])
    speed = np.abs(along.derivative()([event["time"] for event in passed]))
    assert np.all(np.abs(along([event["time"] for event in passed])) < 1e-3 * tol * speed)
    landed = scene.run(duration=2.0, output_step=0.01, integrator="radau", step=0.01)
    assert not any(event.get("passed") for event in landed.report["events"])
    assert drift(run) < 10 * tol * np.ptp(run["energy.kinetic"])


def test_a_damper_that_would_jump_is_not_gone_over_but_where_little_comes_of_it():
    law = {"stiffness": STIFFNESS, "damping": 40.0, "tension_only": True}
    run = hanging(-4.0, 0.3, **law).run(duration=2.0, output_step=0.01, integrator="genalpha", tol=1e-4)
    exact = hanging(-4.0, 0.3, **law).run(duration=2.0, output_step=0.01, integrator="radau", tol=1e-9)
    assert [event["what"] for event in run.report["events"]] == [event["what"] for event in exact.report["events"]]
    assert np.abs(extension(run) - extension(exact)).max() < 5e-4 * np.ptp(extension(exact))


@pytest.mark.parametrize("integrator", ["genalpha", "radau"])
def test_a_resumed_run_tells_the_same_events(tmp_path, integrator):
    given = {"duration": 2.0, "output_step": 0.01, "integrator": integrator, "tol": 1e-2}

    def stop(time):
        if time > 1.0:
            raise KeyboardInterrupt

    scene = hanging(0.5, stiffness=STIFFNESS, tension_only=True)
    whole = scene.run(**given, save=tmp_path / "whole.nc")
    assert scene.run(**given, save=tmp_path / "out.nc", progress=stop).status == "interrupted"
    assert scene.run(**given, save=tmp_path / "out.nc", resume=True).events == whole.events
    assert whole.events[-1]["time"] > 1.0


def test_events_of_a_user_and_those_gone_over_are_in_order(tmp_path):
    scene = hanging(0.5, stiffness=STIFFNESS, tension_only=True)
    for k in range(9):  # below, where it is taut, and above, where it is slack
        scene.event(f"at_{k}", quantity="m.position.z", value=-1.0 + 2e-3 * (k - 4))
    scene.event("end", function=lambda time, state: state["m.position"][2] + 0.99, direction="falling", action="stop")
    run = scene.run(duration=2.0, output_step=0.01, integrator="genalpha", tol=3e-2)
    times = [event["time"] for event in run.events]
    assert times == sorted(times)
    assert run.events[-1]["name"] == "end"
    assert [event["what"] for event in run.events if event["name"] == "dropper"][-1] == "became slack"


def test_a_spring_that_changes_without_end_is_named():
    model = build(hanging(0.5, stiffness=STIFFNESS, tension_only=True))
    assert describe_dof(model, 0, 0) == 'point force "dropper"'


INTEGRATORS = (*BY_TOL, *BY_STEP)
STEP = 0.05


def grazing(beyond, peak=0.5125, **law):
    """Return a mass thrown against gravity, whose spring would be extended by `beyond` (m) at the peak."""
    scene = fu.Scene(gravity=(0, 0, GRAVITY))
    speed = GRAVITY * peak
    scene.rigid_body("m", mass=MASS, inertia=(1, 1, 1), position=(0, 0, -1 - beyond + speed * peak / 2),
                     velocity=(0, 0, -speed))
    scene.spring((0, 0, 10), "m", length=11.0, name="dropper", stiffness=STIFFNESS, tension_only=True, **law)
    return scene


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("damping", [0.0, DAMPING])
@pytest.mark.parametrize("part", [1e-3, 0.1])
def test_a_spring_that_is_taut_for_a_part_of_a_step_is_not_missed(integrator, damping, part):
    """The mass is free, then the spring is taut for at most a quarter of a thousandth of a vibration."""
    half, peak = STEP * part / 2, 0.5125
    run = grazing(GRAVITY * half**2 / 2, peak, damping=damping).run(duration=1.0, output_step=STEP, step=STEP,
                                                                   integrator=integrator)
    events = run.report["events"]
    assert [event["what"] for event in events] == ["became taut", "became slack"]
    found = [event["time"] for event in events]
    assert found[0] == pytest.approx(peak - half, abs=1e-5 * STEP if events[0].get("passed") else 1e-9)
    assert found[0] < found[1] < peak + half * (1 + part)
    assert run.report["steps"] < 1.5 / STEP


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("size", ["fixed", "by tol"])
def test_a_quantity_that_passes_a_value_and_is_back_within_a_step_is_noted(integrator, size):
    """The closed form of the height decides, for one event or both directions; a miss by 1e-3 of the path is none."""
    half, peak = 1e-3, 0.5125
    beyond = GRAVITY * half**2 / 2
    scene = grazing(-1.0, peak)
    for name, value, direction in (("both", beyond, "both"), ("rising", beyond, "rising"), ("missed", -1e-3, "both")):
        scene.event(name, quantity="m.position.z", value=value, direction=direction)
    run = scene.run(duration=1.0, output_step=STEP, step=STEP if size == "fixed" else None, integrator=integrator)
    found = {name: [event["time"] for event in run.report["events"] if event["name"] == name]
             for name in ("both", "rising", "missed")}
    assert found["both"] == pytest.approx([peak - half, peak + half], abs=1e-9)
    assert found["rising"] == pytest.approx([peak + half], abs=1e-9)
    assert found["missed"] == []


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_quantity_that_turns_in_the_step_after_its_event_is_seen_to_pass_back(integrator):
    peak, half = 0.5125, 0.02
    scene = grazing(-1.0, peak)
    scene.event("low", quantity="m.position.z", value=GRAVITY * half**2 / 2)
    run = scene.run(duration=1.0, output_step=0.2, step=0.2, integrator=integrator)
    assert [event["time"] for event in run.report["events"]] == pytest.approx([peak - half, peak + half], abs=1e-9)
