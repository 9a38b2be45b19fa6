"""Pantographs of arms and joints: kinematics, static force and equivalent masses against closed forms, equilibrium,
small motions against masses on springs, energy, refusals.
"""

import funicular as fu
import numpy as np
import pytest
from funicular import catenary
from funicular.catenary.jointed import moved
from test_catenary import line55

DEFAULT = catenary.JointedPantograph(uplift=120)
LENGTH, ANGLE, GRAVITY = 1.5, -0.5, 9.81


def parallelogram(**more):
    """Return a pantograph whose thrust rod is parallel to the lower arm and as long: upper arm and head do not rotate.

    The head moves on a circle with the length of the lower arm as its radius.
    """
    knee = LENGTH * np.array([np.cos(ANGLE), np.sin(ANGLE)])
    off, head = np.array([0.1, -0.2]), knee + np.array([-0.8, 1.5])
    return catenary.JointedPantograph(**{
        "knee": knee, "rod_base": off, "rod_top": knee + off, "head": head,
        "guide": (knee, head + np.array([0.0, 0.2])),
        "lower": {"mass": 20.0, "inertia": 4.0}, "upper": {"mass": 10.0, "inertia": 2.0},
        "rod": {"mass": 5.0, "inertia": 1.0}, "carrier": {"mass": 3.0, "inertia": 0.1},
        "collector": {"mass": 7.0, "inertia": 0.5}, "damper_at": ((0.0, -1.0), knee / 2)} | more)


def test_closed_forms_of_a_parallelogram():
    p, rise = parallelogram(uplift=100), LENGTH * np.cos(ANGLE)
    weights = 20 / 2 + 5 / 2 + 10 + 3 + 7
    assert p.moment_at() == pytest.approx((100 + GRAVITY * weights) * rise, rel=1e-12)
    assert p.static_force() == pytest.approx(100, rel=1e-12)
    for raised in (-0.3, 0.1, 0.4):
        angle = np.arcsin(np.sin(ANGLE) + raised / LENGTH)
        exact = (100 + GRAVITY * weights) * np.cos(ANGLE) / np.cos(angle) - GRAVITY * weights
        assert p.static_force(raised) == pytest.approx(exact, rel=1e-11)
    same = p.equivalent()
    moving = (20 + 5) * LENGTH**2 / 4 + 4 + 1 + (10 + 3 + 7) * LENGTH**2
    assert same.masses == pytest.approx([7.0, moving / rise**2 - 7.0], rel=1e-12)
    stiffness = -(100 + GRAVITY * weights) * np.tan(ANGLE) / (LENGTH * np.cos(ANGLE) ** 2) * np.cos(ANGLE)
    assert same.stiffness == pytest.approx([4200.0, stiffness], rel=1e-6)
    gap = np.array(p.knee) / 2 - (0.0, -1.0)
    rate = LENGTH / 2 * (-np.sin(ANGLE) * gap[0] + np.cos(ANGLE) * gap[1]) / np.hypot(*gap)
    assert same.damping == pytest.approx([10.0, 3300 * (rate / rise) ** 2], rel=1e-12)
    assert same.uplift == pytest.approx(100 * (1 + stiffness / 4200), rel=1e-6)


def test_moment_and_uplift_are_one():
    moment = parallelogram(uplift=100).moment_at()
    assert parallelogram(moment=moment).static_force(0.2) == pytest.approx(
        parallelogram(uplift=100).static_force(0.2), rel=1e-12)
    assert parallelogram(moment=moment).equivalent() == parallelogram(uplift=100).equivalent()


@pytest.mark.parametrize("turn", [-0.2, 0.0, 0.15])
def test_rates_are_derivatives_of_places_and_members_keep_their_lengths(turn):
    step = 1e-5
    ahead, behind = (moved(DEFAULT.joints, turn + each) for each in (step, -step))
    velocities, rates = moved(DEFAULT.joints, turn).rates()
    for name, velocity in velocities.items():
        assert (ahead.points[name] - behind.points[name]) / (2 * step) == pytest.approx(velocity, abs=1e-9)
    for name, rate in rates.items():
        assert (ahead.turns[name] - behind.turns[name]) / (2 * step) == pytest.approx(rate, abs=1e-9)
    now, drawn = ahead.points, DEFAULT.joints
    for a, b in (("rod_base", "rod_top"), ("knee", "rod_top"), ("knee", "head"), ("guide_low", "guide_top"),
                 ("head", "guide_top"), ("rod_top", "head")):
        assert np.linalg.norm(now[a] - now[b]) == pytest.approx(np.linalg.norm(drawn[a] - drawn[b]), rel=1e-13)


def test_the_default_is_what_is_said_of_it():
    same = DEFAULT.equivalent()
    assert same.masses[1] == pytest.approx(15.6, abs=0.1)
    forces = [DEFAULT.static_force(raised) for raised in (-0.15, 0.0, 0.15)]
    assert forces == pytest.approx([123.4, 120, 116.6], abs=0.1)
    assert abs(np.degrees(DEFAULT.posture(0.2).turns["carrier"])) < 1  # the guide keeps the collector level
    assert abs(np.degrees(DEFAULT.posture(-0.2).turns["carrier"])) < 1


def below_a_wire(pantograph, speed=0.0, spans=1, at=27.5):
    """Return the scene; the wire is horizontal at mid-span, so that it pushes vertically."""
    scene = catenary.scene(line55(spans, damping=0.06), (2.0, 4.0))
    catenary.add_pantograph(scene, pantograph, at, speed)
    return scene


@pytest.mark.parametrize("pantograph", [DEFAULT, parallelogram(uplift=100)], ids=["default", "parallelogram"])
def test_at_rest_it_presses_as_virtual_work_says(pantograph):
    scene = below_a_wire(pantograph)
    rest = scene.equilibrium()
    force, way = rest["pantograph_contact.force"][:2], pantograph.rates()  # the wire is not quite level off the middle
    work = float(force @ way / way[1])
    collector = float(rest["pantograph_1.position"][1] - scene.bodies["pantograph_1"].position[1])
    pressed = float(force[1]) - pantograph.static_force()  # that compresses the suspension
    assert work == pytest.approx(pantograph.static_force(collector + pressed / 4200), rel=1e-6)
    assert 1e-3 < abs(collector) < 0.03


@pytest.mark.slow
def test_small_motions_are_those_of_the_equivalent_masses():
    """A small pulse on the collector at rest: the motions differ by its square."""
    found = []
    for pantograph in (DEFAULT, DEFAULT.equivalent()):
        scene = below_a_wire(pantograph)
        scene.force("pantograph_1", value=(0, 2.0, 0), scale=fu.Pulse(start=0.05, end=0.15, rise=0.05))
        run = scene.run(duration=1.0, tol=1e-6, absolute_tol=1e-7, quantities=["pantograph_1.position"], progress=False,
                        output_step=5e-3)
        height = run["pantograph_1.position"][:, 1]
        found.append(np.stack([height - height[0], run["pantograph_contact.normal_force"]]))
    moves, forces = np.stack(found, axis=1)
    assert np.abs(moves[0]).max() > 1e-4
    assert np.abs(moves[0] - moves[1]).max() < 2e-3 * np.abs(moves[0]).max()
    swing = forces - forces[:, :1]
    assert np.abs(swing[0] - swing[1]).max() < 4e-3 * np.abs(swing[0]).max()


@pytest.fixture(scope="module")
def passages():
    """Return passages through two spans at 250 km/h, of the jointed pantograph and of its equivalent masses."""
    return [below_a_wire(each, 250 / 3.6, spans=2, at=20.0).run(duration=0.99, progress=False)
            for each in (DEFAULT, DEFAULT.equivalent())]


@pytest.mark.slow
def test_a_passage_is_assessed(passages):
    jointed, masses = (catenary.assess(run) for run in passages)
    assert float(jointed["mean"][0]) == pytest.approx(float(masses["mean"][0]), rel=2e-3)
    assert float(jointed.standard_deviation[0]) == pytest.approx(float(masses.standard_deviation[0]), rel=1e-2)
    assert jointed.place.values == pytest.approx(masses.place.values, abs=5e-3)  # the head moves along as it rises
    assert np.abs(jointed.place.values - masses.place.values).max() > 1e-3


def test_energy_of_a_passage_is_balanced(passages):
    balance = passages[0].energy_balance()
    assert np.abs(balance.residual).max() < 0.03 * balance.exchanged
    assert max(np.abs(passages[0][f"pantograph_{name}.residual"]).max() for name in (
        "pivot", "knee", "rod_base", "rod_top", "head", "guide")) < 1e-9


def test_two_of_them():
    scene = below_a_wire(DEFAULT, 80.0, spans=2, at=20.0)
    catenary.add_pantograph(scene, DEFAULT, 45.0, 80.0, name="second")
    rest = scene.equilibrium()
    for name in ("pantograph", "second"):
        assert 110 < float(rest[f"{name}_contact.normal_force"]) < 121


@pytest.mark.parametrize(("changes", "says"), [
    ({}, "no uplift"),
    ({"uplift": 100, "moment": 900}, "two uplifts"),
    ({"uplift": -1}, "uplift must not be negative"),
    ({"uplift": 100, "knee": (1.0, 2.0, 3.0)}, "knee"),
    ({"uplift": 100, "guide": ((1.0, 2.0),)}, "two points"),
    ({"uplift": 100, "lower": {"mass": 0.0, "inertia": 1.0}}, "mass must be positive"),
    ({"uplift": 100, "rod_top": (1.2, 0.85)}, "rod and the upper arm's lever are in line"),
    ({"uplift": 100, "guide": ((1.25, 0.89), (0.19, 1.5))}, "guide and the carrier's lever are in line"),
    ({"uplift": 100, "rod_base": (0.1, -0.2), "rod_top": (0.1, 1.3), "knee": (0.0, 1.5), "head": (-0.8, 3.0),
      "guide": ((0.0, 1.5), (-0.8, 3.2))}, "does not rise"),
])
def test_what_is_no_pantograph_is_refused(changes, says):
    with pytest.raises(fu.SceneError, match=says):
        catenary.JointedPantograph(**changes)


def test_what_it_does_not_reach_is_said():
    with pytest.raises(fu.SceneError, match="does not reach 3 m"):
        DEFAULT.static_force(3.0)
    with pytest.raises(fu.SceneError, match="cannot turn its lower arm by 2 rad"):
        DEFAULT.posture(2.0)
    raised = parallelogram(uplift=100, knee=LENGTH * np.array([np.cos(0.5), np.sin(0.5)]),
                           rod_top=LENGTH * np.array([np.cos(0.5), np.sin(0.5)]) + (0.1, -0.2))
    with pytest.raises(fu.SceneError, match="grows with the height"):
        raised.equivalent()
