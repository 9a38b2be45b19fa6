"""
The C kernels in your own program
=================================

Each generated kernel is a pure C function without state or allocation. ``kernels.h`` gives shape and unit of every
argument. This guide calls one kernel from C and from Python.
"""

# %%
# Include path and sources
# ------------------------
#
# ``python -m funicular.generated`` prints the include path and the sources. ``--include`` and ``--sources`` print one
# of them.

import json
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np


def printed(option: str) -> list[str]:
    """Return the lines that the module prints."""
    return subprocess.run([sys.executable, "-m", "funicular.generated", option], check=True, capture_output=True,
                          text=True).stdout.splitlines()


include, = printed("--include")
sources = {Path(path).stem: path for path in printed("--sources")}
print(len(sources), "files, such as", *sorted(sources)[:4])

# %%
# A program
# ---------
#
# The program computes the elastic energy and force of a cable element of 2 m, stretched by 1 %. The coordinates are r
# and r_x at both ends. Another kernel computes ``constants`` from E A and E I.

PROGRAM = r"""
#include "kernels.h"
#include <stdio.h>

int main(void)
{
    const double length = 2.0, stiffness[2] = {1000.0, 0.5};
    const double e[12] = {0, 0, 0, 1.01, 0, 0, 2.02, 0, 0, 1.01, 0, 0};
    double constants[2], energy, force[12];
    cable12_green_exact_stiffness(length, stiffness, constants);
    cable12_green_exact_energy(length, e, constants, &energy);
    cable12_green_exact_elastic_force(length, e, constants, force);
    printf("%.17g %.17g\n", energy, force[6]);
    return 0;
}
"""
Path("call.c").write_text(PROGRAM, encoding="utf-8")
compiler = shutil.which("cc") or shutil.which("gcc") or shutil.which("clang")
subprocess.run([compiler, "-std=c11", "-Wall", "-Wextra", include, "call.c", sources["cable12_green_exact"], "-lm",
                "-o", "call"], check=True)
energy, force = map(float, subprocess.run(["./call"], check=True, capture_output=True, text=True).stdout.split())
print(f"energy {energy:.6f} J, force at the far end {force:.6f} N")

# %%
# By hand: Green's strain is (1.01² - 1) / 2; the energy is E A / 2 times its square times the length; the force is E A
# times the strain times the stretch 1.01.

strain = (1.01**2 - 1) / 2
assert abs(energy - 1000 * strain**2 / 2 * 2) < 1e-12
assert abs(force - 1000 * strain * 1.01) < 1e-9

# %%
# From Python
# -----------
#
# The same kernel is a function of arrays. ``rows`` evaluates it for many elements in one call.

from funicular.generated import kernels

e = np.array([[0, 0, 0], [1.01, 0, 0], [2.02, 0, 0], [1.01, 0, 0]])
same, = kernels.cable12_green_exact_energy(2.0, e, [1000.0, 0.5])
assert same == energy
print(f"from Python: {same:.6f} J")

# %%
# All kernels
# -----------
#
# ``manifest.json`` describes each kernel: its result, equation, arguments with shapes and units, and operation count.

from funicular.generated import described

manifest = described(json.loads(Path(include.removeprefix("-I"), "manifest.json").read_text(encoding="utf-8")))
entry = manifest["cable12_green_exact_elastic_force"]
print(entry["doc"])
for argument in entry["inputs"] + entry["outputs"]:
    print(f"  {argument['name']:12} {argument['shape']} {argument['unit']}")
