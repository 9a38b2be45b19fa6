"""What scenes can be made of: the elements of this package."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class ElementKind:
    """Nodal vectors in the order of the coordinates, dimension, director, and laws.

    ``laws`` maps each law to the one whose section stiffness it takes; the first is the default.
    """

    nodal_vectors: tuple[str, ...]
    dim: int
    director: str
    laws: dict[str, str]

    @property
    def is_cable(self) -> bool:
        """Whether its laws know the section by its axial and bending stiffness alone."""
        return all(like.startswith(("green_", "engineering_")) for like in self.laws.values())


def _laws(*names: str) -> dict[str, str]:
    return {name: name.removesuffix("_curved") for name in names}


_BEAM = _laws("continuum", "continuum_curved", "structural")
_CABLE = _laws("green_exact", "green_linear", "engineering_exact", "engineering_linear")

_BUILT_IN = {
    "beam24": ElementKind(("r", "r_x", "r_y", "r_z"), 3, "r_y", _BEAM),
    "cable12": ElementKind(("r", "r_x"), 3, "", _CABLE | _laws("green_exact_curved", "engineering_exact_curved")),
    "cable18": ElementKind(("r", "r_x", "r_xx"), 3, "", _laws("green_exact", "engineering_exact")),
    "beam12p": ElementKind(("r", "r_x", "r_y"), 2, "r_y", _BEAM),
    "cable8p": ElementKind(("r", "r_x"), 2, "", _CABLE),
}


def built_in() -> dict[str, ElementKind]:
    """The elements of this package by name."""
    return _BUILT_IN
