"""The error of the motion agrees with ``tol``, over the scenes of tests/benchmarks/choice_scenes.py."""

import numpy as np
import pytest
from choice import TOLS, cell, references
from choice_scenes import SCENES

MIN_SHARE_WITHIN_TOL, MAX_ERROR_RATIO = 0.95, 3.0
"""Part of the cells that are within tol, and the largest error of any, over tol."""

QUICK = ("heavy top, 150 rad/s", "heavy top on a spring", "flexible link", "taut cable, struck", "taut cable, rider",
         "rider at twice the wave speed", "buckling", "friction, vibrating", "friction that stops", "stick",
         "shaken support", "zip line")


def errors(names, tols) -> np.ndarray:
    """Return the errors over tol of each cell; print those beyond it."""
    cells = [cell(name, tol) for name in names for tol in tols]
    for row in cells:
        if row["error/tol"] > 1:
            print(f"{row['scene']}, tol {row['tol']:g}, {row['integrator']}: {row['error/tol']:.2f} tol")
    return np.array([row["error/tol"] for row in cells])


@pytest.mark.parametrize("tol", [1e-3, 1e-4])
def test_the_error_is_at_most_three_tol(tol):
    """Scenes with errors of up to 60 tol by genalpha, or by radau's embedded estimate alone."""
    assert errors(QUICK, [tol]).max() < MAX_ERROR_RATIO


@pytest.mark.slow
def test_the_error_is_within_tol_in_nearly_all_cells():
    found = errors(SCENES, TOLS)
    assert np.mean(found <= 1) >= MIN_SHARE_WITHIN_TOL
    assert found.max() <= MAX_ERROR_RATIO


def test_references_are_converged():
    """Two methods agree on them to a tenth of the smallest tol."""
    for name in SCENES:
        assert references()[f"{name}, converged"] < 1e-7, name
