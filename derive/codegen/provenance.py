"""Which files decide a family's text, and their hash: the specs, all that they import here, and what prints them."""

from __future__ import annotations

import ast
import hashlib
from collections.abc import Iterable, Iterator
from functools import cache
from importlib import resources
from pathlib import Path

PACKAGE = "funicular.derive"
PRINTING = ("codegen.c_printer", "codegen.rendering")
TEMPLATES = ("codegen/templates/family.c.jinja", "codegen/templates/stages.h.jinja")


def deciding(roots: Iterable[str]) -> tuple[str, ...]:
    """Return the files that decide a family whose specs are the modules `roots`, in order of first mention."""
    found: dict[str, None] = {}
    waiting = [*roots, *PRINTING]
    while waiting:
        module = waiting.pop(0)
        if module not in found:
            found[module] = None
            waiting[:0] = _imports(module)
    return (*(_file(m) for m in found), *TEMPLATES)


def spec_hash(files: Iterable[str], spec: Path | None = None) -> str:
    """Return the SHA-256 over the text of files here and of the user's file, shortened."""
    digest = hashlib.sha256()
    for file in files:
        digest.update(_read(file))
    if spec is not None:
        digest.update(spec.read_bytes())
    return digest.hexdigest()[:16]


@cache
def _imports(module: str) -> tuple[str, ...]:
    return tuple(m for node in ast.walk(ast.parse(_read(_file(module)))) for m in _named(node, module))


def _named(node: ast.AST, module: str) -> Iterator[str]:
    """Return the modules of this package that a relative import in `module` names; absolute imports are of other
    packages.
    """
    if isinstance(node, ast.ImportFrom) and node.level:
        path = module.split(".")
        depth = len(path) - node.level + _file(module).endswith("__init__.py")
        inner = ".".join([*path[:depth], *([node.module] if node.module else [])])
        for name in (f"{inner}.{a.name}".lstrip(".") for a in node.names):
            yield name if _exists(name) else inner


def _exists(module: str) -> bool:
    return (resources.files(PACKAGE) / _file(module)).is_file()


def _file(module: str) -> str:
    path = module.replace(".", "/")
    package = f"{path}/__init__.py"
    return package if (resources.files(PACKAGE) / package).is_file() else f"{path}.py"


def _read(file: str) -> bytes:
    return (resources.files(PACKAGE) / file).read_bytes()
