"""`Scene.relax`: damped motions end in known equilibria, and report where they do not end."""

import funicular as fu
import numpy as np
import pytest
from catenary import end_forces
from relaxation import links, rope, strut, thin_rope, with_rider
from scipy.optimize import brentq
from scipy.special import ellipk


def energies_never_rise(state) -> bool:
    energies = np.array(state.relaxation.energies)
    return bool(np.all(np.diff(energies) <= 1e-11 * np.abs(energies).max()))


def test_a_slack_cable_falls_into_its_catenary():
    state = thin_rope().relax()
    weight, axial = 7800 * np.pi * 0.001**2 * 9.81, 1e7 * np.pi * 0.001**2
    horizontal, vertical = end_forces(1.0, 0.0, 1.3, weight, axial)
    assert state.stable
    assert state["rope@0.force"] == pytest.approx([-horizontal, vertical, 0], rel=0.02)  # it bends, too
    assert energies_never_rise(state)
    assert state.relaxation.resets > 0
    assert "came to rest by" in state.messages[0]


def test_it_is_the_state_of_equilibrium_where_there_is_one():
    scene = rope()
    assert scene.relax()["rope.position"] == pytest.approx(scene.equilibrium()["rope.position"], abs=1e-8)


@pytest.mark.parametrize("factor", [1.05, 1.5])
def test_a_buckled_rod_is_the_elastica(factor, validated):
    with pytest.warns(fu.FunicularWarning, match="pushed off"):
        state = strut(factor).relax()
    k = brentq(lambda k: ellipk(k * k) - np.pi / 2 * np.sqrt(factor), 1e-3, 0.99)
    assert state.stable
    validated("Statics", f"rod at {factor:g} of Euler's load, by a damped motion", "deflection of the end",
              2 * k / (np.pi / 2 * np.sqrt(factor)), float(abs(state["rod.position"][-1, 1])), unit="m", bound=5e-3,
              source="elastica, elliptic integral")


def test_a_rider_runs_to_the_lowest_point_of_a_light_cable():
    state = with_rider(density=1.0).relax()
    assert state.stable
    assert state["A.position"][:2] == pytest.approx([1.0, -np.sqrt(1.05**2 - 1)], abs=4e-3)
    assert energies_never_rise(state)


def test_friction_holds_a_rider_on_a_slope_that_it_can_bear():
    with pytest.warns(fu.FunicularWarning, match="one of many"):
        state = with_rider(friction=fu.Friction(coefficient=0.3, model="stick")).relax(tol=1e-5)
    s = float(state["trolley.s"])
    assert s < 0.8  # it has not come to the lowest point
    element, x = divmod(s, 2.1 / 15)
    ends = state["rope.nodal_vectors"][int(element):int(element) + 2]
    x *= 15 / 2.1
    slopes = np.array([6 * x * (x - 1), (1 - x) * (1 - 3 * x), 6 * x * (1 - x), x * (3 * x - 2)])
    tangent = slopes @ np.array([ends[0, 0] * 15 / 2.1, ends[0, 1], ends[1, 0] * 15 / 2.1, ends[1, 1]])
    assert abs(tangent[1] / tangent[0]) <= 0.3 * (1 + 1e-3)
    assert state.residual <= 1e-5 * 9.81
    assert state["trolley.force"] == pytest.approx([0, 9.81, 0], abs=1e-3)  # with friction's part, as in a run
    ends = state["rope@0.force"] + state["rope@2.1.force"]
    assert ends == pytest.approx([0, (1 + 1000 * np.pi * 0.005**2 * 2.1) * 9.81, 0], abs=1e-3)


@pytest.mark.parametrize("number", [5, 20])
def test_a_chain_of_links_hangs_straight_down(number):
    state = links(number).relax()
    assert state.stable
    for k in range(number):
        assert state[f"b{k}.position"] == pytest.approx([0, -0.2 * k - 0.1, 0], abs=1e-8)


def test_an_end_stop_holds_a_rider():
    made = fu.Scene()
    made.cable("rail", start=(0, 0, 0), end=(2, -0.4, 0), elements=4, element="cable12", section=fu.Circle(radius=0.02),
               material=fu.Material(youngs_modulus=1e10, poisson_ratio=0.3, density=1000))
    made.clamp("rail", s=0)
    made.clamp("rail", s=made.cables["rail"].length)
    made.rigid_body("A", mass=1, inertia=(1e-3, 1e-3, 1e-3), position=(1, -0.2, 0))
    length = made.cables["rail"].length
    made.slide("A", along="rail", s=length / 2, name="trolley",
               at_end=fu.Buffer(length=0.2, stiffness=200.0, damping=20.0))
    state = made.relax()
    assert float(state["trolley.s"]) == pytest.approx(length - 0.2 + 9.81 * np.sin(np.arctan(0.2)) / 200.0, abs=2e-3)


@pytest.mark.parametrize(("change", "message"), [
    (lambda made: made.force("rope", s=0.65, value=(0, 1, 0), scale=fu.Harmonic(amplitude=1, frequency=1)),
     "scale changes with time"),
    (lambda made: made.motion("rope", s=0.65, displacement=(None, fu.Ramp(start=0, end=1), None)),
     "displacement changes with time"),
])
def test_what_goes_on_by_itself_is_refused(change, message):
    made = rope()
    change(made)
    with pytest.raises(fu.SceneError, match=message):
        made.relax()


def test_friction_that_creeps_is_refused():
    with pytest.raises(fu.SceneError, match="creeps"):
        with_rider(friction=fu.Friction(coefficient=0.3)).relax()


def test_what_falls_for_ever_is_named():
    made = fu.Scene()
    made.rigid_body("A", mass=1, inertia=(1, 1, 1), position=(0, 0, 0))
    with pytest.raises(fu.EquilibriumError, match=r'body "A" is farthest from rest, 9.81 N') as error:
        made.relax(max_steps=200)
    assert error.value.state.relaxation.steps >= 200


def test_a_run_starts_from_it_and_stays():
    made = rope()
    made.run_settings = {"duration": 0.1, "initial": "relaxed"}
    run = made.run()
    assert np.ptp(run["rope.position"], axis=0).max() < 1e-6


def test_settings_of_a_scene_file():
    made = rope()
    made.relax_settings = {"tol": 1e-5, "max_steps": 3}
    copy = fu.Scene.from_toml(made.to_toml())
    assert copy.relax_settings == {"tol": 1e-5, "max_steps": 3}
    with pytest.raises(fu.EquilibriumError, match="did not come to rest, after"):
        copy.relax()
    with pytest.raises(fu.SceneError, match="max_step"):
        copy.relax(max_step=3)


def test_it_is_seen_from_the_command_line(tmp_path, monkeypatch):
    from funicular.cli.main import app
    from typer.testing import CliRunner

    monkeypatch.chdir(tmp_path)
    (tmp_path / "rope.toml").write_text(rope(elements=8).to_toml())
    result = CliRunner().invoke(app, ["view", "rope.toml", "--relaxed", "-o", "rope.html"])
    assert result.exit_code == 0, result.output
    assert (tmp_path / "rope.html").stat().st_size > 1000
