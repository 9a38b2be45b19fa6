"""Springs whose length or stiffness is a signal: closed forms, the balance of energy, corners of the law, files."""

import funicular as fu
import numpy as np
import pytest
from expectations import refused
from interrupted_runs import check_file_and_resume
from scipy.integrate import solve_ivp
from scipy.special import airy

MASS, STIFFNESS, LENGTH = 2.0, 50.0, 1.5
OMEGA = np.sqrt(STIFFNESS / MASS)
STROKE, FREQUENCY = 0.1, 0.7
WINCH = fu.Harmonic(amplitude=STROKE, frequency=FREQUENCY, offset=LENGTH)
SOFTENING = fu.TableSignal(time=(0, 4), value=(STIFFNESS, STIFFNESS / 5), interpolation="linear")
METHODS = {"genalpha": {"tol": 1e-6}, "radau": {"tol": 1e-7}, "explicit": {"tol": 1e-7}, "energy": {"step": 1e-3}}
TOLERANCE = {"genalpha": 1e-5, "radau": 1e-8, "explicit": 1e-8, "energy": 2e-5}
"""m: errors of methods of order 2 at these settings, and of the others."""


def hung(height: float = LENGTH, planar: bool = False, **spring) -> fu.Scene:
    """Return a mass at a height above the ground, on a spring from there, without gravity."""
    scene = fu.Scene(gravity=(0, 0, 0))
    if planar:
        scene.cable("far", start=(9, 0, 0), end=(10, 0, 0), elements=1, element="cable8p",
                    section=fu.Circle(radius=0.01),
                    material=fu.Material(youngs_modulus=1e6, poisson_ratio=0.3, density=1000))
    scene.rigid_body("mass", mass=MASS, inertia=(1, 1, 1), position=(0, height, 0))
    scene.spring((0, 0, 0), "mass", name="spring", **spring)
    return scene


def imbalance(run: fu.Run) -> float:
    """Return the largest change of the sum of all energies less the external work, J."""
    stored = sum(run[f"energy.{part}"] for part in ("kinetic", "elastic", "potential", "dissipated"))
    return float(np.ptp(stored - run["energy.external"]))


@pytest.mark.parametrize("planar", [False, True])
@pytest.mark.parametrize("method", METHODS)
def test_a_driven_length_moves_its_mass(method, planar):
    """m x'' = -k (x - L - a sin wt) from rest: x = L + a/(1 - r²) (sin wt - r sin w0 t), r = w/w0."""
    run = hung(stiffness=STIFFNESS, length=WINCH, planar=planar).run(duration=3.0, output_step=0.01, integrator=method,
                                                                     **METHODS[method])
    w, r = 2 * np.pi * FREQUENCY, 2 * np.pi * FREQUENCY / OMEGA
    exact = LENGTH + STROKE / (1 - r**2) * (np.sin(w * run.time) - r * np.sin(OMEGA * run.time))
    assert np.abs(run["mass.position"][:, 1] - exact).max() < TOLERANCE[method]
    tension = STIFFNESS * (exact - WINCH.value(run.time))
    assert np.abs(run["spring.tension"] - tension).max() < 2 * STIFFNESS * TOLERANCE[method]
    power = -tension * WINCH.value(run.time, 1)
    work = np.append(0.0, np.cumsum((power[1:] + power[:-1]) / 2 * 0.01))
    assert np.abs(run["energy.external"] - work).max() < 5e-4 * np.ptp(work)  # the error of the trapezoidal rule
    assert imbalance(run) < (1e-12 if method == "energy" else 1e-5) * np.ptp(work)


@pytest.mark.parametrize("method", METHODS)
def test_a_stiffness_that_falls_linearly(method):
    """m x'' = -(k - c t) e: Airy functions of z = (c t - k) (m c²)^(-1/3)."""
    scene = hung(height=LENGTH + 0.1, stiffness=SOFTENING, length=LENGTH)
    run = scene.run(duration=3.0, output_step=0.01, integrator=method, **METHODS[method])
    rate = STIFFNESS * 0.8 / 4 / MASS
    scale = rate ** (1 / 3)
    z = (rate * run.time - OMEGA**2) / scale**2
    a, da, b, db = airy(z[0])
    first, second = np.linalg.solve([[a, b], [da, db]], [0.1, 0.0])
    exact = LENGTH + first * airy(z)[0] + second * airy(z)[2]
    assert np.abs(run["mass.position"][:, 1] - exact).max() < TOLERANCE[method]
    assert imbalance(run) < (1e-12 if method == "energy" else 1e-4) * np.ptp(run["energy.external"])


LAWS = {
    "damper": {"stiffness": STIFFNESS, "damping": 3.0, "length": WINCH},
    "tension only": {"stiffness": STIFFNESS, "damping": 0.3, "length": WINCH, "tension_only": True},
    "tension only, no damper": {"stiffness": SOFTENING, "length": WINCH, "tension_only": True},
    "play": {"stiffness": SOFTENING, "length": WINCH, "free_play": 0.05},
}


def tension_of(spring, x, rate, t):
    """Return the tension of one of these springs, N."""
    length, winding = WINCH.value(t), WINCH.value(t, 1)
    stiffness = SOFTENING.value(t) if spring["stiffness"] is SOFTENING else STIFFNESS
    extension = x - length
    if "tension_only" in spring and extension < 0:
        return 0.0
    play = spring.get("free_play", 0.0) / 2
    tension = stiffness * np.sign(extension) * max(abs(extension) - play, 0.0)
    tension += spring.get("damping", 0.0) * (rate - winding)
    return max(tension, 0.0) if "tension_only" in spring else tension


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("law", LAWS)
def test_laws_with_corners_and_dampers(law, method):
    spring = LAWS[law]
    run = hung(**spring).run(duration=3.0, output_step=0.05, integrator=method, **METHODS[method])
    exact = solve_ivp(lambda t, y: (y[1], -tension_of(spring, *y, t) / MASS), (0, 3), (LENGTH, 0.0), rtol=1e-10,
                      atol=1e-11, max_step=0.01, t_eval=run.time).y[0]
    assert np.abs(run["mass.position"][:, 1] - exact).max() < max(TOLERANCE[method], 1e-7)  # of the reference
    assert imbalance(run) < (1e-12 if method == "energy" else 1e-4) * np.ptp(run["energy.external"])


def test_two_winches_pull_a_mass_across():
    """A mass between two springs, off their line: the direction turns, and both lengths do work."""
    scene = hung(stiffness=STIFFNESS, length=WINCH, damping=0.5)
    scene.spring((2, 0.5, 0), "mass", name="other", stiffness=fu.Ramp(start=0, end=1, before=20, after=80), length=1.0)
    whole = scene.run(duration=2.0, output_step=0.02, integrator="explicit", tol=1e-9)
    for method in ("radau", "genalpha", "energy"):
        run = scene.run(duration=2.0, output_step=0.02, integrator=method, **METHODS[method])
        assert np.abs(run["mass.position"] - whole["mass.position"]).max() < 10 * TOLERANCE[method]
        assert imbalance(run) < (1e-11 if method == "energy" else 1e-4) * np.ptp(run["energy.external"])


def test_files_and_resuming_keep_every_bit(tmp_path):
    scene = hung(stiffness=SOFTENING, length=WINCH, tension_only=True)
    run = check_file_and_resume(scene, tmp_path, 20, duration=1.0, output_step=0.05, tol=1e-5)
    assert run["energy.external"][-1] != 0


def test_statics_take_the_values_at_the_start():
    loaded = fu.Scene()
    loaded.rigid_body("mass", mass=MASS, inertia=(1, 1, 1), position=(0, -2, 0))
    varying = {"stiffness": SOFTENING, "length": fu.Ramp(start=1, end=2, before=0.5, after=3.0)}
    loaded.spring((0, 0, 0), "mass", name="spring", **varying)
    rest = loaded.equilibrium()
    assert rest["mass.position"][1] == pytest.approx(-0.5 - MASS * 9.81 / STIFFNESS, rel=1e-12)
    assert 2 * np.pi * loaded.modes(6, about=rest).frequency.max() == pytest.approx(OMEGA, rel=1e-9)
    other = loaded.replace("spring", length=fu.Ramp(start=1, end=2, before=0.7, after=3.0))
    with pytest.raises(fu.SceneError, match="is at t = 0 another than in the state to start from"):
        other.run(duration=0.1, initial=rest)
    run = loaded.run(duration=0.5, output_step=0.1, tol=1e-6, initial=rest)  # the signal begins at 1 s
    moved = run["mass.position"][:, 1] - run["mass.position"][0, 1]
    assert np.abs(moved).max() < 0.2


def test_refusals():
    with refused('spring "spring": length must not be negative, got -0.1 m, the least value of the signal'):
        hung(stiffness=1.0, length=fu.Ramp(start=0, end=1, before=1.0, after=-0.1))
    with refused('spring "spring": stiffness must not be negative, got -1 N/m, the least value of the signal'):
        hung(stiffness=fu.Harmonic(amplitude=2.0, frequency=1.0, offset=1.0), length=1.0)
    with refused('spring "spring": length must be a number or a signal such as Ramp(start=0, end=1), got \'long\''):
        hung(stiffness=1.0, length="long")
