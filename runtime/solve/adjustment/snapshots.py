"""Static states of one scene as arrays, from which the values of many states are read at once."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Self

import numpy as np

from ...model.part_states import States, numbers_at_rest
from ..statics.static_problem import StaticState


@dataclass
class Snapshots:
    """T static states of a scene: configurations q (T, n_q), arc-lengths s (T, slides), reactions (T, n_dof), and
    outputs of couplings by kind, (T, couplings, numbers).
    """

    q: np.ndarray
    s: np.ndarray
    reaction: np.ndarray
    couplings: dict[str, np.ndarray]

    def __len__(self) -> int:
        """Return the number of states."""
        return len(self.q)

    @classmethod
    def of(cls, states: Iterable[StaticState], reactions: bool = True) -> Self:
        """Take the present states; one that moves between two iterations counts as several.

        reactions: False where no value needs residuals, which saves these.
        """
        rows: list[tuple[np.ndarray, ...]] = []
        couplings: list[dict[str, np.ndarray]] = []
        for state in states:
            if reactions:
                state.residual()
            kept = state.keep()
            rows.append((kept["q"], kept["s"], state.engine.reaction()))
            couplings.append(numbers_at_rest(state.engine))
        q, s, reaction = (np.array(each) for each in zip(*rows, strict=True))
        return cls(q, s, reaction, {kind: np.array([each[kind] for each in couplings]) for kind in couplings[0]})

    def states(self) -> States:
        """Return them in the form from which results of parts are read."""
        return States.at_rest(self.q, self.s, self.reaction, self.couplings)


@dataclass(frozen=True)
class Reader:
    """Reads values of states.

    read: returns values (T, targets) of snapshots of a scene's states; in_metres (targets,): which are in m; reactions:
    whether snapshots need reactions; parts: names of the parts whose results are read; sections: whether forces in
    sections of cables are read.
    """

    read: Callable[[StaticState, Snapshots], np.ndarray]
    in_metres: np.ndarray
    reactions: bool
    parts: frozenset[str] = frozenset()
    sections: bool = False

    def values(self, state: StaticState) -> np.ndarray:
        """Return (targets,): the values of a state."""
        return np.asarray(self.read(state, Snapshots.of([state], self.reactions))[0])
