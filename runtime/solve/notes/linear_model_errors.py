"""The error of the linear model of motion about the start, where it exceeds the tolerance."""

from __future__ import annotations

from ...engine import Engine
from ...integrators import stable_at
from ...parts.settings import RunSettings

FIXED_STEP_SHARE = 1e-2
"""Of the largest motion: error of the model above which it is noted in a run with a fixed step, without a tolerance."""


def beyond_linear_model(engine: Engine, settings: RunSettings) -> list[str]:
    """Return a note where the forces that the linear model leaves out displace the scene by more than is allowed."""
    if engine.linear_error is None:
        return []
    error, time = engine.linear_error
    motion = engine.controlled_motion
    share = settings.tol if settings.step is None else FIXED_STEP_SHARE
    if error <= share * motion + engine.absolute_tol:
        return []
    return [f"the linear model of motion about the start is off by up to {error:.3g} m at t = {time:.6g} s, "
            f"{100 * error / motion:.2g} % of the largest motion that counts: the motion is not small enough for it. "
            f'integrator="{stable_at(fixed_step=True).name}" has no such error']
