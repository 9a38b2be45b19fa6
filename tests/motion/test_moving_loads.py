"""Forces that move along cables: case M1, a train by superposition, ends, nodes, energy, files, refusals."""

import numpy as np
import pytest
from changing_loads import (
    DEFLECTION_RATIO,
    INTEGRATORS,
    PUBLISHED,
    STEEL,
    TRAIN,
    F,
    L,
    beam,
    by_modes,
    crossing,
    deflection,
    speed_of,
    train_by_modes,
    under_range,
)
from expectations import energy_error, largest, refused
from funicular import Harmonic, Piece, Pulse, Ramp, Rectangle, Scene, TableSignal
from funicular.model.breakpoints import breakpoints
from funicular.model.build import build
from interrupted_runs import check_file_and_resume
from shared_scenes import SQUARE, TABLE_1, add_cable

LINEAR = pytest.mark.filterwarnings("ignore:the linear model of motion")


def walk(start: float, stop: float, time: float = 1.0) -> TableSignal:
    return TableSignal(time=[0, time], value=[start, stop], interpolation="linear")


def soft(element="cable12", **given) -> Scene:
    """Return a soft cable of four elements, pinned at both ends."""
    scene = Scene()
    add_cable(scene, pins=(0.0, 1.5), elements=4, element=element, **given)
    return scene


@LINEAR
@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("alpha", PUBLISHED)
def test_a_force_that_crosses_a_beam(alpha, integrator):
    time = L / speed_of(alpha)
    run = crossing(alpha).run(time, output_step=time / 2000, integrator=integrator, tol=1e-6)
    found = deflection(run)
    assert abs(found.max() - PUBLISHED[alpha]) < 1e-4
    assert largest(found - by_modes(alpha, run.time)) < 1e-4
    assert energy_error(run) < 1e-5


@LINEAR
@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_train_of_three_axles_by_superposition(integrator):
    """It comes on the beam, and leaves it in free vibration."""
    time = 2 * L / speed_of(0.25)
    run = crossing(0.25, 2.0, **TRAIN).run(time, output_step=time / 400, integrator=integrator, tol=1e-6)
    assert largest(deflection(run) - train_by_modes(0.25, run.time)) < 2e-4 * sum(TRAIN["shares"])
    assert energy_error(run) < 1e-5
    assert np.ptp(run["energy.external"][run.time > 1.51 / 2 * time]) == 0


def test_in_space_as_in_the_plane():
    time = L / speed_of(0.5)
    settings = {"duration": time, "output_step": time / 50, "integrator": "radau", "tol": 1e-7}
    planar, spatial = (deflection(crossing(0.5, element=name).run(**settings)) for name in ("cable8p", "cable12"))
    np.testing.assert_allclose(spatial, planar, atol=1e-6)


@pytest.mark.parametrize("element", ["cable12", "beam24", "cable18"])
@pytest.mark.parametrize("follower", [False, True])
def test_it_does_work_on_a_cable_that_moves_far(element, follower):
    """The balance of energies, with all methods, and their agreement."""
    def ends(integrator, tol):
        scene = soft(element)
        scene.force("wire", s=walk(-0.2, 1.6, 0.3), offsets=(0, -0.4), shares=(1, 0.5), follower=follower,
                    value=(30, 0, 0) if follower else (5, -40, 3))
        run = scene.run(0.4, output_step=0.01, integrator=integrator, tol=tol)
        assert energy_error(run) < 1e-3
        return run["wire.nodal_vectors"][:, 2, 0]

    exact = ends("radau", 1e-7)
    for integrator, tol in (("explicit", 1e-7), ("genalpha", 1e-5), ("energy", 1e-5)):
        assert largest(ends(integrator, tol) - exact) < 2e-3 * largest(exact[:, 1]), integrator


def test_passages_of_nodes_keep_the_order():
    """The error of steps of fixed size is 1000 times larger where they pass over the nodes."""
    def middle(steps):
        scene, time = beam(elements=3), L / speed_of(0.5)
        scene.force("beam", s=walk(0, L, time), value=(0, -F, 0))
        run = scene.run(time, output_step=time, integrator="explicit", step=time / steps)
        return run["beam.nodal_vectors"][-1, 1, 1, 1] / DEFLECTION_RATIO

    assert abs(middle(1000) - middle(4000)) < 2e-11


def test_steps_end_where_it_passes_nodes_and_ends():
    scene = soft()
    scene.force("wire", s=walk(-0.3, 1.8), offsets=(0, -0.15), value=(0, -1, 0))
    times, jumps = breakpoints(build(scene), 1.0, 1e-3)
    first = (np.array([0, 0.375, 0.75, 1.125, 1.5]) + 0.3) / 2.1
    expected = np.sort([*first, *(first + 0.15 / 2.1)])
    np.testing.assert_allclose(times[times < 0.999], expected[expected < 0.999], rtol=1e-12)
    at_ends = np.isclose(times[:, None], [first[0], first[-1], first[0] + 0.15 / 2.1, first[-1] + 0.15 / 2.1]).any(1)
    assert set(jumps[at_ends]) == {1} and set(jumps[~at_ends]) == {0}
    times, _ = breakpoints(build(scene), 1.0, 1e-3, nodes=False)
    assert len(times[times < 0.999]) == 4


def test_off_the_ends_nothing_acts():
    """A free cable without weight: its momentum is the impulse of the force while it is on the cable."""
    scene = Scene(gravity=(0, 0, 0))
    add_cable(scene, elements=3, pins=())
    scene.force("wire", s=walk(-0.5, 2.5), value=(0, 2.0, 0))
    mass = TABLE_1.density * SQUARE.area * 1.5
    for integrator in ("genalpha", "radau", "explicit", "energy"):
        run = scene.run(1.0, output_step=0.01, integrator=integrator, tol=1e-5)
        momentum = mass * mean_velocity(run)
        expected = 2.0 * np.clip(run.time - 0.5 / 3, 0, 1.5 / 3)
        np.testing.assert_allclose(momentum, expected, atol=1e-5)


def mean_velocity(run) -> np.ndarray:
    """Return the mean velocity (T,) along y of a cable of equal elements: the integral of its cubic rates."""
    v = run["wire.nodal_velocity"][:, :, :, 1]
    n, length = v.shape[1] - 1, 1.5 / (v.shape[1] - 1)
    return ((v[:, 1:, 0] + v[:, :-1, 0]) / 2 + length * (v[:, :-1, 1] - v[:, 1:, 1]) / 12).sum(axis=1) / n


@pytest.mark.parametrize("signal", [
    Ramp(start=0.05, end=0.3, before=-0.1, after=0.9), Harmonic(amplitude=0.6, frequency=3, offset=0.75),
    TableSignal(time=[0, 0.1, 0.2, 0.3], value=[0.1, 1.7, 0.2, 1.4]),
    Pulse(start=0.05, end=0.25, rise=0.05, height=1.2)])
def test_signals_of_any_form(signal):
    scene = soft()
    scene.force("wire", s=signal, value=(0, -50, 0), scale=Ramp(start=0, end=0.1))
    runs = [scene.run(0.3, output_step=0.01, integrator=name, tol=1e-6) for name in ("explicit", "radau")]
    assert largest(runs[0]["wire.nodal_vectors"] - runs[1]["wire.nodal_vectors"]) < 1e-5
    assert energy_error(runs[0]) < 1e-5


@pytest.mark.parametrize(("start", "stop"), [(0.0, L / 2), (1.1, 4.3), (2.0, 2.01)])
def test_a_line_load_over_a_range(start, stop):
    """Its ends lie within elements; cubic elements are exact at nodes."""
    found, exact = under_range(start, stop)
    assert abs(found - exact) < 1e-8


def test_at_rest_it_stands_where_it_starts():
    scene, fixed = beam(), beam()
    scene.force("beam", s=walk(4.0, 12.0), value=(0, -F, 0))
    fixed.force("beam", s=4.0, value=(0, -F, 0))
    s = np.array([1.0, 4.0, 7.0])
    for rest in (scene.equilibrium(), fixed.equilibrium()):
        moment = rest.section_forces("beam", s)["moment"].values[..., 2]
        np.testing.assert_allclose(moment, F * np.array([0.6, 2.4, 1.2]), rtol=1e-6)


def test_it_crosses_the_joint_of_two_pieces():
    """Slowly: the joint deflects as under fixed forces at rest, and the moments under the force are F s (L - s)/L."""
    def stepped() -> Scene:
        scene = Scene(gravity=(0, 0, 0))
        pieces = [Piece(length=length, section=Rectangle(height=depth, width=0.1), material=STEEL, elements=4)
                  for length, depth in ((4.0, 0.1), (6.0, 0.2))]
        scene.cable("beam", start=(0, 0, 0), end=(L, 0, 0), element="cable8p", pieces=pieces)
        scene.pin("beam", s=0.0)
        scene.pin("beam", s=L)
        return scene

    scene = stepped()
    scene.force("beam", s=walk(0.0, L, 1000.0), value=(0, -F, 0))
    run = scene.run(1000.0, output_step=100.0, integrator="genalpha", step=1.0, spectral_radius=0.0)
    for k in (2, 4, 5, 7):
        fixed = stepped()
        fixed.force("beam", s=float(k), value=(0, -F, 0))
        expected = fixed.equilibrium()["beam.nodal_vectors"][4, 0, 1]
        assert abs(run["beam.nodal_vectors"][k, 4, 0, 1] / expected - 1) < 1e-4
        moment = run.section_forces("beam", [float(k)])["moment"].values[k, 0, 2]
        assert abs(moment / (F * k * (L - k) / L) - 1) < 1e-4


def test_the_moment_under_it():
    """Slowly, so that the beam is at rest: F s (L - s)/L."""
    scene = beam()
    scene.force("beam", s=walk(0.0, L, 1000.0), value=(0, -F, 0))
    run = scene.run(1000.0, output_step=100.0, integrator="genalpha", step=1.0, spectral_radius=0.0)
    s = np.linspace(1, 9, 9)
    found = [run.section_forces("beam", [at])["moment"].values[k + 1, 0, 2] for k, at in enumerate(s)]
    np.testing.assert_allclose(found, F * s * (L - s) / L, rtol=1e-3)


@pytest.mark.parametrize("integrator", ["genalpha", "radau", "explicit", "energy"])
def test_a_file_and_a_resumed_run(tmp_path, integrator):
    scene = soft()
    scene.force("wire", s=walk(-0.1, 1.7, 0.15), offsets=(0, -0.4), shares=(1, 0.5), value=(0, -40, 0), name="train")
    run = check_file_and_resume(scene, tmp_path, 20, duration=0.2, output_step=0.01, tol=1e-3, integrator=integrator)
    assert run["energy.external"][-1] > 0


@LINEAR
def test_a_resumed_run_by_the_linear_model(tmp_path):
    time = L / speed_of(0.5)
    check_file_and_resume(crossing(0.5, 1.5, **TRAIN), tmp_path, 20, duration=1.5 * time, output_step=time / 20,
                          step=time / 200, integrator="linear")


def test_arrows_move_with_it():
    scene = soft()
    scene.force("wire", s=walk(-0.3, 1.2, 0.1), value=(0, -40, 0), name="walker")
    run = scene.run(0.1, output_step=0.01)
    (arrow,) = [each for each in run.animation().clips[0].segments if each.name == "walker"]
    np.testing.assert_array_equal(arrow.start[:2], arrow.end[:2])
    assert (arrow.end[-1] - arrow.start[-1])[1] < 0
    assert abs(arrow.end[-1, 0] - 1.2) < 0.05


def test_what_is_refused():
    scene = soft()
    scene.rigid_body("A", mass=1.0, inertia=(1, 1, 1), position=(0, 1, 0))
    with refused('force "f": moves along "A", which is no cable; give s as a number'):
        scene.force("A", s=walk(0, 1), value=(0, 1, 0), name="f")
    with refused('force "f": is never on the cable, [0, 1.5] m, at the offset -3 m: s starts at 0 m'):
        scene.force("wire", s=walk(0, 1), offsets=(0, -3), value=(0, 1, 0), name="f")
    with refused('force "f": s is a sine that leaves the cable, [0, 1.5] m, at the offset 0 m; take a smaller '
                 "amplitude, or a TableSignal"):
        scene.force("wire", s=Harmonic(amplitude=1.0, frequency=1, offset=0.75), value=(0, 1, 0), name="f")
    with refused('force "f": offsets and shares are of a force that moves; give s as a signal, or leave them out'):
        scene.force("wire", s=1.0, offsets=(0, -1), value=(0, 1, 0), name="f")
    with refused('force "f": offsets and shares must be of equal length, got 2 and 1'):
        scene.force("wire", s=walk(0, 1), offsets=(0, -1), shares=[1], value=(0, 1, 0), name="f")
    with refused('force "f": acts on cable "wire" and takes no point at; leave at out'):
        scene.force("wire", s=walk(0, 1), at=(0, 1, 0), value=(0, 1, 0), name="f")
    assert not scene.loads
