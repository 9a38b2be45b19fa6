"""Data that a scene computes and keeps: materials, geometry, starts of joints."""

import funicular
import numpy as np
import pytest
from funicular import FunicularWarning, Material, Rectangle, Scene, SceneError
from funicular.parts.kinds import KINDS, plural_of
from numpy.testing import assert_allclose


def test_material_from_either_constant():
    by_poisson = Material(youngs_modulus=2e11, density=7850, poisson_ratio=0.3)
    by_shear = Material(youngs_modulus=2e11, density=7850, shear_modulus=2e11 / 2.6)
    both = Material(youngs_modulus=2e11, density=7850, poisson_ratio=0.3, shear_modulus=2e11 / 2.6)
    lam, mu = 0.3 * 2e11 / (1.3 * 0.4), 2e11 / 2.6
    expected = [lam + 2 * mu] * 3 + [lam] * 3 + [mu] * 3
    for material in (by_poisson, by_shear, both):
        assert_allclose(material.elasticity(), expected, rtol=1e-12)


def test_elasticity_gives_the_uniaxial_stiffness_back():
    D11, D22, D33, D12, D13, D23, *G = Material(youngs_modulus=3e6, density=1, poisson_ratio=0.45).elasticity()
    stiffness = np.array([[D11, D12, D13], [D12, D22, D23], [D13, D23, D33]])
    compliance = np.linalg.inv(stiffness)
    assert_allclose(compliance[0], [1 / 3e6, -0.45 / 3e6, -0.45 / 3e6], rtol=1e-12)
    assert_allclose(G, 3e6 / 2.9, rtol=1e-12)


def test_table_1_has_no_coupling_at_all():
    material = Material(youngs_modulus=0.4e9, density=4200, shear_modulus=0.2e9)
    assert material.elasticity().tolist() == [0.4e9] * 3 + [0.0] * 3 + [0.2e9] * 3


@pytest.fixture
def scene():
    scene = Scene()
    scene.cable(
        "wire",
        start=(1, 2, 3),
        end=(1, 2, 5),
        elements=4,
        section=Rectangle(height=0.01, width=0.02),
        material=Material(youngs_modulus=1e9, density=1000, poisson_ratio=0.3),
        up=(3, 0, 7),
    )
    return scene


def test_geometry_of_a_cable(scene):
    wire = scene.cables["wire"]
    assert wire.length == 2
    assert wire.node_s.tolist() == [0, 0.5, 1, 1.5, 2]
    assert_allclose(wire.axes, [[0, 0, 1], [1, 0, 0], [0, 1, 0]], atol=1e-15)
    assert_allclose(wire.point(0.5), [1, 2, 3.5])
    assert wire.nodal_vectors.shape == (5, 4, 3)
    assert_allclose(wire.nodal_vectors[1], [[1, 2, 3.5], [0, 0, 1], [1, 0, 0], [0, 1, 0]], atol=1e-15)
    assert [wire.node_at(s) for s in (0, 1.5, 2, 1.4)] == [0, 3, 4, None]


def test_an_unknown_attribute_is_named(scene):
    for owner, message in ((scene, "'Scene' object has no attribute 'cabel'"),
                           (scene.cables["wire"], "'Cable' object has no attribute 'cabel'"),
                           (funicular, "module 'funicular' has no attribute 'cabel'")):
        with pytest.raises(AttributeError, match=f"^{message}$"):
            _ = owner.cabel


def test_the_ends_are_exact(scene):
    odd = scene.cables["wire"].model_copy(update={"start": (0.1, 0.2, 0.3), "end": (1.7, -0.9, 0.7)})
    assert tuple(odd.point(0.0)) == odd.start
    assert tuple(odd.point(odd.length)) == odd.end


def body(scene, **changes):
    return scene.rigid_body("A", **{"mass": 1, "inertia": (1, 1, 1), "position": (1, 2, 4)} | changes)


def test_a_slide_takes_names_or_parts_and_names_itself(scene):
    slide = scene.slide(body(scene), along=scene.cables["wire"], s=1)
    assert (slide.body, slide.along, slide.name) == ("A", "wire", "A_on_wire")
    assert scene.pin(scene.cables["wire"], s=0.5).label == "wire@0.5"


def test_the_rider_s_point_turns_with_the_body(scene):
    quarter_about_x = (np.sqrt(0.5), np.sqrt(0.5), 0, 0)
    rider = body(scene, position=(1, 2, 4 - 0.3), orientation=quarter_about_x)
    assert_allclose(rider.point((0, 0.3, 0)), [1, 2, 4], atol=1e-15)
    scene.slide(rider, along="wire", s=1, at=(0, 0.3, 0))
    assert scene.messages == []


def test_a_rider_slightly_off_is_moved_and_reported(scene):
    body(scene, position=(1, 2.0015, 4))
    with pytest.warns(
        FunicularWarning, match=r'slide "trolley": body "A" was moved by 0.0015 m onto cable "wire"'
    ) as warned:
        scene.slide("A", along="wire", s=1, name="trolley")
    assert_allclose(scene.bodies["A"].position, (1, 2, 4), rtol=1e-15)
    assert scene.messages == [str(warned[0].message)]
    assert warned[0].filename == __file__
    scene.check()


def test_an_orientation_is_normalised(scene):
    rider = body(scene, orientation=(0.7071, 0, 0.7071, 0))
    assert_allclose(rider.orientation, (np.sqrt(0.5), 0, np.sqrt(0.5), 0), rtol=1e-15)


def test_inertia_from_moments_matrix_or_array(scene):
    expected = ((1.0, 0.0, 0.0), (0.0, 2.0, 0.0), (0.0, 0.0, 2.5))
    for given in ((1, 2, 2.5), np.diag([1, 2, 2.5]), np.array([1, 2, 2.5]), expected):
        assert type(body(Scene(), inertia=given)).kind == "rigid_body"
        assert body(Scene(), inertia=given).inertia == expected


def test_numpy_scalars_are_numbers(scene):
    rider = body(scene, mass=np.float32(2), position=np.array([1, 2, 4]))
    assert (rider.mass, rider.position) == (2.0, (1.0, 2.0, 4.0))


def test_unnamed_parts_take_the_next_number(scene):
    scene.rigid_body("A", mass=1, inertia=(1, 1, 1), position=(0, 0, 0))
    names = [scene.force("A", value=(0, 0, 1), **given).name for given in
             ({}, {}, {"name": "force_3"}, {}, {"name": "force_9"}, {})]
    assert names == ["force_1", "force_2", "force_3", "force_4", "force_9", "force_5"]
    assert scene.spring("A", (0, 0, 9), stiffness=1).name == "spring_1"


def test_a_free_name_is_found_in_few_looks(scene, monkeypatch):
    """The search for a free name is linear: 2,000 unnamed forces once took 71 s."""
    scene.rigid_body("A", mass=1, inertia=(1, 1, 1), position=(0, 0, 0))
    looks, look = [], Scene.part_named
    monkeypatch.setattr(Scene, "part_named", lambda *a: (looks.append(a), look(*a))[1])
    for _ in range(500):
        scene.force("A", value=(0, 0, 1))
    assert len(looks) < 500 * 20


def test_supports_look_only_at_what_is_on_their_cable(scene, monkeypatch):
    from funicular.parts import locations

    looks, look = [], locations.node_of
    monkeypatch.setattr(locations, "node_of", lambda *a: (looks.append(a), look(*a))[1])
    wire = scene.cables["wire"]
    for k in range(50):
        scene.add(wire.model_copy(update={"name": f"wire_{k}"}))
        scene.pin(f"wire_{k}", s=0)
        scene.pin(f"wire_{k}", s=wire.length)
    assert len(looks) <= 100


def test_unnamed_events_are_all_kept(scene):
    """A second unnamed event does not replace the first."""
    scene.rigid_body("A", mass=1, inertia=(1, 1, 1), position=(0, 0, 0))
    for value in (0.1, 0.2, 0.3):
        scene.event(quantity="A.position.x", value=value)
    assert [(name, event.value) for name, event in scene.events.items()] == [
        ("event_1", 0.1), ("event_2", 0.2), ("event_3", 0.3)]
    with pytest.raises(SceneError, match='event "event_2": there is already an event of that name'):
        scene.event("event_2", quantity="A.position.x")


def test_every_kind_of_part_has_a_view_by_the_plural_of_its_name():
    """Kinds that share a group, such as springs and other forces between points, have views of their own."""
    scene = Scene()
    scene.rigid_body("A", mass=1, inertia=(1, 1, 1), position=(0, 0, 0))
    scene.spring("A", (0, 1, 0), stiffness=1.0, name="string")
    scene.force("A", value=(1, 0, 0), name="push")
    scene.moment("A", value=(1, 0, 0), name="twist")
    for kind in KINDS:
        view = getattr(scene, plural_of(kind.kind))
        assert isinstance(view, dict if kind.is_named() else list)
        assert all(type(part) is kind for part in (view.values() if kind.is_named() else view))
        assert plural_of(kind.kind) in dir(scene)
    assert list(scene.springs) == ["string"] and scene.springs["string"] is scene.point_forces["string"]
    assert list(scene.forces) == ["push"] and list(scene.moments) == ["twist"] and list(scene.rigid_bodies) == ["A"]
    with pytest.raises(SceneError, match="for reading"):
        del scene.springs["string"]
    with pytest.raises(SceneError, match="springs cannot be set"):
        scene.springs = {}
