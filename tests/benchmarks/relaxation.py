"""Cost of relaxation by a damped motion: steps, resets of velocities, CPU; beside it the cost of `equilibrium`.

    python tests/benchmarks/relaxation.py [--out FILE.csv] [--repetitions 3]

Last column: the kinetic energy of a run without resets after as many steps, relative to the energy lost by the scene,
with the same integrator and tol = 1e-2. CPU is the minimum of the repetitions. Then `equilibrium` of small
scenes: of a line drawn straight, of two bundled ones with one line, and of a span with adjusted lengths.
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import time
import warnings
from collections.abc import Callable

import funicular as fu
import numpy as np
from table import arguments, few, show

ROPE = fu.Material(youngs_modulus=1e8, poisson_ratio=0.3, density=1000)
THICK, THIN = fu.Circle(radius=0.005), fu.Circle(radius=0.001)



def rope(length: float = 1.3, span: float = 1.0, elements: int = 20, density: float = 1000.0,
         section: fu.Circle = THICK, youngs_modulus: float = 1e8) -> fu.Scene:
    """A slack cable drawn straight, in compression."""
    made = fu.Scene()
    made.cable("rope", start=(0, 0, 0), end=(span, 0, 0), rest_length=length, elements=elements, element="cable12",
               section=section,
               material=ROPE.model_copy(update={"density": density, "youngs_modulus": youngs_modulus}))
    made.pin("rope", s=0)
    made.pin("rope", s=length)
    return made


def thin_rope() -> fu.Scene:
    """A very flexible cable: a catenary."""
    return rope(elements=40, density=7800, section=THIN, youngs_modulus=1e7)


def with_rider(s: float = 0.3, friction: fu.Friction | None = None, **cable: float) -> fu.Scene:
    """A body on a slack cable, near its start."""
    made = rope(length=2.1, span=2.0, elements=15, **cable)
    made.rigid_body("A", mass=1, inertia=(1e-3, 1e-3, 1e-3), position=(s / 2.1 * 2.0, 0, 0))
    made.slide("A", along="rope", s=s, name="trolley", friction=friction)
    return made


def strut(factor: float) -> fu.Scene:
    """A rod clamped at one end, under a multiple of Euler's load."""
    made = fu.Scene(gravity=(0, 0, 0))
    made.cable("rod", start=(0, 0, 0), end=(1, 0, 0), elements=10, element="cable8p",
               section=fu.Rectangle(height=0.01, width=0.01),
               material=fu.Material(youngs_modulus=1e9, poisson_ratio=0.0, density=1000))
    made.clamp("rod", s=0)
    made.force("rod", s=1.0, value=(-factor * np.pi**2 / 4 * 1e9 * 0.01**4 / 12, 0, 0))
    return made


def links(number: int = 5) -> fu.Scene:
    """A chain of bodies released from the horizontal."""
    made = fu.Scene()
    for k in range(number):
        made.rigid_body(f"b{k}", mass=1, inertia=(1e-2, 1e-2, 1e-2), position=(0.2 * k + 0.1, 0, 0))
        made.joint("spherical", (f"b{k}", (-0.1, 0, 0)), (f"b{k - 1}", (0.1, 0, 0)) if k else (0, 0, 0))
    return made


SCENES: dict[str, Callable[[], fu.Scene]] = {
    "slack rope, drawn straight": thin_rope, "stiffer rope": rope,
    "rider on a slack cable": with_rider,
    "the same, with friction": lambda: with_rider(friction=fu.Friction(coefficient=0.3, model="stick")),
    "rod at 1.05 of Euler's load": lambda: strut(1.05), "rod at 1.5": lambda: strut(1.5),
    "chain of 5 links": links, "chain of 20 links": lambda: links(20)}


def least(found: Callable[[], fu.Equilibrium], repetitions: int) -> tuple[float, fu.Equilibrium]:
    """Return the minimum CPU seconds of calls, and the result of the last one."""
    taken = []
    for _ in range(repetitions):
        begin = time.process_time()
        state = found()
        taken.append(time.process_time() - begin)
    return min(taken), state


def left_without_resets(scene: fu.Scene, steps: int, lost: float) -> float:
    """Return the final kinetic energy of a run with about this number of steps, over the energy lost at rest."""
    duration, run = 0.01, None
    while run is None or run.report["steps"] < steps:
        run = scene.run(duration, integrator="genalpha", spectral_radius=0.0, tol=1e-2)
        duration *= 1.5
    return float(run["energy.kinetic"][-1] / lost)


def row(name: str, repetitions: int) -> dict:
    """Return a line of the table."""
    scene = SCENES[name]()
    taken, state = least(scene.relax, repetitions)
    report = state.relaxation
    try:
        static, at_once = least(scene.equilibrium, repetitions)
        points = [key for key in state if key.endswith(".position")]
        apart = max(float(np.abs(state[key] - at_once[key]).max()) for key in points)
        beside = {"equilibrium_ms": 1e3 * static, "apart_m": apart}
    except fu.EquilibriumError:
        beside = {"equilibrium_ms": np.nan, "apart_m": np.nan}
    lost = report.energies[0] - report.energies[-1]
    return {"scene": name, "steps": report.steps, "resets": report.resets, "ms": 1e3 * taken,
            "residual_N": state.residual, **beside, "kinetic_left": left_without_resets(scene, report.steps, lost)}


AT_REST: dict[str, Callable[[], fu.Scene]] = {
    "line of 20 elements": lambda: rope(length=1.1),
    **{name: (lambda name=name: fu.load_scene(name)) for name in ("mooring", "mooring_on_bed", "overhead_span")}}


def at_rest(name: str, repetitions: int) -> dict:
    """Return a line of the table of states of rest."""
    scene = AT_REST[name]()
    taken, state = least(scene.equilibrium, 5 * repetitions)
    return {"scene": name, "unknowns": state.model.n_band + state.model.n_border_dof + state.model.n_extra,
            "iterations": state.iterations, "residual_N": state.residual, "ms": 1e3 * taken}


def main() -> None:
    """Measure and print."""
    options = arguments(__doc__, repetitions=(3, "of every search"))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", fu.FunicularWarning)
        show([row(name, options.repetitions) for name in few(SCENES)], options.out)
        show([at_rest(name, options.repetitions) for name in few(AT_REST)], table="at rest")


if __name__ == "__main__":
    main()
