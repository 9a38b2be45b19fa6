"""Pages, films and files for ParaView, from Python and from the command line: output and refusals."""

import sys
import xml.etree.ElementTree as ElementTree

import funicular as fu
import numpy as np
import pytest
from fake_recording import fake_recording
from funicular.cli.main import app
from funicular.errors import FunicularError
from funicular.parts.settings import RunSettings
from funicular.results.run import Run
from funicular.view import showing
from funicular.view.animation import Clip
from funicular.view.video import film_times
from numpy.testing import assert_allclose
from PIL import Image
from typer.testing import CliRunner
from viewed_scenes import spatial


@pytest.fixture(scope="module")
def run():
    scene = fu.load_scene("paper51")
    recording = fake_recording(scene, times=21)
    return Run.from_recording(recording, scene, RunSettings(duration=1.0), fu.Scene.from_toml)


@pytest.fixture(scope="module")
def in_space():
    return spatial().run(0.2, output_step=0.02, tol=1e-2, progress=False)


@pytest.fixture
def funicular(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return lambda *arguments: CliRunner().invoke(app, ["view", *map(str, arguments)])


def stored(tmp_path, name: str) -> str:
    """Run example 5.1 for a tenth of a second into a file; return its name."""
    fu.load_scene("paper51").run(0.1, output_step=0.01, tol=1e-3, save=tmp_path / name, progress=False)
    return name


# ---- pages


def test_a_page_is_written(run, tmp_path):
    path = run.save_html(tmp_path / "page.html")
    text = path.read_text(encoding="utf-8")
    assert "<title>run" in text and len(text) < 1e6
    with pytest.raises(fu.ResultFileError, match="page cannot be written here"):
        run.save_html(tmp_path / "nowhere" / "page.html")


def test_view_opens_a_page_in_the_browser(run, monkeypatch, capsys):
    opened = []
    monkeypatch.setattr(showing.webbrowser, "open", lambda url: not opened.append(url))
    path = run.view(fu.load_scene("paper51"))
    assert opened == [path.as_uri()] and "run" in path.read_text(encoding="utf-8")
    monkeypatch.setattr(showing.webbrowser, "open", lambda url: False)
    path = run.view()
    assert capsys.readouterr().err == f"no browser was found; open {path}\n"


class Kernel:
    """Simulates IPython in a notebook."""

    kernel = "a kernel"

    @classmethod
    def get_ipython(cls):
        return cls


def test_view_in_a_notebook_is_a_frame(run, monkeypatch):
    monkeypatch.setitem(sys.modules, "IPython", Kernel)
    frame = run.view()
    shown = frame._repr_html_()
    assert shown.startswith("<iframe srcdoc=") and "sandbox" in shown
    assert shown.count("<") == 2  # all of the page is escaped, but the frame and its end
    assert repr(frame).startswith("<a page of 0.")


def test_a_run_without_times_has_nothing_to_see(tmp_path):
    scene = fu.load_scene("paper51")
    recording = fake_recording(scene, times=2)
    for group in (recording.cables, *recording.parts.values()):
        for arrays in group.values():
            arrays |= {k: v[:0] for k, v in arrays.items() if k not in ("node_s", "vector_names")}
    recording.time, recording.energy = recording.time[:0], {k: v[:0] for k, v in recording.energy.items()}
    empty = Run.from_recording(recording, scene, RunSettings(duration=1.0), fu.Scene.from_toml)
    with pytest.raises(FunicularError, match="the run has no output times to show"):
        empty.save_html(tmp_path / "page.html")
    assert "no output times to show" in empty._repr_html_()


# ---- films


def test_a_gif_plays_at_the_speed_that_is_asked_for(in_space, tmp_path):
    path = in_space.save_video(tmp_path / "film.gif", speed=0.5, colour="tension")
    with Image.open(path) as film:
        assert film.size == (960, 540) and film.n_frames == 11 and film.info["duration"] == 40
        first = np.asarray(film.convert("RGB"), dtype=int)
        film.seek(10)
        last = np.asarray(film.convert("RGB"), dtype=int)
    assert np.abs(first - last).max() > 100  # something moves
    assert np.array_equal(first[-15:], last[-15:])  # and the margin does not


def test_an_mp4_has_its_pictures(run, tmp_path):
    ffmpeg = pytest.importorskip("imageio_ffmpeg")
    path = run.save_video(tmp_path / "film.mp4", speed=2.0)
    frames, seconds = ffmpeg.count_frames_and_secs(str(path))
    assert frames == 14 and seconds == pytest.approx(0.56, abs=0.05)


def test_modes_follow_one_another_in_a_film(tmp_path):
    """Three periods of each mode, 25 pictures a second."""
    scene = fu.load_scene("cable_car")
    modes = scene.modes(2, about=scene.equilibrium())
    path = modes.save_video(tmp_path / "modes.gif", speed=20)
    with Image.open(path) as film:
        assert abs(film.n_frames - np.sum(3 / modes.frequency / 20 * 25 + 1.5)) <= 2


def test_the_times_of_a_film():
    times, pace = film_times((Clip("a", np.linspace(1.0, 3.0, 5)),), 1.0)
    assert pace == 1.0 and len(times) == 51
    assert_allclose(times[[0, 1, -1]], [1.0, 1.04, 3.0])
    times, pace = film_times((Clip("a", np.linspace(0, 80.0, 5)),), None)
    assert pace == 10.0 and times[-1] == 80.0 and len(times) == 201
    times, _ = film_times((Clip("mode", 0.5 * np.arange(4) / 4, periodic=True),), 1.0)
    assert times[-1] == pytest.approx(1.5)  # three periods


@pytest.mark.parametrize(("speed", "complaint"), [
    (0.0, "the speed of a film must be positive, got 0"),
    (1e-4, r"the film would have 250001 pictures, at most 3000 are made; take a speed of 0\.00833 or more"),
])
def test_films_that_are_refused(run, tmp_path, speed, complaint):
    with pytest.raises(FunicularError, match=complaint):
        run.save_video(tmp_path / "film.gif", speed=speed)


def test_what_films_cannot_show(run, tmp_path):
    with pytest.raises(FunicularError, match=r"a film ends in \.gif or \.mp4"):
        run.save_video(tmp_path / "film.avi")
    with pytest.raises(FunicularError, match='no quantity "tensoin"; did you mean "tension"'):
        run.save_video(tmp_path / "film.gif", colour="tensoin")
    with pytest.raises(FunicularError, match="there is one frame, which makes no film"):
        fu.load_scene("paper51").save_video(tmp_path / "film.gif")
    with pytest.raises(fu.ResultFileError, match="the pictures cannot be written here: No such file"):
        run.save_video(tmp_path / "nowhere" / "film.gif")


def test_a_missing_extra_is_named(run, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "meshio", None)
    with pytest.raises(FunicularError, match=r"this needs meshio, .* pip install 'funicular\[vtk\]'"):
        run.save_vtk(tmp_path)


# ---- ParaView


def test_files_for_paraview_hold_the_results(in_space, tmp_path):
    meshio = pytest.importorskip("meshio")
    path = in_space.save_vtk(tmp_path / "out")
    listed = ElementTree.parse(path).getroot().findall("./Collection/DataSet")
    assert path.name == "out.pvd"
    assert_allclose([float(each.get("timestep")) for each in listed], in_space.time)
    clip = in_space.animation().clips[0]
    for k in (0, len(listed) - 1):
        mesh = meshio.read(path.parent / listed[k].get("file"))
        assert listed[k].get("part") == "0"
        rope, boom = clip.cables
        n, m = len(rope.s), len(boom.s)
        assert_allclose(mesh.points[: n + m], np.concatenate([rope.position[k], boom.position[k]]), atol=1e-14)
        assert_allclose(mesh.point_data["tension"][:n], rope.quantities[0].values[k])
        assert np.isnan(mesh.point_data["tension"][n + m :]).all() and np.isnan(mesh.point_data["moment"][:n]).all()
        assert_allclose(mesh.point_data["section_y"][n : n + m], boom.section_y[k])
        assert_allclose(mesh.point_data["diameter"][:n], 0.04)
        box = mesh.points[mesh.point_data["part"] == 2]
        assert_allclose(box.mean(axis=0), in_space["car.position"][k], atol=1e-12)
        cells = mesh.cells_dict
        assert len(cells["line"]) == n + m - 2 and len(cells["triangle"]) > 12
        assert cells["triangle"].min() == n + m


def test_both_of_two_runs_are_parts_for_paraview(run, tmp_path):
    pytest.importorskip("meshio")
    from funicular.results.animation.clips import overlaid
    from funicular.view.vtk import write_vtk

    path = write_vtk(overlaid([run.animation("one"), fu.load_scene("paper51").animation("other")]), tmp_path / "two")
    listed = ElementTree.parse(path).getroot().findall("./Collection/DataSet")
    assert [sum(each.get("part") == part for each in listed) for part in "01"] == [21, 1]
    assert all((path.parent / each.get("file")).exists() for each in listed)


# ---- the command line


def test_view_writes_a_page_beside(funicular, tmp_path):
    name = stored(tmp_path, "a.nc")
    found = funicular(name)
    assert (found.exit_code, found.stdout) == (0, "written: a.html\n")
    assert "<title>a" in (tmp_path / "a.html").read_text(encoding="utf-8")


def test_view_of_two_runs(funicular, tmp_path):
    found = funicular(stored(tmp_path, "a.nc"), stored(tmp_path, "b.nc"), "-o", "both.html", "--png", "both.png")
    assert (found.exit_code, found.stdout) == (0, "written: both.png\nwritten: both.html\n")
    assert "a and b" in (tmp_path / "both.html").read_text(encoding="utf-8")


@pytest.mark.parametrize("options", [(), ("--equilibrium",), ("--path",), ("--modes", 2, "--as-drawn"),
                                     ("--modes", 2, "--equilibrium")])
def test_view_of_a_scene(funicular, tmp_path, options):
    found = funicular("paper51", *options)
    assert (found.exit_code, found.stdout) == (0, "written: paper51.html\n")
    assert "<title>paper51" in (tmp_path / "paper51.html").read_text(encoding="utf-8")


def test_view_opens_the_page_only_when_asked(funicular, tmp_path, monkeypatch):
    opened = []
    monkeypatch.setattr(showing.webbrowser, "open", lambda url: not opened.append(url))
    assert funicular("paper51").exit_code == 0 and not opened
    assert funicular("paper51", "--open", "-o", "there.html").exit_code == 0
    assert opened == [(tmp_path / "there.html").as_uri()]


def test_view_writes_other_pictures_instead(funicular, tmp_path):
    pytest.importorskip("meshio")
    name = stored(tmp_path, "a.nc")
    found = funicular(name, "--gif", "a.gif", "--speed", 1, "--colour", "strain", "--vtk", "frames")
    assert found.stdout == "written: a.gif\nwritten: frames/frames.pvd\n"
    assert not (tmp_path / "a.html").exists()


def test_view_refuses(funicular, tmp_path):
    found = funicular(stored(tmp_path, "a.nc"), "--modes", 3)
    assert found.exit_code == 1
    assert found.stderr == ("error: a.nc: --equilibrium, --relaxed, --path and --modes are for scenes, not for results "
                            "of runs\n")
    assert "error: nowhere.nc: there is no such file" in funicular("nowhere.nc").stderr
