"""Catenaries with staggers: heights and positions at the supports, lateral forces against closed forms, passages beside
planar ones, arms that rotate about their hinges.
"""

import funicular as fu
import numpy as np
import pytest
from funicular import catenary
from test_catenary import TWO_MASSES, X, line55
from test_jointed_pantograph import DEFAULT

SIDE, SPAN = 0.2, 55.0


@pytest.mark.parametrize("of_messenger", [None, 0.0, 0.1])
def test_the_wire_lies_as_given(of_messenger):
    form = catenary.form(line55(3, stagger=SIDE, messenger_stagger=of_messenger), (1.5, 3.0))
    scene = catenary.scene(form)
    rest = scene.equilibrium()
    assert rest.stable
    wire = rest["contact.position"]
    for span in range(3):
        for k, x in enumerate(X):
            node = int(np.argmin(np.abs(wire[:, 0] - SPAN * span - x)))
            assert wire[node, 1] == pytest.approx(-form.line.droppers.depths[k], abs=1e-6)
            assert float(rest[f"dropper_{span + 1}_{k + 1}.tension"]) == pytest.approx(form.tensions[k], rel=1e-5)
    at_masts = [int(np.argmin(np.abs(wire[:, 0] - SPAN * mast))) for mast in range(4)]
    assert wire[at_masts, 2] == pytest.approx([SIDE, -SIDE, SIDE, -SIDE], abs=1e-7)
    assert wire[at_masts, 1] == pytest.approx(form.heights[0], abs=1e-6)
    assert rest["contact@0.force"][0] == pytest.approx(-22e3, rel=1e-5)
    upper = SIDE if of_messenger is None else of_messenger
    ends = [rest[f"messenger_{k}.position"][-1] for k in (1, 2)]
    assert [end[2] for end in ends] == pytest.approx([-upper, upper], abs=1e-9)
    assert [end[1] for end in ends] == pytest.approx([1.2, 1.2], abs=1e-6)
    assert float(rest["support_1.tension"]) == pytest.approx(form.mast_forces[0], rel=1e-6)


@pytest.mark.parametrize("of_messenger", [SIDE, pytest.param(0.0, marks=pytest.mark.slow)])
def test_supports_bear_the_tension_times_its_change_of_direction(of_messenger):
    """Moments about the mean height of a span: droppers pull both wires equally, at any inclination.

    The lateral forces of both wires at an end of a span of the length L are (T 2 a + T' 2 a' + 2 M) / L. The messenger
    rotates freely; the contact wire is parallel to the track at the masts, and bends there with M = l F, l = sqrt(EI /
    T), beside its arm with the force 2 F.
    """
    errors = []
    for longest in ((1.0, 1.0), (0.25, 0.5)):
        scene = catenary.scene(catenary.form(line55(2, stagger=SIDE, messenger_stagger=of_messenger), longest))
        rest, end = scene.equilibrium(), scene.cables["messenger_1"].length
        arm, upper = rest["steady_arm_1.force"][2], rest[f"messenger_1@{end:.12g}.force"][2]
        bent = -np.sqrt(179 / 22e3) * arm
        exact = 2 * (22e3 * 2 * SIDE + 16e3 * 2 * of_messenger + bent) / SPAN
        errors.append(-(arm + upper) / exact - 1)
    assert arm < -300  # at the second mast it pulls away from the track's middle, to -z
    assert 0 < errors[1] < 2e-4  # in the first order: elements turn the wire over their own length
    assert errors[1] < 0.2 * errors[0]


@pytest.mark.slow
def test_with_little_bending_an_arm_bears_what_a_string_does():
    form = catenary.form(line55(2, bending=0.01, stagger=SIDE), (0.25, 0.5))
    assert -catenary.scene(form).equilibrium()["steady_arm_1.force"][2] == pytest.approx(
        2 * 22e3 * 2 * SIDE / SPAN, rel=2e-3)


def test_no_stagger_is_the_planar_line():
    plain, none = (catenary.scene(catenary.form(line55(2, **more), (2.0, 4.0))) for more in ({}, {"stagger": 0.0}))
    assert {cable.element for cable in none.cables.values()} == {"cable8p"}
    assert none.to_toml() == plain.to_toml()
    assert not none.joints


@pytest.fixture(scope="module")
def passages():
    """Return passages through two spans at 250 km/h, with staggers, and in the plane with arms of the same vertical
    stiffness.
    """
    runs = []
    for more in ({"stagger": SIDE}, {"steady_arm": catenary.SteadyArm(stiffness=2 * 22e3 * 2 * SIDE / SPAN)}):
        scene = catenary.scene(line55(2, damping=0.06, **{"steady_arm": catenary.SteadyArm(), **more}), (2.0, 4.0))
        assert str(scene.equilibrium().stability) == "stable"
        catenary.add_pantograph(scene, TWO_MASSES, 20.0, 250 / 3.6)
        runs.append(scene.run(duration=0.99, progress=False))
    return runs


@pytest.mark.slow
def test_the_wire_wanders_along_the_collector(passages):
    run = passages[0]
    along, x = run["pantograph_contact.s_b"], run["pantograph_1.position"][:, 0]
    assert along == pytest.approx(SIDE * np.interp(x, [0, SPAN, 2 * SPAN], [1, -1, 1]), abs=5e-3)  # waves pull it aside
    assert along.min() == pytest.approx(-SIDE, abs=1e-3)
    touching = run["pantograph_contact.position"][:, 2]
    assert touching == pytest.approx(along, abs=1e-9)  # the bar is across the track, its middle over that


def test_a_passage_is_that_of_the_plane(passages):
    """Apart from the end masts, a stagger changes heights and forces by its square."""
    space, plane = (catenary.assess(run) for run in passages)
    assert float(space["mean"][0]) == pytest.approx(float(plane["mean"][0]), rel=3e-3)
    assert float(space.standard_deviation[0]) == pytest.approx(float(plane.standard_deviation[0]), rel=1e-2)
    assert float(space.uplift[1]) == pytest.approx(float(plane.uplift[1]), rel=2e-2)
    balance = passages[0].energy_balance()
    assert np.abs(balance.residual).max() < 0.02 * balance.exchanged


def test_an_arm_pulls_down_as_it_turns(passages):
    force, raised = passages[0]["steady_arm_1.force"], catenary.uplift(passages[0])[:, 1]
    assert raised.max() > 0.02
    assert force[:, 1] == pytest.approx(force[:, 2] * raised / np.sqrt(1 - raised**2), abs=0.05)  # its length is 1 m


def test_a_jointed_pantograph_below_staggers():
    scene = catenary.scene(line55(1, stagger=SIDE), (2.0, 4.0))
    catenary.add_pantograph(scene, DEFAULT, 20.0, 0.0)
    plane = catenary.scene(line55(1), (2.0, 4.0))
    catenary.add_pantograph(plane, DEFAULT, 20.0, 0.0)
    forces = [float(each.equilibrium()["pantograph_contact.normal_force"]) for each in (scene, plane)]
    assert forces[0] == pytest.approx(forces[1], rel=1e-6)


def test_stability_is_counted_where_pivots_are_almost_zero():
    """In this scene SuperLU takes no diagonal pivots, so that they do not count the stability."""
    scene = catenary.scene(line55(2, stagger=SIDE, steady_arm=catenary.SteadyArm()), (2.0, 4.0))
    catenary.add_pantograph(scene, TWO_MASSES, 20.0, 60.0)
    found = scene.equilibrium().stability
    assert found.known
    assert not found.unstable


@pytest.mark.parametrize(("changes", "says"), [
    ({"stagger": np.inf}, "stagger must be finite"),
    ({"stagger": "left"}, "stagger"),
    ({"messenger_stagger": [0.1]}, "messenger_stagger"),
])
def test_staggers_that_are_none_are_refused(changes, says):
    with pytest.raises(fu.SceneError, match=says):
        line55(**changes)
    with pytest.raises(fu.SceneError, match="length must be positive"):
        catenary.SteadyArm(length=0.0)
