"""Scenes on which tests/benchmarks/choice.py measures ``tol``: name, scene, duration in s.

The durations are short, so that neighbouring motions stay close: in a sensitive scene (a whip that cracks, a cable that
snaps taut) errors grow with any integrator, and a longer run would have no converged reference.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import funicular as fu
import numpy as np
from hard_cases import cables, crossings
from pendulum import pendulum
from sliding import sliding_mass


@dataclass(frozen=True)
class Subject:
    """A scene, made anew for each run, its duration in s, and further settings of its runs."""

    make: Callable[[], fu.Scene]
    duration: float
    initial: str = "drawn"


def rider() -> fu.Scene:
    """A body that rotates and slides over nodes of a soft, damped rope."""
    scene = fu.Scene()
    scene.cable("rope", start=(0, 0, 0), end=(10, 0, 0), elements=6, element="cable12",
                section=fu.Rectangle(height=0.05, width=0.05),
                material=fu.Material(youngs_modulus=2e6, poisson_ratio=0.0, density=1000, damping_time=1e-3))
    scene.pin("rope", s=0.0)
    scene.pin("rope", s=10.0)
    scene.rigid_body("A", mass=5, inertia=(0.1, 0.2, 0.3), position=(2, -0.3, 0.1), velocity=(4, 0, 0),
                     angular_velocity=(1, 2, 3))
    scene.slide("A", along="rope", s=2.0, at=(0, 0.3, -0.1), name="trolley")
    return scene


def heavy_top() -> fu.Scene:
    """The top of Geradin & Cardona (2001) and Bruels & Cardona (2010): 150 rad/s about its axis, foot on a joint."""
    scene = fu.Scene(gravity=(0, 0, -9.81))
    velocity = np.cross((0, 150, -4.61538), (0, 1, 0))
    scene.rigid_body("top", mass=15.0, inertia=(0.234375, 0.46875, 0.234375), position=(0, 1, 0),
                     velocity=tuple(velocity), angular_velocity=(0, 150, -4.61538))
    scene.joint("spherical", ("top", (0, -1, 0)), (0, 0, 0), name="foot")
    return scene


def top_on_a_spring() -> fu.Scene:
    """The same, its foot tied to the ground by a stiff spring."""
    scene = fu.Scene(gravity=(0, 0, -9.81))
    scene.rigid_body("top", mass=15.0, inertia=(0.234375, 0.46875, 0.234375), position=(0, 1, 0),
                     velocity=tuple(np.cross((0, 150, -4.61538), (0, 1, 0))), angular_velocity=(0, 150, -4.61538))
    scene.spring(("top", (0, -1, 0)), (0, 0, 15 * 9.81 / 1e6), stiffness=1e6, length=0.0)
    return scene


def double_pendulum() -> fu.Scene:
    """Two rods on hinges that are not parallel."""
    scene = fu.Scene()
    scene.rigid_body("upper", mass=2.0, inertia=(0.17, 0.001, 0.17), position=(0, -0.5, 0), angular_velocity=(0, 0, 4))
    scene.rigid_body("lower", mass=1.0, inertia=(0.08, 0.001, 0.08), position=(0, -1.5, 0), velocity=(6.0, 0, 0),
                     angular_velocity=(0, 0, 4))
    scene.joint("revolute", ("upper", (0, 0.5, 0)), (0, 0, 0), axis=(0, 0, 1), name="top")
    scene.joint("universal", ("upper", (0, -0.5, 0)), ("lower", (0, 0.5, 0)), axis=(1, 0, 0),
                second_axis=(0, 0, 1), name="knee")
    return scene


def taut(load: float = 0.0, speed: float = 0.0) -> fu.Scene:
    """A steel rope of 12 mm over 50 m under 28 kN, drawn straight; a weight at a third of it, or a rider."""
    scene = fu.Scene()
    scene.cable("rope", start=(0, 0, 0), end=(50, 0, 0), rest_length=49.8, elements=12, element="cable12",
                section=fu.GeneralSection(area=7.2e-5, second_moment_about_z=1e-10),
                material=fu.Material(youngs_modulus=1e11, poisson_ratio=0.3, density=8600))
    scene.pin("rope", s=0.0)
    scene.pin("rope", s=49.8)
    if load:
        scene.force("rope", s=16.6, value=(0, -load, 0), scale=fu.Pulse(start=0.0, end=0.05))
    if speed:
        scene.rigid_body("A", mass=20.0, inertia=(0.5, 0.5, 0.5), position=(5.0, 0, 0), velocity=(speed, 0, 0))
        scene.slide("A", along="rope", s=4.98, name="trolley")
    return scene


def faster_than_waves() -> fu.Scene:
    """A rider at twice the wave speed of a taut rope (hard_cases/riders.py)."""
    area = np.pi * 5e-3**2
    c = np.sqrt(0.05 * 0.4e9 * area / (4200 * area / 1.05))
    scene = crossings.pinned_rope(gravity=(0, 0, 0), elements=12, rest_length=1.5 / 1.05,
                                  section=fu.Circle(radius=5e-3))
    crossings.ride(scene, 0.03, 2.02 * c)
    scene.force("A", value=(0, -50, 0))
    return scene


WAVE = np.sqrt(0.05 * 0.4e9 * 1.05 / 4200)
"""Speed of transverse waves there, m/s."""


def rubbing(model: str, coefficient: float = 0.2, damping_time: float = 1e-4) -> fu.Scene:
    """Friction on a flexible beam: the normal force vibrates with it."""
    scene = fu.Scene()
    scene.cable("wire", start=(0, 0, 0), end=(1.5, 0, 0), elements=3, section=fu.Rectangle(height=0.05, width=0.05),
                material=fu.Material(youngs_modulus=4e8, poisson_ratio=0.0, density=4200, damping_time=damping_time))
    scene.pin("wire", s=0.0)
    scene.pin("wire", s=1.5)
    scene.rigid_body("A", mass=1.0, inertia=(1e-3,) * 3, position=(0.25, 0, 0), velocity=(1.5, 0, 0))
    scene.slide("A", along="wire", s=0.25, name="trolley",
                friction=fu.Friction(coefficient=coefficient, model=model))
    return scene


def sticking() -> fu.Scene:
    """A block on a soft cable is pulled to and fro: it sticks and slips."""
    scene = fu.Scene()
    scene.cable("wire", start=(0, 0, 0), end=(2, 0, 0), elements=4, element="cable12",
                section=fu.Rectangle(height=0.03, width=0.03),
                material=fu.Material(youngs_modulus=2e8, poisson_ratio=0.0, density=2000, damping_time=1e-3))
    scene.clamp("wire", s=0.0)
    scene.clamp("wire", s=2.0)
    scene.rigid_body("A", mass=2.0, inertia=(1e-2,) * 3, position=(0.8, 0, 0))
    scene.slide("A", along="wire", s=0.8, name="block",
                friction=fu.Friction(coefficient=0.3, static_coefficient=0.45, model="stick"))
    scene.force("A", value=(20, 0, 0), scale=fu.Harmonic(amplitude=1.0, frequency=2.0))
    return scene


def stopping(stop) -> fu.Scene:
    """A rider reaches the stop at the end of a soft rope."""
    scene = fu.Scene()
    scene.cable("rope", start=(0, 0, 0), end=(2, 0, 0), elements=4, element="cable12",
                section=fu.Circle(radius=0.01), rest_length=1.98,
                material=fu.Material(youngs_modulus=1e8, poisson_ratio=0.0, density=1000))
    scene.pin("rope", s=0.0)
    scene.pin("rope", s=1.98)
    scene.rigid_body("A", mass=0.5, inertia=(1e-3,) * 3, position=(1.4, 0, 0), velocity=(3, 0, 0))
    scene.slide("A", along="rope", s=1.386, name="trolley", at_end=stop)
    return scene


def shaken() -> fu.Scene:
    """A cable hangs from a vibrating support, with a body at its lower end."""
    scene = fu.Scene()
    scene.cable("rope", start=(0, 0, 0), end=(0, -1, 0), elements=6, element="cable12", section=fu.Circle(radius=5e-3),
                material=fu.Material(youngs_modulus=5e7, poisson_ratio=0.3, density=1100), up=(1, 0, 0))
    scene.motion("rope", s=0.0, displacement=(fu.Harmonic(amplitude=0.05, frequency=3.0), 0, 0))
    scene.rigid_body("A", mass=0.3, inertia=(1e-4,) * 3, position=(0, -1, 0))
    scene.joint("spherical", ("rope", 1.0), "A", name="hook")
    return scene


def cantilever() -> fu.Scene:
    """A shear-deformable beam under a follower force at its end."""
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.cable("beam", start=(0, 0, 0), end=(1, 0, 0), elements=4, element="beam24", law="structural",
                section=fu.Rectangle(height=0.02, width=0.03),
                material=fu.Material(youngs_modulus=1e9, poisson_ratio=0.3, density=2000))
    scene.clamp("beam", s=0.0)
    scene.force("beam", s=1.0, value=(0, 30, 5), follower=True)
    return scene


def spin_up() -> fu.Scene:
    """A beam turned about its end up to 6 rad/s within 3 s (case D3 of published, five times as fast)."""
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.cable("beam", start=(0, 0, 0), end=(10, 0, 0), elements=4, element="cable8p",
                section=fu.GeneralSection(area=1e-3, second_moment_about_z=5e-7),
                material=fu.Material(youngs_modulus=2.8e10, poisson_ratio=0.0, density=1200))
    time = np.linspace(0, 3, 31)
    angle = fu.TableSignal(time=tuple(time), value=tuple(time**2 * (3 - time / 3) / 3))
    scene.motion("beam", s=0.0, rotation=((0, 0, 1), angle))
    return scene


def drawn_along() -> fu.Scene:
    """A slide is driven along a soft cable, with a pendulum on a hinge."""
    scene = fu.Scene()
    scene.cable("wire", start=(0, 0, 0), end=(3, 0, 0), elements=6, element="cable12",
                section=fu.Circle(radius=0.02), rest_length=2.98,
                material=fu.Material(youngs_modulus=2e8, poisson_ratio=0.0, density=1000, damping_time=1e-3))
    scene.pin("wire", s=0.0)
    scene.pin("wire", s=2.98)
    scene.rigid_body("carriage", mass=1.0, inertia=(1e-2,) * 3, position=(0.5, 0, 0))
    scene.rigid_body("load", mass=3.0, inertia=(0.1, 0.02, 0.1), position=(0.5, -0.5, 0))
    scene.slide("carriage", along="wire", s=0.5 * 2.98 / 3, frame="tangent",
                velocity=fu.TableSignal(time=(0, 0.3, 2), value=(0, 2, 2), interpolation="linear"), name="drive")
    scene.joint("revolute", "carriage", ("load", (0, 0.5, 0)), axis=(0, 0, 1), name="hinge")
    return scene


def mooring() -> fu.Scene:
    """A stiff chain, drawn slack as a catenary, is released with a buoy on it."""
    scene = fu.Scene()
    scene.cable("chain", curve=lambda u: (4 * u, -1.5 * np.sin(np.pi * u), 0), rest="straight", elements=10,
                element="cable8p", section=fu.Circle(radius=0.01),
                material=fu.Material(youngs_modulus=1e10, poisson_ratio=0.3, density=7850))
    scene.pin("chain", s=0.0)
    scene.pin("chain", s=scene.cables["chain"].length)
    return scene


SCENES = {
    "pendulum, 8, E 2e6": Subject(lambda: pendulum(8, 2e6, 1000), 0.3),
    "pendulum, 32, E 2e6": Subject(lambda: pendulum(32, 2e6, 1000), 0.3),
    "pendulum, 8, E 7e8": Subject(lambda: pendulum(8, 7e8, 1000), 0.1),
    "pendulum, 8, steel": Subject(lambda: pendulum(8, 2.1e11, 1000), 0.05),
    "rider on a soft rope": Subject(rider, 1.0),
    "first scene": Subject(lambda: fu.load_scene("paper51"), 0.3),
    "sliding mass on cable12": Subject(lambda: sliding_mass(6), 0.5),
    "heavy top, 150 rad/s": Subject(heavy_top, 0.5),
    "heavy top on a spring": Subject(top_on_a_spring, 0.3),
    "double pendulum": Subject(double_pendulum, 1.0),
    "rigid link": Subject(lambda: fu.load_scene("paper52_rigid"), 0.6),
    "flexible link": Subject(lambda: fu.load_scene("paper52_ancf"), 0.3),
    "modal link": Subject(lambda: fu.load_scene("paper52_modal"), 0.4),
    "taut cable": Subject(taut, 0.3),
    "taut cable, struck": Subject(lambda: taut(load=500.0), 0.5),
    "taut cable, rider": Subject(lambda: taut(speed=15.0), 0.6),
    "rider at twice the wave speed": Subject(faster_than_waves, 0.6 / WAVE),
    "buckling": Subject(cables.buckling, 0.3),
    "slack goes taut": Subject(cables.slack, 0.3),
    "steel and rubber": Subject(cables.steel_and_rubber, 0.4),
    "free fall": Subject(cables.falling, 0.5),
    "whip": Subject(cables.whip, 0.35),
    "friction, vibrating": Subject(lambda: rubbing("regularised"), 0.4),
    "friction, undamped": Subject(lambda: rubbing("regularised", 0.4, 0.0), 0.2),
    "friction that stops": Subject(lambda: rubbing("stick", 0.5), 0.4),
    "stick": Subject(sticking, 0.8),
    "hard stop": Subject(lambda: stopping(fu.HardStop(restitution=0.5)), 0.4),
    "buffer": Subject(lambda: stopping(fu.Buffer(length=0.2, stiffness=2000.0, damping=10.0)), 0.4),
    "shaken support": Subject(shaken, 1.0),
    "follower force": Subject(cantilever, 0.2),
    "spin-up": Subject(spin_up, 2.0),
    "driven slide": Subject(drawn_along, 0.6),
    "chain let go": Subject(mooring, 0.4),
    "zip line": Subject(lambda: fu.load_scene("zip_line"), 1.0),
    "cable car": Subject(lambda: fu.load_scene("cable_car"), 2.0, "equilibrium"),
    "two riders": Subject(lambda: crossings.two((0.3, 2.0), (0.45, 0.5)), 0.3),
}
