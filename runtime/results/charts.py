"""Charts of a run over time and along its cables, by Matplotlib, which is imported when one is made."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..parts.rope_items import Drum
from ..view.plot import colour_scale, snapshots
from ..view.projections import axis_name
from .animation.clips import upward
from .quantities import ENERGIES, STORED_ENERGIES
from .recorded import Recorded
from .section_forces.balance_limits import known_method
from .section_forces.forces import DEFAULT_DIVISIONS, jumps, of_run, with_sides

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MAX_MARKERS = 200
"""Output times up to which a chart marks each one."""


def acceleration(run: Recorded, figure: Figure) -> bool:
    """Draw the vertical accelerations of bodies over time, Fig. 5 of the paper; False without a slide or a body."""
    bodies = list(run.scene.bodies)
    if not (bodies and run.scene.slides):
        return False
    up = upward(run.scene)
    marker = "." if len(run.time) <= MAX_MARKERS else ""
    figure.set_size_inches(7, 3.4)
    axes = figure.add_subplot()
    for body in bodies:
        axes.plot(run.time, run[f"{body}.acceleration"] @ up, marker=marker, markersize=4, label=f"body {body}")
    axes.set_xlabel("time / s")
    axes.set_ylabel(f"{axis_name(up)}-acceleration / (m/s²)")
    axes.legend(loc="best")
    return True


def slide(run: Recorded, figure: Figure) -> bool:
    """Draw positions and speeds of slides along their cables and ropes over time; False without a slide."""
    slides = run.scene.slides
    if not slides:
        return False
    figure.set_size_inches(7, 4.6)
    place, speed = figure.subplots(2, sharex=True)
    along = {slide.along for slide in slides.values()} & run.scene.cables.keys()
    for s in np.unique(np.concatenate([run.coords[f"{cable}.node"].values for cable in along])) if along else ():
        place.axhline(s, color="0.6", linewidth=0.7, linestyle=":")
    if along:
        place.plot([], [], color="0.6", linewidth=0.7, linestyle=":", label="nodes of the cable")
    for name in slides:
        place.plot(run.time, run[f"{name}.s"], label=f"slide {name}")
        speed.plot(run.time, run[f"{name}.s_rate"])
    place.grid(axis="y", visible=False)
    place.set_ylabel("arc-length s / m")
    place.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=4)
    speed.set_ylabel("s rate / (m/s)")
    speed.set_xlabel("time / s")
    return True


def rope(run: Recorded, figure: Figure) -> bool:
    """Draw over time the tensions of ropes on both sides of sheaves and at drums, the wrap angles, and the lengths in
    store; False without a rope.
    """
    wheels = [wheel for each in run.scene.ropes.values() for wheel in each.wheels]
    if not wheels:
        return False
    drums = [wheel for wheel in wheels if isinstance(wheel, Drum)]
    shown = ["tension / N", *["wrap angle / rad"] * (len(drums) < len(wheels)), *["length in store / m"] * bool(drums)]
    figure.set_size_inches(7, 2.3 * len(shown))
    axes = dict(zip(shown, figure.subplots(len(shown), sharex=True), strict=True))
    for number, wheel in enumerate(wheels):
        name, colour, is_drum = wheel.name, f"C{number % 10}", isinstance(wheel, Drum)
        for side, style in {"": "-"}.items() if is_drum else {"_on": "-", "_off": (0, (4, 2))}.items():
            axes["tension / N"].plot(run.time, run[f"{name}.tension{side}"], color=colour, linestyle=style,
                                     label=name + side.replace("_", ", "))
        label, key = ("length in store / m", "length_in_store") if is_drum else ("wrap angle / rad", "wrap_angle")
        axes[label].plot(run.time, run[f"{name}.{key}"], color=colour)
    for label, ax in axes.items():
        ax.set_ylabel(label)
    axes["tension / N"].legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=4)
    ax.set_xlabel("time / s")
    return True


def section_forces(run: Recorded, figure: Figure, cable: str) -> bool:
    """Draw tension and moment along a cable at a few times, coloured by time, on both sides of jumps."""
    described, shown, colour = run.scene.cables[cable], snapshots(len(run.time)), colour_scale(run.time)
    fixed = jumps(run.scene, cable)
    riders = [run[f"{name}.s"][shown] for name, slide in run.scene.slides.items() if slide.along == cable]
    places = np.concatenate([np.broadcast_to(fixed, (len(shown), len(fixed))), *(s[:, None] for s in riders)], axis=1)
    s = with_sides(described, described.divided(DEFAULT_DIVISIONS), places)
    method = known_method(run.scene, run.model, cable, False)
    forces = of_run(run, cable, s, shown, method=method)
    figure.set_size_inches(7, 4.8)
    tension, moment = figure.subplots(2, sharex=True)
    for k, time in enumerate(run.time[shown]):
        tension.plot(s[k], forces["tension"][k], color=colour.to_rgba(time))
        moment.plot(s[k], np.linalg.norm(forces["moment"][k], axis=-1), color=colour.to_rgba(time))
    tension.set_ylabel("tension / N")
    if method != "balance":
        tension.set_title("by the elastic law: results do not contain all loads")
    moment.set_ylabel("moment / (N m)")
    moment.set_xlabel(f"arc-length s of {cable} / m")
    figure.colorbar(colour, ax=[tension, moment], label="time / s", pad=0.02, fraction=0.04)
    return True


def energy(run: Recorded, figure: Figure) -> bool:
    """Draw the changes of the energies since the start, and the relative residual of their balance."""
    figure.set_size_inches(7, 4.8)
    changes, error = figure.subplots(2, sharex=True, height_ratios=(2.2, 1))
    for name in (name for name in ENERGIES if f"energy.{name}" in run):
        found = run[f"energy.{name}"]
        if name in STORED_ENERGIES or found.any():
            changes.plot(run.time, found - found[0], label=name)
    changes.axhline(0, color="0.4", linewidth=0.7)
    changes.set_ylabel("change of energy / J")
    changes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=4)
    error.plot(run.time, run.energy_balance().relative, color="0.2")
    error.axhline(0, color="0.4", linewidth=0.7)
    error.set_ylabel("sum of changes /\nenergy exchanged")
    error.ticklabel_format(axis="y", style="sci", scilimits=(-2, 2), useMathText=True)
    error.set_xlabel("time / s")
    return True
