"""The bundled scene of a catenary, made by its builder.

    python tests/statics/bundled_catenary.py

writes runtime/scenes/catenary.toml; tests/statics/test_bundled_catenary.py compares it.
"""

from pathlib import Path

from funicular import Scene, catenary

FILE = Path(__file__).parents[2] / "runtime" / "scenes" / "catenary.toml"
HEAD = """\
# A catenary over a railway, three spans of 55 m, and a pantograph of three masses that passes below it at 275 km/h.
#
# Written by `python tests/statics/bundled_catenary.py` with funicular.catenary: the lengths of the droppers are those
# with which the contact wire lies on a parabola of 55 mm at the droppers and pulls with 22 kN. The mesh is coarse, for
# a quick look; what its elements leave of the dents in the wires is in the stiffnesses of droppers and contact: see
# runtime/guides/pages/catenaries.md.
"""
COARSE = 3.0, 6.0
"""Longest elements of contact wire and messenger, m."""


def built() -> Scene:
    """Return the scene."""
    damping = {"mass_damping": catenary.mass_damping(0.005, 5.0), "damping_time": 1e-4}
    line = catenary.Line(
        spans=3, span=55.0, height=1.2, support=500e3,
        contact=catenary.Wire(mass=1.35, tension=22e3, axial_stiffness=15e6, bending_stiffness=179, **damping),
        messenger=catenary.Wire(mass=1.08, tension=16e3, axial_stiffness=11.64e6, bending_stiffness=111, **damping),
        droppers=catenary.Droppers(at=[4.5, 10.25, 16, 21.75, 27.5, 33.25, 39, 44.75, 50.5], sag=0.055,
                                   axial_stiffness=200e3, mass=0.117, messenger_clamp=0.195, contact_clamp=0.165))
    scene = catenary.scene(line, COARSE)
    pantograph = catenary.Pantograph(masses=[7.5, 9, 6], stiffness=[7000, 15500, 160], damping=[45, 0.1, 100],
                                     uplift=120)
    catenary.add_pantograph(scene, pantograph, at=20.0, speed=275 / 3.6)
    return scene


if __name__ == "__main__":
    FILE.write_text(HEAD + built().to_toml().lstrip("\n"), encoding="utf-8")
