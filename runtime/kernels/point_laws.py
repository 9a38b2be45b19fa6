"""Laws of forces between two points, from the manifest of the kernels."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from .elements import manifest


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
    found = manifest()["point_laws"].get(kernel)
    if found is None:
        raise ValueError(f'no kernels of a point law "{kernel}": write its spec in derive/couplings/point_laws, run '
                         "`funicular derive` and install again")
    return PointLaw(**found)
