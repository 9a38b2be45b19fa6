"""Slack cables drawn straight, or otherwise far from equilibrium, reach the catenary or the elastica."""

import warnings
from itertools import pairwise

import numpy as np
import pytest
from catenary import end_forces
from funicular import Circle, FunicularWarning, GeneralSection, Material, Scene
from numpy.testing import assert_allclose
from scipy.integrate import solve_bvp
from shared_scenes import cable_scene

AREA, E, DENSITY, G = np.pi * 1e-4, 1e11, 7850.0, 9.81
WEIGHT, AXIAL, BENDING = DENSITY * AREA * G, E * AREA, E * np.pi / 4 * 1e-8
SLENDER = GeneralSection(area=AREA, second_moment_about_z=1e-12, second_moment_about_y=1e-12)
CASES = [((10, 0), 10.5), ((10, 0), 10.05), ((10, 4), 11.5), ((20, 5), 21.0)]


def rope(end, length, elements=20, element="cable12", section=SLENDER, points=None, **how) -> Scene:
    drawn = {"end": (*end, 0)} if points is None else {"points": points, "rest": "straight"}
    return cable_scene("rope", pins=(0, length), elements=elements, element=element, rest_length=length,
                       section=section, material=Material(youngs_modulus=E, poisson_ratio=0.3, density=DENSITY),
                       **drawn, **how)


def hangs(scene, end, length, **settings):
    """Return the equilibrium, which must be stable and a catenary."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", FunicularWarning)
        state = scene.equilibrium(**settings)
    H, V = end_forces(*end, length, WEIGHT, AXIAL)
    assert state.stable
    assert_allclose(state["rope@0.force"], [-H, V, 0], atol=1e-3 * np.hypot(H, V))
    return state


@pytest.mark.parametrize("element", ["cable12", "cable8p"])
@pytest.mark.parametrize(("end", "length"), CASES)
def test_drawn_straight(end, length, element, validated):
    state = hangs(rope(end, length, element=element), end, length)
    H, V = end_forces(*end, length, WEIGHT, AXIAL)
    validated("Statics", f"slack rope of {length} m to ({end[0]}, {end[1]}) m, drawn straight", "force on its end",
              [-H, V], state["rope@0.force"][:2], unit="N", scale=np.hypot(H, V), bound=1e-3, variant=element,
              mesh="20 elements", source="elastic catenary")


@pytest.mark.parametrize("membrane", ["assumed", "reduced"])
@pytest.mark.parametrize(("end", "length"), CASES)
def test_drawn_straight_with_another_axial_strain(end, length, membrane):
    """Their section has three stiffnesses, all of which the search must soften."""
    hangs(rope(end, length, membrane=membrane), end, length)


@pytest.mark.parametrize("membrane", ["full", "assumed", "reduced"])
def test_compressed_and_straight_is_unstable(membrane):
    """Without weight and without the search for a stable state, Newton's method leaves it straight."""
    scene = rope((1, 0), 1.001, section=Circle(radius=0.001), membrane=membrane)
    scene.gravity = (0, 0, 0)
    with pytest.warns(FunicularWarning, match="the state is unstable: .* its energy; a small disturbance leaves it"):
        state = scene.equilibrium(seek_stable=False)
    assert not state.stable
    np.testing.assert_allclose(state["rope.position"][:, 1:], 0, atol=1e-12)


@pytest.mark.slow
def test_two_thousand_elements():
    """A sparse factorisation counts; a dense one would take 1.2 GB and minutes."""
    u = np.linspace(0, 1, 41)[:, None]
    points = np.hstack([10 * u, -4 * np.sqrt(3 / 8 * 10 * 0.5) * u * (1 - u), 0 * u])
    state = hangs(rope((10, 0), 10.5, 2000, points=points), (10, 0), 10.5)
    assert str(state.stability) == "stable"


@pytest.mark.parametrize("elements", [20, 96])
@pytest.mark.parametrize("part", [0.25, 0.5])
@pytest.mark.parametrize(("end", "length"), [CASES[0], CASES[2]])
def test_drawn_with_a_part_of_its_sag(end, length, part, elements):
    chord, u = np.hypot(*end), np.linspace(0, 1, 41)[:, None]
    sag = part * np.sqrt(3 / 8 * chord * (length - chord))
    points = np.hstack([u * end[0], u * end[1] - 4 * sag * u * (1 - u), 0 * u])
    hangs(rope(end, length, elements, points=points), end, length)


@pytest.mark.parametrize("elements", [20, 96])
def test_a_mooring_drawn_as_a_fold(elements):
    """A Z between the ground and the fairlead, with rounded corners."""
    corners, u = np.array([(0, 0, 0), (40, 0, 0), (10, 15, 0), (50, 30, 0)], dtype=float), np.linspace(0, 1, 30)[:-1]
    line = np.vstack([a + np.outer(u, b - a) for a, b in pairwise(corners)] + [corners[-1:]])
    smooth = line.copy()
    for k in range(3):
        smooth[4:-4, k] = np.convolve(line[:, k], np.ones(9) / 9, "valid")
    hangs(rope((50, 30), 110.0, elements, points=smooth), (50, 30), 110.0)


@pytest.mark.parametrize(("element", "settings"), [("cable8p", {"load_steps": 2}),
                                                   ("cable12", {"method": "arc_length"})])
def test_in_load_steps_and_along_a_path(element, settings):
    """Without its weight it is a bow of any direction; with it, it hangs."""
    state = hangs(rope((10, 0), 10.5, 10, element), (10, 0), 10.5, **settings)
    assert any("drawn with stress" in message for message in state.messages)


def elastica(end, length) -> tuple[float, float]:
    """Return horizontal and upward force at the start of a heavy rope with bending, on pins: a boundary value problem.

    The force on the part before s is (H, W), W = w s - V: theta' = kappa, EI kappa' = H sin theta - W cos theta, and
    the stretch is (H cos theta + W sin theta)/EA.
    """
    def rates(s, state, force):
        theta, kappa = state[:2]
        H, W = force[0], WEIGHT * s - force[1]
        stretch = 1 + (H * np.cos(theta) + W * np.sin(theta)) / AXIAL
        return [kappa, (H * np.sin(theta) - W * np.cos(theta)) / BENDING,
                stretch * np.cos(theta), stretch * np.sin(theta)]

    def ends(first, last, force):
        return [first[1], last[1], first[2], first[3], last[2] - end[0], last[3] - end[1]]

    s = np.linspace(0, length, 101)
    chord = np.hypot(*end)
    slope = 4 * np.sqrt(3 / 8 * chord * (length - chord)) / chord
    theta = np.arctan2(end[1], end[0]) + slope * (2 * s / length - 1)
    guess = [theta, 0 * s + 2 * slope / length, np.cumsum(np.cos(theta)) * s[1], np.cumsum(np.sin(theta)) * s[1]]
    H, V = end_forces(*end, length, WEIGHT, AXIAL)
    found = solve_bvp(rates, ends, s, guess, p=[H, V], tol=1e-8, max_nodes=20000)
    assert found.success
    return found.p


@pytest.mark.parametrize(("end", "length"), CASES[:1] + CASES[2:])
def test_where_bending_counts(end, length, validated):
    """The bending stiffness of the rope, 20 mm thick, takes a third off the force of the catenary."""
    H, V = elastica(end, length)
    state = rope(end, length, section=Circle(radius=0.01)).equilibrium()
    assert state.stable and not state.messages
    validated("Statics", f"slack rope of {length} m that resists bending, to ({end[0]}, {end[1]}) m",
              "force on its end", [-H, V], state["rope@0.force"][:2], unit="N", scale=np.hypot(H, V), bound=1e-3,
              variant="cable12", source="heavy elastica, boundary value problem", mesh="20 elements")
