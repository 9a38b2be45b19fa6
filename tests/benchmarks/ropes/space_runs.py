"""Runs of ropes in space by funicular; see `ropes.runs`."""

from __future__ import annotations

from math import degrees

import funicular as fu
import numpy as np

from .scenes import GRAVITY, Found, rope_of
from .swings import on_the_line


def fleet(rho: float, tol: float) -> Found:
    """A load that swings out of the plane of the groove, with a rope of 1 element a span and this mass of a length, or
    without mass where that is zero.
    """
    R, at, speed = 0.3, np.array([1.8, -3.2, 0.12]), 0.4
    _, along, _ = on_the_line(R, at)
    scene = fu.Scene(gravity=(0, -GRAVITY, 0))
    scene.rigid_body("counterweight", mass=5.5, inertia=(5.5,) * 3, position=(-R, -3, 0),
                     velocity=(0, speed * along[2], 0))
    scene.rigid_body("load", mass=5.0, inertia=(5.0,) * 3, position=at, velocity=(0, 0, speed))
    scene.rope("rope", element="cable12", elements=1, tension=45.0, route=[
        fu.Anchor("counterweight"), fu.Sheave("top", at=(0, 0, 0), radius=R, side="right", max_fleet_angle=0.2),
        fu.Anchor("load")], **rope_of(1e6, rho, 0, 1e-3) if rho else rope_of(1e8, 1e-5, 0, 1e-3) | {"mass": False})
    run = scene.run(2.0, output_step=0.5, tol=tol, integrator="radau", progress=False)
    found = {}
    for k, time in enumerate((".5", "1", "1.5", "2"), start=1):
        found |= {f"{axis} at {time} s": x for axis, x in zip("xyz", run["load.position"][k], strict=True)}
        found[f"wrap at {time} s"] = degrees(run["top.wrap_angle"][k])
    return found


def at_rest_without_mass() -> fu.Run:
    """Return the first instants of a rope without mass off the plane of the groove, with 100 N."""
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.rope("rope", element="cable12", tension=100.0, mass=False, route=[
        fu.Anchor(at=(-0.3, -0.5, 0)), fu.Sheave("top", at=(0, 0, 0), radius=0.3, side="right", max_fleet_angle=0.2),
        fu.Anchor(at=(0.809249, -0.495093, 0.126487))], **rope_of(1e5, 1e-3, 0))
    return scene.run(1e-3, output_step=1e-3, progress=False)


def fleet_at_rest_without_mass() -> Found:
    """What the case asks of that rope."""
    run = at_rest_without_mass()
    place, wrap = run["rope.position"][0], run["top.wrap_angle"][0]
    foot = place[np.flatnonzero(place[:, 2] > 1e-9)[0] - 1]
    return {"foot": 180 - degrees(wrap), "foot from the axis": float(np.hypot(*foot[:2])),
            "fleet angle": degrees(run["top.fleet_angle_off"][0]),
            "length": 0.3 * wrap + float(np.linalg.norm(place[-1] - foot))}


def fleet_at_rest(elements: int = 2) -> Found:
    """A rope off the plane of the groove, at rest."""
    R, scene = 0.3, fu.Scene(gravity=(0, 0, 0))
    scene.rope("rope", element="cable12", elements=elements, tension=100.0, route=[
        fu.Anchor(at=(-R, -0.5, 0)), fu.Sheave("top", at=(0, 0, 0), radius=R, side="right"),
        fu.Anchor(at=(0.809249, -0.495093, 0.126487))], **rope_of(1e5, 1e-3, 0))
    rest = scene.equilibrium()
    assert rest.stable
    place, wrap = rest["rope.position"], rest["top.wrap_angle"]
    foot = place[np.flatnonzero(place[:, 2] > 1e-9)[0] - 1]
    return {"foot": 180 - degrees(wrap), "foot from the axis": float(np.hypot(*foot[:2])),
            "fleet angle": degrees(rest["top.fleet_angle_off"]),
            "length": R * wrap + float(np.linalg.norm(place[-1] - foot))}
