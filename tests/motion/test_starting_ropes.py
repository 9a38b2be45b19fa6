"""How ropes start: rates that follow from the bodies that hold them; states of other runs with prescribed rotations."""

import time

import funicular as fu
import numpy as np
import pytest
from funicular.model.build import build
from funicular.model.initial_state import InitialState

SECTION = fu.Circle(radius=1e-3)
SOFT = fu.Material(youngs_modulus=6e8, poisson_ratio=0.3, density=7000, damping_time=1e-4)
STIFF = fu.Material(youngs_modulus=6e10, poisson_ratio=0.3, density=7000)
MADE = {"section": SECTION, "material": SOFT, "elements": 2}


def body(scene, name, x, y, **given):
    scene.rigid_body(name, **{"mass": 2.0, "inertia": (1, 1, 0.1), "position": (x, y, 0)} | given)


def along(elements=4, **sheave) -> fu.Scene:
    """Return two bodies that move along their rope over a sheave at 1 m/s."""
    scene = fu.Scene(gravity=(0, 0, 0))
    for name, x, speed in (("A", -0.2, -1.0), ("B", 0.2, 1.0)):
        body(scene, name, x, -3, velocity=(0, speed, 0))
        scene.force(name, value=(0, -200.0, 0))
    scene.rope("rope", route=[fu.Anchor("A"), fu.Sheave("top", at=(0, 0, 0), radius=0.2, side="right", **sheave),
                              fu.Anchor("B")], tension=200.0, elements=elements, section=SECTION, material=STIFF)
    return scene


def between_bodies(shift=0.0) -> fu.Scene:
    """Return a rope from a turning body over two sheaves on bodies to a modal one, moved on by a time in s."""
    scene = fu.Scene(gravity=(0, -9.81, 0))
    rates = {"A": (-2, -1, 0.3, -0.2, 0.7), "S": (0, 0.5, 0.2, 0.1, -0.4), "R": (1.5, -0.6, -0.1, 0.3, 0.5)}
    for name, (x, y, v_x, v_y, spin) in rates.items():
        half = shift * spin / 2
        body(scene, name, x + shift * v_x, y + shift * v_y, orientation=(np.cos(half), 0, 0, np.sin(half)),
             centre=(0.03, -0.02, 0), velocity=(v_x, v_y, 0), angular_velocity=(0, 0, spin))
    scene.rope("rope", length=6.3, route=[
        fu.Anchor("A", at=(0.1, 0.05, 0)), fu.Sheave("one", at=("S", (0.05, 0.02, 0)), radius=0.2, side="right"),
        fu.Sheave("two", at=("R", (-0.1, 0, 0)), radius=0.15, side="left"), fu.Anchor(at=(3, 0.4, 0))],
        **MADE | {"section": fu.Circle(radius=1e-4)})
    return scene


@pytest.mark.parametrize("elements", [1, 8])
def test_a_rope_runs_with_its_bodies(elements):
    """The material runs at 1 m/s over the stretch from the start, and the tension stays; a rope at rest had 0 m/s and
    forces of 0 to 430 N.
    """
    run = along(elements).run(0.02, output_step=2e-4, tol=1e-5)
    stretch = 1 + 200 / (6e10 * np.pi * 1e-6)
    assert run["top.material_speed"][0] == pytest.approx(-1 / stretch, rel=2e-5)  # the bending shifts it
    assert np.abs(run["top.material_speed"] + 1 / stretch).max() < 1e-3
    assert np.abs(np.linalg.norm(run["rope.start_force"], axis=1) - 200).max() < 1.0
    assert run.report["messages"] == []


def test_rates_are_those_of_the_drawn_rope():
    """Central differences of the coordinates of scenes drawn before and after, to 2e-7, as bending shifts the spans."""
    h = 1e-4
    model, before, after = (build(between_bodies(shift)) for shift in (0.0, -h, h))
    at = model.ropes[0].coordinates
    assert np.abs(model.v[at]).max() > 0.2
    assert (after.q[at] - before.q[at]) / (2 * h) == pytest.approx(model.v[at], abs=2e-7)


def with_drums(**drum) -> fu.Scene:
    scene = fu.Scene(gravity=(0, 0, 0))
    body(scene, "C", 0, 1, velocity=(0.2, 0.5, 0), angular_velocity=(0, 0, 0.4))
    body(scene, "D", 2, -1, velocity=(0, -0.3, 0), angular_velocity=(0, 0, -0.3))
    scene.rope("rope", tension=50.0, route=[
        fu.Drum("first", at=(-2, 0, 0), radius=0.2, side="right", length_in_store=2.0, **drum),
        fu.Sheave("top", at="C", radius=0.2, side="right"),
        fu.Drum("last", at="D", radius=0.25, side="right", length_in_store=3.0, inertia=0.1)], **MADE)
    return scene


def belt() -> fu.Scene:
    """Return a closed rope around bodies that move."""
    scene = fu.Scene(gravity=(0, 0, 0))
    for name, x, y in (("A", 0, 0), ("B", 1, 0.1), ("C", 0.4, 0.8)):
        body(scene, name, x, y, velocity=(0.1 * x + y, 0.2 - x, 0), angular_velocity=(0, 0, 1 + x))
    scene.rope("rope", closed=True, tension=50.0, route=[fu.Sheave(f"on_{name}", at=name, radius=0.1, side="left")
                                                         for name in "ABC"], **MADE)
    return scene


MOVING = {"bodies": between_bodies, "drums": with_drums, "turning drum": lambda: with_drums(velocity=1.5), "belt": belt}


@pytest.mark.parametrize("made", MOVING)
def test_rates_fit_the_tangent_points_and_drums(made):
    """The start changes no velocity: the rates keep all conditions to rounding."""
    scene = MOVING[made]()
    model, run = build(scene), scene.run(1e-4, output_step=1e-4, integrator="radau")
    at = model.ropes[0].coordinates
    assert run["rope.coordinate_rates"][0] == pytest.approx(model.v[at], abs=1e-12)
    assert not any("velocities" in message for message in run.report["messages"])


def test_a_drum_that_turns_pays_out():
    """The rope leaves a drum at 1.5 rad/s at its start, at 0.3 m/s over the stretch, and is not stretched by this."""
    stretch = 1 + 50.0 / (6e8 * np.pi * 1e-6)
    one, other = (build(with_drums(**given)) for given in ({}, {"velocity": 1.5}))
    drum = one.ropes[0].drums[0]
    assert other.v[drum.s] - one.v[drum.s] == pytest.approx(0.3 / stretch, rel=1e-9)


@pytest.mark.parametrize("side", ["left", "right"])
def test_a_drum_at_the_last_end_is_the_mirror_of_one_at_the_first(side):
    """A drum takes the rope in by the same speed at either end; one at the last end had the wrong sense of winding."""
    def lifted(last: bool) -> fu.Run:
        scene, other = fu.Scene(gravity=(0, 0, 0)), {"left": "right", "right": "left"}
        body(scene, "L", 0, -3)
        scene.force("L", value=(0, -20, 0))
        drum = fu.Drum("drum", at=(0.2 if side == "left" else -0.2, 0, 0), radius=0.2, length_in_store=5.0,
                       side=other[side] if last else side, velocity=-1.0 if side == "left" else 1.0)
        scene.rope("rope", route=[drum, fu.Anchor("L")][:: -1 if last else 1], tension=20.0, **MADE)
        return scene.run(0.05, output_step=0.01, tol=1e-6)

    first, last = lifted(False), lifted(True)
    for name in ("drum.length_in_store", "drum.tension", "drum.torque", "L.position"):
        assert last[name] == pytest.approx(first[name], abs=1e-4), name
    assert first["drum.length_in_store"][-1] > 5.009


# ---- starts from states

def test_sheaves_on_a_modal_body_that_vibrates():
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.modal_body("beam", start=(-1, 0, 0), end=(1, 0, 0), element="beam12p", elements=4, modes=2,
                     section=fu.Rectangle(height=0.05, width=0.05), velocity=(0.1, 0.2, 0),
                     angular_velocity=(0, 0, 0.3),
                     material=fu.Material(youngs_modulus=2e8, poisson_ratio=0.3, density=1000))
    body(scene, "L", 0.8, -2, velocity=(0.1, 0.4, 0))
    scene.rope("rope", tension=20.0, route=[
        fu.Anchor(at=(-2, -1, 0)), fu.Sheave("one", at=("beam", (-0.5, 0, 0)), radius=0.1, side="right"),
        fu.Sheave("two", at=("beam", (0.5, 0, 0)), radius=0.1, side="right"), fu.Anchor("L")], **MADE)
    state, model = {"beam.modal_velocities": [0.5, -0.3]}, build(scene)
    InitialState(state).start(model, scene)
    run = scene.run(1e-5, output_step=1e-5, integrator="radau", initial=state)
    assert run["rope.coordinate_rates"][0] == pytest.approx(model.v[model.ropes[0].coordinates], abs=1e-12)
    assert run["beam.modal_velocities"][0] == pytest.approx([0.5, -0.3], abs=1e-12)


def test_from_a_state_of_rest():
    """A weight that starts at 1 m/s from its rest takes its rope along."""
    scene = fu.Scene()
    for name, x, speed in (("A", -0.25, 1.0), ("B", 0.25, -1.0)):
        body(scene, name, x, -2, velocity=(0, speed, 0))
    scene.rope("rope", route=[fu.Anchor("A"), fu.Sheave("top", at=(0, 0, 0), radius=0.25), fu.Anchor("B")],
               tension=19.0, **MADE)
    rest = scene.equilibrium(seek_stable=False)
    run = scene.run(0.01, output_step=0.001, initial=rest)
    assert np.abs(run["top.material_speed"] - 1 / (1 + 19.6 / (6e8 * np.pi * 1e-6))).max() < 0.01
    assert not any("velocities" in message for message in run.report["messages"])


def test_from_given_velocities_of_bodies():
    scene = along()
    still = scene.replace("A", velocity=(0, 0, 0)).replace("B", velocity=(0, 0, 0))
    assert still.run(1e-3, output_step=1e-3)["top.material_speed"][0] == 0.0
    state = {"A.velocity": (0, -1.0, 0), "B.velocity": (0, 1.0, 0)}
    given, drawn = still.run(1e-3, output_step=1e-3, initial=state), scene.run(1e-3, output_step=1e-3)
    assert given["rope.coordinate_rates"][0] == pytest.approx(drawn["rope.coordinate_rates"][0], abs=1e-12)
    kept = scene.run(1e-3, output_step=1e-3, initial={"rope.coordinate_rates": 0 * drawn["rope.coordinate_rates"][0]})
    assert any("broke a joint" in message for message in kept.report["messages"])


def test_faster_than_waves_is_refused_at_once(tmp_path):
    """The bodies run at 40 m/s along the rope; the square root of T/rho is 30 m/s."""
    scene = fu.Scene(gravity=(0, 0, 0))
    body(scene, "A", -0.2, -3, velocity=(0, 40.0, 0))
    body(scene, "B", 0.2, -1, velocity=(0, -40.0, 0))
    scene.rope("hoist", route=[fu.Anchor("A"), fu.Sheave("top", at=(0, 0, 0), radius=0.2), fu.Anchor("B")],
               tension=20.0, **MADE)
    for settings in ({}, {"save": tmp_path / "run.nc"}):
        began = time.perf_counter()
        with pytest.raises(fu.RopeLeftError, match="at t = 0 s") as caught:
            scene.run(0.01, **settings)
        assert time.perf_counter() - began < 30.0
        assert caught.value.run.time.tolist() == [0.0]
        assert caught.value.run["top.material_speed"][0] > 39


PRESCRIBED = {"velocity": {"velocity": 3.0}, "angle": {"angle": fu.Ramp(start=0.0, end=0.1, after=0.3)}}


def driven(**drive) -> fu.Scene:
    """Return a belt around two sheaves, of which one is driven."""
    scene, rough = fu.Scene(gravity=(0, 0, 0)), {"radius": 0.1, "side": "left", "inertia": 0.05, "friction": 0.3}
    scene.rope("belt", closed=True, tension=200.0, route=[fu.Sheave("driver", at=(0, 0, 0), **rough, **drive),
                                                          fu.Sheave("driven", at=(0.4, 0, 0), **rough)], **MADE)
    return scene


@pytest.mark.parametrize("drive", PRESCRIBED)
def test_a_prescribed_rotation_starts_from_a_state(drive):
    """The rotation of the driver begins anew with its signal, all else goes on."""
    scene, settings = driven(**PRESCRIBED[drive]), {"output_step": 0.05, "tol": 1e-5, "integrator": "radau"}
    run = scene.run(0.1, **settings)
    later = scene.run(0.05, **settings, initial=run.at(0.1))
    assert later["driver.angle"][0] == 0.0 and run["driver.angle"][-1] > 0.05
    assert later["driven.angle"][0] == run["driven.angle"][-1] > 1e-3


def test_a_rest_with_a_prescribed_rotation_starts_a_run():
    scene = driven(angle=3.0)
    with pytest.warns(fu.FunicularWarning, match="friction"):
        rest = scene.equilibrium()
    still = scene.replace("belt", route=driven(velocity=0.0).ropes["belt"].route)
    run = still.run(0.01, output_step=0.01, initial=rest)
    assert run["driver.angle"].tolist() == [0.0, 0.0]
    assert scene.equilibrium(start=rest)["driver.angle"] == 3.0
