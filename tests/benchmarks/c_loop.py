"""The generated kernels in a C loop on one thread: microseconds a call, and bytes of code."""

from __future__ import annotations

import os
import re
import shlex
import subprocess
import sysconfig
from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
from funicular.derive import drift, emit, verify_numbers
from funicular.derive.families import families
from funicular.derive.verify_states import states
from funicular.generated import kernels as compiled

PROGRAM = """#define _POSIX_C_SOURCE 199309L
#include <stdio.h>
#include <time.h>
#include "kernels.h"
static double now(void) { struct timespec t; clock_gettime(CLOCK_MONOTONIC, &t); return t.tv_sec + 1e-9 * t.tv_nsec; }
static double sum;
@LOOPS@
int main(void)
{
@CALLS@
    return sum == 1234.5;
}
"""
# the inputs change from call to call, by less than their last place, so that no call can be left out
LOOP = """static void loop_@NAME@(void)
{
@ARRAYS@
    const double begin = now();
    for (long i = 0; i < @TIMES@; ++i) {
        @NAME@(@ARGUMENTS@);
        @MOVED@[i % (sizeof @MOVED@ / sizeof *@MOVED@)] += 1e-300 * @OUT@[0];
        sum += @OUT@[0];
    }
    printf("@NAME@ %.6g\\n", (now() - begin) / @TIMES@ * 1e6);
}
"""
OPERATIONS = 2e7  # of one loop: some milliseconds


def options() -> list[str]:
    """The compiler and the optimisation of the package's own build."""
    level = re.findall(r"-O\w", sysconfig.get_config_var("CFLAGS") or "")[-1:] or ["-O2"]
    return [*shlex.split(os.environ.get("CC", "cc")), "-std=c11", *level]


def build(folder: Path, manifest: dict) -> Path:
    """The program in ``folder``: a loop for every kernel of the manifest, and generated/*.c as it stands."""
    loops = []
    for family in families().values():
        record = emit.recorded(family, manifest)
        values = _sample(family, record.programs)
        loops += [_loop(program, values) for program in record.programs]
    text = PROGRAM.replace("@LOOPS@", "\n".join(loops))
    text = text.replace("@CALLS@", "\n".join(f"    loop_{name}();" for name in manifest["kernels"]))
    (folder / "loop.c").write_text(text, encoding="utf-8")
    sources = [folder / "loop.c", *(drift.folder() / f"{name}.c" for name in manifest["families"])]

    def compile_(source: Path) -> Path:
        made = folder / f"{source.stem}.o"
        subprocess.run([*options(), f"-I{drift.folder()}", "-c", source, "-o", made], check=True)
        return made

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        objects = list(pool.map(compile_, sources))
    subprocess.run([*options(), *objects, "-lm", "-o", folder / "loop"], check=True)
    return folder / "loop"


def _sample(family, programs) -> dict[str, np.ndarray]:
    """The first state on which the family is verified; its constants from the compiled kernels."""
    def call(name, inputs):
        outputs = next(p.outputs for p in programs if p.name == name)
        results = getattr(compiled, name)(*inputs)
        return dict(zip((a.name for a in outputs), results if len(outputs) > 1 else [results], strict=True))

    return states(family, verify_numbers.real(family.name, programs, call))[0]


def _loop(program: emit.Recorded, values: dict[str, np.ndarray]) -> str:
    arrays, arguments = [], []
    for argument in program.inputs:
        numbers = ", ".join(repr(float(v)) for v in np.ravel(values[argument.name]))
        arrays.append(f"    static double {argument.name}_[] = {{{numbers}}};")
        arguments.append(f"{argument.name}_[0]" if argument.shape == () else f"{argument.name}_")
    for argument in program.outputs:
        arrays.append(f"    static double {argument.name}_[{argument.size}];")
        arguments.append(f"{argument.name}_")
    moved = max(program.inputs, key=lambda a: (a.name == "e", a.size))
    fill = {"NAME": program.name, "ARRAYS": "\n".join(arrays), "ARGUMENTS": ", ".join(arguments),
            "MOVED": f"{moved.name}_", "OUT": f"{program.outputs[0].name}_",
            "TIMES": str(int(OPERATIONS / (sum(program.operations().values()) + 20)))}
    text = LOOP
    for name, value in fill.items():
        text = text.replace(f"@{name}@", value)
    return text


def times(program: Path, repetitions: int) -> dict[str, list[float]]:
    """Microseconds a call by kernel; every repetition is a round of all of them."""
    taken: dict[str, list[float]] = {}
    for _ in range(repetitions):
        for line in _output([program]):
            name, value = line.split()
            taken.setdefault(name, []).append(float(value))
    return taken


def code_sizes(program: Path) -> dict[str, int]:
    """Bytes of code by function, as nm tells; empty without nm."""
    try:
        lines = [line.split() for line in _output(["nm", "-S", program])]
    except (OSError, subprocess.CalledProcessError):
        return {}
    return {line[3]: int(line[1], 16) for line in lines if len(line) == 4}


def _output(command: Iterable) -> list[str]:
    return subprocess.run(list(command), capture_output=True, text=True, check=True).stdout.splitlines()
