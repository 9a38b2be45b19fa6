"""Elastic laws by name: energies as functions of Gram products, and what each law is."""

from collections.abc import Callable
from functools import partial
from typing import Any

from ..spec import ASSUMED_LAWS, CABLE_LAWS, TENSION_ONLY_LAWS, LawTraits
from .cable import assumed, cable, tension_only
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
    (TENSION_ONLY_LAWS, tension_only.TensionOnlyCable, tension_only.traits)]

LAWS: dict[str, Callable[..., Any]] = {continuum.NAME: continuum.Continuum,
                                       curved_continuum.NAME: curved_continuum.CurvedContinuum}
"""What makes a law from the Gram products of an element."""

TRAITS: dict[str, LawTraits] = {continuum.NAME: continuum.TRAITS, curved_continuum.NAME: curved_continuum.TRAITS,
                                structural.NAME: structural.TRAITS}
"""What each law is; the structural one has kernels of its own, without Gram products."""

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
    """Return what an entry of an element's `laws` is; a law of the user's is what the one of `stiffness_of` is."""
    return TRAITS[stiffness_of(law)]


def law_class(law: str | type) -> Callable[..., Any]:
    """Return what makes the law of an entry of an element's `laws` from Gram products."""
    return LAWS[law] if isinstance(law, str) else law
