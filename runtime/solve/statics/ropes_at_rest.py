"""Ropes of a given tension at rest among the bodies as drawn, which gives their stress-free lengths.

Without friction W - T lambda - rho g . r is the same all along a rope at rest, with the energy W of a stress-free
length, the tension T and the stretch lambda. This is the force on the arc-length at an anchor where more rope is
supplied there. With this force of the given tension at the first point, that arc-length is an unknown; afterwards it is
held. The mesh makes a small difference between the force and the tension at the first point, which a few corrections
remove.
"""

from __future__ import annotations

import numpy as np

from ...engine import Engine, outputs_by_name
from ...errors import SceneError
from ...model.build import build
from ...model.model import Model
from ...model.rope_model import RopeModel
from ...model.rope_states import in_groove
from ...model.states import attachment_points
from ...model.taut_ropes import TautPointModel
from ...parts.attachment import Attachment
from ...parts.rope import Rope
from ...parts.rope_drawing import Holders, place_of
from ...parts.rope_items import Anchor, Drum, RouteItem
from ...parts.rope_route import ANGLE_ROUNDING, MIN_WRAP
from ...parts.scene_data import SceneData
from ...parts.validation import show
from ..linear.solver import solver

MAX_ITERATIONS = 50
MAX_CORRECTIONS = 12
TOLERANCE = 1e-12
"""Of the last correction of positions, over the length of the rope, and of strains."""
MAX_CORRECTION_GROWTH = 1e3
"""Ratio of a correction to the smallest one before above which Newton's method diverges."""
MAX_TENSION_RATIO = 2.0**12
"""Of the first tension at which rest is sought to the given one."""
MIN_TENSION_RATIO = 1.002
"""Of two tensions in turn below which the search ends."""
TENSION_TOLERANCE = 1e-10
"""Of the tension at the first point, relative."""
SMALL_WRAP = 0.05
"""Wrap angle in rad below which a rope leaves its sheave where Newton's method finds no state of less tension."""
STILL = {"inertia": 0.0, "torque": None, "angle": None, "velocity": None, "damping": 0.0}
"""The entries of a sheave or a drum that is held."""


def with_ropes_at_rest(model: Model, scene: SceneData) -> np.ndarray:
    """Return the configuration (n_q,) of a model as drawn with its ropes of a given tension at rest.

    Raises SceneError where such a rope leaves a sheave at rest.
    """
    q = model.q.copy()
    for rope in model.ropes:
        if rope.supply >= 0:
            found = _Supplied(scene, rope.part)
            found.come_to_rest()
            _take(q, rope, found.engine.state()["q"], found.rope)
    return q


def off_sheaves(model: Model, engine: Engine) -> str:
    """Return where a rope of a static state has left a sheave, a span has no length, or something that holds to a rope
    or slides along it has come to the end of a span, in words, else "".
    """
    if not model.ropes:
        return ""
    q = engine.state()["q"]
    numbers = outputs_by_name("sheave", engine.static_outputs("sheave")) if model.sheaves else {}
    for k, sheave in enumerate(model.sheaves):
        if not sheave.has_contact(q):
            if numbers["gap"][k] < 0.0:
                return f'the rope touches sheave "{sheave.name}", which has contact=False'
            continue
        centre = attachment_points(model, sheave.attachments[0], q[None])[0, : model.dim]
        dim = model.dim
        folded = any(sheave.sense * np.linalg.det([in_groove(model, sheave, q[None], vector[None])[0] for vector in (
            q[at : at + dim] - centre, q[at + dim : at + 2 * dim])]) <= 0
                     for at in sheave.nodes)  # its slope is tangent, but against the sense of travel
        if folded or numbers["wrap_angle"][k] < MIN_WRAP:
            return f'the rope leaves sheave "{sheave.name}"'
        if min(numbers[name][k] for name in ("normal_force", "tension_on", "tension_off")) < 0.0:
            return f'the rope lifts off sheave "{sheave.name}": it has no tension there'
    numbers = outputs_by_name("drum", engine.static_outputs("drum")) if model.drums else {}
    for k, drum in enumerate(model.drums):
        if numbers["length_in_store"][k] < 0.0:
            return f'drum "{drum.name}" is empty'
        if numbers["normal_force"][k] < 0.0:
            return f'the rope lifts off drum "{drum.name}": it has no tension there'
    if points := model.of(TautPointModel):
        numbers = outputs_by_name("taut_point", engine.static_outputs("taut_point"))
        for k, point in enumerate(points):
            if numbers["touches"][k] and not numbers["wrap_angle"][k] >= -ANGLE_ROUNDING:
                return f'the rope leaves sheave "{point.name}"'
            if numbers["touches"][k] and numbers["aside"][k]:
                return (f'the rope comes onto sheave "{point.name}" beside the middle of its groove, so that its place '
                        "along the axis is not known")
    for span in model.spans:
        if q[span.span_s[1]] - q[span.span_s[0]] < span.least_length:
            return f'a span of rope "{span.name}" becomes too short to be modelled'
        if (end := span.end_of_grips(q)) is not None:
            return span.reached(end)
    for slide, s in zip(model.slides, engine.state()["s"], strict=True):
        first, last = slide.ends_at(model, q)
        if slide.cable < 0 and not first <= s <= last:
            return slide.reached(int(s > last))
    return ""


class _Supplied:
    """A rope alone, held at the places as drawn, with a supply at an anchor.

    sign: 1 where this is the last item of the route, else -1; kept: the material coordinate at the other end.
    """

    def __init__(self, scene: SceneData, part: Rope):
        alone = SceneData(scene.gravity)
        alone.put(part.model_copy(update={"route": tuple(_still(item, scene.holders) for item in part.route)}))
        self.part, self.model = part, build(alone, supplied=True)
        self.rope, = self.model.ropes
        self.engine = Engine(self.model)
        self.engine.set_state(0.0)
        ends = self.rope.spans[0].s[0], self.rope.spans[-1].s[1]
        self.sign = 1.0 if self.rope.supply == ends[1] else -1.0
        self.at, self.kept = self.model.unknown_of_dof[self.rope.supply], ends[0 if self.sign > 0 else 1]
        free = self.model.unknown_of_dof >= 0
        self.weight = np.zeros(self.engine.unknowns)
        self.weight[self.model.unknown_of_dof[free]] = self.model.weight[free]
        self.EA, self.cause = part.stiffness[0], ""
        self.first = self.rope.spans[0].node(0).start
        self.height = float(self.rope.rho * np.array(scene.gravity)[: self.model.dim] @ self.place)

    @property
    def place(self) -> np.ndarray:
        """Return the place of the first point, m."""
        found: np.ndarray = self.engine.state()["q"][self.first : self.first + self.model.dim]
        return found

    def come_to_rest(self) -> None:
        """Find rest at the given tension, or from greater ones on. Raises SceneError."""
        assert self.part.tension is not None, "the tension decides on the supply"
        given, ratio, tension = self.part.tension, 2.0, self.part.tension
        while not self._rests(tension):
            tension *= ratio
            self._draw(tension)
            if tension > MAX_TENSION_RATIO * given:
                raise self._refused(self.engine.state(), tension)
        while tension > given:
            kept, lower = self.engine.state(), max(given, tension / ratio)
            if self._rests(lower):
                tension = lower
                continue
            self.engine.set_state(0.0, **kept, prescribe=True)
            ratio = ratio**0.5
            if ratio < MIN_TENSION_RATIO:
                raise self._refused(kept, tension)

    def _draw(self, tension: float) -> None:
        """Go to the state as drawn, with the stretch of another tension."""
        longer = self.rope.route.stretch / (1 + tension / self.EA)
        q, spans = self.model.q.copy(), self.rope.spans
        s = np.unique(np.concatenate([*(span.s for span in spans), *(sheave.s for sheave in self.rope.sheaves)]))
        q[s] = q[self.kept] + longer * (q[s] - q[self.kept])
        for span in spans:
            q[span.nodes].reshape(-1, 2, span.dim)[:, 1] /= longer
        self.engine.set_state(0.0, q)

    def _rests(self, tension: float) -> bool:
        """Come to rest with a tension at the first point; return whether that was found, on the route."""
        force = -tension - tension**2 / (2 * self.EA) - self.height
        for _ in range(MAX_CORRECTIONS):
            if not self._newton(force):
                return False
            if left_route := off_sheaves(self.model, self.engine):
                self.cause = left_route
                return False
            left = self._tension() - tension
            if abs(left) <= TOLERANCE * self.EA + TENSION_TOLERANCE * tension:
                return True
            force += (1 + tension / self.EA) * left
        return False

    def _newton(self, force: float) -> bool:
        """Run Newton's method with a force on the supply; return whether it converged."""
        least, size = np.inf, self.rope.route.length
        for _ in range(MAX_ITERATIONS):
            residual = self.engine.static_residual()
            residual[self.at] -= self.sign * force
            try:
                change = solver(self.engine.matrix(0.0, 0.0, 1.0))(-residual)
            except RuntimeError:
                return False
            step = float(np.linalg.norm(self.weight * change))
            if not step < min(MAX_CORRECTION_GROWTH * least, 10.0 * size):
                return False
            self.engine.move(change)
            least = min(least, step)
            if step <= TOLERANCE * size:
                return True
        return False

    def _tension(self) -> float:
        """Return the tension at the first point, N."""
        if isinstance(self.part.route[0], Drum):
            return float(outputs_by_name("drum", self.engine.static_outputs("drum"))["tension"][0])
        self.engine.static_residual()
        return float(np.linalg.norm(self.engine.reaction()[self.first : self.first + self.model.dim]))

    def _refused(self, kept: dict[str, np.ndarray], tension: float) -> SceneError:
        """Return the error of a rope that is not at rest below a tension, from this state on."""
        self.engine.set_state(0.0, **kept, prescribe=True)
        if self.model.sheaves:
            wraps = outputs_by_name("sheave", self.engine.static_outputs("sheave"))["wrap_angle"]
            if wraps.min() < SMALL_WRAP:
                self.cause = f'the rope leaves sheave "{self.model.sheaves[int(np.argmin(wraps))].name}"'
        assert self.part.tension is not None, "as above"
        return SceneError(self.part.where, f"has no state of rest with the tension {show(self.part.tension, 'N')} at "
                          f"its first point among the bodies as drawn: at less than {tension:.4g} N "
                          + (self.cause or "none was found"),
                          "give more tension, or the length" + "; or leave the sheave out" * bool(self.cause))


def _still(item: RouteItem, holders: Holders) -> RouteItem:
    """Return an item of a route, held at its place as drawn."""
    place = tuple(place_of(item.end, holders).tolist())
    if isinstance(item, Anchor):
        return item.model_copy(update={"on": None, "at": place, "s": None})
    return item.held_at(Attachment.model_construct(on=None, at=place)).model_copy(update=STILL)


def _take(q: np.ndarray, rope: RopeModel, found: np.ndarray, alone: RopeModel) -> None:
    """Put the coordinates of a rope alone into a configuration of its scene, without rotations of its wheels."""
    for span, other in zip(rope.spans, alone.spans, strict=True):
        q[span.nodes] = found[other.nodes]
        q[list(span.s)] = found[list(other.s)]
    for sheave, same in zip(rope.sheaves, alone.sheaves, strict=True):
        q[sheave.s] = found[same.s]
