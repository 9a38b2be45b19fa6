"""The result of `scene.linearise()`: a linear model of small motions about a state of rest."""

from __future__ import annotations

from dataclasses import dataclass, fields
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import SceneError
from ..parts.scene_data import SceneData
from ..parts.validation import shown
from ..solve.linearisation.linearise import Linearised
from ..solve.statics.rest_state import RestState

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

__all__ = ["LinearModel"]


@dataclass(frozen=True, eq=False, repr=False)
class LinearModel(Linearised):
    """The linear model x' = A x + B u, y = C x + D u about a state of rest; x, u and y are changes from it.

    A (states, states), B (states, inputs), C (outputs, states), D (outputs, inputs). states, inputs, outputs: their
    names; state_units, input_units, output_units: their units; input_values, output_values: those at rest. The first
    half of the states are coordinates, then come their rates, then positions of what inputs drive by a velocity.
    mass, damping, stiffness (n, n): of the n coordinates. basis: what the coordinates are, in words. With inputs that
    prescribe positions, coordinates are those beyond the motion that follows the input without force of inertia, and
    rates those beyond the jump that a force by the input's rate causes. scene, about: the scene and its state, None as
    drawn. messages: what the model holds, linearises or leaves out.
    """

    scene: SceneData | None = None
    about: RestState | None = None

    @classmethod
    def of(cls, found: Linearised, scene: SceneData, about: RestState | None) -> LinearModel:
        """Return the model with its scene."""
        return cls(**{field.name: getattr(found, field.name) for field in fields(found)}, scene=scene, about=about)

    def __repr__(self) -> str:
        """Return the numbers of states, inputs and outputs."""
        return (f"<funicular.LinearModel: {len(self.states)} states, {len(self.inputs)} inputs, "
                f"{len(self.outputs)} outputs>")

    @property
    def poles(self) -> np.ndarray:
        """Return the eigenvalues (states,) of A in 1/s, by rising magnitude."""
        if self.squares is not None:
            roots = np.sqrt(-self.squares.astype(complex))
            found = np.concatenate([roots, -roots])
        else:
            found = np.linalg.eigvals(self.A).astype(complex)
        found = found + 0.0  # no -0
        return found[np.lexsort((-found.imag, -found.real, np.round(np.abs(found), 12)))]

    def response(self, frequency: ArrayLike | None = None, *, angular_frequency: ArrayLike | None = None) -> np.ndarray:
        """Return the frequency response (..., outputs, inputs), complex: y over u at each frequency.

        frequency: in Hz, or angular_frequency in rad/s, of any shape (...). Raises SceneError where neither or both are
        given, and at a pole.
        """
        if (frequency is None) == (angular_frequency is None):
            raise SceneError("response", "give frequency in Hz or angular_frequency in rad/s, one of them")
        given = angular_frequency if frequency is None else frequency
        try:
            w = np.asarray(given, dtype=float)
        except (TypeError, ValueError):
            w = np.array(np.nan)
        if not np.isfinite(w).all():
            raise SceneError("response", f"frequencies must be finite numbers, got {shown(given)}")
        w = w if frequency is None else 2 * np.pi * w
        identity = np.eye(len(self.states))
        try:
            each = [self.C @ np.linalg.solve(1j * value * identity - self.A, self.B) + self.D for value in w.ravel()]
        except np.linalg.LinAlgError:
            raise SceneError("response", "the model has a pole at one of these frequencies, where its response is "
                             "infinite", "take others, or add damping") from None
        return np.array(each, dtype=complex).reshape(*w.shape, len(self.outputs), len(self.inputs))

    def state_space(self) -> Any:
        """Return the model as python-control's ``StateSpace`` with names if it is installed, else as that of
        scipy.signal.
        """
        if find_spec("control") is not None:
            import control  # slow to import, where it is installed

            return control.ss(self.A, self.B, self.C, self.D, states=list(self.states), inputs=list(self.inputs),
                              outputs=list(self.outputs))
        from scipy.signal import StateSpace  # slow to import

        return StateSpace(self.A, self.B, self.C, self.D)
