"""Fields of parts declare how their vectors rotate, and to which cable their arc-lengths belong."""

from types import UnionType
from typing import Annotated, Union, get_args, get_origin

import funicular as fu
import numpy as np
import pytest
from funicular.base.rotations import conjugate, product, quaternion
from funicular.parts.attachment import Attachment
from funicular.parts.in_plane import turned_fields
from funicular.parts.kinds import KINDS
from funicular.parts.locations import following, on_cables
from funicular.parts.part import Part, about_fields
from funicular.parts.plane import Plane
from funicular.parts.plane_axes import PlaneAxes
from funicular.parts.scene_text import read
from funicular.parts.schemas import DIRECTION, POINT, TENSOR, FileEntry, Turning
from funicular.parts.surface_shapes import SURFACE_SHAPES
from funicular.parts.validation import Matrix, Vector, direction, place_on, xyz

WITH_FIELDS = (*KINDS, *SURFACE_SHAPES.kinds, Attachment)
TURN = np.array([0.5, 0.5, 0.5, 0.5])
PLANE = Plane.across(np.array([0.0, -1, 0]), np.zeros(3))
BODY = fu.RigidBody(name="A", mass=1.0, inertia=(1, 1, 1), position=(0, 0, 0),
                    orientation=product(quaternion(PLANE.axes), conjugate(TURN)))
UPRIGHT = PlaneAxes(PLANE, {"A": BODY}, 1.0)
"""x stays, z becomes y: the plane y = 0; A: a body whose axes the plane's come to by x y z -> z x y."""


def turnings_of(kind):
    return {name: about for name, about in about_fields(kind).items() if isinstance(about, Turning)}


def vectors_in(annotation):
    """Return whether a field can hold vectors."""
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
    assert xyz("m").about == Turning(POINT) and xyz("N").about == Turning(DIRECTION)
    assert direction("on").about == Turning(DIRECTION, "on")


class Wheel(Part):
    """A part of an unknown kind with vectors of new names."""

    kind = "wheel"
    on: str | None = None
    hub: Annotated[Vector, xyz("m")]
    axle: Annotated[Vector, direction()]
    spoke: Annotated[Vector, direction(of="on")] | None = None
    rail: Annotated[tuple[Vector, ...] | None, xyz("m")] = None
    end: Attachment | None = None
    s: Annotated[float, place_on("on")] | None = None


def test_vectors_of_a_new_part_are_turned():
    """A vector of a new name rotates with the axes."""
    wheel = Wheel(on="A", hub=(1, 0, 2), axle=(0, 0, 3), spoke=(1, 2, 3), end=Attachment(at=(4, 0, 5)))
    found = turned_fields(wheel, UPRIGHT)
    assert found.keys() == {"hub", "axle", "spoke", "end"}
    assert (found["hub"], found["axle"], found["end"].at) == ((1, 2, 0), (0, 3, 0), (4, 5, 0))
    assert found["spoke"] == pytest.approx((2, 3, 1))
    on_body = turned_fields(Wheel(hub=(0, 0, 0), axle=(1, 0, 0), end=Attachment(on="A", at=(1, 2, 3))), UPRIGHT)
    assert on_body["end"].at == pytest.approx((2, 3, 1))


def test_inertia_turns_as_a_tensor():
    body = next(kind for kind in KINDS if kind.kind == "rigid_body")
    assert turnings_of(body)["inertia"] == Turning(TENSOR, "name")
    part = body(name="A", mass=1.0, inertia=(1, 2, 2.5), position=(0, 0, 0))
    assert np.array(turned_fields(part, UPRIGHT)["inertia"]) == pytest.approx(np.diag([2, 2.5, 1]))


def test_vectors_of_a_new_part_leave_a_plane():
    wheel = Wheel(hub=(1, 0, 2), axle=(0, 1, 0), end=Attachment(at=(4, 0, 5)))
    assert [*wheel.off_plane()] == ["hub (1, 0, 2) m", "end (4, 0, 5) m"]
    contact = fu.Contact(a="A", b="bed", points=[(0, 0, 0), (0, 0, 3)])
    assert [*contact.off_plane()] == ["points (0, 0, 3) m"]


def test_arc_lengths_of_parts_keep_their_part_of_a_cable():
    """The node of an event moves with the length of its cable."""
    assert [*on_cables(Wheel(on="wire", hub=(0, 0, 0), axle=(1, 0, 0), s=2.0))] == [("s", "wire", 2.0)]
    scene = fu.Scene()
    scene.cable("wire", start=(0, 0, 0), end=(4, 0, 0), elements=4, element="cable12", section=fu.Circle(radius=0.01),
                material=fu.Material(youngs_modulus=1e7, poisson_ratio=0.3, density=1500.0))
    scene.event("low", quantity="wire.position.y", s=1.0, value=-1.0)
    found = following(scene, {0: {"rest_length": 4.4}})
    parts = list(scene.parts())
    assert scene.changed([(parts[k], entries) for k, entries in found.items()]).events["low"].s == 1.1


def test_paths_of_parts_in_a_scene_file_are_relative_to_it(tmp_path):
    """Each check of a path has a `FileEntry`; without it the path is relative to the working directory."""
    text = '[[rigid_body]]\nname = "A"\nmass = 1.0\ninertia = [1, 1, 1]\nposition = [0, 0, 0]\n'
    scene = read(text + 'shape = { kind = "mesh", file = "a.stl" }', "scene", fu.Scene, tmp_path)
    assert scene.bodies["A"].shape.file == str(tmp_path / "a.stl")
    paths = {f"{kind.__name__}.{name}" for kind in (*KINDS, fu.MeshShape, fu.VelocityTable)
             for name, about in about_fields(kind).items() if isinstance(about, FileEntry)}
    assert paths == {"Cable.library", "ModalBody.data", "MeshShape.file", "VelocityTable.file"}
