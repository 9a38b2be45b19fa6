"""Kernels in a C program: `python -m funicular.generated` and kernels.h are sufficient for compiler and caller."""

import json
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from funicular.derive.codegen import drift
from funicular.derive.codegen.parallel_build import NOT_OF_KERNELS
from funicular.derive.verify.compiled import compiler
from funicular.generated import described, kernels

PROGRAM = Path(__file__).with_name("kernel_call.c")
HEADER = (drift.folder() / "kernels.h").read_text(encoding="utf-8")


def told(*options: str) -> list[str]:
    """Return the lines that the module prints."""
    run = subprocess.run([sys.executable, "-m", "funicular.generated", *options], capture_output=True, text=True,
                         check=True)
    return run.stdout.splitlines()


def test_a_c_program_gives_the_numbers_of_the_python_face(tmp_path):
    """Only the file of one kernel is compiled; all files take a minute."""
    include, *sources = told()
    assert include == f"-I{drift.folder()}"
    source, = (s for s in sources if Path(s).name == "cable12_green_exact.c")
    program = tmp_path / "kernel_call"
    subprocess.run([*compiler(), "-std=c11", "-Wall", "-Wextra", "-Werror", include, PROGRAM, source, "-lm",
                    "-o", program], check=True)
    energy = float(subprocess.run([program], capture_output=True, text=True, check=True).stdout)
    e = [[0, 0, 0], [1.01, 0, 0], [2.02, 0, 0], [1.01, 0, 0]]
    expected, = kernels.cable12_green_exact_energy(2.0, e, [1000.0, 0.5])
    assert energy == pytest.approx(expected, rel=1e-14)
    strain = (1.01**2 - 1) / 2
    assert energy == pytest.approx(1000.0 * strain**2 / 2 * 2.0, rel=1e-12), "EA eps^2/2 l, unbent"


def test_sources_are_all_c_files_with_kernels():
    sources = [Path(line) for line in told("--sources")]
    others = {Path(name).name for name in NOT_OF_KERNELS}
    assert {s.name for s in sources} == {p.name for p in drift.folder().glob("*.c")} - others
    assert all(s.is_file() for s in sources)
    assert told("--include") == [f"-I{drift.folder()}"]


def test_the_header_says_shapes_and_units():
    """Two comments precede a declaration: the result with units, then the sizes of arrays."""
    manifest = json.loads((drift.folder() / "manifest.json").read_text(encoding="utf-8"))
    comments, found = ["", ""], {}
    text = HEADER.replace("\n * ", " ")
    for comment, declared in re.findall(r"/\* (.*?) \*/|^((?:fu_\w+_kernel|void) [^;]*);", text, re.M | re.S):
        if comment:
            comments = [comment, ""] if " -> " in comment else [comments[0], comment]
        else:
            found |= {name: comments for name in re.sub(r"\(.*", "", declared).replace(",", "").split()[1:]}
    for name, entry in described(manifest).items():
        for argument in entry["inputs"] + entry["outputs"]:
            shape = "x".join(map(str, argument["shape"]))
            assert f"{argument['name']} [{argument['unit']}]" in found[name][0], name
            assert not shape or f"{argument['name']} {shape}" in found[name][1], name


@pytest.mark.skipif(shutil.which("c++") is None, reason="no C++ compiler")
def test_the_header_compiles_as_cplusplus(tmp_path):
    unit = tmp_path / "unit.cpp"
    unit.write_text('#include "kernels.h"\n'
                    "double density(const double *m) { double U; beam24_continuum_energy(1, m, m, &U); return U; }\n")
    out = tmp_path / "unit.o"
    subprocess.run(["c++", "-Wall", "-Werror", f"-I{drift.folder()}", "-c", unit, "-o", out], check=True)
    assert b"beam24_continuum_energy" in out.read_bytes()
    assert b"_Z23beam24_continuum_energy" not in out.read_bytes()
