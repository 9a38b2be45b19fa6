"""CPU time of a run beside its steps, by part: the scene, its checks, the model, the engine, the start, the results.

    python tests/benchmarks/setup.py [--out FILE.csv] [--repetitions 15]

CPU ms on one core, the minimum of alternating repetitions, since other load only adds to it. Python calls are those of
Python and C functions by the profiler, after all imports; they do not depend on the machine. `scene`: to make the
scene, no part of a run; `set-up`: the sum from the checks to the start; `another`: of another scene of the same
topology; `results`: from the last step to the `Run`, for 101 output times. `unaccounted`: the share of a run of 1 s at
tol 1e-4 outside the parts of report["time_s"].

The aim: set-up of the first scene within 1.5 ms, unaccounted at most 10 %.
"""

import os

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import cProfile
import gc
import time
from collections.abc import Callable

import funicular as fu
from funicular import Run, Scene, load_scene
from funicular.checks.plausibility import implausible
from funicular.engine import Engine
from funicular.integrators import Integrator
from funicular.model.breakpoints import breakpoints
from funicular.model.build import build
from funicular.model.cables import kept_arrays
from funicular.model.elimination import dense_beside, eliminated
from funicular.model.fewest_operations import ordered
from funicular.model.numbering import numbered_once
from funicular.model.redundant_constraints import drop_redundant_rows
from funicular.parts.settings import RunSettings
from funicular.solve.motion.event_handler import EventHandler
from funicular.solve.motion.integrator_choice import choose
from table import arguments, few, show

SET_UP = ("checks", "model", "engine", "redundant", "choice", "start")
RUN, OUTPUT = 1.0, 0.01
"""Duration and output step, s, of the runs that tell what is unaccounted."""


def rope(elements: int) -> Scene:
    """A rope of many elements, pinned at one end."""
    scene = Scene(gravity=(0, 0, -9.81))
    rope = scene.cable("rope", start=(0, 0, 0), end=(elements / 10, 0, 0), elements=elements, element="cable12",
                       section=fu.Circle(radius=0.01), up=(0, 0, 1),
                       material=fu.Material(youngs_modulus=1e8, poisson_ratio=0.0, density=1000))
    scene.pin(rope, s=0.0)
    return scene


def bodies(number: int, joined: bool = True) -> Scene:
    """Rigid bodies, in a chain of spherical joints from the ground, or loose."""
    scene = Scene(gravity=(0, 0, -9.81))
    for k in range(number):
        scene.rigid_body(f"b{k}", mass=1.0, inertia=(1e-2, 1e-2, 1e-2), position=(k + 0.5, 0, 0))
        if joined:
            before = (f"b{k - 1}", (0.5, 0, 0)) if k else (0, 0, 0)
            scene.joint("spherical", before, (f"b{k}", (-0.5, 0, 0)))
    return scene


SCENES: dict[str, tuple[Callable[[], Scene], bool]] = {
    "first scene": (lambda: load_scene("paper51"), True),
    "cable car": (lambda: load_scene("cable_car"), True),
    "500 elements": (lambda: rope(500), False),
    "2,000 elements": (lambda: rope(2000), False),
    "50 bodies, 50 joints": (lambda: bodies(50), False),
    "200 bodies, 200 joints": (lambda: bodies(200), False),
    "1,000 bodies": (lambda: bodies(1000, joined=False), False),
}
"""How a scene is made, and whether it is run as well."""


class Clock:
    """CPU seconds by part."""

    def __init__(self) -> None:
        self.taken: dict[str, float] = {}
        self._last = time.process_time()

    def lap(self, part: str) -> None:
        """Add the time since the last lap to that of a part."""
        now = time.process_time()
        self.taken[part] = now - self._last
        self._last = now


def forget() -> None:
    """Forget the analysis of topologies and arrays of cables, so that the next scene is the first of its kind."""
    for kept in (eliminated, dense_beside, ordered, numbered_once, kept_arrays):
        kept.cache_clear()


def set_up(make: Callable[[], Scene], clock: Clock | None = None) -> Engine:
    """Return an engine at its first step, set up as by `Scene.run` and `solve.run.simulate`."""
    clock = clock or Clock()
    scene = make()
    clock.lap("scene")
    settings = RunSettings(duration=RUN, output_step=OUTPUT, tol=1e-4)
    scene._check_for(settings)
    clock.lap("checks")
    model = build(scene)
    clock.lap("model")
    engine = Engine(model)
    engine.handle_events(EventHandler(scene, model))
    clock.lap("engine")
    implausible(scene)
    drop_redundant_rows(model, engine)
    clock.lap("redundant")
    method: Integrator = choose(settings, scene, model, engine, None)[0]
    clock.lap("choice")
    engine.start(duration=RUN, output_step=OUTPUT, tol=settings.tol, step=0.0, method=method, first_step=1e-3 * RUN,
                 breakpoints=breakpoints(model, RUN, settings.tol))
    clock.lap("start")
    return engine


def calls(function: Callable[[], object]) -> int:
    """Return the number of calls of Python and C functions within a call, without those of garbage collection."""
    profile = cProfile.Profile()
    gc.disable()
    try:
        profile.enable()
        function()
        profile.disable()
    finally:
        gc.enable()
    return sum(entry.callcount for entry in profile.getstats())


def calls_of(scene: Scene) -> int:
    """Return the number of calls that set up a run of a scene."""
    return calls(lambda: set_up(lambda: scene))


def run(make: Callable[[], Scene]) -> tuple[Run, float]:
    """Return a run of the scene, and the ms of its results after the last step."""
    made = make().run(RUN, output_step=OUTPUT, tol=1e-4, progress=False)
    return made, 1e3 * made.report["time_s"]["results"]


def unaccounted(made: Run) -> float:
    """Return the share of a run's wall time outside the parts of its report."""
    parts = {name: seconds for name, seconds in made.report["time_s"].items() if name != "solve_cpu"}
    total = parts.pop("total")
    return 1.0 - sum(parts.values()) / total


def main() -> None:
    """Measure and print."""
    options = arguments(__doc__, repetitions=(15, "of each scene; a fifth of them for the large ones"))
    scenes = dict(few(SCENES.items()))
    taken: dict[str, list[dict[str, float]]] = {name: [] for name in scenes}
    again: dict[str, list[float]] = {name: [] for name in scenes}
    left: dict[str, list[tuple[float, float]]] = {name: [] for name in scenes}
    for turn in range(-1, options.repetitions):
        for name, (make, runs) in scenes.items():
            if not runs and turn % 5 != 4 and turn >= 0:
                continue
            clock, another = Clock(), Clock()
            forget()
            set_up(make, clock)
            taken[name].append(clock.taken)
            set_up(make, another)
            again[name].append(sum(another.taken[part] for part in SET_UP))
            if runs:
                made, results = run(make)
                left[name].append((results, unaccounted(made)))
    rows: list[dict] = []
    for name, (make, _) in scenes.items():
        least = {part: 1e3 * min(one[part] for one in taken[name]) for part in ("scene", *SET_UP)}
        results, part = (min(each) for each in zip(*left[name], strict=True)) if left[name] else ("", "")
        rows.append({"name": name, **least, "set-up": sum(least[each] for each in SET_UP),
                     "another": 1e3 * min(again[name]), "results": results,
                     "unaccounted": part, "calls": calls_of(make())})
    show(rows, options.out)


if __name__ == "__main__":
    main()
