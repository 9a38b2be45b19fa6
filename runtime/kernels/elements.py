"""Elements of this package and of libraries, and laws of forces between points, from their manifests."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from ..base.deferred import dataclass

MANIFEST = "manifest.json"


@dataclass(frozen=True)
class LawTraits:
    """Traits of an elastic law in the manifest.

    stiffness_of       the law of this package with the same section stiffness; itself, except for a law of the user's
    kind               "cable" (of the axis alone), "continuum" or "structural" (of the whole section)
    strain, curvature  the measures of a cable: "green" or "engineering", "exact" or "linear"; else empty
    membrane           representation of the axial strain of a cable: "full", "assumed" or "tension_only"; else empty
    straight           of a law for a curved stress-free shape, the law for a straight one; else empty
    takes_shape        whether its kernels take the stress-free shape
    shared             by kernel, the family (ELEMENT_LAW) that provides it, as in the engine's table of kernels
    discrete_gradient  whether its energy has a discrete gradient, which the integrator "energy" needs
    """

    stiffness_of: str
    kind: str
    strain: str
    curvature: str
    membrane: str
    straight: str
    takes_shape: bool
    shared: dict[str, str]
    discrete_gradient: bool


@dataclass(frozen=True)
class ElementKind:
    """Nodal vectors in the order of the coordinates, dimension, director, and laws; the first law is the default."""

    nodal_vectors: tuple[str, ...]
    dim: int
    director: str
    laws: dict[str, LawTraits]

    @property
    def is_cable(self) -> bool:
        """Return whether its laws depend only on the axial and bending stiffness of the section."""
        return all(law.kind == "cable" for law in self.laws.values())

    def law_kernel(self, element: str, law: str, kernel: str) -> str:
        """Return the full name of a kernel of a law on this element, possibly that of another law."""
        return f"{self.laws[law].shared.get(kernel, f'{element}_{law}')}_{kernel}"

    def law_for_curved_shape(self, law: str) -> str | None:
        """Return the form of a law for curved stress-free shapes; None if the element has none."""
        if law in self.laws and self.laws[law].takes_shape:
            return law
        return next((name for name, traits in self.laws.items() if traits.straight == law), None)


@cache
def manifest() -> dict[str, Any]:
    """Return the manifest of this package's kernels."""
    found: dict[str, Any] = json.loads(_text())
    return found


@cache
def _text() -> str:
    spec = find_spec("funicular.generated")
    assert spec is not None and spec.origin is not None
    return Path(spec.origin).with_name(MANIFEST).read_text(encoding="utf-8")  # importlib.resources takes 5 ms to load


@cache
def part_of_manifest(name: str) -> Any:
    """Return one part of the manifest of this package's kernels, without reading the others.

    The whole takes a fiftieth of the time to the first result. Its text has a line for each part, indented by a space.
    """
    head = f'\n "{name}": '
    return json.JSONDecoder().raw_decode(_text(), _text().index(head) + len(head))[0]


def of_manifest(content: dict[str, Any]) -> dict[str, ElementKind]:
    """Return the elements of a manifest by name."""
    return {name: ElementKind(tuple(e["nodal_vectors"]), e["dim"], e["director"],
                              {law: LawTraits(**traits) for law, traits in e["laws"].items()})
            for name, e in content["elements"].items()}


@cache
def built_in() -> dict[str, ElementKind]:
    """Return the elements of this package by name."""
    return of_manifest({"elements": part_of_manifest("elements")})


@cache
def built_in_laws() -> dict[str, LawTraits]:
    """Return the laws of this package by name."""
    return {law: traits for kind in built_in().values() for law, traits in kind.laws.items()}


def gauge(vectors: tuple[str, ...], length: float, y: float, z: float) -> Iterator[float]:
    """Yield the displacement of a point of an element of that length by a unit of each nodal vector, m.

    1 for positions; a unit of r_x moves the middle of an element by l/8, of r_xx by about l²/64; one of r_y or r_z
    moves the surface by the section's radius of gyration ``y`` or ``z``.
    """
    for vector in vectors:
        by = vector.partition("_")[2]
        yield (length / 8) ** by.count("x") * y ** by.count("y") * z ** by.count("z")


@dataclass(frozen=True)
class PointLaw:
    """The law of a force between two points.

    parameters  units by name, in the order of the kernels' arguments
    damping     name of the parameter of damping; empty without any
    """

    parameters: Mapping[str, str]
    damping: str


def point_law(kernel: str) -> PointLaw:
    """Return the law of the kernels of that name.

    Raises ValueError where there are none.
    """
    found = part_of_manifest("point_laws").get(kernel)
    if found is None:
        raise ValueError(f'no kernels of a point law "{kernel}": write its spec in derive/couplings/point_laws, run '
                         "`funicular derive` and install again")
    return PointLaw(**found)
