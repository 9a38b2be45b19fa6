"""Which parts of a scene are chosen, and which stay as given."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from ..errors import SceneError
from ..parts.cable import Cable
from ..parts.settings import RunSettings
from .candidates import Free, possible
from .choice import Choice
from .chooser import Chooser
from .planar import Planar, planar_of
from .probes import Runner
from .remeshing import MAX_COARSEST_ELEMENTS, CableModel, S, coarsest, remade
from .unequal import with_unequal_elements

FREE = ("unset", "all")
"""What is chosen: unset values alone, or all."""


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
        meshed = [each.cable.name for each in chooser.free if each.fixed is None and each.cable.pieces is None]
        choice.reasons += [f"{each.cable.where}: each of its pieces has equal elements" for each in chooser.free
                           if each.cable.pieces is not None]
        if meshed:
            choice = with_unequal_elements(choice, meshed, chooser.prober, chooser.time.probe_tol, chooser.time.probed)
    if planar is not None:
        choice.reasons.insert(0, str(planar))
        choice.planar = str(planar) if planar.scene is not None else ""
    return choice


def _planar(scene: S, free: str) -> Planar[S] | None:
    """Return the planar form of a spatial scene, or the reasons against it; None where elements of cables are given.

    Free cables are taken as beams of the structural law: the law is chosen later.
    """
    if scene.dim == 2 or not scene.cables or any(_keeps(cable, free) for cable in scene.cables.values()):
        return None
    models = {}
    for name, cable in scene.cables.items():
        elements = coarsest(scene, cable) or 1 if cable.is_open else cable.elements
        models[name] = possible(scene, cable).finest.of(elements)
    try:
        return planar_of(remade(scene, models))
    except SceneError as error:
        return Planar(None, (str(error),))


def _keeps(cable: Cable, free: str) -> bool:
    """Return whether the element and law of a cable stay as given."""
    return cable.library is not None or (free == "unset" and "element" in cable.model_fields_set)


def _free(scene: S, name: str, asked: Cable, free: str) -> Free:
    """Return the possible models of a cable of a scene; asked: the cable as the user gave it."""
    cable = scene.cables[name]
    keeps_mesh = free == "unset" and not asked.is_open
    given = asked.elements if keeps_mesh else None
    base = coarsest(scene, cable)
    if not base and given is None:
        which = "equal elements" if cable.pieces is None else "elements, equal in each piece,"
        raise SceneError(cable.where, f"no mesh of up to {MAX_COARSEST_ELEMENTS} {which} has nodes at all its "
                         "supports", "give elements, or move a support")
    if _keeps(asked, free):
        kept = CableModel(cable.element, cable.law)
        why = (f"{cable.element}, {cable.law} as given: the error of this model is not estimated",)
        return Free(cable, None, kept, why, base, given, True)
    return replace(possible(scene, cable), base=base, fixed=given)
