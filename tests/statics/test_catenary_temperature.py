"""Temperature of catenaries: tensions of held wires against strings, balance weights, anchors, refusals."""

from dataclasses import replace

import funicular as fu
import numpy as np
import pytest
from catenary_sections import COARSE, heights_off, line, strings, tensions, unequal
from expectations import refused
from funicular import catenary

LAST = catenary.End(), catenary.End(weights=True)
"""Ends with weights at the last mast."""


@pytest.fixture(scope="module")
def fine():
    """The form of a span of wires with little bending, as strings."""
    return catenary.form(line(bending=0.01), (0.5, 1.0))


@pytest.mark.parametrize("temperature", [-40.0, -15.0, 40.0])
def test_held_wires_tighten_and_slacken_as_strings_do(fine, temperature, validated):
    found = tensions(catenary.scene(fine, temperature=temperature))
    for name, ours, exact, bound in zip(("contact wire", "messenger"), found, strings(fine.line, temperature),
                                        (1e-4, 1e-3), strict=True):
        validated("Catenaries", f"held ends, {temperature:g} K", f"tension of the {name}", exact, ours, unit="N",
                  bound=bound, source="two strings with springs between")


def test_droppers_lengthen(fine):
    """By 4 %: the messenger bears more, and the contact wire hangs lower, as by strings."""
    longer = fine.line.remade({"droppers": fine.line.droppers.remade({"thermal_expansion": 1e-3})})
    scenes = [catenary.scene(form, temperature=40.0) for form in (fine, replace(fine, line=longer, spans=tuple(
        replace(each, span=replace(each.span, droppers=longer.droppers)) for each in fine.spans)))]
    assert scenes[1].point_forces["dropper_1_1"].length == pytest.approx(1.04 * fine.lengths[0], rel=1e-12)
    found = tensions(scenes[1]) - tensions(scenes[0])
    assert found == pytest.approx(strings(longer, 40.0) - strings(fine.line, 40.0), rel=1e-2)
    with refused("catenary: temperature is a signal, but droppers take a number alone by their thermal_expansion; "
                 "leave thermal_expansion of the droppers out: they are short beside the wires"):
        catenary.scene(longer, COARSE, temperature=fu.Ramp(start=0, end=1))
    with refused("catenary: droppers must keep a positive length, got -1 times the one at 0 K; give temperature in K "
                 "above that of the form, thermal_expansion in 1/K"):
        catenary.scene(longer, COARSE, temperature=-2000.0)


@pytest.mark.parametrize("ends", [LAST, LAST[::-1]], ids=["last", "first"])
@pytest.mark.parametrize("of", [line, unequal], ids=["equal", "unequal"])
def test_weights_keep_the_tension(of, ends):
    made = of(**({"spans": 3} if of is line else {}), ends=ends)
    form = catenary.form(made, COARSE)
    sags = []
    for temperature in (-40.0, 0.0, 40.0):
        scene = catenary.scene(form, temperature=temperature)
        rest = scene.equilibrium()
        assert rest.stable
        length, at = scene.cables["contact"].length, -1 if ends[1].weights else 0
        tension = rest.section_forces("contact", s=[0.0, length])["tension"].values
        assert tension[at] == pytest.approx(22e3, rel=1e-9)
        assert tension[-1 - at] == pytest.approx(22e3, rel=2e-4)  # droppers that incline pull along the wire
        moved = float(rest["contact.position"][at, 0]) - (made.length if at else 0.0)
        assert moved * (1 if at else -1) == pytest.approx(1.7e-5 * temperature * length, rel=5e-3, abs=1e-6)
        sags.append(heights_off(made, rest))
    assert np.abs(sags[1]).max() < 1e-5
    assert np.abs(sags[0] - sags[2]).max() > 1e-3


def test_an_anchor_holds_the_raised_wire():
    """The wire rises on a parabola, which its droppers follow, to its anchor in the last span."""
    x = np.arange(5.0, 51.0, 7.5)
    raised = line().droppers.remade({"at": x, "sag": -0.5 * (x / 55) ** 2})
    ends = catenary.End(), catenary.End(height=0.5)
    made = line(2, span=[55.0, 55.0], droppers=[line().droppers, raised], ends=ends)
    form = catenary.form(made, COARSE)
    rest = catenary.scene(form).equilibrium()
    assert rest.stable
    assert np.abs(heights_off(made, rest)).max() < 1e-7
    assert rest["contact.position"][-1, :2] == pytest.approx([110.0, 0.5], abs=1e-12)
    end = f"contact@{form.rest.adjusted['contact.rest_length']:.12g}.force"
    own, curvature = 9.81 * 1.35, 2 * 0.5 / 55**2
    assert form.tensions[10:15] == pytest.approx((own - 22e3 * curvature) * 7.5 + 9.81 * 0.165, rel=2e-2)
    borne = form.tensions.sum() + rest[end][1]
    assert borne == pytest.approx(own * 110 + 9.81 * 0.165 * 16, rel=1e-4)


def test_a_signal_warms_the_wires_in_a_run():
    """Slow warming: the wires stay close to rest, whose tensions change as held ones do."""
    made = line(bending=1.0)
    scene = catenary.scene(catenary.form(made, (2.0, 4.0)), temperature=fu.Ramp(start=0.0, end=0.5, after=5.0))
    assert fu.Scene.from_toml(scene.to_toml()).to_toml() == scene.to_toml()
    run = scene.run(duration=1.0, initial="equilibrium", tol=1e-5, output_step=0.05, progress=False)
    force = -run["contact@0.force"][:, 0]
    assert force[0] == pytest.approx(22e3, rel=1e-6)
    assert force[-5:].mean() == pytest.approx(strings(made, 5.0)[0], rel=5e-3)


@pytest.mark.parametrize(("changes", "says"), [
    ({"ends": (catenary.End(weights=True), catenary.End(weights=True))}, "weights at both ends.*hold them at one end"),
    ({"ends": (catenary.End(),)}, "ends"),
    ({"ends": (catenary.End(), catenary.End(height=5.0))}, "dropper 9 would have to push"),
])
def test_ends_that_hold_nothing_are_refused(changes, says):
    with pytest.raises(fu.SceneError, match=says):
        line(**changes)
    with pytest.raises(fu.SceneError, match="height"):
        catenary.End(height=np.inf)


def test_wires_without_expansion_are_refused():
    wire = line().contact.remade({"thermal_expansion": None})
    with pytest.raises(fu.SceneError, match="thermal_expansion"):
        catenary.scene(line(contact=wire), COARSE, temperature=10.0)
