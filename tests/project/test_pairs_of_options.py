"""Every bundled scene with every option of every command works, or one line gives the reason of a refusal.

The options are read from the command line itself; an option without a value here fails the test. Scenes and options are
the factors of a covering array for each command.
"""

import os
import warnings
from pathlib import Path

import funicular as fu
import matplotlib
import pytest
import typer
from covering import CoveringArray, Row, smallest
from funicular.cli.main import app
from typer.testing import CliRunner

WITHOUT_A_SCENE = {"scenes", "schema", "import", "export", "derive", "verify", "theory"}
"""Commands without a scene as their first argument."""
NEVER = {"help": "prints and ends", "open_it": "opens a browser", "library": "needs a library of elements",
         "cluster": "needs a Dask scheduler", "workers": "starts processes", "retry_failed": "goes on with a file"}
"""Options that are left out, and why; tests of their own have them."""


def interval(scene: fu.Scene) -> float:
    """Return two output steps of a bundled scene, s: the duration of its runs here."""
    return 2 * scene.run_settings.get("output_step", scene.run_settings["duration"] / 100)


def first(scene: fu.Scene) -> str:
    """Return a quantity of every scene: the height of its first cable or rope."""
    return f"{next(iter([*scene.cables, *scene.ropes]))}.position.y"


VALUES = {
    "run": {"output": ["-o", "{out}/x.nc"], "plot": ["--plot"], "plot_dir": ["--plot-dir", "{out}/plots"],
            "forces": ["--plot", "--forces"], "duration": None, "tol": ["--tol", "1e-2"],
            "absolute_tol": ["--absolute-tol", "1e-4"], "quantities": ["--quantities", "{quantity}"],
            "step": ["--step", "{step}"], "integrator": ["--integrator", "radau"],
            "spectral_radius": ["--spectral-radius", "0.8", "--integrator", "genalpha"], "model": ["--model", "given"],
            "resume": ["--resume"], "estimate": ["--estimate"]},
    "choose": {"output": ["-o", "{out}/chosen.toml"], "tol": ["--tol", "0.3"], "duration": None,
               "quantities": ["--quantities", "{quantity}"], "free": ["--free", "unset"], "unequal": ["--unequal"]},
    "view": {"output": ["-o", "{out}/x.html"], "equilibrium": ["--equilibrium"], "relaxed": ["--relaxed"],
             "path": ["--path"], "modes": ["--modes", "2", "--equilibrium"], "as_drawn": ["--modes", "2", "--as-drawn"],
             "png": ["--png", "{out}/x.png"],
             "gif": ["--gif", "{out}/x.gif"], "mp4": ["--mp4", "{out}/x.mp4"], "vtk": ["--vtk", "{out}/vtk"],
             "speed": ["--speed", "10", "--gif", "{out}/y.gif"], "colour": ["--colour", "tension"]},
    "sweep": {"values": None, "keep": None, "output": None, "serial": None, "duration": None,
              "method": ["--method", "list"], "samples": ["--samples", "1", "--method", "latin"],
              "seed": ["--seed", "1"], "batch": ["--batch", "1"], "estimate": ["--estimate"],
              "record_invalid": ["--record-invalid"], "tol": ["--tol", "1e-2"],
              "output_step": ["--output-step", "{step}"], "integrator": ["--integrator", "radau"]},
    "bench": {}}
"""By command and option what is given; None for what each call has. {out} is a folder of its own."""

ALWAYS = {
    "run": ["--duration", "{duration}"], "choose": ["--duration", "{duration}"], "view": [],
    "sweep": ["--set", "gravity.y=-9.81,-9.8", "--keep", "{quantity}", "-o", "{out}/s.nc", "--serial", "--duration",
              "{duration}"], "bench": []}


def options(command: str) -> list[str]:
    """Return the options of a command."""
    return [parameter.name for parameter in typer.main.get_command(app).commands[command].params
            if parameter.param_type_name == "option" and parameter.name not in NEVER]


def test_every_command_and_option_is_here():
    assert {*typer.main.get_command(app).commands} == {*VALUES, *WITHOUT_A_SCENE}
    for command in VALUES.keys() - {"bench"}:  # of which test_bench.py has the options
        assert set(options(command)) == VALUES[command].keys(), command


def call(command: str, row: Row, folder: Path) -> str:
    """Return the outcome of a call: nothing, "refused", or an error that must not occur."""
    scene = fu.load_scene(row["scene"])
    length = interval(scene)
    given = [part for name, values in VALUES[command].items() if row.get(name) == "given" for part in values]
    facts = {"out": folder, "duration": length, "step": length / 2, "quantity": first(scene)}
    arguments = [part.format(**facts) for part in [command, row["scene"], *ALWAYS[command], *given]]
    with warnings.catch_warnings():
        warnings.simplefilter("error", RuntimeWarning)
        result = CliRunner().invoke(app, arguments)
    if result.exit_code == 0:
        return ""
    if result.exit_code in (1, 2) and isinstance(result.exception, SystemExit) and "Traceback" not in result.stderr:
        return "refused" if "error" in result.stderr.lower() else f"no word on stderr: {result.output}"
    return f"{type(result.exception).__name__}: {result.exception}"


def covered(command: str, scenes: list[str], folder: Path) -> dict[frozenset, str]:
    """Call a command for the rows of its covering array; return the errors with their minimal sets of options."""
    factors = {"scene": scenes} | {name: ["", "given"] for name, values in VALUES[command].items() if values}
    array, errors = CoveringArray(factors), {}
    neutral = {name: levels[:1] for name, levels in factors.items()} | {"scene": scenes[:2]}
    for number, row in enumerate(array.rows()):
        place = folder / str(number)
        place.mkdir()
        found = call(command, row, place)
        if not found:
            array.worked(row)
            continue
        levels = smallest(row, neutral, lambda row: call(command, row, place) == found)  # noqa: B023
        array.refuse(levels)
        if found != "refused":
            errors[levels] = found
    assert not [levels for levels in array.refused if levels <= {("scene", name) for name in scenes}]
    return errors


@pytest.fixture
def outside(tmp_path, monkeypatch):
    matplotlib.use("Agg")
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.slow
@pytest.mark.usefixtures("quick_pictures")
@pytest.mark.parametrize("command", [name for name in VALUES if name != "bench"])
def test_every_bundled_scene_with_every_option(command, outside):
    errors = covered(command, list(fu.bundled_scenes()), outside)
    assert not errors, "\n".join(f"{dict(levels)}: {error}" for levels, error in errors.items())


def test_pictures_of_forces_and_the_page_of_a_damped_catenary(outside):
    """The wires have damping_time and a law without a damping kernel of its own."""
    result = CliRunner().invoke(app, ["run", "catenary", "--duration", "0.01", "--plot", "--forces", "-o", "c.nc"])
    assert result.exit_code == 0, result.output
    assert Path("c-forces-contact.png").stat().st_size > 1000
    result = CliRunner().invoke(app, ["view", "c.nc", "-o", "c.html"])
    assert result.exit_code == 0 and os.path.getsize("c.html") > 1000, result.output
