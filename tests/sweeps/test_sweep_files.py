"""Files of sweeps: interrupted sweeps continue, others are refused, damage is detected, memory is bounded."""

import functools
import os
import subprocess
import sys
from pathlib import Path

import funicular as fu
import numpy as np
import pytest
from funicular.results.netcdf import File
from sweep_subjects import ALONE, SHORT, counted, same, scene, square


class Stopped(BaseException):
    """Simulates the death of a process."""


def stop_after(points: int):
    def progress(done: int, failed: int) -> None:
        if done >= points:
            raise Stopped

    return progress


def counts(folder: Path) -> dict[int, int]:
    lines = (folder / "computed").read_text().split()
    return {int(x): lines.count(x) for x in lines}


def test_a_stopped_sweep_goes_on_without_repeating_a_point(tmp_path):
    call = {"parameters": {"x": range(40), "folder": [str(tmp_path)]}, "save": tmp_path / "x.nc", "workers": 0,
            "batch": 3}
    with pytest.raises(Stopped):
        fu.sweep(counted, **call, progress=stop_after(20))
    half = fu.load_sweep(tmp_path / "x.nc")
    assert 20 <= half.attrs["finished"] < 40
    absent = (half.status == "not run").values.ravel()
    assert absent.sum() == 40 - half.attrs["finished"] and np.isnan(half.twice.values.ravel()[absent]).all()
    np.testing.assert_array_equal(half.twice.values.ravel()[~absent], 2.0 * np.arange(40)[~absent])
    whole = fu.sweep(counted, **call, progress=False)
    np.testing.assert_array_equal(whole.twice.values.ravel(), 2.0 * np.arange(40))
    assert counts(tmp_path) == dict.fromkeys(range(40), 1)
    fu.sweep(counted, **call, progress=False)  # nothing is left
    assert counts(tmp_path) == dict.fromkeys(range(40), 1)


def test_failed_points_are_computed_again_on_demand(tmp_path):
    def fails(x: int) -> dict:
        if (tmp_path / "bad").exists() and x > 2:
            raise ValueError
        return {"x2": x * x}

    call = {"parameters": {"x": range(5)}, "save": tmp_path / "x.nc", **ALONE}
    (tmp_path / "bad").touch()
    assert int((fu.sweep(fails, **call).status == "failed").sum()) == 2
    (tmp_path / "bad").unlink()
    assert int((fu.sweep(fails, **call).status == "failed").sum()) == 2
    found = fu.sweep(fails, **call, retry_failed=True)
    np.testing.assert_array_equal(found.x2, np.arange(5.0) ** 2)
    assert list(found.message.values) == [""] * 5


def other_square(x: int, y: float) -> dict:
    return {"product": x * y + 1, "both": [x, y]}


@pytest.mark.parametrize("change, words", [
    ({"subject": other_square}, "another scene or function"), ({"parameters": {"x": [1, 3], "y": [1.0]}}, "values"),
    ({"keep": ["product"]}, "other results to keep"),
    ({"parameters": {"x": [1], "y": [1.0]}, "method": "list"}, "values")])
def test_another_sweep_into_the_same_file_is_refused(change, words, tmp_path):
    call = {"subject": square, "parameters": {"x": [1], "y": [1.0]}, "save": tmp_path / "x.nc", **ALONE}
    fu.sweep(**call)
    before = (tmp_path / "x.nc").read_bytes()
    with pytest.raises(fu.ResultFileError, match=f"holds a sweep of .*{words}.*; delete it, or give another name"):
        fu.sweep(**call | change)
    assert (tmp_path / "x.nc").read_bytes() == before


@pytest.mark.parametrize("content", [b"text", b""])
def test_files_of_others_are_left_alone(content, tmp_path):
    (tmp_path / "x.nc").write_bytes(content)
    with pytest.raises(fu.ResultFileError, match="no sweep of funicular"):
        fu.sweep(square, {"x": [1], "y": [1.0]}, save=tmp_path / "x.nc", **ALONE)
    assert (tmp_path / "x.nc").read_bytes() == content
    scene().run(**SHORT, save=tmp_path / "run.nc")
    with pytest.raises(fu.ResultFileError, match="is not the file of a sweep"):
        fu.sweep(square, {"x": [1], "y": [1.0]}, save=tmp_path / "run.nc", **ALONE)


def test_a_file_that_is_being_written_is_refused(tmp_path):
    call = {"subject": square, "parameters": {"x": [1, 3], "y": [*range(20)]}, "save": tmp_path / "x.nc"}

    def again(done: int, failed: int) -> None:
        with pytest.raises(fu.ResultFileError, match="another sweep is writing it"):
            fu.sweep(**call, **ALONE)
        seen.append(done)

    seen: list[int] = []
    fu.sweep(**call, workers=0, progress=again)
    assert seen


def test_damaged_points_are_found_and_computed_again(tmp_path):
    path, call = tmp_path / "x.nc", {"subject": square, "parameters": {"x": [1, 3], "y": [1.0, 2.0]}}
    whole = fu.sweep(**call, **ALONE)
    fu.sweep(**call, save=path, **ALONE)
    file = File(path)
    data = bytearray(path.read_bytes())
    data[file.first_row_at + 2 * file.row_bytes + 20] ^= 1
    path.write_bytes(data)
    with pytest.raises(fu.ResultFileError, match="1 of its points are damaged, the first is number 2"):
        fu.load_sweep(path)
    with pytest.warns(fu.FunicularWarning, match="they are left out"):
        found = fu.load_sweep(path, salvage=True)
    assert found.status.values.tolist() == [["returned"] * 2, ["not run", "returned"]]
    assert np.isnan(found["product"][1, 0])
    assert same(fu.sweep(**call, save=path, **ALONE).compute(), whole.compute())
    data[file.first_row_at - 30] ^= 1
    path.write_bytes(data)
    with pytest.raises(fu.ResultFileError):
        fu.sweep(**call, save=path, **ALONE)


def test_the_file_grows_by_a_row_a_point_and_memory_by_a_byte(tmp_path):
    """Flags and the values of samples stay in memory per point; they are counted, since a measurement takes long."""
    def make(x: float) -> dict:
        return {"array": np.full(1000, x)}

    call = {"parameters": {"x": fu.Uniform(0, 1)}, "method": "random", "save": tmp_path / "x.nc", **ALONE}
    found = fu.sweep(make, samples=500, **call)
    file = File(tmp_path / "x.nc")
    assert os.path.getsize(tmp_path / "x.nc") == file.first_row_at + 500 * file.row_bytes
    assert 8000 < file.row_bytes < 8400
    assert float(found["array"][123, 7]) == float(found.x[123])


FACTOR = 1.0


def scaled(x: float) -> dict:
    return {"y": FACTOR * x}


def calls(x: float) -> dict:
    return scaled(x)


def multiplied(factor: float):
    return lambda x: {"y": factor * x}


class Times:
    def __init__(self, factor: float):
        self.factor = factor

    def __call__(self, x: float) -> dict:
        return {"y": self.factor * x}

    def method(self, x: float) -> dict:
        return self(x)


def made(source: str):
    """Return a function without a source file."""
    return eval(source)


def by_array(factor: float):
    values = np.array([factor])
    return lambda x: {"y": values[0] * x}


@pytest.mark.parametrize("make", [
    multiplied, by_array, Times, lambda factor: Times(factor).method,
    lambda factor: functools.partial(lambda factor, x: {"y": factor * x}, factor),
    lambda factor: lambda x, factor=factor: {"y": factor * x}, lambda factor: made(f"lambda x: {{'y': {factor} * x}}")])
def test_a_sweep_does_not_go_on_with_a_function_of_other_values(make, tmp_path):
    """The text of the function is the same, its results differ."""
    call = {"parameters": {"x": [1.0, 2.0]}, "save": tmp_path / "x.nc", "workers": 0, "progress": False}
    for _ in range(2):
        assert fu.sweep(make(1.0), **call)["y"].values.tolist() == [1, 2]
    with pytest.raises(fu.ResultFileError, match="another scene or function"):
        fu.sweep(make(2.0), **call)


@pytest.mark.parametrize("function", [scaled, calls])
def test_a_sweep_does_not_go_on_where_a_global_value_is_another(function, tmp_path, monkeypatch):
    call = {"parameters": {"x": [1.0, 2.0]}, "save": tmp_path / "x.nc", "workers": 0, "progress": False}
    fu.sweep(function, **call)
    monkeypatch.setitem(globals(), "FACTOR", 3.0)
    with pytest.raises(fu.ResultFileError, match="another scene or function"):
        fu.sweep(function, **call)


def test_a_sweep_does_not_go_on_with_another_watched_function(tmp_path):
    def watched(height: float) -> fu.Scene:
        made = scene()
        made.event("low", function=lambda time, state: time - height, action="stop")
        return made

    call = {"parameters": {"A.mass": [1.0, 2.0]}, "save": tmp_path / "x.nc", "workers": 0, "progress": False,
            "keep": ["A.position"], **SHORT}
    fu.sweep(watched(1e-3), **call)
    fu.sweep(watched(1e-3), **call)
    with pytest.raises(fu.ResultFileError, match="another scene or function"):
        fu.sweep(watched(2e-3), **call)


def test_what_a_function_is_does_not_depend_on_the_process():
    """A sweep continues in another process, in which addresses and the order of sets differ."""
    code = ("import sys; sys.path[:0] = ['tests', 'tests/sweeps']; from test_sweep_files import *; "
            "from funicular.sweeps.identity import identity_of; "
            "print([identity_of(each) for each in (calls, multiplied(2.0), Times(1.0), by_array(1.0))])")
    folder = Path(__file__).parents[2]
    one, other = (subprocess.run([sys.executable, "-c", code], cwd=folder, check=True, capture_output=True, text=True,
                                 env=os.environ | {"PYTHONHASHSEED": seed}).stdout for seed in "12")
    assert one == other and "0x" not in one
