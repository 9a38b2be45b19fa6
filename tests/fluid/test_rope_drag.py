"""Fluids that flow past the spans of ropes, by the velocity of the material."""

import funicular as fu
import numpy as np
import pytest
from derivatives import error_by_drags
from interrupted_runs import killed_and_resumed
from ropes.scenes import rope_of
from test_grips import SETTINGS, spanned
from test_rope_loads import on_a_cable_and_a_rope

pytestmark = pytest.mark.filterwarnings("ignore:.*youngs_modulus|.*density:funicular.FunicularWarning")
WIND, DRAG = {"density": 60.0, "velocity": (3, -6, 0)}, {"normal": 1.2, "tangential": 0.02, "diameter": 0.01}


def blown(dim: int = 2, *, side: float = 1.0, lift: float = 0.0, **fluid) -> fu.Scene:
    """Return a rope over a sheave in a fluid; side -1: mirrored at x = 0."""
    scene = spanned(dim).without("load")
    if side < 0:
        rope = scene.ropes["line"]
        scene = fu.Scene()
        scene.rope("line", route=[fu.Anchor(at=(0, 0, 0)), fu.Sheave("top", at=(-10, -0.3, 0), radius=0.3),
                                  fu.Anchor(at=(-10.3, -5, 0))], tension=2e3, elements=3, section=rope.section,
                   material=rope.material)
    x, y, z = fluid.get("velocity", WIND["velocity"])
    scene.fluid("air", **WIND | fluid | {"velocity": (side * x, y, z)})
    scene.drag("line", lift=lift, **DRAG, name="past")
    return scene


def test_agrees_with_a_cable():
    """A rope of 10 m in a wind that bends it by .3 m, as a cable; the difference is that of its end beside a sheave."""
    def load(scene):
        scene.fluid("air", **WIND | {"density": 300.0})
        scene.drag("line", **DRAG, name="past")

    errors = []
    for end in (0.02, 0.01):
        runs = [scene.run(0.6, **SETTINGS) for scene in on_a_cable_and_a_rope(end, load)]
        assert runs[1]["line.nodal_vectors"][:, 2, 0, 1].min() < -0.2
        errors.append([np.abs(runs[0][name] - runs[1][name]).max() / np.abs(runs[1][name]).max()
                       for name in ("past.force", "energy.external", "energy.dissipated")])
    assert np.max(errors[0]) < 1e-2 and np.all(np.array(errors[1]) < 0.7 * np.array(errors[0]))


@pytest.mark.parametrize("speed", [2.0, -2.0])
def test_a_hauled_rope_is_braked_along_it(speed):
    """A load on a rope that is wound through a still fluid: nodes rest, the material moves. Tension grows up the rope
    by its weight and by c_t v |v| a length as it is stretched.
    """
    mass, rho, length, radius = 40.0, 0.5, 20.0, 0.3
    scene = fu.Scene()
    scene.rigid_body("load", mass=mass, inertia=(1, 1, 1), position=(-radius, -length, 0))
    scene.rope("hoist", route=[fu.Drum("winch", at=(0, 0, 0), radius=radius, side="left", length_in_store=25,
                                       velocity=fu.Ramp(start=0.0, end=1.0, after=-speed / radius)),
                               fu.Anchor("load")], tension=mass * 9.81, elements=3, **rope_of(1e6, rho, 0, 5e-2))
    scene.fluid("water", density=1000.0)
    scene.drag("hoist", tangential=0.05, diameter=0.02, displaced_area=0.0, name="past")
    run = scene.run(4.0, **SETTINGS | {"output_step": 0.5})
    below, rises = -run["load.position"][-1, 1], run["load.velocity"][-1, 1]
    expected = -1000 / 2 * np.pi * 0.02 * 0.05 * rises * abs(rises) * below
    assert abs(rises) == pytest.approx(abs(speed), rel=1e-3)
    assert run["past.force"][-1, 1] == pytest.approx(expected, rel=2e-3)
    tension = run.section_forces("hoist", method="constitutive").tension.values[-1]
    weight = rho * 9.81 * below / (1 + mass * 9.81 / 1e6)
    assert tension[0] - tension[-1] == pytest.approx(weight - expected, rel=5e-3)
    assert np.abs(run.energy_balance().relative).max() < 1e-4


@pytest.mark.parametrize("integrator", ["genalpha", "explicit"])
@pytest.mark.slow_cases("explicit")
def test_integrators_agree(integrator):
    runs = [blown(surface=-2.0, density=1000.0).run(0.1, **SETTINGS | {"integrator": name, "tol": 1e-6})
            for name in ("radau", integrator)]
    for name in ("line.position", "past.force", "energy.external", "energy.dissipated"):
        moved = np.ptp(runs[0][name], axis=0).max()
        assert moved > 0 and np.abs(runs[1][name] - runs[0][name]).max() < 1e-3 * moved
    for run in runs:
        assert np.abs(run.energy_balance().relative).max() < 1e-6


@pytest.mark.parametrize("scene", [
    blown(), blown(surface=-2.0), blown(surface=0.004), blown(3, lift=0.4, velocity=(3, -6, 2)),
    blown(profile=fu.PowerProfile(exponent=0.2, reference_height=10.0))],
    ids=["all", "surface", "section", "lift", "profile"])
def test_tangent(scene):
    assert error_by_drags(scene) < 2e-5


def test_mirrored():
    runs = [blown(side=side).run(0.3, **SETTINGS) for side in (1, -1)]
    assert np.abs(runs[1]["line.position"] - runs[0]["line.position"] * [-1, 1, 1]).max() < 1e-9


def test_a_planar_scene_and_its_twin_in_space():
    """In space tangent points take the sag of the rope into account."""
    runs = [blown(dim).run(0.5, **SETTINGS) for dim in (2, 3)]
    assert np.abs(runs[0]["line.position"] - runs[0]["line.position"][0]).max() > 0.1
    assert np.abs(runs[0]["past.force"] - runs[1]["past.force"]).max() < 2e-3 * np.abs(runs[0]["past.force"]).max()


def test_at_rest_in_a_wind():
    scene = blown()
    rest = scene.equilibrium()
    run = scene.run(0.5, initial=rest, **SETTINGS)
    assert np.abs(run["line.position"] - rest["line.position"]).max() < 1e-8
    assert scene.modes(2, rest).frequency[0] > 1.0
    with pytest.raises(fu.FunicularError, match='do not contain the forces of the drag "past"'):
        rest.section_forces("line")


def test_still_water_carries_a_rope_of_its_density():
    """Buoyancy cancels the weight but on the wrap, so that spans are straight."""
    scene = fu.Scene()
    rope = scene.rope("line", route=[fu.Anchor(at=(0, 0, 0)), fu.Sheave("top", at=(10, -0.1, 0), radius=0.1),
                                     fu.Anchor(at=(10.1, -5, 0))], length=14.98, elements=4,
                      **rope_of(1.3e5, 0.08, 0, 1e-3))
    scene.fluid("water", density=1000.0)
    scene.drag("line", displaced_area=0.08 / 1000)
    assert np.abs(scene.equilibrium()["line.position"][:4, 1]).max() < 1e-3 and rope.name == "line"


def test_resumed_bit_for_bit(tmp_path):
    scene, settings = blown(surface=-2.0), SETTINGS | {"duration": 0.8}
    whole = scene.run(**settings)
    resumed = killed_and_resumed(scene, tmp_path / "run.nc", 10, **settings)
    assert all(np.array_equal(whole[name], resumed[name]) for name in whole)


def test_from_a_file(tmp_path):
    scene = blown()
    (tmp_path / "scene.toml").write_text(scene.to_toml(), encoding="utf-8")
    runs = [each.run(0.1, **SETTINGS)["past.force"] for each in (scene, fu.load_scene(tmp_path / "scene.toml"))]
    assert np.array_equal(*runs) and scene.view() is not None


@pytest.mark.parametrize(("given", "words"), [
    ({"polar": fu.Polar(angle=[-np.pi, 0, np.pi], drag=[1, 1, 1], lift=[0, 0, 0]), "normal": 0.0},
     "has a polar, but its sections have no rotation"),
    ({"area": 1.0}, "takes no area"),
    ({"lift": 0.5}, 'lift of rope "line" leaves the plane'),
    ({"normal": 0.0, "tangential": 0.0, "displaced_area": 0.0}, "neither drag nor buoyancy"),
])
def test_refused(given, words):
    scene = spanned().without("load")
    scene.fluid("air", density=1.0)
    with pytest.raises(fu.SceneError) as caught:
        scene.drag("line", **{"normal": 1.0, **given})
    assert words in str(caught.value)


def test_refused_twice_and_without_mass():
    scene = blown()
    with pytest.raises(fu.SceneError, match='rope "line" has the drag "past" already'):
        scene.drag("line", normal=1.0)
    with pytest.raises(fu.SceneError, match="has mass=False"):
        scene.replace("line", mass=False)
    with pytest.raises(fu.SceneError, match='"top" is a sheave of rope "line"'):
        scene.drag("top", area=1.0)
