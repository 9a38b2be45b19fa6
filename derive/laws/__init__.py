"""Elastic laws: energies as functions of Gram products, by name."""

from functools import partial

from funicular.derive.laws.cable import Cable
from funicular.derive.laws.continuum import Continuum
from funicular.derive.spec import CABLE_LAWS

LAWS = {"continuum": Continuum} | {
    name: partial(Cable, **dict(zip(("strain", "curvature"), name.split("_"), strict=True))) for name in CABLE_LAWS}
