"""Names of older versions are refused, in any use, with a message that gives the new name."""

import re

import funicular as fu
import pytest
from funicular.parts.joint import Joint
from funicular.parts.support import Clamp
from funicular.scene.file import loads

NOW = {"second_moment_yy": "second_moment_about_z", "second_moment_zz": "second_moment_about_y",
       "rotary_moment_yy": "rotary_moment_about_z", "rotary_moment_zz": "rotary_moment_about_y"}
INTEGRAL = {"z": "the integral of y²", "y": "the integral of z²"}


def refused(error, complaint):
    return pytest.raises(error, match=re.escape(complaint) + "$")


def test_attributes_of_the_package():
    for old, new in (("General", "GeneralSection"), ("Table", "TableSignal")):
        with refused(AttributeError, f"module 'funicular' has no attribute '{old}': it is called \"{new}\" now"):
            getattr(fu, old)


def test_attributes_of_a_scene():
    for old, new in (("join", "tie"), ("joins", "ties")):
        with refused(AttributeError, f"'Scene' object has no attribute '{old}': it is called \"{new}\" now"):
            getattr(fu.Scene(), old)
    with refused(AttributeError, "'Scene' object has no attribute 'cabel'"):
        _ = fu.Scene().cabel


@pytest.mark.parametrize("old", list(NOW)[:2])
def test_attributes_of_a_section(old):
    section = fu.Rectangle(height=2, width=1)
    with refused(AttributeError, f"'Rectangle' object has no attribute '{old}': it is called \"{NOW[old]}\" now, "
                 + INTEGRAL[NOW[old][-1]]):
        getattr(section, old)
    assert section.second_moment_about_z == pytest.approx(8 / 12) and section.second_moment_about_y == pytest.approx(
        2 / 12)
    with pytest.raises(AttributeError, match="heigth"):
        _ = section.heigth


def test_attributes_of_a_joint():
    joint = Joint(kind="spherical", a=("A", (0, 0, 0)), b=(0, 0, 0))
    with refused(AttributeError, "'Joint' object has no attribute 'pair': it is called \"joint_kind\" now"):
        _ = joint.pair
    assert joint.joint_kind == "spherical"


def test_keywords_of_a_clamp():
    with refused(fu.SceneError, 'clamp on "wire": "hold" is not known here; it is called "fix" now'):
        Clamp(cable="wire", s=0, hold="all")


@pytest.mark.parametrize("old", NOW)
def test_keywords_of_a_section(old):
    with refused(fu.SceneError, f'GeneralSection: "{old}" is not known here; it is called "{NOW[old]}" now, '
                 + INTEGRAL[NOW[old][-1]]):
        fu.GeneralSection(area=1, **{old: 1.0})


def test_rotary_moments_are_those_about_their_axes():
    section = fu.GeneralSection(area=1, second_moment_about_z=2, second_moment_about_y=3, rotary_moment_about_z=4,
                                rotary_moment_about_y=5)
    assert section.moments()[:3].tolist() == [1, 2, 3] and section.mass_moments()[:3].tolist() == [1, 4, 5]


def test_tables_and_keys_of_a_scene_file():
    with refused(fu.SceneError, 'x, line 1: scene: "join" is not known here; it is called "tie" now'):
        loads("[[join]]\ncable = 'a'\n", "x")
    text = """
        [[cable]]
        name = "wire"
        start = [0, 0, 0]
        end = [1, 0, 0]
        elements = 2
        element = "cable12"
        section = {shape = "general", area = 1e-4, second_moment_yy = 1e-9}
        material = {youngs_modulus = 1e9, poisson_ratio = 0, density = 1000}
        """
    with refused(fu.SceneError, 'section "second_moment_yy" is not known here; it is called "second_moment_about_z" '
                 "now, the integral of y²"):
        loads(text, "x")


def test_names_of_results():
    scene = fu.Scene()
    section, material = fu.Circle(radius=0.01), fu.Material(youngs_modulus=1e8, poisson_ratio=0, density=1000)
    for k in range(2):
        scene.cable(f"c{k}", start=(k, 0, 0), end=(k + 1, 0, 0), elements=1, element="cable12", section=section,
                    material=material)
    scene.tie("c0", s=1, to="c1", at=0)
    run = scene.run(1e-4)
    with refused(fu.UnknownResultError, 'the run has no result "join_1.force"; it is called "tie_1.force" now'):
        _ = run["join_1.force"]


def test_the_package_completes_its_interface_alone():
    lazy = {"Choice", "Equilibrium", "InitialState", "LogUniform", "Modes", "Uniform", "load_sweep", "sweep",
            "sweep_cost"}
    assert {name for name in dir(fu) if not name.startswith("__")} == {*fu.__all__, *lazy} - {"__version__"}
    assert all(hasattr(fu, name) for name in dir(fu))
