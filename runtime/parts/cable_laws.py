"""The elastic laws of cables: those that an element has, and the one that the entries of a cable name."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ..kernels.elements import ElementKind, built_in
from ..kernels.libraries import of_library
from .section_stiffness import law_of_measures, measures_of_law, variants
from .validation import shown

DEFAULT_ELEMENT = "beam24"
MEASURES = {"strain": ("green", "engineering"), "curvature": ("exact", "linear"),
            "membrane": ("full", "assumed", "reduced", "tension_only", "tabulated")}
"""The keywords that name the law of a cable by its measures, see `Cable`, with their values; the first is the default.
"""


def possible_laws(kind: ElementKind) -> list[str]:
    """Return the laws that a cable of such elements can be given."""
    laws = [law for law, traits in kind.laws.items() if not traits.straight]
    return laws + [law for law, variant in variants().items() if variant.kernel_law in laws]


def chosen(kind: ElementKind, data: dict[str, Any]) -> str | None:
    """Return the law that the entries of a cable name, by default the first one of its element.

    Raises ValueError(cause, remedy) where the element has no such law. The checks of the measures refuse unknown ones.
    """
    element, law, possible = data.get("element", DEFAULT_ELEMENT), data.get("law"), possible_laws(kind)
    measures = {name: data[name] for name in MEASURES if data.get(name)}
    if not isinstance(law, str | None):
        raise ValueError(f"law must be a name, got {shown(law)}", "possible: " + ", ".join(possible))
    if any(measure not in MEASURES[name] for name, measure in measures.items()):
        return possible[0]
    if measures:
        if not kind.is_cable:
            raise ValueError(f"strain, curvature and membrane are for cable elements, {element} is a beam",
                             "leave them out, or take " + others(kind.dim, cable=True))
        default = {name: values[0] for name, values in MEASURES.items()}
        if measures.get("membrane") in ("tension_only", "tabulated"):
            default["strain"] = "engineering"
        by_measures = law_of_measures(**default | measures)
        if law not in (None, by_measures):
            raise ValueError(f'law "{law}" disagrees with strain, curvature and membrane', "give the one or the others")
        law = by_measures
    if law is not None and law not in possible:
        raise ValueError(f'law "{law}" is not possible for {element}', "possible: " + ", ".join(possible))
    return law or possible[0]


def changed(kind: ElementKind, law: str, changes: Mapping[str, Any], library: str | None) -> dict[str, Any]:
    """Return the entries that name the law of a cable after changes of its other entries, None for those to leave out.

    A change of one measure keeps the others. An element without the law, where that was the default, gets its own
    default.
    """
    element = changes["element"] or DEFAULT_ELEMENT if "element" in changes else None
    other = (of_library(library).get(element) if isinstance(element, str) else None) or kind
    if any(name in changes for name in MEASURES):
        return {"law": None} | (measures_of_law(law) if other.is_cable else {})
    return {"law": None} if law == possible_laws(kind)[0] and law not in possible_laws(other) else {}


def others(dim: int, *, cable: bool | None = None) -> str:
    """Return the elements of a dimension, cables or beams, as a remedy names them."""
    names = [f'"{name}"' for name, kind in built_in().items() if kind.dim == dim and cable in (None, kind.is_cable)]
    return "element=" + " or ".join(names)
