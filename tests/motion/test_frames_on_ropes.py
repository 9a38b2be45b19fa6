"""Slides that tie the axes of their rider to the tangent of a rope, whose nodes flow along it."""

import funicular as fu
import numpy as np
import pytest
from interrupted_runs import killed_and_resumed
from ropes.scenes import on_rope_and_cable
from test_grips import ROPE, SETTINGS
from test_slides_on_ropes import hauled

pytestmark = pytest.mark.filterwarnings("ignore:.*youngs_modulus|.*density|.*initial velocities:"
                                        "funicular.FunicularWarning")
TANGENT = {"frame": "tangent"}


def trolley(dim: int, *, along: float = 2.0, sideways: float = 0.0, **slide) -> fu.Scene:
    """Return a trolley whose floor stays along a rope over a sheave."""
    scene = fu.Scene()
    rope = scene.rope("line", route=[fu.Anchor(at=(0, 0, 0)), fu.Sheave("top", at=(10, -0.3, 0), radius=0.3),
                                     fu.Anchor(at=(10.3, -5, 0))], tension=2e3, elements=3,
                      element="cable8p" if dim == 2 else "cable12", **ROPE)
    position = np.add(rope.point(scene.holders, 4.0), (0, -0.5, 0)).tolist()
    scene.rigid_body("load", mass=20, inertia=(1, 1, 1), position=position, velocity=(along, 0, sideways))
    scene.slide("load", along="line", s=4.0, at=(0, 0.5, 0), name="trolley", **TANGENT | slide)
    return scene


@pytest.mark.parametrize(("integrator", "duration"), [("radau", 0.3), ("genalpha", 0.15)])
def test_agrees_with_a_slide_on_a_cable(integrator, duration):
    """A small sheave and 1 cm of rope beyond it, past an end of an element. The difference is in proportion to them."""
    rope, cable, line = on_rope_and_cable(0.01)
    runs = []
    for scene in (rope, cable):
        place = line.point(rope.bodies, 2.0) - np.array([0, 0.3, 0])
        scene.rigid_body("load", mass=20, inertia=(1, 1, 1), position=place.tolist(), velocity=(4, 0, 0))
        scene.slide("load", along="line", s=2.0, at=(0, 0.3, 0), name="trolley", **TANGENT)
        runs.append(scene.run(duration, **SETTINGS | {"integrator": integrator, "tol": 1e-5}))
    assert runs[0].report["element_crossings"] == runs[1].report["element_crossings"] > 0
    for name, bound in (("load.position", 1e-4), ("load.orientation", 1e-5), ("trolley.s", 1e-4)):
        assert np.abs(runs[0][name] - runs[1][name]).max() < bound, name
    moment = runs[1]["trolley.moment"]
    assert np.abs(runs[0]["trolley.moment"] - moment).max() < 0.02 * np.abs(moment).max() > 0.02
    assert np.abs(runs[0].energy_balance().relative).max() < 1e-5


@pytest.mark.parametrize("friction", [None, 0.1])
@pytest.mark.parametrize("integrator", ["genalpha", pytest.param("explicit", marks=pytest.mark.slow)])
def test_integrators_agree(integrator, friction):
    scene = trolley(2, friction=friction)
    run, other = (scene.run(0.15, **SETTINGS | {"integrator": name}) for name in ("radau", integrator))
    for name in ("load.position", "load.orientation"):
        assert np.abs(run[name] - other[name]).max() < 1e-5


@pytest.mark.parametrize("roll", ["free", "fixed"])
def test_a_planar_scene_and_its_twin_in_space(roll):
    """In space tangent points take the sag of the rope into account."""
    planar, spatial = trolley(2).run(0.3, **SETTINGS), trolley(3, roll=roll).run(0.3, **SETTINGS)
    assert np.ptp(planar["load.orientation"][:, 3]) > 5e-4
    assert np.abs(planar["load.position"] - spatial["load.position"]).max() < 1e-4  # measured: 2.3e-5
    assert np.abs(planar["load.orientation"] - spatial["load.orientation"]).max() < 5e-5
    assert np.abs(spatial.energy_balance().relative).max() < 1e-5


@pytest.mark.parametrize("roll", ["free", "fixed"])
def test_out_of_the_plane(roll):
    """The load swings about the tangent, or its axis across the rope stays perpendicular to up."""
    run = trolley(3, sideways=1.0, roll=roll).run(0.3, **SETTINGS)
    w, x, y, z = run["load.orientation"].T
    across = 2 * (y * z - w * x)  # height of the third axis of the body
    assert np.abs(across).max() < 1e-9 if roll == "fixed" else np.ptp(across) > 0.05
    genalpha = trolley(3, sideways=1.0, roll=roll).run(0.3, **SETTINGS | {"integrator": "genalpha"})
    assert np.abs(run["load.position"] - genalpha["load.position"]).max() < 1e-4
    assert np.abs(run["load.orientation"] - genalpha["load.orientation"]).max() < 1e-4
    assert np.abs(run.energy_balance().relative).max() < 1e-5


def test_while_the_rope_runs():
    """A drum pays out under a trolley that slides with friction. The axes follow the tangent, and energy is kept."""
    run = hauled(elements=2, speed=1.0, friction=0.05, **TANGENT).run(0.5, **SETTINGS)
    assert run["energy.dissipated"][-1] > 1
    assert run["trolley.residual"].max() < 1e-9
    assert np.abs(run.energy_balance().relative).max() < 1e-6


def test_at_rest():
    """A trolley held by its drive hangs at rest as without a frame, but for the angle of the rope and its moment."""
    scene = trolley(2, along=0.0, drive=4.0)
    rest = scene.equilibrium()
    assert np.abs(rest["trolley.moment"][2]) > 1e-3
    run = scene.run(0.2, **SETTINGS, initial=rest)
    assert np.abs(run["load.position"] - rest["load.position"]).max() < 1e-8


def test_resumed_bit_for_bit(tmp_path):
    scene, settings = trolley(3), SETTINGS | {"duration": 0.3, "output_step": 0.02}
    whole = scene.run(**settings)
    resumed = killed_and_resumed(scene, tmp_path / "run.nc", 8, **settings)
    assert all(np.array_equal(whole[name], resumed[name]) for name in whole)


def test_from_a_file(tmp_path):
    scene = trolley(3, roll="fixed")
    (tmp_path / "scene.toml").write_text(scene.to_toml(), encoding="utf-8")
    again = fu.load_scene(tmp_path / "scene.toml")
    assert again.slides["trolley"].up == (0, 1, 0)
    assert np.array_equal(*(each.run(0.1, **SETTINGS)["trolley.moment"] for each in (scene, again)))


@pytest.mark.parametrize(("slide", "words"), [
    ({"frame": "section"}, 'frame "section" needs section axes, but rope "line" has a tangent only'),
    ({"roll": "fixed", "up": (1, 0, 0)}, 'is along the tangent of rope "line"'),
])
def test_refused(slide, words):
    with pytest.raises(fu.SceneError, match=words):
        trolley(3, **slide)


def test_the_energy_scheme_refuses_it():
    with pytest.raises(fu.FunicularError, match="energy"):
        trolley(2).run(0.1, step=1e-3, integrator="energy", progress=False)


def test_a_rope_that_rides_has_no_axes():
    scene = trolley(2)
    x, y, _ = scene.ropes["line"].point(scene.holders, 6.0)
    scene.cable("wire", start=(x - 1, y, 0), end=(x + 1, y, 0), element="cable8p", elements=2, **ROPE)
    with pytest.raises(fu.SceneError, match='needs axes of the rider, and rope "line" has none'):
        scene.slide(("line", 6.0), along="wire", s=1.0, **TANGENT)
