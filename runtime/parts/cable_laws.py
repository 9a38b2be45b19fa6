"""The elastic laws of cables: which an element has, which one a cable is given, and what they ask of its section."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Protocol

from ..kernels.elements import ElementKind, LawTraits, built_in
from ..kernels.libraries import of_library
from .material import Material
from .section import GeneralSection, Section
from .section_stiffness import kernel_law, law_of_measures, measures_of_law, variants
from .validation import EXACT, show, shown

MEMBRANES = ("full", "assumed", "reduced", "tension_only")
"""How an element of a cable represents its axial strain, see `Cable`; the first is the default."""


MEASURES = ("strain", "curvature", "membrane")
"""The keywords that name a cable's law by its measures."""


class Described(Protocol):
    """What the checks of a law look at, which a cable has."""

    law: str

    @property
    def element(self) -> str:
        """Return the name of its element."""

    @property
    def section(self) -> Section:
        """Return its section, with its stiffness and its mass."""

    @property
    def material(self) -> Material:
        """Return its material, with its elastic constants."""

    @property
    def is_curved(self) -> bool:
        """Return whether its stress-free shape is curved."""

    @property
    def traits(self) -> LawTraits:
        """Return what the law of its kernels is."""

    @property
    def stiffness_law(self) -> str:
        """Return the name of the law whose stiffness of the section it takes."""

    @property
    def kind_of_element(self) -> ElementKind:
        """Return what its element is."""

    @property
    def dim(self) -> int:
        """Return 3, or 2 for planar elements."""


def possible_laws(kind: ElementKind) -> list[str]:
    """Return the laws that a cable of such elements can be given."""
    laws = [law for law, traits in kind.laws.items() if not traits.straight]
    return laws + [law for law, variant in variants().items() if variant.kernel_law in laws]


def chosen(kind: ElementKind, data: dict) -> str | None:
    """Return the law of a cable from what it is given; ValueError if the element has no such law."""
    element = data.get("element", "beam24")
    law, strain, curvature, membrane = (data.get(name) for name in ("law", "strain", "curvature", "membrane"))
    possible = possible_laws(kind)
    if law is None and not (strain or curvature or membrane):
        return possible[0]
    if not isinstance(law, str | None):
        raise ValueError(f"law must be a name, got {shown(law)}", "possible: " + ", ".join(possible))
    if not all(isinstance(measure, str | None) for measure in (strain, curvature, membrane)):
        return possible[0]  # the checks of strain, curvature and membrane refuse it
    if strain or curvature or membrane:
        if not kind.is_cable:
            raise ValueError(f"strain, curvature and membrane are for cable elements, {element} is a beam",
                             "leave them out, or take " + others(kind.dim, cable=True))
        default = "engineering" if membrane == "tension_only" else "green"
        by_measures = law_of_measures(strain or default, curvature or "exact", membrane or MEMBRANES[0])
        if law not in (None, by_measures):
            raise ValueError(f'law "{law}" disagrees with strain, curvature and membrane', "give the one or the others")
        law = by_measures
    if law not in possible and _are_measures(strain, curvature, membrane):  # else the checks of these say it better
        raise ValueError(f'law "{law}" is not possible for {element}', "possible: " + ", ".join(possible))
    return law


def changed(kind: ElementKind, law: str, changes: Mapping[str, Any], library: str | None) -> dict[str, Any]:
    """Return what becomes of the entries that name the law of a cable where others of its entries change: None for
    those that are left out.

    Where a measure changes, the others stay. Where the element changes to one without such a law, its default follows
    from the default.
    """
    element = changes["element"] or "beam24" if "element" in changes else None
    other = (of_library(library).get(element) if isinstance(element, str) else None) or kind
    if any(name in changes for name in MEASURES):
        return {"law": None} | (measures_of_law(law) if other.is_cable else {})
    return {"law": None} if law == possible_laws(kind)[0] and law not in possible_laws(other) else {}


def _are_measures(strain: str | None, curvature: str | None, membrane: str | None) -> bool:
    """Return whether these are names of measures of strain and curvature, as far as they are given."""
    return (strain in (None, "", "green", "engineering") and curvature in (None, "", "exact", "linear")
            and membrane in (None, "", *MEMBRANES))


def name_of_kernels(kind: ElementKind, law: str, curved: bool) -> str:
    """Return the name of a law among an element's kernels, of a cable whose stress-free shape is curved or straight."""
    law = kernel_law(law)
    return (kind.law_for_curved_shape(law) or law) if curved else law


def check(cable: Described) -> None:
    """Raise ValueError(cause, remedy) where the law of a cable does not suit its shape, its section or its material."""
    kind = cable.kind_of_element
    if cable.is_curved and kind.law_for_curved_shape(kernel_law(cable.law)) is None:
        curved = {name: [law for law in possible_laws(other) if other.law_for_curved_shape(kernel_law(law))]
                  for name, other in built_in().items()}
        able = [f"{name} ({', '.join(laws)})" for name, laws in curved.items() if laws]
        raise ValueError(f'{cable.element} with law "{cable.law}" is stress-free only where it is straight, but '
                         "it is drawn curved", 'take rest="straight", or one of ' + ", ".join(able))
    if cable.dim == 3 and kernel_law(cable.stiffness_law) == "continuum" and cable.material.is_incompressible:
        raise ValueError(f'law "{cable.law}" needs a poisson_ratio below 0.5, at which Lamé\'s λ is infinite, got '
                         f"{cable.material.poisson():.9g}", 'take law="structural", which needs E and G alone')
    _check_section(cable)


def _check_section(cable: Described) -> None:
    """Raise ValueError(cause, remedy) where the law of a cable needs more of its section, or less, than that gives."""
    kind, section = cable.kind_of_element, cable.section
    given = {keyword for keyword in ("torsion_constant", "shear_factors")
             if getattr(section, f"given_{keyword}") is not None}
    if kind.is_cable:
        _refuse_unequal_bending(cable)
        if given:
            raise ValueError(f"section.{min(given)} is given, but {cable.element} has neither shear nor torsion",
                             "leave it out, or take " + others(kind.dim, cable=False))
        if isinstance(section, GeneralSection) and section.has_rotary:
            raise ValueError(f"section.rotary_moment is given, but {cable.element} has no rotary inertia",
                             "leave it out, or take " + others(kind.dim, cable=False))
    elif cable.traits.kind == "structural":
        needed = {"shear_factors"} | ({"torsion_constant"} if kind.dim == 3 else set())
        if isinstance(section, GeneralSection) and (missing := needed - given):
            raise ValueError(f'law "structural" needs section.{min(missing)}, which a general section does not '
                             "tell", "give it to the section")
    elif isinstance(section, GeneralSection):
        raise ValueError(f'law "{cable.law}" integrates over the shape of the section, which a general section does '
                         "not tell", 'take law="structural", a rectangle, circle or tube, or '
                         + others(kind.dim, cable=True))
    elif cable.law == "continuum" and given:
        raise ValueError(f'section.{min(given)} is given, but law "continuum" computes its own from the shape',
                         'leave it out, or take law="poisson_split" or "structural"')


def _refuse_unequal_bending(cable: Described) -> None:
    across = cable.section.second_moment_about_z, cable.section.second_moment_about_y
    if cable.dim == 3 and abs(across[0] - across[1]) > EXACT * max(across):
        raise ValueError(f"{cable.element} has one bending stiffness: its section needs equal second moments, "
                         f"got {show(across, 'm⁴')}", 'take a square, a circle or a tube, or element="beam24"')


def others(dim: int, *, cable: bool | None = None) -> str:
    """Return the elements to take instead, for a remedy."""
    names = [f'"{name}"' for name, kind in built_in().items() if kind.dim == dim and cable in (None, kind.is_cable)]
    return "element=" + " or ".join(names)
