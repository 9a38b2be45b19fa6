"""Friction of joints: brakes and bearings against closed forms, with every integrator that takes friction."""

import funicular as fu
import numpy as np
import pytest
from expectations import refused
from interrupted_runs import check_file_and_resume
from scipy.optimize import brentq
from viewed_scenes import hoist

INTEGRATORS = "genalpha", "radau", "explicit"
MASS, INERTIA, RADIUS, COEFFICIENT, CLAMP = 3.0, 0.5, 0.2, 0.4, 50.0
SHARP = 1e-4
"""Speed of regularised friction, m/s."""


def rough(**given) -> fu.Friction:
    return fu.Friction(**{"coefficient": COEFFICIENT, "velocity": SHARP} | given)


def wheel(dim: int = 3, rate: float = 10.0, friction: fu.Friction | None = None, **given) -> fu.Scene:
    """Return a wheel on a bearing; in the plane beside a cable that makes the scene planar."""
    scene = fu.Scene(gravity=(0, -9.81, 0))
    if dim == 2:
        scene.cable("far", start=(5, 0, 0), end=(6, 0, 0), elements=1, element="cable8p",
                    section=fu.Circle(radius=0.01),
                    material=fu.Material(youngs_modulus=1e6, poisson_ratio=0.3, density=1000))
        for s in (0, 1):
            scene.clamp("far", s=s, fix="all")
    scene.rigid_body("W", mass=MASS, inertia=(0.3, 0.3, INERTIA), position=(0, 0, 0), angular_velocity=(0, 0, rate))
    scene.joint("revolute", (0, 0, 0), "W", axis=(0, 0, 1), name="axle", radius=RADIUS, friction=friction or rough(),
                **given)
    return scene


@pytest.mark.parametrize("integrator", [*INTEGRATORS, "auto"])
@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("by", ["clamp", "weight"])
def test_a_brake_stops_a_wheel(by, dim, integrator):
    """At t = I ω/T by a constant torque T, which the joint's moment contains; all of its energy is dissipated."""
    torque = COEFFICIENT * RADIUS * (CLAMP if by == "clamp" else MASS * 9.81)
    stop = INERTIA * 10 / torque
    run = wheel(dim, **({"normal_force": CLAMP} if by == "clamp" else {})).run(
        1.2 * stop, output_step=stop / 50, tol=1e-6, integrator=integrator)
    exact = np.maximum(10 - torque / INERTIA * run.time, 0)
    assert run["W.angular_velocity"][:, 2] == pytest.approx(exact, abs=2 * SHARP / RADIUS)
    assert run["axle.moment"][10, 2] == pytest.approx(-torque, rel=1e-6)
    assert run["axle.force"][10, 1] == pytest.approx(MASS * 9.81, rel=1e-6)
    assert run["energy.dissipated"][-1] == pytest.approx(INERTIA * 50, rel=1e-5)


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_brake_closes_by_a_signal_and_by_an_event(integrator):
    torque = COEFFICIENT * RADIUS * CLAMP
    ramp = fu.Ramp(start=0.1, end=0.5)
    run = wheel(normal_force=CLAMP, friction=rough(scale=ramp)).run(1.0, output_step=0.05, tol=1e-6,
                                                                     integrator=integrator)
    closed = np.where(run.time < 0.5, np.maximum(run.time - 0.1, 0) ** 2 / 0.8, run.time - 0.3)
    assert run["W.angular_velocity"][-1, 2] == pytest.approx(10 - torque / INERTIA * 0.7, abs=1e-4)
    assert run["W.angular_velocity"][2, 2] == pytest.approx(10, abs=1e-9)
    assert np.abs(run["W.angular_velocity"][:, 2] - 10 + torque / INERTIA * closed).max() < 0.3, "a smooth ramp"
    scene = wheel(normal_force=CLAMP, friction=rough(when="gate"))
    scene.event("gate", function=lambda time, state: time - 0.4)
    run = scene.run(1.0, output_step=0.05, tol=1e-6, integrator=integrator)
    exact = 10 - torque / INERTIA * np.maximum(run.time - 0.4, 0)
    assert run["W.angular_velocity"][:, 2] == pytest.approx(exact, abs=1e-4)


def pendulum(angle: float, **given) -> fu.Scene:
    """Return a point mass of 2 kg on a rod of 1 m, turned from the vertical by an angle."""
    scene = fu.Scene(gravity=(0, -9.81, 0))
    scene.rigid_body("P", mass=2.0, inertia=(1e-3, 1e-3, 1e-3), position=(np.sin(angle), -np.cos(angle), 0),
                     orientation=(np.cos(angle / 2), 0, 0, np.sin(angle / 2)))
    scene.joint("revolute", (0, 0, 0), ("P", (0, 1, 0)), axis=(0, 0, 1), name="axle", radius=0.05, **given)
    return scene


def turns(angle: float, torque: float, count: int) -> list[float]:
    """Return the angles of the turning points: m g L (cos θ' - cos θ) = T (θ + θ') between two of them."""
    found = [angle]
    for _ in range(count):
        last = found[-1]
        found.append(brentq(lambda x, last=last: 2 * 9.81 * (np.cos(x) - np.cos(last)) - torque * (last + x), 0, last))
    return found


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_the_swing_of_a_pendulum_with_dry_friction(integrator):
    """Its amplitude falls by 2 T/(m g L) each half swing while that is small."""
    torque = 0.4
    scene = pendulum(0.3, friction=rough(velocity=1e-5), normal_force=torque / COEFFICIENT / 0.05)
    run = scene.run(5.0, output_step=0.005, tol=1e-7, integrator=integrator)
    angle = np.arctan2(run["P.position"][:, 0], -run["P.position"][:, 1])
    peaks = np.flatnonzero((np.abs(angle[1:-1]) >= np.abs(angle[:-2])) & (np.abs(angle[1:-1]) > np.abs(angle[2:]))) + 1
    exact = turns(0.3, torque, 4)
    assert np.abs(angle[peaks[:4]]) == pytest.approx(exact[1:], abs=2e-5)
    assert -np.diff(exact) == pytest.approx(2 * torque / (2 * 9.81), rel=0.02)


def test_integrators_agree_where_the_own_force_presses():
    """The centrifugal force changes friction along the swing."""
    runs = [pendulum(1.2, friction=rough(coefficient=0.8, velocity=1e-3, viscous=0.5)).run(
        2.0, output_step=0.1, tol=1e-7, integrator=integrator) for integrator in INTEGRATORS]
    for run in runs[1:]:
        assert run["P.position"] == pytest.approx(runs[0]["P.position"], abs=1e-4)
    assert runs[0]["energy.dissipated"][-1] > 0.5
    for run in runs:
        total = sum(run[f"energy.{name}"] for name in ("kinetic", "potential", "dissipated"))
        assert np.ptp(total) < 1e-4 * run["energy.dissipated"][-1]


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_block_slides_down_a_rail(integrator):
    """g (sin α - μ cos α), whose weight alone presses on a prismatic joint."""
    slope, mu = 0.6, 0.3
    along = np.array([np.cos(slope), -np.sin(slope), 0])
    scene = fu.Scene(gravity=(0, -9.81, 0))
    scene.rigid_body("B", mass=4.0, inertia=(1, 1, 1), position=(0, 0, 0), velocity=tuple(0.1 * along))
    scene.joint("prismatic", (0, 0, 0), "B", axis=tuple(along), friction=rough(coefficient=mu), name="rail")
    run = scene.run(1.0, output_step=0.1, tol=1e-6, integrator=integrator)
    exact = 0.1 * run.time + 9.81 * (np.sin(slope) - mu * np.cos(slope)) * run.time**2 / 2
    assert run["B.position"] @ along == pytest.approx(exact, abs=1e-5)


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_sleeve_turns_and_slides_on_a_bar(integrator):
    """Friction is against the whole speed of sliding: with I = m r² its direction stays, and it falls by μ g."""
    mass = 2.0
    scene = fu.Scene(gravity=(0, -9.81, 0))
    scene.rigid_body("S", mass=mass, inertia=(0.06, 0.06, mass * RADIUS**2), position=(0, 0, 0), velocity=(0, 0, 3),
                     angular_velocity=(0, 0, 4 / RADIUS))
    scene.joint("cylindrical", (0, 0, 0), "S", axis=(0, 0, 1), radius=RADIUS, friction=rough(), name="bar")
    run = scene.run(1.0, output_step=0.1, tol=1e-6, integrator=integrator)
    speed = 5 - COEFFICIENT * 9.81 * run.time
    assert run["S.velocity"][:, 2] == pytest.approx(0.6 * speed, abs=1e-4)
    assert run["S.angular_velocity"][:, 2] * RADIUS == pytest.approx(0.8 * speed, abs=1e-4)


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_friction_between_two_free_bodies_keeps_their_momentum(integrator):
    """And ends their relative rotation, about an axis that turns in space."""
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.rigid_body("A", mass=2, inertia=(0.2, 0.3, 0.4), position=(0, 0, 0), angular_velocity=(1, 0.5, 3))
    scene.rigid_body("B", mass=1, inertia=(0.1, 0.2, 0.15), position=(0, 0, 0.5), velocity=(0.25, -0.5, 0),
                     angular_velocity=(1, 0.5, -2))
    scene.joint("revolute", ("A", (0, 0, 0.25)), ("B", (0, 0, -0.25)), axis=(0, 0, 1), name="hinge", radius=0.1,
                friction=rough(), normal_force=20.0)
    run = scene.run(3.0, output_step=0.1, tol=1e-7, integrator=integrator)
    moment = run["momentum.angular"] if "momentum.angular" in run else _angular_momentum(run, scene)
    assert moment == pytest.approx(np.broadcast_to(moment[0], moment.shape), abs=2e-5)
    relative = run["A.angular_velocity"][:, 2] - run["B.angular_velocity"][:, 2]
    assert abs(relative[0]) > 4
    assert abs(relative[-1]) < 0.01


def _angular_momentum(run: fu.Run, scene: fu.Scene) -> np.ndarray:
    total = np.zeros((len(run.time), 3))
    for name in ("A", "B"):
        body = scene.bodies[name]
        w, x, y, z = run[f"{name}.orientation"].T
        R = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                      [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                      [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]).transpose(2, 0, 1)
        own = np.einsum("tij,j,tj->ti", R, np.diag(body.inertia), run[f"{name}.angular_velocity"])
        total += own + body.mass * np.cross(run[f"{name}.position"], run[f"{name}.velocity"])
    return total


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_runs_resume_and_files_hold_friction(integrator, tmp_path):
    scene = pendulum(0.8, friction=rough(velocity=1e-2, scale=fu.Ramp(start=0, end=1)))
    check_file_and_resume(scene, tmp_path, 8, duration=0.2, tol=1e-5, output_step=0.01, integrator=integrator)


@pytest.mark.parametrize(("kind", "entries", "message"), [
    ("spherical", {"friction": 0.1},
     "friction is given, but a spherical joint has none; leave it out, or take revolute or prismatic or cylindrical"),
    ("revolute", {"friction": 0.1}, "friction of a revolute joint needs the radius of its pin"),
    ("revolute", {"radius": 0.1}, "radius is given, but no friction"),
    ("prismatic", {"friction": 0.1, "radius": 0.1, "axis": (1, 0, 0)}, "a prismatic joint has no pin; leave it out"),
    ("revolute", {"friction": 0.1, "radius": 0.1, "velocity": fu.Ramp(start=0, end=1)},
     "friction is given, but a signal drives the joint"),
    ("cylindrical", {"friction": fu.Friction(coefficient=0.1, model="stick"), "radius": 0.1},
     'friction has model="stick", but a cylindrical joint is free in two motions'),
    ("revolute", {"friction": fu.Friction(coefficient=0.1, static_coefficient=0.2), "radius": 0.1},
     'friction has static_coefficient, which joints have not without sticking; '
     'leave static_coefficient out, or take model="stick"'),
    ("revolute", {"friction": fu.Friction(rolling=0.1), "radius": 0.1}, "friction has rolling, which joints have not"),
    ("revolute", {"friction": 0.1, "radius": 0.1, "normal_force": -1}, "normal_force must be positive"),
])
def test_friction_that_a_joint_cannot_have_is_refused(kind, entries, message):
    scene = fu.Scene()
    scene.rigid_body("A", mass=1, inertia=(1, 1, 1), position=(0, 0, 0))
    with pytest.raises(fu.SceneError) as error:
        scene.joint(kind, (0, 0, 0), "A", **{"axis": (0, 0, 1)} | entries if kind != "spherical" else entries)
    assert message in str(error.value)


def test_integrators_and_searches_without_friction_say_so():
    scene = wheel()
    for integrator in ("energy", "linear"):
        with pytest.raises(fu.SceneError, match=f'joint "axle": integrator "{integrator}" does not support friction of '
                                                "joints"):
            scene.run(0.1, output_step=0.1, integrator=integrator)
    with pytest.raises(fu.SceneError, match="creeps and never comes to rest"):
        scene.relax()
    missing = wheel(friction=rough(when="gate"))
    with pytest.raises(fu.SceneError, match='when: there is no event "gate"'):
        missing.run(0.1, output_step=0.1)


def test_shared_forces_are_refused():
    """A door on two hinges: rigid bodies do not tell what each bears. Brakes on both have torques of their own."""
    scene = fu.Scene(gravity=(0, 0, -9.81))
    scene.rigid_body("D", mass=1, inertia=(1, 1, 1), position=(1, 0, 0), angular_velocity=(0, 0, 1), velocity=(0, 1, 0))
    for name, z, press in (("low", -1, {}), ("high", 1, {"normal_force": 5.0})):
        scene.joint("revolute", (0, 0, z), ("D", (-1, 0, z)), axis=(0, 0, 1), name=name, friction=0.1, radius=0.1,
                    **press)
    with refused('joint "low": has friction by its force, which other joints share in a way that rigid bodies do not '
                 "determine; give its normal_force, or leave out what over-constrains the scene"):
        scene.run(0.1, output_step=0.1)
    run = scene.replace("low", normal_force=5.0).run(0.1, output_step=0.1, tol=1e-6)
    assert run["D.angular_velocity"][-1, 2] == pytest.approx(1 - 2 * 0.1 * 5 * 0.1 / 2 * 0.1, abs=1e-6)


def arms(dim: int, count: int = 1, element: str | None = None, **given) -> fu.Scene:
    """Return horizontal beams of 1 m in a row, from a pin at the ground on, with friction in the joints between them.
    """
    scene, area = fu.Scene(gravity=(0, -9.81, 0)), 1e-3
    element = element or ("cable8p" if dim == 2 else "beam24")
    for k in range(count):
        scene.cable(f"arm{k}", start=(k, 0, 0), end=(k + 1, 0, 0), elements=1, element=element,
                    up=(0, 1, 0), section=fu.Rectangle(height=area**0.5, width=area**0.5),
                    material=fu.Material(youngs_modulus=1e8, poisson_ratio=0.0, density=2000),
                    **({"law": "structural"} if element == "beam24" else {}))
        scene.joint("revolute", (f"arm{k - 1}", 1.0) if k else (0, 0, 0), (f"arm{k}", 0.0), axis=(0, 0, 1),
                    name=f"pin{k}", friction=rough(velocity=1e-4), radius=0.1, **given)
    return scene


def directions(run: fu.Run, name: str, node: int) -> np.ndarray:
    """Return the angles (T,) of a slope of a cable."""
    slope = run[f"{name}.nodal_vectors"][:, node, 1]
    return np.unwrap(np.arctan2(slope[:, 1], slope[:, 0]))


@pytest.mark.parametrize(("dim", "count", "integrator"), [
    (2, 1, "radau"), (3, 1, "radau"), (3, 1, "genalpha"), (2, 1, "explicit"), (2, 2, "radau"), (3, 2, "radau")])
def test_pins_of_cables_dissipate_their_torque_times_the_angle(dim, count, integrator):
    """A given normal force has a constant torque, which sections next to the pin bear."""
    torque = COEFFICIENT * 30.0 * 0.1
    run = arms(dim, count, normal_force=30.0).run(0.2, output_step=0.05, tol=1e-5, integrator=integrator,
                                                  progress=False)
    turned = np.abs(directions(run, "arm0", 0)[-1])
    if count == 2:
        relative = directions(run, "arm1", 0) - directions(run, "arm0", 1)
        turned += np.abs(np.diff(relative)).sum()
    assert turned > 0.2
    assert run["energy.dissipated"][-1] == pytest.approx(torque * turned, rel=2e-3)
    assert np.abs(run["pin0.moment"][2:, 2]) == pytest.approx(torque, rel=1e-4)
    total = sum(run[f"energy.{name}"] for name in ("kinetic", "elastic", "potential", "dissipated"))
    assert np.ptp(total) < 2e-4 * np.ptp(run["energy.potential"])
    moment = np.asarray(run.section_forces("arm0", s=[1e-6])["moment"])[-1, 0, 2]
    assert abs(moment) == pytest.approx(torque, rel=1e-3)


def test_the_force_of_a_cable_presses_its_pin():
    runs = [arms(3).run(0.05, output_step=0.025, tol=1e-5, integrator=integrator, progress=False)
            for integrator in INTEGRATORS[:2]]
    for run in runs:
        assert run["arm0.nodal_vectors"] == pytest.approx(runs[0]["arm0.nodal_vectors"], abs=2e-5)
        force = np.linalg.norm(run["pin0.force"][1:], axis=1)
        assert np.abs(run["pin0.moment"][1:, 2]) == pytest.approx(COEFFICIENT * 0.1 * force, rel=1e-3)


def test_runs_with_a_rough_pin_of_a_cable_resume(tmp_path):
    check_file_and_resume(arms(3), tmp_path, 8, duration=0.04, tol=1e-4, output_step=0.005, integrator="radau")


def test_statics_and_modes_of_a_cable_do_not_feel_the_friction_of_its_pin():
    rough_scene, bare = arms(2, normal_force=30.0), arms(2, normal_force=30.0)
    bare = bare.replace("pin0", friction=None, radius=None, normal_force=None)
    for scene in (rough_scene, bare):
        scene.pin("arm0", s=1.0)
    states = [scene.equilibrium() for scene in (rough_scene, bare)]
    assert states[0]["arm0.nodal_vectors"] == pytest.approx(states[1]["arm0.nodal_vectors"], abs=1e-12)
    rough_modes, bare_modes = (scene.modes(2, about=state).frequency for scene, state in
                               zip((rough_scene, bare), states, strict=True))
    assert rough_modes == pytest.approx(bare_modes, rel=1e-9)


def test_friction_on_a_rope_is_refused():
    scene = hoist(held=True)
    scene.rigid_body("A", mass=1, inertia=(1, 1, 1), position=(-0.25, -1.5, 0))
    with refused('joint "pin": has friction, but "rope" is a rope, which has no axes; '
                 "join it to a small body, and that to the rope by another joint"):
        scene.joint("revolute", ("rope", 1.0), "A", name="pin", friction=0.1, radius=0.1)
