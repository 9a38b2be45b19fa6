"""Every keyword of every part and setting is given invalid values: each is accepted, or refused by a `SceneError`."""

import copy
import itertools
import re

import funicular as fu
import numpy as np
import pytest
from funicular.cli.main import app
from funicular.errors import FunicularError
from funicular.parts.settings import EquilibriumSettings, ModeSettings, RunSettings
from funicular.parts.validation import LIMITS, OTHER_LIMITS
from funicular.scene.file import loads
from random_scenes import DATA, NUMBERS, OBJECTS, WORDS
from shared_scenes import CABLE as WIRE
from typer.testing import CliRunner

SQUARE = fu.Rectangle(height=0.05, width=0.05)
SOFT = fu.Material(youngs_modulus=4e8, poisson_ratio=0.0, density=4200)
RAMP = fu.Ramp(start=0, end=1)


def scene() -> fu.Scene:
    made = fu.Scene()
    made.cable("wire", start=(0, 0, 0), end=(1.5, 0, 0), elements=3, section=SQUARE, material=SOFT)
    made.cable("rope", start=(0, 0, 0), end=(0, 0, 1.5), elements=3, section=SQUARE, material=SOFT)
    made.rigid_body("A", mass=1, inertia=(1, 1, 1), position=(0.25, 0, 0))
    return made


DESCRIBED = {
    "section": (fu.Rectangle, {"height": 0.1, "width": 0.1, "torsion_constant": 1e-5, "shear_factors": (1, 1)}),
    "circle": (fu.Circle, {"radius": 0.1}),
    "tube": (fu.Tube, {"outer_radius": 0.1, "inner_radius": 0.05}),
    "general": (fu.GeneralSection, {"area": 0.1, "second_moment_about_z": 1e-3, "second_moment_about_y": 1e-3}),
    "material": (fu.Material, {"youngs_modulus": 1e9, "density": 1e3, "poisson_ratio": 0.3, "damping_time": 0,
                               "mass_damping": 0}),
    "shear": (fu.Material, {"youngs_modulus": 1e9, "density": 1e3, "shear_modulus": 4e8}),
    "ramp": (fu.Ramp, {"start": 0, "end": 1, "before": 0, "after": 1}),
    "pulse": (fu.Pulse, {"start": 0, "end": 1, "rise": 0.1, "height": 1}),
    "harmonic": (fu.Harmonic, {"amplitude": 1, "frequency": 1, "phase": 0, "offset": 0}),
    "table": (fu.TableSignal, {"time": [0, 1, 2], "value": [0, 1, 2], "interpolation": "linear"}),
    "friction": (fu.Friction, {"coefficient": 0.1, "static_coefficient": 0.2, "viscous": 0, "rolling": 0,
                               "model": "stick", "velocity": 1e-3}),
    "stop": (fu.HardStop, {"restitution": 0.1}),
    "buffer": (fu.Buffer, {"length": 0.1, "stiffness": 1, "damping": 1}),
    "scene": (fu.Scene, {"gravity": (0, 0, 0)}),
    "run": (RunSettings, {"duration": 1, "tol": 1e-3, "step": 0.1, "output_step": 0.1, "integrator": "auto",
                          "spectral_radius": 0.9, "initial": "drawn", "threads": 1, "save": "x.nc"}),
    "equilibrium": (EquilibriumSettings, {"load_steps": 1, "tolerance": 1e-9, "max_iterations": 3,
                                          "method": "newton"}),
    "modes": (ModeSettings, {"n": 1}),
}

CABLE = {"name": "c", "elements": 2, "section": SQUARE, "material": SOFT}
AT_A = {"kind": "revolute", "a": "A", "b": (0.25, 0, 0), "name": "j"}
ON_WIRE = {"body": "A", "along": "wire", "s": 0.25}
ADDED = {
    "straight": ("cable", CABLE | {"start": (0, 0, 0), "end": (1, 0, 0), "element": "beam24", "law": "continuum",
                                   "up": (0, 1, 0), "rest": "drawn", "rest_length": 1.0, "velocity": (0, 0, 0),
                                   "angular_velocity": (0, 0, 0)}),
    "measures": ("cable", CABLE | {"start": (0, 0, 0), "end": (1, 0, 0), "element": "cable12", "strain": "green",
                                   "curvature": "exact"}),
    "points": ("cable", CABLE | {"points": [(0, 0, 0), (1, 0, 0)]}),
    "curve": ("cable", CABLE | {"curve": lambda u: (u, 0, 0)}),
    "body": ("rigid_body", {"name": "B", "mass": 1, "inertia": (1, 1, 1), "position": (0, 0, 0),
                            "orientation": (1, 0, 0, 0), "centre": (0, 0, 0), "velocity": (0, 0, 0),
                            "angular_velocity": (0, 0, 0)}),
    "modal": ("modal_body", {"name": "B", "start": (0, 0, 0), "end": (1, 0, 0), "section": SQUARE, "material": SOFT,
                             "up": (0, 1, 0), "elements": 2, "element": "beam24", "law": "structural", "modes": 2,
                             "boundary": "free", "damping_ratio": 0}),
    "file": ("modal_body", {"name": "B", "data": "none.npz", "position": (0, 0, 0), "orientation": (1, 0, 0, 0),
                            "orthogonal": True}),
    "pin": ("pin", {"cable": "wire", "s": 0}),
    "clamp": ("clamp", {"cable": "wire", "s": 0, "fix": "all"}),
    "motion": ("motion", {"cable": "wire", "s": 0, "displacement": (0, RAMP, 0), "rotation": ((0, 0, 1), RAMP)}),
    "tie": ("tie", {"cable": "wire", "s": 0, "to": "rope", "at": 0, "rotation": "free", "name": "j"}),
    "force": ("force", {"on": "wire", "value": (0, 0, 1), "s": 0, "scale": RAMP, "follower": False, "name": "f"}),
    "push": ("force", {"on": "A", "value": (0, 0, 1), "at": (0, 0, 0)}),
    "line": ("distributed_force", {"cable": "wire", "value": (0, 0, 1), "start": 0, "stop": 1, "scale": 1,
                                   "follower": False}),
    "moment": ("moment", {"on": "wire", "value": (0, 0, 1), "s": 0, "scale": 1}),
    "spring": ("spring", {"a": "A", "b": ("wire", 1), "stiffness": 1, "damping": 1, "length": 1, "name": "f"}),
    "event": ("event", {"name": "e", "quantity": "wire.position.y", "s": 0, "value": 0, "direction": "both",
                        "action": "record"}),
    "function": ("event", {"function": lambda time, state: time}),
    "revolute": ("joint", AT_A | {"axis": (0, 0, 1), "angle": RAMP}),
    "universal": ("joint", AT_A | {"kind": "universal", "axis": (0, 0, 1), "second_axis": (0, 1, 0)}),
    "distance": ("joint", AT_A | {"kind": "distance", "b": (0.25, 1, 0), "length": 1}),
    "prismatic": ("joint", AT_A | {"kind": "prismatic", "axis": (0, 0, 1), "velocity": 1}),
    "slide": ("slide", ON_WIRE | {"at": (0, 0, 0), "frame": "tangent", "roll": "fixed", "up": (0, 1, 0),
                                  "friction": fu.Friction(), "at_start": "error", "at_end": "leave", "name": "t"}),
    "driven": ("slide", ON_WIRE | {"drive": 0.25}),
    "pulled": ("slide", ON_WIRE | {"velocity": 0.25}),
}


def refused_or_taken(call, keyword: str, value) -> None:
    """Accept a value, or require a SceneError with a readable message."""
    try:
        call(value)
    except FunicularError as error:
        assert isinstance(error, fu.SceneError) or "library" in keyword
        assert len(str(error)) < 3000 or isinstance(value, str)


def nonsense(keyword: str):
    for value in [*NUMBERS, *WORDS, *DATA, *OBJECTS]:
        if keyword != "data" or not isinstance(value, str):
            yield value


@pytest.mark.parametrize("described", DESCRIBED)
def test_descriptions_and_settings(described):
    make, keywords = DESCRIBED[described]
    make(**keywords)
    for keyword in keywords:
        for value in nonsense(keyword):
            refused_or_taken(lambda value: make(**keywords | {keyword: value}), keyword, value)  # noqa: B023


@pytest.mark.parametrize("added", ADDED)
@pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")
def test_parts(added):
    method, keywords = ADDED[added]
    empty = scene()
    if added != "file":
        getattr(copy.deepcopy(empty), method)(**keywords)

    def add(value):
        made = copy.copy(empty)
        for name, group in vars(empty).items():
            setattr(made, name, copy.copy(group))
        getattr(made, method)(**keywords | {keyword: value})

    once = CABLE if method == "cable" and added != "straight" else ()
    for keyword in keywords.keys() - once:
        for value in nonsense(keyword):
            refused_or_taken(add, keyword, value)


@pytest.mark.parametrize(
    ("make", "complaint"),
    [
        (lambda: fu.Circle(radius=1e60), "Circle: radius must not exceed 1e+09 m in size, got 1e+60 m"),
        (lambda: scene().force("A", value=(0, 0, 1), at=(1e60, 0, 0)),
         "force: at must lie within 1e+09 m of the origin, beyond which positions are rounded to more than 1e-7 m, got "
         "(1e+60, 0, 0) m; draw the scene nearer to the origin"),
        (lambda: fu.Circle(radius=1e-300), "Circle: radius must not be below 1e-12 m, got 1e-300 m"),
        (lambda: fu.Circle(radius=10**400), "Circle: radius must be finite, got inf m"),
        (lambda: fu.Tube(outer_radius=1, inner_radius=1 - 1e-15), "Tube: the wall must be thicker than 1e-12 of "
         "outer_radius (1 m), got 9.99201e-16 m; its moments are lost in rounding"),
        (lambda: fu.Material(youngs_modulus=1e31, density=1, poisson_ratio=0),
         "Material: youngs_modulus must not exceed 1e+30 Pa in size, got 1e+31 Pa"),
        (lambda: fu.Scene(gravity=(0, -1e40, 0)), "scene: gravity must not exceed 1e+30 m/s² in size, got (0, -1e+40, "
         "0) m/s²"),
        (lambda: scene().cable(**CABLE | {"elements": 10**8}, start=(0, 0, 0), end=(1, 0, 0)),
         'cable "c": elements must not exceed 1000000, got 100000000'),
        (lambda: scene().cable(**CABLE | {"name": "c" * 101}, start=(0, 0, 0), end=(1, 0, 0)),
         f'cable "{"c" * 101}": name must not be longer than 100 characters, got 101'),
        (lambda: scene().run(5e-324), "run: duration must not be below 1e-12 s, got 4.94065646e-324 s"),
        (lambda: scene().run(1e13), "run: duration must not exceed 1e+12 s in size, got 1e+13 s"),
        (lambda: scene().run(10**5000), "run: duration must be finite, got inf s"),
        (lambda: scene().run(1e6, step=1e-9), "run: step must not be below 1e-12 of the duration 1e+06 s, got 1e-09 s"),
        (lambda: scene().run(1, threads=10**9), "run: threads must not exceed 1000000, got 1000000000"),
        (lambda: scene().run(1, threads=10**5000),
         "run: threads must not exceed 1000000, got an integer of 16610 bits"),
        (lambda: scene().run(1, save=3), "run: save input should be a valid string, got 3"),
        (lambda: scene().run(1, resume="yes"), "run: resume must be true or false, got 'yes'"),
        (lambda: fu.Ramp(start=0, end=5e-324), "Ramp: times must be 1e-12 s apart or more, got 4.94e-324 s between "
         "0.0 s and 5e-324 s"),
        (lambda: fu.Pulse(start=1e6, end=2e6, rise=1e-11), "Pulse: times must be 1e-08 s apart or more, got 0 s between"
         " 1000000.0 s and 1000000.0 s"),
        (lambda: fu.TableSignal(time=[0, 1, 1 + 1e-13], value=[0, 1, 2]),
         "TableSignal: times must be 1e-12 s apart or more, got "
         "9.99e-14 s between 1.0 s and 1.0000000000001 s"),
        (lambda: scene().joint("revolute", "A", (0.25, 0, 0), axis=(1e-200, 0, 0)),
         "joint: axis must not be shorter than 1e-30, got (1e-200, 0, 0)"),
        (lambda: scene().force("wire", s=1, value=(0, 0, 1), scale={"form": ["ramp"]}),
         "force: scale has the form ['ramp'], not a name; known: table, ramp, harmonic, pulse"),
        (lambda: scene().slide("A", along="wire", s=0.25, at_end={"stop": []}),
         "slide: at_end has the stop [], not a name; known: hard, buffer"),
        (lambda: scene().pin([[]], s=0), "pin on [[]]: cable input should be a valid string, got [[]]"),
        (lambda: scene().cable(**CABLE, start=(0, 0, 0), end=(1, 0, 0), law=["continuum"]),
         "cable \"c\": law must be a name, got ['continuum']; possible: continuum, structural, poisson_split"),
    ],
)
def test_bounds_are_stated(make, complaint):
    with pytest.raises(fu.SceneError) as refused:
        make()
    assert str(refused.value) == complaint


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("gravity = " + "[" * 10_000 + "]" * 10_000, "x.toml: is nested too deeply"),
        ("gravity = " + "{a=" * 10_000 + "1" + "}" * 10_000, "x.toml: is nested too deeply"),
        ("gravity = [0, 1" + "0" * 5000 + ", 0]",
         "x.toml: has an integer of too many digits; write it as a number such as 1e9"),
        ("gravity = [0, 0x1" + "0" * 5000 + ", 0]",
         "x.toml, line 1: scene: gravity must be finite, got (0, inf, 0) m/s²"),
        (WIRE.replace("= 3", "= 0x1" + "0" * 5000),
         'x.toml, line 6: cable "wire": elements must not exceed 1000000, got an integer of 20001 bits'),
        (WIRE.replace('"wire"', '["wire"]'),
         "x.toml, line 3: [[cable]] 1: name must be made of letters, digits, _ and -, and "
         "begin with no digit, got ['wire']"),
        (WIRE.replace('shape = "rectangle"', 'shape = ["rectangle"]'),
         "x.toml, line 7: cable \"wire\": section has the shape ['rectangle'], not a name; known: rectangle, circle, "
         "tube, general"),
        (WIRE + 'element = ["beam24"]', None),
        (WIRE + 'strain = ["green"]', None),
        (WIRE + "up = 1979-05-27",
         "x.toml, line 9: cable \"wire\": up must be 3 numbers, got datetime.date(1979, 5, 27)"),
        ("[run]\nduration = 1\nsave = 3", "x.toml, line 3: run: save input should be a valid string, got 3"),
    ],
)
def test_files(text, complaint):
    with pytest.raises(fu.SceneError) as refused:
        loads(text, "x.toml")
    assert complaint is None or re.sub(r"\s+", " ", str(refused.value)) == complaint


@pytest.mark.parametrize("integrator", ["genalpha", "radau", "explicit"])
def test_at_the_limits(integrator):
    """The smallest and the largest accepted numbers give a result, or an error with a message."""
    for length, radius, E, density in itertools.product(*[LIMITS["m"]] * 2, *[OTHER_LIMITS] * 2):
        made = fu.Scene()
        wire = made.cable("wire", start=(0, 0, 0), end=(length, 0, 0), elements=2, element="cable12",
                          section=fu.Circle(radius=radius),
                          material=fu.Material(youngs_modulus=E, poisson_ratio=0.3, density=density))
        made.pin(wire, s=0)
        made.rigid_body("A", mass=density, inertia=(1e-30, 1e-30, 1e-30), position=(length, 0, 0))
        made.slide("A", along=wire, s=length)
        made.force(wire, s=length, value=(0, 1e30, 0))
        try:
            run = made.run(1, step=1, output_step=1, integrator=integrator)
        except FunicularError:
            continue
        assert all(np.isfinite(run[name]).all() for name in run.keys())


def test_no_more_memory_than_there_is(monkeypatch):
    from funicular import engine

    monkeypatch.setattr(engine, "MACHINE_MEMORY", 1e4)
    for compute in (lambda: scene().run(1), lambda: scene().equilibrium(), lambda: scene().modes(2)):
        with pytest.raises(fu.SceneError, match=r"^scene: takes more memory than this machine has; take fewer"):
            compute()


FALLING = """
[[rigid_body]]
name = "A"
mass = 1
inertia = [1, 1, 1]
position = [0, 0, 0]

[run]
duration = 0.1
"""


@pytest.mark.parametrize(
    ("text", "given", "complaint"),
    [
        ("gravity = " + "[" * 10_000 + "]" * 10_000, ["run"], "scene.toml: is nested too deeply"),
        (FALLING.replace("= 1\n", "= 1e60\n"), ["run"], 'rigid_body "A": mass must not exceed 1e+30 kg in size'),
        (FALLING, ["run", "--duration", "nan"], "run: duration must be finite, got nan s"),
        (FALLING, ["run", "--step", "5e-324"], "run: step must not be below 1e-12 s, got 4.94065646e-324 s"),
        (FALLING, ["run", "--tol", "1e-400"], "run: tol must be positive, got 0"),
        (FALLING, ["bench", "--duration", "0"], "run: duration must be positive, got 0 s"),
        (FALLING, ["bench", "--duration", "nan"], "run: duration must be finite, got nan s"),
        (FALLING, ["bench", "--output-step", "1"], "run: output_step must not exceed the duration 0.1 s, got 1 s"),
        (FALLING, ["bench", "--tols", ""], "bench: tols: the list is empty; name one, or leave it out"),
        (FALLING, ["bench", "--tols", "nan"], "bench: tols: a tolerance must lie inside (0, 1), got nan"),
        (FALLING, ["bench", "--elements", ","], "bench: elements: the list is empty; name one, or leave it out"),
        (FALLING, ["bench", "--elements", "9" * 30], "bench: elements: 1e+30 exceeds 1000000"),
        (FALLING, ["bench", "--elements", "x9999999"], "bench: elements: 1e+07 exceeds 1000000"),
        (FALLING, ["bench", "--integrators", ","], "bench: integrators: the list is empty; name one, or leave it out"),
        (FALLING, ["bench", "--outputs", ""], "bench: outputs: the list is empty; name one, or leave it out"),
        (FALLING, ["bench", "--repetitions", "0"], "bench: repetitions must be 1 or more, got 0"),
        (FALLING, ["bench", "--repetitions", "99999999999999"],
         "bench: repetitions must not exceed 1000000, got 99999999999999"),
    ],
)
def test_the_command_line_says_it_in_a_line(text, given, complaint, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "scene.toml").write_text(text)
    result = CliRunner().invoke(app, [given[0], "scene.toml", *given[1:]])
    assert isinstance(result.exception, SystemExit)
    assert (result.exit_code, result.stderr.count("\n")) == (1, 1)
    assert result.stderr.startswith("error: ") and complaint in result.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["scene.toml"]
