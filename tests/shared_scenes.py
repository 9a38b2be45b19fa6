"""Small scenes that tests share: a straight cable and its riders; sizes and material of Table 1 by default."""

import numpy as np
from funicular import Material, Rectangle, Scene, TensionTable
from funicular.parts.paths import Variants, path_of
from funicular.parts.section import Section

TABLE_1 = Material(youngs_modulus=0.4e9, poisson_ratio=0.0, density=4200)
SQUARE = Rectangle(height=0.05, width=0.05)

G, MASS, LENGTH, SLOPE = 9.81, 2.0, 4.0, 0.5
"""Gravity, mass of the block, length of the heavy wire and its slope: m/s², kg, m, rad."""

CABLE = """
[[cable]]
name = "wire"
start = [0, 0, 0]
end = [1.5, 0, 0]
elements = 3
section = { shape = "rectangle", height = 0.05, width = 0.05 }
material = { youngs_modulus = 0.4e9, shear_modulus = 0.2e9, density = 4200 }
"""
"""The cable of Table 1 in a scene file, with a shear modulus in the place of Poisson's ratio."""


def changed(scene: Scene, values: dict) -> Scene:
    """Return a scene with other values, by path."""
    paths = {path_of(scene, path): value for path, value in values.items()}
    return Variants(scene, paths).at(paths)


def add_cable(scene: Scene, name="wire", pins=(0, 1.5), **given):
    """Add a cable, 1.5 m along x if its keywords name no other shape, with pins at these arc lengths; return it.

    pins: arc lengths in m, or "ends" for both ends; given: keywords of `Scene.cable`.
    """
    line = {} if "curve" in given or "points" in given else {"start": (0, 0, 0), "end": (1.5, 0, 0)}
    cable = scene.cable(name, **line | {"elements": 3, "section": SQUARE, "material": TABLE_1} | given)
    for s in (0.0, cable.length) if pins == "ends" else pins:
        scene.pin(cable, s=s)
    return cable


def cable_scene(name="wire", *, length=1.0, pins=(), clamps=(), gravity=(0, -9.81, 0), **given) -> Scene:
    """Return a scene with one cable of ``length`` m along x: a pendulum with pins=(0,), a cantilever with clamps=(0,).

    pins: arc lengths in m, or "ends". clamps: arc lengths. given: keywords of `Scene.cable`, or its own shape instead
    of the length.
    """
    scene = Scene(gravity=gravity)
    line = {} if given.keys() & {"end", "curve", "points"} else {"end": (length, 0, 0)}
    cable = add_cable(scene, name, pins, **line, **given)
    for s in clamps:
        scene.clamp(cable, s=s)
    return scene


def structural(element: str) -> dict[str, str]:
    """Return the keyword of the structural law for a beam, none for a cable."""
    return {"law": "structural"} if element.startswith("beam") else {}


def add_rider(scene: Scene, s: float, speed: float, cable="wire", name="A", slide="trolley", across=(0, 0), **body):
    """Add a body of 1 kg on a cable that lies along x, its centre of mass on the cable; return its slide.

    across: its velocity in y and z, m/s; body: other keywords of `Scene.rigid_body`.
    """
    given = {"mass": 1.0, "inertia": (1e-3, 1e-3, 1e-3), "position": scene.cables[cable].point(s),
             "velocity": (speed, *across)} | body
    return scene.slide(scene.rigid_body(name, **given), along=cable, s=s, name=slide)


def one_rider(s=0.25, speed=1.0, gravity=(0, -9.81, 0), *, across=(0, 0), **cable) -> Scene:
    """Return a scene with a cable and one rider: by default the first scene."""
    scene = Scene(gravity=gravity)
    add_cable(scene, **cable)
    add_rider(scene, s, speed, across=across)
    return scene


# ---- a wire that does not deform, for closed forms


def heavy_wire(dim=3, elements=4, length=LENGTH) -> Scene:
    """Return a straight unsupported wire along x of 1e13 kg, which forces of 20 N move by 1e-12 m in a second.

    A clamped wire would have axial vibrations to resolve. Gravity acts on the riders alone, as a load.
    """
    return cable_scene(length=length, gravity=(0, 0, 0), elements=elements, element={2: "cable8p", 3: "cable12"}[dim],
                       material=Material(youngs_modulus=1.0, poisson_ratio=0.0, density=1e15))


def block(s, speed=0.0, *, weight=MASS * G, slope=SLOPE, dim=3, scene=None, name="A", slide="trolley",
          **given) -> Scene:
    """Return a scene with a block of MASS on a wire with a descent of `slope`, rad.

    The weight is rotated, not the wire. given: other keywords of `Scene.slide`.
    """
    scene = scene or heavy_wire(dim)
    scene.rigid_body(name, mass=MASS, inertia=(1e-2, 1e-2, 1e-2), position=(s, 0, 0), velocity=(speed, 0, 0))
    scene.slide(name, along="wire", s=s, name=slide, **given)
    if weight:
        scene.force(name, value=(weight * np.sin(slope), -weight * np.cos(slope), 0))
    return scene


def section_of(law: str, section: Section) -> Section:
    """Return the section, with a table of the axial force where the law takes one."""
    table = TensionTable(strain=[-0.1, 0, 0.02, 0.1], force=[-270, 0, 63, 350])
    return section.remade({"tension_table": table}) if law.endswith("tabulated") else section
