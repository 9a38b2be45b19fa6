"""Random scenes whose errors are far beyond tol say so: the table of tests/benchmarks/notes.py."""

import numpy as np
import pytest
from notes import SILENT, cells, silent_part


@pytest.mark.slow
def test_few_runs_err_by_much_and_say_nothing():
    """Of the scenes from seed 100 on, at tol 1e-3 and 1e-4; two of the riders there err by 5 and 21 tol, and say so."""
    rows = [row for seed in range(100, 180) for row in cells(seed)]
    assert np.mean([np.isfinite(row["error/tol"]) for row in rows]) > 0.8
    assert any(row["error/tol"] > SILENT and row["noted"] for row in rows)
    assert silent_part(rows) < 0.01
