"""Elastic laws by name: energies as functions of Gram products, and traits."""

from collections.abc import Callable
from functools import partial
from typing import Any

from ..spec import ASSUMED_LAWS, CABLE_LAWS, TABULATED_LAWS, TENSION_ONLY_LAWS, LawTraits
from .cable import assumed, cable, tabulated, tension_only
from .cable import curved as curved_cable
from .continuum import continuum
from .continuum import curved as curved_continuum
from .structural import structural

CURVED_CABLE_LAWS = ("green_exact_curved", "engineering_exact_curved")


def _measures(law: str) -> dict[str, str]:
    """Return strain and curvature of a cable's law, which its name begins with."""
    strain, curvature, *_ = law.split("_")
    return {"strain": strain, "curvature": curvature}


_CABLES: list[tuple[tuple[str, ...], Callable[..., Any], Callable[..., Any]]] = [
    (CABLE_LAWS, cable.Cable, cable.traits), (ASSUMED_LAWS, assumed.AssumedCable, assumed.traits),
    (CURVED_CABLE_LAWS, curved_cable.CurvedCable, curved_cable.traits),
    (TENSION_ONLY_LAWS, tension_only.TensionOnlyCable, tension_only.traits),
    (TABULATED_LAWS, tabulated.TabulatedCable, tabulated.traits)]

LAWS: dict[str, Callable[..., Any]] = {continuum.NAME: continuum.Continuum,
                                       curved_continuum.NAME: curved_continuum.CurvedContinuum}
"""Constructors of laws from the Gram products of an element."""

TRAITS: dict[str, LawTraits] = {continuum.NAME: continuum.TRAITS, curved_continuum.NAME: curved_continuum.TRAITS,
                                structural.NAME: structural.TRAITS}
"""Traits of each law; the structural one has its own kernels, without Gram products."""

for names, law, traits in _CABLES:
    LAWS |= {name: partial(law, **_measures(name)) for name in names}
    TRAITS |= {name: traits(**_measures(name)) for name in names}


def law_name(law: str | type) -> str:
    """Return the name of an entry of an element's `laws`."""
    return law if isinstance(law, str) else getattr(law, "name")  # noqa: B009 (a class of the user's has it)


def stiffness_of(law: str | type) -> str:
    """Return the law of this package whose section stiffness an entry of an element's `laws` takes."""
    return law if isinstance(law, str) else getattr(law, "stiffness_of")  # noqa: B009


def law_traits(law: str | type) -> LawTraits:
    """Return the traits of an entry of an element's `laws`; a user's law has those of its `stiffness_of`."""
    return TRAITS[stiffness_of(law)]


def law_class(law: str | type) -> Callable[..., Any]:
    """Return the constructor of the law of an entry of an element's `laws`."""
    return LAWS[law] if isinstance(law, str) else law
