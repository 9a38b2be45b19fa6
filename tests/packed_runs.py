"""Packed scenes in this process, their rows, and the same rows of a run."""

import funicular as fu
import numpy as np
from funicular.engine import PackedRun
from funicular.export.scene_image import SceneImage, image_of
from funicular.export.values import _labels
from funicular.parts.in_plane import in_plane
from funicular.parts.inputs import with_inputs
from funicular.parts.settings import RunSettings, overridden

RUNNING, DONE, STOPPED, FAILED = range(4)


def image(scene: fu.Scene, inputs: tuple[str, ...] = (), **settings) -> SceneImage:
    """Return the packed scene of a run with these settings."""
    driven, found = with_inputs(scene, inputs, "export")
    return image_of(in_plane(driven), RunSettings(**overridden(scene.run_settings, settings)), inputs=found)


def opened(made: SceneImage, **options) -> PackedRun:
    return PackedRun(made.packed.content, made.packed.digest, made.packed.kernels, **options)


def rows(run: PackedRun, until: int | None = None) -> np.ndarray:
    """Return the rows of a packed run up to a number of them, or to its end."""
    found = []
    while until is None or len(found) < until:
        status = run.step()
        assert status != FAILED, run.message
        found.append(run.row())
        if status:
            break
    return np.array(found)


def expected(run: fu.Run, names: list[str]) -> np.ndarray:
    """Return the results of a run by the names of values."""
    found = {"time": run.time}
    for name, result in run.variables.items():
        if result.dims[:1] == ("time",):
            numbers = np.asarray(result.values).reshape(len(run.time), -1)
            found |= dict(zip([name + label for label in _labels(result, run.coords)], numbers.T, strict=True))
    return np.stack([found[name] for name in names], axis=1)
