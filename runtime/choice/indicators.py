"""What a coarse run of cable elements tells of what they leave out: shear, rotary inertia, compression, deformation."""

from __future__ import annotations

from collections.abc import Collection
from functools import lru_cache

import numpy as np

from ..parts.cable import Cable
from ..parts.section import Section
from ..results.run import Run
from .motion import along
from .probes import S

PARTS = 24
"""Equal parts of a cable between which its curvature is differenced."""

SOFTER = 0.9
"""Of the bending stiffness: what a scene is run with, to see how much its motion depends on it."""


def curvatures(cable: Cable, run: Run) -> np.ndarray:
    """Return (time, place, 3): the curvature vector in 1/m at equal distances, without that of the drawn shape at rest.
    """
    vectors = run[f"{cable.name}.nodal_vectors"]
    r_x, r_xx = (along(cable, vectors, PARTS, derivative) for derivative in (1, 2))
    found = np.cross(r_x, r_xx) / np.sum(r_x * r_x, axis=-1, keepdims=True)
    return found - found[:1] if cable.is_curved else found


def shear_stiffness(cable: Cable) -> float:
    """Return kGA of a cable's section in N, in the direction in which it is less."""
    _, shear_modulus = cable.material.lame()
    return float(min(cable.section.shear_factors(cable.material.poisson())) * shear_modulus
                 * cable.section.moments()[0])


def shear_compliance(cable: Cable, run: Run) -> float:
    """Return by how much shear and rotary inertia soften the bending of a cable, as a part of its stiffness.

    The energy of shear over that of bending, ∫V²/kGA over ∫M²/EI with V = dM/ds, is what shear takes from the
    stiffness of that deflection; rotary inertia does kG/E as much to a vibration (Timoshenko, Phil. Mag. 41 (1921)).
    """
    kappa = curvatures(cable, run)
    bending = cable.material.youngs_modulus * cable.section.second_moment_about_z
    shear = shear_stiffness(cable)
    slope = np.diff(kappa, axis=1) / (cable.length / PARTS)
    middle = (kappa[:, 1:] + kappa[:, :-1]) / 2
    energy = float(np.sum(middle * middle))
    if energy == 0.0:
        return 0.0
    rotary = shear / (cable.material.youngs_modulus * float(cable.section.moments()[0]))
    return bending / shear * float(np.sum(slope * slope)) / energy * (1 + rotary)


def softened(scene: S, names: Collection[str]) -> S:
    """Return a scene in which some cables, of cable elements, have `SOFTER` times their bending stiffness."""
    def soft(cable: Cable) -> Cable:
        return cable.remade({"section": _soft(type(cable.section))(**cable.section.entries())})

    return scene.with_parts(soft(part) if isinstance(part, Cable) and part.name in names else part
                            for part in scene.parts())


@lru_cache
def _soft(kind: type[Section]) -> type[Section]:
    """Return the sections of a kind with `SOFTER` second moments: what reads their radius still finds it."""
    softer = [1, SOFTER, SOFTER, 1, 1, 1]
    return type(f"Soft{kind.__name__}", (kind,),
                {"moments": lambda section: kind.moments(section) * softer, "__module__": __name__})


def deformation(cable: Cable, run: Run) -> float:
    """Return how far, in m, a point of a cable is at most from where the best rigid motion of its drawn shape has it.
    """
    points = along(cable, run[f"{cable.name}.nodal_vectors"])
    drawn = points[0] - points[0].mean(axis=0)
    moved = points[1:] - points[1:].mean(axis=1, keepdims=True)
    u, _, vt = np.linalg.svd(drawn.T @ moved)
    u[:, :, -1] *= np.where(np.linalg.det(u @ vt) < 0, -1.0, 1.0)[:, None]
    return float(np.linalg.norm(drawn @ (u @ vt) - moved, axis=-1).max(initial=0.0))
