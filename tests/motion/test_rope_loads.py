"""Forces at material points of ropes, and forces along their spans."""

import funicular as fu
import numpy as np
import pytest
from derivatives import at_rest, of_a_step
from funicular.engine import Engine
from funicular.integrators import GeneralisedAlpha
from funicular.model.build import build
from interrupted_runs import killed_and_resumed
from ropes.scenes import on_rope_and_cable, rope_of
from test_grips import ROPE, SETTINGS, hauled, spanned

pytestmark = pytest.mark.filterwarnings("ignore:.*youngs_modulus|.*density:funicular.FunicularWarning")
PULSE = fu.Pulse(start=0.0, end=0.3)


def loaded(dim: int = 2, *, mirrored: bool = False) -> fu.Scene:
    """Return a rope over a sheave with a force at 4 m, and one along it between two points in elements."""
    scene, side = spanned(dim).without("load"), -1 if mirrored else 1
    if mirrored:
        scene = fu.Scene()
        scene.rope("line", route=[fu.Anchor(at=(0, 0, 0)), fu.Sheave("top", at=(-10, -0.3, 0), radius=0.3),
                                  fu.Anchor(at=(-10.3, -5, 0))], tension=2e3, elements=3, **ROPE)
    scene.force("line", s=4.0, value=(side * 50, -200, 0), scale=PULSE, name="pull")
    scene.distributed_force("line", value=(side * 5, -30, 0), start=3.0, stop=12.0, name="wind")
    return scene


def on_a_cable_and_a_rope(end: float, load) -> list[fu.Scene]:
    """Return a cable of 10 m, and a rope of it that goes on over a sheave of 1 cm for a length `end`, both loaded."""
    rope, cable, _ = on_rope_and_cable(end)
    for scene in (rope, cable):
        load(scene)
    return [rope, cable]


@pytest.mark.parametrize("load", [
    lambda scene: scene.force("line", s=4.0, value=(100, -300, 0)),
    lambda scene: scene.distributed_force("line", value=(10, -40, 0), start=1.3, stop=7.1)], ids=["point", "line"])
def test_agrees_with_a_cable(load):
    """The middle falls by .3 m. The difference is in proportion to the length beside the sheave."""
    errors = []
    for end in (0.02, 0.01):
        runs = [scene.run(0.6, **SETTINGS) for scene in on_a_cable_and_a_rope(end, load)]
        places = [runs[0]["line.position"], runs[1]["line.nodal_vectors"][:, :, 0]]
        fallen = [-run[:, :, 1].min(axis=1) for run in places]
        assert max(fallen[1]) > 0.2
        errors.append(np.abs(runs[0]["energy.external"] - runs[1]["energy.external"]).max()
                      / np.abs(runs[1]["energy.external"]).max())
    assert errors[0] < 3e-3 and errors[1] < 0.7 * errors[0]


@pytest.mark.parametrize("integrator", ["genalpha", "explicit"])
@pytest.mark.slow_cases("explicit")
def test_integrators_agree(integrator):
    """Work of the loads is external and explains the energy."""
    runs = [loaded().run(0.1, **SETTINGS | {"integrator": name, "tol": 1e-6, "output_step": 0.02})
            for name in ("radau", integrator)]
    places = [run["line.position"] for run in runs]
    moved = np.abs(places[0] - places[0][0]).max()
    assert moved > 0.02
    assert np.abs(places[1] - places[0]).max() < 1e-4 * moved
    for run in runs:
        assert run["energy.external"][-1] > 1.0
        assert np.abs(run.energy_balance().relative).max() < 1e-6


def test_work_is_that_of_a_point_of_the_material():
    """A weight pulls the rope by 1.5 m past ends of elements. The work is that on the path of a body which the rope
    holds at the point of the force.
    """
    scene = fu.Scene()
    scene.rigid_body("A", mass=8, inertia=(1, 1, 1), position=(-0.2, -4, 0))
    scene.rigid_body("B", mass=10, inertia=(1, 1, 1), position=(0.2, -2, 0))
    rope = scene.rope("line", route=[fu.Anchor("A"), fu.Sheave("top", at=(0, 0, 0), radius=0.2, side="right"),
                                     fu.Anchor("B")], tension=90.0, elements=8, **rope_of(2e4, 0.1, 0, 2e-3))
    scene.rigid_body("probe", mass=1e-3, inertia=(1, 1, 1), position=rope.point(scene.bodies, 1.2).tolist())
    scene.joint("spherical", ("line", 1.2), "probe")
    force = np.array([4.0, 30.0, 0.0])
    scene.force("line", s=1.2, value=force.tolist())
    run = scene.run(1.15, **SETTINGS | {"tol": 1e-6})
    moved = run["probe.position"] - run["probe.position"][0]
    assert np.ptp(moved[:, 1]) > 1.5
    assert np.abs(run["energy.external"] - moved @ force).max() < 1e-6 * np.abs(run["energy.external"]).max()


@pytest.mark.parametrize("kind", ["step", "rest"])
def test_tangent(kind):
    """The matrix is the derivative, also by the ends of the loaded part of an element."""
    scene = spanned().without("load")
    scene.force("line", s=4.0, value=(500, -2000, 0))
    scene.distributed_force("line", value=(300, -900, 0), start=3.1, stop=12.2)
    engine = Engine(build(scene))
    if kind == "step":
        engine.start(duration=1.0, output_step=1.0, tol=1e-6, step=0.02, first_step=0.02, method=GeneralisedAlpha(0.8))
        at = 1e-2 * np.random.default_rng(1).standard_normal(engine.unknowns)
        matrix, found = engine.linearise(0.02, at)[1], of_a_step(engine, 0.02, at, 1e-6)
    else:
        engine.set_state(0.0)
        kept = engine.state()
        engine.static_residual()
        matrix, found = engine.matrix(0.0, 0.0, 1.0).toarray(), at_rest(engine, 0.0, kept, 1e-6)
    assert np.abs(found - matrix).max() < 1e-6 * np.abs(matrix).max()


def test_a_load_along_all_of_it_is_a_weight():
    """A load of the weight of a length in place of gravity gives the same state of rest, without weight on the wrap."""
    places = []
    for gravity in (True, False):
        scene = fu.Scene() if gravity else fu.Scene(gravity=(0, 0, 0))
        rope = scene.rope("line", route=[fu.Anchor(at=(0, 0, 0)), fu.Sheave("top", at=(10, -0.01, 0), radius=0.01),
                                         fu.Anchor(at=(10.01, -5, 0))], length=14.99, elements=4,
                          **rope_of(1.3e5, 0.08, 0, 1e-3))
        if not gravity:
            scene.distributed_force("line", value=(0, -9.81 * rope.material.density * rope.section.area, 0))
        places.append(scene.equilibrium()["line.position"])
    assert places[0][:, 1].min() < -5 + 1e-9 and places[0][8:24, 1].min() < -0.05
    assert np.abs(places[0] - places[1]).max() < 1e-4


def test_mirrored():
    runs = [loaded(mirrored=mirrored).run(0.2, **SETTINGS)["line.position"] for mirrored in (False, True)]
    assert np.abs(runs[1] - runs[0] * [-1, 1, 1]).max() < 1e-9


def test_a_planar_scene_and_its_twin_in_space():
    """In space tangent points take the sag of the rope into account, 1e-4 m here."""
    places = [loaded(dim).run(0.5, **SETTINGS)["line.position"]
              for dim in (2, 3)]
    assert np.abs(places[0] - places[0][0]).max() > 0.1
    assert np.abs(places[0][:, 4] - places[1][:, 4]).max() < 1e-3


def test_at_rest():
    """A loaded rope stays at rest, and its modes exist. Forces in balance are those of the law alone."""
    scene = loaded().replace("pull", scale=1.0)
    rest = scene.equilibrium()
    run = scene.run(0.5, initial=rest, **SETTINGS)
    assert np.abs(run["line.position"] - rest["line.position"]).max() < 1e-8
    assert scene.modes(2, rest).frequency[0] > 1.0
    with pytest.raises(fu.FunicularError, match='do not contain the forces of the force "pull"; take method='):
        rest.section_forces("line")
    tension = rest.section_forces("line", s=[3.0, 5.0], method="constitutive").tension.values
    assert np.all(tension > 2000)


def test_resumed_bit_for_bit(tmp_path):
    scene = hauled(elements=8)
    scene.force("haul", s=13.0, value=(0, -100, 0), scale=PULSE)
    scene.distributed_force("haul", value=(3, -5, 0), stop=15.0)
    settings = SETTINGS | {"duration": 1.0}
    whole = scene.run(**settings)
    resumed = killed_and_resumed(scene, tmp_path / "run.nc", 15, **settings)
    assert all(np.array_equal(whole[name], resumed[name]) for name in whole)


def test_from_a_file(tmp_path):
    scene = loaded()
    (tmp_path / "scene.toml").write_text(scene.to_toml(), encoding="utf-8")
    again = fu.load_scene(tmp_path / "scene.toml")
    assert again.loads["wind"].stop == 12.0 and again.loads["pull"].s == 4.0
    runs = [each.run(0.1, **SETTINGS)["line.position"] for each in (scene, again)]
    assert np.array_equal(*runs)


def test_a_force_that_reaches_a_sheave_ends_the_run():
    """A load along the rope runs over it; a force at a point ends the run."""
    scene = hauled(s=15.0)
    scene.distributed_force("haul", value=(0, -20, 0), start=20.0, stop=24.5)
    scene.force("haul", s=23.5, value=(0, -100, 0), name="pull")
    with pytest.raises(fu.RopeLeftError, match=r'force "pull" acts on rope "haul" at s = 23\.5 m, which reaches '
                       'sheave "top"') as caught:
        scene.run(5.0, **SETTINGS)
    assert 1.0 < caught.value.run.time[-1] < 3.0
    assert scene.without("pull").run(3.0, **SETTINGS).energy_balance().relative.max() < 1e-5


def test_drawn():
    """Arrows end on the rope, those along it at its loaded part."""
    page = loaded().view()
    assert page is not None


@pytest.mark.parametrize(("add", "words"), [
    (lambda s: s.moment("haul", s=7.0, value=(0, 0, 1)), "no axes on which a moment could act"),
    (lambda s: s.force("haul", s=7.0, value=(1, 0, 0), follower=True), "no axes that it could follow"),
    (lambda s: s.distributed_force("haul", value=(1, 0, 0), follower=True), "no axes that it could follow"),
    (lambda s: s.force("haul", value=(1, 0, 0)), "needs the stress-free arc-length s there"),
    (lambda s: s.force("haul", s=7.0, at=(0, 0, 0), value=(1, 0, 0)), "not a point at"),
    (lambda s: s.force("haul", s=99.0, value=(1, 0, 0)), "must lie within a span"),
    (lambda s: s.force("winch", value=(1, 0, 0)), '"winch" is a drum of rope "haul"'),
    (lambda s: s.distributed_force("haul", value=(1, 0, 0), start=3.0, stop=99), "stop must lie on the rope"),
    (lambda s: s.force("haul", s=7.0, value=(0, 0, 1)), "leaves the plane"),
])
def test_refused(add, words):
    with pytest.raises(fu.SceneError) as caught:
        add(hauled())
    assert words in str(caught.value)


@pytest.mark.parametrize("add", [
    lambda s: s.joint("spherical", ("line", 4.0), "load"), lambda s: s.force("line", s=4.0, value=(0, -1, 0)),
    lambda s: s.distributed_force("line", value=(0, -1, 0))])
def test_refused_without_mass(add):
    with pytest.raises(fu.SceneError, match="has mass=False: it is straight and carries no load; give it a mass"):
        add(spanned(load=(0, 0, 0)).replace("line", mass=False))
