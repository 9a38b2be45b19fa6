"""The sliding mass: a body on a pinned cable of the sizes of Table 1, released with 1 m/s (case S1 and its variants).
"""

from __future__ import annotations

from funicular import Material, Rectangle, Scene


def sliding_mass(elements=3, element="cable12", *, youngs_modulus=0.4e9, poisson_ratio=0.0, damping_time=0.0, mass=1.0,
                 **law) -> Scene:
    """The scene; law: strain or law of the cable."""
    scene = Scene()
    wire = scene.cable("wire", start=(0, 0, 0), end=(1.5, 0, 0), elements=elements, element=element,
                       section=Rectangle(height=0.05, width=0.05),
                       material=Material(youngs_modulus=youngs_modulus, poisson_ratio=poisson_ratio, density=4200,
                                         damping_time=damping_time), **law)
    scene.pin(wire, s=0.0)
    scene.pin(wire, s=1.5)
    scene.rigid_body("A", mass=mass, inertia=(1e-3, 1e-3, 1e-3), position=(0.25, 0, 0), velocity=(1, 0, 0))
    scene.slide("A", along=wire, s=0.25, name="trolley")
    return scene
