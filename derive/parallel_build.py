"""Build of the extension modules with their C files side by side: setuptools compiles those of one module in turn."""

from __future__ import annotations

import os
from concurrent.futures import ThreadPoolExecutor

from setuptools.command.build_ext import build_ext


class ParallelBuild(build_ext):
    """build_ext of pyproject.toml."""

    def build_extensions(self) -> None:
        """Build all modules; files in a pool of as many threads as there are cores, each calling the compiler."""
        compile_in_turn = self.compiler.compile
        with ThreadPoolExecutor(os.cpu_count()) as pool:

            def compile_side_by_side(sources: list[str], *args, **kwargs) -> list[str]:
                largest_first = sorted(sources, key=lambda path: -os.path.getsize(path))
                done = dict(zip(largest_first, pool.map(lambda path: compile_in_turn([path], *args, **kwargs),
                                                        largest_first), strict=True))
                return [done[path][0] for path in sources]

            self.compiler.compile = compile_side_by_side
            super().build_extensions()
