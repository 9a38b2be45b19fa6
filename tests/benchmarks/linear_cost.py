"""Cost of a step against the number of elements: time, iterations, memory.

    python tests/benchmarks/linear_cost.py [--out FILE.csv] [--plot FILE.png] [--repetitions 3] [--steps 300]

Steps of 20 µs of generalised-alpha, one thread, on cable12 with E = 2 MPa: short enough for the waves of the finest
mesh, so that every mesh has the same iterations per step. A pendulum of 1.5 m released from the horizontal; the same
held at both ends with one and with three riders; three cables joined at a node, with a rider; three joined to a ring; a
ladder, two parallel cables joined at four nodes. Microseconds of CPU per step and element: the minimum of alternating
repetitions. Memory: of the engine's arrays without its recording.

Last, the time of a substitution in the engine and by LAPACK's dpbtrs, on a band of the pendulum's 501 elements.

The aim: with 2,000 elements at most 1.3 times the time per step and element with 100.
"""

import os

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import time
from pathlib import Path

import numpy as np
from funicular import Material, Rectangle, Scene
from funicular.engine import Engine
from funicular.integrators import GeneralisedAlpha
from funicular.model.build import build
from scipy.linalg.lapack import dpbtrf, dpbtrs
from table import few, parser, show

SIZES = (3, 9, 30, 99, 501, 2001)
LENGTH = 1.5
STEP = 2e-5


def cable(made: Scene, name: str, start: tuple, end: tuple, elements: int) -> None:
    """One cable12 of the scene."""
    made.cable(name, start=start, end=end, elements=elements, element="cable12",
               section=Rectangle(height=0.02, width=0.02),
               material=Material(youngs_modulus=2e6, poisson_ratio=0.3, density=1000))


def ride(made: Scene, along: str, count: int) -> None:
    """Riders of the scene, at rest on the x-axis."""
    for k in range(count):
        s = LENGTH * (0.21 + 0.2 * k)
        made.rigid_body(f"rider{k}", mass=0.3, inertia=(1e-3, 1e-3, 1e-3), position=(s, 0, 0))
        made.slide(f"rider{k}", along=along, s=s)


def pendulum(elements: int, riders: int = 0) -> Scene:
    """A horizontal cable, held at its start, and with riders at its end too."""
    made = Scene()
    cable(made, "wire", (0, 0, 0), (LENGTH, 0, 0), elements)
    made.pin("wire", s=0.0)
    if riders:
        made.pin("wire", s=LENGTH)
    ride(made, "wire", riders)
    return made


def joined(elements: int) -> Scene:
    """Three cables of a third of the elements each, held at one end and joined at the other; a rider on the first."""
    made = Scene()
    for name, start in (("a", (0, 0, 0)), ("b", (2, 0, 1)), ("c", (2, 0, -1))):
        cable(made, name, start, (LENGTH, 0, 0), elements // 3)
        made.pin(name, s=0.0)
    for name in "bc":
        made.tie("a", s=LENGTH, to=name, at=made.cables[name].length, rotation="free")
    ride(made, "a", 1)
    return made


def ring(elements: int) -> Scene:
    """Three cables of a third of the elements each, joined to a triangle that a spring holds at a corner."""
    made = Scene()
    corners = ((0, 0, 0), (LENGTH, 0, 0), (0.7, 0, 1.2))
    for k, name in enumerate("abc"):
        cable(made, name, corners[k], corners[(k + 1) % 3], elements // 3)
    for name, to in ("ab", "bc", "ca"):
        made.tie(name, s=made.cables[name].length, to=to, at=0.0, rotation="free")
    made.spring(("a", 0.0), (0, 0.1, 0), stiffness=50.0)
    return made


def ladder(elements: int, rungs: int = 4) -> Scene:
    """Two cables of half the elements each, held at one end, joined at equally spaced nodes up to the other."""
    made, each = Scene(), elements // 2
    for name in "ab":
        cable(made, name, (0, 0, 0), (LENGTH, 0, 0), each)
        made.pin(name, s=0.0)
    for node in sorted({(k + 1) * each // rungs for k in range(rungs)} - {0}):
        made.tie("a", s=LENGTH * node / each, to="b", at=LENGTH * node / each, rotation="free")
    return made


SCENES = {"pendulum": lambda n: pendulum(n), "one rider": lambda n: pendulum(n, 1),
          "three riders": lambda n: pendulum(n, 3), "three cables": joined, "ring": ring, "ladder": ladder}


def scene(name: str, elements: int) -> Scene:
    """Return one of SCENES with a total number of elements."""
    return SCENES[name](elements)


def measure(name: str, elements: int, steps: int) -> dict:
    """One run."""
    engine = Engine(build(scene(name, elements)))
    memory = engine.memory
    duration = steps * STEP
    status, _ = engine.start(duration=duration, output_step=duration, tol=1e-4, step=STEP,
                             method=GeneralisedAlpha(0.8), first_step=STEP)
    begin = time.process_time()
    status = status or engine.advance(lambda _: None)
    taken = time.process_time() - begin
    if status != "completed":
        raise RuntimeError(f"{name} with {elements} elements: {status}")
    counts = engine.statistics
    n = counts["steps"]
    return {"scene": name, "elements": elements, "us_per_step_and_element": 1e6 * taken / n / elements,
            "iterations_per_step": counts["newton_iterations"] / n,
            "factorisations_per_step": counts["factorisations"] / n,
            "ns_per_solve_and_element": 1e9 * counts["time_s"]["solve"] / (n + counts["newton_iterations"]) / elements,
            "kB_per_element": memory / 1e3 / elements}


def lapack_substitution(unknowns: int, width: int, repetitions: int) -> float:
    """Seconds of dpbtrs for one right-hand side."""
    band = np.full((width + 1, unknowns), 0.1)
    band[0] = 2.0 * width
    factor, info = dpbtrf(band, lower=1)
    right, taken = np.ones(unknowns), []
    for _ in range(100 * repetitions):
        begin = time.perf_counter()
        dpbtrs(factor, right, lower=1)
        taken.append(time.perf_counter() - begin)
    assert info == 0
    return min(taken)


def plot(rows: list[dict], file: Path) -> None:
    """Draw time per step and element, and memory, against the number of elements."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(8, 3.6), layout="constrained")
    for axes, key, label in zip(figure.subplots(1, 2), ("us_per_step_and_element", "kB_per_element"),
                                ("µs per step and element", "kB per element"), strict=True):
        for name in SCENES:
            of = [row for row in rows if row["scene"] == name]
            axes.plot([row["elements"] for row in of], [row[key] for row in of], "o-", label=name)
        axes.set(xscale="log", xlabel="elements", ylabel=label, ylim=(0, None))
    axes.legend()
    figure.savefig(file, dpi=130)
    print(f"written: {file}")


def main() -> None:
    """Measure, print, draw."""
    made = parser(__doc__, repetitions=(3, "of every run"), steps=(300, "of a run"))
    made.add_argument("--plot", type=Path, metavar="FILE.png", help="draw time and memory against the elements")
    options = made.parse_args()
    best = {}
    for _ in range(options.repetitions):
        for name in few(SCENES):
            for n in few(SIZES):
                found = measure(name, n, options.steps)
                key = "us_per_step_and_element"
                if (name, n) not in best or found[key] < best[name, n][key]:
                    best[name, n] = found
    rows = list(best.values())
    show(rows, options.out)
    if options.smallest:
        return
    for name in SCENES:
        large, small = (best[name, n]["us_per_step_and_element"] for n in (2001, 99))
        print(f"{name}: 2,001 elements take {large / small:.2f} times as long a step and an element as 99 (aim 1.3)")
    engine = Engine(build(scene("pendulum", 501)))
    print(f"substitution, ns an element: {best['pendulum', 501]['ns_per_solve_and_element']:.0f} in the engine, "
          f"{1e9 * lapack_substitution(*engine.band[:2], options.repetitions) / 501:.0f} by dpbtrs")
    if options.plot:
        plot(rows, options.plot)


if __name__ == "__main__":
    main()
