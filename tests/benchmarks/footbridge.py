"""A footbridge under walkers: error and CPU time of the linear model of motion about rest and of the scene's equations.

    python tests/benchmarks/footbridge.py [--out FILE.csv]

A deck of 40 m on two supports, of which one slides, and of 1,500 kg/m, whose first frequency, 2 Hz, is that of the
paces, with a damping ratio of 0.5 %. Walkers are bodies that slides drive along it at 1.5 m/s, with a force of 700 N
whose first harmonic is 40 %: one without mass, one of 70 kg, and 30 of them in step, 0.6 m from each other. Reference:
ten modes of the beam with the moving masses, integrated to 1e-10. Errors are those of the deflection at mid-span, over
its largest.
"""

from __future__ import annotations

import os

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np
from funicular import GeneralSection, Harmonic, Material, Scene, catenary
from scipy.integrate import solve_ivp
from table import Parser, few, parser, show

LENGTH, MASS, FREQUENCY, RATIO = 40.0, 1500.0, 2.0, 0.005
SPEED, WEIGHT, HARMONIC, APART, LIGHT = 1.5, 700.0, 0.4, 0.6, 1e-3
WALK = 20.0
"""Distance that each walker goes, m."""
STIFFNESS = MASS * (2 * np.pi * FREQUENCY * (LENGTH / np.pi) ** 2) ** 2
DAMPING = catenary.mass_damping(RATIO, FREQUENCY)
MODES, ELEMENTS = 10, 20
OUTPUT_STEP = 0.02
GROUPS = {"a force": (1, LIGHT), "one of 70 kg": (1, 70.0), "30 of 70 kg": (30, 70.0)}
"""Numbers and masses of walkers, kg."""
SETTINGS = [{"integrator": name, "step": step} for step in (1e-2, 5e-3, 2.5e-3) for name in ("genalpha", "linear")]


def bridge(count: int, mass: float, elements: int = ELEMENTS) -> Scene:
    """Return the deck under a number of walkers of a mass in kg."""
    scene = Scene(gravity=(0, 0, 0))
    scene.cable("deck", start=(0, 0, 0), end=(LENGTH, 0, 0), elements=elements, element="cable8p",
                section=GeneralSection(area=MASS / 7850, second_moment_about_z=STIFFNESS / 2.1e11),
                material=Material(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7850, mass_damping=DAMPING))
    scene.pin("deck", s=0.0)
    scene.rigid_body("bearing", mass=1.0, inertia=(1.0, 1.0, 1.0), position=(LENGTH, 0, 0))
    scene.joint("prismatic", (LENGTH, 0, 0), "bearing", axis=(1, 0, 0))
    scene.joint("spherical", "bearing", ("deck", LENGTH))
    for k in range(count):
        name, s = f"walker{k}", APART * k
        scene.rigid_body(name, mass=mass, inertia=(mass, mass, mass), position=(s, 0, 0), velocity=(SPEED, 0, 0))
        scene.slide(name, along="deck", velocity=SPEED)
        scene.force(name, value=(0, -WEIGHT, 0), scale=Harmonic(amplitude=HARMONIC, frequency=FREQUENCY, offset=1.0))
    return scene


def modal(count: int, mass: float, times: np.ndarray, modes: int = MODES) -> np.ndarray:
    """Return the deflection at mid-span by the modes of the deck, m."""
    n = np.arange(1, modes + 1) * np.pi / LENGTH
    squares, starts = STIFFNESS / MASS * n**4, APART * np.arange(count)[:, None]

    def rates(t: float, y: np.ndarray) -> np.ndarray:
        q, rate = y[:modes], y[modes:]
        x = n * (starts + SPEED * t)
        shape, slope, bend = np.sin(x), n * np.cos(x), -(n**2) * np.sin(x)
        force = WEIGHT * (1 + HARMONIC * np.sin(2 * np.pi * FREQUENCY * t))
        of_walkers = force - mass * (2 * SPEED * slope @ rate + SPEED**2 * bend @ q)
        own = 0.5 * MASS * LENGTH
        second = np.linalg.solve(own * np.eye(modes) + mass * shape.T @ shape,
                                 shape.T @ of_walkers - own * (DAMPING * rate + squares * q))
        return np.concatenate([rate, second])

    y = solve_ivp(rates, (0.0, times[-1]), np.zeros(2 * modes), "DOP853", times, rtol=1e-10, atol=1e-13).y
    return np.sin(n * LENGTH / 2) @ y[:modes]


def rows() -> list[dict]:
    """Return the table."""
    found = []
    duration = OUTPUT_STEP if Parser.smallest else WALK / SPEED
    for settings in SETTINGS[:2]:  # the first run of a process loads libraries
        bridge(1, LIGHT).run(OUTPUT_STEP, progress=False, **settings)
    for walkers, (count, mass) in few(GROUPS.items()):
        reference = None
        for settings in few(SETTINGS):
            run = bridge(count, mass).run(duration, output_step=OUTPUT_STEP, progress=False, **settings)
            reference = modal(count, mass, run.time) if reference is None else reference
            error = np.abs(run["deck.nodal_vectors"][:, ELEMENTS // 2, 0, 1] + reference).max() / reference.max()
            found.append({"walkers": walkers, "integrator": settings["integrator"], "step, ms": 1e3 * settings["step"],
                          "deflection, mm": 1e3 * float(reference.max()), "error %": 100 * float(error),
                          "steps": run.report["steps"], "factorisations": run.report["factorisations"],
                          "iterations a step": run.report["newton_iterations"] / run.report["steps"],
                          "cpu s": run.report["time_s"]["solve_cpu"]})
            print(found[-1], flush=True)
    return found


def main() -> None:
    """Print the table."""
    given = parser(__doc__).parse_args()
    show(rows(), given.out)


if __name__ == "__main__":
    main()
