"""Ropes in space over sheaves on bodies that rotate: momenta, energy, integrators, planar twins, driven rotation."""

import funicular as fu
import numpy as np
import pytest
from funicular.base.rotations import rotate, turned_by
from funicular.engine import Engine
from funicular.model.build import build
from interrupted_runs import killed_and_resumed
from ropes.runs import rope_of
from test_ropes import BRIEF, INTEGRATORS, SHEAVES, THIN, near
from test_sticking_ropes import SHEAVES as STICKING
from turned_scenes import ASKEW, differences, turned_scene

SPIN = (1.5, 1.0, 2.0)
ALL = SHEAVES | {f"{name}, sticking": given for name, given in STICKING.items()}


def free(gravity=(0, 0, 0), density=7e5, **sheave) -> fu.Scene:
    """Return two bodies on a heavy rope over a sheave on a third body, all free; springs keep them apart."""
    scene = fu.Scene(gravity=gravity)
    scene.rigid_body("A", mass=2.0, inertia=(0.5, 0.4, 0.3), position=(-0.2, -1.5, 0.02), velocity=(0.1, 0, 0.2))
    scene.rigid_body("B", mass=2.5, inertia=(0.4, 0.5, 0.3), position=(0.9, -1.2, 0.1), velocity=(0.3, 0, -0.2),
                     angular_velocity=(0.2, 0.3, 0.1))
    scene.rigid_body("C", mass=3.0, inertia=(0.02, 0.03, 0.025), position=(0, 0, 0), velocity=(0, 0.1, 0.05),
                     angular_velocity=SPIN)
    top = fu.Sheave("top", at=("C", (0.01, -0.03, 0.02)), axis=(0.05, 0.1, 1), radius=0.2, side="right",
                    max_fleet_angle=0.5, **sheave)
    given = THIN | {"element": "cable12", "elements": 3, "material": fu.Material(
        youngs_modulus=6e8, poisson_ratio=0.3, density=density, damping_time=1e-4)}
    scene.rope("hoist", route=[fu.Anchor("A", at=(0, 0.1, 0)), top, fu.Anchor("B", at=(0.02, 0.1, 0))], tension=30.0,
               **given)
    for name, length in (("A", 3.0), ("B", 3.2)):
        scene.spring(name, "C", stiffness=20, length=length, name=f"push_{name}")
    return scene


def momenta(scene: fu.Scene, run, k: int) -> np.ndarray:
    """Return (6,): momentum and moment of momentum about the origin of bodies and ropes, at a row of a run."""
    model = build(scene)
    run.at(run.time[k]).start(model, scene)
    engine = Engine(model)
    engine.set_state(0.0)
    n, free_dofs = model.n_band + model.n_border_dof, model.unknown_of_dof >= 0

    def over(dofs):
        found = np.zeros(n)
        found[model.unknown_of_dof[free_dofs]] = dofs[free_dofs]
        return found

    q, rigid = model.q, np.zeros((6, model.n_dof))
    for axis, unit in enumerate(np.eye(3)):
        for each in model.bodies:
            at, d = each.configuration, each.dof
            rigid[axis, d + axis] = 1
            rigid[3 + axis, d : d + 3] = np.cross(unit, q[at : at + 3])
            rigid[3 + axis, d + 3 : d + 6] = rotate(q[at + 3 : at + 7] * [1, -1, -1, -1], unit)
        for rope in model.ropes:
            for node in (span.node(i).start for span in rope.spans for i in range(span.n_elements + 1)):
                rigid[axis, node + axis] = 1
                for at in (node, node + 3):
                    rigid[3 + axis, at : at + 3] = np.cross(unit, q[at : at + 3])
    p = engine.dense_matrix(1.0, 0.0, 0.0)[:n, :n] @ over(model.v)
    return np.array([over(each) @ p for each in rigid])


@pytest.mark.parametrize("sheave", ALL)
@pytest.mark.slow_cases("turning, sticking")
def test_momenta_and_energy_of_free_bodies(sheave):
    """The sheave's body turns by 20 degrees, with fleet angles to .2 rad; on the explicit run both are to 1e-10."""
    scene, runs = free(**ALL[sheave]), []
    for integrator, bound in (("radau", 1e-8), ("explicit", 1e-9)):
        run = scene.run(0.06, output_step=0.03, tol=1e-7, integrator=integrator, progress=False)
        found = np.array([momenta(scene, run, k) for k in range(3)])
        assert np.abs(found[0]).min() > 0.05
        assert np.abs(found - found[0]).max() < bound
        assert np.abs(run.energy_balance().relative).max() < 1e-9
        assert run["top.residual"].max() < 1e-12
        runs.append(run)
    near(*runs, 1e-8, "A.position", "B.position", "C.orientation")
    near(*runs, 1e-3, "top.tension_on", "top.force")


def test_integrators_and_gravity():
    runs = [free(gravity=(1.0, -9.81, 3.0), **SHEAVES["turning"]).run(0.05, output_step=0.05, tol=1e-6, integrator=each)
            for each in INTEGRATORS]
    for run in runs:
        assert np.abs(run.energy_balance().relative).max() < 1e-7
        near(run, runs[-1], 2e-7, "B.position", "C.orientation", "top.angle")
        near(run, runs[-1], 1e-2, "top.tension_on", "top.force", "top.torque")


def test_a_turned_scene_gives_the_same():
    scene = free(gravity=(0, -9.81, 0), **SHEAVES["rough"])
    one, other = (each.run(0.05, output_step=0.05, tol=1e-6, integrator="radau")
                  for each in (scene, turned_scene(scene, *ASKEW)))
    axes = rotate(turned_by(np.array(ASKEW[0])), np.eye(3))
    assert np.abs(one["top.force"] - other["top.force"] @ axes.T).max() < 1e-3 or (
        np.abs(one["top.force"] - other["top.force"] @ axes).max() < 1e-3)
    near(one, other, 1e-7, "top.wrap_angle", "top.fleet_angle_on", "top.fleet_angle_off", "top.angle")


def carried(element: str, **sheave) -> fu.Scene:
    """Return a load on a rope over a sheave at the end of a lever, which a hinge across the plane lets swing."""
    scene = fu.Scene()
    scene.rigid_body("lever", mass=3.0, inertia=(0.2, 0.4, 0.5), position=(0.5, 0, 0))
    scene.rigid_body("L", mass=2.0, inertia=(0.1, 0.1, 0.1), position=(1.2, -1.2, 0), velocity=(0.3, 0, 0))
    scene.joint("revolute", (0.0, 0.0, 0.0), ("lever", (-0.5, 0, 0)), axis=(0, 0, 1), name="hinge")
    scene.spring((0.5, 1.0, 0.0), "lever", stiffness=1000.0, length=0.92)
    scene.rope("hoist", route=[fu.Anchor(at=(-0.5, -0.8, 0)), fu.Sheave(
        "top", at=("lever", (0.5, 0, 0)), radius=0.2, side="right", **sheave), fu.Anchor("L", at=(0, 0.05, 0))],
        tension=20.0, **THIN | {"element": element})
    return scene


@pytest.mark.parametrize("sheave", SHEAVES)
def test_a_planar_scene_and_its_spatial_twin(sheave):
    """The lever and its load agree to 1e-8; the wrap differs by the sag of chords."""
    plane, space = (carried(element, **SHEAVES[sheave]).run(**BRIEF, integrator="radau")
                    for element in ("cable8p", "cable12"))
    assert np.ptp(plane["lever.position"], axis=0).max() > 2e-3
    near(plane, space, 1e-6, "L.position", "lever.position", "lever.orientation", "top.angle")
    near(plane, space, 1e-2, "top.tension_on", "top.wrap_angle", "top.torque")
    assert np.abs(space["hoist.position"][..., 2]).max() < 1e-12


def slewed(rate: float, gravity=(0, 0, 0)) -> fu.Scene:
    """Return a jib that turns at a constant rate about y with a rope over a sheave, which turns with it."""
    scene, at = fu.Scene(gravity=gravity), np.array([0, 0, -rate * 1.2])
    scene.rigid_body("jib", mass=3.0, inertia=(1, 1, 1), position=(0, 0, 0), angular_velocity=(0, rate, 0))
    scene.rigid_body("L", mass=2.0, inertia=(0.1, 0.1, 0.1), position=(1.2, -1.2, 0), velocity=at,
                     angular_velocity=(0, rate, 0))
    scene.joint("revolute", (0.0, 0.0, 0.0), "jib", axis=(0, 1, 0), name="slew", angle=fu.TableSignal(
        time=[0, 10], value=[0, 10 * rate], interpolation="linear"))
    scene.joint("weld", ("jib", (1.2, -1.2, 0)), "L", name="held")
    scene.rope("hoist", route=[fu.Anchor("jib", at=(-0.5, -0.8, 0)), fu.Sheave(
        "top", at=("jib", (1.0, 0, 0)), radius=0.2, side="right"), fu.Anchor("L", at=(0, 0.05, 0))],
        tension=20.0, **THIN | {"element": "cable12", "elements": 1})
    return scene


@pytest.mark.parametrize("integrator", ["radau", "explicit"])
def test_a_scene_that_a_joint_turns_steadily(integrator):
    """The rope stays at rest on the jib but for the little that centrifugal forces bend it."""
    rate = 1.5
    run = slewed(rate).run(0.08, output_step=0.04, tol=1e-6, integrator=integrator, progress=False)
    turned = rotate(turned_by(np.stack([0 * run.time, -rate * run.time, 0 * run.time], axis=1))[:, None],
                    run["hoist.position"])
    assert np.abs(turned - turned[0]).max() < 2e-3
    still = slewed(0.0).run(0.08, output_step=0.04, tol=1e-6, integrator=integrator, progress=False)
    assert run["top.wrap_angle"] == pytest.approx(still["top.wrap_angle"], abs=3e-3)
    assert run["top.tension_on"] == pytest.approx(still["top.tension_on"], rel=2e-2)
    force = rotate(turned_by(np.stack([0 * run.time, -rate * run.time, 0 * run.time], axis=1)), run["top.force"])
    assert np.abs(force - force[0])[:, 2].max() < 0.1
    assert np.abs(run.energy_balance().relative).max() < 1e-6


def hanging(**sheave) -> fu.Scene:
    """Return a block that hangs from a rope, whose ends are at the ground, with a weight below its axle."""
    scene = fu.Scene()
    scene.rigid_body("block", mass=4.0, inertia=(0.05, 0.05, 0.05), position=(0.1, -1.0, 0.02), centre=(0, -0.2, 0.01))
    scene.rope("hoist", route=[fu.Anchor(at=(-0.1, 0.1, 0)), fu.Sheave("low", at="block", radius=0.15, side="left",
                                                                   max_fleet_angle=0.5, **sheave),
                               fu.Anchor(at=(0.3, 0, 0.1))], tension=20.0, **THIN | {"element": "cable12"})
    return scene


def test_rest_and_modes_of_a_block():
    """A free block finds its direction; its frequencies are those of its motion about rest."""
    scene = hanging()
    rest = scene.equilibrium()
    assert rest.stable
    run = scene.run(0.5, initial=rest, output_step=0.05, tol=1e-6, integrator="radau", progress=False)
    assert np.abs(run["block.position"] - rest["block.position"]).max() < 1e-7
    assert np.abs(run["block.orientation"] - rest["block.orientation"]).max() < 1e-6
    assert rest["low.force"] == pytest.approx([0, 9.81 * 4.0, 0], abs=1e-5)
    mode = scene.modes(3, about=rest)
    turned = turned_scene(scene, *ASKEW)
    assert turned.modes(3, about=turned.equilibrium()).frequency == pytest.approx(mode.frequency, abs=1e-6)


def test_modal_carriers():
    """A sheave at the end of a beam that bends sideways and twists."""
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.modal_body("beam", start=(-1, 0, 0), end=(1, 0, 0), element="beam24", elements=4, modes=4,
                     section=fu.Rectangle(height=0.05, width=0.03),
                     material=fu.Material(youngs_modulus=2e10, poisson_ratio=0.3, density=2000))
    scene.joint("weld", (-1.0, 0.0, 0.0), "beam")
    scene.rigid_body("L", mass=3.0, inertia=(0.1, 0.1, 0.1), position=(1.2, -1.2, 0.05), velocity=(0.1, -1.0, 0.5))
    scene.rope("hoist", route=[fu.Anchor(at=(-0.2, -0.8, 0)), fu.Sheave("top", at=("beam", (1, 0, 0)), radius=0.2,
                                                                   side="right", max_fleet_angle=0.5),
                               fu.Anchor("L")], tension=29.0, **rope_of(2e4, 0.05, 0, 1e-4), element="cable12")
    runs = [scene.run(0.02, output_step=0.02, tol=1e-6, integrator=each, progress=False)
            for each in ("radau", "explicit")]
    near(*runs, 1e-7, "L.position", "beam.modal_coordinates", "top.fleet_angle_off")
    assert np.abs(runs[0].energy_balance().relative).max() < 1e-7


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_resumed_bit_for_bit(tmp_path, integrator):
    scene = free(**SHEAVES["turning"])
    settings = {"duration": 0.02, "output_step": 0.002, "tol": 1e-5, "integrator": integrator}
    resumed = killed_and_resumed(scene, tmp_path / "run.nc", 15, **settings, progress=False)
    whole = scene.run(**settings)
    assert all(np.array_equal(whole[name], resumed[name]) for name in whole)


def test_a_file_gives_the_same():
    scene = free(**SHEAVES["rough"])
    again = fu.Scene.from_toml(scene.to_toml())
    one, other = (each.run(0.02, output_step=0.01, tol=1e-5, integrator="radau") for each in (scene, again))
    assert max(differences(one, other).values()) == 0
