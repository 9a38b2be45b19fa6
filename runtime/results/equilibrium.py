"""The result of `scene.equilibrium()`: a state of rest with the section forces of its cables."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..parts.cable import Cable
from ..parts.rope import Rope
from ..parts.slide import Slide
from ..solve.statics.rest_state import CriticalPoint, RestState
from .section_forces.ropes import section_forces
from .slack import slack_elements
from .viewable import Viewable, titled

if TYPE_CHECKING:
    import xarray
    from numpy.typing import ArrayLike

    from ..view.animation import Animation

__all__ = ["CriticalPoint", "Equilibrium"]


class Equilibrium(Viewable, RestState):
    """A state of rest of a scene, see `RestState`, with the section forces of its cables."""

    def section_forces(self, cable: Cable | Rope | str, s: ArrayLike | Slide | None = None, *, method: str = "balance",
                       side: str = "after") -> xarray.Dataset:
        """Return the forces and moments in sections of ``cable`` like `Run.section_forces`, over s alone.

        The default places include both sides of riders.
        """
        return section_forces(self, cable, s, method=method, side=side)

    def slack_elements(self, cable: Cable | str) -> xarray.DataArray:
        """Return which elements of ``cable`` are slack, (element,): shorter in the middle than at rest."""
        return slack_elements(self, cable)

    def rope_tensions(self, rope: Rope | str) -> xarray.DataArray:
        """Return the range of the tensions of ``rope`` at rest in N, (span, end, limit): at the start and the end of
        each span, at both limits of the friction on the sheaves that do not turn freely.

        At the limit "hoisting" ropes are about to move towards their first items, at "lowering" towards their last
        ones: two more equilibria, see ``impending`` of `EquilibriumSettings`. Raises SceneError without such friction;
        EquilibriumError where a limit has no state of rest.
        """
        from .rope_tensions import rope_tensions  # searches for rest

        return rope_tensions(self, rope)

    def animation(self, title: str | None = None) -> Animation:
        """Return the animation of the state; see `Viewable.animation`."""
        from .animation.clips import of_equilibrium  # for pictures alone

        return of_equilibrium(self, title or titled(self.scene, "at rest") or "equilibrium")

    @property
    def load_path(self) -> LoadPath:
        """Return the load path to this state, for pictures: ``rest.load_path.view()``."""
        return LoadPath(self)

    def overview(self) -> list[tuple[str, str]]:
        """Return the properties of the state for a notebook; see `Viewable.overview`."""
        from .animation.clips import details  # for pictures alone

        return [*details(self).items(), ("iterations", str(self.iterations)),
                *(("note", message) for message in self.messages)]


class LoadPath(Viewable):
    """The states of the load path of one, `RestState.path`, for pictures."""

    def __init__(self, last: Equilibrium):
        """last: the final state of the path."""
        self.last = last

    def __repr__(self) -> str:
        """Return the number of states and their loads."""
        loads = [state.load_fraction for state in self.last.path]
        return f"<funicular.LoadPath: {len(loads)} states, {min(loads):.4g} to {max(loads):.4g} times the loads>"

    def animation(self, title: str | None = None) -> Animation:
        """Return the animation of the path; see `Viewable.animation`. Raises FunicularError for a single state."""
        from .animation.clips import of_path  # for pictures alone

        return of_path(self.last, title or titled(self.last.scene, "load path") or "load path")

    def overview(self) -> list[tuple[str, str]]:
        """Return the properties of the last state for a notebook; see `Viewable.overview`."""
        return [("states", str(len(self.last.path))), *self.last.overview()]
