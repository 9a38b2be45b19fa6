"""Scenes with irrelevant free vibrations, which steps need not follow (tests/benchmarks/ringing.py).

The twisted rods are those of the critical-twist experiment of cosseratbench 0.3.0 (MIT licence), whose parameters are
repeated here: under tension, the far end rotated slowly beyond the critical twist. The pendulum is that of its
hanging-cable experiment, released in its first mode with a uniform stretch instead of that at rest.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import funicular as fu
import numpy as np

CRITICAL = 10.755
"""Moment times length over bending stiffness B at which a rod under a tension of 10 B / L^2 buckles (Greenhill)."""

LEVELS = (0.96, 0.98, 1.00, 1.02, 1.04, 1.06)
"""Twists that the rods are turned to, as parts of the critical one."""


def twisted_rods(levels: tuple[float, ...], elements: int = 25) -> fu.Scene:
    """Rods of 1 m, clamped, with an end under tension that a motion rotates over 6 s; bent by 0.1 mm as drawn."""
    scene = fu.Scene(gravity=(0, 0, 0))
    radius, E = 0.01, 1e6
    bending, x, t = E * np.pi * radius**4 / 4, np.linspace(0, 1, 201), np.linspace(0, 6, 121)
    for k, level in enumerate(levels):
        name, offset = f"rod{k}", 0.25 * k
        scene.cable(name, points=[(a, offset + 5e-5 * (1 - np.cos(2 * np.pi * a)), 0) for a in x], elements=elements,
                    element="beam24", law="structural", section=fu.Circle(radius=radius), up=(0, 0, 1),
                    material=fu.Material(youngs_modulus=E, shear_modulus=E / 3, density=1000))
        end = scene.cables[name].length
        turn = fu.TableSignal(time=tuple(t), value=tuple(level * CRITICAL * 1.5 * (0.5 - 0.5 * np.cos(np.pi * t / 6))))
        scene.clamp(name, s=0.0)
        scene.motion(name, s=end, displacement=("free", 0, 0), rotation=((1, 0, 0), turn))
        scene.force(name, s=end, value=(10 * bending, 0, 0))
    return scene


def hanging_cable(elements: int, youngs_modulus: float = 1e7) -> fu.Scene:
    """A cable of 1 m, stretched and released 2 cm beside its equilibrium: its first mode swings with axial vibrations.
    """
    scene = fu.Scene(gravity=(0, 0, -9.81))
    z = np.linspace(0, 1, 41)  # from the pin down, m; the first mode of a hanging chain is Bessel's J0
    u = 2.404826 * np.sqrt(1 - z)
    mode = np.array([sum((-1) ** k * (v / 2) ** (2 * k) / np.prod(np.arange(1.0, k + 1)) ** 2 for k in range(15))
                     for v in u])
    scene.cable("rod", points=list(zip(0.02 * mode, np.zeros(41), -z * (1 + 9810 / (2 * youngs_modulus)), strict=True)),
                rest="straight", rest_length=1.0, elements=elements, element="cable12",
                section=fu.Circle(radius=0.002), up=(0, 1, 0),
                material=fu.Material(youngs_modulus=youngs_modulus, shear_modulus=youngs_modulus / 3, density=1000))
    scene.pin("rod", s=0.0)
    return scene


@dataclass(frozen=True)
class Ringing:
    """A scene, its duration in s, the cable of the relevant nodes with their axes, its settings, and fixed steps, s."""

    make: Callable[[], fu.Scene]
    duration: float
    cable: str
    settings: dict
    tols: tuple[float, ...]
    axes: tuple[int, ...] = (0, 1, 2)
    steps: tuple[float, ...] = ()


SIDEWAYS = ["rod0.position.y", "rod0.position.z"]
COARSE = (8e-3, 4e-3, 2e-3, 1e-3, 5e-4)
FINE = (2e-3, 1e-3, 5e-4, 2.5e-4, 1.25e-4)
SCENES = {
    "twisted rod, all of its motion": Ringing(lambda: twisted_rods((1.04,)), 0.5, "rod0", {}, (1e-2, 1e-3), steps=FINE),
    "twisted rod, sideways": Ringing(lambda: twisted_rods((1.04,)), 0.5, "rod0", {"quantities": SIDEWAYS}, (1e-2, 1e-3),
                                     (1, 2), COARSE),
    "twisted rod, absolute_tol 1e-5": Ringing(lambda: twisted_rods((1.04,)), 0.5, "rod0", {"absolute_tol": 1e-5},
                                              (1e-3,), steps=COARSE),
    "six twisted rods": Ringing(lambda: twisted_rods(LEVELS), 0.5, "rod0", {}, (1e-3, 1e-5), steps=FINE[2:]),
    "stretched pendulum, 25": Ringing(lambda: hanging_cable(25), 2.0, "rod", {}, (1e-2, 1e-3, 1e-4), steps=COARSE),
    "stretched pendulum, 50": Ringing(lambda: hanging_cable(50), 2.0, "rod", {}, (1e-2, 1e-3), steps=COARSE),
    "softer pendulum, 25": Ringing(lambda: hanging_cable(25, 1e6), 2.0, "rod", {}, (1e-2, 1e-3), steps=COARSE),
}
