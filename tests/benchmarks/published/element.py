"""One element's mass and force, and the natural vibrations of a beam: E1 and E2."""

from __future__ import annotations

import numpy as np
from funicular import Material, Rectangle, Scene
from funicular.generated import kernels
from funicular.parts.section_stiffness import section_stiffness

from .case import CABLES, KINDS, MEMBRANES, Case, Kind, Quantity

# --- E1: kernels, since a scene reports neither mass nor force of an element --------------------------------------

STEEL = Material(youngs_modulus=210e9, poisson_ratio=0.3, density=7850)
SQUARE = Rectangle(height=0.1, width=0.1)
MASS = {(0, 0): 29.1571428571429, (0, 1): 4.11190476190476, (0, 4): 10.0928571428571, (0, 5): -2.42976190476190,
        (1, 1): 0.747619047619048, (1, 5): -0.560714285714286, (2, 2): 0.0218055555555556, (2, 6): 0.0109027777777778}
FORCE = (2180.76923076923, 823532.319457014)
"""On node 1 along x and z in N, where node 2 has moved by 1 mm along z."""


def mass_quantities(kind: Kind, elements: int) -> list[Quantity]:
    """Between nodal vectors r, r_x, r_y, r_z of both ends."""
    return [Quantity(f"mass of nodal vectors {i + 1}, {j + 1}", "kg, kg m, kg m²", m) for (i, j), m in MASS.items()]


def mass(kind: Kind, elements: int) -> list[float]:
    """Entries of the mass matrix."""
    m = kernels.beam24_mass(1.0, STEEL.density, SQUARE.moments())
    return [m[entry] for entry in MASS]


def force(kind: Kind, elements: int) -> tuple[float, float]:
    """Return forces of the cable on node 1."""
    e = np.zeros((2, 4, 3))
    e[:, 1:] = np.eye(3)
    e[1, 0] = 1.0, 0.0, 0.001
    S = section_stiffness("poisson_split", SQUARE, STEEL)
    f = kernels.beam24_continuum_elastic_force(1.0, e.reshape(8, 3), kernels.beam24_continuum_stiffness(1.0, S))
    return -f[0, 0], -f[0, 2]


# --- E2: natural frequencies ------------------------------------------------------------------------------------------

LENGTH, SIDE = 2.0, 0.4
POLAR = SIDE**4 / 6
TORSION_CONSTANT = 0.8436 * POLAR
FREQUENCIES = {"bending": (95.63398, 332.23451, 635.69629), "axial": (280.32063,), "torsion": (319.34981,)}
"""rad/s: bending between pins, axial with one end held, torsion with both ends held."""


MODES = 24
"""Enough to hold those of every kind of motion."""


def vibrations(motion: str):
    """Natural angular frequencies of a kind of motion."""
    def values(kind: Kind, elements: int) -> np.ndarray:
        scene = Scene(gravity=(0, 0, 0))
        given = {} if kind.is_cable or kind.law == "continuum" or kind.is_planar else {
            "torsion_constant": TORSION_CONSTANT}
        scene.cable("beam", start=(0, 0, 0), end=(LENGTH, 0, 0), elements=elements, element=kind.element, law=kind.law,
                    section=Rectangle(height=SIDE, width=SIDE, **given),
                    material=Material(youngs_modulus=1e9, poisson_ratio=0.3, density=7850))
        ends = (0, LENGTH)
        if motion == "bending":
            for s in ends:
                scene.pin("beam", s=s)
        else:
            for s in ends[: 2 if motion == "torsion" else 1]:
                scene.clamp("beam", s=s)
        modes = scene.modes(MODES)
        found = modes.angular_frequency[[motion_of(shape, kind) == motion for shape in modes["beam.nodal_vectors"]]]
        both_planes = 2 if motion == "bending" and not kind.is_planar else 1
        return found[::both_planes][: len(FREQUENCIES[motion])]
    return values


def motion_of(shape: np.ndarray, kind: Kind) -> str:
    """Return the dominant component of a mode's shape (nodes, vectors, 3)."""
    twist = shape[:, 2, 2] - shape[:, 3, 1] if not (kind.is_cable or kind.is_planar) else 0.0
    sizes = {"axial": shape[:, 0, 0], "bending": shape[:, 0, 1:], "torsion": SIDE / 4 * twist}
    return max(sizes, key=lambda motion: np.linalg.norm(sizes[motion]))


def vibration_case(motion: str, where: str, notes: dict[str, str], cannot: dict[str, str]) -> Case:
    """One kind of motion of E2."""
    def quantities(kind: Kind, elements: int) -> list[Quantity]:
        return [Quantity(f"{motion} {number}", "rad/s", reference) for number, reference in
                enumerate(FREQUENCIES[motion], start=1)]
    return Case(f"E2 {motion}", f"natural frequencies, {where}", "closed form, Timoshenko's beam", quantities,
                vibrations(motion), 16, [kind for kind in KINDS if kind.element not in cannot], notes=notes,
                cannot=cannot)


SLENDER = "no shear, no rotary inertia: Euler-Bernoulli"
LOCKS = "Poisson locking: its sides cannot bulge"
WIDENS = "own limit: the held section cannot narrow"
LAGS = "own limit: r_z hangs on r_y by the shear of the section"
SOFT = "its upper mode is soft: order 4 in place of 6"
PLANE = "J of a section that stays plane"

E1_MASS = Case("E1 mass", "mass matrix", "several codes", mass_quantities, mass, 1, [Kind("beam24", "continuum")])
E1_FORCE = Case(
    "E1 force", "force of one element", "several codes",
    lambda kind, elements: [Quantity(name, "N", value) for name, value in zip(("x", "z"), FORCE, strict=True)], force,
    1, [Kind("beam24", "poisson_split")])
E2 = [
    vibration_case("bending", "simply supported",
                   {str(kind): SLENDER for kind in CABLES + MEMBRANES} | {"continuum": LOCKS}, {}),
    vibration_case("axial", "fixed and free",
                   {"poisson_split": WIDENS, "continuum": WIDENS, "engineering_exact_reduced": SOFT}, {}),
    vibration_case("torsion", "fixed at both ends", {"continuum": PLANE, "structural": LAGS},
                   {"cable12": "no torsion", "cable18": "no torsion", "cable8p": "planar", "beam12p": "planar"}),
]

CASES = [E1_MASS, E1_FORCE, *E2]
