"""Scenes as TOML: accepted and refused text with its line, and a lossless round trip."""

import re

import numpy as np
import pytest
from expectations import refused
from funicular import (
    Circle,
    GeneralSection,
    Harmonic,
    Material,
    Pulse,
    Ramp,
    Rectangle,
    Scene,
    SceneError,
    TableSignal,
    Tube,
    bundled_scenes,
    load_scene,
)
from funicular.parts.scene_text import TABLES
from funicular.scene.file import loads
from shared_scenes import CABLE


@pytest.mark.parametrize("name", list(bundled_scenes()))
def test_bundled_scenes_are_whole(name):
    load_scene(name).check()


def test_paper51_is_table_1():
    scene = load_scene("paper51")
    wire, body = scene.cables["wire"], scene.bodies["A"]
    assert (wire.length, wire.elements, wire.element, wire.material.density) == (1.5, 3, "beam24", 4200)
    assert wire.material.lame() == (0.0, 0.2e9)
    assert wire.section.area == pytest.approx(0.0025, rel=1e-15)
    assert [pin.label for pin in scene.pins] == ["wire@0", "wire@1.5"]
    assert (body.mass, body.position, body.velocity) == (1.0, (0.25, 0.0, 0.0), (1.0, 0.0, 0.0))
    assert (scene.slides["trolley"].body, scene.slides["trolley"].s) == ("A", 0.25)
    assert scene.gravity == (0.0, -9.81, 0.0)
    assert scene.run_settings == {"duration": 1.0, "tol": 1e-5, "output_step": 0.002}


def same(a: Scene, b: Scene) -> bool:
    """Return whether two scenes are equal except for the title, the name of the file."""
    return vars(a) | {"title": ""} == vars(b) | {"title": ""}


def test_round_trip_of_the_bundled_scene():
    scene = load_scene("paper51")
    assert same(loads(scene.to_toml(), "copy"), scene)


def test_round_trip_of_everything_else():
    scene = Scene(gravity=(1e-17, 0.1, 1e22))
    rubber = Material(youngs_modulus=1 / 3, density=1.1e3, poisson_ratio=0.3, damping_time=1e-4)
    common = {"start": (0, 0, 0), "end": (0, 0, -10 / 3), "material": rubber, "up": (1, 1, 0)}
    scene.cable("Seil-ä", elements=7, section=Tube(outer_radius=0.02, inner_radius=0.01), **common)
    scene.cable("b", elements=1, section=Circle(radius=0.1), **common)
    scene.pin("b", s=10 / 3)
    scene.rigid_body(
        "A",
        mass=0.1,
        inertia=[[1, 0.1, 0], [0.1, 1, 0], [0, 0, 1]],
        position=(0, 0.3, -1),
        orientation=(0.6, 0.8, 0.0004, 0),
        angular_velocity=(0, 1e-300, 2),
    )
    at = scene.bodies["A"].point((0, 0, 0))
    scene.rigid_body("B", mass=1, inertia=(1, 1, 1), position=(0, 0, -1))
    scene.slide("B", along="Seil-ä", s=1.0, name="trolley")
    assert tuple(at) == (0, 0.3, -1)
    assert same(loads(scene.to_toml(), "copy"), scene)


def test_round_trip_of_shapes_supports_loads_and_springs():
    scene = Scene(gravity=(0, 0, -1))
    soft = Material(youngs_modulus=1e6, density=1e3, shear_modulus=4e5, mass_damping=0.1)
    constants = GeneralSection(area=1e-4, second_moment_about_z=1e-9, torsion_constant=2e-9, shear_factors=(0.8, 0.9))
    common = {"material": soft, "elements": 2}
    scene.cable("ring", curve=lambda u: (np.sin(u), np.cos(u), u / 3), element="beam24", law="structural",
                section=constants, up=(0, 0, 1), rest_length=1.1, **common)
    scene.cable("rope", points=[(0, 1, 0), (0, 2, 1), (0, 3, 1)], element="cable18", strain="engineering",
                rest="straight", section=Circle(radius=0.01), **common)
    scene.cable("bar", start=(1, 0, 0), end=(2, 0, 0), law="poisson_split",
                section=Rectangle(height=0.1, width=0.2, torsion_constant=1e-5), **common)
    scene.clamp("ring", s=1.1, fix="all")
    scene.motion("bar", s=0, displacement=(TableSignal(time=[0, 1, 2], value=[0, 1 / 3, 1]), 0, Ramp(start=0, end=0.1)),
                 rotation=((1, 2, 2), Pulse(start=0, end=1, height=-2)))
    scene.motion("bar", s=1, rotation=((1, 0, 0), 0))
    scene.tie("rope", s=0, to="ring", at=0, rotation="free")
    scene.rigid_body("A", mass=1, inertia=(1, 1, 1), position=(0, 0, 3))
    scene.force("A", value=(0, 0, 1 / 7), at=(0, 0, 1), follower=True, scale=Harmonic(amplitude=2, frequency=3))
    scene.force("ring", s=0.5, value=(0, 0, 1), scale=0.5, name="push")
    scene.distributed_force("bar", value=(0, 1, 0), stop=0.3, scale=TableSignal(time=[0, 1], value=[2, 3],
                                                                           interpolation="linear"))
    scene.moment("bar", s=1, value=(1, 0, 0))
    scene.spring("A", (0, 0, 9), stiffness=3)
    scene.spring(("A", (0, 0, 1)), ("bar", 1 / 3), stiffness=3, damping=0.1, length=0.5, name="tie")
    scene.equilibrium_settings = {"load_steps": 4, "method": "arc_length"}
    scene.run_settings = {"duration": 1.0, "initial": "equilibrium"}
    copy = loads(scene.to_toml(), "copy")
    assert same(copy, scene)
    assert copy.to_toml() == scene.to_toml()
    assert copy.cables["ring"].length == 1.1


@pytest.mark.parametrize("axis", [(1, 1, 0), (1, 1, 1), (0.3, -0.1, 0.2), (0, 0, 1)])
def test_the_axis_of_a_motion_is_read_as_it_was_written(axis):
    """A second division by the length rounded the axis, so that a run of the text could not resume."""
    scene = loads(CABLE, "x")
    scene.motion("wire", s=0, rotation=(axis, Ramp(start=0, end=1)))
    assert same(loads(scene.to_toml(), "copy"), scene)


def test_loads_as_tables():
    scene = loads(CABLE + """
[[clamp]]
cable = "wire"
s = 0
[[motion]]
cable = "wire"
s = 1.5
displacement = [0, { form = "ramp", start = 0, end = 1, after = 0.1 }, 0]
[[force]]
name = "push"
on = "wire"
s = 0.5
value = [0, 1, 0]
scale = { form = "table", time = [0, 1, 2], value = [0, 1, 0] }
[[spring]]
a = ["wire", 1]
b = [1, 2, 0]
stiffness = 3
[equilibrium]
load_steps = 3
[run]
duration = 1
initial = "equilibrium"
""", "x.toml")
    assert scene.motions[0].displacement[1] == Ramp(start=0, end=1, after=0.1)
    assert scene.loads["push"].scale == TableSignal(time=[0, 1, 2], value=[0, 1, 0])
    assert scene.point_forces["spring_1"].length == 2
    assert (scene.equilibrium_settings, scene.run_settings) == (
        {"load_steps": 3}, {"duration": 1.0, "initial": "equilibrium"})


def test_a_moved_rider_is_not_moved_again():
    text = CABLE + '[[rigid_body]]\nname="A"\nmass=1\ninertia=[1,1,1]\nposition=[0.5,0.001,0]\n'
    with pytest.warns(UserWarning, match="moved by 0.001 m"):
        scene = loads(text + '[[slide]]\nbody="A"\nalong="wire"\ns=0.5\n', "x.toml")
    assert loads(scene.to_toml(), "copy").messages == []


def test_a_file_is_named_by_its_path(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(CABLE.replace("height = 0.05", "height = -0.05"))
    with refused(f'{path}, line 7: cable "wire": section.height must be positive, got -0.05 m'):
        load_scene(path)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("[[cabel]]", 'x.toml, line 1: scene: "cabel" is not known here; did you mean "cable"?'),
        ("gravty = [0, 0, 0]", 'x.toml, line 1: scene: "gravty" is not known here; did you mean "gravity"?'),
        ("gravity = [0, nan, 0]", "x.toml, line 1: scene: gravity must be finite, got (0, nan, 0) m/s²"),
        ("[cable]", "x.toml: [cable]: must be an array of tables; write [[cable]], in two brackets"),
        ("[[cable]]", "x.toml: 3 errors"
                      "\n  line 1: [[cable]] 1: name is missing"
                      "\n  line 1: [[cable]] 1: section is missing"
                      "\n  line 1: [[cable]] 1: material is missing"),
        ('[[cable]]\nname = "wire"', 'x.toml: 2 errors'
                                     '\n  line 1: cable "wire": section is missing'
                                     '\n  line 1: cable "wire": material is missing'),
        (CABLE + "elemnts = 3", 'x.toml, line 9: cable "wire": "elemnts" is not known here; did you mean "elements"?'),
        (
            CABLE.replace("width =", "widht ="),
            'x.toml, line 7: cable "wire": section "widht" is not known here; did you mean "width"?',
        ),
        (
            CABLE.replace("density", "desnity"),
            'x.toml, line 8: cable "wire": material "desnity" is not known here; did you mean "density"?',
        ),
        (
            CABLE.replace('"rectangle"', '"rectangel"'),
            'x.toml, line 7: cable "wire": section has the unknown shape "rectangel"; did you mean "rectangle"?',
        ),
        (CABLE.replace("= 3", '= "3"'),
         "x.toml, line 6: cable \"wire\": elements must be a whole number, 1 or more, got '3'"),
        (CABLE * 2,
         'x.toml, line 10: cable "wire": there is already a cable of that name; give each part its own name'),
        (
            CABLE + '[[pin]]\ncable = "wire"\ns = 0\n[[pin]]\ncable = "wire"\nt = 0',
            'x.toml: 2 errors'
            '\n  line 12: [[pin]] 2: s is missing'
            '\n  line 14: [[pin]] 2: "t" is not known here; known: cable, s',
        ),
        (
            CABLE + '[[pin]]\ncable = "wir"\ns = 0',
            'x.toml, line 9: pin on "wir": there is no cable "wir"; did you mean "wire"?',
        ),
        ('[[rigid_body]]\nname = "A"', 'x.toml: 3 errors'
                                       '\n  line 1: rigid_body "A": mass is missing'
                                       '\n  line 1: rigid_body "A": inertia is missing'
                                       '\n  line 1: rigid_body "A": position is missing'),
        ("[run]\ntol = 1e-3", "x.toml, line 1: run: duration is missing"),
        ("[run]\nduration = -1", "x.toml, line 2: run: duration must be positive, got -1 s"),
        ("[run]\nduration = 1\ntoll = 1e-3", 'x.toml, line 3: run: "toll" is not known here; did you mean "tol"?'),
        ("run = 3", "x.toml, line 1: [run]: must be a table"),
        ('[run]\nduration = 1\ninitial = "rest"',
         'x.toml, line 3: run: initial "rest" is not known; known: drawn, equilibrium, relaxed, state'),
        ("equilibrium = 3", "x.toml, line 1: [equilibrium]: must be a table"),
        ("[equilibrium]\nload_step = 3",
         'x.toml, line 2: equilibrium: "load_step" is not known here; did you mean "load_steps"?'),
        ("[[clmp]]", 'x.toml, line 1: scene: "clmp" is not known here; did you mean "clamp"?'),
        (CABLE + '[[force]]\non = "wire"\ns = 0', "x.toml, line 9: [[force]] 1: value is missing"),
        (CABLE + '[[force]]\nname = "F"\non = "wire"\ns = 0\nvalue = [0, 0, 1]\nscale = { start = 0 }',
         'x.toml, line 14: force "F": scale has no form; known: table, ramp, harmonic, pulse'),
        (CABLE + '[[force]]\nname = "F"\non = "wire"\ns = 0\nvalue = [0, 0, 1]\nscale = { form = "ramp", begin = 0 }',
         'x.toml, line 14: force "F": scale "begin" is not known here; known: start, end, before, after'),
        (CABLE + '[[spring]]\na = "wire"\nb = [0, 0, 1]\nstiffness = 1',
         'x.toml, line 9: spring "spring_1": a: acts on cable "wire" and needs the arc-length s there'),
        (CABLE.replace("end = [1.5, 0, 0]", "curve = 1"),
         'x.toml, line 2: cable "wire": curve must be a function of u from 0 to 1, got 1; or give points'),
        (
            'gravity = [0, -9.81, 0]\nname "wire"',
            "x.toml: is not valid TOML: Expected '=' after a key in a key/value pair (at line 2, column 6)",
        ),
    ],
)
def test_refused(text, message):
    with refused(message):
        loads(text, "x.toml")


def test_no_such_scene(tmp_path):
    with refused('paper15: there is no such scene file, nor a bundled scene of that name; did you mean "paper51"?'):
        load_scene("paper15")


def test_a_binary_file(tmp_path):
    path = tmp_path / "x.toml"
    path.write_bytes(b"\x89HDF\r\n")
    with pytest.raises(SceneError, match=rf"^{re.escape(str(path))}: cannot be read as text: .*0x89"):
        load_scene(path)


def test_text_is_never_run():
    with refused('x.toml, line 3: rigid_body "A": mass must be a number, got \'__import__("os").getpid()\''):
        loads('[[rigid_body]]\nname = "A"\nmass = \'__import__("os").getpid()\'\n'
              "inertia = [1, 1, 1]\nposition = [0, 0, 0]", "x.toml")


SEVERAL = '''gravity = [0, -9.81, 0]
note = """
[[cable]]
name = "in a text"
"""

[[cable]]
name = "wire"
elements = 0
start = [0, 0, 0]
end = [
  1.5,
  0, 0]
section = { shape = "rectangle", height = -0.05, width = 0.05 }
up = [0, 1, 0]
[cable.material]
youngs_modulus = 4e8
density = "heavy"
poisson_ratio = 0

[[pin]]
cable = "wire"
s = 0.0

[[pin]]
cable = "wyre"
s = 0.0

[[rigid_body]]
name = "A"
mass = 1.0
inertia = [1e-3, 1e-3, 1e-3]
position = [0, 0, 0]

[[rigid_body]]
name = "A"
mass = 1.0
inertia = [1e-3, 1e-3, 1e-3]
position = [0, 0, 0]
'''


def test_all_errors_of_a_file_at_once_by_line():
    """A pin on a refused cable makes no further error; a table within a text is not parsed."""
    with pytest.raises(SceneError) as error:
        loads(SEVERAL, "x.toml")
    assert str(error.value) == """x.toml: 6 errors
  line 2: scene: "note" is not known here; known: """ + ", ".join(TABLES) + """
  line 9: cable "wire": elements must be a whole number, 1 or more, got 0
  line 14: cable "wire": section.height must be positive, got -0.05 m
  line 16: cable "wire": material.density must be a number, got 'heavy'
  line 25: pin on "wyre": there is no cable "wyre"; the scene has none yet
  line 35: rigid_body "A": there is already a rigid_body of that name; give each part its own name"""
    assert len(error.value.errors) == 6


def test_all_wrong_values_of_a_part_are_at_hand():
    with pytest.raises(SceneError, match='"widht" is not known') as error:
        Rectangle(widht=1)
    assert [each.entry for each in error.value.errors] == ["widht", "height", "width"]


def test_a_file_of_many_errors_is_answered_at_once():
    with pytest.raises(SceneError) as error:
        loads(CABLE + '[[pin]]\ncable = "wyre"\ns = 0\n' * 3000, "x.toml")
    assert len(error.value.errors) == 20
    assert str(error.value).startswith("x.toml: 20 errors, and perhaps more\n  line 9: pin on ")


def test_a_file_of_results_and_an_ending_too_many_are_named(tmp_path):
    (tmp_path / "p.nc").write_bytes(b"CDF\x02\xe9")
    with pytest.raises(SceneError, match="holds the results of a run, not a scene; take fu"):
        load_scene(tmp_path / "p.nc")
    with pytest.raises(SceneError, match=r'there is no such scene file.*; the bundled scene is "paper51"'):
        load_scene("paper51.toml")


def test_a_tol_that_is_given_takes_the_place_of_steps_in_a_file():
    """A step, or an absolute_tol, of the scene file would make the tol of the call ineffective."""
    scene = load_scene("paper51")
    scene.run_settings |= {"step": 1e-3, "duration": 0.02}
    assert scene.run(integrator="radau").report["step"] == 1e-3
    run = scene.run(tol=1e-4, integrator="radau")
    assert run.report["step"] is None and run.report["tol"] == 1e-4
    assert scene.run(tol=1e-4, step=5e-4).report["step"] == 5e-4
    scene.run_settings = {"absolute_tol": 1e-2, "duration": 0.2}
    steps = [scene.run(integrator="radau", **given).report["steps"] for given in ({}, {"tol": 1e-6})]
    assert steps[1] > 3 * steps[0]
