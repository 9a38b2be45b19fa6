"""Added mass: frequencies, falls, conserved impulses, energy balance, all integrators, refusals."""

from functools import cache
from itertools import pairwise, product
from math import pi, sqrt

import funicular as fu
import numpy as np
import pytest
from derivatives import error_by_drags, of_a_step
from expectations import unaccounted
from funicular.choice.planar import planar_of
from funicular.engine import Engine
from funicular.integrators import EnergyMomentum
from funicular.model.build import build
from scipy.integrate import quad, solve_ivp

INTEGRATORS = ("genalpha", "energy", "explicit", "radau")
SMALL_STEPS = {("genalpha", 3), ("energy", 3)}  # of second order, where tol is 1e-6: for seconds
IN_WATER = [pytest.param(*each, marks=[pytest.mark.slow] * (each in SMALL_STEPS))
            for each in product(INTEGRATORS, (2, 3))]
FOR_JOINTS_AND_MODES = ("genalpha", "explicit", "radau")
FORMS = ("lagrange", "morison")
ELEMENTS = ("cable12", "cable8p", "cable18", "beam24", "beam12p")
G, WATER, RADIUS, STEEL = 9.81, 1000.0, 0.01, 7800.0
AREA = pi * RADIUS**2


def rope(scene, element="cable12", end=(2, 0, 0), elements=4, density=STEEL, youngs_modulus=1e7, **more):
    return scene.cable("wire", start=(0, 0, 0), end=end, elements=elements, element=element,
                       section=fu.Circle(radius=RADIUS),
                       material=fu.Material(youngs_modulus=youngs_modulus, poisson_ratio=0.0, density=density), **more)


def taut(coefficient, element="cable12"):
    """Return a string of 2 m; its tension dominates, a hundred times its bending stiffness changes nothing."""
    scene = fu.Scene(gravity=(0, 0, 0))
    wire = rope(scene, element, elements=12, youngs_modulus=1e5, rest_length=2 / 1.5)
    scene.pin(wire, s=0.0)
    scene.pin(wire, s=wire.length)
    scene.fluid(density=WATER)
    if coefficient is not None:
        scene.drag(wire, added_mass=coefficient)
    return scene


@pytest.mark.parametrize("element", ELEMENTS)
def test_a_taut_cable_vibrates_slower_in_water(element, validated):
    """Transverse frequencies decrease by sqrt(m/(m + C rho A)); rotating sections carry no water."""
    dry, still, wet = (taut(coefficient, element) for coefficient in (None, 0.0, 1.3))
    found = [scene.modes(2, about=scene.equilibrium()).frequency for scene in (dry, still, wet)]
    assert found[1] == pytest.approx(found[0], rel=1e-9, abs=1e-6)
    turns = 1e-4 if "beam" in element else 1e-7
    validated("Fluid", "taut cable in water, added mass", "frequency over that in air",
              sqrt(STEEL / (STEEL + 1.3 * WATER)), float(found[2][-1] / found[0][-1]), bound=turns,
              source="closed form", variant=element)


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_run_vibrates_with_the_frequency_of_the_modes(integrator):
    scene = taut(1.3)
    state = scene.equilibrium()
    modes = scene.modes(1, about=state)
    period = 1 / modes.frequency[0]
    start = {"wire.nodal_vectors": state["wire.nodal_vectors"] + 1e-6 * modes["wire.nodal_vectors"][0]}
    run = scene.run(2 * period, initial=start, tol=1e-5, integrator=integrator, output_step=period / 8)
    shape = run["wire.nodal_vectors"][:, 6, 0] - state["wire.nodal_vectors"][6, 0]
    along = shape @ shape[0] / (shape[0] @ shape[0])
    assert np.abs(along - np.cos(2 * pi * run.time / period)).max() < 1e-3


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("element", ["cable12", "beam12p"])
def test_a_cable_that_falls_across_carries_the_water_along(integrator, element):
    """v = v_t tanh(g' t/v_t), with g' the weight in water over the total mass."""
    scene = fu.Scene()
    rope(scene, element)
    scene.fluid(density=WATER)
    scene.drag("wire", normal=1.2, tangential=0.01, added_mass=1.0, added_mass_tangential=0.05)
    run = scene.run(0.5, tol=1e-7, integrator=integrator, output_step=0.05)
    weight, mass = (STEEL - WATER) * AREA * G, (STEEL + WATER) * AREA
    terminal = sqrt(weight / (WATER / 2 * 2 * RADIUS * 1.2))
    exact = -terminal * np.tanh(run.time * weight / mass / terminal)
    assert np.abs(run["wire.nodal_velocity"][:, :, 0, 1] - exact[:, None]).max() < 1e-6
    assert unaccounted(run) < (1e-12 if integrator == "energy" else 1e-5)
    # fluid forces: buoyancy, drag, added mass
    drag = WATER / 2 * 2 * RADIUS * 1.2 * exact**2
    force = 2 * (WATER * AREA * G + drag - WATER * AREA * (drag - weight) / mass)
    assert np.abs(run["drag_1.force"][:, 1] - force).max() < 1e-4 * force.max()


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_sphere_begins_to_fall_with_the_mass_of_half_the_water(integrator):
    scene = fu.Scene()
    scene.fluid(density=WATER)
    scene.rigid_body("ball", mass=3.0, inertia=(1e-3, 1e-3, 1e-3), position=(0, 0, 0))
    scene.drag("ball", volume=1e-3, added_mass=0.5)
    run = scene.run(0.4, tol=1e-8, integrator=integrator, output_step=0.1)
    assert run["ball.position"][:, 1] == pytest.approx(-(3 - 1) / (3 + 0.5) * G * run.time**2 / 2, abs=1e-8)
    assert unaccounted(run) < (1e-13 if integrator == "energy" else 1e-8)
    assert run["ball.acceleration"][-1, 1] == pytest.approx(-(3 - 1) / (3 + 0.5) * G, rel=1e-6)


@pytest.mark.parametrize("integrator", FOR_JOINTS_AND_MODES)
def test_a_pendulum_in_water_swings_with_the_weight_and_the_inertia_that_the_water_leaves(integrator, validated):
    """A ball on a massless rod from 60 degrees: the period is an elliptic integral, with the weight in water."""
    length, angle = 1.0, pi / 3
    scene = fu.Scene()
    scene.fluid(density=WATER)
    scene.rigid_body("ball", mass=8.0, inertia=(1e-6, 1e-6, 1e-6),
                     position=(length * np.sin(angle), -length * np.cos(angle), 0))
    scene.joint("spherical", ("ball", (-length * np.sin(angle), length * np.cos(angle), 0)), (0, 0, 0))
    scene.drag("ball", volume=1e-3, added_mass=(0.5, 0.5, 0.5))
    effective = (8 - 1) / (8 + 0.5) * G
    quarter = quad(lambda x: 1 / sqrt(1 - (np.sin(angle / 2) * np.sin(x)) ** 2), 0, pi / 2)[0]
    period = 4 * sqrt(length / effective) * quarter
    run = scene.run(period, tol=1e-7, integrator=integrator, output_step=period / 4)
    validated("Fluid", "pendulum in water, from 60 degrees", "position after a period", run["ball.position"][0],
              run["ball.position"][-1], unit="m", scale=1.0, bound=1e-5, source="closed form, elliptic integral",
              variant=integrator)
    assert run["ball.position"][2, 0] == pytest.approx(-run["ball.position"][0, 0], abs=1e-5)
    assert unaccounted(run) < 1e-5
    rest = scene.equilibrium()
    assert rest["ball.position"] == pytest.approx([0, -1, 0], abs=1e-9)
    assert scene.modes(1, about=rest).angular_frequency[0] == pytest.approx(0.0, abs=1e-3)  # about the rod, first


def kirchhoff(mass, J, C, v, omega, duration):
    """Return v, omega (body axes) of a body in a fluid at a time, by Kirchhoff's equations."""
    M, J = mass * np.eye(3) + C, np.diag(J)

    def rates(t, x):
        p, m = M @ x[:3], J @ x[3:6]
        return np.concatenate([np.linalg.solve(M, np.cross(p, x[3:6])),
                               np.linalg.solve(J, np.cross(m, x[3:6]) + np.cross(p, x[:3]))])

    return solve_ivp(rates, (0, duration), np.concatenate([v, omega]), rtol=1e-12, atol=1e-13).y[:, -1]


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.slow_cases("energy", "explicit")
def test_a_body_that_tumbles_in_water_follows_kirchhoffs_equations(integrator):
    C = np.array([[0.4, 0.1, 0.0], [0.1, 1.1, 0.2], [0.0, 0.2, 2.0]])
    J, v, omega = (0.02, 0.05, 0.06), np.array([1.0, 0.3, -0.5]), np.array([0.5, -1.0, 2.0])
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.fluid(density=WATER)
    scene.rigid_body("fish", mass=1.5, inertia=J, position=(0, 0, 0), velocity=v, angular_velocity=omega)
    scene.drag("fish", volume=1e-3, added_mass=C)
    run = scene.run(2.0, tol=1e-8 if integrator != "genalpha" else 1e-6, integrator=integrator, output_step=1.0)
    exact = kirchhoff(1.5, J, C, v, omega, 2.0)
    assert run["fish.angular_velocity"][-1] == pytest.approx(exact[3:], abs=1e-4 if integrator == "genalpha" else 1e-5)
    assert np.ptp(run["energy.kinetic"]) < 1e-5
    assert np.linalg.norm(run["fish.velocity"][-1]) == pytest.approx(np.linalg.norm(exact[:3]), abs=1e-4)


def tumbling(at, dim=3):
    """Return a body that tumbles in still water, with its added mass at a point of it."""
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.fluid(density=WATER)
    out = 0.2 * (dim == 3)
    scene.rigid_body("fish", mass=1.5, inertia=(0.02, 0.05, 0.06), position=(0, 0, 0),
                     velocity=(1.0, 0.3, -0.5 * (dim == 3)),
                     angular_velocity=(0.5, -1.0, 2.0) if dim == 3 else (0, 0, 2.0))
    scene.drag("fish", volume=1e-3, at=at, added_mass=[[0.4, 0.1, 0], [0.1, 1.1, out], [0, out, 2.0]])
    return scene


@pytest.mark.parametrize(("at", "dim"), [((0, 0, 0), 3), ((0.1, -0.2, 0.05), 3), ((0.1, -0.2, 0), 2)])
def test_a_body_keeps_its_energy_in_still_water_to_rounding(at, dim):
    run = tumbling(at, dim).run(2.0, step=4e-3, integrator="energy", output_step=0.1)
    assert np.ptp(run["energy.kinetic"]) < 1e-13 * run["energy.kinetic"][0]  # measured: 5e-15
    assert np.abs(run["energy.external"]).max() < 1e-13 * run["energy.kinetic"][0]
    other = tumbling(at, dim).run(2.0, step=4e-3, integrator="genalpha", output_step=0.1)
    assert np.ptp(other["energy.kinetic"]) > 1e-6 * run["energy.kinetic"][0]


@pytest.mark.parametrize("at", [(0, 0, 0), (0.1, -0.2, 0.05)])
def test_added_mass_of_a_body_is_of_second_order_where_energy_is_kept(at):
    scene = tumbling(at)
    exact = scene.run(1.0, tol=1e-10, integrator="radau", output_step=1.0)

    def error(step):
        run = scene.run(1.0, step=step, integrator="energy", output_step=1.0)
        return max(np.abs(run[name][-1] - exact[name][-1]).max() for name in ("fish.angular_velocity", "fish.velocity"))

    for coarse, fine in pairwise(error(step) for step in (8e-3, 4e-3, 2e-3)):
        assert 3.8 < coarse / fine < 4.2


@pytest.mark.parametrize("dim", [2, 3])
def test_newton_contracts_by_the_square_of_the_step_where_energy_is_kept(dim):
    """The matrix approximates the derivative of the residual; the test measures the error after one iteration."""
    left = []
    for h in (1e-3, 1e-4):
        engine = Engine(build(swimming(dim)))
        engine.start(duration=1.0, output_step=0.1, tol=1e-4, step=0.0, method=EnergyMomentum(), first_step=h)
        _, matrix = engine.linearise(h, np.zeros(engine.unknowns))
        derivative = of_a_step(engine, h, np.zeros(engine.unknowns), 1e-6)
        left.append(np.abs(np.linalg.eigvals(np.eye(engine.unknowns) - np.linalg.solve(matrix, derivative))).max())
    assert left[0] < 0.02  # measured: 0.006, 4e-5
    assert left[1] < left[0] / 50


@pytest.mark.parametrize("dim", [2, 3])
def test_what_moves_with_the_water_is_carried_by_its_acceleration(dim):
    """A cable and a body of the density of water move with oscillating water: (1 + C) rho V DU/Dt."""
    scene = fu.Scene()
    wire = rope(scene, "beam24" if dim == 3 else "cable8p", (1, 0.5, 0), density=WATER)
    scene.rigid_body("ball", mass=2.0, inertia=(1e-2, 1e-2, 1e-2), position=(0, 2, 0))
    scene.fluid(density=WATER, velocity=(1, 0.5, 0), scale=fu.Harmonic(amplitude=0.3, frequency=1.0))
    scene.drag(wire, normal=1.0, added_mass=1.0)
    scene.drag("ball", area=0.01, volume=2e-3, added_mass=(0.3, 0.5, 0.7))
    run = scene.run(0.75, tol=1e-8, integrator="radau", output_step=0.25)
    way = 0.3 * (1 - np.cos(2 * pi * run.time)) / (2 * pi)
    for name, at in (("wire", run["wire.nodal_vectors"][:, 2, 0]), ("ball", run["ball.position"])):
        assert np.abs(at - at[0] - way[:, None] * np.array([1, 0.5, 0])).max() < 1e-7, name
    assert np.abs(run["drag_2.force"][:, 1] - 2 * G - 2 * 0.5 * 0.3 * 2 * pi * np.cos(2 * pi * run.time)).max() < 1e-5


def swimming(dim=3, body=True, drag=1.0, amplitude=0.5, form="lagrange"):
    """Return a cable, and a body attached by a spring, in a current that grows with height and varies in time."""
    scene = fu.Scene()
    wire = rope(scene, "beam24" if dim == 3 else "cable8p", (1, 0.3, 0), 3, density=1500, youngs_modulus=1e6)
    scene.pin(wire, s=0.0)
    flow = (0.8, 0.2, -0.5) if dim == 3 else (0.8, 0.2, 0)
    scene.fluid("sea", density=WATER, velocity=flow, scale=fu.Harmonic(amplitude=amplitude, frequency=1.0, offset=1.0),
                profile=fu.TableProfile(height=[-2, 3], factors=[0.4, 2.0]))
    scene.drag(wire, normal=1.1 * drag, tangential=0.05 * drag, added_mass=1.0, added_mass_tangential=0.1,
               added_mass_form=form)
    if body:
        out = 0.2 * (dim == 3)
        scene.rigid_body("buoy", mass=3.0, inertia=(0.02, 0.03, 0.04), position=(1.2, 0.3, 0), velocity=(1, -0.5, 0),
                         angular_velocity=(0.5, 1.0, 2.0) if dim == 3 else (0, 0, 2.0))
        scene.spring(("wire", wire.length), ("buoy", (0.1, 0, 0)), stiffness=200.0, length=0.05)
        scene.drag("buoy", area=0.02 * drag, coefficient=0.8, at=(-0.1, 0.05, 0), volume=2e-3,
                   added_mass=[[0.5, 0.1, 0], [0.1, 0.9, out], [0, out, 0.3]], added_mass_form=form)
    return scene


@cache
def accurate(dim, form="lagrange"):
    """Return the reference run, computed once."""
    return swimming(dim, form=form).run(0.2, tol=1e-9, integrator="explicit", output_step=0.05)


@pytest.mark.parametrize(("integrator", "dim"), IN_WATER)
@pytest.mark.slow_cases("explicit-3", "energy-2", "genalpha-2")
def test_the_energy_of_the_water_is_in_the_balance(integrator, dim):
    run = swimming(dim).run(0.2, tol=1e-6, integrator=integrator, output_step=0.05)
    assert abs(run["energy.external"][-1] - run["energy.external"][0]) > 0.1
    assert unaccounted(run) < (1e-11 if integrator == "energy" else 1e-5)
    best = accurate(dim)
    assert np.abs(run["wire.nodal_vectors"][:, :, 0] - best["wire.nodal_vectors"][:, :, 0]).max() < 2e-6


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("bodies", [False, True])
def test_newtons_matrix_is_the_derivative_of_its_residual(dim, bodies):
    """A cable in a flow of constant gradient; a body without the change of its point's acceleration."""
    allowed = 2e-2 if bodies else 1e-6
    for form in FORMS:
        assert error_by_drags(swimming(dim, bodies, amplitude=0.0, form=form)) < allowed


@pytest.mark.parametrize("integrator", FOR_JOINTS_AND_MODES)
def test_morisons_equation_has_other_forces_and_a_balance(integrator):
    """The work beyond the change of the kinetic energy of the water is external."""
    run, best = swimming(2, form="morison").run(0.2, tol=1e-6, integrator=integrator, output_step=0.05), {
        form: accurate(2, form)["wire.nodal_vectors"][:, :, 0] for form in FORMS}
    assert unaccounted(run) < 1e-5
    assert np.abs(run["wire.nodal_vectors"][:, :, 0] - best["morison"]).max() < 2e-6
    assert np.abs(best["morison"] - best["lagrange"]).max() > 1e-4


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("body", ["cable", "ball"])
def test_forces_on_what_is_held_in_a_sheared_stream(form, body, validated):
    """At rest with U = (u(y) s(t), 0, 0): (1 + C) rho V u s', and by Lagrange's equations C rho V grad(U^2/2)."""
    scene, slope, C, volume = fu.Scene(gravity=(0, 0, 0)), 0.4, 0.8, 2 * AREA
    scene.fluid(density=WATER, velocity=(1, 0, 0), profile=fu.TableProfile(height=[-2, 3], factors=[1 - 2 * slope,
                                                                                                 1 + 3 * slope]),
                scale=fu.TableSignal(time=[0, 1], value=[1.0, 3.0], interpolation="linear"))
    more = {"added_mass": C, "added_mass_form": form}
    if body == "cable":  # along z: x and y are across
        wire = scene.cable("wire", start=(0, 0, 0), end=(0, 0, 2), elements=2, element="cable12", up=(0, 1, 0),
                           section=fu.Circle(radius=RADIUS),
                           material=fu.Material(youngs_modulus=1e13, poisson_ratio=0.0, density=STEEL))
        for s in (0, 2):
            scene.clamp(wire, s=s)
        scene.drag(wire, **more)
    else:
        scene.rigid_body("ball", mass=1.0, inertia=(1, 1, 1), position=(0, 0, 0))
        scene.joint("weld", "ball", (0, 0, 0))
        scene.drag("ball", volume=volume, **more)
    force = scene.equilibrium()["drag_1.force"]
    exact = (1 + C) * WATER * volume * 2.0
    validated("Fluid", f"held {body} in a sheared stream that accelerates, {form}", "force", exact, float(force[0]),
              unit="N", bound=1e-6, source="closed form")
    lift = 0.0 if form == "morison" else C * WATER * volume * slope
    assert force[1] == pytest.approx(lift, abs=1e-6 * exact)


def test_a_kink_of_the_flow_is_a_jump_of_the_force():
    """The water begins to accelerate at an instant, without an end; the cable follows to the tolerance."""
    scene = fu.Scene(gravity=(0, 0, 0))
    rope(scene)
    scene.fluid(density=WATER, velocity=(0, 1, 0),
                scale=fu.TableSignal(time=[0, 0.3, 0.5, 1], value=[0, 0, 0.4, 0.4], interpolation="linear"))
    scene.drag("wire", added_mass=1.0)
    for integrator in INTEGRATORS:
        run = scene.run(0.8, tol=1e-6, integrator=integrator, output_step=0.1)
        exact = 0.4 * 2 * WATER / (STEEL + WATER)  # (1 + C) of the water's velocity
        assert run["wire.nodal_velocity"][-1, 0, 0, 1] == pytest.approx(exact, rel=1e-6)


def test_a_planar_scene_in_another_plane_has_the_same_added_mass():
    runs = []
    for element in ("cable8p", "cable12"):
        scene = fu.Scene(gravity=(0, 0, -G))
        wire = scene.cable("wire", start=(1, 0.5, 12), end=(3, 0.5, 14), elements=4, element=element, up=(0, 0, 1),
                           strain="engineering", section=fu.Circle(radius=RADIUS),
                           material=fu.Material(youngs_modulus=1e7, poisson_ratio=0.0, density=2000))
        scene.pin(wire, s=0.0)
        scene.rigid_body("buoy", mass=3.0, inertia=(0.02, 0.03, 0.04), position=(3.1, 0.5, 14))
        scene.spring(("wire", wire.length), ("buoy", (0.1, 0, 0)), stiffness=200.0, length=0.05)
        scene.fluid(density=WATER, velocity=(0.3, 0, 0.1))
        scene.drag(wire, normal=1.2, added_mass=1.0)
        scene.drag("buoy", volume=1e-3, added_mass=[[0.5, 0, 0.2], [0, 0.9, 0], [0.2, 0, 0.3]])
        runs.append(scene.run(0.1, tol=1e-8, integrator="radau", output_step=0.05))
    planar, spatial = runs
    assert np.abs(planar["wire.nodal_vectors"] - spatial["wire.nodal_vectors"]).max() < 1e-7
    assert np.abs(planar["buoy.orientation"] - spatial["buoy.orientation"]).max() < 1e-7


def test_a_modal_body_takes_it_at_a_node():
    scene = fu.Scene()
    scene.modal_body("bar", start=(0, 0, 0), end=(1, 0, 0), modes=4, section=fu.Rectangle(height=0.02, width=0.02),
                     material=fu.Material(youngs_modulus=1e8, poisson_ratio=0.3, density=1500))
    scene.fluid(density=WATER, velocity=(0.3, 1.0, 0.2))
    scene.drag("bar", area=0.02, at=(0.5, 0, 0), volume=1e-4, added_mass=(0.2, 1, 1))
    runs = [scene.run(0.2, tol=1e-7, integrator=integrator, output_step=0.1) for integrator in FOR_JOINTS_AND_MODES]
    for run in runs:
        assert unaccounted(run) < 1e-6
        assert np.abs(run["bar.position"] - runs[1]["bar.position"]).max() < 1e-5


def test_scene_files_say_the_same():
    text = swimming().to_toml()
    again = fu.Scene.from_toml(text)
    assert again.to_toml() == text and "added_mass = [[0.5, 0.1" in text
    assert again.drags["drag_1"].added_mass == 1.0


REFUSED = {
    "tangential": (lambda s: s.drag("wire", normal=1, added_mass_tangential=0.1), "without added_mass"),
    "nothing displaced": (lambda s: s.drag("wire", normal=1, displaced_area=0, added_mass=1), "give displaced_area"),
    "no volume": (lambda s: s.drag("A", area=1, added_mass=1), "give volume"),
    "matrix": (lambda s: s.drag("wire", added_mass=(1, 1, 1)), "is one number"),
    "tangential of a body": (lambda s: s.drag("A", volume=1, added_mass=1, added_mass_tangential=1),
                             "takes no added_mass_tangential"),
    "form": (lambda s: s.drag("wire", normal=1, added_mass_form="morison"), "form is given without added_mass"),
    "form unknown": (lambda s: s.drag("wire", added_mass=1, added_mass_form="airy"), "known: lagrange, morison"),
    "negative": (lambda s: s.drag("wire", added_mass=-1), "must not be negative"),
    "indefinite": (lambda s: s.drag("A", volume=1, added_mass=(1, -1, 1)), "must not be negative in any direction"),
    "not symmetric": (lambda s: s.drag("A", volume=1, added_mass=[[1, 1, 0], [0, 1, 0], [0, 0, 1]]), "be symmetric"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_bad_input_is_refused(case):
    scene = fu.Scene()
    rope(scene)
    scene.rigid_body("A", mass=1.0, inertia=(1, 1, 1), position=(0, 1, 0))
    scene.fluid(density=WATER)
    add, message = REFUSED[case]
    with pytest.raises(fu.SceneError, match=message):
        add(scene)


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_driven_end_gives_what_the_water_takes(integrator):
    scene = fu.Scene()
    wire = rope(scene, "cable12", (1, 0, 0), density=1500, youngs_modulus=1e6)
    scene.motion(wire, s=0.0, displacement=(0, fu.Ramp(start=0, end=0.3, after=0.2),
                                            fu.TableSignal(time=[0, 0.1, 0.2, 0.4], value=[0, 0.01, -0.01, 0.02])))
    scene.fluid(density=WATER, velocity=(0.4, 0.1, 0))
    scene.drag(wire, normal=1.0, added_mass=1.0)
    run = scene.run(0.3, tol=1e-6, integrator=integrator, output_step=0.05)
    assert run["energy.external"][-1] > 0.1
    assert unaccounted(run) < (1e-12 if integrator == "energy" else 1e-6)


@pytest.mark.parametrize("integrator", FOR_JOINTS_AND_MODES)
def test_a_stop_that_is_struck_in_water_balances(integrator):
    scene = fu.Scene()
    wire = rope(scene, "cable12", (1, -0.3, 0), density=1500)
    scene.pin(wire, s=0.0)
    scene.pin(wire, s=wire.length)
    scene.rigid_body("A", mass=0.5, inertia=(1e-3,) * 3, position=wire.point(0.7), velocity=3 * wire.axes[0])
    scene.slide("A", along=wire, s=0.7, name="trolley", at_end=fu.HardStop(restitution=0.5))
    scene.fluid(density=WATER, velocity=(0.4, 0.1, 0))
    scene.drag(wire, normal=1.0, added_mass=1.0)
    scene.drag("A", area=0.003, volume=1e-4, added_mass=(0.3, 0.5, 0.7))
    run = scene.run(0.2, tol=1e-6, integrator=integrator, output_step=0.02)
    assert run.report["events"]
    assert run["energy.dissipated"][-1] > 0.5
    assert unaccounted(run) < 1e-5


@pytest.mark.parametrize(("integrator", "friction"),
                         [*product(FOR_JOINTS_AND_MODES, (0.0, 0.3)), ("energy", 0.0)])
def test_an_impact_in_a_stream_balances(integrator, friction):
    """The work of a stream at an impact is U . M (v+ - v-), beside the loss at the ground."""
    scene = fu.Scene(gravity=(0, -G, 0))
    scene.surface("ground", fu.Plane())
    scene.rigid_body("ball", mass=2.0, inertia=(8e-3,) * 3, position=(0, 1.1, 0), velocity=(0.5, 0, 0))
    scene.contact("ball", "ground", restitution=0.8, radius=0.1, friction=friction)
    scene.fluid(density=WATER, velocity=(0.3, -1.0, 0))
    scene.drag("ball", volume=1e-3, added_mass=0.5)
    run = scene.run(1.0, tol=1e-6, integrator=integrator, output_step=0.01)
    assert [event["what"] for event in run.report["events"]] == ["struck"]
    assert run["energy.dissipated"][-1] > 1.0
    assert unaccounted(run) < 1e-9


def test_a_scene_in_a_plane_is_recognised_unless_lift_leaves_it():
    for lift in (0.0, 0.3):
        scene = fu.Scene()
        wire = rope(scene, "cable12", (1, 0, 0))
        scene.pin(wire, s=0.0)
        scene.fluid(density=WATER, velocity=(1, 0, 0))
        scene.drag(wire, normal=1.0, lift=lift, added_mass=1.0)
        found = planar_of(scene)
        assert (found.scene is None) == (lift != 0)
        if lift:
            assert "lift" in found.reasons[0]


def test_pictures_show_the_flow_and_the_forces_of_the_law():
    run = swimming().run(0.02, step=1e-3, integrator="genalpha", output_step=0.01)
    animation = run.animation("swimming")
    arrows = {segment.name: segment.end - segment.start for segment in animation.clips[0].segments
              if segment.kind == "load"}
    assert set(arrows) == {"sea, drag_1", "sea, drag_2"}
    way = arrows["sea, drag_1"][0]
    assert way / np.linalg.norm(way) == pytest.approx(np.array([0.8, 0.2, -0.5]) / sqrt(0.93))
    assert not any("could not be computed" in note for note in animation.notes)
    assert "tension" in {quantity.key for quantity in animation.clips[0].cables[0].quantities}


def test_a_run_from_rest_in_a_sheared_current_stays_there():
    """A sphere at rest in a current U(y) has the lift C m dU/dy U by its added mass C m, also in statics."""
    scene = fu.Scene()
    scene.rigid_body("buoy", mass=2.0, inertia=(0.01,) * 3, position=(0, 2, 0))
    scene.joint("distance", (0, 0, 0), "buoy", name="tether")
    scene.fluid(density=WATER, table=fu.VelocityTable(
        y=(0, 4), velocity=((0, 0, 0), (2, 0, 0)), interpolation="linear"))
    scene.drag("buoy", volume=4e-3, added_mass=0.5)
    rest = scene.equilibrium()
    lift = 0.5 * WATER * 4e-3 * 0.5 * 0.5 * rest["buoy.position"][1]
    assert rest["tether.force"][1] == pytest.approx(-(2.0 * G + lift), rel=1e-6)
    run = scene.run(0.5, tol=1e-6, initial=rest)
    assert np.abs(run["buoy.position"] - rest["buoy.position"]).max() < 1e-8


def test_the_energy_scheme_refuses_morisons_equation():
    with pytest.raises(fu.SceneError, match='integrator "energy" has no discrete gradient of it'):
        swimming(2, form="morison").run(0.1, tol=1e-4, integrator="energy", output_step=0.1)
