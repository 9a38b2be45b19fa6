"""A rope leaves its drum where that has run empty: its end is free, and falls with the load."""

import funicular as fu
import numpy as np
import pytest
from interrupted_runs import killed_and_resumed
from test_ropes import INTEGRATORS, THIN, body, momenta, near

BRIEF = {"duration": 0.6, "output_step": 0.05, "tol": 1e-6}
FALLING = 0.45  # s: the rope has left some time before


def paying(turn: float) -> fu.TableSignal:
    return fu.TableSignal(time=[0, 0.4, 3], value=[0, turn, turn], interpolation="linear")


def hanging(sense=1, **drum) -> fu.Scene:
    """Return a load that hangs from a drum, which pays out all its rope."""
    scene = fu.Scene(gravity=(0, -9.81, 0))
    body(scene, "load", 0.2 * sense, -1.5, 3.0, velocity=(0.1 * sense, 0, 0))
    winch = fu.Drum("winch", at=(0, 0, 0), radius=0.2, side="right" if sense > 0 else "left",
                    **{"length_in_store": 0.1, "at_end": "leave", "velocity": paying(-3 * sense)} | drum)
    scene.rope("hoist", route=[winch, fu.Anchor("load")], tension=3 * 9.81, **THIN)
    return scene


@pytest.fixture(scope="module")
def runs() -> dict[str, fu.Run]:
    return {each: hanging().run(**BRIEF, integrator=each) for each in INTEGRATORS}


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.slow_cases("genalpha")
def test_the_load_falls_freely(runs, integrator):
    """The momentum of all changes by the weight alone; energy balances, with what the event takes."""
    run = runs[integrator]
    assert [event["what"] for event in run.events] == ["left the drum"]
    assert np.abs(run.energy_balance().relative).max() < 5e-6
    first = int(np.searchsorted(run.time, FALLING - 1e-9))
    scene = hanging()
    before, after = (momenta(scene, run, k) for k in (first, len(run.time) - 1))
    weight = -9.81 * (3.0 + mass_of_rope(scene))
    assert after[:2] - before[:2] == pytest.approx([0, weight * (run.time[-1] - run.time[first])], abs=1e-5)
    assert run["winch.length_in_store"][-1] == pytest.approx(0.0, abs=1e-12)
    assert [run[f"winch.{name}"][-1] for name in ("tension", "normal_force", "power")] == pytest.approx([0, 0, 0])
    near(run, runs["radau"], 1e-6, "load.position")


def mass_of_rope(scene: fu.Scene) -> float:
    """Return the mass of the rope with what is in store, kg."""
    rope = scene.ropes["hoist"]
    length = rope.drawn(scene.bodies).free_length + rope.length_in_store
    return rope.material.density * rope.section.mass_moments()[0] * length


def test_mirrored(runs):
    run = hanging(-1).run(**BRIEF, integrator="radau")
    assert run["load.position"][-1] * (-1, 1, 1) == pytest.approx(runs["radau"]["load.position"][-1], abs=1e-10)


def test_a_drum_goes_on_turning_alone():
    """Its torque accelerates its own inertia after the rope has left."""
    scene = hanging(velocity=None, inertia=2.0, torque=2.0)
    run = scene.run(1.2, output_step=0.05, tol=1e-6, integrator="radau")
    left = run.events[0]["time"]
    rates = np.diff(run["winch.angle"][run.time > left + 0.05], 2) / 0.05**2
    assert len(rates) > 2
    assert rates == pytest.approx(np.full(len(rates), 2.0 / 2.0), abs=1e-4)


def test_goes_on_from_a_state_after_it_left(runs):
    whole = runs["radau"]
    rest = hanging().run(0.15, output_step=0.05, tol=1e-6, integrator="radau", initial=whole.at(FALLING))
    assert not rest.events
    assert rest["load.position"][-1] == pytest.approx(whole["load.position"][-1], abs=1e-6)


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_resumed_bit_for_bit(tmp_path, integrator, runs):
    scene = hanging()
    resumed = killed_and_resumed(scene, tmp_path / "run.nc", 10, **BRIEF, integrator=integrator, progress=False)
    assert all(np.array_equal(runs[integrator][name], resumed[name]) for name in resumed)


def test_a_rope_without_mass_cannot_leave():
    with pytest.raises(fu.SceneError, match='drum "winch" has at_end="leave": its free end would have no place'):
        scene = fu.Scene()
        body(scene, "load", 0.2, -1.5, 3.0)
        winch = fu.Drum("winch", at=(0, 0, 0), radius=0.2, side="right", length_in_store=0.1, at_end="leave")
        scene.rope("hoist", route=[winch, fu.Anchor("load")], tension=30.0, mass=False, **THIN)


def test_files():
    scene = hanging()
    again = fu.Scene.from_toml(scene.to_toml())
    assert again.ropes["hoist"].drums[0].at_end == "leave"
