"""Ropes over sheaves on free bodies in space by the energy-momentum integrator: momenta, energy, order."""

from itertools import pairwise

import funicular as fu
import numpy as np
import pytest
from expectations import unaccounted
from funicular.base.rotations import rotate
from funicular.engine import Engine
from funicular.integrators import EnergyMomentum
from funicular.model.build import build
from interrupted_runs import killed_and_resumed
from ropes.scenes import rope_of

FRICTION = fu.Friction(coefficient=0.2, velocity=1e-2)
KINDS = {"smooth": {}, "rough": {"friction": FRICTION, "zones": 3, "inertia": 0.002}}
SETTINGS = {"output_step": 0.02, "step": 5e-4, "integrator": "energy", "progress": False}
pytestmark = pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")


def free(sheaves: int = 1, damping: float = 0.0, gravity=(0, 0, 0), bending: float = 0.01, **sheave) -> fu.Scene:
    """Return two bodies on a heavy rope over sheaves on as many other bodies, all free, with spin; springs keep them
    apart.
    """
    scene = fu.Scene(gravity=gravity)
    scene.rigid_body("A", mass=2.0, inertia=(0.5, 0.4, 0.3), position=(-0.2, -1.5, 0.02), velocity=(0.1, 0, 0.2))
    scene.rigid_body("B", mass=2.5, inertia=(0.4, 0.5, 0.3), position=(sheaves - 0.1, -1.2, 0.1),
                     velocity=(0.3, 0, -0.2), angular_velocity=(0.2, 0.3, 0.1))
    route = []
    for k in range(sheaves):
        name = f"C{k}"
        scene.rigid_body(name, mass=3.0, inertia=(0.02, 0.03, 0.025), position=(k, 0.1 * k + 0.4 * (k == 1), 0.03 * k),
                         velocity=(0, 0.1, 0.05 - 0.1 * k), angular_velocity=(1.5 - k, 1.0, 2.0 - 3 * k))
        route.append(fu.Sheave(f"top{k}", at=(name, (0.01, -0.03, 0.02)), axis=(0.05, 0.1 - 0.1 * k, 1), radius=0.2,
                               side="right", max_fleet_angle=0.5, **sheave))
    scene.rope("rope", element="cable12", route=[fu.Anchor("A", at=(0, 0.1, 0)), *route,
                                                 fu.Anchor("B", at=(0.02, 0.1, 0))],
               tension=30.0, elements=3, **rope_of(2e3, 0.3, bending, damping))
    names = ["A", *(f"C{k}" for k in range(sheaves)), "B"]
    for one, other in pairwise(names):
        scene.spring(one, other, stiffness=20, length=3.0, name=f"push_{one}")
    return scene


def hermite(e: np.ndarray, length: float, x: np.ndarray) -> np.ndarray:
    """Return places (points, 3) of an element of nodal vectors (4, 3) at parts x of its length."""
    return np.stack([1 - 3 * x**2 + 2 * x**3, length * (x - 2 * x**2 + x**3), 3 * x**2 - 2 * x**3,
                     length * (x**3 - x**2)], axis=1) @ e


def momenta_of(places: np.ndarray, momenta: np.ndarray) -> np.ndarray:
    """Return the sums (6,) of momenta at places (n, 3) and of their moments about the origin."""
    return np.array([*momenta.sum(axis=0), *np.cross(places, momenta).sum(axis=0)])


def momenta_in(model, engine: Engine, scene: fu.Scene) -> np.ndarray:
    """Return (6,): momentum and angular momentum about the origin, as the integrator has them."""
    _, q, v, _ = engine.now()
    total, axes_of = np.zeros(6), {}
    for k, (body, part) in enumerate(zip(model.bodies, scene.bodies.values(), strict=True)):
        at, d = body.configuration, body.dof
        axes_of[k] = np.stack([rotate(q[at + 3 : at + 7], unit) for unit in np.eye(3)], axis=1)
        total += momenta_of(q[None, at : at + 3], part.mass * v[None, d : d + 3])
        total[3:] += axes_of[k] @ (np.asarray(part.inertia) @ v[d + 3 : d + 6])
    for k, coupling in enumerate(model.couplings):
        if coupling.type == "span":
            x, weight = np.polynomial.legendre.leggauss(4)
            P = coupling.rho * weight[:, None] / 2 * engine.history(k)[1:].reshape(-1, 4, 3)
            lengths = np.diff(coupling.span_share) * np.diff(q[list(coupling.span_s)])
            for j, length in enumerate(lengths):
                e = q[coupling.span_first + 6 * j : coupling.span_first + 6 * j + 12].reshape(4, 3)
                total += momenta_of(hermite(e, length, (1 + x) / 2), P[j])
        if coupling.type == "sheave":
            x, weight = np.polynomial.legendre.leggauss(8)
            P = coupling.rho * weight[:, None] / 2 * engine.history(k)[1:-3].reshape(-1, 8, 3)
            on = coupling.attachments[0]
            body, axes = model.bodies[on.body], axes_of[on.body] @ np.asarray(on.axes).reshape(3, 3)
            centre = q[body.configuration : body.configuration + 3] + axes_of[on.body] @ np.asarray(on.u)
            ends = [(q[node : node + 3] - centre) @ axes for node in coupling.nodes]
            begin, end = (np.arctan2(each[1], each[0]) for each in ends)
            wrap = coupling.sense * ((coupling.sense * (end - begin)) % (2 * np.pi))
            for j in range(coupling.n_zones):
                angle = begin + (j + (1 + x) / 2) / coupling.n_zones * wrap
                arms = coupling.radius * np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
                total += momenta_of(centre + arms @ axes.T, P[j])
            spin = axes[:, 2] @ axes_of[on.body] @ v[body.dof + 3 : body.dof + 6]
            if coupling.turn >= 0:
                total[3:] += coupling.inertia * (v[coupling.turn] + spin) * axes[:, 2]
    return total


def momenta(scene: fu.Scene, durations: tuple[float, ...]) -> list[np.ndarray]:
    """Return the momenta (6,) of a scene after these durations."""
    found = []
    for duration in durations:
        model = build(scene)
        engine = Engine(model)
        engine.start(duration=duration, output_step=duration, tol=1e-4, step=5e-4, method=EnergyMomentum(),
                     first_step=5e-4)
        engine.advance(lambda *_: None)
        found.append(momenta_in(model, engine, scene))
    return found


@pytest.mark.parametrize("sheaves", [1, 2, 3])
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.slow_cases("rough-3", "rough-2")
def test_momenta_are_kept_to_rounding(kind, sheaves):
    """The bodies turn by up to 40 degrees, with fleet angles to .2 rad."""
    first, *others = momenta(free(sheaves, **KINDS[kind]), (5e-4, 0.05, 0.2))
    assert np.abs(first).min() > 0.02
    assert max(np.abs(other - first).max() for other in others) < 1e-12 * np.abs(first).max()  # measured: 2e-13


def test_momenta_are_kept_with_damping():
    """Of a rope without bending stiffness: damping of bending in space takes the spin about the tangent."""
    scene = free(2, 1e-3, bending=0.0, **KINDS["rough"])
    first, *others = momenta(scene, (5e-4, 0.05, 0.2))
    assert max(np.abs(other - first).max() for other in others) < 1e-12 * np.abs(first).max()


@pytest.mark.parametrize("damping", [0.0, 1e-3])
@pytest.mark.parametrize("kind", KINDS)
def test_energy_is_kept_to_rounding(kind, damping):
    run = free(2, damping, gravity=(1.0, -9.81, 3.0), **KINDS[kind]).run(0.1, **SETTINGS)
    assert unaccounted(run) < 1e-12 * run["energy.kinetic"].max()  # measured: 5e-14
    assert np.ptp(run["energy.kinetic"]) > 1.0


def test_energy_of_free_bodies_is_kept_with_the_elastic_energy():
    run = free(3).run(0.2, **SETTINGS)
    total = run["energy.kinetic"] + run["energy.elastic"]
    assert np.ptp(total) < 1e-12 * total[0]
    assert np.ptp(run["energy.kinetic"]) > 0.1


def ends(kind: str, step: float) -> np.ndarray:
    scene = free(1, 1e-3, gravity=(1.0, -9.81, 3.0), **KINDS[kind])
    run = scene.run(0.1, **SETTINGS | {"step": step, "output_step": 0.1})
    return np.concatenate([run["C0.position"][-1], run["C0.orientation"][-1], run["B.position"][-1]])


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.slow_cases("rough")
def test_order_in_time_is_two(kind):
    coarse, middle, fine = (ends(kind, step) for step in (1e-3, 5e-4, 2.5e-4))
    first, second = np.abs(middle - coarse).max(), np.abs(fine - middle).max()
    assert 3.7 < first / second < 4.3
    radau = free(1, 1e-3, gravity=(1.0, -9.81, 3.0), **KINDS[kind]).run(0.1, output_step=0.1, tol=1e-8,
                                                                         integrator="radau", progress=False)
    exact = np.concatenate([radau["C0.position"][-1], radau["C0.orientation"][-1], radau["B.position"][-1]])
    assert np.abs(fine + (fine - middle) / 3 - exact).max() < 0.2 * second


def test_resumed_bit_for_bit(tmp_path):
    scene = free(1, 1e-3, **KINDS["rough"])
    settings = SETTINGS | {"duration": 0.03, "output_step": 2e-3}
    whole = scene.run(**settings)
    resumed = killed_and_resumed(scene, tmp_path / "run.nc", 8, **settings)
    assert all(np.array_equal(whole[name], resumed[name]) for name in whole)


def driven(**drive) -> fu.Scene:
    """Return a sheave with a drive on a body that swings on an anchor, and a load below it, in space."""
    scene = fu.Scene(gravity=(0, -9.81, 0))
    scene.rigid_body("C", mass=3.0, inertia=(0.02, 0.03, 0.025), position=(0, 0, 0), angular_velocity=(0.5, 2.0, 0.3))
    scene.spring((0.0, 1.0, 0.1), "C", stiffness=400, length=0.8)
    scene.rigid_body("L", mass=2.0, inertia=(0.1, 0.1, 0.1), position=(0.2, -1.5, 0), velocity=(0.2, 0, 0.1))
    top = fu.Sheave("top", at="C", axis=(0, 0, 1), radius=0.2, side="right", max_fleet_angle=0.5, friction=FRICTION,
                    zones=3, inertia=0.01, **drive)
    scene.rope("rope", element="cable12", route=[fu.Anchor(at=(-0.2, -1, 0)), top, fu.Anchor("L")], tension=20.0,
               elements=2, **rope_of(5e3, 0.1, 0, 1e-3))
    return scene


@pytest.mark.parametrize("drive", [{"torque": 0.3}, {"damping": 0.05}, {"velocity": fu.TableSignal(
    time=[0, 0.05, 1], value=[0, 3, 3], interpolation="linear")}], ids=["torque", "bearing", "velocity"])
def test_drives_balance_to_rounding(drive):
    run = driven(**drive).run(0.1, **SETTINGS)
    assert unaccounted(run) < 1e-12 * run["energy.kinetic"].max()
    radau = driven(**drive).run(0.1, output_step=0.1, tol=1e-7, integrator="radau", progress=False)
    assert np.abs(run["L.position"][-1] - radau["L.position"][-1]).max() < 2e-5


def test_a_sheave_in_the_plane_of_its_motion_matches_the_planar_rope():
    """Energies and places agree with the same rope in the plane."""
    plane, space = (swinging(dim).run(0.2, **SETTINGS) for dim in (2, 3))
    assert np.abs(plane["L.position"] - space["L.position"]).max() < 1e-5


def swinging(dim: int) -> fu.Scene:
    scene = fu.Scene(gravity=(0, -9.81, 0))
    scene.rigid_body("C", mass=3.0, inertia=(0.5, 0.5, 0.5), position=(0, 0, 0), angular_velocity=(0, 0, 1.0))
    scene.spring((0.0, 1.0, 0.0), "C", stiffness=400, length=0.8)
    scene.rigid_body("L", mass=2.0, inertia=(0.1, 0.1, 0.1), position=(0.2, -1.5, 0), velocity=(0.5, 0, 0))
    where = {"axis": (0, 0, 1)} if dim == 3 else {}
    scene.rope("rope", element="cable12" if dim == 3 else "cable8p", tension=20.0, elements=4, route=[
        fu.Anchor(at=(-0.2, -1, 0)), fu.Sheave("top", at="C", radius=0.2, side="right", **where), fu.Anchor("L")],
        **rope_of(5e3, 0.1, 0, 1e-3))
    return scene
