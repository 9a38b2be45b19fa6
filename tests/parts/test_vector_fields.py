"""Fields of parts that are vectors say how other axes change them, and scenes in other planes turn all of them."""

from types import UnionType
from typing import Annotated, Union, get_args, get_origin

import numpy as np
import pytest
from funicular.parts.attachment import Attachment
from funicular.parts.kinds import KINDS
from funicular.parts.laid import turned_fields
from funicular.parts.part import Part
from funicular.parts.plane import Plane
from funicular.parts.plane_axes import PlaneAxes
from funicular.parts.schemas import DIRECTION, POINT, TENSOR, Turning
from funicular.parts.surface_shapes import SURFACE_SHAPES
from funicular.parts.validation import Matrix, Vector, direction, xyz
from funicular.parts.vector_fields import turnings_of

WITH_FIELDS = (*KINDS, *SURFACE_SHAPES.kinds, Attachment)
UPRIGHT = PlaneAxes(Plane.across(np.array([0.0, -1, 0]), np.zeros(3)), {"A": np.array([0.5, 0.5, 0.5, 0.5])}, 1.0)
"""x stays, z becomes y: the plane y = 0; A: a body whose axes the plane's come to by x y z -> z x y."""


def vectors_in(annotation):
    """Return whether a field holds vectors, or may."""
    if annotation in (Vector, Matrix):
        return True
    inner = get_origin(annotation) in (Union, UnionType, Annotated, tuple)
    return inner and any(vectors_in(each) for each in get_args(annotation))


@pytest.mark.parametrize("kind", WITH_FIELDS, ids=lambda kind: kind.__name__)
def test_all_vectors_say_how_they_turn(kind):
    """Use `xyz` or `direction` for a new vector, or give its own check a `Turning`."""
    found = {name for name, field in kind.model_fields.items() if vectors_in(field.annotation)}
    assert found <= set(turnings_of(kind)), f"{kind.__name__}: {found - set(turnings_of(kind))}"
    for name, turning in turnings_of(kind).items():
        assert turning.of in (None, "holder") or hasattr(kind, turning.of) or turning.of in kind.model_fields, name


def test_checks_know_points_from_directions():
    assert xyz("m").turning == Turning(POINT) and xyz("N").turning == Turning(DIRECTION)
    assert direction("on").turning == Turning(DIRECTION, "on")


class Wheel(Part):
    """A part of a kind that nothing knows, with vectors of new names."""

    kind = "wheel"
    on: str | None = None
    hub: Annotated[Vector, xyz("m")]
    axle: Annotated[Vector, direction()]
    spoke: Annotated[Vector, direction(of="on")] | None = None
    rail: Annotated[tuple[Vector, ...] | None, xyz("m")] = None
    end: Attachment | None = None


def test_vectors_of_a_new_part_are_turned():
    """A vector of a new name stayed along the ground's axes without a word."""
    wheel = Wheel(on="A", hub=(1, 0, 2), axle=(0, 0, 3), spoke=(1, 2, 3), end=Attachment(at=(4, 0, 5)))
    found = turned_fields(wheel, UPRIGHT)
    assert {**found, "end": found["end"].at} == {"hub": (1, 2, 0), "axle": (0, 3, 0), "spoke": (2, 3, 1),
                                                 "end": (4, 5, 0)}
    on_body = turned_fields(Wheel(hub=(0, 0, 0), axle=(1, 0, 0), end=Attachment(on="A", at=(1, 2, 3))), UPRIGHT)
    assert on_body["end"].at == (2, 3, 1)


def test_inertia_turns_as_a_tensor():
    body = next(kind for kind in KINDS if kind.kind == "rigid_body")
    assert turnings_of(body)["inertia"] == Turning(TENSOR, "name")
    part = body(name="A", mass=1.0, inertia=(1, 2, 2.5), position=(0, 0, 0))
    assert np.array(turned_fields(part, UPRIGHT)["inertia"]) == pytest.approx(np.diag([2, 2.5, 1]))
