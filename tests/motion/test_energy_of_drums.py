"""Ropes on drums by the energy-momentum integrator, in the plane and in space: energy, momenta, order, creep."""

from itertools import pairwise

import funicular as fu
import numpy as np
import pytest
import test_drums as planar
import test_energy_in_space as in_space
import test_energy_of_ropes as in_plane
import test_turning_drums as spatial
from expectations import unaccounted
from funicular.base.rotations import rotate
from funicular.engine import Engine
from funicular.integrators import EnergyMomentum
from funicular.model.build import build
from interrupted_runs import killed_and_resumed
from ropes.scenes import rope_of
from test_left_drums import hanging

pytestmark = pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")
STEP = {"integrator": "energy", "step": 1e-3, "progress": False}
RAMP = fu.TableSignal(time=[0, 0.1, 1], value=[0, 3, 3], interpolation="linear")
TURN = fu.TableSignal(time=[0, 0.02, 0.04, 0.06], value=[0, 0.001, 0.004, -0.002])
DRIVES = {"held": {}, "torque": {"inertia": 0.05, "torque": 9.0}, "velocity": {"velocity": RAMP},
          "angle": {"angle": TURN, "inertia": 0.05}, "brake": {"inertia": 0.05, "damping": 2.0}}
SCENES = {"plane, ground": planar.hoist, "plane, body": planar.deck,
          "space, ground": lambda **drive: spatial.hoist("cable12", 0.1, **drive),
          "space, body": lambda **drive: spatial.deck(gravity=(1.0, -9.81, 3.0), **drive)}
NAMES = ("load.position", "deck.position", "deck.orientation", "winch.angle")


def off(run: fu.Run, exact: fu.Run) -> float:
    """Return the largest difference of places and turns."""
    return max(np.abs(run[name] - exact[name]).max() for name in NAMES if name in exact)


@pytest.mark.parametrize("drive", DRIVES)
@pytest.mark.parametrize("scene", SCENES)
def test_energy_is_kept_to_rounding_and_places_agree_with_radau(scene, drive):
    """Rope is wound, paid out, and both; what creeps agrees, too."""
    made = SCENES[scene]
    run = made(**DRIVES[drive]).run(0.04, output_step=0.01, **STEP)
    exact = made(**DRIVES[drive]).run(0.04, output_step=0.01, tol=1e-6, integrator="radau", progress=False)
    assert unaccounted(run) < 1e-12 * run["energy.kinetic"].max()  # measured: 2e-13 at most
    assert run["energy.dissipated"][-1] == pytest.approx(exact["energy.dissipated"][-1], rel=5e-2)  # short waves
    assert off(run, exact) < 2e-5  # measured: 1e-5 at most
    assert run["winch.residual"].max() < 1e-14


@pytest.mark.parametrize("scene", ["plane, body", "space, body"])
def test_order_in_time_is_two(scene):
    def end(step: float) -> np.ndarray:
        run = SCENES[scene](inertia=0.05, torque=4.0).run(0.04, output_step=0.04, **STEP | {"step": step})
        return np.concatenate([run[name][-1].ravel() for name in NAMES])

    ends = [end(step) for step in (1e-3, 5e-4, 2.5e-4)]
    first, second = (np.abs(a - b).max() for a, b in pairwise(ends))
    assert 3.5 < first / second < 4.5
    exact = SCENES[scene](inertia=0.05, torque=4.0).run(0.04, output_step=0.04, tol=1e-8, integrator="radau",
                                                         progress=False)
    exact = np.concatenate([exact[name][-1].ravel() for name in NAMES])
    assert np.abs(ends[2] + (ends[2] - ends[1]) / 3 - exact).max() < 0.2 * second


# --- momenta ----------------------------------------------------------------------------------------------------


def free(dim: int, **drum: object) -> fu.Scene:
    """Return a load on a heavy rope from a winch on a free body, which spins; a spring keeps them apart."""
    scene, spin = fu.Scene(gravity=(0, 0, 0)), 0.8
    tilt = (0.5, 0.3) if dim == 3 else (0, 0)
    scene.rigid_body("deck", mass=5.0, inertia=(0.2, 0.25, 0.3), position=(0, 0, 0), angular_velocity=(*tilt, spin),
                     velocity=(0.1, 0.2, 0.1 * (dim - 2)))
    scene.rigid_body("load", mass=2.0, inertia=(0.1, 0.15, 0.12), position=(0.2, -2.0, 0),
                     angular_velocity=(0, 0, spin), velocity=(0.1 + spin * 2.0, 0.5, 0.05 * (dim - 2)))
    axis = {"axis": (0.05, 0.1, 1), "max_fleet_angle": 0.5} if dim == 3 else {"axis": (0, 0, 1)}
    winch = fu.Drum("winch", at=("deck", (-0.1, -0.05, 0)), radius=0.2, side="right", length_in_store=1.0, **axis,
                    **drum)
    scene.rope("hoist", route=[winch, fu.Anchor("load")], tension=42.0, elements=2,
               element="cable12" if dim == 3 else "cable8p", **rope_of(2e3, 0.3, 0.02, 0.0))
    scene.spring("deck", "load", stiffness=20.0, length=4.0)
    return scene


VELOCITIES = slice(10, 16)  # of the wound rope, among the history variables of a drum


def of_drum(model, engine: Engine, k: int) -> np.ndarray:
    """Return (6,): momentum and angular momentum about the origin of a wound rope and its drum, on a body."""
    _, q, v, _ = engine.now()
    drum = model.couplings[k]
    body, on = model.bodies[drum.attachments[0].body], drum.attachments[0]
    V, u = engine.history(k)[VELOCITIES], drum.direction * (q[drum.s] - drum.end)
    at, mass = q[body.configuration : body.configuration + model.dim], drum.rho * u
    own = v[drum.turn] if drum.turn >= 0 else 0.0
    if model.dim == 2:
        c, s = q[body.configuration + 2 :][:2]
        centre, velocity = np.array([*(at + np.array([[c, -s], [s, c]]) @ on.u[:2]), 0]), np.array([V[1], V[2], 0])
        spin = np.array([0, 0, mass * drum.radius * V[0] + drum.inertia * (own + v[body.dof + 2])])
    else:
        turned = np.stack([rotate(q[body.configuration + 3 :][:4], unit) for unit in np.eye(3)], axis=1)
        axes, centre, velocity = turned @ np.asarray(on.axes).reshape(3, 3), at + turned @ np.asarray(on.u), V[3:]
        about = axes[:, 2] @ turned @ v[body.dof + 3 : body.dof + 6]
        spin = mass * drum.radius * axes @ [V[1] / 2, V[2] / 2, V[0]] + drum.inertia * (own + about) * axes[:, 2]
    return np.array([*(mass * velocity), *(np.cross(centre, mass * velocity) + spin)])


def momenta(scene: fu.Scene, durations: tuple[float, ...]) -> list[np.ndarray]:
    """Return the momenta of a scene after these durations: (3,) in the plane, (6,) in space."""
    found = []
    for duration in durations:
        model = build(scene)
        engine = Engine(model)
        engine.start(duration=duration, output_step=duration, tol=1e-4, step=1e-3, method=EnergyMomentum(),
                     first_step=1e-3)
        engine.advance(lambda *_: None)
        wound = sum(of_drum(model, engine, k) for k, each in enumerate(model.couplings) if each.type == "drum")
        found.append(in_space.momenta_in(model, engine, scene) + wound if model.dim == 3 else
                     in_plane.momenta_in(model, engine, scene) + wound[[0, 1, 5]])
    return found


@pytest.mark.parametrize("drum", [{}, {"inertia": 0.05, "torque": 4.0}, {"inertia": 0.05, "damping": 0.5}],
                         ids=["held", "torque", "brake"])
@pytest.mark.parametrize("dim", [2, 3])
def test_momenta_are_kept_to_rounding(dim, drum):
    """The body turns by 20 degrees; the drum on it winds or pays out."""
    first, *others = momenta(free(dim, **drum), (1e-3, 0.05, 0.4))
    assert max(np.abs(other - first).max() for other in others) < 1e-12 * np.abs(first).max()
    run = free(dim, **drum).run(0.4, output_step=0.05, **STEP)
    assert unaccounted(run) < 1e-12 * run["energy.kinetic"].max()
    assert np.ptp(run["winch.length_in_store"]) > 0.02


# --- creep ------------------------------------------------------------------------------------------------------


def test_creep_is_dissipated():
    """A drum winds rope of the stretch l_1 and pays it out to a span of the stretch l_2, which a heavier load pulls: of
    each metre (EA + EI/R^2)/2 (l_1 - l_2)^2 is dissipated, with light rope.
    """
    EA, rho = 2e3, 1e-3
    paying = fu.TableSignal(time=[0, 0.2, 0.3, 3], value=[0, 0, -1, -1], interpolation="linear")
    scene = fu.Scene(gravity=(0, -9.81, 0))
    scene.rigid_body("load", mass=4.0, inertia=(1, 1, 1), position=(0.2, -1.0, 0))
    winch = fu.Drum("winch", at=(0, 0, 0), radius=0.2, side="right", length_in_store=1.0, velocity=paying)
    scene.rope("hoist", route=[winch, fu.Anchor("load")], tension=39.24, elements=1, **rope_of(EA, rho, 0.0, 2e-2))
    scene.force("load", value=(0, -40.0, 0), scale=fu.Ramp(start=0, end=0.2, after=1))
    run = scene.run(1.5, output_step=0.05, **STEP)
    late = run.time > 1.0
    store, lost = run["winch.length_in_store"][late], run["energy.dissipated"][late]
    assert unaccounted(run) < 1e-12 * np.ptp(run["energy.potential"])
    assert (lost[-1] - lost[0]) / (store[0] - store[-1]) == pytest.approx(EA / 2 * (40.0 / EA) ** 2, rel=2e-2)


# --- runs -------------------------------------------------------------------------------------------------------


def test_a_drum_in_the_plane_of_its_motion_matches_the_planar_one():
    plane, space = (spatial.hoist(element, velocity=RAMP).run(0.2, output_step=0.02, **STEP)
                    for element in ("cable8p", "cable12"))
    assert np.abs(plane["load.position"] - space["load.position"]).max() < 1e-7
    assert plane["winch.length_in_store"] == pytest.approx(space["winch.length_in_store"], abs=2e-4)


def test_a_rope_that_leaves_an_empty_drum():
    """The end is free then; the drum turns on alone."""
    run = hanging().run(0.6, output_step=0.05, **STEP)
    exact = hanging().run(0.6, output_step=0.05, tol=1e-6, integrator="radau", progress=False)
    assert [event["what"] for event in run.events] == ["left the drum"]
    assert unaccounted(run) < 1e-12 * run["energy.kinetic"].max()
    assert run["winch.length_in_store"][-1] == pytest.approx(0, abs=1e-12)
    assert np.abs(run["load.position"] - exact["load.position"]).max() < 1e-4


@pytest.mark.parametrize("scene", ["plane, body", "space, body"])
def test_resumed_bit_for_bit(tmp_path, scene):
    made = SCENES[scene](velocity=RAMP)
    settings = STEP | {"duration": 0.03, "output_step": 2e-3}
    whole = made.run(**settings)
    resumed = killed_and_resumed(made, tmp_path / "run.nc", 8, **settings)
    assert all(np.array_equal(whole[name], resumed[name]) for name in whole)
