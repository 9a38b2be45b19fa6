"""The list of everything that is generated. A new spec joins by one entry in its own list."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Iterator
from functools import partial
from importlib import import_module
from itertools import chain
from pkgutil import iter_modules

from . import couplings
from .bodies import BODIES, RIDERS, Body, Rider, modal, modal_kernels
from .bodies import kernels as body_kernels
from .bodies.point import Point
from .codegen.family import BodyFamily, ElementFamily, Family, LawFamily, SlideFamily
from .couplings import slide
from .couplings.span import SPANS
from .elements import ELEMENTS
from .elements import kernels as element_kernels
from .laws import kernels as law_kernels
from .laws import law_name, law_traits, stiffness_of
from .laws.structural import kernels as structural_kernels
from .laws.structural import structural
from .spec import Element


def _element(element: Element) -> ElementFamily:
    return ElementFamily(element.name, element.doc, partial(element_kernels.build, element),
                         (f"elements.{element.name}", "elements.kernels"),
                         group=element.name, role="element",
                         facts={"nodes": len(element.nodes), "vectors": len(element.nodal_vectors), "dim": element.dim},
                         element=element)


def _law(element: Element, law: str | type) -> LawFamily:
    name, traits = law_name(law), law_traits(law)
    shared = {kernel: f"{element.name}_{other}" for kernel, other in law_kernels.taken(element, law).items()}
    if name == structural.NAME:
        builder, build = "laws.structural.kernels", partial(structural_kernels.build, element)
    else:
        builder, build = "laws.kernels", partial(law_kernels.build, element, law)
    return LawFamily(f"{element.name}_{name}", f"elastic law {name} on {element.name}", build,
                     (f"elements.{element.name}", builder), group=element.name, role="law",
                     outside_table=("stiffness", "stiffness_at", "section_forces"), shared=shared,
                     missing=law_kernels.missing(law), facts=law_kernels.facts(element, law), element=element, law=name,
                     stiffness_of=stiffness_of(law), traits=traits)


def _body(body: Body) -> BodyFamily:
    return BodyFamily(body.NAME, body.DOC, partial(body_kernels.build, body), (f"bodies.{body.NAME}", "bodies.kernels"),
                      role="body",
                      facts={"dim": body.DIM, "configuration": body.N_CONFIGURATION, "velocity": body.N_VELOCITY},
                      rider=body.NAME)


def _modal(name: str, body: Body) -> BodyFamily:
    return BodyFamily(name, f"modal body on a {body.NAME} frame", partial(modal_kernels.build, name, body),
                      ("bodies.modal", f"bodies.{body.NAME}", "bodies.modal_kernels"),
                      role="modal",
                      facts={"dim": body.DIM},
                      rider=body.NAME)


def _slide(element: Element, rider: Rider, flows: bool = False) -> SlideFamily:
    name = f"slide_{'span_' if flows else ''}{element.name}_{rider.NAME}"
    return SlideFamily(name,
                       f"sliding joint of a {rider.NAME} rider on a {element.name} {'rope' if flows else 'cable'}",
                       partial(slide.build, name, element, rider, flows),
                       ("couplings.slide", f"elements.{element.name}",
                        "bodies.point" if isinstance(rider, Point) else f"bodies.{rider.NAME}"),
                       group="slide", role="slide",
                       missing=(slide.DISCRETE_GRADIENT if flows else slide.FLOWING_GRADIENT,),
                       facts={"coordinates": element.n_coordinates + slide.N_ENDS * flows + rider.N_VELOCITY,
                              "dim": element.dim},
                       element=element, rider=rider.NAME, flows=flows)


def _slides(element: Element, flows: bool = False) -> list[SlideFamily]:
    return [_slide(element, rider, flows) for rider in RIDERS.values() if rider.DIM == element.dim]


def _couplings() -> Iterator[Family]:
    """Yield the families of each module of couplings/ that has some; the slides are those of elements."""
    for file in iter_modules(couplings.__path__):
        of_module = getattr(import_module(f"{couplings.__name__}.{file.name}"), "families", list)
        yield from of_module()


def of_element(element: Element) -> list[Family]:
    """Return the families of an element: its own kernels, its laws, and its slide for each rider of its dimension."""
    return [_element(element), *(_law(element, law) for law in element.laws), *_slides(element)]


def families() -> dict[str, Family]:
    """Return every family by name: elements, laws, bodies, the slide of each element and rider, on ropes too, other
    couplings.
    """
    of_role: dict[str, list[Family]] = {"element": [], "law": [], "slide": []}
    for element in ELEMENTS.values():
        for family in of_element(element):
            of_role[family.role].append(family)
    every = [*of_role["element"], *of_role["law"], *map(_body, BODIES.values()),
             *(_modal(name, body) for name, body in modal.FRAMES.items()), *of_role["slide"],
             *chain.from_iterable(_slides(ELEMENTS[name], flows=True) for name in SPANS), *_couplings()]
    return {f.name: f for f in every}


def whole_groups(some: Iterable[str]) -> dict[str, Family]:
    """Return the families of these names, and those of their groups: what they share is found in all of them."""
    every = families()
    groups = {every[name].group for name in some} - {""}
    return {name: family for name, family in every.items() if name in some or family.group in groups}


def named(names: Iterable[str]) -> dict[str, Family]:
    """Return the families of these names.

    Raises KeyError for an unknown one, naming the near ones.
    """
    wanted, every = set(names), families()
    for name in wanted - every.keys():
        near = difflib.get_close_matches(name, every, n=3) or sorted(every)
        raise KeyError(f'no spec "{name}"; did you mean {", ".join(near)}?')
    return {name: family for name, family in every.items() if name in wanted}
