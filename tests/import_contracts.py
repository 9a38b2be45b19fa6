"""The contracts on imports in pyproject.toml, checked by import-linter over all three folders of the package.

The folders runtime, derive and generated form one package only when installed. import-linter looks for packages below
packages, so that it gets an installed copy.

    python tests/import_contracts.py
"""

from __future__ import annotations

import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

TOP = Path(__file__).parents[1]
PACKAGES = {"runtime": "funicular", "derive": "funicular/derive", "generated": "funicular/generated"}


def installed_tree(directory: Path) -> None:
    """Copy the Python files and type stubs of the package to the places of an installed one."""
    for folder, package in PACKAGES.items():
        for file in (TOP / folder).rglob("*.py*"):
            if file.suffix not in (".py", ".pyi"):
                continue
            copy = directory / package / file.relative_to(TOP / folder)
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(file, copy)
        for file in (TOP / folder).glob("*.pyx"):  # Cython: a module that others import
            (directory / package / file.with_suffix(".py").name).touch()


def complaint(directory: Path, *options: str) -> str:
    """Run Python with these options in a directory; return its output if it fails, else an empty text."""
    found = subprocess.run([sys.executable, *options], cwd=directory, capture_output=True, text=True, check=False)
    return "" if found.returncode == 0 else found.stdout + found.stderr


def broken_contracts(directory: Path) -> str:
    """Return the report of import-linter on the package in a directory, empty if all contracts hold."""
    return complaint(directory, "-c", "from importlinter.cli import lint_imports_command; lint_imports_command()",
                     "--config", str(TOP / "pyproject.toml"), "--no-cache")


def check(errors_in: Callable[[Path], str], passed: str) -> None:
    """Search a copy of the package for errors; exit with them, or print that there are none."""
    with tempfile.TemporaryDirectory() as directory:
        installed_tree(Path(directory))
        if found := errors_in(Path(directory)):
            sys.exit(found)
    print(passed)


if __name__ == "__main__":
    check(broken_contracts, "all contracts on imports are kept")
