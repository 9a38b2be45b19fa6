"""Spatial cable with 18 coordinates: position, slope and curvature at two nodes, quintic, C2 along the cable."""

from ..spec import Element, x

CABLE18 = Element(
    name="cable18",
    dim=3,
    basis=(1, x, x**2, x**3, x**4, x**5),
    nodal_vectors=("r", "r_x", "r_xx"),
    director="",
    laws=("green_exact", "engineering_exact", "green_exact_assumed", "engineering_exact_assumed"),
    doc="spatial cable, quintic: a slide crosses its nodes without a jump of acceleration",
    source="quintic Hermite interpolation of the ANCF cable",
)
