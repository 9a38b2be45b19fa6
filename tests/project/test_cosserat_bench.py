"""Scenarios of cosseratbench as scenes, without that package: elements, ends, starts, directors; closed forms."""

import subprocess
import sys
from importlib.metadata import distribution

import numpy as np
import pytest
from cosserat_rods import CLAMPED, FREE, PINNED, Rod, Scenario, load, motion
from funicular.cosserat_bench.contacts import tangents_of
from funicular.cosserat_bench.motion import Choices, moved, untwisted
from funicular.cosserat_bench.rods import element_of, scene_of

DOWN = (0.0, 0.0, -9.81)
STRAIGHT = [(0, 0, 0), (1, 0, 0)]
BOW = [(0, 0, 0), (0.5, 0, -0.1), (1, 0, 0)]
HELIX = [(np.cos(a), np.sin(a), 0.1 * a) for a in np.linspace(0, 3, 41)]
STILL = motion((0.0, 1.0))


@pytest.mark.parametrize(("rod", "gravity", "element"), [
    (Rod(STRAIGHT, start=CLAMPED), DOWN, "cable8p"),
    (Rod(STRAIGHT, start=CLAMPED), (0, 0, 0), "cable8p"),
    (Rod(STRAIGHT, start=CLAMPED, loads=(load((0, 1, 0)),)), DOWN, "cable12"),
    (Rod(BOW, start=PINNED, end=PINNED, normal=(0, 1, 0)), DOWN, "cable8p"),
    (Rod(BOW, start=PINNED, end=PINNED, normal=(0, 1, 0)), (0, 9.81, 0), "cable12"),
    (Rod(HELIX, start=PINNED), DOWN, "cable12"),
    (Rod(BOW, start=CLAMPED, end=CLAMPED, normal=(0, 1, 0)), DOWN, "beam24"),
    (Rod(STRAIGHT, start=CLAMPED, start_motion=STILL), DOWN, "beam24"),
])
def test_the_cheapest_element(rod, gravity, element):
    assert element_of(Scenario(gravity=gravity), rod, alone=True) == element
    assert scene_of(Scenario(gravity=gravity), [rod], 4).cables[0].element == element


def test_rods_beside_others_are_spatial():
    rods = [Rod(STRAIGHT, start=PINNED), Rod([(0, 1, 0), (1, 1, 0)], start=PINNED)]
    made = scene_of(Scenario(gravity=DOWN), rods, 4)
    assert [cable.element for cable in made.cables] == ["cable12", "cable12"]
    assert [cable.name for cable in made.cables] == ["rod0", "rod1"]


def test_bent_cantilever():
    """F L³ / (3 E I), 1 % of the length. Geometry accounts for 1e-4, and the approach to rest for the remainder."""
    rod = Rod(STRAIGHT, start=CLAMPED, loads=(load((0, 0, -2.4e-4)),))
    stiff = rod.material.youngs_modulus * rod.second_moment_of_area
    deflection = 2.4e-4 / (3 * stiff)
    frequency = 3.516 * np.sqrt(stiff / (1000 * rod.area))
    (positions,), (directors,) = moved(Scenario(rod, duration=24.0, frequency=frequency), 4, 7, Choices())
    assert positions.shape == (7, 5, 3)
    assert positions[0] == pytest.approx(np.array([[0, 0, 0], [0.25, 0, 0], [0.5, 0, 0], [0.75, 0, 0], [1, 0, 0]]))
    assert -positions[-1, -1, 2] == pytest.approx(deflection, rel=3e-4)
    assert np.abs(np.sum(directors * tangents_of(positions), axis=-1)).max() < 1e-12
    slope = -1.0 * positions[-1, -1, 2] - -1.0 * positions[-1, -2, 2]
    assert directors[-1, -1] == pytest.approx([slope / 0.25, 0, 1], abs=1e-3)


def test_twisted_rod_turns_evenly():
    """An end turns slowly by an angle; the sections turn in proportion to their arc-length."""
    times = np.linspace(0, 4, 81)
    turn = 1.5 * (0.5 - 0.5 * np.cos(np.pi * times / 4))
    driven = motion(times, rotation=tuple((a, 0.0, 0.0) for a in turn), slides_along=(1.0, 0.0, 0.0))
    rod = Rod(STRAIGHT, start=CLAMPED, end=CLAMPED, end_motion=driven)
    (positions,), (directors,) = moved(Scenario(rod, duration=5.0, frequency=3.0), 5, 6, Choices())
    angles = np.arctan2(-directors[..., 1], directors[..., 2])
    assert angles[-1] == pytest.approx(1.5 * (np.arange(5) + 0.5) / 5, abs=2e-3)
    assert angles[2] == pytest.approx(np.interp(2.0, times, turn) * (np.arange(5) + 0.5) / 5, abs=2e-2)
    assert np.abs(positions[..., 1:]).max() < 1e-9


def test_sliding_end_takes_its_load():
    """A clamped end that slides stretches the rod by F L / (E A)."""
    driven = motion((0.0, 1.0), slides_along=(1.0, 0.0, 0.0))
    rod = Rod(STRAIGHT, start=CLAMPED, end=CLAMPED, end_motion=driven, loads=(load((0.3, 0, 0)),))
    (positions,), _ = moved(Scenario(rod, duration=3.0, frequency=5.0), 4, 4, Choices())
    assert positions[-1, -1, 0] - 1 == pytest.approx(0.3 / (1e6 * rod.area), rel=1e-4)


def test_rod_that_starts_at_rest_stays():
    """The rod hangs stretched by its weight: s + ρ g (L s - s²/2) / E below its pin, to the error of the element."""
    s = np.linspace(0, 1, 101)
    depth = s + 1000 * 9.81 * (s - s**2 / 2) / 1e6
    rod = Rod(np.stack([0 * s, 0 * s, -depth], axis=1), start=PINNED, normal=(0, 1, 0), rest_arc_length=tuple(s))
    (positions,), _ = moved(Scenario(rod, duration=2.0, gravity=DOWN, quasi_static=False), 10, 21, Choices())
    assert np.abs(positions - positions[0]).max() < 1e-9
    assert -positions[-1, :, 2] == pytest.approx(depth[::10], abs=1e-9)


def test_clamped_end_of_a_stretched_rod_keeps_its_direction():
    s = np.linspace(0, 1, 101)
    bow = np.stack([1.02 * s, 0 * s, 0.05 * np.sin(np.pi * s)], axis=1)
    rod = Rod(bow, start=CLAMPED, normal=(0, 1, 0), rest_arc_length=tuple(s))
    made = scene_of(Scenario(rod), [rod], 10)
    run = made.scene.run(duration=1e-3, initial=made.start)
    assert run["rod0.position"][0] == pytest.approx(bow[::10], abs=1e-6)


def test_flexible_rods_have_no_bending():
    rod = Rod(STRAIGHT, start=PINNED)
    made = [scene_of(Scenario(rod), [rod], 4, bending=bending).cables[0] for bending in (True, False)]
    areas, moments = zip(*((cable.section.moments()[0], cable.section.moments()[1]) for cable in made), strict=True)
    assert areas[0] == pytest.approx(areas[1])
    assert moments[1] < 1e-7 * moments[0]


def test_smooth_motions_are_splines_and_others_straight_lines():
    def signals(displacement, times):
        rod = Rod(STRAIGHT, start=CLAMPED, end=CLAMPED, end_motion=motion(times, displacement=displacement))
        (driven,) = scene_of(Scenario(rod), [rod], 2).scene.motions
        return driven.displacement

    t = np.linspace(0, 1, 51)
    rise = 0.1 * (0.5 - 0.5 * np.cos(np.pi * t))
    smooth = signals(tuple((x, 0.0, 0.0) for x in rise), t)
    assert smooth[0].interpolation == "cubic"
    assert smooth[0].value(t) == pytest.approx(rise)
    assert abs(smooth[0].value(0.0, 1)) < 1e-9
    kinked = signals(((0.0, 0.0, 0.0), (0.1, 0.0, 0.0), (0.0, 0.2, 0.0)), (0.0, 0.5, 1.0))
    assert [each.interpolation for each in kinked[:2]] == ["linear", "linear"]
    assert kinked[0].value(0.25) == pytest.approx(0.05)


@pytest.mark.parametrize(("rod", "message"), [
    (Rod(STRAIGHT, start=CLAMPED, end=CLAMPED, end_motion=motion((0.0, 1.0), slides_along=(1.0, 1.0, 0.0))),
     "an end that slides along"),
    (Rod(STRAIGHT, start=CLAMPED, end=CLAMPED,
         end_motion=motion((0.0, 1.0, 2.0), rotation=((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (1.0, 1.0, 0.0)))),
     "an end that turns about more than one axis"),
    (Rod(STRAIGHT, start=CLAMPED, end=CLAMPED, shear_modulus=1e5), "torsion of a shear modulus below a third"),
])
def test_what_is_not_modelled_is_refused(rod, message):
    with pytest.raises(NotImplementedError, match=message):
        moved(Scenario(rod), 4, 2, Choices())


def test_directors_turn_with_the_line_alone():
    """In a plane the transverse director stays; in space the directors are normal to the chords, and constant at rest.
    """
    turn = np.linspace(0, 1.2, 9)
    bent = np.stack([np.cumsum(np.cos(turn)), 0 * turn, np.cumsum(np.sin(turn))], axis=1)
    frames = np.stack([np.arange(9)[:, None] * [1.0, 0, 0], bent])
    across = np.tile([0.0, 1.0, 0.0], (8, 1))
    for clamped in (None, 0, -1):
        assert untwisted(across, frames, clamped) == pytest.approx(np.stack([across, across]), abs=1e-12)
    in_plane = untwisted(np.tile([0.0, 0.0, 1.0], (8, 1)), frames, 0)
    assert np.sum(in_plane * tangents_of(frames), axis=-1) == pytest.approx(0, abs=1e-12)
    assert np.linalg.norm(in_plane, axis=-1) == pytest.approx(1, abs=1e-12)
    helix = np.tile(np.array(HELIX), (3, 1, 1))
    first = np.cross(tangents_of(helix[0]), [0.3, -0.2, 1.0])
    first[1:] = untwisted(first / np.linalg.norm(first, axis=1, keepdims=True), helix, 0)[1, 1:]
    first[0] /= np.linalg.norm(first[0])
    assert untwisted(first, helix, None)[-1] == pytest.approx(first, abs=1e-12)


def test_steps_follow_the_scale():
    """The tolerance grows with the fourth power of the scale, which doubles the steps for twice the scale."""
    scenario = Scenario(Rod(STRAIGHT, start=PINNED, normal=(0, 1, 0)), gravity=DOWN, quasi_static=False)
    assert Choices(time_step_scale=2.0).tol_of(scenario) == 16 * Choices().tol_of(scenario)
    assert Choices(tol=1e-5).tol_of(scenario) == 1e-5
    assert Choices.damping_rate(scenario) == 0
    assert Choices.damping_rate(Scenario(frequency=2.0)) == pytest.approx(3.8)


def test_funicular_and_the_mapping_do_without_cosseratbench():
    code = ("import sys; sys.modules['cosseratbench'] = None; import funicular, funicular.cosserat_bench.motion as m; "
            "print(m.INTEGRATOR); import funicular.cosserat_bench.solver")
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.stdout.strip() == "radau"
    assert "cosseratbench" in done.stderr.splitlines()[-1]


def test_entry_point_is_in_the_metadata():
    (point,) = [each for each in distribution("funicular").entry_points if each.group == "cosseratbench.solvers"]
    assert (point.name, point.value) == ("funicular", "funicular.cosserat_bench.solver:FunicularSolver")


def test_free_rods_fall():
    rod = Rod(STRAIGHT, start=FREE)
    (positions,), _ = moved(Scenario(rod, duration=0.5, gravity=DOWN, quasi_static=False), 2, 2, Choices())
    assert positions[-1, :, 2] == pytest.approx(-0.5 * 9.81 * 0.25)
