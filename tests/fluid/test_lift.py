"""Lift of cables and bodies: deflection, gliding, angles of attack, derivatives, energy balance, refusals."""

from functools import cache
from math import atan2, cos, pi, radians, sin, sqrt

import funicular as fu
import numpy as np
import pytest
from derivatives import error_by_drags
from expectations import unaccounted

INTEGRATORS = ("genalpha", "energy", "explicit", "radau")
ELEMENTS = ("cable12", "cable18", "beam24")
G, WATER = 9.81, 1000.0
ROPE = {"section": fu.Circle(radius=0.01), "material": fu.Material(youngs_modulus=1e7, poisson_ratio=0.0, density=2000)}


def plate():
    """Return the polar of a flat plate: normal force 2 sin(angle), a spline of exact symmetry."""
    angle = np.linspace(-pi, pi, 73)
    normal = 2 * np.sin(angle)
    drag, lift = normal * np.sin(angle) + 0.02, normal * np.cos(angle)
    drag[-1], lift[-1] = drag[0], lift[0]
    return fu.Polar(angle=angle, drag=np.maximum(drag, 0.02), lift=lift, interpolation="cubic")


@pytest.mark.parametrize("element", ELEMENTS)
def test_a_cable_in_cross_flow_is_deflected_by_lift_over_drag(element):
    """The plane of a weightless taut cable across the flow leans by atan(C_L/C_D)."""
    scene = fu.Scene(gravity=(0, 0, 0))
    wire = scene.cable("wire", start=(0, 0, 0), end=(0, 0, 4), elements=8, element=element, rest_length=3.9,
                       section=ROPE["section"],
                       material=fu.Material(youngs_modulus=1e10, poisson_ratio=0.0, density=2000))
    scene.pin(wire, s=0.0)
    scene.pin(wire, s=wire.length)
    scene.fluid(density=WATER, velocity=(1.5, 0, 0))
    scene.drag(wire, normal=1.2, lift=0.5, displaced_area=0)
    state = scene.equilibrium()
    middle = state["wire.position"][4]
    assert middle[0] > 5e-4
    assert middle[1] / middle[0] == pytest.approx(0.5 / 1.2, rel=1e-6)  # i x w: z times x is along y
    force = state["drag_1.force"]
    assert force[1] / force[0] == pytest.approx(0.5 / 1.2, rel=1e-6)
    cuts = state.section_forces("wire", [0.001, wire.length - 0.001])["force"]
    assert np.abs(np.array(cuts[1] - cuts[0]) + force).max() < 2e-3 * np.linalg.norm(force)


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_glider_comes_down_at_the_angle_of_drag_over_lift(integrator):
    """Steady glide at constant coefficients: tan(angle) = C_D/C_L, ρ/2 A v² sqrt(C_D² + C_L²) = m g."""
    drag, lift, area, mass = 0.1, 0.8, 0.5, 2.0
    angle = atan2(drag, lift)
    speed = sqrt(mass * G / (1.2 / 2 * area * sqrt(drag**2 + lift**2)))
    scene = fu.Scene()
    scene.rigid_body("wing", mass=mass, inertia=(0.1, 0.1, 0.1), position=(0, 0, 0),
                     velocity=(speed * cos(angle), -speed * sin(angle), 0))
    scene.fluid(density=1.2)
    # the flow comes from ahead, along -x: lift along y is span x flow for a span along -z
    scene.drag("wing", area=area, coefficient=drag, lift=lift, span=(0, 0, -1))
    run = scene.run(2.0, tol=1e-8, integrator=integrator, output_step=0.5)
    way = run["wing.position"][-1]
    assert way == pytest.approx([2 * speed * cos(angle), -2 * speed * sin(angle), 0], abs=1e-5)
    assert unaccounted(run) < (1e-11 if integrator == "energy" else 1e-5)


def kite(dim=3):
    """Return a plate on a hinge with a spring, in a wind that has a height profile."""
    scene = fu.Scene()
    element = "cable12" if dim == 3 else "cable8p"
    wire = scene.cable("wire", start=(0, 0, 0), end=(1, 0.5, 0), elements=3, element=element, **ROPE)
    scene.pin(wire, s=0.0)
    scene.rigid_body("kite", mass=0.3, inertia=(0.01, 0.02, 0.03), position=(1.1, 0.6, 0),
                     angular_velocity=(0.5, 0.3, 1.0) if dim == 3 else (0, 0, 1.0))
    scene.spring(("wire", wire.length), ("kite", (-0.1, 0, 0)), stiffness=300.0, length=0.1)
    scene.fluid("wind", density=1.2, velocity=(9, 2, 1 if dim == 3 else 0),
                profile=fu.PowerProfile(exponent=0.2, reference_height=0.3, least_height=0.1))
    more = {"span": (0, 0.2, 1), "lift": 0.3} if dim == 3 else {}
    scene.drag(wire, normal=1.1, **{"lift": more["lift"]} if more else {})
    scene.drag("kite", area=0.2, polar=plate(), chord=(1, 0.1, -0.02) if dim == 3 else (1, 0.1, 0), at=(0.05, 0.02, 0),
               **{"span": more["span"]} if more else {})
    return scene


@cache
def accurate(dim):
    """Return the reference run, computed once."""
    return kite(dim).run(0.15, tol=1e-9, integrator="explicit", output_step=0.05)


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_all_integrators_fly_a_kite_alike(integrator, dim):
    run = kite(dim).run(0.15, tol=1e-6, integrator=integrator, output_step=0.05)
    best = accurate(dim)
    assert np.abs(run["kite.position"] - best["kite.position"]).max() < 1e-5
    assert unaccounted(run) < (1e-11 if integrator == "energy" else 1e-5)


@pytest.mark.parametrize("dim", [2, 3])
def test_newtons_matrix_is_the_derivative_of_its_residual(dim):
    assert error_by_drags(kite(dim)) < 2e-5


@pytest.mark.parametrize("degrees", [-140, -30, 0, 10, 75, 180])
def test_a_plate_has_the_coefficients_of_its_angle_of_attack(degrees):
    """The flow comes from below the chord at this angle about the span, for a body rotated in space."""
    angle, turn = radians(degrees), (cos(0.4), sin(0.4) * 0.6, 0.0, sin(0.4) * 0.8)
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.rigid_body("wing", mass=1e9, inertia=(1e9,) * 3, position=(0, 0, 0), orientation=turn)
    body = scene.bodies["wing"]
    flow = 7 * (cos(angle) * body.axes[:, 0] + sin(angle) * body.axes[:, 1])
    lift = 7 * (-sin(angle) * body.axes[:, 0] + cos(angle) * body.axes[:, 1])
    along = 3 * body.axes[:, 2]  # the part along the span does nothing
    scene.fluid(density=1.2, velocity=flow + along)
    scene.drag("wing", area=0.5, polar=plate(), chord=(1, 0, 0), span=(0, 0, 1))
    drag, up = plate().at(angle)
    run = scene.run(1e-3, step=1e-3, integrator="explicit")
    assert run["drag_1.force"][0] == pytest.approx(1.2 / 2 * 0.5 * 7 * (drag * flow + up * lift), rel=1e-9, abs=1e-9)
    assert up == pytest.approx(2 * sin(angle) * cos(angle), abs=1e-4)


def test_a_vane_turns_into_the_wind():
    """Equilibrium of a plate on a pivot ahead of its centre of pressure."""
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.rigid_body("vane", mass=1.0, inertia=(0.1, 0.1, 0.1), position=(0, 0, 0),
                     orientation=(cos(0.2), 0, 0, sin(0.2)))
    scene.joint("revolute", "vane", (0, 0, 0), axis=(0, 0, 1))
    scene.fluid(density=1.2, velocity=(8, 3, 0))
    scene.drag("vane", area=0.3, polar=plate(), chord=(1, 0, 0), span=(0, 0, 1), at=(0.4, 0, 0))
    w, _, _, z = scene.equilibrium()["vane.orientation"]
    assert 2 * atan2(z, w) == pytest.approx(atan2(3, 8), abs=1e-7)


def test_planar_scenes_in_another_plane_have_the_same_lift():
    runs = []
    for element in ("cable8p", "cable12"):
        scene = fu.Scene(gravity=(0, 0, -G))
        wire = scene.cable("wire", start=(1, 0.5, 12), end=(3, 0.5, 14), elements=4, element=element, up=(0, 0, 1),
                           strain="engineering", **ROPE)
        scene.pin(wire, s=0.0)
        scene.rigid_body("kite", mass=0.3, inertia=(0.01, 0.02, 0.03), position=(3.1, 0.5, 14))
        scene.spring(("wire", wire.length), ("kite", (0.1, 0, 0)), stiffness=200.0, length=0.05)
        scene.fluid(density=1.2, velocity=(9, 0, 2))
        scene.drag("kite", area=0.2, polar=plate(), chord=(1, 0, 0.2), span=(0, 1, 0))
        runs.append(scene.run(0.1, tol=1e-8, integrator="radau", output_step=0.05))
    planar, spatial = runs
    assert np.abs(planar["drag_1.force"] - spatial["drag_1.force"]).max() < 1e-6
    assert np.abs(planar["kite.position"] - spatial["kite.position"]).max() < 1e-7


def test_scene_files_say_the_same():
    text = kite().to_toml()
    assert fu.Scene.from_toml(text).to_toml() == text and "polar = {angle = [-3.14159" in text


@pytest.mark.parametrize("column", ["drag", "lift", "moment"])
def test_a_polar_closes_within_rounding(column):
    angle = np.linspace(-pi, pi, 181)
    values = 1.0 + np.sin(angle)  # the ends differ by 2.4e-16
    assert values[0] != values[-1]
    made = fu.Polar(**{"angle": angle, "drag": [1.0] * 181, "lift": [0.0] * 181, column: values})
    assert np.all(made.coefficients(np.array(-pi)) == made.coefficients(np.array(pi)))
    values[-1] += 1e-8
    with pytest.raises(fu.SceneError, match=f"{column} must be the same at both ends"):
        fu.Polar(**{"angle": angle, "drag": [1.0] * 181, "lift": [0.0] * 181, column: values})


REFUSED = {
    "no span": (lambda s: s.drag("A", area=1, lift=1), "span is missing"),
    "no chord": (lambda s: s.drag("A", area=1, polar=plate(), span=(0, 0, 1)), "chord is missing"),
    "not square": (lambda s: s.drag("A", area=1, polar=plate(), span=(0, 0, 1), chord=(1, 0, 1)), "be square to span"),
    "two lifts": (lambda s: s.drag("A", area=1, polar=plate(), span=(0, 0, 1), chord=(1, 0, 0), lift=1),
                  "has a polar and lift"),
    "two drags": (lambda s: s.drag("A", area=1, polar=plate(), span=(0, 0, 1), chord=(1, 0, 0), coefficient=2),
                  "has a polar and a coefficient"),
    "no area": (lambda s: s.drag("A", volume=1, lift=1, span=(0, 0, 1)), "has lift without an area"),
    "chord alone": (lambda s: s.drag("A", area=1, chord=(0, 0, 1)), "chord is given without a polar"),
    "span alone": (lambda s: s.drag("A", area=1, span=(0, 0, 1)), "span is given without lift"),
    "span of a cable": (lambda s: s.drag("wire", normal=1, span=(0, 0, 1)), "takes no span"),
    "half a turn": (lambda s: fu.Polar(angle=[-1, 0, 1], drag=[0, 0, 0], lift=[0, 0, 0]), "angle must go from"),
    "ends": (lambda s: fu.Polar(angle=[-pi, 0, pi], drag=[0, 0, 0], lift=[0, 0, 1]), "must be the same at both ends"),
    "negative": (lambda s: fu.Polar(angle=[-pi, 0, pi], drag=[1, -1, 1], lift=[0, 0, 0]), "must not be negative"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_bad_input_is_refused(case):
    scene = fu.Scene()
    scene.cable("wire", start=(0, 0, 0), end=(1, 0, 0), elements=3, element="cable12", **ROPE)
    scene.rigid_body("A", mass=1.0, inertia=(1, 1, 1), position=(0, 1, 0))
    scene.fluid(density=WATER)
    add, message = REFUSED[case]
    with pytest.raises(fu.SceneError, match=message):
        add(scene)


def test_lift_of_a_planar_cable_is_refused():
    scene = fu.Scene()
    scene.cable("wire", start=(0, 0, 0), end=(1, 0, 0), elements=3, element="cable8p", **ROPE)
    scene.fluid(density=WATER)
    with pytest.raises(fu.SceneError, match="leaves the plane"):
        scene.drag("wire", lift=1.0)
