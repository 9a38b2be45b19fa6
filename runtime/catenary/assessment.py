"""Assessment of the contact of a pantograph with the wire: filtered force, statistics, uplift, losses, pictures."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from ..errors import SceneError, near
from .building import called, named

if TYPE_CHECKING:
    import xarray as xr  # brings pandas
    from matplotlib.axes import Axes

    from ..results.run import Run

CUTOFF = 20.0
"""Hz: cut-off of the low-pass filter of the contact force."""

ORDER = 4
"""Order of the filter in each of its two directions."""

MAST_DISTANCE = 1e-3
"""m: least distance of two masts along the track."""

MIN_SAMPLES = 5.0
"""Output times in a period of the cut-off frequency: with fewer the filtered force differs."""


def low_pass(force: np.ndarray, step: float, cutoff: float = CUTOFF, order: int = ORDER) -> np.ndarray:
    """Return a force (time,), sampled at equal steps (s), without its parts above a frequency (Hz).

    A Butterworth filter, run forwards and backwards for zero phase, and adjusted so that the amplitude at the cut-off
    is 1/sqrt(2) after both. Raises SceneError.
    """
    from scipy.signal import butter, sosfiltfilt  # 0.6 s

    if not step * cutoff * MIN_SAMPLES <= 1 + 1e-9:
        raise SceneError("contact force", f"is known at steps of {step:.6g} s, too coarse to filter at {cutoff:g} Hz",
                         f"run with output_step={1 / (MIN_SAMPLES * cutoff):.6g} s or less")
    corner = cutoff / (np.sqrt(2.0) - 1.0) ** (1 / (2 * order))
    # prewarped: the filter depends on the tangent of the angle in a step
    warped = np.arctan(np.tan(np.pi * cutoff * step) * corner / cutoff) / (np.pi * step)
    return np.asarray(sosfiltfilt(butter(order, warped, fs=1 / step, output="sos"), force))


def masts(run: Run) -> np.ndarray:
    """Return the places of the masts of a run's catenary, in m along the track."""
    cables = run.scene.cables
    ends = np.sort([point[0] for name in named(cables, "messenger_[0-9]+") for point in (
        cables[name].drawn_through[0], cables[name].drawn_through[-1])])
    if not len(ends) or not named(cables, "contact"):
        raise SceneError("run", "is of no catenary: there are no cables \"contact\" and \"messenger_1\"",
                         "make the scene with funicular.catenary.scene")
    return np.asarray(ends[np.append(True, np.diff(ends) > MAST_DISTANCE)])


def uplift(run: Run) -> np.ndarray:
    """Return (time, mast): the rise of the contact wire over its height at rest at each mast, in m.

    Where two sections overlap, it is the largest of both wires.
    """
    places = masts(run)
    found = np.full((len(run.time), len(places)), -np.inf)
    for name in named(run.scene.cables, "contact"):
        (x, y, _), positions = np.transpose(run.scene.cables[name].drawn_through), run[f"{name}.position"]
        over = np.flatnonzero((places >= x[0] - MAST_DISTANCE) & (places <= x[-1] + MAST_DISTANCE))
        at = [int(np.argmin(np.abs(positions[0, :, 0] - place))) for place in places[over]]
        found[:, over] = np.maximum(found[:, over], positions[:, at, 1] - np.interp(places[over], x, y))
    return found


def contacts(run: Run, pantograph: str = "pantograph") -> list[str]:
    """Return the names of a pantograph's contacts, one of each strip with each contact wire. Raises SceneError."""
    wires, strips = run.scene.cables, r"(_[0-9]+)?"
    found = [name for name, each in run.scene.crossings.items()
             if each.a in wires and re.fullmatch(re.escape(f"{pantograph}_{each.a}") + strips, name)]
    if not found:
        known = {re.sub(f"_{each.a}{strips}$", "", name) for name, each in run.scene.crossings.items()}
        raise SceneError("assessment", f'there is no pantograph "{pantograph}"', near(pantograph, sorted(known)))
    return found


def losses(run: Run, pantograph: str = "pantograph") -> list[tuple[float, float]]:
    """Return the intervals (s) in which none of a collector's strips was on a wire."""
    apart = [(float(run.time[0]), float(run.time[-1]))]
    for contact in contacts(run, pantograph):
        off = _off(run, contact)
        apart = [(max(a, begin), min(b, end)) for a, b in apart for begin, end in off if max(a, begin) < min(b, end)]
    return apart


def _off(run: Run, contact: str) -> list[tuple[float, float]]:
    """Return the intervals (s) in which a contact was open."""
    found, since = [], None
    if run[f"{contact}.normal_force"][0] <= 0:
        since = float(run.time[0])
    for event in run.events:
        if event["name"] != contact:
            continue
        if event["what"] == "lost contact" and since is None:
            since = event["time"]
        elif event["what"] == "came into contact" and since is not None:
            found.append((since, event["time"]))
            since = None
    return found if since is None else [*found, (since, float(run.time[-1]))]


def assess(run: Run, sections: Sequence[tuple[float, float]] | None = None, pantograph: str = "pantograph",
           cutoff: float = CUTOFF, order: int = ORDER) -> xr.Dataset:
    """Return the statistics of a pantograph's contact force in sections of the track, as an xarray dataset.

    The force is the sum of those of all strips and wires, which are in forces by contact and time.

    sections: their ends, in m along the track; by default the two spans in the middle, or the whole passage of a line
    of fewer than four spans. By section, of the force filtered at the cut-off (Hz): its mean, standard_deviation,
    statistical_maximum and statistical_minimum (mean ± 3 standard deviations), maximum and minimum, in N; of the
    unfiltered force the loss_time in s, loss_share of the time in the section, and the number of losses. By mast the
    largest uplift in m; over time the force, filtered and not, and the place of the collector. Raises SceneError.
    """
    import xarray as xr  # brings pandas

    names, time = contacts(run, pantograph), run.time
    forces = np.stack([run[f"{name}.normal_force"] for name in names])
    force, place = forces.sum(axis=0), run[f"{pantograph}_1.position"][:, 0]
    steps = np.diff(time)
    whole = len(time) - 1 if abs(steps[-1] - steps[0]) > 1e-6 * steps[0] else len(time)  # the last may be shorter
    filtered = np.append(low_pass(force[:whole], float(steps[0]), cutoff, order), force[whole:])
    rows = [_section(time[:whole], force[:whole], filtered[:whole], place[:whole], losses(run, pantograph), *section)
            for section in _sections(run, sections, place)]
    by_section = {key: ("section", np.array([row[key] for row in rows])) for key in rows[0]}
    found = xr.Dataset({**by_section, "uplift": ("mast", uplift(run).max(axis=0)), "force": ("time", force),
                        "forces": (("contact", "time"), forces), "filtered_force": ("time", filtered),
                        "place": ("time", place)},
                       coords={"time": time, "mast": masts(run), "contact": names},
                       attrs={"cutoff_Hz": cutoff, "filter": f"Butterworth, order {order}, forwards and backwards"})
    for key, unit in UNITS.items():
        found[key].attrs["units"] = unit
    return found


UNITS = {"mean": "N", "standard_deviation": "N", "statistical_maximum": "N", "statistical_minimum": "N", "maximum": "N",
         "minimum": "N", "loss_time": "s", "loss_share": "1", "losses": "1", "start": "m", "end": "m", "uplift": "m",
         "force": "N", "forces": "N", "filtered_force": "N", "place": "m", "mast": "m", "time": "s"}


def _sections(run: Run, sections: Sequence[tuple[float, float]] | None, place: np.ndarray) -> list[tuple[float, float]]:
    if sections is None:
        at = masts(run)
        middle = len(at) // 2
        sections = [(at[middle - 1], at[middle + 1])] if len(at) > 4 else [(float(place[0]), float(place[-1]))]
    for start, end in sections:
        if not place[0] <= start < end <= place[-1] + 1e-9 * abs(place[-1]):
            raise SceneError("assessment", f"the pantograph went from {place[0]:.6g} to {place[-1]:.6g} m, which does "
                             f"not hold the section from {start:.6g} to {end:.6g} m", "run longer, or take another one")
    return [(float(start), float(end)) for start, end in sections]


def _section(time: np.ndarray, force: np.ndarray, filtered: np.ndarray, place: np.ndarray,
             lost: list[tuple[float, float]], start: float, end: float) -> dict[str, float]:
    """Return the statistics of one section."""
    inside = (place >= start) & (place <= end)
    mean, deviation = float(filtered[inside].mean()), float(filtered[inside].std())
    begin, stop = np.interp([start, end], place, time)
    parts = [min(b, stop) - max(a, begin) for a, b in lost if a < stop and b > begin]
    return {"start": start, "end": end, "mean": mean, "standard_deviation": deviation,
            "statistical_maximum": mean + 3 * deviation, "statistical_minimum": mean - 3 * deviation,
            "maximum": float(filtered[inside].max()), "minimum": float(filtered[inside].min()),
            "loss_time": float(sum(parts)), "loss_share": float(sum(parts) / (stop - begin)), "losses": len(parts)}


def plot_force(run: Run, axes: Axes, pantograph: str = "pantograph",
               sections: Sequence[tuple[float, float]] | None = None) -> None:
    """Draw the contact force over the track, filtered and not, with mean ± 3 standard deviations by section."""
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
    """Draw the uplift of the contact wire at masts over time; at: their numbers from 0, by default the middle three."""
    values, x = uplift(run), masts(run)
    middle = len(x) // 2
    for k in range(max(middle - 1, 0), min(middle + 2, len(x))) if at is None else at:
        axes.plot(run.time, 1e3 * values[:, k], label=f"mast {k}, {x[k]:g} m")
    axes.set(xlabel="time in s", ylabel="uplift in mm")
    axes.legend(loc="upper right", fontsize="small")


def plot_droppers(run: Run, axes: Axes, span: int, droppers: Sequence[int] | None = None, section: int = 1) -> None:
    """Draw the forces of a span's droppers over time.

    span, of the section, and droppers, by default all, are numbered from 1.
    """
    start = called(section, f"dropper_{span}_")
    every = [name for name in run.scene.point_forces if name.startswith(start)]
    names = every if droppers is None else [f"{start}{k}" for k in droppers]
    for name in names:
        axes.plot(run.time, run[f"{name}.tension"], linewidth=1, label=f"dropper {name.rpartition('_')[2]}")
    of = f" of section {section}" * (section > 1)
    axes.set(xlabel="time in s", ylabel="force in N", title=f"droppers of span {span}{of}")
    axes.set_ylim(bottom=min(0.0, float(np.min([run[f'{name}.tension'].min() for name in names]))))
    axes.legend(loc="upper right", fontsize="small", ncols=3)
