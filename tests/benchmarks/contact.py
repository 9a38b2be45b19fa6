"""Contact of cables with surfaces: how it converges with mesh and stiffness, and what it costs.

    python tests/benchmarks/contact.py [--out FILE.csv]

First the mooring line of tests/test_contact.py at rest, against the elastic catenary on the ground: where its end is
and where it touches down, in m; the tension at the anchor in N, with and without friction; the penetration in m. What
does not converge to zero is the line's bending, which the catenary leaves out.

Then the rope over a drum: parts of the capstan's limit that it holds and at which it slides.

Then a cable of 1,000 elements, of which none, ten or all touch the ground: what the contact takes of a step, beside all
of it.
"""

from __future__ import annotations

import os

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import sys
import warnings
from pathlib import Path

import numpy as np
from funicular import Circle, Material, Plane, Scene
from funicular.engine import Engine
from funicular.integrators import GeneralisedAlpha
from funicular.model.build import build

sys.path.insert(0, str(Path(__file__).parents[1]))

from table import arguments, show
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
    """Return the parts of the capstan's limit between which the rope begins to slide."""
    held = 0.0
    for part in np.arange(0.94, 1.04, 0.01):
        run = capstan(part * heaviest(mu), mu).run(0.5, output_step=0.05, tol=1e-4, integrator="genalpha")
        end = run["rope.position"][:, 0, 1] + LIGHT
        if end[-1] - end[-2] > 2e-5:
            return {"case": "rope over a drum", "friction": mu, "holds": f"{held:.2f}", "slides": f"{part:.2f}"}
        held = part
    raise AssertionError("the rope holds beyond the limit")


PARTS = "residual", "factorisation", "solve", "step", "error"


def cost() -> list[dict[str, object]]:
    """Return what a contact of 1,000 elements costs a step of which none, ten, or all touch; and the cable itself."""
    found = []
    for name, height in (("none touch", -2.0), ("ten touch", 0.0), ("all touch", 2e-5)):
        scene = Scene()
        end = 0.01 if name == "all touch" else 0.5
        scene.cable("line", start=(0, 0.01, 0), end=(100, end, 0), elements=1000, element="cable12",
                    section=Circle(radius=0.01), material=Material(youngs_modulus=1e9, poisson_ratio=0, density=5000))
        scene.pin("line", s=0)
        scene.surface("bed", Plane(point=(0, height + (0.0049 if name == "ten touch" else 0.0), 0)))
        scene.contact("line", "bed", stiffness=1e5, name="bed_contact")
        run = scene.run(0.02, output_step=0.02, step=1e-3, integrator="genalpha")
        engine = Engine(build(scene))
        engine.start(duration=1.0, output_step=1.0, tol=1e-4, step=1e-3, first_step=1e-3, method=GeneralisedAlpha(0.8))
        found.append({"case": f"1,000 elements, {name}", "touching, m": f"{run['bed_contact.touching'][0]:.2f}",
                      "contact, us a step": 1e6 * float(engine.costs()[0]),
                      "all, us a step": 1e6 * sum(run.report["time_s"][part] for part in PARTS) / run.report["steps"]})
    return found


def main() -> None:
    """Print the tables."""
    warnings.simplefilter("ignore")
    options = arguments(__doc__)
    rows = [line(n, 0.0, 2.4e5) for n in (30, 60, 120, 240)]
    rows += [line(120, 0.0, k) for k in (2.4e4, 2.4e6)]
    rows += [line(n, 0.3, 2.4e5) for n in (30, 60, 120)]
    show(rows, options.out)
    show([drum(mu) for mu in (0.1, 0.3)])
    show(cost())


if __name__ == "__main__":
    main()
