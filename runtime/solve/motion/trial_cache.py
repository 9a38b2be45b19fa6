"""Cache of integrator trials for scenes of one shape: a method that lost in the first scene is not tried again."""

from __future__ import annotations

from dataclasses import field
from typing import TYPE_CHECKING

from ...base.deferred import dataclass
from ...parts.scene_data import SceneData

if TYPE_CHECKING:  # bring SciPy
    from ...integrators import Integrator
    from .integrator_choice import Rival

MAX_COST_RATIO = 2.0
"""Cost of a scene over that of the first scene's rival above which the scene runs a trial of its own."""


@dataclass
class TrialCache:
    """The outcome of the first scene's trials.

    Each scene selects its method from its own data. If that leads to a trial that the first scene lost, the rival runs,
    whose cost is known beforehand. A successful trial costs nothing and is repeated.

    shape: of the first scene, where that lost a trial; lost: the cost of the rival by the names of both methods;
    returned: the names of a method that lost and of its rival that lost to it afterwards, of more than its expected
    cost; is_open: until the end of the first scene, whose trials count.
    """

    shape: tuple[object, ...] = ()
    lost: dict[tuple[str, str], float] = field(default_factory=dict)
    returned: set[tuple[str, str]] = field(default_factory=set)
    is_open: bool = True

    def of(self, scene: SceneData, method: Integrator, reason: str,
           rival: Rival | None) -> tuple[Integrator, str, Rival | None]:
        """Return the choice for a scene, as `choose` does, from its choice by its own numbers."""
        of_first = " on trial lost in the first scene, which has the same shape"
        if rival is not None and (method.name, rival.method.name) in self.returned and shape_of(scene) == self.shape:
            return method, f"{reason}; {rival.method.name}{of_first}", None
        while rival is not None and self._lost(method, rival) and shape_of(scene) == self.shape:
            reason += f"; {method.name}{of_first}"
            method, rival = rival.method, rival.rival
        return method, reason, rival

    def _lost(self, method: Integrator, rival: Rival) -> bool:
        """Return whether the first scene lost this trial, with a rival that was not much cheaper."""
        return rival.cost <= MAX_COST_RATIO * self.lost.get((method.name, rival.method.name), 0.0)

    def note(self, scene: SceneData, method: Integrator, rival: Rival) -> None:
        """Keep the lost trial of a method in the first scene."""
        if self.is_open:
            self.shape = shape_of(scene)
            self.lost[method.name, rival.method.name] = rival.cost
            if (rival.method.name, method.name) in self.lost:
                self.returned.add((rival.method.name, method.name))


def shape_of(scene: SceneData) -> tuple[object, ...]:
    """Return the key of scenes of one shape: parts by kind and name, elements, meshes and laws."""
    return scene.dim, *((type(part), part.given_name) for part in scene.parts()), *(
        (cable.element, cable.elements, cable.law, cable.library) for cable in scene.cables.values())
