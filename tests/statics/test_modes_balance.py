"""Modes of drawn scenes with and without balance of forces, and about unstable states."""

import re

import numpy as np
import pytest
from funicular import Circle, FunicularWarning, Material, Scene, SceneError
from scipy.linalg import eigh
from shared_scenes import cable_scene

G, J = 9.81, 4e-3
MASS, LEVER = (1.3, 0.6), (0.8, 0.5)


def double_pendulum(second=(0.0, -1.3)):
    """Return two hanging bodies on hinges; second: position of the lower one."""
    scene = Scene()
    scene.rigid_body("a", mass=MASS[0], inertia=(J,) * 3, position=(0, -LEVER[0], 0))
    scene.rigid_body("b", mass=MASS[1], inertia=(J,) * 3, position=(*second, 0))
    scene.joint("revolute", (0, 0, 0), ("a", (0, LEVER[0], 0)), axis=(0, 0, 1))
    arm = (-second[0], -LEVER[0] - second[1], 0)
    scene.joint("revolute", "a", ("b", arm), axis=(0, 0, 1))
    return scene


def test_joints_bear_the_weight_of_what_hangs_in_balance():
    (m, n), (a, b) = MASS, LEVER
    squares = eigh([[(m + n) * a * G, 0], [0, n * b * G]], [[(m + n) * a**2 + J, n * a * b], [n * a * b, n * b**2 + J]],
                   eigvals_only=True)
    modes = double_pendulum().modes(2)
    assert modes.angular_frequency == pytest.approx(np.sqrt(squares), rel=1e-9)
    assert modes.messages == []


@pytest.mark.parametrize("stretch", [0.0, 0.0981])
def test_springs_pull_by_their_gap(stretch):
    """A string of two springs with a weight: transverse w² is the tension times the sum of 1 / length, over the mass.
    """
    scene = Scene(gravity=(0, 0, 0))
    scene.rigid_body("A", mass=2.0, inertia=(1, 1, 1), position=(0, 0, 0))
    for end in (1.0, -1.0):
        scene.spring("A", (end, 0, 0), stiffness=200.0, length=1 - stretch)
    found = scene.modes(6).angular_frequency
    assert np.sort(found)[-1] == pytest.approx(np.sqrt(400 / 2.0))
    assert found == pytest.approx(scene.modes(6, about=scene.equilibrium()).angular_frequency, abs=1e-9)
    across = np.sqrt(2 * 200 * stretch / 2.0)
    assert np.min(abs(found - across)) < 1e-9


def test_what_is_not_in_balance_is_refused():
    scene = double_pendulum(second=(0.5, -LEVER[0]))
    with pytest.raises(SceneError, match=r"modes: the scene as drawn is not in balance: residual forces are up to "
                       r'.* N, largest on body "b"; take about=scene\.equilibrium\(\)'):
        scene.modes(2)
    with pytest.warns(FunicularWarning, match="joints and slides bear nothing"):
        modes = scene.modes(2, as_drawn=True)
    assert np.all(modes.angular_frequency == 0)
    assert scene.modes(2, about=scene.equilibrium()).angular_frequency[0] > 1


def test_a_weight_on_a_cable_is_not_in_balance_as_drawn():
    scene = cable_scene(pins="ends", elements=4, element="cable12", section=Circle(radius=0.01),
                        material=Material(youngs_modulus=1e9, poisson_ratio=0, density=1000))
    weight = 1000 * np.pi * 1e-4 * scene.cables["wire"].length * G / 4
    with pytest.raises(SceneError) as error:
        scene.modes(2)
    left, where = re.search(r"forces are up to (\S+) N, .* at s = (\S+) m", str(error.value)).groups()
    assert float(left) == pytest.approx(weight, rel=1e-2)
    assert float(where) > 0


def test_modes_of_an_unstable_state_say_so():
    """An inverted pendulum, and one of two inverted: as drawn, and about an equilibrium."""
    scene = Scene()
    scene.rigid_body("a", mass=1.0, inertia=(J,) * 3, position=(0, 0.8, 0))
    scene.joint("revolute", (0, 0, 0), ("a", (0, -0.8, 0)), axis=(0, 0, 1))
    growth = np.sqrt(0.8 * G / (0.8**2 + J))
    rest = scene.equilibrium(seek_stable=False)
    for about in (None, rest):
        with pytest.warns(FunicularWarning):
            modes = scene.modes(1, about=about)
        assert modes.growth_rate == pytest.approx([growth])
        assert modes.messages == [f"the state is unstable: 1 independent direction lowers its energy; mode 1 grows, by "
                                  f"up to {growth:.4g} 1/s"]
    above = double_pendulum(second=(0.0, -LEVER[0] + 0.5))
    with pytest.warns(FunicularWarning, match="1 independent direction lowers its energy; mode 1 grows"):
        assert len(above.modes(2)) == 2
