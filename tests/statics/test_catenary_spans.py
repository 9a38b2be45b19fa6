"""Catenaries of unequal spans: heights, dropper forces and weights against strings and against balances of forces."""

import numpy as np
import pytest
from funicular import catenary
from test_catenary import X, droppers, line55

UNEQUAL = {"span": [55.0, 48.0, 50.0],
           "droppers": [droppers(), droppers(at=[5, 12, 20, 28, 36, 43], sag=[0, 0.02, 0.03, 0.035, 0.02, 0]),
                        droppers(at=[4, 11, 18, 25, 32, 39, 46], sag=0.04)]}
LONGEST = (1.0, 2.0)


def heights_off(line, rest):
    """Return by how much the contact wire is off its given heights at the droppers, in m."""
    wire = rest["contact.position"]
    return np.array([wire[np.argmin(np.abs(wire[:, 0] - span.start - x)), 1] + depth for span in line.each
                     for x, depth in zip(span.droppers.at, span.droppers.depths, strict=True)])


@pytest.mark.parametrize("stagger", [0.0, pytest.param([0.2, -0.2, 0.25, -0.15], id="staggers")])
def test_unequal_spans_lie_as_given(stagger):
    line = line55(3, **UNEQUAL, stagger=stagger)
    form = catenary.form(line, LONGEST)
    rest = catenary.scene(form).equilibrium()
    assert rest.stable
    assert [len(span.lengths) for span in form.spans] == [9, 6, 7]
    assert np.abs(heights_off(line, rest)).max() < 5e-8
    for k, span in enumerate(form.spans):
        tensions = [float(rest[f"dropper_{k + 1}_{j + 1}.tension"]) for j in range(len(span.lengths))]
        assert tensions == pytest.approx(span.tensions, rel=1e-7)
    assert [float(rest[f"support_{mast}.tension"]) for mast in (1, 2)] == pytest.approx(form.mast_forces, rel=1e-7)
    assert rest["contact@0.force"][0] == pytest.approx(-22e3, rel=1e-8)
    # the droppers bear all of the contact wire, whose end masts are symmetry planes
    clamps = 0.165 * 22
    assert form.tensions.sum() == pytest.approx(9.81 * (1.35 * 153 + clamps), rel=1e-4)


def test_dropper_forces_come_to_those_of_strings():
    """With little bending the forces are those of tributary lengths and kinks."""
    form = catenary.form(line55(3, bending=0.01, **UNEQUAL), (0.5, 1.0))
    strings = form.line.strings
    assert form.tensions == pytest.approx(strings.forces, rel=2e-2)
    assert form.tensions.sum() == pytest.approx(strings.forces.sum(), rel=1e-4)


def test_strings_sag_between_droppers_across_a_mast():
    """The wire hangs over an inner mast from dropper to dropper: the height there is that of a parabola."""
    line = line55(3, bending=0.01, **UNEQUAL)
    form = catenary.form(line, (0.5, 2.0))  # whose elements round the kinks at the droppers
    before, after = 55 - 50.5, 5.0
    assert form.heights[1] == pytest.approx(-9.81 * 1.35 / 22e3 / 2 * before * after, rel=0.05)
    assert form.heights[0] == pytest.approx(-9.81 * 1.35 / 22e3 / 2 * 4.5**2, rel=0.06)


def test_equal_spans_given_as_lists_are_those_that_one_repeats():
    """The form of all spans is that of one, repeated; lists of equal entries are such spans."""
    listed = line55(2, span=[55.0, 55.0], droppers=[droppers(), droppers()])
    assert listed.repeats
    assert catenary.scene(listed, (2.0, 4.0)).to_toml() == catenary.scene(line55(2), (2.0, 4.0)).to_toml()
    one = catenary.form(line55(2), (2.0, 4.0))
    off = line55(2, droppers=[droppers(), droppers(at=[*X[:-1], 50.5 + 1e-6])])  # hardly unequal
    both = catenary.form(off, (2.0, 4.0))
    assert not off.repeats
    for span in both.spans:
        assert span.lengths == pytest.approx(one.spans[0].lengths, abs=2e-6)
        assert span.tensions == pytest.approx(one.spans[0].tensions, rel=1e-4)
    assert both.heights == pytest.approx([one.heights[0]] * 3, abs=1e-6)
    assert both.mast_forces == pytest.approx(one.mast_forces, rel=1e-6)


def test_a_span_without_droppers_and_one_without_symmetry():
    spans = [droppers(), catenary.Droppers(at=[], stiffness=1e5), droppers(at=[5, 12, 20, 28], sag=0.0)]
    line = line55(3, span=[55.0, 20.0, 36.0], droppers=spans)
    form = catenary.form(line, LONGEST)
    rest = catenary.scene(form).equilibrium()
    assert rest.stable
    assert np.abs(heights_off(line, rest)).max() < 5e-8
    stretched = 1 + line.messenger.tension / line.messenger.axial_stiffness  # has the mass of its length as given
    own, before = (9.81 * 1.08 * stretched * each.messenger_length / 2 for each in (form.spans[1], form.spans[0]))
    first = form.spans[0]  # the droppers of which hang from it; the second messenger hangs alone
    before += float((first.tensions + 9.81 * first.hanging) @ np.array(X) / 55)
    assert form.mast_forces[0] == pytest.approx(own + before, rel=5e-5)  # droppers hang a few mm from X


def test_a_passage_through_unequal_spans():
    line = line55(3, damping=0.06, **UNEQUAL)
    scene = catenary.scene(catenary.form(line, (2.0, 4.0)))
    masses = catenary.Pantograph(masses=[7.2, 15], stiffness=[4200, 50], damping=[10, 90], uplift=120)
    catenary.add_pantograph(scene, masses, 20.0, 200 / 3.6)
    run = scene.run(progress=False, duration=1.6)
    found = catenary.assess(run, [(25, 103)])
    assert found.mast.values == pytest.approx([0, 55, 103, 153])
    assert 100 < float(found["mean"][0]) < 125
    assert 0.01 < float(found.uplift[1]) < 0.1
    assert abs(float(found.uplift[3])) < 0.01
