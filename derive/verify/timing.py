"""Kernels in a C loop on one thread: microseconds a call, and bytes of code.

For `funicular derive --spec` and for tests/benchmarks. Each kernel gets the sample on which it is verified.
"""

from __future__ import annotations

import subprocess
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ..codegen.family import Family
from ..codegen.manifest import recorded
from ..codegen.program import Program
from ..codegen.rendering import Recorded
from . import numbers as verify_numbers
from .compiled import compiler
from .samples import states

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
# no call waits for the one before it, as none does in an assembly over elements; kernels are compiled on their own, so
# that none can be left out
LOOP = """static void loop_@NAME@(void)
{
@ARRAYS@
    const double begin = now();
    for (long i = 0; i < @TIMES@; ++i) {
        @NAME@(@ARGUMENTS@);
        sum += @OUT@[0];
    }
    printf("@NAME@ %.6g\\n", (now() - begin) / @TIMES@ * 1e6);
}
"""
OPERATIONS = 2e7  # of one loop: some milliseconds


def build(families: Iterable[Family], manifest: dict[str, Any], kernels: Any, units: Iterable[Path],
          flags: Iterable[str], work: Path) -> Path:
    """Return a program with a loop for every kernel of the families.

    manifest: what it says of them; kernels: their Python face; units: the object files that hold them; flags: of the
    compiler, with the folder of kernels.h; work: the folder for the program.
    """
    loops, names = [], []
    for family in families:
        record = recorded(family, manifest)
        assert record is not None  # families are those of the manifest
        values = sample(family, record.programs, kernels)
        loops += [_loop(program, values) for program in record.programs]
        names += [program.name for program in record.programs]
    text = PROGRAM.replace("@LOOPS@", "\n".join(loops))
    source, program = work / "loop.c", work / "loop"
    source.write_text(text.replace("@CALLS@", "\n".join(f"    loop_{name}();" for name in names)), encoding="utf-8")
    subprocess.run([*compiler(), *flags, source, *units, "-lm", "-o", program], check=True)
    return program


def times(program: Path, repetitions: int) -> dict[str, list[float]]:
    """Return the microseconds a call by kernel; every repetition is a round of all of them."""
    taken: dict[str, list[float]] = {}
    for _ in range(repetitions):
        for line in _output([program]):
            name, value = line.split()
            taken.setdefault(name, []).append(float(value))
    return taken


def code_sizes(program: Path) -> dict[str, int]:
    """Return the bytes of code by function, as nm tells; empty without nm."""
    try:
        lines = [line.split() for line in _output(["nm", "-S", program])]
    except (OSError, subprocess.CalledProcessError):
        return {}
    return {line[3]: int(line[1], 16) for line in lines if len(line) == 4}


def _output(command: Iterable[Any]) -> list[str]:
    return subprocess.run(list(command), capture_output=True, text=True, check=True).stdout.splitlines()


def sample(family: Family, programs: Sequence[Program | Recorded], kernels: Any) -> dict[str, np.ndarray]:
    """Return the first state on which the family is verified; its constants from the compiled kernels."""
    outputs = {p.name: [a.name for a in p.outputs] for p in programs}

    def call(name: str, inputs: Sequence[np.ndarray]) -> Any:
        results = getattr(kernels, name)(*inputs)
        return dict(zip(outputs[name], results if isinstance(results, tuple) else (results,), strict=True))

    return states(family, verify_numbers.real(family.name, programs, call))[0]


def _loop(program: Program | Recorded, values: Mapping[str, np.ndarray]) -> str:
    arrays, arguments = [], []
    for argument in program.inputs:
        numbers = ", ".join(repr(float(v)) for v in np.ravel(values[argument.name]))
        arrays.append(f"    static double {argument.name}_[] = {{{numbers}}};")
        arguments.append(f"{argument.name}_[0]" if argument.shape == () else f"{argument.name}_")
    for argument in program.outputs:
        arrays.append(f"    static double {argument.name}_[{argument.size}];")
        arguments.append(f"{argument.name}_")
    fill = {"NAME": program.name, "ARRAYS": "\n".join(arrays), "ARGUMENTS": ", ".join(arguments),
            "OUT": f"{program.outputs[0].name}_",
            "TIMES": str(int(OPERATIONS / (sum(program.operations().values()) + 20)))}
    text = LOOP
    for name, value in fill.items():
        text = text.replace(f"@{name}@", value)
    return text
