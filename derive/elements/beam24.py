"""Spatial beam with 24 coordinates: position and three slopes at two nodes (eq 1-2)."""

from ..spec import Element, x, y, z

BEAM24 = Element(
    name="beam24",
    dim=3,
    basis=(1, x, y, z, x * y, x * z, x**2, x**3),
    nodal_vectors=("r", "r_x", "r_y", "r_z"),
    director="r_y",
    laws=("continuum", "continuum_curved", "structural"),
    doc="fully parameterised spatial ANCF beam, solid of volume, with torsion and rotary inertia",
    source="paper eq 1-8; Shabana & Yakoub, J. Mech. Design 123 (2001) 606-613",
)
