"""Ropes whose ends, sheaves and drums are held by points of cables: beside ropes on a light body hinged there."""

import funicular as fu
import numpy as np
import pytest
from funicular.parts.locations import following
from funicular.parts.paths import changes_of, path_of
from interrupted_runs import killed_and_resumed

THREAD = {"section": fu.Circle(radius=3e-4),
          "material": fu.Material(youngs_modulus=2e9, poisson_ratio=0.3, density=4000, damping_time=1e-3)}
BAR = {"section": fu.Circle(radius=5e-3),
       "material": fu.Material(youngs_modulus=1e9, poisson_ratio=0.3, density=7800, damping_time=1e-3)}
R, MIDDLE = 0.2, 3.95
SLIDING = {}
TURNING = {"inertia": 0.1, "friction": fu.Friction(coefficient=0.3, velocity=1e-3)}


def bearer(element: str = "cable8p", **given) -> fu.Scene:
    """Return a scene without gravity with a taut cable along x from -4 to 4 m."""
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.cable("bearer", start=(-4, 0, 0), end=(4, 0, 0), elements=8, element=element, rest_length=2 * MIDDLE,
                **BAR, **given)
    for s in (0.0, 2 * MIDDLE):
        scene.pin("bearer", s=s)
    return scene


def hinged(scene: fu.Scene, mass: float = 1e-5) -> str:
    """Add a light body that is hinged to the middle of the cable; return its name."""
    scene.rigid_body("hanger", mass=mass, inertia=(mass * 1e-3,) * 3, position=(0, 0, 0))
    scene.joint("revolute", "hanger", ("bearer", MIDDLE), axis=(0, 0, 1))
    return "hanger"


def weights(scene: fu.Scene, at, element: str = "cable8p", heavy: float = 11.8, mass: bool = True,
            **given) -> fu.Scene:
    """Return the scene with two pulled bodies on a rope over a sheave at a place."""
    for name, x, force in (("light", -R, 9.81), ("heavy", R, heavy)):
        scene.rigid_body(name, mass=1, inertia=(1, 1, 1), position=(x, -2, 0))
        scene.force(name, value=(0, -force, 0))
    scene.rope("rope", element=element, tension=10.7, elements=1, mass=mass, **THREAD, route=[
        fu.Anchor("light"), fu.Sheave("top", at=at, radius=R, side="right", **given), fu.Anchor("heavy")])
    return scene


def on_cable(**given) -> fu.Scene:
    return weights(bearer(), ("bearer", MIDDLE), **given)


def apart(one: fu.Run, other: fu.Run) -> float:
    """Return the largest distance of the heavy body and of the bearer in two runs, m."""
    return max(np.abs(one[name] - other[name]).max() for name in ("heavy.position", "bearer.position"))


@pytest.mark.parametrize("sheave", [SLIDING, TURNING], ids=["sliding", "turning"])
def test_a_sheave_on_a_cable_is_one_on_a_light_body_there(sheave):
    settings = {"duration": 0.3, "output_step": 0.05, "tol": 1e-6, "integrator": "radau", "progress": False}
    run, other = on_cable(**sheave).run(**settings), weights(scene := bearer(), hinged(scene), **sheave).run(**settings)
    assert apart(run, other) < 2e-7  # 1e-5 kg of .64 kg/m; 8e-6 m of 1 g
    assert np.abs(run["bearer.position"][:, 4, 1]).max() > 5e-3
    assert np.abs(run.energy_balance().relative).max() < 1e-7
    assert run["top.force"] == pytest.approx(other["top.force"], rel=1e-4, abs=1e-3)


@pytest.mark.parametrize(("integrator", "sheave"), [("genalpha", TURNING), ("explicit", SLIDING)])
def test_integrators_agree(integrator, sheave):
    scene = on_cable(**sheave)
    given = {"duration": 0.05, "output_step": 0.01, "progress": False}
    assert apart(scene.run(integrator="radau", tol=1e-6, **given), scene.run(integrator=integrator, tol=1e-5, **given)
                 ) < 1e-6


def test_a_torque_acts_on_the_section():
    """A motor between a sheave and the cable turns the cable's section: the moment of its two halves."""
    still, driven = (on_cable(heavy=9.81, torque=torque, **TURNING).run(
        0.3, output_step=0.05, tol=1e-5, integrator="radau", progress=False) for torque in (None, 1.0))
    tilts = [float(np.diff(run["bearer.position"][-1, [3, 5], 1])[0]) for run in (still, driven)]
    assert abs(tilts[0]) < 1e-12 and tilts[1] < -1e-4
    assert np.abs(driven.energy_balance().relative).max() < 1e-5


def wound_on(scene: fu.Scene, at, **given) -> fu.Scene:
    """Return the scene with a body that hangs from a drum at a place, beside an end of the rope."""
    scene.rigid_body("load", mass=1, inertia=(1, 1, 1), position=(0.3, -1, 0))
    scene.rope("rope", tension=9.0, elements=1, route=[
        at["end"], fu.Sheave("low", at="load", radius=0.15, side="left"),
        fu.Drum("winch", at=at["drum"], radius=0.1, side="left", length_in_store=2.0,
                velocity=fu.Ramp(start=0, end=0.2, before=0, after=0.4))], **THREAD | given)
    scene.force("load", value=(0, -17.0, 0))
    return scene


@pytest.mark.parametrize("element", ["cable8p", "beam12p"])
@pytest.mark.parametrize("mass", [True, False], ids=["with mass", "without"])
@pytest.mark.slow_cases("with mass-cable8p")
def test_a_drum_and_an_end_on_a_cable(element, mass):
    """As on light bodies that are welded and hinged there."""
    on, by_bodies = bearer(element), bearer(element)
    for name, s, kind, axis in (("for_drum", 4.44375, "weld", None), ("for_end", 3.95, "spherical", None)):
        x = s / MIDDLE * 4 - 4
        by_bodies.rigid_body(name, mass=1e-5, inertia=(1e-8,) * 3, position=(x, 0, 0))
        by_bodies.joint("revolute" if kind == "spherical" else kind, name, ("bearer", s),
                        axis=(0, 0, 1) if kind == "spherical" else axis)
    settings = {"duration": 0.3, "output_step": 0.05, "tol": 1e-6, "integrator": "radau", "progress": False}
    run = wound_on(on, {"end": fu.Anchor("bearer", s=3.95), "drum": ("bearer", 4.44375)}, mass=mass).run(**settings)
    other = wound_on(by_bodies, {"end": fu.Anchor("for_end"), "drum": "for_drum"}, mass=mass).run(**settings)
    assert np.abs(run["load.position"] - other["load.position"]).max() < 1e-6
    assert np.abs(run["bearer.position"] - other["bearer.position"]).max() < 1e-6
    assert run["winch.length_in_store"] == pytest.approx(other["winch.length_in_store"], abs=1e-6)
    assert np.ptp(run["load.position"][:, 1]) > 0.01


def hung(element: str = "cable8p") -> fu.Scene:
    """Return a heavy cable with a sheave, over which a rope from the ground holds a weight."""
    scene = fu.Scene()
    scene.cable("bearer", start=(-4, 0, 0), end=(4, 0, 0), elements=8, element=element, rest_length=2 * MIDDLE, **BAR)
    for s in (0.0, 2 * MIDDLE):
        scene.pin("bearer", s=s)
    scene.rigid_body("load", mass=1, inertia=(1, 1, 1), position=(R, -2, 0))
    scene.rope("rope", tension=9.81, elements=1, element=element, **THREAD, route=[
        fu.Anchor(at=(-R, -2, 0)), fu.Sheave("top", at=("bearer", MIDDLE), radius=R, side="right"), fu.Anchor("load")])
    return scene


def test_statics_and_modes():
    rest = hung().equilibrium()
    weight = 2 * 9.81 + rest["top.force"][1]
    assert -0.06 < weight < -0.05  # of the rope
    by_force = fu.Scene()
    by_force.cable("bearer", start=(-4, 0, 0), end=(4, 0, 0), elements=8, element="cable8p", rest_length=2 * MIDDLE,
                   **BAR)
    for s in (0.0, 2 * MIDDLE):
        by_force.pin("bearer", s=s)
    by_force.force("bearer", s=MIDDLE, value=tuple(rest["top.force"]))
    assert rest["bearer.position"] == pytest.approx(by_force.equilibrium()["bearer.position"], abs=1e-9)
    assert hung().modes(4, about=rest).frequency.min() >= 0


def test_files_and_changes(tmp_path):
    scene = hung()
    again = fu.Scene.from_toml(scene.to_toml())
    assert again.to_toml() == scene.to_toml()
    scene.rope("stay", tension=5.0, **THREAD, route=[
        fu.Anchor("bearer", s=1.0), fu.Sheave("low", at=(-2, -2, 0), radius=0.1, side="left"),
        fu.Anchor(at=(0, -3, 0))])
    assert fu.Scene.from_toml(scene.to_toml()).to_toml() == scene.to_toml()
    given = changes_of(scene, {path_of(scene, "bearer.rest_length"): 0.99 * 2 * MIDDLE})
    shorter = {k: entries["route"] for k, entries in following(scene, given).items() if "route" in entries}
    assert sorted(item.end.s for route in shorter.values() for item in route if item.end.on == "bearer") == [
        pytest.approx(0.99), pytest.approx(0.99 * MIDDLE)]
    assert not scene.without("bearer").ropes


@pytest.mark.parametrize("integrator", ["radau", "genalpha"])
def test_resumed_bit_for_bit(tmp_path, integrator):
    scene = on_cable(**SLIDING)
    settings = {"duration": 0.05, "output_step": 1e-3, "tol": 1e-4, "integrator": integrator, "progress": False}
    resumed = killed_and_resumed(scene, tmp_path / "run.nc", 20, **settings)
    whole = scene.run(**settings)
    assert all(np.array_equal(whole[name], resumed[name]) for name in whole)


@pytest.mark.parametrize("element", ["cable8p", "cable12"])
def test_a_rope_starts_with_its_cable(element):
    """A scene that moves as a whole, and in the plane turns: the rates of the rope follow from those of the cable."""
    turning = np.array([0, 0, 0.5 if element == "cable8p" else 0])
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.cable("bearer", start=(0, 0, 0), end=(4, 0, 0), elements=4, element=element, velocity=(0.3, 1, 0),
                angular_velocity=turning, **BAR)
    scene.rigid_body("top", mass=1, inertia=(1, 1, 1), position=(2, 2, 0), angular_velocity=turning,
                     velocity=np.add([0.3, 1, 0], np.cross(turning, (2, 2, 0))))
    if element == "cable12":
        scene.joint("prismatic", "top", (2, 2, 0), axis=(0.3, 1, 0))
    scene.rope("rope", element=element, tension=10.0, elements=2, **THREAD, route=[
        fu.Anchor("bearer", s=1.0), fu.Sheave("wheel", at="top", radius=0.2, side="right"), fu.Anchor("bearer", s=3.5)])
    run = scene.run(1e-4, output_step=1e-4, step=1e-5, integrator="genalpha", progress=False)
    start, end = run["rope.position"]
    assert end - start == pytest.approx(1e-4 * np.add([0.3, 1, 0], np.cross(turning, start)), abs=2e-6)


def test_loads_and_fluids_on_a_rope_on_a_cable():
    """The wind moves the load to its side, and the sheave bears the load of a length. A file keeps all parts."""
    scene = hung()
    scene.fluid("air", density=1.2, velocity=(4, 0, 0))
    scene.drag("rope", normal=1.2, diameter=0.05)
    scene.distributed_force("rope", value=(0, -0.05, 0))
    scene.force("rope", s=0.5, value=(0.1, 0, 0))
    scene.surface("floor", fu.Plane(point=(0, -9, 0), normal=(0, 1, 0)))
    scene.contact("rope", "floor", stiffness=1e4)
    rest, still = scene.equilibrium(), hung().equilibrium()
    assert rest["load.position"][0] > still["load.position"][0] + 0.02
    assert rest["top.force"][1] < still["top.force"][1] - 0.1
    assert fu.Scene.from_toml(scene.to_toml()).to_toml() == scene.to_toml()


STICKING = {"friction": fu.Friction(coefficient=0.3, model="stick"), "inertia": 0.1}


def test_friction_that_sticks():
    settings = {"duration": 0.1, "output_step": 0.02, "tol": 1e-6, "integrator": "radau", "progress": False}
    run = on_cable(**STICKING).run(**settings)
    other = weights(scene := bearer(), hinged(scene), **STICKING).run(**settings)
    assert apart(run, other) < 2e-7
    assert run["top.slip_angle"][0] == 0.0


def test_pictures():
    """A wheel follows its point of the cable."""
    clip = on_cable(**TURNING).run(0.05, output_step=0.01, step=1e-4, progress=False).animation("a run").clips[0]
    wheel = next(body for body in clip.bodies if body.name == "top")
    bearer = next(cable for cable in clip.cables if cable.name == "bearer")
    assert np.abs(bearer.position - wheel.position[:, None]).sum(axis=-1).min(axis=1).max() < 1e-3
