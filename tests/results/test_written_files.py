"""Replaced files: a full disk, an error or Ctrl-C leaves the older one."""

import os
import re
import resource
import signal
from contextlib import contextmanager
from pathlib import Path

import funicular as fu
import pytest
from funicular.base.written_files import write_text, write_whole
from funicular.bench import report
from funicular.bench.bench import bench, grid
from funicular.cli.main import app
from funicular.derive.theory import command
from funicular.errors import FunicularError
from typer.testing import CliRunner

SOURCES = [Path(__file__).parents[2] / folder for folder in ("runtime", "derive")]


@contextmanager
def full_disk(left: int):
    """Limit the files of this process and its children to a number of bytes, as a full disk does."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (left, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


@pytest.fixture(scope="module")
def run():
    return fu.load_scene("paper51").run(0.1, output_step=0.02, tol=1e-2, progress=False)


@pytest.fixture(scope="module")
def measured():
    scene = fu.load_scene("paper51")
    return bench(scene, grid(scene, integrators=["genalpha"], tols=[1e-1], elements=["x1"], outputs=None, duration=0.02,
                             output_step=0.01, repetitions=1))


def schema(path: Path) -> None:
    done = CliRunner().invoke(app, ["schema", "-o", str(path)])
    if done.exit_code:
        raise FunicularError(done.stderr)


def figure(path: Path) -> None:
    from funicular.view.files import save_figure
    from matplotlib.figure import Figure

    made = Figure()
    made.add_subplot().plot([0, 1])
    save_figure(made, path)


WRITERS = {
    "page.html": lambda path, run, measured: run.save_html(path),
    "view.png": lambda path, run, measured: run.save_png(path),
    "shape.png": lambda path, run, measured: run.save_plots(path.parent),
    "film.gif": lambda path, run, measured: run.save_video(path, speed=0.5),
    "film.mp4": lambda path, run, measured: run.save_video(path, speed=0.5),
    "part0_frame0.vtu": lambda path, run, measured: run.save_vtk(path.parent),
    "result.nc": lambda path, run, measured: run.save(path),
    "bench.csv": lambda path, run, measured: report.save(measured, path.parent, "bench"),
    "schema.json": lambda path, run, measured: schema(path),
    "figure.png": lambda path, run, measured: figure(path),
    "rigid.html": lambda path, run, measured: command.build("rigid", path.parent),
}
LEFT = {"bench.csv": 200}


@pytest.mark.parametrize("name", WRITERS)
@pytest.mark.slow_cases("rigid.html", "view.png", "film.mp4")
def test_a_full_disk_leaves_the_older_file(name, run, measured, tmp_path):
    path = tmp_path / name
    WRITERS[name](path, run, measured)
    good, beside = path.read_bytes(), sorted(os.listdir(tmp_path))
    assert len(good) > LEFT.get(name, 2000)
    refused = pytest.raises(FunicularError, match=r"cannot be written here|could not be written")
    with full_disk(LEFT.get(name, 2000)), refused:
        WRITERS[name](path, run, measured)
    assert path.read_bytes() == good
    assert sorted(os.listdir(tmp_path)) == beside


def test_a_chosen_scene_is_written_whole(tmp_path):
    path = tmp_path / "chosen.toml"
    path.write_text("older")
    with full_disk(100):
        done = CliRunner().invoke(app, ["choose", "paper51", "--tol", "0.1", "--duration", "0.02", "-o", str(path)])
    assert done.exit_code == 1 and "chosen.toml: the file cannot be written here: File too large" in done.stderr
    assert path.read_text() == "older" and os.listdir(tmp_path) == ["chosen.toml"]


def test_ctrl_c_leaves_the_older_file(tmp_path):
    path = write_text(tmp_path / "a.txt", "older")

    def interrupted(part: Path) -> None:
        part.write_text("newer")
        os.kill(os.getpid(), signal.SIGINT)

    with pytest.raises(KeyboardInterrupt):
        write_whole(path, interrupted)
    assert path.read_text() == "older" and os.listdir(tmp_path) == ["a.txt"]


def test_links_modes_and_devices_stay_what_they_are(tmp_path):
    target, link = tmp_path / "target.txt", tmp_path / "link.txt"
    target.write_text("older")
    target.chmod(0o640)
    link.symlink_to(target)
    assert write_text(link, "newer\n") == link
    assert link.is_symlink() and target.read_text() == "newer\n" and target.stat().st_mode & 0o777 == 0o640
    write_text("/dev/null", "nothing")
    assert Path("/dev/null").is_char_device()
    for wrong, reason in ((tmp_path, "this is a directory"), (tmp_path / "a" / "b", "No such"), ("a\0b", "embedded")):
        with pytest.raises(fu.ResultFileError, match=f"the file cannot be written here: {reason}"):
            write_text(wrong, "")
    assert sorted(os.listdir(tmp_path)) == ["link.txt", "target.txt"]


def test_no_file_is_written_in_its_place():
    """All files are written by `write_whole`; the exceptions listed here make files under new names."""
    elsewhere = {"guides", "written_files.py",  # scripts that are read, and the function itself
                 "library.py", "compiled.py", "timing.py", "command.py", "workers.py", "build.py"}  # temporary folders
    writes = re.compile(r"\.write_text\(|\.write_bytes\(|\.savefig\(|open\([^)]*\"w|np\.save")
    files = [file for folder in SOURCES for file in folder.rglob("*.py")
             if not elsewhere & {file.name, *file.relative_to(folder).parts}]
    found = [f"{file.name}:{number}" for file in files
             for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), start=1)
             if writes.search(line)]
    allowed = {"files.py",  # a picture in a page
               "report.py",  # within write_whole
               "watch.py",  # in a temporary folder
               "netcdf.py", "checkpoints.py"}  # part files with locks
    assert {each.partition(":")[0] for each in found} <= allowed, found
