"""Ropes without mass in space: fleet angles, twins in the plane, turned scenes, wheels on bodies that rotate, friction,
drums, statics and modes, files, and how runs end.
"""

from math import exp, pi

import funicular as fu
import numpy as np
import pytest
from derivatives import of_a_step
from expectations import refused
from funicular.base.rotations import rotate
from funicular.engine import Engine
from funicular.integrators import GeneralisedAlpha
from funicular.model.build import build
from interrupted_runs import kill
from ropes.scenes import GRAVITY, rope_of, weight
from ropes.space_runs import at_rest_without_mass
from test_ropes import near
from turned_scenes import ASKEW, turned_scene

SPATIAL = {"mass": False, "element": "cable12"}
STIFF, SOFT = (rope_of(EA, 1e-5, 0, 1e-3) | SPATIAL for EA in (1e7, 6e4))
PLANAR = {"element": "cable8p"}
BRIEF = {"tol": 1e-7, "progress": False}
ANY = {"max_fleet_angle": 0.9}


# ---- fleet angles

def test_a_fleet_angle_at_rest():
    """The closed form: of a point at the distance p from the axis, and z along it, the foot is at the distance rho."""
    run, R, (x, y, z) = at_rest_without_mass(), 0.3, (0.809249, -0.495093, 0.126487)
    square = x * x + y * y
    root = np.sqrt((square - R**2)**2 - 4 * (R * z)**2)
    rho = np.sqrt((square + R**2 - root) / 2)
    foot = np.arctan2(y, x) + np.arccos(rho / np.sqrt(square))
    part = np.sqrt(square + z * z - rho**2)
    fleet = np.arcsin(z / part)
    assert rho == pytest.approx(R / np.cos(fleet), rel=1e-14)
    assert run["top.wrap_angle"][0] == pytest.approx(pi - foot, abs=1e-12)
    assert run["top.fleet_angle_off"][0] == pytest.approx(fleet, abs=1e-12)
    assert run["top.fleet_angle_on"][0] == 0
    places = run["rope.position"][0]
    at = np.linalg.norm(places, axis=1)
    assert at[-5] == pytest.approx(rho, rel=1e-12)  # of the last part, with five points
    force = 100 * ((np.array([x, y, z]) - places[-5]) / part + [0, -1, 0])
    assert run["top.force"][0] == pytest.approx(force, abs=1e-9)
    assert run["rope.s"][0, -1] * (1 + 100 / 1e5) == pytest.approx(0.5 + R * (pi - foot) + part, rel=1e-12)


def swing(damping: bool = True, **sheave) -> fu.Scene:
    """Return a load that swings out of the plane of a sheave, with a counterweight."""
    scene = fu.Scene(gravity=(0, -GRAVITY, 0))
    scene.rigid_body("C", mass=5.5, inertia=(1, 1, 1), position=(-0.3, -2, 0.1), velocity=(0, 0.1, 0.1))
    scene.rigid_body("L", mass=5.0, inertia=(1, 1, 1), position=(1.2, -2.2, 0.12), velocity=(0.1, 0, 0.4))
    given = SOFT if damping else rope_of(6e4, 1e-5, 0) | SPATIAL
    scene.rope("hoist", tension=50.0, **given, route=[
        fu.Anchor("C", at=(0, 0.1, 0)), fu.Sheave("top", at=(0, 0, 0), radius=0.3, side="right", **ANY | sheave),
        fu.Anchor("L", at=(0.02, 0.1, 0.01))])
    return scene


def test_energy_without_damping():
    run = swing(damping=False).run(1.0, output_step=0.05, tol=1e-9, integrator="radau", progress=False)
    assert np.ptp(run["top.fleet_angle_off"]) > 0.05
    assert np.abs(run.energy_balance().relative).max() < 1e-8
    assert np.ptp(run["top.tension_on"]) > 10


# ---- wheels on bodies that rotate

SHEAVES = {"smooth": {}, "held": {"friction": 2.0}, "slipping": {"friction": 0.05},
           "driven": {"friction": 2.0, "velocity": fu.Ramp(start=0, end=0.1, after=1.0)}}


def free(gravity=(0, 0, 0), first=None, **sheave) -> fu.Scene:
    """Return a rope over two sheaves with skew axes on two bodies, between two others, all free."""
    scene = fu.Scene(gravity=gravity)
    scene.rigid_body("A", mass=2.0, inertia=(1, 1, 0.4), position=(-0.2, -1, 0.1), velocity=(0.1, -0.1, 0.3),
                     angular_velocity=(0.1, 0.5, 0.3))
    scene.rigid_body("B", mass=3.0, inertia=(1, 1, 0.4), position=(2.3, -1.2, 0.3), velocity=(0.2, -0.1, 0.3),
                     angular_velocity=(0.1, 0, 0.3))
    scene.rigid_body("S", mass=5.0, inertia=(1, 0.8, 0.5), position=(0, 0.1, 0.05), velocity=(0, 0.1, 0.2),
                     angular_velocity=(0.3, 0.4, 0.2))
    scene.rigid_body("U", mass=4.0, inertia=(0.5, 0.6, 0.7), position=(2, 0.2, 0.2), velocity=(0, 0.2, 0),
                     angular_velocity=(0.5, -0.3, 0.2))
    for name, length in (("A", 1.6), ("B", 1.7)):
        scene.spring(name, "S" if name == "A" else "U", stiffness=200, length=length, name=f"push_{name}")
    scene.spring("S", "U", stiffness=300, length=2.6, name="push")
    scene.rope("hoist", tension=100.0, **SOFT, route=[
        first or fu.Anchor("A", at=(0, 0.1, 0.03)),
        fu.Sheave("top", at=("S", (0.02, -0.05, 0.01)), radius=0.2, axis=(0.1, 0.1, 1), side="right", **ANY, **sheave),
        fu.Sheave("two", at=("U", (0.1, 0.1, 0)), radius=0.15, axis=(-0.2, 0.15, 1), side="right", **ANY),
        fu.Anchor("B", at=(0.02, 0.1, 0.05))])
    return scene


def winch(**given) -> fu.Drum:
    return fu.Drum("winch", at=("A", (0.05, 0.02, 0)), radius=0.1, side="right", length_in_store=2.0,
                   axis=(0.1, 0.2, 1), **ANY, **given)


def momenta(run) -> np.ndarray:
    """Return (T, 6): momentum and moment of momentum about the origin."""
    found = 0.0
    for body in run.scene.bodies.values():
        r, v, w = (run[f"{body.name}.{name}"] for name in ("position", "velocity", "angular_velocity"))
        A = np.stack([rotate(run[f"{body.name}.orientation"], axis) for axis in np.eye(3)], axis=-1)
        own = np.einsum("tij,jk,tk->ti", A, np.array(body.inertia), w)  # angular velocities are in body axes
        found = found + np.concatenate([body.mass * v, body.mass * np.cross(r, v) + own], axis=1)
    return found


@pytest.mark.parametrize("sheave", [*SHEAVES, "drum"])
def test_momenta_and_energy_of_free_bodies(sheave):
    """Both sheaves turn with their bodies; friction and drives act between bodies alone."""
    scene = free(first=winch(velocity=0.7)) if sheave == "drum" else free(**SHEAVES[sheave])
    run = scene.run(0.2, output_step=0.02, integrator="radau", **BRIEF | {"tol": 1e-9})
    found = momenta(run)
    assert np.abs(found[0]).min() > 0.05
    assert np.abs(found - found[0]).max() < 1e-7
    assert np.abs(run.energy_balance().relative).max() < 1e-7
    assert np.ptp(run["S.angular_velocity"], axis=0).min() > 0.01
    assert np.ptp(run["top.fleet_angle_off"]) > 0.005
    if sheave == "slipping":
        assert run["top.slip"].any() and not run["top.slip"].all()  # it slips and sticks again
    if sheave == "drum":
        assert np.ptp(run["winch.length_in_store"]) > 1e-3


@pytest.mark.parametrize("sheave", [*SHEAVES, "drum"])
@pytest.mark.slow_cases("slipping", "drum")
def test_integrators_agree(sheave):
    scene = free((1.0, -3.0, 2.0), first=winch(velocity=0.7)) if sheave == "drum" else free(
        (1.0, -3.0, 2.0), **SHEAVES[sheave])
    runs = [scene.run(0.1, output_step=0.05, integrator=each, **BRIEF) for each in ("radau", "genalpha", "explicit")]
    for run in runs:
        near(run, runs[-1], 5e-6, "A.position", "B.position", "S.orientation", "hoist.position")
        assert np.abs(run.energy_balance().relative).max() < 1e-5


@pytest.mark.parametrize("sheave", [*SHEAVES, "drum"])
@pytest.mark.parametrize("h", [1e-2, 1e-3])
def test_the_matrix_of_a_step_is_the_derivative_of_its_residual(sheave, h):
    scene = free(first=winch(velocity=0.7)) if sheave == "drum" else free(**SHEAVES[sheave])
    engine = Engine(build(scene))
    status, _ = engine.start(duration=1.0, output_step=0.1, tol=1e-4, step=0.0, method=GeneralisedAlpha(0.8),
                             first_step=1e-3)
    assert status is None
    at = 1e-3 * np.random.default_rng(1).standard_normal(engine.unknowns)
    matrix = engine.linearise(h, at)[1]
    worst = [np.abs(of_a_step(engine, h, at, step) - matrix).max() / np.abs(matrix).max() for step in (1e-5, 1e-6)]
    assert min(worst) < 1e-9  # measured: 1e-11 at most


@pytest.mark.parametrize("sheave", [*SHEAVES, "drum"])
@pytest.mark.slow_cases("slipping", "driven")
def test_a_turned_scene_gives_the_same(sheave):
    scene = free((0, -GRAVITY, 0), first=winch(velocity=0.7)) if sheave == "drum" else free(
        (0, -GRAVITY, 0), **SHEAVES[sheave])
    one, other = (each.run(0.1, output_step=0.05, integrator="radau", **BRIEF | {"tol": 1e-10})
                  for each in (scene, turned_scene(scene, *ASKEW)))
    near(one, other, 1e-9, "top.wrap_angle", "top.fleet_angle_on", "top.fleet_angle_off", "two.fleet_angle_off")
    near(one, other, 1e-4, "top.tension_on", "two.tension_off")


# ---- twins in the plane

def twins(**sheave) -> list[fu.Scene]:
    """Return a load that swings on a rope over a sheave on a lever and another one, from a drum, in plane and space."""
    found = []
    for element in (PLANAR, {}):
        scene = fu.Scene(gravity=(0, -GRAVITY, 0))
        scene.rigid_body("lever", mass=3.0, inertia=(0.2, 0.4, 0.5), position=(0.5, 0, 0))
        weight(scene, "L", 2.0, 1.7, -1.2)
        scene.joint("revolute", (0.0, 0.0, 0.0), ("lever", (-0.5, 0, 0)), axis=(0, 0, 1), name="hinge")
        scene.spring((0.5, 1.0, 0.0), "lever", stiffness=1000.0, length=0.92, name="holds")
        scene.rope("hoist", tension=20.0, **SOFT | element, route=[
            fu.Drum("winch", at=(-0.5, -0.8, 0), radius=0.1, side="right", length_in_store=2.0,
                    velocity=fu.Ramp(start=0, end=0.2, after=2.0)),
            fu.Sheave("top", at=("lever", (0.5, 0, 0)), radius=0.2, side="right", **sheave),
            fu.Sheave("two", at=(1.4, 0.1, 0), radius=0.1, side="right"), fu.Anchor("L", at=(0, 0.05, 0))])
        found.append(scene)
    return found


@pytest.mark.parametrize("sheave", [{}, {"friction": 2.0}, {"friction": 0.05}], ids=["smooth", "held", "slipping"])
@pytest.mark.slow_cases("slipping")
def test_a_planar_scene_and_its_spatial_twin(sheave):
    plane, space = (each.run(0.4, output_step=0.05, integrator="radau", **BRIEF | {"tol": 1e-9})
                    for each in twins(**sheave))
    assert np.ptp(plane["lever.position"], axis=0).max() > 2e-3
    near(plane, space, 1e-9, "lever.position", "L.position", "hoist.position", "top.wrap_angle", "two.wrap_angle",
         "winch.length_in_store", "hoist.s")
    near(plane, space, 1e-5, "top.tension_on", "top.tension_off", "top.force", "two.force", "winch.torque", "top.slip",
         "top.material_speed", "two.material_speed")
    assert np.abs(space["top.fleet_angle_on"]).max() < 1e-12
    if sheave.get("friction") == 0.05:
        assert np.abs(plane["top.slip"]).max() > 0.01


@pytest.mark.parametrize(("friction", "inertia"), [(3.0, 0.5), (0.1, 2.0)])
def test_a_belt_and_its_spatial_twin(friction, inertia):
    """With more than a turn of both pulleys; at the lower friction the belt slips on them."""
    runs = []
    for element in (PLANAR, {}):
        scene, pulley = fu.Scene(gravity=(0, 0, 0)), {"radius": 0.1, "friction": friction, "side": "left"}
        scene.rope("belt", closed=True, tension=500.0, **rope_of(1e5, 1e-5, 0, 1e-3) | SPATIAL | element, route=[
            fu.Sheave("driver", at=(0, 0, 0), **pulley, velocity=fu.Ramp(start=0, end=0.2, after=20.0)),
            fu.Sheave("driven", at=(1, 0, 0), **pulley | {"radius": 0.15}, inertia=inertia)])
        runs.append(scene.run(0.6, output_step=0.1, integrator="radau", **BRIEF | {"tol": 1e-9}))
    near(*runs, 1e-8, "driver.angle", "driven.angle", "driver.wrap_angle", "driven.wrap_angle")
    near(*runs, 1e-4, "driver.tension_on", "driven.tension_on", "driver.material_speed", "driven.slip")
    assert runs[0]["driver.angle"][-1] > 2 * pi
    assert bool(np.abs(runs[0]["driven.slip"]).max() > 0.01 or np.abs(runs[0]["driver.slip"]).max() > 0.01) is (
        friction < 1)


def test_the_speed_of_a_rope_that_slips_is_that_of_the_material_that_passes():
    """Between the middle of the wrap on the second sheave and the load, beside a sheave on which the rope slips."""
    scene = twins(friction=0.05)[1]
    run = scene.run(0.1, output_step=1e-4, integrator="radau", **BRIEF | {"tol": 1e-9})
    s = run["hoist.s"]
    beyond = s[:, -1] - (s[:, -5 - 18] + s[:, -5]) / 2  # a wrap has 19 points, a part 5
    slips = np.abs(run["top.slip"]) > 0.01
    inside = np.flatnonzero(slips[2:-2] & slips[:-4] & slips[4:]) + 2
    assert len(inside) > 100
    speed = np.gradient(beyond, run.time)
    assert np.abs(speed - run["two.material_speed"])[inside].max() < 1e-4


# ---- friction and drums

@pytest.mark.parametrize("coefficient", [0.1, 0.3])
def test_a_capstan_holds_up_to_its_limit(coefficient):
    """The limit is that of the wrap, 1e-6 to either side, where the rope leaves at fleet angles."""
    scene = fu.Scene(gravity=(0, 0, 0))
    rope = [fu.Anchor("A"), fu.Sheave("top", at=(0, 0, 0), radius=0.2, side="right", friction=coefficient, **ANY),
            fu.Anchor("B")]
    for name, at in (("A", (-0.3, -2, 0.1)), ("B", (0.4, -2.5, 0.2))):
        scene.rigid_body(name, mass=1.0, inertia=(1, 1, 1), position=at)
    scene.rope("hoist", route=rope, tension=1000.0, **STIFF)
    drawn = scene.run(1e-6, output_step=1e-6, progress=False)
    assert drawn["top.fleet_angle_on"][0] > 0.04
    limit = exp(coefficient * drawn["top.wrap_angle"][0])
    ends = [drawn["hoist.position"][0, k] for k in (0, 4, -5, -1)]
    on, off = ends[1] - ends[0], ends[3] - ends[2]
    for factor, slips in ((1 - 1e-6, False), (1 + 1e-6, True)):
        pulled = fu.Scene.from_toml(scene.to_toml())
        pulled.force("A", value=tuple(-1000.0 * on / np.linalg.norm(on)))
        pulled.force("B", value=tuple(1000.0 * limit * factor * off / np.linalg.norm(off)))
        rest = pulled.equilibrium()
        run = pulled.run(1e-3, output_step=1e-3, initial=rest, **BRIEF)
        ratio = run["top.tension_off"] / run["top.tension_on"]
        assert ratio[0] == pytest.approx(limit * min(factor, 1.0), rel=1e-9)
        assert bool(run["top.slip"][-1]) is slips


def test_a_drum_drives_up_and_down():
    """The length of the rope is that of the part and what is wound: with a fleet angle, to the stretch."""
    scene = fu.Scene(gravity=(0, -GRAVITY, 0))
    scene.rigid_body("load", mass=20.0, inertia=(1, 1, 1), position=(0.25, -6, 0.4))
    haul = fu.TableSignal(time=[0, 0.3, 0.9, 1.2, 9], value=[0, 4, 4, -4, -4], interpolation="linear")
    scene.rope("rope", tension=20 * GRAVITY, **STIFF, route=[
        fu.Drum("winch", at=(0, 0, 0), radius=0.25, side="right", length_in_store=3.0, velocity=haul, **ANY),
        fu.Anchor("load")])
    run = scene.run(2.0, output_step=0.05, integrator="radau", **BRIEF)
    x, y, z = run["load.position"].T
    square = x * x + y * y
    rho = np.sqrt((square + 0.25**2 - np.sqrt((square - 0.25**2)**2 - (0.5 * z)**2)) / 2)
    part = np.sqrt(square + z * z - rho**2)
    foot = np.arctan2(y, x) + np.arccos(rho / np.sqrt(square))
    way = 0.25 * run["winch.angle"] + part + 0.25 * (foot[0] - foot)
    assert np.ptp(run["winch.angle"]) > 3
    assert np.abs(way - way[0]).max() < 2e-4  # the rope stretches by 1e-4 m
    assert np.abs(run["winch.fleet_angle"] - np.arcsin(z / part)).max() < 1e-10
    assert np.abs(run.energy_balance().relative).max() < 1e-6


# ---- rest

def test_rest_and_modes_are_those_in_the_plane():
    plane, space = ([], [])
    for found, element in ((plane, PLANAR), (space, {})):
        scene = fu.Scene(gravity=(0, -GRAVITY, 0))
        weight(scene, "load", 5.0, 0.3, -3)
        scene.rope("rope", route=[fu.Anchor(at=(-0.3, -2, 0)), fu.Sheave("top", at=(0, 0, 0), radius=0.3, side="right"),
                                  fu.Anchor("load")], tension=40.0, **SOFT | element)
        rest = scene.equilibrium()
        found += [rest["load.position"], rest["top.wrap_angle"], scene.modes(3 if element else 6, about=rest)]
    assert plane[0] == pytest.approx(space[0], abs=1e-9) and plane[1] == pytest.approx(space[1], abs=1e-9)
    for frequency in plane[2].frequency[1:3]:
        assert np.abs(space[2].frequency / frequency - 1).min() < 1e-8
    drop = -space[0][1]
    across = np.sqrt(GRAVITY / drop) / (2 * pi)  # about the foot
    shapes = space[2]["load.displacement"]
    k = int(np.argmax(np.abs(shapes[:, 2]) / np.linalg.norm(shapes, axis=1).clip(1e-300)))
    assert space[2].frequency[k] == pytest.approx(across, rel=1e-6)
    assert space[2]["rope.displacement"][k, -1] == pytest.approx(shapes[k], abs=1e-6)


@pytest.mark.parametrize("k", [1, 6])
def test_modes_move_the_rope_as_velocities_do(k):
    """A sheave on a ring on a ball joint, whose groove tilts with it."""
    scene = fu.Scene(gravity=(0, -GRAVITY, 0))
    scene.rigid_body("load", mass=5.0, inertia=(1, 1, 1), position=(0.3, -2, 0))
    scene.rigid_body("ring", mass=5.0, inertia=(0.2, 0.1, 0.3), position=(0, 0.5, 0))
    scene.joint("spherical", (0, 0.8, 0), ("ring", (0, 0.3, 0)), name="hinge")
    top = fu.Sheave("top", at=("ring", (0, -0.5, 0)), radius=0.3, side="right", **ANY)
    route = [fu.Anchor(at=(-0.3, -2, 0)), top, fu.Anchor("load", at=(0, 0.05, 0))]
    scene.rope("rope", tension=40.0, **SOFT, route=route)
    modes = scene.modes(9, about=scene.equilibrium())
    assert modes.frequency[k] > 0.1
    for name in ("load", "ring"):
        motion = (tuple(0.1 * modes[f"{name}.{of}"][k]) for of in ("displacement", "rotation"))
        scene = scene.replace(name, **dict(zip(("velocity", "angular_velocity"), motion, strict=True)))
    run = scene.run(1e-4, output_step=1e-4, initial="equilibrium", integrator="radau", progress=False)
    moved = np.diff(run["rope.position"], axis=0)[0] / 1e-5
    assert np.abs(moved - modes["rope.displacement"][k]).max() < 1e-4 * np.abs(moved).max()


def test_a_load_comes_to_rest_below_its_sheave():
    """Which hangs straight down from the edge of its groove."""
    scene = fu.Scene(gravity=(0, -GRAVITY, 0))
    scene.rigid_body("load", mass=5.0, inertia=(1, 1, 1), position=(0.6, -2, 0.3))
    scene.rope("rope", route=[fu.Anchor(at=(-0.3, -2, 0.2)),
                              fu.Sheave("top", at=(0, 0, 0), radius=0.3, side="right", **ANY), fu.Anchor("load")],
               tension=40.0, **SOFT)
    rest = scene.equilibrium()
    assert rest["top.tension_off"] == pytest.approx(5 * GRAVITY, rel=1e-9)
    assert rest["load.position"][[0, 2]] == pytest.approx([0.3, 0], abs=1e-8)
    run = scene.run(0.3, output_step=0.1, initial=rest, **BRIEF)
    assert np.abs(run["load.position"] - rest["load.position"]).max() < 1e-8


# ---- files

def test_files(tmp_path):
    scene = free(friction=2.0)
    run = scene.run(0.04, output_step=0.02, **BRIEF)
    run.save(tmp_path / "run.nc")
    copy = fu.Scene.from_toml(scene.to_toml())
    for other in (fu.load_run(tmp_path / "run.nc"), copy.run(0.04, output_step=0.02, **BRIEF)):
        assert all(np.array_equal(run[name], other[name]) for name in run)


@pytest.mark.parametrize("integrator", ["genalpha", "radau", "explicit"])
def test_resumed_bit_for_bit(tmp_path, integrator):
    settings = {"duration": 0.2, "output_step": 0.005, "tol": 1e-5, "integrator": integrator}
    kill(free(friction=0.05), tmp_path / "run.nc", 15, **settings, progress=False)
    resumed = free(friction=0.05).run(**settings, save=tmp_path / "run.nc", resume=True, progress=False)
    whole = free(friction=0.05).run(**settings, progress=False)
    assert all(np.array_equal(whole[name], resumed[name]) for name in whole)


# ---- messages

def test_a_fleet_angle_above_its_limit_is_reported():
    with pytest.warns(fu.FunicularWarning, match='sheave "top": its fleet angle reached .* rad at t = .* s, above '
                                                 "max_fleet_angle, 0.08 rad: the rope may leave its groove"):
        swing(max_fleet_angle=0.08).run(0.5, output_step=0.1, **BRIEF)


def test_a_part_that_becomes_too_short_for_its_fleet_angle_ends_the_run():
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.rigid_body("load", mass=1.0, inertia=(1, 1, 1), position=(0.3, -1.5, 0.3), velocity=(0, 1.0, 0))
    top = fu.Sheave("top", at=(0, 0, 0), radius=0.3, side="right", **ANY)
    scene.rope("rope", route=[fu.Anchor(at=(-0.3, -1, 0)), top, fu.Anchor("load")], tension=0.1, **SOFT)
    with pytest.raises(fu.RopeLeftError, match='the groove of sheave "top", as a span is too short for its fleet'):
        scene.run(2.0, output_step=0.1, **BRIEF)


def test_refusals():
    with refused('rope "hoist": integrator "energy" does not support ropes without mass; take another integrator'):
        swing().run(0.1, integrator="energy", progress=False)
