"""What scenes can be made of: the elements of this package and of libraries, as their manifests tell."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from importlib import resources

MANIFEST = "manifest.json"


@dataclass(frozen=True)
class ElementKind:
    """Nodal vectors in the order of the coordinates, dimension, director, and laws.

    ``laws`` maps each law to the one of this package whose section stiffness it takes; the first is the default.
    """

    nodal_vectors: tuple[str, ...]
    dim: int
    director: str
    laws: dict[str, str]

    @property
    def is_cable(self) -> bool:
        """Whether its laws know the section by its axial and bending stiffness alone."""
        return all(like.startswith(("green_", "engineering_")) for like in self.laws.values())


@cache
def manifest() -> dict:
    """The manifest of this package's kernels."""
    return json.loads((resources.files("funicular.generated") / MANIFEST).read_text(encoding="utf-8"))


def of_manifest(content: dict) -> dict[str, ElementKind]:
    """The elements of a manifest by name."""
    return {name: ElementKind(tuple(e["nodal_vectors"]), e["dim"], e["director"], e["laws"])
            for name, e in content["elements"].items()}


@cache
def built_in() -> dict[str, ElementKind]:
    """The elements of this package by name."""
    return of_manifest(manifest())


def gauge(vectors: tuple[str, ...], length: float, y: float, z: float) -> Iterator[float]:
    """How far, in m, a unit of each nodal vector moves a point of an element of that length.

    1 for positions; a unit of r_x moves the middle of an element by l/8, of r_xx by about l²/64; one of r_y or r_z
    moves the surface by the section's radius of gyration ``y`` or ``z``.
    """
    for vector in vectors:
        by = vector.partition("_")[2]
        yield (length / 8) ** by.count("x") * y ** by.count("y") * z ** by.count("z")
