"""Scenes made of others with one part changed."""

import re

import funicular as fu
import numpy as np
import pytest
from expectations import refused
from funicular.parts.kinds import PARTS


def test_replace_returns_a_changed_scene():
    scene = fu.load_scene("cable_car")
    slide = next(iter(scene.slides))
    changed = scene.replace(slide, friction=fu.Friction(coefficient=0.05))
    assert changed.slides[slide].friction == fu.Friction(coefficient=0.05) != scene.slides[slide].friction
    assert changed.to_toml() != scene.to_toml()
    assert changed.replace(slide, friction=scene.slides[slide].friction).to_toml() == scene.to_toml()
    assert changed.run_settings == scene.run_settings


def test_replace_checks_and_names():
    scene = fu.load_scene("paper51")
    with refused('scene: there is no part "wires"; did you mean "wire"?'):
        scene.replace("wires", elements=4)
    with refused('cable "wire": elements must be a whole number, 1 or more, got 0'):
        scene.replace("wire", elements=0)
    with pytest.raises(fu.SceneError, match='"element_count" is not known here'):
        scene.replace("wire", element_count=3)
    pin = scene.pins[1]
    assert scene.replace(pin, s=1.0).pins[1].s == 1.0
    with refused('cable "wire": elements cannot be changed once the part is made; make another part, or another scene: '
                 'scene.replace("wire", elements=...)'):
        scene.cables["wire"].elements = 4


ROPE = {"start": (0, 0, 0), "end": (1, 0, 0), "elements": 4, "element": "cable12", "section": fu.Circle(radius=0.01),
        "material": fu.Material(youngs_modulus=1e9, poisson_ratio=0.3, density=1000)}


def rope(**given) -> fu.Scene:
    scene = fu.Scene()
    scene.cable("rope", **ROPE | given)
    return scene


@pytest.mark.parametrize(("given", "changes", "law"), [
    ({}, {"membrane": "reduced"}, "green_exact_reduced"),
    ({}, {"strain": "engineering"}, "engineering_exact"),
    ({"strain": "engineering"}, {"membrane": "reduced"}, "engineering_exact_reduced"),
    ({"strain": "engineering"}, {"curvature": "linear"}, "engineering_linear"),
    ({"law": "engineering_exact"}, {"membrane": "assumed"}, "engineering_exact_assumed"),
    ({"law": "engineering_exact_tension_only"}, {"curvature": "exact"}, "engineering_exact_tension_only"),
    ({"strain": "engineering", "membrane": "reduced"}, {"membrane": None}, "engineering_exact"),
    ({"strain": "engineering", "membrane": "reduced"}, {"strain": None}, "green_exact_reduced"),
    ({"strain": "engineering"}, {"law": "green_exact"}, "green_exact"),
    ({"strain": "engineering"}, {"element": "cable18"}, "engineering_exact"),
    ({}, {"element": "beam24"}, "continuum"),
    ({"element": "beam24"}, {"element": "cable12"}, "green_exact"),
    ({"element": "beam24", "law": "structural"}, {"elements": 2}, "structural"),
])
def test_another_measure_keeps_the_others_and_makes_another_law(given, changes, law):
    cable = rope(**given).replace("rope", **changes).cables["rope"]
    assert cable.law == law
    assert cable.law == fu.Cable(**cable.entries()).law


def test_a_law_that_no_longer_fits_is_refused_by_name():
    with pytest.raises(fu.SceneError, match='law "structural" is not possible for cable12; possible: green_exact, '):
        rope(element="beam24", law="structural").replace("rope", element="cable12")
    with pytest.raises(fu.SceneError, match="curvature and membrane are for cable elements, beam24 is a beam; leave"):
        rope(strain="engineering").replace("rope", element="beam24")


def test_a_cable_is_drawn_anew():
    bent = rope().replace("rope", curve=lambda u: (u, u**2, 0))
    assert bent.cables["rope"].points is not None and bent.cables["rope"].start is None
    assert bent.replace("rope", curve=lambda u: (u, 0, 0)).cables["rope"].points[-1] == (1, 0, 0)
    assert bent.replace("rope", start=(0, 0, 0), end=(2, 0, 0), points=None).cables["rope"].length == 2
    with pytest.raises(fu.SceneError, match="has points and start or end; give the points alone"):
        bent.replace("rope", start=(0, 0, 0))
    hung = rope().replace("rope", shape="hanging", rest_length=1.2, elements=8).cables["rope"]
    assert (hung.rest, hung.drawn_length) == ("straight", pytest.approx(1.2, abs=1e-6))
    drawn = rope(shape="hanging", rest_length=1.2).replace("rope", points=[(0, 0, 0), (1, 0, 0)], nodes=(0, 0.5, 1.2))
    assert (drawn.cables["rope"].shape, drawn.cables["rope"].elements) == (None, 2)


def test_what_a_scene_has_found_is_found_anew():
    """Omitted lengths, axes and ends follow from the scene, also after a change of another part."""
    scene = rope()
    scene.rigid_body("A", mass=1, inertia=(1, 1, 1), position=(0, 3, 0))
    scene.spring("A", (0, 0, 0), stiffness=10, name="free")
    scene.spring("A", (0, 0, 0), stiffness=10, length=2.5, name="given")
    scene.joint("distance", "A", ("rope", 1.0), name="rod")
    scene.distributed_force("rope", value=(0, -1, 0), name="wind")
    moved = scene.replace("A", position=(0, 4, 0))
    assert [moved.point_forces[name].length for name in ("free", "given")] == [4, 2.5]
    assert moved.joints["rod"].length == pytest.approx(np.hypot(1, 4))
    assert scene.replace("rope", rest_length=1.5).loads["wind"].stop == 1.5
    assert moved.replace("free", length=3).replace("A", position=(0, 5, 0)).point_forces["free"].length == 3
    section = fu.GeneralSection(area=1e-4, second_moment_about_z=1e-9)
    assert fu.GeneralSection(**section.entries() | {"second_moment_about_z": 2e-9}).second_moment_about_y == 2e-9


def test_another_rider_has_its_own_point():
    scene = rope()
    for name in "AB":
        scene.rigid_body(name, mass=1, inertia=(1, 1, 1), position=(0.5, -0.25 * (name == "A"), 0))
    scene.slide("A", along="rope", s=0.5, at=(0, 0.25, 0), name="trolley")
    assert scene.replace("trolley", body="B").slides["trolley"].at == (0, 0, 0)
    assert scene.replace("trolley", body=(0.5, 0, 0)).slides["trolley"].body is None
    assert scene.replace("trolley", body="A").slides["trolley"].at == (0, 0.25, 0)


def everything() -> fu.Scene:
    """Return a scene with a part of every kind."""
    scene = rope(strain="engineering")
    scene.cable("bar", **ROPE | {"start": (0, 0, 1), "end": (1, 0, 1), "element": "beam24", "law": "structural"})
    scene.cable("hook", **ROPE | {"start": (1, 0, 0), "end": (2, 0, 0)})
    scene.point_mass("rope", s=0.4, mass=1.0, name="clump")
    scene.pin("rope", s=0.0)
    scene.clamp("bar", s=0.5, fix="all")
    scene.motion("bar", s=1.0, displacement=(fu.Harmonic(amplitude=0.1, frequency=1.0), 0, "free"))
    scene.tie("hook", s=0.0, to="rope", at=1.0, rotation="free", name="breakpoint")
    scene.rigid_body("A", mass=1, inertia=(1, 1, 1), position=(0.5, 0, 0), shape=fu.Sphere(radius=0.1))
    scene.rigid_body("B", mass=1, inertia=(1, 1, 1), position=(0.5, -1, 0))
    scene.modal_body("beam", start=(0, 0, 3), end=(1, 0, 3), section=fu.Circle(radius=0.01), material=ROPE["material"],
                     elements=4, modes=2)
    scene.joint("revolute", "A", ("B", (0, 1, 0)), axis=(0, 0, 1), name="hinge")
    scene.joint("distance", "B", ("hook", 1.0), name="rod")
    scene.slide("A", along="rope", s=0.5, frame="tangent", roll="fixed", friction=fu.Friction(coefficient=0.1),
                name="trolley")
    scene.force("B", value=(1, 0, 0), at=(0, 0.1, 0), name="push")
    scene.distributed_force("rope", value=(0, -1, 0), name="wind")
    scene.moment("bar", s=0.5, value=(0, 0, 1), name="turn")
    scene.spring("B", (0, -3, 0), stiffness=10, damping=1, name="spring")
    scene.event("low", quantity="B.position.y", value=-2)
    scene.fluid("air", density=1.2, velocity=(3, 0, 0))
    scene.drag("rope", fluid="air", normal=1.2, name="gust")
    scene.ice("bar", thickness=0.01, name="rime")
    scene.surface("bed", fu.Plane(point=(0, -5, 0)))
    scene.surface("side", fu.Plane(point=(0, -6, 0)))
    scene.contact("hook", "bed", name="landing")
    scene.relaxation("hook", stiffness=1e3, time=0.5, name="viscosity")
    scene.wire_friction("hook", stiffness=0.5, moment=0.1, name="wires")
    for k, name in enumerate(("fibres", "yarn")):
        scene.cable(name, **ROPE | {"start": (0, 0, 5 + k), "end": (1, 0, 5 + k), "membrane": "tabulated",
                                    "section": fu.Circle(radius=0.01, tension_table=fu.TensionTable(
                                        strain=(0, 0.1), force=(0, 1e3)))})
    scene.working_curve("fibres", permanent=0.3, form="exponential", bend=0.5, name="worked")
    scene.crossing("rope", "B", at=(0, 0.5, 0), axis=(0, 0, 1), length=0.2, stiffness=1e3, name="touch")
    return scene


def hoist() -> fu.Scene:
    """Return a planar scene with a rope, which `everything` cannot have."""
    scene = fu.Scene()
    scene.rigid_body("A", mass=1, inertia=(1, 1, 1), position=(-1, 0, 0))
    scene.rope("hoist", route=[fu.Anchor("A"), fu.Sheave("top", at=(0, 3, 0), radius=0.2), fu.Anchor(at=(1, 0, 0))],
               section=ROPE["section"], material=ROPE["material"], tension=1e3)
    return scene


OTHERS = {
    "rope": {"name": "cord", "route": [fu.Anchor("A"), fu.Sheave("high", at=(0, 4, 0), radius=0.3), fu.Anchor("A", at=(
             1, 0, 0))], "section": fu.Circle(radius=0.02), "elements": (2, 3), "tension": 2e3, "length": 6.0,
             "material": fu.Material(youngs_modulus=2e9, poisson_ratio=0.3, density=1000), "element": "cable8p",
             "mass": False, "temperature": 0.0},
    "cable": {"name": "cord", "start": (0, 0, 0.0), "end": (1.0, 0, 0), "points": ((0, 0, 0), (0.5, 0, 0), (1, 0, 0)),
              "curve": lambda u: (u, 0, 0), "elements": 8, "nodes": (0, 0.25, 1.0),
              "element": "cable18", "law": "engineering_linear",
              "strain": "green", "curvature": "linear", "membrane": "assumed", "section": fu.Circle(radius=0.02),
              "material": fu.Material(youngs_modulus=2e9, poisson_ratio=0.3, density=1000), "up": (0, 1, 1),
              "pieces": [fu.Piece(length=0.5, section=fu.Circle(radius=0.02), elements=n, material=fu.Material(
                  youngs_modulus=2e9, poisson_ratio=0.3, density=density)) for density, n in ((1000, 4), (2000, 8))],
              "rest": "straight", "rest_length": 1.0, "shape": "straight", "temperature": 0.0,
              "velocity": (0, 0, 1), "angular_velocity": (0, 1, 0)},
    "point_mass": {"on": "hook", "s": 0.5, "mass": 2.0, "name": "x"},
    "pin": {"cable": "hook", "s": 0.25},
    "clamp": {"cable": "rope", "s": 0.0, "fix": "section", "direction": (1, 0.1, 0)},
    "motion": {"cable": "rope", "s": 0.75, "displacement": (0, 0, 0), "rotation": ((1, 0, 0), 0.1)},
    "tie": {"cable": "hook", "s": 0.0, "to": "rope", "at": 1.0, "rotation": "rigid", "name": "knot_2"},
    "rigid_body": {"name": "C", "mass": 2.0, "inertia": (2, 2, 2), "position": (0.5, 0, 0.0),
                   "orientation": (0, 1, 0, 0),
                   "centre": (0, 0, 0.1), "velocity": (0, 0, 0.0), "angular_velocity": (0, 0, 1),
                   "shape": fu.Box(size=(1, 1, 1))},
    "modal_body": {"name": "pole", "start": (0, 0.1, 3), "end": (1, 0.1, 3), "section": fu.Circle(radius=0.02),
                   "material": fu.Material(youngs_modulus=2e9, poisson_ratio=0.3, density=1000), "up": (0, 0, 1),
                   "elements": 8, "element": "cable12", "law": "structural", "modes": 3, "boundary": "attached",
                   "orthogonal": False, "damping_ratio": 0.1, "velocity": (1, 0, 0), "angular_velocity": (1, 0, 0)},
    "joint": {"kind": "cylindrical", "a": "A", "b": ("B", (0, 1, 0.0)), "axis": (1, 0, 0), "angle": 0.0,
              "name": "x"},
    "slide": {"body": (0.5, 0, 0), "along": "rope", "s": 0.5, "at": (0, 0, 0.0), "name": "x", "frame": "point",
              "roll": "free", "up": (0, 1, 1), "drive": 0.5, "velocity": 0.1, "friction": fu.Friction(coefficient=0.2),
              "at_start": "leave", "at_end": fu.HardStop(restitution=0.5)},
    "force": {"on": "A", "at": (0, 0, 0), "value": (2, 0, 0), "scale": 2.0, "follower": True, "name": "x",
              "offsets": (0, -1), "shares": (2,), "when": "x", "until": "y"},
    "distributed_force": {"cable": "hook", "value": (0, -2, 0), "start": 0.25, "stop": 0.75, "follower": False,
                          "scale": 2.0, "name": "x", "when": "x", "until": "y"},
    "moment": {"on": "B", "s": 0.25, "value": (0, 0, 2), "scale": 2.0, "name": "x", "when": "x", "until": "y"},
    "spring": {"a": "A", "b": (0, -4, 0), "stiffness": 20.0, "damping": 2.0, "length": 1.0, "tension_only": True,
               "free_play": 0.1, "name": "x"},
    "fluid": {"name": "breeze", "density": 1.3, "surface": -3.0, "velocity": (0, 0, 2.0), "scale": 2.0,
              "profile": fu.PowerProfile(exponent=0.2, reference_height=10)},
    "drag": {"on": "hook", "fluid": "air", "start": 0.25, "stop": 0.75, "normal": 1.0, "tangential": 0.01,
             "diameter": 0.03, "displaced_area": 0.0,
             "lift": 0.2, "added_mass": 1.0,
             "name": "x"},
    "surface": {"name": "floor", "shape": fu.HeightField(x=(0, 1), heights=(-7, -8)), "on": "B", "at": (0, -1, 0)},
    "contact": {"a": "rope", "b": "side", "stiffness": 1e4, "exponent": 1.5, "damping": 0.1, "friction": 0.2,
                "tangential_stiffness": 1e5, "radius": 0.02, "start": 0.25, "stop": 0.75, "name": "x"},
    "ice": {"cable": "hook", "thickness": 0.02, "density": 600.0, "start": 0.25, "stop": 0.75, "diameter": 0.03,
            "name": "x"},
    "relaxation": {"cable": "rope", "stiffness": 2e3, "time": 0.7, "name": "other"},
    "wire_friction": {"cable": "rope", "stiffness": 0.7, "moment": 0.2, "name": "other"},
    "working_curve": {"cable": "yarn", "permanent": 0.2, "form": "quadratic", "bend": 0.4, "highest_tension": 50.0,
                      "name": "other"},
    "crossing": {"a": "hook", "b": "A", "at": (0, 0.6, 0), "axis": (0, 1, 1), "length": 0.3, "radius": 0.02,
                 "stiffness": 2e3, "exponent": 1.5, "damping": 0.1, "tangential_stiffness": 1e5,
                 "friction": fu.Friction(coefficient=0.2), "side": (0, 1, 0), "name": "x"},
    "event": {"name": "x", "quantity": "B.position.x", "value": 1.0, "direction": "rising", "action": "stop"},
}
"""Another value for fields, by the kind of the part."""

REFUSED = {
    ("slide", "frame"): 'roll "fixed" is for frame "tangent", got frame "point"; leave it out, or take frame="tangent"',
    ("moment", "on"): 'acts on body "B" and takes no arc-length s',
    ("force", "offsets"): "offsets and shares are of a force that moves",
    ("force", "shares"): "offsets and shares are of a force that moves",
    ("ice", "cable"): 'is on a cable with the contact "landing"',
    ("cable", "name"): 'there is no cable "rope"',
    ("rigid_body", "name"): 'there is no cable or body "A"',
    ("fluid", "name"): 'there is no fluid "air"',
    ("surface", "name"): 'there is no surface "bed"',
}
"""Why another value is refused, as another entry, or another part, does not go with it."""

ONE_OF_TWO = {("rope", "closed"),
              ("force", "s"), ("event", "s"), ("event", "function"), ("modal_body", "data"), ("modal_body", "position"),
              ("modal_body", "orientation"), ("joint", "second_axis"), ("joint", "up"), ("joint", "distance"),
              ("joint", "velocity"), ("joint", "length"), ("joint", "friction"), ("joint", "radius"),
              ("joint", "normal_force"), ("slide", "body_s"), ("spring", "table"),
              ("drag", "area"), ("drag", "coefficient"), ("drag", "at"), ("drag", "volume"), ("drag", "height"),
              ("contact", "points"), ("contact", "restitution"), ("contact", "rest_velocity"),
              ("drag", "polar"), ("drag", "span"), ("drag", "chord"), ("drag", "added_mass_tangential"),
              ("drag", "added_mass_form"), ("fluid", "table"), ("fluid", "waves"), ("fluid", "depth"),
              ("surface", "inside"), ("working_curve", "strain"), ("working_curve", "force")}
"""Fields of parts that are described otherwise, or of other kinds of joints."""


REASONS = "missing", "needs", "has neither", "either a", "is for frame", "are for cable elements", "there is no fluid"
"""Why a value cannot be left out."""


@pytest.mark.parametrize("shape", [fu.Plane(normal=(0, 1, 0.1)), fu.Sphere(radius=0.2), fu.Box(size=(0.2, 0.4, 0.2)),
                                   fu.Cylinder(radius=0.1, length=0.4, axis=(0, 0, 1)),
                                   fu.Capsule(radius=0.1, length=0.4, axis=(1, 0, 0)),
                                   fu.HeightField(x=(0, 1), heights=(0, 0.1))])
def test_each_shape_of_a_surface_can_take_the_place_of_another(shape):
    scene = everything().replace("bed", shape=shape, at=(0, -5, 0))
    assert scene.surfaces["bed"].shape == shape
    assert scene.contacts["landing"].b == "bed" and scene.replace("bed", on="B").surfaces["bed"].on == "B"
    assert fu.Scene.from_toml(scene.to_toml()).surfaces["bed"] == scene.surfaces["bed"]


def test_all_fields_are_tried():
    fields = {(kind, keyword) for kind, part in PARTS.items() for keyword in part.keywords()}
    tried = {(kind, keyword) for kind, values in OTHERS.items() for keyword in values}
    assert tried <= fields and fields - tried <= ONE_OF_TWO | {("cable", "library")}


@pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")
@pytest.mark.parametrize("kind", PARTS)
def test_each_field_of_each_part_can_be_replaced(kind):
    """Each field is replaced by its own value, by none if optional, and by another value; impossible ones are refused.
    """
    scene = hoist() if kind == "rope" else everything()
    part = next(part for part in scene.parts() if part.kind == kind)
    here, keywords = [*scene.parts()].index(part), type(part).keywords()
    for keyword, value in part.as_made().entries().items():
        same = scene.replace(part, **{keyword: value})
        assert [*same.parts()][here].entries().items() >= part.entries().items(), keyword
        try:
            other = [*scene.replace(part, **{keyword: None}).parts()][here]
        except fu.SceneError as error:
            assert any(reason in str(error) for reason in REASONS), (keyword, error)
        else:
            assert keyword in ("law", "name") or keyword not in other.as_made().model_fields_set
    for keyword, value in OTHERS[kind].items():
        if (kind, keyword) in REFUSED:
            with pytest.raises(fu.SceneError, match=re.escape(REFUSED[kind, keyword])):
                scene.replace(part, **{keyword: value})
            continue
        other = [*scene.replace(part, **{keyword: value}).parts()][here]
        if keyword not in ("curve", "body", "a", "b", "route"):  # kept as points, or completed
            alone = type(part).model_validate(part.entries_with({keyword: value}))
            assert getattr(other, keywords[keyword]) == getattr(alone, keywords[keyword]), keyword
