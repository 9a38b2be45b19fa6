"""Planar cable with 8 coordinates: position and slope at two nodes, cubic Hermite."""

from ..spec import ASSUMED_LAWS, CABLE_LAWS, TABULATED_LAWS, TENSION_ONLY_LAWS, Element, x

CABLE8P = Element(
    name="cable8p",
    dim=2,
    basis=(1, x, x**2, x**3),
    nodal_vectors=("r", "r_x"),
    director="",
    laws=(*CABLE_LAWS, *ASSUMED_LAWS, *TENSION_ONLY_LAWS, *TABULATED_LAWS),
    doc="planar ANCF cable, cubic, axial and bending stiffness",
    source="Berzeri & Shabana, J. Sound and Vibration 235 (2000) 539-565; the paper's ref 6",
)
