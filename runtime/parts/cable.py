"""Cables, and the checks of their shape, mesh, law and section."""

from collections.abc import Iterable, Iterator, Mapping
from typing import Any, Self

import numpy as np
from pydantic import model_validator

from ..errors import SceneError
from ..kernels.elements import built_in
from ..kernels.libraries import of_library
from . import cable_drawing, cable_laws, cable_mesh, curves
from .cable_fields import CableFields, library_directory
from .cable_laws import others, possible_laws
from .drawn_cable import DrawnCable
from .hanging import catenary
from .material import Material
from .piece import with_elements
from .section import GeneralSection, Section
from .section_stiffness import kernel_law
from .signal import Signal
from .validation import LENGTH_TOLERANCE, show, shown

MAX_GROWTH_RANGE = 4.0
"""Of the stress-free lengths of a beam, up to which series of the constants of its law end."""


class Cable(DrawnCable, CableFields):
    """A cable of elements, drawn straight, through points or along a curve.

    Arc-lengths s are those of the undeformed cable. A run starts from the drawn shape. The tangent of a curve must be
    continuous; the curvature may jump, as from a straight part to an arc.

    Without ``elements`` and ``nodes``, `Scene.choose`, or a run with ``model="auto"``, chooses equal elements for a
    tolerance, and also element and law without an ``element``.

    Planar elements lie in the plane through their line and ``up``, with the height on the side of ``up``. With line and
    ``up`` in z = 0 the height is z x tangent.

    A cable with a curved stress-free shape measures the magnitude of the exact curvature: it resists bending in the
    plane of its curve, and only by tension bending across it. For thin arcs of beams the law is "structural": the
    continuum locks, unless its elements are shorter than about two heights.

    start, end: ends of a straight or hanging cable, m
    points: points (x, y, z) of a smooth curve, m
    curve: a function of u from 0 to 1 that returns x, y, z in m; kept as points
    shape: "straight"; or "hanging": along the catenary of an inextensible cable of the ``rest_length``, longer than the
        span, from ``start`` to ``end`` under the gravity of the scene, with a straight stress-free shape
    elements: number of elements of equal length
    nodes: arc-lengths of the nodes, from 0 to the length, m; close together where the cable bends sharply or parts are
        attached. The ratio of the longest and the shortest element is at most 1e6
    library: directory of a library of elements
    element: name of the element
    law: of beams, "continuum" (the default), "poisson_split" or "structural"
    strain: of cable elements, the axial measure, "green" (the default) or "engineering"
    curvature: of cable elements, the measure of bending, "exact" (the default) or "linear"
    membrane: of cable elements, the representation of axial strain. "full" (the default): at every point.
        "tension_only": at every point, engineering strain, with 1e-4 of the axial stiffness in compression, where the
        force is at most that plus 2.5e-7 EA. "assumed": by Legendre modes of degree 0 to 2 ("cable18": 0 to 4).
        "tabulated": at every point, engineering strain, the force by the ``tension_table`` of the section; the
        material's Young's modulus gives bending and damping.
        "reduced": by modes of degree 0 and 1 ("cable18": 0 to 2), with 1 % of the axial stiffness on higher modes.
        Beside a point force on a taut rope, the tension of full and assumed strain oscillates, that of reduced strain
        hardly. Reduced strain is for small strain, stable up to a compression of 1 %, and needs about four times the
        elements for axial waves
    section: cross-section
    material: material
    pieces: in the place of section, material, elements and rest_length: a list of `Piece`, from start to end
    up: direction of the section's height at the start, less its component along the axis; the section follows the curve
        without rotation about its tangent. It may lie along the axis of a round section or of an element without
        section axes: the height is then along the ground's axis most nearly across
    rest: undeformed shape, "drawn" or "straight"
    rest_length: undeformed length, m, by default the drawn length. A shorter one makes the drawn cable taut, a longer
        one slack, or compressed where it is straight. Also a signal, as of a tendon or a turnbuckle: s and mass are
        those at t = 0, and the work is in ``energy.external``
    temperature: above that of the stress-free state, K, a number or a signal; by default that of the scene. By
        ``thermal_expansion`` of the material of each piece it lengthens the stress-free cable along its axis. Mass,
        section and stiffness stay as given, and s is that at 0 K
    velocity: initial velocity of the first point, m/s; the cable moves as a rigid body, except at its supports
    angular_velocity: initial angular velocity about the first point, rad/s, along the ground's axes
    """

    kind = "cable"
    group = "cables"
    of_scene = ("temperature",)

    @model_validator(mode="before")
    @classmethod
    def _settled(cls, data: Any) -> Any:
        """Replace a curve by points, and measures of the law by its name."""
        if not isinstance(data, dict):
            return data
        optional = ("start", "end", "points", "curve", "law", "library", "rest_length", "elements", "nodes",
                    "shape", *cable_laws.MEASURES)
        data = {name: value for name, value in data.items() if value is not None or name not in optional}
        if "curve" in data:
            if "points" in data:
                raise ValueError("has points and a curve", "give one of them")
            curve, elements = data.pop("curve"), data.get("elements", len(np.atleast_1d(data.get("nodes", 0))))
            if not callable(curve):
                raise ValueError(f"curve must be a function of u from 0 to 1, got {shown(curve)}", "or give points")
            data["points"] = curves.sample(curve, min(elements, 1000) if isinstance(elements, int) else 1)
        if data.get("shape") == "hanging":
            data.setdefault("rest", "straight")
        try:
            known = of_library(library_directory(data.get("library")))
        except ValueError:  # the check of the field refuses the library
            return data
        element = data.get("element", cable_laws.DEFAULT_ELEMENT)
        if isinstance(element, str) and element in known:
            data["law"] = cable_laws.chosen(known[element], data)
        return data

    @model_validator(mode="after")
    def _consists_of_pieces(self) -> "Cable":
        given = [name for name, value in (("section", self.given_section), ("material", self.given_material),
                                          ("elements", self.given_elements), ("nodes", self.nodes),
                                          ("rest_length", self.rest_length)) if value is not None]
        if self.pieces is None:
            return self
        if given:
            raise ValueError(f"has pieces and {given[0]}", f"leave {given[0]} out: each piece has its own "
                             + {"nodes": "elements", "rest_length": "length"}.get(given[0], given[0]))
        if self.pieces[0].hinge:
            raise ValueError("begins with a piece at a hinge, which joins a piece to the one before it",
                             "leave hinge out of the first piece")
        lengths = [piece.length / piece.elements for piece in self.pieces]
        if max(lengths) > cable_mesh.MAX_LENGTH_RATIO * min(lengths):
            k = lengths.index(min(lengths))
            raise ValueError(f"pieces.{k} of {show(self.pieces[k].length, 'm')} has elements of "
                             f"{show(lengths[k], 'm')}: the longest of the cable is {max(lengths) / lengths[k]:.3g} "
                             f"times as long, at most {cable_mesh.MAX_LENGTH_RATIO:g} times is allowed",
                             "give it fewer elements or more length, or leave it out")
        if self.rest == "drawn" and not self._shape.straight:
            raise ValueError("is drawn curved and has pieces, whose stress-free shape is straight",
                             'give rest="straight"')
        return self

    @model_validator(mode="after")
    def _is_drawn(self) -> "Cable":
        ends = self.start is not None, self.end is not None
        if self.points is not None and any(ends):
            raise ValueError("has points and start or end", "give the points alone, the first is the start")
        if self.points is None and not all(ends):
            missing = "end is" if ends[0] else "start is" if ends[1] else "start and end, or points, are"
            raise ValueError(f"{missing} missing")
        if self.shape is not None and self.points is not None:
            raise ValueError(f'has points and shape="{self.shape}"', "give one of them")
        if self.shape == "hanging" and self.rest_length is None and self.pieces is None:
            raise ValueError('has shape="hanging", but rest_length is missing')
        if self.shape == "hanging" and self.rest != "straight":
            raise ValueError('has shape="hanging", but rest="drawn"', 'leave rest out, or give the '
                             "catenary as curve")
        if self.start is not None and self.end is not None and self.start == self.end:
            raise ValueError(
                f"start and end must be different points, got {show(self.start)} and {show(self.end, 'm')}")
        if self.nodes is not None:
            if self.given_elements is not None:
                raise ValueError(f"has {self.given_elements} elements and {len(self.nodes)} nodes",
                                 "give elements of equal lengths, or the nodes")
            cable_mesh.check_ends(self.nodes, self.length)
        self._check_drawing()
        return self

    def _check_drawing(self) -> None:
        """Raise ValueError where its elements cannot be drawn along its shape."""
        if self.dim == 2:
            cable_drawing.check_plane(self.element, self.drawn_through, self.velocity, self.angular_velocity, self.up)
        else:
            cable_drawing.check_height(self.drawn_through, self.up, self.is_round)
        if not self.is_open:
            cable_drawing.check_elements(self._shape, self.node_s * self.stretch)

    def hanging_under(self, gravity: tuple[float, ...]) -> "Cable":
        """Return a hanging cable drawn along its catenary under gravity (m/s²), another as it is. Raises SceneError."""
        if self.shape != "hanging":
            return self
        assert self.start is not None, f"{self.where} has no start"
        assert self.end is not None, f"{self.where} has no end"
        try:
            curve = catenary(self.start, self.end, self.length, gravity)
            made = self.hanging_through(curves.points(curves.sample(curve, 1 if self.is_open else
                                                                    min(self.elements, 1000))))
            made._check_drawing()
        except ValueError as error:
            raise SceneError(self.where, *error.args) from None
        return made

    def model_copy(self, *, update: Mapping[str, Any] | None = None, deep: bool = False) -> Self:
        """Return a copy with other values of fields; its shape follows from them."""
        made = super().model_copy(update=update, deep=deep)
        for name in ("_shape", "uniform_pieces", "_mesh_of_pieces"):
            vars(made).pop(name, None)
        return made

    def hanging_through(self, points: Iterable[tuple[float, ...]]) -> "Cable":
        """Return the cable drawn through points of its catenary, in m, without checks."""
        made = self.model_copy()
        made._hanging = tuple(points)
        return made

    @model_validator(mode="after")
    def _can_grow(self) -> "Cable":
        self.check_growth()
        return self

    def check_growth(self) -> None:
        """Raise ValueError(cause, remedy) where its stress-free length cannot grow as given."""
        warm, growth = self.temperature, self.growth
        if warm is not None and warm != 0.0 and None in {
                piece.material.thermal_expansion for piece in self.uniform_pieces}:
            raise ValueError("has a temperature, but its material has no thermal_expansion",
                             "give the material one, 0 for a cable that keeps its length")
        if isinstance(self.rest_length, Signal) and growth[0].signal is not self.rest_length:
            raise ValueError("has signals for rest_length and temperature", "give one of them as a number")
        if not (least := min(each.least for each in growth)) > 0:
            raise ValueError(f"the stress-free length must stay positive, got {least:.6g} times the length at "
                             "0 K", "give temperature in K above the stress-free state, thermal_expansion in 1/K")
        if not self.grows or (self.is_open and "element" not in self.model_fields_set):
            return
        name = "rest_length" if growth[0].signal is self.rest_length else "temperature"
        if self.library is not None:
            raise ValueError(f"{name} is a signal, but {self.element} of a library takes a number alone, for which the "
                             "constants of its law are made", "give a number, or take " + others(self.dim, cable=True))
        if not self.kind_of_element.is_cable and any(
                each.greatest > MAX_GROWTH_RANGE * each.least for each in growth):
            raise ValueError(f"the largest stress-free length by the signal of {name} is more than "
                             f"{MAX_GROWTH_RANGE:g} times the smallest, too much for the constants of the law of "
                             f"{self.element}", "give less, or take " + others(self.dim, cable=True))

    @model_validator(mode="after")
    def _law_suits(self) -> "Cable":
        """Check that the law suits the shape, the section and the material. Raises ValueError(cause, remedy)."""
        if self.is_open and "element" not in self.model_fields_set:
            return self
        kind = self.kind_of_element
        if self.is_curved and kind.law_for_curved_shape(kernel_law(self.law)) is None:
            curved = {name: [law for law in possible_laws(other) if other.law_for_curved_shape(kernel_law(law))]
                      for name, other in built_in().items()}
            able = [f"{name} ({', '.join(laws)})" for name, laws in curved.items() if laws]
            raise ValueError(f'{self.element} with law "{self.law}" is stress-free only where it is straight, but '
                             "it is drawn curved", 'take rest="straight", or one of ' + ", ".join(able))
        for piece in self.uniform_pieces:
            ratio = piece.material.poisson()
            if self.dim == 3 and kernel_law(self.stiffness_law) == "continuum" and piece.material.is_incompressible:
                raise ValueError(f'law "{self.law}" needs a poisson_ratio below 0.5, at which Lamé\'s λ is infinite, '
                                 f"got {ratio:.9g}", 'take law="structural", which needs E and G alone')
            (self._check_cable_section if kind.is_cable else self._check_beam_section)(piece.section)
            self._check_torque(piece.section, piece.material)
            self._check_table(piece.section)
        return self

    def _check_cable_section(self, section: Section) -> None:
        """Raise ValueError where an element without section axes is given what only beams have."""
        beams = "leave it out, or take " + others(self.dim, cable=False)
        moments = section.second_moment_about_z, section.second_moment_about_y
        if self.dim == 3 and abs(moments[0] - moments[1]) > LENGTH_TOLERANCE * max(moments):
            raise ValueError(f"{self.element} has one bending stiffness: its section needs equal second moments, "
                             f"got {show(moments, 'm⁴')}", 'take a square, a circle or a tube, or element="beam24"')
        if given := section.given_beside_shape:
            raise ValueError(f"section.{min(given)} is given, but {self.element} has neither shear nor torsion", beams)
        if isinstance(section, GeneralSection) and section.has_rotary:
            raise ValueError(f"section.rotary_moment is given, but {self.element} has no rotary inertia", beams)

    def _check_beam_section(self, section: Section) -> None:
        """Raise ValueError where the law of a beam needs other data of the section than those given."""
        given, is_general = section.given_beside_shape, isinstance(section, GeneralSection)
        if not min(section.moments()[1:3]) > 0:
            raise ValueError("has a section without second moments, which beams need", "give them, or take "
                             + others(self.dim, cable=True))
        if self.traits.kind == "structural":
            missing = ({"shear_factors", "torsion_constant"} if self.dim == 3 else {"shear_factors"}) - given
            if is_general and missing:
                raise ValueError(f'law "structural" needs section.{min(missing)}, which a general section does not '
                                 "tell", "give it to the section")
        elif is_general:
            raise ValueError(f'law "{self.law}" integrates over the shape of the section, which a general section does '
                             "not tell", 'take law="structural", a rectangle, circle or tube, or '
                             + others(self.dim, cable=True))
        elif self.law == "continuum" and given:
            raise ValueError(f'section.{min(given)} is given, but law "continuum" computes its own from the shape',
                             'leave it out, or take law="poisson_split" or "structural"')

    def _check_torque(self, section: Section, material: Material) -> None:
        """Raise ValueError where the tension of a section cannot make a torque."""
        if not section.torque_per_tension:
            return
        if self.traits.kind != "structural" or self.dim == 2:
            raise ValueError(f'section.torque_per_tension is given, but the law "{self.law}" of {self.element} has no '
                             "torque by tension", 'leave it out, or take element="beam24" with law="structural"')
        EA, GJ = material.youngs_modulus * section.area, material.lame()[1] * section.torsion_constant
        if not EA * section.torque_per_tension**2 < GJ:
            raise ValueError(f"section.torque_per_tension must be smaller than √(GJ/EA) = {(GJ / EA) ** 0.5:.6g} m, so "
                             f"that strain and twist store energy, got {section.torque_per_tension:.6g} m")

    def _check_table(self, section: Section) -> None:
        """Raise ValueError unless a section has a table of the axial force exactly where the law takes one."""
        takes = self.traits.membrane == "tabulated"
        if takes and section.tension_table is None:
            raise ValueError(f'law "{self.law}" needs section.tension_table',
                             "give the section a fu.TensionTable(strain=..., force=...)")
        if section.tension_table is not None and not takes:
            raise ValueError(f'section.tension_table is given, but the law "{self.law}" of {self.element} takes none',
                             'leave it out, or take element="cable12" or "cable8p" with membrane="tabulated"')

    def mesh_entries(self, elements: int) -> dict[str, Any]:
        """Return the entries of the cable with another number of elements.

        Unequal elements are divided or joined evenly where the number is a multiple or a divisor of theirs. Else the
        new elements are equal.
        """
        if self.pieces is not None:
            return {"pieces": with_elements(self.pieces, elements)}
        nodes = cable_mesh.refined(self.uneven_nodes, elements)
        return {"nodes": nodes, "elements": None} if nodes else {"elements": elements, "nodes": None}

    @property
    def uneven_nodes(self) -> tuple[float, ...]:
        """Return the arc-lengths of its nodes in m where its elements are not equal, else ()."""
        return () if self.nodes is None or self.mesh.is_even else tuple(self.mesh.node_s.tolist())

    def entries(self) -> dict[str, Any]:
        """Return its entries; of an open cable without the element and the law that were not given."""
        entries = super().entries()
        if self.is_open and "element" not in self.model_fields_set:
            return {name: value for name, value in entries.items() if name not in ("element", "law")}
        return entries

    def entries_with(self, changes: Mapping[str, Any]) -> dict[str, Any]:
        """Return the entries of a cable with changes.

        Another shape or law replaces all entries of the old one; another measure keeps the other measures. Elements
        replace nodes, nodes replace elements, and pieces replace section, material, elements and rest_length. A hanging
        cable is free of stress where it is straight.
        """
        other = {"elements": "nodes", "nodes": "elements"}
        left: dict[str, Any] = {other[name]: None for name in other if changes.get(name) is not None}
        if any(changes.get(name) is not None for name in ("points", "curve")):
            left |= dict.fromkeys(("start", "end", "points", "shape"))
        if changes.get("shape") == "hanging":
            left["rest"] = None
        if changes.get("pieces") is not None:
            left |= dict.fromkeys(("section", "material", "elements", "nodes", "rest_length"))
        if "law" not in changes:
            left |= cable_laws.changed(self.kind_of_element, self.law, changes, self.library)
        elif changes["law"] != self.law:
            left |= dict.fromkeys(cable_laws.MEASURES)
        return super().entries_with(left | {**changes})

    def off_plane(self) -> Iterator[str]:
        """Yield nothing: a planar cable lies in a plane of its own."""
        return iter(())
