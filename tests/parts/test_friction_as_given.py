"""Slides, contacts and crossings take friction in one form: a coefficient, a `Friction` or its table."""

import funicular as fu
import numpy as np
import pytest
from funicular.parts.paths import path_of, value_at
from funicular.scene.file import loads
from funicular.scene.schema import scene_schema
from jsonschema import Draft7Validator
from shared_scenes import changed

RUBBING = ("trolley", "foot", "touch")
"""A slide, a contact and a crossing of `scene`."""
FORMS = {"number": 0.2, "part": fu.Friction(coefficient=0.2), "table": {"coefficient": 0.2},
         "numpy": np.float64(0.2), "whole": 0}


def scene(friction) -> fu.Scene:
    """Return a rider on a rope, a box on a plane, and a bar that is pulled along the rope."""
    made = fu.Scene(gravity=(0, -9.81, 0))
    made.cable("rope", start=(0, 0, 0), end=(2, 0, 0), elements=4, element="cable8p", section=fu.Circle(radius=0.01),
               material=fu.Material(youngs_modulus=1e8, poisson_ratio=0.3, density=1000), rest_length=1.99)
    made.pin("rope", s=0)
    made.pin("rope", s=1.99)
    for name, place in (("rider", (1.5, 0, 0)), ("box", (0, -1, 0)), ("head", (0.5, -0.0099, 0))):
        made.rigid_body(name, mass=1, inertia=(1, 1, 1), position=place, velocity=(0.1, 0, 0))
    made.joint("prismatic", (0.5, -0.0099, 0), "head", axis=(1, 0, 0))
    made.slide("rider", along="rope", s=1.4925, name="trolley", friction=friction)
    made.surface("floor", fu.Plane(point=(0, -1, 0)))
    made.contact("box", "floor", stiffness=1e4, friction=friction, name="foot")
    made.crossing("rope", "head", stiffness=1e4, side=(0, 1, 0), friction=friction, name="touch")
    return made


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")
def test_all_forms_are_one(form):
    made = scene(FORMS[form])
    for part in (made.slides["trolley"], made.contacts["foot"], made.crossings["touch"]):
        assert part.friction == fu.Friction(coefficient=0.0 if form == "whole" else 0.2)
    again = loads(made.to_toml())
    assert again.to_toml() == made.to_toml()
    assert again.contacts["foot"].friction == made.contacts["foot"].friction


@pytest.mark.parametrize("kind", ["slide", "contact", "crossing"])
def test_files_take_all_forms(kind):
    schema = scene_schema()
    entry = schema["properties"][kind]["items"]["properties"]["friction"]
    check = Draft7Validator({"$defs": schema["$defs"], **entry})
    for friction in (0.2, 0, {"coefficient": 0.2}, {"coefficient": 0.2, "model": "stick"}):
        check.validate(friction)
    for friction in (-0.2, "much", {"coeficient": 0.2}):
        assert not check.is_valid(friction)


@pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")
def test_a_path_leads_to_the_coefficient_whatever_was_given():
    for friction in (None, 0.2, fu.Friction(coefficient=0.2)):
        made = scene(friction)
        for name in RUBBING:
            for path, value in ((f"{name}.friction", 0.3), (f"{name}.friction.coefficient", 0.3)):
                found = changed(made, {path: value})
                assert value_at(found, path_of(found, f"{name}.friction.coefficient")) == 0.3


@pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")
def test_a_number_and_its_friction_move_alike():
    one, other = (scene(friction).run(duration=0.05, output_step=0.05, tol=1e-4, integrator="radau")
                  for friction in (0.2, fu.Friction(coefficient=0.2)))
    for name in ("rider.position", "box.position", "head.position", "foot.friction_force"):
        assert (one[name] == other[name]).all()
    assert np.abs(one["foot.friction_force"]).max() > 0.1


@pytest.mark.parametrize(("friction", "message"), [
    (-0.1, "friction.coefficient must not be negative"), (np.nan, "friction.coefficient must be finite"),
    ("much", "friction must be a coefficient, a Friction or a table of its values"), (True, "friction must be a coef"),
    ([0.1], "friction must be a coefficient"), ({"coeficient": 1}, "coeficient"),
])
def test_what_is_none_is_refused(friction, message):
    for make, others in ((fu.Slide, {"s": 1.0, "along": "b", "body": "a"}), (fu.Contact, {"a": "a", "b": "b"}),
                         (fu.Crossing, {"a": "a", "b": "b", "stiffness": 1.0})):
        with pytest.raises(fu.SceneError, match=message):
            make(friction=friction, **others)


@pytest.mark.parametrize(("friction", "message"), [
    ({"coefficient": 0.1, "viscous": 1.0}, "has viscous friction"),
    ({"rolling": 0.1}, "has rolling friction"),
    ({"coefficient": 0.1, "static_coefficient": 0.2}, "has a static_coefficient, which only slides and joints have"),
])
def test_what_is_of_slides_alone(friction, message):
    fu.Slide(body="a", along="b", s=1.0, friction=friction)
    for make, others in ((fu.Contact, {}), (fu.Crossing, {"stiffness": 1.0})):
        with pytest.raises(fu.SceneError, match=message):
            make(a="a", b="b", friction=friction, **others)
