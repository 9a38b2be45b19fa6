"""Elements of unequal lengths beside equal ones, both chosen for a tolerance: their numbers, true errors and cost.

    python tests/benchmarks/unequal.py

The first scenes are taut cables between clamps, which bend over sqrt(EI/N) beside clamps and force alone; the others
have no such places. Errors are distances from the mesh chosen for the smallest tolerance with every element halved,
over the largest motion; equal elements would need several thousand for that.
"""

from __future__ import annotations

import time
import warnings
from collections.abc import Callable

import funicular as fu
from funicular.choice.motion import motion
from funicular.results.trajectories import distance, largest_change
from model_scenes import crane, robot, rubber_pendulum, shaken, slackline
from table import arguments, few, write

TOLS = (1e-2, 1e-3, 1e-4)
INSTANTS = 25


def swung(radius: float, ramp: fu.Harmonic | fu.Ramp) -> fu.Scene:
    """A cable of 1 m with 0.1 % of strain between two clamps; a force on its middle bends it as ``ramp`` says."""
    scene, length = fu.Scene(), 1 / 1.001
    scene.cable("w", start=(0, 0, 0), end=(1, 0, 0), rest_length=length, element="cable12",
                section=fu.Circle(radius=radius),
                material=fu.Material(youngs_modulus=1e8, poisson_ratio=0.0, density=1000, damping_time=1e-3))
    scene.clamp("w", s=0.0)
    scene.clamp("w", s=length)
    scene.force("w", s=length / 2, value=(0, -3e5 * radius**2, 0), scale=ramp)
    return scene


SLOWLY, AT_ONCE = fu.Harmonic(amplitude=1.0, frequency=2.0), fu.Ramp(start=0.0, end=1e-3)
SCENES: dict[str, tuple[Callable[[], fu.Scene], float, str]] = {
    "clamped, layer 0.03, swung": (lambda: swung(2e-3, SLOWLY), 0.5, "equilibrium"),
    "clamped, layer 0.008, swung": (lambda: swung(5e-4, SLOWLY), 0.5, "equilibrium"),
    "clamped, layer 0.03, struck": (lambda: swung(2e-3, AT_ONCE), 0.1, "equilibrium"),
    "slackline": (slackline, 0.3, "equilibrium"), "rubber pendulum": (rubber_pendulum, 0.5, "drawn"),
    "crane": (crane, 1.0, "drawn"), "robot": (robot, 0.4, "drawn"),
    "shaken rope": (shaken, 0.6, "drawn"),
}


def opened(scene: fu.Scene) -> fu.Scene:
    """The scene without the numbers of elements of its cables."""
    return scene.with_parts(part.remade({"elements": None}) if part.kind == "cable" else part for part in scene.parts())


def main() -> None:
    """Measure and print."""
    options, rows = arguments(__doc__), []
    warnings.simplefilter("ignore")
    columns = "".join(f"  {mesh:>14} {'error':>8} {'CPU s':>6}" for mesh in ("equal", "unequal"))
    print(f"{'scene':28} {'tol':>6}{columns}")
    for name, (make, duration, initial) in few(SCENES.items()):
        scene = opened(make())
        settings = {"output_step": duration / INSTANTS, "initial": initial, "progress": False}
        fine = scene.choose(TOLS[-1], duration=duration, initial=initial, unequal=True).scene
        fine = fine.remeshed(lambda cable: 2 * cable.elements)
        exact = motion(fine, fine.run(duration, tol=1e-5, integrator="radau", **settings))
        for tol in few(TOLS):
            row: dict[str, object] = {"scene": name, "tol": tol}
            line = f"{name:28} {tol:6.0e}"
            for unequal in (False, True):
                choice = scene.choose(tol, duration=duration, initial=initial, unequal=unequal)
                begin = time.process_time()
                run = choice.scene.run(**settings)
                seconds = time.process_time() - begin
                error = distance(motion(choice.scene, run), exact) / largest_change(exact)
                mesh = "+".join(f"{model.elements}{'u' * bool(model.nodes)}" for model in choice.models.values())
                row |= {f"{key}_{'un' * unequal}equal": value
                        for key, value in (("elements", mesh), ("error", error), ("cpu_s", seconds))}
                line += f"  {mesh:>14} {error:8.1e} {seconds:6.3f}"
            rows.append(row)
            print(line, flush=True)
    write(rows, options.out)


if __name__ == "__main__":
    main()
