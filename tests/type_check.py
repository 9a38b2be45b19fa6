"""The types of the package, checked by mypy over all three folders as installed.

    python tests/type_check.py
"""

from __future__ import annotations

from pathlib import Path

from import_contracts import TOP, check, complaint


def type_errors(directory: Path) -> str:
    """Return the report of mypy on the package in a directory, empty without errors."""
    return complaint(directory, "-m", "mypy", "--config-file", str(TOP / "pyproject.toml"), "--cache-dir",
                     str(TOP / ".mypy_cache"), "--no-error-summary", "--package", "funicular")


if __name__ == "__main__":
    check(type_errors, "all types are right")
