"""Contact in scenarios of cosseratbench: pairs, refusals and warnings."""

import numpy as np
import pytest
from cosserat_rods import PINNED, Rod, Scenario, cylinder, motion, plane
from funicular.cosserat_bench.contacts import near, overlapping, passes_into_itself, side_by_side
from funicular.cosserat_bench.motion import Choices, moved
from funicular.cosserat_bench.rods import element_of
from funicular.errors import FunicularWarning

DOWN = (0.0, 0.0, -9.81)
ALONG_X = [(-0.2, 0, 0), (0.2, 0, 0)]
LOOP = [(0.1 * np.sin(a), 0.1 * np.cos(a), 0.002 * a) for a in np.linspace(0, 6.6, 80)]


def raised(points, height):
    """Return the rod at a height."""
    return [(x, y, z + height) for x, y, z in points]


def held(points, height=0.0, **others):
    """Return a rod between pins, at a height."""
    return Rod(raised(points, height), start=PINNED, end=PINNED, normal=(0.6, 0.8, 0), radius=0.005, **others)


def across(points):
    """Return the rod along y."""
    return [(y, x, z) for x, y, z in points]


def test_rod_comes_to_lie_on_a_plane():
    """Its contact permits a penetration of a thousandth of the radius."""
    rod = Rod([(0, 0, 0.03), (0.4, 0, 0.03)], radius=0.01, normal=(0, 1, 0))
    scenario = Scenario(rod, duration=2.0, gravity=DOWN, frequency=5.0,
                        obstacles=(plane((0, 0, 0), (0, 0, 1), friction=0.3),))
    assert element_of(scenario, rod, alone=True) == "cable8p"
    (positions,), _ = moved(scenario, 4, 11, Choices())
    assert positions[-1, :, 2] == pytest.approx(0.01 * (1 - 1e-3), abs=2e-7)
    assert positions[-1, :, 0] == pytest.approx(positions[0, :, 0], abs=1e-6)


@pytest.mark.parametrize(("obstacle", "element"), [
    (plane((0, 0, -1), (0.6, 0, 0.8)), "cable8p"),
    (plane((0, 0, -1), (0, 0.6, 0.8)), "cable12"),
    (cylinder((0, 0, -1), (0, 1, 0), 0.1, 1.0), "cable8p"),
    (cylinder((0, 0, -1), (1, 0, 0), 0.1, 1.0), "cable12"),
])
def test_planar_rods_have_obstacles_that_keep_them_in_their_plane(obstacle, element):
    rod = held([(0, 0, 0), (0.5, 0, -0.1), (1, 0, 0)])
    assert element_of(Scenario(gravity=DOWN, obstacles=(obstacle,)), rod, alone=True) == element


@pytest.mark.parametrize("height", [0.02, 0.1])
def test_a_rod_that_falls_on_another_rests_on_it(height):
    """The rods start close and move together at once, or start apart and meet during the run."""
    beam = Rod(raised(across(ALONG_X), height), radius=0.005, normal=(1, 0, 0), youngs_modulus=1e8)
    scenario = Scenario(held(ALONG_X, youngs_modulus=1e8), beam, duration=1.6, gravity=DOWN, frequency=5.0)
    assert (len(near(scenario)) == 1) == (height < 0.04)
    (lower, upper), (of_lower, of_upper) = moved(scenario, 4, 9, Choices())
    gap = upper[:, 2, 2] - lower[:, 2, 2]
    assert gap[0] == pytest.approx(height)
    assert gap[-1] == pytest.approx(0.01 - 5e-6, abs=1e-6)
    assert lower.shape == upper.shape == (9, 5, 3)
    assert of_lower.shape == of_upper.shape == (9, 4, 3)


@pytest.mark.filterwarnings("ignore:motion on")  # whose rate jumps
def test_rods_side_by_side_are_refused_where_they_touch():
    fixed, falling = held(ALONG_X, youngs_modulus=1e8), held(ALONG_X, height=0.02)
    assert side_by_side(fixed, falling)
    assert not side_by_side(fixed, held(across(ALONG_X), height=0.02))
    lowered = motion((0.0, 0.2), displacement=((0.0, 0.0, 0.0), (0.0, 0.0, -0.05)))
    driven = Rod(raised(ALONG_X, 0.02), start="clamped", start_motion=lowered, radius=0.005)
    with pytest.raises(NotImplementedError, match="two rods at more than one point"):
        moved(Scenario(fixed, driven, duration=0.2, frequency=10.0), 3, 9, Choices())


@pytest.mark.filterwarnings("ignore:motion on")  # whose rate jumps
def test_rods_that_start_apart_and_side_by_side_are_warned_of():
    lowered = motion((0.0, 0.2), displacement=((0.0, 0.0, 0.0), (0.0, 0.0, -0.2)))
    driven = Rod(raised(ALONG_X, 0.1), start="clamped", start_motion=lowered, radius=0.005)
    with pytest.warns(FunicularWarning, match=r"rods 0 and 1 pass into each other from t = 0\.1 s on"):
        moved(Scenario(held(ALONG_X), driven, duration=0.2, frequency=10.0), 3, 21, Choices())


def test_rods_that_change_sides_between_frames_have_passed_through_each_other():
    scenario = Scenario(held(ALONG_X), held(across(ALONG_X), height=0.1))
    still = np.array([ALONG_X] * 3)
    moving = np.array([raised(across(ALONG_X), z) for z in (0.1, 0.05, -0.06)])
    assert overlapping(scenario, [still, moving]) == {(0, 1): 2}
    assert overlapping(scenario, [still, moving[:2].repeat(2, axis=0)[:3]]) == {}
    assert overlapping(scenario, [still, moving + np.array([5.0, 0, 0])]) == {}


def test_a_rod_in_contact_with_itself_is_found():
    straight = np.linspace([0, 0, 0], [0.66, 0, 0], 80)
    frames = np.stack([straight, np.array(LOOP), np.array(LOOP) * [1, 1, 40]])
    rod = Rod(LOOP, radius=0.01)
    assert passes_into_itself(rod, frames) == 1
    assert passes_into_itself(rod, frames[[0, 2]]) is None


def test_a_rod_in_contact_with_itself_beside_obstacles_is_refused():
    scenario = Scenario(Rod(LOOP), self_contact=True, obstacles=(plane((0, 0, -1), (0, 0, 1)),))
    with pytest.raises(NotImplementedError, match="contact of a rod with itself"):
        moved(scenario, 4, 2, Choices())


def test_contact_at_the_end_of_a_cylinder_is_refused():
    rod = Rod([(-0.1, 0, 0.06), (0.1, 0, 0.06)], radius=0.005, normal=(0, 1, 0))
    short = cylinder((0, 0.3, 0), (0, 1, 0), 0.05, 0.1)
    with pytest.raises(NotImplementedError, match="at the end of a cylinder"):
        moved(Scenario(rod, duration=0.2, gravity=DOWN, frequency=10.0, obstacles=(short,)), 4, 11, Choices())
