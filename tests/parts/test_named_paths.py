"""Paths in a scene file: output stays below the folder of the file and replaces only results of the same scene."""

import os
import pickle

import funicular as fu
import pytest
from expectations import refused
from funicular.cli.main import app
from interrupted_runs import short
from typer.testing import CliRunner

RUN = "\n[run]\nduration = 0.02\noutput_step = 0.01\nsave = {}\n"
GIVE = "or give it on the command line (-o) or in Python (save=)"


def scene_file(folder, save: str, scene: fu.Scene | None = None):
    """Write a scene file with a path for its results; return its own path."""
    folder.mkdir(exist_ok=True)
    path = folder / "scene.toml"
    path.write_text((scene or short()).to_toml() + RUN.format(repr(save)))
    return path


@pytest.fixture
def here(tmp_path, monkeypatch):
    """Change to a working directory beside the folder of the scene file."""
    (tmp_path / "here").mkdir()
    monkeypatch.chdir(tmp_path / "here")
    return tmp_path


@pytest.mark.parametrize("save", ["x.nc", "./x.nc", "results/x.nc"])
def test_results_go_below_the_folder_of_the_file(here, save):
    path = scene_file(here / "there", save)
    (here / "there" / "results").mkdir()
    scene = fu.load_scene(path)
    for made in (scene, scene.replace("A", mass=1.0), pickle.loads(pickle.dumps(scene)), fu.load_scene(path).copied()):
        assert made.run(progress=False).status == "completed"
    assert fu.load_run(here / "there" / save).status == "completed" and os.listdir(here / "here") == []
    assert fu.load_run(here / "there" / save).scene.run_settings["save"] == save
    assert CliRunner().invoke(app, ["run", str(path)]).exit_code == 0
    assert os.listdir(here / "here") == []
    assert f'save = "{save}"' in scene.to_toml()


@pytest.mark.parametrize("save", ["/tmp/x.nc", "../x.nc", "a/../../x.nc", "results/../x.nc", "..\\x.nc", "C:x.nc",
                                  "C:\\x.nc", "\\x.nc", "//server/x.nc"])
def test_words_that_lead_out_are_refused(here, save):
    with pytest.raises(fu.SceneError, match=r", line \d+: \[run\]: save = .* must stay below the folder of the file"):
        fu.load_scene(scene_file(here / "there", save))


@pytest.mark.parametrize("link", ["x.nc", "results"])
def test_links_are_not_followed(here, link):
    victim = here / "victim"
    victim.mkdir()
    (victim / "x.nc").write_text("untouched")
    path = scene_file(here / "there", "x.nc" if link == "x.nc" else "results/x.nc")
    (here / "there" / link).symlink_to(victim / "x.nc" if link == "x.nc" else victim)
    with pytest.raises(fu.SceneError, match=r'^run: save = "\S+x\.nc" in a scene file leads over the link'
                       if link != "x.nc" else "leads over the link"):
        fu.load_scene(path).run(progress=False)
    done = CliRunner().invoke(app, ["run", str(path)])
    assert done.exit_code == 1 and "leads over the link" in done.stderr and "Traceback" not in done.stderr
    assert (victim / "x.nc").read_text() == "untouched" and os.listdir(victim) == ["x.nc"]


def test_other_files_are_not_replaced(here):
    path = scene_file(here / "there", "x.nc")
    scene, target = fu.load_scene(path), here / "there" / "x.nc"
    cause = 'save = "x.nc" in a scene file replaces results of the same scene alone'
    target.write_text("untouched")
    with refused(f"{target}: {cause}; delete what is there, choose another name, {GIVE}", fu.ResultFileError):
        scene.run(progress=False)
    assert target.read_text() == "untouched"
    short(speed=2.0).run(0.02, save=target, progress=False)
    before = target.read_bytes()
    with pytest.raises(fu.ResultFileError, match="replaces results of the same scene alone"):
        scene.run(progress=False)
    assert target.read_bytes() == before
    assert sorted(os.listdir(here / "there")) == ["scene.toml", "x.nc"]
    assert scene.run(save=target, progress=False).status == "completed"  # which the user has said
    assert scene.run(progress=False).status == "completed"  # the same scene
    assert scene.run(duration=0.03, tol=1e-2, progress=False).status == "completed"  # other settings


def test_a_file_in_the_place_of_the_checkpoint_is_not_replaced(here):
    path = scene_file(here / "there", "x.nc")
    (here / "there" / "x.nc.state").write_text("untouched")
    with pytest.raises(fu.ResultFileError, match=r"there is a file x\.nc\.state, which the run would replace"):
        fu.load_scene(path).run(progress=False)
    assert (here / "there" / "x.nc.state").read_text() == "untouched"


def test_an_interrupted_run_goes_on(here):
    def stop(_: float) -> None:
        raise KeyboardInterrupt

    scene = fu.load_scene(scene_file(here / "there", "x.nc"))
    with pytest.warns(fu.FunicularWarning, match="interrupted"):
        assert scene.run(progress=stop).status == "interrupted"
    assert scene.run(resume=True, progress=False).status == "completed"


def test_a_chosen_scene_replaces_its_own_results(here):
    scene = fu.Scene()
    wire = scene.cable("wire", start=(0, 0, 0), end=(1, 0, 0), section=fu.Circle(radius=0.01),
                       material=fu.Material(youngs_modulus=1e7, poisson_ratio=0.3, density=1000))
    scene.pin(wire, s=0.0)
    path = scene_file(here / "there", "x.nc", scene)
    for _ in range(2):
        with pytest.warns(fu.FunicularWarning, match="model chosen"):
            assert fu.load_scene(path).run(tol=0.1, progress=False).status == "completed"
