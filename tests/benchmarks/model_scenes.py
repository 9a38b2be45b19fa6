"""Scenes for measuring the choice of a model by tests/benchmarks/model_choice.py: name, scene, duration in s.

The drawn models of their cables (element, law, number of elements) are a start; the choice is free in all of them.
"""

from __future__ import annotations

import funicular as fu
import numpy as np
from choice_scenes import Subject, mooring, rider, spin_up, taut
from hard_cases import cables
from pendulum import pendulum


def crane() -> fu.Scene:
    """A trolley accelerates along the girder of a crane, a load swings below it (guide crane.py)."""
    scene = fu.Scene()
    scene.cable("girder", start=(0, 0, 0), end=(20, 0, 0), elements=8, element="cable8p",
                section=fu.GeneralSection(area=0.05, second_moment_about_z=5e-3),
                material=fu.Material(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7850, damping_time=5e-4))
    scene.pin("girder", s=0.0)
    scene.motion("girder", s=20.0, displacement=("free", 0, 0))
    scene.rigid_body("trolley", mass=2000, inertia=(500, 500, 500), position=(3, 0, 0))
    scene.rigid_body("load", mass=8000, inertia=(4000, 4000, 4000), position=(3, -6, 0))
    scene.joint("distance", "trolley", "load", name="rope")
    scene.slide("trolley", along="girder", s=3.0, name="drive", frame="tangent",
                velocity=fu.TableSignal(time=[0, 1.5, 60], value=[0, 1.5, 1.5], interpolation="linear"))
    return scene


def robot() -> fu.Scene:
    """A camera hangs from three ropes whose upper ends are moved up and down (guide cable_robot.py), in space."""
    scene = fu.Scene()
    scene.rigid_body("camera", mass=60.0, inertia=(1, 1, 1), position=(0, 2, 0))
    for k, angle in enumerate(np.radians([90, 210, 330])):
        at = (5 * np.cos(angle), 2 + np.sqrt(39.0), 5 * np.sin(angle))
        name = f"cable_{k}"
        scene.cable(name, start=at, end=(0, 2, 0), elements=4, element="cable12", strain="engineering",
                    section=fu.GeneralSection(area=1.3e-5, second_moment_about_z=2e-12),
                    material=fu.Material(youngs_modulus=2e10, poisson_ratio=0.3, density=4000, damping_time=2e-3))
        scene.motion(name, s=0.0, displacement=(0, fu.Ramp(start=0.0, end=0.4, after=(0.1, -0.06, 0.04)[k]), 0))
        scene.joint("spherical", (name, 8.0), "camera", name=f"eye_{k}")
    return scene


def slackline() -> fu.Scene:
    """A person jumps off the middle of a slackline (guide slackline.py)."""
    scene = fu.Scene()
    rest_length = 25.0 / (1 + 2000.0 / (1.2e9 * 6.25e-5))
    scene.cable("line", start=(0, 1, 0), end=(25, 1, 0), rest_length=rest_length, elements=20, element="cable12",
                section=fu.GeneralSection(area=6.25e-5, second_moment_about_z=3e-11),
                material=fu.Material(youngs_modulus=1.2e9, poisson_ratio=0.3, density=1100, damping_time=2e-3))
    scene.pin("line", s=0.0)
    scene.pin("line", s=rest_length)
    scene.force("line", s=rest_length / 2, value=(0, -75 * 9.81, 0),
                scale=fu.Ramp(start=0, end=0.02, before=1, after=0))
    return scene


def rubber_pendulum() -> fu.Scene:
    """A rubber rod let go from the horizontal (case D1)."""
    scene = fu.Scene()
    scene.cable("rod", start=(0, 0, 0), end=(1, 0, 0), elements=8, element="cable12", section=fu.Circle(radius=5e-3),
                material=fu.Material(youngs_modulus=5e6, poisson_ratio=0.45, density=1100))
    scene.pin("rod", s=0.0)
    return scene


def shaken() -> fu.Scene:
    """A cable hangs from a support that moves aside and back, with a body at its lower end."""
    scene = fu.Scene()
    scene.cable("rope", start=(0, 0, 0), end=(0, -1, 0), elements=6, element="cable12", section=fu.Circle(radius=5e-3),
                material=fu.Material(youngs_modulus=5e7, poisson_ratio=0.3, density=1100, damping_time=1e-3),
                up=(1, 0, 0))
    scene.motion("rope", s=0.0, displacement=(fu.Pulse(start=0.0, end=0.6, rise=0.25, height=0.1), 0, 0))
    scene.rigid_body("A", mass=0.3, inertia=(1e-4,) * 3, position=(0, -1, 0))
    scene.joint("spherical", ("rope", 1.0), "A", name="hook")
    return scene


def stout() -> fu.Scene:
    """A stout cantilever of rubber under a force that rises within 0.05 s: it shears as much as it bends."""
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.cable("beam", start=(0, 0, 0), end=(2, 0, 0), elements=4, element="beam12p", law="structural",
                section=fu.Rectangle(height=0.5, width=0.1),
                material=fu.Material(youngs_modulus=2.07e8, poisson_ratio=0.3, density=1000, damping_time=1e-4))
    scene.clamp("beam", s=0.0)
    scene.force("beam", s=2.0, value=(0, -6.25e3, 0), scale=fu.Ramp(start=0.0, end=0.05))
    return scene


def crossing_force() -> fu.Scene:
    """A heavy mass crosses a beam at half of the critical speed (case M2), pushed by its weight alone."""
    scene = fu.Scene(gravity=(0, -9.81, 0))
    scene.cable("beam", start=(0, 0, 0), end=(10, 0, 0), elements=8, element="cable8p",
                section=fu.Rectangle(height=0.2, width=0.1),
                material=fu.Material(youngs_modulus=2e10, poisson_ratio=0.3, density=2500))
    scene.pin("beam", s=0.0)
    scene.motion("beam", s=10.0, displacement=("free", 0, 0))
    scene.rigid_body("A", mass=250.0, inertia=(1, 1, 1), position=(1.0, 0, 0), velocity=(20, 0, 0))
    scene.slide("A", along="beam", s=1.0, name="wheel")
    return scene


def princeton() -> fu.Scene:
    """The blade of the Princeton experiment (case B6) under a force at 45 degrees: bending and torsion."""
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.cable("blade", start=(0, 0, 0), end=(0.508, 0, 0), elements=4, element="beam24", law="structural",
                section=fu.Rectangle(height=12.3777e-3, width=3.2024e-3),
                material=fu.Material(youngs_modulus=71.7e9, poisson_ratio=0.31, density=2700, damping_time=1e-4))
    scene.clamp("blade", s=0.0)
    scene.force("blade", s=0.508, value=(0, -6.29, 6.29), scale=fu.Ramp(start=0.0, end=0.05))
    return scene


SCENES = {
    "first scene": Subject(lambda: fu.load_scene("paper51"), 0.5),
    "rigid link": Subject(lambda: fu.load_scene("paper52_rigid"), 0.6),
    "modal link": Subject(lambda: fu.load_scene("paper52_modal"), 0.4),
    "flexible link": Subject(lambda: fu.load_scene("paper52_ancf"), 0.3),
    "cable car": Subject(lambda: fu.load_scene("cable_car"), 2.0, "equilibrium"),
    "crane": Subject(crane, 2.0, "equilibrium"),
    "zip line": Subject(lambda: fu.load_scene("zip_line"), 0.5),
    "cable robot": Subject(robot, 0.4, "equilibrium"),
    "slackline": Subject(slackline, 0.6, "equilibrium"),
    "pendulum, E 2e6": Subject(lambda: pendulum(8, 2e6, 7200), 0.5),
    "pendulum, E 7e8": Subject(lambda: pendulum(8, 7e8, 7200), 0.3),
    "rubber pendulum": Subject(rubber_pendulum, 0.4),
    "spin-up": Subject(spin_up, 2.0),
    "rider on a soft rope": Subject(rider, 0.4),
    "taut cable, rider": Subject(lambda: taut(speed=15.0), 0.6),
    "shaken support": Subject(shaken, 1.0),
    "stout cantilever": Subject(stout, 0.1),
    "mass crosses a beam": Subject(crossing_force, 0.3),
    "Princeton blade": Subject(princeton, 0.1),
    "chain let go": Subject(mooring, 0.4),
    "steel and rubber": Subject(cables.steel_and_rubber, 0.4),
}
