"""What a new coupling costs: a trial of a copy of the package, with files of its own and lines in lists.

The trial is a wheel on a rail: a derived spec, a force, a constraint, state, an event, energy, work from outside and
outputs. Its spec is a file in derive/couplings/point_laws, which no list names.
"""

import json
import os
import re
import shutil
import subprocess
import sys
import sysconfig
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import funicular
import numpy as np
import pytest
from funicular.derive.codegen.parallel_build import BLOCKS, NOT_OF_KERNELS

TRIAL = Path(__file__).parent / "trial_coupling"
TESTS = Path(__file__).parents[1]
RUNTIME = Path(funicular.__file__).parent
FILES = {"law.py": "derive/couplings/point_laws/tow.py", "tow.c": "engine/couplings/tow/tow.c",
         "tow.py": "parts/tow.py", "tows.py": "model/tows.py"}
LINES = {"engine/events/list.c": ("    WITH_EVENTS(crossing)", "    WITH_EVENTS(tow) \\\n"),
         "parts/listed.py": ("from .surface ", "from .tow import Tow as Tow\n")}
"""Lists that name each kind of coupling: how the line before the new one begins, and the new one."""
pytestmark = [pytest.mark.slow, pytest.mark.skipif(sys.platform == "win32", reason="calls a compiler of Unix")]


def copied(folder):
    """Return a copy of the package with the trial in it, its kernels derived, nothing compiled yet."""
    package = folder / "funicular"
    ignored = shutil.ignore_patterns("__pycache__", "engine.*.so", "kernels.*.so", "page_source")
    shutil.copytree(RUNTIME, package, ignore=ignored)
    for part in ("derive", "generated"):
        shutil.copytree(Path(__import__(f"funicular.{part}").__dict__[part].__path__[0]), package / part,
                        ignore=ignored)
    for name, place in FILES.items():
        (package / place).parent.mkdir(exist_ok=True)
        shutil.copy(TRIAL / name, package / place)
    for name, (before, line) in LINES.items():
        lines = (package / name).read_text().splitlines(keepends=True)
        (after,) = (k for k, each in enumerate(lines, 1) if each.startswith(before))
        (package / name).write_text("".join([*lines[:after], line, *lines[after:]]))
    subprocess.run([sys.executable, package / "derive", "tow", "planar_tow"], check=True, capture_output=True)
    return package


def compiled(made, sources):
    """Compile an extension module of the copy without optimisation, from the C of Cython and these C files."""
    if not made.exists():
        subprocess.run([sys.executable, "-m", "cython", "-3", made.with_suffix(".pyx"), "-o", made], check=True)
    package = made.parent if made.stem == "engine" else made.parents[1]
    objects = package / f"objects_of_{made.stem}"
    objects.mkdir()
    compiler = [*sysconfig.get_config_var("CC").split(), "-O0", "-fPIC", "-pthread", "-fvisibility=hidden", "-w"]
    include = [f"-I{path}" for path in (package / "generated", package / "engine", sysconfig.get_path("include"))]

    def compile_one(number, source):
        unit = objects / f"{number}.o"
        subprocess.run([*compiler, *include, "-c", source, "-o", unit], check=True)
        return unit

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        found = list(pool.map(compile_one, range(len(sources) + 1), [made, *sources]))
    library = made.with_suffix(sysconfig.get_config_var("EXT_SUFFIX"))
    shared = ["-bundle", "-undefined", "dynamic_lookup"] if sys.platform == "darwin" else ["-shared"]
    subprocess.run([*compiler, *shared, *found, "-lm", "-o", library], check=True)


@pytest.fixture(scope="module")
def uses(tmp_path_factory):
    folder = tmp_path_factory.mktemp("trial")
    package = copied(folder)
    generated = package / "generated"
    kernels = set(generated.glob("*.c")) - {package / name for name in NOT_OF_KERNELS}
    compiled(generated / "kernels.c", kernels)
    compiled(package / "engine.c", [*(package / "engine").rglob("*.c"), *(package / name for name in BLOCKS)])
    path = os.pathsep.join(map(str, (folder, TESTS)))
    done, verified = (subprocess.run([sys.executable, *command], capture_output=True, text=True,
                                     env=os.environ | {"PYTHONPATH": path})
                      for command in ([TRIAL / "uses.py", folder],
                                      ["-m", "funicular.cli.main", "verify", "tow", "planar_tow"]))
    assert done.returncode == 0, done.stderr[-3000:]
    return json.loads(done.stdout) | {"verified": (verified.returncode, verified.stdout[-3000:])}


def test_what_it_costs(capsys):
    """Two lists name the kinds, one line each: those of the engine's types and of parts. A third is a step back."""
    lines = {name: line.count("\n") for name, (_, line) in LINES.items()}
    with capsys.disabled():
        print(f"\na trial coupling: {len(FILES)} files of its own, {', '.join(FILES.values())}; and "
              f"{sum(lines.values())} lines in {len(LINES)} files of the package: {', '.join(LINES)}")
    assert lines == dict.fromkeys(LINES, 1) and len(LINES) <= 2
    assert len(FILES) <= 4


def test_its_c_file_stands_in_the_layer_of_couplings():
    """It includes no header of a higher layer, though it finds an event."""
    layers = set(re.findall(r'#include "(\w+)/', (TRIAL / "tow.c").read_text()))
    assert layers <= {"base", "linear", "bodies", "couplings"}, layers


def test_all_integrators_run_it(uses):
    """The energy that the moving point gives is found again, the wheel stays on the rail, and the spring breaks."""
    radau = uses["integrators"]["radau"]
    reference = np.subtract(radau["force"], radau["reaction"])
    assert 2.5 < np.abs(reference).max() < 3.0 and np.abs(reference[-1]).max() == 0.0
    times = []
    for name, found in uses["integrators"].items():
        assert found["status"] == "completed" and found["balance"] < 1e-6, (name, found["balance"])
        assert found["off_rail"] < 1e-8, (name, found["off_rail"])
        np.testing.assert_allclose(found["reaction"], radau["reaction"], rtol=0, atol=1e-3)
        (part, what, time), = found["events"]
        assert (part, what) == ("T", "broke")
        times.append(time)
    assert np.ptp(times) < 1e-6 and 0.1 < times[0] < 0.19, times


def test_statics_and_section_forces_know_it(uses):
    rest = uses["rest"]
    pull = np.subtract(rest["force"], rest["reaction"])
    assert np.linalg.norm(pull) == pytest.approx(50 * rest["stretch"]) and pull[1] > 0.1
    assert np.linalg.norm(rest["reaction"]) > 1e-2
    assert np.array(rest["jump"]) == pytest.approx(np.array(rest["force"]), abs=1e-6)


def test_a_resumed_run_is_the_same_bit_for_bit(uses):
    status, *same = uses["resumed"]
    assert status == "interrupted" and all(same) and len(same) > 10


def test_its_vectors_turn_with_the_plane(uses):
    assert max(uses["plane"].values()) < 1e-9, uses["plane"]


def test_files_pages_schema_and_stub_have_it(uses):
    assert uses["file"][-1] == pytest.approx([0.5, 0.2, 0])
    assert uses["scene_file"] == [50.0, True] and uses["schema"] and uses["stub"]
    assert "T" in uses["page"]
    assert uses["vectors"] == ["T.force", "T.position", "T.reaction", "T.stretch"]


def test_its_kernels_are_verified_and_its_theory_has_a_page(uses):
    """Formulas of the page are read back and agree with the compiled kernels."""
    assert uses["verified"][0] == 0, uses["verified"][1]
    assert uses["theory"]["faults"] == [] and uses["theory"]["formulas"] > 3
