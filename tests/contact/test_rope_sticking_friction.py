"""Friction of ropes on surfaces that sticks: springs of the material, which flows past the points of contact."""

import funicular as fu
import numpy as np
import pytest
from derivatives import of_a_step
from funicular.engine import Engine
from funicular.integrators import GeneralisedAlpha
from funicular.model.build import build
from interrupted_runs import check_file_and_resume
from ropes.scenes import on_rope_and_cable, rope_of
from test_grips import SETTINGS
from test_rope_friction import BED, ELEMENT, on_sled

pytestmark = pytest.mark.filterwarnings("ignore:.*youngs_modulus|.*density|contact:funicular.FunicularWarning")


def sticking(coefficient: float) -> fu.Friction:
    return fu.Friction(coefficient=coefficient, model="stick")


def stuck_on_sled(dim: int = 2, **given) -> fu.Scene:
    """Return `on_sled` with friction that sticks."""
    scene = on_sled(dim, **given).without("bed")
    scene.contact("line", "deck", friction=sticking(0.3), damping=0.5, **BED)
    return scene


@pytest.mark.parametrize("along", [(1.0, 0.0, 0.0), (-1.0, 0.0, 0.0)])
def test_agrees_with_a_cable(along):
    """A sled decelerates below a rope. The difference from a cable is in proportion to the length beside the sheave,
    into which the rope slides.
    """
    errors = []
    for end in (0.01, 0.005):
        runs = []
        for scene in on_rope_and_cable(end)[:2]:
            scene.rigid_body("sled", mass=5.0, inertia=(1, 1, 1), position=(5, -1, 0), velocity=along)
            scene.joint("prismatic", (5, -1, 0), "sled", axis=(1, 0, 0))
            scene.surface("deck", fu.Plane(point=(0, 0.975, 0)), on="sled")
            scene.contact("line", "deck", stiffness=1e4, radius=0.02, damping=0.5, name="bed", friction=sticking(0.4))
            runs.append(scene.run(0.25, **SETTINGS | {"tol": 1e-6}))
        rope, cable = runs
        assert np.abs(rope.energy_balance().relative).max() < 1e-5
        errors.append([np.abs(rope["sled.velocity"] - cable["sled.velocity"]).max(),
                       abs(rope["energy.dissipated"][-1] / cable["energy.dissipated"][-1] - 1)])
    assert np.all(errors[0] < np.array([5e-4, 5e-4])) and np.all(errors[1] < np.array([3e-5, 3e-5]))


L, TANGENTIAL, SLED, FLOW, SLIP = 4.0, 100.0, 5.0, 2.0, 0.1
HAULED = 500.0
"""Length in contact (m), stiffness of friction's spring (N/m a length), masses of sled and bodies, velocities."""


def carried(elements: int = 12, dim: int = 2, sense: int = 1, tangential: float = TANGENTIAL) -> fu.Scene:
    """Return a rope that two heavy bodies haul over a deck, all along the span between two sheaves. The deck's sled
    moves with it, slower by SLIP as it begins.
    """
    scene = fu.Scene()
    for name, x, v in (("A", 4.1, FLOW), ("B", -0.1, -FLOW)):
        scene.rigid_body(name, mass=HAULED, inertia=(1, 1, 1), position=(x, 6, 0), velocity=(0, v * sense, 0))
        scene.force(name, value=(0, 9.81 * HAULED + 150, 0))
    scene.rope("line", route=[fu.Anchor("B"), fu.Sheave("left", at=(0, 0.1, 0), radius=0.1, side="left"),
                              fu.Sheave("right", at=(4, 0.1, 0), radius=0.1, side="left"), fu.Anchor("A")],
               tension=150.0, elements=[2, elements, 2], element=ELEMENT[dim], **rope_of(1e6, 0.05, 0, 1e-3))
    scene.rigid_body("sled", mass=SLED, inertia=(1, 1, 1), position=(2, -1, 0), velocity=((FLOW - SLIP) * sense, 0, 0))
    scene.joint("prismatic", (2, -1, 0), "sled", axis=(1, 0, 0))
    scene.surface("deck", fu.Plane(point=(0, 0.98 + 0.05 * 9.81 / BED["stiffness"], 0)), on="sled")
    scene.contact("line", "deck", damping=1.0, friction=sticking(1e3), tangential_stiffness=tangential, **BED)
    return scene


def carried_by_delays(times: np.ndarray, n: int = 8000) -> tuple[np.ndarray, float]:
    """Return the velocity of the rope past the sled, and the energy that is lost with stretched material. Material has
    no stretch where it enters, and the stretch x behind the entry is the displacement D past the sled since then:

        m D'' = -k int_0^L D(t) - D(t - x/v) dx,   D = 0 before the start,   1/m = 1/sled + 1/(bodies and rope).
    """
    mass = 1 / (1 / SLED + 1 / (2 * HAULED + 0.05 * 16))
    t, h = np.linspace(0, times[-1], n + 1, retstep=True)
    D, past, rates = np.zeros(n + 1), np.zeros(n + 1), np.full(n + 1, SLIP)  # past: integral of D
    a = 0.0
    for i in range(n):
        D[i + 1] = D[i] + h * rates[i] + h * h / 2 * a
        past[i + 1] = past[i] + h * (D[i] + D[i + 1]) / 2
        entered = np.interp(t[i + 1] - L / FLOW, t[: i + 2], past[: i + 2], left=0.0)
        last, a = a, -TANGENTIAL / mass * (L * D[i + 1] - FLOW * (past[i + 1] - entered))
        rates[i + 1] = rates[i] + h * (last + a) / 2
    x = np.linspace(0, L, 2001)
    stored = TANGENTIAL / 2 * np.trapezoid((D[-1] - np.interp(t[-1] - x / FLOW, t, D, left=0.0)) ** 2, x)
    return np.interp(times, t, rates), mass / 2 * (SLIP**2 - rates[-1] ** 2) - stored


@pytest.mark.parametrize(("dim", "sense"), [(2, 1), (2, -1), (3, 1)])
@pytest.mark.slow_cases("2--1", "3-1")
def test_the_stretch_flows_with_the_material(dim, sense):
    """A sled that the rope carries along swings, and its swing decays as stretched material leaves, within 3 periods
    and 1.25 passages of the span. A stretch that stayed at the points of contact would not let it decay.
    """
    errors = []
    for elements in (6, 24):
        run = carried(elements, dim, sense).run(2.5, **SETTINGS | {"tol": 1e-7})
        past = sense * (run["A.velocity"][:, 1] - run["sled.velocity"][:, 0])
        exact, lost = carried_by_delays(run.time)
        errors.append([np.abs(past - exact).max() / SLIP, abs(run["energy.dissipated"][-1] / lost - 1)])
        assert np.abs(run.energy_balance().relative).max() < 1e-5
    assert np.abs(past[run.time > 2.3]).max() < 0.8 * SLIP
    assert np.all(errors[0] < np.array([0.05, 0.2])) and np.all(errors[1] < np.array([0.015, 2e-3]))


EA, K, MU, RHO = 1e5, 1e6, 0.4, 0.5


def on_ground(*, elements: int = 12, dim: int = 2, weights=(12.0, 12.0), mu: float = MU, EA: float = EA,
              damping_time: float = 2e-2, tangential: float = K) -> fu.Scene:
    """Return a rope that two bodies pull up from below two sheaves, between which it lies 4 m along the ground."""
    scene = fu.Scene()
    for name, x, m in (("A", 4.1, weights[0]), ("B", -0.1, weights[1])):
        scene.rigid_body(name, mass=m, inertia=(1, 1, 1), position=(x, 4, 0))
        scene.force(name, value=(0, 2 * 9.81 * m, 0))
    scene.rope("line", route=[fu.Anchor("B"), fu.Sheave("left", at=(0, 0.1, 0), radius=0.1, side="left"),
                              fu.Sheave("right", at=(4, 0.1, 0), radius=0.1, side="left"), fu.Anchor("A")],
               tension=9.81 * weights[1], elements=[2, elements, 2], element=ELEMENT[dim],
               **rope_of(EA, RHO, 0, damping_time))
    scene.surface("ground", fu.Plane(point=(0, -0.02, 0)))
    scene.contact("line", "ground", damping=1.0, friction=sticking(mu), tangential_stiffness=tangential, **BED)
    return scene


def pulled(force: float, normal: float) -> float:
    """Return the displacement of the end of a rope on the ground by a force from rest. Friction has its limit mu n
    along a length a; beyond, springs hold it, and the tension decays over sqrt(EA/k): force = mu n (a + sqrt(EA/k)).
    """
    limit, decay = MU * normal, (EA / K) ** 0.5
    a = force / limit - decay
    assert 0 < a < L - 5 * decay
    return limit * (decay**2 + decay * a + a * a / 2) / EA


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.slow_cases("3")
def test_a_rope_that_is_pulled_and_let_go(dim):
    """Tension of one end rises below mu N, and falls back: as it falls, displacements are twice those by half of the
    force (Masing), and a part stays. The free length beside the ground stretches, too.
    """
    force, normal = 4.0, RHO * 9.81
    scene = on_ground(dim=dim)
    for value, start in ((force, 0.1), (-force, 1.6)):
        scene.force("A", value=(0, value, 0), scale=fu.Ramp(start=start, end=start + 1.0))
    run = scene.run(3.0, initial=scene.equilibrium(), **SETTINGS | {"tol": 1e-6, "output_step": 0.1})
    held, back = (run["A.position"][k, 1] - run["A.position"][0, 1] for k in (15, 30))
    edge = (L - run["bed.force"][0, 1] / normal) / 2  # beside a sheave, where it does not lie on the ground yet
    free = force * (4 - 0.1 + np.pi / 2 * 0.1 + edge) / EA
    one = pulled(force, normal)
    assert held - free == pytest.approx(one, rel=5e-3)
    assert np.ptp(run["A.position"][13:16, 1]) < 1e-4 * one  # it does not creep
    assert back == pytest.approx(one - 2 * pulled(force / 2, normal), rel=5e-3)
    assert run["bed.friction_force"][15, 0] == pytest.approx(-force, rel=1e-3)
    assert np.abs(run["bed.friction_force"][30, 0]) < 1e-3 * force
    assert np.abs(run.energy_balance().relative).max() < 1e-6
    assert run["energy.dissipated"][30] > run["energy.dissipated"][15] > 0


def test_a_rope_that_slips_has_mu_n():
    """The difference of two weights is above mu N."""
    m = (20.0, 12.0)
    run = on_ground(weights=m, EA=2e6, damping_time=1e-3, tangential=2e4).run(
        1.0, **SETTINGS | {"tol": 1e-6, "output_step": 0.01})
    late = run.time > 0.5
    normal = run["bed.force"][late, 1]
    assert run["bed.friction_force"][late, 0] == pytest.approx(-MU * normal, rel=1e-5)
    fell = np.polynomial.Polynomial.fit(run.time[late], run["A.position"][late, 1], 3).deriv(2)(run.time[late]).mean()
    y = run["A.position"][late, 1].mean() - run["B.position"][late, 1].mean()
    assert fell == pytest.approx((9.81 * (m[0] - m[1] - RHO * y) - MU * normal.mean()) / (sum(m) + RHO * 12), rel=0.02)


@pytest.mark.slow
def test_elements_converge_as_the_rope_flows_back_and_forth():
    def swung(elements: int) -> np.ndarray:
        scene = on_ground(elements=elements, EA=2e6, damping_time=1e-2, tangential=2e3)
        scene.force("A", value=(0, 16, 0), scale=fu.Harmonic(amplitude=1.0, frequency=3.0))
        run = scene.run(0.6, **SETTINGS | {"tol": 1e-6, "output_step": 0.02})
        friction = run["bed.friction_force"][:, 0]
        assert friction.max() > 5 and friction.min() < -5
        return run["A.position"][:, 1]

    exact = swung(24)
    errors = [np.abs(swung(n) - exact).max() / np.ptp(exact) for n in (3, 6, 12)]
    assert errors[0] > 2 * errors[1] > 4 * errors[2]
    assert errors[2] < 1e-3


@pytest.mark.parametrize("integrator", ["radau", "genalpha", "explicit"])
@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.slow_cases("2-radau", "3-genalpha", "3-explicit")
def test_energy_on_a_moving_body(dim, integrator):
    """The sled is thrown back by the rope, which drags it along. Integrators agree on what friction dissipates."""
    settings = SETTINGS | {"duration": 0.3, "tol": 1e-5, "output_step": 0.01}
    run, other = (stuck_on_sled(dim).run(**settings | {"integrator": each}) for each in (integrator, "radau"))
    assert run["bed.touching"].max() > 1 and run["energy.dissipated"][-1] > 0.5
    assert np.abs(run.energy_balance().relative).max() < 2e-5
    assert run["energy.dissipated"] == pytest.approx(other["energy.dissipated"], abs=1e-4)
    assert np.diff(run["energy.dissipated"]).min() > -1e-5


@pytest.mark.parametrize("dim", [2, 3])
def test_tangent_with_stretch_and_flow(dim):
    """After 0.1 s the stretch differs along the rope, and the rope flows 20 mm in a step."""
    engine = Engine(build(carried(4, dim, tangential=1e5)))
    engine.start(duration=0.1, output_step=0.1, tol=1e-6, step=1e-3, first_step=1e-3, method=GeneralisedAlpha(0.8))
    assert engine.advance(lambda *_: None) == "completed"
    at = 1e-6 * np.random.default_rng(1).standard_normal(engine.unknowns)
    matrix = engine.linearise(0.01, at)[1]
    difference = np.abs(of_a_step(engine, 0.01, at, 1e-7) - matrix)
    assert difference.max() < 1e-7 * np.abs(matrix).max()


def test_a_planar_scene_and_its_twin_in_space():
    runs = [stuck_on_sled(dim, flat=True).run(0.3, **SETTINGS | {"tol": 1e-6}) for dim in (2, 3)]
    assert runs[0]["bed.touching"].max() > 1
    assert np.abs(runs[0]["sled.position"] - runs[1]["sled.position"])[:, :2].max() < 1e-3


def test_resumed_bit_for_bit_and_from_a_file(tmp_path):
    check_file_and_resume(stuck_on_sled(), tmp_path, 8, **SETTINGS | {"duration": 0.4})


def test_a_state_of_rest_has_none():
    scene = on_ground(EA=2e6)
    with pytest.warns(fu.FunicularWarning, match='friction of contact "bed" is left out: at rest contacts move freely'):
        rest = scene.equilibrium()
    assert np.abs(rest["bed.friction_force"]).max() == 0 and rest["bed.force"][1] > 10
    with pytest.raises(fu.SceneError, match='contact "bed": its friction has no part in a state of rest'):
        scene.relax()
    with pytest.warns(fu.FunicularWarning, match='modes leave out the friction of contact "bed"'):
        scene.modes(3, about=rest)


def test_refused():
    with pytest.raises(fu.SceneError, match='contact "bed": integrator "energy" has no discrete gradient of it'):
        stuck_on_sled().run(0.1, output_step=0.1, integrator="energy", step=1e-3, progress=False)
    scene = on_sled().without("bed")
    with pytest.raises(fu.SceneError, match="tangential_stiffness is missing"):
        scene.contact("line", "deck", friction=sticking(0.3), exponent=1.5, stiffness=1e6, radius=0.02)
