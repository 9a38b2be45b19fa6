"""Static states of one scene, one after the other, as arrays: what values of many states are read from at once."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Self

import numpy as np

from ..model.states import AT_REST
from .static_problem import StaticState


@dataclass
class Snapshots:
    """T static states of a scene: configurations q (T, n_q), arc-lengths s and forces of slides (T, slides, 3), forces
    between points (T, point forces, 3), what supports give (T, n_dof), forces of joints (T, joints, 7), and the numbers
    of other couplings by their kind, of AT_REST (T, couplings, numbers).
    """

    q: np.ndarray
    s: np.ndarray
    slide_force: np.ndarray
    point_force: np.ndarray
    reaction: np.ndarray
    joint_forces: np.ndarray
    couplings: dict[str, np.ndarray]

    def __len__(self) -> int:
        """Return the number of states."""
        return len(self.q)

    @classmethod
    def of(cls, states: Iterable[StaticState], reactions: bool = True) -> Self:
        """Take the states that these are in when it is their turn: one that moves on counts as several.

        reactions: False where no force is asked for that residuals are needed to know, which saves them.
        """
        rows: list[tuple[np.ndarray, ...]] = []
        couplings: dict[str, list[np.ndarray]] = {kind: [] for kind in AT_REST}
        for state in states:
            if reactions:
                state.residual()
            kept = state.keep()
            rows.append((kept["q"], kept["s"], kept["force"], kept["point_force"], state.engine.reaction(),
                         state.engine.joint_forces()))
            for kind, numbers in couplings.items():
                numbers.append(state.engine.static_outputs(kind))
        q, s, slide_force, point_force, reaction, joint_forces = (np.array(each) for each in zip(*rows, strict=True))
        return cls(q, s, slide_force, point_force, reaction, joint_forces,
                   {kind: np.array(numbers) for kind, numbers in couplings.items()})


@dataclass(frozen=True)
class Reader:
    """What reads values of states.

    read: returns values (T, targets) of snapshots of a scene's states; in_metres (targets,): which are in m; reactions:
    whether snapshots must have what supports give; parts: names of the parts whose results are read; sections: whether
    forces in sections of cables are.
    """

    read: Callable[[StaticState, Snapshots], np.ndarray]
    in_metres: np.ndarray
    reactions: bool
    parts: frozenset[str] = frozenset()
    sections: bool = False

    def values(self, state: StaticState) -> np.ndarray:
        """Return (targets,): the values of a state."""
        return self.read(state, Snapshots.of([state], self.reactions))[0]
