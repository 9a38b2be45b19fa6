"""Example 5.2 of the paper: a link with a ball below a cable, of three kinds."""

import numpy as np
import pytest
from expectations import energy_error
from funicular import load_scene
from paper52 import KINDS, apart, scene

# an independent formulation: the ball at t, the slide at the end
BALL = {0.5: (0.64119495, -0.52848962), 1.0: (1.06010457, -0.52851147), 1.5: (1.39133466, -0.49815146)}
SLIDE = (1.35843121, 0.00076473)


def test_the_rigid_link_moves_as_the_reference_says(validated):
    run = load_scene("paper52_rigid").run(duration=1.5, tol=1e-6, output_step=0.5)
    assert run.time[1:] == pytest.approx([*BALL])
    validated("Slides", "example 5.2 of the paper, rigid link with a ball", "position of the ball at 0.5, 1 and 1.5 s",
              [*BALL.values()], run["ball.position"][1:, :2], unit="m", scale=1.0, bound=1e-6,
              source="independent formulation")
    top = 2 * run["link.position"][-1] - run["ball.position"][-1]
    np.testing.assert_allclose(top[:2], SLIDE, atol=1e-6)
    assert run["trolley.residual"].max() < 1e-12
    assert run["eye.residual"].max() < 1e-12


def test_planar_and_spatial_joints_agree():
    space, plane = (scene("rigid", planar=flat).run(duration=1.5, tol=1e-6, output_step=0.01) for flat in (False, True))
    assert apart(space, plane, 1.5) < 1e-11  # measured: 2e-14
    off = space["ball.acceleration"] - plane["ball.acceleration"]
    assert np.abs(off).max() < 1e-6  # of 25 m/s^2; measured: 2e-9


def test_links_are_one_until_flexibility_parts_them():
    runs = {by: {kind: scene(kind, stiffer=by).run(duration=1.5, tol=1e-4, output_step=0.01) for kind in KINDS}
            for by in (1.0, 10.0, 100.0)}
    for kind in ("modal", "ancf"):
        off = [[apart(of[kind], of["rigid"], until) for of in runs.values()] for until in (0.5, 1.5)]
        assert 1e-3 < off[0][0] < 5e-3, "together at first"
        assert 1e-2 < off[1][0] < 3e-2, "then apart"
        for soft, stiff in zip(off[1], off[1][1:], strict=False):
            assert soft / stiff == pytest.approx(10, rel=0.35), "as their compliance parts them"
        assert off[1][2] < 3e-4  # measured: 2.2e-4 and 2.0e-4
    assert apart(runs[1.0]["modal"], runs[1.0]["ancf"], 1.5) < 3e-3  # 2 elements there, 5 modes here


def test_the_ball_swings_in_space():
    run = scene("rigid", aside=1.0).run(duration=1.5, tol=1e-5, output_step=0.01)
    assert np.ptp(run["ball.position"][:, 2]) > 0.3
    assert run["ball.position"][-1, 0] > 1.0
    distance = np.linalg.norm(run["ball.position"] - run["link.position"], axis=1)
    np.testing.assert_allclose(distance, 0.25, atol=1e-12)


@pytest.mark.parametrize("name", ["paper52_rigid", "paper52_modal", "paper52_ancf"])
def test_scene_files_run(name):
    of_file = load_scene(name)
    run = of_file.run()
    assert run.status == "completed"
    assert energy_error(run) < 1e-3  # measured: 6e-5
