"""`import funicular` is quick and loads no module that only some uses need."""

import re
import subprocess
import sys

import funicular as fu
import pytest

HEAVY = {"sympy", "jinja2", "matplotlib", "xarray", "h5py", "h5netcdf", "scipy", "pandas", "rich", "typer"}


def python(code: str) -> str:
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout


def test_no_heavy_module_is_loaded():
    loaded = set(python("import sys, funicular; print(*sys.modules)").split())
    assert "pydantic" in loaded
    assert not loaded & HEAVY


def test_catenaries_load_none_either():
    loaded = set(python("import sys, funicular.catenary; print(*sys.modules)").split())
    assert not loaded & HEAVY


def test_the_command_line_loads_none_either():
    loaded = set(python("import sys, funicular.cli.main; print(*sys.modules)").split())
    assert not loaded & (HEAVY - {"rich", "typer"})


@pytest.mark.parametrize("scene", ["paper51", "belt_drive", "block_and_tackle"])
def test_a_run_loads_no_more_of_scipy_than_its_table_of_lapack(scene):
    """The rest of SciPy and numpy.random take longer to load than the first scene takes to run; small borders need no
    LAPACK, and parts no plugins of pydantic, the search for which loads importlib.metadata.
    """
    loaded = set(python("import sys, warnings, funicular; warnings.simplefilter('ignore'); "
                        f"funicular.load_scene('{scene}').run(duration=0.02, output_step=0.01, progress=False); "
                        "print(*sys.modules)").split())
    table = set() if scene == "paper51" else {"scipy.linalg.cython_lapack"}
    assert {name for name in loaded if re.match(r"scipy\.(?!_|version)\w+", name)} == table
    assert ("scipy" in loaded) == bool(table)
    assert not loaded & (HEAVY - {"scipy"} | {"numpy.random", "numpy.testing", "importlib.metadata",
                              "importlib.resources", "pydantic.plugin._loader"})


def test_models_of_others_find_their_plugins_of_pydantic():
    assert python("import funicular as fu; from pydantic import BaseModel, plugin\n"
                  "fu.load_scene('paper51')\n"
                  "from pydantic.plugin import _loader; print(_loader.__file__ is not None, _loader._plugins)\n"
                  "type('Model', (BaseModel,), {}); print(_loader._plugins is not None)").split() == [
                      "True", "None", "True"]


def test_what_another_version_of_pydantic_takes_from_its_module_is_loaded():
    assert python("from funicular.parts.plugins import no_plugins\n"
                  "with no_plugins(): from pydantic.plugin._loader import get_plugins, PYDANTIC_ENTRY_POINT_GROUP\n"
                  "print(PYDANTIC_ENTRY_POINT_GROUP)").split() == ["pydantic"]


def test_the_table_of_lapack_is_that_of_a_later_import():
    python("from funicular.base.lapack import cython_lapack; table = cython_lapack()\n"
           "import scipy.linalg, scipy.sparse.linalg\n"
           "from scipy.linalg import cython_lapack as later\n"
           "assert later is table and 'dpbtrf' in later.__pyx_capi__ and cython_lapack() is table")


NEEDED = "import numpy; from pydantic import BaseModel; type('Model', (BaseModel,), {})"
CALLS = """
import sys
calls = 0
def count(frame, event, argument):
    global calls
    calls += event in ("call", "c_call")
sys.setprofile(count)
{}
sys.setprofile(None)
print(calls)
"""


def calls_of(code: str) -> int:
    """Return the number of function calls of some code with all modules compiled; it does not depend on the machine's
    load.
    """
    return [int(python(CALLS.format(code))) for _ in range(2)][1]


def test_most_of_its_work_is_that_of_numpy_and_pydantic():
    """The ratio is 1.4 in seconds, which vary, and 1.38 to 1.50 in calls, by what else is installed: the search for
    modules and for plugins of pydantic is in both.
    """
    assert calls_of("import funicular") < 1.55 * calls_of(NEEDED)


def test_it_brings_modules_of_numpy_and_of_python_alone():
    """Permitted are its own modules, those of pydantic, and those of the Cython runtime."""
    modules = set(python("import sys, funicular; print(*sys.modules)").split())
    needed = set(python(f"import sys; {NEEDED}; print(*sys.modules)").split())
    found = {name.partition(".")[0] for name in modules - needed
             if not re.match(r"cython_runtime$|_cython_[\d_]+$", name)}
    assert found - sys.stdlib_module_names <= {"funicular", "numpy"}


def test_everything_it_announces_is_there():
    names = python("import funicular as f; print(*(n for n in f.__all__ if not hasattr(f, n)))").split()
    assert names == []


def test_the_package_completes_its_interface_alone():
    lazy = {"Choice", "Equilibrium", "InitialState", "LinearModel", "LogUniform", "Modes", "Simulation", "Uniform",
            "load_sweep", "read_moordyn", "sweep", "sweep_cost"}
    assert {name for name in dir(fu) if not name.startswith("__")} == {*fu.__all__, *lazy} - {"__version__"}
    assert all(hasattr(fu, name) for name in dir(fu))
