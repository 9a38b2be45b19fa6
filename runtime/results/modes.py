"""The result of `scene.modes()`: natural vibrations with pictures."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import TYPE_CHECKING

import numpy as np

from ..parts.scene_data import SceneData
from ..solve.modes import modes as solved
from ..solve.statics.rest_state import RestState
from .viewable import Viewable, titled

if TYPE_CHECKING:
    from ..view.animation import Animation

__all__ = ["Modes"]


@dataclass(repr=False)
class Modes(Viewable, solved.Modes):
    """Natural vibrations of a scene, see `funicular.solve.modes.modes.Modes`.

    scene: the scene; about: the state of equilibrium of the vibrations, None for the scene as drawn.
    """

    scene: SceneData | None = None
    about: RestState | None = None

    @classmethod
    def of(cls, found: solved.Modes, scene: SceneData, about: RestState | None) -> Modes:
        """Return the modes with their scene."""
        return cls(**{field.name: getattr(found, field.name) for field in fields(found)}, scene=scene, about=about)

    def __repr__(self) -> str:
        """Return their number and the range of their frequencies."""
        if not len(self):
            return "<funicular.Modes: none>"
        return (f"<funicular.Modes: {len(self)}, {np.min(self.frequency):.4g} to {np.max(self.frequency):.4g} Hz, "
                f"{len(self.shapes)} shapes>")

    def animation(self, title: str | None = None) -> Animation:
        """Return the animation of the modes, one clip each; see `Viewable.animation`."""
        from .animation.clips import of_modes  # for pictures alone
        from .animation.sources import drawn

        assert self.scene is not None, "modes are made by Scene.modes"
        about = drawn(self.scene) if self.about is None else self.about.quantities
        state = "as drawn" if self.about is None else "about rest"
        return of_modes(self, self.scene, about, title or titled(self.scene, f"modes {state}") or f"modes {state}")

    def overview(self) -> list[tuple[str, str]]:
        """Return the frequencies for a notebook; see `Viewable.overview`."""
        return [*((f"mode {k}", f"{frequency:.6g} Hz" + (f", grows by {growth:.4g} 1/s" if growth else ""))
                  for k, (frequency, growth) in enumerate(zip(self.frequency, self.growth_rate, strict=True), start=1)),
                *(("note", message) for message in self.messages)]
