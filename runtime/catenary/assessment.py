"""What a run says of the contact of a pantograph with the wire: filtered force and its statistics, uplift, losses."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from ..errors import SceneError, near

if TYPE_CHECKING:
    import xarray as xr  # brings pandas

    from ..results.run import Run

CUTOFF = 20.0
"""Hz: of the low-pass filter of the contact force."""

ORDER = 4
"""Of the filter in each of its two directions."""

LEAST_SAMPLES = 5.0
"""Output times in a period of the cut-off frequency: fewer tell another force."""


def low_pass(force: np.ndarray, step: float, cutoff: float = CUTOFF, order: int = ORDER) -> np.ndarray:
    """Return a force (time,) that is sampled at equal steps (s), without what is above a frequency (Hz).

    A Butterworth filter, run forwards and backwards, so that it shifts no phase, and adjusted so that the amplitude at
    the cut-off is 1/sqrt(2) after both. Raises SceneError.
    """
    from scipy.signal import butter, sosfiltfilt  # 0.6 s, for that alone

    if not step * cutoff * LEAST_SAMPLES <= 1 + 1e-9:
        raise SceneError("contact force", f"is known at steps of {step:.6g} s, too coarse to filter at {cutoff:g} Hz",
                         f"run with output_step={1 / (LEAST_SAMPLES * cutoff):.6g} s or less")
    corner = cutoff / (np.sqrt(2.0) - 1.0) ** (1 / (2 * order))
    # the filter is made of the tangent of the angle in the step: 20 Hz stay 20 Hz
    warped = np.arctan(np.tan(np.pi * cutoff * step) * corner / cutoff) / (np.pi * step)
    return sosfiltfilt(butter(order, warped, fs=1 / step, output="sos"), force)


def masts(run: Run) -> np.ndarray:
    """Return where the masts of a run's catenary stand, in m along the track."""
    ends = [cable.drawn_through for name, cable in run.scene.cables.items() if name.startswith("messenger_")]
    if not ends or "contact" not in run.scene.cables:
        raise SceneError("run", "is of no catenary: there are no cables \"contact\" and \"messenger_1\"",
                         "make the scene with funicular.catenary.scene")
    return np.array([ends[0][0][0], *(points[-1][0] for points in ends)])


def uplift(run: Run) -> np.ndarray:
    """Return (time, mast): how far the contact wire is above its height at rest at each mast, in m."""
    places = masts(run)
    wire, positions = run.scene.cables["contact"], run["contact.position"]
    at = [int(np.argmin(np.abs(positions[0, :, 0] - x))) for x in places]
    return positions[:, at, 1] - wire.drawn_through[0][1]


def losses(run: Run, pantograph: str = "pantograph") -> list[tuple[float, float]]:
    """Return the times from and to which (s) the collector was off the wire."""
    contact, found, since = f"{pantograph}_contact", [], None
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
    """Return the statistics of a run's contact force in sections of the track, as an xarray dataset.

    sections: from and to, in m along the track; the two spans in the middle if not given, of fewer than four spans all
    that the pantograph has passed. By section, of the force filtered at the cut-off (Hz): its mean, standard_deviation,
    statistical_maximum and statistical_minimum (mean ± 3 standard deviations), maximum and minimum, in N; of the force
    itself the loss_time in s, loss_share of the time in the section, and losses, how many. By mast the largest uplift
    in m; over time the force, filtered and not, and the place of the collector. Raises SceneError.
    """
    import xarray as xr  # brings pandas

    name, time = f"{pantograph}_contact.normal_force", run.time
    if name not in run:
        known = [each.removesuffix("_contact") for each in run.scene.crossings]
        raise SceneError("assessment", f'there is no pantograph "{pantograph}"', near(pantograph, known))
    force, place = run[name], run[f"{pantograph}_1.position"][:, 0]
    steps = np.diff(time)
    whole = len(time) - 1 if abs(steps[-1] - steps[0]) > 1e-6 * steps[0] else len(time)  # the last may be shorter
    filtered = np.append(low_pass(force[:whole], float(steps[0]), cutoff, order), force[whole:])
    rows = [_section(time[:whole], force[:whole], filtered[:whole], place[:whole], losses(run, pantograph), *section)
            for section in _sections(run, sections, place)]
    by_section = {key: ("section", np.array([row[key] for row in rows])) for key in rows[0]}
    found = xr.Dataset({**by_section, "uplift": ("mast", uplift(run).max(axis=0)), "force": ("time", force),
                        "filtered_force": ("time", filtered), "place": ("time", place)},
                       coords={"time": time, "mast": masts(run)},
                       attrs={"cutoff_Hz": cutoff, "filter": f"Butterworth, order {order}, forwards and backwards"})
    for key, unit in UNITS.items():
        found[key].attrs["units"] = unit
    return found


UNITS = {"mean": "N", "standard_deviation": "N", "statistical_maximum": "N", "statistical_minimum": "N", "maximum": "N",
         "minimum": "N", "loss_time": "s", "loss_share": "1", "losses": "1", "start": "m", "end": "m", "uplift": "m",
         "force": "N", "filtered_force": "N", "place": "m", "mast": "m", "time": "s"}


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
