"""Elastic laws: energies as functions of Gram products, by name."""

from collections.abc import Callable
from functools import partial

from ..spec import ASSUMED_LAWS, CABLE_LAWS
from .cable.assumed import AssumedCable
from .cable.cable import Cable
from .cable.curved import CurvedCable
from .continuum.continuum import Continuum
from .continuum.curved import CurvedContinuum


def _measures(law: str) -> dict[str, str]:
    """Strain and curvature of a cable's law by its name."""
    strain, curvature, *_ = law.split("_")
    return {"strain": strain, "curvature": curvature}


LAWS = ({"continuum": Continuum, "continuum_curved": CurvedContinuum}
        | {name: partial(Cable, **_measures(name)) for name in CABLE_LAWS}
        | {name: partial(AssumedCable, **_measures(name)) for name in ASSUMED_LAWS}
        | {name: partial(CurvedCable, **_measures(name))
           for name in ("green_exact_curved", "engineering_exact_curved")})

DAMPED_LIKE = {"continuum_curved": "continuum"} | {
    f"{strain}_{other}": f"{strain}_exact"
    for strain in ("green", "engineering") for other in ("linear", "exact_curved", "exact_assumed", "linear_assumed")}
"""The law whose damping kernels another takes; its constants lead the other's A."""


def law_name(law: str | type) -> str:
    """Name of an entry of an element's `laws`."""
    return law if isinstance(law, str) else law.name


def law_like(law: str | type) -> str:
    """The law in LAWS whose section stiffness an entry of an element's `laws` takes."""
    return law if isinstance(law, str) else law.like


def law_class(law: str | type) -> Callable:
    """What makes the law of an entry of an element's `laws` from Gram products."""
    return LAWS[law] if isinstance(law, str) else law
