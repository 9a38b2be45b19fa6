"""Example 5.1 of the paper, planar elements against spatial ones: a table, and with --plot the picture of both.

    python tests/benchmarks/planar.py [--out FILE.csv] [--plot FILE.png]

Steps of 1 ms, generalised-α. With equal kinematics all steps of the Newton iteration are equal up to rounding. The
kinematics are equal for a cable in its plane, for a beam with ν = 0, and with any ν by the structural law. They differ
for the continuum law with ν of 0.3, whose sections cannot deform as bending requires (Poisson locking): beam12p, in
plane stress, bends with E I / (1 - ν²), 1.10 E I, and beam24, in three-dimensional stress, with E I (1 - ν) / (1 + ν) /
(1 - 2 ν), 1.35 E I. They also differ between a cable and the beam of the continuum law, which is too stiff with 3
elements: r_y is linear along an element, the slope is not, and the difference is shear (under 50 N the wire sags 5.4 %
less than the cable with 3 elements, 0.41 % with 12, 0.15 % with 48).
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from funicular import Run
from sliding import sliding_mass
from table import few, parser, show

PAIRS = [
    ("cable8p", "cable12", "", 0.0, "equal kinematics"),
    ("beam12p", "beam24", "continuum", 0.0, "equal kinematics"),
    ("beam12p", "beam24", "structural", 0.3, "equal kinematics"),
    ("beam12p", "beam24", "continuum", 0.3, "plane or three-dimensional stress"),
    ("cable8p", "beam24", "continuum", 0.0, "the beam locks in shear"),
]
QUANTITIES = {"x, y / m": "A.position", "s / m": "trolley.s", "force / N": "trolley.force",
              "acceleration / (m/s²)": "A.acceleration"}


def simulate(element: str, law: str = "continuum", poisson_ratio: float = 0.0, duration: float = 1.0) -> Run:
    """Return a run of Table 1 with another element."""
    laws = {"law": law} if "beam" in element else {}
    scene = sliding_mass(3, element, poisson_ratio=poisson_ratio, **laws)
    return scene.run(duration, step=1e-3, output_step=2e-3)


def differences(planar: Run, spatial: Run) -> dict[str, float]:
    """Return the largest difference of each quantity."""
    return {label: float(np.abs(planar[name] - spatial[name]).max()) for label, name in QUANTITIES.items()}


def draw(runs: dict[tuple[str, str, float], Run], path: Path) -> None:
    """Draw the rider's height by the four elements, and the differences of planar and spatial ones."""
    from funicular.view.plot import STYLE
    from matplotlib import pyplot, rc_context

    with rc_context(STYLE):
        figure, (height, apart) = pyplot.subplots(2, figsize=(7.5, 6), sharex=True)
        for element in ("cable12", "cable8p", "beam24", "beam12p"):
            run, planar = runs[element, "" if "cable" in element else "continuum", 0.0], element.endswith("p")
            height.plot(run.time, 1e3 * run["A.position"][:, 1],
                        label=f"{element}, {'planar' if planar else 'spatial'}",
                        color="C0" if "beam" in element else "C1", linewidth=1.2 if planar else 4,
                        alpha=1 if planar else 0.35)
        height.set_ylabel("y of the rider / mm")
        height.set_ylim(-52, 2)
        height.legend(ncols=2, loc="lower center")
        for k, (planar, spatial, law, ratio, why) in enumerate(PAIRS):
            one, other = (runs[element, law, ratio] for element in (planar, spatial))
            gap = np.linalg.norm(one["A.position"] - other["A.position"], axis=1)
            apart.semilogy(one.time[1:], np.maximum(gap[1:], 1e-18), color=f"C{k + 2}", linewidth=1,
                           label=f"{planar}, {spatial}, {law or 'green'}, ν = {ratio:g}: {why}")
        apart.set_ylabel("distance of the riders / m")
        apart.set_xlabel("time / s")
        apart.set_ylim(1e-18, 1)
        apart.legend(loc="center", fontsize=8)
        figure.savefig(path, dpi=100)


def main() -> None:
    """Run, compare, print, draw."""
    options = parser(__doc__)
    options.add_argument("--plot", type=Path, metavar="FILE.png", help="draw the picture")
    options = options.parse_args()
    runs = {(element, law, ratio): simulate(element, law, ratio)
            for planar, spatial, law, ratio, _ in few(PAIRS) for element in (planar, spatial)}
    show([{"planar": planar, "spatial": spatial, "law": law, "ν": ratio}
          | differences(runs[planar, law, ratio], runs[spatial, law, ratio]) | {"why": why}
          for planar, spatial, law, ratio, why in few(PAIRS)], options.out)
    if options.plot:
        draw(runs, options.plot)
        print(f"written: {options.plot}")


if __name__ == "__main__":
    main()
