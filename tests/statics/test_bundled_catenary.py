"""The bundled scene of a catenary equals the output of its builder and has its stated figures."""

import tomllib

import funicular as fu
import numpy as np
import pytest
from bundled_catenary import built
from funicular import catenary


def compare(mine, theirs, place="scene"):
    """Compare two scene files: numbers to 1e-9, the rest exactly."""
    if isinstance(mine, dict):
        assert mine.keys() == theirs.keys(), place
        for name, value in mine.items():
            compare(value, theirs[name], f"{place}.{name}")
    elif isinstance(mine, list | tuple):
        assert len(mine) == len(theirs), place
        for k, (one, other) in enumerate(zip(mine, theirs, strict=True)):
            compare(one, other, f"{place}[{k}]")
    elif isinstance(mine, float):
        assert mine == pytest.approx(theirs, rel=1e-9, abs=1e-9), place
    else:
        assert mine == theirs, place


def test_the_bundled_scene_is_what_the_builder_makes():
    compare(*(tomllib.loads(scene.to_toml()) for scene in (fu.load_scene("catenary"), built())))


def test_figures_of_the_bundled_scene():
    """On the coarse mesh the standard deviation is a tenth larger than with elements of 1 m and of 0.5 m (36.2 N)."""
    run = fu.load_scene("catenary").run(progress=False)
    found = catenary.assess(run)
    assert float(found["mean"][0]) == pytest.approx(111.5, abs=0.2)  # within 0.1 of meshes of 1 m and 0.5 m
    assert float(found.standard_deviation[0]) == pytest.approx(40.1, rel=1e-2)  # that of a tolerance of 3e-4 m
    assert float(found.maximum[0]) == pytest.approx(219.5, rel=1e-2)
    assert found.uplift.values == pytest.approx([0.0183, 0.0336, 0.0356, 0.0311], abs=3e-4)
    balance = run.energy_balance()
    assert np.abs(balance.residual).max() < 0.03 * balance.exchanged
