"""Time of generated kernels in a C loop, one thread: for `funicular derive --spec` and for tests/benchmarks.

Each kernel is called on a bent, stretched and turned element (verify_states.py), its arguments changing from call to
call so that no call can be left out.
"""

from __future__ import annotations

import math
import subprocess
from collections.abc import Iterable, Mapping
from pathlib import Path

import numpy as np
from funicular.derive import emit
from funicular.derive.spec import Family
from funicular.derive.verify_compile import compiler
from funicular.derive.verify_numbers import Numbers
from funicular.derive.verify_states import states

LEAST_SECONDS = 4e-3  # of one timed loop: long against the clock's step
_PROGRAM = """#define _POSIX_C_SOURCE 199309L
#include <stdio.h>
#include <time.h>
#include "kernels.h"
static double now(void) {{ struct timespec t; clock_gettime(CLOCK_MONOTONIC, &t); return t.tv_sec + 1e-9 * t.tv_nsec; }}
static double sum;
{loops}
int main(void)
{{
{calls}
    return sum == 1234.5;
}}
"""
_LOOP = """
{arrays}
static void time_{name}(void)
{{
    double seconds = 0.0;
    long calls = 64;
    while (seconds < {least}) {{
        calls *= 2;
        const double begin = now();
        for (long i = 0; i < calls; ++i) {{
            {name}({arguments});
            {changed} += 1e-300 * {result}[0];
            sum += {result}[0];
        }}
        seconds = now() - begin;
    }}
    printf("{name} %.6g\\n", seconds / calls * 1e6);
}}
"""


def measure(names: Iterable[str], families: Mapping[str, Family], manifest: dict, kernels, units: Iterable[Path],
            header: Path, work: Path, level: str = "-O3", repetitions: int = 5) -> list[dict]:
    """A row for each kernel: microseconds a call (best of rounds that take turns), operations, bytes of code.

    names: of kernels; manifest: what it says of them; kernels: their Python face; units: the C or object files that
    hold them; header: the folder of kernels.h; work: one for the program.
    """
    loops, used = [], {}
    for name in names:
        family = manifest["kernels"][name]["family"]
        used[family] = used.get(family) or _state(families[family], manifest, kernels)
        loops.append((name, _loop(name, manifest["kernels"][name], used[family])))
    source, program = work / "loop.c", work / "loop"
    source.write_text(_PROGRAM.format(loops="".join(text for _, text in loops),
                                      calls="\n".join(f"    time_{name}();" for name, _ in loops)), encoding="utf-8")
    subprocess.run([*compiler(), "-std=c11", level, f"-I{header}", source, *units, "-lm", "-o", program], check=True)
    times: dict[str, list[float]] = {name: [] for name, _ in loops}
    for _ in range(repetitions):
        for line in subprocess.run([program], capture_output=True, text=True, check=True).stdout.splitlines():
            times[line.split()[0]].append(float(line.split()[1]))
    sizes = code_sizes(program)
    return [{"kernel": name, "us": min(taken), **manifest["kernels"][name]["operations"],
             "code_bytes": sizes.get(name, "")} for name, taken in times.items()]


def code_sizes(program: Path) -> dict[str, int]:
    """Bytes of code by kernel, as nm tells; empty without nm."""
    try:
        listed = subprocess.run(["nm", "-S", program], capture_output=True, text=True, check=True).stdout
    except (OSError, subprocess.CalledProcessError):
        return {}
    lines = [line.split() for line in listed.splitlines()]
    return {line[3]: int(line[1], 16) for line in lines if len(line) == 4}


def _state(family: Family, manifest: dict, kernels) -> dict[str, np.ndarray]:
    """A bent state of a family, with the constants that its kernels make for each other."""
    programs = emit.recorded(family, manifest).programs
    outputs = {p.name: [a.name for a in p.outputs] for p in programs}

    def call(name: str, inputs) -> dict[str, np.ndarray]:
        found = getattr(kernels, name)(*inputs)
        return dict(zip(outputs[name], found if isinstance(found, tuple) else (found,), strict=True))

    numbers = Numbers(family.name, programs, call, math, lambda v: v.astype(float))
    return states(family, numbers)[0]


def _loop(name: str, entry: dict, state: Mapping[str, np.ndarray]) -> str:
    arrays, arguments = [], []
    for given in entry["inputs"]:
        symbol = f"{name}_{given['name']}"
        values = np.ravel(state[given["name"]]).tolist()
        arrays.append(f"static double {symbol}[{len(values)}] = {{{', '.join(map(repr, values))}}};")
        arguments.append(symbol if given["shape"] else f"{symbol}[0]")
    results = [f"{name}_{out['name']}_out" for out in entry["outputs"]]
    arrays += [f"static double {symbol}[{math.prod(out['shape'])}];"
               for symbol, out in zip(results, entry["outputs"], strict=True)]
    changed = next(f"{name}_{given['name']}[0]" for given in reversed(entry["inputs"]) if given["shape"])
    return _LOOP.format(arrays="\n".join(arrays), name=name, arguments=", ".join([*arguments, *results]),
                        changed=changed, result=results[0], least=LEAST_SECONDS)
