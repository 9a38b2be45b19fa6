"""Riders: nearly massless and very heavy, faster than waves of the cable, far from the origin; those of the paper."""

from functools import cache

import numpy as np
from funicular import Circle

from .case import BALANCE, CONVERGED, HELD, Subject, figures, positions, simulate
from .crossings import pinned_rope, ride, rider

HERE = Subject()
DENSITY = 4200 * np.pi * 0.0282**2
"""Mass of the paper's cable, kg/m."""


@cache
def reference(ratio: float):
    """Return the converged motion of a rider with a multiple of the cable's mass."""
    return simulate(weighing(ratio), 0.6, **CONVERGED)


def weighing(ratio: float):
    return rider(0.25, 1.0, mass=ratio * 1.5 * DENSITY, elements=3)


def of_mass(ratio: float):
    def measure(integrator):
        return figures(simulate(weighing(ratio), 0.6, integrator=integrator), reference(ratio))

    return measure


for ratio in (1e-9, 1e-6, 1e2, 1e4):
    HERE.case(f"a rider of {ratio:g} times the cable's mass", error=3e-4, balance=BALANCE, residual=HELD,
              gap=HELD)(of_mass(ratio))


@HERE.case("a rider at twice the wave speed of the cable",
           error={"genalpha": 1.5e-3, "energy": 3e-4, "explicit": 1e-8, "radau": 1e-6}, balance=BALANCE,
           residual=HELD, gap=HELD, mach=(2, 2.1))
def faster_than_waves(integrator):
    """A taut rope, c = sqrt(T / ρA); `mach`: least speed of the rider over c. The rider, pushed down, is the only load.
    """
    area = np.pi * 5e-3**2
    c = np.sqrt(0.05 * 0.4e9 * area / (4200 * area / 1.05))

    def scene():
        made = pinned_rope(gravity=(0, 0, 0), elements=12, rest_length=1.5 / 1.05,
                           section=Circle(radius=5e-3))
        ride(made, 0.03, 2.02 * c)
        made.force("A", value=(0, -50, 0))
        return made

    run, exact = (simulate(scene(), 1.2 / (2 * c), **settings) for settings in ({"integrator": integrator}, CONVERGED))
    return figures(run, exact) | {"mach": float(run["A.velocity"][:, 0].min() / c)}


@cache
def at_the_origin(integrator: str):
    return simulate(rider(0.25, 1.0, elements=3), 0.6, integrator=integrator)


def far(distance: float):
    def measure(integrator):
        """`apart`: distance from the motion at the origin, m."""
        scene = rider(0.25, 1.0, elements=3, start=(distance, -distance, distance),
                      end=(distance + 1.5, -distance, distance))
        run = simulate(scene, 0.6, integrator=integrator)
        near = at_the_origin(integrator)
        moved = positions(run) - positions(run)[0] - positions(near) + positions(near)[0]
        return figures(run) | {"apart": float(np.abs(moved).max())}

    return measure


for distance in (1e2, 1e4):
    HERE.case(f"{distance:g} m from the origin", apart=1e-5, balance=BALANCE, residual=HELD, gap=HELD)(far(distance))
