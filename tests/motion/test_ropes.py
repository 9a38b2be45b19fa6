"""Ropes in motion: energy, momentum, agreement of integrators, other axes, order and units, files, and how runs end."""

import re

import funicular as fu
import numpy as np
import pytest
from expectations import refused
from funicular.engine import Engine
from funicular.model.build import build
from interrupted_runs import killed_and_resumed
from rewritten import in_units
from turned_scenes import turned_scene

THIN = {"section": fu.Circle(radius=1e-3), "elements": 2,
        "material": fu.Material(youngs_modulus=6e8, poisson_ratio=0.3, density=7000, damping_time=1e-4)}
FRICTION = fu.Friction(coefficient=0.2, velocity=0.1)
SHEAVES = {"smooth": {}, "rough": {"friction": FRICTION, "zones": 3},
           "turning": {"friction": FRICTION, "zones": 3, "inertia": 0.02}}
INTEGRATORS = ("genalpha", "radau", "explicit")
BRIEF = {"duration": 0.1, "output_step": 0.05, "tol": 1e-6}


def body(scene, name, x, y, mass=2.0, **given):
    scene.rigid_body(name, mass=mass, inertia=(1, 1, 0.1), position=(x, y, 0), **given)


def swing(**sheave) -> fu.Scene:
    """Return a load that swings from a rope with a counterweight."""
    scene = fu.Scene(gravity=(0, -9.81, 0))
    body(scene, "C", -0.2, -1.5, 2.2)
    body(scene, "L", 0.9, -1.2, 2.0, velocity=(0.3, 0, 0))
    scene.rope("hoist", route=[fu.Anchor("C", at=(0, 0.1, 0)), fu.Sheave("top", at=(0, 0, 0), radius=0.2, **sheave),
                               fu.Anchor("L")], tension=20.0, **THIN)
    return scene


def row(n: int, **sheave) -> fu.Scene:
    """Return two weights on a rope over and under n sheaves in a row."""
    scene = fu.Scene(gravity=(0, -9.81, 0))
    body(scene, "A", -0.2, -1)
    body(scene, "B", n - 0.8, -1, 2.2)
    sheaves = [fu.Sheave(f"s{k}", at=(k, -0.5 * (k % 2), 0), radius=0.2, side=("right", "left")[k % 2], **sheave)
               for k in range(n)]
    scene.rope("hoist", route=[fu.Anchor("A"), *sheaves, fu.Anchor("B")], tension=20.0, **THIN | {"elements": 1})
    return scene


def carried(**sheave) -> fu.Scene:
    """Return a rope over a body that moves and turns, between two bodies; the sum of all loads is zero."""
    scene = fu.Scene(gravity=(0, 0, 0))
    body(scene, "A", -0.2, -1, velocity=(0, -0.1, 0))
    body(scene, "B", 0.3, -1.2, 3.0, velocity=(0.2, -0.1, 0))
    body(scene, "S", 0, 0.1, 5.0, velocity=(0, 0.1, 0), angular_velocity=(0, 0, 0.5))
    top = fu.Sheave("top", at=("S", (0.02, -0.05, 0)), radius=0.2, **sheave)
    scene.rope("hoist", route=[fu.Anchor("A", at=(0, 0.1, 0)), top, fu.Anchor("B")], tension=30.0, **THIN)
    for name, force in FORCES.items():
        scene.force(name, value=(0, force, 0))
    return scene


FORCES = {"A": -30.0, "B": -30.0, "S": 60.0}


def near(one, other, bound, *names):
    for name in names:
        assert np.abs(one[name] - other[name]).max() < bound, name


# ---- energy, momentum, integrators

@pytest.mark.parametrize("sheave", SHEAVES)
def test_energy_and_the_agreement_of_integrators(sheave):
    """Differences: 2e-9 m of a motion of .05 m; the balance is off by 3e-9 of what is exchanged."""
    runs = [swing(**SHEAVES[sheave]).run(**BRIEF, integrator=each) for each in INTEGRATORS]
    for run in runs:
        assert np.abs(run.energy_balance().relative).max() < 1e-7
        near(run, runs[-1], 5e-8, "L.position", "C.position")
        near(run, runs[-1], 5e-3, "top.tension_on", "top.tension_off", "hoist.start_force")
        assert (run["top.residual"] < 1e-12).all() and (run["top.normal_force"] > 0).all()
    assert (runs[0]["energy.dissipated"][-1] > 1e-5) and ("top.torque" in runs[0])


def momenta(scene, run, k):
    """Return both momenta and the moment of momentum about the origin of all bodies and ropes, at a row of a run."""
    model = build(scene)
    run.at(run.time[k]).start(model, scene)
    engine = Engine(model)
    engine.set_state(0.0)
    n, free = model.n_band + model.n_border_dof, model.unknown_of_dof >= 0

    def over(dofs):
        found = np.zeros(n)
        found[model.unknown_of_dof[free]] = dofs[free]
        return found

    q, rigid = model.q, np.zeros((3, model.n_dof))
    for each in model.bodies:
        at, d = each.configuration, each.dof
        rigid[0, d] = rigid[1, d + 1] = rigid[2, d + 2] = 1
        rigid[2, d : d + 2] = -q[at + 1], q[at]
    for rope in model.ropes:
        for node in (span.node(i).start for span in rope.spans for i in range(span.n_elements + 1)):
            rigid[0, node] = rigid[1, node + 1] = 1
            for at in (node, node + 2):
                rigid[2, at : at + 2] = -q[at + 1], q[at]
    p = engine.dense_matrix(1.0, 0.0, 0.0)[:n, :n] @ over(model.v)
    return np.array([over(each) @ p for each in rigid])


@pytest.mark.parametrize("sheave", [*SHEAVES, "driven"])
def test_momentum_of_a_rope_over_a_moving_body(sheave):
    """Momentum is kept to rounding; its moment changes by that of loads: the body takes the moment of friction and the
    reaction of a drive.
    """
    scene = carried(**SHEAVES.get(sheave, SHEAVES["turning"] | {"torque": 0.7, "damping": 0.1}))
    run = scene.run(duration=0.1, output_step=0.002, tol=1e-6, integrator="explicit")
    change = momenta(scene, run, -1) - momenta(scene, run, 0)
    moment = sum(run[f"{name}.position"][:, 0] * force for name, force in FORCES.items())
    assert np.abs(change[:2]).max() < 1e-12
    assert change[2] == pytest.approx(np.sum(moment[1:] + moment[:-1]) * 0.001, abs=2e-6)  # of the trapezoidal rule
    assert np.abs(run.energy_balance().relative).max() < 1e-9


def test_weight_and_tension_at_rest_in_motion():
    """A rope on the ground that stays at rest bears its weight at anchors and sheave."""
    scene = fu.Scene(gravity=(0, -9.81, 0))
    scene.rope("hoist", route=[fu.Anchor(at=(-1, -1, 0)), fu.Sheave("top", at=(0, 0, 0), radius=0.2),
                               fu.Anchor(at=(1, -1.5, 0))], tension=50.0, **THIN)
    run = scene.run(duration=0.02, output_step=0.01, initial="equilibrium")
    weight = 7000 * np.pi * 1e-6 * 9.81 * run["hoist.s"][0, -1]
    total = run["hoist.start_force"] + run["hoist.end_force"] + run["top.force"]
    assert np.abs(total - (0, -weight, 0)).max() < 1e-6


# ---- routes, zones

@pytest.mark.parametrize("sheave", SHEAVES)
def test_three_sheaves(sheave):
    runs = [row(3, **SHEAVES[sheave]).run(**BRIEF | {"tol": 1e-5}, integrator=each) for each in INTEGRATORS]
    for run in runs:
        near(run, runs[-1], 1e-6, "A.position", "B.position")
        assert np.abs(run.energy_balance().relative).max() < 1e-6


@pytest.mark.parametrize("sheave", ["smooth", "turning"])
@pytest.mark.slow_cases("turning")
def test_forty_sheaves(sheave):
    one, other = (row(40, **SHEAVES[sheave]).run(duration=0.02, output_step=0.02, tol=1e-5, integrator=each)
                  for each in ("genalpha", "radau"))
    near(one, other, 1e-6, "A.position", "B.position")


def test_a_coefficient_of_zero_is_no_friction():
    near(swing().run(**BRIEF), swing(friction=0.0, zones=5).run(**BRIEF), 1e-15, "L.position", "top.tension_on")


def test_weak_friction_in_many_zones_tends_to_none():
    smooth, weak = swing().run(**BRIEF), swing(friction=fu.Friction(coefficient=1e-9), zones=8).run(**BRIEF)
    near(smooth, weak, 1e-6, "L.position")


@pytest.mark.slow
def test_zones_converge():
    """Slip of a wrap: the load by 2, 4 and 8 zones against 16."""
    last = [swing(friction=FRICTION, zones=n).run(**BRIEF)["L.position"][-1] for n in (2, 4, 8, 16)]
    errors = [np.abs(each - last[-1]).max() for each in last[:-1]]
    assert errors[2] < errors[0] and errors[2] < 1e-4


# ---- other axes, order, units, neighbours

def test_a_moved_and_turned_scene():
    scene, angle = swing(friction=FRICTION, zones=3, inertia=0.02), 0.7
    run, other = scene.run(**BRIEF), turned_scene(scene, (0, 0, angle), (3.0, -2.0, 0)).run(**BRIEF)
    A = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
    near({"p": run["hoist.position"] @ A.T + (3, -2, 0)}, {"p": other["hoist.position"]}, 1e-8, "p")
    for name in ("top.force", "hoist.start_force", "hoist.end_force"):
        near({"f": run[name] @ A.T}, {"f": other[name]}, 1e-3, "f")
    near(run, other, 1e-8, "top.angle", "hoist.s")


def test_other_planes_are_refused():
    with pytest.raises(fu.SceneError, match="leaves the plane z = 0"):
        turned_scene(swing(), (np.pi / 2, 0, 0), (0, 0, 0)).run(0.01)


def test_order_of_parts():
    def run(order: int):
        scene = fu.Scene()
        ends = [("A", -0.25, -2.0), ("B", 0.25, -2.2), ("C", 1.75, -2.0), ("D", 2.25, -2.1)]
        for name, x, y in ends[::order]:
            body(scene, name, x, y)
        for name, x, a, b in [("one", 0, "A", "B"), ("two", 2, "C", "D")][::order]:
            scene.rope(name, route=[fu.Anchor(a), fu.Sheave(f"over_{name}", at=(x, 0, 0), radius=0.25), fu.Anchor(b)],
                       tension=20.0, **THIN)
        return scene.run(**BRIEF)

    one, other = run(1), run(-1)
    assert sorted(one.keys()) == sorted(other.keys())
    near(one, other, 1e-9, *(name for name in one if "force" not in name and "tension" not in name
                             and "acceleration" not in name))


def test_other_units():
    run, other = swing().run(**BRIEF), in_units(swing(), 100.0, 1000.0, 10.0).run(duration=1.0, output_step=0.5,
                                                                                  tol=1e-6)
    assert np.abs(other["L.position"] / 100 - run["L.position"]).max() < 1e-9


def test_beside_a_cable_and_a_slide():
    """A rope that shares no part with a cable moves as alone, and a slide as without the rope."""
    def with_a_cable(scene):
        scene.cable("wire", start=(2, 0, 0), end=(3, 0, 0), elements=3, element="cable8p", rest_length=0.99,
                    section=fu.Circle(radius=0.01), material=fu.Material(youngs_modulus=1e8, poisson_ratio=0.3,
                                                                          density=1000))
        scene.pin("wire", s=0.0)
        scene.pin("wire", s=scene.cables["wire"].length)
        body(scene, "rider", 2.3, 0)
        scene.slide("rider", along="wire", s=0.297)
        return scene

    both = with_a_cable(swing()).run(**BRIEF)
    near(both, swing().run(**BRIEF), 1e-8, "L.position", "hoist.position")
    near(both, with_a_cable(fu.Scene(gravity=(0, -9.81, 0))).run(**BRIEF), 1e-8, "rider.position", "rider_on_wire.s")


def test_anchors_on_one_body_and_on_the_ground():
    """A rope from a body over the ground to the same body, and one between two points of the ground beside it."""
    scene = fu.Scene(gravity=(0, -9.81, 0))
    body(scene, "A", 0, -1)
    scene.rope("sling", route=[fu.Anchor("A", at=(-0.2, 0, 0)), fu.Sheave("top", at=(0, 0, 0), radius=0.2),
                               fu.Anchor("A", at=(0.2, 0, 0))], tension=9.81, **THIN)
    scene.rope("line", route=[fu.Anchor(at=(2, -1, 0)), fu.Sheave("peg", at=(3, 0, 0), radius=0.2),
                              fu.Anchor(at=(4, -1, 0))], tension=50.0, **THIN)
    run = scene.run(**BRIEF)
    assert np.abs(run["A.position"][:, 0]).max() < 1e-12  # symmetry
    assert np.abs(run.energy_balance().relative).max() < 1e-6


# ---- settings of runs, files

def test_integrators_that_are_chosen_and_refused():
    with pytest.raises(fu.SceneError, match='rope "hoist": integrator "energy" has no algorithmic dissipation'):
        swing().run(0.01, integrator="energy", spectral_radius=0.5)
    run = swing().run(**BRIEF)
    assert run.report["integrator"] != "energy"
    near(run, swing().run(**BRIEF | {"tol": 1e-9}), 1e-6, "L.position")
    fixed = swing().run(0.1, output_step=0.05, step=1e-4)
    near(run, fixed, 1e-5, "L.position")
    near(run, swing().run(**BRIEF, spectral_radius=0.5), 1e-6, "L.position")
    near(run, swing().run(**BRIEF, quantities=["L.position"]), 1e-5, "L.position")
    assert swing().choose(tol=1e-3, duration=0.1).integrator != "energy"


@pytest.mark.parametrize("quantity", ["hoist.position", "top.tension_on"])
def test_quantities_of_ropes_have_no_error_estimate(quantity):
    with pytest.raises(fu.SceneError, match=f'the error of "{quantity}" is not estimated'):
        swing().run(0.01, quantities=[quantity])


def test_estimated_errors_include_the_mesh_of_the_rope():
    errors = swing().run(0.1, output_step=0.05, tol=1e-4, estimate=True).report["errors"]
    assert 1e-7 < errors["mesh"] < 1e-2 and errors["time"] < 1e-4
    scene = fu.Scene()
    scene.rope("line", route=[fu.Anchor(at=(2, -1, 0)), fu.Sheave("peg", at=(3, 0, 0), radius=0.2),
                              fu.Anchor(at=(4, -1, 0))], tension=50.0, **THIN)
    assert scene.run(0.01, output_step=0.01, estimate=True).report["errors"]["mesh"] > 0


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_run_from_a_state_of_another(integrator):
    scene = swing(**SHEAVES["turning"])
    run = scene.run(**BRIEF, integrator=integrator)
    later = scene.run(0.05, output_step=0.05, tol=1e-6, integrator=integrator, initial=run.at(0.05))
    near({"p": later["L.position"][-1]}, {"p": run["L.position"][-1]}, 1e-7, "p")
    assert np.abs(later["hoist.coordinates"][0] - run["hoist.coordinates"][1]).max() < 1e-12


def test_states_that_do_not_fit():
    scene = fu.Scene()
    scene.rope("line", route=[fu.Anchor(at=(2, -1, 0)), fu.Sheave("peg", at=(3, 0, 0), radius=0.2),
                              fu.Anchor(at=(4, -1, 0))], tension=50.0, **THIN)
    state = dict(scene.run(0.001, output_step=0.001).at(0.001))
    with pytest.raises(fu.SceneError, match=re.escape('"line.coordinates" has an end')):
        scene.run(0.001, initial=state | {"line.coordinates": state["line.coordinates"] + 0.1})
    with pytest.raises(fu.SceneError, match="must have the shape"):
        scene.run(0.001, initial={"line.coordinates": [1, 2]})


def test_files(tmp_path):
    scene = swing(**SHEAVES["turning"])
    run = scene.run(**BRIEF)
    run.save(tmp_path / "run.nc")
    copy = fu.Scene.from_toml(scene.to_toml())
    for other in (fu.load_run(tmp_path / "run.nc"), copy.run(**BRIEF)):
        assert all(np.array_equal(run[name], other[name]) for name in run)
    assert fu.load_run(tmp_path / "run.nc").scene.to_toml() == scene.to_toml()


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_resumed_bit_for_bit(tmp_path, integrator):
    scene = swing(**SHEAVES["turning"])
    settings = {"duration": 0.02, "output_step": 0.002, "tol": 1e-5, "integrator": integrator}
    resumed = killed_and_resumed(scene, tmp_path / "run.nc", 15, **settings, progress=False)
    whole = scene.run(**settings)
    assert all(np.array_equal(whole[name], resumed[name]) for name in whole)


def test_replaced_and_left_out():
    scene = swing()
    other = scene.replace("hoist", tension=25.0)
    assert other.run(0.001, output_step=0.001)["top.tension_on"][0] > 24
    assert scene.without("hoist").ropes == {}
    assert scene.without("L").messages == ['without rigid_body "L", rope "hoist" was left out, too']


def test_events_see_ropes_by_functions():
    scene = swing()
    scene.event(function=lambda time, state: state["hoist.position"][-1, 1] - state["L.position"][1] + 1e-9, name="end")
    scene.event(function=lambda time, state: state["hoist.s"][0] + time - 0.01, name="later")
    events = scene.run(**BRIEF).report["events"]
    assert [event["name"] for event in events] == ["later"] and events[0]["time"] == pytest.approx(0.01, abs=1e-9)


# ---- how runs end

def ends(scene, match, **settings):
    with pytest.raises(fu.RopeLeftError, match=match) as caught:
        scene.run(**{"duration": 2.0, "output_step": 0.05, "tol": 1e-4} | settings)
    run = caught.value.run
    assert run.status == "rope_left" and (run["top.normal_force"][:-1] > 0).all()


@pytest.mark.parametrize("integrator", ["genalpha", "radau"])  # the explicit method takes 12 s: the span gets stiff
def test_a_span_becomes_too_short(integrator):
    scene = fu.Scene()
    body(scene, "C", -0.2, -1.5, 10.0)
    body(scene, "L", 0.2, -0.1, 1.0)
    scene.rope("hoist", route=[fu.Anchor("C"), fu.Sheave("top", at=(0, 0, 0), radius=0.2), fu.Anchor("L")],
               tension=10.0, **THIN)
    ends(scene, 'a span of rope "hoist" becomes too short', integrator=integrator)


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_rope_goes_slack(integrator):
    ends(swing().replace("L", velocity=(0, 3.0, 0)), 'lifts off sheave "top"', integrator=integrator)


def pulled_off(**sheave: object) -> fu.Scene:
    """Return a load that pulls its rope off a sheave."""
    scene = fu.Scene(gravity=(0, 0, 0))
    body(scene, "L", 1.5, -0.05, 1.0, velocity=(0, 1.0, 0))
    scene.rope("hoist", route=[fu.Anchor(at=(-1, 0, 0)),
                               fu.Sheave("top", at=(0, -0.2, 0), radius=0.2, side="right", **sheave),
                               fu.Anchor("L")], tension=30.0, **THIN)
    scene.force("L", value=(30, 0, 0))
    return scene


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_rope_leaves_a_sheave_without_friction(integrator):
    run = pulled_off().run(0.5, output_step=0.005, integrator=integrator, tol=1e-5, progress=False)
    assert [event["what"] for event in run.events] == ["left the sheave"]
    assert run["top.gap"][-1] > 0.1
    assert np.abs(run.energy_balance().relative).max() < 1e-4


def test_a_rope_without_tension_as_drawn():
    """Its weights pull it taut, or it lifts off; never is the normal force negative."""
    scene = swing()
    length = scene.route_of(scene.ropes["hoist"]).length - 1e-4
    slack = scene.replace("hoist", length=length, tension=None)
    drawn = slack.ropes["hoist"].drawn(slack.bodies)
    assert drawn.stretch == pytest.approx(1.0, abs=2e-4)
    run = slack.run(0.01, output_step=0.001, tol=1e-4)
    assert (run["top.normal_force"] >= -1e-9).all()


def test_refused_materials():
    with refused('rope "hoist": its material has mass_damping, which ropes do not have; give damping_time, or the drag '
                 "of the bodies on it"):
        swing().replace("hoist", material=fu.Material(youngs_modulus=6e8, poisson_ratio=0.3, density=7000,
                                                      mass_damping=1.0))
