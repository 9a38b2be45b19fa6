"""Lines in contact at their closest points: a wire under a moving bar, and crossing cables."""

import funicular as fu
import numpy as np
import pytest
from derivatives import of_a_step
from expectations import unaccounted
from funicular.engine import Engine
from funicular.integrators import GeneralisedAlpha
from funicular.model.build import build
from scipy.linalg import expm
from turned_scenes import turned_scene

TENSION, RADIUS, MODULUS, DENSITY = 1000.0, 2.5e-4, 4e12, 5.76e5
"""Of a wire without bending: the bending length sqrt(EI/T) is 3.5 mm."""
AREA = np.pi * RADIUS**2
STIFFNESS = 5e4


def wire(elements: int, length: float = 20.0, dim: int = 2) -> fu.Scene:
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.cable("wire", start=(0, 0, 0), end=(length, 0, 0), elements=elements,
                element="cable8p" if dim == 2 else "cable12", section=fu.Circle(radius=RADIUS),
                material=fu.Material(youngs_modulus=MODULUS, poisson_ratio=0.3, density=DENSITY),
                rest_length=length / (1 + TENSION / (MODULUS * AREA)))
    scene.pin("wire", s=0)
    scene.pin("wire", s=scene.cables["wire"].length)
    return scene


def collector(elements: int = 40, speed: float = 0.0, force: float = 5.0, dim: int = 2, gap: float = 0.0,
              rise: float = 0.0, mass: float = 0.5, length: float = 0.5, start: float = 4.0, **law) -> fu.Scene:
    """Return a head under the wire, on a carriage of constant speed, pressed or thrown upwards."""
    scene = wire(elements, dim=dim)
    y = -RADIUS - gap
    scene.rigid_body("carriage", mass=1000.0, inertia=(1, 1, 1), position=(start, y - 1, 0), velocity=(speed, 0, 0))
    scene.rigid_body("head", mass=mass, inertia=(1, 1, 1), position=(start, y, 0), velocity=(speed, rise, 0))
    scene.joint("prismatic", (start, y - 1, 0), "carriage", axis=(1, 0, 0), velocity=speed)
    scene.joint("prismatic", "carriage", "head", axis=(0, 1, 0))
    if force:
        scene.force("head", value=(0, force, 0))
    bar = {} if dim == 2 else {"axis": (0, 0, 1), "length": length}
    scene.crossing("wire", "head", name="contact", side=(0, 1, 0), **{"stiffness": STIFFNESS} | bar | law)
    return scene


def rising(time: np.ndarray, mass: float, force: float, rise: float = 0.0) -> np.ndarray:
    """Return height of the head, its rate and height of the wire above it, (T, 3), until waves return from the ends.

    A force N that moves along a string slower than its waves lifts the point under it by w' = N/Z, Z = 2 sqrt(T rho A),
    at any speed (d'Alembert), and the head has m y'' = F - N with N = k (y - w).
    """
    k, impedance = STIFFNESS, 2 * np.sqrt(TENSION * DENSITY * AREA)
    matrix = np.array([[0, 1, 0, 0], [-k / mass, 0, k / mass, force / mass], [k / impedance, 0, -k / impedance, 0],
                       [0, 0, 0, 0]])
    return np.array([expm(matrix * t) @ np.array([0, rise, 0, 1.0]) for t in time])[:, :3]


def total(run) -> np.ndarray:
    """Return the conserved sum of energy, dissipation and external work, J."""
    return (run["energy.kinetic"] + run["energy.elastic"] + run["energy.potential"] + run["energy.dissipated"]
            - run["energy.external"])


@pytest.mark.parametrize(("speed", "errors"), [(0.0, (0.0105, 0.0055)), (60.0, (0.017, 0.0085))])
def test_a_pushed_head_lifts_the_wire_as_a_moving_force_lifts_a_string(speed, errors, validated):
    found = []
    for elements, most in zip((40, 80), errors, strict=True):
        run = collector(elements, speed).run(duration=0.08, output_step=0.01, integrator="explicit", tol=1e-6)
        expected = rising(run.time, 0.5, 5.0)[:, 0]
        height = run["head.position"][:, 1] - run["head.position"][0, 1]
        found.append(np.abs(height - expected).max() / expected[-1])
        validated("Contact", f"head pushed against a wire, {speed:g} m/s, {elements} elements", "lift of the head",
                  expected, height, unit="m", scale=float(expected[-1]), bound=most,
                  source="d'Alembert, moving force on a string", mesh=f"{elements} elements")  # waves have 94 m/s
        assert unaccounted(run) < 1e-9 * run["energy.kinetic"].max()
    assert 1.7 < found[0] / found[1] < 2.3  # of first order: contact is at a point


def test_a_bar_in_space_does_what_a_point_in_the_plane_does():
    plane, space = (collector(20, 20.0, dim=dim, damping=0.05).run(duration=0.1, output_step=0.01, tol=1e-6)
                    for dim in (2, 3))
    for name in ("head.position", "contact.force", "contact.s", "contact.penetration", "contact.position"):
        assert np.abs(plane[name] - space[name]).max() < 1e-6 * np.abs(plane[name]).max(), name


@pytest.mark.parametrize("exponent", [1.0, 1.5])
def test_deflection_and_force_at_rest(exponent):
    """A string under a force F at x = a: F a b/(T L); the penetration of the head by the law."""
    scene = wire(160)
    scene.rigid_body("head", mass=1.0, inertia=(1, 1, 1), position=(5.0, -0.01, 0))
    scene.joint("prismatic", (5.0, -0.01, 0), "head", axis=(0, 1, 0))
    scene.force("head", value=(0, 2.0, 0))
    scene.spring("head", (5.0, -1.01, 0), stiffness=1.0, length=1.0)
    scene.crossing("wire", "head", name="contact", stiffness=STIFFNESS, exponent=exponent)
    rest = scene.equilibrium()
    lift = rest["head.position"][1] + 0.01
    force = 2.0 - lift
    depth = (rest["contact.normal_force"] / STIFFNESS) ** (1 / exponent)
    assert rest["contact.force"][1] == pytest.approx(force, rel=1e-9)
    assert rest["contact.normal_force"] == pytest.approx(np.linalg.norm(rest["contact.force"]), rel=1e-12)
    assert rest["contact.penetration"] == pytest.approx(depth, rel=1e-9)
    wire_up = rest["head.position"][1] + RADIUS - depth
    # the mesh rounds the kink: 4.2e-3, with 40 elements 1e-2
    assert wire_up == pytest.approx(force * 5 * 15 / (TENSION * 20), rel=5e-3)
    run = scene.run(duration=0.1, output_step=0.05, initial="equilibrium")
    assert np.abs(run["contact.normal_force"] - rest["contact.normal_force"]).max() < 1e-6


@pytest.mark.parametrize("integrator", ["radau", "genalpha", "explicit"])
@pytest.mark.parametrize("damping", [0.0, 0.2])
def test_energy_and_events_of_a_head_thrown_at_the_wire(integrator, damping):
    scene = collector(10, force=0.0, gap=0.1, rise=2.0, damping=damping)
    run = scene.run(duration=0.12, output_step=0.002, integrator=integrator, tol=1e-6)
    events = [(event["time"], event["what"]) for event in run.report["events"]]
    assert events[0][1] == "came into contact" and abs(events[0][0] - 0.05) < 1e-9
    assert [what for _, what in events[:2]] == ["came into contact", "lost contact"]
    assert unaccounted(run) < 1e-4 * total(run)[0]
    assert (run["energy.dissipated"][-1] > 1e-3) == bool(damping)
    assert np.all(np.diff(run["energy.dissipated"]) > -1e-9)
    open_now = run["contact.penetration"] < -1e-6
    assert open_now.any() and np.all(run["contact.normal_force"][open_now] == 0)


@pytest.mark.parametrize("integrator", ["genalpha", "radau"])
def test_a_touch_within_a_step_is_not_missed(integrator):
    """A head on a spring rises 0.1 mm into the wire for 14 ms, within steps of 20 ms."""
    scene = wire(10)
    scene.rigid_body("head", mass=1.0, inertia=(1, 1, 1), position=(5.0, -0.1999 - RADIUS, 0))
    scene.joint("prismatic", (5.0, -0.2 - RADIUS, 0), "head", axis=(0, 1, 0))
    scene.spring("head", (5.0, -1.0999 - RADIUS, 0), stiffness=4 * np.pi**2, length=1.0)
    scene.crossing("wire", "head", name="contact", stiffness=STIFFNESS)
    run = scene.run(duration=0.7, output_step=0.7, integrator=integrator,
                    **{"step": 0.02} if integrator == "genalpha" else {"tol": 1e-5})
    assert [event["what"] for event in run.report["events"]][:2] == ["came into contact", "lost contact"]
    assert run.report["events"][0]["time"] == pytest.approx(0.5 - np.sqrt(2e-4 / (0.1 * 4 * np.pi**2)), abs=2e-3)


def test_contact_ends_where_the_wire_or_the_bar_ends():
    run = collector(20, 20.0, start=19.0, force=2.0).run(duration=0.08, output_step=0.002, integrator="explicit",
                                                       tol=1e-6)
    event = run.report["events"][-1]
    assert event["what"] == "lost contact" and abs(event["time"] - 0.05) < 2e-4
    after = run.time > event["time"]
    assert np.all(run["contact.normal_force"][after] == 0)
    assert unaccounted(run) < 1e-9 * run["energy.kinetic"].max()
    scene = wire(10, dim=3)
    scene.rigid_body("head", mass=1.0, inertia=(1, 1, 1), position=(5.0, -0.01 - RADIUS, 0), velocity=(0, 1, 10))
    scene.crossing("wire", "head", axis=(0, 0, 1), length=0.05, stiffness=STIFFNESS, name="contact")
    run = scene.run(duration=0.05, output_step=0.005, tol=1e-6)
    assert not run.report["events"] and run["head.position"][-1, 1] > 0.03  # the bar has passed before it is up


def test_a_bar_that_comes_in_over_its_end_brings_energy_from_outside():
    scene = wire(10, dim=3)
    scene.rigid_body("head", mass=1.0, inertia=(1, 1, 1), position=(5.0, -1e-3, -0.2), velocity=(0, 0, 5))
    scene.crossing("wire", "head", axis=(0, 0, 1), length=0.1, radius=2e-3, stiffness=STIFFNESS, name="contact")
    run = scene.run(duration=0.04, output_step=0.002, tol=1e-6, integrator="explicit")
    event = run.report["events"][0]
    assert event["what"] == "came into contact" and abs(event["time"] - 0.02) < 1e-9
    assert run["energy.external"][-1] == pytest.approx(STIFFNESS * 1e-6 / 2, rel=1e-6)
    assert unaccounted(run) < 1e-9 * total(run)[0]


def own_unknowns_eliminated(matrix: np.ndarray, own: int) -> np.ndarray:
    kept, beside = matrix[:-own, :-own], matrix[:-own, -own:]
    return kept - beside @ np.linalg.solve(matrix[-own:, -own:], matrix[-own:, :-own])


GRIPS = {"regularised": {"friction": fu.Friction(coefficient=0.3, velocity=2.0)},
         "sticking": {"friction": fu.Friction(coefficient=50.0, model="stick"), "tangential_stiffness": 3e4},
         "sliding": {"friction": fu.Friction(coefficient=1e-3, model="stick"), "tangential_stiffness": 3e4}}


def touching(dim: int, other: str, exponent: float, friction: str = "regularised") -> fu.Scene:
    """Return a wire of three elements in contact with the bar of a turning body, or another wire, off the nodes and
    moving.
    """
    scene = wire(3, dim=dim)
    law = {"stiffness": STIFFNESS, "exponent": exponent, "damping": 0.3, "radius": 0.01} | GRIPS[friction]
    if other == "cable":
        scene.cable("other", start=(6.1, -0.004, -5), end=(7, -0.005, 6), elements=3, element="cable12",
                    section=fu.Circle(radius=RADIUS), velocity=(0.3, 2, 0), rest_length=11.0,
                    material=fu.Material(youngs_modulus=MODULUS, poisson_ratio=0.3, density=DENSITY))
        scene.crossing("wire", "other", **law)
        return scene
    turn = {"velocity": (0.5, 1, 0.2), "angular_velocity": (0.1, 0.3, 0.2)} if dim == 3 else {
        "velocity": (0.5, 1, 0), "angular_velocity": (0, 0, 0.7)}
    scene.rigid_body("head", mass=1.0, inertia=(0.1, 0.2, 0.15), position=(8, -0.1, 0), **turn)
    bar = {"axis": (0.2, 0.05, 1), "length": 0.6} if dim == 3 else {}
    scene.crossing("wire", "head", at=(0.02, 0.096, 0), **law, **bar)
    return scene


@pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")  # the lines overlap
@pytest.mark.parametrize(("dim", "other"), [(2, "bar"), (3, "bar"), (3, "cable")])
@pytest.mark.parametrize(("exponent", "friction"), [(1.0, "regularised"), (1.5, "regularised"), (1.0, "sticking"),
                                                    (1.5, "sliding")])
def test_matrix_is_the_derivative_of_the_residual(dim, other, exponent, friction):
    engine = Engine(build(touching(dim, other, exponent, friction)))
    status, _ = engine.start(duration=1.0, output_step=0.1, tol=1e-4, step=0.0, method=GeneralisedAlpha(0.8),
                             first_step=1e-3)
    assert status is None
    own, n = 2 * dim - 1, engine.unknowns
    for h in (1e-2, 1e-4):
        at = 1e-4 * np.random.default_rng(1).standard_normal(n)
        matrix = own_unknowns_eliminated(engine.linearise(h, at)[1], own)
        errors = []
        for step in (1e-5, 1e-6, 1e-7):
            found = of_a_step(engine, h, at, step)[:-own, :-own]
            errors.append(np.abs(found - matrix).max() / np.abs(matrix).max())
        assert min(errors) < 1e-9  # measured: 1e-12 to 1e-10


@pytest.mark.parametrize("integrator", ["radau", "genalpha", "explicit"])
def test_friction_is_along_the_slip_and_its_work_goes_to_heat(integrator):
    scene = collector(20, 20.0, dim=3, friction=fu.Friction(coefficient=0.3, velocity=1.0))
    run = scene.run(duration=0.1, output_step=0.002, integrator=integrator, tol=1e-6)
    touching = run["contact.normal_force"] > 1.0
    friction = run["contact.force"][touching, 0] / run["contact.normal_force"][touching]
    # the wire is dragged along by at most F/(2 sqrt(EA rho A)), 1.6e-5 m/s, and its slope is 3e-3
    assert np.abs(friction - 0.3 * 20 / np.sqrt(401)).max() < 6e-3
    assert run["energy.dissipated"][-1] > 0.2 * 5.0 * 20 * 0.1
    assert unaccounted(run) < 1e-4 * run["energy.dissipated"][-1]


def test_section_forces_jump_by_the_contact_force():
    scene = collector(20)
    run = scene.run(duration=0.02, output_step=0.02, tol=1e-6)
    s = run["contact.s"][-1]
    force = run.section_forces("wire", s=[s - 1e-6, s + 1e-6])["force"].values[-1]
    assert np.abs(force[1] - force[0] + run["contact.force"][-1]).max() < 1e-3 * run["contact.normal_force"][-1]


def crossed(**changes) -> fu.Scene:
    scene = wire(4, dim=3)
    scene.rigid_body("head", mass=1.0, inertia=(1, 1, 1), position=(5, -0.5, 0))
    scene.cable("other", start=(5, -1, -1), end=(5, -1, 1), elements=2, element="cable12",
                section=fu.Rectangle(width=0.01, height=0.01),
                material=fu.Material(youngs_modulus=1e9, poisson_ratio=0.3, density=1000))
    scene.crossing(**{"a": "wire", "b": "head", "axis": (0, 0, 1), "length": 0.5, "stiffness": 1e4} | changes)
    return scene


BAR = {"axis": None, "length": None}


@pytest.mark.parametrize(("changes", "message"), [
    ({"b": "wire", **BAR}, 'has the cable "wire" on both sides'),
    ({"b": "other", **BAR}, "radius is missing"),
    ({"b": "other"}, 'axis is given, but b is the cable "other"'),
    ({"b": "none"}, 'there is no cable or body "none"'),
    ({"a": "none"}, 'there is no cable "none"'),
    ({"axis": None}, "axis of the bar is missing"),
    ({"length": None}, "length of the bar is missing"),
    ({"length": 0.0}, "length must be positive"),
    ({"axis": (0, 0, 0)}, "axis must not be zero"),
    ({"axis": (1, 0, 0)}, "the lines are parallel"),
    ({"at": (0, 0.5, 0)}, "the lines meet as drawn"),
    ({"side": (1, 0, 0)}, "is not across both lines"),
    ({"side": (0, -1, 0)}, "the lines are on the other side of each other as drawn, 0.5 m apart"),
    ({"b": None, "at": None}, "needs b, a cable or a body, or at"),
    ({"exponent": 2.0}, "exponent must be 1 or 1.5"),
    ({"stiffness": 0.0}, "stiffness must be positive"),
    ({"damping": -1.0}, "damping must not be negative"),
    ({"friction": fu.Friction(coefficient=0.1, model="stick"), "exponent": 1.5}, "tangential_stiffness is missing"),
    ({"friction": fu.Friction(coefficient=0.1, viscous=1.0)}, "has viscous friction"),
])
def test_bad_input_is_refused(changes, message):
    with pytest.raises(fu.SceneError, match=message):
        crossed(**{name: value for name, value in changes.items()})


def test_lines_that_overlap_as_drawn_are_told_of():
    message = "the lines overlap by 0.1 m as drawn, where the contact force is 1000"
    with pytest.warns(fu.FunicularWarning, match=message):
        scene = crossed(at=(0, 0.4, 0), radius=0.2)
    assert "overlap" in scene.messages[-1]


def test_what_does_not_go_in_the_plane_is_refused():
    scene = wire(4)
    scene.rigid_body("head", mass=1.0, inertia=(1, 1, 1), position=(5, -0.5, 0))
    with pytest.raises(fu.SceneError, match="in the plane a bar is square to it"):
        scene.crossing("wire", "head", length=1.0, stiffness=1e4)
    with pytest.raises(fu.SceneError, match="a bar of some length leaves the plane"):
        scene.crossing("wire", "head", axis=(0, 0, 1), length=1.0, stiffness=1e4)
    scene.cable("other", start=(5, -1, 0), end=(6, -1, 0), elements=1, element="cable8p",
                section=fu.Circle(radius=0.01), material=fu.Material(youngs_modulus=1e9, poisson_ratio=0.3,
                                                                     density=1000))
    with pytest.raises(fu.SceneError, match="two planar cables lie in one plane"):
        scene.crossing("wire", "other", stiffness=1e4)


def test_lines_that_become_parallel_end_the_run_with_a_message():
    scene = wire(10, dim=3)
    scene.rigid_body("head", mass=1.0, inertia=(1, 1, 1), position=(5.0, -0.01, 0), angular_velocity=(0, 10, 0))
    scene.crossing("wire", "head", axis=(0, 0, 1), length=2.0, stiffness=STIFFNESS)
    message = r'crossing "crossing_1" has lost its contact state.* where its lines are parallel'
    with pytest.raises(fu.FunicularError, match=message):
        scene.run(duration=0.2, output_step=0.02, step=np.pi / 2000, integrator="genalpha")


def crossing_ropes(drop: float, elements: int) -> fu.Scene:
    """Return two ropes of 1 m at right angles, their ends 0.8 m apart; the upper one's ends move below those of the
    lower.
    """
    scene = fu.Scene(gravity=(0, 0, -9.81))
    for name, axis, height in (("lower", 0, 0.0), ("upper", 1, 0.02)):
        ends = np.zeros((2, 3))
        ends[:, axis], ends[:, 2] = (-0.4, 0.4), height
        scene.cable(name, start=ends[0], end=ends[1], rest_length=1.0, shape="hanging", elements=elements,
                    element="cable12", law="engineering_exact", section=fu.Circle(radius=0.005), rest="straight",
                    material=fu.Material(youngs_modulus=1e6, poisson_ratio=0.5, density=1000))
        for s in (0.0, 1.0):
            scene.motion(name, s=s, displacement=(0, 0, -drop - height if name == "upper" else 0))
    scene.crossing("upper", "lower", stiffness=1e5, name="contact")
    return scene


@pytest.mark.parametrize(("drop", "force"), [(0.05, 0.188161), (0.1, 0.266793)])
def test_ropes_that_cross(drop, force, validated):
    """Force by an elastica boundary value problem, cosseratbench 0.3.0, experiment crossing."""
    rest = crossing_ropes(drop, 40).equilibrium(seek_stable=False)
    validated("Contact", f"two ropes that cross, {drop:g} m apart", "force between them", force,
              float(rest["contact.normal_force"]), unit="N", bound=1e-4, mesh="40 elements a rope",
              source="elastica, boundary value problem (cosseratbench 0.3.0, crossing)")
    assert rest["contact.s"] == pytest.approx(0.5, abs=1e-9)


def test_a_planar_scene_in_another_plane():
    """The wire is along z, with y up."""
    plain = collector(10, 20.0, damping=0.05)
    turned = turned_scene(plain, (0, -np.pi / 2, 0), (0, 0, 0))
    along = np.array([[0, 0, -1], [0, 1, 0], [1, 0, 0]])  # x to z, z to -x
    assert tuple(turned.cables["wire"].end) == (0, 0, 20) and tuple(turned.crossings["contact"].side) == (0, 1, 0)
    runs = [scene.run(duration=0.05, output_step=0.01, tol=1e-6, integrator="explicit") for scene in (plain, turned)]
    for name in ("contact.force", "contact.position", "head.position"):
        assert np.abs(runs[0][name] @ along.T - runs[1][name]).max() < 1e-9 * np.abs(runs[0][name]).max(), name
    assert np.abs(runs[0]["contact.s"] - runs[1]["contact.s"]).max() < 1e-9
