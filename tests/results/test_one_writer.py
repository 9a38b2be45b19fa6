"""One run per file: concurrent writers, removed files and replaced links are detected."""

import fcntl
import os
import re
import subprocess
import sys
import threading
from pathlib import Path

import numpy as np
import pytest
from funicular import ConvergenceError, FunicularError, ResultFileError, Scene, SceneError, load_run, load_scene
from funicular.results import streaming
from interrupted_runs import SETTINGS, content, short
from test_cli import funicular

TAKEN = "another run is writing it; wait for its end, or give another name$"


def while_it_runs(path: Path, do, monkeypatch, **settings):
    """Run, and call `do` once in the middle."""
    monkeypatch.setattr(streaming, "CHECKPOINT_INTERVAL", -1.0)
    done = []

    def once(time: float) -> None:
        if time > 0.1 and not done:
            done.append(True)
            do()

    return short().run(**SETTINGS | settings, save=path, progress=once)


def test_a_run_of_its_own_goes_on_while_others_are_refused(tmp_path, monkeypatch):
    path = tmp_path / "x.nc"

    def others() -> None:
        for start in (lambda: short(2.0).run(**SETTINGS, save=path),
                      lambda: short().run(**SETTINGS, save=path, resume=True),
                      lambda: short(2.0).run(**SETTINGS, save=tmp_path / "link.nc")):
            with pytest.raises(ResultFileError, match=f"{re.escape(str(path))}: {TAKEN}"):
                start()
        with pytest.raises(ResultFileError, match=r"a run is writing it; wait for its end, or give another name$"):
            saved.save(path)
        assert load_run(path).status == "unfinished"

    saved = short(2.0).run(**SETTINGS)
    (tmp_path / "link.nc").symlink_to("x.nc")
    run = while_it_runs(path, others, monkeypatch)
    assert run.status == "completed" and run["A.velocity"][0, 0] == 1.0
    assert content(path) == {name: run[name].tobytes() for name in ["time", *run.keys()]}
    assert {p.name for p in tmp_path.iterdir()} == {"x.nc", "link.nc"}


def test_a_run_that_has_not_made_its_file_yet_has_it_already(tmp_path, monkeypatch):
    """The interval between the check and the first row is as long as an equilibrium takes."""
    path, errors = tmp_path / "x.nc", []
    equilibrium = Scene.equilibrium

    def meanwhile(scene, **given):
        for resume in (False, True):
            with pytest.raises(ResultFileError) as refused:
                short(2.0).run(**SETTINGS, save=path, resume=resume)
            errors.append(str(refused.value))
        return equilibrium(scene, **given)

    monkeypatch.setattr(Scene, "equilibrium", meanwhile)
    scene = Scene()
    scene.rigid_body("A", mass=1.0, inertia=(1, 1, 1), position=(0, 0, 0))
    scene.spring("A", (0, 1, 0), stiffness=50.0)
    scene.run(duration=0.1, tol=1e-3, initial="equilibrium", save=path)
    assert re.search(TAKEN, errors[0]) and "there is no run to resume" in errors[1]
    assert [p.name for p in tmp_path.iterdir()] == ["x.nc"]


def test_many_runs_started_at_once(tmp_path):
    """Each returns its own results, or is refused."""
    path, found = tmp_path / "x.nc", {}
    barrier = threading.Barrier(6)

    def go(speed: float) -> None:
        barrier.wait()
        try:
            found[speed] = short(speed).run(**SETTINGS, save=path)["A.velocity"][0, 0]
        except ResultFileError as error:
            found[speed] = re.search(TAKEN, str(error)) is not None

    threads = [threading.Thread(target=go, args=(1.0 + k,)) for k in range(6)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(found) == 6 and all(value is True or value == speed for speed, value in found.items())
    assert [p.name for p in tmp_path.iterdir()] == ["x.nc"] and load_run(path).status == "completed"


PROCESS = """
import sys
sys.path.insert(0, {tests!r})
from interrupted_runs import SETTINGS, short
from funicular import FunicularError
try:
    print(short({speed}).run(**SETTINGS, save="x.nc")["A.velocity"][0, 0])
except FunicularError as error:
    print("refused" if "another run is writing it" in str(error) else error)
"""


@pytest.mark.slow
def test_processes_started_at_once(tmp_path):
    started = {speed: subprocess.Popen(
        [sys.executable, "-c", PROCESS.format(tests=str(Path(__file__).parents[1]), speed=speed)], cwd=tmp_path,
        text=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL) for speed in (1.0, 2.0, 3.0)}
    output = {speed: process.communicate()[0].strip() for speed, process in started.items()}
    assert all(text in ("refused", str(speed)) for speed, text in output.items()), output
    assert [p.name for p in tmp_path.iterdir()] == ["x.nc"]


@pytest.mark.parametrize("replace", [False, True])
def test_a_file_removed_or_replaced_while_it_is_written(tmp_path, monkeypatch, replace):
    path = tmp_path / "x.nc"
    other = short(2.0).run(**SETTINGS)

    def meddle() -> None:
        path.unlink()
        if replace:
            other.save(path)

    with pytest.raises(ResultFileError, match=r"x\.nc: it was removed or replaced while the run was writing it;"):
        while_it_runs(path, meddle, monkeypatch)
    assert path.exists() == replace
    if replace:
        assert content(path) == {name: other[name].tobytes() for name in ["time", *other.keys()]}


def test_links_in_the_place_of_a_runs_own_files(tmp_path, monkeypatch):
    victim, path = tmp_path / "victim", tmp_path / "x.nc"
    victim.write_text("untouched")
    (tmp_path / ".x.nc.part").symlink_to(victim)
    with pytest.raises(ResultFileError, match=r"x\.nc: \.x\.nc\.part beside it is a link; delete the link$"):
        short().run(**SETTINGS, save=path)
    (tmp_path / ".x.nc.part").unlink()
    for name in (".x.nc.state.part", "x.nc.state", f".x.nc.{os.getpid()}.probe"):
        (tmp_path / name).symlink_to(victim)
    monkeypatch.setattr(streaming, "CHECKPOINT_INTERVAL", -1.0)
    run = short().run(**SETTINGS, save=path)
    run.save(path)
    assert victim.read_text() == "untouched" and load_run(path).status == "completed"
    assert {p.name for p in tmp_path.iterdir()} == {"x.nc", "victim"}


def test_what_a_killed_run_left_is_written_over(tmp_path):
    (tmp_path / ".x.nc.part").write_text("half a header, and longer than the new one " * 10_000)
    short().run(**SETTINGS, save=tmp_path / "x.nc")
    assert [p.name for p in tmp_path.iterdir()] == ["x.nc"] and load_run(tmp_path / "x.nc").status == "completed"


def test_a_file_system_without_locks(tmp_path, monkeypatch):
    def none(descriptor, operation):
        raise OSError(95, "Operation not supported")

    monkeypatch.setattr(fcntl, "flock", none)
    short().run(**SETTINGS, save=tmp_path / "x.nc")
    (tmp_path / ".x.nc.part").touch()
    with pytest.raises(ResultFileError, match=r"another run may be writing it: there is \.x\.nc\.part, and this file "
                                              r"system has no locks; delete \.x\.nc\.part if there is none$"):
        short().run(**SETTINGS, save=tmp_path / "x.nc")


def test_what_fails_leaves_nothing_behind(tmp_path, stopped):
    folder = tmp_path / "new"
    folder.mkdir()
    scene = short()
    for run in (lambda: scene.run(duration=1.0, output_step=1e-15, save=folder / "x.nc"),
                lambda: scene.run(**SETTINGS, save=folder / "x.nc", resume=True)):
        with pytest.raises(FunicularError):
            run()
    assert not list(folder.iterdir())
    before = {p.name: p.read_bytes() for p in stopped.parent.glob("x.nc*")}
    with pytest.raises(ResultFileError):
        short().run(**SETTINGS | {"tol": 1e-2}, save=stopped, resume=True)
    assert {p.name: p.read_bytes() for p in stopped.parent.glob("*x.nc*")} == before


# --- paths, and no rows ------------------------------------------------------------------------------------------

PATHS = ["a\0b.nc", "x" * 300 + ".nc", "x" * 249 + ".nc", "d/" * 3000 + "x.nc", "\ud800.nc", "", "nowhere/x.nc"]


@pytest.mark.parametrize("path", PATHS, ids=lambda path: ascii(path)[:12])
def test_paths_that_cannot_be(path, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    run = short().run(**SETTINGS)
    for write in (lambda: short().run(**SETTINGS, save=path), lambda: run.save(path)):
        with pytest.raises(ResultFileError, match=r"the results cannot be written here: .*; (give|add)") as refused:
            write()
        assert len(str(refused.value)) < 500 and str(refused.value).isprintable()
    with pytest.raises(ResultFileError, match=r"there is no such file$"):
        load_run(path)
    with pytest.raises(SceneError, match="there is no such scene file"):
        load_scene(path)
    with pytest.raises(SceneError, match="there is no file"):
        Scene().modal_body("A", data=path, position=(0, 0, 0))
    assert not list(tmp_path.iterdir())


def without_rows(recording):
    def cut(values):
        for name, value in values.items():
            if isinstance(value, dict):
                cut(value)
            elif isinstance(value, np.ndarray) and len(value) == 101:
                values[name] = value[:0]

    cut({name: value for name, value in vars(recording).items() if name != "report"})
    recording.time = recording.time[:0]
    recording.status, recording.message = "no_convergence", "no step converged"
    return recording


def test_a_run_that_stops_before_its_first_row(engine, tmp_path):
    """No file, no checkpoint, an unchanged older file; the run reports that it has no rows."""
    whole = engine.simulate

    def simulate(*given, **named):
        return without_rows((yield from whole(*given, **named)))

    engine.simulate = simulate
    (tmp_path / "old.nc").write_text("old")
    for save in (None, tmp_path / "x.nc", tmp_path / "old.nc"):
        with pytest.raises(ConvergenceError) as error:
            load_scene("paper51").run(save=save)
        run = error.value.run
        assert repr(run) == "<funicular.Run: no_convergence, no times, 20 results>"
        assert run.summary().startswith("status: no_convergence before the first output time: there are no results")
        assert run["A.position"].shape == (0, 3) and run.energy_balance().exchanged == 0 and np.size(run.time) == 0
    result = funicular("run", "paper51", "--plot")
    assert (result.exit_code, result.stderr) == (1, "error: no step converged\n") and "paper51.nc" not in result.stdout
    assert [(p.name, p.read_text()) for p in tmp_path.iterdir()] == [("old.nc", "old")]
