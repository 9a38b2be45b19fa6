"""Runs in separate processes, killed at any instant, continue to the same numbers; memory is bounded."""

import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
import xarray
from funicular import load_run
from interrupted_runs import content, short

CHILD = """
import sys
from funicular.results import streaming
from funicular.cli.main import app
streaming.CHECKPOINT_INTERVAL = streaming.ROWS_INTERVAL = 0.0
app(sys.argv[1:])
"""


def start(folder: Path, name: str, *options: str) -> subprocess.Popen:
    arguments = ["run", "scene.toml", "-o", name, *options]
    return subprocess.Popen([sys.executable, "-c", CHILD, *arguments], cwd=folder, stdout=subprocess.DEVNULL)


def times(path: Path) -> int:
    with xarray.open_dataset(path) as dataset:
        return dataset.sizes["time"]


def await_file(running: subprocess.Popen, path: Path, least: int = 1) -> float:
    """Wait until the file has a number of times; return the time of that, s."""
    while running.poll() is None and not (path.exists() and times_so_far(path) >= least):
        time.sleep(0.002)
    return time.monotonic()


def times_so_far(path: Path) -> int:
    """The file grows: scipy maps it before it reads the number of rows, and a row may arrive in between."""
    try:
        return times(path)
    except ValueError:
        return 0


@pytest.fixture
def whole(tmp_path) -> tuple[dict[str, bytes], float]:
    """Return the output of a run of about a second and its writing time, s; scene.toml is in the folder."""
    scene = short()
    scene.run_settings = {"duration": 0.6, "output_step": 5e-4, "step": 1e-5}
    (tmp_path / "scene.toml").write_text(scene.to_toml())
    running = start(tmp_path, "whole.nc")
    begin = await_file(running, tmp_path / "whole.nc")
    assert running.wait() == 0
    return content(tmp_path / "whole.nc"), time.monotonic() - begin


def check_killed(path: Path, expected: dict[str, bytes]) -> None:
    for name, values in content(path).items():
        assert expected[name].startswith(values), name


def check_resumed(path: Path, expected: dict[str, bytes]) -> None:
    if load_run(path).status == "unfinished":  # and not killed on the way out
        assert start(path.parent, path.name, "--resume").wait() == 0
    assert content(path) == expected


def test_kill(whole, tmp_path):
    path, least = tmp_path / "x.nc", 1
    for options in ([], ["--resume"]):
        running = start(tmp_path, path.name, *options)
        await_file(running, path, least + 150)
        running.kill()
        assert running.wait() == -signal.SIGKILL
        check_killed(path, whole[0])
        least = times(path)
    assert 300 < least <= 601  # or on the way out
    check_resumed(path, whole[0])


@pytest.mark.slow
def test_kill_at_20_random_instants(whole, tmp_path):
    expected, seconds = whole
    random_ones, reached = random.Random(4), []
    while len(reached) < 20:
        path = tmp_path / f"{len(reached)}.nc"
        running = start(tmp_path, path.name)
        await_file(running, path)
        time.sleep(random_ones.random() * seconds)
        running.kill()
        if running.wait() == -signal.SIGKILL:
            check_killed(path, expected)
            reached.append((times(path), path))
    for _, path in sorted(reached)[-4:]:
        check_resumed(path, expected)


MEMORY = """
import resource, sys
sys.path.insert(0, {tests!r})
from interrupted_runs import SOFT
from shared_scenes import cable_scene
cable_scene(pins=(0.0,), **SOFT).run(duration={rows} * 1e-3, step=1e-3, output_step=1e-3, save="x.nc")
print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)
"""


def peak(rows: int, folder: Path) -> float:
    code = MEMORY.format(tests=str(Path(__file__).parents[1]), rows=rows)
    done = subprocess.run([sys.executable, "-c", code], cwd=folder, capture_output=True, text=True, check=True)
    return int(done.stdout) / 1024


@pytest.mark.slow
def test_memory_does_not_grow_with_duration(tmp_path):
    few, many = peak(20_000, tmp_path), peak(100_000, tmp_path)
    assert (tmp_path / "x.nc").stat().st_size > 40e6
    assert many - few < 4.0  # MB
