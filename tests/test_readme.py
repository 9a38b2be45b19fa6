"""What README.md shows is true: its scene runs, in Python and as TOML, and the files that it names exist."""

import re
from pathlib import Path

import funicular
import pytest
from funicular.scene_file import loads

ROOT = Path(__file__).parents[1]
README = (ROOT / "README.md").read_text(encoding="utf-8")


def block(language: str) -> str:
    section = README.split("## Your own scene")[1].split("\n## ")[0]
    (found,) = re.findall(rf"^```{language}\n(.*?)^```", section, re.MULTILINE | re.DOTALL)
    return found


def test_both_ways_of_writing_the_scene_are_one(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    space = {}
    exec(block("python"), space)
    assert "completed" in capsys.readouterr().out
    assert (tmp_path / "first.nc").is_file()
    from_file = loads(block("toml"), "README.md")
    assert from_file.run_settings == {"duration": 1.0, "tol": 1e-4, "output_step": 0.01}
    from_file.run_settings = {}
    assert from_file.to_toml() == space["scene"].to_toml()


def test_its_events_happen():
    """On the scene above them, run a little longer than there."""
    space = {"scene": loads(block("toml"), "README.md")}
    (example,) = re.findall(r"^```python\n(.*?)^```", README.split("## Through time")[1].split("\n## ")[0],
                            re.MULTILINE | re.DOTALL)
    exec(example, space)
    run = space["scene"].run(duration=1.0, tol=1e-4)
    assert {event["name"] for event in run.events} >= {"low"}
    assert run.status == "event" and run["A.position"][-1, 1] == pytest.approx(-0.03, abs=1e-9)


def test_rest_vibrations_and_section_forces(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (example,) = re.findall(r"^```python\n(.*?)^```", README.split("## What a scene may hold")[1].split("\n## ")[0],
                            re.MULTILINE | re.DOTALL)
    space = {}
    exec(example, space)
    rest, run = space["rest"], space["run"]
    assert rest["rope@0.force"][1] > 1000
    assert abs(run["rope.nodal_vectors"][-1] - rest["rope.nodal_vectors"]).max() < 1e-8


def test_its_trolley_runs():
    (example,) = re.findall(r"^```python\n(.*?)^```", README.split("## What rides, and what joins")[1].split("\n## ")[0],
                            re.MULTILINE | re.DOTALL)
    space = {}
    exec(example, space)
    run = space["run"]
    assert run["trolley.s"][-1] > 4
    mean = run["hinge.force"][run.time > 0.5].mean(axis=0)
    assert 0.3 * 60 * 9.81 < mean[1] < 3 * 60 * 9.81, "the rope bears the load, which falls on it"
    assert run["energy.dissipated"][-1] > 0


def test_its_scene_is_the_bundled_one():
    scene, bundled = loads(block("toml"), "README.md"), funicular.load_scene("paper51")
    for parts in ("pins", "bodies", "slides"):
        assert getattr(scene, parts) == getattr(bundled, parts)


def test_exactly_two_commands():
    section = README.split("## Two commands")[1].split("\n## ")[0]
    assert [line.startswith("    python3 -m venv") for line in section.splitlines() if line[:1] == " "] == [True] * 2


@pytest.mark.parametrize("path", sorted(set(re.findall(r"[(`]((?:derive|runtime|tests|generated)/[\w./]*)", README))))
def test_files_that_it_names_exist(path):
    assert (ROOT / path).exists()
