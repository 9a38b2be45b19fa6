"""Ropes that stick to their sheaves at rest.

All points of the wraps stick at first. Those that ask for more than the limit of friction then slide to where friction
is at its limit, as the ends of a wrap do where the tension beside it has changed; the others keep their place.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...engine import outputs_by_name
from ...model.rope_wheels import SheaveModel
from ...parts.validation import show
from .static_problem import StaticProblem

STICKS = 2
"""The mode of a point that sticks; others are directions of sliding, 1 and -1."""
EXCESS_TOLERANCE = 1e-7
"""Of friction over its limit, relative, as of runs: at rest they keep what sticks here."""
FORCE_TOLERANCE = 1e-12
"""The same of a point without normal force, over EA."""
SLIP_TOLERANCE = 1e-12
"""Of sliding against its direction, over the size of the scene."""
MAX_STRAIN_ERROR = 0.02
"""Of a slope beside a sheave from the strain of the tension there: folds of a span without tension are larger."""
MAX_CHANGES = 200
"""Changes of which points slide, at most."""


class HeldWraps:
    """The wraps of a static problem whose ropes stick, from its present state on."""

    def __init__(self, problem: StaticProblem):
        self.problem, self.engine = problem, problem.engine
        self.sheaves = [sheave for sheave in problem.model.sheaves if sheave.sticks]
        self.of_point = np.repeat(np.arange(len(self.sheaves)), [len(sheave.points) for sheave in self.sheaves])
        self.needed: dict[str, float] = {}  # coefficients of friction with which all points stick, by sheave
        self.settled = True
        self.engine.hold_wraps()

    def settle(self) -> bool:
        """Let points slide where friction is at its limit, from a state of rest in which all stick; return whether a
        state of rest was found.
        """
        self.needed = dict(self._needed())
        self.problem.messages += self._without_friction()
        self.settled = self._found()
        return self.settled

    def _found(self) -> bool:
        """Do the same by changing which points slide."""
        seen: set[tuple[int, ...]] = set()
        for _ in range(MAX_CHANGES):
            modes, points = self.engine.held_wraps()
            changed = self._changed(modes, points, tuple(modes) in seen)
            if np.array_equal(changed, modes):
                return True
            seen.add(tuple(modes))
            self.engine.set_held_wraps(changed)
            if not self.problem.newton():
                return False
        return False

    def _changed(self, modes: np.ndarray, points: np.ndarray, one: bool) -> np.ndarray:
        """Return the next modes of the points: those above the limit slide; without any, the point sticks that has slid
        furthest against its direction. one: of the points above the limit the worst alone.
        """
        found, (f, limit, slip) = modes.copy(), points.T
        EA = np.array([sheave.A[0] for sheave in self.sheaves])[self.of_point]
        excess = np.where(modes == STICKS, np.abs(f) - (1 + EXCESS_TOLERANCE) * limit - FORCE_TOLERANCE * EA, 0.0)
        back = np.where(modes == STICKS, 0.0, -modes * slip)
        if excess.max() > 0:
            loose = excess == excess.max() if one else excess > 0
            found[loose] = np.sign(f[loose])
        elif back.max() > SLIP_TOLERANCE * self.problem.size:
            found[np.argmax(back)] = STICKS
        return found

    def _needed(self) -> Iterator[tuple[str, float]]:
        """Yield the coefficients of friction that hold the tensions beside sheaves, infinite without tension."""
        numbers = outputs_by_name("sheave", self.engine.static_outputs("sheave"))
        for k, sheave in enumerate(self.problem.model.sheaves):
            on, off, wrap = (float(numbers[name][k]) for name in ("tension_on", "tension_off", "wrap_angle"))
            yield sheave.name, abs(np.log(on / off)) / wrap if min(on, off, wrap) > 0 else np.inf

    def _without_friction(self) -> Iterator[str]:
        """Yield messages on sheaves without friction on which ropes of given lengths of spans slide."""
        q = self.problem.keep()["q"]
        for rope in self.problem.model.ropes:
            if rope.route.free is None:
                continue
            for item, arc, beside in zip(rope.part.sheaves, rope.route.sheaves, rope.route.beside_sheaves, strict=True):
                on, off = (rope.route.stretch_of(k) - 1 for k in beside)
                if item.coefficient or on == off:
                    continue
                needed = f"{abs(np.log(off / on)) / arc.wrap:.4g}" if min(on, off, arc.wrap) > 0 else "any size not"
                found = [f"{q[rope.spans[k].s[1]] - q[rope.spans[k].s[0]]:.6g}" for k in beside]
                yield (f"{rope.part.where} slides on {item.where}, which has no friction, to lengths of "
                       f"{' and '.join(found)} m beside it; as drawn a coefficient of {needed} holds it")

    def _sliding(self) -> list[tuple[SheaveModel, float]]:
        """Return the sheaves on which all points slide in one direction, with the least sliding of a point in m."""
        modes, points = self.engine.held_wraps()
        found = []
        for k, sheave in enumerate(self.sheaves):
            own = modes[self.of_point == k]
            if own[0] != STICKS and np.all(own == own[0]):
                found.append((sheave, float(np.abs(points[self.of_point == k, 2]).min())))
        return found

    def _slack(self) -> Iterator[str]:
        """Yield in words which spans beside sheaves have folds: their material, which stays, is longer than they."""
        q, numbers = self.problem.keep()["q"], outputs_by_name("sheave", self.engine.static_outputs("sheave"))
        for k, sheave in enumerate(self.problem.model.sheaves):
            for node, name in zip(sheave.nodes, ("tension_on", "tension_off"), strict=True):
                dim = sheave.before.dim
                strain, held = np.linalg.norm(q[node + dim : node + 2 * dim]) - 1, numbers[name][k] / sheave.A[0]
                if abs(strain - held) > MAX_STRAIN_ERROR:
                    yield (f'a span beside sheave "{sheave.name}" is slack, or its elements are too few: its strain '
                           f"there is {strain:.3g}, that of its tension {held:.3g}; the state")

    def causes(self) -> str:
        """Return in words why ropes do not stick, with the friction that they need, and which state is the last one of
        the search; else "".
        """
        if slack := next(self._slack(), ""):
            return slack
        sliding = []
        for sheave, slip in self._sliding():
            needed, given = self.needed[sheave.name], f"its coefficient of friction {show(sheave.friction)}"
            sliding.append(f'the rope slides on sheave "{sheave.name}"{f" by {slip:.4g} m" * self.settled}'
                           + (f": {given} is below {needed:.9g}, with which it sticks" if needed > sheave.friction else
                              ", with what slides beside it"))
        if self.settled:
            return "; ".join([*sliding, "the state after sliding"] if sliding else [])
        return "; ".join([*sliding, "no state of rest was found with friction at its limit where it slides, and the "
                          "state in which all of it sticks"])
