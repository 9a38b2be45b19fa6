"""Checks of working curves against their scene."""

from __future__ import annotations

import numpy as np

from ..errors import SceneError
from ..parts.cubic_segments import integral, value
from ..parts.scene_data import SceneData
from ..parts.tension_table import TensionTable
from ..parts.validation import show
from ..parts.working_curve import WorkingCurve
from .placement import cable_of, check_strained_by_forces

MEETING_TOLERANCE = 1e-3
"""Error of the last point of a measured curve against the table, as a fraction of its force."""
CHECKED_STRAINS, CHECKED_RANGE = 60, 2.0
"""Strains, and highest strains, at which curves are compared; the largest one over the last of the table."""
ROUNDING = 1e-9


def placed_working_curve(scene: SceneData, part: WorkingCurve) -> WorkingCurve:
    """Return the working curve, checked to suit its cable. Raises SceneError."""
    cable = cable_of(scene, part.cable, part.where)
    if not cable.gives_way or cable.traits.membrane != "tabulated":
        raise SceneError(part.where, f"needs the force of first loading, but {cable.where} has no table that begins at "
                         "strain 0", 'give its section a tension_table from strain 0 on, and the cable '
                         'membrane="tabulated"')
    check_strained_by_forces(cable, part.where, "working curve")
    for other in scene.working_curves.values():
        if other.cable == part.cable and other is not part:
            raise SceneError(part.where, f"{cable.where} has {other.where} already", "leave one of them out")
    for piece in cable.uniform_pieces:
        assert piece.section.tension_table is not None  # as the law has one
        _check_curves(part, piece.section.tension_table)
    return part


def _check_curves(part: WorkingCurve, table: TensionTable) -> None:
    """Raise SceneError for a measured curve that does not end on the table, or for curves that give energy."""
    first = table.numbers()
    if part.strain is not None and part.force is not None:
        there = float(value(first, np.array(part.strain[-1])))
        if abs(part.force[-1] - there) > MEETING_TOLERANCE * there:
            raise SceneError(part.where, f"the last force is {show(part.force[-1], 'N')} at the strain "
                             f"{part.strain[-1]:g}, where the table of the cable has {show(there, 'N')}",
                             "let the curve end on the table")
    highest = np.linspace(0, CHECKED_RANGE * table.strain[-1], CHECKED_STRAINS + 1)[1:, None]
    low = part.permanent_share * highest
    strain = low + (highest - low) * np.linspace(0, 1, CHECKED_STRAINS)
    over = part.force_at(first, strain, highest) - value(first, strain)
    row, column = np.unravel_index(np.argmax(over / value(first, highest)), over.shape)
    if over[row, column] > ROUNDING * value(first, highest[row, 0]):
        at, top = strain[row, column], highest[row, 0]
        raise SceneError(part.where, f"the working curve from the strain {top:.3g} is above first loading at "
                         f"{at:.3g}: {show(float(over[row, column]), 'N')} over "
                         f"{show(float(value(first, at)), 'N')}", "give it more permanent strain or more bend")
    stored = (highest - low)[:, 0] * value(first, highest[:, 0]) * float(integral(part.shape(), np.array(1.0)))
    lost = integral(first, highest[:, 0]) - stored
    if np.any(np.diff(lost, prepend=0.0) < -ROUNDING * stored):
        k = int(np.argmin(np.diff(lost, prepend=0.0) / stored))
        raise SceneError(part.where, f"loading up to the strain {highest[k, 0]:.3g} would cost less than a part of it: "
                         "the working curves give energy", "give them more permanent strain or more bend")
