"""Slack lines drawn straight, brought to equilibrium from no other shape: forces, curvatures and CPU by mesh.

    python tests/benchmarks/slack_lines.py [--out FILE.csv] [--most 1000]

Rows: lazy-wave cables (bare, buoyant, bare, in water, on a bed), two tied ropes, a wire on a bed, ropes on two pins.
References: for the lazy-wave cables another program, converged; for the ropes and the wire the elastic catenary,
without bending. Not stable: EquilibriumError. CPU in ms, of one call; for ropes the minimum of five.
"""

from __future__ import annotations

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import time
import warnings
from dataclasses import dataclass

import funicular as fu
import numpy as np
from table import arguments, show


@dataclass
class LazyWave:
    """Lengths (m) of bare, buoyant and bare part; the buoyant one's diameter (m) and mass (kg/m); anchor (x, z) in m.

    force, curvature: of the hang-off in N, and the largest one in 1/m, by another program.
    """

    lengths: tuple[float, float, float]
    diameter: float
    mass: float
    anchor: tuple[float, float]
    force: float
    curvature: float


LAZY_WAVES = {"80 m": LazyWave((68.114, 50.0, 52.101), 0.290, 59.53, (125, -80), 9320.17, 0.0968),
              "200 m": LazyWave((171.978, 60.0, 121.527), 0.300, 60.85, (205, -200), 25160.0, 0.0832)}
G, WATER, MODULUS = 9.80665, 1025.0, 1e10
AREA, SECOND_MOMENT = 4.69e8 / MODULUS, 1.99e4 / MODULUS
MESHES = {100: (56, 16, 28), 200: (98, 34, 68), 450: (200, 125, 125), 600: (260, 180, 160), 1000: (400, 300, 300)}
"""Elements of the three parts. Of 100 elements the curvature shows where they are: their own error is 0.4 to 1 %."""
PARTS = ("upper", "buoyant", "lower")


def lazy_wave(data: LazyWave, elements: tuple[int, ...], fractions: tuple[float, float] | None = None,
              added_mass: float | None = 1.0, membrane: str = "full", heave: fu.TableSignal | None = None,
              added_mass_form: str = "lagrange") -> fu.Scene:
    """Return the cable, drawn straight from the hang-off to the anchor.

    fractions: of the distance at which its parts are drawn to meet; by default those of their lengths. heave: vertical
    displacement of the hang-off in m.
    """
    scene = fu.Scene(gravity=(0, 0, -G))
    start, end = np.array([5.0, 0, -14]), np.array([data.anchor[0], 0, data.anchor[1]])
    along = (0, *(fractions or np.cumsum(data.lengths)[:2] / sum(data.lengths)), 1)
    points = [start + part * (end - start) for part in along]
    scene.fluid("sea", density=WATER)
    scene.surface("bed", fu.Plane(point=(0, 0, data.anchor[1]), normal=(0, 0, 1)))
    for k, (name, n, length) in enumerate(zip(PARTS, elements, data.lengths, strict=True)):
        diameter, mass = (data.diameter, data.mass) if name == "buoyant" else (0.160, 36.70)
        scene.cable(name, start=points[k], end=points[k + 1], rest_length=length, elements=n, element="cable12",
                    strain="engineering", membrane=membrane, rest="straight",
                    section=fu.GeneralSection(area=AREA, second_moment_about_y=SECOND_MOMENT,
                                              second_moment_about_z=SECOND_MOMENT),
                    material=fu.Material(youngs_modulus=MODULUS, poisson_ratio=0.3, density=mass / AREA))
        scene.drag(name, normal=1.2, tangential=0.1, diameter=diameter, displaced_area=np.pi / 4 * diameter**2,
                   added_mass=added_mass, added_mass_form=added_mass_form if added_mass is not None else "lagrange")
        if name != "buoyant":
            scene.contact(name, "bed", stiffness=1e5 * diameter, radius=1e-6, damping=1.0)
    if heave is None:
        scene.pin("upper", s=0)
    else:
        scene.motion("upper", s=0, displacement=(0, 0, heave))
    scene.pin("lower", s=data.lengths[2])
    scene.tie("upper", s=data.lengths[0], to="buoyant", at=0)
    scene.tie("buoyant", s=data.lengths[1], to="lower", at=0)
    return scene


def largest_curvature(rest: fu.Equilibrium) -> float:
    """Return the largest curvature of all cables, 1/m, at four places per element."""
    return max(float(np.abs(rest.section_forces(cable, s=cable.divided(4))["curvature"]).max())
               for cable in rest.scene.cables.values())


def tied_ropes(elements: int) -> fu.Scene:
    """Return two tied ropes of 70 m, each drawn along 50 m, between pins 100 m apart."""
    scene = fu.Scene(gravity=(0, 0, -9.81))
    for name, x in (("a", 0), ("b", 50)):
        scene.cable(name, start=(x, 0, 0), end=(x + 50, 0, 0), rest_length=70, elements=elements, element="cable12",
                    section=fu.Circle(radius=0.05),
                    material=fu.Material(youngs_modulus=1e9, poisson_ratio=0.3, density=5000))
    scene.pin("a", s=0)
    scene.pin("b", s=70)
    scene.tie("a", s=70, to="b", at=0)
    return scene


def wire_on_bed(elements: int, bending: float = 2500.0, density: float = 900.0, anchor: float = -80.0,
                membrane: str = "reduced") -> fu.Scene:
    """Return a wire of 330 m from a pin to an anchor on a bed, 300 m aside and 80 m below; bending: EI in N m²."""
    scene = fu.Scene(gravity=(0, 0, -G))
    moment = bending / MODULUS
    scene.cable("wire", start=(0, 0, 0), end=(300, 0, anchor), rest_length=330, elements=elements, element="cable12",
                section=fu.GeneralSection(area=0.08, second_moment_about_z=moment, second_moment_about_y=moment),
                material=fu.Material(youngs_modulus=MODULUS, poisson_ratio=0.3, density=density), strain="engineering",
                membrane=membrane)
    scene.pin("wire", s=0)
    scene.pin("wire", s=330)
    scene.surface("bed", fu.Plane(point=(0, 0, -80), normal=(0, 0, 1)))
    scene.contact("wire", "bed", stiffness=1.5e5, radius=1e-6)
    return scene


def rope(elements: int, length: float = 60.0) -> fu.Scene:
    """Return a rope between two pins 50 m apart."""
    scene = fu.Scene(gravity=(0, 0, -9.81))
    scene.cable("rope", start=(0, 0, 0), end=(50, 0, 0), rest_length=length, elements=elements, element="cable12",
                section=fu.Circle(radius=0.01),
                material=fu.Material(youngs_modulus=1e11, poisson_ratio=0.3, density=7850))
    scene.pin("rope", s=0)
    scene.pin("rope", s=length)
    return scene


def solved(scene: fu.Scene, repetitions: int = 1) -> tuple[fu.Equilibrium | None, float]:
    """Return the equilibrium, None without one, and the minimum CPU time in ms of some calls."""
    least, rest = np.inf, None
    for _ in range(repetitions):
        begin = time.process_time()
        try:
            rest = scene.equilibrium()
        except fu.EquilibriumError:
            rest = None
        least = min(least, time.process_time() - begin)
    return rest, 1e3 * least


def row(name: str, elements: int, scene: fu.Scene, reference: float, repetitions: int = 1,
        curvature: float | None = None) -> dict:
    """Return a row of the table: force at the start of the first cable, and errors."""
    rest, cpu = solved(scene, repetitions)
    force = np.nan if rest is None else float(np.linalg.norm(rest[f"{next(iter(scene.cables))}@0.force"]))
    kappa = np.nan if rest is None or curvature is None else largest_curvature(rest)
    return {"line": name, "elements": elements, "stable": rest is not None and rest.stable, "force, N": f"{force:.2f}",
            "off": force / reference - 1, "curvature, 1/m": "" if curvature is None else f"{kappa:.5f}",
            "off ": "" if curvature is None else f"{kappa / curvature - 1:.2g}", "CPU, ms": cpu}


def main() -> None:
    """Print the table."""
    given = arguments(__doc__, most=(1000, "elements of a line, at most"))
    warnings.simplefilter("ignore", fu.FunicularWarning)
    rope(10).equilibrium()  # imports
    rows = [row(f"lazy wave, {name}", n, lazy_wave(data, mesh), data.force, curvature=data.curvature)
            for name, data in LAZY_WAVES.items() for n, mesh in MESHES.items() if n <= given.most]
    rows += [row("two tied ropes", 2 * n, tied_ropes(n), 29953.453) for n in (50, 150) if 2 * n <= given.most]
    rows += [row("wire on a bed", n, wire_on_bed(n), 129058.17) for n in (20, 45, 100) if n <= given.most]
    rows += [row("rope", n, rope(n), 921.58, repetitions=5) for n in (10, 20, 40)]
    show(rows, given.out)


if __name__ == "__main__":
    main()
