"""Droppers of catenaries that are missing or break in a run: forces of their neighbours, energy, refusals."""

import funicular as fu
import numpy as np
import pytest
from catenary_sections import COARSE, line
from expectations import energy_error
from funicular import catenary

NAME, BREAKS = "dropper_1_5", 0.2


@pytest.fixture(scope="module")
def form():
    """The form of one span."""
    return catenary.form(line(), COARSE)


def test_the_neighbours_of_a_missing_dropper_bear_its_share(form):
    rest = catenary.scene(form, broken={NAME: 0.0}).equilibrium()
    tensions = [float(rest[f"dropper_1_{k}.tension"]) for k in (1, 2, 3, 4, 6, 7, 8, 9)]
    assert NAME + ".tension" not in rest
    assert sum(tensions) == pytest.approx(form.tensions.sum(), rel=1e-5)
    assert np.array(tensions)[3:5] == pytest.approx(1.5 * form.tensions[4], rel=5e-3)
    assert tensions == pytest.approx(tensions[::-1], rel=1e-6)


@pytest.mark.parametrize(("integrator", "settings", "bound"), [
    ("genalpha", {"tol": 1e-4, "absolute_tol": 1e-4}, 2e-2), ("radau", {"tol": 1e-5}, 2e-3),
    ("energy", {"step": 2e-3}, 1e-8), pytest.param("explicit", {"tol": 1e-5}, 1e-4, marks=pytest.mark.slow)])
def test_a_dropper_breaks(form, integrator, settings, bound):
    scene = catenary.scene(form, broken={NAME: BREAKS})
    assert fu.Scene.from_toml(scene.to_toml()).to_toml() == scene.to_toml()
    run = scene.run(duration=0.6, initial="equilibrium", integrator=integrator, output_step=0.02, progress=False,
                    **settings)
    whole = run.time <= BREAKS
    assert run[f"{NAME}.tension"][whole] == pytest.approx(form.tensions[4], rel=1e-6)
    assert not run[f"{NAME}.tension"][~whole].any()
    beside = run["dropper_1_4.tension"][~whole]
    assert beside.max() > 1.5 * form.tensions[3]  # it swings about the new state of rest
    assert energy_error(run) < bound


def test_names_and_times_are_refused(form):
    with pytest.raises(fu.SceneError, match=r'no dropper "dropper_1_10" to break.*dropper_1_1'):
        catenary.scene(form, broken={"dropper_1_10": 0.0})
    with pytest.raises(fu.SceneError, match="dropper_1_5 cannot break at -1 s"):
        catenary.scene(form, broken={NAME: -1.0})
    with pytest.raises(fu.SceneError, match="no dropper"):
        catenary.scene(form, broken={"contact": 0.0})
