"""Contact of cables with surfaces: convergence with mesh and stiffness, and cost.

    python tests/benchmarks/contact.py [--out FILE.csv]

First the mooring line of test_contact.py in equilibrium, against the elastic catenary on the ground: end and touch-down
in m; tension at the anchor in N, with and without friction; penetration in m. The remaining difference is bending,
absent in the catenary. Then the rope over a drum: shares of the capstan's limit at which it holds and slides. Then the
cost of evaluating all forces of a cable of 1,000 elements, of which none, ten or all touch the ground. Then distant
pairs, 10,000 of 100 bodies and 100 spheres, and 100 crossings of cables: CPU time of adding and of setting up, of an
evaluation of all forces, and of a step less that of the scene without them.
"""

from __future__ import annotations

import os

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import sys
import warnings
from pathlib import Path
from time import process_time

import numpy as np
from funicular import Circle, Material, Plane, Scene

sys.path.insert(0, str(Path(__file__).parents[1]))
sys.path.insert(0, str(Path(__file__).parents[1] / "contact"))

from many_parts import bodies_and_spheres
from table import arguments, few, show
from test_contact import LIFTED, LIGHT, L, R, capstan, end_of_mooring, heaviest, mooring


def line(elements: int, friction: float, stiffness: float) -> dict[str, object]:
    """Return the errors of the mooring line."""
    state = mooring(elements, friction=friction, stiffness=stiffness).equilibrium()
    end, tension = end_of_mooring(friction)
    found = state["line.position"][-1, :2] - [0, R]
    return {"case": "mooring", "elements": elements, "friction": friction, "stiffness": f"{stiffness:.1e}",
            "end": f"{np.linalg.norm(found - end):.1e}", "touch-down": f"{state['contact_1.last'] - L + LIFTED:.1e}",
            "tension": f"{-state['line@0.force'][0] - tension:.1e}",
            "penetration": f"{state['contact_1.penetration']:.1e}"}


def drum(mu: float) -> dict[str, object]:
    """Return the shares of the capstan's limit between which the rope begins to slide."""
    held = 0.0
    for part in np.arange(0.94, 1.04, 0.01):
        run = capstan(part * heaviest(mu), mu).run(0.5, output_step=0.05, tol=1e-4, integrator="genalpha")
        end = run["rope.position"][:, 0, 1] + LIGHT
        if end[-1] - end[-2] > 2e-5:
            return {"case": "rope over a drum", "friction": mu, "holds": f"{held:.2f}", "slides": f"{part:.2f}"}
        held = part
    raise AssertionError("the rope holds beyond the limit")


def cost() -> list[dict[str, object]]:
    """Return the cost of evaluating all forces of 1,000 elements, of which none, ten, or all touch."""
    found = []
    for name, height in few((("no contact", None), ("none touch", -2.0), ("ten touch", 4.9e-3),
                              ("all touch", 2e-5))):
        scene = Scene()
        end = 0.01 if name == "all touch" else 0.5
        scene.cable("line", start=(0, 0.01, 0), end=(100, end, 0), elements=1000, element="cable12",
                    section=Circle(radius=0.01), material=Material(youngs_modulus=1e9, poisson_ratio=0, density=5000))
        scene.pin("line", s=0)
        if height is not None:
            scene.surface("bed", Plane(point=(0, height, 0)))
            scene.contact("line", "bed", stiffness=1e5, name="bed_contact")
        runs = [scene.run(0.05, output_step=0.05, step=1e-3, integrator="genalpha") for _ in few(range(3))]
        best = min(run.report["time_s"]["residual"] / run.report["newton_iterations"] for run in runs)
        touching = runs[0]["bed_contact.touching"][0] if height is not None else 0.0
        found.append({"1,000 elements": name, "touching, m": f"{touching:.2f}", "forces, us": f"{1e6 * best:.0f}"})
    return found


def many_cables(pairs: bool) -> Scene:
    """Return 100 pairs of cables 5 m apart, with a crossing each."""
    scene = Scene()
    for k in range(100):
        z = 3.0 * k
        for name, start, end in ((f"upper{k}", (0, 0, z), (2, 0, z)), (f"lower{k}", (1, -5, z - 1), (1, -5, z + 1))):
            scene.cable(name, start=start, end=end, elements=4, element="cable12", section=Circle(radius=0.01),
                        material=Material(youngs_modulus=1e7, poisson_ratio=0, density=1000))
            scene.pin(name, s=0)
            scene.pin(name, s=2)
        if pairs:
            scene.crossing(f"upper{k}", f"lower{k}", stiffness=1e4)
    return scene


def seconds_of(scene: Scene, duration: float) -> tuple[float, float]:
    """Return the minimum CPU seconds of three runs with steps of 1 ms, and of an evaluation of all forces."""
    least = [np.inf, np.inf]
    for _ in few(range(3)):
        begin = process_time()
        run = scene.run(duration, output_step=duration, step=1e-3, integrator="genalpha")
        taken = process_time() - begin, run.report["time_s"]["residual"] / run.report["newton_iterations"]
        least = [min(pair) for pair in zip(least, taken, strict=True)]
    return least[0], least[1]


def far() -> list[dict[str, object]]:
    """Return the cost of distant pairs."""
    found = []
    for name, make in few((("10,000 contacts", lambda pairs: bodies_and_spheres(100, pairs)),
                            ("100 crossings", many_cables))):
        steps, added = [], []
        for pairs in (False, True):
            begin = process_time()
            scene = make(pairs)
            added.append(process_time() - begin)
            short, _ = seconds_of(scene, 0.1)
            long, evaluation = seconds_of(scene, 0.6)
            steps.append((long - short) / 500)
            set_up = short - 100 * steps[-1]
        found.append({"far apart": name, "add, s": f"{added[1] - added[0]:.2f}", "run but steps, s": f"{set_up:.2f}",
                      "forces, us": f"{1e6 * evaluation:.0f}", "step, us more": f"{1e6 * (steps[1] - steps[0]):.0f}"})
    return found


def main() -> None:
    """Print the tables."""
    warnings.simplefilter("ignore")
    options = arguments(__doc__)
    rows = [line(n, 0.0, 2.4e5) for n in few((30, 60, 120, 240))]
    rows += [line(120, 0.0, k) for k in few((2.4e4, 2.4e6))]
    rows += [line(n, 0.3, 2.4e5) for n in few((30, 60, 120))]
    show(rows, options.out, "mooring")
    show([drum(mu) for mu in few((0.1, 0.3))], table="drum")
    show(cost(), table="forces")
    show(far(), table="far apart")


if __name__ == "__main__":
    main()
