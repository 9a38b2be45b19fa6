"""Sweeps in this process have the bits of a plain loop; failures, refusals, the command."""

import inspect
import os
import subprocess
import sys
from pathlib import Path

import funicular as fu
import numpy as np
import pytest
import xarray
from funicular.cli import main
from funicular.sweeps import sweep as module
from sweep_subjects import ALONE, E_MODULUS, FRICTION, GRID, KEPT, SHORT, by_hand, same, scene, square
from typer.testing import CliRunner


@pytest.fixture(scope="module")
def grid() -> xarray.Dataset:
    return fu.sweep(scene(), GRID, keep=KEPT, **ALONE)


def test_results_are_those_of_a_plain_loop(grid):
    assert grid["A.position"].dims == (E_MODULUS, FRICTION, "time", "xyz")
    for e in GRID[E_MODULUS]:
        for mu in GRID[FRICTION]:
            run, point = by_hand(e, mu), grid.sel({E_MODULUS: e, FRICTION: mu})
            np.testing.assert_array_equal(point["A.position"], run["A.position"])
            np.testing.assert_array_equal(point["trolley.force.y"], run["trolley.force"][:, 1])
            np.testing.assert_array_equal(point["wire.position"], run["wire.position"])
            np.testing.assert_array_equal(grid.time, run.time)
            assert point.status == "completed" and point.message == "; ".join(run.report["messages"])


def test_everything_has_its_unit(grid):
    assert grid[E_MODULUS].attrs["units"] == "Pa" and grid["trolley.force.y"].attrs["units"] == "N"
    assert grid["wire.position"].attrs["units"] == "m" and grid.time.attrs["units"] == "s"
    assert grid["wire.node"].attrs["units"] == "m" and list(grid["wire.node"].values) == [0.0, 0.75, 1.5]
    assert (grid.seconds > 0).all() and grid.attrs["scene"] == scene().to_toml()


def test_file_is_the_same_and_read_when_asked_for(grid, tmp_path):
    path = tmp_path / "x.nc"
    found = fu.sweep(scene(), GRID, keep=KEPT, save=path, **ALONE)
    assert same(found.compute(), grid.load()) and same(fu.load_sweep(path).compute(), grid)
    variable = fu.load_sweep(path)["A.position"].variable
    assert not isinstance(variable._data, np.ndarray)
    for key in ((0,), (slice(None), 1, [3, 1]), ([2, 0], 0, -1, 1), (..., 2), (1, 1, 2, 0)):
        np.testing.assert_array_equal(fu.load_sweep(path)["A.position"][key], grid["A.position"].values[
            tuple(np.array(k) if isinstance(k, list) else k for k in key)])


def test_other_readers_see_all_points_with_their_parameters(grid, tmp_path):
    fu.sweep(scene(), GRID, keep=KEPT, save=tmp_path / "x.nc", **ALONE)
    with xarray.open_dataset(tmp_path / "x.nc") as found:
        assert found["A.position"].dims == ("point", "time", "xyz")
        np.testing.assert_array_equal(found[FRICTION], GRID[FRICTION] * 3)
        np.testing.assert_array_equal(found["A.position"], grid["A.position"].values.reshape(6, 5, 3))
        assert list(found.status.values) == ["completed"] * 6


def test_samples_lie_along_points():
    given = {E_MODULUS: fu.LogUniform(3e8, 5e8), "A.velocity.x": fu.Uniform(0.5, 1)}
    found = fu.sweep(scene(), given, method="latin", samples=4, seed=1, keep=["A.position.x"], **ALONE)
    assert found["A.position.x"].dims == ("point", "time") and found[E_MODULUS].dims == ("point",)
    for k in range(4):
        e, v = float(found[E_MODULUS][k]), float(found["A.velocity.x"][k])
        material = fu.Material(youngs_modulus=e, shear_modulus=0.2e9, density=4200.0)
        run = scene().replace("wire", material=material).replace("A", velocity=(v, 0, 0)).run(**SHORT)
        np.testing.assert_array_equal(found["A.position.x"][k], run["A.position"][:, 0])


def test_settings_of_runs_and_texts_are_parameters():
    given = {"run.integrator": ["radau", "explicit"], "run.tol": [1e-3, 1e-6]}
    found = fu.sweep(scene(), given, keep=["A.position.x"], **ALONE)
    run = scene().run(**SHORT | {"integrator": "explicit", "tol": 1e-6})
    np.testing.assert_array_equal(found["A.position.x"].sel({"run.integrator": "explicit", "run.tol": 1e-6}),
                                  run["A.position"][:, 0])


def test_points_of_different_durations_have_their_own_times():
    found = fu.sweep(scene(), {"run.duration": [0.02, 0.01], "A.mass": [1, 2]}, keep=["A.position.x"], **ALONE)
    short = found.isel({"run.duration": 1, "A.mass": 0})
    run = scene().run(**SHORT | {"duration": 0.01})
    rows = len(run.time)
    assert found["A.position.x"].dims == ("run.duration", "A.mass", "row")
    np.testing.assert_array_equal(short["time"][:rows], run.time)
    np.testing.assert_array_equal(short["A.position.x"][:rows], run["A.position"][:, 0])
    assert np.isnan(short["time"][rows:]).all() and np.isnan(short["A.position.x"][rows:]).all()
    np.testing.assert_array_equal(found["time"][0, 0, :5], scene().run(**SHORT).time)


def test_points_that_an_event_stops_have_their_own_times():
    base = scene()
    base.event("low", quantity="A.position.y", value=-0.0005, direction="falling", action="stop")
    found = fu.sweep(base, {"A.mass": [1.0, 50.0]}, keep=["A.position.y"], **ALONE)
    for mass in (1.0, 50.0):
        run, point = base.replace("A", mass=mass).run(**SHORT), found.sel({"A.mass": mass})
        rows = len(run.time)
        np.testing.assert_array_equal(point["time"][:rows], run.time)
        assert np.isnan(point["time"][rows:]).all() and point.status == run.status
    assert "event" in found.status.values


def test_cables_of_different_lengths_have_their_own_places_of_nodes():
    given = {"wire.end.x": [1.5, 1.8], "wire@1.5.s": [1.5, 1.8]}
    found = fu.sweep(scene(), given, method="list", keep=["wire.position"], **ALONE)
    np.testing.assert_array_equal(found["wire.node.of_point"], [[0, 0.75, 1.5], [0, 0.9, 1.8]])
    assert found["wire.node.of_point"].attrs["units"] == "m" and "wire.node" not in found.coords
    one = fu.sweep(scene(), given, method="list", keep=["A.position"], **ALONE)
    assert "wire.node.of_point" not in one


def test_a_point_with_other_places_than_the_sample_is_recorded(monkeypatch, tmp_path):
    """The sample consists of the two first points, of equal length."""
    monkeypatch.setattr(module, "sample", lambda subject, points, missing: {
        k: subject.compute([points.point(k)])[0] for k in missing[:2]})
    given = {"wire.end.x": [1.5, 1.5, 1.8], "wire@1.5.s": [1.5, 1.5, 1.8]}
    found = fu.sweep(scene(), given, method="list", keep=["wire.position"], save=tmp_path / "x.nc", **ALONE)
    assert list(found.status.values) == ["completed", "completed", "failed"]
    assert 'the point has another "wire.node" than the first points' in str(found.message.values[2])


def test_functions_of_a_run_are_kept():
    keep = {"lowest": lambda run: run["A.position"][:, 1].min(), "end": "A.position.x"}
    found = fu.sweep(scene(), {"A.mass": [1.0, 2.0]}, keep=keep, **ALONE)
    assert found.lowest.dims == ("A.mass",)
    assert float(found.lowest[1]) == scene().replace("A", mass=2.0).run(**SHORT)["A.position"][:, 1].min()


@pytest.mark.parametrize("kind", ["scene", "run", "dict"])
def test_a_function_returns_a_scene_a_run_or_numbers(kind):
    def subject(mass: float) -> object:
        made = scene().replace("A", mass=mass)
        if kind == "scene":
            return made
        run = made.run(progress=False)
        return run if kind == "run" else {"A.position.x": run["A.position"][:, 0]}

    found = fu.sweep(subject, {"mass": [1.0, 2.0]}, keep=["A.position.x"], **ALONE)
    for mass in (1.0, 2.0):
        run = scene().replace("A", mass=mass).run(**SHORT)
        np.testing.assert_array_equal(found["A.position.x"].sel(mass=mass), run["A.position"][:, 0])


def test_a_point_that_fails_is_recorded_and_the_rest_goes_on():
    found = fu.sweep(square, {"x": [1, 2, 3], "y": [1.0, 2.0]}, **ALONE)
    np.testing.assert_array_equal(found["product"], [[1, 2], [np.nan] * 2, [3, 6]])
    np.testing.assert_array_equal(found["both"][2], [[3, 1], [3, 2]])
    assert (found.status == "failed").values.tolist() == [[False] * 2, [True] * 2, [False] * 2]
    assert found.message.values[1, 0] == "ZeroDivisionError: x is two" and found.message.values[0, 0] == ""


def test_a_run_that_fails_is_recorded():
    """At 60 m/s the body leaves the end of the cable."""
    found = fu.sweep(scene(), {"A.velocity.x": [1.0, 60.0]}, keep=["A.position"], duration=0.03, **ALONE)
    assert list(found.status.values) == ["completed", "failed"]
    assert 'slide "trolley": ran off the end of cable "wire"' in str(found.message.values[1])
    assert np.isnan(found["A.position"][1]).all() and not np.isnan(found["A.position"][0]).any()


def test_a_long_message_is_cut_and_says_so():
    def fails(x: int) -> dict:
        if x:
            raise ValueError("é" * 500)
        return {"y": x}

    text = str(fu.sweep(fails, {"x": [0, 1]}, **ALONE).message.values[1])
    assert text.startswith("ValueError: ééé") and text.endswith("é...") and len(text.encode()) <= 240


def test_a_point_of_another_shape_is_recorded():
    found = fu.sweep(lambda n: {"array": np.zeros(n)}, {"n": [3, 3 + 1]}, **ALONE)
    assert list(found.status.values) == ["returned", "failed"]
    assert 'has the shape (4,) here, and (3,) at the first points' in str(found.message.values[1])


@pytest.mark.parametrize("given, words", [
    ({"keep": ["A.positon"]}, 'no result "A.positon"; did you mean "A.position"'),
    ({"keep": []}, "names no results to keep.*known: .*A.position"),
    ({"keep": ["A.position"], "durration": 1}, '"durration" is not known here; did you mean "duration"'),
    ({"keep": ["A.position"], "save_as": 1}, '"save_as" is not known here'),
    ({"keep": ["A.position"], "workers": -1}, "workers must be a whole number"),
    ({"keep": ["A.position"], "duration": -1}, "duration must be positive, got -1 s"),
    ({"keep": ["A.position"], "parameters": {"A.mass": [1, -2]}}, 'sweep at A.mass = -2: rigid_body "A": mass must be '
     "positive, got -2 kg"),
    ({"keep": ["A.position"], "parameters": {"A.mas": [1]}}, 'A has no "mas"; did you mean "mass"'),
    ({"keep": ["A.position.x"], "parameters": {"A.position.x": [0.25]}}, "is a parameter, and kept as a result, too"),
    ({"keep": ["A.position"], "parameters": {"run.tol": [1e-3, -1.0]}}, "tol must be positive"),
])
def test_wrong_sweeps_are_refused_before_any_work(given, words, monkeypatch):
    if "kept as a result" not in words:
        monkeypatch.setattr(module, "sample", None)
    parameters = given.pop("parameters", {"A.mass": [1.0]})
    with pytest.raises(fu.SceneError, match=words):
        fu.sweep(scene(), parameters, **{**ALONE, **given})


def test_wrong_values_are_found_among_very_many_points(monkeypatch):
    monkeypatch.setattr(module, "sample", None)
    masses = [*np.linspace(1, 2, 1500)]
    with pytest.raises(fu.SceneError, match=r"A\.inertia\.2\.2 = -0\.5:"):
        fu.sweep(scene(), {"A.mass": masses, "A.inertia.2.2": [0.0015, -0.5]}, keep=["A.position"], **ALONE)
    with pytest.raises(fu.SceneError, match=r"A\.mass = -0\.[0-9]+:"):
        fu.sweep(scene(), {"A.mass": fu.Uniform(-1e-3, 1)}, method="random", samples=3000, keep=["A.position"],
                 **ALONE)


def test_scenes_that_cannot_be_simulated_are_recorded_on_demand():
    found = fu.sweep(scene(), {"A.mass": [1.0, -2.0]}, keep=["A.position"], record_invalid=True, **ALONE)
    assert list(found.status.values) == ["completed", "failed"] and "mass must be positive" in str(found.message[1])


@pytest.mark.parametrize("function, words", [
    (lambda x: {}, 'takes no parameter "y"'),
    (lambda x, y, z: {}, "cannot be called with x, y alone"),
    (3, "must be a scene or a function"),
])
def test_functions_that_do_not_fit_are_refused(function, words):
    with pytest.raises(fu.SceneError, match=words):
        fu.sweep(function, {"x": [1], "y": [1]}, **ALONE)


@pytest.mark.parametrize("made, words", [("text", "must return a Scene, a Run, or a dict"), ({"a": "b"}, 'kept as "a"'),
                                         ({"time": 1.0}, '"time" is taken')])
def test_what_functions_return_is_checked(made, words):
    with pytest.raises(fu.FunicularError, match=words):
        fu.sweep(lambda x: made, {"x": [1, 2]}, **ALONE)


def test_a_sweep_of_which_all_fails_says_why():
    with pytest.raises(fu.FunicularError, match="all 1 points that were tried first failed; one of them: Zero"):
        fu.sweep(square, {"x": [2], "y": [1.0]}, **ALONE)


def test_without_dask_the_remedy_is_said(monkeypatch):
    find = module.importlib.util.find_spec
    monkeypatch.setattr(module.importlib.util, "find_spec", lambda name: None if name == "distributed" else find(name))
    with pytest.raises(fu.FunicularError, match=r"\"distributed\" is missing; pip install 'funicular\[sweep\]', or .*"
                                                "workers=0, --serial"):
        fu.sweep(square, {"x": [1], "y": [1.0]})
    assert fu.sweep(square, {"x": [1], "y": [1.0]}, **ALONE).attrs["finished"] == 1
    with pytest.raises(fu.FunicularError, match=r"\"distributed\" is missing"):
        fu.sweep(scene(), GRID, keep=KEPT, cluster="tcp://127.0.0.1:1")
    monkeypatch.setattr(module, "PROCESSES_START_SECONDS", 0.0)  # long work of scenes takes threads
    found = fu.sweep(scene(), GRID | {"A.mass": [1.0, 1.5]}, keep=KEPT, workers=2, progress=False)
    assert found.attrs["finished"] == 12


def test_the_cost_is_told_beforehand():
    told = []
    fu.sweep(square, {"x": [1, 3], "y": [*range(20)]}, on_cost=told.append, **ALONE)
    assert told[0].points == 40 - told[0].sampled and told[0].sampled == 8
    cost = fu.sweep_cost(scene(), GRID, keep=KEPT, workers=2)
    assert cost.points == 6 and cost.seconds == 3 * cost.point_seconds[1] and cost.bytes == 6 * cost.point_bytes
    assert str(cost).startswith("6 points of ") and " on 2 workers; " in str(cost)


def command(*arguments: str, folder: Path):
    (folder / "scene.toml").write_text(scene().to_toml())
    here = os.getcwd()
    os.chdir(folder)
    try:
        from funicular.cli.main import app
        return CliRunner().invoke(app, ["sweep", "scene.toml", "--serial", *arguments])
    finally:
        os.chdir(here)


def test_command(grid, tmp_path):
    options = ("--set", f"{E_MODULUS}=3e8:5e8:3", "--set", f"{FRICTION}=0,0.2", "--keep", ",".join(KEPT))
    done = command(*options, folder=tmp_path)
    assert done.exit_code == 0 and "6 of 6 points, 0 failed" in done.output
    found = fu.load_sweep(tmp_path / "scene-sweep.nc")
    for name in KEPT:
        np.testing.assert_array_equal(found[name], grid[name])
    told = command(*options, "--estimate", "-o", "other.nc", folder=tmp_path)
    assert told.exit_code == 0 and told.output.startswith("6 points of ") and not (tmp_path / "other.nc").exists()


@pytest.mark.parametrize("options, words", [
    (("--set", "wire.materal.density=1"), 'wire has no "materal"'), (("--set", "A.mass"), "is not PATH=VALUES"),
    (("--set", "A.mass=1", "--set", "A.mass=2"), "given twice"), (("--set", "A.mass=1:2", "--method", "latin"),
                                                                   "needs a number of samples")])
def test_command_refuses(options, words, tmp_path):
    done = command(*options, "--keep", "A.position", folder=tmp_path)
    assert done.exit_code == 1 and words in done.output
    assert sorted(path.name for path in tmp_path.iterdir()) == ["scene.toml"]


def test_command_tells_what_failed(tmp_path):
    done = command("--set", "A.velocity.x=1,60", "--keep", "A.position", "--duration", "0.03", folder=tmp_path)
    assert done.exit_code == 0 and "2 of 2 points, 1 failed" in done.output and "ran off the end" in done.output


def test_interrupted_sweeps_say_so(tmp_path):
    def interrupt(done: int, failed: int) -> None:
        raise KeyboardInterrupt

    with pytest.warns(fu.FunicularWarning, match="interrupted; .* of 40 points are in .*, and the same sweep goes on"):
        found = fu.sweep(square, {"x": [1, 3], "y": [*range(20)]}, save=tmp_path / "x.nc", workers=0, batch=2,
                         progress=interrupt)
    assert 0 < found.attrs["finished"] < 40


def test_a_sweep_is_imported_when_it_is_used():
    code = "import sys, funicular; funicular.sweep; print('dask' in sys.modules, 'xarray' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["False", "False"]


def test_the_command_module_has_no_other_defaults():
    """Options omitted on the command line have the defaults of `funicular.sweep`."""
    options, defaults = inspect.signature(main.sweep).parameters, module.sweep.__kwdefaults__
    shared = (options.keys() & defaults.keys()) - {"keep"}
    assert len(shared) == 8 and all(options[name].default == defaults[name] for name in shared)
