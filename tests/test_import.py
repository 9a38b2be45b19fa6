"""`import funicular` is quick and brings along nothing that only some uses need."""

import subprocess
import sys
import time

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


def test_it_takes_less_than_a_quarter_second():
    def seconds(code: str) -> float:
        start = time.perf_counter()
        python(code)
        return time.perf_counter() - start

    # The best of several: everything else on the machine can only add to it.
    bare = min(seconds("pass") for _ in range(3))
    assert min(seconds("import funicular") for _ in range(7)) - bare < 0.25


def test_everything_it_announces_is_there():
    names = python("import funicular as f; print(*(n for n in f.__all__ if not hasattr(f, n)))").split()
    assert names == []
