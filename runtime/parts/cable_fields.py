"""The fields of a cable, and the properties that do not depend on its shape."""

import os
from collections.abc import Callable
from functools import cached_property
from itertools import accumulate, pairwise
from typing import TYPE_CHECKING, Annotated, Any, TypeVar

import numpy as np
from pydantic import AfterValidator, Field, PrivateAttr, ValidationInfo

from ..errors import SceneError, near
from ..kernels.elements import ElementKind
from ..kernels.libraries import of_library, resolved
from . import curves
from .cable_laws import DEFAULT_ELEMENT, MEASURES
from .cable_mesh import Nodes
from .material import Material
from .part import Part
from .piece import Pieces, UniformPiece
from .schemas import ONLY_PYTHON, POINT, FileEntry, GivenAs, Turning, checked, list_of_lists
from .section import AnySection, Section, outer_radius_of
from .signal import Signal, varying
from .thermal import TEMPERATURE
from .validation import Count, Name, Points, Vector, one_of, positive, shown, xyz

if TYPE_CHECKING:
    from numpy.typing import ArrayLike  # for type checkers alone

T = TypeVar("T")


def library_directory(value: Any) -> str | None:
    """Return the absolute path of a library without links, and load it. Raises ValueError."""
    if value is None:
        return None
    if not isinstance(value, str | os.PathLike):
        raise ValueError(f"must be a directory, got {shown(value)}")
    directory = resolved(value)
    of_library(directory)
    return directory


def _element(value: Any, info: ValidationInfo) -> str:
    """Return the name of an element of the library, or of this package."""
    library = info.data.get("library")
    known = of_library(library)
    if not isinstance(value, str):
        raise ValueError(f"must be a name, got {shown(value)}", "known: " + ", ".join(known))
    if value not in known:
        where = f' in library "{library}"' if library else ""
        raise ValueError(f'"{value}" is not known{where}', near(value, known))
    return value


def _unless_pieces(value: Any, info: ValidationInfo) -> Any:
    """Return a value, which a cable without pieces must have."""
    if value is None and info.data.get("pieces", ()) is None:
        raise ValueError("is missing")
    return value


UNLESS_PIECES = AfterValidator(_unless_pieces)


class CableFields(Part):
    """Base of a cable: its fields, which `Cable` describes."""

    _hanging: Points | None = PrivateAttr(None)

    name: Name
    start: Annotated[Vector | None, xyz("m")] = None
    end: Annotated[Vector | None, xyz("m")] = None
    points: Annotated[Points | None, checked(curves.points, list_of_lists("m"), Turning(POINT))] = None
    curve: Annotated[Callable[..., Any] | None, GivenAs(ONLY_PYTHON)] = None  # kept as points, see `Cable._settled`
    shape: Annotated[str | None, one_of(("straight", "hanging"), optional=True)] = None
    given_elements: Annotated[Count | None, Field(alias="elements")] = None
    nodes: Nodes | None = None
    library: Annotated[str | None, checked(library_directory, {"type": "string"}, FileEntry())] = None
    element: Annotated[str, checked(_element, {"type": "string"})] = DEFAULT_ELEMENT
    law: str = None  # type: ignore[assignment]  # `Cable._settled` chooses one where none is given
    strain: Annotated[str | None, one_of(MEASURES["strain"], optional=True)] = None
    curvature: Annotated[str | None, one_of(MEASURES["curvature"], optional=True)] = None
    membrane: Annotated[str | None, one_of(MEASURES["membrane"], optional=True)] = None
    pieces: Pieces | None = None
    given_section: Annotated[AnySection | None, Field(alias="section", validate_default=True), UNLESS_PIECES] = None
    given_material: Annotated[Material | None, Field(alias="material", validate_default=True), UNLESS_PIECES] = None
    up: Annotated[Vector, xyz()] = (0.0, 1.0, 0.0)
    rest: Annotated[str, one_of(("drawn", "straight"))] = "drawn"
    rest_length: Annotated[float | Signal, varying(positive("m"))] | None = None
    temperature: Annotated[float | Signal, TEMPERATURE] | None = None
    velocity: Annotated[Vector, xyz("m/s")] = (0.0, 0.0, 0.0)
    angular_velocity: Annotated[Vector, xyz("rad/s")] = (0.0, 0.0, 0.0)

    @property
    def is_open(self) -> bool:
        """Return whether the number of its elements is still to be chosen."""
        return self.given_elements is None and self.nodes is None and self.pieces is None

    @property
    def elements(self) -> int:
        """Return the number of its elements. Raises SceneError where it is still to be chosen."""
        if self.given_elements is not None:
            return self.given_elements
        if self.nodes is not None:
            return len(self.nodes) - 1
        if self.pieces is not None:
            return sum(piece.elements for piece in self.pieces)
        raise SceneError(self.where, "has no elements yet",
                         "give elements=, or let them be chosen: scene.choose(tol).scene")

    @property
    def n_elements(self) -> int:
        """Return the number of its elements, 1 where it is still to be chosen."""
        return 1 if self.is_open else self.elements

    @cached_property
    def uniform_pieces(self) -> tuple[UniformPiece, ...]:
        """Return its pieces, one of a cable with one section and one material.

        Of a cable whose elements are still to be chosen, their number is 1.
        """
        if self.pieces is None:
            assert self.given_section is not None, f"{self.where} has no section"
            assert self.given_material is not None, f"{self.where} has no material"
            return UniformPiece(0, self.n_elements, self.given_section, self.given_material),
        ends = [0, *accumulate(piece.elements for piece in self.pieces)]
        return tuple(UniformPiece(first, end, piece.section, piece.material, piece.hinge)
                     for piece, (first, end) in zip(self.pieces, pairwise(ends), strict=True))

    @property
    def section(self) -> Section:
        """Return its section. Raises SceneError where its pieces have several."""
        return self.given_section or self._one([piece.section for piece in self.uniform_pieces], "section")

    @property
    def material(self) -> Material:
        """Return its material. Raises SceneError where its pieces have several."""
        return self.given_material or self._one([piece.material for piece in self.uniform_pieces], "material")

    def _one(self, each: list[T], what: str) -> T:
        """Return what all pieces have. Raises SceneError."""
        if any(other != each[0] for other in each):
            raise SceneError(self.where, f"has pieces of several {what}s, where one is needed",
                             f"give one {what} to all pieces, or a cable to each piece and join them by ties")
        return each[0]

    def of_elements(self, of_piece: Callable[[UniformPiece], float]) -> np.ndarray:
        """Return (elements,): a number of the piece of each element."""
        return self.repeated([of_piece(piece) for piece in self.uniform_pieces])

    def repeated(self, values: "ArrayLike") -> np.ndarray:
        """Return values (pieces, ...) of the pieces for each of their elements, (elements, ...)."""
        return np.repeat(values, [piece.end - piece.first for piece in self.uniform_pieces], axis=0)

    @property
    def kind_of_element(self) -> ElementKind:
        """Return the properties of its element."""
        return of_library(self.library)[self.element]

    @property
    def dim(self) -> int:
        """Return 3, or 2 for planar elements."""
        return self.kind_of_element.dim

    @property
    def is_round(self) -> bool:
        """Return whether all directions across its axis are equivalent: a round section, or elements without axes."""
        return not self.kind_of_element.director or all(outer_radius_of(piece.section) is not None
                                                        for piece in self.uniform_pieces)

    @property
    def stiffness_law(self) -> str:
        """Return the name of the law that gives the stiffness of its section, see `section_stiffness`."""
        laws = self.kind_of_element.laws
        return laws[self.law].stiffness_of if self.law in laws else self.law

    @property
    def drawn_through(self) -> Points:
        """Return the points that it is drawn through, in m."""
        if self.shape == "hanging" and self._hanging is not None:
            return self._hanging
        if self.points is not None:
            return self.points
        assert self.start is not None and self.end is not None, f"{self.where} has neither points nor ends"
        return self.start, self.end
