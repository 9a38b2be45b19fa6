"""`python derive [--check] [NAME...]`: `funicular derive` in a clone whose engine is not compiled.

It needs numpy, rich, and SymPy, mpmath and Jinja as the extra `test` pins them. The package funicular is not imported:
its __init__ would load the engine.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from types import ModuleType


def main() -> int:
    """Derive what the command line asks for and return the exit code."""
    parser = argparse.ArgumentParser(prog="python derive", description="Derive the equations and write generated/.")
    parser.add_argument("names", nargs="*", metavar="NAME", help="family of kernels (all by default)")
    parser.add_argument("--check", action="store_true", help="write nothing; fail if the files differ")
    given = parser.parse_args()
    top = Path(__file__).resolve().parents[1]
    package = ModuleType("funicular")
    package.__path__ = [str(top / "runtime"), str(top)]  # in a clone; once installed, the second holds all folders
    sys.modules["funicular"] = package
    from funicular.derive.pipeline import main as derive

    return derive(given.names, given.check)


if __name__ == "__main__":
    sys.exit(main())
