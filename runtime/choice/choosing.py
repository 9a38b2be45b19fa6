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
from .planar import Planar, planar_of
from .probes import Runner, S
from .remeshing import MOST_PARTS, coarsest, remade
from .unequal import with_unequal_elements

FREE = ("unset", "all")
"""What is chosen: what was not given, or all."""


def choose(scene: S, settings: RunSettings, quantities: Sequence[str], free: str, runner: Runner[S],
           unequal: bool = False) -> Choice[S]:
    """Return the models of a scene's cables for the tolerance of the settings.

    quantities: names of results that count, none for the motion; free: see `FREE`; runner: runs a scene; unequal:
    whether elements of unequal lengths are tried, too. Raises SceneError.
    """
    if free not in FREE:
        raise SceneError("choose", f'free must be one of "unset" and "all", got {free!r}')
    if settings.initial == "state":
        raise SceneError("choose", "a state to start from fits one mesh alone", 'take initial="drawn" or "equilibrium"')
    planar = _planar(scene, free)
    taken = scene if planar is None or planar.scene is None else planar.scene
    chooser = Chooser(taken, settings, quantities, runner,
                      [_free(taken, name, scene.cables[name], free) for name in scene.cables])
    choice = chooser.choose()
    if unequal:
        meshed = [each.cable.name for each in chooser.free if each.fixed is None]
        choice = with_unequal_elements(choice, meshed, chooser.prober, chooser.time.probe_tol, chooser.time.probed)
    if planar is not None:
        choice.reasons.insert(0, str(planar))
        choice.planar = str(planar) if planar.scene is not None else ""
    return choice


def _planar(scene: S, free: str) -> Planar[S] | None:
    """Return the planar form of a spatial scene, or why it has none; None where elements of cables are not free.

    Cables that are free are taken as beams of the structural law: which law they get is chosen later.
    """
    if scene.dim == 2 or not scene.cables or any(_keeps(cable, free) for cable in scene.cables.values()):
        return None
    models = {}
    for name, cable in scene.cables.items():
        elements = coarsest(scene, cable) or 1 if cable.is_open else cable.elements
        models[name] = kinds_of(scene, cable, scene.dim).finest.with_elements(elements)
    try:
        return planar_of(remade(scene, models))
    except SceneError as error:
        return Planar(None, (str(error),))


def _keeps(cable: Cable, free: str) -> bool:
    """Return whether the element and law of a cable stay as they were given."""
    return cable.library is not None or (free == "unset" and "element" in cable.model_fields_set)


def _free(scene: SceneData, name: str, asked: Cable, free: str) -> Free:
    """Return what is to be chosen of a cable of a scene; asked: the cable as the user gave it."""
    cable = scene.cables[name]
    given = asked.elements if free == "unset" and not asked.is_open else None
    base = coarsest(scene, cable)
    if not base and given is None:
        raise SceneError(cable.where, f"no mesh of up to {MOST_PARTS} equal elements has nodes at all its supports",
                         "give elements, or move a support")
    if _keeps(asked, free):
        why = (f"{cable.element}, {cable.law} as given: what that leaves out is not estimated",)
        return Free(cable, Kinds(None, Kind(cable.element, cable.law), why), base, given, True)
    return Free(cable, kinds_of(scene, cable, scene.dim), base, given)
