"""Wires that stay as they are, whatever rides them, for tests against closed forms."""

import numpy as np
from funicular import Material, Rectangle, Scene

G, MASS, LENGTH, SLOPE = 9.81, 2.0, 4.0, 0.5
KIND = {2: "cable8p", 3: "cable12"}


def wire(dim=3, elements=4, length=LENGTH) -> Scene:
    """A straight wire along x that nothing holds: 1e13 kg, which forces of 20 N move by 1e-12 m in a second.

    Clamped instead, it would leave its axial vibrations to resolve; gravity acts on the riders alone, as a load.
    """
    scene = Scene(gravity=(0, 0, 0))
    scene.cable("wire", start=(0, 0, 0), end=(length, 0, 0), elements=elements, element=KIND[dim],
                section=Rectangle(height=0.05, width=0.05),
                material=Material(youngs_modulus=1.0, poisson_ratio=0.0, density=1e15))
    return scene


def block(s, speed=0.0, *, weight=MASS * G, slope=SLOPE, dim=3, scene=None, name="A", slide="trolley",
          **given) -> Scene:
    """A block of MASS on a wire that falls towards its end by `slope`, in rad: its weight is turned, not the wire."""
    scene = scene or wire(dim)
    scene.rigid_body(name, mass=MASS, inertia=(1e-2, 1e-2, 1e-2), position=(s, 0, 0), velocity=(speed, 0, 0))
    scene.slide(name, along="wire", s=s, name=slide, **given)
    if weight:
        scene.force(name, value=(weight * np.sin(slope), -weight * np.cos(slope), 0))
    return scene


def told(run) -> list[str]:
    """What its slides have done."""
    return [event["what"] for event in run.report["events"]]


def unbalanced(run) -> float:
    """Largest part of the energy exchanged that the books miss."""
    return float(np.abs(run.energy_balance().relative).max())
