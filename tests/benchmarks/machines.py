"""Machines of the table in the guide (machines.md): the number of each by a formula by hand, beside ours.

    python tests/benchmarks/machines.py [--out FILE.csv]

A rope about to slide over a rough saddle; the pull of a line at -40, 0 and 40 K; the deflection under a load that walks
over a beam; the heave of a float; the acceleration of a load on a winch; the way of a car and of a wheel with brakes.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator

import funicular as fu
import numpy as np
from changing_loads import COEFFICIENT as RAIL_FRICTION
from changing_loads import PUBLISHED, SPEED, crossing, deflection, rail, speed_of
from changing_loads import L as SPAN
from table import arguments, few, show

G = 9.81
ROUGH = 0.3
"""Coefficient of friction of the saddle, and of the brake of the wheel."""
PULLS = {-40: 3624.711844, 0: 3456.022081, 40: 3302.255931}
"""Horizontal force by temperature, N: the elastic catenary of the grown stress-free length."""
WATER, FLOAT_MASS, FLOAT_HEIGHT, FLOAT_VOLUME = 1000.0, 120.0, 0.6, 0.3
LOAD, DRUM_RADIUS, DRUM_INERTIA, TORQUE = 50.0, 0.25, 2.0, 160.0
WHEEL_INERTIA, WHEEL_RATE, DISC_RADIUS, CLAMP = 0.5, 10.0, 0.2, 50.0
ROPE = {"section": fu.GeneralSection(area=1e-5, second_moment_about_y=1e-16, second_moment_about_z=1e-16),
        "material": fu.Material(youngs_modulus=1e11, poisson_ratio=0.3, density=80, damping_time=0.02)}
"""Flexible and light; its longitudinal vibration under the load is damped."""


def saddle() -> tuple[float, float]:
    """Return the tension on the side of the load over that on the other, as it is about to rise, and exp(μ π)."""
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.rigid_body("load", mass=LOAD, inertia=(1, 1, 1), position=(0.1, -2, 0))
    scene.force("load", value=(0, -LOAD * G, 0))
    held = fu.Sheave("saddle", at=(0, 0, 0), radius=0.1, side="right", friction=ROUGH)
    scene.rope("rope", route=[fu.Anchor(at=(-0.1, -2, 0)), held, fu.Anchor("load")], elements=1, tension=LOAD * G,
               **ROPE)
    rest = scene.equilibrium(impending="hoisting")
    return float(rest["saddle.tension_on"] / rest["saddle.tension_off"]), float(np.exp(ROUGH * np.pi))


def line(temperature: float) -> tuple[float, float]:
    """Return the horizontal force of a line of EA 1e6 N and 10 N/m whose length is its span, 100 m, and `PULLS`."""
    scene = fu.Scene(gravity=(0, -10, 0))
    scene.cable("line", start=(0, 0, 0), end=(100, 0, 0), elements=32, element="cable12", strain="engineering",
                membrane="assumed", temperature=temperature, rest_length=100.0,
                section=fu.GeneralSection(area=1e-3, second_moment_about_y=1e-14, second_moment_about_z=1e-14),
                material=fu.Material(youngs_modulus=1e9, poisson_ratio=0.3, density=1000, thermal_expansion=1.2e-5))
    scene.pin("line", s=0)
    scene.pin("line", s=100)
    return float(abs(scene.equilibrium()["line@0.force"][0])), PULLS[int(temperature)]


def walk(alpha: float = 0.25) -> tuple[float, float]:
    """Return the largest deflection of a beam under a force that crosses it, over the static one, and as published."""
    time = SPAN / speed_of(alpha)
    run = crossing(alpha).run(time, output_step=time / 2000, tol=1e-6, integrator="radau")
    return float(deflection(run).max()), PUBLISHED[alpha]


def heave() -> tuple[float, float]:
    """Return the period of an upright column that floats, and 2 π sqrt(m/(ρ g A)), s."""
    scene = fu.Scene(gravity=(0, -G, 0))
    scene.fluid("water", density=WATER, surface=0.0)
    scene.rigid_body("float", mass=FLOAT_MASS, inertia=(10, 10, 10), position=(0, 0.06, 0))
    scene.drag("float", volume=FLOAT_VOLUME, height=FLOAT_HEIGHT, area=0.0, coefficient=0.0)
    area = FLOAT_VOLUME / FLOAT_HEIGHT
    frequency = float(scene.modes(6, about=scene.equilibrium()).angular_frequency[-1])
    return 2 * np.pi / frequency, 2 * np.pi * np.sqrt(FLOAT_MASS / (WATER * G * area))


def winch() -> tuple[float, float]:
    """Return the acceleration of a load by a motor on a drum, and (T/R - m g)/(m + I/R²), m/s²."""
    scene = fu.Scene(gravity=(0, -G, 0))
    scene.rigid_body("load", mass=LOAD, inertia=(1, 1, 1), position=(DRUM_RADIUS, -5, 0))
    drum = fu.Drum("winch", at=(0, 0, 0), radius=DRUM_RADIUS, side="right", length_in_store=2.0, inertia=DRUM_INERTIA,
                   torque=TORQUE)
    scene.rope("rope", route=[drum, fu.Anchor("load")], elements=1, mass=False, tension=LOAD * G, **ROPE)
    run = scene.run(1.0, output_step=0.1, tol=1e-8, integrator="radau")
    closed = (TORQUE / DRUM_RADIUS - LOAD * G) / (LOAD + DRUM_INERTIA / DRUM_RADIUS**2)
    return float(run["load.velocity"][-1, 1] - run["load.velocity"][5, 1]) / 0.5, closed


def car() -> tuple[float, float]:
    """Return the way of a car on a rail until its brake has stopped it, and v²/(2 μ g), m."""
    friction = fu.Friction(coefficient=RAIL_FRICTION, model="stick")
    run = rail(friction).run(2.4, output_step=0.1, integrator="radau", tol=1e-8)
    return float(run["wheels.s"][-1] - run["wheels.s"][0]), SPEED**2 / (2 * RAIL_FRICTION * G)


def wheel() -> tuple[float, float]:
    """Return the angle of a wheel until the brake on its joint has stopped it, and I ω²/(2 μ N r), rad."""
    scene = fu.Scene(gravity=(0, -G, 0))
    scene.rigid_body("wheel", mass=3.0, inertia=(0.3, 0.3, WHEEL_INERTIA), position=(0, 0, 0),
                     angular_velocity=(0, 0, WHEEL_RATE))
    scene.joint("revolute", (0, 0, 0), "wheel", axis=(0, 0, 1), radius=DISC_RADIUS, normal_force=CLAMP,
                friction=fu.Friction(coefficient=ROUGH, model="stick"))
    torque = ROUGH * CLAMP * DISC_RADIUS
    stop = WHEEL_INERTIA * WHEEL_RATE / torque
    run = scene.run(1.1 * stop, output_step=stop / 500, integrator="radau", tol=1e-8)
    angle = float(np.trapezoid(run["wheel.angular_velocity"][:, 2], run.time))
    return angle, WHEEL_INERTIA * WHEEL_RATE**2 / (2 * torque)


MACHINES = {"saddle: ratio of tensions": saddle, "line at -40 K: pull, N": lambda: line(-40),
            "line at 0 K: pull, N": lambda: line(0), "line at 40 K: pull, N": lambda: line(40),
            "walking load: largest deflection over the static one": walk, "float: period of heave, s": heave,
            "winch: acceleration of the load, m/s²": winch, "brake of a slide: way, m": car,
            "brake of a joint: angle, rad": wheel}
"""Ours and the formula's, by machine."""


def rows() -> Iterator[dict]:
    """Yield the rows of the table."""
    for name, of in few(MACHINES.items()):
        found, closed = of()
        yield {"machine": name, "funicular": f"{found:.8g}", "formula": f"{closed:.8g}", "off": found / closed - 1}


def main() -> None:
    """Print the table."""
    options = arguments(__doc__)
    warnings.simplefilter("ignore", fu.FunicularWarning)
    show(list(rows()), options.out)


if __name__ == "__main__":
    main()
