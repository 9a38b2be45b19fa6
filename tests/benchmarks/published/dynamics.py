"""Motions: S1, D0, D1 and D3."""

from __future__ import annotations

from functools import cache
from math import pi, sqrt

import numpy as np
from funicular import Circle, GeneralSection, Material, Rectangle, Scene, TableSignal
from sliding import sliding_mass

from .case import CABLES, KINDS, MEMBRANES, STRUCTURAL, Case, Kind, Quantity

CUBIC = [kind for kind in CABLES if kind.element in ("cable12", "cable8p")]

# --- S1: a body slides along a cable ----------------------------------------------------------------------------------

RIDER = {3: (1.32524954, -0.00608859), 6: (1.32457683, -0.00619614), 12: (1.32487172, -0.00613117)}
"""By number of cubic elements: position of the body after a second, engineering strain."""


def rider_quantities(kind: Kind, elements: int) -> list[Quantity]:
    """Relative to the travel along the cable, and to the sag under the body."""
    x, y = RIDER[elements if kind in CUBIC else 12]
    return [Quantity("x of the body", "m", x, 1.075), Quantity("y of the body", "m", y, 0.0223)]


def rider(kind: Kind, elements: int) -> np.ndarray:
    """Position of the body after a second."""
    scene = sliding_mass(elements, kind.element, law=kind.law)
    return scene.run(1.0, tol=1e-6, output_step=1.0)["A.position"][-1, :2]


# --- D0: a heavy rope swings ------------------------------------------------------------------------------------------

ROPE = {"green": (-0.937770, -0.093219), "engineering": (-0.9086540, 0.0005923)}
"""End of the rope after a second, of 8 cubic elements."""
FINE = {"cable18": 16}
"""Elements that stand for the limit, 64 of the others."""


def rope_end(kind: Kind, elements: int, duration: float, tol: float, outputs: int) -> np.ndarray:
    """(outputs, 2): the end of the rope."""
    scene = Scene()
    rope = scene.cable("rope", start=(0, 0, 0), end=(1, 0, 0), elements=elements, element=kind.element, law=kind.law,
                       section=Rectangle(height=0.02, width=0.02),
                       material=Material(youngs_modulus=2e6, poisson_ratio=0, density=7200))
    scene.pin(rope, s=0)
    return scene.run(duration, tol=tol, output_step=duration / outputs)["rope.nodal_vectors"][1:, -1, 0, :2]


def swing(kind: Kind, elements: int) -> np.ndarray:
    """End of the rope after a second."""
    return rope_end(kind, elements, 1.0, 1e-6, 1)[-1]


def swing_quantities(kind: Kind, elements: int) -> list[Quantity]:
    """Relative to the length."""
    x, y = ROPE["green" if kind.is_green else "engineering"]
    return [Quantity("x of the end", "m", x, 1.0), Quantity("y of the end", "m", y, 1.0)]


@cache
def half_swing(kind: Kind, elements: int) -> np.ndarray:
    """The first half second, before the growth of mesh errors."""
    return rope_end(kind, elements, 0.5, 1e-5, 50)


def mesh_error(kind: Kind, elements: int) -> tuple[float]:
    """Return the root mean square of the end's distance to a fine mesh."""
    apart = half_swing(kind, elements) - half_swing(kind, FINE.get(kind.element, 64))
    return (np.sqrt(np.mean(np.sum(apart**2, axis=1))),)


# --- D1: a rubber rod swings ------------------------------------------------------------------------------------------

RUBBER = {0.2: (0.942, -0.198), 0.4: (0.476, -0.842), 0.6: (-0.655, -0.697), 1.0: (-0.940, -0.099)}
"""By time in s: the end of the rod."""
NEARLY_HALF = 0.499
"""Poisson's ratio of rubber; at 0.5 the continuum is incompressible, which its law cannot be."""


def rubber_quantities(kind: Kind, elements: int) -> list[Quantity]:
    """Relative to the length."""
    return [Quantity(f"{axis} at {time:g} s", "m", value, 1.0) for time, end in RUBBER.items()
            for axis, value in zip("xy", end, strict=True)]


def rubber(kind: Kind, elements: int) -> np.ndarray:
    """The end of the rod at the times."""
    scene = Scene()
    rod = scene.cable("rod", start=(0, 0, 0), end=(1, 0, 0), elements=elements, element=kind.element, law=kind.law,
                      section=Circle(radius=0.005),
                      material=Material(youngs_modulus=5e6, poisson_ratio=NEARLY_HALF, density=1100))
    scene.pin(rod, s=0)
    run = scene.run(1.0, tol=1e-5, output_step=0.2)
    rows = [int(np.argmin(np.abs(run.time - time))) for time in RUBBER]
    return run["rod.nodal_vectors"][rows, -1, 0, :2].ravel()


# --- D3: spin-up ------------------------------------------------------------------------------------------------------

SPEED, RISE = 6.0, 15.0  # rad/s, s
EXTENSION, LAG, LAG_TIME = 5.143175e-4, -0.573, 6.76
SETTLING = 0.1
"""Retardation in s, which stops what still vibrates and does nothing to the steady state."""


def angle(time: np.ndarray) -> np.ndarray:
    """Return the angle of the clamped end in rad."""
    rising = SPEED / RISE * (time**2 / 2 + (RISE / 2 / pi) ** 2 * (np.cos(2 * pi * time / RISE) - 1))
    return np.where(time < RISE, rising, SPEED * time - SPEED * RISE / 2)


def turning(time_step=0.05, end=31.0) -> TableSignal:
    """Return the angle as a cubic spline, to 2e-8, past the end of a run, since a table is constant after its last
    value.
    """
    time = np.arange(0, end + time_step / 2, time_step)
    return TableSignal(time=time, value=angle(time))


def spin_up(kind: Kind, elements: int, duration: float, step: float,
            damping_time: float) -> tuple[np.ndarray, np.ndarray]:
    """Return times, and the end of the blade (time, 2) in axes that rotate with the clamped one, less its place at
    rest.
    """
    length, area, gyration = 10.0, 0.01, sqrt(5e-4)  # of the section: EI/EA and ρI/ρA agree on it
    height = gyration * sqrt(12)
    section = Rectangle(height=height, width=area / height)
    if kind.law == "structural":
        section = Rectangle(height=height, width=area / height, shear_factors=(1, 1))
    elif kind.is_cable:
        section = GeneralSection(area=area, second_moment_about_z=area * gyration**2)
    scene = Scene(gravity=(0, 0, 0))
    scene.cable("blade", start=(0, 0, 0), end=(length, 0, 0), elements=elements, element=kind.element, law=kind.law,
                section=section, material=Material(youngs_modulus=2.8e7 / area, shear_modulus=1e7 / area,
                                                   density=1.2 / area, damping_time=damping_time))
    scene.motion("blade", s=0, displacement=(0, 0, 0), rotation=((0, 0, 1), turning()))
    run = scene.run(duration, step=step, output_step=0.02)
    x, y = run["blade.nodal_vectors"][:, -1, 0, :2].T
    cos, sin = np.cos(angle(run.time)), np.sin(angle(run.time))
    return run.time, np.stack([cos * x + sin * y - length, cos * y - sin * x], axis=1)


def lag(kind: Kind, elements: int) -> tuple[float, float]:
    """Return the largest lag behind the clamped end, and its time."""
    time, end = spin_up(kind, elements, 10.0, 5e-3, 0.0)
    k = int(np.argmin(end[:, 1]))
    return end[k, 1], time[k]


def extension(kind: Kind, elements: int) -> tuple[float]:
    """Return the steady extension at constant speed."""
    _, end = spin_up(kind, elements, 30.0, 2.5e-3, SETTLING)
    return (end[-1, 0],)


LOCKS = "locks in bending; its sides cannot move freely"
OTHER_MESH = "the reference is of 12 cubic elements"
NARROWS = "the held section cannot narrow"
HELD_SLOPE = "a motion holds the length of r_x: order 1"

S1 = [
    Case(f"S1, {n} elements", "a body slides along a cable", "two independent formulations, 1e-8", rider_quantities,
         rider, n, [kind for kind in CABLES if not kind.is_green and (n == 12 or kind in CUBIC)],
         own_elements={"cable18": 6}, notes={"cable18": OTHER_MESH}) for n in (3, 12)
]
D0 = Case("D0", "rope pendulum", "two independent formulations", swing_quantities, swing, 8, CUBIC)
D0_MESH = Case(
    "D0 mesh", "rope pendulum, first half second", "a fine mesh of its own",
    lambda kind, elements: [Quantity("distance of the end", "m", 0.0, 1.0)], mesh_error, 16,
    CABLES + MEMBRANES + STRUCTURAL, own_elements={"cable18": 4}, ordered=CABLES + MEMBRANES + STRUCTURAL)
D1 = Case("D1", "rubber pendulum", "several codes, 1 % of the length", rubber_quantities, rubber, 16, KINDS,
          notes={"continuum": LOCKS, "poisson_split": LOCKS})
D3_LAG = Case("D3 lag", "spin-up, largest lag", "several codes",
              lambda kind, elements: [Quantity("lag", "m", LAG), Quantity("time", "s", LAG_TIME)], lag, 8, KINDS,
              notes={"continuum": LOCKS, "poisson_split": LOCKS})
D3_STEADY = Case("D3 steady", "spin-up, steady extension", "closed form",
                 lambda kind, elements: [Quantity("extension", "m", EXTENSION)], extension, 8, KINDS,
                 notes={str(kind): HELD_SLOPE for kind in CABLES + MEMBRANES}
                 | {"poisson_split": NARROWS, "continuum": NARROWS})

CASES = [*S1, D0, D0_MESH, D1, D3_LAG, D3_STEADY]
