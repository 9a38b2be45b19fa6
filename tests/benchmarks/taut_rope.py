"""A taut rope with a rider, by the representation of the axial strain (`membrane`): tension beside the rider,
positions, order in the mesh, and the cost of force and tangent.

    python tests/benchmarks/taut_rope.py [--out FILE.csv] [--elements 96]

First the rope of the zip line, nearly without bending stiffness, with 84 kg at rest on a node, at 0.3 of an element or
in the middle of one. The reference is a closed form: two elastic catenaries that meet under the load. `tension` is the
largest deviation of the tension, by the elastic law, on the rider's element and its two neighbours; `at nodes` the same
at nodes alone; both relative to the local tension of the reference. `position` is the largest deviation of a point of
the rope in m, `rider` that of the rider; orders are from half the elements. `force` is that of the pin. Neither cubic
nor quintic elements can represent the kink under a point force: positions are of the first order with any law.

Then the zip line itself, with its rider in motion: lowest and highest tension in kN on the three elements about the
rider at t = 10 s, the mean and the largest range over the last 2 s, relative to the tension; steps and CPU time.

Then the motions of a straight element without membrane energy, beside the rigid ones, by the modes with stiffness. The
reduced strain has 1 % of it on mode 2.
"""

from __future__ import annotations

import os

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from dataclasses import dataclass
from importlib import resources
from itertools import product
from math import asinh, hypot
from time import process_time

import numpy as np
from funicular import GeneralSection, Material, Scene
from funicular.generated import described, kernels
from funicular.kernels.elements import manifest
from funicular.results.section_forces.forces import of_run
from funicular.scene.file import loads
from scipy.optimize import fsolve
from table import arguments, few, show

LENGTH, SPAN, DROP = 120.4, 120.0, 12.0
EA, WEIGHT, LOAD, GRAVITY = 7.2e6, 6.1, 84 * 9.81, 9.81
PLACE = 0.375
"""Of the rope's length: the element that the rider stands on begins here, or next to it."""
PARTS = {"node": 0.0, "0.3": 0.3, "middle": 0.5}
MEMBRANES = ("full", "assumed", "reduced")
LAWS = [law + kind for law in ("green_exact", "green_linear", "engineering_exact") for kind in ("", "_assumed")]


@dataclass(frozen=True)
class Catenaries:
    """The rope without bending stiffness: the force (H, V) on its start, along x and up, and the position of the load.
    """

    H: float
    V: float
    at: float

    @classmethod
    def under(cls, at: float) -> Catenaries:
        """In equilibrium under the load."""
        def gap(force):
            return cls(*force, at).position(LENGTH) - (SPAN, -DROP)

        tension = EA * (hypot(SPAN, DROP) / LENGTH - 1)
        force = fsolve(gap, (-tension, tension * DROP / SPAN + (WEIGHT * LENGTH + LOAD) / 2), xtol=1e-13)
        if np.abs(gap(force)).max() > 1e-9 * LENGTH:
            raise RuntimeError(f"no equilibrium found: {gap(force)} m are left")
        return cls(*force, at)

    def internal(self, s: float, after: bool = True) -> tuple[float, float]:
        """Return the force on the part before s, along x and up."""
        return -self.H, -self.V + WEIGHT * s + LOAD * (s > self.at or (after and s == self.at))

    def tension(self, s: float, after: bool) -> float:
        """Return the tension at s, at the load on the side after or before it."""
        return hypot(*self.internal(s, after))

    def position(self, s: float) -> np.ndarray:
        """Return x and y at s from the start: of each part x' = (1/EA + 1/T) H, y' = (1/EA + 1/T) V(s)."""
        x, y = 0.0, 0.0
        for begin, end in ((0.0, min(s, self.at)), (self.at, s)):
            if end <= begin:
                continue
            H, first = self.internal(begin)
            last = first + WEIGHT * (end - begin)
            x += H * (end - begin) / EA + H / WEIGHT * (asinh(last / H) - asinh(first / H))
            y += (last**2 - first**2) / (2 * EA * WEIGHT) + (hypot(H, last) - hypot(H, first)) / WEIGHT
        return np.array([x, y])


def rope(elements: int, membrane: str, element: str = "cable8p") -> Scene:
    """Between its pins."""
    area = 7.2e-5
    scene = Scene(gravity=(0, -GRAVITY, 0))
    scene.cable("rope", start=(0, 0, 0), end=(SPAN, -DROP, 0), rest_length=LENGTH, elements=elements, element=element,
                strain="engineering", membrane=membrane, section=GeneralSection(area=area, second_moment_about_z=1e-13),
                material=Material(youngs_modulus=EA / area, poisson_ratio=0, density=WEIGHT / GRAVITY / area))
    scene.pin("rope", s=0)
    scene.pin("rope", s=LENGTH)
    return scene


def at_rest(elements: int, membrane: str, part: float, element: str = "cable8p") -> dict[str, float]:
    """Return the errors with the rider at a share of an element."""
    length, first = LENGTH / elements, round(PLACE * elements)
    at = (first + part) * length
    scene, true = rope(elements, membrane, element), Catenaries.under(at)
    scene.force("rope", s=at, value=(0, -LOAD, 0))
    rest = scene.equilibrium()
    near = length * (first - 1 + np.linspace(0, 3, 61))
    inside = near[(np.abs(near - at) > 1e-9 * LENGTH) & (np.abs(near / length - np.round(near / length)) > 1e-9)]
    nodes = length * (first - 1 + np.arange(4))
    nodes = nodes[np.abs(nodes - at) > 1e-9 * LENGTH]

    def deviation(places: np.ndarray) -> float:
        found = rest.section_forces("rope", s=places, method="constitutive").tension.values
        return max(abs(T / true.tension(s, s > at) - 1) for T, s in zip(found, places, strict=True))

    points = np.linspace(0, LENGTH, 4 * elements + 1)
    positions = {s: np.linalg.norm(point(rest, s) - true.position(s)) for s in [*points, at]}
    return {"tension": deviation(inside), "at nodes": deviation(nodes), "position": max(positions.values()),
            "rider": positions[at], "force": abs(abs(rest["rope@0.force"][0]) / abs(true.H) - 1)}


def point(rest, s: float) -> np.ndarray:
    """Return x and y of the rope at s."""
    cable, vectors = rest.scene.cables["rope"], rest["rope.nodal_vectors"]
    length = cable.length / cable.elements
    first = min(int(s / length * (1 + 1e-12)), cable.elements - 1)
    e = vectors[first : first + 2, :, :2].reshape(2 * vectors.shape[1], 2)
    return getattr(kernels, f"{cable.element}_on_axis")(length, s - first * length)[0] @ e


def in_motion(elements: int, membrane: str, duration: float = 10.0) -> dict[str, float]:
    """The zip line."""
    text = (resources.files("funicular.scenes") / "zip_line.toml").read_text(encoding="utf-8")
    scene = loads(text.replace("elements = 24", f'elements = {elements}\nmembrane = "{membrane}"'), "zip_line")
    begin = process_time()
    run = scene.run(duration, tol=1e-4, output_step=0.05, progress=False)
    seconds, cable = process_time() - begin, scene.cables["rope"]
    length, last = cable.length / elements, slice(-41, None)
    first = np.clip(run["wheels.s"][last] // length, 1, elements - 2) - 1
    places = length * (first[:, None] + np.linspace(0.01, 2.99, 31))
    found = of_run(run, "rope", places, last, method="constitutive")["tension"]
    ranges = np.ptp(found, axis=1) / np.mean(found, axis=1)
    return {"lowest kN": np.min(found[-1]) / 1e3, "highest kN": np.max(found[-1]) / 1e3, "mean range": ranges.mean(),
            "largest range": ranges.max(), "steps": run.report["steps"], "CPU s": seconds}


def motions_without_energy(stiffness: list[float]) -> int:
    """Return the number of axial motions of a straight element without energy, except its translation, by stiffnesses
    of its modes.
    """
    places, weights = np.polynomial.legendre.leggauss(4)
    K = np.zeros((4, 4))
    for m, share in enumerate(stiffness):
        P = np.polynomial.legendre.Legendre.basis(m)(places)
        mode = sum(w * p * kernels.cable8p_on_axis(1.0, (1 + x) / 2)[1]
                   for x, w, p in zip(places, weights, P, strict=True)) * (2 * m + 1) / 2
        K += share * np.outer(mode, mode) / (2 * m + 1)
    return int(np.sum(np.linalg.eigvalsh(K) < 1e-12)) - 1


def main() -> None:
    """Measure and print."""
    options = arguments(__doc__, elements=(96, "of the finest mesh", 12))
    meshes = [n for n in (6, 12, 24, 48, 96, 192) if n <= options.elements]
    rows = []
    for element, part, membrane in few(product(("cable8p", "cable18"), PARTS, MEMBRANES)):
        before = None
        for elements in meshes:
            found = at_rest(elements, membrane, PARTS[part], element)
            orders = {f"order {name}": "" if before is None else f"{np.log2(before[name] / found[name]):.1f}"
                      for name in ("position", "rider")}
            rows.append({"element": element, "rider at": part, "membrane": membrane, "elements": elements, **found,
                         **orders})
            before = found
    show(rows, options.out, "rest")
    print()
    show([{"membrane": membrane, "elements": elements, **in_motion(elements, membrane)}
          for elements in meshes if elements >= 12 for membrane in few(MEMBRANES)], table="motion")
    print()
    modes = {"0": [1], "0..1": [1, 1], "0..1, and 1 % of 2 (reduced)": [1, 1, 0.01], "0..2 (assumed)": [1, 1, 1]}
    show([{"modes": name, "motions without energy": motions_without_energy(stiffness)}
          for name, stiffness in modes.items()], table="modes")
    print()
    show([operations(element, law) for element in ("cable8p", "cable12") for law in LAWS], table="operations")


def operations(element: str, law: str) -> dict[str, object]:
    """Return arithmetic operations per call; kernels.py has the times."""
    every = described(manifest())
    return {"element": element, "law": law} | {
        kernel: sum(every[f"{element}_{law}_{kernel}"]["operations"].values())
        for kernel in ("elastic_force", "elastic_tangent", "discrete_force")}


if __name__ == "__main__":
    main()
