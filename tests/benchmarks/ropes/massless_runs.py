"""Runs of ropes without mass by funicular, against the reference solutions: `RUNS` by the keys of the cases."""

from __future__ import annotations

from collections.abc import Callable
from math import atan2, cos, degrees, log, pi, sin

import funicular as fu
import numpy as np

from .scenes import GRAVITY, Found, over_one, rope_of, swing, weight
from .space_runs import fleet, fleet_at_rest_without_mass

EA = 1e7
"""Of ropes that are inextensible in a case, N."""


def rope(EA: float = EA) -> dict[str, object]:
    """Return section, material and mass of a rope without mass."""
    return rope_of(EA, 1e-5, 0, 1e-3) | {"mass": False}


def two_weights() -> Found:
    """Two weights that start from rest, with a sheave that turns with the rope and with a smooth one."""
    found = {}
    for friction, name in ((0.1, "acceleration"), (0.0, "acceleration without friction")):
        scene = swing(1.0, 1.2, 0.22, 2.0, 2.0, 0.0)
        turning = {"inertia": 0.90, "friction": friction} if friction else {}
        over_one(scene, 0.22, ("counterweight", "load"), tension=10.7, given=rope(), **turning)
        run = scene.run(2.0, output_step=0.5, tol=1e-8, integrator="radau", progress=False)
        way = -run["load.position"][:, 1]
        found[name] = way[4] - 2 * way[2] + way[0]
        if friction:
            light, heavy = run["top.tension_on"][-1], run["top.tension_off"][-1]
            found |= {"light side": light, "heavy side": heavy, "least friction": log(heavy / light) / pi}
    return found


def tackle() -> Found:
    """A load on a block between two falls, and a weight on the haul."""
    R, M, m, J = 0.12, 400.0, 230.0, 0.08
    scene = fu.Scene(gravity=(0, -GRAVITY, 0))
    scene.rigid_body("block", mass=M, inertia=(M,) * 3, position=(0, -10, 0))
    weight(scene, "haul", m, 3 * R, -2)
    of_both = {"radius": R, "inertia": J, "friction": 0.5}
    scene.rope("rope", route=[fu.Anchor(at=(-R, 0, 0)), fu.Sheave("lower", at="block", side="left", **of_both),
                              fu.Sheave("upper", at=(2 * R, 0, 0), side="right", **of_both), fu.Anchor("haul")],
               tension=2050.0, **rope(1e8))
    run = scene.run(2.0, output_step=0.5, tol=1e-7, integrator="radau", progress=False)
    way = run["block.position"][:, 1]
    return {"acceleration": way[4] - 2 * way[2] + way[0], "haul": run["upper.tension_off"][-1],
            "fall to the anchor": run["lower.tension_on"][-1],
            "fall from the fixed sheave": run["upper.tension_on"][-1]}


def atwood(EA: float = EA) -> fu.Scene:
    """Return a load that swings on a rope over a smooth sheave, with a counterweight."""
    scene = swing(5.5, 5.0, 0.3, 3.0, 4.0, 0.5)
    over_one(scene, 0.3, ("counterweight", "load"), tension=50.0, given=rope(EA))
    return scene


def swinging_atwood() -> Found:
    """The load at the times of the case, and the wraps."""
    run = atwood().run(3.0, output_step=1.0, tol=1e-5, integrator="radau", progress=False)
    found = {}
    for k in (1, 2, 3):
        found |= {f"x at {k} s": run["load.position"][k, 0], f"y at {k} s": run["load.position"][k, 1],
                  f"wrap at {k} s": degrees(run["top.wrap_angle"][k])}
    return found


def peg(**given: object) -> Found:
    """A pendulum whose rope meets a peg, leaves it and returns; given: of the rope."""
    scene = fu.Scene(gravity=(0, -GRAVITY, 0))
    weight(scene, "load", 1.0, -2 * sin(0.7), -2 * cos(0.7))
    scene.rope("rope", route=[fu.Anchor(at=(0, 0, 0)), fu.Sheave("peg", at=(0.3, -1, 0), radius=0.1, side="left"),
                              fu.Anchor("load")], tension=5.0, **rope(), **given)
    run = scene.run(6.0, output_step=1.0, tol=1e-6, integrator="radau", progress=False)
    times = [each["time"] for each in run.report["events"]]
    found = dict(zip(("wrap returns", "wrap is lost", "wrap returns again"), times, strict=False))
    for k in (1, 2, 4, 6):
        found |= {f"x at {k} s": run["load.position"][k, 0], f"y at {k} s": run["load.position"][k, 1]}
    return found


def hauled() -> Found:
    """A pendulum whose rope a drum hauls in."""
    R, angle, length = 0.25, 0.15, 8.0
    scene = swing(1.0, 50.0, R, 1.0, length, angle).without("counterweight")
    haul = fu.TableSignal(time=[0, 0.5, 6], value=[0, 1 / R, 1 / R], interpolation="linear")
    winch = fu.Drum("winch", at=(0, 0, 0), radius=R, side="right", length_in_store=3.0, velocity=haul)
    scene.rope("rope", route=[winch, fu.Anchor("load")], tension=485.0, **rope())
    run = scene.run(5.0, output_step=0.5, tol=1e-6, integrator="radau", progress=False)
    found = {}
    for time in (2, 4, 5):
        foot, load = (np.array(run[name][2 * time])[..., :2] for name in ("rope.position", "load.position"))
        along = load - foot[0]
        found |= {f"angle at {time} s": atan2(along[0], -along[1]),
                  f"tension at {time} s": run["winch.tension"][2 * time]}
    return found


RUNS: dict[str, Callable[[], Found]] = {
    "two weights": two_weights, "tackle": tackle, "swinging Atwood": swinging_atwood, "peg": peg,
    "pendulum hauled in": hauled, "fleet angle": lambda: fleet(0.0, 1e-6),
    "fleet angle at rest": fleet_at_rest_without_mass}
