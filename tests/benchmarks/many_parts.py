"""Growth of the cost of a step with the number of parts, with exponents: slides on one cable, nets of bodies, spans of
a catenary, pairs far apart.

    python tests/benchmarks/many_parts.py [--out FILE.csv] [--repetitions 3] [--steps 100]

slides: riders of 0.3 kg at 1 m/s on a pinned cable with three elements for each; "0.1 ms" are steps with one matrix for
many of them, "1 ms" steps of which most take a new one. net: bodies.py's square of bodies at constant distances.
catenary: spans of pantographs.py's 55 m line at rest, in which a force begins to lift the contact wire. far pairs: the
contacts of each of a number of bodies in free flight with each of as many distant spheres; parts: pairs.
Generalised-alpha with a fixed step, one thread. Microseconds of CPU per step and part, the minimum of repetitions;
MB of the engine's arrays. An exponent is that of the number of parts, from the row before: 1 of the time of a step is
a constant time per part.
"""

import os

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from collections.abc import Callable

import numpy as np
from bodies import net, run
from funicular import Circle, Material, Scene, Sphere, catenary
from funicular.model.build import build
from funicular.model.initial_state import InitialState
from funicular.model.model import Model
from pantographs import line55
from table import arguments, few, show

ELEMENTS_PER_SLIDE = 3
SPACING = 1.0
"""Distance of slides, m."""
TENSION = 1e-3
"""Strain of the cable as drawn."""
LIFTED_AT, UPLIFT = 60.0, 100.0
"""Place of the force on the contact wire, m, and the force, N."""


def slides(count: int) -> Scene:
    """Return a stretched cable with riders at equal distances, all of which move along it."""
    scene, length = Scene(), count * SPACING
    rest_length = length / (1 + TENSION)
    scene.cable("wire", start=(0, 0, 0), end=(length, 0, 0), rest_length=rest_length,
                elements=ELEMENTS_PER_SLIDE * count, element="cable12", section=Circle(radius=0.01),
                material=Material(youngs_modulus=1e9, poisson_ratio=0.3, density=2000))
    scene.pin("wire", s=0.0)
    scene.pin("wire", s=rest_length)
    for k in range(count):
        share = (k + 0.5) / count
        scene.rigid_body(f"rider{k}", mass=0.3, inertia=(1e-3, 1e-3, 1e-3), position=(share * length, 0, 0),
                         velocity=(1, 0, 0))
        scene.slide(f"rider{k}", along="wire", s=share * rest_length)
    return scene


def line_of_spans(count: int) -> Scene:
    """Return an overhead line of this number of spans."""
    return catenary.scene(line55(spans=count))


def lifted(count: int) -> Model:
    """Return an overhead line of this number of spans at rest, in which a force begins to lift the contact wire."""
    rest, scene = line_of_spans(count).equilibrium(), line_of_spans(count)
    scene.force("contact", s=LIFTED_AT, value=(0, UPLIFT, 0))
    model = build(scene)
    InitialState(rest).start(model, scene)
    return model


def bodies_and_spheres(count: int, pairs: bool = True) -> Scene:
    """Return bodies in free flight, in contact pairs with each of as many distant spheres."""
    scene = Scene()
    for k in range(count):
        scene.rigid_body(f"body{k}", mass=1.0, inertia=(1e-3,) * 3, position=(0.5 * k, 100 + 0.3 * (k % 7), 0.1 * k),
                         velocity=(0.3, 1, 0))
        scene.surface(f"sphere{k}", Sphere(radius=0.2, at=(0.5 * k, 0, 0)))
    if pairs:
        scene.contact("all", "all", stiffness=1e4, radius=0.05)
    return scene


def far_pairs(count: int) -> Scene:
    """Return a scene with this number of pairs far apart."""
    return bodies_and_spheres(round(count**0.5))


def built(make: Callable[[int], Scene]) -> Callable[[int], Model]:
    """Return the function that makes the model of a scene."""
    return lambda count: build(make(count))


CASES: dict[str, tuple[Callable[[int], Model], float, tuple[int, ...]]] = {
    "slides, 0.1 ms": (built(slides), 1e-4, (30, 100, 200)), "slides, 1 ms": (built(slides), 1e-3, (30, 100, 200)),
    "net, 1 ms": (built(net), 1e-3, (64, 256, 1024)), "catenary, 1 ms": (lifted, 1e-3, (3, 10, 30, 60)),
    "far pairs, 1 ms": (built(far_pairs), 1e-3, (100, 1600, 10000))}
"""Models with their step in s and numbers of parts."""


def measure(name: str, parts: int, steps: int, repetitions: int) -> dict:
    """Return a row without its exponents."""
    make, step, _ = CASES[name]
    model = make(parts)
    engine, taken = run(model, steps, step)
    for _ in range(repetitions - 1):
        taken = min(taken, run(model, steps, step)[1])
    counts = engine.statistics
    return {"scene": name, "parts": parts, "us_per_step_and_part": 1e6 * taken / counts["steps"] / parts,
            "exponent": "", "iterations_per_step": counts["newton_iterations"] / counts["steps"],
            "factorisations_per_step": counts["factorisations"] / counts["steps"], "MB": engine.memory / 1e6,
            "exponent_of_memory": ""}


def growth(name: str, steps: int, repetitions: int) -> list[dict]:
    """Return the rows of a scene."""
    rows: list[dict] = []
    for parts in few(CASES[name][2]):
        rows.append(measure(name, parts, steps, repetitions))
        if len(rows) > 1:
            before, row = rows[-2:]
            more = np.log(row["parts"] / before["parts"])
            row["exponent"] = 1 + np.log(row["us_per_step_and_part"] / before["us_per_step_and_part"]) / more
            row["exponent_of_memory"] = np.log(row["MB"] / before["MB"]) / more
    return rows


def main() -> None:
    """Measure and print."""
    options = arguments(__doc__, repetitions=(3, "of every run"), steps=(100, "of a run"))
    show([row for name in few(CASES) for row in growth(name, options.steps, options.repetitions)], options.out)


if __name__ == "__main__":
    main()
