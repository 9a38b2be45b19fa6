"""Spatial cable with 12 coordinates: position and slope at two nodes, cubic Hermite, no torsion."""

from ..spec import ASSUMED_LAWS, CABLE_LAWS, TABULATED_LAWS, TENSION_ONLY_LAWS, Element, x

CABLE12 = Element(
    name="cable12",
    dim=3,
    basis=(1, x, x**2, x**3),
    nodal_vectors=("r", "r_x"),
    director="",
    laws=(*CABLE_LAWS, *ASSUMED_LAWS, "green_exact_curved", "engineering_exact_curved", *TENSION_ONLY_LAWS,
          *TABULATED_LAWS),
    doc="spatial ANCF cable, cubic, axial and bending stiffness",
    source="Gerstmayr & Shabana, Nonlinear Dynamics 45 (2006) 109-130",
)
