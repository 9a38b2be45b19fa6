"""Wind and water: closed forms, a boundary value problem, derivatives, energy balance, refusals."""

from functools import cache
from itertools import product
from math import acos, pi, sin, sqrt

import funicular as fu
import numpy as np
import pytest
from derivatives import error_by_drags
from expectations import unaccounted
from scipy.integrate import solve_bvp

INTEGRATORS = ("genalpha", "energy", "explicit", "radau")
SMALL_STEPS = {("genalpha", 3), ("energy", 3)}  # of second order, where tol is 1e-6: for seconds
IN_WATER = [pytest.param(*each, marks=[pytest.mark.slow] * (each in SMALL_STEPS))
            for each in product(INTEGRATORS, (2, 3))]
ELEMENTS = ("cable12", "cable8p", "cable18", "beam24", "beam12p")
G, WATER = 9.81, 1000.0
ROPE = {"section": fu.Circle(radius=0.01), "material": fu.Material(youngs_modulus=1e7, poisson_ratio=0.0, density=2000)}
AREA = pi * 0.01**2


def rope(scene, element="cable12", end=(2, 0, 0), elements=4, **more):
    return scene.cable("wire", start=(0, 0, 0), end=end, elements=elements, element=element, **ROPE | more)


@pytest.mark.parametrize("element", ELEMENTS)
@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_horizontal_cable_falls_as_the_closed_form(integrator, element, validated):
    """v = v_t tanh(g' t/v_t), with the weight in water over the mass, g', and the terminal velocity v_t."""
    scene = fu.Scene()
    rope(scene, element)
    scene.fluid(density=WATER)
    scene.drag("wire", normal=1.2, tangential=0.01)
    run = scene.run(0.5, tol=1e-7, integrator=integrator, output_step=0.05)
    weight, drag = (2000 - WATER) * AREA * G, WATER / 2 * 0.02 * 1.2
    terminal = sqrt(weight / drag)
    exact = -terminal * np.tanh(run.time * weight / (2000 * AREA) / terminal)
    assert exact[-1] < -0.999 * terminal
    validated("Fluid", "horizontal cable that sinks", "velocity", exact[:, None],
              run["wire.nodal_velocity"][:, :, 0, 1], unit="m/s", scale=1.0, bound=1e-7, source="closed form",
              variant=f"{element}, {integrator}")
    assert np.abs(run["drag_1.force"][-1] - [0, 2 * 2000 * AREA * G, 0]).max() < 1e-2
    assert unaccounted(run) < (2e-14 if integrator == "energy" else 1e-6)
    assert run["energy.dissipated"][-1] > 1.0
    assert np.abs(np.array(run.section_forces("wire", 0.7)["force"])).max() < 1e-4  # all of it falls alike


def test_elements_of_unequal_lengths_fall_alike():
    runs = []
    for mesh in ({"elements": 4}, {"elements": None, "nodes": (0, 0.1, 0.3, 1.2, 2.0)}):
        scene = fu.Scene()
        rope(scene, **mesh)
        scene.fluid(density=WATER)
        scene.drag("wire", normal=1.2, tangential=0.01)
        runs.append(scene.run(0.5, tol=1e-7, integrator="radau", output_step=0.05))
    equal, unequal = (run["wire.nodal_velocity"][:, :, 0, 1] for run in runs)
    assert np.abs(unequal - equal[:, :1]).max() < 1e-7
    assert np.abs(runs[0]["drag_1.force"] - runs[1]["drag_1.force"]).max() < 1e-5
    force = [np.array(run.section_forces("wire", 0.15)["force"]) for run in runs]
    assert np.abs(force[0] - force[1]).max() < 1e-4


def test_a_planar_cable_in_another_plane_has_the_wind_of_its_height():
    """z is up, and the plane y = 0.5 has an offset in height: profiles use heights over the ground's origin."""
    runs = []
    for element in ("cable8p", "cable12"):
        scene = fu.Scene(gravity=(0, 0, -G))
        wire = scene.cable("wire", start=(1, 0.5, 12), end=(3, 0.5, 14), elements=4, element=element, up=(0, 0, 1),
                           strain="engineering", **ROPE)
        scene.pin(wire, s=0.0)
        scene.fluid(density=1.25, velocity=(9, 0, 0), profile=fu.PowerProfile(exponent=0.2, reference_height=10))
        scene.drag(wire, normal=1.2, tangential=0.01)
        runs.append(scene.run(0.3, tol=1e-9, integrator="radau", output_step=0.05))
    planar, spatial = runs
    assert np.abs(planar["wire.nodal_vectors"] - spatial["wire.nodal_vectors"]).max() < 1e-8
    assert np.abs(planar["drag_1.force"] - spatial["drag_1.force"]).max() < 1e-7
    assert np.abs(planar["drag_1.force"][:, 0]).max() > 0.1
    forces = [np.array(run.section_forces("wire", 1.0)["force"]) for run in runs]
    assert np.abs(forces[0] - forces[1]).max() < 1e-5


@pytest.mark.parametrize("element", ELEMENTS)
def test_a_towed_cable_is_straight_at_the_critical_angle(element, validated):
    """Weight and drag across the cable balance, w cos(angle) = q sin^2(angle), for any drag along it."""
    speed, radius, density = 3.0, 0.005, 5000
    scene = fu.Scene()
    wire = rope(scene, element, (0, -20, 0), section=fu.Circle(radius=radius),
                material=fu.Material(youngs_modulus=1e12, poisson_ratio=0.0, density=density))
    scene.pin(wire, s=0.0)
    scene.fluid(density=1025, velocity=(speed, 0, 0))
    scene.drag(wire, normal=1.2, tangential=0.02)
    state = scene.equilibrium()
    weight, across = (density - 1025) * pi * radius**2 * G, 1025 / 2 * 2 * radius * 1.2 * speed**2
    cosine = (sqrt(weight**2 + 4 * across**2) - weight) / (2 * across)
    along = (state["wire.position"] - state["wire.position"][0])[1:]
    given = {"source": "closed form, critical angle", "variant": element}
    validated("Fluid", "towed cable", "cosine of its angle", cosine, along[:, 0] / np.linalg.norm(along, axis=1),
              scale=1.0, bound=1e-7, **given)
    tension = 20 * (weight * sin(acos(cosine)) + 1025 / 2 * pi * 2 * radius * 0.02 * (speed * cosine) ** 2)
    validated("Fluid", "towed cable", "tension at its top", tension, float(np.linalg.norm(state["wire@0.force"])),
              unit="N", bound=1e-6, **given)
    own = [0, -density * pi * radius**2 * 20 * G, 0]
    assert np.abs(state["wire@0.force"] + state["drag_1.force"] + own).max() < 1e-6


def string_in_current(length, span, stiffness, weight, flow, normal, tangential):
    """Return a function of s (n,): r (3, n), n (3, n) of a string between two points in a current.

    weight: in N/m, less buoyancy. flow(y): velocity along z at the height y. normal, tangential: in N s²/m³.
    """
    def rates(s, x):
        n, T = x[3:], np.linalg.norm(x[3:], axis=0)
        slope = (1 + T / stiffness) * n / T
        i, U = n / T, np.zeros_like(n)
        U[2] = flow(x[1])
        w_t = np.sum(i * U, axis=0)
        w_n = U - w_t * i
        f = (1 + T / stiffness) * (normal * np.linalg.norm(w_n, axis=0) * w_n + tangential * np.abs(w_t) * w_t * i)
        f[1] -= weight
        return np.vstack([slope, -f])

    def ends(a, b):
        return np.concatenate([a[:3], b[:3] - [span, 0, 0]])

    s = np.linspace(0, length, 101)
    sag = sqrt(3 * span * (length - span) / 8)
    guess = np.zeros((6, len(s)))
    guess[0], guess[1] = span * s / length, -4 * sag * s / length * (1 - s / length)
    guess[3], guess[4] = weight * span**2 / 8 / sag, weight * (s - length / 2)
    found = solve_bvp(rates, ends, s, guess, tol=1e-9, max_nodes=100000)
    assert found.success
    return found.sol


def current_scene(elements, element="cable12", **more):
    """Return a rope of 12 m over a span of 10 m in a current that grows with height, drawn as a hanging line."""
    scene = fu.Scene()
    section = fu.GeneralSection(area=1e-4, second_moment_about_z=1e-14)
    s = np.linspace(0, 1, 81)
    line = np.column_stack([10 * s, 3.0 * 4 * s * (s - 1), 0 * s])
    wire = scene.cable("wire", points=line, rest="straight", rest_length=12.0, elements=elements,
                       element=element, section=section, strain="engineering",
                       material=fu.Material(youngs_modulus=1e9, poisson_ratio=0, density=3000))
    scene.pin(wire, s=0.0)
    scene.pin(wire, s=wire.length)
    profile = fu.TableProfile(height=[-8, -4, 0], factors=[0.2, 0.6, 1.0])
    scene.fluid("sea", density=1025, velocity=(0, 0, 1.5), profile=profile)
    scene.drag(wire, normal=1.2, tangential=0.05, diameter=0.02)
    return scene


def test_a_cable_in_a_cross_current_hangs_as_the_boundary_value_problem(validated):
    state = current_scene(48).equilibrium()
    sol = string_in_current(12.0, 10.0, 1e9 * 1e-4, (3000 - 1025) * 1e-4 * G,
                            lambda y: 1.5 * (1 + 0.1 * y), 1025 / 2 * 0.02 * 1.2, 1025 / 2 * pi * 0.02 * 0.05)
    s = np.linspace(0, 12.0, 49)
    exact = sol(s)
    assert np.abs(exact[2]).max() > 1.0  # it is blown well out of its plane
    validated("Fluid", "cable in a current across it", "position", exact[:3].T, state["wire.position"], unit="m",
              scale=1.0, bound=1e-6, source="string in a current, boundary value problem", mesh="48 elements")
    assert np.abs(state["wire@0.force"] + exact[3:, 0]).max() < 1e-7 * np.linalg.norm(exact[3:, 0])
    cut = state.section_forces("wire", [3.0, 6.0])["force"]
    assert np.abs(np.array(cut) - sol([3.0, 6.0])[3:].T).max() < 1e-6 * np.linalg.norm(exact[3:, 0])


def swimming(dim=3):
    """Return a body with centres of pressure and buoyancy apart from its mass centre, on a spring, and a cable."""
    scene = fu.Scene()
    element = "beam24" if dim == 3 else "beam12p"
    wire = rope(scene, element, (1, 0.3, 0), 3, material=fu.Material(youngs_modulus=1e6, poisson_ratio=0, density=1500))
    scene.pin(wire, s=0.0)
    spin = (0.5, 1.0, 2.0) if dim == 3 else (0, 0, 2.0)
    body = scene.rigid_body("buoy", mass=3.0, inertia=(0.02, 0.03, 0.04), position=(1.2, 0.3, 0),
                            velocity=(1, -0.5, 0), angular_velocity=spin)
    scene.spring(("wire", wire.length), (body, (0.1, 0, 0)), stiffness=200.0, length=0.05)
    flow = (0.8, 0.2, -0.5) if dim == 3 else (0.8, 0.2, 0)
    scene.fluid("sea", density=WATER, velocity=flow, scale=fu.Harmonic(amplitude=0.5, frequency=1.0, offset=1.0),
                profile=fu.TableProfile(height=[-1, 0, 0.4, 2], factors=[0.4, 0.7, 1.0, 1.5], interpolation="cubic"))
    scene.drag(wire, normal=1.1, tangential=0.05)
    scene.drag(body, area=0.02, coefficient=0.8, at=(-0.1, 0.05, 0), volume=2e-3)
    return scene


@cache
def accurate(dim):
    """Return the reference run, computed once."""
    return swimming(dim).run(0.6, tol=1e-9, integrator="explicit", output_step=0.05)


@pytest.mark.parametrize(("integrator", "dim"), IN_WATER)
@pytest.mark.slow_cases("explicit-3", "energy-2", "genalpha-2")
def test_what_the_flow_gives_and_drag_takes_is_in_the_energy_balance(integrator, dim):
    run = swimming(dim).run(0.6, tol=1e-6, integrator=integrator, output_step=0.05)
    assert run["energy.dissipated"][-1] > 0.5 and abs(run["energy.external"][-1]) > 0.5
    assert unaccounted(run) < (1e-11 if integrator == "energy" else 1e-5)
    best = accurate(dim)
    assert np.abs(run["buoy.position"] - best["buoy.position"]).max() < 1e-5


@pytest.mark.parametrize("dim", [2, 3])
def test_newtons_matrix_is_the_derivative_of_its_residual(dim):
    """The contribution of drag to the step's matrix is the derivative of its force by slopes, heights, rates and
    rotations.
    """
    assert error_by_drags(swimming(dim)) < 1e-6


def test_a_sphere_falls_at_its_terminal_speed_and_floats_where_it_displaces_its_mass(validated):
    scene = fu.Scene()
    scene.fluid("sea", density=WATER)
    for name, volume in (("falls", 1e-3), ("floats", 2e-3)):
        scene.rigid_body(name, mass=2.0, inertia=(1e-3, 1e-3, 1e-3), position=(0, 0, len(scene.bodies)))
        scene.drag(name, area=0.01, coefficient=0.5, volume=volume)
    run = scene.run(3.0, tol=1e-8, output_step=0.5)
    weight, drag = (2.0 - WATER * 1e-3) * G, WATER / 2 * 0.01 * 0.5
    validated("Fluid", "body that sinks", "terminal velocity", -sqrt(weight / drag),
              float(run["falls.velocity"][-1, 1]), unit="m/s", bound=1e-6, source="closed form")
    assert np.abs(run["floats.position"] - run["floats.position"][0]).max() < 1e-12
    assert run["drag_2.force"][-1] == pytest.approx([0, 2 * G, 0])


@pytest.mark.parametrize("integrator", ["genalpha", "explicit", "radau"])
def test_a_pendulum_rests_aslant_in_the_wind(integrator, validated):
    """tan(angle) = drag/weight, with both forces at one point."""
    scene = fu.Scene()
    scene.rigid_body("ball", mass=2.0, inertia=(1e-3, 1e-3, 1e-3), position=(0, -1, 0))
    scene.joint("spherical", ("ball", (0, 1, 0)), (0, 0, 0))
    scene.fluid("wind", density=1.2, velocity=(10, 0, 0), profile=fu.PowerProfile(exponent=0.2, reference_height=10))
    scene.drag("ball", area=0.2, coefficient=1.0)
    state = scene.equilibrium()
    force = 1.2 / 2 * 0.2 * (10 * 0.1**0.2) ** 2  # below the least height of the profile, 1 m
    x, y, _ = state["ball.position"]
    validated("Fluid", "pendulum in the wind", "tangent of its angle", force / (2.0 * G), float(-x / y), bound=1e-7,
              source="closed form, drag over weight")
    assert state["drag_1.force"] == pytest.approx([force, 0, 0])
    run = scene.run(0.2, initial=state, tol=1e-8, integrator=integrator)
    assert np.abs(run["ball.position"] - run["ball.position"][0]).max() < 1e-6


def test_profiles_and_signals_scale_the_velocity():
    power = fu.PowerProfile(exponent=0.5, reference_height=4.0, least_height=1.0)
    fluid = fu.Fluid(density=1.2, velocity=(2, 0, 0), scale=fu.Ramp(start=0, end=1), profile=power)
    found = fluid.velocity_at(np.array([0.0, 2.0, 2.0]), np.array([4.0, 4.0, 16.0]))
    assert found[:, 0] == pytest.approx([0, 2, 4])
    assert power.factor(np.array([-3.0])) == pytest.approx(0.5)


def test_scene_files_say_the_same():
    scene = swimming()
    text = scene.to_toml()
    again = fu.Scene.from_toml(text)
    assert again.to_toml() == text and "[[fluid]]" in text and "[[drag]]" in text
    one, other = (each.run(0.1, step=1e-2, integrator="genalpha") for each in (scene, again))
    assert np.array_equal(one["buoy.position"], other["buoy.position"])


def test_relaxation_and_modes_take_it():
    scene = fu.Scene()
    wire = rope(scene, "cable12", (0, -2, 0))
    scene.pin(wire, s=0.0)
    scene.fluid(density=WATER, velocity=(0.5, 0, 0))
    scene.drag(wire, normal=1.2)
    state, relaxed = scene.equilibrium(), scene.relax()
    assert np.abs(state["wire.position"] - relaxed["wire.position"]).max() < 1e-6
    assert (scene.modes(2, about=state).frequency > 0).all()


REFUSED = {
    "no fluid": (lambda s: s.drag("wire", normal=1.2), "needs a fluid, of which the scene has none"),
    "unknown fluid": (lambda s: (s.fluid("air", density=1.2), s.drag("wire", normal=1.2, fluid="sea")),
                      'there is no fluid "sea"'),
    "no density": (lambda s: s.fluid("air"), "density is missing"),
    "two fluids": (lambda s: (s.fluid("air", density=1.2), s.fluid("sea", density=WATER), s.drag("wire", normal=1)),
                   "needs a fluid, of which the scene has 2"),
    "no part": (lambda s: (s.fluid(density=1.2), s.drag("rope", normal=1)), 'there is no cable or body "rope"'),
    "nothing": (lambda s: (s.fluid(density=1.2), s.drag("wire", displaced_area=0)), "neither drag nor buoyancy"),
    "nothing on a body": (lambda s: (s.fluid(density=1.2), s.drag("A")), "neither drag nor buoyancy"),
    "twice": (lambda s: (s.fluid(density=1.2), s.drag("wire", normal=1), s.drag("wire", normal=1)),
              'cable "wire" has the drag "drag_1" already'),
    "area of a cable": (lambda s: (s.fluid(density=1.2), s.drag("wire", area=1.0)), "takes no area"),
    "both": (lambda s: (s.fluid(density=1.2), s.drag("A", area=1.0, normal=1.0)),
             'acts on body "A" and takes no normal'),
    "width": (lambda s: (s.fluid(density=1.2), s.drag("square", normal=1.0)), "diameter is missing"),
    "profile": (lambda s: s.fluid(density=1.2, profile={"form": "power", "exponent": 0.2}),
                "reference_height is missing|profile"),
    "table": (lambda s: fu.TableProfile(height=[0, 0], factors=[1, 2]), "height must increase"),
    "lengths": (lambda s: fu.TableProfile(height=[0, 1], factors=[1, 2, 3]), "of equal length"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_bad_input_is_refused(case):
    scene = fu.Scene()
    rope(scene)
    scene.cable("square", start=(0, 0, 0), end=(2, 0, 0), elements=2, element="beam24",
                section=fu.Rectangle(height=0.01, width=0.02), material=ROPE["material"])
    scene.rigid_body("A", mass=1.0, inertia=(1, 1, 1), position=(0, 1, 0))
    add, message = REFUSED[case]
    with pytest.raises(fu.SceneError, match=message):
        add(scene)


@pytest.mark.parametrize("integrator", ["genalpha", "explicit", "radau"])
def test_a_modal_body_takes_it_at_a_node(integrator):
    scene = fu.Scene()
    scene.modal_body("bar", start=(0, 0, 0), end=(1, 0, 0), modes=4, section=fu.Rectangle(height=0.02, width=0.02),
                     material=fu.Material(youngs_modulus=1e8, poisson_ratio=0.3, density=1500))
    scene.fluid(density=WATER, velocity=(0.3, 1.0, 0.2))
    scene.drag("bar", area=0.02, at=(0.5, 0, 0), volume=1e-4)
    run = scene.run(0.4, tol=1e-7, integrator=integrator, output_step=0.1)
    assert unaccounted(run) < 1e-6
    assert run["bar.position"][-1] == pytest.approx([0.85506393, -0.30115553, 0.03580343], abs=1e-6)
    with pytest.raises(fu.SceneError, match="is no node of the body"):
        scene.drag("bar", area=0.02, at=(0.7, 0, 0))


def test_section_forces_of_a_run_hold_what_the_flow_does():
    """A rope at rest in a current has the section forces of its equilibrium."""
    scene = current_scene(24)
    state = scene.equilibrium()
    run = scene.run(0.2, initial=state, tol=1e-6, output_step=0.1)
    assert np.abs(run["wire.position"] - state["wire.position"]).max() < 1e-9
    one, other = (np.array(of.section_forces("wire", [3.0, 6.0])["force"]) for of in (run, state))
    assert np.abs(one[-1] - other).max() < 1e-6 * np.abs(other).max()


def test_a_load_path_puts_on_as_much_of_the_flow_as_of_the_loads():
    state = current_scene(12).equilibrium(load_steps=4)
    for each in state.path:
        cut = sum(each[f"wire@{s}.force"] for s in (0, 12))
        weight = np.array([0, 3000 * 1e-4 * 12.0 * G * each.gravity_fraction, 0])
        assert cut + each["drag_1.force"] == pytest.approx(weight, abs=1e-6)


def moored(elements, element="cable12"):
    """Return a buoy of 0.5 m³ held under water by 60 m of line, in a current that grows with height."""
    scene = fu.Scene()
    area = pi * 0.03**2 / 4
    line = scene.cable("line", start=(0, 0, 0), end=(0, 60, 0), elements=elements, element=element,
                       strain="engineering", section=fu.GeneralSection(area=area, second_moment_about_z=1e-13),
                       material=fu.Material(youngs_modulus=2e6 / area, poisson_ratio=0, density=1400))
    scene.pin(line, s=0.0)
    scene.rigid_body("buoy", mass=100.0, inertia=(5, 5, 5), position=(0, 60, 0))
    scene.joint("spherical", (line, 60.0), "buoy")
    scene.fluid("sea", density=1025, velocity=(1, 0, 0),
                profile=fu.TableProfile(height=[-10, 0, 100], factors=[0.3, 0.5, 2.5]))
    scene.drag(line, normal=1.2, tangential=0.02, diameter=0.03)
    scene.drag("buoy", area=0.8, coefficient=0.6, volume=0.5)
    return scene


@pytest.mark.parametrize("element", ["cable12", "cable8p"])
def test_a_mooring_in_a_current_stands_as_the_boundary_value_problem(element, validated):
    state = moored(24, element).equilibrium()
    weight = (1400 - 1025) * pi * 0.03**2 / 4 * G
    normal, tangential = 1025 / 2 * 0.03 * 1.2, 1025 / 2 * pi * 0.03 * 0.02

    def flow(y):
        return 0.5 + 0.02 * y

    def rates(s, x):
        n, T = x[2:], np.hypot(*x[2:])
        i, U = n / T, np.array([flow(x[1]), 0 * x[1]])
        w_t = np.sum(i * U, axis=0)
        w_n = U - w_t * i
        f = (1 + T / 2e6) * (normal * np.hypot(*w_n) * w_n + tangential * np.abs(w_t) * w_t * i)
        f[1] -= weight
        return np.vstack([(1 + T / 2e6) * i, -f])

    def ends(a, b):
        return np.array([a[0], a[1], b[2] - 1025 / 2 * 0.8 * 0.6 * flow(b[1]) ** 2, b[3] - (1025 * 0.5 - 100) * G])

    s = np.linspace(0, 60, 101)
    guess = np.vstack([0 * s, s, 0 * s, 0 * s + 4000])
    found = solve_bvp(rates, ends, s, guess, tol=1e-10, max_nodes=100000)
    assert found.success
    exact = found.sol(np.linspace(0, 60, 25))
    assert exact[0, -1] > 20.0  # it is carried far
    validated("Fluid", "moored buoy in a current", "position of the line", exact[:2].T, state["line.position"][:, :2],
              unit="m", scale=1.0, bound=2e-6, source="boundary value problem", variant=element, mesh="24 elements")
    assert state["buoy.position"][:2] == pytest.approx(exact[:2, -1], abs=1e-6)
    assert np.abs(state["line@0.force"][:2] + exact[2:, 0]).max() < 1e-5
