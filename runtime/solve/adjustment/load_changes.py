"""The change of the residual by values and positions of loads, and by ends of forces between two points, at rest."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import chain
from typing import cast

import numpy as np

from ...model.attachments import ModelBuilder
from ...model.kinds import in_order
from ...model.loads import AnyLoadModel, LoadBuilder
from ...model.signals import Signals
from ...model.states import attachment_points
from ...parts.in_plane import turned
from ...parts.load import DistributedForce, Force, Moment
from ...parts.paths import Path
from ...parts.point_force import PointForce
from .change import Change, Rest, altered, axis_of

AnyLoad = Force | DistributedForce | Moment


def unit_of(rest: Rest, part: AnyLoad, entries: tuple[str, ...]) -> AnyLoad | None:
    """Return the load with a unit value along one axis, None for another entry."""
    if len(entries) != 2 or entries[0] != "value" or rest.reader.sections:
        return None
    unit = part.model_copy(update={"value": axis_of(entries[1])})
    if rest.scene.plane_axes is not None:
        unit = cast(AnyLoad, turned(unit, rest.scene.plane_axes, rest.scene.as_drawn))
    return unit if any(unit.value) and not (rest.model.dim == 2 and any(unit.off_plane())) else None


def by_values(rest: Rest, units: Mapping[int, AnyLoad]) -> dict[int, Change]:
    """Return the changes by loads of unit values, by the numbers of their parameters."""
    if not units:
        return {}
    model = rest.model
    builder = ModelBuilder(rest.scene, model.cables, model.ropes, model.bodies, {})
    builder.signals = Signals(model.signals)
    loads = LoadBuilder(builder)
    owners: dict[str, list[int]] = {"dead": [], "turning": [], "along": []}
    for k, unit in units.items():
        loads.load(unit)
        for kind, of in owners.items():
            of += [k] * (len(getattr(loads, kind)) - len(of))
    others = [coupling for coupling in model.couplings if not isinstance(coupling, AnyLoadModel)]
    couplings = in_order([*loads.all, *others])
    loaded = altered(model, couplings=couplings, signals=builder.signals)
    engine = rest.engine(loaded)
    found = {k: Change(model) for k in units}
    for number, k in enumerate(chain.from_iterable(owners.values())):
        found[k].f += engine.external_forces(number, number + 1)[0]
    return found


def by_end(rest: Rest, part: PointForce, path: Path) -> Change | None:
    """Return the change by an end on the ground, or by its position along a cable: of the gap of the law, and of the
    point of action; None where the law itself depends on the gap as drawn.
    """
    model, ends = rest.model, {"a": part.a, "b": part.b}
    place = ends.get(path.entries[0])
    if place is None or len(path.entries) != 2 or part.name in rest.reader.parts or part.as_made() is not part:
        return None
    number = next(k for k, force in enumerate(model.point_forces) if force.name == part.name)
    force, kept = model.point_forces[number], rest.problem.keep()
    sign, change = -1.0 if path.entries[0] == "a" else 1.0, Change(model)
    if place.on is None:
        moved = rest.along(path.entries[1])
        if moved is None:
            return None
    elif place.on in rest.scene.cables and not rest.reader.sections:
        N, at = rest.shape(place.on, place.arc_length, derivative=1)
        moved = N @ kept["q"][at].reshape(len(N), model.dim)
        change.f[at] = sign * np.outer(N, kept["point_force"][number][: model.dim]).ravel()
    else:
        return None
    a, b = (attachment_points(model, end, kept["q"][None])[0, : model.dim] for end in force.attachments)
    change.g[force.unknown : force.unknown + model.dim] = -sign * force.tangent_at_rest(b - a) @ moved
    return change


def by_place(rest: Rest, part: Force | DistributedForce, path: Path) -> Change | None:
    """Return the change by the position of a load along a cable, or by the start or stop of a distributed one."""
    load = cast(Force | DistributedForce, next(
        mine for mine, drawn in zip(rest.scene.parts(), rest.scene.as_drawn.parts(), strict=True) if drawn is part))
    s = getattr(load, path.entries[0]) if path.entries[0] in ("s", "start", "stop") else None
    on = getattr(load, "cable", None) or getattr(load, "on", None)
    if not isinstance(s, float) or on not in rest.scene.cables or rest.reader.sections or load.follower:
        return None
    N, at = rest.shape(on, s, derivative=int(path.entries[0] == "s"))
    value = float(load.scale.value(0.0)) * np.array(load.value)[: rest.model.dim]
    change = Change(rest.model)
    change.f[at] = (1.0 if path.entries[0] == "start" else -1.0) * np.outer(N, value).ravel()
    return change
