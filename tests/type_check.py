"""The types of the package, checked by mypy over all three folders as they stand once they are installed.

The folders runtime, derive and generated are one package only then, so mypy gets the copy that import-linter gets, too.

    python tests/type_check.py
"""

from __future__ import annotations

from pathlib import Path

from import_contracts import TOP, check, complaint


def type_errors(directory: Path) -> str:
    """Return what mypy says of the package in a directory, empty where its types are right."""
    return complaint(directory, "-m", "mypy", "--config-file", str(TOP / "pyproject.toml"), "--cache-dir",
                     str(TOP / ".mypy_cache"), "--no-error-summary", "--package", "funicular")


if __name__ == "__main__":
    check(type_errors, "all types are right")
