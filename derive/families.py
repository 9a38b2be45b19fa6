"""The list of everything that is generated. A new spec joins by one entry in its own list."""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from functools import partial

from funicular.derive import element_kernels, law_kernels, structural_kernels
from funicular.derive.bodies import rigid
from funicular.derive.elements import ELEMENTS
from funicular.derive.joints import slide
from funicular.derive.laws import structural
from funicular.derive.spec import Element, Family


def _element(element: Element) -> Family:
    return Family(element.name, element.doc, partial(element_kernels.build, element),
                  (f"elements.{element.name}", "element_kernels"),
                  role="element",
                  facts={"nodes": len(element.nodes), "vectors": len(element.nodal_vectors), "dim": element.dim},
                  element=element)


def _law(element: Element, law: str) -> Family:
    builder = structural_kernels if law == structural.NAME else law_kernels
    return Family(f"{element.name}_{law}", f"elastic law {law} on {element.name}",
                  partial(builder.build, element, law), (f"elements.{element.name}", builder.__name__.split(".")[-1]),
                  role="law", element=element, law=law)


def _slide(element: Element) -> Family:
    return Family(f"slide_{element.name}_{rigid.NAME}",
                  f"sliding joint of a {rigid.NAME} rider on a {element.name} cable",
                  partial(slide.build, element),
                  ("joints.slide", f"elements.{element.name}", f"bodies.{rigid.NAME}"),
                  role="slide", facts={"coordinates": element.n_coordinates + rigid.N_VELOCITY},
                  element=element, rider=rigid.NAME)


def families() -> dict[str, Family]:
    """Every family by name: elements, their laws, bodies, and the slide for each pair of element and rider."""
    every = [*map(_element, ELEMENTS.values()),
             *(_law(element, law) for element in ELEMENTS.values() for law in element.laws),
             Family(rigid.NAME, "rigid body", rigid.build, (f"bodies.{rigid.NAME}",), rider=rigid.NAME),
             *(_slide(element) for element in ELEMENTS.values() if element.dim == rigid.DIM)]
    return {f.name: f for f in every}


def named(names: Iterable[str]) -> dict[str, Family]:
    """The families of these names.

    Raises KeyError for an unknown one, naming the near ones.
    """
    every = families()
    for name in names:
        if name not in every:
            near = difflib.get_close_matches(name, every, n=3) or sorted(every)
            raise KeyError(f'no spec "{name}"; did you mean {", ".join(near)}?')
    return {name: every[name] for name in every if name in set(names)}
