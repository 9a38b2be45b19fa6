"""Cables of several pieces beside closed forms and another program: forces, waves, frequencies.

    python tests/benchmarks/pieces.py [--out FILE.csv] [--elements 40]

Rows: the elongation of a bar of two materials; the waves that the joint of such a bar reflects and transmits; the
frequencies of a stepped cantilever (transfer matrices of Euler and Bernoulli); two ropes in line under gravity (elastic
catenary by pieces, without bending); the frequencies of a string with a bead in its middle; a lazy-wave cable in water
from one cable (another program, converged). CPU in s.
"""

from __future__ import annotations

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import time
import warnings
from collections.abc import Callable
from itertools import pairwise

import funicular as fu
import numpy as np
from scipy.optimize import brentq, root
from slack_lines import AREA, LAZY_WAVES, MESHES, MODULUS, SECOND_MOMENT, WATER, G
from table import arguments, show

SECTION = fu.Circle(radius=0.01)
LENGTHS = 4.0, 6.0
STIFF, SOFT = (fu.Material(youngs_modulus=E, poisson_ratio=0.3, density=density) for E, density in ((4e9, 3000),
                                                                                                  (1e9, 2000)))


def law_of(element: str) -> dict[str, str]:
    """Return the law in which the cases are compared."""
    return {"strain": "engineering"} if element.startswith("cable") else {"law": "structural"}


def bar(element: str, elements: int) -> fu.Scene:
    """Return a straight bar of a soft and a stiff piece, held at its end."""
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.cable("bar", start=(0, 0, 0), end=(sum(LENGTHS), 0, 0), element=element, rest="straight", **law_of(element),
                pieces=[fu.Piece(length=length, section=SECTION, material=material, elements=elements)
                        for length, material in zip(LENGTHS, (SOFT, STIFF), strict=True)])
    scene.pin("bar", s=sum(LENGTHS))
    return scene


def elongation(element: str, elements: int) -> tuple[float, float]:
    """Return the elongation of the bar under a force, and its closed form, m."""
    scene, force = bar(element, elements), 1e3
    scene.force("bar", s=0, value=(-force, 0, 0))
    rest = scene.equilibrium()
    closed = sum(force * length / (material.youngs_modulus * SECTION.area)
                 for length, material in zip(LENGTHS, (SOFT, STIFF), strict=True))
    return -float(rest["bar.position"][0, 0]), closed


def waves(element: str, elements: int) -> list[tuple[float, float]]:
    """Return the tension of the reflected and of the transmitted wave over that of the arriving one, and each closed
    form, by the impedances sqrt(E rho).
    """
    scene, force = bar(element, elements), 10.0
    speed = np.sqrt(SOFT.youngs_modulus / SOFT.density)
    scene.force("bar", s=0, value=(force, 0, 0), scale=fu.Pulse(start=0.0, end=2.0 / speed))
    at = (LENGTHS[0] + 2.5) / speed  # both waves have left the joint
    run = scene.run(duration=at, tol=1e-5, output_step=at)
    soft, stiff = (np.sqrt(each.youngs_modulus * each.density) for each in (SOFT, STIFF))
    reflected = (stiff - soft) / (stiff + soft)
    tension = [float(-run.section_forces("bar", s=np.linspace(*ends, 501))["tension"][-1].min()) / force
               for ends in ((0.0, LENGTHS[0] - 0.01), (LENGTHS[0] + 0.01, sum(LENGTHS)))]
    return list(zip(tension, (reflected, 1 + reflected), strict=True))


def cantilever(element: str, elements: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the lowest three frequencies of a stepped cantilever, thick and thin, and their closed form, Hz."""
    radii, lengths, material = (0.01, 0.006), (0.6, 0.9), SOFT
    scene = fu.Scene(gravity=(0, 0, 0))
    sections = [fu.Circle(radius=radius) for radius in radii]
    scene.cable("beam", start=(0, 0, 0), end=(sum(lengths), 0, 0), element=element, **law_of(element),
                pieces=[fu.Piece(length=length, section=section, material=material, elements=elements)
                        for length, section in zip(lengths, sections, strict=True)])
    scene.clamp("beam", s=0)

    def across(omega: float) -> float:
        state = np.eye(4)[:, 2:]  # displacement, slope, moment, shear at the clamp
        for section, length in zip(sections, lengths, strict=True):
            EI = material.youngs_modulus * section.second_moment_about_z
            k = (omega**2 * material.density * section.area / EI) ** 0.25
            c, s, ch, sh = np.cos(k * length), np.sin(k * length), np.cosh(k * length), np.sinh(k * length)
            a, b, d, e = (ch + c) / 2, (sh + s) / 2 / k, (ch - c) / 2 / k**2, (sh - s) / 2 / k**3
            by = np.array([[a, b, d / EI, e / EI], [k**4 * e, a, b / EI, d / EI],
                           [k**4 * EI * d, k**4 * EI * e, a, b], [k**4 * EI * b, k**4 * EI * d, k**4 * e, a]])
            state = by @ state
        return float(np.linalg.det(state[2:]))

    grid = 2 * np.pi * np.geomspace(0.3, 60, 600)
    found = [brentq(across, low, high) for low, high in pairwise(grid)
             if across(low) * across(high) < 0]
    frequencies = np.asarray(scene.modes(6).frequency)
    return frequencies[:: 1 if scene.dim == 2 else 2][:3], np.array(found[:3]) / (2 * np.pi)


ROPES = (40.0, 1e5, 5.0), (50.0, 1e6, 20.0)
"""Length (m), EA (N) and weight (N/m) of two ropes in line."""
SPAN = 80.0, -10.0
"""From one end to the other, along and up, m."""


def two_ropes(element: str, elements: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the force of two ropes in line on their support, along and up, and that of the catenary by pieces, N.

    They have no bending stiffness.
    """
    area, weight = 1e-4, 9.81
    scene = fu.Scene(gravity=(0, -weight, 0))
    section = fu.GeneralSection(area=area, second_moment_about_z=0.0)
    scene.cable("ropes", start=(0, 0, 0), end=(*SPAN, 0), element=element, strain="engineering", rest="straight",
                membrane="reduced", pieces=[
                    fu.Piece(length=length, section=section, elements=elements, material=fu.Material(
                        youngs_modulus=EA / area, poisson_ratio=0.3, density=w / weight / area))
                    for length, EA, w in ROPES])
    scene.pin("ropes", s=0)
    scene.pin("ropes", s=sum(length for length, *_ in ROPES))

    def gap(force: np.ndarray) -> np.ndarray:
        H, V = force
        x = y = 0.0
        for length, EA, w in ROPES:
            end = V - w * length
            x += H * length / EA + H / w * (np.arcsinh(V / H) - np.arcsinh(end / H))
            y -= (V**2 - end**2) / (2 * EA * w) + (np.hypot(H, V) - np.hypot(H, end)) / w
            V = end
        return np.array([x - SPAN[0], y - SPAN[1]])

    closed = root(gap, [500.0, 500.0], tol=1e-13).x
    force = np.asarray(scene.equilibrium()["ropes@0.force"])[:2]
    return np.abs(force), np.abs(closed)


def bead(element: str, elements: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the lowest three frequencies across a string with a bead in its middle, and their closed form, Hz.

    Where the bead moves, tan(k L/2) = 2 mass of the string/(mass of the bead k L); else k L = 2 pi. A hinge lets the
    string have a kink there.
    """
    span, stretch, area, mass = 2.0, 1e-3, 1e-4, 0.3
    scene = fu.Scene(gravity=(0, 0, 0))
    material = fu.Material(youngs_modulus=1e9, poisson_ratio=0.3, density=1000)
    length = span / (1 + stretch)
    scene.cable("string", start=(0, 0, 0), end=(span, 0, 0), element=element, strain="engineering", pieces=[
        fu.Piece(length=length / 2, elements=elements // 2 or 1, material=material, hinge=hinge,
                 section=fu.GeneralSection(area=area, second_moment_about_z=0.0)) for hinge in (False, True)])
    for s in (0, length):
        scene.pin("string", s=s)
    scene.point_mass("string", s=length / 2, mass=mass)
    tension, per_length = material.youngs_modulus * area * stretch, material.density * area * length / span
    ratio = 2 * per_length * span / mass
    moving = [brentq(lambda a: a * np.sin(a / 2) - ratio * np.cos(a / 2), low, low + np.pi)
              for low in (0.0, 2 * np.pi)]
    closed = np.sort([moving[0], 2 * np.pi, moving[1]]) / span * np.sqrt(tension / per_length) / (2 * np.pi)
    frequencies = np.asarray(scene.modes(6, about=scene.equilibrium()).frequency)
    return frequencies[:: 1 if scene.dim == 2 else 2][:3], closed


def riser(elements: tuple[int, ...], name: str = "80 m") -> fu.Scene:
    """Return a lazy-wave cable of slack_lines.py from one cable, drawn straight."""
    data = LAZY_WAVES[name]
    scene = fu.Scene(gravity=(0, 0, -G))
    scene.fluid("sea", density=WATER)
    scene.surface("bed", fu.Plane(point=(0, 0, data.anchor[1]), normal=(0, 0, 1)))
    section = fu.GeneralSection(area=AREA, second_moment_about_z=SECOND_MOMENT)
    scene.cable("riser", start=(5, 0, -14), end=(data.anchor[0], 0, data.anchor[1]), element="cable12",
                strain="engineering", rest="straight", pieces=[
                    fu.Piece(length=length, section=section, elements=n, material=fu.Material(
                        youngs_modulus=MODULUS, poisson_ratio=0.3, density=mass / AREA))
                    for length, n, mass in zip(data.lengths, elements, (36.70, data.mass, 36.70), strict=True)])
    ends = np.cumsum([0.0, *data.lengths]).tolist()
    for start, stop, diameter in zip(ends, ends[1:], (0.160, data.diameter, 0.160), strict=False):
        scene.drag("riser", start=start, stop=stop, normal=1.2, tangential=0.1, diameter=diameter,
                   displaced_area=np.pi / 4 * diameter**2, added_mass=1.0)
    scene.contact("riser", "bed", stiffness=1e5 * 0.160, radius=1e-6, damping=1.0)
    scene.pin("riser", s=0)
    scene.pin("riser", s=ends[-1])
    return scene


def main() -> None:
    """Print the table."""
    given = arguments(__doc__, elements=(40, "elements of a piece"))
    warnings.simplefilter("ignore", fu.FunicularWarning)
    rows: list[dict] = []

    def add(case: str, of: Callable[[], tuple], *labels: str) -> None:
        begin = time.process_time()
        found = of()
        cpu = time.process_time() - begin
        values = found if isinstance(found, list) else list(zip(*map(np.atleast_1d, found), strict=True))
        rows.extend({"case": f"{case}{label}", "funicular": f"{value:.8g}", "reference": f"{reference:.8g}",
                     "off": value / reference - 1, "CPU, s": cpu}
                    for label, (value, reference) in zip(labels or ("",), values, strict=True))

    for element in ("cable12", "cable18", "beam24", "cable8p", "beam12p"):
        add(f"bar of two materials, {element}: elongation, m", lambda element=element: elongation(element, 4))
    for element in ("cable8p", "beam12p"):
        add(f"bar of two materials, {element}: ", lambda element=element: waves(element, given.elements),
            "reflected wave", "transmitted wave")
    for element in ("cable12", "cable8p"):
        add(f"stepped cantilever, {element}: ", lambda element=element: cantilever(element, given.elements // 2 or 1),
            *(f"frequency {k}, Hz" for k in (1, 2, 3)))
    add("two ropes: force ", lambda: two_ropes("cable8p", given.elements), "along, N", "up, N")
    for element in ("cable12", "cable18", "cable8p"):
        add(f"string with a bead, {element}: ", lambda element=element: bead(element, given.elements),
            *(f"frequency {k}, Hz" for k in (1, 2, 3)))
    data = LAZY_WAVES["80 m"]
    add("lazy wave, 80 m, one cable: hang-off force, N", lambda: (float(np.linalg.norm(
        riser(MESHES[200]).equilibrium()["riser@0.force"])), data.force))
    show(rows, given.out)


if __name__ == "__main__":
    main()
