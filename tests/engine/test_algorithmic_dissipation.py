"""Algorithmic dissipation of the energy-momentum integrator: fast vibrations decay, slow motion and momenta do not."""

from itertools import pairwise

import numpy as np
import pytest
from funicular import Circle, Material, Scene
from funicular.engine import Engine
from funicular.integrators import EnergyMomentum
from funicular.model.build import build
from shared_scenes import cable_scene
from test_energy_integrator import CABLES, PLANAR, balance, changes, crossing, free, momenta

RADII = (0.0, 0.5, 0.8, 1.0)
pytestmark = pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")


class Oscillator:
    """u'' = -omega^2 u with h = 1 by algorithmic_dissipation.c. The state is u, v, g; the energy includes the stored
    part.
    """

    def __init__(self, spectral_radius: float, omega: float):
        lag, viscosity, inertia, weight = EnergyMomentum(spectral_radius).parameters
        follows = 2 / (2 * lag + 1)  # g_1 - g_0 = follows (lag du - g_0)
        stiffness = omega**2
        start = np.array([[1, 0.5, 0],
                          [-stiffness * (0.5 - weight), 1 + 2 * stiffness * inertia, stiffness * follows * viscosity],
                          [-follows * lag, 0, 1 - follows]])
        end = np.array([[1, -0.5, 0], [stiffness * (0.5 + weight), 1, 0], [-follows * lag, 0, 1]])
        self.step = np.linalg.solve(end, start)
        self.energy = 0.5 * np.array([stiffness, 1 + stiffness * inertia,
                                      stiffness * viscosity / lag if lag else 0.0])

    @property
    def radius(self) -> float:
        return np.abs(np.linalg.eigvals(self.step)).max()


@pytest.mark.parametrize("spectral_radius", RADII)
def test_spectral_radius_of_a_fast_oscillator_is_the_one_asked_for(spectral_radius):
    # three eigenvalues coincide there: their error is the third root of the distance from the limit
    assert abs(Oscillator(spectral_radius, 1e4).radius - spectral_radius) < 5e-3
    assert abs(Oscillator(spectral_radius, 1e6).radius - spectral_radius) < 5e-4


@pytest.mark.parametrize("spectral_radius", RADII)
def test_no_oscillator_grows_and_slow_ones_stay(spectral_radius):
    radii = np.array([Oscillator(spectral_radius, omega).radius for omega in np.logspace(-3, 6, 200)])
    assert radii.max() < 1 + 1e-13
    lost = [1 - Oscillator(spectral_radius, omega).radius for omega in (0.01, 0.1)]
    assert lost[0] < 6e-9  # a step, of the amplitude; measured: 5e-9 at most, falling with the fourth power
    assert lost[1] < 6e-5


@pytest.mark.parametrize("spectral_radius", RADII)
@pytest.mark.parametrize("omega", [0.1, 3.0, 100.0])
def test_the_energy_of_an_oscillator_never_grows(spectral_radius, omega):
    oscillator, state, energies = Oscillator(spectral_radius, omega), np.array([1.0, 0.3, 0.0]), []
    for _ in range(200):
        energies.append(oscillator.energy @ state**2)
        state = oscillator.step @ state
    assert np.diff(energies).max() < 1e-14 * energies[0]
    assert (energies[-1] < 0.9 * energies[0]) == (spectral_radius < 1 and omega > 1)


@pytest.mark.parametrize("kind", [*CABLES, *PLANAR])
def test_momenta_are_kept_and_the_energy_balances(kind):
    scene = free(planar=kind in PLANAR, **(CABLES | PLANAR)[kind])
    run = scene.run(duration=0.5, step=5e-4, output_step=0.05, integrator="energy", spectral_radius=0.5)
    errors = balance(run), *map(changes, momenta(scene, run))
    assert max(errors) < 1e-12  # measured: 1e-13 at most
    assert run["energy.dissipated"][-1] > 1e-5 * run["energy.kinetic"][0]
    assert run["energy.dissipated"].min() >= 0


class EveryRow:
    """A stream that only evaluates the engine after each row."""

    def __init__(self, look):
        self.look = look

    def pause(self):
        self.look()

    def between(self):
        pass


@pytest.mark.parametrize("kind", ["green", "engineering", "cable8p"])
def test_energy_with_what_is_stored_decays_in_every_step(kind):
    """The stored energy is viscosity/(2 lag) D g^2 plus the energy of r, with D by the Gauss points of the damping."""
    scene = free(planar=kind in PLANAR, **(CABLES | PLANAR)[kind])
    model, method = build(scene), EnergyMomentum(0.5)
    lag, viscosity, _, _ = method.parameters
    cable, engine, stored = model.cables[0], Engine(model), []
    EA, EI = np.ravel(cable.A)[:2]
    axial = EA * cable.mesh.mean / 2 * np.polynomial.legendre.leggauss(3)[1]
    bending = 2 * EI / cable.mesh.mean * np.repeat(np.polynomial.legendre.leggauss(2)[1], model.dim)
    stiffness = np.concatenate([axial, bending])

    def look():
        numbers = engine.relaxed_strains()[0]
        stored.append(viscosity / (2 * lag) * np.sum(stiffness * numbers[:, :-1] ** 2) + numbers[:, -1].sum())

    engine.start(duration=0.2, output_step=5e-4, tol=1e-4, step=5e-4, method=method, first_step=5e-4)
    engine.advance(lambda t: None, 1, EveryRow(look))
    rows = engine.rows()
    energy = (rows["kinetic"] + rows["elastic"] + rows["potential"])[1:len(stored) + 1] + stored
    assert len(stored) > 300
    assert np.diff(energy).max() < 1e-14 * energy[0]
    assert max(stored) > 1e-6 * energy[0]


@pytest.mark.parametrize("kind", ["beam24", "green"])
def test_order_in_time_is_two(kind):
    scene = crossing(youngs_modulus=1e6, **CABLES[kind])

    def end(step):
        run = scene.run(duration=0.2, step=step, output_step=0.2, integrator="energy", spectral_radius=0.5)
        return np.concatenate([run["A.position"][-1], run["A.orientation"][-1], run["trolley.s"][-1:],
                               run["wire.nodal_vectors"][-1, :, 0].ravel(), run["A.velocity"][-1] / 10])

    ends = [end(step) for step in (5e-4, 2.5e-4, 1.25e-4)]
    first, second = (np.abs(a - b).max() for a, b in pairwise(ends))
    assert 3.5 < first / second < 4.5


def pendulum(element: str, stretch: float) -> Scene:
    """A steel wire falls from the horizontal. With 0.1 % of slack it vibrates at h omega of 12 and more for h = 1 ms.
    """
    return cable_scene(pins=(0.0,), elements=8, element=element, rest_length=1 / (1 + stretch),
                       section=Circle(radius=1e-3),
                       material=Material(youngs_modulus=2e11, poisson_ratio=0, density=7850))


@pytest.mark.parametrize("element", ["cable12", "cable8p", "beam24"])
def test_a_ringing_wire_goes_still_and_swings_on(element):
    settings = {"duration": 0.5, "step": 1e-3, "output_step": 0.02, "integrator": "energy"}
    rings = pendulum(element, 1e-3).run(**settings, spectral_radius=0.5)
    still = pendulum(element, 0.0).run(**settings)
    ringing = rings["energy.elastic"][0]
    assert 0.31 < ringing < 0.32  # J; the swing has up to 0.12 J of kinetic energy and 2e-4 J of elastic energy
    lost = rings["energy.dissipated"] / ringing
    assert lost[5] > 0.999
    assert abs(lost[-1] - lost[5]) < 1e-5
    assert rings["energy.elastic"][-1] < 2e-3 * ringing
    assert abs(rings["energy.kinetic"][-1] / still["energy.kinetic"][-1] - 1) < 0.01
    ends = [run["wire.nodal_vectors"][-1, -1, 0] for run in (rings, still)]
    np.testing.assert_allclose(*ends, atol=0.01)
    assert balance(rings) < 1e-11


def test_slow_motion_keeps_its_energy():
    run = pendulum("cable12", 0.0).run(duration=1.0, step=1e-3, output_step=0.02, integrator="energy",
                                       spectral_radius=0.5)
    assert 0 <= run["energy.dissipated"][-1] < 1e-5 * run["energy.kinetic"].max()  # measured: 1.5e-6


def test_a_spectral_radius_of_one_is_the_integrator_as_it_was():
    runs = [crossing(**CABLES["green"]).run(duration=0.1, step=1e-3, output_step=0.01, integrator="energy", **given)
            for given in ({}, {"spectral_radius": 1.0})]
    for name in ("A.position", "wire.nodal_vectors", "energy.kinetic", "energy.dissipated"):
        np.testing.assert_array_equal(*(run[name] for run in runs))
    assert [run.report["spectral_radius"] for run in runs] == [1.0, 1.0]
    assert runs[0]["energy.dissipated"].max() == 0.0


def test_crossing_nodes_keeps_the_energy_balance():
    run = crossing(**CABLES["green"]).run(duration=1.0, tol=1e-4, output_step=0.05, integrator="energy",
                                          spectral_radius=0.5)
    assert run.report["element_crossings"] > 0
    assert balance(run) < 1e-12
    assert run["energy.dissipated"].min() >= 0


def test_the_engine_does_what_the_oscillator_does():
    """A wire has axial vibrations at h omega of 79 and more, with amplitudes in the linear range."""
    step, speed = 0.01, np.sqrt(2e11 / 7850)
    scene = Scene(gravity=(0, 0, 0))
    scene.cable("wire", start=(0, 0, 0), end=(1, 0, 0), elements=1, element="cable8p", rest_length=1 / (1 + 1e-8),
                section=Circle(radius=1e-3), material=Material(youngs_modulus=2e11, poisson_ratio=0, density=7850))
    scene.pin("wire", s=0.0)
    run = scene.run(duration=10 * step, step=step, output_step=step, integrator="energy", spectral_radius=0.5)
    oscillator, state, squares = Oscillator(0.5, step * speed * np.pi / 2), np.array([1.0, 0, 0]), []
    for _ in run.time:
        squares.append(state[0] ** 2)
        state = oscillator.step @ state
    assert squares[-1] < 2e-3
    np.testing.assert_allclose(run["energy.elastic"] / run["energy.elastic"][0], squares, rtol=0.03)
