"""Elastic laws: energies as functions of Gram products, by name."""

from collections.abc import Callable
from functools import partial

from funicular.derive.laws.cable import Cable
from funicular.derive.laws.cable_curved import CurvedCable
from funicular.derive.laws.continuum import Continuum
from funicular.derive.laws.continuum_curved import CurvedContinuum
from funicular.derive.spec import CABLE_LAWS

LAWS = {"continuum": Continuum, "continuum_curved": CurvedContinuum} | {
    name: partial(Cable, **dict(zip(("strain", "curvature"), name.split("_"), strict=True))) for name in CABLE_LAWS} | {
    f"{strain}_exact_curved": partial(CurvedCable, strain=strain, curvature="exact")
    for strain in ("green", "engineering")}

DAMPED_LIKE = {"continuum_curved": "continuum"} | {
    f"{strain}_{other}": f"{strain}_exact"
    for strain in ("green", "engineering") for other in ("linear", "exact_curved")}
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
