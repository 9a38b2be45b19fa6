"""Choices with unequal elements: taken, and correct, where a cable bends in few places."""

import funicular as fu
import numpy as np
import pytest
from funicular.choice.motion import motion
from funicular.choice.unequal import density, graded, saving
from funicular.results.trajectories import distance, largest_change
from shared_scenes import cable_scene

LENGTH = 1 / 1.001


def taut() -> fu.Scene:
    """Return a clamped cable with 0.1 % of strain, excited by a force: it bends in three places, 3 % of its length."""
    scene = fu.Scene()
    scene.cable("w", start=(0, 0, 0), end=(1, 0, 0), rest_length=LENGTH, element="cable12",
                section=fu.Circle(radius=2e-3),
                material=fu.Material(youngs_modulus=1e8, poisson_ratio=0.0, density=1000, damping_time=1e-3))
    scene.clamp("w", s=0.0)
    scene.clamp("w", s=LENGTH)
    scene.force("w", s=0.3 * LENGTH, value=(0, -1.2, 0), scale=fu.Harmonic(amplitude=1.0, frequency=5.0))
    return scene


@pytest.fixture(scope="module")
def choice():
    return taut().choose(1e-2, duration=0.1, initial="equilibrium", unequal=True)


def test_a_taut_cable_between_clamps(choice):
    """Fewer than two thirds of the equal elements, densest at clamps and force, within tol of a fine mesh."""
    equal = taut().choose(1e-2, duration=0.1, initial="equilibrium")
    model, cable = choice.models["w"], choice.scene.cables["w"]
    assert model.nodes == cable.nodes and model.elements <= 2 / 3 * equal.models["w"].elements
    assert choice.kept and choice.error <= 1e-2
    assert np.abs(cable.node_s - 0.3 * LENGTH).min() < 1e-12
    lengths = np.diff(cable.node_s)
    assert max(lengths[0], lengths[-1]) < lengths.max() / 3
    settings = {"output_step": 0.01, "initial": "equilibrium"}
    found = motion(choice.scene, choice.scene.run(**settings))
    fine = taut().replace("w", elements=150)
    exact = motion(fine, fine.run(0.1, tol=1e-4, integrator="radau", **settings))
    assert distance(found, exact) < 1e-2 * largest_change(exact)


def test_it_says_what_was_chosen(choice):
    assert str(choice.models["w"]) == f"{choice.models['w'].elements} unequal cable12, {choice.models['w'].law}"
    assert "closest where curvature jumps" in choice.reasons[-1]
    assert [row["elements"] for row in choice.table if row["chosen"]] == [choice.models["w"].elements]
    assert fu.Scene.from_toml(choice.scene.to_toml()).cables["w"].nodes == choice.models["w"].nodes


def test_equal_elements_stay_where_unequal_ones_would_save_little():
    scene = cable_scene("w", clamps=(0.0,), elements=None, element="cable12", section=fu.Circle(radius=0.01),
                        material=fu.Material(youngs_modulus=1e7, poisson_ratio=0.0, density=1000))
    choice = scene.choose(1e-2, duration=0.1, unequal=True)
    assert choice.models["w"].nodes == ()
    assert "unequal elements" in choice.reasons[-1]
    assert choice.scene.to_toml() == scene.choose(1e-2, duration=0.1).scene.to_toml()


def test_the_density_of_nodes():
    """Zero jumps give equal elements; a layer at the start attracts nodes, increasingly so on finer meshes."""
    scene = taut().replace("w", elements=20)
    cable = scene.cables["w"]
    straight = cable.nodal_vectors[None]
    np.testing.assert_allclose(density(cable, straight), 1.0)
    assert saving(cable, straight) == pytest.approx(1.0)
    even = graded(scene, cable, straight, 20)
    assert 0.3 * LENGTH in even and len(even) == 21
    bent = straight.copy()
    bent[0, :, 0, 1] = 0.1 * np.exp(-cable.node_s / 0.05)
    bent[0, :, 1, 1] = -2.0 * np.exp(-cable.node_s / 0.05)
    assert density(cable, bent)[0] > 3 * density(cable, bent)[-1]
    assert saving(cable, bent) < 0.6
    assert np.diff(graded(scene, cable, bent, 20))[0] < LENGTH / 50
