"""Pantograph heads that tilt, with two strips: a force of each, balances of the head, limits, refusals."""

import funicular as fu
import numpy as np
import pytest
from catenary_sections import COARSE, COLLECTOR, ONE, RIGID, SPRUNG, line, passage, vertical_impulse, with_head
from funicular import catenary
from test_catenary import line55
from test_jointed_pantograph import DEFAULT


@pytest.fixture(scope="module")
def form():
    """The form of two spans."""
    return catenary.form(line(2), COARSE)


def passing(form, pantograph, duration=1.0, **settings):
    """Return a run of 50 m in two spans."""
    return passage(catenary.scene(form), pantograph, 20.0, 50.0, duration=duration, **settings)


def test_one_strip_is_a_collector_without_a_head(form):
    ours, usual = (passing(form, each)["pantograph_contact.normal_force"] for each in (with_head(ONE), COLLECTOR))
    assert ours == pytest.approx(usual, abs=1e-5)


@pytest.mark.parametrize("head", [SPRUNG, RIGID], ids=["sprung", "rigid"])
def test_strip_forces_are_those_of_the_equations_of_motion(form, head):
    """The impulse of the strips is that of uplift and lowest spring, less the momentum of all masses."""
    run = passing(form, with_head(head), output_step=1e-3)
    found = catenary.assess(run)
    assert found.contact.values.tolist() == ["pantograph_contact_1", "pantograph_contact_2"]
    assert found.force.values == pytest.approx(found.forces.values.sum(axis=0), abs=1e-12)
    assert np.abs(np.diff(found.forces.values, axis=0)).max() > 20
    ours, by_momentum = vertical_impulse(run)
    assert ours == pytest.approx(by_momentum, rel=1e-5)


def test_the_head_pitches_by_the_moment_of_its_strips(form):
    run, moment = passing(form, with_head(RIGID), duration=0.5, output_step=1e-3), 0.0
    for k in (1, 2):
        arm = run[f"pantograph_contact_{k}.position"] - run["pantograph_tilting_head.position"]
        moment = moment - np.cross(arm, run[f"pantograph_contact_{k}.force"])[:, 2]
    spin = 0.3 * run["pantograph_tilting_head.angular_velocity"][:, 2]
    assert spin[-1] - spin[0] == pytest.approx(np.trapezoid(moment, run.time), abs=0.02 * np.ptp(spin))
    assert np.ptp(spin) > 0.01


def test_strips_share_the_force_at_rest(form):
    scene = catenary.scene(form)
    catenary.add_pantograph(scene, with_head(SPRUNG), 27.5, 0.0)  # level there
    rest = scene.equilibrium()
    forces = [float(rest[f"pantograph_contact_{k}.normal_force"]) for k in (1, 2)]
    assert forces[0] == pytest.approx(forces[1], rel=1e-6)
    raised = float(rest["pantograph_2.position"][1] - scene.bodies["pantograph_2"].position[1])
    assert sum(forces) == pytest.approx(120 - 50 * raised, rel=1e-5)
    strips = [rest[f"pantograph_strip_{k}.position"][1] for k in (1, 2)]
    below = float(rest["pantograph_tilting_head.position"][1] - np.mean(strips))
    assert below == pytest.approx(forces[0] / 4e3, rel=1e-5)


def test_it_rolls_under_a_wire_beside_the_middle():
    scene = catenary.scene(line55(1, stagger=0.2), (2.0, 4.0))
    head = SPRUNG.remade({"tilt_stiffness": 2e3})
    catenary.add_pantograph(scene, with_head(head), 14.0, 0.0)
    rest = scene.equilibrium()
    forces = np.array([float(rest[f"pantograph_contact_{k}.normal_force"]) for k in (1, 2)])
    places = np.array([float(rest[f"pantograph_contact_{k}.s_b"]) for k in (1, 2)])
    w, x, *_ = rest["pantograph_tilting_head.orientation"]
    assert 2 * np.arctan2(x, w) == pytest.approx(float(forces @ places) / 2e3, rel=2e-2)  # away from the wire
    assert places == pytest.approx([0.1, 0.1], abs=5e-3)


def test_a_jointed_pantograph_carries_a_head(form):
    scene = catenary.scene(form)
    catenary.add_pantograph(scene, DEFAULT.remade({"tilting_head": RIGID}), 27.5, 0.0)
    rest = scene.equilibrium()
    forces = [float(rest[f"pantograph_contact_{k}.normal_force"]) for k in (1, 2)]
    assert sum(forces) == pytest.approx(120, rel=5e-3)
    assert forces[0] == pytest.approx(forces[1], rel=5e-3)
    assert DEFAULT.remade({"tilting_head": RIGID}).equivalent().tilting_head == RIGID


@pytest.mark.parametrize(("changes", "says"), [
    ({"strips": [0.1, 0.1]}, "two strips at one place"),
    ({"strips": [0.0]}, "tips over: all its strips are on one side"),
    ({"strips": [0.1, 0.3]}, "tips over"),
    ({"strips": []}, "strips"),
    ({"mass": -1.0}, "mass must be positive"),
    ({"strip_damping": 5.0}, "no spring below its strips"),
])
def test_heads_that_do_not_stand_are_refused(changes, says):
    with pytest.raises(fu.SceneError, match=says):
        catenary.Head(**{"mass": 3.0, "inertia": 0.3} | changes)


def test_a_head_that_rolls_over_is_refused():
    scene = catenary.scene(line55(1, stagger=0.2), (2.0, 4.0))
    with pytest.raises(fu.SceneError, match=r"rolls over .* give tilt_stiffness"):
        catenary.add_pantograph(scene, with_head(RIGID), 14.0, 0.0)
