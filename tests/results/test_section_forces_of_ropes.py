"""Section forces along the spans of ropes, at rest and in motion."""

import funicular as fu
import numpy as np
import pytest
from numpy.testing import assert_allclose
from ropes.scenes import GRAVITY, rope_of, weight

EA, RHO = 1e6, 1.5
pytestmark = pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")


def spans(tension=300.0, EI=0.0, elements=4, **given) -> fu.Scene:
    """Return a rope in three spans over two sheaves."""
    scene = fu.Scene(gravity=(0, -GRAVITY, 0))
    scene.rope("rope", tension=tension, elements=elements, **rope_of(EA, RHO, EI), **given, route=[
        fu.Anchor(at=(0, 0, 0)), fu.Sheave("one", at=(10, 2, 0), radius=0.3, side="right"),
        fu.Sheave("two", at=(20, 1.8, 0), radius=0.3, side="right"), fu.Anchor(at=(30, 0, 0))])
    return scene


@pytest.mark.parametrize("given", [{}, {"EI": 0.5}, {"element": "cable12"}, {"elements": (2, 5, 3)}])
def test_ends_of_spans_at_rest(given):
    """They are the forces on the anchors, and the tensions at the tangent points."""
    rest = spans(**given).equilibrium()
    found = rest.section_forces("rope")
    assert found.force.dims == ("point", "xyz") and found.tension.attrs["units"] == "N"
    assert_allclose(found.force.values[0], rest["rope.start_force"], atol=1e-8)
    assert_allclose(found.force.values[-1], -rest["rope.end_force"], atol=1e-8)
    ends = [found.tension.values[found.span.values == k][[0, -1]] for k in range(3)]
    for k, names in enumerate((("one", "two"), ("one", "two"))):
        at = [rest[f"{name}.{('tension_on', 'tension_off')[k]}"] for name in names]
        assert_allclose([ends[j + k][1 - k] for j in range(2)], at, rtol=5e-6)


def test_along_a_span_against_a_catenary():
    """The horizontal part is constant, the vertical one grows by the weight; strain is that of the tension."""
    rest = spans(elements=8).equilibrium()
    found = rest.section_forces("rope")
    first = found.isel(point=found.span.values == 1)
    force, s = first.force.values, first.s.values
    assert np.ptp(force[:, 0]) < 1e-8
    assert_allclose(np.diff(force[:, 1]), RHO * GRAVITY * np.diff(s), atol=1e-7)
    assert_allclose(first.tension, np.linalg.norm(force, axis=1), rtol=1e-9)
    parameter = force[0, 0] / (RHO * GRAVITY)
    low = np.argmin(np.abs(force[:, 1]))
    x = (s - s[low]) / parameter
    assert_allclose(first.tension.values[low] * np.cosh(np.arcsinh(x)), first.tension, rtol=2e-4)


def test_both_methods_converge_to_the_same():
    """The error of the elastic law falls to less than a third with elements of half the length."""
    errors = []
    for elements in (4, 8, 16):
        rest = spans(elements=elements).equilibrium()
        law, balance = (rest.section_forces("rope", method=method) for method in ("constitutive", "balance"))
        inside = law.isel(point=law.span.values == 1)
        errors.append(np.abs(inside.tension - balance.tension.values[law.span.values == 1]).max() / 300)
        assert_allclose(law.tension, EA * law.strain, rtol=1e-9)
    assert errors[0] < 1.5e-2 and errors[1] < errors[0] / 3 and errors[2] < errors[1] / 3


def test_given_places_at_rest_and_what_is_on_sheaves():
    rest = spans().equilibrium()
    nodes = rest.section_forces("rope").s.values
    wrap = (rest["rope.s"][(rest["rope.s"] > 10) & (rest["rope.s"] < 11)]).mean()
    found = rest.section_forces("rope", [0.0, wrap, nodes[-1]])
    assert found.tension.dims == ("s",)
    assert np.isnan(found.tension.values).tolist() == [False, True, False]
    assert np.isnan(found.force.values[1]).all()
    assert found.tension.values[0] == pytest.approx(300.0, rel=1e-9)


def hoist() -> fu.Scene:
    scene = fu.Scene(gravity=(0, -GRAVITY, 0))
    weight(scene, "load", 30.0, 5.3, -3.0)
    scene.rope("rope", tension=350.0, elements=4, **rope_of(EA, 0.2, 0, 1e-3), route=[
        fu.Drum("winch", at=(0, 0, 0), radius=0.3, side="right", length_in_store=20.0,
                velocity=fu.Ramp(start=0.0, end=0.2, before=0.0, after=-1.0)),
        fu.Sheave("top", at=(5, 1, 0), radius=0.3, side="right"), fu.Anchor("load")])
    return scene


def test_in_motion_by_the_elastic_law(tmp_path):
    """Places move with the rope; a place that runs onto a sheave is none of a span; tensions are those of sheaves."""
    run = hoist().run(1.0, output_step=0.1, initial="equilibrium", tol=1e-5, save=tmp_path / "run.nc")
    found = run.section_forces("rope", method="constitutive")
    assert found.tension.dims == ("time", "point") and found.s.dims == ("time", "point")
    of_load = found.isel(point=found.span.values == 1)
    assert_allclose(of_load.tension.values.mean(axis=1), run["top.tension_off"] - 0.2 * GRAVITY * 2, rtol=2e-2)
    moving = of_load.s.values[:, 0]
    assert abs(moving[-1] - moving[0]) > 0.2
    end, begin = sorted((moving[-1], moving[0]))
    at = run.section_forces("rope", [0.5 * (begin + end)], method="constitutive").tension.values[:, 0]
    assert 0 < np.isnan(at).sum() < len(at) or np.isnan(at[0]) != np.isnan(at[-1])
    loaded = fu.load_run(tmp_path / "run.nc").section_forces("rope", method="constitutive")
    assert_allclose(loaded.tension, found.tension)
    found.to_netcdf(tmp_path / "forces.nc")


def test_refused():
    run = hoist().run(0.01, output_step=0.01)
    with pytest.raises(fu.FunicularError, match='rope "rope" in motion are those of the elastic law; take method='):
        run.section_forces("rope")
    rest = spans().equilibrium()
    with pytest.raises(fu.FunicularError, match='rope "rope": s must be arc-lengths'):
        rest.section_forces("rope", "here")
    with pytest.raises(fu.UnknownResultError, match='there is no cable "rop"'):
        rest.section_forces("rop")
