"""The statements of the READMEs and pages are true: code and commands run, links and names exist."""

import argparse
import inspect
import os
import re
import runpy
import subprocess
import sys
import tomllib
import warnings
from pathlib import Path

import funicular
import pytest
from funicular.cli.main import app
from funicular.parts.solids import Solid
from funicular.scene.file import loads
from pages import PAGES, ROOT, page
from typer.testing import CliRunner

README, _, RUNTIME, *_ = pages = [page(path) for path in PAGES]
OUTSIDE = "python3 -m venv", "funicular derive", "funicular verify", "funicular derive --check", "funicular theory"
"""Commands that .ci/run starts; `funicular derive --spec` is in tests/derive/test_user_elements.py."""
SHORT = {"bench": ["--duration", "0.02", "--repetitions", "1"], "sweep": ["--duration", "0.02", "--serial"]}
"""What a command gets here so that it is quick."""
QUICK = ("first_scene", "order", "paper52", "planar", "crossing", "taut_rope", "linear_cost")
"""Benchmarks that take less than 20 s; the cases and hard cases are asserted by tests of their own, and all run at
their smallest in test_benchmarks_run.
"""


def sections(language: str) -> list:
    """Return page and section of all blocks in a language, for parametrize."""
    found = dict.fromkeys((p.path, block.section) for p in pages for block in p.blocks if block.language == language)
    return [pytest.param(p, section, id=f"{p.path}: {section}")
            for p in pages for path, section in found if path == p.path]


# --- code -------------------------------------------------------------------------------------------------------


def first_scene(space):
    assert space["run"].status == "completed"
    assert space["run"]["A.position"].shape == (101, 3)


def saved(space):
    first_scene(space)
    assert funicular.load_run("first.nc")["trolley.force"].shape == (101, 3)


def rest(space):
    rest, run = space["rest"], space["run"]
    assert rest["rope@0.force"][1] > 1000
    assert abs(run["rope.nodal_vectors"][-1] - rest["rope.nodal_vectors"]).max() < 1e-8


def trolley(space):
    run = space["run"]
    assert run["trolley.s"][-1] > 4
    mean = run["hinge.force"][run.time > 0.5].mean(axis=0)
    assert 0.3 * 60 * 9.81 < mean[1] < 3 * 60 * 9.81, "the rope bears the load, which falls on it"
    assert run["energy.dissipated"][-1] > 0


def named_quantities(space):
    run = space["run"]
    assert run.status == "completed" and run.time[-1] == pytest.approx(0.3)
    assert any("A.position" in message and "trolley.s" in message for message in run.report["messages"])


def events(space):
    run = space["run"]
    assert {event["name"] for event in run.events} >= {"low"}
    assert run.status == "event"
    assert run["A.position"][-1, 1] == pytest.approx(-0.03, abs=1e-9)


def towed_line(space):
    forces = space["towed"]["line@0.force"] + space["towed"]["drag_1.force"]
    weight = 5000 * 3.141592653589793 * 0.005**2 * 20 * 9.81
    assert forces == pytest.approx([0, weight, 0], rel=1e-6, abs=1e-6 * weight)


def buoy(space):
    height = space["falls_in"]["buoy.position"][:, 1]
    assert height[0] == 3 and abs(height[-1]) < 0.6, "it swims"


def swaying_line(space):
    turning, swaying = space["swaying"].frequency
    assert turning < 1e-6, "the sinker turns freely about its line"
    assert 0.9 * 0.0807 < swaying < 0.0910, "a pendulum of 30 m with and without its added mass"


def bouncing_ball(space):
    assert "struck" in {event["what"] for event in space["run"].report["events"]}


def moored_line(space):
    assert 10 < space["moored"]["lying.last"] < 40 and space["moored"].stable


def middle_of_an_element(space):
    assert space["r"] == pytest.approx([0.25, 0, 0])


def sweeps(space):
    found, run = space["found"], space["run"]
    assert found["A.position"].dims == ("A.mass", "trolley.friction.coefficient", "time", "xyz")
    assert found.attrs["finished"] == 6 and (found.status == "completed").all()
    assert (found["A.position"].sel({"A.mass": 2.0, "trolley.friction.coefficient": 0.1}) == run["A.position"]).all()
    assert space["lowest"].sizes == {"point": 8}


def pages_and_pictures(space):
    for name in ("before", "motion", "both", "modes"):
        assert "<title>" in Path(f"{name}.html").read_text(encoding="utf-8")
    assert Path("shape.png").stat().st_size > 10_000


def buoy_in_waves(space):
    height = space["run"]["buoy.position"][:, 1] - space["elevation"]
    assert 0.5 < space["elevation"].max() - space["elevation"].min() < 3 and abs(height[20:]).max() < 0.4


def many_scenes(space):
    run = space["scene"].replace("A", mass=space["masses"][-1]).run(duration=0.1, tol=1e-3)
    assert space["mass"] == space["masses"][-1]
    assert space["kept"]["A.position"].tobytes() == run["A.position"].tobytes()


def own_element(space):
    assert space["run"].status == "completed"


def force_law(space):
    assert list(space["LAW"].parameters) == [name for name in space["Magnet"].model_fields if name not in "name a b"]


def given_values(space):
    rest = space["rest"]
    assert rest["rope@0.force"][0] == pytest.approx(-20e3)
    assert rest["dropper.tension"] > 0


def ice_that_falls(space):
    run = space["drops"]
    height = run["line.position"][..., 1]
    assert abs(height[run.time < 1] - height[0]).max() < 1e-9, "it begins at rest"
    bare, iced = height[:, 13:].mean(axis=1), height[:, :12].mean(axis=1)
    assert bare[-1] > bare[0] + 1 and iced[-1] < iced[0]


def passage(space):
    assert space["form"].lengths[:3] == pytest.approx([1.017, 0.896, 0.810], abs=2e-3)
    assert 100 < float(space["found"]["mean"][0]) < 125
    assert 0.01 < float(space["found"].uplift[1]) < 0.1


def held_by_friction(space):
    state, run = space["rest"], space["run"]
    assert 0.315 < float(state["trolley.s"]) < 0.9
    assert abs(run["A.position"] - run["A.position"][0]).max() < 1e-5

def unequal_elements(space):
    assert space["rope"].elements == 8 and space["equal"].cables["rope"].elements == 25
    assert space["halves"].cables["rope"].nodes[:5] == pytest.approx((0, 0.05, 0.1, 0.2, 0.3))


def chosen_model(space):
    assert space["choice"].kept and space["run"].report["choice"]["kept"]
    assert space["run"].scene.cables["strip"].elements == space["choice"].models["strip"].elements


def collector(space):
    run = space["run"]
    assert run.events[0]["what"] == "came into contact" and run["contact.normal_force"].max() > 100
    assert run["contact.s"][-1] - run["contact.s"][0] == pytest.approx(10, abs=0.1)


def stepped(space):
    assert space["sim"].time == 0.1 and space["run"].time[0] == pytest.approx(0.01)
    assert space["sim"].inputs == {"push.value.x": 3.0}


def linear_model(space):
    linear = space["linear"]
    assert linear.response(0.5).shape == (1, 1)
    assert sorted(abs(linear.poles.imag))[-1] == pytest.approx(3.7059411760, rel=1e-9)


SUBJECTS = "runtime/guides/pages/"
AFTERWARDS = {("README.md", "First scene"): saved,
              ("runtime/README.md", "Scenes"): first_scene,
              (f"{SUBJECTS}model.md", "A choice"): chosen_model,
              (f"{SUBJECTS}cables.md", "Unequal elements"): unequal_elements,
              (f"{SUBJECTS}cables.md", "Ice"): ice_that_falls,
              (f"{SUBJECTS}fluids.md", "A towed line"): towed_line,
              (f"{SUBJECTS}fluids.md", "A surface"): buoy,
              (f"{SUBJECTS}fluids.md", "Waves"): buoy_in_waves,
              (f"{SUBJECTS}fluids.md", "A table of the flow"): swaying_line,
              (f"{SUBJECTS}contact.md", "A line on a bed"): moored_line,
              (f"{SUBJECTS}contact.md", "Hard contact"): bouncing_ball,
              (f"{SUBJECTS}contact.md", "Crossings"): collector,
              (f"{SUBJECTS}joints.md", "A carriage"): trolley,
              (f"{SUBJECTS}catenaries.md", "A passage"): passage,
              (f"{SUBJECTS}running.md", "Tolerance"): named_quantities,
              (f"{SUBJECTS}running.md", "Events"): events,
              (f"{SUBJECTS}running.md", "From outside"): stepped,
              (f"{SUBJECTS}sweeps.md", "Sweeps"): sweeps,
              (f"{SUBJECTS}sweeps.md", "Several runs"): many_scenes,
              (f"{SUBJECTS}pictures.md", "See it"): pages_and_pictures,
              (f"{SUBJECTS}statics.md", "Equilibrium"): rest,
              (f"{SUBJECTS}statics.md", "A state with given values"): given_values,
              (f"{SUBJECTS}statics.md", "Rest by a damped motion"): held_by_friction,
              (f"{SUBJECTS}statics.md", "Linear models"): linear_model,
              ("derive/README.md", "Kernels from Python"): middle_of_an_element,
              ("derive/README.md", "Your own element"): own_element,
              ("derive/README.md", "A force between two points"): force_law}
"""What must be true when the Python of a section has run."""


@pytest.mark.parametrize(("of", "section"), sections("python"))
def test_python_runs(of, section, tmp_path, monkeypatch):
    """All blocks of a section run in one namespace; cable18 replaces the user's own element."""
    monkeypatch.chdir(tmp_path)
    space = {}
    for block in of.of(section, "python"):
        exec(block.replace('element="quintic", library="quintic"', 'element="cable18"'), space)
    AFTERWARDS[of.path, section](space)


def test_all_python_is_looked_at():
    assert {(p.values[0].path, p.values[1]) for p in sections("python")} == set(AFTERWARDS)


def in_toml() -> funicular.Scene:
    (block,) = RUNTIME.of("Scene files", "toml")
    return loads(block, RUNTIME.path)


@pytest.mark.parametrize("of", [README, RUNTIME], ids=lambda of: of.path)
def test_both_ways_of_writing_the_scene_are_one(of, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    block, *_ = of.of("First scene" if of is README else "Scenes", "python")
    space = {}
    exec(block.split("run = ")[0], space)
    from_file = in_toml()
    assert from_file.run_settings == {"duration": 1.0, "tol": 1e-4, "output_step": 0.01}
    assert 'run(duration=1.0, tol=1e-4, output_step=0.01)' in block
    from_file.run_settings = {}
    assert from_file.to_toml() == space["scene"].to_toml()


def test_its_scene_is_the_bundled_one():
    scene, bundled = in_toml(), funicular.load_scene("paper51")
    for parts in ("pins", "bodies", "slides"):
        assert getattr(scene, parts) == getattr(bundled, parts)


def test_parts_within_parts_are_the_same_in_a_file():
    rows = re.findall(r"^\| `(fu\..*?)` \| `(\{.*\})` \|$", RUNTIME.section("Scene files"), re.MULTILINE)
    assert len(rows) >= 4
    for in_python, in_file in rows:
        part, table = eval(in_python, {"fu": funicular}), tomllib.loads(f"x = {in_file}")["x"]
        if isinstance(part, Solid):
            assert table.pop("kind") == part.kind
        for tag in ("shape", "form", "stop"):
            assert table.pop(tag, None) == getattr(part, tag, None), in_file
        assert type(part).model_validate(table) == part


# --- commands ---------------------------------------------------------------------------------------------------


def commands(program: str) -> list:
    """Return the arguments of every command of a program, for parametrize."""
    found = {" ".join(words): words for p in pages for _, words in p.commands()
             if " ".join(words).startswith(f".venv/bin/{program} ")}
    return [pytest.param(words[1:], id=" ".join(words[1:])) for words in found.values()]


def test_every_command_is_one_that_is_looked_at():
    known = ("python3 -m venv ", ".venv/bin/funicular ", ".venv/bin/python tests/benchmarks/")
    for of in pages:
        for _, words in of.commands():
            assert " ".join(words).startswith(known), f"{of.path}: {words}"


def test_exactly_two_commands():
    """.ci/run takes the commands by the same heading."""
    ci = (ROOT / ".ci" / "run").read_text(encoding="utf-8")
    assert "sed -n '/^## Two commands/,/^## /s/^    //p' README.md" in ci
    assert [words[:3] for section, words in README.commands() if section == "Two commands"] == [
        ["python3", "-m", "venv"]] * 2
    assert ".venv/bin/funicular verify" in ci
    assert ".venv/bin/funicular derive --check" in ci


@pytest.mark.parametrize("words", commands("funicular"))
def test_commands_run(words, tmp_path, monkeypatch):
    if words[0] in ("derive", "verify", "theory"):  # of .ci/run and of tests/derive/test_user_elements.py: minutes
        words = [*words, "--help"]
    monkeypatch.chdir(tmp_path)
    (block,) = RUNTIME.of("Scene files", "toml")
    Path("first.toml").write_text(block, encoding="utf-8")
    short = SHORT.get(words[0], [])
    if "--resume" in words:
        interrupted(block)
        short = []
    done = CliRunner().invoke(app, [*words, *short], catch_exceptions=False)
    assert done.exit_code == 0, done.output
    if "--plot" in words:
        assert list(tmp_path.glob("*-shape.png"))
    if "--resume" in words:
        run = funicular.load_run("long.nc")
        assert run.status == "completed"
        assert run.report["resumed_at_s"]


def interrupted(scene: str) -> None:
    """Leave a run of long.toml that Ctrl-C has interrupted."""
    Path("long.toml").write_text(scene.replace("duration = 1.0", "duration = 0.1"), encoding="utf-8")

    def stop(time: float) -> None:
        if time > 0.05:
            raise KeyboardInterrupt

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", funicular.FunicularWarning)
        run = funicular.load_scene("long.toml").run(save="long.nc", progress=stop)
    assert run.status == "interrupted"


class Accepted(Exception):  # noqa: N818
    """The command line was understood."""


@pytest.mark.parametrize("words", commands("python"))
def test_benchmarks_take_their_arguments(words, monkeypatch):
    def parsed(self, *args, **given):
        parse(self, *args, **given)
        raise Accepted

    parse = argparse.ArgumentParser.parse_args
    monkeypatch.setattr(argparse.ArgumentParser, "parse_args", parsed)
    monkeypatch.setattr(os, "environ", dict(os.environ))  # they ask for one thread
    monkeypatch.setattr(sys, "argv", words)
    if "import exudyn" in (ROOT / words[0]).read_text(encoding="utf-8"):
        pytest.importorskip("exudyn")
    with pytest.raises(Accepted):
        runpy.run_path(str(ROOT / words[0]), run_name="__main__")


@pytest.mark.slow
@pytest.mark.parametrize("words", [p for p in commands("python") if Path(p.values[0][0]).stem in QUICK])
def test_quick_benchmarks_run(words, tmp_path):
    done = subprocess.run([sys.executable, ROOT / words[0], *words[1:]], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    pictures = [word for word in words if word.endswith(".png")]
    assert done.stdout.count("\n") > 3
    assert all((tmp_path / name).stat().st_size > 1000 for name in pictures)


# --- links and names --------------------------------------------------------------------------------------------


@pytest.mark.parametrize("of", pages, ids=lambda of: of.path)
def test_links_and_pictures_are_there(of):
    """Relative links work in a copy of the repository, on its host and in the source distribution."""
    for link in of.links:
        if link.startswith("https://"):
            continue
        name, _, anchor = link.partition("#")
        target = (ROOT / of.path).parent / name if name else ROOT / of.path
        assert target.resolve().is_relative_to(ROOT), link
        assert target.exists(), link
        if anchor:
            assert anchor in page(target.resolve().relative_to(ROOT).as_posix()).anchors, link


@pytest.mark.parametrize("of", [RUNTIME], ids=lambda of: of.path)
def test_a_page_lists_all_its_sections(of):
    contents = of.text.split("\n## ")[0]
    linked = {link[1:] for link in of.links if link.startswith("#") and f"({link})" in contents}
    titles = {re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-")
              for title in re.findall(r"^## (.*)$", of.text, re.MULTILINE)}
    assert linked == titles


@pytest.mark.parametrize("of", pages, ids=lambda of: of.path)
def test_files_that_it_names_exist(of):
    named = {word.rstrip("/") for text in of.words
             for word in re.findall(r"(?:derive|runtime|tests|generated|\.ci)/[\w./*]*", text)}
    for path in named:
        assert list(ROOT.glob(path)), path


def keywords_of(called) -> set[str]:
    """Return the fields of a part, as users write them, or the parameters of a function."""
    fields = getattr(called, "model_fields", None)
    return {f.alias or name for name, f in fields.items()} if fields else set(inspect.signature(called).parameters)


def takes_any(called) -> bool:
    """Return whether a function takes arbitrary keywords; Never marks those that are always refused."""
    return not getattr(called, "model_fields", None) and any(
        parameter.kind is parameter.VAR_KEYWORD and parameter.annotation != "Never"
        for parameter in inspect.signature(called).parameters.values())


@pytest.mark.parametrize("of", pages, ids=lambda of: of.path)
def test_names_of_the_package_exist(of):
    """Classes, functions and methods, with the keywords that they are shown with."""
    for word in of.words:
        for owner, name, given in re.findall(r"\b(fu|scene)\.(\w+)(\([^)]*\))?", word):
            called = getattr(funicular if owner == "fu" else funicular.Scene(), name, None)
            assert called is not None, word
            if (keywords := re.findall(r"(\w+)=", given)) and not takes_any(called):
                assert set(keywords) <= keywords_of(called), word


def test_front_page_is_short():
    assert README.text.count("\n") <= 160


def test_layout_is_that_of_the_folders():
    """The table under "Layout" names all folders of the top level, and all packages of derive and runtime."""
    rows = [row.split("|") for row in README.section("Layout").splitlines() if row.startswith("| ")][1:]
    named = {re.search(r"\w+", row[1])[0]: re.findall(r"`(\w+)`", row[3]) for row in rows}
    assert set(named) == {"derive", "generated", "runtime", "tests"}
    for folder, inside in named.items():
        for name in inside:
            assert (ROOT / folder / name).is_dir(), f"{folder}/{name}"
        packages = {path.parent.name for path in (ROOT / folder).glob("*/__init__.py")}
        assert folder not in ("derive", "runtime") or packages <= set(inside), packages - set(inside)
