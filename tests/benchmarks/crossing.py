"""A rider crosses the nodes of a flexible cable: cubic elements (cable12) and quintic ones (cable18), side by side.

    python tests/benchmarks/crossing.py [--out FILE.csv] [--plot FILE.png]

The sliding mass on 12 elements, with E of 2 MPa and a rider of 5 kg. r'' of cubic elements is discontinuous at their
nodes, and the acceleration of the rider changes by s'² times the jump; r'' is a nodal vector of quintic elements.
``jump`` is the change of the acceleration from one step before a node passage to one step after it, less the change per
step nearby. A true discontinuity does not decrease with the step.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from funicular import Run
from sliding import sliding_mass
from table import few, parser, show

ELEMENTS, DURATION = 12, 1.0
STEPS = (1e-3, 5e-4, 2.5e-4, 1.25e-4)
DAMPING_TIME = 1e-2  # the sudden start's vibrations would hide what the nodes do


def simulate(element: str, step: float) -> Run:
    """Return the flexible sliding mass with outputs at every step."""
    scene = sliding_mass(ELEMENTS, element, strain="engineering", youngs_modulus=2e6, mass=5.0,
                         damping_time=DAMPING_TIME)
    return scene.run(DURATION, step=step, output_step=step)


def jumps(run: Run) -> np.ndarray:
    """Return jumps (passages,) of the rider's acceleration at each node, m/s²."""
    s, a = run["trolley.s"], run["A.acceleration"]
    element = np.floor(s / (1.5 / ELEMENTS))
    change = np.linalg.norm(np.diff(a, axis=0), axis=1)
    crossings = np.flatnonzero(np.diff(element))
    near = np.median([change[crossings + k] for k in (-3, -2, 2, 3)], axis=0)
    return change[crossings] - near


def draw(runs: dict[str, Run], path: Path) -> None:
    """Draw the rider's acceleration over its position, with nodes."""
    from funicular.view.plot import STYLE
    from matplotlib import pyplot, rc_context

    with rc_context(STYLE):
        figure, (whole, rate) = pyplot.subplots(2, figsize=(7.5, 6), sharex=True)
        for axes in (whole, rate):
            for node in np.linspace(0, 1.5, ELEMENTS + 1):
                axes.axvline(node, color="0.6", linewidth=0.8, linestyle=":", zorder=0)
        for (element, run), colour in zip(runs.items(), ("C1", "C0"), strict=True):
            s, a = run["trolley.s"], run["A.acceleration"]
            whole.plot(s, a[:, 1], color=colour, label=element, linewidth=1.2)
            change = np.linalg.norm(np.diff(a, axis=0), axis=1) / np.diff(run.time)
            rate.semilogy((s[1:] + s[:-1]) / 2, change, color=colour, linewidth=1)
        whole.set_xlim(0.25, 1.35)
        whole.set_ylabel("vertical acceleration / (m/s²)")
        whole.legend()
        rate.set_ylabel("change of the acceleration\nin a step, per time / (m/s³)")
        rate.set_xlabel("s of the rider / m (dotted: nodes)")
        figure.savefig(path, dpi=100)


def main() -> None:
    """Run, measure, print, draw."""
    options = parser(__doc__)
    options.add_argument("--plot", type=Path, metavar="FILE.png", help="draw the picture")
    options = options.parse_args()
    rows, runs = [], {}
    for step in few(STEPS):
        for element in ("cable12", "cable18"):
            runs[element] = simulate(element, step)
            found = jumps(runs[element])
            rows.append({"step / s": step, "element": element, "crossings": len(found),
                         "median jump / (m/s²)": float(np.median(found)), "largest": float(found.max()),
                         "s at the end / m": runs[element]["trolley.s"][-1]})
    show(rows, options.out)
    if options.plot:
        draw(runs, options.plot)
        print(f"written: {options.plot}")


if __name__ == "__main__":
    main()
