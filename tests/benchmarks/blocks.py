"""Kernels of several elements at once (generated/blocks.c) beside those of one: nanoseconds per element.

    python tests/benchmarks/blocks.py [--out FILE.csv] [--repetitions 7]

One thread, compiled as the engine is, 16 elements in the first-level cache, gather and scatter included: minimum of the
repetitions. Operations are those of the manifest; their rate is relative to the machine's peak of fused multiply-adds
in AVX2 (two operations each), measured here. Kernels without fused operations can reach half of it, or three quarters
on cores with adders apart from their multipliers. Divisions and square roots, four to eight times as long as a product,
reduce the rate much further.
"""

from __future__ import annotations

import json
import platform
import subprocess
import tempfile
from pathlib import Path

import numpy as np
from funicular.derive.catalogue import families
from funicular.derive.codegen import drift
from funicular.derive.codegen import rendering as emit
from funicular.derive.codegen.manifest import recorded
from funicular.derive.verify import timing
from funicular.derive.verify.compiled import compiler
from funicular.generated import kernels as compiled
from table import Parser, arguments, show

ELEMENTS = 16
FLAGS = ["-std=c11", "-O3", "-fno-math-errno"]
PROGRAM = """#define _POSIX_C_SOURCE 199309L
#include <stdio.h>
#include <time.h>
#include "blocks.h"
#include "kernels.h"
static double now(void) { struct timespec t; clock_gettime(CLOCK_MONOTONIC, &t); return t.tv_sec + 1e-9 * t.tv_nsec; }
static double e[@SIZE@], v[@SIZE@], out[@SIZE@ * 32], sum;
static void fill(double *to, const double *from, int n)
{
    for (int k = 0; k < @ELEMENTS@; ++k)
        for (int i = 0; i < n; ++i) to[k * n + i] = from[i];
}
typedef double lanes __attribute__((vector_size(32)));
__attribute__((target("avx2,fma"))) static double peak(void)
{
    const lanes a = {0.5, 0.4, 0.3, 0.2}, b = {1.0, 2.0, 3.0, 4.0};
    lanes p = a, q = a + 1, r = a + 2, s = a + 3, t = a + 4, u = a + 5, x = a + 6, y = a + 7, z = a + 8, w = a + 9;
    const double begin = now();
    for (long k = 0; k < 4000000; ++k) {
        p = p * a + b, q = q * a + b, r = r * a + b, s = s * a + b, t = t * a + b;
        u = u * a + b, x = x * a + b, y = y * a + b, z = z * a + b, w = w * a + b;
    }
    const double taken = now() - begin;
    sum += (p + q + r + s + t + u + x + y + z + w)[0];
    return 4e6 * 10 * 8 / taken * 1e-9;
}
int main(void)
{
    const fu_law_blocks *of;
    printf("peak 0 %.6g\\n", peak());
@LOOPS@
    return sum == 1234.5;
}
"""
LOOP = """    {
        static const double A[] = {@A@}, e0[] = {@e@}, v0[] = {@v@}, l = @l@;
        const fu_elements some = {.l = &l, .tau = @tau@, .e = e, .v = v, .A = A, .per_node = @n@};
        fill(e, e0, @n@);
        fill(v, v0, @n@);
        double begin = now();
        for (int r = 0; r < @TIMES@; ++r) {
            for (int k = 0; k < @ELEMENTS@; ++k) @CALL@;
            sum += out[r % 8];
        }
        const double single = now() - begin;
        of = fu_blocks_of("@LAW@");
        if (!of) return 1;
        begin = now();
        for (int r = 0; r < @TIMES@; ++r) {
            of->@KERNEL@(@ELEMENTS@, &some, out);
            sum += out[r % 8];
        }
        printf("@LAW@_@KERNEL@ %.6g %.6g\\n", single / @TIMES@ / @ELEMENTS@ * 1e9,
               (now() - begin) / @TIMES@ / @ELEMENTS@ * 1e9);
    }
"""


def times(operations: int) -> int:
    """Return the number of calls of a kernel with a number of operations."""
    return 1 if Parser.smallest else int(2e6 / ELEMENTS * 100 / operations)


def loops() -> tuple[str, dict[str, int]]:
    """Return the C text of a loop for every kernel with a block version, and operations by kernel."""
    manifest = json.loads((drift.folder() / "manifest.json").read_text(encoding="utf-8"))
    text, operations = "", {}
    for family in families().values():
        record = recorded(family, manifest)
        names = emit.block_kernels(record) if family.role == "law" else []
        values = timing.sample(family, record.programs, compiled) if names else {}
        for program in record.programs:
            if program.name not in names:
                continue
            kernel = program.name.removeprefix(f"{family.name}_")
            operations[program.name] = sum(program.operations().values())
            n = values["e"].size
            places = {"e": f"e + k * {n}", "v": f"v + k * {n}", "A": "A", "l": "l", "tau": "some.tau"}
            given = ", ".join(places[a.name] for a in program.inputs)
            size = program.outputs[0].size
            fill = {"A": _numbers(values["A"]), "e": _numbers(values["e"]), "v": _numbers(values.get("v", [0.0] * n)),
                    "l": repr(float(values["l"])), "tau": repr(float(values.get("tau", 1.0))), "n": str(n),
                    "CALL": f"{program.name}({given}, out + k * {size})", "LAW": family.name, "KERNEL": kernel,
                    "TIMES": str(times(operations[program.name])), "ELEMENTS": str(ELEMENTS)}
            loop = LOOP
            for name, value in fill.items():
                loop = loop.replace(f"@{name}@", value)
            text += loop
    return text, operations


def _numbers(values) -> str:
    return ", ".join(repr(float(v)) for v in np.ravel(values))


def rows(repetitions: int) -> list[dict]:
    """Return the table; empty on machines without blocks."""
    if platform.machine() not in ("x86_64", "AMD64"):
        return []
    text, operations = loops()
    program = PROGRAM.replace("@LOOPS@", text).replace("@SIZE@", str(32 * ELEMENTS))
    least: dict[str, np.ndarray] = {}
    with tempfile.TemporaryDirectory() as folder:
        source, binary = Path(folder) / "blocks_loop.c", Path(folder) / "blocks_loop"
        source.write_text(program.replace("@ELEMENTS@", str(ELEMENTS)), encoding="utf-8")
        laws = [drift.folder() / f"{name}.c" for name, family in families().items() if family.role == "law"]
        units, flags = [], [*FLAGS, *["-O0"] * Parser.smallest]
        for unit in (drift.folder() / "blocks.c", *laws, source):
            units.append(Path(folder) / f"{unit.stem}.o")
            subprocess.run([*compiler(), *flags, f"-I{drift.folder()}", "-c", unit, "-o", units[-1]], check=True)
        subprocess.run([*compiler(), *units, "-lm", "-o", binary], check=True)
        for _ in range(repetitions):
            for line in subprocess.run([binary], capture_output=True, text=True, check=True).stdout.splitlines():
                name, *times = line.split()
                numbers = np.array(times, dtype=float)
                best = np.maximum if name == "peak" else np.minimum
                least[name] = best(least.get(name, numbers), numbers)
    peak = least.pop("peak")[1]
    print(f"peak: {peak:.1f} Gflop/s (fused multiply-adds, AVX2)")
    return [{"kernel": name, "operations": operations[name], "ns_single": single, "ns_block": block,
             "gain": single / block, "gflop_per_s": operations[name] / block,
             "of_peak": operations[name] / block / peak} for name, (single, block) in least.items()]


def main() -> None:
    """Measure and print."""
    options = arguments(__doc__, repetitions=(7, "of the round of kernels"))
    if found := rows(options.repetitions):
        show(found, options.out)
    else:
        print(f"no kernels of several elements on {platform.machine()}")


if __name__ == "__main__":
    main()
