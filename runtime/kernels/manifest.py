"""The form of the manifest of a library of elements."""

from __future__ import annotations

from typing import Any, Literal

from pydantic import BaseModel, ConfigDict

from .elements import LawTraits


class _Described(BaseModel):
    model_config = ConfigDict(strict=True, defer_build=True)


class _Shared(_Described):
    spec: str
    file: str
    sha256: str
    digest: str = ""


class _Argument(_Described):
    unit: str
    doc: str


class _Kernel(_Described):
    doc: str
    arguments: str


class _Element(_Described):
    nodal_vectors: list[str]
    dim: Literal[2, 3]
    director: str
    laws: dict[str, LawTraits]


class Manifest(_Described):
    """Entries required to load a library."""

    interface: str
    library: _Shared
    elements: dict[str, _Element]
    arguments: dict[str, _Argument]
    kernels: dict[str, dict[str, _Kernel]]
    tools: dict[str, str]
    families: dict[str, dict[str, Any]]
    sources: dict[str, str]
    files: dict[str, str]
