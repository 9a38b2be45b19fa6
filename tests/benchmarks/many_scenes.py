"""Scenes per second: variants of one scene by themselves, by `fu.run_many`, `fu.sweep`, and Exudyn's
ParameterVariation.

    pip install '.[bench]' && python tests/benchmarks/many_scenes.py [--out FILE.csv] [--scenes 200] [--repetitions 3]
        [--theirs 100]

The scenes differ by the mass of the rider, 0.5 to 2 kg. "first scene" is that of README.md; "sliding mass" is the same
with Exudyn's cable, cable12 in funicular, of 3 elements. Each takes a second of motion, at tol 1e-3 in funicular.
Error: the largest distance of the rider from its converged path, over the largest motion, the largest of a few
variants; each code has its own converged path (as in exudyn_side_by_side.py). Exudyn has the fewest steps of a list
within `tol`, and the fewest with the error of funicular.

The time is that of a whole scene: description, checks, model, run, labelled results; in Exudyn description, assembly,
run, and the rider's last position. "wall" is by the clock, "CPU" by that of the process and its children; methods
alternate, and the median counts. CPU is the better figure on a busy machine. "locked" is the part of it in funicular
with Python's lock, which one thread has at a time.
"""

import os

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import resource
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import partial
from itertools import product
from statistics import median

import exudyn_models as peer
import funicular as fu
import numpy as np
from exudyn.processing import ParameterVariation
from funicular.results.trajectories import distance, largest_change
from sliding import sliding_mass
from table import arguments, show

DURATION, OUTPUTS, TOL, ELEMENTS, MODULUS = 1.0, 50, 1e-3, 3, 0.4e9
SAMPLE = (0.5, 1.1, 2.0)
"""Masses of the variants whose error is measured, kg."""
STEPS = (50, 100, 200, 500, 1000, 2000, 4000)
FINEST = (16000, 32000)
"""Steps from which their converged path is extrapolated; its order is 1."""
CONVERGED_TOL = 1e-7
"""The tolerance of our converged path."""
SETTINGS = {"duration": DURATION, "tol": TOL, "output_step": DURATION / OUTPUTS}


def first_scene(mass: float) -> fu.Scene:
    """Return the scene of README.md with another mass."""
    scene = fu.Scene(gravity=(0, -9.81, 0))
    wire = scene.cable("wire", start=(0, 0, 0), end=(1.5, 0, 0), elements=ELEMENTS,
                       section=fu.Rectangle(height=0.05, width=0.05), up=(0, 1, 0),
                       material=fu.Material(youngs_modulus=MODULUS, poisson_ratio=0.0, density=4200))
    scene.pin(wire, s=0.0)
    scene.pin(wire, s=1.5)
    body = scene.rigid_body("A", mass=mass, inertia=(1e-3, 1e-3, 1e-3), position=(0.25, 0, 0), velocity=(1, 0, 0))
    scene.slide(body, along=wire, s=0.25, name="trolley")
    return scene


def their_function(point: dict) -> list[float]:
    """Return the function for ParameterVariation: the rider's last position, m."""
    made = peer.sliding_mass(ELEMENTS, MODULUS, point["mass"])
    return peer.last_position(made, DURATION, point["functionData"]["steps"])


OURS = {"first scene": first_scene,
        "sliding mass": lambda mass: sliding_mass(ELEMENTS, strain="engineering", youngs_modulus=MODULUS, mass=mass)}


@dataclass
class Method:
    """A method to run n scenes, its error, and wall and CPU seconds, a pair per repetition.

    locked: seconds per scene with Python's lock, which one thread has at a time.
    """

    scene: str
    name: str
    n: int
    run: Callable[[], object]
    error: float
    locked: float = np.nan
    times: list[tuple[float, float]] = field(default_factory=list)

    def measure(self) -> None:
        """Run the scenes once."""
        wall, cpu = time.perf_counter(), _cpu()
        self.run()
        self.times.append((time.perf_counter() - wall, _cpu() - cpu))


def _cpu() -> float:
    """Return the CPU seconds of this process and its finished children."""
    children = resource.getrusage(resource.RUSAGE_CHILDREN)
    return time.process_time() + children.ru_utime + children.ru_stime


def masses(n: int) -> list[float]:
    """Return the masses of n variants, kg."""
    return np.linspace(0.5, 2.0, n).tolist()


def variants(make: Callable[[float], fu.Scene], n: int) -> Iterator[fu.Scene]:
    """Describe n scenes, one after the other."""
    return (make(mass) for mass in masses(n))


def our_error(make: Callable[[float], fu.Scene], integrator: str) -> float:
    """Return the largest error of the sample in funicular."""
    def of(mass: float) -> float:
        exact = make(mass).run(**SETTINGS | {"tol": CONVERGED_TOL})["A.position"]
        return distance(make(mass).run(**SETTINGS, integrator=integrator)["A.position"], exact) / largest_change(exact)

    return max(of(mass) for mass in SAMPLE)


def their_errors() -> dict[int, float]:
    """Return the largest error of the sample in Exudyn, by the number of steps."""
    errors = dict.fromkeys(STEPS, 0.0)
    for mass in SAMPLE:
        make = partial(peer.sliding_mass, ELEMENTS, MODULUS, mass)
        coarse, fine = (peer.trajectory(make, DURATION, steps, OUTPUTS) for steps in FINEST)
        exact = 2 * fine - coarse
        for steps in STEPS:
            error = distance(peer.trajectory(make, DURATION, steps, OUTPUTS), exact) / largest_change(exact)
            errors[steps] = max(errors[steps], error)
    return errors


def locked_seconds(make: Callable[[float], fu.Scene], settings: dict) -> float:
    """Return CPU seconds of a scene with Python's lock, all but the integration, the minimum of the sample."""
    found = []
    for mass in SAMPLE:
        begin = time.thread_time()
        run = make(mass).run(**settings)
        found.append(time.thread_time() - begin - run.report["time_s"]["solve_cpu"])
    return min(found)


def our_methods(n: int) -> list[Method]:
    """Return the methods of funicular, by integrator."""
    methods = []
    for (name, make), integrator in product(OURS.items(), ("auto", "genalpha")):
        error, settings = our_error(make, integrator), SETTINGS | {"integrator": integrator}
        locked = locked_seconds(make, settings)
        methods.append(Method(name, f"{integrator}, each by itself", n, lambda make=make, settings=settings: [
            scene.run(**settings) for scene in variants(make, n)], error, locked))
        for workers in (0, 2):
            methods.append(Method(name, f"{integrator}, sweep of A.mass, workers = {workers}", n, partial(
                sweep, make, n, workers, settings), error, locked))
        for threads in (1, 2):
            methods.append(Method(name, f"{integrator}, run_many, threads = {threads}", n, partial(
                run_all, make, n, threads, settings), error, locked))
    return methods


def run_all(make: Callable[[float], fu.Scene], n: int, threads: int, settings: dict) -> None:
    """Run n scenes by run_many; keep the path of the rider of each."""
    for kept in fu.run_many(variants(make, n), threads=threads, keep=["A.position"], **settings):
        assert isinstance(kept, dict), kept


def sweep(make: Callable[[float], fu.Scene], n: int, workers: int, settings: dict) -> None:
    """Run n scenes as the points of a sweep, with workers on threads; keep the path of the rider of each."""
    found = fu.sweep(make(1.0), {"A.mass": masses(n)}, keep=["A.position"], workers=workers, progress=False, **settings)
    assert (found["status"] == "completed").all()


def their_methods(n: int, ours: float) -> list[Method]:
    """Return the methods of Exudyn: for the same tolerance, and for the error of funicular."""
    errors, methods = their_errors(), []
    for allowed in (TOL, ours):
        steps = next((steps for steps in STEPS if errors[steps] <= allowed), STEPS[-1])
        for processes in (1, 2):
            run = partial(ParameterVariation, their_function, {"mass": masses(n)}, useMultiProcessing=processes > 1,
                          numberOfThreads=processes, showProgress=False, parameterFunctionData={"steps": steps})
            methods.append(Method("sliding mass", f"Exudyn, {steps} steps, processes = {processes}", n, run,
                                  errors[steps]))
    return methods


def main() -> None:
    """Measure, print."""
    options = arguments(__doc__, repetitions=(3, "of each method"), scenes=(200, "scenes here"),
                        theirs=(100, "scenes there"))
    ours = our_methods(options.scenes)
    least = min(method.error for method in ours if method.scene == "sliding mass")
    methods = ours + their_methods(options.theirs, least)
    for _ in range(options.repetitions):
        for method in methods:
            method.measure()
    rows = []
    for method in methods:
        wall, cpu = (median(times) for times in zip(*method.times, strict=True))
        rows.append({"scene": method.scene, "method": method.name, "error": method.error,
                     "scenes per s (wall)": method.n / wall, "scenes per CPU s": method.n / cpu,
                     "CPU ms a scene": 1e3 * cpu / method.n, "of them locked": 1e3 * method.locked})
    show(rows, options.out)


if __name__ == "__main__":
    main()
