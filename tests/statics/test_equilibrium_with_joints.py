"""Equilibrium and small vibrations of scenes with joints, tied and driven slides, cables as riders."""

import numpy as np
import pytest
from funicular import GeneralSection, Material, Scene
from numpy.testing import assert_allclose
from shared_scenes import SQUARE
from test_joints import LEFT, rod
from test_mechanisms import Z, door, four_bars

G = 9.81
STIFF = Material(youngs_modulus=1e12, poisson_ratio=0, density=1200)


def wire(scene, elements=4, length=1.5, material=STIFF):
    scene.cable("wire", start=(0, 0, 0), end=(length, 0, 0), elements=elements, element="cable12", section=SQUARE,
                material=material)
    for s in (0.0, length):
        scene.clamp("wire", s=s)


def pendulum(kind, **given) -> Scene:
    scene = Scene()
    scene.rigid_body("A", mass=2.0, inertia=(0.1, 0.15, 0.2), position=(0, -0.5, 0))
    scene.joint(kind, (0, 0, 0), ("A", (0, 0.5, 0)), name="hinge", **given)
    return scene


@pytest.mark.parametrize(("kind", "given", "inertia"), [
    ("revolute", {"axis": Z}, [0.2]), ("universal", {"axis": (1, 0, 0), "second_axis": (0, 0, 1)}, [0.2, 0.1]),
    ("cylindrical", {"axis": (1, 0, 0)}, [np.inf, 0.1])])
def test_a_pendulum_swings_as_it_should(kind, given, inertia):
    """sqrt(m g d/(I + m d^2)); 0 along an axis that is free."""
    scene = pendulum(kind, **given)
    found = scene.modes(len(inertia), about=scene.equilibrium()).angular_frequency
    expected = np.sqrt(2 * G * 0.5 / (np.array(inertia) + 2 * 0.25))
    assert_allclose(np.sort(found), np.sort(expected), rtol=1e-9, atol=1e-6)


def test_a_rod_falls_to_its_rest():
    """Drawn horizontally, the rod hangs at rest; the hinge holds its weight, and a run from there stays."""
    scene = rod()
    scene.joint("revolute", (0, 0, 0), LEFT, axis=Z, name="hinge")
    state = scene.equilibrium()
    assert_allclose(state["A.position"], [0, -0.5, 0], atol=1e-9)
    assert_allclose(state["hinge.force"], [0, 2 * G, 0], atol=1e-9)
    assert_allclose(scene.modes(1, about=state).angular_frequency, [np.sqrt(2 * G * 0.5 / 0.7)], rtol=1e-9)
    run = scene.run(0.5, initial="equilibrium")
    assert_allclose(run["A.position"], np.tile(state["A.position"], (len(run.time), 1)), atol=1e-9)


def test_a_hinged_bar_on_a_spring():
    scene = rod()
    scene.joint("revolute", (0, 0, 0), LEFT, axis=Z, name="hinge")
    scene.spring(("A", (0.5, 0, 0)), (1, 1, 0), stiffness=100.0, length=1.0, name="spring")
    state = scene.equilibrium()
    at, pull = state["A.position"], state["spring.force"]
    assert_allclose(np.cross(2 * at, pull) + np.cross(at, [0, -2 * G, 0]), 0, atol=1e-9)
    assert_allclose(state["hinge.force"] + pull + [0, -2 * G, 0], 0, atol=1e-9)
    run = scene.run(1.0, initial=state)
    assert np.abs(run["A.velocity"]).max() < 1e-9
    assert_allclose(run["hinge.force"][-1], state["hinge.force"], atol=1e-8)


def test_a_driven_hinge_starts_where_its_signal_does():
    """The moment at rest, and one vibration less."""
    scene = rod()
    scene.joint("revolute", (0, 0, 0), LEFT, axis=Z, angle=0.3, name="hinge")
    state = scene.equilibrium()
    assert_allclose(state["A.position"], [0.5 * np.cos(0.3), 0.5 * np.sin(0.3), 0], atol=1e-12)
    assert_allclose(state["hinge.moment"], [0, 0, 2 * G * 0.5 * np.cos(0.3)], atol=1e-9)
    run = scene.run(0.1, initial=state)
    assert_allclose(run["hinge.moment"][-1], state["hinge.moment"], atol=1e-9)


def test_a_pendulum_on_a_driven_slide():
    """A rider that is fixed along the cable has two swings and a rotation."""
    scene = Scene()
    wire(scene)
    scene.rigid_body("A", mass=1e-2, inertia=(1e-3, 1e-3, 1e-3), position=(0.6, -1, 0))
    scene.slide("A", along="wire", s=0.6, at=(0, 1, 0), drive=0.6, name="trolley")
    state = scene.equilibrium()
    assert state["trolley.s"] == pytest.approx(0.6, abs=1e-12)
    swing = np.sqrt(1e-2 * G / (1e-3 + 1e-2))
    assert_allclose(scene.modes(3, about=state).angular_frequency, [0, swing, swing], rtol=1e-4, atol=1e-3)
    run = scene.run(0.01, initial=state)
    assert_allclose(run["A.position"][-1], state["A.position"], atol=1e-8)


def test_a_tied_trolley_swings_sideways_alone():
    scene = Scene()
    wire(scene, elements=3, material=Material(youngs_modulus=1e8, poisson_ratio=0, density=1200))
    scene.rigid_body("A", mass=1e-2, inertia=(1e-3, 1e-3, 1e-3), position=(0.75, -1, 0))
    scene.slide("A", along="wire", s=0.75, at=(0, 1, 0), frame="tangent", name="trolley")
    modes = scene.modes(2, about=scene.equilibrium())
    assert modes.angular_frequency[0] < 1  # along the sagging cable
    assert modes.angular_frequency[1] == pytest.approx(np.sqrt(1e-2 * G / (1e-3 + 1e-2)), rel=1e-4)
    assert_allclose(np.abs(modes["A.displacement"][1]), [0, 0, 1], atol=1e-3)


@pytest.mark.parametrize("how", ["weld", "section"])
def test_a_body_at_the_tip_of_a_massless_beam(how):
    """Bending with rotation of the tip, torsion, axial; slender, so that shear contributes at most 0.35 %."""
    scene = Scene(gravity=(0, 0, 0))
    scene.cable("beam", start=(0, 0, 0), end=(1, 0, 0), elements=4, section=SQUARE, law="structural",
                material=Material(youngs_modulus=1e7, poisson_ratio=0, density=0.1))
    scene.clamp("beam", s=0.0)
    scene.rigid_body("A", mass=1.0, inertia=(1e-3, 1e-3, 1e-3), position=(1, 0, 0))
    if how == "weld":
        scene.joint("weld", ("beam", 1.0), "A")
    else:
        scene.slide("A", along="beam", s=1.0, frame="section", drive=1.0)
    stiffness = 1e7 * 0.05**4 / 12 * np.array([[12, -6], [-6, 4]])
    bending = np.sqrt(np.linalg.eigvals(np.diag([1, 1e3]) @ stiffness))
    torsion, stretch = np.sqrt(0.5e7 * 0.8436 * 0.05**4 / 6 / 1e-3), np.sqrt(1e7 * 0.05**2)
    expected = np.sort([*bending, *bending, torsion, stretch])
    assert_allclose(scene.modes(6).angular_frequency, expected, rtol=4e-3)


def test_a_chain_that_hangs_from_a_slide():
    """Zeros of J0: j sqrt(g/L)/2, twice each."""
    scene = Scene()
    wire(scene, elements=2, length=1.0)
    scene.cable("chain", start=(0.5, 0, 0), end=(0.5, -1, 0), elements=12, element="cable12", up=(1, 0, 0),
                section=GeneralSection(area=1e-4, second_moment_about_z=1e-16, second_moment_about_y=1e-16),
                material=Material(youngs_modulus=1e10, poisson_ratio=0, density=1e4))
    scene.slide(("chain", 0.0), along="wire", s=0.5, drive=0.5)
    found = scene.modes(6, about=scene.equilibrium()).angular_frequency
    assert_allclose(found, np.repeat([2.404826, 5.520078, 8.653728], 2) / 2 * np.sqrt(G), rtol=2e-4)


def test_over_constrained_loops_rest_and_vibrate():
    state = door().equilibrium()  # about an upright axis it may stand anywhere
    assert_allclose(state["hinge0.force"] + state["hinge1.force"], [0, 20 * G, 0], atol=1e-9)
    assert door().modes(1).angular_frequency == pytest.approx(0, abs=1e-6)
    hanging = four_bars(1, speed=0.0, angle=-np.pi / 2)
    found = hanging.modes(1, about=hanging.equilibrium()).angular_frequency
    # two legs that turn about their ends, one bar that does not turn
    assert_allclose(found, [np.sqrt(2 * G / (2 / 3 + 1))], rtol=1e-9)
