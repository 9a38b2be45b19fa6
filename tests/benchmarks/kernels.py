"""Time of the generated kernels in a C loop.

    python tests/benchmarks/kernels.py [--out FILE.csv] [--repetitions 7]

Compiles generated/*.c with the C compiler ($CC or cc) and the optimisation of the package's own build, calls each
kernel of the beam24 element that runs in the time loop on a bent element, and prints microseconds a call (the best of
repetitions that take turns), the operations that the manifest counts, and the bytes of its code. The arguments change
from call to call, so that no call can be left out.

The aims: elastic force at most 0.25 µs, tangent at most 2 µs.
"""

import json
import os
import re
import shlex
import subprocess
import sysconfig
import tempfile
from pathlib import Path

from funicular.derive import drift
from table import arguments, show

KERNELS = {
    "beam24_inertia_force": "m, e, out",
    "beam24_continuum_energy": "l, e, A, out",
    "beam24_continuum_elastic_force": "l, e, A, out",
    "beam24_continuum_elastic_tangent": "l, e, A, out",
    "beam24_continuum_damping_force": "l, e, v, A, 1e-4, out",
    "beam24_continuum_damping_tangent": "l, e, v, A, 1e-4, 2e3, out",
    "beam24_structural_elastic_force": "l, e, As, out",
    "beam24_structural_elastic_tangent": "l, e, As, out",
    "beam24_structural_damping_tangent": "l, e, v, As, 1e-4, 2e3, out",
    "beam12p_structural_elastic_force": "l, ep, Ap, out",
    "beam12p_structural_elastic_tangent": "l, ep, Ap, out",
    "cable12_engineering_exact_elastic_force": "l, ec, Ac, out",
    "cable12_engineering_exact_elastic_tangent": "l, ec, Ac, out",
    "cable12_green_linear_elastic_force": "l, ec, Ac, out",
    "cable12_green_linear_elastic_tangent": "l, ec, Ac, out",
    "cable18_engineering_exact_elastic_force": "l, eq, Ac, out",
    "cable18_engineering_exact_elastic_tangent": "l, eq, Ac, out",
    "cable18_engineering_exact_damping_tangent": "l, eq, v, Ac, 1e-4, 2e3, out",
    "slide_beam24_rigid_residual": "l, 0.2, e, b, u, f, out, out + 3",
    "slide_beam24_rigid_tangent": "l, 0.2, e, b, u, f, out, out + 93",
}
PROGRAM = """
#define _POSIX_C_SOURCE 199309L
#include <stdio.h>
#include <time.h>
#include "kernels.h"
static double now(void) { struct timespec t; clock_gettime(CLOCK_MONOTONIC, &t); return t.tv_sec + 1e-9 * t.tv_nsec; }
static double m[64], A[61], As[29], Ap[14], e[24], e0[24], ep[12], ep0[12], v[24], out[2048], sum;
int main(void)
{
    const double l = 0.5, section[6] = {2.5e-3, 5.2083333e-7, 5.2083333e-7, 1.953125e-10, 1.0850694e-10, 1.953125e-10};
    const double D[9] = {4e8, 4e8, 4e8, 0, 0, 0, 2e8, 2e8, 2e8};
    double S[54];
    const double ec[12] = {0, 0, 0, 1, 0, 0, 0.49, 0.05, 0, 1, 0.2, 0}, Ac[2] = {1e6, 208.333};
    const double eq[18] = {0, 0, 0, 1, 0, 0, 0, 0.4, 0, 0.49, 0.05, 0, 1, 0.2, 0, 0, 0.4, 0};
    const double b[7] = {0.2, 0.01, 0, 1, 0, 0, 0}, u[3] = {0, 0, 0}, f[3] = {0.3, 10, 1};
    beam24_mass(l, 4200, section, m);
    for (int i = 0; i < 54; ++i) S[i] = D[i / 6] * section[i % 6];
    beam24_continuum_stiffness(l, S, A);
    for (int k = 0; k < 2; ++k) {
        e[12 * k] = 0.49 * k;
        e[12 * k + 1] = 0.05 * k;
        e[12 * k + 3] = e[12 * k + 7] = e[12 * k + 11] = 1;
        e[12 * k + 4] = 0.2 * k;
        e[12 * k + 6] = -0.2 * k;
    }
    const double Ss[9] = {1e6, 4e5, 4e5, 80, 208.333, 208.333, 1e6, 1e6, 4e5}, Sp[4] = {1e6, 4e5, 208.333, 1e6};
    for (int k = 0; k < 2; ++k) {
        e0[12 * k] = ep0[6 * k] = l * k;
        for (int i = 0; i < 3; ++i) e0[12 * k + 3 + 4 * i] = 1;
        for (int i = 0; i < 2; ++i) ep0[6 * k + 2 + 3 * i] = 1;
        for (int i = 0; i < 6; ++i) ep[6 * k + i] = e[12 * k + 3 * (i / 2) + i % 2];
    }
    beam24_structural_stiffness(l, e0, Ss, As);
    beam12p_structural_stiffness(l, ep0, Sp, Ap);
    /* no zeros: what the loops add to them would underflow in products, which is slow */
    for (int i = 0; i < 24; ++i) e[i] += 1e-3 * (1 + 7 * i % 11);
    for (int i = 0; i < 24; ++i) v[i] = 0.1 * i;
    @LOOPS@
    return sum == 1234.5;
}
"""
LOOP = """    {
        const double begin = now();
        for (int i = 0; i < @CALLS@; ++i) {
            @NAME@(@ARGUMENTS@);
            e[i % 24] += 1e-300 * out[i & 1];
            sum += out[0];
        }
        printf("@NAME@ %.6g\\n", (now() - begin) / @CALLS@ * 1e6);
    }
"""


def build(folder: Path) -> Path:
    """The program in ``folder``, from the generated C as it stands."""
    loops = "".join(
        LOOP.replace("@NAME@", name).replace("@ARGUMENTS@", given).replace("@CALLS@", "200000")
        for name, given in KERNELS.items()
    )
    (folder / "loop.c").write_text(PROGRAM.replace("@LOOPS@", loops), encoding="utf-8")
    generated = drift.folder()
    level = re.findall(r"-O\w", sysconfig.get_config_var("CFLAGS") or "")[-1:] or ["-O2"]
    compiler = shlex.split(os.environ.get("CC", "cc"))
    kernels = json.loads((generated / "manifest.json").read_text(encoding="utf-8"))["kernels"]
    families = {kernels[name]["family"] for name in (*KERNELS, "beam24_mass", "beam24_continuum_stiffness")}
    sources = [folder / "loop.c", *(generated / f"{family}.c" for family in sorted(families))]
    command = [*compiler, "-std=c11", *level, f"-I{generated}", *sources, "-lm", "-o", folder / "loop"]
    subprocess.run(command, check=True)
    print(f"compiled with {' '.join([*compiler, *level])}")
    return folder / "loop"


def code_sizes(program: Path) -> dict[str, int]:
    """Bytes of code by kernel, as nm tells; empty without nm."""
    try:
        listed = subprocess.run(["nm", "-S", program], capture_output=True, text=True, check=True).stdout
    except (OSError, subprocess.CalledProcessError):
        return {}
    lines = [line.split() for line in listed.splitlines()]
    return {line[3]: int(line[1], 16) for line in lines if len(line) == 4}


def main() -> None:
    """Measure and print."""
    options = arguments(__doc__, repetitions=(7, "of the whole round"))
    counted = json.loads((drift.folder() / "manifest.json").read_text(encoding="utf-8"))["kernels"]
    with tempfile.TemporaryDirectory() as folder:
        program = build(Path(folder))
        times = {name: [] for name in KERNELS}
        for _ in range(options.repetitions):
            for line in subprocess.run([program], capture_output=True, text=True, check=True).stdout.splitlines():
                times[line.split()[0]].append(float(line.split()[1]))
        sizes = code_sizes(program)
    rows = [
        {"kernel": name, "us": min(taken), **counted[name]["operations"], "code_bytes": sizes.get(name, "")}
        for name, taken in times.items()
    ]
    show(rows, options.out)


if __name__ == "__main__":
    main()
