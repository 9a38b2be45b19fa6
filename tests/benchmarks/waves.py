"""Linear waves and Morison's equation beside closed forms and another program.

    python tests/benchmarks/waves.py [--out FILE.csv]

Rows: the force of waves on a vertical pile, its inertia and its drag (Morison's equation over the depth in closed form,
small waves), and to the surface of waves of 2 m by quadrature of the same kinematics with Wheeler's rule; the response
of a buoy in regular waves (linear oscillator); a heaving lazy-wave cable with Morison's added mass (another program);
the variance of the elevation of a sea by JONSWAP's spectrum. CPU in s.
"""

from __future__ import annotations

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import time
import warnings
from collections.abc import Callable

import funicular as fu
import numpy as np
from lazy_wave import DURATION, MESH, OUTPUT, PERIOD, heave, period
from scipy.integrate import quad
from slack_lines import LAZY_WAVES, lazy_wave
from table import arguments, show

G, WATER = 9.81, 1025.0
DEPTH, DIAMETER, WAVE_PERIOD = 20.0, 0.1, 8.0
C_DRAG, C_ADDED = 1.0, 1.0
MORISON = 9336.88, 5655.2, 13084.4
"""Mean, minimum and maximum of the tension of the heaving cable with Morison's added mass by another program, N."""


def number(period: float, depth: float) -> float:
    """Return k of omega² = g k tanh(k depth), 1/m, by fixed-point iteration."""
    omega = 2 * np.pi / period
    k = omega**2 / G
    for _ in range(500):
        k = 0.5 * (k + omega**2 / (G * np.tanh(k * depth)))
    return float(k)


def pile(amplitude: float, drag: float, form: str = "morison", phase: float = 0.0, elements: int = 16
         ) -> fu.Scene:
    """Return a vertical pile, clamped at all of its nodes, in a regular wave along x."""
    scene = fu.Scene(gravity=(0, -G, 0))
    scene.cable("pile", start=(0, -DEPTH, 0), end=(0, 4, 0), elements=elements, element="cable8p",
                section=fu.Circle(radius=DIAMETER / 2),
                material=fu.Material(youngs_modulus=1e12, poisson_ratio=0.0, density=7800))
    for s in np.linspace(0.0, DEPTH + 4, elements + 1).tolist():
        scene.clamp("pile", s=s)
    scene.fluid("sea", density=WATER, surface=0.0, depth=DEPTH,
                waves=[fu.Wave(amplitude=amplitude, period=WAVE_PERIOD, phase=phase)])
    scene.drag("pile", normal=drag, added_mass=C_ADDED, added_mass_form=form)
    return scene


def force_on_pile(scene: fu.Scene) -> float:
    """Return the force along x at t = 0, N."""
    return float(scene.run(duration=1e-3, step=1e-3, output_step=1e-3, integrator="radau")["drag_1.force"][0, 0])


def inertia_of_pile(amplitude: float) -> float:
    """Return the largest inertial force up to the still level, C_M rho A g a tanh kd, N."""
    k = number(WAVE_PERIOD, DEPTH)
    return (1 + C_ADDED) * WATER * np.pi / 4 * DIAMETER**2 * G * amplitude * np.tanh(k * DEPTH)


def drag_of_pile(amplitude: float) -> float:
    """Return the largest drag up to the still level, N."""
    k, omega = number(WAVE_PERIOD, DEPTH), 2 * np.pi / WAVE_PERIOD
    integral = (np.sinh(2 * k * DEPTH) / (4 * k) + DEPTH / 2) / np.sinh(k * DEPTH) ** 2
    return float(WATER / 2 * DIAMETER * C_DRAG * (amplitude * omega) ** 2 * integral)


def to_the_surface(amplitude: float, phase: float) -> float:
    """Return the force of Morison's equation at x = 0, t = 0 up to the elevation, by quadrature, N."""
    k, omega, step = number(WAVE_PERIOD, DEPTH), 2 * np.pi / WAVE_PERIOD, 1e-5

    def velocity(t: float, x: float, z: float) -> np.ndarray:
        theta = k * x - omega * t + phase
        eta = amplitude * np.cos(theta)
        at = (z - eta) / (1 + eta / DEPTH)
        scale = amplitude * omega / np.sinh(k * DEPTH)
        return np.array([scale * np.cosh(k * (at + DEPTH)) * np.cos(theta),
                         scale * np.sinh(k * (at + DEPTH)) * np.sin(theta)])

    def density(z: float) -> float:
        u = velocity(0, 0, z)
        along = step * np.array([1.0, *u])  # a particle's path: its velocity changes by DU/Dt
        before, after = (velocity(*(sign * along + (0, 0, z))) for sign in (-1, 1))
        return (WATER / 2 * DIAMETER * C_DRAG * abs(u[0]) * u[0]
                + (1 + C_ADDED) * WATER * np.pi / 4 * DIAMETER**2 * (after - before)[0] / (2 * step))

    top = amplitude * np.cos(phase)
    return float(quad(density, -DEPTH, top, epsabs=1e-6, epsrel=1e-9, limit=200)[0])


BUOY_PERIOD, RADIUS, HEIGHT, MASS = 4.0, 0.5, 2.0, 1200.0
"""Of an upright column in waves: s, m, m, kg."""


def buoy(amplitude: float, start: complex = 0.0) -> fu.Scene:
    """Return a buoy that heaves in a regular wave; start: complex amplitude of its motion."""
    scene = fu.Scene(gravity=(0, -G, 0))
    scene.fluid("sea", density=WATER, surface=0.0, waves=[fu.Wave(amplitude=amplitude, period=BUOY_PERIOD)])
    omega = 2 * np.pi / BUOY_PERIOD
    scene.rigid_body("buoy", mass=MASS, inertia=(1e5, 1e5, 1e5), position=(0, centre() + start.real, 0),
                     velocity=(0, omega * start.imag, 0))
    scene.joint("prismatic", (0, 0, 0), "buoy", axis=(0, 1, 0))
    scene.drag("buoy", volume=np.pi * RADIUS**2 * HEIGHT, height=HEIGHT, added_mass=0.3)
    return scene


def centre() -> float:
    """Return the height of the middle of the buoy at rest, m."""
    return HEIGHT / 2 - MASS / (WATER * np.pi * RADIUS**2)


def response(amplitude: float) -> float:
    """Return the amplitude of the buoy's heave in long-crested waves by the linear oscillator, m.

    (m + C m_w) z'' + rho g A z = rho g A eta + (1 + C) m_w dw/dt with the mass m_w of the displaced water, and the
    acceleration of the water at the middle of the buoy.
    """
    omega = 2 * np.pi / BUOY_PERIOD
    waterplane = WATER * G * np.pi * RADIUS**2
    decay = np.exp(omega**2 / G * centre())
    return float(amplitude * (waterplane - 1.3 * MASS * omega**2 * decay)
                 / (waterplane - (MASS + 0.3 * MASS) * omega**2))


def heave_of_buoy(amplitude: float) -> tuple[float, float]:
    """Return the amplitude of the fundamental of the buoy's heave over two periods, and that of the oscillator, m."""
    linear = response(amplitude)
    run = buoy(amplitude, complex(linear)).run(duration=2 * BUOY_PERIOD, tol=1e-9, integrator="radau",
                                               output_step=BUOY_PERIOD / 32)
    z, t = run["buoy.position"][:-1, 1], run.time[:-1]
    return float(2 * np.mean(z * np.cos(2 * np.pi * t / BUOY_PERIOD))), linear


def heaving_cable() -> list[tuple[float, float]]:
    """Return mean, minimum and maximum of the tension in the last period, and those of another program, N."""
    scene = lazy_wave(LAZY_WAVES["80 m"], MESH, added_mass=1.0, heave=heave(), added_mass_form="morison")
    run = scene.run(duration=DURATION, output_step=OUTPUT, initial=scene.equilibrium(), integrator="radau", tol=1e-3,
                    progress=False)
    tension = np.linalg.norm(run["upper@0.force"], axis=1)[round((DURATION - PERIOD) / OUTPUT):]
    return list(zip(period(tension).tolist(), MORISON, strict=True))


def variance_of_sea(components: int) -> tuple[float, float]:
    """Return the variance of the elevation over six hours, and Hs²/16, m²."""
    sea = fu.Fluid(density=WATER, surface=0.0, waves=fu.jonswap(significant_height=3.0, peak_period=9.0,
                                                               components=components, seed=7))
    elevation = sea.elevation(np.arange(0, 6 * 3600, 0.5), np.zeros(3))
    return float(np.var(elevation)), 9 / 16


def main() -> None:
    """Print the table."""
    given = arguments(__doc__, elements=(16, "elements of the pile"))
    warnings.simplefilter("ignore", fu.FunicularWarning)
    rows: list[dict] = []

    def add(case: str, of: Callable[[], tuple | list], *labels: str) -> None:
        begin = time.process_time()
        found = of()
        cpu = time.process_time() - begin
        values = found if isinstance(found, list) else [found]
        rows.extend({"case": f"{case}{label}", "funicular": f"{value:.8g}", "reference": f"{reference:.8g}",
                     "off": value / reference - 1, "CPU, s": cpu}
                    for label, (value, reference) in zip(labels or ("",), values, strict=True))

    small = 1e-3
    add("pile, wave of 2 mm: inertia, N", lambda: (force_on_pile(pile(
        small, 0.0, phase=-np.pi / 2, elements=given.elements)), -inertia_of_pile(small)))
    add("pile, wave of 2 mm: drag, N", lambda: (force_on_pile(pile(
        small, C_DRAG, elements=given.elements)), drag_of_pile(small)))
    for phase in (0.0, -0.7):
        add(f"pile, wave of 2 m, phase {phase}: force, N", lambda phase=phase: (
            force_on_pile(pile(1.0, C_DRAG, phase=phase, elements=given.elements)), to_the_surface(1.0, phase)))
    for amplitude in (0.04, 0.02, 0.01):
        add(f"buoy in waves of {amplitude} m: heave, m", lambda amplitude=amplitude: heave_of_buoy(amplitude))
    add("heaving lazy wave: tension, ", heaving_cable, *(f"{of}, N" for of in ("mean", "minimum", "maximum")))
    for components in (50, 200):
        add(f"JONSWAP, {components} waves: variance, m²", lambda components=components: variance_of_sea(components))
    show(rows, given.out)


if __name__ == "__main__":
    main()
