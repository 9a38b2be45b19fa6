"""Kernels at several points at once equal those at one point."""

import ctypes
import json
import platform
import subprocess
import sys

import numpy as np
import pytest
from funicular.derive.catalogue import families
from funicular.derive.codegen import drift
from funicular.derive.codegen.manifest import recorded
from funicular.derive.codegen.rendering import POINT_BLOCKS
from funicular.derive.verify.compiled import compiler
from funicular.generated import kernels

POINTS = 4
SAME_BITS = platform.machine() in ("x86_64", "AMD64")  # no contraction to fused operations there
FAMILIES = [name for name, family in families().items() if family.role in POINT_BLOCKS]
pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="calls a compiler of Unix")


@pytest.fixture(scope="module", params=[[], ["-D__builtin_cpu_supports(name)=0"]], ids=["machine", "plain"])
def library(request, tmp_path_factory):
    """Return the library as it chooses its kernels on this machine, and as on one without AVX2."""
    made = tmp_path_factory.mktemp("point_blocks") / "point_blocks.so"
    folder = drift.folder()
    subprocess.run([*compiler(), "-std=c11", "-O1", "-w", "-shared", "-fPIC", *request.param, f"-I{folder}",
                    folder / "point_blocks.c", "-lm", "-o", made], check=True)
    return ctypes.CDLL(made)


def aligned(values):
    """Return an array of the values at an address that vectors of numbers may have."""
    memory = np.empty(values.size + POINTS)
    first = -(memory.ctypes.data // 8) % POINTS
    found = memory[first:first + values.size].reshape(values.shape)
    found[:] = values
    return found


@pytest.mark.parametrize("name", FAMILIES)
def test_blocks_give_what_single_points_give(library, name):
    family = families()[name]
    table = POINT_BLOCKS[family.role]
    find = getattr(library, f"fu_{family.role}_blocks_of")
    find.restype = ctypes.POINTER(ctypes.c_void_p)
    entry, rng = find(name.encode()), np.random.default_rng(8)
    manifest = json.loads((drift.folder() / "manifest.json").read_text(encoding="utf-8"))
    programs = {p.name: p for p in recorded(family, manifest).programs}
    for place, kernel in enumerate(table, 1):  # after the name
        if kernel in family.missing:
            assert not entry[place], kernel
            continue
        program = programs[f"{name}_{kernel}"]
        given = [aligned(0.1 + rng.random((a.size, POINTS))) for a in program.inputs]
        found = [aligned(np.zeros((a.size, POINTS))) for a in program.outputs]
        call = ctypes.CFUNCTYPE(None, *[ctypes.c_void_p] * (len(given) + len(found)))(entry[place])
        call(*(array.ctypes.data for array in (*given, *found)))
        for point in range(POINTS):
            one = getattr(kernels, program.name)(*(
                array[:, point].reshape(a.shape) if a.shape else float(array[0, point])
                for array, a in zip(given, program.inputs, strict=True)))
            for several, single in zip(found, one if isinstance(one, tuple) else (one,), strict=True):
                np.testing.assert_allclose(several[:, point], np.ravel(single), rtol=0 if SAME_BITS else 1e-13,
                                           err_msg=f"{program.name}, point {point}")
