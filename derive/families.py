"""The list of everything that is generated. A new spec joins by one entry in its own list."""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from functools import partial
from types import ModuleType

from funicular.derive import body_kernels, element_kernels, law_kernels
from funicular.derive.bodies import BODIES
from funicular.derive.elements import ELEMENTS
from funicular.derive.joints import slide
from funicular.derive.spec import Element, Family


def _element(element: Element) -> Family:
    return Family(element.name, element.doc, partial(element_kernels.build, element),
                  (f"elements.{element.name}", "element_kernels"),
                  role="element",
                  facts={"nodes": len(element.nodes), "vectors": len(element.nodal_vectors), "dim": element.dim},
                  element=element)


def _law(element: Element, law: str) -> Family:
    return Family(f"{element.name}_{law}", f"elastic law {law} on {element.name}",
                  partial(law_kernels.build, element, law), (f"elements.{element.name}", "law_kernels"),
                  role="law", own=("stiffness",), element=element, law=law)


def _body(body: ModuleType) -> Family:
    return Family(body.NAME, body.DOC, partial(body_kernels.build, body), (f"bodies.{body.NAME}", "body_kernels"),
                  role="body",
                  facts={"dim": body.DIM, "configuration": body.N_CONFIGURATION, "velocity": body.N_VELOCITY},
                  rider=body.NAME)


def _slide(element: Element, rider: ModuleType) -> Family:
    return Family(f"slide_{element.name}_{rider.NAME}",
                  f"sliding joint of a {rider.NAME} rider on a {element.name} cable",
                  partial(slide.build, element, rider),
                  ("joints.slide", f"elements.{element.name}", f"bodies.{rider.NAME}"),
                  role="slide",
                  facts={"coordinates": element.n_coordinates + rider.N_VELOCITY, "dim": element.dim},
                  element=element, rider=rider.NAME)


def families() -> dict[str, Family]:
    """Every family by name: elements, their laws, bodies, and the slide for each pair of element and rider."""
    every = [*map(_element, ELEMENTS.values()),
             *(_law(element, law) for element in ELEMENTS.values() for law in element.laws),
             *map(_body, BODIES.values()),
             *(_slide(element, rider) for rider in BODIES.values() for element in ELEMENTS.values()
               if element.dim == rider.DIM)]
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
