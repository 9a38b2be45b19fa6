"""Overlaps of two sections of a catenary: heights and forces at rest, handover of a collector, refusals."""

import funicular as fu
import numpy as np
import pytest
from catenary_sections import COARSE, COLLECTOR, OVERLAP, heights_off, line, overlapping, passage, vertical_impulse
from funicular import catenary

NAMES = ["pantograph_contact", "pantograph_section_2_contact"]


@pytest.fixture(scope="module")
def forms():
    """The forms of two sections."""
    return [catenary.form(each, COARSE) for each in overlapping()]


def test_both_sections_rest_as_they_do_alone(forms):
    scene = catenary.scene(forms, overlaps=OVERLAP)
    assert fu.Scene.from_toml(scene.to_toml()).to_toml() == scene.to_toml()
    assert [scene.cables[name].drawn_through[0][0] for name in ("contact", "section_2_contact")] == [0.0, 55.0]
    rest = scene.equilibrium()
    assert rest.stable
    for form, prefix, start in zip(forms, ("", "section_2_"), (0.0, 55.0), strict=True):
        for k, span in enumerate(form.spans):
            tensions = [float(rest[f"{prefix}dropper_{k + 1}_{j + 1}.tension"]) for j in range(9)]
            assert tensions == pytest.approx(span.tensions, rel=1e-6)
        wire = rest[f"{prefix}contact.position"]
        at = wire[np.argmin(np.abs(wire[:, 0] - start - 5 * 55.0 / 2)), 1]
        assert abs(at) < 0.06
    assert np.abs(heights_off(forms[0].line, rest)).max() < 1e-7


@pytest.fixture(scope="module")
def slow(forms):
    """A passage through the overlap at 20 m/s."""
    return passage(catenary.scene(forms, overlaps=OVERLAP), COLLECTOR, 105.0, 20.0, duration=3.2)


def test_a_collector_goes_from_wire_to_wire(slow):
    found = catenary.assess(slow, [(108.0, 168.0)])
    assert found.contact.values.tolist() == NAMES
    first, second = found.forces.values
    assert not second[found.place.values < 112].any()
    assert not first[found.place.values > 163].any()
    both = (first > 0) & (second > 0)
    assert 20 < np.ptp(found.place.values[both]) < 55
    assert catenary.losses(slow) == []  # though each of the wires is left
    assert {each["name"] for each in slow.events} >= set(NAMES)
    assert found.force.values.min() > 90
    # slowly, the sum is the force at rest: the uplift force less that of the lowest spring
    spring = slow["pantograph_spring_2.tension"]
    assert float(found.force.mean()) == pytest.approx(120 - spring.mean(), rel=3e-3)
    assert np.subtract(*vertical_impulse(slow)) == pytest.approx(0.0, abs=0.02)


def test_masts_and_uplift_are_those_of_both_sections(slow):
    assert catenary.uplift(slow).shape == (len(slow.time), 7)
    found = catenary.assess(slow, [(110.0, 165.0)])
    assert found.mast.values == pytest.approx(55.0 * np.arange(7), abs=1e-9)
    assert 0.01 < float(found.uplift[2]) < 0.05
    assert 0.01 < float(found.uplift[3]) < 0.05


@pytest.mark.slow
def test_a_fast_collector_does_not_lose_both_wires(forms):
    run = passage(catenary.scene(forms, overlaps=OVERLAP), COLLECTOR, 80.0, 60.0, duration=2.0)
    assert catenary.losses(run) == []
    assert np.subtract(*vertical_impulse(run)) == pytest.approx(0.0, abs=0.05)


def test_wires_side_by_side_in_space():
    """In the middle of the overlap both wires bear the collector, beside the middle of the track."""
    scene = catenary.scene([catenary.form(each, (4.0, 6.0)) for each in overlapping(staggered=True)], overlaps=OVERLAP)
    catenary.add_pantograph(scene, COLLECTOR, 137.5, 0.0)
    rest = scene.equilibrium()
    forces, places = ([float(rest[f"{name}.{what}"]) for name in NAMES] for what in ("normal_force", "s_b"))
    raised = float(rest["pantograph_2.position"][1] - scene.bodies["pantograph_2"].position[1])
    assert sum(forces) == pytest.approx(120 - 50 * raised, rel=1e-3)
    assert min(forces) > 30
    assert places == pytest.approx([0.1, -0.1], abs=5e-3)


def test_a_broken_dropper_of_the_second_section(forms):
    scene = catenary.scene(forms, overlaps=OVERLAP, broken={"section_2_dropper_5_5": 0.0})
    assert "section_2_dropper_5_5" not in scene.point_forces
    with pytest.raises(fu.SceneError, match='no dropper "section_3_dropper_1_1"'):
        catenary.scene(forms, overlaps=OVERLAP, broken={"section_3_dropper_1_1": 0.0})


@pytest.mark.parametrize(("lines", "overlaps", "says"), [
    ([], 1, "no lines"),
    ([line(2), line(2)], 3, "of 1 to 2 spans, which section 1 has, got 3; take fewer"),
    ([line(3), line(2)], 0, "of 1 to 3 spans, which section 1 has, got 0"),
    ([line(3), line(2), line(3)], 2, "of 1 to 0 spans, which section 2 has besides its other overlap, got 2"),
    ([line(2), line(2)], [1, 1], "2 sections, but 2 overlaps"),
    ([line(2), line(2, span=[60.0, 55.0])], 1, "its span 1 is 55 m long in section 1 and 60 m in section 2"),
    ([line(2), line(2, gravity=9.8)], 1, r"gravity 9.81 and 9.8 m/s²"),
])
def test_sections_that_do_not_overlap_are_refused(lines, overlaps, says):
    with pytest.raises(fu.SceneError, match=says):
        catenary.scene(lines, (6.0, 6.0), overlaps=overlaps)
