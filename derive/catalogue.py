"""The list of everything that is generated. A new spec joins by one entry in its own list."""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from functools import partial

from .bodies import BODIES, RIDERS, Body, Rider, modal, modal_kernels
from .bodies import kernels as body_kernels
from .bodies.point import Point
from .codegen.family import (
    BodyFamily,
    CouplingFamily,
    ElementFamily,
    Family,
    LawFamily,
    PointLawFamily,
    SlideFamily,
)
from .couplings import crossing, drag, frame, joint, point_law, resistance, slide, surface
from .couplings.point_laws import LAWS as POINT_LAWS
from .elements import ELEMENTS
from .elements import kernels as element_kernels
from .laws import kernels as law_kernels
from .laws import law_name, law_traits, stiffness_of
from .laws.structural import kernels as structural_kernels
from .laws.structural import structural
from .spec import Element, PointLaw

_SPACE = {2: "the plane", 3: "space"}


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


def _slide(element: Element, rider: Rider) -> SlideFamily:
    return SlideFamily(f"slide_{element.name}_{rider.NAME}",
                       f"sliding joint of a {rider.NAME} rider on a {element.name} cable",
                       partial(slide.build, element, rider),
                       ("couplings.slide", f"elements.{element.name}",
                        "bodies.point" if isinstance(rider, Point) else f"bodies.{rider.NAME}"),
                       group="slide", role="slide",
                       facts={"coordinates": element.n_coordinates + rider.N_VELOCITY, "dim": element.dim},
                       element=element, rider=rider.NAME)


def _frame(dim: int) -> CouplingFamily:
    return CouplingFamily(frame.FRAMES[dim], f"frame of two vectors in {_SPACE[dim]}", partial(frame.build, dim),
                          ("couplings.frame",), role="frame", facts={"dim": dim}, dim=dim)


def _resistance(dim: int) -> CouplingFamily:
    return CouplingFamily(resistance.RESISTANCES[dim], f"friction and buffers of slides in {_SPACE[dim]}",
                          partial(resistance.build, dim),
                          ("couplings.resistance",), role="resistance", facts={"dim": dim}, dim=dim)


def _drag(dim: int) -> CouplingFamily:
    return CouplingFamily(drag.DRAGS[dim], f"drag of a fluid in {_SPACE[dim]}", partial(drag.build, dim),
                          ("couplings.drag", "couplings.section_flow", "couplings.added_mass", "couplings.wetness"),
                          role="drag", missing=() if dim == 3 else ("lift_along_cable", "on_section"),
                          facts={"dim": dim}, dim=dim)


def _crossing(dim: int) -> CouplingFamily:
    return CouplingFamily(crossing.CROSSINGS[dim], f"contact of lines at their closest points in {_SPACE[dim]}",
                          partial(crossing.build, dim),
                          ("couplings.crossing", "couplings.crossing_stretch", "couplings.stretch"), role="crossing",
                          facts={"dim": dim}, dim=dim)


def _surface(dim: int) -> CouplingFamily:
    return CouplingFamily(surface.SURFACES[dim], f"surfaces and contact with them in {_SPACE[dim]}",
                          partial(surface.build, dim), ("couplings.surface", "couplings.stretch"), role="surface",
                          facts={"dim": dim}, dim=dim)


def _joint(dim: int, name: str) -> CouplingFamily:
    return CouplingFamily(f"joint_{name}", f"{name.replace('_', ' ')} joint between two frames",
                          partial(joint.build, dim, name), ("couplings.joint",), role="joint",
                          facts={"dim": dim, "rows": joint.rows(dim, name)}, dim=dim)


def of_point_law(name: str, law: PointLaw) -> list[Family]:
    """Return the families of the force between two points by a law, in space and in the plane."""
    return [PointLawFamily(prefix + name, f"{law.doc} in {_SPACE[dim]}",
                           partial(point_law.build, prefix + name, law, dim),
                           (f"couplings.point_laws.{name}", "couplings.point_law"), role="point_law",
                           missing=point_law.missing(law), facts={"dim": dim, "parameters": len(law.parameters)},
                           dim=dim, point_law=law) for dim, prefix in ((3, ""), (2, "planar_"))]


def of_element(element: Element) -> list[Family]:
    """Return the families of an element: its own kernels, its laws, and its slide for each rider of its dimension."""
    return [_element(element), *(_law(element, law) for law in element.laws),
            *(_slide(element, rider) for rider in RIDERS.values() if rider.DIM == element.dim)]


def families() -> dict[str, Family]:
    """Return every family by name: elements, laws, bodies, the slide of each element and rider, joints, resistances,
    drag, crossings, surfaces, forces between two points.
    """
    of_role: dict[str, list[Family]] = {"element": [], "law": [], "slide": []}
    for element in ELEMENTS.values():
        for family in of_element(element):
            of_role[family.role].append(family)
    joints = [_joint(dim, name) for dim, of_dim in joint.JOINTS.items() for name in of_dim]
    every = [*of_role["element"], *of_role["law"], *map(_body, BODIES.values()),
             *(_modal(name, body) for name, body in modal.FRAMES.items()),
             *of_role["slide"],
             *map(_frame, frame.FRAMES), *joints, *map(_resistance, resistance.RESISTANCES), *map(_drag, drag.DRAGS),
             *map(_crossing, crossing.CROSSINGS), *map(_surface, surface.SURFACES),
             *(family for name, law in POINT_LAWS.items() for family in of_point_law(name, law))]
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
