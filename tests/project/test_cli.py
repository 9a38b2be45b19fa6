"""The command line and `Scene.run` around a mock of the engine."""

import re
import sys
import warnings
from importlib.metadata import version
from types import ModuleType

import pytest
from funicular import ConvergenceError, EndOfCableError, FunicularWarning, load_run, load_scene
from funicular.cli.main import app
from typer.testing import CliRunner

END = 'slide "trolley": reached the end of cable "wire" at t = 0.4 s'


def funicular(*args: str):
    return CliRunner().invoke(app, list(map(str, args)))


def test_run(engine, tmp_path):
    result = funicular("run", "paper51")
    assert (result.exit_code, result.stderr) == (0, "")
    assert [p.name for p in tmp_path.iterdir()] == ["paper51.nc"]
    assert load_run("paper51.nc").status == "completed"
    summary = dict(re.findall(r"^ +(\S+(?: \S+)*) {2,}(.*\S)", result.stdout, re.MULTILINE))
    assert summary["results"] == "paper51.nc"
    assert summary["status"].startswith("completed at t = 1 s")
    assert {"steps", "wall time", "energy balance", "joint residual"} <= set(summary)
    assert (engine.calls[0].duration, engine.calls[0].tol, engine.calls[0].output_step) == (1.0, 1e-5, 0.002)


def test_options_come_before_the_file(engine):
    result = funicular("run", "paper51", "--duration", 2, "--tol", 1e-3, "--step", 0.5, "-o", "other.nc")
    assert result.exit_code == 0
    settings = engine.calls[0]
    assert (settings.duration, settings.tol, settings.step, settings.save) == (2, 1e-3, 0.5, "other.nc")
    assert load_run("other.nc").report["settings"]["tol"] == 1e-3


def test_a_path_and_its_save(engine, tmp_path):
    text = load_scene("paper51").to_toml()
    (tmp_path / "mine.toml").write_text(text)
    assert funicular("run", tmp_path / "mine.toml").exit_code == 0
    (tmp_path / "mine.toml").write_text(text + 'save = "named.nc"\n')
    assert funicular("run", tmp_path / "mine.toml").exit_code == 0
    assert {p.name for p in tmp_path.glob("*.nc")} == {"mine.nc", "named.nc"}


def test_pictures(engine, tmp_path):
    assert funicular("run", "paper51", "--plot").exit_code == 0
    assert funicular("run", "paper51", "--plot-dir", "a/b").exit_code == 0
    names = {f"paper51-{picture}.png" for picture in ("shape", "acceleration", "slide", "energy")}
    assert {p.name for p in tmp_path.glob("*.png")} == names
    assert {p.name for p in (tmp_path / "a" / "b").iterdir()} == names


def test_pictures_of_section_forces(engine, tmp_path):
    assert funicular("run", "paper51", "--forces").exit_code == 0
    assert "paper51-forces-wire.png" in {p.name for p in tmp_path.glob("*.png")}


def test_end_of_cable(engine):
    engine.outcome = {"status": "end_of_cable", "message": END, "duration": 0.4, "times": 41}
    result = funicular("run", "paper51")
    assert (result.exit_code, result.stderr) == (1, f"error: {END}\n")
    kept = load_run("paper51.nc")
    assert (kept.status, kept.report["message"], kept.time[-1]) == ("end_of_cable", END, 0.4)


def test_interrupted(engine):
    engine.outcome = {"status": "interrupted", "message": "interrupted at t = 0.4 s", "duration": 0.4}
    result = funicular("run", "paper51")
    assert (result.exit_code, result.stderr) == (130, "note: interrupted at t = 0.4 s\n")
    assert load_run("paper51.nc").status == "interrupted"


def test_interrupted_outside_of_the_engine(engine, monkeypatch):
    def simulate(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr(engine, "simulate", simulate)
    result = funicular("run", "paper51")
    assert (result.exit_code, result.stderr) == (130, "interrupted\n")


@pytest.mark.parametrize(
    ("args", "message"),
    [
        (["paper15"], "paper15: there is no such scene file, nor a bundled scene of that name"),
        (["paper51", "--tol", "-1"], "run: tol must be positive, got -1"),
        (["paper51", "--duration", "nan"], "run: duration must be finite, got nan s"),
        (
            ["paper51", "-o", "absent/x.nc"],
            "absent/x.nc: the results cannot be written here: No such file or directory",
        ),
        (["paper51", "--plot-dir", "file/a"], "picture.png: the results cannot be written here: Not a directory"),
    ],
)
def test_errors_are_one_line_before_the_run(engine, tmp_path, args, message):
    (tmp_path / "file").touch()
    result = funicular("run", *args)
    assert result.exit_code == 1
    assert result.stderr.startswith("error: ") and message in result.stderr
    assert result.stderr.count("\n") == 1 and result.stdout == ""
    assert engine.calls == [] and [p.name for p in tmp_path.iterdir()] == ["file"]


def test_warnings_are_notes(engine, tmp_path):
    text = load_scene("paper51").to_toml().replace("position = [0.25, 0.0,", "position = [0.25, 1e-4,")
    (tmp_path / "x.toml").write_text(text)
    result = funicular("run", "x.toml")
    assert result.exit_code == 0
    assert result.stderr == 'note: slide "trolley": body "A" was moved by 0.0001 m onto cable "wire"\n'
    assert load_run("x.nc").report["messages"][0] in result.stderr


def test_scenes():
    result = funicular("scenes")
    assert result.exit_code == 0
    names = [line.partition("\t")[0] for line in result.stdout.splitlines()]
    assert {"paper51", "paper52_rigid", "cable_car"} <= set(names)
    assert all(line.endswith(f"{name}.toml") for name, line in zip(names, result.stdout.splitlines(), strict=True))


@pytest.mark.parametrize("code", [0, 1])
def test_derive_and_verify_pass_on_names_and_exit_codes(monkeypatch, code):
    calls = []
    for name in ("derive", "derive.pipeline", "derive.verify", "derive.verify.command"):
        module = ModuleType(f"funicular.{name}")
        module.main = lambda *args: calls.append(args) or code
        monkeypatch.setitem(sys.modules, module.__name__, module)
    results = [
        funicular("derive"),
        funicular("derive", "--check", "beam24"),
        funicular("verify"),
        funicular("verify", "beam24", "rigid"),
    ]
    assert [r.exit_code for r in results] == [code] * 4
    assert calls == [([], False), (["beam24"], True), ([],), (["beam24", "rigid"],)]


def test_errors_hand_over_the_run(engine):
    scene = load_scene("paper51")
    for status, error in (("end_of_cable", EndOfCableError), ("no_convergence", ConvergenceError)):
        engine.outcome = {"status": status, "message": END, "duration": 0.4}
        with pytest.raises(error) as stopped:
            scene.run(save="x.nc")
        assert str(stopped.value) == END
        assert stopped.value.run.time[-1] == load_run("x.nc").time[-1] == 0.4


def test_an_interrupted_run_is_returned(engine):
    engine.outcome = {"status": "interrupted", "message": "interrupted at t = 0.4 s", "duration": 0.4}
    with pytest.warns(FunicularWarning, match=r"interrupted at t = 0.4 s") as warned:
        run = load_scene("paper51").run()
    assert warned[0].filename == __file__
    assert (run.report["status"], run.time[-1]) == ("interrupted", 0.4)


def test_settings_and_defaults_reach_the_engine(engine):
    scene = load_scene("paper51")
    scene.run_settings = {}
    scene.run(2.0, spectral_radius=0.5)
    settings = engine.calls[0]
    assert settings.model_dump() == {
        "duration": 2.0,
        "tol": 1e-4,
        "absolute_tol": None,
        "quantities": None,
        "step": None,
        "output_step": 0.02,
        "integrator": "auto",
        "spectral_radius": 0.5,
        "model": "given",
        "initial": "drawn",
        "save": None,
        "threads": 1,
        "estimate": False,
    }


def test_progress(engine, capsys, monkeypatch):
    scene, seen = load_scene("paper51"), []
    scene.run(progress=seen.append)
    scene.run()
    scene.run(progress=False)
    assert seen == [0.5]
    assert capsys.readouterr() == ("", "")
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    scene.run()
    assert "0.5 of 1 s" in capsys.readouterr().err


def test_messages_of_scene_and_engine_are_kept(engine):
    scene = load_scene("paper51")
    scene.messages.append("moved")
    with warnings.catch_warnings(action="error"):
        assert scene.run().report["messages"] == ["moved", "the start was made consistent"]


def test_version():
    result = funicular("--version")
    assert (result.exit_code, result.stdout) == (0, f"funicular {version('funicular')}\n")


@pytest.mark.parametrize(("words", "offered"), [
    ("ru", ["run"]),
    ("run paper52_m", ["paper52_modal"]),
    ("run mine", []),  # the shell then completes paths
    ("run --to", ["--tol"]),
])
def test_completion(words, offered):
    """The completions that a shell receives for the last word."""
    asked = {"_FUNICULAR_COMPLETE": "complete_bash", "COMP_WORDS": f"funicular {words}",
             "COMP_CWORD": str(len(words.split()))}
    result = CliRunner().invoke(app, env=asked, prog_name="funicular")
    assert result.exit_code == 0
    assert result.stdout.split() == offered
