"""Runs combined along a new dimension."""

import json

import funicular as fu
import numpy as np
import pytest
from expectations import refused


@pytest.fixture(scope="module")
def runs():
    scene = fu.load_scene("paper51")
    return [scene.replace("A", mass=mass).run(duration=0.02, tol=1e-3) for mass in (1.0, 2.0)]


def test_runs_along_a_new_dimension(runs):
    found = fu.combine(runs, mass=[1.0, 2.0])
    assert dict(found.sizes)["mass"] == 2 and set(runs[0].keys()) < set(found.data_vars)
    for k, run in enumerate(runs):
        one = found.sel(mass=k + 1.0)
        for key in run.keys():
            np.testing.assert_array_equal(one[key], run[key])
        assert json.loads(str(one["report"].values))["status"] == "completed"
        assert fu.Scene.from_toml(str(one["scene"].values)).bodies["A"].mass == k + 1.0
    assert found["A.position"].attrs["units"] == "m"


def test_what_cannot_be_combined_is_refused(runs):
    with refused("combine: mass must have one value for each of the 2 runs, got the shape (3,)", fu.FunicularError):
        fu.combine(runs, mass=[1, 2, 3])
    with refused('combine: the runs have "time" already; name the dimension otherwise', fu.FunicularError):
        fu.combine(runs, time=[1, 2])
    longer = runs[0].scene.run(duration=0.03, tol=1e-3)
    with refused('combine: the run of mass = 2 has another "time" than the first; for the same times give all the same '
                 "duration and output_step", fu.FunicularError):
        fu.combine([runs[0], longer], mass=[1, 2])
