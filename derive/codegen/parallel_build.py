"""Build of the extension modules: their C files side by side, since setuptools compiles those of one module in turn;
OpenMP for those that take it, where the compiler has it.
"""

from __future__ import annotations

import os
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from setuptools.command.build_ext import build_ext
from setuptools.errors import CompileError, LinkError

THREADED = ("funicular.engine",)
OPENMP = "-fopenmp"


class ParallelBuild(build_ext):
    """The command build_ext that pyproject.toml names."""

    def build_extensions(self) -> None:
        """Build all modules; files in a pool of as many threads as there are cores, each calling the compiler."""
        if self._has_openmp():
            for module in self.extensions:
                if module.name in THREADED:
                    module.extra_compile_args.append(OPENMP)
                    module.extra_link_args.append(OPENMP)
        compile_in_turn = self.compiler.compile
        with ThreadPoolExecutor(os.cpu_count()) as pool:

            def compile_side_by_side(sources: list[str], *args, **kwargs) -> list[str]:
                largest_first = sorted(sources, key=lambda path: -os.path.getsize(path))
                done = dict(zip(largest_first, pool.map(lambda path: compile_in_turn([path], *args, **kwargs),
                                                        largest_first), strict=True))
                return [done[path][0] for path in sources]

            self.compiler.compile = compile_side_by_side
            super().build_extensions()

    def _has_openmp(self) -> bool:
        """Return whether a program with it compiles and links."""
        with tempfile.TemporaryDirectory() as folder:
            source = Path(folder) / "openmp.c"
            source.write_text("#include <omp.h>\nint main(void) { return omp_get_max_threads() < 1; }\n")
            try:
                objects = self.compiler.compile([str(source)], output_dir=folder, extra_postargs=[OPENMP])
                self.compiler.link_executable(objects, str(Path(folder) / "openmp"), extra_postargs=[OPENMP])
            except (CompileError, LinkError):
                return False
        return True
