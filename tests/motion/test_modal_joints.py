"""Modal bodies with joints, slides, springs and loads: constraints, closed forms, agreement."""

import numpy as np
import pytest
from expectations import INTEGRATORS, energy_error
from funicular import Harmonic, Material, Rectangle, Scene, SceneError
from funicular.base.rotations import rotate
from numpy.testing import assert_allclose

G = 9.81
BAR = {"section": Rectangle(height=0.03, width=0.02), "elements": 6,
       "material": Material(youngs_modulus=2e7, poisson_ratio=0.0, density=1100)}
FLAT = BAR | {"element": "beam12p"}
STEEL = Material(youngs_modulus=2e11, poisson_ratio=0.3, density=7800)
SOFT = Material(youngs_modulus=1e7, poisson_ratio=0.0, density=1200)
ENERGY_ERRORS = {"explicit": 1e-4, "radau": 2e-3, "genalpha": 2e-2}
Z = {"axis": (0, 0, 1)}


def held(kind, **given) -> Scene:
    """Return a bar on the ground, its far end on a spring and under forces and a moment."""
    scene = Scene()
    scene.modal_body("bar", start=(0, 0, 0), end=(0.5, 0, 0), modes=4, boundary="attached", damping_ratio=0.01, **BAR)
    scene.joint(kind, (0, 0, 0), ("bar", 0.0), name="joint", **given)
    scene.spring(("bar", 0.5), (0.5, 0.3, 0.1), stiffness=200.0, damping=0.5, length=0.2)
    scene.force("bar", s=0.5, value=(0, 5, 3), scale=Harmonic(amplitude=1.0, frequency=20.0))
    scene.force("bar", s=0.5, value=(0, 5, 3), follower=True)
    scene.moment("bar", s=0.25, value=(0.1, 0.3, -0.2))
    return scene


def chain(kind, to="modal", **given) -> Scene:
    """Return two bars, or a bar and a rigid body or a cable, joined and thrown."""
    scene = Scene()
    moving = {"velocity": (0.1, 0.2, -0.3), "angular_velocity": (3, -2, 4)}
    scene.modal_body("bar", start=(0, 0, 0), end=(0.5, 0.1, 0), modes=5, **moving, **BAR)
    if to == "modal":
        scene.modal_body("other", start=(0.5, 0.1, 0), end=(0.9, 0, 0.2), modes=5, **BAR)
    elif to == "rigid":
        scene.rigid_body("other", mass=0.5, inertia=(0.002, 0.003, 0.004), position=(0.5, 0.1, 0), **moving)
    else:
        scene.cable("other", start=(0.5, 0.1, 0), end=(1.1, 0.1, 0), elements=2, material=SOFT,
                    section=Rectangle(height=0.03, width=0.03))
    b = ("other", 0.0) if to != "rigid" else "other"
    scene.joint(kind, ("bar", scene.bodies["bar"].mesh.length), b, name="joint", **given)
    return scene


def rider(frame="point", roll="free", element="cable12", **given) -> Scene:
    scene, planar = Scene(), element.endswith("p")
    scene.cable("wire", start=(0, 0, 0), end=(1.5, 0, 0), elements=3, element=element, material=SOFT,
                section=Rectangle(height=0.05, width=0.05))
    for s in (0.0, 1.5):
        scene.pin("wire", s=s)
    up = {} if planar else {"up": (1, 0, 0)}
    scene.modal_body("bar", start=(0.4, 0, 0), end=(0.4, -0.5, 0), modes=4, velocity=(1, 0, 0),
                     **up, **(FLAT if planar else BAR))
    scene.slide(("bar", 0.0), along="wire", s=0.4, frame=frame, roll=roll, name="joint", **given)
    return scene


def planar() -> Scene:
    scene = rider("tangent", element="cable8p")
    scene.modal_body("arm", start=(0.4, -0.5, 0), end=(0.8, -0.6, 0), modes=4, angular_velocity=(0, 0, 3), **FLAT)
    scene.joint("revolute", ("bar", 0.5), ("arm", 0.0))
    return scene


CASES = {
    "ground-weld": lambda: held("weld"),
    "ground-revolute": lambda: held("revolute", **Z),
    "ground-spherical": lambda: held("spherical"),
    "ground-revolute-driven": lambda: held("revolute", angle=Harmonic(amplitude=0.3, frequency=5.0), **Z),
    "modal-spherical": lambda: chain("spherical"),
    "modal-universal": lambda: chain("universal", axis=(0, 0, 1), second_axis=(1, 1, 0)),
    "modal-weld": lambda: chain("weld"),
    "rigid-prismatic": lambda: chain("prismatic", "rigid", axis=(1, 0.2, 0.1)),
    "rigid-revolute": lambda: chain("revolute", "rigid", **Z),
    "cable-weld": lambda: chain("weld", "cable"),
    "rider": rider,
    "rider-tangent": lambda: rider("tangent"),
    "rider-tangent-fixed": lambda: rider("tangent", "fixed"),
    "rider-section": lambda: rider("section", element="beam24"),
    "rider-driven": lambda: rider(velocity=1.0),
    "planar": planar,
}


@pytest.mark.filterwarnings("ignore:initial velocities broke a joint")
@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("case", CASES)
@pytest.mark.slow_cases("ground-spherical-genalpha", "ground-revolute-genalpha")
def test_it_is_kept_and_the_energy_balances(case, integrator):
    run = CASES[case]().run(0.02, output_step=0.002, tol=1e-4, integrator=integrator)
    assert run["joint.residual"].max() < 1e-9
    assert energy_error(run) < ENERGY_ERRORS[integrator]
    assert np.ptp(run["bar.modal_coordinates"], axis=0).max() > 1e-7, "it deforms"


@pytest.mark.filterwarnings("ignore:initial velocities broke a joint")
@pytest.mark.parametrize("case", [pytest.param("ground-revolute", marks=pytest.mark.slow), "modal-universal",
                                  "rigid-prismatic", "cable-weld", "rider-tangent", "planar"])
@pytest.mark.slow_cases("cable-weld")
def test_integrators_agree(case):
    ends = [CASES[case]().run(0.05, output_step=0.05, tol=1e-6, integrator=name)["bar.nodes"][-1]
            for name in INTEGRATORS]
    assert_allclose(ends[1], ends[0], atol=2e-7)
    assert_allclose(ends[2], ends[0], atol=2e-6)


# ---- closed forms of a slender bar of 1 m (Euler, Bernoulli)

SIDE = 0.01
BENDING = 2e11 * SIDE**4 / 12
UNIT = np.sqrt(BENDING / (7800 * SIDE**2))
"""Angular frequencies are this times the squares of the roots, in rad/s."""
ROOTS = {"pinned": np.pi * np.array([1, 2]), "clamped and pinned": np.array([3.9266023121, 7.0685827456]),
         "cantilever": np.array([1.8751040687, 4.6940911330]), "clamped": np.array([4.7300407449, 7.8532046241])}


def slender(modes, boundary, start, end=None, gravity=(0, 0, 0)) -> Scene:
    """Return a bar whose supported end is on an axial carriage: no axial load, and no redundant equation."""
    scene = Scene(gravity=gravity)
    scene.modal_body("bar", start=(0, 0, 0), end=(1, 0, 0), section=Rectangle(height=SIDE, width=SIDE), material=STEEL,
                     elements=20, element="cable12", modes=modes, boundary=boundary)
    scene.joint(start, (0, 0, 0), ("bar", 0.0), name="foot",
                **({"axis": (0, 0, 1), "second_axis": (0, 1, 0)} if start == "universal" else {}))
    if end:
        scene.rigid_body("carriage", mass=1, inertia=(1, 1, 1), position=(1, 0, 0))
        scene.joint("prismatic", (1, 0, 0), "carriage", axis=(1, 0, 0))
        scene.joint(end, "carriage", ("bar", 1.0))
    return scene


def off(modes, boundary, start, end, of) -> np.ndarray:
    """Return the relative errors of the two lowest roots, which are double."""
    found = np.sqrt(slender(modes, boundary, start, end).modes(4).angular_frequency / UNIT)
    assert_allclose(found[::2], found[1::2], rtol=1e-6)
    return found[::2] / ROOTS[of] - 1


@pytest.mark.parametrize(("boundary", "start", "end", "of", "modes", "power", "last"), [
    # support forces are discontinuous at an end: third order in the modes; a clamp bends a section, which free-end
    # modes do not: first order. A cantilever's own modes are exact up to the mesh
    ("free", "universal", "spherical", "pinned", (8, 16, 32), 2.2, 2e-4),
    ("attached", "weld", "spherical", "clamped and pinned", (8, 32), 2.5, 2e-4),
    ("free", "weld", None, "cantilever", (8, 16, 32), 0.8, 0.03),
    ("free", "weld", "weld", "clamped", (8, 16, 32), 0.8, 0.06),
    ("attached", "weld", None, "cantilever", (4,), 0, 2e-6),
    ("attached", "weld", "weld", "clamped", (8, 32), 1.0, 0.03),
])
def test_frequencies_converge_with_the_number_of_modes(boundary, start, end, of, modes, power, last):
    found = np.array([off(n, boundary, start, end, of) for n in modes])
    assert (found > 0).all(), "modes left out stiffen"
    assert found[-1].max() < last
    for k in range(1, len(modes)):
        assert (np.log(found[k - 1] / found[k]) / np.log(modes[k] / modes[k - 1]) > power).all()


def test_a_cantilever_on_a_spring():
    """b^3 (1 + cos b cosh b) + k (sin b cosh b - cos b sinh b) = 0, with k the stiffness of the spring over EI/L^3."""
    from scipy.optimize import brentq

    k, scene = 20.0, slender(16, "attached", "weld")
    scene.spring(("bar", 1.0), (1, 0.5, 0), stiffness=k * BENDING)
    root = brentq(lambda b: b**3 * (1 + np.cos(b) * np.cosh(b)) + k * (np.sin(b) * np.cosh(b) - np.cos(b) * np.sinh(b)),
                  2, 4)
    found = np.sqrt(scene.modes(2).angular_frequency / UNIT)
    assert_allclose(found, [ROOTS["cantilever"][0], root], rtol=2e-4)


def test_it_sags_under_its_weight_and_a_load():
    """w L^4/8EI and F L^3/3EI; the foot carries force and moment. `modes` about that state agrees.

    With 16 modes the last one is half of a pair of equal frequency, whose axes the library chooses.
    """
    weight, load = 7800 * SIDE**2 * G, 20.0
    scene = slender(20, "attached", "weld", gravity=(0, -G, 0))
    scene.force("bar", s=1.0, value=(0, -load, 0))
    state = scene.equilibrium()
    sag = -(weight / 8 + load / 3) / BENDING
    assert_allclose(state["bar.nodes"][-1, 1], sag, rtol=1e-4)
    assert_allclose(state["foot.force"], [0, weight + load, 0], atol=1e-8)
    assert_allclose(state["foot.moment"], [0, 0, weight / 2 + load], rtol=1e-9, atol=1e-4)  # double modes are mixed
    found = scene.modes(2, about=state)
    assert_allclose(np.sqrt(found.angular_frequency / UNIT), ROOTS["cantilever"][0], rtol=2e-3)
    run = scene.run(0.05, initial=state, tol=1e-6)
    assert_allclose(run["bar.nodes"], np.tile(state["bar.nodes"], (len(run.time), 1, 1)), atol=1e-9)
    assert_allclose(run["foot.moment"][-1], state["foot.moment"], rtol=1e-6, atol=1e-6)


def test_a_moment_bends_it_to_an_arc():
    """M L^2/2EI, and M L/EI of its end section, by a joint and by the load."""
    scene = slender(32, "attached", "weld")
    scene.moment("bar", s=1.0, value=(0, 0, 3.0))
    state = scene.equilibrium()
    assert_allclose(state["bar.nodes"][-1, 1], 3.0 / 2 / BENDING, rtol=2e-3)
    assert_allclose(state["foot.moment"], [0, 0, -3.0], atol=1e-9)


def test_a_bar_on_a_hinge_swings():
    """m g l/2 over m l^2/3 for a stiff bar, also by a run from 0.01 rad."""
    scene = slender(6, "free", "universal", gravity=(G, 0, 0))
    found = scene.modes(2, about=scene.equilibrium()).angular_frequency
    assert_allclose(found, np.sqrt(1.5 * G), rtol=1e-4)


def test_modes_of_a_cable_and_what_rides_it_on_modes():
    """A stiff link on a taut wire at rest vibrates with the wire as a rigid body does."""
    found = []
    for kind in ("modal", "rigid"):
        scene = Scene()
        scene.cable("wire", start=(0, 0, 0), end=(1.5, 0, 0), elements=4, element="cable12", material=SOFT,
                    section=Rectangle(height=0.05, width=0.05))
        for s in (0.0, 1.5):
            scene.pin("wire", s=s)
        bar = scene.modal_body("bar", start=(0.75, 0, 0), end=(0.75, -0.5, 0), up=(1, 0, 0), modes=4,
                               **BAR | {"material": STEEL})
        if kind == "rigid":
            shape, (position, orientation) = bar.shape, bar.frame
            dict.clear(scene.bodies)
            scene.rigid_body("bar", mass=shape.mass, inertia=bar.inertia, position=position, orientation=orientation)
        scene.slide("bar", along="wire", s=0.75, at=(-0.25, 0, 0))
        state = scene.equilibrium()
        assert_allclose(state["bar_on_wire.s"], 0.75, atol=1e-6)
        found.append((state["bar.position"], scene.modes(8, about=state).angular_frequency))
    assert_allclose(found[0][0], found[1][0], atol=1e-6)
    assert_allclose(found[0][1], found[1][1], rtol=1e-4, atol=1e-2)


# ---- loads on points of modal bodies


def test_a_force_on_a_node_does_its_work():
    """The mass centre, at the origin of the frame with free-free modes, obeys Newton's law."""
    scene = Scene(gravity=(0, 0, 0))
    bar = scene.modal_body("bar", start=(0, 0, 0), end=(0.5, 0, 0), modes=4, angular_velocity=(1, 2, -2), **BAR)
    scene.force("bar", at=(0.25, 0.015, 0.01), value=(1, -2, 3))
    run = scene.run(0.1, output_step=0.01, tol=1e-8, integrator="radau")
    assert energy_error(run) < 1e-5
    assert_allclose(run["bar.position"][-1] - bar.frame[0], np.array([1, -2, 3]) / bar.mass * 0.1**2 / 2, rtol=1e-6)


def test_a_follower_turns_with_the_section():
    """A stiff one flies as a rigid body."""
    ends = []
    for stiff in (True, False):
        scene = Scene(gravity=(0, 0, 0))
        moving = {"angular_velocity": (1, 2, -2)}
        bar = scene.modal_body("bar", start=(0, 0, 0), end=(0.5, 0, 0), modes=4, **moving, **BAR | {"material": STEEL})
        if stiff:
            dict.clear(scene.bodies)
            scene.rigid_body("bar", mass=bar.mass, inertia=bar.inertia, position=bar.frame[0], **moving)
        scene.force("bar", at=(0.25, 0.015, 0.01), value=(10, -20, 30), follower=True)
        run = scene.run(0.2, output_step=0.01, tol=1e-8, integrator="radau")
        assert energy_error(run) < 1e-5
        ends.append(run["bar.position"][-1])
    assert_allclose(ends[1], ends[0], atol=3e-4 * np.linalg.norm(ends[0] - bar.frame[0]))


def test_a_moment_turns_it():
    """At any section: J omega' = M about an axis of symmetry."""
    for s in (0.0, 0.25, 0.5):
        scene = Scene(gravity=(0, 0, 0))
        scene.modal_body("bar", start=(0, 0, 0), end=(0.5, 0, 0), modes=4, **BAR | {"material": STEEL})
        scene.moment("bar", s=s, value=(0, 0, 0.1))
        run = scene.run(0.05, output_step=0.05, tol=1e-8)
        bar = scene.bodies["bar"]
        assert_allclose(run["bar.angular_velocity"][-1, 2], 0.1 / bar.inertia[2, 2] * 0.05, rtol=0.02)


def test_loads_and_ends_off_its_nodes_are_refused():
    scene = Scene()
    scene.modal_body("bar", start=(0, 0, 0), end=(0.5, 0, 0), **BAR)
    for add in (lambda: scene.force("bar", s=0.47, value=(1, 0, 0)),
                lambda: scene.force("bar", at=(0.22, 0.01, 0), value=(1, 0, 0)),
                lambda: scene.moment("bar", s=0.47, value=(1, 0, 0)),
                lambda: scene.joint("spherical", (0.47, 0, 0), ("bar", 0.47))):
        with pytest.raises(SceneError, match=r'modal_body "bar": \(0.22, .* m is no node of the body; the nearest'):
            add()


def test_a_scene_file_keeps_loads_and_joints():
    from funicular.scene.file import loads

    scene = held("revolute", **Z)
    again = loads(scene.to_toml(), "text")
    assert again.to_toml() == scene.to_toml()
    one, two = (each.run(0.005, output_step=0.005, tol=1e-6) for each in (scene, again))
    assert_allclose(one["bar.nodes"], two["bar.nodes"], atol=0)


def test_an_end_turns_with_its_section():
    """A light body welded to the tip of a bar bent by a moment has rotated by M L/EI."""
    scene = slender(32, "attached", "weld")
    scene.rigid_body("flag", mass=1e-3, inertia=(1e-6, 1e-6, 1e-6), position=(1, 0, 0))
    scene.joint("weld", ("bar", 1.0), "flag")
    scene.moment("flag", value=(0, 0, 3.0))
    turned = rotate(scene.equilibrium()["flag.orientation"], (1, 0, 0))
    assert_allclose(np.arctan2(turned[1], turned[0]), 3.0 / BENDING, rtol=0.05)
