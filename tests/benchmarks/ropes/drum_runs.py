"""Runs of drums by funicular, for `runs.RUNS`."""

from __future__ import annotations

from math import atan2

import funicular as fu
import numpy as np

from .drums import CORNERS, DAMPING, DENSITY, EA, LOAD, OUT, STORE, rim
from .scenes import GRAVITY, Found, rope_of, swing, weight

RADIUS = 0.4
"""Of the drum, m: the reference has none."""


def drum() -> Found:
    """A drum winds a heavy elastic rope and pays it out, from rest."""
    light, heavy = DENSITY * GRAVITY / EA, 1 + LOAD * GRAVITY / EA
    out = (np.sqrt(heavy**2 + 2 * light * OUT) - heavy) / light  # stress-free, OUT when stretched by its weight
    time = sorted({t for corner in CORNERS for t in corner})
    scene = fu.Scene(gravity=(0, -GRAVITY, 0))
    weight(scene, "load", LOAD, RADIUS, -OUT)
    winch = fu.Drum("winch", at=(0, 0, 0), radius=RADIUS, side="right", length_in_store=STORE,
                    velocity=fu.TableSignal(time=time, value=[rim(t) / RADIUS for t in time], interpolation="linear"))
    scene.rope("rope", route=[winch, fu.Anchor("load")], length=STORE + out, elements=2,
               **rope_of(EA, DENSITY, 0, DAMPING))
    run = scene.run(8.0, output_step=2.0, tol=1e-4, integrator="radau", initial="equilibrium", progress=False)
    found = {}
    for k in range(1, 5):
        found |= {f"load at {2 * k} s": -run["load.position"][k, 1],
                  f"store at {2 * k} s": run["winch.length_in_store"][k] - STORE}
    return found


def hauled() -> Found:
    """A pendulum whose rope a drum hauls in, with a rope of .1 g/m."""
    R, angle, length = 0.25, 0.15, 8.0
    scene = swing(1.0, 50.0, R, 1.0, length, angle).without("counterweight")
    haul = fu.TableSignal(time=[0, 0.5, 6], value=[0, 1 / R, 1 / R], interpolation="linear")
    winch = fu.Drum("winch", at=(0, 0, 0), radius=R, side="right", length_in_store=3.0, velocity=haul)
    scene.rope("rope", route=[winch, fu.Anchor("load")], tension=485.0, elements=1, **rope_of(1e7, 1e-4, 0, 1e-3))
    run = scene.run(5.0, output_step=0.5, tol=1e-5, integrator="radau", progress=False)
    found = {}
    for time in (2, 4, 5):
        foot, load = (np.array(run[name][2 * time])[..., :2] for name in ("rope.position", "load.position"))
        along = load - foot[0]
        found |= {f"angle at {time} s": atan2(along[0], -along[1]),
                  f"tension at {time} s": run["winch.tension"][2 * time]}
    return found
