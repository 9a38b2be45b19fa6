"""Each refusal of bad input names the place, the cause and, where possible, the remedy."""

import math

import funicular
import numpy as np
import pytest
from expectations import refused
from funicular import Circle, Material, Rectangle, ResultFileError, Scene, SceneError, Tube

NAN, INF = math.nan, math.inf
SECTION = Rectangle(height=0.05, width=0.05)
STEEL = {"youngs_modulus": 2e11, "density": 7850, "poisson_ratio": 0.3}
CABLE = {
    "start": (0, 0, 0),
    "end": (1.5, 0, 0),
    "elements": 3,
    "section": SECTION,
    "material": Material(**STEEL),
}
BODY = {"mass": 1.0, "inertia": (1e-3, 1e-3, 1e-3), "position": (0.25, 0, 0)}


def scene():
    made = Scene()
    made.cable("wire", **CABLE)
    made.rigid_body("A", **BODY)
    return made


BAD_SIZES = [
    (-0.05, "be positive, got -0.05 m"),
    (0, "be positive, got 0 m"),
    (NAN, "be finite, got nan m"),
    (INF, "be finite, got inf m"),
    (10**400, "be finite, got inf m"),
    ("0.05", "be a number, got '0.05'"),
    (True, "be a number, got True"),
    (None, "be a number, got None"),
]


@pytest.mark.parametrize(("size", "complaint"), BAD_SIZES)
@pytest.mark.parametrize(
    ("section", "name", "others"),
    [
        (Rectangle, "height", {"width": 1}),
        (Rectangle, "width", {"height": 1}),
        (Circle, "radius", {}),
        (Tube, "outer_radius", {"inner_radius": 0.1}),
        (Tube, "inner_radius", {"outer_radius": 0.1}),
    ],
)
def test_sizes(section, name, others, size, complaint):
    with refused(f"{section.__name__}: {name} must {complaint}"):
        section(**others, **{name: size})


def test_the_place_in_a_cable():
    with refused('cable "wire": section.height must be positive, got -0.05 m'):
        Scene().cable("wire", **CABLE | {"section": {"shape": "rectangle", "height": -0.05, "width": 0.05}})
    with refused('cable "wire": material.density must be positive, got 0 kg/m³'):
        Scene().cable("wire", **CABLE | {"material": STEEL | {"density": 0}})


def test_a_tube_needs_a_wall():
    with refused("Tube: inner_radius must be smaller than outer_radius (0.1 m), got 0.1 m"):
        Tube(outer_radius=0.1, inner_radius=0.1)


@pytest.mark.parametrize(
    ("changes", "complaint"),
    [
        ({"youngs_modulus": -1}, "youngs_modulus must be positive, got -1 Pa"),
        ({"youngs_modulus": 0}, "youngs_modulus must be positive, got 0 Pa"),
        ({"youngs_modulus": NAN}, "youngs_modulus must be finite, got nan Pa"),
        ({"density": -INF}, "density must be finite, got -inf kg/m³"),
        ({"density": 0.0}, "density must be positive, got 0 kg/m³"),
        ({"poisson_ratio": 0.51}, "poisson_ratio must be above -1 and at most 0.5, got 0.51"),
        ({"poisson_ratio": -1}, "poisson_ratio must be above -1 and at most 0.5, got -1"),
        ({"poisson_ratio": NAN}, "poisson_ratio must be finite, got nan"),
        ({"poisson_ratio": None, "shear_modulus": -1}, "shear_modulus must be positive, got -1 Pa"),
        ({"poisson_ratio": None}, "poisson_ratio or shear_modulus is missing; give one of the two"),
        (
            {"poisson_ratio": None, "shear_modulus": 0.6e11},
            "shear_modulus must be at least youngs_modulus / 3 = 6.66666667e+10 Pa, got 6e+10 Pa; "
            "the Poisson ratio E / (2 G) - 1 = 0.666666667 must be above -1 and at most 0.5",
        ),
        (
            {"shear_modulus": 1e11},
            "shear_modulus 1e+11 Pa and poisson_ratio 0.3 disagree: E / (2 (1 + ν)) = 7.69230769e+10 Pa; "
            "give one of the two",
        ),
        ({"damping_time": -1e-3}, "damping_time must not be negative, got -0.001 s"),
        ({"densty": 1}, '"densty" is not known here; did you mean "density"?'),
    ],
)
def test_material(changes, complaint):
    with refused(f"Material: {complaint}"):
        Material(**STEEL | changes)


@pytest.mark.parametrize(
    ("changes", "complaint"),
    [
        ({"end": (0, 0, 0)}, "start and end must be different points, got (0, 0, 0) and (0, 0, 0) m"),
        (
            {"up": (-2, 0, 0)},
            "up must not be zero or parallel to the axis (1, 0, 0), got (-2, 0, 0); "
            "give the direction of the section's height",
        ),
        (
            {"up": (0, 0, 0)},
            "up must not be zero or parallel to the axis (1, 0, 0), got (0, 0, 0); "
            "give the direction of the section's height",
        ),
        ({"start": (0, NAN, 0)}, "start must be finite, got (0, nan, 0) m"),
        ({"end": (INF, 0, 0)}, "end must be finite, got (inf, 0, 0) m"),
        ({"end": (1, 0)}, "end must be 3 numbers, got (1, 0)"),
        ({"end": "far"}, "end must be 3 numbers, got 'far'"),
        ({"elements": 0}, "elements must be a whole number, 1 or more, got 0"),
        ({"elements": -3}, "elements must be a whole number, 1 or more, got -3"),
        ({"elements": 2.5}, "elements must be a whole number, 1 or more, got 2.5"),
        ({"elements": True}, "elements must be a whole number, 1 or more, got True"),
        ({"element": "beam42"}, 'element "beam42" is not known; did you mean "beam24"?'),
        ({"section": 0.05}, "section must be a section such as Rectangle(height=0.05, width=0.05), got 0.05"),
        ({"section": {"height": 1}}, "section has no shape; known: rectangle, circle, tube, general"),
        ({"section": {"shape": "cirkle"}}, 'section has the unknown shape "cirkle"; did you mean "circle"?'),
        ({"material": "steel"}, "material must be a Material or a table of its values, got 'steel'"),
    ],
)
def test_cable(changes, complaint):
    with refused(f'cable "wire": {complaint}'):
        Scene().cable("wire", **CABLE | changes)


@pytest.mark.parametrize("name", ["", "a.b", "a@1", "a/b", "1st", 7, None])
def test_names_leave_the_signs_of_results_alone(name):
    with pytest.raises(SceneError, match=r"name must be made of letters, digits, _ and -, and begin with no digit"):
        Scene().cable(name, **CABLE)


@pytest.mark.parametrize(
    ("changes", "complaint"),
    [
        ({"mass": 0}, "mass must be positive, got 0 kg"),
        ({"mass": -1}, "mass must be positive, got -1 kg"),
        ({"mass": NAN}, "mass must be finite, got nan kg"),
        ({"mass": None}, "mass must be a number, got None"),
        ({"inertia": (0, 1, 1)}, "inertia must be positive, got the principal moments (0, 1, 1) kg m²"),
        ({"inertia": (-1, 1, 1)}, "inertia must be positive, got the principal moments (-1, 1, 1) kg m²"),
        (
            {"inertia": (1, 1, 2.1)},
            "inertia is not that of a body: no principal moment exceeds the sum of the others, got (1, 1, 2.1) kg m²",
        ),
        (
            {"inertia": [[1, 0.1, 0], [0, 1, 0], [0, 0, 1]]},
            "inertia must be symmetric, got [[1.0, 0.1, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]",
        ),
        ({"inertia": 1}, "inertia must be 3 numbers, got 1"),
        ({"inertia": np.full((3, 3), NAN)}, "inertia must be finite, got (nan, nan, nan) kg m²"),
        (
            {"orientation": (1, 1, 0, 0)},
            "orientation must be a unit quaternion (w, x, y, z), got (1, 1, 0, 0), of length 1.41421; "
            "divide it by its length",
        ),
        ({"orientation": (1, 0, 0)}, "orientation must be 4 numbers, got (1, 0, 0)"),
        ({"velocity": (0, NAN, 0)}, "velocity must be finite, got (0, nan, 0) m/s"),
        ({"angular_velocity": (0, 0, INF)}, "angular_velocity must be finite, got (0, 0, inf) rad/s"),
    ],
)
def test_rigid_body(changes, complaint):
    with refused(f'rigid_body "A": {complaint}'):
        Scene().rigid_body("A", **BODY | changes)


def test_names_are_unique():
    made = scene()
    with refused('rigid_body "A": there is already a rigid_body of that name; give each part its own name'):
        made.rigid_body("A", **BODY)
    with refused('rigid_body "wire": there is already a cable of that name; give each part its own name'):
        made.rigid_body("wire", **BODY)
    with refused('slide "A": there is already a rigid_body of that name; give each part its own name'):
        made.slide("A", along="wire", s=0.25, name="A")
    with refused('rigid_body "energy": its name is a name of results; give another one'):
        made.rigid_body("energy", **BODY)
    assert list(made.bodies) == ["A"]


@pytest.mark.parametrize(
    ("s", "complaint"),
    [
        (0.3, "s must be a node of the cable, got 0.3 m; nodes are at 0, 0.5, 1, 1.5 m"),
        (1.6, "s must lie on the cable, in [0, 1.5] m, got 1.6 m"),
        (-0.1, "s must lie on the cable, in [0, 1.5] m, got -0.1 m"),
        (NAN, "s must be finite, got nan m"),
    ],
)
def test_pin(s, complaint):
    with refused(f'pin on "wire": {complaint}'):
        scene().pin("wire", s=s)


def test_pin_on_a_fine_mesh_lists_the_neighbours():
    made = Scene()
    made.cable("wire", **CABLE | {"elements": 150})
    with refused('pin on "wire": s must be a node of the cable, got 0.304 m; nodes near it are at 0.3, 0.31 m'):
        made.pin("wire", s=0.304)


def test_pin_twice_or_nowhere():
    made = scene()
    made.pin("wire", s=0.5)
    with refused('pin on "wire": the node at s = 0.5 m is already pinned'):
        made.pin("wire", s=0.5 + 1e-12)
    with refused('pin on "wier": there is no cable "wier"; did you mean "wire"?'):
        made.pin("wier", s=0.5)


def test_slide_without_cable_or_body():
    with refused('slide "t": there is no cable or rope "wirr"; did you mean "wire"?'):
        scene().slide("A", along="wirr", s=0.25, name="t")
    with refused('slide "t": body: there is no cable or body "B"; known: wire, A'):
        scene().slide("B", along="wire", s=0.25, name="t")
    with refused('slide "t": there is no cable or rope "wire"; the scene has none yet'):
        made = Scene()
        made.rigid_body("A", **BODY)
        made.slide("A", along="wire", s=0.25, name="t")


@pytest.mark.parametrize("s", [-0.01, 1.51])
def test_slide_off_the_ends(s):
    with refused(f'slide "t": s must lie on the cable, in [0, 1.5] m, got {s} m'):
        scene().slide("A", along="wire", s=s, name="t")


def test_rider_too_far_from_the_cable():
    made = scene()
    made.rigid_body("B", **BODY | {"position": (0.25, 0.002, 0)})
    with refused(
        'slide "t": the point of body "B" at (0.25, 0.002, 0) m is 0.002 m away from cable "wire" at s = 0.25 m; '
        "start the body at position (0.25, 0, 0) m, or slide from s = 0.25 m"
    ):
        made.slide("B", along="wire", s=0.25, name="t")
    with pytest.raises(SceneError, match=r"position \(0.75, 0, 0\) m, or slide from s = 0.25 m"):
        made.slide("A", along="wire", s=0.75)
    assert made.slides == {} and made.messages == []


def test_a_body_cannot_be_moved_for_two_cables():
    made = scene()
    made.cable("rail", **CABLE | {"start": (0, 0.001, 0), "end": (1.5, 0.001, 0)})
    made.slide("A", along="wire", s=0.25, name="t")
    with pytest.warns(funicular.FunicularWarning, match="moved by 0.001 m"):
        made.slide("A", along="rail", s=0.25, name="u")
    with pytest.raises(SceneError, match=r'slide "t": .* 0.001 m away .* it cannot be moved for each'):
        made.check()


@pytest.mark.parametrize(
    ("settings", "complaint"),
    [
        ({"duration": 0}, "duration must be positive, got 0 s"),
        ({"duration": -1}, "duration must be positive, got -1 s"),
        ({"duration": NAN}, "duration must be finite, got nan s"),
        ({"duration": None}, "duration is missing"),
        ({"tol": 0}, "tol must be positive, got 0"),
        ({"tol": -1e-3}, "tol must be positive, got -0.001"),
        ({"tol": INF}, "tol must be finite, got inf"),
        ({"step": 0}, "step must be positive, got 0 s"),
        ({"step": 2}, "step must not exceed the duration 1 s, got 2 s"),
        ({"output_step": -0.1}, "output_step must be positive, got -0.1 s"),
        ({"output_step": 2}, "output_step must not exceed the duration 1 s, got 2 s"),
        ({"spectral_radius": 1.1}, "spectral_radius must lie in [0, 1], got 1.1"),
        ({"integrator": "genalfa"}, 'integrator "genalfa" is not known; did you mean "genalpha"?'),
    ],
)
def test_settings(settings, complaint):
    with refused(f"run: {complaint}"):
        scene().run(**{"duration": 1} | settings)


def test_an_empty_scene():
    with refused("scene: is empty: there is nothing to simulate; add a cable or a rigid body"):
        Scene().run(1)


@pytest.mark.parametrize(
    ("gravity", "complaint"),
    [((0, NAN, 0), "finite, got (0, nan, 0) m/s²"), (9.81, "3 numbers, got 9.81"), ((0, "g", 0), "a number, got 'g'")],
)
def test_gravity(gravity, complaint):
    with refused(f"scene: gravity must be {complaint}"):
        Scene(gravity=gravity)


def test_an_unwritable_output_is_found_before_the_run(tmp_path, monkeypatch):
    import sys

    monkeypatch.setitem(sys.modules, "funicular.solve.motion.run", None)  # importing the engine would raise ImportError
    remedy = "give a path in a directory that exists and is yours to write to"
    absent = tmp_path / "absent" / "x.nc"
    with refused(f"{absent}: the results cannot be written here: No such file or directory; {remedy}", ResultFileError):
        scene().run(1, save=absent)
    with refused(f"{tmp_path}: the results cannot be written here: this is a directory; add a name", ResultFileError):
        scene().run(1, save=tmp_path)
    file = tmp_path / "file"
    file.touch()
    with refused(f"{file}/x.nc: the results cannot be written here: Not a directory; {remedy}", ResultFileError):
        scene().run(1, save=file / "x.nc")
    assert list(tmp_path.iterdir()) == [file]
