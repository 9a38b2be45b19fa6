"""Drag, lift and moment on beams by the angle of attack of their sections: forces, divergence, galloping, balances."""

from functools import cache
from math import cos, pi, radians, sin, sqrt, tan

import funicular as fu
import numpy as np
import pytest
from derivatives import error_by_drags
from expectations import unaccounted
from funicular.base.rotations import rotate

INTEGRATORS = ("genalpha", "energy", "explicit", "radau")
SOFT = fu.Material(youngs_modulus=1e6, poisson_ratio=0.2, density=900)
STIFF = fu.Material(youngs_modulus=1e13, poisson_ratio=0.3, density=2000)
AIR = 1.2


def periodic(values):
    """Return values whose last equals the first exactly."""
    return np.append(values[:-1], values[0])


def iced():
    """Return coefficients whose only symmetry is that of half a turn."""
    angle = np.linspace(-pi, pi, 73)
    return fu.Polar(angle=angle, drag=periodic(1.2 - 0.8 * np.cos(2 * angle)), lift=periodic(0.9 * np.sin(2 * angle)),
                    moment=periodic(0.3 * np.sin(2 * angle - 0.4)), interpolation="cubic")


def straight(drag=0.0, lift_slope=0.0, moment=0.0, moment_slope=0.0):
    """Return coefficients that are linear within half a rad of zero, and zero at ±π."""
    angle = np.array([-pi, -0.5, 0.5, pi])
    within = np.array([0.0, -0.5, 0.5, 0.0])
    inside = np.array([0.0, 1.0, 1.0, 0.0])
    return fu.Polar(angle=angle, drag=[drag] * 4, lift=lift_slope * within,
                    moment=moment * inside + moment_slope * within)


def cantilever(material, section, *, turn=(1.0, 0, 0, 0), length=2.0, elements=4, **more):
    """Return a scene of a beam along z, its height along y, clamped at its start; both rotated."""
    scene = fu.Scene(gravity=(0, 0, 0))
    end, up = (rotate(np.array(turn), np.array(v)) for v in ((0, 0, length), (0, 1.0, 0)))
    beam = scene.cable("beam", start=(0, 0, 0), end=end, up=up, elements=elements, element="beam24", section=section,
                       material=material, **more)
    scene.clamp(beam, s=0.0)
    return scene


@pytest.mark.parametrize("turn", [(1.0, 0.0, 0.0, 0.0), (cos(0.7), sin(0.7) * 0.6, 0.0, sin(0.7) * 0.8)])
@pytest.mark.parametrize("degrees", [-140, -30, 10, 75, 180])
def test_force_and_moment_are_those_of_the_angle_of_attack(degrees, turn):
    """The flow comes from below the chord at this angle about the axis, with an axial part; the chord lies between the
    axes.
    """
    chord_angle, angle, width, length, speed = radians(25), radians(degrees), 0.15, 2.0, 7.0
    scene = cantilever(STIFF, fu.Rectangle(height=0.1, width=0.08), turn=turn)
    across = speed * np.array([cos(angle + chord_angle), sin(angle + chord_angle), 0.0])
    flow, along = (rotate(np.array(turn), v) for v in (across, np.array([0, 0, 3.0])))
    scene.fluid(density=AIR, velocity=flow + along)
    # the local axes are x along z, y along y, and so z along -x
    scene.drag("beam", polar=iced(), chord=(0, sin(chord_angle), -cos(chord_angle)), diameter=width, displaced_area=0)
    state = scene.equilibrium()
    drag, lift, moment = 1.2 - 0.8 * cos(2 * angle), 0.9 * sin(2 * angle), 0.3 * sin(2 * angle - 0.4)
    axis = rotate(np.array(turn), np.array([0, 0, 1.0]))
    per_length = AIR / 2 * width * speed * (drag * flow + lift * np.cross(axis, flow))
    # positive nose up: the moment turns the chord towards smaller angles about the axis and increases that of the flow
    couple = -AIR / 2 * width**2 * speed**2 * moment * axis
    size = AIR / 2 * width * speed**2
    s = np.array([0.0, 0.3, 1.0, 1.7])
    cut = state.section_forces("beam", s)
    assert np.abs(state["drag_1.force"] - length * per_length).max() < 1e-4 * size  # the spline of the table
    assert np.abs(np.array(cut["force"]) - (length - s)[:, None] * per_length).max() < 1e-4 * size
    about = (length - s)[:, None] * couple + ((length - s)**2 / 2)[:, None] * np.cross(axis, per_length)
    assert np.abs(np.array(cut["moment"]) - about).max() < 1e-4 * size
    assert np.abs(state["beam@0.moment"] + about[0]).max() < 1e-4 * size


RADIUS, SHEAR, TORSION_WIDTH = 0.01, 1e9, 0.2


def torsion_bar(part, elements=16, offset=0.02):
    """Return a bar under aerodynamic moment alone, at a share of the speed of divergence, and its twist.

    G J θ'' = -m with m = -q b² (C_M(0) - C_M' θ), clamped and free: θ = C_M(0)/C_M' (1 - cos k x - tan k L sin k x),
    k² = q b² C_M'/(G J), which diverges at k L = π/2.
    """
    slope, length = 2.0, 2.0
    k = part * pi / 2 / length
    stiffness = SHEAR * pi * RADIUS**4 / 2
    speed = sqrt(2 * k**2 * stiffness / (AIR * TORSION_WIDTH**2 * slope))
    scene = cantilever(fu.Material(youngs_modulus=2 * SHEAR, poisson_ratio=0.0, density=2000), fu.Circle(radius=RADIUS),
                       elements=elements)
    scene.fluid(density=AIR, velocity=(speed, 0, 0))
    scene.drag("beam", polar=straight(moment=offset, moment_slope=slope), chord=(0, 0, -1), diameter=TORSION_WIDTH,
               displaced_area=0)
    x = np.linspace(0, length, elements + 1)
    return scene, offset / slope * (1 - np.cos(k * x) - tan(k * length) * np.sin(k * x))


def twist(state):
    """Return the rotation (nodes,) of the height of each section about z."""
    height = state["beam.nodal_vectors"][:, 2]
    return np.arctan2(-height[:, 0], height[:, 1])


@pytest.mark.parametrize("part", [0.3, 0.8])
def test_a_bar_twists_as_the_closed_form_until_it_diverges(part):
    errors = []
    for elements in (4, 8):
        scene, exact = torsion_bar(part, elements, offset=1e-4)  # an axis that twists by more also shortens
        errors.append(np.abs(twist(scene.equilibrium()) - exact).max() / np.abs(exact).max())
    assert exact[-1] < 0  # nose up, against the axis
    assert errors[1] < 0.006 and errors[0] / errors[1] == pytest.approx(4, rel=0.2)


@pytest.mark.parametrize("part", [0.5, 0.9, 1.1])
def test_a_mode_of_torsion_is_slower_in_the_wind_and_grows_beyond_divergence(part):
    """ω² = G/ρ ((π/2L)² - k²) of the first mode, zero at the pressure of divergence."""
    scene, _ = torsion_bar(part, offset=0.0)
    modes = scene.modes(16)  # as drawn it rests, beyond divergence without being stable
    square = SHEAR / 2000 * (pi / 4) ** 2 * (1 - part**2)
    # bending modes, which the moment does not change, are far from it
    if square > 0:
        assert np.abs(modes.frequency * 2 * pi / sqrt(square) - 1).min() < 0.01
    else:
        assert np.abs(modes.growth_rate / sqrt(-square) - 1).min() < 0.01


GALLOPING = {"drag": 1.0, "width": 0.05, "speed": 10.0}


def galloping(lift_slope):
    """Return the growth rate in 1/s of a cantilever's first mode across the wind, measured at its tip."""
    drag, width, speed = GALLOPING.values()
    section = fu.Rectangle(height=0.01, width=0.03)  # weak across the wind, which blows along its width
    scene = cantilever(fu.Material(youngs_modulus=2e11, poisson_ratio=0.0, density=1000), section, elements=6)
    scene.fluid(density=AIR, velocity=(speed, 0, 0))
    scene.drag("beam", polar=straight(drag=drag, lift_slope=lift_slope), chord=(0, 0, -1), diameter=width,
               displaced_area=0)
    rest = scene.equilibrium()
    modes = scene.modes(1, about=rest)
    shape = modes.shapes["beam.nodal_vectors"][0]
    start = {"beam.nodal_vectors": rest["beam.nodal_vectors"] + 1e-3 / shape[-1, 0, 1] * shape}
    period = 1 / modes.frequency[0]
    run = scene.run(6 * period, initial=start, step=period / 400, integrator="genalpha", output_step=period / 40)
    y, v = (run[f"beam.nodal_{name}"][:, -1, 0, 1] for name in ("vectors", "velocity"))
    amplitude = np.hypot(y, v / (2 * pi * modes.frequency[0]))
    return float(np.polyfit(run.time, np.log(amplitude), 1)[0])


@pytest.mark.parametrize("lift_slope", [-3.0, -1.0, 1.0])
def test_galloping_grows_as_den_hartog_has_it(lift_slope):
    """-ρ U b/(4 m) (C_L' + C_D), which changes its sign at C_L' = -C_D."""
    drag, width, speed = GALLOPING.values()
    scale = AIR * speed * width / (4 * 1000 * 0.01 * 0.03)
    assert galloping(lift_slope) == pytest.approx(-scale * (lift_slope + drag), abs=0.01 * scale)


def flag(start=(0, 0, 0)):
    """Return a flexible beam in torsion and bending, in a wind with a height profile, under its weight."""
    scene = fu.Scene()
    beam = scene.cable("beam", start=start, end=np.add(start, (1, 0.2, 0.1)), elements=3, element="beam24",
                       section=fu.Rectangle(height=0.05, width=0.02), material=SOFT, angular_velocity=(0.4, 0.2, 0.8))
    scene.clamp(beam, s=0.0)
    scene.fluid("wind", density=AIR, velocity=(3, 4, 9),
                profile=fu.PowerProfile(exponent=0.2, reference_height=0.3, least_height=0.1))
    scene.drag(beam, polar=iced(), chord=(0, 0.3, 1), diameter=0.15, tangential=0.1)
    return scene


@cache
def accurate():
    """Return the reference run, computed once."""
    return flag().run(0.05, tol=1e-8, integrator="radau", output_step=0.01)


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_all_integrators_agree_and_the_wind_is_in_the_energy_balance(integrator):
    run = flag().run(0.05, tol=1e-6, integrator=integrator, output_step=0.01)
    assert run["energy.external"][-1] > 1.0 and run["energy.dissipated"][-1] > 1.0
    assert unaccounted(run) < (1e-12 if integrator == "energy" else 1e-5)
    assert np.abs(run["beam.position"] - accurate()["beam.position"]).max() < 1e-6


def test_newtons_matrix_is_the_derivative_of_its_residual():
    assert error_by_drags(flag()) < 1e-8


@pytest.mark.parametrize("more", [{}, {"added_mass": 2.0}])
def test_section_forces_of_a_run_vanish_at_the_free_end(more):
    """The forces are summed from the clamped end over all loads and inertia."""
    scene = flag()
    scene = scene.replace("drag_1", **more)
    run = scene.run(0.05, tol=1e-8, integrator="radau", output_step=0.01)
    cut = run.section_forces("beam", [0.0, float(scene.cables["beam"].length)])
    for name in ("moment",) if more else ("force", "moment"):  # the fluid's impulse gives the end of a line a force
        start, end = np.moveaxis(np.array(cut[name]), 1, 0)
        assert np.abs(start).max() > 0.1
        assert np.abs(end).max() < 1e-6 * np.abs(start).max()


def test_relaxation_finds_the_same_rest():
    scene, _ = torsion_bar(0.5, elements=4)
    state, relaxed = scene.equilibrium(), scene.relax()
    assert np.abs(twist(state) - twist(relaxed)).max() < 1e-6


def test_a_load_path_puts_on_as_much_of_the_moment_as_of_the_loads():
    scene, _ = torsion_bar(0.5, elements=4)
    for each in scene.equilibrium(load_steps=4).path[:-1]:
        fraction, moment = each.load_fraction, np.array(each.section_forces("beam", [0.0])["moment"])[0]
        assert moment == pytest.approx(-each["beam@0.moment"], rel=1e-6, abs=1e-9) and 0 < fraction < 1


def test_the_far_origin_keeps_the_digits():
    near, far = flag(), flag((1e4, 0, 1e4))
    one, other = (np.array(scene.run(0.02, step=0.01, integrator="genalpha")["drag_1.force"]) for scene in (near, far))
    assert np.abs(one - other).max() < 1e-8 * np.abs(one).max()


def test_scene_files_say_the_same():
    scene = flag()
    text = scene.to_toml()
    again = fu.Scene.from_toml(text)
    assert again.to_toml() == text and "moment = [" in text
    one, other = (each.run(0.02, step=0.01, integrator="genalpha") for each in (scene, again))
    assert np.array_equal(one["beam.nodal_vectors"], other["beam.nodal_vectors"])


def on(element, **more):
    """Return a function that adds a cable of an element with a polar drag."""
    entries = {"polar": iced(), "chord": (0, 1, 0), "diameter": 0.1} | more

    def add(scene):
        scene.cable("wire", start=(0, 0, 0), end=(1, 0, 0), elements=2, element=element,
                    section=fu.Circle(radius=0.01), material=SOFT)
        scene.drag("wire", **{name: value for name, value in entries.items() if value is not None})

    return add


REFUSED = {
    "cable12": (on("cable12"), 'has a polar, and cable "wire" has the element cable12 without rotation'),
    "cable18": (on("cable18"), "without rotation of its section; take the element beam24, or normal and lift"),
    "beam12p": (on("beam12p"), 'has a polar, and cable "wire" has the planar element beam12p'),
    "no chord": (on("beam24", chord=None), "chord is missing, from which the polar counts its angle; give chord"),
    "chord along": (on("beam24", chord=(0.1, 1, 0)), "chord must be square to the axis of the cable, x, got"),
    "chord alone": (on("beam24", polar=None, normal=1), "chord is given without a polar"),
    "normal": (on("beam24", normal=1.0), "has a polar and normal; leave it out"),
    "lift": (on("beam24", lift=1.0), "has a polar and lift; leave it out"),
    "span": (on("beam24", span=(1, 0, 0)), "takes no span"),
    "a body's moment": (lambda s: (s.rigid_body("A", mass=1, inertia=(1, 1, 1), position=(0, 0, 0)), s.drag(
        "A", area=1, polar=iced(), chord=(1, 0, 0), span=(0, 0, 1))), "its polar has a moment, which only beams take"),
    "ends": (lambda s: fu.Polar(angle=[-pi, 0, pi], drag=[0] * 3, lift=[0] * 3, moment=[0, 0, 1]),
             "moment must be the same at both ends"),
    "length": (lambda s: fu.Polar(angle=[-pi, 0, pi], drag=[0] * 3, lift=[0] * 3, moment=[0, 0]), "moment"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_bad_input_is_refused(case):
    add, message = REFUSED[case]
    scene = fu.Scene()
    scene.fluid(density=AIR)
    with pytest.raises(fu.SceneError, match=message):
        add(scene)


def test_a_model_is_chosen_that_knows_the_section():
    scene, _ = torsion_bar(0.5, elements=4)
    choice = scene.choose(0.05, duration=0.01, free="all")
    assert choice.scene.cables["beam"].element == "beam24"
    assert "meets its section at an angle, which its twist changes" in str(choice)


def test_a_section_that_is_not_round_needs_its_width():
    scene = cantilever(SOFT, fu.Rectangle(height=0.1, width=0.1))
    scene.fluid(density=AIR)
    with pytest.raises(fu.SceneError, match="diameter is missing"):
        scene.drag("beam", polar=iced(), chord=(0, 1, 0))
