"""Hanging ropes: B11."""

from __future__ import annotations

from math import hypot, pi, sqrt

import numpy as np
from funicular import Circle, Material, Scene

from .case import KINDS, Case, Kind, Quantity

DIAMETER = 1e-4
"""In m: bending moves H by some (DIAMETER / 1 mm)² 1e-7 of it, the digits printed are some 1e-9."""

GRAVITY = 9.81


def catenary(kind: Kind, elements: int, weight: float, axial: float, length: float, span: float, drop: float):
    """Return the horizontal force, and the sag at mid-span, of the elastic catenary.

    weight in N/m, axial stiffness in N, undeformed length, span and drop in m. It is drawn as a parabola of that
    length.
    """
    area = pi * DIAMETER**2 / 4
    scene = Scene(gravity=(0, -GRAVITY, 0))
    u, sag = np.linspace(0, 1, 41), sqrt(3 / 8 * span * (length - hypot(span, drop)))
    points = np.stack([span * u, -drop * u - 4 * sag * u * (1 - u), 0 * u], axis=1)
    scene.cable("rope", points=points, rest="straight", rest_length=length, elements=elements, element=kind.element,
                law=kind.law, section=Circle(radius=DIAMETER / 2),
                material=Material(youngs_modulus=axial / area, poisson_ratio=0, density=weight / GRAVITY / area))
    scene.pin("rope", s=0)
    scene.pin("rope", s=length)
    state = scene.equilibrium(seek_stable=False)  # these elements are too long for the torsion of so thin a beam
    return abs(state["rope@0.force"][0]), -state["rope.position"][elements // 2, 1]


GREEN = "own limit: green strain"
LOCKS = f"{GREEN}; locks a little"
NOTES = {"green_exact": GREEN, "poisson_split": LOCKS, "continuum": LOCKS}

B11_ROPE = Case(
    "B11 level", "elastic catenary, level", "closed form",
    lambda kind, elements: [Quantity("H", "N", 468.5298543), Quantity("sag", "m", 29.2912402998)],
    lambda kind, elements: catenary(kind, elements, 10, 1e6, 120, 100, 0), 64, KINDS, notes=NOTES)

B11_DROP = Case(
    "B11 drop", "elastic catenary, one end 30 m lower", "closed form",
    lambda kind, elements: [Quantity("H", "N", 517.6813139)],
    lambda kind, elements: catenary(kind, elements, 10, 1e6, 120, 100, 30)[:1], 64, KINDS, notes=NOTES)

B11_WIRE = Case(
    "B11 wire", "like a contact wire", "closed form",
    lambda kind, elements: [Quantity("H", "N", 5464.176658), Quantity("sag", "m", 1.0905468631)],
    lambda kind, elements: catenary(kind, elements, 13.2435, 1e7, 60.02, 60, 0), 64, KINDS, notes=NOTES)

CASES = [B11_ROPE, B11_DROP, B11_WIRE]
