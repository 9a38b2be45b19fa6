"""Integrators of runs: one file each, and their list; that of the engine is in engine/integrators/list.c."""

from .energy import EnergyMomentum
from .explicit import Explicit
from .genalpha import GeneralisedAlpha
from .integrator import Demands, Integrator
from .linear import Linear
from .radau import Radau

LIST = (GeneralisedAlpha, Explicit, Radau, EnergyMomentum, Linear)
INTEGRATORS: dict[str, type[Integrator]] = {one.name: one for one in LIST}
OF_EQUATIONS = tuple(one.name for one in LIST if not one.is_linear)
"""Names of the integrators of the scene's own equations, for any motion."""
AUTO = "auto"
"""Name for the integrator that a run chooses itself."""


def stable_at(fixed_step: bool) -> type[Integrator]:
    """Return the integrator that is stable at any step, for a fixed step or for steps chosen by the tolerance."""
    return GeneralisedAlpha if fixed_step else Radau


__all__ = ["AUTO", "INTEGRATORS", "OF_EQUATIONS", "Demands", "EnergyMomentum", "Explicit", "GeneralisedAlpha",
           "Integrator", "Linear", "Radau", "stable_at"]
