"""The packed scene of a run with its settings, or the reason why there is none."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from ..errors import SceneError
from ..parts.inputs import Input
from ..parts.scene_data import SceneData
from ..parts.settings import RunSettings
from ..solve.motion.run import Start, made_ready
from .image import Packed, Value, packed
from .values import values_of_row


class SceneImage(NamedTuple):
    """A packed scene; its integrator and the reason for it; the values of a row; names of results without values;
    whether the run calls LAPACK, whose plain version differs in rounding.
    """

    packed: Packed
    integrator: str
    reason: str
    values: list[Value]
    missing: list[str]
    has_lapack: bool


def image_of(scene: SceneData, settings: RunSettings, initial: Start | None = None,
             inputs: Sequence[Input] = ()) -> SceneImage:
    """Return the image of a checked scene's run, in the axes of the model; inputs: of `with_inputs`. Raises SceneError
    for what C cannot run.
    """
    _refuse(scene)
    settings = settings.model_copy(update={"threads": 1})
    run = made_ready(scene, settings, initial, inputs)
    twin = made_ready(scene, settings, initial, inputs, like=run)
    handler = run.event_handler
    for function in handler.event_functions:
        if function.kind == "function":
            raise SceneError(function.event.where, "cannot be exported to C: its quantity is computed by Python",
                             "leave the event out; quantities such as \"A.position.y\" of scenes in space or in the "
                             "plane x, y are exported")
    if run.model.signals.switched:
        raise SceneError("scene", "cannot be exported to C: loads or friction begin or end with events, which Python "
                         "switches", "give them times")
    names = [f'{coupling.type} "{coupling.name}"' for coupling in run.model.couplings]
    values, missing = values_of_row(twin.model, scene, twin.engine)
    for array in twin.engine.record_arrays().values():
        array[:] = 0.0
    made = packed(run.engine, twin.engine, every=run.every, values=values, couplings=names,
                  stops=[function.event.action == "stop" for function in handler.event_functions],
                  inputs=[(each.path, each.unit) for each in inputs])
    return SceneImage(made, run.method.name, run.reason, values, missing, run.engine.has_lapack)


def _refuse(scene: SceneData) -> None:
    """Raise SceneError for elements of the user, and ropes without mass."""
    for rope in scene.ropes.values():
        if not rope.mass:
            raise SceneError(rope.where, "cannot be exported to C: Python computes its results from where it touches "
                             "its sheaves", "leave mass=False out")
    for cable in scene.cables.values():
        if cable.library is not None:
            raise SceneError(cable.where, "cannot be exported to C: its element is from a library of yours",
                             "take an element of funicular")
