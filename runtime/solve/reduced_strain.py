"""What a reduced axial strain cannot bear: compression beyond its stabilisation, see `stiffness.STABILISATION`."""

from __future__ import annotations

import numpy as np

from ..model.model import Model
from ..parts.scene_data import SceneData
from ..parts.section_stiffness import STABILISATION, is_reduced


def notes(scene: SceneData, model: Model, time: np.ndarray, q: np.ndarray) -> list[str]:
    """Return a note for each cable with a reduced axial strain that was compressed too much at one of the times.

    time (n,) in s; q (n, coordinates). The strain is that of the chords of elements.
    """
    found = []
    for cable in model.cables:
        if not len(q) or not is_reduced(scene.cables[cable.name].law):
            continue
        nodes = q[:, cable.coordinates].reshape(len(q), *cable.shape)[:, :, cable.vectors.index("r")]
        strain = np.linalg.norm(np.diff(nodes, axis=1), axis=-1) / cable.length - 1
        least = strain.min(axis=1)
        worst = int(np.argmin(least))
        if least[worst] < -STABILISATION:
            found.append(f'cable "{cable.name}" was compressed by {-least[worst]:.2g} of its length at t = '
                         f'{time[worst]:.4g} s: membrane="reduced" keeps the lengths of its slopes stable up to '
                         f'{STABILISATION:g} alone; take membrane="assumed" or "full"')
    return found
