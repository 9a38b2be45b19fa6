"""Linear algebra of the engine for small scenes, called from C: the residuals of random systems are rounding."""

import subprocess
from pathlib import Path

from funicular.derive.codegen import drift
from funicular.derive.verify.compiled import compiler

PROGRAM = Path(__file__).with_name("small_systems.c")
ENGINE = Path(__file__).parents[2] / "runtime" / "engine"
NAMES = ("band", "complex_band", "complex_pivoted", "inverse", "pivoted", "small")
SOURCES = [ENGINE / "linear" / f"{name}.c" for name in NAMES]


def test_residuals_are_rounding(tmp_path):
    program = tmp_path / "small_systems"
    subprocess.run([*compiler(), "-std=c11", "-O2", "-Wall", "-Wextra", "-Wpedantic", "-Werror", f"-I{drift.folder()}",
                    f"-I{ENGINE}", PROGRAM, *SOURCES, "-lm", "-o", program], check=True)
    done = subprocess.run([program], capture_output=True, text=True, check=True)
    real, band, unsymmetric, inverse, small, pivoted, *singular = map(float, done.stdout.split())
    assert 0 < real < 10
    assert 0 < band < 10
    assert 0 < unsymmetric < 10
    assert 0 < inverse < 10
    assert 0 < small < 50
    assert 0 < pivoted < 50
    assert singular == [2, 1, 2], "the second pivot of a matrix of rank 1 is zero, and the first one of no entries"
