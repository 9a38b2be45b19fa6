"""Riders and their ties: tangent and section frames, driven slides, cables as riders, several slides."""

import numpy as np
import pytest
from expectations import INTEGRATORS, energy_error, largest
from funicular import Material, Rectangle, Scene, TableSignal
from funicular.base.rotations import rotate
from numpy.testing import assert_allclose
from shared_scenes import cable_scene

G = 9.81
SQUARE = Rectangle(height=0.05, width=0.05)
SOFT = Material(youngs_modulus=1e7, poisson_ratio=0.0, density=1200)
STIFF = Material(youngs_modulus=1e9, poisson_ratio=0.0, density=1200)
ENERGY_ERRORS = {"explicit": 1e-4, "radau": 2e-3, "genalpha": 1e-2}


def wired(element="cable12", gravity=(0, -G, 0), end=(1.5, 0, 0), pins=(0.0, 1.5), material=SOFT, elements=3) -> Scene:
    return cable_scene(pins=pins, gravity=gravity, end=end, elements=elements, element=element, material=material)


def trolley(frame="tangent", element="cable12", at=(0, 0.1, -0.05), **given) -> Scene:
    scene = wired(element)
    planar = element.endswith("p")
    at = (at[0], at[1], 0) if planar else at
    scene.rigid_body("A", mass=1.3, inertia=(0.02, 0.03, 0.04), position=-np.array(at) + (0.4, 0, 0),
                     velocity=(1, 0.2, 0 if planar else 0.1), angular_velocity=(0, 0, 1) if planar else (3, 1, 1))
    scene.slide("A", along="wire", s=0.4, at=at, frame=frame, name="trolley", **given)
    return scene


def hung(element="cable12", s=0.0, link=None, frame="point", **given) -> Scene:
    """Return a cable that hangs at its point s from a slide on another."""
    scene = wired(element)
    below = (0.4, s, 0), (0.4, s - 1, 0)
    up = {} if element.endswith("p") else {"up": (1, 0, 0)}
    scene.cable("link", start=below[0], end=below[1], elements=2, element=link or element, section=SQUARE,
                material=SOFT, **up)
    scene.slide(("link", s), along="wire", s=0.4, frame=frame, name="trolley", **given)
    return scene


TIED = {
    "tangent": lambda: trolley(),
    "tangent-beam24": lambda: trolley(element="beam24"),
    "tangent-fixed": lambda: trolley(roll="fixed"),
    "tangent-planar": lambda: trolley(element="cable8p"),
    "section": lambda: trolley("section", "beam24"),
    "section-planar": lambda: trolley("section", "beam12p"),
    "driven": lambda: trolley("point", velocity=1.0),
    "tangent-driven": lambda: trolley(velocity=1.0),
    "link-end": lambda: hung(),
    "link-middle": lambda: hung(s=0.3),
    "link-beam24": lambda: hung("beam24", link="cable12", s=0.5),
    "link-section": lambda: hung("beam24", frame="section"),
    "link-tangent": lambda: hung("cable12", link="beam24", frame="tangent", s=0.3),
    "link-planar": lambda: hung("cable8p", s=0.3),
    "link-driven": lambda: hung(velocity=0.5),
}


@pytest.mark.filterwarnings("ignore:initial velocities broke a joint")
@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("case", TIED)
def test_it_is_kept_and_the_energy_balances(case, integrator):
    run = TIED[case]().run(0.02, output_step=0.002, tol=1e-4, integrator=integrator)
    assert run["trolley.residual"].max() < 1e-9
    assert energy_error(run) < ENERGY_ERRORS[integrator]
    if "driven" in case:
        rate = 0.5 if case == "link-driven" else 1.0
        assert_allclose(run["trolley.s"], 0.4 + rate * run.time, atol=1e-9)
    else:
        assert largest(run["energy.external"]) == 0


def tangent(run, s) -> np.ndarray:
    """Return tangents (time, 3) of the cable12 "wire" at arc-lengths s (time,), by differences of its cubic."""
    length, nodal = 0.5, run["wire.nodal_vectors"]
    found = []
    for row, at in enumerate(s):
        k = min(int(at / length), nodal.shape[1] - 2)
        x = at / length - k
        r0, t0, r1, t1 = (*nodal[row, k], *nodal[row, k + 1])
        slope = (6 * x * x - 6 * x) * (r0 - r1) / length + (3 * x * x - 4 * x + 1) * t0 + (3 * x * x - 2 * x) * t1
        found.append(slope / np.linalg.norm(slope))
    return np.array(found)


@pytest.mark.filterwarnings("ignore:initial velocities broke a joint")
@pytest.mark.parametrize("roll", ["free", "fixed"])
def test_a_trolley_keeps_its_floor_along_the_cable(roll):
    run = trolley(roll=roll).run(0.3, output_step=0.01, tol=1e-6)
    along = tangent(run, run["trolley.s"])
    floor = np.array([rotate(q, (1, 0, 0)) for q in run["A.orientation"]])
    side = np.array([rotate(q, (0, 0, 1)) for q in run["A.orientation"]])
    assert_allclose(floor, along, atol=1e-9)
    if roll == "fixed":  # its side stays level
        assert largest(side[:, 1]) < 1e-9
        assert largest(np.einsum("td,td->t", run["trolley.moment"], along)) > 0.1
    else:
        assert largest(side[:, 1]) > 0.1
        assert largest(np.einsum("td,td->t", run["trolley.moment"], along)) < 1e-9


@pytest.mark.parametrize(("elements", "s"), [(2, 0.5), (3, 2 / 3), (4, 0.75)])
def test_a_torque_on_a_rider_twists_the_cable(elements, s):
    """T s/(G J) at a node, with J by the torsion factor of a square, 0.8436 of the polar moment."""
    scene = Scene(gravity=(0, 0, 0))
    scene.cable("wire", start=(0, 0, 0), end=(1, 0, 0), elements=elements, section=SQUARE, material=SOFT,
                law="structural")
    scene.clamp("wire", s=0.0)
    scene.rigid_body("A", mass=1.0, inertia=(0.02, 0.02, 0.02), position=(s, 0, 0))
    scene.slide("A", along="wire", s=s, frame="section", drive=s, name="trolley")
    scene.moment("A", value=(0.5, 0, 0))
    state = scene.equilibrium()
    w, x, y, z = state["A.orientation"]
    assert 2 * np.arctan2(x, w) == pytest.approx(0.5 * s / (0.5e7 * 0.8436 * 0.05**4 / 6), rel=1e-3)
    assert abs(y) + abs(z) < 1e-6
    assert_allclose(state["trolley.moment"], [-0.5, 0, 0], atol=1e-9)


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_driven_slide_pulls_with_weight_and_inertia(integrator):
    """On an incline of 30 degrees: m a + m g sin along it, m g cos across."""
    up = np.array([np.cos(np.pi / 6), 0.5, 0])
    scene = wired(gravity=(0, 0, 0), end=tuple(1.5 * up), material=Material(youngs_modulus=1e11, poisson_ratio=0.0,
                                                                            density=1e5))
    mass = 1e-3  # next to nothing beside the cable's, which stays straight
    scene.rigid_body("A", mass=mass, inertia=(1e-6, 1e-6, 1e-6), position=0.2 * up)
    scene.force("A", at=(0, 0, 0), value=(0, -mass * G, 0))
    way = TableSignal(time=[0, 0.05, 0.1], value=[0.2, 0.205, 0.24])
    scene.slide("A", along="wire", s=0.2, drive=way, name="trolley")
    run = scene.run(0.1, tol=1e-5, integrator=integrator, output_step=0.01)
    assert_allclose(run["trolley.s"], way.value(run.time), atol=1e-9)
    assert_allclose(run["trolley.traction"], mass * (way.value(run.time, 2) + G * 0.5), rtol=1e-2)
    across = run["trolley.force"] @ np.array([-up[1], up[0], 0])
    assert_allclose(across, mass * G * up[0], rtol=1e-2)
    energy = sum(run[f"energy.{name}"] for name in ("kinetic", "elastic", "potential"))
    assert_allclose(run["energy.external"], energy - energy[0], atol=2e-6)


@pytest.mark.parametrize(("element", "s"), [("cable12", 0.0), ("cable12", 0.3), ("cable12", 0.5), ("beam24", 0.0),
                                            ("beam24", 0.3), ("cable8p", 0.3)])
@pytest.mark.filterwarnings("ignore:the state is unstable")
def test_a_hanging_cable_weighs_on_its_slide(element, s):
    """Upright, which can be unstable: hung at its middle, both halves would fold down."""
    state = hung(element, s, drive=0.4).equilibrium(seek_stable=False)
    assert state.stable == (s < 0.5)
    assert_allclose(state["trolley.force"], [0, 1200 * 0.05**2 * G, 0], atol=1e-6)
    assert_allclose(state["link.position"][:, 0], state["link.position"][0, 0], atol=1e-6)
    run = hung(element, s, drive=0.4).run(0.01, initial=state)
    assert_allclose(run["link.nodal_vectors"][-1], state["link.nodal_vectors"], atol=1e-7)


def car(frames=("point", "point")) -> Scene:
    scene = wired()
    scene.rigid_body("car", mass=2.0, inertia=(0.1, 0.2, 0.2), position=(0.6, -0.3, 0), velocity=(1, 0, 0))
    for name, x, frame in zip(("front", "back"), (0.1, -0.1), frames, strict=True):
        scene.slide("car", along="wire", s=0.6 + x, at=(x, 0.3, 0), frame=frame, name=name)
    return scene


@pytest.mark.filterwarnings("ignore:initial velocities broke a joint")
@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_car_on_two_wheels(integrator):
    """Newton and Euler: the forces of the wheels give the motion; one wheel crosses a node before the other."""
    run = car().run(0.5, output_step=0.01, tol=1e-4, integrator=integrator)
    assert run.report["element_crossings"] == 1 and max(run[f"{w}.residual"].max() for w in ("front", "back")) < 1e-9
    force = run["front.force"] + run["back.force"]
    assert_allclose(force, 2 * run["car.acceleration"] + [0, 2 * G, 0], atol=1e-7)
    arm = {name: np.array([rotate(q, (x, 0.3, 0)) for q in run["car.orientation"]])
           for name, x in (("front", 0.1), ("back", -0.1))}
    moment = sum(np.cross(arm[name], run[f"{name}.force"]) for name in arm)
    assert_allclose(moment[:, 2], 0.2 * run["car.angular_acceleration"][:, 2], atol=1e-7)
    apart = run["front.s"] - run["back.s"]
    assert 0.15 < apart.min() and apart.max() < 0.25


def test_a_body_between_two_cables():
    """Of the same kind, above and below: each carries its part, and the body does not turn."""
    scene = wired()
    scene.cable("low", start=(0, -1, 0), end=(1.5, -1, 0), elements=3, element="cable12", section=SQUARE, material=SOFT)
    for s in (0.0, 1.5):
        scene.pin("low", s=s)
    scene.rigid_body("A", mass=2.0, inertia=(0.1, 0.2, 0.2), position=(0.4, -0.5, 0), velocity=(1, 0, 0))
    scene.slide("A", along="wire", s=0.4, at=(0, 0.5, 0), name="above")
    scene.slide("A", along="low", s=0.4, at=(0, -0.5, 0), name="below")
    run = scene.run(0.3, output_step=0.01, tol=1e-6)
    force = run["above.force"] + run["below.force"]
    assert_allclose(force, 2 * run["A.acceleration"] + [0, 2 * G, 0], atol=1e-8)
    assert max(run[f"{name}.residual"].max() for name in ("above", "below")) < 1e-9
    assert energy_error(run) < 1e-6
