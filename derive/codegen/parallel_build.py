"""Build of the extension modules. Their C files are found and compiled in parallel: setuptools compiles the files of
one module one after the other. MSVC has its own options, and no threads.
"""

from __future__ import annotations

import os
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

from setuptools.command.build_ext import build_ext

THREADED = ("funicular.engine",)
THREADS = "-pthread"
MSVC = ["/std:c11", "/O2"]
BLOCKS = ("generated/blocks.c", "generated/point_blocks.c")
SOURCES = {"funicular.generated.kernels": ["generated/*.c"],
           "funicular.engine": ["runtime/engine/**/*.c", *BLOCKS]}
"""Patterns of the C files of a module; blocks are compiled into the engine, with the options of its hot loops."""
NOT_OF_KERNELS = (*BLOCKS, "generated/kernels.c")
"""C files in generated/ of another module, and Cython's own."""
DEPENDENCIES = {"funicular.generated.kernels": ["generated/*.h"],
                "funicular.engine": ["generated/*.h", "runtime/engine/**/*.h", "runtime/engine/**/*.pxi"]}
"""Patterns of the files whose change has a module built anew."""


def found(patterns: list[str]) -> list[str]:
    """Return the files below the working folder that match one of the patterns, sorted by pattern and name."""
    return [path.as_posix() for pattern in patterns for path in sorted(Path().glob(pattern))]


def c_files(module: str) -> list[str]:
    """Return the C files of an extension module, without those that Cython writes."""
    return [path for path in found(SOURCES[module])
            if module != "funicular.generated.kernels" or path not in NOT_OF_KERNELS]


class ParallelBuild(build_ext):
    """The command build_ext that pyproject.toml names."""

    def finalize_options(self) -> None:
        """Add to each module the C files that are there."""
        super().finalize_options()
        for module in self.extensions:
            module.sources += [path for path in c_files(module.name) if path not in module.sources]
            module.depends += found(DEPENDENCIES[module.name])

    def build_extensions(self) -> None:
        """Build all modules, with one call of the compiler a file in a pool of one thread a core."""
        is_msvc = self.compiler.compiler_type == "msvc"
        for module in self.extensions:
            if is_msvc:
                module.extra_compile_args = [*MSVC]
            elif module.name in THREADED:
                module.extra_compile_args.append(THREADS)
                module.extra_link_args.append(THREADS)
        compile_in_turn = self.compiler.compile
        with ThreadPoolExecutor(os.cpu_count()) as pool:

            def compile_side_by_side(sources: list[str], *args: Any, **kwargs: Any) -> list[str]:
                largest_first = sorted(sources, key=lambda path: -os.path.getsize(path))
                done = dict(zip(largest_first, pool.map(lambda path: compile_in_turn([path], *args, **kwargs),
                                                        largest_first), strict=True))
                return [done[path][0] for path in sources]

            self.compiler.compile = compile_side_by_side
            super().build_extensions()
