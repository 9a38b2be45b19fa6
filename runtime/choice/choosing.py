"""What of a scene is chosen, and what stays as it was given."""

from __future__ import annotations

from collections.abc import Sequence

from ..errors import SceneError
from ..parts.cable import Cable
from ..parts.scene_data import SceneData
from ..parts.settings import RunSettings
from .candidates import Kind, Kinds, kinds_of
from .choice import Choice
from .chooser import Chooser
from .estimate import Free
from .probes import S, Simulate
from .remaking import MOST_PARTS, coarsest

FREE = ("unset", "all")
"""What is chosen: what was not given, or all."""


def choose(scene: S, settings: RunSettings, quantities: Sequence[str], free: str, simulate: Simulate) -> Choice[S]:
    """Return the models of a scene's cables for the tolerance of the settings.

    quantities: names of results that count, none for the motion; free: see `FREE`; simulate: runs a scene. Raises
    SceneError.
    """
    if free not in FREE:
        raise SceneError("choose", f'free must be one of "unset" and "all", got {free!r}')
    if settings.initial == "state":
        raise SceneError("choose", "a state to start from fits one mesh alone", 'take initial="drawn" or "equilibrium"')
    return Chooser(scene, settings, quantities, simulate,
                   [_free(scene, cable, free) for cable in scene.cables.values()]).choose()


def _free(scene: SceneData, cable: Cable, free: str) -> Free:
    """Return what is to be chosen of a cable."""
    given = cable.given_elements if free == "unset" else None
    base = coarsest(scene, cable)
    if not base and given is None:
        raise SceneError(cable.where, f"no mesh of up to {MOST_PARTS} equal elements has nodes at all its supports",
                         "give elements, or move a support")
    keeps = cable.library is not None or (free == "unset" and "element" in cable.model_fields_set)
    if keeps:
        why = (f"{cable.element}, {cable.law} as given: what that leaves out is not estimated",)
        return Free(cable, Kinds(None, Kind(cable.element, cable.law), why), base, given, keeps)
    return Free(cable, kinds_of(scene, cable, scene.dim), base, given)
