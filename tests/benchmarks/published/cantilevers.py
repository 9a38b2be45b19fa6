"""Cantilevers in a plane under a force or a moment at the end: B1 to B4."""

from __future__ import annotations

import warnings
from math import cos, pi, sin, sqrt

import numpy as np
from funicular import FunicularWarning, Material, Rectangle, Scene
from funicular.parts.section import Section

from .case import CABLES, KINDS, MEMBRANES, STRUCTURAL, Case, Kind, Quantity


def cantilever(kind: Kind, elements: int, length: float, section: Section, youngs_modulus: float, poisson_ratio=0.0,
               curve=None) -> Scene:
    """Return a cantilever along x, clamped at the origin, without gravity."""
    scene = Scene(gravity=(0, 0, 0))
    drawn = {"start": (0, 0, 0), "end": (length, 0, 0)} if curve is None else {"curve": curve}
    scene.cable("beam", elements=elements, element=kind.element, law=kind.law, section=section, **drawn,
                material=Material(youngs_modulus=youngs_modulus, poisson_ratio=poisson_ratio, density=1000))
    scene.clamp("beam", s=0)
    return scene


def tip(scene: Scene, *, force=None, moment=None) -> tuple[np.ndarray, np.ndarray]:
    """Return position and slope of the free end under loads on it.

    The solutions are planar: in space a deep section would tip over sideways (B3), and a cable leave the plane (B4).
    """
    length = scene.cables["beam"].length
    if force is not None:
        scene.force("beam", s=length, value=force)
    if moment is not None:
        scene.moment("beam", s=length, value=moment)
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "the state is unstable", FunicularWarning)
        state = scene.equilibrium(seek_stable=False)
    return tuple(state["beam.nodal_vectors"][-1, :2])


# --- B1: the elastica -------------------------------------------------------------------------------------------------

ELASTICA = {
    0.5: (0.162143575658, 0.015918962471, 0.244533647133),
    1: (0.301720773800, 0.056433236284, 0.461351949712),
    2: (0.493457480397, 0.160641720825, 0.781749831557),
    5: (0.713791523612, 0.387628360724, 1.215368117610),
    10: (0.810609024880, 0.554995597754, 1.430285538800),
}
"""P L²/EI: w/L, u/L, angle at the end."""

SLENDER = 1e-3
"""Height over length: stretch and shear, which the elastica has not, then are some 1e-6."""


def elastica_quantities(kind: Kind, elements: int) -> list[Quantity]:
    """Lengths relative to that of the beam, angles to one radian."""
    return [Quantity(f"{name} at P L²/EI = {load:g}", unit, reference, 1.0) for load, row in ELASTICA.items()
            for name, unit, reference in zip(("w/L", "u/L", "angle"), ("1", "1", "rad"), row, strict=True)]


def elastica(kind: Kind, elements: int) -> list[float]:
    """Deflection, shortening and angle at each load."""
    section, E = Rectangle(height=SLENDER, width=SLENDER), 1e9
    found = []
    for load in ELASTICA:
        r, slope = tip(cantilever(kind, elements, 1, section, E),
                       force=(0, load * E * section.second_moment_about_z, 0))
        found += [r[1], 1 - r[0], np.arctan2(slope[1], slope[0])]
    return found


# --- B2: the same with stretch ----------------------------------------------------------------------------------------

STRETCHED = {"engineering": (0.508537304326, 1.207239854550), "green": (0.508922870415, 1.208398131108)}
RIGID_IN_SHEAR = 1e4
"""Shear factor: the published limit has no shear."""


def stretched_quantities(kind: Kind, elements: int) -> list[Quantity]:
    """Each relative to the limit of its own formulation; beams have Reissner's strain, the engineering strain."""
    u, w = STRETCHED["green" if kind.is_green else "engineering"]
    return [Quantity("u", "m", u, 2.0), Quantity("w", "m", w, 2.0)]


def stretched(kind: Kind, elements: int) -> tuple[float, float]:
    """Shortening and deflection."""
    height, length, E = 0.1, 2.0, 2.07e11
    factors = {"shear_factors": (RIGID_IN_SHEAR,) * 2} if kind.law == "structural" else {}
    section = Rectangle(height=height, width=height, **factors)
    force = 3 * E * section.second_moment_about_z / length**2
    r, _ = tip(cantilever(kind, elements, length, section, E), force=(0, force, 0))
    return length - r[0], r[1]


# --- B3: stout, with shear --------------------------------------------------------------------------------------------

SMALL_FORCE, LARGE_FORCE = 62500.0, 62.5e6  # N
FORCES = {SMALL_FORCE: [("w", 8.09903382e-4)], LARGE_FORCE: [("u", 0.15097119), ("w", 0.71056873)]}


def stout_scene(kind: Kind, elements: int) -> Scene:
    """A spatial cable has one bending stiffness: its square section has the same second moment."""
    height, width, E = 0.5, 0.1, 2.07e11
    if kind.is_cable and not kind.is_planar:
        height = width = (height**3 * width) ** 0.25
    return cantilever(kind, elements, 2, Rectangle(height=height, width=width), E, 0.3)


def stout_quantities(force: float):
    """Relative to the numbers themselves."""
    return lambda kind, elements: [Quantity(name, "m", reference) for name, reference in FORCES[force]]


def stout(force: float):
    """Shortening (of the large force) and deflection."""
    def values(kind: Kind, elements: int) -> tuple[float, ...]:
        r, _ = tip(stout_scene(kind, elements), force=(0, -force, 0))
        return (2 - r[0], -r[1])[2 - len(FORCES[force]):]
    return values


# --- B4: rolled up ----------------------------------------------------------------------------------------------------

ROLLED = Rectangle(height=0.01, width=0.01)  # of a beam of 1 m


def rolled_quantities(turns: int):
    """The end returns to the start.

    Green strain is combined with a curvature per deformed length, and a moment then stretches: with W = EA (λ² - 1)²/8
    + EI (θ'/λ)²/2 the minimum over λ is at λ² = 1 + 2 M²/(EA EI), with θ' = M λ²/EI.
    """
    def quantities(kind: Kind, elements: int) -> list[Quantity]:
        x = y = 0.0
        if kind.is_green:
            stretch = sqrt(1 + 2 * (2 * pi * turns) ** 2 * ROLLED.second_moment_about_z / ROLLED.area)
            turn = 2 * pi * turns * stretch**2
            x, y = stretch * sin(turn) / turn, stretch * (1 - cos(turn)) / turn
        return [Quantity("x of the end", "m", x, 1.0), Quantity("y of the end", "m", y, 1.0)]
    return quantities


def rolled(turns: int):
    """Position of the end."""
    def values(kind: Kind, elements: int) -> tuple[float, float]:
        E = 1e9
        moment = 2 * pi * turns * E * ROLLED.second_moment_about_z
        r, _ = tip(cantilever(kind, elements, 1, ROLLED, E), moment=(0, 0, moment))
        return r[0], r[1]
    return values


LOCKS = "locks in bending until elements are as short as high"
OWN_SHEAR = "own limit: has shear"
NO_SHEAR = "no shear: Euler-Bernoulli"
POISSON = "Poisson locking: its sides cannot bulge"
FULLY_INTEGRATED = "own limit: St. Venant-Kirchhoff at strains of 14 %"
SLOW_START = "locks a little in stretch where slender; order 6 later"

STOUT_NOTES = {str(kind): NO_SHEAR for kind in CABLES + MEMBRANES} | {"continuum": POISSON}

B1 = Case(
    "B1", "elastica, tip force", "closed form, elliptic integrals", elastica_quantities, elastica, 32, KINDS,
    own_elements={"cable18": 4, "structural": 8}, ordered=KINDS,  # finer, these are at the limit that SLENDER sets
    notes={"poisson_split": LOCKS, "continuum": LOCKS, "cable12": SLOW_START, "cable8p": SLOW_START})

B2 = Case(
    "B2", "tip force, with stretch", "two independent formulations, converged", stretched_quantities, stretched, 16,
    KINDS, own_elements={"cable18": 8, "structural": 8}, ordered=CABLES + MEMBRANES + STRUCTURAL,
    notes={"poisson_split": OWN_SHEAR, "continuum": OWN_SHEAR})

B3_SMALL = Case(
    "B3 small", "stout cantilever, 62.5 kN", "Timoshenko's beam", stout_quantities(SMALL_FORCE), stout(SMALL_FORCE), 16,
    KINDS, own_elements={"structural": 1}, notes=STOUT_NOTES)

B3_LARGE = Case(
    "B3 large", "stout cantilever, 62.5 MN", "Reissner's beam, converged", stout_quantities(LARGE_FORCE),
    stout(LARGE_FORCE), 16, KINDS, own_elements={"structural": 8},
    ordered=STRUCTURAL,  # finer, it is at 1e-6 and goes on with order 2
    notes=STOUT_NOTES | {"poisson_split": FULLY_INTEGRATED})

B4 = [
    Case(f"B4 {word}", f"rolled up {word} by an end moment", "closed form, arc of a circle", rolled_quantities(turns),
         rolled(turns), 16 * turns, KINDS, ordered=KINDS, notes={"poisson_split": LOCKS, "continuum": LOCKS})
    for turns, word in ((1, "once"), (2, "twice"))
]

CASES = [B1, B2, B3_SMALL, B3_LARGE, *B4]
