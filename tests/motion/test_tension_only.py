"""Cables without stiffness in compression: membrane="tension_only"."""

import funicular as fu
import numpy as np
import pytest

EA, LEFT, TRANSITION = 1e9 * np.pi * 1e-6, 1e-4, 1e-6


def wire(membrane, element="cable12", elements=8, stretch=1.0):
    """Return a wire of 1 m, pinned at both ends, drawn with this stretch."""
    scene = fu.Scene(gravity=(0, -9.81, 0))
    rope = scene.cable("wire", start=(0, 0, 0), end=(1, 0, 0), elements=elements, element=element, membrane=membrane,
                       strain="engineering", section=fu.Circle(radius=1e-3), rest_length=1.0 / stretch,
                       material=fu.Material(youngs_modulus=1e9, poisson_ratio=0.3, density=1100))
    scene.pin(rope, s=0)
    scene.pin(rope, s=1.0 / stretch)
    return scene


def energy_as_drawn(scene):
    """Return the elastic energy at the start."""
    run = scene.run(duration=1e-9, step=1e-9, integrator="genalpha", output_step=1e-9)
    return run["energy.elastic"][0]


@pytest.mark.parametrize("element", ["cable8p", "cable12"])
@pytest.mark.parametrize("strain", [1e-3, 1e-2, -1e-3, -1e-2])
def test_energy_of_a_strain(element, strain):
    stored = energy_as_drawn(wire("tension_only", element, stretch=1 + strain))
    ideal = EA / 2 * strain**2 * (1.0 if strain > 0 else LEFT) / (1 + strain)
    transition = 1.001 * EA * TRANSITION * abs(strain) / 4 / (1 + strain)  # of both branches
    assert abs(stored - ideal) <= transition


def test_a_taut_wire_hangs_as_with_the_full_law():
    states = [wire(membrane, stretch=1.01).equilibrium()["wire.nodal_vectors"] for membrane in ("full", "tension_only")]
    sag = np.ptp(states[0][:, 0, 1])
    assert np.abs(states[0] - states[1])[:, 0].max() < 2e-4 * sag  # 2.5e-7/1e-2 of the tension, and bending


def test_a_longer_wire_takes_fewer_steps():
    """Drawn with a compression of 0.5 %: a full wire rebounds axially, a tension-only one falls."""
    steps = {membrane: wire(membrane, stretch=1 / 1.005).run(
        duration=0.1, output_step=0.01, tol=1e-3, integrator="radau").report["steps"]
        for membrane in ("full", "tension_only")}
    assert steps["tension_only"] < steps["full"] / 1.5


def test_the_energy_integrator_balances_it_to_rounding():
    scene = wire("tension_only", stretch=1 / 1.005)
    run = scene.run(duration=0.05, output_step=0.01, step=1e-4, integrator="energy")
    total = sum(run[f"energy.{part}"] for part in ("kinetic", "elastic", "potential", "dissipated"))
    assert np.ptp(total) < 1e-9 * np.ptp(run["energy.potential"])


def test_it_is_a_law_of_straight_cables_with_engineering_strain():
    assert wire("tension_only").cables["wire"].law == "engineering_exact_tension_only"
    common = {"start": (0, 0, 0), "end": (1, 0, 0), "elements": 4, "section": fu.Circle(radius=1e-3),
              "material": fu.Material(youngs_modulus=1e9, poisson_ratio=0.3, density=1100)}
    scene = fu.Scene()
    scene.cable("a", element="cable12", membrane="tension_only", **common)
    assert scene.cables["a"].law == "engineering_exact_tension_only"
    for given in ({"element": "cable12", "strain": "green"}, {"element": "cable18"}, {"element": "beam24"},
                  {"element": "cable12", "curvature": "linear"}):
        with pytest.raises(fu.SceneError, match=r"is not possible|are for cable elements"):
            scene.cable("b", membrane="tension_only", **given, **common)


def let_loose(element="cable12", action="record", elements=8):
    """Return a taut wire whose end approaches smoothly for a while."""
    scene = fu.Scene(gravity=(0, -9.81, 0))
    wire = scene.cable("wire", start=(0, 0, 0), end=(1, 0, 0), elements=elements, element=element,
                       membrane="tension_only", section=fu.Circle(radius=1e-3), rest_length=1 / 1.001,
                       material=fu.Material(youngs_modulus=1e8, poisson_ratio=0.3, density=1100))
    scene.pin(wire, s=0)
    way = fu.TableSignal(time=[0, 0.05, 0.1, 0.15], value=[0, -0.004, -0.004, 0.002], interpolation="cubic")
    scene.motion(wire, s=1 / 1.001, displacement=(way, 0, 0))
    if action == "stop":
        scene.event(quantity="wire.least_strain", direction="falling", action="stop", name="first")
    return scene


@pytest.mark.parametrize("element", ["cable8p", "cable12"])
def test_slack_elements_are_noted(element):
    run = let_loose(element).run(duration=0.1, output_step=1e-4, integrator="radau", tol=1e-5)
    slack = run.slack_elements("wire")
    assert slack.dims == ("time", "element")
    assert slack.shape == (len(run.time), 8)
    assert slack.s[0] == pytest.approx(1 / 1.001 / 16)
    some, events = slack.any("element").values, run.report["events"]
    assert not some[0] and some.any()
    assert [event["what"] for event in events] == (["became slack", "all taut again"] * len(events))[:len(events)]
    for event in events:  # between the rows before and after it, unless another one is there, too
        k = int(np.searchsorted(run.time, event["time"]))
        if sum(run.time[k - 1] <= other["time"] <= run.time[k] for other in events) == 1:
            assert (some[k - 1], some[k]) == ((False, True) if event["what"] == "became slack" else (True, False))
    first = int(np.argmax(some))
    assert run.time[first - 1] <= events[0]["time"] <= run.time[first]
    assert slack.values[first, events[0]["element"]]


def test_rounding_makes_no_element_slack():
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.cable("wire", start=(0, 0, 0), end=(0.7, 0.1, 0.2), elements=12, element="cable12",
                section=fu.Circle(radius=1e-3), membrane="tension_only",
                material=fu.Material(youngs_modulus=1e8, poisson_ratio=0.3, density=1100))
    scene.pin("wire", s=0)
    rest = scene.equilibrium()
    assert not rest.slack_elements("wire").values.any()
    run = scene.run(duration=0.01, output_step=0.01, integrator="radau", tol=1e-5, progress=False)
    assert not run.slack_elements("wire").values.any() and not run.report["events"]


def test_a_run_ends_where_a_cable_becomes_slack_if_asked():
    whole = let_loose().run(duration=0.1, output_step=1e-3, integrator="radau", tol=1e-6)
    run = let_loose(action="stop").run(duration=0.1, output_step=1e-3, integrator="radau", tol=1e-6)
    assert run.status == "event"
    assert run.time[-1] == pytest.approx(whole.report["events"][0]["time"], abs=1e-5)
    with pytest.raises(fu.SceneError, match=r"cannot be watched|has no place"):
        let_loose().event(quantity="wire.least_strain", s=0.5, name="there")


def test_a_state_of_rest_tells_which_elements_are_slack():
    scene = fu.Scene(gravity=(0, -9.81, 0))
    wire = scene.cable("wire", start=(0, 0, 0), end=(0, -1, 0), elements=8, element="cable12", membrane="tension_only",
                       section=fu.Circle(radius=1e-3), rest_length=1.0,
                       material=fu.Material(youngs_modulus=1e6, poisson_ratio=0.3, density=1100))
    for s in (0, 1.0):
        scene.clamp(wire, s=s)
    slack = scene.equilibrium().slack_elements("wire").values
    assert list(slack) == [False] * 7 + [True]  # its weight hangs on the upper end
    with pytest.raises(fu.UnknownResultError, match='there is no cable "rope"'):
        scene.equilibrium().slack_elements("rope")


def test_a_resumed_run_notes_the_same(tmp_path):
    given = {"duration": 0.1, "output_step": 1e-3, "integrator": "radau", "tol": 1e-4}

    def stop(time):
        if time > 0.045:
            raise KeyboardInterrupt

    whole = let_loose().run(**given, save=tmp_path / "whole.nc")
    assert let_loose().run(**given, save=tmp_path / "out.nc", progress=stop).status == "interrupted"
    resumed = let_loose().run(**given, save=tmp_path / "out.nc", resume=True)
    assert resumed.events == whole.events
    assert whole.events[-1]["time"] > 0.06


def test_a_slack_rope_comes_to_rest_by_a_damped_motion():
    scene = let_loose()
    length = 1 / 1.001
    at_rest = fu.Scene(gravity=(0, -9.81, 0))
    cable = scene.cables["wire"].as_made().entries() | {"end": (0.98, 0, 0)}
    at_rest.cable(cable.pop("name"), **cable)
    for s in (0, length):
        at_rest.pin("wire", s=s)
    relaxed, found = at_rest.relax(), at_rest.equilibrium()
    assert relaxed["wire.position"] == pytest.approx(found["wire.position"], abs=1e-6)


def shortened(element="cable8p", speed=-1.0, damping_time=1e-3, membrane="tension_only", pull=0.0,
              radius=0.005):
    """Return a straight rope of 1 m without gravity, drawn longer by pull, with an axially moving mass of 1 kg at its
    end.
    """
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.cable("rope", start=(0, 0, 0), end=(1 + pull, 0, 0), elements=2, element=element, strain="engineering",
                membrane=membrane, rest_length=1.0, section=fu.Circle(radius=radius),
                material=fu.Material(youngs_modulus=1e7, poisson_ratio=0.3, density=0.1, damping_time=damping_time))
    scene.pin("rope", s=0.0)
    scene.rigid_body("A", mass=1.0, inertia=(1, 1, 1), position=(1 + pull, 0, 0), velocity=(speed, 0, 0))
    scene.joint("spherical", ("rope", 1.0), "A", name="end")
    return scene


SLACK_EA = 1e7 * np.pi * 0.005**2


@pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")
@pytest.mark.parametrize(("element", "integrator"), [
    ("cable8p", "radau"), ("cable8p", "genalpha"), ("cable8p", "explicit"), ("cable12", "radau")])
def test_a_slack_rope_is_damped_by_the_part_that_it_resists_with(element, integrator):
    """At a strain of 0.3 both forces are 1e-4 of the full law's."""
    run = shortened(element).run(duration=0.3, tol=1e-6, output_step=0.05, integrator=integrator)
    elastic, damping = LEFT * SLACK_EA * 0.3, LEFT * SLACK_EA * 1e-3
    assert run["end.force"][-1, 0] == pytest.approx(elastic + damping + SLACK_EA * TRANSITION / 4, rel=0.01)
    by_balance, by_law = (run.section_forces("rope", s=[0.25, 0.75], method=method).tension[-1]
                          for method in ("balance", "constitutive"))
    assert np.asarray(by_balance) == pytest.approx(np.asarray(by_law), rel=0.01)
    assert run["energy.dissipated"][-1] == pytest.approx(LEFT * SLACK_EA * 1e-3 * 0.3, rel=0.1)
    total = sum(run[f"energy.{part}"] for part in ("kinetic", "elastic", "dissipated"))
    assert np.ptp(total) < 1e-6


@pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")
def test_a_taut_rope_is_damped_as_with_the_full_law():
    """It vibrates about a stretch of 0.1, far above the transition strain."""
    lost = {membrane: shortened(speed=0.3, membrane=membrane, pull=0.1).run(
        duration=0.04, tol=1e-7, output_step=0.02, integrator="radau")["energy.dissipated"][-1]
        for membrane in ("full", "tension_only")}
    assert lost["tension_only"] == pytest.approx(lost["full"], rel=1e-4)
    assert lost["full"] > 1e-3


@pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")
def test_a_straight_slack_rope_is_said_to_bear_what_is_left():
    """The force in the note on buckling is that of the reduced law."""
    run = shortened(damping_time=0.0, radius=0.002).run(duration=0.5, tol=1e-6, output_step=0.05)
    [note] = [message for message in run.report["messages"] if "perfectly straight" in message]
    said = float(note.partition("under a compression of ")[2].partition(" N")[0])
    assert said == pytest.approx(-run.section_forces("rope", s=0.5, method="constitutive").tension[-1].item(), rel=0.01)
    assert said == pytest.approx(LEFT * SLACK_EA * 0.16 * 0.5, rel=0.01)


def pulled_down():
    """Return a rope of two elements with a body at its end, which a spring pulls sideways."""
    scene = fu.Scene()
    scene.cable("w", start=(0, 0, 0), end=(1, 0, 0), elements=2, element="cable8p", section=fu.Circle(radius=0.005),
                membrane="tension_only", material=fu.Material(youngs_modulus=1e7, poisson_ratio=0.0, density=1000))
    scene.pin("w", s=0.0)
    scene.rigid_body("A", mass=1.0, inertia=(1e-3,) * 3, position=(1, 0, 0))
    scene.joint("spherical", ("w", 1.0), "A")
    scene.spring("A", (1, 0.25, 0), stiffness=600.0, length=0.2)
    return scene


def growing(run):
    return [message for message in run.report["messages"] if "small differences grow" in message]


def off(run, reference, name):
    """Return the largest error of positions relative to the largest motion."""
    exact = reference[f"{name}.position"]
    return np.abs(run[f"{name}.position"] - exact).max() / np.abs(exact - exact[0]).max()


@pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")
@pytest.mark.parametrize(("make", "name", "settings"), [
    (pulled_down, "A", {"duration": 1.0, "output_step": 0.01}),
    (lambda: wire("tension_only", elements=4, stretch=1 / 1.02), "wire", {"duration": 0.5, "output_step": 5e-3})])
def test_growing_errors_of_slack_cables_are_noted(make, name, settings):
    """The compression is small; the errors are 200 tol and more."""
    run, reference = (make().run(tol=tol, **settings) for tol in (1e-4, 1e-8))
    assert off(run, reference, name) > 1e-2
    [note] = growing(run)
    assert f'cable "{"w" if name == "A" else name}" becomes slack: from t = ' in note
    times = float(note.partition("errors may become ")[2].split()[0])
    assert 0.1 * times * 1e-4 < off(run, reference, name) < 10 * times * 1e-4


@pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")
@pytest.mark.parametrize(("make", "name", "settings"), [
    (lambda: let_loose("cable8p"), "wire", {"duration": 0.15, "output_step": 1e-3, "tol": 1e-3}),
    (lambda: wire("tension_only", stretch=1 / 1.005), "wire", {"duration": 0.1, "output_step": 1e-3, "tol": 1e-3}),
    (shortened, "rope", {"duration": 0.3, "output_step": 1e-2, "tol": 1e-6}),
    (pulled_down, "A", {"duration": 0.1, "output_step": 1e-3, "tol": 1e-4})])
def test_slack_cables_whose_errors_stay_small_say_nothing(make, name, settings):
    run = make().run(**settings)
    assert run.slack_elements(next(iter(run.scene.cables))).values.any() or name == "A"
    assert off(run, make().run(**settings | {"tol": 1e-3 * settings["tol"]}), name) < 3 * settings["tol"]
    assert not growing(run)
