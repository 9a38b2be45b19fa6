"""Indicators of a coarse run of cable elements: shear, rotary inertia, short waves, deformation."""

from __future__ import annotations

from collections.abc import Collection
from functools import lru_cache

import numpy as np

from ..parts.cable import Cable
from ..parts.piece import UniformPiece
from ..parts.section import Section
from ..results.run import Run
from ..solve.notes.supersonic_loads import excess
from .motion import along
from .remeshing import S

PARTS = 24
"""Equal parts of a cable between which its curvature is differenced."""

BENDING_RATIO = 0.9
"""Ratio of the bending stiffness in a run that shows its influence on the motion."""

MAX_WAVE_NUMBER = 1e6
"""rad/m: larger than that of any wave on a mesh."""

MIN_ELEMENTS_PER_WAVE = 2.0
"""Number of elements below which a mesh does not show a wave at all."""


def shear_compliance(cable: Cable, run: Run) -> float:
    """Return the part of its bending stiffness by which shear and rotary inertia soften a cable.

    The energy of shear over that of bending, ∫V²/kGA over ∫M²/EI with V = dM/ds, is the part that shear takes from the
    stiffness of that deflection; rotary inertia takes kG/E times as much of a vibration (Timoshenko, Phil. Mag. 41
    (1921)).
    """
    vectors = run[f"{cable.name}.nodal_vectors"]
    r_x, r_xx = (along(cable, vectors, PARTS, derivative) for derivative in (1, 2))
    kappa = np.cross(r_x, r_xx) / np.sum(r_x * r_x, axis=-1, keepdims=True)
    if cable.is_curved:
        kappa = kappa - kappa[:1]
    parts = np.arange(2 * PARTS + 1) / (2 * PARTS) * cable.length  # the points, and the middles between them
    element = cable.mesh.element_at(parts * (1 + 1e-12))
    bending = cable.of_elements(
        lambda piece: piece.material.youngs_modulus * piece.section.second_moment_about_z)[element]
    shear = cable.of_elements(_shear_stiffness_of)[element][1::2]
    axial = cable.of_elements(lambda piece: piece.material.youngs_modulus * piece.section.area)[element][1::2]
    moment = bending[::2, None] * kappa
    force = np.diff(moment, axis=1) / (cable.length / PARTS)
    middle = (moment[:, 1:] + moment[:, :-1]) / 2
    energy = float(np.sum(middle * middle / bending[1::2, None]))
    if energy == 0.0:
        return 0.0
    return float(np.sum(force * force / shear[:, None])) / energy * (1 + float(np.max(shear / axial)))


def _shear_stiffness(cable: Cable) -> float:
    """Return kGA of a cable's section in N, in the more flexible direction, the least of its pieces."""
    return min(map(_shear_stiffness_of, cable.uniform_pieces))


def _shear_stiffness_of(piece: UniformPiece) -> float:
    return min(piece.section.shear_factors(piece.material.poisson())) * piece.material.lame()[1] * piece.section.area


def softened(scene: S, names: Collection[str]) -> S:
    """Return a scene in which some cables, of cable elements, have `BENDING_RATIO` of their bending stiffness."""
    def soft(cable: Cable) -> Cable:
        if cable.pieces is None:
            return cable.remade({"section": softer(cable.section)})
        return cable.remade({"pieces": [piece.remade({"section": softer(piece.section)}) for piece in cable.pieces]})

    def softer(section: Section) -> Section:
        return _soft(type(section))(**section.entries())

    return scene.with_parts(soft(part) if isinstance(part, Cable) and part.name in names else part
                            for part in scene.parts())


@lru_cache
def _soft(kind: type[Section]) -> type[Section]:
    """Return sections of a kind with smaller second moments and the same radius."""
    ratios = [1, BENDING_RATIO, BENDING_RATIO, 1, 1, 1]
    return type(f"Soft{kind.__name__}", (kind,),
                {"moments": lambda section: kind.moments(section) * ratios, "__module__": __name__})


def deformation(cable: Cable, run: Run) -> float:
    """Return the largest distance in m of a point of a cable from the best rigid motion of its drawn shape."""
    points = along(cable, run[f"{cable.name}.nodal_vectors"])
    drawn = points[0] - points[0].mean(axis=0)
    moved = points[1:] - points[1:].mean(axis=1, keepdims=True)
    u, _, vt = np.linalg.svd(drawn.T @ moved)
    u[:, :, -1] *= np.where(np.linalg.det(u @ vt) < 0, -1.0, 1.0)[:, None]
    return float(np.linalg.norm(drawn @ (u @ vt) - moved, axis=-1).max(initial=0.0))


def elements_for_waves(scene: S, run: Run, shearing: Collection[str] = ()) -> dict[str, tuple[int, str]]:
    """Return by cable the least number of elements that shows its short waves, and the name of their source.

    A point that moves along a cable at a speed v above that of the waves of its tension, a slide or a crossing, makes
    waves of its own speed: B k² = X, X = m v² - T/a, its `excess`. Meshes whose elements are longer than half such a
    wave agree with each other, and all are wrong. A beam bends and shears in series, B k² = X / (1 - X/S) with its
    shear stiffness S: its waves become shorter than any mesh as X approaches S, at the speed of shear waves.

    run: of the scene, on any mesh; shearing: cables whose waves are those of a beam. A wave counts where its source
    moves with it for a wavelength.
    """
    sources: list[tuple[str | None, str, str]] = [
        (slide.along, slide.where, f"{slide.name}.s") for slide in scene.slides.values()]
    sources += [(line, crossing.where, f"{crossing.name}.{quantity}") for crossing in scene.crossings.values()
                for line, quantity in ((crossing.a, "s"), (crossing.b, "s_b"))]
    found: dict[str, tuple[int, str]] = {}
    for line, name, quantity in sources:
        if line is not None and (cable := scene.cables.get(line)) is not None:
            k = _wave_number(cable, run, run[quantity], line in shearing)
            elements = int(np.ceil(MIN_ELEMENTS_PER_WAVE * k * cable.length / (2 * np.pi)))
            if elements > found.get(line, (1, ""))[0]:
                found[line] = elements, name
    return found


def _wave_number(cable: Cable, run: Run, s: np.ndarray, shears: bool) -> float:
    """Return the largest wave number, in rad/m, with which a point at s (time,) moves for a wavelength; 0 if none.

    shears: whether the waves are those of a beam.
    """
    stretch = np.linalg.norm(along(cable, run[f"{cable.name}.nodal_vectors"], PARTS, 1), axis=-1).mean(axis=1)
    stretch = (stretch[1:] + stretch[:-1]) / 2
    travel = np.abs(np.diff(s.reshape(len(run.time), -1)[:, 0]))
    bending = min(piece.material.youngs_modulus * float(min(piece.section.moments()[1:3]))
                  for piece in cable.uniform_pieces)
    beyond = np.nan_to_num(np.maximum(excess(cable, stretch, travel / np.diff(run.time)), 0.0))
    if shears:
        left = 1.0 - beyond / _shear_stiffness(cable)
        beyond = np.where(left > 0, beyond / np.maximum(left, 1e-12), bending * MAX_WAVE_NUMBER**2)
    shortest = np.where(beyond > 0, MAX_WAVE_NUMBER, 0.0)
    k = np.minimum(np.sqrt(beyond / bending), MAX_WAVE_NUMBER) if bending > 0 else shortest
    order = np.argsort(-k)
    moved = np.cumsum(np.nan_to_num(travel)[order])
    return float(np.max(k[order], where=moved * k[order] >= 2 * np.pi, initial=0.0))
