"""Elastic laws: energies as functions of Gram products, by name."""

from functools import partial

from funicular.derive.laws.cable import Cable
from funicular.derive.laws.cable_curved import CurvedCable
from funicular.derive.laws.continuum import Continuum
from funicular.derive.laws.continuum_curved import CurvedContinuum
from funicular.derive.spec import CABLE_LAWS

LAWS = {"continuum": Continuum, "continuum_curved": CurvedContinuum} | {
    name: partial(Cable, **dict(zip(("strain", "curvature"), name.split("_"), strict=True))) for name in CABLE_LAWS} | {
    f"{strain}_exact_curved": partial(CurvedCable, strain=strain, curvature="exact") for strain in ("green", "engineering")}
