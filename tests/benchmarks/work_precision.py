"""Work and precision of the integrators on two scenes, by `funicular.bench`.

    python tests/benchmarks/work_precision.py [--out FILE.csv] [--plot FILE.png] [--repetitions 3]

Two scenes: example 5.1 of the paper, a stiff cable, and the sliding mass on a flexible one (E of 2 MPa, a rider of
5 kg), whose motion is not slow compared with its vibrations. Each on the mesh of the paper and on one twice as fine.
"""

import os

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from pathlib import Path

from funicular import load_scene
from funicular.bench.bench import Bench, bench, grid
from funicular.bench.report import draw_on, print_table, record
from rich.console import Console
from sliding import sliding_mass
from table import few, parser, show

TOLS = (1e-1, 1e-2, 1e-3, 1e-4)
SCENES = {
    "example 5.1": lambda: load_scene("paper51"),
    "flexible": lambda: sliding_mass(strain="engineering", youngs_modulus=2e6, mass=5.0),
}


def draw(results: dict[str, Bench], path: Path) -> None:
    """A panel a scene."""
    from funicular.view.plot import STYLE
    from matplotlib import pyplot, rc_context

    with rc_context(STYLE):
        figure, panels = pyplot.subplots(1, len(results), figsize=(10, 4), sharey=True)
        for axes, (name, result) in zip(panels, results.items(), strict=True):
            draw_on(axes, result)
            axes.set_title(name, fontsize=10)
        panels[1].set_ylabel("")
        handles, labels = panels[0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside upper center", ncols=4)
        figure.savefig(path, dpi=100)


def main() -> None:
    """Measure, print, draw."""
    options = parser(__doc__, repetitions=(3, "of each run, taking turns"))
    options.add_argument("--plot", type=Path, metavar="FILE.png", help="draw the picture")
    options = options.parse_args()
    results, console = {}, Console(width=100)
    for name, scene in few(SCENES.items()):
        described = scene()
        results[name] = bench(described, grid(described, tols=few(TOLS), duration=1.0, repetitions=options.repetitions))
        console.print(name)
        print_table(results[name], console)
    if options.out or options.json:
        show([{"scene": name} | record(result, row) for name, result in results.items() for row in result.rows],
             options.out)
    if options.plot:
        draw(results, options.plot)
        print(f"written: {options.plot}")


if __name__ == "__main__":
    main()
