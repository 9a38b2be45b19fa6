"""Ropes over sheaves by the energy-momentum integrator: energy and momenta to rounding, order 2, refusals."""

from itertools import pairwise

import funicular as fu
import numpy as np
import pytest
from expectations import unaccounted
from funicular.engine import Engine
from funicular.integrators import EnergyMomentum
from funicular.model.build import build
from interrupted_runs import killed_and_resumed
from paired_scenes import FACTORS
from paired_scenes import build as build_pair
from ropes.scenes import rope_of

FRICTION = fu.Friction(coefficient=0.3, velocity=1e-2)
ROUGH = {"friction": FRICTION, "zones": 3, "inertia": 0.1}
pytestmark = pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")


def free(damping: float, **sheave: object) -> fu.Scene:
    """Return two masses on a rope over a sheave on a third one, all of which rotate freely; springs keep it taut."""
    scene, spin = fu.Scene(gravity=(0, 0, 0)), 0.8
    bodies = (("A", 4.4, (-0.25, -2.5), 0.2), ("B", 4.0, (0.9, -2.5), 0.3), ("C", 6.0, (0, 0.1), 0.2))
    for name, mass, at, drift in bodies:
        scene.rigid_body(name, mass=mass, inertia=(1, 1, 1), position=(*at, 0), angular_velocity=(0, 0, spin),
                         velocity=(0.3 - spin * at[1], drift + spin * at[0], 0))
    scene.rope("rope", route=[fu.Anchor("A"), fu.Sheave("top", at=("C", (0, -0.1, 0)), radius=0.25, side="right",
                                                        **sheave), fu.Anchor("B")],
               tension=42.0, elements=2, **rope_of(2e3, 0.3, 0.02, damping))
    for name in "AB":
        scene.spring((name, (0, 0, 0)), ("C", (0, 0, 0)), stiffness=20.0, length=4.7)
    return scene


def swinging(sense: int = 1, damping: float = 0.0, **sheave: object) -> fu.Scene:
    """Return a load that swings below a sheave."""
    scene = fu.Scene(gravity=(0, -9.81, 0))
    scene.rigid_body("L", mass=2.0, inertia=(1, 1, 1), position=(sense * 0.2, -1.5, 0), velocity=(sense * 0.8, 0, 0))
    top = fu.Sheave("top", at=(0, 0, 0), radius=0.2, side="right" if sense > 0 else "left", **sheave)
    scene.rope("rope", route=[fu.Anchor(at=(-sense, -1, 0)), top, fu.Anchor("L")], tension=20.0, elements=2,
               **rope_of(2e4, 0.05, 0.01, damping))
    return scene


def belt(**drive: object) -> fu.Scene:
    """Return a belt with a driver and a braked pulley."""
    scene, made = fu.Scene(gravity=(0, 0, 0)), {"radius": 0.1, "side": "left", "friction": FRICTION, "zones": 3,
                                                "inertia": 0.05}
    scene.rope("rope", closed=True, tension=100.0, elements=1, route=[
        fu.Sheave("one", at=(0, 0, 0), **drive, **made), fu.Sheave("other", at=(0.4, 0, 0), damping=0.1, **made)],
        **rope_of(1e4, 0.5, 0, 1e-3))
    return scene


def two_sheaves() -> fu.Scene:
    """Return two weights on a rope over two sheaves with friction."""
    scene = fu.Scene(gravity=(0, -9.81, 0))
    for name, x, mass in (("A", -0.2, 2.0), ("B", 1.2, 2.4)):
        scene.rigid_body(name, mass=mass, inertia=(1, 1, 1), position=(x, -1.5, 0), velocity=(0.3, 0, 0))
    scene.rope("rope", route=[fu.Anchor("A"), fu.Sheave("one", at=(0, 0, 0), radius=0.2, side="right", **ROUGH),
                              fu.Sheave("other", at=(1, 0, 0), radius=0.2, side="right", **ROUGH), fu.Anchor("B")],
               tension=20.0, elements=2, **rope_of(2e4, 0.1, 0, 1e-4))
    return scene


def balance(run: fu.Run) -> float:
    """Return the largest error of the energy balance relative to the largest kinetic energy."""
    return unaccounted(run) / run["energy.kinetic"].max()


# --- momentum ---------------------------------------------------------------------------------------------------


def hermite(e: np.ndarray, length: float, x: np.ndarray) -> np.ndarray:
    """Return places (points, 2) of an element of nodal vectors (4, 2) at parts x of its length."""
    return np.stack([1 - 3 * x**2 + 2 * x**3, length * (x - 2 * x**2 + x**3), 3 * x**2 - 2 * x**3,
                     length * (x**3 - x**2)], axis=1) @ e


def momenta_of(places: np.ndarray, momenta: np.ndarray) -> np.ndarray:
    """Return the sums (3,) of momenta at places (n, 2) and of their moments."""
    return np.array([*momenta.sum(axis=0), (places[:, 0] * momenta[:, 1] - places[:, 1] * momenta[:, 0]).sum()])


def momenta(duration: float, scene: fu.Scene) -> np.ndarray:
    """Return the momentum of a free scene and its angular momentum about the origin, (3,), after a duration."""
    model = build(scene)
    engine = Engine(model)
    engine.start(duration=duration, output_step=duration, tol=1e-4, step=1e-3, method=EnergyMomentum(), first_step=1e-3)
    engine.advance(lambda *_: None)
    return momenta_in(model, engine, scene)


def momenta_in(model, engine: Engine, scene: fu.Scene) -> np.ndarray:
    """Return (3,): momentum and angular momentum about the origin, as the integrator has them, but of drums."""
    _, q, v, _ = engine.now()
    total = np.zeros(3)
    for body, part in zip(model.bodies, scene.bodies.values(), strict=True):
        at = slice(body.configuration, body.configuration + 2)
        total += momenta_of(q[None, at], part.mass * v[None, body.dof : body.dof + 2])
        total[2] += np.asarray(part.inertia)[2, 2] * v[body.dof + 2]
    for k, coupling in enumerate(model.couplings):
        if coupling.type == "span":
            x, weight = np.polynomial.legendre.leggauss(4)
            P = coupling.rho * weight[:, None] / 2 * engine.history(k)[1:].reshape(-1, 4, 2)
            lengths = np.diff(coupling.span_share) * np.diff(q[list(coupling.span_s)])
            for j, length in enumerate(lengths):
                e = q[coupling.span_first + 4 * j : coupling.span_first + 4 * j + 8].reshape(4, 2)
                total += momenta_of(hermite(e, length, (1 + x) / 2), P[j])
        if coupling.type == "sheave":
            x, weight = np.polynomial.legendre.leggauss(8)
            history = engine.history(k)[1:-3]  # without the spin and the place of the rope
            P = coupling.rho * weight[:, None] / 2 * history.reshape(-1, 8, 2)
            body = model.bodies[coupling.attachments[0].body]
            place, (c, s) = q[body.configuration : body.configuration + 2], q[body.configuration + 2 :][:2]
            centre = place + np.array([[c, -s], [s, c]]) @ (0, -0.1)
            one, other = (q[node : node + 2] - centre for node in coupling.nodes)
            begin = np.arctan2(*one[::-1])
            wrap = coupling.sense * ((coupling.sense * (np.arctan2(*other[::-1]) - begin)) % (2 * np.pi))
            for j in range(coupling.n_zones):
                angle = begin + (j + (1 + x) / 2) / coupling.n_zones * wrap
                total += momenta_of(centre + coupling.radius * np.stack([np.cos(angle), np.sin(angle)], axis=1), P[j])
            if coupling.turn >= 0:
                total[2] += coupling.inertia * (v[coupling.turn] + v[body.dof + 2])
    return total


@pytest.mark.parametrize(("damping", "sheave"), [(0.0, {}), (1e-4, ROUGH)], ids=["smooth", "rough"])
def test_momenta_are_kept_to_rounding(damping, sheave):
    first, *others = (momenta(duration, free(damping, **sheave)) for duration in (1e-3, 0.05, 0.4))
    assert max(np.abs(other - first).max() for other in others) < 1e-12 * np.abs(first).max()  # measured: 4e-15


# --- energy -----------------------------------------------------------------------------------------------------

TABLE = fu.TableSignal(time=[0, 0.1, 1], value=[0, 9, 9], interpolation="linear")
TURN = fu.TableSignal(time=[0, 0.05, 0.1, 0.15, 0.2], value=[0, 0.01, 0.1, 0.3, 0.7])


@pytest.mark.parametrize(("scene", "duration"), [
    (lambda: free(0.0), 0.4), (lambda: free(1e-4, **ROUGH), 0.2), (swinging, 1.0), (two_sheaves, 0.3),
    (lambda: belt(torque=2.0), 0.2), (lambda: belt(velocity=TABLE), 0.2), (lambda: belt(angle=TURN), 0.2)],
    ids=["free", "free with friction", "swinging", "two sheaves", "torque", "velocity", "angle"])
def test_energy_is_kept_to_rounding(scene, duration):
    """Over a breakpoint of a drive, too."""
    run = scene().run(duration, output_step=duration / 10, step=1e-3, integrator="energy")
    assert balance(run) < 1e-12  # measured: 1e-13 at most
    assert np.ptp(run["energy.kinetic"]) > 1e-3 * run["energy.kinetic"].max()


def test_energy_is_kept_under_step_control():
    run = swinging().run(0.3, output_step=0.1, tol=1e-3, integrator="energy")
    assert balance(run) < 1e-12


@pytest.mark.slow
def test_steps_grow_in_number_with_the_root_of_tol(tmp_path):
    """From rest, where little has moved: velocities of the rope have no error with alternating signs from step to step,
    of which the estimate of errors would make ever shorter steps.
    """
    row = {factor: levels[0] for factor, levels in FACTORS.items()} | {"element": "cable8p", "rope": "rope over a body"}
    settings = {"duration": 0.02, "output_step": 1e-3, "progress": False}
    tols = (1e-4, 1e-5, 1e-6)
    runs = [build_pair(row, tmp_path).run(tol=tol, integrator="energy", **settings) for tol in tols]
    exact = build_pair(row, tmp_path).run(tol=1e-9, integrator="radau", **settings)["hoist.position"]
    counts = [run.report["steps"] for run in runs]
    assert all(2.5 < second / first < 4 for first, second in pairwise(counts))  # measured: 3.0, 3.2
    for run, tol in zip(runs, tols, strict=True):
        assert np.abs(run["hoist.position"] - exact).max() < tol * np.ptp(exact, axis=0).max()  # measured: 0.1, 0.4
        assert run.report["smallest_step_s"] > 1e-9


def in_space(**sheave: object) -> fu.Scene:
    """Return a load that swings out of the plane of the groove of a sheave."""
    scene = fu.Scene()
    scene.rigid_body("weight", mass=5.5, inertia=(1, 1, 1), position=(-0.3, -3, 0), velocity=(0, 0.0131, 0))
    scene.rigid_body("L", mass=5, inertia=(1, 1, 1), position=(1.8, -3.2, 0.12), velocity=(0, 0, 0.4))
    top = fu.Sheave("top", at=(0, 0, 0), axis=(0, 0, 1), radius=0.3, side="right", **sheave)
    scene.rope("rope", element="cable12", route=[fu.Anchor("weight"), top, fu.Anchor("L")], tension=45, elements=2,
               **rope_of(4e4, 0.01, 0, 1e-3))
    return scene


@pytest.mark.parametrize("sheave", [{}, ROUGH], ids=["smooth", "rough"])
def test_energy_is_kept_in_space(sheave):
    """With a fleet angle, whose tangent points move along the axis of the rope."""
    run = in_space(**sheave).run(0.3, output_step=0.05, step=1e-3, integrator="energy")
    assert balance(run) < 1e-12  # measured: 2e-14
    radau = in_space(**sheave).run(0.3, output_step=0.3, tol=1e-6, integrator="radau")
    assert np.abs(run["L.position"][-1] - radau["L.position"][-1]).max() < 2e-6
    assert np.ptp(run["top.fleet_angle_off"]) > 0.01


@pytest.mark.slow
def test_a_hundred_thousand_steps_do_not_drift():
    run = swinging().run(100.0, output_step=1.0, step=1e-3, integrator="energy")
    assert run.report["steps"] == 100_000
    assert balance(run) < 1e-12  # measured: 2e-13
    assert run["top.residual"].max() < 1e-14


def test_order_in_time_is_two():
    ends = [swinging(damping=1e-3).run(0.5, output_step=0.5, step=step, integrator="energy")["L.position"][-1]
            for step in (4e-3, 2e-3, 1e-3)]
    first, second = (np.abs(a - b).max() for a, b in pairwise(ends))
    assert 3.8 < first / second < 4.2  # measured: 3.99
    radau = swinging(damping=1e-3).run(0.5, output_step=0.5, tol=1e-8, integrator="radau")["L.position"][-1]
    assert np.abs(ends[-1] - radau).max() < second


def test_a_mirrored_scene_has_the_mirrored_motion():
    one, other = (swinging(sense, 1e-4, **ROUGH).run(0.5, output_step=0.1, step=1e-3, integrator="energy")
                  for sense in (1, -1))
    assert np.abs(one["L.position"] * (-1, 1, 1) - other["L.position"]).max() < 1e-13
    assert one["energy.dissipated"] == pytest.approx(other["energy.dissipated"], rel=1e-12)


def test_resumed_bit_for_bit(tmp_path):
    scene = swinging(1, 1e-4, **ROUGH)
    settings = {"duration": 0.2, "output_step": 0.01, "step": 1e-3, "integrator": "energy"}
    whole = scene.run(**settings, progress=False)
    resumed = killed_and_resumed(scene, tmp_path / "run.nc", 15, **settings, progress=False)
    assert all(np.array_equal(whole[name], resumed[name]) for name in whole)


# --- limits -----------------------------------------------------------------------------------------------------


def test_a_rope_that_leaves_its_sheave_ends_the_run():
    scene = fu.Scene(gravity=(0, -9.81, 0))
    scene.rigid_body("L", mass=1.0, inertia=(1, 1, 1), position=(1.2, -1.2, 0))
    scene.rope("rope", route=[fu.Anchor(at=(0, 0, 0)), fu.Sheave("peg", at=(0.3, -0.6, 0), radius=0.1, side="left"),
                              fu.Anchor("L")], tension=7.5, elements=1, **rope_of(2e4, 0.01, 0, 1e-3))
    with pytest.raises(fu.RopeLeftError, match='leaves sheave "peg", as its wrap angle reaches') as caught:
        scene.run(2.0, output_step=0.05, step=1e-3, integrator="energy")
    assert balance(caught.value.run) < 1e-12


TOP = fu.Sheave("top", at=(0, 0, 0), radius=0.2, side="right")


def with_route(*items: object, **settings: object) -> fu.Scene:
    scene = fu.Scene(gravity=(0, -9.81, 0))
    scene.rigid_body("L", mass=2.0, inertia=(1, 1, 1), position=(0.2, -1.5, 0))
    scene.rope("rope", route=[*items, fu.Anchor("L")], **{"tension": 20.0, "elements": 1} | settings,
               **rope_of(2e4, 0.05, 0, 1e-3))
    return scene


def lying() -> fu.Scene:
    scene = with_route(fu.Anchor(at=(-1, -1, 0)), TOP)
    scene.surface("floor", fu.Plane(point=(0, -3, 0)))
    scene.contact("rope", "floor", stiffness=1e4, radius=0.01, name="lies")
    return scene


@pytest.mark.parametrize(("scene", "message"), [
    (lambda: with_route(fu.Anchor(at=(-1, -1, 0)), TOP, mass=False),
     'integrator "energy" does not support ropes without mass; take another'),
    (lambda: with_route(fu.Anchor(at=(0.2, 1, 0)), fu.Sheave("top", at=(-0.5, 0, 0), radius=0.2, side="right",
                                                             contact=False)),
     'sheave "top", which the rope touches in a run; draw the rope on it, or take'),
    (lying, 'contact "lies": integrator "energy" has no discrete gradient of it')])
def test_what_has_no_step_equations_is_refused(scene, message):
    with pytest.raises(fu.SceneError, match=message):
        scene().run(0.1, integrator="energy")


def test_algorithmic_dissipation_is_refused():
    with pytest.raises(fu.SceneError, match='rope "rope": integrator "energy" has no algorithmic dissipation of ropes'):
        swinging().run(0.1, integrator="energy", spectral_radius=0.5)
