"""Fields that may be zero are accepted, in runs and statics, or refused by a message."""

import funicular as fu
import numpy as np
import pytest
from funicular.kernels.libraries import kernels_of
from funicular.model.hulls import hull_of

pytestmark = pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")
CROSSING = {"stiffness": 1e5, "radius": 0.01, "damping": 0.1, "friction": 0.2, "exponent": 1.0,
            "tangential_stiffness": 1e4, "at": (4.5, -0.02, 0)}
CONTACT = {"stiffness": 1e4, "damping": 0.1, "friction": 0.2, "tangential_stiffness": 1e4, "radius": 0.05}
HARD = {"restitution": 0.5, "friction": 0.2, "radius": 0.05, "rest_velocity": 1e-3}
SPRING = {"stiffness": 100.0, "damping": 1.0, "length": 0.5, "free_play": 0.1}
DRAG = {"normal": 1.0, "tangential": 0.1, "displaced_area": 1e-4, "added_mass": 0.5, "diameter": 0.02}
FLUID = {"density": 1000.0, "velocity": (1, 0, 0), "scale": 1.0}


def rope(**crossing):
    """Return a rope of 10 m over a bar."""
    scene = fu.Scene(gravity=(0, -9.81, 0))
    scene.cable("rope", start=(0, 0, 0), end=(10, 0, 0), elements=6, element="cable8p", rest_length=9.99,
                section=fu.Circle(radius=0.01), material=fu.Material(youngs_modulus=1e9, poisson_ratio=0, density=8000))
    for s in (0, 9.99):
        scene.pin("rope", s=s)
    if crossing:
        scene.crossing("rope", side=(0, 1, 0), name="bar", **crossing)
    return scene


def in_water(fluid=FLUID, **drag):
    scene = rope()
    scene.fluid("water", **fluid)
    scene.drag("rope", fluid="water", **drag)
    return scene


def body(contact=None, spring=None):
    scene = fu.Scene(gravity=(0, -9.81, 0))
    scene.rigid_body("b", mass=1.0, inertia=(1e-3,) * 3, position=(0, 0.0501, 0), velocity=(0.1, 0, 0))
    if contact:
        scene.surface("ground", fu.Plane())
        scene.contact("b", "ground", **contact)
    if spring:
        scene.spring("b", (0, 2, 0), **spring)
    return scene


KINDS = {"crossing": (CROSSING, rope), "contact": (CONTACT, lambda **given: body(contact=given)),
         "hard contact": (HARD, lambda **given: body(contact=given)),
         "spring": (SPRING, lambda **given: body(spring=given)), "drag": (DRAG, in_water),
         "fluid": (FLUID, lambda **given: in_water(fluid=given, **DRAG))}


@pytest.mark.parametrize(("kind", "field"), [(kind, field) for kind, (given, _) in KINDS.items() for field in given])
def test_a_field_that_is_zero(kind, field):
    given, make = KINDS[kind]
    zero = (0, 0, 0) if isinstance(given[field], tuple) else 0.0
    try:
        scene = make(**given | {field: zero})
    except fu.SceneError:
        return
    run = scene.run(duration=0.02, tol=1e-3)
    assert all(np.isfinite(run[name]).all() for name in run.keys() if name.endswith(("position", "velocity")))
    try:
        scene.equilibrium()
    except fu.FunicularError as error:
        assert kind in ("contact", "hard contact", "spring"), error  # nothing holds the body sideways


def test_a_crossing_without_a_radius_touches_where_its_lines_meet():
    """The radius 0 is the limit of small radii: the static force equals that of 0.1 mm to 1e-7."""
    thin, none = (rope(**CROSSING | {"radius": radius, "friction": None, "tangential_stiffness": None,
                                     "at": (4.5, -radius, 0)}) for radius in (1e-4, 0.0))
    rest = none.equilibrium()
    assert rest["bar.normal_force"] == pytest.approx(thin.equilibrium()["bar.normal_force"], rel=1e-6)
    assert not [message for message in rest.messages if "radius" in message]


@pytest.mark.parametrize("length", [1e-5, 1e-3, 1.0, 1e4, 1e6])
@pytest.mark.parametrize("element, degree", [("cable8p", 3), ("cable12", 3), ("cable18", 5), ("beam24", 3)])
def test_hulls_have_the_degree_of_the_axis_at_any_length(element, degree, length):
    """Shares of r_xx grow with length²: a bound in m² made the degree depend on the length of elements."""
    kernel = getattr(kernels_of(None), f"{element}_on_axis")
    assert hull_of(kernel, np.array([length])).points.shape[1] == degree + 1
