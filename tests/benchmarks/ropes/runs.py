"""Runs of ropes by funicular, against the reference solutions: `RUNS` by the keys of the cases.

Each function returns some of the quantities of its case by name. Ropes that are massless or inextensible in a case have
here a mass and a stretch so small that their influence is below the bar.
"""

from __future__ import annotations

from collections.abc import Callable
from math import degrees, log, pi

import funicular as fu
import numpy as np

from .drum_runs import drum, hauled
from .loop_runs import elevator, elevator_with_wraps, ropeway, wave
from .scenes import GRAVITY, Found, over_a_peg, over_one, rope_of, swing, weight
from .sliding_runs import held_cylinder, moving_capstan
from .space_runs import fleet, fleet_at_rest


def without_mass(found: Callable[[float], Found], rho: float) -> Found:
    """Return results extrapolated to a rope without mass, from those with a mass of a length and with half of it.

    A lighter rope is no substitute: its transverse vibrations, which nothing damps, are faster.
    """
    heavy, light = found(rho), found(rho / 2)
    return {name: 2 * light[name] - heavy[name] for name in light}


def two_weights() -> Found:
    """Two weights that start from rest: acceleration by the way, with friction above the least one."""
    return without_mass(_two_weights, 1e-3)


def _two_weights(rho: float) -> Found:
    found = {}
    for friction, name in ((0.1, "acceleration"), (0.0, "acceleration without friction")):
        scene = swing(1.0, 1.2, 0.22, 2.0, 2.0, 0.0)
        turning = {"inertia": 0.90, "friction": fu.Friction(coefficient=friction, model="stick")} if friction else {}
        over_one(scene, 0.22, ("counterweight", "load"), elements=1, tension=10.7, given=rope_of(1e7, rho, 0, 1e-3),
                 **turning)
        run = scene.run(2.0, output_step=0.5, tol=1e-6, integrator="radau", progress=False)
        way = -run["load.position"][:, 1]
        found[name] = way[4] - 2 * way[2] + way[0]
        if friction:
            light, heavy = run["top.tension_on"][-1], run["top.tension_off"][-1]
            found |= {"light side": light, "heavy side": heavy, "least friction": log(heavy / light) / pi}
    return found


def heavy_rope() -> Found:
    """A heavy rope with two weights on a sheave that it turns."""
    scene = swing(2.0, 2.5, 0.2, 5.0, 5.0, 0.0)
    over_one(scene, 0.2, ("counterweight", "load"), elements=2, tension=40.0, given=rope_of(1e7, 0.5, 0, 1e-4),
             inertia=0.1, friction=fu.Friction(coefficient=0.5, model="stick"))
    run = scene.run(2.0, output_step=1.0, tol=1e-5, integrator="radau", progress=False)
    way = run["load.position"][0, 1] - run["load.position"][:, 1]
    return {"way at 1 s": way[1], "way at 2 s": way[2], "light side": run["top.tension_on"][-1],
            "heavy side": run["top.tension_off"][-1], "force on the sheave": -run["top.force"][-1, 1]}


def free_rope() -> Found:
    """A heavy rope without weights, to the instant at which it lifts off."""
    side = 1 - 0.05 * pi
    scene = swing(1e-7, 1e-7, 0.1, side - 0.04, side + 0.04, 0.0)
    over_one(scene, 0.1, ("counterweight", "load"), elements=3, tension=2.0, given=rope_of(1e6, 0.4, 0, 1e-4))
    try:
        scene.run(2.0, output_step=0.5, tol=1e-5, integrator="radau", progress=False)
    except fu.RopeLeftError as error:
        run = error.run
        way = -side - run["load.position"][:, 1]
        light = run["top.tension_on"][-1] < run["top.tension_off"][-1]
        return {"wrap lost at": run.time[-1], "way": way[-1], "side": -1.0 if light else 1.0,
                "rate": float(np.arccosh(way[1] / way[0]) / run.time[1])}
    raise AssertionError("the rope stays on its sheave")


def tackle() -> Found:
    """A load on a block between two falls, and a weight on the haul."""
    return without_mass(_tackle, 2e-4)


def _tackle(rho: float) -> Found:
    R, M, m, J = 0.12, 400.0, 230.0, 0.08
    scene = fu.Scene(gravity=(0, -GRAVITY, 0))
    scene.rigid_body("block", mass=M, inertia=(M,) * 3, position=(0, -10, 0))
    weight(scene, "haul", m, 3 * R, -2)
    of_both = {"radius": R, "inertia": J, "friction": fu.Friction(coefficient=0.5, model="stick")}
    scene.rope("rope", route=[fu.Anchor(at=(-R, 0, 0)), fu.Sheave("lower", at="block", side="left", **of_both),
                              fu.Sheave("upper", at=(2 * R, 0, 0), side="right", **of_both), fu.Anchor("haul")],
               elements=1, tension=2050.0, **rope_of(1e7, rho, 0, 1e-3))
    run = scene.run(2.0, output_step=0.5, tol=1e-6, integrator="radau", progress=False)
    way = run["block.position"][:, 1]
    return {"acceleration": way[4] - 2 * way[2] + way[0], "haul": run["upper.tension_off"][-1],
            "fall to the anchor": run["lower.tension_on"][-1],
            "fall from the fixed sheave": run["upper.tension_on"][-1]}


def swinging_atwood() -> Found:
    """A load that swings on a rope of 0.01 g/m."""
    scene = swing(5.5, 5.0, 0.3, 3.0, 4.0, 0.5)
    over_one(scene, 0.3, ("counterweight", "load"), elements=2, tension=50.0, given=rope_of(1e7, 1e-5, 0, 1e-3))
    run = scene.run(3.0, output_step=1.0, tol=1e-5, integrator="radau", progress=False)
    found = {}
    for k in (1, 2, 3):
        found |= {f"x at {k} s": run["load.position"][k, 0], f"y at {k} s": run["load.position"][k, 1],
                  f"wrap at {k} s": degrees(run["top.wrap_angle"][k])}
    return found


def _swings(run: fu.Run, times: str) -> Found:
    found = {}
    for k, time in enumerate(times.split(), start=1):
        load = run["load.position"][k]
        found |= {f"x at {time} s": load[0], f"y at {time} s": load[1],
                  f"counterweight at {time} s": run["counterweight.position"][k, 1]}
    return found


def heavy_atwood() -> Found:
    """The same on a heavy elastic rope, with 3 elements a span."""
    scene = swing(4.4, 4.0, 0.25, 2.5, 3.0, 0.6)
    over_one(scene, 0.25, ("counterweight", "load"), elements=3, tension=42.0,
             given=rope_of(8e4, 0.3 * (1 + 42 / 8e4), 0, 1e-4))
    return _swings(scene.run(1.5, output_step=0.5, tol=1e-5, integrator="radau", progress=False), ".5 1 1.5")


def bent_atwood() -> Found:
    """The same with bending, 2 elements a span, let go from the state of rest with both ends held."""
    R, angle, free = 0.3, 0.6, 2.0
    given = {"length": (2 * free + R * (pi - angle)) / 1.001, **rope_of(5e4 * 1.001, 0.3 * 1.001, 0.09, 1e-4)}
    free_scene, held = (swing(5.5, 5.0, R, free, free, angle) for _ in range(2))
    for scene in (free_scene, held):
        over_one(scene, R, ("counterweight", "load"), given=given)
    for name, body in held.bodies.items():
        held.joint("weld", body.position, name)
    rest = held.equilibrium()
    start = {name: rest[name] for name in ("rope.coordinates", "counterweight.position", "load.position")}
    return _swings(free_scene.run(1.0, output_step=0.25, tol=1e-5, integrator="radau", progress=False, initial=start),
                   ".25 .5 .75 1")


def run_on() -> Found:
    """A rope with bending, both ends pulled down by 100 N: the wrap ends where contact does."""
    R, T, EI = 0.3, 100.0, 0.09
    far = R + EI / (2 * T * R)
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.rope("rope", route=[fu.Anchor(at=(-far, -4, 0)), fu.Sheave("top", at=(0, 0, 0), radius=R, side="right"),
                              fu.Anchor(at=(far, -4, 0))], elements=2, tension=T, **rope_of(1e6, 0.3, EI))
    rest = scene.equilibrium()
    far = np.abs(rest["rope.position"][:, 0]).max()
    beta = np.arccos(1 - EI / (2 * rest["top.tension_on"] * R**2))
    return {"wrap": degrees(rest["top.wrap_angle"] - 2 * beta), "far line from the axis": far}


def capstan() -> Found:
    """A capstan that turns under a rope whose ends are held."""
    found = {}
    for mu, turns, name in ((0.1, 0, "mu .1 over pi"), (0.3, 0, "mu .3 over pi"), (0.3, 1, "mu .3 over 3 pi")):
        scene = fu.Scene(gravity=(0, 0, 0))
        friction = fu.Friction(coefficient=mu, model="stick")
        turning = fu.TableSignal(time=[0, 0.5, 1], value=[0, -1, -1], interpolation="linear")
        scene.rope("rope", route=[fu.Anchor(at=(-0.2, -2, 0)),
                                  fu.Sheave("top", at=(0, 0, 0), radius=0.2, side="right", turns=turns, zones=4,
                                            friction=friction, velocity=turning), fu.Anchor(at=(0.2, -2, 0))],
                   elements=1, tension=100.0, **rope_of(1e5, 0.1, 0, 1e-3))
        run = scene.run(1.0, output_step=0.5, tol=1e-6, integrator="radau", progress=False)
        found[name] = run["top.tension_on"][-1] / run["top.tension_off"][-1]
    return found


def belt(EI: float = 0.0) -> Found:
    """A belt that drives a loaded pulley, with 8 zones a wrap; EI: its bending, which the reference leaves out."""
    time = np.linspace(0, 2.5, 501)
    x = np.clip((time - 1) / 0.5, 0, 1)
    friction = fu.Friction(coefficient=0.5, model="stick")
    pulley = {"radius": 0.1, "side": "left", "inertia": 0.25, "friction": friction, "zones": 8}
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.rope("belt", closed=True, length=1.1938052, elements=1, route=[
        fu.Sheave("driver", at=(0, 0, 0), velocity=fu.TableSignal(time=[0, 0.05, 0.6, 3], value=[0, 0, 12, 12],
                                                                  interpolation="linear"), **pulley),
        fu.Sheave("driven", at=(0.1 * pi, 0, 0), damping=2.0,
                  torque=fu.TableSignal(time=time, value=-25 * x * x * (3 - 2 * x)), **pulley)],
        **rope_of(7600.0, 0.872421, EI, 1e-3))
    run = scene.run(2.45, output_step=0.05, tol=1e-3, integrator="radau", progress=False)
    turn = run["driven.angle"]
    tight, slack = run["driver.tension_on"][-1], run["driver.tension_off"][-1]
    inertia = 0.872421 * run["driver.material_speed"][-1] ** 2
    presses = [T - inertia * (1 + T / 7600.0) for T in (tight, slack)]
    return {"tight": tight, "slack": slack, "torque": run["driven.torque"][-1],
            "driven": (turn[-1] - turn[-5]) / (run.time[-1] - run.time[-5]),
            "slip arc": degrees(log(presses[0] / presses[1]) / 0.5)}  # over which friction is full


def peg() -> Found:
    """A pendulum on a rope of .05 g/m that meets a peg, leaves it, and meets it again."""
    scene = over_a_peg(5e-5, 1e6, 1e-3)
    run = scene.run(6.0, output_step=0.5, tol=1e-5, integrator="radau", progress=False)
    times = [event["time"] for event in run.events]
    found = dict(zip(("wrap returns", "wrap is lost", "wrap returns again"), times, strict=False))
    for k in (2, 4, 8, 12):
        for axis, value in zip("xy", run["load.position"][k], strict=False):
            found[f"{axis} at {k // 2} s"] = float(value)
    return found


RUNS: dict[str, Callable[[], Found]] = {
    "two weights": two_weights, "heavy rope": heavy_rope, "free rope": free_rope, "tackle": tackle,
    "swinging Atwood": swinging_atwood, "heavy swinging Atwood": heavy_atwood, "bending in motion": bent_atwood,
    "fleet angle": lambda: fleet(1e-5, 1e-5), "fleet angle with mass": lambda: fleet(1e-3, 1e-5),
    "fleet angle at rest": fleet_at_rest, "run-on with bending": run_on, "capstan": capstan,
    "moving capstan": moving_capstan, "held cylinder": held_cylinder, "belt": belt, "elevator": elevator,
    "elevator with wraps": elevator_with_wraps, "ropeway": ropeway, "wave": wave, "drum": drum,
    "pendulum hauled in": hauled, "peg": peg}
