"""Results over time beside a picture, and events on its time line."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...errors import FunicularError
from ...parts.rope import Rope
from ...view.animation import Curve, EventMark
from ..quantities import ENERGIES, Variable
from ..recorded import Recorded
from ..section_forces.balance_limits import known_method
from ..section_forces.forces import of_run as forces_of_run

MAX_ROWS, MIN_ROWS = 2000, 200
"""Bounds of the rows of a curve."""
MAX_NUMBERS = 150_000
"""Numbers of all curves together, unless `MIN_ROWS` need more, for a small page."""
CURVES = (("time",), ("time", "xyz"), ("time", "normal"))
"""Dimensions of results with a curve."""
UNITS = {"m/s2": "m/s²", "rad/s2": "rad/s²"}
AT_WHEELS = ("tension_on", "tension_off", "wrap_angle", "tension", "length_in_store")
"""Results of sheaves and drums in the charts of their rope."""
MAX_TENSIONS = 1000
"""Largest number of times at which the tension at a slide is computed."""


def thinned(count: int, limit: int) -> np.ndarray:
    """Return the numbers of at most ``limit`` of ``count`` rows: every k-th and the last."""
    step = max(1, -(-(count - 1) // max(1, limit - 1)))
    return np.unique(np.append(np.arange(0, count, step), count - 1))


def curves(run: Recorded, notes: list[str]) -> Iterator[Curve]:
    """Yield the results of a run over time: scalars, vectors, the energy balance, the tension at slides."""
    shown = {name: variable for name, variable in run.variables.items()
             if variable.dims in CURVES}
    columns = sum(int(np.prod(variable.values.shape[1:])) for variable in shown.values())
    rows = int(np.clip(MAX_NUMBERS // max(1, columns), MIN_ROWS, MAX_ROWS))
    chosen = thinned(len(run.time), rows)
    if len(chosen) < len(run.time):
        notes.append(f"curves have {len(chosen)} of the run's {len(run.time)} output times")
    time = run.time[chosen]
    yield from _energies(run, chosen)
    for name, slide in run.scene.slides.items():
        if slide.along in run.scene.cables:  # ropes have those at their wheels
            yield from _tension_at(run, name, notes)
    for rope in run.scene.ropes.values():
        yield from _at_wheels(run, rope, chosen)
    together = {f"{wheel.name}.{key}" for rope in run.scene.ropes.values() for wheel in rope.wheels
                for key in AT_WHEELS}
    for name, variable in shown.items():
        if not name.startswith("energy.") and name not in together:
            label = f"{name.rpartition('.')[0]}: {variable.long_name}"
            yield Curve(name, label, UNITS.get(variable.units, variable.units),
                        _columns(run, variable), time, variable.values[chosen])


def _columns(run: Recorded, variable: Variable) -> tuple[str, ...]:
    if len(variable.dims) == 1:
        return ()
    along = run.coords.get(variable.dims[1])
    return (tuple(map(str, along.values)) if along is not None
            else tuple(str(k + 1) for k in range(variable.values.shape[1])))


def _energies(run: Recorded, chosen: np.ndarray) -> Iterator[Curve]:
    """Yield the energies in one chart, and the residual of their balance in another."""
    known = [name for name in ENERGIES if f"energy.{name}" in run]
    if not known:
        return
    time = run.time[chosen]
    energies = np.stack([run[f"energy.{name}"][chosen] for name in known], axis=1)
    yield Curve("energy", "energy", "J", tuple(known), time, energies)
    balance = run.energy_balance()
    yield Curve("energy.balance", "energy balance: residual", "J", (), time, balance.residual[chosen])


def _at_wheels(run: Recorded, rope: Rope, chosen: np.ndarray) -> Iterator[Curve]:
    """Yield charts of a rope: the tensions at its sheaves and drums, the wrap angles, and the lengths in store."""
    names, time = [sheave.name for sheave in rope.sheaves], run.time[chosen]
    drums = [drum.name for drum in rope.drums.values()]
    sides = {f"{name} {side}": f"{name}.tension_{side}" for name in names for side in ("on", "off")}
    sides |= {name: f"{name}.tension" for name in drums}
    angles = {name: f"{name}.wrap_angle" for name in names}
    stores = {name: f"{name}.length_in_store" for name in drums}
    for key, label, unit, columns in (("tension", "tension at sheaves and drums", "N", sides),
                                      ("wraps", "wrap angles", "rad", angles),
                                      ("stores", "lengths in store", "m", stores)):
        if not columns:
            continue
        yield Curve(f"{rope.name}.{key}", f"{rope.name}: {label}", unit, tuple(columns), time,
                    np.stack([run[name][chosen] for name in columns.values()], axis=1))


def _tension_at(run: Recorded, slide: str, notes: list[str]) -> Iterator[Curve]:
    """Yield the tension of the cable on both sides of a slide."""
    name = run.scene.slides[slide].along
    chosen = thinned(len(run.time), MAX_TENSIONS)
    s = np.clip(run[f"{slide}.s"][chosen], 0.0, run.scene.cables[name].length)[:, None]
    try:
        method = known_method(run.scene, run.model, name, False)
        sides = [forces_of_run(run, name, s, chosen, side=side, method=method)["tension"][:, 0]
                 for side in ("before", "after")]
    except (FunicularError, RuntimeError) as error:
        notes.append(f'the tension of "{name}" at slide "{slide}" could not be computed: {error}')
        return
    yield Curve(f"{name}.tension@{slide}", f"{name}: tension at {slide}", "N", ("before", "after"), run.time[chosen],
                np.stack(sides, axis=1))


def events(run: Recorded) -> Iterator[EventMark]:
    """Yield the events with their descriptions."""
    for event in run.report.get("events", []):  # older files have none
        what = f": {event['what']}" if event.get("what") else ""
        place = f" at s = {event['s']:.4g} m" if isinstance(event.get("s"), float) else ""
        yield EventMark(float(event["time"]), f"{event['name']}{what}{place}")
