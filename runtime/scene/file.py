"""Scenes and runs from files."""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path

from ..base.bounded_files import MAX_SCENE_BYTES, TooLargeError, read_bytes
from ..errors import SceneError, near, shown_path
from ..results.run import Run
from .scene import Scene

SCENES = Path(__file__).parents[1] / "scenes"

loads = Scene.from_toml


def bundled_scenes() -> dict[str, Path]:
    """Return the scenes of the package by name.

    >>> import funicular as fu
    >>> "cable_car" in fu.bundled_scenes()
    True
    """
    return {path.stem: path for path in sorted(SCENES.glob("*.toml"))}


def load_scene(path: str | os.PathLike[str], libraries: Iterable[str | os.PathLike[str]] = ()) -> Scene:
    """Read a scene file, or the bundled scene of that name; its [run] table becomes ``scene.run_settings``.

    libraries: directories of elements (`funicular derive --spec`) that the file may load; they are machine code.
    Raises SceneError.
    """
    file = Path(path)
    if not os.path.isfile(file):  # False also for an invalid path
        bundled = bundled_scenes()
        if os.fspath(path) not in bundled:
            raise SceneError(
                shown_path(path),
                "there is no such scene file, nor a bundled scene of that name",
                f'the bundled scene is "{file.stem}"' if file.stem in bundled else near(file.stem, bundled),
            )
        file = bundled[os.fspath(path)]
    if file.suffix == ".nc":
        raise SceneError(str(file), "holds the results of a run, not a scene", "take fu.load_run, or funicular view")
    try:
        text = read_bytes(file, MAX_SCENE_BYTES, "keep long tables in an .npz or a netCDF file").decode("utf-8")
        text = text.replace("\r\n", "\n").replace("\r", "\n")
    except TooLargeError as error:
        raise SceneError(str(file), *error.args) from None
    except (OSError, UnicodeDecodeError) as error:
        raise SceneError(str(file), f"cannot be read as text: {error}") from None
    scene = loads(text, str(file), file.parent, libraries)
    scene.title = file.stem
    return scene


def load_run(path: str | os.PathLike[str], libraries: Iterable[str | os.PathLike[str]] = (),
             salvage: bool = False) -> Run:
    """Open the results of a run, also of one that is running or was killed; arrays are read on demand.

    Checksums protect header, report and rows.

    libraries: directories of elements (`funicular derive --spec`) that ``run.scene`` may load; they are machine code.
    salvage: omit damaged rows, with a `FunicularWarning`, instead of refusing the file.
    Raises ResultFileError, also for a damaged or foreign file.
    """
    from ..results.files import open_file  # with checkpoints, not needed for scenes and runs in memory
    from ..results.opening import opened

    return opened(open_file(path), Scene.from_toml, libraries, salvage)
