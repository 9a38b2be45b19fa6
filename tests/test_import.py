"""`import funicular` is quick and brings along nothing that only some uses need."""

import os
import resource
import subprocess
import sys

import numpy as np

HEAVY = {"sympy", "jinja2", "matplotlib", "xarray", "h5py", "h5netcdf", "scipy", "pandas", "rich", "typer"}


def python(code: str) -> str:
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout


def test_no_heavy_module_is_loaded():
    loaded = set(python("import sys, funicular; print(*sys.modules)").split())
    assert "pydantic" in loaded
    assert not loaded & HEAVY


def test_the_command_line_loads_none_either():
    loaded = set(python("import sys, funicular.cli; print(*sys.modules)").split())
    assert not loaded & (HEAVY - {"rich", "typer"})


def cpu_seconds(code: str) -> float:
    """Of one thread: the wall clock would tell what else the machine does."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    one_thread = os.environ | {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    subprocess.run([sys.executable, "-c", code], env=one_thread, check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def test_most_of_its_time_is_that_of_numpy_and_pydantic():
    """Measured on a quiet machine: 0.16 s, 0.11 s of it for these two. Taken in turns, as seconds tell of the load."""
    both = "import numpy; from pydantic import BaseModel; type('Model', (BaseModel,), {})"
    codes = ("pass", both, "import funicular")
    bare, needed, whole = np.min([[cpu_seconds(code) for code in codes] for _ in range(7)], axis=0)
    assert whole - bare < 1.7 * (needed - bare)


def test_everything_it_announces_is_there():
    names = python("import funicular as f; print(*(n for n in f.__all__ if not hasattr(f, n)))").split()
    assert names == []
