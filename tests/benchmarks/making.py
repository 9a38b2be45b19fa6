"""The making of the package: derivation of every family, build of a clean clone."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from funicular.derive.catalogue import families
from funicular.derive.codegen import rendering as emit

ROOT = Path(__file__).parents[2]


def derivation() -> dict[str, float]:
    """Return CPU seconds by family, from the spec to the text of its file, in one process."""
    taken = {}
    for name, family in families().items():
        begin = time.process_time()
        emit.render([emit.derive(family)], [name], lambda _: None)
        taken[name] = time.process_time() - begin
    return taken


def build() -> tuple[float, float]:
    """Return wall and CPU seconds of a wheel from a clean clone, without a compiler cache, with installed tools."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run(["git", "clone", "--quiet", ROOT, Path(folder) / "clone"], check=True)
        begin, before = time.perf_counter(), os.times()
        subprocess.run([sys.executable, "-m", "pip", "wheel", "--quiet", "--no-build-isolation", "--no-deps",
                        "--wheel-dir", folder, Path(folder) / "clone"], check=True, stderr=subprocess.DEVNULL,
                       env=os.environ | {"CCACHE_DISABLE": "1"})
        after = os.times()
    cpu = after.children_user + after.children_system - before.children_user - before.children_system
    return time.perf_counter() - begin, cpu
