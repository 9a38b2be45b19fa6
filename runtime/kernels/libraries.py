"""Libraries of the user's elements, made by `funicular derive --spec FILE --out DIR`.

A library is machine code, which runs when it is loaded. Only the person who runs a scene may allow that, by naming the
directory in Python or on the command line; otherwise a file that names one is refused (`check_allowed`).
"""

from __future__ import annotations

import ctypes
import hashlib
import json
import math
import os
from collections.abc import Iterable
from pathlib import Path
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import numpy as np
from pydantic import ValidationError

from ..base.deferred import dataclass
from ..errors import FunicularError, SceneError, shown_path
from . import elements
from .elements import MANIFEST, ElementKind

if TYPE_CHECKING:
    from numpy.typing import ArrayLike  # 9 ms, and for type checkers alone

COMMAND = "`funicular derive --spec {spec} --out {out}`"

_loaded: dict[str, tuple[bytes, Library]] = {}


class LibraryError(FunicularError, ValueError):
    """A directory holds no library that this version can use."""

    def __init__(self, cause: str, remedy: str):
        """cause: what is wrong with the directory; remedy: what to do."""
        super().__init__(cause, remedy)

    def __str__(self) -> str:
        return "library " + "; ".join(self.args)


def resolved(directory: str | os.PathLike[str]) -> str:
    """Return a directory's absolute path without links. Raises ValueError for what no path can be."""
    try:
        return os.path.realpath(os.fspath(directory))
    except (TypeError, ValueError):  # not a path; a NUL, or half of a surrogate pair
        raise ValueError(f"must be a directory, got {directory!r}") from None


def check_allowed(asked: str, allowed: Iterable[str | os.PathLike[str]], place: str) -> None:
    """Raise SceneError unless the library that a file names is among the directories that the caller allows.

    asked: its resolved path; place: the part of the file that names it.
    """
    if asked not in set(map(resolved, allowed)):
        raise SceneError(place, f'takes its element from the library "{asked}", which is machine code, and a file '
                         "alone may not load it", "if you trust this directory, allow it: in Python with "
                         f'libraries=["{asked}"], on the command line with --library {asked}')


def manifest_digest(content: dict[str, Any]) -> str:
    """Return sha256 of a library's manifest without its digest."""
    bare = content | {"library": {name: value for name, value in content["library"].items() if name != "digest"}}
    return hashlib.sha256(json.dumps(bare, sort_keys=True).encode()).hexdigest()


def read_manifest(directory: Path) -> tuple[bytes, dict[str, Any]]:
    """Return the manifest of the library in a directory, as bytes and as data. Raises LibraryError."""
    try:
        text = (directory / MANIFEST).read_bytes()
    except OSError as error:
        raise LibraryError(f'"{shown_path(directory)}" is none: {MANIFEST} cannot be read ({error.strerror})',
                           "make one with " + COMMAND.format(spec="FILE", out=shown_path(directory))) from None
    try:
        from .manifest import Manifest  # its models would take a tenth of the time of `import funicular`

        Manifest.model_validate_json(text)
        return text, json.loads(text)
    except (ValidationError, ValueError, RecursionError):
        raise LibraryError(f'"{directory}" is none: its {MANIFEST} is not that of a library',
                           "make one with " + COMMAND.format(spec="FILE", out=directory)) from None


class Kernel:
    """A kernel of a library as a function of arrays, as those of `funicular.generated.kernels`."""

    def __init__(self, shared: ctypes.CDLL, name: str, entry: dict[str, Any]):
        self.__name__, self.__doc__ = name, f"{entry['doc']} ({entry['source']})."
        self._inputs = [(a["name"], tuple(a["shape"])) for a in entry["inputs"]]
        self._outputs = [tuple(a["shape"]) for a in entry["outputs"]]
        self.shapes = {a["name"]: tuple(a["shape"]) for a in entry["inputs"] + entry["outputs"]}
        self._function = getattr(shared, name)
        self._function.restype = None
        self._function.argtypes = [*(ctypes.c_void_p if shape else ctypes.c_double for _, shape in self._inputs),
                                   *(ctypes.c_void_p for _ in self._outputs)]

    def __call__(self, *given: Any, **named: Any) -> np.ndarray | tuple[np.ndarray, ...]:
        """Return the outputs for these inputs: one array, or a tuple of them."""
        names = [name for name, _ in self._inputs]
        named = dict(zip(names, given, strict=False)) | named
        if len(given) > len(names) or set(named) != set(names):
            raise TypeError(f"{self.__name__} takes ({', '.join(names)})")
        values = [self._array(named[name], shape, name) if shape else float(named[name])
                  for name, shape in self._inputs]
        outputs = [np.empty(shape) for shape in self._outputs]
        self._function(*(v.ctypes.data if isinstance(v, np.ndarray) else v for v in (*values, *outputs)))
        return outputs[0] if len(outputs) == 1 else tuple(outputs)

    def rows(self, n: int, *given: ArrayLike) -> np.ndarray | tuple[np.ndarray, ...]:
        """Return the outputs (n, ...) of n calls; each argument for all, or (n, ...)."""
        if len(given) != len(self._inputs):
            raise TypeError(f"{self.__name__} takes ({', '.join(name for name, _ in self._inputs)})")
        arrays = [np.asarray(value, dtype=float) for value in given]
        for (name, shape), array in zip(self._inputs, arrays, strict=True):
            if array.shape not in (shape, (n, *shape)):
                raise ValueError(f"{self.__name__}: argument {name} must have shape {shape} or {(n, *shape)}, "
                                 f"got {array.shape}")
        alike = [array.shape == shape for (_, shape), array in zip(self._inputs, arrays, strict=True)]
        found = [np.empty((n, *shape)) for shape in self._outputs]
        for k in range(n):
            once = self(*(array if same else array[k] for array, same in zip(arrays, alike, strict=True)))
            for into, value in zip(found, once if len(found) > 1 else (once,), strict=True):
                into[k] = value
        return found[0] if len(found) == 1 else tuple(found)

    def _array(self, value: ArrayLike, shape: tuple[int, ...], name: str) -> np.ndarray:
        array = np.ascontiguousarray(value, dtype=float)
        if array.size != math.prod(shape):
            raise ValueError(f"{self.__name__}: argument {name} must have shape {shape}, got {array.shape}")
        return array


@dataclass(frozen=True)
class Library:
    """A library in memory: elements by name, kernels as functions, address of its fu_all (kernels.h).

    digest: sha256 of its machine code.
    """

    directory: Path
    elements: dict[str, ElementKind]
    kernels: SimpleNamespace
    tables: int
    digest: str


def load(directory: str | os.PathLike[str]) -> Library:
    """Return the library in a directory; it stays loaded. Raises LibraryError."""
    path = Path(resolved(directory))
    text, content = read_manifest(path)
    if _loaded.get(str(path), (b"",))[0] != text:
        _loaded[str(path)] = text, _open(path, content)
    return _loaded[str(path)][1]


def of_library(library: str | None) -> dict[str, ElementKind]:
    """Return the elements of a library by name, of this package for None. Raises LibraryError."""
    return elements.built_in() if library is None else load(library).elements


def kernels_of(library: str | None) -> Any:
    """Return the object whose attributes are the kernels of a library, of this package for None. Raises LibraryError.
    """
    if library is not None:
        return load(library).kernels
    from funicular.generated import kernels  # machine code of 2 MB: a scene may be described without it

    return kernels


def tables_of(library: str | None) -> int:
    """Return the address of a library's fu_all for the engine, 0 for this package's own. Raises LibraryError."""
    return load(library).tables if library is not None else 0


def _open(path: Path, content: dict[str, Any]) -> Library:
    # not at the top: `funicular derive` must start where generated/ is missing or broken
    from funicular.generated import described as described_kernels

    made, described = content["interface"], content["library"]
    again = "make it anew with " + COMMAND.format(spec=described["spec"], out=path)
    if made != elements.manifest()["interface"]:
        raise LibraryError(f'"{path}" was made for another version of funicular: its tables of kernels '
                           f"are laid out as {made}, here as {elements.manifest()['interface']}", again)
    if manifest_digest(content) != described.get("digest"):
        raise LibraryError(f'"{path}" is damaged: its {MANIFEST} is not the one that was made', again)
    file = path / Path(described["file"]).name  # in this directory, whatever the manifest says
    try:
        if file.is_symlink() or hashlib.sha256(file.read_bytes()).hexdigest() != described["sha256"]:
            raise LibraryError(f'"{path}" is damaged: {file.name} is not the file that was made', again)
        shared = ctypes.CDLL(str(file))
        kernels = SimpleNamespace(**{name: Kernel(shared, name, entry)
                                     for name, entry in described_kernels(content).items()})
        tables = ctypes.addressof(ctypes.c_char.in_dll(shared, "fu_all"))
    except OSError as error:
        raise LibraryError(f'"{path}" cannot be loaded here: {error}', again) from None
    except (AttributeError, KeyError, ValueError) as error:  # a missing name or argument
        if isinstance(error, LibraryError):
            raise
        raise LibraryError(f'"{path}" is damaged: {file.name} lacks what its {MANIFEST} names: {error}',
                           again) from None
    return Library(path, elements.of_manifest(content), kernels, tables, described["sha256"])
