"""Cost of a step against the number of bodies: chains, trees, ladders and nets of rigid bodies.

    python tests/benchmarks/bodies.py [--out FILE.csv] [--repetitions 3] [--steps 100] [--largest 1000]

Rods of 0.1 m and 0.1 kg, released at rest under gravity; steps of 1 ms of generalised-alpha, one thread.
chain: spherical joints, the first on the ground, horizontal. tree: each rod carries two. ladder: two chains, bodies of
equal number at a constant distance. net: a square of bodies at constant distances, suspended from its first row.
Microseconds of CPU per step: the minimum of repetitions. error: the largest distance of a body from its position with
steps of a quarter of the size, over the largest motion. energy: its change over the exchanged energy. multiplications:
of a factorisation, counted, per body. set-up: seconds from the scene's data to the engine.

The aim: cost in proportion to the bodies for chains and trees, and less than 2 ms a step with 1,000 bodies.
"""

import os

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import time
from collections.abc import Callable

import numpy as np
from funicular import Scene
from funicular.engine import Engine
from funicular.integrators import GeneralisedAlpha
from funicular.model.build import build
from table import few, parser, show

SIZES = (20, 100, 300, 1000)
STEP = 1e-3
LENGTH, MASS, GRAVITY = 0.1, 0.1, 9.81
INERTIA = (1e-4, 1e-4, 1e-4)


def rod(scene: Scene, name: str, start: np.ndarray, along: np.ndarray, on: tuple | None = None) -> np.ndarray:
    """Add a rod in a direction on a spherical joint with the ground or `on`; return its far end."""
    half = LENGTH / 2 * along
    scene.rigid_body(name, mass=MASS, inertia=INERTIA, position=tuple(start + half))
    scene.joint("spherical", tuple(start) if on is None else on, (name, tuple(-half)))
    return start + 2 * half


def chain(n: int, name: str = "rod", at: float = 0.0, scene: Scene | None = None) -> Scene:
    """Rods in a chain."""
    scene, end, along = scene or Scene(gravity=(0, -GRAVITY, 0)), np.array([0.0, 0.0, at]), np.array([1.0, 0, 0])
    for k in range(n):
        end = rod(scene, f"{name}{k}", end, along, (f"{name}{k - 1}", tuple(LENGTH / 2 * along)) if k else None)
    return scene


def tree(n: int) -> Scene:
    """Rods in a binary tree."""
    scene, rng = Scene(gravity=(0, -GRAVITY, 0)), np.random.default_rng(1)
    along = rng.normal(size=(n, 3))
    along /= np.linalg.norm(along, axis=1)[:, None]
    ends = []
    for k in range(n):
        of = (k - 1) // 2
        ends.append(rod(scene, f"rod{k}", ends[of] if k else np.zeros(3), along[k],
                        (f"rod{of}", tuple(LENGTH / 2 * along[of])) if k else None))
    return scene


def ladder(n: int) -> Scene:
    """Two chains, bodies of equal number at a constant distance."""
    scene = chain(n // 2, "left", 0.0)
    chain(n // 2, "right", LENGTH, scene)
    for k in range(n // 2):
        scene.joint("distance", f"left{k}", f"right{k}")
    return scene


def net(n: int) -> Scene:
    """A horizontal net of bodies at constant distances, its first row suspended from the ground."""
    scene, side = Scene(gravity=(0, -GRAVITY, 0)), round(n**0.5)
    for i in range(side):
        for j in range(side):
            scene.rigid_body(f"breakpoint{i}_{j}", mass=MASS, inertia=INERTIA, position=(i * LENGTH, 0, j * LENGTH))
            scene.joint("distance", f"breakpoint{i - 1}_{j}" if i else (-LENGTH, 0, j * LENGTH), f"breakpoint{i}_{j}")
            if j:
                scene.joint("distance", f"breakpoint{i}_{j - 1}", f"breakpoint{i}_{j}")
    return scene


SCENES: dict[str, Callable[[int], Scene]] = {"chain": chain, "tree": tree, "ladder": ladder, "net": net}


def positions(engine: Engine, model: object) -> np.ndarray:
    """Return positions (bodies, 3)."""
    _, q, _, _ = engine.now()
    return np.array([q[body.configuration : body.configuration + 3] for body in model.bodies])


def run(model: object, steps: int, step: float) -> tuple[Engine, float]:
    """Return the engine after a number of steps, and their CPU seconds."""
    engine = Engine(model)
    status, _ = engine.start(duration=steps * step, output_step=steps * step, tol=1e-4, step=step,
                             method=GeneralisedAlpha(0.8), first_step=step)
    begin = time.process_time()
    status = status or engine.advance(lambda _: None)
    taken = time.process_time() - begin
    if status != "completed":
        raise RuntimeError(status)
    return engine, taken


def energy_change(engine: Engine) -> float:
    """Return the change of the total energy over a run, over the larger kinetic energy at its end or start."""
    rows = engine.rows()
    total = rows["kinetic"] + rows["elastic"] + rows["potential"]
    return float(abs(total[-1] - total[0]) / rows["kinetic"].max())


def measure(name: str, n: int, steps: int, repetitions: int) -> dict:
    """One row of the table."""
    scene = SCENES[name](n)
    begin = time.process_time()
    model = build(scene)
    Engine(model)
    set_up = time.process_time() - begin
    engine, taken = run(model, steps, STEP)
    for _ in range(repetitions - 1):
        taken = min(taken, run(model, steps, STEP)[1])
    start = np.array([model.q[body.configuration : body.configuration + 3] for body in model.bodies])
    end, reference = positions(engine, model), positions(run(model, 4 * steps, STEP / 4)[0], model)
    motion = np.linalg.norm(reference - start, axis=1).max()
    counts = engine.statistics
    error = float(np.linalg.norm(end - reference, axis=1).max() / motion)
    return {"scene": name, "bodies": len(model.bodies), "error": error,
            "energy": energy_change(engine), "us_per_step": 1e6 * taken / counts["steps"],
            "us_per_step_and_body": 1e6 * taken / counts["steps"] / len(model.bodies),
            "iterations_per_step": counts["newton_iterations"] / counts["steps"],
            "factorisations_per_step": counts["factorisations"] / counts["steps"],
            "multiplications": model.newton.operations / len(model.bodies), "set_up_s": set_up,
            "MB": engine.memory / 1e6}


def main() -> None:
    """Measure and print."""
    options = parser(__doc__, repetitions=(3, "of every run"), steps=(100, "of a run"),
                     largest=(1000, "number of bodies", 20)).parse_args()
    show([measure(name, n, options.steps, options.repetitions) for name in few(SCENES) for n in SIZES
          if n <= options.largest], options.out)


if __name__ == "__main__":
    main()
