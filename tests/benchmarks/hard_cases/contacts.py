"""Contact with surfaces: a cable thrown on the ground, a grazing contact, a ball that chatters to rest."""

from functools import cache

import numpy as np
from funicular import Capsule, Circle, HeightField, Material, Plane, Scene

from .case import CONVERGED, Subject, balance, error, simulate

HERE = Subject()
BALANCE = {"genalpha": 1e-3, "energy": 1e-11, "explicit": 1e-3, "radau": 2e-3}
"""Bounds of the energy balance: the power of friction and damping is integrated by the trapezoidal rule."""
ROPE = {"section": Circle(radius=0.01), "material": Material(youngs_modulus=1e7, poisson_ratio=0.0, density=2000)}


def thrown() -> Scene:
    """A cable that rotates as it falls on hills, and slides on them."""
    scene = Scene()
    scene.cable("wire", start=(0, 0.2, 0), end=(1, 0.3, 0), elements=8, element="cable8p", velocity=(2, -1, 0),
                angular_velocity=(0, 0, -3), **ROPE)
    scene.surface("ground", HeightField.of(lambda x: 0.02 * np.sin(3 * x), np.linspace(-1, 3, 41)))
    scene.contact("wire", "ground", stiffness=2e5, damping=0.3, friction=0.3)
    return scene


@HERE.case("a cable thrown on the ground", balance=BALANCE, deepest=(5.6e-3, 5.8e-3), slow=["energy"])
def on_the_ground(integrator):
    run = simulate(thrown(), 0.5, integrator=integrator, output_step=0.01)
    return {"balance": balance(run), "deepest": float(run["contact_1.penetration"].max())}


def grazing(depth: float) -> Scene:
    """A ball that flies past a capsule and grazes it to a depth of a thousandth of a millimetre."""
    scene = Scene(gravity=(0, 0, 0))
    scene.rigid_body("A", mass=1, inertia=(1e-3,) * 3, position=(-1, 0.11 - depth, 0), velocity=(1, 0, 0))
    scene.surface("bump", Capsule(radius=0.1, length=0.02, axis=(1, 0, 0)))
    scene.contact("A", "bump", radius=0.01, stiffness=1e6)
    return scene


@HERE.case("grazing contact", events=(2, 2), turned=(9.8e-4, 1e-3))
def grazes(integrator):
    run = simulate(grazing(1e-6), 2.0, integrator=integrator, output_step=1.0)
    return {"events": len(run.report["events"]), "turned": float(run["A.velocity"][-1, 1])}


@cache
def bounced():
    """The converged motion of the ball."""
    return simulate(bouncing(), 1.5, output_step=0.05, **CONVERGED)


def bouncing() -> Scene:
    """A ball that bounces more than ten times, until it chatters."""
    scene = Scene()
    scene.rigid_body("ball", mass=0.1, inertia=(1e-4,) * 3, position=(0, 0.25, 0))
    scene.surface("ground", Plane())
    scene.contact("ball", "ground", radius=0.05, stiffness=1e5, exponent=1.5, damping=0.25)
    return scene


@HERE.case("a ball that bounces to rest", error=1e-2, balance=BALANCE)
def bounces(integrator):
    run = simulate(bouncing(), 1.5, integrator=integrator, output_step=0.05, tol=1e-5)
    return {"error": error(run, bounced()), "balance": balance(run)}
