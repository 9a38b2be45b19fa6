"""Waves that a point makes which moves along a cable faster than the waves of its tension: coarse meshes have none.

A point that moves along at the speed v, a slide or a crossing, makes waves of its own speed, with B k² = X, where
X = m v² - T/a is its `excess`. Meshes whose elements are longer than half such a wave agree with each other, and are
all wrong. A beam bends and shears, in series: B k² = X / (1 - X/S), with S its shear stiffness. Its waves become
shorter than any mesh as X comes to S, the point to the speed of shear waves.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator

import numpy as np

from ..parts.cable import Cable
from ..results.run import Run
from ..solve.notes.supersonic_loads import excess
from .indicators import PARTS, shear_stiffness
from .motion import along
from .probes import S

SHORTEST = 1e6
"""rad/m: waves shorter than all that a mesh can have."""

ELEMENTS_A_WAVE = 2.0
"""With fewer elements a wave is not seen at all."""


def elements_for_waves(scene: S, run: Run, shearing: Collection[str] = ()) -> dict[str, tuple[int, str]]:
    """Return by cable the least number of elements that shows such waves, and the name of what makes them; none of
    cables without.

    run: of the scene, on any mesh; shearing: cables whose waves are those of a beam. A wave counts that its maker goes
    along with for a wavelength.
    """
    found: dict[str, tuple[int, str]] = {}
    for name, cable, s in _moving(scene, run):
        k = _wave_number(cable, run, s, cable.name in shearing)
        elements = int(np.ceil(ELEMENTS_A_WAVE * k * cable.length / (2 * np.pi)))
        if elements > found.get(cable.name, (1, ""))[0]:
            found[cable.name] = elements, name
    return found


def _moving(scene: S, run: Run) -> Iterator[tuple[str, Cable, np.ndarray]]:
    """Yield what moves along a cable, the cable, and its arc-lengths at the output times, (time,)."""
    for slide in scene.slides.values():
        if slide.along in scene.cables:
            yield slide.where, scene.cables[slide.along], run[f"{slide.name}.s"]
    for crossing in scene.crossings.values():
        for line, quantity in ((crossing.a, "s"), (crossing.b, "s_b")):
            if line in scene.cables:
                yield crossing.where, scene.cables[line], run[f"{crossing.name}.{quantity}"]


def _wave_number(cable: Cable, run: Run, s: np.ndarray, shears: bool) -> float:
    """Return the largest wave number, in rad/m, of waves with which a point at s moves on for a wavelength; 0 if none.

    shears: whether they are those of a beam.
    """
    stretch = np.linalg.norm(along(cable, run[f"{cable.name}.nodal_vectors"], PARTS, 1), axis=-1).mean(axis=1)
    stretch = (stretch[1:] + stretch[:-1]) / 2
    way = np.abs(np.diff(s.reshape(len(run.time), -1)[:, 0]))
    speed = way / np.diff(run.time)
    bending = cable.material.youngs_modulus * min(cable.section.second_moment_about_z,
                                                  cable.section.second_moment_about_y)
    beyond = np.nan_to_num(np.maximum(excess(cable, stretch, speed), 0.0))
    if shears:
        left = 1.0 - beyond / shear_stiffness(cable)
        beyond = np.where(left > 0, beyond / np.maximum(left, 1e-12), bending * SHORTEST**2)
    k = np.minimum(np.sqrt(beyond / bending), SHORTEST)
    order = np.argsort(-k)
    gone = np.cumsum(np.nan_to_num(way)[order])
    return float(np.max(k[order], where=gone * k[order] >= 2 * np.pi, initial=0.0))
