"""Section forces along the spans of ropes, in which the material moves through the elements.

At rest a span is a cable of the stress-free length that it has then, so that its forces in balance are those of the
cable. In motion the balance would take the accelerations of the material, which a run does not record: there they are
those of the elastic law, whose axial strain is linear in an element.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from ...errors import FunicularError, near
from ...kernels.libraries import kernels_of
from ...model.build import build
from ...model.rope_model import LAW, RopeModel
from ...model.span_coordinates import PER_NODE, SpanCoordinates
from ...model.states import spatial
from ...parts.cable import Cable
from ...parts.locations import grips
from ...parts.part import Part
from ...parts.rope import Rope
from ...parts.scene_data import SceneData
from ...parts.slide import Slide
from ...parts.validation import show
from ...solve.statics.rest_state import RestState
from ..recorded import Recorded
from .cable_loads import Instants
from .components import CABLE
from .forces import DEFAULT_DIVISIONS, GLOBAL, check_words, cut_forces, dataset

if TYPE_CHECKING:
    import xarray
    from numpy.typing import ArrayLike

NAMES = {**GLOBAL, **CABLE}
IN_MOTION = ("in motion are those of the elastic law", 'take method="constitutive"')


def section_forces(state: Recorded | RestState, part: Cable | Rope | str, s: ArrayLike | Slide | None, *, method: str,
                   side: str) -> xarray.Dataset:
    """Return the section forces of a cable or a rope, see `Run.section_forces`."""
    name = part if isinstance(part, str) else part.name
    if (rope := state.scene.ropes.get(name)) is None:
        return dataset(state, name, s, method=method, side=side)
    check_words(name, method, side)
    return _of_rope(state, rope, s, method, side)


def _of_rope(state: Recorded | RestState, rope: Rope, s: ArrayLike | Slide | None, method: str, side: str
             ) -> xarray.Dataset:
    """Return the section forces of a rope. Raises FunicularError for the balance of a run, and for s that are none."""
    import xarray  # 0.5 s, for those who ask for it

    if method == "balance" and not isinstance(state, RestState):
        raise FunicularError(f'section forces of rope "{rope.name}" {IN_MOTION[0]}; {IN_MOTION[1]}')
    if method == "balance" and (acting := next(_acting_on(state.scene, rope), None)) is not None:
        raise FunicularError(f'section forces of rope "{rope.name}" in balance do not contain the forces of the '
                             f'{acting.where}; take method="constitutive"')
    model = next(each for each in state.model.ropes if each.part.name == rope.name)
    coordinates = np.atleast_2d(state[f"{rope.name}.coordinates"])
    q = np.zeros((len(coordinates), state.model.n_q))
    q[:, model.coordinates] = coordinates
    name = s.name if isinstance(s, Slide) else s if isinstance(s, str) else None
    follows = name is not None
    given = None if s is None else (_given(rope, s) if name is None else
                                    _at_slide(state, rope, name) - np.reshape(model.origin(q), (-1, 1)))
    parts = [_Span(model, span, q) for span in model.spans]
    places = [part.divided() if given is None else part.within(given) for part in parts]
    found = [part.forces(at, SceneData(state.scene.gravity), method, side == "after")
             for part, at in zip(parts, places, strict=True)]
    over_time = not isinstance(state, RestState)
    coords: dict[str, Any] = {"xyz": ["x", "y", "z"]}
    of_s = {"units": "m", "long_name": "stress-free arc-length"}
    if not isinstance(state, RestState):
        coords["time"] = ("time", state.time, {"units": "s", "long_name": "time"})
    if given is None:
        axis = "point"
        values = {name: np.concatenate([each[name] for each in found], axis=1) for name in NAMES}
        along = np.concatenate(places, axis=1)
        coords["s"] = (("time",) * over_time + ("point",), along if over_time else along[0], of_s)
        coords["span"] = ("point", np.repeat(np.arange(len(parts)), [at.shape[1] for at in places]),
                          {"long_name": "number of the span, in the rope's order"})
    else:
        axis = "s"
        values = {name: _of_either([each[name] for each in found]) for name in NAMES}
        coords["s"] = ("s", given, of_s)
        if follows:
            values = {name: value[:, 0] for name, value in values.items()}
            coords["s"] = (("time",) * over_time, given[:, 0] if over_time else given[0, 0], of_s)
    dims = ("time",) * over_time + (axis,) * (not follows)
    return xarray.Dataset(
        {name: (dims + ("xyz",) * (name in GLOBAL), values[name] if over_time else values[name][0],
                {"units": unit, "long_name": label}) for name, (unit, label) in NAMES.items()},
        coords, {"rope": rope.name, "element": rope.element, "law": LAW, "method": method, "side": side})


def _acting_on(scene: SceneData, rope: Rope) -> Iterator[Part]:
    """Yield the parts that act on a rope within its spans."""
    yield from (part for part, _, end in grips(scene) if end.on == rope.name)
    yield from (slide for slide in scene.slides.values() if slide.along == rope.name)
    yield from (load for load in scene.loads.values() if getattr(load, "cable", None) == rope.name)
    yield from (drag for drag in scene.drags.values() if drag.on == rope.name)
    yield from (contact for contact in scene.contacts.values() if contact.a == rope.name)


def _at_slide(state: Recorded | RestState, rope: Rope, name: str) -> np.ndarray:
    """Return (T, 1): the arc-length of a slide on a rope, m. Raises FunicularError."""
    slide = state.scene.slides.get(name)
    if slide is None or slide.along != rope.name:
        known = [each.name for each in state.scene.slides.values() if each.along == rope.name]
        raise FunicularError(f'section forces of rope "{rope.name}": s must be arc-lengths in m, or a slide on it, got '
                             f'"{name}"' + (f"; {near(name, known)}" if known else ""))
    return np.atleast_1d(state[f"{name}.s"])[:, None]


def _given(rope: Rope, s: Any) -> np.ndarray:
    """Return given arc-lengths (n,) in m. Raises FunicularError."""
    try:
        found = np.atleast_1d(np.asarray(s, dtype=float))
    except (TypeError, ValueError):
        raise FunicularError(f'section forces of rope "{rope.name}": s must be arc-lengths in m, got {s!r}') from None
    if found.ndim != 1 or not np.isfinite(found).all():
        raise FunicularError(f'section forces of rope "{rope.name}": s must be arc-lengths (n,) in m, got {show(s)}')
    return found


def _of_either(parts: list[np.ndarray]) -> np.ndarray:
    """Return the values that are numbers in one of arrays; not a number where that is none."""
    found = parts[0].copy()
    for each in parts[1:]:
        found = np.where(np.isnan(found), each, found)
    return found


class _Span:
    """A span at T instants: nodal vectors (T, nodes, 2, dim), arc-lengths s of the nodes (T, nodes) in m."""

    def __init__(self, rope: RopeModel, span: SpanCoordinates, q: np.ndarray):
        self.rope = rope
        self.vectors = q[:, span.nodes].reshape(len(q), -1, PER_NODE, span.dim)
        ends = q[:, list(span.s)] - np.reshape(rope.origin(q), (-1, 1))
        self.s = ends[:, :1] + span.share * np.diff(ends)

    def divided(self) -> np.ndarray:
        """Return the default places (T, n), m."""
        share = np.linspace(0, 1, (self.s.shape[1] - 1) * DEFAULT_DIVISIONS + 1)
        found: np.ndarray = self.s[:, :1] + share * (self.s[:, -1:] - self.s[:, :1])
        return found

    def within(self, s: np.ndarray) -> np.ndarray:
        """Return places (n,), or (T, n) of each time, at all times (T, n), m, not numbers where they are off the span.
        """
        inside = (s >= self.s[:, :1]) & (s <= self.s[:, -1:])
        return np.where(inside, s, np.nan)

    def forces(self, s: np.ndarray, scene: SceneData, method: str, after: bool) -> dict[str, np.ndarray]:
        """Return force, moment and components by name at places (T, n) that are numbers; scene: with the gravity."""
        held = np.where(np.isnan(s), self.s[:, :1], s)
        found = self._in_balance(held, scene, after) if method == "balance" else self._by_law(held, after)
        off = np.isnan(s)
        return {name: np.where(off[..., None] if name in GLOBAL else off, np.nan, found[name]) for name in NAMES}

    def _by_law(self, s: np.ndarray, after: bool) -> dict[str, np.ndarray]:
        """Return them by the elastic law."""
        part = self.rope.part
        kernel = getattr(kernels_of(None), f"{part.element}_{LAW}_section_forces")
        instants, n = np.arange(len(s))[:, None], self.s.shape[1] - 1
        share = (s - self.s[:, :1]) / (self.s[:, -1:] - self.s[:, :1]) * n
        node = np.round(share)
        share = np.where(np.abs(share - node) < 1e-9, node, share)
        element = np.clip(np.floor(share) if after else np.ceil(share) - 1, 0, n - 1).astype(int)
        length = (self.s[:, -1:] - self.s[:, :1]) / n
        x = np.clip((share - element) * length, 0.0, length)
        e = np.concatenate([self.vectors[instants, element], self.vectors[instants, element + 1]], axis=2)
        found = kernel.rows(s.size, np.broadcast_to(length, s.shape).ravel(), x.ravel(),
                            e.reshape(-1, *e.shape[2:]), self.rope.stiffness)
        force, moment, axes, strain = (values.reshape(*s.shape, *values.shape[1:]) for values in found)
        tension = np.einsum("tsi,tsi->ts", force, axes[..., 0, :])
        across = np.linalg.norm(force - tension[..., None] * axes[..., 0, :], axis=-1)
        return {"force": force, "moment": moment, "tension": tension, "shear": across, "strain": strain[..., 0],
                "curvature": strain[..., 5]}

    def _in_balance(self, s: np.ndarray, scene: SceneData, after: bool) -> dict[str, np.ndarray]:
        """Return them of the span as a cable at rest, T = 1."""
        part, length = self.rope.part, float(self.s[0, -1] - self.s[0, 0])
        cable = Cable(name="span", start=(0, 0, 0), end=(length, 0, 0), elements=self.s.shape[1] - 1,
                      element=part.element, strain="engineering", curvature="exact", membrane="assumed", up=(0, 1, 0),
                      section=part.section, material=part.warm_material)
        scene.put(cable)
        model = build(scene)
        q = self.vectors.reshape(1, -1)
        results = {"span.nodal_vectors": spatial(self.vectors)}
        at = Instants(np.zeros(1), q, np.zeros((1, model.n_dof)), results.__getitem__, is_rest=True)
        return cut_forces(scene, model, at, "span", s - self.s[:, :1], side="after" if after else "before")
