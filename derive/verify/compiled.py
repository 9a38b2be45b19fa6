"""The checked-in C, compiled on the spot and called through ctypes, for real and for complex numbers.

A shim gives every kernel one signature, an array of pointers, because ctypes cannot pass complex numbers by value.
"""

from __future__ import annotations

import ctypes
import hashlib
import os
import shlex
import shutil
import subprocess
import sysconfig
from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np

from ..codegen.program import Program

SHARED_FLAGS = ("-std=c11", "-O3", "-fPIC")
"""Options for the C of a library that is used, not only verified."""

COMPILERS = ThreadPoolExecutor(2)
"""Compilers that run beside the derivation: for real and for complex numbers."""


class CompilerError(Exception):
    """No C compiler, or it refused the generated text."""


def compiler() -> list[str]:
    """Return the C compiler: $CC, then the one that built this Python, then cc, gcc, clang.

    Raises CompilerError where there is none.
    """
    for candidate in (os.environ.get("CC"), sysconfig.get_config_var("CC"), "cc", "gcc", "clang"):
        words = shlex.split(candidate or "")
        if words and shutil.which(words[0]):
            return words
    raise CompilerError("no C compiler found (tried $CC, cc, gcc, clang): install one, or set CC to its command")


def compile_units(sources: Iterable[Path], flags: Iterable[str], work: Path) -> list[Path]:
    """Return the object files in a folder from C files, compiled side by side. Raises CompilerError with the first
    messages.
    """
    def start(source: Path) -> subprocess.CompletedProcess[str]:
        command = [*compiler(), *flags, "-c", str(source), "-o", str(work / f"{source.stem}.o")]
        return subprocess.run(command, stderr=subprocess.PIPE, text=True)

    sources = list(sources)
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        for source, done in zip(sources, pool.map(start, sources), strict=True):
            if done.returncode:
                raise CompilerError(f"the C compiler refuses {source.name}:\n"
                                    + "\n".join(done.stderr.splitlines()[:12]))
    return [work / f"{source.stem}.o" for source in sources]


def link_shared(units: list[Path], folder: Path) -> Path:
    """Link object files to a shared library in a folder.

    The name holds a hash of the file, since a process that has one of that name open gets no other.
    """
    linked = folder / "kernels.so"
    subprocess.run([*compiler(), "-shared", *units, "-lm", "-o", linked], check=True)
    return linked.rename(folder / f"kernels-{hashlib.sha256(linked.read_bytes()).hexdigest()[:12]}.so")


class Library:
    """The kernels of one generated file for one kind of number; compilation runs beside the caller until `load`."""

    def __init__(self, family: str, programs: Iterable[Program], generated: Path, work: Path, dtype: type):
        self.programs, self.dtype, self.family = {p.name: p for p in programs}, dtype, family
        stem = f"{family}_{dtype.__name__}"
        shim = work / f"{stem}_shim.c"
        shim.write_text(self._shim(), encoding="utf-8")
        self._path = work / f"{stem}.so"
        define = ["-DFU_COMPLEX"] if dtype is complex else []
        # no optimisation: what is verified is the text, and the large kernels compile ten times faster
        command = [*compiler(), "-O0", "-w", "-fPIC", "-shared", *define, f"-I{generated}", "-o", str(self._path),
                   str(generated / f"{family}.c"), str(shim), "-lm"]
        self._compilation = COMPILERS.submit(subprocess.run, command, stderr=subprocess.PIPE, text=True)
        self._functions: dict[str, Any] = {}

    def _shim(self) -> str:
        lines = ['#include "kernels.h"']
        for name, program in self.programs.items():
            arguments = [f"*a[{i}]" if a.shape == () else f"a[{i}]" for i, a in enumerate(program.inputs)]
            arguments += [f"a[{len(program.inputs) + i}]" for i in range(len(program.outputs))]
            lines.append(f"void call_{name}(fu_real *const *a) {{ {name}({', '.join(arguments)}); }}")
        return "\n".join(lines) + "\n"

    def load(self) -> Library:
        """Wait for the compiler. Raises CompilerError with its first messages."""
        done = self._compilation.result()
        if done.returncode:
            first = "\n".join(done.stderr.splitlines()[:12])
            raise CompilerError(f"generated/{self.family}.c does not compile; `funicular derive --check` says what "
                                f"differs from the specs\n{first}")
        shared = ctypes.CDLL(str(self._path))
        self._functions = {name: getattr(shared, f"call_{name}") for name in self.programs}
        return self

    def __call__(self, name: str, inputs: Iterable[np.ndarray]) -> dict[str, np.ndarray]:
        """Return the outputs of a kernel by name; every call has fresh arrays, with not-a-number where nothing was
        written.
        """
        program = self.programs[name]
        arrays: list[np.ndarray] = [np.ascontiguousarray(v, dtype=self.dtype) for v in inputs]
        for argument, array in zip(program.inputs, arrays, strict=True):
            if array.size != argument.size:
                raise ValueError(f"{name}: {argument.name} must have shape {argument.shape}, got {array.shape}")
        outputs: dict[str, np.ndarray] = {a.name: np.full(a.shape, np.nan, dtype=self.dtype) for a in program.outputs}
        pointers = [a.ctypes.data for a in (*arrays, *outputs.values())]
        self._functions[name]((ctypes.c_void_p * len(pointers))(*pointers))
        return outputs
