"""Results: names, labels, files, energy balance. The recording is made by hand, without the engine."""

import re
from types import SimpleNamespace

import numpy as np
import pytest
import xarray
from fake_recording import fake_recording
from funicular import ResultFileError, Scene, UnknownResultError, load_run, load_scene
from funicular.parts.settings import RunSettings
from funicular.results.netcdf import File
from funicular.results.run import Run
from numpy.testing import assert_array_equal

SHAPES = {
    "A.position": (101, 3),
    "A.orientation": (101, 4),
    "A.acceleration": (101, 3),
    "wire.nodal_vectors": (101, 4, 4, 3),
    "wire.nodal_velocity": (101, 4, 4, 3),
    "trolley.s": (101,),
    "trolley.s_rate": (101,),
    "trolley.force": (101, 3),
    "trolley.multiplier": (101, 2),
    "trolley.residual": (101,),
    "wire@0.force": (101, 3),
    "wire@1.5.force": (101, 3),
    "energy.kinetic": (101,),
    "energy.dissipated": (101,),
    "time": (101,),
}
UNITS = {
    "A.position": "m",
    "A.velocity": "m/s",
    "A.angular_velocity": "rad/s",
    "A.acceleration": "m/s2",
    "trolley.s": "m",
    "trolley.force": "N",
    "wire@0.force": "N",
    "energy.elastic": "J",
    "time": "s",
}


@pytest.fixture
def recording():
    return fake_recording(load_scene("paper51"))


@pytest.fixture
def run(recording):
    return Run.from_recording(recording, load_scene("paper51"), RunSettings(duration=1.0, tol=1e-5), Scene.from_toml)


def test_names_and_shapes(run, recording):
    assert {name: run[name].shape for name in SHAPES} == SHAPES
    assert set(SHAPES) - {"time"} <= set(run.keys())
    assert_array_equal(run["A.position"], recording.parts["bodies"]["A"]["position"])
    assert_array_equal(run.time, recording.time)
    assert "A.position" in run and "B.position" not in run
    assert repr(run) == "<funicular.Run: completed, 101 times to 1 s, 20 results>"


def test_a_run_is_read_as_a_mapping(run):
    """`for name in run` asked for a result of the name 0."""
    assert list(run) == run.keys()
    assert len(run) == len(run.keys())
    assert {name: values.shape for name, values in run.items()} == {name: run[name].shape for name in run.keys()}
    assert dict(run).keys() == set(run.keys())
    assert "time" in run and 0 not in run
    assert set(run._ipython_key_completions_()) == {*run, "time", "wire.position"}
    assert all(name in run for name in run._ipython_key_completions_())


def test_a_run_without_results_is_not_false():
    assert Run({}, {}, {}, None)


def test_an_unknown_name(run):
    with pytest.raises(UnknownResultError) as error:
        run["A.positon"]
    assert str(error.value) == 'the run has no result "A.positon"; did you mean "A.position"?'
    assert isinstance(error.value, KeyError)


def test_dataset_has_labels(run):
    dataset = run.dataset
    assert {name: dataset[name].attrs["units"] for name in UNITS} == UNITS
    assert all(dataset[name].attrs["long_name"] for name in dataset.variables)
    assert dataset["wire.nodal_vectors"].dims == ("time", "wire.node", "wire.vector", "xyz")
    second_node = dataset["wire.nodal_vectors"].sel({"wire.node": 0.5, "wire.vector": "r", "xyz": "x"})
    assert_array_equal(second_node, 0.5)


def test_file_round_trip(run, tmp_path):
    path = tmp_path / "x.nc"
    run.save(path)
    back = load_run(path)
    assert back.keys() == run.keys()
    for name in [*run.keys(), "time"]:
        assert_array_equal(back[name], run[name], strict=True)
    assert back.variables["A.position"].units == "m"
    assert back.report == run.report | {"factorisations": 310}
    assert back.report["settings"] == RunSettings(duration=1.0, tol=1e-5).model_dump()
    assert vars(back.scene) == vars(load_scene("paper51")) | {"title": ""}  # it was read from text
    assert back.summary() == run.summary()
    assert [p.name for p in tmp_path.iterdir()] == ["x.nc"]


def test_xarray_opens_the_file_as_it_is(run, tmp_path):
    run.save(tmp_path / "x.nc")
    with xarray.open_dataset(tmp_path / "x.nc") as dataset:
        assert dataset["time"].dtype == float  # units "s" must not become a time difference
        assert dataset["A.position"].sel(time=0.5, xyz="x") == pytest.approx(0.75)
        assert dataset["A.position"].units == "m"


def test_a_failed_save_leaves_the_old_file(run, tmp_path, monkeypatch):
    path = tmp_path / "x.nc"
    path.write_text("old")

    def disk_full(self, first, values):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(File, "write", disk_full)
    with pytest.raises(ResultFileError, match=r"the results cannot be written here: No space left on device"):
        run.save(path)
    assert [(p.name, p.read_text()) for p in tmp_path.iterdir()] == [("x.nc", "old")]


def test_damaged_and_foreign_files(run, tmp_path):
    path = tmp_path / "x.nc"
    run.save(path)
    whole = path.read_bytes()
    for size in (0, 100, 4096, len(whole) // 2, len(whole) - 1):
        path.write_bytes(whole[:size])
        with pytest.raises(ResultFileError, match=rf"^{re.escape(str(path))}: is no netCDF file, or was cut short"):
            load_run(path)
    path.write_text("time,x\n0,1\n")
    with pytest.raises(ResultFileError, match=rf"^{re.escape(str(path))}: is no netCDF file, or was cut short"):
        load_run(path)
    xarray.Dataset({"a": 1}).to_netcdf(path, engine="scipy")
    with pytest.raises(ResultFileError, match=r"x\.nc: is a netCDF file, but not one that funicular wrote$"):
        load_run(path)
    run.dataset.assign_attrs(funicular_format=99).to_netcdf(path, engine="scipy")
    with pytest.raises(ResultFileError, match=r"x\.nc: was written by a newer funicular; update this one to read it$"):
        load_run(path)
    with pytest.raises(ResultFileError, match=r"absent\.nc: there is no such file$"):
        load_run(tmp_path / "absent.nc")


def with_energy(**energy):
    steady = dict.fromkeys(("kinetic", "elastic", "potential", "dissipated", "external"), np.zeros(3))
    variables = {f"energy.{name}": SimpleNamespace(values=np.array(e)) for name, e in (steady | energy).items()}
    return Run(variables, {}, {}, "")


def test_energy_balance():
    balance = with_energy(kinetic=[1.0, 3.0, 0.5], potential=[5.0, 3.0, 5.0], dissipated=[0, 0, 0.4]).energy_balance()
    np.testing.assert_allclose(balance.residual, [0, 0, -0.1], atol=1e-15)
    assert balance.exchanged == 2.0  # the fall from 5 J to 3 J, once
    np.testing.assert_allclose(balance.relative, [0, 0, -0.05], atol=1e-15)


def test_work_from_outside_is_no_residual():
    balance = with_energy(kinetic=[0, 2.0, 3.0], dissipated=[0, 1.0, 1.5], external=[0, 3.0, 4.0]).energy_balance()
    np.testing.assert_allclose(balance.residual, [0, 0, 0.5], atol=1e-15)


def test_supports_joins_and_springs_have_results(recording):
    turn = {"force": np.ones((101, 3)), "moment": np.full((101, 3), 2.0)}
    recording.parts |= {"clamps": {"wire@0.5": turn}, "motions": {"wire@1": turn}, "ties": {"corner": turn},
                        "point_forces": {"tie": {"tension": np.zeros(101), "length": np.ones(101)}}}
    recording.energy["external"] = np.zeros(101)
    run = Run.from_recording(recording, load_scene("paper51"), RunSettings(duration=1.0), Scene.from_toml)
    units = {name: run.variables[name].units for name in run.keys() if name not in recording.energy}
    assert {"wire@0.5.force": "N", "wire@0.5.moment": "N m", "wire@1.moment": "N m", "corner.force": "N",
            "tie.tension": "N", "tie.length": "m", "energy.external": "J"}.items() <= units.items()
    assert_array_equal(run["wire@0.5.moment"], turn["moment"])


def test_energy_balance_of_a_body_at_rest():
    balance = with_energy(potential=[5.0, 5.0, 5.0]).energy_balance()
    assert balance.exchanged == 0
    assert_array_equal(balance.relative, np.zeros(3))


def test_summary(run):
    lines = dict(line.split(": ", 1) for line in run.summary().splitlines())
    assert lines == {
        "status": "completed at t = 1 s, 101 times",
        "steps": "1000 taken, 2 rejected, 2100 Newton iterations, 310 factorisations",
        "wall time": "0.03 s: set_up 0.01, solve 0.015",
        "real-time factor": "33.3 s of motion in 1 s of wall time",
        "energy balance": "off by 1e-06 J at most, 1.2e-06 of the energy exchanged",
        "joint residual": "3e-13 m at most",
        "note": "the start was made consistent",
    }
