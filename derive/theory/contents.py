"""Contents of the documents: the chapters of the theory in the order of the paper, and the pages of elements."""

from __future__ import annotations

from ..catalogue import families
from ..codegen.family import SPACE, Family
from ..couplings.joint import JOINTS
from .document import Composer, Document

LEAD = ("Formulas are printed from the specs and programs that make the kernels, or stand beside them. Each one is "
        "read back from this page when it is built, evaluated at random points, and compared with the compiled "
        "kernels. The number in green is the largest difference that was found, relative to the largest entry. "
        "Equation numbers are those of the paper: J.-H. Seo, I.-H. Jung, T.-W. Park, H. Sugiyama, A. A. Shabana, The "
        "Development of a Sliding Joint for Very Flexible Multibody Dynamics, 2005 (in Korean).")
MAIN = {"element": "beam24", "law": "beam24_continuum", "slide": "slide_beam24_rigid", "body": "rigid",
        "point_law": "spring", "joint": "joint_spherical", "span": "span_cable8p", "sheave": "planar_sheave",
        "taut_rope": "planar_taut_rope"}
"""The families of the theory: the element and the rider of the paper; of other roles the family called as the role."""

THEORY: dict[str, dict[str, str]] = {
    "elements/elements": {}, "laws/continuum/continuum": {}, "laws/cable/cable": {"law": "cable12_green_exact"},
    "laws/structural/structural": {"law": "beam24_structural"}, "theory/motion": {}, "bodies/rigid": {},
    "bodies/modal": {}, "couplings/joint": {}, "couplings/joint_kind": {}, "couplings/spring": {},
    "algebra/tangent_frame": {}, "couplings/frame": {}, "couplings/slide": {}, "couplings/resistance": {},
    "couplings/branch": {}, "couplings/working_curve": {}, "couplings/drag": {}, "couplings/added_mass": {},
    "couplings/wetness": {}, "couplings/waves": {}, "couplings/surface": {}, "couplings/hard_contact": {},
    "couplings/span": {},
    "couplings/sheave": {}, "couplings/tangent_point": {}, "couplings/drum": {}, "couplings/rope_point": {},
    "couplings/taut_rope": {}, "couplings/taut_part": {}, "couplings/crossing": {}, "theory/catenary": {}}
"""The chapters of the theory in order, with families that differ from `MAIN`. Those of other roles follow."""


def main_families() -> dict[str, str]:
    """Return the family that the theory shows, by role."""
    return {family.role: family.role for family in families().values()} | MAIN


def chapters() -> list[str]:
    """Return the chapters of the theory: those in order, then those of roles that these leave out."""
    every = families()
    return list(dict.fromkeys([*THEORY, *(chapter_of(every[name]) for name in main_families().values())]))


def theory() -> Document:
    """Return the whole theory, eq 1 to 38."""
    composer, main = Composer("The theory of funicular", LEAD), main_families()
    for chapter in chapters():
        if chapter == CHAPTERS["joint"]:
            _add_joints(composer, main)
        else:
            composer.add(chapter, main | THEORY.get(chapter, {}))
    return composer.document


def _add_joints(composer: Composer, main: dict[str, str]) -> None:
    """Append the chapter of each kind of joint."""
    for dim, kinds in JOINTS.items():
        composer.add_text(f"## Joints in {SPACE[dim]}\n", main)
        for name in kinds:
            composer.add_text(f"### {name.removeprefix('planar_').replace('_', ' ').capitalize()}\n", main)
            composer.add(CHAPTERS["joint"], {"joint": f"joint_{name}"})


CHAPTERS = {"element": "elements/elements", "body": "bodies/rigid", "modal": "bodies/modal",
            "joint": "couplings/joint_kind"}
"""The chapters of roles; of another role the one called as the role in couplings/."""


def chapter_of(family: Family) -> str:
    """Return the chapter about a family."""
    if family.role == "point_law" and "spring" in family.name:
        return "couplings/spring"
    if family.name == "planar_crossing":
        return "couplings/planar_crossing"
    if family.role != "law":
        return CHAPTERS.get(family.role, f"couplings/{family.role}")
    assert family.traits is not None
    kind = family.traits.kind
    if family.traits.membrane == "tabulated":
        return f"laws/{kind}/tabulated"
    return f"laws/{kind}/{kind}{'_curved' if kind == 'continuum' and family.traits.takes_shape else ''}"


def page(name: str) -> Document:
    """Return the page of one family of kernels."""
    family = families()[name]
    composer = Composer(name, f"{family.doc[0].upper()}{family.doc[1:]}.")
    composer.add(chapter_of(family), {family.role: name})
    return composer.document
