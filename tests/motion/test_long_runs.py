"""A run of more than a million steps reports its duration and the reason early."""

import sys

import numpy as np
import pytest
from funicular import Circle, FunicularWarning, Material, Scene, TableSignal, load_scene
from funicular.solve.motion import long_runs
from shared_scenes import cable_scene


def stiff(pinned=True) -> Scene:
    """Return a steel wire released from a force, with axial vibrations of up to 4e5 rad/s."""
    scene = cable_scene(pins=(0.0,) if pinned else (), elements=8, element="cable8p", section=Circle(radius=1e-3),
                        material=Material(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7850))
    scene.force("wire", s=1.0, value=(10, 0, 0))
    return scene


def stopped_at(time: float, scene: Scene) -> Scene:
    scene.event("enough", function=lambda reached, state: reached - time, action="stop")
    return scene


@pytest.mark.parametrize(("settings", "until", "why"), [
    ({"integrator": "explicit"}, 0.1, r"stability asks the explicit method for steps of .*Take integrator=\"radau\""),
    ({"integrator": "radau", "tol": 1e-8}, 0.02, r"tol = 1e-08 asks for steps of .* rad/s.*cable \"wire\" at s = "),
    ({"step": 2e-6}, 0.05, r"the step is fixed at 2e-06 s"),
])
def test_a_long_run_says_so_while_it_runs(settings, until, why):
    """A message at the start gives the expected total, the report the actual one."""
    with pytest.warns(FunicularWarning, match=rf"needs about [0-9.e+]+ steps, .* at the present rate of .*: {why}"):
        run = stopped_at(until, stiff()).run(50, **settings)
    (note,) = [note for note in run.report["messages"] if "steps to t" in note]
    assert f"steps to t = {until:g} s of 50 s: " in note


def test_the_bar_shows_rate_and_end(monkeypatch, capsys):
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    with pytest.warns(FunicularWarning, match="needs about"):
        stopped_at(0.1, stiff()).run(50, integrator="explicit")
    assert "a second, " in capsys.readouterr().err.replace("\n", " ")


def test_a_run_of_few_steps_says_nothing():
    messages = stiff().run(1e-3, integrator="explicit").report["messages"]
    assert not [message for message in messages if "steps" in message]


def test_knots_of_a_table_are_named_as_what_the_steps_are_for(monkeypatch):
    """The rate of a piecewise linear motion is discontinuous at each sample."""
    monkeypatch.setattr(long_runs, "MANY_STEPS_LIMIT", 500)
    time = np.linspace(0, 0.1, 1001)
    scene = stiff(pinned=False)
    polygon = TableSignal(time=tuple(time), value=tuple(1e-3 * np.cos(90 * time) - 1e-3), interpolation="linear")
    scene.motion("wire", s=0.0, displacement=(polygon, 0, 0))
    notes = scene.run(0.1, tol=1e-3, output_step=0.05, integrator="radau").report["messages"]
    message = "a step ends at each of the 999 breakpoints of signals so far. Give tables fewer samples"
    assert any(message in note for note in notes)


@pytest.mark.parametrize("integrator", ["genalpha", "radau"])
def test_progress_changes_no_bit(integrator):
    """Without a display the engine pauses by itself, where it returns with one."""
    times: list[float] = []
    shown, quiet = (load_scene("paper51").run(0.4, output_step=0.02, tol=1e-3, integrator=integrator, progress=each)
                    for each in (times.append, False))
    assert len(times) >= 20
    assert shown.report["factorisations"] == quiet.report["factorisations"]
    for name, values in quiet.items():
        assert shown[name].tobytes() == values.tobytes(), name
