"""Contents of the documents: the chapters of the theory in the order of the paper, and the pages of elements."""

from __future__ import annotations

from ..catalogue import families
from ..codegen.family import Family
from ..couplings.joint import JOINTS
from .document import Composer, Document

LEAD = ("Formulas are printed from the specs and programs that make the kernels, or stand beside them. Each one is "
        "read back from this page when it is built, evaluated at random points, and compared with the compiled "
        "kernels. The number in green is the largest difference that was found, relative to the largest entry. "
        "Equation numbers are those of the paper: J.-H. Seo, I.-H. Jung, T.-W. Park, H. Sugiyama, A. A. Shabana, The "
        "Development of a Sliding Joint for Very Flexible Multibody Dynamics, 2005 (in Korean).")
MAIN = {"element": "beam24", "law": "beam24_continuum", "slide": "slide_beam24_rigid", "body": "rigid",
        "modal": "modal", "frame": "frame", "point_law": "spring", "resistance": "resistance", "drag": "drag",
        "surface": "surface", "crossing": "crossing"}
"""The families of the theory: the element and the rider of the paper."""


def theory() -> Document:
    """Return the whole theory, eq 1 to 38."""
    composer = Composer("The theory of funicular", LEAD)
    composer.add("elements/elements", MAIN)
    composer.add("laws/continuum/continuum", MAIN)
    composer.add("laws/cable/cable", {"law": "cable12_green_exact"})
    composer.add("laws/structural/structural", {"law": "beam24_structural"})
    composer.add("theory/motion", MAIN)
    composer.add("bodies/rigid", MAIN)
    composer.add("bodies/modal", MAIN)
    composer.add("couplings/joint", MAIN)
    for dim, kinds in JOINTS.items():
        composer.add_text(f"## Joints in {'the plane' if dim == 2 else 'space'}\n", MAIN)
        for name in kinds:
            composer.add_text(f"### {name.removeprefix('planar_').replace('_', ' ').capitalize()}\n", MAIN)
            composer.add("couplings/joint_kind", {"joint": f"joint_{name}"})
    composer.add("couplings/spring", MAIN)
    composer.add("algebra/tangent_frame", MAIN)
    composer.add("couplings/frame", MAIN)
    composer.add("couplings/slide", MAIN)
    composer.add("couplings/resistance", MAIN)
    composer.add("couplings/drag", MAIN)
    composer.add("couplings/added_mass", MAIN)
    composer.add("couplings/wetness", MAIN)
    composer.add("couplings/surface", MAIN)
    composer.add("couplings/hard_contact", MAIN)
    composer.add("couplings/crossing", MAIN)
    composer.add("theory/catenary", MAIN)
    return composer.document


CHAPTERS = {"element": "elements/elements", "slide": "couplings/slide", "body": "bodies/rigid", "modal": "bodies/modal",
            "joint": "couplings/joint_kind", "frame": "couplings/frame", "point_law": "couplings/point_law",
            "resistance": "couplings/resistance", "drag": "couplings/drag", "surface": "couplings/surface",
            "crossing": "couplings/crossing"}


def chapter_of(family: Family) -> str:
    """Return the chapter about a family."""
    if family.role == "point_law" and "spring" in family.name:
        return "couplings/spring"
    if family.name == "planar_crossing":
        return "couplings/planar_crossing"
    if family.role != "law":
        return CHAPTERS[family.role]
    assert family.traits is not None
    kind = family.traits.kind
    return f"laws/{kind}/{kind}{'_curved' if kind == 'continuum' and family.traits.takes_shape else ''}"


def page(name: str) -> Document:
    """Return the page of one family of kernels."""
    family = families()[name]
    composer = Composer(name, f"{family.doc[0].upper()}{family.doc[1:]}.")
    composer.add(chapter_of(family), {family.role: name})
    return composer.document
