"""The list of everything that is generated. A new spec joins by one entry in its own list."""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from functools import partial
from types import ModuleType

from .bodies import BODIES, RIDERS, modal, modal_kernels
from .bodies import kernels as body_kernels
from .bodies.point import Point
from .couplings import frame, resistance, slide, spring
from .couplings import joint as pair
from .elements import ELEMENTS
from .elements import kernels as element_kernels
from .laws import DAMPED_LIKE, law_like, law_name
from .laws import kernels as law_kernels
from .laws.structural import kernels as structural_kernels
from .laws.structural import structural
from .spec import Element, Family


def _element(element: Element) -> Family:
    return Family(element.name, element.doc, partial(element_kernels.build, element),
                  (f"elements.{element.name}", "elements.kernels"),
                  role="element",
                  facts={"nodes": len(element.nodes), "vectors": len(element.nodal_vectors), "dim": element.dim},
                  element=element)


def _law(element: Element, law: str | type) -> Family:
    name = law_name(law)
    twin = DAMPED_LIKE.get(name)
    shared = {kernel: f"{element.name}_{twin}" for kernel in (*law_kernels.DAMPING, *law_kernels.ALGORITHMIC)
              if twin in element.laws}
    if name == structural.NAME:
        builder, build = structural_kernels, partial(structural_kernels.build, element, law)
    else:
        builder, build = law_kernels, partial(law_kernels.build, element, law, damping=not shared)
    return Family(f"{element.name}_{name}", f"elastic law {name} on {element.name}", build,
                  (f"elements.{element.name}", builder.__name__.removeprefix("funicular.derive.")), role="law",
                  own=("stiffness", "stiffness_at", "section_forces"), shared=shared,
                  lacks=law_kernels.lacks(law), facts=law_kernels.facts(element, law), element=element, law=name,
                  like=law_like(law))


def _body(body: ModuleType) -> Family:
    return Family(body.NAME, body.DOC, partial(body_kernels.build, body), (f"bodies.{body.NAME}", "bodies.kernels"),
                  role="body",
                  facts={"dim": body.DIM, "configuration": body.N_CONFIGURATION, "velocity": body.N_VELOCITY},
                  rider=body.NAME)


def _modal(name: str, frame: ModuleType) -> Family:
    return Family(name, f"modal body on a {frame.NAME} frame", partial(modal_kernels.build, name, frame),
                  ("bodies.modal", f"bodies.{frame.NAME}", "bodies.modal_kernels"),
                  role="modal",
                  facts={"dim": frame.DIM},
                  rider=frame.NAME)


def _slide(element: Element, rider: ModuleType | Point) -> Family:
    return Family(f"slide_{element.name}_{rider.NAME}",
                  f"sliding joint of a {rider.NAME} rider on a {element.name} cable",
                  partial(slide.build, element, rider),
                  ("couplings.slide", f"elements.{element.name}",
                   "bodies.point" if isinstance(rider, Point) else f"bodies.{rider.NAME}"),
                  role="slide",
                  facts={"coordinates": element.n_coordinates + rider.N_VELOCITY, "dim": element.dim},
                  element=element, rider=rider.NAME)


def _frame(dim: int) -> Family:
    return Family(frame.FRAMES[dim], f"frame of two vectors in {_SPACE[dim]}", partial(frame.build, dim),
                  ("couplings.frame",), role="frame", facts={"dim": dim}, dim=dim)


def _resistance(dim: int) -> Family:
    return Family(resistance.RESISTANCES[dim], f"friction and buffers of slides in {_SPACE[dim]}",
                  partial(resistance.build, dim),
                  ("couplings.resistance",), role="resistance", facts={"dim": dim}, dim=dim)


def _spring(name: str, of: spring.Spring) -> Family:
    return Family(name, f"spring and damper{'' if of.has_length else ' of no rest length'} between two points in "
                  f"{_SPACE[of.dim]}", partial(spring.build, name), ("couplings.spring",), role="spring",
                  facts={"dim": of.dim}, dim=of.dim)


def _joint(dim: int, name: str) -> Family:
    return Family(f"joint_{name}", f"{name.replace('_', ' ')} joint between two frames", partial(pair.build, dim, name),
                  ("couplings.joint",), role="joint", facts={"dim": dim, "rows": pair.rows(dim, name)}, dim=dim)


_SPACE = {2: "the plane", 3: "space"}


def of_element(element: Element) -> list[Family]:
    """An element's own kernels, its laws, and the slide of each rider of its dimension."""
    return [_element(element), *(_law(element, law) for law in element.laws),
            *(_slide(element, rider) for rider in RIDERS.values() if rider.DIM == element.dim)]


def families() -> dict[str, Family]:
    """Every family by name: elements, their laws, bodies, the slide for each pair of element and rider, joints,
    resistances, springs.
    """
    of_role: dict[str, list[Family]] = {"element": [], "law": [], "slide": []}
    for element in ELEMENTS.values():
        for family in of_element(element):
            of_role[family.role].append(family)
    joints = [_joint(dim, name) for dim, of_dim in pair.JOINTS.items() for name in of_dim]
    every = [*of_role["element"], *of_role["law"], *map(_body, BODIES.values()),
             *(_modal(name, of) for name, of in modal.FRAMES.items()),
             *of_role["slide"],
             *map(_frame, frame.FRAMES), *joints, *map(_resistance, resistance.RESISTANCES),
             *(_spring(name, of) for name, of in spring.SPRINGS.items())]
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
