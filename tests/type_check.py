"""The types of the package, checked by mypy over all three folders as they stand once they are installed.

The folders runtime, derive and generated are one package only then, so mypy gets the copy that import-linter gets, too.

    python tests/type_check.py
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path

from import_contracts import TOP, installed_tree


def type_errors(directory: Path) -> str:
    """Return what mypy says of the package in a directory, empty where its types are right."""
    command = [sys.executable, "-m", "mypy", "--config-file", str(TOP / "pyproject.toml"), "--cache-dir",
               str(TOP / ".mypy_cache"), "--no-error-summary", "--package", "funicular"]
    found = subprocess.run(command, cwd=directory, capture_output=True, text=True, check=False)
    return "" if found.returncode == 0 else found.stdout + found.stderr


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as directory:
        installed_tree(Path(directory))
        if complaint := type_errors(Path(directory)):
            sys.exit(complaint)
    print("all types are right")
