"""Notes on meshes too coarse for the forces in cables: by the strain within elements, and at slides."""

import re
import warnings

import funicular as fu
import numpy as np
import pytest
from funicular.model.build import build
from funicular.parts.in_plane import in_plane
from funicular.solve.notes.coarse_meshes import ROW_INTERVAL, CoarseMeshes
from funicular.solve.notes.coarse_slides import CoarseSlides
from funicular.solve.notes.row_notes import RowNotes
from scipy.optimize import brentq

A, DENSITY = 3e-4, 7800.0
WEIGHT = A * DENSITY * 9.81
THIN = fu.GeneralSection(area=A, second_moment_about_z=2e-11, second_moment_about_y=2e-11)


def rope(n, span=10.0, length=30.0, element="cable8p", modulus=1e11, **kw):
    """Return a hanging rope between two pins at one height."""
    scene = fu.Scene(gravity=(0, -9.81, 0))
    wire = scene.cable("wire", start=(0, 0, 0), end=(span, 0, 0), rest_length=length, elements=n, element=element,
                       material=fu.Material(youngs_modulus=modulus, poisson_ratio=0, density=DENSITY,
                                            damping_time=1e-3), **{"shape": "hanging", "section": THIN} | kw)
    scene.pin(wire, s=0)
    scene.pin(wire, s=wire.length)
    return scene


def catenary(span, length):
    """Return the force (2,) on the pin of an inextensible cable: H = w a, with 2 a sinh(span / 2 a) = length; N."""
    a = brentq(lambda a: 2 * a * np.sinh(span / (2 * a)) - length, 0.02 * span, 1e3 * span)
    return WEIGHT * np.array([-a, length / 2])


def error_of(rest, exact):
    """Return the largest error of a component of the force, relative to the force."""
    return np.abs(rest["wire@0.force"][:2] - exact).max() / np.linalg.norm(exact)


def coarse(messages):
    return [message for message in messages if "are too long between" in message]


def advised(message):
    return int(re.search(r"elements=(\d+)", message).group(1))


@pytest.mark.parametrize(("span", "length", "n", "element"), [
    (10, 30, 6, "cable8p"), (10, 30, 8, "cable8p"), (10, 30, 6, "cable12"), (100, 110, 2, "cable8p"),
    (100, 140, 3, "cable8p")])
def test_a_line_of_few_elements_is_told_and_right_with_the_number_it_is_told(span, length, n, element):
    """The note gives the error to a factor of four; with the advised mesh, once or twice, the force is right to 2 %."""
    rest = rope(n, span, length, element).equilibrium()
    note, = coarse(rest.messages)
    error, exact = error_of(rest, catenary(span, length)), catenary(span, length)
    assert error > 0.01 and 1 / 4 < float(re.search(r"may be ([\d.]+) % off", note).group(1)) / (100 * error) < 4
    for _ in range(2):
        rest = rope(advised(note), span, length, element).equilibrium()
        note = next(iter(coarse(rest.messages)), note)
    assert coarse(rest.messages) == [] and error_of(rest, exact) < 0.02


@pytest.mark.parametrize(("span", "length", "n"), [(100, 100.5, 2), (100, 110, 4), (10, 30, 16), (100, 140, 8)])
def test_meshes_that_are_right_are_not(span, length, n):
    rest = rope(n, span, length).equilibrium()
    assert coarse(rest.messages) == []
    if length > 101:  # the taut one stretches
        assert error_of(rest, catenary(span, length)) < 0.01


def loaded(n, length=105.0):
    scene = rope(n, 100.0, length)
    scene.force("wire", s=0.4 * length, value=(0, -6000, 0))
    return scene


@pytest.mark.parametrize("n", [4, 5, 10])
def test_a_corner_below_a_load_is_told_with_its_place(n):
    """With 4, 5 and 10 elements, the load within one and at nodes, forces differ from those of 200 by 3, 4 and 2 %, and
    by less than 1 % with the advised mesh.
    """
    rest = loaded(n).equilibrium()
    note, = coarse(rest.messages)
    assert "what acts at s = 42 m bends the cable over sqrt(EI/N) = 0.0" in note
    exact = loaded(200).equilibrium()["wire@0.force"][:2]
    assert error_of(rest, exact) > 0.01 > error_of(loaded(advised(note)).equilibrium(), exact)


def test_a_taut_stretch_of_a_slack_line_is_measured_by_the_line():
    """Two elements of a stretch turn by 24 degrees, but the line of four bears the load: its forces are right."""
    scene = fu.Scene(gravity=(0, -9.81, 0))
    ends = np.linspace((0, 0, 0), (200, -60, 0), 5)
    stretches = [(20000, 4e8), (3000, 1.5e8), (15000, 4e8), (8000, 1e8)]
    for k, (density, EA) in enumerate(stretches):
        scene.cable(f"c{k}", start=ends[k], end=ends[k + 1], rest_length=60, elements=2, element="cable8p",
                    section=fu.GeneralSection(area=5e-3, second_moment_about_z=2e-8),
                    material=fu.Material(youngs_modulus=EA / 5e-3, poisson_ratio=0, density=density))
        if k:
            scene.tie(f"c{k - 1}", s=60.0, to=f"c{k}", at=0)
    scene.pin("c0", s=0)
    scene.pin("c3", s=60)
    assert coarse(scene.equilibrium().messages) == []


def test_a_run_is_told_as_well():
    """A rope swings slowly after a push; a mesh of twenty elements has no note."""
    for n, told in ((6, 1), (20, 0)):
        scene = rope(n)
        run = scene.run(duration=0.5, tol=1e-3, output_step=0.01, integrator="radau", initial=scene.equilibrium())
        notes = [message for message in coarse(run.report["messages"]) if "state to start" not in message]
        assert len(notes) == told


def test_what_flies_free_of_stress_is_not_told():
    scene = fu.Scene(gravity=(0, -9.81, 0))
    scene.cable("wire", start=(0, 0, 0), end=(3, 0, 0), elements=3, element="cable8p", velocity=(1, 2, 0),
                angular_velocity=(0, 0, 1), section=fu.Circle(radius=0.01),
                material=fu.Material(youngs_modulus=1e9, poisson_ratio=0, density=1000, damping_time=1e-3))
    run = scene.run(duration=0.3, tol=1e-4, output_step=0.01)
    assert coarse(run.report["messages"]) == []


def test_rows_may_come_in_any_parts():
    """The findings of 40 rows do not depend on their division, as after a checkpoint."""
    scene = in_plane(rope(6))
    scene.slide((5.0, float(scene.cables["wire"].point(15.0)[1]), 0), along="wire", s=15.0)
    model = build(scene)
    rng = np.random.default_rng(1)
    q = model.q + 0.01 * rng.standard_normal((40, len(model.q)))
    rows = {"time": np.arange(40.0), "q": q, "v": np.zeros((40, model.n_dof)), "s": np.full((40, 1), 15.0),
            "slide": rng.standard_normal((40, 1, 11)) * 100}
    whole, parts = RowNotes(scene, model), RowNotes(scene, model)
    whole.see(Recorded(rows))
    for start, stop in ((0, 1), (1, 2), (2, 11), (11, 40)):
        parts.see(Recorded({name: array[start:stop] for name, array in rows.items()}))
    for kind in (CoarseMeshes, CoarseSlides):
        (one,), (other,) = whole[kind].found.values(), parts[kind].found.values()
        for a, b in zip(one, other, strict=True):
            np.testing.assert_allclose(a, b, rtol=1e-12)
        assert one[0] == 40 / ROW_INTERVAL


class Recorded:
    """Stands for an engine that has recorded rows, of a scene without contact."""

    def __init__(self, rows):
        self._rows = rows

    def rows(self):
        return self._rows

    def deepest(self, kind):
        return np.zeros(0)

    farthest = deepest


def over_an_eyelet(n, radius=0.3, load=1000.0, EI=10.0, angle=np.pi / 2):
    """Return a weightless rope from a pin over an eyelet, pulled at its end: by balance the pin bears the load."""
    straight, arc = 3.0 - radius * angle / 2, radius * angle

    def line(u):
        s = 6.0 * u
        turned = min(max(s - straight, 0.0) / radius, angle)
        x, y, rest = min(s, straight) + radius * np.sin(turned), -radius + radius * np.cos(turned), s - straight - arc
        return x + max(rest, 0.0) * np.cos(angle), y - max(rest, 0.0) * np.sin(angle), 0

    scene = fu.Scene(gravity=(0, 0, 0))
    wire = scene.cable("rope", curve=line, elements=n, element="cable8p", strain="engineering", rest="straight",
                       section=fu.GeneralSection(area=1e-4, second_moment_about_z=EI / 1e10),
                       material=fu.Material(youngs_modulus=1e10, poisson_ratio=0, density=8000))
    scene.pin(wire, s=0)
    scene.slide(tuple(wire.point(3.1)), along=wire, s=3.1, name="eye")
    scene.force(wire, s=6.0, value=(load * np.cos(angle), -load * np.sin(angle), 0))
    return scene


def at_slides(messages):
    return [message for message in messages if "cannot follow" in message]


def test_a_loaded_rope_over_an_eyelet_is_told_and_right_with_the_length_it_is_told():
    rest = over_an_eyelet(13).equilibrium()
    note, = at_slides(rest.messages)
    assert note.startswith('slide "eye": cable "rope" turns there by ') and "which its elements of 0.462 m" in note
    assert float(re.search(r"sqrt\(EI/N\) = ([\d.]+) m", note).group(1)) == pytest.approx(np.sqrt(10 / 1000), rel=0.3)
    assert abs(np.linalg.norm(rest["rope@0.force"]) / 1000 - 1) > 0.02
    better = over_an_eyelet(advised(note) + 6).equilibrium()
    assert at_slides(better.messages) == []
    assert np.linalg.norm(better["rope@0.force"]) == pytest.approx(1000, rel=0.02)


@pytest.mark.parametrize("given", [{"n": 13, "angle": 0.15}, {"n": 13, "EI": 400.0}, {"n": 70}])
def test_a_slide_that_turns_its_cable_little_or_within_its_elements_is_not(given):
    rest = over_an_eyelet(**given).equilibrium()
    assert at_slides(rest.messages) == []
    assert np.linalg.norm(rest["rope@0.force"]) == pytest.approx(1000, rel=0.02)


def test_a_run_over_an_eyelet_is_told():
    scene = over_an_eyelet(13)
    run = scene.run(duration=0.1, tol=1e-3, output_step=0.005, integrator="radau", initial=scene.equilibrium())
    assert len([each for each in at_slides(run.report["messages"]) if "state to start" not in each]) == 1


def test_forces_by_the_elastic_law_are_told_where_they_swing():
    """At the pin the elastic law gives -1198 N with six elements and 345 N with 120; the balance gives the pin's 344 N.
    """
    rest, fine = rope(6).equilibrium(), rope(120).equilibrium()
    pin = np.linalg.norm(rest["wire@0.force"])
    with pytest.warns(fu.FunicularWarning, match=r'"constitutive" swings by .* N within the element from s = 0 to 5 m'):
        by_law = rest.section_forces("wire", s=[0.0], method="constitutive")
    assert abs(float(by_law.tension[0]) / pin - 1) > 1
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for state, method in ((rest, "balance"), (fine, "constitutive")):
            found = state.section_forces("wire", s=[0.0], method=method)
            assert float(found.tension[0]) == pytest.approx(pin, rel=0.01)


def test_a_corner_that_bending_makes_round_is_not_told():
    """A rope of 20 mm over 50 m: 20 elements differ by 0.5 % from 200."""
    def wire(n):
        scene = rope(n, 50.0, 50.2, shape="straight", section=fu.Circle(radius=0.01))
        scene.force("wire", s=15.06, value=(0, -2000, 0))
        return scene.equilibrium()

    rest = wire(20)
    assert coarse(rest.messages) == [] and error_of(rest, wire(200)["wire@0.force"][:2]) < 0.01
