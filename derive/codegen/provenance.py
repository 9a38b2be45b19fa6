"""Which files decide the text of a family, and their hashes: the specs, what they import here, and what prints them.

The hash of a Python file is that of its statements. Comments, docstrings and layout leave it as it is.
"""

from __future__ import annotations

import ast
import hashlib
from collections.abc import Collection, Iterable, Iterator
from functools import cache
from importlib import resources
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .family import Family

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


def hashes(families: Collection[Family]) -> dict[str, str]:
    """Return the hash of each file that decides one of the families, by name in order; a user's file begins with "./".
    """
    files = {file for family in families for file in deciding(family.modules)}
    own = {f"./{family.spec.name}": _hash_of_python(family.spec.read_bytes()) for family in families if family.spec}
    return dict(sorted(({file: _hash(file) for file in files} | own).items()))


def short_hash(content: bytes) -> str:
    """Return the SHA-256 of a content, shortened, as the manifest keeps it."""
    return hashlib.sha256(content).hexdigest()[:16]


def _hash(file: str) -> str:
    return _hash_of_python(_read(file)) if file.endswith(".py") else short_hash(_read(file))


@cache
def _hash_of_python(source: bytes) -> str:
    return short_hash(_spelled(ast.parse(source)).encode())


def _spelled(node: object) -> str:
    """Return the text of a node of a syntax tree without its docstrings, the same for all versions of Python.

    Empty fields are left out: a version adds some for statements that only later code can have.
    """
    if isinstance(node, list):
        return f"[{', '.join(_spelled(each) for each in node if not _is_docstring(each))}]"
    if isinstance(node, ast.AST) and not isinstance(node, ast.Constant):
        fields = [f"{name}={_spelled(value)}" for name, value in ast.iter_fields(node) if value not in (None, [])]
        return f"{type(node).__name__}({', '.join(fields)})"
    return ascii(node.value if isinstance(node, ast.Constant) else node)


def _is_docstring(node: object) -> bool:
    """Return whether a statement is a string alone, of a module, class, function or constant."""
    return isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str)


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
