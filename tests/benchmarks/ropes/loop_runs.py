"""Runs of elevators, ropeways and waves by funicular; see `ropes.runs`."""

from __future__ import annotations

from math import pi

import funicular as fu
import numpy as np

from . import elevators, waves
from .scenes import GRAVITY, Found, over_one, rope_of, weight


def _guided(scene: fu.Scene, name: str, mass: float, x: float, y: float, **drive: object) -> None:
    """Add a weight that moves along a vertical rail."""
    weight(scene, name, mass, x, y)
    scene.joint("prismatic", (x, y, 0), name, axis=(0, 1, 0), **drive)


def _elevator(held: bool, less: float) -> list[float]:
    """Return the first three frequencies above zero; less: mass taken from rims and tension mass, kg.

    There is no gravity, and little tension: the frequencies of bars do not depend on them.
    """
    R, tension, of = elevators.R, 10.0, elevators
    scene = fu.Scene(gravity=(0, 0, 0))
    _guided(scene, "car", of.CAR, -R, -of.BELOW)
    _guided(scene, "counterweight", of.COUNTERWEIGHT, R, of.BELOW - of.HEIGHT)
    _guided(scene, "tension_mass", of.TENSION_MASS - less, 0, -of.HEIGHT)
    scene.force("tension_mass", value=(0, -2 * tension, 0))
    rough = {"radius": R, "friction": 0.5, "zones": 2}
    turning = {} if held else {"inertia": of.J_TOP - less * R**2}
    top = fu.Sheave("top", at=(0, 0, 0), side="right", **rough, **turning)
    bottom = fu.Sheave("bottom", at="tension_mass", side="left", inertia=of.J_BOTTOM - less * R**2, **rough)
    for name, sheave, EA in (("hoist", top, of.EA), ("compensation", bottom, of.EA_COMPENSATION)):
        scene.rope(name, route=[fu.Anchor("car"), sheave, fu.Anchor("counterweight")], elements=4, tension=tension,
                   **rope_of(EA, of.DENSITY, 0))
    modes = scene.modes(42, wraps="stick")
    moves = [modes[f"{name}.displacement"][:, 1] for name in ("car", "counterweight", "tension_mass")]
    axial = np.max(np.abs([*moves, R * modes["bottom.angle"]]), axis=0) > 1e-3  # others are those of strings
    return [float(each) for each in modes.frequency[axial & (modes.frequency > 0.01)][:3]]


def _frequencies(less: float) -> Found:
    names = [each.name for each in elevators.CASES[0].quantities]
    return dict(zip(names, _elevator(False, less) + _elevator(True, less), strict=True))


def elevator() -> Found:
    """An elevator whose sheaves and tension mass are lighter by the ropes on them, which the reference leaves out."""
    return _frequencies(elevators.WRAP)


def elevator_with_wraps() -> Found:
    """The elevator as it is."""
    return _frequencies(0.0)


def ropeway() -> Found:
    """A loop of a ropeway drawn upright, with the gravity along the slope, at .5 m/s: rho v² is 2e-5 of the tension.

    The rope is in parts from car to car. On the carriage are the tension weight and what hangs on it: the rope on its
    sheave, and its own weight.
    """
    H, S, rho, R, EA, own = 300.0, 1000.0, 6.0, 2.0, 1e9, 1000.0
    along, level = GRAVITY * H / S, (1 - (H / S) ** 2) ** 0.5
    scene = fu.Scene(gravity=(0, -along, 0))
    made = rope_of(EA, rho, 0, 0.1)
    for side, x, mass, resists in (("up", R, 800.0, -1), ("down", -R, 400.0, 1)):
        places = -800.0 + 200.0 * np.arange(4)
        for k, y in enumerate(places):
            weight(scene, f"{side}{k}", mass, x, y)
            scene.force(f"{side}{k}", value=(0, resists * 0.02 * mass * GRAVITY * level, 0))
        for k, y in enumerate(places[:-1]):
            part = scene.cable(f"{side}_rope{k}", start=(x, y, 0), end=(x, y + 200.0, 0), elements=1,
                               element="cable8p", rest_length=200.0 / (1 + 5e4 / EA), **made)
            scene.joint("spherical", (part.name, 0.0), f"{side}{k}")
            scene.joint("spherical", (part.name, part.length), f"{side}{k + 1}")
    _guided(scene, "carriage", own, 0, -S)
    scene.force("carriage", value=(0, -80e3 + (own + rho * pi * R) * along, 0))
    starts = fu.TableSignal(time=[0, 2, 4, 100], value=[0, 0, 0.5 / R, 0.5 / R], interpolation="linear")
    drive = fu.Sheave("drive", at=(0, 0, 0), radius=R, side="left", zones=4, velocity=starts,
                      friction=fu.Friction(coefficient=0.3, velocity=1e-4))
    scene.rope("top", route=[fu.Anchor("up3"), drive, fu.Anchor("down3")], elements=1, tension=5e4, **made)
    scene.rope("bottom", route=[fu.Anchor("down0"), fu.Sheave("return", at="carriage", radius=R, side="left"),
                                fu.Anchor("up0")], elements=1, tension=4.2e4, **made)
    run = scene.run(10.0, output_step=5.0, tol=1e-3, integrator="radau", progress=False)
    return {"tight": run["drive.tension_on"][-1], "slack": run["drive.tension_off"][-1],
            "torque": -run["drive.torque"][-1]}


def wave() -> Found:
    """A smooth start of the haul, and the force of the rope on a heavy load: from half the one to half the other."""
    rise, speed, EA, R = 0.03, 0.05, waves.EA, waves.R
    end = waves.delay()[0] + 1.5 * rise
    time = np.linspace(0, end, 400)
    x = np.clip(time / rise, 0, 1)
    hauls = speed * x * x * (3 - 2 * x)
    scene = fu.Scene(gravity=(0, 0, 0))
    _guided(scene, "haul", 1.0, -R, -waves.NEAR, velocity=fu.TableSignal(time=time, value=-hauls))
    _guided(scene, "load", 1e5, R, -waves.FAR)
    scene.force("load", value=(0, -waves.TENSION, 0))
    over_one(scene, R, ("haul", "load"), elements=(4, 20), tension=waves.TENSION,
             given=rope_of(EA, waves.DENSITY, 0, 1e-6))
    run = scene.run(end, output_step=end / 300, tol=1e-5, integrator="radau", progress=False)
    pull = np.linalg.norm(run["rope.end_force"], axis=1) - waves.TENSION
    half = (EA * waves.DENSITY) ** 0.5 * speed  # the full rise is twice rho c v, as the load stands still
    at = int(np.argmax(pull >= half))
    return {"delay": float(np.interp(half, pull[at - 1 : at + 1], run.time[at - 1 : at + 1])
                           - np.interp(speed / 2, hauls, time))}
