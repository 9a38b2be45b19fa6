"""Pictures of a run: contact force over the track, uplift at the masts over time, forces of droppers over time."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from .assessment import assess, masts, uplift

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ..results.run import Run


def plot_force(run: Run, axes: Axes, pantograph: str = "pantograph",
               sections: Sequence[tuple[float, float]] | None = None) -> None:
    """Draw the contact force over the track, filtered and not, with mean and mean ± 3 standard deviations by section.
    """
    found = assess(run, sections, pantograph)
    for x in masts(run):
        axes.axvline(x, color="0.85", linewidth=0.8, zorder=0)
    axes.plot(found.place, found.force, color="0.75", linewidth=0.6, label="contact force")
    axes.plot(found.place, found.filtered_force, color="C0", linewidth=1.2, label=f"below {found.cutoff_Hz:g} Hz")
    for k in range(found.sizes["section"]):
        here = found.isel(section=k)
        ends = [float(here.start), float(here.end)]
        axes.plot(ends, [float(here["mean"])] * 2, color="C3", linewidth=1.5, label="mean" if not k else None)
        axes.fill_between(ends, float(here.statistical_minimum),
                          float(here.statistical_maximum), color="C3", alpha=0.1, linewidth=0,
                          label="mean ± 3 standard deviations" if not k else None)
    axes.set(xlabel="collector along the track in m", ylabel="force in N")
    axes.set_xlim(float(found.place[0]), float(found.place[-1]))
    axes.legend(loc="upper right", fontsize="small", ncols=2)


def plot_uplift(run: Run, axes: Axes, at: Sequence[int] | None = None) -> None:
    """Draw the uplift of the contact wire at masts over time; at: their numbers from 0, by default three in the middle.
    """
    values, x = uplift(run), masts(run)
    middle = len(x) // 2
    for k in range(max(middle - 1, 0), min(middle + 2, len(x))) if at is None else at:
        axes.plot(run.time, 1e3 * values[:, k], label=f"mast {k}, {x[k]:g} m")
    axes.set(xlabel="time in s", ylabel="uplift in mm")
    axes.legend(loc="upper right", fontsize="small")


def plot_droppers(run: Run, axes: Axes, span: int, droppers: Sequence[int] | None = None) -> None:
    """Draw the forces of a span's droppers over time; span and droppers are numbered from 1, by default all."""
    every = [name for name in run.scene.point_forces if name.startswith(f"dropper_{span}_")]
    names = every if droppers is None else [f"dropper_{span}_{k}" for k in droppers]
    for name in names:
        axes.plot(run.time, run[f"{name}.tension"], linewidth=1, label=f"dropper {name.rpartition('_')[2]}")
    axes.set(xlabel="time in s", ylabel="force in N", title=f"droppers of span {span}")
    axes.set_ylim(bottom=min(0.0, float(np.min([run[f'{name}.tension'].min() for name in names]))))
    axes.legend(loc="upper right", fontsize="small", ncols=3)
