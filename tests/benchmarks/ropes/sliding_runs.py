"""Runs of ropes that slide over held cylinders, by funicular; see `ropes.runs`."""

from __future__ import annotations

import funicular as fu
import numpy as np
from scipy.integrate import cumulative_simpson

from .scenes import GRAVITY, Found, rope_of, weight

R, DENSITY, SLACK, ACCELERATION, RISE, SPEED = 0.1, 0.5, 30.0, 15.0, 0.1, 6.0
"""Of the moving capstan; its acceleration begins within RISE, s."""


def _smooth(x: np.ndarray) -> np.ndarray:
    y = np.clip(x, 0, 1)
    return y**3 * (10 - 15 * y + 6 * y * y)


def _capstan(speed: float, end: float, damping_time: float, zones: int, output_step: float) -> fu.Run:
    """Return a run in which the tight end is hauled up to a speed; the pull on the slack end makes up for the inertia
    of its side. Raises RopeLeftError.
    """
    mass, before, behind = 1e-3, 4.0, 3.0
    time = np.linspace(0, end, round(end / 5e-4) + 1)
    a = ACCELERATION * (_smooth(time / RISE) - _smooth((time - speed / ACCELERATION) / RISE))
    v = cumulative_simpson(a, x=time, initial=0)
    left = before - cumulative_simpson(v, x=time, initial=0)
    scene = fu.Scene(gravity=(0, 0, 0))
    for name, x, drive in (("slack", -before, {}), ("tight", behind, {"velocity": fu.TableSignal(time=time, value=v)})):
        weight(scene, name, mass, x, R)
        scene.joint("prismatic", (x, R, 0), name, axis=(1, 0, 0), **drive)
    scene.force("slack", value=(-1, 0, 0), scale=fu.TableSignal(time=time, value=SLACK - (mass + DENSITY * left) * a))
    held = fu.Sheave("held", at=(0, 0, 0), radius=R, side="right", turns=1, zones=zones,
                     friction=fu.Friction(coefficient=0.3, velocity=1e-4))
    scene.rope("rope", route=[fu.Anchor("slack"), held, fu.Anchor("tight")], elements=1, tension=SLACK,
               **rope_of(1e7, DENSITY, 0, damping_time))
    return scene.run(end, output_step=output_step, tol=1e-5, integrator="radau", progress=False)


def _tight(damping_time: float, zones: int) -> float:
    """Return the tight side at 6 m/s in acceleration."""
    end = SPEED / ACCELERATION + RISE / 2
    return float(_capstan(2 * SPEED, end, damping_time, zones, end)["held.tension_off"][-1])


def _lost(damping_time: float) -> float:
    """Return the speed at which the slack side leaves the wrap."""
    try:
        _capstan(1.5 * SPEED, 0.8, damping_time, 8, 0.4)
    except fu.RopeLeftError as error:
        return float(error.run["slack.velocity"][-1, 0])
    raise AssertionError("the rope stays on its capstan")


def moving_capstan() -> Found:
    """A capstan from which a rope is hauled, with one turn.

    In acceleration the tension rises with time, so that the rope's damping counts: extrapolated to none. Its inertia on
    the wrap has an error of the square of the zones: extrapolated, too.
    """
    end = SPEED / ACCELERATION + RISE + 0.15
    steady = _capstan(SPEED, end, 1e-3, 16, end)
    tight = _tight(1e-4, 16)
    return {"tight side": steady["held.tension_off"][-1],
            "tight side in acceleration": 2 * tight - _tight(2e-4, 16) + (tight - _tight(1e-4, 8)) / 3,
            "wrap lost above": 2 * _lost(1e-4) - _lost(2e-4)}


def held_on_cylinder(mu: float, zones: int) -> float:
    """Return the longest heavy side that a friction holds, m.

    A heavy rope hangs from a cylinder on one side and is held below it on the other one. The cylinder turns slowly
    towards the side that hangs: then the rope is about to slide to the other one, and the tension there is the weight
    of the longest rope that could hang there.
    """
    radius, light, rho = 0.051, 0.15, 0.5
    turning = fu.TableSignal(time=[0, 0.2, 0.4, 10], value=[0, 0, 0.4, 0.4], interpolation="linear")
    scene = fu.Scene(gravity=(0, -GRAVITY, 0))
    weight(scene, "end", 1e-6, -radius, -light)
    held = fu.Sheave("held", at=(0, 0, 0), radius=radius, side="right", zones=zones, velocity=turning,
                     friction=fu.Friction(coefficient=mu, velocity=1e-4))
    scene.rope("rope", route=[fu.Anchor("end"), held, fu.Anchor(at=(radius, -0.3, 0))], elements=1,
               tension=rho * GRAVITY * light, **rope_of(1e5, rho, 0, 1e-3))
    run = scene.run(1.0, output_step=0.5, tol=1e-5, integrator="radau", progress=False)
    return float(run["held.tension_off"][-1]) / (rho * GRAVITY)


def held_cylinder() -> Found:
    """A heavy rope over a held cylinder, with 16 zones."""
    return {"mu .1 holds to": held_on_cylinder(0.1, 16), "mu .3 holds to": held_on_cylinder(0.3, 16)}
