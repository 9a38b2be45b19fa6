"""Section forces against closed forms: kinks, taut and loaded beams, a spinning beam, a moving force."""

import numpy as np
import pytest
from funicular import Circle, GeneralSection, Material, Rectangle, Scene
from funicular.results.section_forces.layer import beside, fixed_direction
from numpy.testing import assert_allclose
from shared_scenes import cable_scene

LOAD, LENGTH, DEPTH = 10.0, 2.0, 0.1


def kinked_rope(elements):
    """Return a slack weightless rope under 1000 N, in equilibrium."""
    scene = Scene(gravity=(0, 0, 0))
    scene.cable("rope", points=[(0, 0, 0), (5, -3.3, 0), (10, 0, 0)], rest="straight", rest_length=12,
                elements=elements, element="cable8p", section=GeneralSection(area=1e-4, second_moment_about_z=1e-9),
                material=Material(youngs_modulus=1e9, poisson_ratio=0.3, density=1000))
    scene.pin("rope", s=0)
    scene.pin("rope", s=12)
    scene.force("rope", s=6.21, value=(0, -1000, 0))
    return scene.equilibrium()


@pytest.mark.parametrize("elements", [12, 24, 25])
def test_a_sharp_kink(elements, validated):
    """The tension in each half is the side of the triangle of forces."""
    rest = kinked_rope(elements)
    for side, support in (("before", "rope@0"), ("after", "rope@12")):
        pull = np.linalg.norm(rest[f"{support}.force"])
        tension = rest.section_forces("rope", [5.2, 6.21, 7.2], side=side)["tension"].values
        validated("Section forces", "rope under a point force", f"tension {side} the force", float(pull),
                  float(tension[1]), unit="N", bound=1e-4, source="triangle of forces", variant="cable8p",
                  mesh=f"{elements} elements")
        assert tension[0 if side == "before" else 2] == pytest.approx(pull, rel=1e-5)
        law = rest.section_forces("rope", [6.21], method="constitutive", side=side)
        assert abs(law["tension"].values[0] - pull) > 0.07 * pull


class TestTautBending:
    """Elements of a taut cable that are much longer than its bending length, against a resolved mesh."""

    S = np.array([0, 0.02, 0.05, 2.0, 4.0, 4.19, 4.21, 7.03, 7.05, 7.07, 9.5])
    CONVERGED = np.array([-3.751, -1.785, -0.586, 0.0146, 0.0153, 0.666, 1.381, 0.729, -1.485, -0.700, 0])
    """Moments in N m, sides of larger s, of 990 elements cable8p by both methods, which are 1 % apart there."""

    @staticmethod
    def moments(elements, element, method="balance"):
        """Return moments with a clamp, a force, a moment and a partial load; E I 1 N m^2, 1.32 kN, a bending length of
        27 mm.
        """
        scene = Scene(gravity=(0, 0, 0))
        scene.cable("rope", start=(0, 0, 0), end=(10, 0, 0), rest_length=9.9, elements=elements, element=element,
                    section=GeneralSection(area=1e-4, second_moment_about_z=1e-9),
                    material=Material(youngs_modulus=1e9, poisson_ratio=0.3, density=1000))
        scene.clamp("rope", s=0)
        scene.pin("rope", s=9.9)
        scene.force("rope", s=4.21, value=(0, -100, 0))
        scene.moment("rope", s=7.05, value=(0, 0, 3))
        scene.distributed_force("rope", value=(0, -20, 0), start=1, stop=9)
        return scene.equilibrium().section_forces("rope", TestTautBending.S, method=method)["moment"].values[:, 2]

    @pytest.mark.parametrize(("elements", "element"),
                             [(9, "cable8p"), (24, "cable8p"), (18, "cable12"), (9, "cable18")])
    def test_moments_of_a_coarse_mesh(self, elements, element, validated):
        validated("Section forces", "taut rope that bends over 27 mm", "moments at 11 places", self.CONVERGED,
                  self.moments(elements, element), unit="N m", scale=1.0, bound=0.08,
                  source="990 elements, both methods", variant=element, mesh=f"{elements} elements")
        assert np.abs(self.moments(elements, element, "constitutive") - self.CONVERGED).max() > 1.5

    def test_moments_of_a_fine_mesh(self):
        assert_allclose(self.moments(990, "cable8p"), self.CONVERGED, atol=0.005)
        assert_allclose(self.moments(990, "cable8p", "constitutive"), self.CONVERGED, atol=0.05)

    @pytest.mark.parametrize("elements", [24, 48])
    def test_moment_of_a_kink(self, elements, validated):
        """2 sqrt(N E I) sin(theta/4) under a force that deflects the rope by theta, 69 degrees: 17.6 N m."""
        rest = kinked_rope(elements)
        before, after = (rest.section_forces("rope", [6.21], side=side) for side in ("before", "after"))
        one, other = before["force"].values[0], after["force"].values[0]
        theta = np.arccos(one @ other / np.linalg.norm(one) / np.linalg.norm(other))
        exact = 2 * np.sqrt(np.sqrt(np.linalg.norm(one) * np.linalg.norm(other))) * np.sin(theta / 4)
        assert 17 < exact < 18
        for name, side in (("before", before), ("after", after)):
            validated("Section forces", "rope under a point force", f"moment {name} the force", exact,
                      float(side["moment"].values[0, 2]), unit="N m", bound=0.05, variant="cable8p",
                      source="closed form, 2 √(N E I) sin(θ/4)", mesh=f"{elements} elements")


@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("across", [0.0, 1e-15, -1e-15])
@pytest.mark.parametrize("degrees", [30, 90, 120, -90])
def test_a_clamp_bends_a_taut_cable_towards_its_force(side, across, degrees):
    """M = 2 sqrt(N E I) sin(theta/2). At 90 degrees the mirror image of the force is opposite it, and rounding decides
    on the axis of the rotation between these two.
    """
    angle, pull, EI, distance = np.deg2rad(degrees), 10.0, 1e-3, 0.004
    force = pull * np.array([[np.cos(angle) + across, np.sin(angle), 0]])
    kink = fixed_direction(np.zeros(1), np.array([[1.04, 0, 0]]), force, side)
    s = np.array([[side * distance, -side * distance]])
    found = beside(kink, s, s > 0, lambda about: np.full((1, 2), EI), np.repeat(force[:, None], 2, axis=1),
                   np.ones((len(force), 2)))
    theta = 4 * np.arctan(np.tan(angle / 4) * np.exp(-distance / np.sqrt(EI / pull)))
    assert_allclose(found, [[[0, 0, side * 2 * np.sqrt(pull * EI) * np.sin(theta / 2)], [0, 0, 0]]], rtol=1e-12)


BEAMS = [("cable12", None), ("cable18", None), ("cable8p", None), ("beam24", "structural"), ("beam24", "continuum"),
         ("beam12p", "structural"), ("beam12p", "continuum")]


def beam(element, law, elements, **given):
    return cable_scene("beam", length=LENGTH, gravity=(0, 0, 0), elements=elements, element=element, law=law,
                       section=Rectangle(height=DEPTH, width=DEPTH),
                       material=Material(youngs_modulus=1e9, poisson_ratio=0, density=1000, **given))


@pytest.mark.parametrize("elements", [3, 8])
@pytest.mark.parametrize(("element", "law"), BEAMS)
def test_a_cantilever_with_a_load_inside_an_element(element, law, elements, validated):
    scene, at = beam(element, law, elements), 1.3
    scene.clamp("beam", s=0)
    scene.force("beam", s=at, value=(0, -LOAD, 0))
    s = np.array([0, 0.3, 0.7, at, 1.7, LENGTH])
    rest = scene.equilibrium()
    forces = rest.section_forces("beam", s, side="before")
    assert_allclose(forces["force"][:, 1], np.where(s <= at, -LOAD, 0), atol=1e-9 * LOAD)
    validated("Section forces", "cantilever, load inside an element", "moment", np.where(s <= at, -LOAD * (at - s), 0),
              forces["moment"].values[:, 2], unit="N m", scale=LOAD * at, bound=1e-5, source="closed form",
              variant=f"{element}{', ' + law if law else ''}", mesh=f"{elements} elements")
    assert_allclose(forces["shear"], np.where(s <= at, LOAD, 0), atol=1e-4 * LOAD)
    assert_allclose(forces["moment"][0], -rest["beam@0.moment"], atol=1e-6 * LOAD)


@pytest.mark.parametrize(("element", "law"), BEAMS)
def test_a_beam_on_two_supports(element, law):
    """The far support is a long spring, which is soft along the beam. Both sides of the load are evaluated."""
    scene, at = beam(element, law, 3), 1.3
    scene.pin("beam", s=0)
    scene.spring(("beam", LENGTH), (LENGTH, 100, 0), stiffness=1e9, length=100)
    if scene.cables["beam"].dim == 3:
        scene.spring(("beam", LENGTH), (LENGTH, 0, 100), stiffness=1e9, length=100)
    scene.force("beam", s=at, value=(0, -LOAD, 0))
    forces = scene.equilibrium().section_forces("beam")
    s = forces["s"].values
    assert np.sum(np.abs(s - at) < 1e-7) == 2
    part = (LENGTH - at) / LENGTH
    assert_allclose(forces["force"][:, 1], -LOAD * np.where(s < at, part, part - 1), atol=1e-6 * LOAD)
    assert_allclose(forces["moment"][:, 2], LOAD * np.where(s < at, part * s, (1 - part) * (LENGTH - s)),
                    atol=1e-5 * LOAD)


def test_a_beam_that_spins(validated):
    """N = rho A W^2 (L^2 - s^2)/2 at small stretch, after damping of its vibrations."""
    speed, L = 10.0, LENGTH
    scene = Scene(gravity=(0, 0, 0))
    scene.cable("beam", start=(0, 0, 0), end=(L, 0, 0), elements=4, element="beam24", law="structural",
                section=Rectangle(height=DEPTH, width=DEPTH), angular_velocity=(0, 0, speed),
                material=Material(youngs_modulus=1e9, poisson_ratio=0, density=1000, damping_time=5e-4))
    scene.pin("beam", s=0)
    run = scene.run(duration=0.2, output_step=0.05, tol=1e-6)
    s = np.array([0, 0.4, 1.1, 1.9, L])
    tension = run.section_forces("beam", s)["tension"].values[-1]
    validated("Section forces", "beam that spins", "tension", 1000 * DEPTH**2 * speed**2 * (L**2 - s**2) / 2, tension,
              unit="N", scale=2000.0, bound=2e-3, source="closed form", variant="beam24, structural", mesh="4 elements")


def test_a_force_that_crosses_a_beam(validated):
    """Case M1 at half the critical speed: moments at three sections and under the force, against a Fourier series."""
    F, EI, line = 1.0, 1e9 * DEPTH**4 / 12, 1000 * DEPTH**2
    v = 0.5 * np.pi / LENGTH * np.sqrt(EI / line)
    scene = beam("cable8p", None, 8)
    scene.pin("beam", s=0)
    scene.pin("beam", s=LENGTH)
    scene.rigid_body("A", mass=1e-4, inertia=(1, 1, 1), position=(0, 0, 0), velocity=(v, 0, 0))
    scene.force("A", value=(0, -F, 0))
    scene.slide("A", along="beam", s=0.0, velocity=v, name="slide")
    run = scene.run(duration=0.95 * LENGTH / v, output_step=0.05 * LENGTH / v, integrator="radau")
    t, s = run.time[1:], np.array([0.25, 0.5, 0.75]) * LENGTH
    n = np.pi / LENGTH * np.arange(1, 1001)[:, None, None]
    x = np.concatenate([np.broadcast_to(s, (len(t), 3)), v * t[:, None]], axis=1)
    w, W = n**2 * np.sqrt(EI / line), n * v
    wave = 2 * F / (line * LENGTH) / (w**2 - W**2) * (np.sin(W * t[:, None]) - W / w * np.sin(w * t[:, None]))
    exact = (EI * n**2 * wave * np.sin(n * x)).sum(axis=0)

    def moments(method):
        there, under = (run.section_forces("beam", place, method=method)["moment"].values[1:, ..., 2]
                        for place in (s, "slide"))
        return np.column_stack([there, under])

    validated("Section forces", "force that crosses a beam at half the critical speed", "moments", exact,
              moments("balance"), unit="N m", scale=F * LENGTH / 4, bound=0.012, source="closed form, Fourier series",
              variant="cable8p, radau", mesh="8 elements")
    assert np.abs(moments("constitutive") - exact).max() > 0.05 * F * LENGTH / 4


@pytest.mark.parametrize("fraction", [0.25, 0.5, 1.0])
def test_states_on_the_way_carry_a_part_of_the_load(fraction):
    scene = beam("beam12p", "structural", 4)
    scene.gravity = (0, -9.81, 0)
    scene.clamp("beam", s=0)
    scene.force("beam", s=LENGTH, value=(0, -100, 0))
    (state,) = [state for state in scene.equilibrium(load_steps=4).path if state.load_fraction == fraction]
    s = np.array([0, 1, LENGTH])
    below = 100 + 9.81 * 1000 * DEPTH**2 * (LENGTH - s)
    assert_allclose(state.section_forces("beam", s)["force"][:, 1], -fraction * below, rtol=1e-6)


def test_a_bent_wire_drawn_straight():
    """A taut cable with an arc as its stress-free shape has the moment of straightening, by its law alone."""
    scene = Scene(gravity=(0, 0, 0))
    u = np.linspace(0, 1, 41)
    scene.cable("wire", points=[(10 * np.sin(a), 10 - 10 * np.cos(a), 0) for a in u], elements=12, element="cable12",
                section=Circle(radius=0.01), material=Material(youngs_modulus=1e9, poisson_ratio=0.3, density=1000))
    scene.pin("wire", s=0)
    scene.force("wire", s=scene.cables["wire"].length, value=(4000, 0, 0))
    rest = scene.equilibrium()
    EI = 1e9 * np.pi * 0.01**4 / 4
    moment = rest.section_forces("wire", [4.0, 5.0, 6.0])["moment"].values
    by_law = rest.section_forces("wire", [4.0, 5.0, 6.0], method="constitutive")["moment"].values
    assert np.linalg.norm(moment, axis=1).min() > 0.6 * EI / 10
    assert_allclose(moment, by_law, atol=0.02 * EI / 10)
