"""Positions beyond the resolution of numbers, and motions with non-finite results."""

import re

import numpy as np
import pytest
from funicular import Circle, ConvergenceError, FunicularWarning, Material, Scene, SceneError, load_run
from interrupted_runs import short

STEEL = Material(youngs_modulus=2e11, poisson_ratio=0.3, density=7850)
TOO_FAR = (0, 2e9, 0)


@pytest.mark.parametrize("add", [
    lambda scene: scene.rigid_body("B", mass=1, inertia=(1, 1, 1), position=(0, 1e306, 0)),
    lambda scene: scene.rigid_body("B", mass=1, inertia=(1, 1, 1), position=(0, 0, 0), centre=TOO_FAR),
    lambda scene: scene.modal_body("B", start=TOO_FAR, end=(1, 2e9, 0), section=Circle(radius=0.01), material=STEEL),
    lambda scene: scene.cable("B", start=(0, 0, 0), end=TOO_FAR, elements=3, section=Circle(radius=0.01),
                              material=STEEL),
    lambda scene: scene.cable("B", points=[(0, 0, 0), TOO_FAR], elements=3, section=Circle(radius=0.01),
                              material=STEEL),
    lambda scene: scene.cable("B", curve=lambda u: (u, 3e9 * u, 0), elements=3, section=Circle(radius=0.01),
                              material=STEEL),
    lambda scene: scene.spring("A", TOO_FAR, stiffness=1.0),
    lambda scene: scene.joint("spherical", ("A", TOO_FAR), (0, 0, 0)),
    lambda scene: scene.force("A", value=(1, 0, 0), at=TOO_FAR),
])
def test_coordinates_have_a_bound(add):
    with pytest.raises(SceneError, match=re.escape("must lie within 1e+09 m of the origin, beyond which")):
        add(short())


@pytest.mark.parametrize("save", [False, True])
@pytest.mark.parametrize(("mass", "speed", "rows"), [(1e300, 1.0, 0), (1e3, 1e160, 0), (1e3, 1e100, 1)])
def test_results_that_are_no_numbers_end_the_run(tmp_path, mass, speed, rows, save, monkeypatch):
    """Infinite energy at the start, or at the end of the first step; recorded rows are finite.

    Such masses and speeds are refused; without that bound they represent any overflow.
    """
    monkeypatch.setattr("funicular.parts.validation.OTHER_LIMITS", (0.0, 1e308))
    scene = Scene()
    scene.rigid_body("A", mass=mass, inertia=(1, 1, 1), position=(0, 1e8, 0), velocity=(speed, 0, 0))
    with pytest.raises(ConvergenceError, match='body "A" diverges') as error:
        scene.run(duration=1.0, tol=1e-3, save=tmp_path / "x.nc" if save else None)
    run = error.value.run
    assert len(run.time) == rows and all(np.isfinite(run[name]).all() for name in run.keys())
    assert [p.name for p in tmp_path.iterdir()] == (["x.nc"] if save and rows else [])
    assert not (save and rows) or len(load_run(tmp_path / "x.nc").time) == rows


def test_rows_of_a_run_that_explodes_are_finite():
    with pytest.raises(ConvergenceError) as error:
        short().run(duration=20.0, step=0.2, output_step=0.2, integrator="explicit")
    run = error.value.run
    assert all(np.isfinite(run[name]).all() for name in run.keys())


def test_a_tolerance_below_rounding_is_noted():
    scene = Scene()
    scene.rigid_body("A", mass=1.0, inertia=(1, 1, 1), position=(9e8, 0, 0), velocity=(20, 0, 0))
    with pytest.warns(FunicularWarning, match=r"positions are rounded to 3\.6e-07 m so far from the origin, which is "
                                              r"more than tol = 1e-07 allows: draw the scene nearer to it"):
        scene.run(duration=0.1, tol=1e-7)
    scene = Scene()
    scene.rigid_body("A", mass=1.0, inertia=(1, 1, 1), position=(1e4, 0, 0))
    assert scene.run(duration=0.1, tol=1e-7).report["messages"] == []
