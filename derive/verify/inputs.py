"""Kinds of input on which rounding is measured, made from a family's sample states, whatever the element and the law.

ordinary        the samples
tiny strain     the stress-free shape turned, coordinates off by 1e-9; riders at the cable, too
large rotation  bent by 2.4 rad from end to end, turned by 3 rad; riders in any attitude
far origin      the samples moved by 10⁴ lengths

None lies along the axes: entries that vanish in such a frame alone, such as 1 - i_x², would be compared to digits that
other frames lack.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..codegen.family import Family
from ..spec import Element
from .motion import RIDERS
from .numbers import State
from .samples import SEEDS
from .samples.shapes import director, on_axis, reference, rotation
from .samples.step import following

KINDS = ("ordinary", "tiny strain", "large rotation", "far origin")
SMALL_CHANGE, ORIGIN_DISTANCE = 1e-9, 1e4
ARC_ANGLE, ROTATION_ANGLE, VECTOR_NOISE = 2.4, 3.0, 0.05


@dataclass(frozen=True)
class Input:
    """A state, and the sizes of its values that count for its conditioning: how far it is from the origin does not."""

    kind: str
    state: State
    sizes: State

    def changed(self, sample: State) -> set[str]:
        """Return the names of the values in which it differs from a sample."""
        return {name for name in self.state if self.state[name] is not sample.get(name)}


def inputs(family: Family, samples: list[State]) -> Iterator[tuple[Input, State]]:
    """Yield every input with the sample that it was made from."""
    for number, sample in enumerate(samples[: len(SEEDS)]):  # the one after these is at rest along the axes
        random = np.random.default_rng(number)
        yield Input("ordinary", sample, sample), sample
        for kind, changes in (("tiny strain", _tiny(family, sample, random)),
                              ("large rotation", _turned(family, sample, random))):
            state = sample | changes
            if family.element and "director" in sample:
                state["director"] = director(family.element, state, random)
            yield Input(kind, state, state), sample
        yield Input("far origin", sample | _far(family, sample, random), sample), sample


def _tiny(family: Family, s: State, random: np.random.Generator) -> dict[str, np.ndarray]:
    changes, near = {}, np.zeros(_dim(family))
    if element := family.element:
        e = s["e0"] if "e0" in s else reference(element, float(s["l"]))
        e = e @ rotation(random, element.dim).T
        changes["e"] = e + SMALL_CHANGE * random.normal(size=e.shape)
        changes["e_next"] = e @ rotation(random, element.dim).T + SMALL_CHANGE * random.normal(size=e.shape)
        near = on_axis(element, s | changes)
    if family.rider:
        rider = RIDERS[family.rider]
        changes |= rider.at_rest(near)
        changes["b"] = rider.moved(np, changes["b"], SMALL_CHANGE * random.normal(size=rider.n_velocity))
        changes["b_next"] = rider.moved(np, changes["b"], SMALL_CHANGE * random.normal(size=rider.n_velocity))
    if family.role == "body":
        changes["step"] = SMALL_CHANGE * s["step"]
    return changes


def _turned(family: Family, s: State, random: np.random.Generator) -> dict[str, np.ndarray]:
    changes, near = {}, np.zeros(_dim(family))
    if element := family.element:
        e = _arc(element, float(s["l"]))
        e += VECTOR_NOISE * random.normal(size=e.shape)
        changes["e"] = e @ rotation(random, element.dim, angle=ROTATION_ANGLE).T
        near = on_axis(element, s | changes)
    if family.rider:
        rider = RIDERS[family.rider]
        changes |= rider.sample(random, near)
        turn = np.zeros(rider.n_velocity)
        turn[rider.rotations][:1] = ROTATION_ANGLE
        changes["b"] = rider.moved(np, changes["b"], turn)
    if family.role == "body":
        changes["step"] = ROTATION_ANGLE / np.linalg.norm(s["step"][rider.rotations]) * s["step"]
    return changes | following(family, s | changes, random)


def _arc(element: Element, l: float) -> np.ndarray:
    """Return the straight element bent to an arc in the plane x y."""
    e, per_node = reference(element, l), len(element.nodal_vectors)
    for k, ratio in enumerate(element.node_ratios):
        angle = ARC_ANGLE * (float(ratio) - 0.5)
        c, s = np.cos(angle), np.sin(angle)
        rows = slice(k * per_node, (k + 1) * per_node)
        e[rows, :2] = e[rows, :2] @ np.array([[c, s], [-s, c]])
        positions = np.flatnonzero(element.is_position[rows]) + rows.start
        e[positions, :2] = l / ARC_ANGLE * np.array([s, -c])
    return e


def _far(family: Family, s: State, random: np.random.Generator) -> dict[str, np.ndarray]:
    offset = random.normal(size=_dim(family))
    offset *= ORIGIN_DISTANCE * float(s.get("l", 1.0)) / np.linalg.norm(offset)
    changes: dict[str, np.ndarray] = {}
    if family.element:
        shift = np.outer(np.array(family.element.is_position, dtype=float), offset)
        changes = {str(name): s[name] + shift for name in ("e", "e0", "e_next") if name in s}
    if family.rider:
        rider = RIDERS[family.rider]
        motion = np.zeros(rider.n_velocity)
        motion[: len(offset)] = offset
        changes |= {name: rider.moved(np, s[name], motion) for name in ("b", "b_next")}
    return changes


def _dim(family: Family) -> int:
    return family.dim or (family.element.dim if family.element else RIDERS[family.rider or ""].dim)
