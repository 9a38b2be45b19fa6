"""Runs that are killed while they write, and their remains, for tests of files, checkpoints and resuming."""

import hashlib
import os
import re
from pathlib import Path

import numpy as np
import pytest
from funicular import Circle, Material, ResultFileError, Run, Scene, load_run, load_scene
from funicular.results import streaming
from shared_scenes import add_cable, add_rider

SETTINGS = {"duration": 0.2, "output_step": 0.01, "tol": 1e-3}
WRITES = 65
"""Of such a run: rows, their number and the checkpoint 20 times; the file's start and its end."""
ANEW = "; start the run anew, without resume$"
SOFT = {"elements": 4, "element": "cable12", "section": Circle(radius=0.01),
        "material": Material(youngs_modulus=4e6, poisson_ratio=0, density=4200)}


def short(speed: float = 1.0) -> Scene:
    """Return a scene of a cable of four elements with a rider."""
    scene = Scene()
    add_cable(scene, pins=(0.0, 1.5), **SOFT)
    add_rider(scene, 0.2, speed, position=(0.2, 0, 0))
    return scene


def content(path) -> dict[str, bytes]:
    """Return the bytes of each result in a file."""
    run = load_run(path)
    return {name: run[name].tobytes() for name in ["time", *run.keys()]}


class Killed(BaseException):
    """Simulates kill -9: nothing of the run happens afterwards."""


def failing(monkeypatch, writes: int, error: BaseException):
    """Raise at every write after a number of them, half-way through; a number in the header is written or not."""
    left = [writes]
    pwrite, replace = os.pwrite, os.replace

    def fails() -> bool:
        left[0] -= 1
        return left[0] < 0

    def put(descriptor, data, at):
        if fails():
            pwrite(descriptor, data[: len(data) // 2 if len(data) > 4 else 0], at)
            raise error
        return pwrite(descriptor, data, at)

    def move(old, new):
        if fails():
            raise error
        replace(old, new)

    monkeypatch.setattr(os, "pwrite", put)
    monkeypatch.setattr(os, "replace", move)
    monkeypatch.setattr(Path, "replace", move)
    return left


def resumed(path, **changes):
    """Return the run resumed from a file."""
    return short().run(**SETTINGS | changes, save=path, resume=True)


def file_refused(path, message: str):
    """Return the context that expects a file to be refused with a message that begins with a pattern."""
    return pytest.raises(ResultFileError, match=rf"^{re.escape(str(path))}: {message}")


def signed(checkpoint: bytes) -> bytes:
    """Return a changed checkpoint with its correct digest."""
    content = checkpoint.partition(b"\n")[2]
    return hashlib.sha256(content).hexdigest().encode() + b"\n" + content


def kill(scene: Scene, path: Path, writes: int, **settings: object) -> None:
    """Run a scene with a checkpoint at every row, and kill it after a number of writes to its file."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(streaming, "CHECKPOINT_INTERVAL", -1.0)
        failing(patch, writes, Killed())
        with pytest.raises(Killed):
            scene.run(**settings, save=path)


def killed_and_resumed(scene: Scene, path: Path, writes: int, **settings: object) -> Run:
    """Return a run that is killed after a number of writes to a file, and resumed from its last checkpoint there."""
    kill(scene, path, writes, **settings)
    return scene.run(**settings, save=path, resume=True)


def check_file_and_resume(scene: Scene, folder: Path, writes: int, **settings: object) -> Run:
    """Return the run of a scene read from its file; a run that is killed and resumed must have the same bits."""
    (folder / "scene.toml").write_text(scene.to_toml(), encoding="utf-8")
    whole = load_scene(folder / "scene.toml").run(**settings)
    resumed = killed_and_resumed(scene, folder / "run.nc", writes, **settings)
    assert all(np.array_equal(whole[name], resumed[name], equal_nan=True) for name in whole)
    return whole
