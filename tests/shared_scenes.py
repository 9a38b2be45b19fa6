"""Cables and riders that the physics tests share; sizes and material of the paper's Table 1 unless said."""

import numpy as np
from funicular import EndOfCableError, Material, Rectangle, Run, Scene

TABLE_1 = Material(youngs_modulus=0.4e9, poisson_ratio=0.0, density=4200)
SQUARE = Rectangle(height=0.05, width=0.05)


def add_cable(scene: Scene, name="wire", pins=(0, 1.5), *, start=(0, 0, 0), end=(1.5, 0, 0), elements=3, **given):
    given = {"section": SQUARE, "material": TABLE_1} | given
    cable = scene.cable(name, start=start, end=end, elements=elements, **given)
    for s in pins:
        scene.pin(cable, s=s)
    return cable


def add_rider(scene: Scene, s: float, speed: float, cable="wire", name="A", slide="trolley", across=(0, 0)):
    """A body of 1 kg, held at its centre of mass, on a cable that lies along x; ``across``: its velocity in y, z."""
    body = scene.rigid_body(
        name, mass=1.0, inertia=(1e-3, 1e-3, 1e-3), position=scene.cables[cable].point(s), velocity=(speed, *across)
    )
    return scene.slide(body, along=cable, s=s, name=slide)


def one_rider(s=0.25, speed=1.0, gravity=(0, -9.81, 0), *, across=(0, 0), **cable) -> Scene:
    """A cable with one rider: by default the first scene."""
    scene = Scene(gravity=gravity)
    add_cable(scene, **cable)
    add_rider(scene, s, speed, across=across)
    return scene


def to_the_end(scene: Scene, *args, **settings) -> tuple[Run, str]:
    """A run that must leave its cable, and what it says."""
    try:
        scene.run(*args, **settings)
    except EndOfCableError as stopped:
        return stopped.run, str(stopped)
    raise AssertionError("the slide was to run off its cable")


def largest(difference) -> float:
    return float(np.abs(difference).max())
