"""Sheaves and drums with inertia of ropes without mass, on bodies that rotate in space and on cables: momenta, energy,
twins in the plane, and ropes of small mass.
"""

import funicular as fu
import numpy as np
import pytest
from derivatives import of_a_step
from funicular.base.rotations import rotate
from funicular.engine import Engine
from funicular.integrators import GeneralisedAlpha
from funicular.model.build import build
from interrupted_runs import kill
from ropes.scenes import GRAVITY, rope_of, weight
from test_massless_ropes_in_space import SOFT, free, momenta, twins, winch
from turned_scenes import ASKEW, turned_scene

INERTIA = 0.3
ON = {"top": ("S", (0.1, 0.1, 1.0)), "winch": ("A", (0.1, 0.2, 1.0))}
"""Bodies of the wheels, and their axes as drawn."""
WHEELS = ["sheave", "slipping", "drum"]


def scene_of(wheel: str, gravity: tuple[float, ...] = (0, 0, 0), inertia: float = INERTIA, **sheave) -> fu.Scene:
    """Return free bodies of test_massless_ropes_in_space, on one of which a wheel with inertia spins up."""
    if wheel == "drum":
        return free(gravity, first=winch(inertia=inertia, torque=6.0 if inertia else None))
    return free(gravity, **{"friction": 0.05 if wheel == "slipping" else 2.0} | sheave, inertia=inertia)


def name_of(wheel: str) -> str:
    return "winch" if wheel == "drum" else "top"


def run_of(scene: fu.Scene, duration: float, integrator: str = "radau", **given) -> fu.Run:
    return scene.run(duration, integrator=integrator, progress=False, **{"output_step": duration / 10, "tol": 1e-9}
                     | given)


def of_the_wheel(run: fu.Run, name: str) -> np.ndarray:
    """Return (T, 3): the angular momentum of a wheel about its axis, I (psi' + a . w) a."""
    body, axis = ON[name]
    frame = np.stack([rotate(run[f"{body}.orientation"], axis) for axis in np.eye(3)], axis=-1)
    a = frame @ frame[0].T @ np.array(axis) / np.linalg.norm(axis)
    carried = np.einsum("ti,tij,tj->t", a, frame, run[f"{body}.angular_velocity"])
    return INERTIA * (run["hoist.coordinate_rates"][:, :1] + carried[:, None]) * a


@pytest.mark.parametrize("wheel", WHEELS)
def test_momenta_and_energy_of_free_bodies(wheel):
    """The angular momentum of the wheel turns with its axis; without it that of the bodies changes."""
    run = run_of(scene_of(wheel), 0.2)
    found = of_bodies = momenta(run)
    found = np.concatenate([found[:, :3], found[:, 3:] + of_the_wheel(run, name_of(wheel))], axis=1)
    assert np.abs(found - found[0]).max() < 1e-10
    assert np.abs(of_bodies - of_bodies[0]).max() > 0.05
    assert np.abs(run.energy_balance().relative).max() < 1e-8
    if wheel == "slipping":
        assert run["top.slip"].any()


@pytest.mark.parametrize("wheel", WHEELS)
@pytest.mark.parametrize(("integrator", "tol"), [("genalpha", 1e-7), ("explicit", 1e-10)])
def test_integrators_agree(wheel, integrator, tol):
    """Steps of explicit at 1e-8 pass over a slip of .7 ms."""
    scene = scene_of(wheel, (1.0, -3.0, 2.0))
    one, other = run_of(scene, 0.1), run_of(scene, 0.1, integrator, tol=tol)
    for name in ("A.position", "S.orientation", f"{name_of(wheel)}.angle"):
        assert other[name] == pytest.approx(one[name], abs=5e-6), name
    assert np.abs(other.energy_balance().relative).max() < 1e-5


@pytest.mark.parametrize("wheel", WHEELS)
@pytest.mark.parametrize("h", [1e-2, 1e-3])
def test_the_matrix_of_a_step_is_the_derivative_of_its_residual(wheel, h):
    engine = Engine(build(scene_of(wheel)))
    status, _ = engine.start(duration=1.0, output_step=0.1, tol=1e-4, step=0.0, method=GeneralisedAlpha(0.8),
                             first_step=1e-3)
    assert status is None
    at = 1e-3 * np.random.default_rng(1).standard_normal(engine.unknowns)
    matrix = engine.linearise(h, at)[1]
    worst = [np.abs(of_a_step(engine, h, at, step) - matrix).max() / np.abs(matrix).max() for step in (1e-5, 1e-6)]
    assert min(worst) < 1e-9


@pytest.mark.parametrize("wheel", WHEELS)
def test_a_turned_scene_gives_the_same(wheel):
    scene = scene_of(wheel, (0, -GRAVITY, 0))
    one, other = (run_of(each, 0.1, tol=1e-10) for each in (scene, turned_scene(scene, *ASKEW)))
    for name in ("top.wrap_angle", "top.fleet_angle_off", f"{name_of(wheel)}.angle"):
        assert other[name] == pytest.approx(one[name], abs=1e-9), name


def test_a_planar_scene_and_its_spatial_twin():
    """The sheave is on a lever that turns."""
    plane, space = (run_of(scene, 0.4) for scene in twins(friction=2.0, inertia=0.1))
    assert np.ptp(plane["lever.position"], axis=0).max() > 2e-3 and np.ptp(plane["top.angle"]) > 0.01
    for name in ("lever.position", "L.position", "hoist.position", "top.angle"):
        assert space[name] == pytest.approx(plane[name], abs=1e-9), name


@pytest.mark.parametrize(("wheel", "rho"), [("drum", 1e-3), ("sheave", 1e-3), *(
    pytest.param("drum", rho, marks=pytest.mark.slow) for rho in (1e-4, 1e-5))])
def test_a_rope_of_little_mass_tends_to_none(wheel, rho):
    """In proportion to its mass. On a sheave it has a stretch of its own on the arc, which makes 2e-5 rad."""
    scene = scene_of(wheel, friction=fu.Friction(coefficient=2.0, model="stick"))
    light = scene.replace("hoist", mass=True, elements=1, **rope_of(6e4, rho, 0, 1e-3))
    given = {"output_step": 0.03, "tol": 1e-6}
    without, found, inert = (run_of(each, 0.15, **given) for each in (scene, light, scene_of(wheel, inertia=0.0)))
    rest = 0.0 if wheel == "drum" else 2e-5
    for name in ("S.position", "A.position", "S.orientation", "A.orientation", f"{name_of(wheel)}.angle"):
        assert np.abs(found[name] - without[name]).max() < 0.2 * rho + rest, name
    carrier = ON[name_of(wheel)][0]
    assert np.abs(inert[f"{carrier}.orientation"] - without[f"{carrier}.orientation"]).max() > 1e-2


def on_a_cable(element: str, aside: float = 0.0) -> fu.Scene:
    """Return two weights on a rope over a sheave with inertia on a sagging cable."""
    scene = fu.Scene(gravity=(0, -GRAVITY, 0))
    scene.cable("bearer", start=(-2, 0, 0), end=(2, 0, 0), elements=4, element=element, **rope_of(1e5, 0.5, 0.5))
    for s in (0.0, 4.0):
        scene.pin("bearer", s=s)
    weight(scene, "light", 1.0, 0.3, -1.5)
    scene.rigid_body("heavy", mass=2.0, inertia=(2, 2, 2), position=(0.7, -1.5, aside))
    top = fu.Sheave("top", at=("bearer", 2.5), radius=0.2, side="right", friction=3.0, inertia=0.5, max_fleet_angle=0.5)
    scene.rope("rope", tension=12.0, route=[fu.Anchor("light"), top, fu.Anchor("heavy")], **SOFT | {"element": element})
    return scene


def test_a_sheave_on_a_cable_and_its_spatial_twin():
    """Its carrier's coordinates are no rotations, so that the rotation has accelerations of its own."""
    plane, space = (run_of(on_a_cable(element), 0.5, tol=1e-8) for element in ("cable8p", "cable12"))
    for name in ("heavy.position", "bearer.position", "top.angle"):
        assert space[name] == pytest.approx(plane[name], abs=1e-9), name
    for run in (plane, space, run_of(on_a_cable("cable12", 0.2), 0.5, tol=1e-8)):
        assert np.abs(run.energy_balance().relative).max() < 2e-8  # 1.4e-4 without these accelerations


@pytest.mark.parametrize("integrator", ["genalpha", "radau", "explicit"])
def test_resumed_bit_for_bit(tmp_path, integrator):
    settings = {"duration": 0.2, "output_step": 0.005, "tol": 1e-5, "integrator": integrator, "progress": False}
    kill(scene_of("slipping"), tmp_path / "run.nc", 15, **settings)
    resumed = scene_of("slipping").run(**settings, save=tmp_path / "run.nc", resume=True)
    whole = scene_of("slipping").run(**settings)
    assert all(np.array_equal(whole[name], resumed[name]) for name in whole)


def test_torques_about_the_axis():
    """A drum has the torque of its drive; the rope alone accelerates a sheave, about an axis that tilts."""
    drum, sheave = (run_of(scene_of(wheel), 0.02, output_step=2e-5) for wheel in ("drum", "sheave"))
    assert drum["winch.torque"] == pytest.approx(6.0, abs=1e-9)
    assert drum["winch.power"] == pytest.approx(6.0 * drum["hoist.coordinate_rates"][:, 0], abs=1e-9)
    spin, axis = of_the_wheel(sheave, "top"), of_the_wheel(sheave, "top")
    axis = axis / np.linalg.norm(axis, axis=1)[:, None]
    upwards = np.sign(axis[:, 2:])
    rate = np.gradient(np.einsum("ti,ti->t", spin, axis * upwards), sheave.time)
    assert np.abs(sheave["top.torque"]).max() > 1
    assert np.abs(rate - sheave["top.torque"])[2:-2].max() < 1e-3 * np.abs(sheave["top.torque"]).max()
