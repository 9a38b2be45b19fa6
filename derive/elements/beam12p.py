"""Planar beam with 12 coordinates: position and two slopes at two nodes, the planar counterpart of beam24."""

from ..spec import Element, x, y

BEAM12P = Element(
    name="beam12p",
    dim=2,
    basis=(1, x, y, x * y, x**2, x**3),
    nodal_vectors=("r", "r_x", "r_y"),
    director="r_y",
    laws=("continuum", "continuum_curved", "structural"),
    doc="fully parameterised planar ANCF beam, shear deformable",
    source="Omar & Shabana, J. Sound and Vibration 243 (2001) 565-576",
)
