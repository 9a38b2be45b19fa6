"""Sheaves and drums of ropes in space on points of cables: twins in the plane, and light bodies welded there."""

import funicular as fu
import numpy as np
import pytest
from funicular.base.rotations import rotate
from funicular.engine import Engine
from funicular.model.build import build
from interrupted_runs import killed_and_resumed
from test_ropes_on_cables import (
    BAR,
    MIDDLE,
    SLIDING,
    STICKING,
    THREAD,
    TURNING,
    apart,
    bearer,
    hung,
    weights,
    wound_on,
)

SETTINGS = {"duration": 0.3, "output_step": 0.05, "tol": 1e-6, "integrator": "radau", "progress": False}
ACROSS = {"cable12": {}, "beam24": {"up": (0, 1, 0)}}
FRICTION = TURNING | {"torque": 1.0}


def welded(scene: fu.Scene, s: float = MIDDLE, name: str = "hanger") -> str:
    """Add a light body that is welded to the cable; return its name."""
    x = s / MIDDLE * 4 - 4
    scene.rigid_body(name, mass=1e-5, inertia=(1e-8,) * 3, position=(x, 0, 0))
    given = {"up": (0, 0, 1)} if scene.cables["bearer"].element == "cable12" else {}
    scene.joint("weld", name, ("bearer", s), **given)
    return name


def swaying(element: str = "cable12", *, by_body: bool = False, **sheave) -> fu.Scene:
    """Return a taut cable with a sheave in its middle; both bodies on its rope are pulled out of its plane, too."""
    scene = bearer(element, **ACROSS[element])
    weights(scene, welded(scene) if by_body else ("bearer", MIDDLE), element="cable12", **sheave)
    scene.force("heavy", value=(0, 0, 2.0))
    scene.force("light", value=(0.5, 0, 0))
    return scene


@pytest.mark.parametrize("sheave", [SLIDING, TURNING, FRICTION, STICKING],
                         ids=["sliding", "turning", "driven", "sticking"])
@pytest.mark.slow_cases("driven", "turning", "sticking")
def test_a_planar_scene_and_its_twin_in_space(sheave):
    """A torque turns the tangent of the cable. A driven wrap that slides is 3e-7 m off: in space its tangent points are
    those of chords.
    """
    runs = [weights(bearer(element), ("bearer", MIDDLE), element=element, **sheave).run(
        **SETTINGS | {"duration": 0.15, "tol": 1e-8}) for element in ("cable8p", "cable12")]
    assert apart(*runs) < (5e-7 if sheave is FRICTION else 1e-8)
    assert runs[0]["top.force"] == pytest.approx(runs[1]["top.force"], abs=1e-3)
    assert np.abs(runs[1]["bearer.position"][:, 4, 1]).max() > 3e-3


@pytest.mark.parametrize(("element", "sheave"), [("cable12", SLIDING), ("cable12", FRICTION), ("cable12", STICKING),
                                                ("beam24", SLIDING), ("beam24", FRICTION)])
@pytest.mark.slow_cases("cable12-sheave1", "cable12-sheave2", "beam24-sheave4")
def test_a_sheave_out_of_the_plane_is_one_on_a_light_body(element, sheave):
    run, other = (swaying(element, by_body=by_body, **sheave).run(**SETTINGS) for by_body in (False, True))
    assert apart(run, other) < 5e-7
    assert run["top.force"] == pytest.approx(other["top.force"], rel=1e-4, abs=1e-3)
    assert np.abs(run["bearer.position"][..., 2]).max() > 1e-3 and run["heavy.position"][-1, 2] > 0.08
    assert np.abs(run.energy_balance().relative).max() < 1e-5


@pytest.mark.parametrize("sheave", [SLIDING, {"friction": 0.2, "angle": 0.0}], ids=["sliding", "held"])
def test_a_rope_without_mass_and_its_twin_in_space(sheave):
    runs = [weights(bearer(element), ("bearer", MIDDLE), element=element, mass=False, **sheave).run(
        **SETTINGS | {"duration": 0.15, "tol": 1e-8}) for element in ("cable8p", "cable12")]
    assert apart(*runs) < 1e-8
    assert runs[0]["top.force"] == pytest.approx(runs[1]["top.force"], abs=1e-6)
    assert np.abs(runs[1]["bearer.position"][:, 4, 1]).max() > 3e-3


@pytest.mark.parametrize("element", ["cable12", "beam24"])
def test_a_rope_without_mass_on_a_cable_is_one_on_a_light_body_there(element):
    run, other = (swaying(element, by_body=by_body, mass=False).run(**SETTINGS) for by_body in (False, True))
    assert apart(run, other) < 5e-7
    assert run["top.force"] == pytest.approx(other["top.force"], rel=1e-4, abs=1e-3)
    assert run["heavy.position"][-1, 2] > 0.08
    assert np.abs(run.energy_balance().relative).max() < 1e-5
    assert run.animation("a run").clips[0].bodies


@pytest.mark.parametrize("element", ["cable12", "beam24"])
@pytest.mark.slow_cases("beam24")
def test_a_drum_on_a_cable(element):
    """A drum winds up, and an end of its rope is on the cable, too."""
    on, by_body = (bearer(element, **ACROSS[element]) for _ in range(2))
    drum = welded(by_body, 4.44375, "for_drum")
    runs = []
    for scene, holder in ((on, ("bearer", 4.44375)), (by_body, drum)):
        wound_on(scene, {"end": fu.Anchor("bearer", s=3.95), "drum": holder}, element="cable12")
        scene.force("load", value=(0, 0, 0.5))
        runs.append(scene.run(**SETTINGS))
    for name in ("load.position", "bearer.position", "winch.length_in_store"):
        assert np.abs(runs[0][name] - runs[1][name]).max() < 1e-6, name
    assert np.ptp(runs[0]["load.position"][:, 1]) > 0.01 and runs[0]["load.position"][-1, 2] > 0.01
    assert np.abs(runs[0].energy_balance().relative).max() < 1e-5


def test_an_axis_along_the_cable():
    """The groove is across the cable: a rope that runs down on both sides of it."""
    scene = bearer("cable12")
    for name, z in (("light", -0.2), ("heavy", 0.2)):
        scene.rigid_body(name, mass=1, inertia=(1, 1, 1), position=(0, -2, z))
        scene.force(name, value=(0, -9.81 if z < 0 else -11.8, 0))
    scene.rope("rope", element="cable12", tension=10.7, elements=1, **THREAD, route=[
        fu.Anchor("light"), fu.Sheave("top", at=("bearer", MIDDLE), radius=0.2, axis=(1, 0, 0), side="left"),
        fu.Anchor("heavy")])
    run = scene.run(**SETTINGS)
    assert np.abs(run.energy_balance().relative).max() < 1e-6
    other = weights(bearer("cable12"), ("bearer", MIDDLE), element="cable12").run(**SETTINGS)
    assert run["heavy.position"][:, 1] == pytest.approx(other["heavy.position"][:, 1], abs=1e-5)
    assert np.abs(run["heavy.position"][:, 0]).max() < 1e-9


def momentum(scene: fu.Scene, run: fu.Run, k: int) -> np.ndarray:
    """Return the momentum (3,) of all cables, bodies and ropes at a row of a run, N s."""
    model = build(scene)
    run.at(run.time[k]).start(model, scene)
    engine = Engine(model)
    engine.set_state(0.0)
    n, free = model.n_band + model.n_border_dof, model.unknown_of_dof >= 0
    moves = np.zeros((3, model.n_dof))
    for d in range(3):
        for cable in model.cables:
            moves[d, cable.first + d + 3 * cable.shape[1] * np.arange(cable.n_elements + 1)] = 1
        for body in model.bodies:
            moves[d, body.dof + d] = 1
        for span in (span for rope in model.ropes for span in rope.spans):
            moves[d, [span.node(i).start + d for i in range(span.n_elements + 1)]] = 1
    over = np.zeros((4, n))
    over[:, model.unknown_of_dof[free]] = np.vstack([moves, model.v])[:, free]
    found: np.ndarray = over[:3] @ engine.dense_matrix(1.0, 0.0, 0.0)[:n, :n] @ over[3]
    return found


def test_momentum_of_a_free_cable():
    """Nothing holds the cable; forces that add up to none pull on the bodies."""
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.cable("bearer", start=(-2, 0, 0), end=(2, 0, 0), elements=4, element="cable12", velocity=(0.1, 0, 0), **BAR)
    weights(scene, ("bearer", 2.0), element="cable12", **TURNING)
    for name, push in (("heavy", (0, 11.8, 0.5)), ("light", (0, 9.81, -0.5))):
        scene.force(name, value=push)
    run = scene.run(0.03, output_step=0.01, tol=1e-6, integrator="radau", progress=False)
    first, last = (momentum(scene, run, k) for k in (0, -1))
    assert np.ptp(run["bearer.position"], axis=0).max() > 1e-3 and first[0] > 0.1
    assert np.abs(last - first).max() < 1e-9


@pytest.mark.parametrize("integrator", ["genalpha", "explicit"])
def test_integrators_agree(integrator):
    given = {"duration": 0.05, "output_step": 0.01, "progress": False}
    scene = swaying(**SLIDING)
    assert apart(scene.run(integrator="radau", tol=1e-6, **given), scene.run(integrator=integrator, tol=1e-5, **given)
                 ) < 1e-6


def test_statics_and_modes_are_those_in_the_plane():
    planar, spatial = hung(), hung("cable12")
    rest, other = (scene.equilibrium() for scene in (planar, spatial))
    assert other["bearer.position"] == pytest.approx(rest["bearer.position"], abs=1e-9)
    assert other["top.force"] == pytest.approx(rest["top.force"], abs=1e-7)
    in_plane = planar.modes(3, about=rest).frequency
    both = spatial.modes(8, about=other).frequency
    assert all(np.abs(both - each).min() < 1e-5 * (each + 1e-2) for each in in_plane)


def test_resumed_bit_for_bit_and_from_a_file(tmp_path):
    scene = swaying(**TURNING)
    (tmp_path / "scene.toml").write_text(scene.to_toml(), encoding="utf-8")
    settings = {"duration": 0.05, "output_step": 1e-3, "tol": 1e-4, "integrator": "radau", "progress": False}
    resumed = killed_and_resumed(scene, tmp_path / "run.nc", 20, **settings)
    whole = fu.load_scene(tmp_path / "scene.toml").run(**settings)
    assert all(np.array_equal(whole[name], resumed[name]) for name in whole)


def test_a_rope_starts_with_its_cable():
    """A scene that moves as a whole: the rates of the rope follow from those of the cable."""
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.cable("bearer", start=(0, 0, 0), end=(4, 0, 0), elements=4, element="cable12", velocity=(0.3, 1, 0.2), **BAR)
    for name, x in (("one", -0.2), ("other", 0.2)):
        scene.rigid_body(name, mass=1, inertia=(1, 1, 1), position=(2 + x, -1, 0.1), velocity=(0.3, 1, 0.2))
    scene.rope("rope", element="cable12", tension=10.0, elements=2, **THREAD, route=[
        fu.Anchor("one"), fu.Sheave("wheel", at=("bearer", 2.0), radius=0.2, side="right"), fu.Anchor("other")])
    run = scene.run(1e-4, output_step=1e-4, step=1e-5, integrator="genalpha", progress=False)
    start, end = run["rope.position"]
    assert end - start == pytest.approx(1e-4 * np.broadcast_to([0.3, 1, 0.2], start.shape), abs=2e-6)


def test_pictures():
    """A wheel follows its point of the cable, and its axis stays across the cable."""
    run = swaying(**SLIDING).run(0.2, output_step=0.1, tol=1e-4, progress=False)
    clip = run.animation("a run").clips[0]
    wheel = next(body for body in clip.bodies if body.name == "top")
    cable = next(cable for cable in clip.cables if cable.name == "bearer")
    assert np.abs(cable.position - wheel.position[:, None]).sum(axis=-1).min(axis=1).max() < 1e-3
    slope, axis = run["bearer.nodal_vectors"][:, 4, 1], rotate(wheel.orientation, (0.0, 0.0, 1.0))
    assert np.abs(slope[-1, 2]) > 1e-5 and np.abs(np.sum(slope * axis, axis=1)).max() < 1e-12
