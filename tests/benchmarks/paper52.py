"""Example 5.2 of the paper: three kinds of link below one cable, figures 7, 8 and 9 of the paper, and their cost.

    python tests/benchmarks/paper52.py [--out FILE.csv] [--plots FOLDER] [--tol 1e-4]

Fig. 7: the ball's y-acceleration with a rigid link, by the spatial and by the planar joint. Fig. 8: with a rigid link,
a modal one, and one of absolute nodal coordinates; and again with links 100 times as stiff, with which all three agree:
their differences are those of flexibility. The rigid link here has the rotary inertia of the others, unlike the thin
rod of the scene file. Fig. 9: the ball's path with 1 m/s along x and z. The table: distance of the ball from that with
the rigid link, error against a run of smaller tol, CPU seconds of the integration.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from funicular import Material, Rectangle, Run, Scene, load_scene
from table import few, parser, show

LENGTH, SIDE, MASS, BALL = 0.5, 0.03, 1.89, 1.0
START = 0.25
KINDS = ("rigid", "modal", "ancf")
LABELS = {"rigid": "rigid", "modal": "modes", "ancf": "absolute nodal coordinates"}


@dataclass
class Motion:
    """A run, and its CPU seconds and error."""

    run: Run
    seconds: float
    error: float


def scene(kind: str, planar: bool = False, stiffer: float = 1.0, aside: float = 0.0) -> Scene:
    """Return the scene of the file with this kind of link; aside: of the ball's velocity along z, m/s."""
    of_file = load_scene("paper52_rigid")
    made = Scene(gravity=of_file.gravity)
    wire = of_file.cables["wire"]
    made.add(wire.model_copy(update={"element": "cable8p"}) if planar else wire)
    for pin in of_file.pins:
        made.pin("wire", s=pin.s)
    section = Rectangle(height=SIDE, width=SIDE)
    material = Material(youngs_modulus=stiffer * 0.2e9, poisson_ratio=0.3, density=4200)
    turn = (-aside / LENGTH, 0.0, 1.0 / LENGTH)
    middle = np.cross(turn, (0, -LENGTH / 2, 0))
    drawn = {"start": (START, 0, 0), "end": (START, -LENGTH, 0), "section": section, "material": material,
             "up": (1, 0, 0), "element": "beam24", "law": "structural"}
    ends = ("link", 0.0), ("link", LENGTH)
    if kind == "rigid":
        across, along = MASS * (LENGTH**2 + SIDE**2) / 12, MASS * SIDE**2 / 6
        made.rigid_body("link", mass=MASS, inertia=(across, along, across), position=(START, -LENGTH / 2, 0),
                        velocity=middle, angular_velocity=turn)
        ends = ("link", (0, LENGTH / 2, 0)), ("link", (0, -LENGTH / 2, 0))
    elif kind == "modal":
        # body axes: x down the link, y along the ground's x
        made.modal_body("link", **drawn, velocity=middle, angular_velocity=(0.0, turn[0], turn[2]))
    else:
        made.cable("link", **drawn, elements=2, angular_velocity=turn)
    made.rigid_body("ball", mass=BALL, inertia=(4e-4,) * 3, position=(START, -LENGTH, 0),
                    velocity=np.cross(turn, (0, -LENGTH, 0)))
    if kind == "rigid":
        made.slide("link", along="wire", s=START, at=ends[0][1], name="trolley")
    else:
        made.slide(ends[0], along="wire", s=START, name="trolley")
    made.joint("spherical", ends[1], "ball", name="eye")
    return made


def moved(of: Scene, tol: float, duration: float = 1.5) -> Motion:
    """Return the motion, and its distance from one with a hundredth of its tol, over the ball's largest motion."""
    run, precise = (of.run(duration=duration, tol=t, output_step=0.005) for t in (tol, tol / 100))
    away = np.linalg.norm(precise["ball.position"] - precise["ball.position"][0], axis=1).max()
    error = np.linalg.norm(run["ball.position"] - precise["ball.position"], axis=1).max() / away
    return Motion(run, run.report["time_s"]["solve_cpu"], error)


def apart(one: Run, other: Run, until: float) -> float:
    """Return the largest distance of the balls up to a time, m."""
    shown = one.time <= until + 1e-9
    return float(np.linalg.norm(one["ball.position"][shown] - other["ball.position"][shown], axis=1).max())


def draw(folder: Path, flat: Motion, links: dict[str, Motion], stiff: dict[str, Motion], path: Motion) -> None:
    """The three figures."""
    from funicular.view.plot import STYLE
    from matplotlib import rc_context
    from matplotlib.figure import Figure

    def acceleration(axes, motion: Motion, **style):
        axes.plot(motion.run.time, motion.run["ball.acceleration"][:, 1], **style)
        axes.set_ylabel("ball: y-acceleration / (m/s²)")

    folder.mkdir(parents=True, exist_ok=True)
    with rc_context(STYLE):
        figure = Figure(figsize=(7, 3.4))
        axes = figure.add_subplot()
        acceleration(axes, links["rigid"], label="spatial joint", linewidth=3.2, color="0.75")
        acceleration(axes, flat, label="planar joint", linestyle="--", color="C0")
        axes.set_xlabel("time / s")
        axes.legend(loc="upper right")
        figure.savefig(folder / "paper52-fig7.png")

        figure = Figure(figsize=(7, 6.2))
        upper, lower = figure.subplots(2, sharex=True)
        for axes, motions, title in ((upper, links, "links of the print, E = 0.2 GPa"),
                                     (lower, stiff, "links 100 times as stiff")):
            for kind, style in zip(KINDS, ({"linewidth": 3.2, "color": "0.75"}, {"color": "C0"},
                                           {"color": "C3", "linestyle": "--"}), strict=True):
                acceleration(axes, motions[kind], label=LABELS[kind], **style)
            axes.set_title(title, loc="left", fontsize=10)
        upper.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=3)
        lower.set_xlabel("time / s")
        figure.savefig(folder / "paper52-fig8.png")

        figure = Figure(figsize=(7, 4.4))
        axes = figure.add_subplot(projection="3d")
        x, y, z = path.run["ball.position"].T
        axes.plot(x, z, y, label="ball")
        axes.plot(*path.run["link.position"].T[[0, 2, 1]], color="0.6", label="middle of the link")
        for k in np.linspace(0, len(x) - 1, 9).round().astype(int):
            top = 2 * path.run["link.position"][k] - path.run["ball.position"][k]
            axes.plot(*np.array([top, path.run["ball.position"][k]]).T[[0, 2, 1]], color="0.3", linewidth=0.8)
        axes.set(xlabel="x / m", ylabel="z / m", zlabel="y / m")
        axes.set_box_aspect((2.2, 1, 1), zoom=1.3)
        axes.view_init(22, -62)
        axes.legend(loc="upper left")
        figure.savefig(folder / "paper52-fig9.png")


def main() -> None:
    """Run all, print the table, and write it and the figures if requested."""
    options = parser(__doc__)
    options.add_argument("--plots", type=Path, metavar="FOLDER", help="draw the figures")
    options.add_argument("--tol", type=float, default=1e-4)
    options = options.parse_args()
    links, stiff = ({kind: moved(scene(kind, stiffer=by), options.tol) for kind in few(KINDS)} for by in (1.0, 100.0))
    flat, path = (moved(scene("rigid", **how), options.tol) for how in ({"planar": True}, {"aside": 1.0}))
    rows = [row(f"{LABELS[kind]}, {name}", m, of["rigid"])
            for name, of in (("of the print", links), ("100 times as stiff", stiff)) for kind, m in of.items()]
    rows += [row("rigid, planar joint", flat, links["rigid"]), row("rigid, 1 m/s along x and z", path)]
    show(rows, options.out)
    if options.plots:
        draw(options.plots, flat, links, stiff, path)


def row(name: str, motion: Motion, rigid: Motion | None = None) -> dict:
    """A row of the table."""
    off = {f"mm off rigid, {t} s": "" if rigid is None else 1e3 * apart(motion.run, rigid.run, t)
           for t in (0.5, 1.0, 1.5)}
    return {"link": name, **off, "error": motion.error, "CPU s": motion.seconds,
            "integrator": motion.run.report["integrator"]}


if __name__ == "__main__":
    main()
