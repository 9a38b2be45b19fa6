"""Scenes of linear models with closed forms, and their references."""

from __future__ import annotations

import funicular as fu
import numpy as np

G = 9.81


def cart_and_pendulum(push: object = 0.0, upright: bool = False, velocity: object = None) -> fu.Scene:
    """Return a cart of 2 kg along x with a pendulum of 0.7 kg, 0.03 kg m², 0.9 m; velocity: of the cart, prescribed."""
    scene, arm = fu.Scene(gravity=(0, -G, 0)), 0.9 if upright else -0.9
    scene.rigid_body("cart", mass=2.0, inertia=(1, 1, 1), position=(0, 0, 0))
    scene.rigid_body("load", mass=0.7, inertia=(0.03, 0.03, 0.03), position=(0, arm, 0))
    scene.joint("prismatic", (0, 0, 0), "cart", axis=(1, 0, 0), name="rail", velocity=velocity)
    scene.joint("revolute", ("cart", (0, 0, 0)), ("load", (0, -arm, 0)), axis=(0, 0, 1), name="hinge")
    scene.force(on="cart", value=(push, 0, 0), name="push")
    return scene


def crane() -> fu.Scene:
    """Return a trolley of 10 kg with a damper of 4 N s/m and a load of 20 kg, a point, on a massless 5 m."""
    scene = fu.Scene(gravity=(0, -G, 0))
    scene.rigid_body("trolley", mass=10.0, inertia=(1, 1, 1), position=(0, 0, 0))
    scene.rigid_body("load", mass=20.0, inertia=(1e-12, 1e-12, 1e-12), position=(0, -5, 0))
    scene.joint("prismatic", (0, 0, 0), "trolley", axis=(1, 0, 0), name="rail", friction=fu.Friction(viscous=4.0))
    scene.joint("revolute", ("trolley", (0, 0, 0)), ("load", (0, 5, 0)), axis=(0, 0, 1), name="hinge")
    scene.force(on="trolley", value=(0, 0, 0), name="push")
    return scene


def crane_reference(w: float) -> tuple[np.ndarray, complex]:
    """Return the eigenvalues of the crane, 0 without, and x/u at an angular frequency."""
    M, m, c, length = 10.0, 20.0, 4.0, 5.0
    roots = np.roots([M * length, c * length, (M + m) * G, c * G])
    s = 1j * w
    over = (length * s**2 + G) / (s * (M * length * s**3 + c * length * s**2 + (M + m) * G * s + c * G))
    return roots, complex(over)


def string(elements: int) -> fu.Scene:
    """Return a string of 1 m, 100 N, 0.01 kg/m, from a support to a ring on a rod across with a damper of 0.5 N s/m."""
    strain, EA, density = 1e-3, 1e5, 100.0
    length = 1 / (1 + strain)
    scene = fu.Scene(gravity=(0, 0, 0))
    area = 1e-2 / density / (length)
    scene.cable("wire", start=(0, 0, 0), end=(1, 0, 0), elements=elements, element="cable8p", strain="engineering",
                rest_length=length, section=fu.GeneralSection(area=area, second_moment_about_z=1e-18),
                material=fu.Material(youngs_modulus=EA / area, poisson_ratio=0, density=density))
    scene.pin("wire", s=0.0)
    scene.motion("wire", s=length, displacement=(0, None, None))
    scene.spring((1, 0, 0), ("wire", length), stiffness=0.0, damping=0.5, length=0.0, name="damper")
    return scene


def string_reference() -> np.ndarray:
    """Return the first two eigenvalues above the axis: exp(2 s L/c) = (d - Z)/(d + Z), Z = 1, d = 0.5 N s/m."""
    return 0.5 * 100.0 * (np.log(0.5 / 1.5) + 1j * np.pi * np.array([1, 3]))


def bead() -> fu.Scene:
    """Return a bead of 1 kg in the middle of a string of 2 m without mass, of springs with a tension of 100 N."""
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.rigid_body("bead", mass=1.0, inertia=(1, 1, 1), position=(0, 0, 0))
    for side in (-1, 1):
        scene.spring((side, 0, 0), "bead", stiffness=1e4, length=1 - 100 / 1e4)
    return scene
