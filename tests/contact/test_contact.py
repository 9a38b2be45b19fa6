"""Surfaces and contact with them by penalty: closed forms, derivatives, energy balance, refusals."""

from itertools import product
from math import asinh, cos, exp, hypot, log, pi, sin, sqrt

import funicular as fu
import numpy as np
import pytest
from derivatives import at_rest
from expectations import unaccounted
from funicular.engine import Engine
from funicular.model.build import build
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from turned_scenes import turned_scene

INTEGRATORS = ("genalpha", "energy", "explicit", "radau")
G = 9.81
ROPE = {"section": fu.Circle(radius=0.01), "material": fu.Material(youngs_modulus=1e7, poisson_ratio=0.0, density=2000)}


# the mooring line: radius, modulus, density; length; weight per length; force on its free end

R, E, RHO, L = 0.01, 1e8, 7800.0, 30.0
AREA = pi * R * R
W = RHO * AREA * G
H, LIFTED = 150.0, 14.0


def mooring(elements, friction=0.0, element="cable8p", stiffness=None):
    """Return a line on the ground whose free end carries H horizontally and the weight of 14 m upwards."""
    scene = fu.Scene()
    lying, lifted = np.linspace(0, L - LIFTED, 30)[:-1], np.linspace(0, LIFTED, 30)
    points = [(x, R, 0) for x in lying]
    points += [(L - LIFTED + H / W * asinh(W * s / H), R + H / W * (sqrt(1 + (W * s / H) ** 2) - 1), 0) for s in lifted]
    line = scene.cable("line", points=points, elements=elements, element=element, law="engineering_exact",
                       rest="straight", rest_length=L, section=fu.Circle(radius=R),
                       material=fu.Material(youngs_modulus=E, poisson_ratio=0, density=RHO))
    scene.pin(line, s=0)
    scene.surface("bed", fu.Plane())
    scene.contact(line, "bed", friction=friction, stiffness=stiffness)
    scene.force(line, s=L, value=(H, W * LIFTED, 0))
    return scene


def end_of_mooring(friction=0.0):
    """Return the end of the elastic catenary, and the tension at the anchor."""
    EA, lying = E * AREA, L - LIFTED
    x = lying + (H * lying - friction * W * lying**2 / 2) / EA + H * LIFTED / EA + H / W * asinh(W * LIFTED / H)
    y = W * LIFTED**2 / 2 / EA + H / W * (sqrt(1 + (W * LIFTED / H) ** 2) - 1)
    return np.array([x, y]), H - friction * W * lying


@pytest.mark.parametrize("element", ["cable8p", "cable12"])
def test_a_mooring_line_lifts_off_the_bed_as_the_catenary(element, validated):
    """Bending, absent in the catenary, moves the touch-down by about sqrt(EI/H)."""
    state = mooring(60, element=element).equilibrium()
    end, tension = end_of_mooring()
    given = {"source": "elastic catenary on a rigid bed", "variant": element, "mesh": "60 elements"}
    validated("Contact", "mooring line on its bed", "place of the upper end", end,
              state["line.position"][-1, :2] - [0, R], unit="m", scale=1.0, bound=5e-4, **given)
    validated("Contact", "mooring line on its bed", "arc-length of the touch-down", L - LIFTED,
              float(state["contact_1.last"]), unit="m", scale=1.0, bound=sqrt(E * pi * R**4 / 4 / H),
              note="bending of the line, √(EI/H)", **given)
    validated("Contact", "mooring line on its bed", "tension at the anchor", tension, float(-state["line@0.force"][0]),
              unit="N", scale=H, bound=1e-9, **given)
    assert abs(state["contact_1.force"][1] + state["line@0.force"][1] - W * (L - LIFTED)) < 1e-6
    assert state["contact_1.penetration"] < 0.02 * R and state.stable


def test_the_touch_down_converges_with_the_mesh():
    """The reference is the finest mesh; there are no jumps between meshes."""
    found = [mooring(n, stiffness=2.4e5).equilibrium() for n in (30, 60, 240)]
    ends = np.array([state["line.position"][-1, :2] for state in found])
    errors = np.linalg.norm(ends[:-1] - ends[-1], axis=1)
    assert errors[1] < 0.6 * errors[0] and errors[1] < 3e-4


def test_a_mooring_with_friction_can_be_adjusted_for_a_force_in_a_section():
    scene = mooring(12, friction=0.3)
    place = f"line@{L - LIFTED / 2:.6g}.tension"
    wanted = 1.001 * float(scene.equilibrium().section_forces("line", s=[L - LIFTED / 2])["tension"][0])
    rest = scene.equilibrium(adjust=["line.rest_length"], to={place: wanted})
    assert rest.adjustment.found[place] == pytest.approx(wanted, rel=1e-6)
    there = [(1 - LIFTED / 2 / L) * rest.adjusted["line.rest_length"]]  # at the same part of its length
    assert float(rest.section_forces("line", s=there)["tension"][0]) == pytest.approx(wanted, rel=1e-6)


def test_the_beds_friction_takes_mu_w_a_length_of_the_tension(validated):
    state = mooring(60, friction=0.3).equilibrium()
    end, tension = end_of_mooring(0.3)
    validated("Contact", "mooring line on its bed, friction 0.3", "tension at the anchor", tension,
              float(-state["line@0.force"][0]), unit="N", scale=1.0, bound=0.3 * W * 0.05, mesh="60 elements",
              source="elastic catenary on a rigid bed", note="friction on 5 cm of the bed")
    assert np.abs(state["line.position"][-1, :2] - [0, R] - end).max() < 5e-4
    assert abs(state["contact_1.friction_force"][0] + 0.3 * W * (L - LIFTED)) < 0.3


def test_an_elastic_rod_is_lifted_off_a_plane_as_the_beam(validated):
    """A force V at the end lifts the length a = 2 V/w by w a^4/(24 EI), with no moment at the touch-down."""
    radius, modulus, density, a = 0.005, 1e9, 2000.0, 0.5
    w, EI = density * pi * radius**2 * G, modulus * pi * radius**4 / 4
    errors = []
    for stiffness in (1e6, 1.6e7):
        scene = fu.Scene()
        rod = scene.cable("rod", start=(0, radius, 0), end=(2, radius, 0), elements=80, element="cable8p",
                          section=fu.Circle(radius=radius),
                          material=fu.Material(youngs_modulus=modulus, poisson_ratio=0, density=density))
        scene.pin(rod, s=0)
        scene.surface("table", fu.Plane())
        scene.contact(rod, "table", stiffness=stiffness)
        scene.force(rod, s=2, value=(0, w * a / 2, 0))
        state = scene.equilibrium()
        errors.append((state["rod.position"][-1, 1] - radius) / (w * a**4 / 24 / EI))
    # the foundation's length is (4 EI/k)^(1/4), 37 and 19 mm
    validated("Contact", "rod lifted off a plane by its end", "lift over w a⁴/(24 E I)", 1.0, errors, bound=1e-3,
              source="closed form, Euler and Bernoulli's beam", mesh="80 elements")


DRUM, ROPE_RADIUS, LIGHT = 0.05, 0.001, 0.15


def heaviest(mu):
    """Return the length of the heavy side at which a rope over a drum begins to slide."""
    return exp(mu * pi) * LIGHT + (DRUM + ROPE_RADIUS) * 2 * mu / (1 + mu * mu) * (exp(mu * pi) + 1)


def capstan(heavy, mu, elements=40):
    """Return a heavy rope over a fixed drum, with 0.15 m on its light side."""
    scene, to = fu.Scene(), DRUM + ROPE_RADIUS
    points = [(-to, -y, 0) for y in np.linspace(LIGHT, 0, 12)[:-1]]
    points += [(to * cos(a), to * sin(a), 0) for a in np.linspace(pi, 0, 60)]
    points += [(to, -y, 0) for y in np.linspace(0, heavy, 12)[1:]]
    scene.cable("rope", points=points, elements=elements, element="cable8p", law="engineering_exact", rest="straight",
                section=fu.Circle(radius=ROPE_RADIUS),
                material=fu.Material(youngs_modulus=3e5, poisson_ratio=0, density=1000, damping_time=0.1))
    scene.surface("drum", fu.Cylinder(radius=DRUM, length=0.1))
    scene.contact("rope", "drum", stiffness=3e4, friction=mu, damping=10)
    return scene


@pytest.mark.parametrize(("mu", "limit"), [(0.1, 0.22929), (0.3, 0.48507)])
def test_the_capstans_limit_is_that_of_the_ropes_equation(mu, limit):
    """Over the angle a from the light side: dT/da = mu (T + w r sin a) + w r cos a, with the weight against the slip.
    """
    to = DRUM + ROPE_RADIUS
    found = solve_ivp(lambda a, T: mu * (T + to * np.sin(a)) + to * np.cos(a), (0, pi), [LIGHT], rtol=1e-10, atol=1e-12)
    assert abs(found.y[0, -1] - heaviest(mu)) < 1e-8 and abs(heaviest(mu) - limit) < 1e-5


@pytest.mark.parametrize("mu", [0.1, 0.3])
def test_a_rope_holds_on_a_drum_up_to_the_capstans_limit(mu):
    """It holds 4 % below the limit and slides 2 % above it; the stretch of the rope slides, so that the limit is not
    sharp.
    """
    ends = []
    for part in (0.96, 1.02):
        run = capstan(part * heaviest(mu), mu).run(0.5, output_step=0.05, tol=1e-4, integrator="genalpha")
        ends.append(run["rope.position"][:, 0, 1] + LIGHT)
    held, slid = ends
    assert held.max() <= 0 and abs(held[-1] - held[-3]) < 3e-5
    assert slid[-1] > 0.01 and slid[-1] - slid[-2] > 1e-3


def ball(damping=0.0, exponent=1.0, stiffness=1e4, gravity=(0, 0, 0), height=0.2, speed=1.0, friction=0.0):
    scene = fu.Scene(gravity=gravity)
    scene.rigid_body("ball", mass=0.3, inertia=(3e-4,) * 3, position=(0, height, 0), velocity=(0.3 * speed, -speed, 0))
    scene.surface("ground", fu.Plane())
    scene.contact("ball", "ground", radius=0.05, stiffness=stiffness, exponent=exponent, damping=damping,
                  friction=friction, tangential_stiffness=stiffness if friction else None)
    return scene


@pytest.mark.parametrize("exponent", [1.0, 1.5])
@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_ball_bounces_with_the_restitution_that_damping_gives(integrator, exponent, validated):
    """v - ln(1 + c v)/c is equal before and after, for any exponent (Hunt & Crossley 1975)."""
    c = 0.4
    run = ball(c, exponent).run(0.4, output_step=0.01, tol=1e-7, integrator=integrator)

    def conserved(v):
        return v - log(1 + c * v) / c

    after = brentq(lambda v: conserved(-v) - conserved(1.0), 0.1, 1.0)
    validated("Contact", f"ball that bounces, damped, exponent {exponent:g}", "speed after the impact", after,
              float(run["ball.velocity"][-1, 1]), unit="m/s", scale=1.0, bound=2e-5, variant=integrator,
              source="Hunt & Crossley 1975, closed form")
    assert unaccounted(run) < (1e-14 if integrator == "energy" else 1e-6)
    events = [event["what"] for event in run.report["events"]]
    assert events == ["came into contact", "lost contact"]
    assert abs(run.report["events"][0]["time"] - 0.15) < 1e-9


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_what_friction_and_damping_take_is_in_the_energy_balance(integrator):
    run = ball(0.3, friction=0.5, gravity=(0, -G, 0)).run(0.5, output_step=0.01, tol=1e-7, integrator=integrator)
    assert run["energy.dissipated"][-1] > 0.02
    assert unaccounted(run) < (1e-13 if integrator == "energy" else 2e-6)


def block(slope, friction, speed=0.0):
    """Return a block on four corners on a slope down to +x, at the penetration of its weight."""
    scene, size, stiffness = fu.Scene(gravity=(G * sin(slope), -G * cos(slope), 0)), 0.1, 1e5
    points = [(x, -size / 4, z) for x in (-size / 2, size / 2) for z in (-size / 2, size / 2)]
    scene.rigid_body("block", mass=2.0, inertia=(2e-3,) * 3, velocity=(speed, 0, 0),
                     position=(0, size / 4 - 2.0 * G * cos(slope) / 4 / stiffness, 0))
    scene.surface("slope", fu.Plane())
    scene.contact("block", "slope", points=points, stiffness=stiffness, damping=1.0, friction=friction,
                  tangential_stiffness=100 * stiffness)
    return scene


def test_a_block_slides_down_a_slope_and_sticks_on_a_lesser_one(validated):
    slope = 0.4
    slides = block(slope, 0.2).run(0.4, output_step=0.1, tol=1e-6, integrator="radau")
    exact = G * (sin(slope) - 0.2 * cos(slope)) * slides.time**2 / 2
    validated("Contact", "block that slides down a slope, friction 0.2", "position", exact,
              slides["block.position"][:, 0], unit="m", scale=1.0, bound=2e-4, source="closed form", variant="radau")
    assert abs(slides["contact_1.touching"][-1] - 4) < 1e-12
    for friction in (0.45, 0.6):  # above tan(slope) = 0.423
        sticks = block(slope, friction).run(0.4, output_step=0.1, tol=1e-6, integrator="radau")
        x = sticks["block.position"][1:, 0]  # its corners settle under its weight, and stick
        assert np.ptp(x) < 3e-6 and np.abs(x).max() < 1e-4


def test_a_sliding_block_comes_to_rest_after_its_way(validated):
    run = block(0.0, 0.3, speed=1.0).run(0.6, output_step=0.05, tol=1e-6, integrator="radau")
    validated("Contact", "block that slides until it rests, friction 0.3", "distance", 1 / (2 * 0.3 * G),
              float(run["block.position"][-1, 0]), unit="m", scale=1.0, bound=2e-4, source="closed form",
              variant="radau")
    assert unaccounted(run) < 3e-4


SHAPES = {"plane": fu.Plane(point=(0, -0.0075, 0), normal=(0.02, 1, 0)),
          "cylinder": fu.Cylinder(radius=0.5, length=1, at=(0.4, -0.507, 0)),
          "sphere": fu.Sphere(radius=0.5, at=(0.4, -0.507, 0)),
          "capsule": fu.Capsule(radius=0.5, length=0.3, axis=(1, 0, 0), at=(0.4, -0.507, 0)),
          "box": fu.Box(size=(0.6, 0.1, 0.5), along=(1, -0.01, 0), up=(0.01, 1, 0), at=(0.4, -0.06, 0)),
          "terrain": fu.HeightField.of(lambda x: -0.009 + 0.003 * sin(3 * x), np.linspace(-0.5, 1.5, 20)),
          "hills": fu.HeightField.of(lambda x, z: -0.009 + 0.003 * sin(3 * x) * cos(2 * z), np.linspace(-0.5, 1.5, 20),
                                     np.linspace(-0.4, 0.4, 9))}
PLANAR_SHAPES = [shape for shape in SHAPES if shape != "hills"]
"""Those for planar cables: a plane has no places across."""


@pytest.mark.parametrize(("element", "shape"), [*product(["cable12"], SHAPES), *product(["cable8p"], PLANAR_SHAPES)])
@pytest.mark.parametrize(("friction", "moved"), [(0.0, 1e-3), (0.3, 1e-6), (0.01, 1e-3)])
@pytest.mark.parametrize("on", [None, "B"])
def test_the_static_matrix_is_the_derivative_of_the_residual(element, shape, friction, moved, on):
    """At a state near the drawn one, with sticking or sliding friction; surfaces of the ground and of a body."""
    scene = fu.Scene()
    scene.cable("wire", start=(0, 0, 0), end=(1, 0.001, 0), elements=3, element=element, **ROPE)
    if on:
        scene.rigid_body("B", mass=1, inertia=(1, 2, 3), position=(0, 0, 0))
    scene.surface("s", SHAPES[shape], on=on)
    scene.contact("wire", "s", stiffness=1e5, friction=friction)
    engine = Engine(build(scene))
    engine.set_state(0.0)
    engine.move(moved * np.random.default_rng(3).standard_normal(engine.unknowns))
    kept, matrix = engine.state(), engine.dense_matrix(0, 0, 1)
    error = at_rest(engine, 0.0, kept, 1e-6) - matrix
    assert np.abs(engine.static_outputs("contact")[0, 6]) > 0
    assert np.abs(error).max() < 1e-6 * np.abs(matrix).max()


def test_the_reaction_acts_on_the_body_that_the_surface_is_on():
    """A cable falls on a free capsule: momentum and angular momentum about z are constant."""
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.cable("wire", start=(-0.5, 0.1, 0), end=(0.5, 0.1, 0), elements=6, element="cable12", velocity=(0, -1, 0),
                **ROPE)
    scene.rigid_body("B", mass=0.4, inertia=(1e-3, 2e-3, 3e-3), position=(0.2, 0, 0), angular_velocity=(0, 0, 2.0))
    scene.surface("s", fu.Capsule(radius=0.05, length=0.1, axis=(1, 0, 0)), on="B")
    scene.contact("wire", "s", stiffness=1e5, friction=0.3)
    run = scene.run(0.15, output_step=0.01, tol=1e-7, integrator="radau")
    assert run.report["events"] and abs(run["B.velocity"][-1, 1]) > 0.05
    model = build(scene)
    mass = model.cables[0].m[0] if model.cables[0].m.ndim == 3 else model.cables[0].m
    momenta, moments = [], []
    for row in range(len(run.time)):
        r, v = (run[f"wire.{name}"][row] for name in ("nodal_vectors", "nodal_velocity"))
        p, spin = 0.4 * run["B.velocity"][row], 0.4 * np.cross(run["B.position"][row], run["B.velocity"][row])[2]
        for k in range(6):
            e, d = (np.concatenate([of[k], of[k + 1]]) for of in (r, v))
            p = p + sum(mass[i] @ d for i in (0, 2))  # shape functions of positions add up to one
            spin += sum(mass[i, j] * (e[i, 0] * d[j, 1] - e[i, 1] * d[j, 0]) for i in range(4) for j in range(4))
        momenta.append(p)
        moments.append(spin + 3e-3 * run["B.angular_velocity"][row, 2])
    assert np.ptp(np.array(momenta), axis=0).max() < 1e-7 and np.ptp(moments) < 1e-6
    assert unaccounted(run) < 1e-4


def cloth(element="cable12"):
    """Return a cable that is thrown on hills."""
    scene = fu.Scene()
    scene.cable("wire", start=(0, 0.1, 0), end=(1, 0.15, 0), elements=8, element=element, velocity=(1.0, 0, 0), **ROPE)
    scene.surface("hills", SHAPES["terrain"])
    scene.contact("wire", "hills", stiffness=2e4, damping=0.5, friction=0.3)
    return scene


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.slow_cases("energy")
def test_a_cable_thrown_on_hills_keeps_the_energy_balance(integrator):
    run = cloth("cable8p").run(0.25, output_step=0.01, tol=1e-5, integrator=integrator)
    assert run["energy.dissipated"][-1] > 0.3 and run["contact_1.touching"].max() > 0.3
    assert unaccounted(run) < (1e-11 if integrator == "energy" else 5e-3)


def test_a_scene_in_another_plane_touches_alike():
    here = cloth("cable8p").run(0.15, output_step=0.05, tol=1e-6, integrator="radau")
    there = turned_scene(cloth("cable8p"), (0, -pi / 2, 0), (3, 0, 0))  # x to z
    assert there.surfaces["hills"].shape.along == (0, 0, 1) and tuple(there.cables["wire"].end) == (3, 0.15, 1)
    found = there.run(0.15, output_step=0.05, tol=1e-6, integrator="radau")
    assert np.abs(found["wire.position"][..., [2, 1]] - here["wire.position"][..., :2]).max() < 1e-6
    assert np.abs(found["contact_1.force"][-1, [2, 1]] - here["contact_1.force"][-1, :2]).max() < 1e-2
    friction = "contact_1.friction_force"
    assert np.abs(found[friction][:, [2, 1]] - here[friction][:, :2]).max() < 1e-2 < np.abs(here[friction]).max()
    assert not found[friction][:, 0].any()


def wire(scene):
    return scene.cable("wire", start=(0, 0, 0), end=(1, 0, 0), elements=2, **ROPE)


REFUSED = {
    "too deep": (lambda s: (wire(s), s.surface("bed", fu.Plane()), s.contact("wire", "bed")),
                 r'"contact_1": "wire" starts 0.01 m below the surface "bed", at \(0, 0, 0\) m; draw it higher'),
    "no surface": (lambda s: (wire(s), s.contact("wire", "bed")), 'there is no surface "bed"; add one before'),
    "nothing": (lambda s: (s.surface("bed", fu.Plane()), s.contact("rope", "bed")),
                'there is no cable or body "rope"'),
    "no stiffness": (lambda s: (s.rigid_body("A", mass=1, inertia=(1, 1, 1), position=(0, 1, 0)),
                                s.surface("bed", fu.Plane()), s.contact("A", "bed")),
                     "stiffness is missing, and without a radius there is none"),
    "no body": (lambda s: s.surface("bed", fu.Plane(), on="A"), 'there is no body "A"'),
    "own": (lambda s: (s.rigid_body("A", mass=1, inertia=(1, 1, 1), position=(0, 1, 0)),
                       s.surface("top", fu.Plane(), on="A"), s.contact("A", "top", stiffness=1)),
            'surface "top" is on that body itself'),
    "twice": (lambda s: (wire(s), s.surface("bed", fu.Plane((0, -1, 0))), s.contact("wire", "bed"),
                         s.contact("bed", "wire")), '"wire" and "bed" have the contact "contact_1" already'),
    "exponent": (lambda s: s.contact("wire", "bed", exponent=2), "exponent must be 1 or 1.5, got 2"),
    "tangential": (lambda s: (wire(s), s.surface("bed", fu.Plane((0, -1, 0))),
                              s.contact("wire", "bed", exponent=1.5, friction=0.1)),
                   "tangential_stiffness is missing"),
    "points": (lambda s: (wire(s), s.surface("bed", fu.Plane((0, -1, 0))),
                          s.contact("wire", "bed", points=[(0, 0, 0)])), "takes no points"),
    "table": (lambda s: s.surface("bed", fu.HeightField(x=(0, 1), heights=(0, 1, 2))), "must be of equal length"),
    "shape": (lambda s: s.surface("bed", "plane"), "must be a shape such as Plane"),
    "zero": (lambda s: s.surface("bed", fu.Plane(normal=(0, 0, 0))), "normal must not be zero"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_bad_input_is_refused(case):
    build_scene, message = REFUSED[case]
    with pytest.raises(fu.SceneError, match=message):
        build_scene(fu.Scene())


def test_a_start_is_looked_at_on_all_elements_however_short():
    """A dip of 30 mm depth and 36 mm width below a line of 10 m, whose nodes are close there alone."""
    dip = np.linspace(-0.018, 0.018, 13)
    along = np.concatenate([np.linspace(0, 3, 5), 3.02 + dip, np.linspace(3.04, 10, 7)])
    points = [(x, 0.03 - 0.015 * (1 + cos(pi * (x - 3.02) / 0.018)) * (abs(x - 3.02) < 0.018), 0) for x in along]
    scene = fu.Scene()
    scene.surface("bed", fu.Plane())
    length = fu.Cable(name="line", points=points, elements=1000, **ROPE).length
    nodes = np.concatenate([np.linspace(0, 2.99, 4), np.linspace(3, 3.1, 21), np.linspace(3.2, length, 10)])
    scene.cable("line", points=points, nodes=nodes, **ROPE)
    with pytest.raises(fu.SceneError, match=r'"line" starts 0\.0097.* m below the surface "bed", at'):
        scene.contact("line", "bed", stiffness=1e6)


def test_a_cable_whose_elements_are_still_to_be_chosen_may_touch():
    def rope_over_drum(height):
        scene = fu.Scene()
        scene.cable("rope", start=(0, height, 0), end=(1, height, 0), **ROPE)
        scene.pin("rope", s=0.0)
        scene.surface("drum", fu.Cylinder(radius=0.1, length=1), at=(0.5, 0.38, 0))
        scene.contact("rope", "drum", radius=0.01, stiffness=1e5, damping=0.5)
        return scene

    with pytest.raises(fu.SceneError, match=r'"rope" starts 0\.01.* m below the surface "drum", at'):
        rope_over_drum(0.48)
    chosen = rope_over_drum(0.5).choose(1e-2, duration=0.2)
    assert chosen.models["rope"].elements > 4 and chosen.scene.contacts["contact_1"].stiffness == 1e5
    with pytest.warns(fu.FunicularWarning, match="chosen for tol = 0.01"):
        run = rope_over_drum(0.5).run(0.2, tol=1e-2, progress=False)
    tip = run["rope.position"][:, -1]
    exact = run.scene.replace("rope", elements=40).run(0.2, tol=1e-4, progress=False)["rope.position"][-1, -1]
    assert np.linalg.norm(tip[-1] - exact) < 1e-2 * np.linalg.norm(tip[-1] - tip[0])


def test_heights_between_places_of_a_table_and_beyond_them():
    field = fu.HeightField.of(lambda x, z: 0.1 * x + 0.2 * z, np.linspace(0, 2, 5), np.linspace(-1, 1, 4))
    shape = fu.Scene().surface("bed", field).geometry
    slant = sqrt(1 + 0.1**2 + 0.2**2)
    assert abs(shape.distance(np.array([0.7, 1.0, 0.3])) - (1 - 0.07 - 0.06) / slant) < 1e-12
    assert abs(shape.distance(np.array([9.0, 1.0, 5.0])) - (1 - 0.2 - 0.2)) < 1e-12


def test_a_table_is_fitted_once_and_no_other_table_or_direction_takes_its_fit():
    heights = [[0.0, 0.1, 0.3], [0.2, 0.5, 0.1], [0.0, 0.4, 0.2]]
    field = fu.HeightField(x=(0, 1, 3), heights=heights, across=(0, 1, 2))
    bed = fu.Scene().surface("bed", field)
    assert bed.geometry.cells is bed.geometry.cells
    with pytest.raises(ValueError, match="read-only"):
        bed.geometry.cells[:] = 0
    turned = field.model_copy(update={"along": (0, 0, 1), "up": (1, 0, 0)})
    there = bed.model_copy(update={"shape": turned, "at": (1, 2, 3)}).geometry
    assert there.cells is bed.geometry.cells and there.origin.tolist() == [1, 2, 3]
    assert there.axes.T.tolist() == [[0, 0, 1], [1, 0, 0], [0, 1, 0]]
    assert bed.geometry.axes.tolist() == np.eye(3).tolist()
    higher = field.model_copy(update={"heights": tuple(tuple(2 * h for h in row) for row in field.heights)})
    assert bed.model_copy(update={"shape": higher}).geometry.highest > 1.9 * bed.geometry.highest > 0.95


def test_scene_files_say_the_same(tmp_path):
    scene = cloth()
    (tmp_path / "hills.toml").write_text(scene.to_toml(), encoding="utf-8")
    again = fu.load_scene(tmp_path / "hills.toml")
    assert again.surfaces == scene.surfaces and again.contacts == scene.contacts


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("with_cable", [False, True])
def test_no_contact_within_a_step_is_missed(integrator, with_cable):
    """A body flies past a drum and grazes it for a hundredth of its path; steps of free flight are longer."""
    scene = fu.Scene(gravity=(0, 0, 0))
    if with_cable:
        scene.cable("A", start=(-1, 0.1099, -0.1), end=(-1, 0.1099, 0.1), elements=2, velocity=(1, 0, 0), **ROPE)
    else:
        scene.rigid_body("A", mass=1, inertia=(1, 1, 1), position=(-1, 0.1099, 0), velocity=(1, 0, 0))
    scene.surface("s", fu.Cylinder(radius=0.1, length=1.0))
    scene.contact("A", "s", stiffness=1e3, radius=0.01)
    run = scene.run(2.0, output_step=1.0, tol=1e-3, integrator=integrator)
    assert [event["what"] for event in run.report["events"]] == ["came into contact", "lost contact"]
    assert abs(run.report["events"][0]["time"] - (1 - sqrt(0.11**2 - 0.1099**2))) < 1e-6


def test_section_forces_hold_what_the_bed_presses():
    state = mooring(60).equilibrium()
    found = state.section_forces("line", [4.0, 10.0, 29.0])
    exact = [H, H, hypot(H, 13 * W)]
    assert np.abs(np.array(found["tension"]) - exact).max() < 2e-2
    rubbing = mooring(60, friction=0.3).equilibrium()
    along = np.array([2.5, 6.5, 10.5])
    found = rubbing.section_forces("line", along)
    assert np.abs(np.array(found["tension"]) - (H - 0.3 * W * (L - LIFTED - along))).max() < 0.3 * W * 0.2


def test_section_forces_of_a_run_with_friction_are_refused():
    run = cloth().run(0.02, output_step=0.01, tol=1e-3)
    with pytest.raises(fu.SceneError, match='"contact_1": has friction, which results do not record along "wire"'):
        run.section_forces("wire", 0.5)


@pytest.mark.parametrize("name", ["mooring_on_bed", "rope_over_drum"])
def test_installed_scenes(name):
    scene = fu.load_scene(name)
    run = scene.run(0.1, progress=False, **{
        key: value for key, value in scene.run_settings.items() if key != "duration"})
    contact = next(iter(scene.contacts))
    assert run[f"{contact}.touching"][-1] > 0.1 and run[f"{contact}.force"][-1, 1] > 0
    shapes = {body.name for body in run.animation("it").clips[0].bodies}
    assert shapes == set(scene.surfaces)


def test_all_shapes_are_drawn():
    for name, shape in SHAPES.items():
        scene = fu.Scene()
        scene.cable("wire", start=(0, 0.5, 0), end=(1, 0.5, 0), elements=2, **ROPE)
        scene.rigid_body("B", mass=1, inertia=(1, 2, 3), position=(0, 0, 0))
        scene.surface("here", shape)
        scene.surface("there", shape, on="B")
        bodies = scene.run(0.01, output_step=0.01).animation("it").clips[0].bodies
        assert [body.name for body in bodies] == ["B", "here", "there"], name


def test_a_deep_penetration_and_a_surface_that_nothing_touches_are_noted():
    with pytest.warns(fu.FunicularWarning, match=r'"contact_1" is up to .* m below its surface, .* % of the radius'):
        ball(stiffness=1e3).run(0.3, output_step=0.01)
    scene = ball()
    scene.surface("wall", fu.Plane(point=(5, 0, 0), normal=(-1, 0, 0)))
    run = scene.run(0.01, output_step=0.01)
    assert any('surface "wall" has no contact and exerts no force' in message for message in run.report["messages"])
    soft = mooring(15, stiffness=5e3)
    with pytest.warns(fu.FunicularWarning, match="below its surface"):
        assert any("below its surface" in message for message in soft.equilibrium().messages)


@pytest.mark.parametrize("element", ["cable12", "cable18", "beam24"])
@pytest.mark.parametrize("shape", sorted(SHAPES))
def test_elements_are_passed_over_only_where_nothing_touches(element, shape):
    """Forces and stiffness at random states have the bits of a computation without the bounding sphere."""
    scene = fu.Scene()
    scene.cable("wire", start=(0, 0, 0), end=(1, 0.001, 0), elements=12, element=element, **ROPE)
    scene.surface("s", SHAPES[shape])
    scene.contact("wire", "s", stiffness=1e5)
    model = build(scene)
    (contact,) = [each for each in model.couplings if hasattr(each, "spread")]
    assert np.isfinite(contact.spread).all()
    cheap = Engine(model)
    contact.spread = np.full_like(contact.spread, np.inf)
    whole = Engine(model)
    random, touched = np.random.default_rng(5), 0
    for size in (0.003, 0.03, 0.1, 0.3) * 5:
        moved = size * random.standard_normal(cheap.unknowns)
        found = []
        for engine in (cheap, whole):
            engine.set_state(0.0)
            engine.move(moved)
            found.append((engine.static_residual().copy(), engine.dense_matrix(0, 0, 1).copy(),
                          engine.static_outputs("contact")[0].copy()))
        assert all(np.array_equal(a, b) for a, b in zip(*found, strict=True))
        touched += found[0][2][6] > 0
    assert touched
