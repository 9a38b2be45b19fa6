"""Beams that bend and twist: B5, B6 and B8."""

from __future__ import annotations

from math import cos, pi, radians, sin

import numpy as np
from funicular import Material, Rectangle, Scene
from scipy.optimize import brentq

from .cantilevers import cantilever, tip
from .case import CABLES, SPATIAL_BEAMS, Case, Kind, Quantity

NO_TORSION = "no torsion"
UNEQUAL = "one bending stiffness"

# --- B5: the 45-degree bend -------------------------------------------------------------------------------------------

RADIUS, BEND = 100.0, pi / 4
POLAR, ST_VENANT = 1 / 6, 0.141  # m⁴, torsion constants
BENDS = {
    POLAR: {300: (58.77912, 22.24478, 40.19189), 600: (47.15044, 15.68480, 53.47486)},
    ST_VENANT: {300: (58.54051, 22.11524, 40.47479), 600: (46.89677, 15.56033, 53.60486)},
}
"""By torsion constant and force in N: position of the end."""


def arc(u: float) -> tuple[float, float, float]:
    """Return an arc along x at the origin, curved towards y."""
    return RADIUS * sin(u * BEND), RADIUS * (1 - cos(u * BEND)), 0.0


def bend_quantities(torsion_constant: float):
    """Relative to the radius."""
    return lambda kind, elements: [Quantity(f"{axis} at {force} N", "m", reference, RADIUS) for force, end in
                                   BENDS[torsion_constant].items() for axis, reference in zip("xyz", end, strict=True)]


def bend(torsion_constant: float):
    """Position of the end at each force."""
    def values(kind: Kind, elements: int) -> list[float]:
        constants = {"torsion_constant": torsion_constant, "shear_factors": (5 / 6, 5 / 6)}
        plain = kind.is_cable or kind.law == "continuum"
        section = Rectangle(height=1, width=1, **({} if plain else constants))
        found = []
        for force in BENDS[torsion_constant]:
            scene = cantilever(kind, elements, RADIUS * BEND, section, 1e7, curve=arc)
            found += [*tip(scene, force=(0, 0, force))[0]]
        return found
    return values


# --- B6: the Princeton beam -------------------------------------------------------------------------------------------

PRINCETON = {0: (0.0107136, 0), 30: (0.0101455, 0.0794517), 45: (0.0088874, 0.1090359), 60: (0.0066533, 0.1299171),
             90: (0, 0.1462530)}
"""Degrees between the load and the stiff direction: deflections in m in the stiff and in the slack one."""


def princeton_quantities(kind: Kind, elements: int) -> list[Quantity]:
    """Relative to the largest deflection."""
    scale = PRINCETON[90][1]
    return [Quantity(f"{axis} at {angle} degrees", "m", reference, scale) for angle, pair in PRINCETON.items()
            for axis, reference in zip("yz", pair, strict=True)]


def princeton(kind: Kind, elements: int) -> list[float]:
    """Deflections at each angle."""
    blade, found = Rectangle(height=12.3777e-3, width=3.2024e-3), []
    for angle in map(radians, PRINCETON):
        scene = cantilever(kind, elements, 0.508, blade, 71.7e9, 0.31)
        r, _ = tip(scene, force=(0, -8.896 * cos(angle), 8.896 * sin(angle)))
        found += [*np.abs(r[1:])]
    return found


# --- B8: the right-angle frame ----------------------------------------------------------------------------------------

BUCKLING = 1.088  # N
LOAD_STEP = 0.03
"""Part of the load to both sides where frequencies are told from rounding, which the stiff height makes coarse."""


def frame(kind: Kind, elements: int, force: float) -> Scene:
    """Return two blades, stiff in their plane; the force on the end is along the clamped one, away from the clamp."""
    leg = 0.24
    scene = Scene(gravity=(0, 0, 0))
    same = {"elements": elements // 2, "element": kind.element, "law": kind.law,
            "section": Rectangle(height=0.03, width=0.0006),
            "material": Material(youngs_modulus=7.124e10, poisson_ratio=0.31, density=2700)}
    scene.cable("clamped", start=(0, 0, 0), end=(leg, 0, 0), **same)
    scene.cable("free", start=(leg, 0, 0), end=(leg, -leg, 0), up=(1, 0, 0), **same)
    scene.clamp("clamped", s=0)
    scene.tie("clamped", s=leg, to="free", at=0)
    scene.force("free", s=leg, value=(force, 0, 0))
    return scene


def lowest_square(scene: Scene) -> float:
    """Return the lowest squared angular frequency about equilibrium, negative if unstable."""
    modes = scene.modes(1, about=scene.equilibrium(seek_stable=False))  # on the branch that stays in its plane
    return float(modes.angular_frequency[0] ** 2 - modes.growth_rate[0] ** 2)


def buckling(kind: Kind, elements: int) -> tuple[float]:
    """Return the load at which the lowest squared frequency passes through zero."""
    def square(force: float) -> float:
        return lowest_square(frame(kind, elements, force))

    rough = brentq(square, 0.9, 4.0, rtol=LOAD_STEP)
    around = rough * (1 + LOAD_STEP * np.array([-2, -1, 1, 2]))
    through = np.polynomial.Polynomial.fit(around, [square(force) for force in around], 3)
    return (brentq(through, around[0], around[-1]),)


POISSON = "Poisson locking, and J of a section that stays plane"
PLANE = "J of a section that stays plane"
TURNED = [kind for kind in CABLES if kind.element == "cable12"]
BLADES_CANNOT = {"cable12": f"{NO_TORSION}, {UNEQUAL}", "cable18": f"{NO_TORSION}, {UNEQUAL}",
                 "cable8p": "planar", "beam12p": "planar"}

B5 = [
    Case(f"B5 J = {name}", "45-degree bend, force out of its plane", "two independent formulations, converged",
         bend_quantities(constant), bend(constant), 16, TURNED + SPATIAL_BEAMS,
         own_elements={"poisson_split": 32, "continuum": 32},
         notes={"cable12": NO_TORSION} | ({} if constant == POLAR else {"continuum": PLANE}),
         cannot={"cable18": f"{NO_TORSION}, straight at rest", "cable8p": "planar", "beam12p": "planar"})
    for constant, name in ((POLAR, "1/6"), (ST_VENANT, "0.141"))
]

B6 = Case("B6", "Princeton beam", "two independent formulations, converged; experiment by Dowell and Traybar",
          princeton_quantities, princeton, 16, SPATIAL_BEAMS, notes={"continuum": POISSON}, cannot=BLADES_CANNOT)

B8 = Case("B8", "right-angle frame, buckling", "several codes",
          lambda kind, elements: [Quantity("buckling load", "N", BUCKLING)], buckling, 16, SPATIAL_BEAMS,
          notes={"continuum": POISSON}, cannot=BLADES_CANNOT)

CASES = [*B5, B6, B8]
