"""The roots of verification for the laws, each from its definition, at 50 digits: by kind of the law."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from ...laws import TRAITS
from ...spec import Element
from . import cable, cable_section, continuum, curved_continuum, structural


class Roots(NamedTuple):
    """Functions of (element, law, state): elastic energy in J, dissipated power in W, outputs of `section_forces`."""

    energy: Callable[..., Any]
    dissipation: Callable[..., Any]
    section: Callable[..., Any]


OF_KIND = {
    "cable": Roots(cable.energy, cable.dissipation, cable_section.section),
    "continuum": Roots(continuum.energy, continuum.dissipation, continuum.section),
    "structural": Roots(structural.energy, structural.dissipation, structural.section)}
CURVED = {"cable": OF_KIND["cable"],
          "continuum": Roots(curved_continuum.energy, continuum.dissipation, curved_continuum.section)}


def _roots(law: str) -> Roots:
    traits = TRAITS[law]
    return (CURVED if traits.straight else OF_KIND)[traits.kind]


def energy(element: Element, law: str, s: Any) -> Any:
    """Return the elastic energy, J."""
    return _roots(law).energy(element, law, s)


def dissipation(element: Element, law: str, s: Any) -> Any:
    """Return the power that Kelvin-Voigt damping takes out, W."""
    return _roots(law).dissipation(element, law, s)


def section(element: Element, law: str, s: Any) -> dict[str, Any]:
    """Return the outputs of the kernel `section_forces` by name."""
    return _roots(law).section(element, law, s)
