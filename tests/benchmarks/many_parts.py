"""Growth of the cost of a step with the number of parts: slides on one cable, nets of bodies, with exponents.

    python tests/benchmarks/many_parts.py [--out FILE.csv] [--repetitions 3] [--steps 100]

slides: riders of 0.3 kg at 1 m/s on a pinned cable with three elements for each; "0.1 ms" are steps with one matrix for
many of them, "1 ms" steps of which most take a new one. net: bodies.py's square of bodies at constant distances.
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
from funicular import Circle, Material, Scene
from funicular.model.build import build
from table import arguments, few, show

ELEMENTS_PER_SLIDE = 3
SPACING = 1.0
"""Distance of slides, m."""
TENSION = 1e-3
"""Strain of the cable as drawn."""


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


CASES: dict[str, tuple[Callable[[int], Scene], float, tuple[int, ...]]] = {
    "slides, 0.1 ms": (slides, 1e-4, (30, 100, 200)), "slides, 1 ms": (slides, 1e-3, (30, 100, 200)),
    "net, 1 ms": (net, 1e-3, (64, 256, 1024))}
"""Scenes with their step in s and numbers of parts."""


def measure(name: str, parts: int, steps: int, repetitions: int) -> dict:
    """Return a row without its exponents."""
    make, step, _ = CASES[name]
    model = build(make(parts))
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
