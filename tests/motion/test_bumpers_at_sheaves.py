"""Riders on ropes that strike a bumper beside a sheave: a hard contact with a surface of what carries the sheave.

The rope runs on under a rider at the bumper, which stands still while what pushes it does.
"""

import funicular as fu
import numpy as np
import pytest
from expectations import slide_events
from interrupted_runs import killed_and_resumed
from ropes.scenes import on_rope_and_cable, rope_of
from test_grips import SETTINGS
from test_ropes import momenta

pytestmark = pytest.mark.filterwarnings("ignore:.*youngs_modulus|.*density|.*initial velocities:"
                                        "funicular.FunicularWarning")
FLOW, PUSH, ACROSS, MU = 0.3, 20.0, 50.0, 0.2
AT, TURNS = 3.9, 0.65
"""Place of the bumper, m, and the instant from which the force turns round, s."""


def pushed(dim: int = 2, friction: object = MU, elements: int = 4, EA: float = 2e5) -> fu.Scene:
    """Return a load on a rope, pushed towards a bumper beside a sheave and later back; a drum pays out the rope."""
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.rigid_body("weight", mass=50, inertia=(1, 1, 1), position=(4.3, -2.3, 0))
    scene.force("weight", value=(0, -1e3, 0))
    drum = fu.Drum("winch", at=(0, -0.2, 0), radius=0.2, side="right", length_in_store=5,
                   velocity=fu.Ramp(start=0.0, end=0.3, after=FLOW / 0.2))
    rope = scene.rope("haul", route=[drum, fu.Sheave("top", at=(4, -0.3, 0), radius=0.3, side="right"),
                                     fu.Anchor("weight")], elements=[elements, 1], tension=1e3,
                      element="cable8p" if dim == 2 else "cable12", **rope_of(EA, 0.5, 0, 1e-2))
    start = rope.point(scene.holders, scene.route_of(rope).arc_lengths(rope.first_arc_length)[0][1] - 0.25)
    scene.rigid_body("load", mass=5, inertia=(1, 1, 1), position=start.tolist())
    scene.force("load", value=(PUSH, 0, 0), scale=fu.Ramp(start=TURNS, end=TURNS + 0.1, before=1.0, after=-1.0))
    scene.force("load", value=(0, -ACROSS, 0))
    scene.slide("load", along="haul", name="trolley", friction=friction, at_end="error")
    scene.surface("plate", fu.Plane(normal=(-1, 0, 0)), at=(AT, 0, 0))
    scene.contact("load", "plate", restitution=0.0, name="bumper")
    return scene


@pytest.mark.parametrize("dim", [2, pytest.param(3, marks=pytest.mark.slow)])
@pytest.mark.parametrize("friction", [pytest.param(MU, id="regularised", marks=pytest.mark.slow),
                                      pytest.param(fu.Friction(coefficient=MU, model="stick"), id="stick")])
def test_the_rope_runs_on_under_a_rider_at_the_bumper(dim, friction):
    """The rider stands still, friction of the sliding rope acts on it, and it leaves when the force turns round."""
    run = pushed(dim, friction).run(0.9, **SETTINGS | {"output_step": 0.02})
    struck, *_, left = (event for event in run.report["events"] if event["name"] == "bumper")
    assert (struck["what"], left["what"]) == ("came into contact", "lost contact")
    assert TURNS < left["time"] < TURNS + 0.1
    held = (run.time > struck["time"] + 0.05) & (run.time < TURNS)
    assert held.sum() > 6
    assert np.abs(run["load.position"][held, 0] - AT).max() < 1e-9
    assert np.mean(run["trolley.s_rate"][held]) == pytest.approx(FLOW, rel=0.05)  # it vibrates along the rope
    assert run["load.position"][-1, 0] < AT - 0.02
    # equilibrium of the rider along the plate's normal, and Coulomb's law
    along = run["trolley.force"][held, 0] + run["bumper.force"][held, 0] + PUSH
    assert np.abs(along).max() < 1e-6 * PUSH
    across = np.linalg.norm(run["trolley.multiplier"][held], axis=1) if dim == 3 else np.abs(
        run["trolley.multiplier"][held, 0])
    assert np.abs(run["trolley.traction"][held]) == pytest.approx(MU * across, rel=1e-4)
    assert np.abs(run.energy_balance().relative).max() < 1e-5


@pytest.mark.parametrize("integrator", ["genalpha", pytest.param("explicit", marks=pytest.mark.slow)])
def test_integrators_agree(integrator):
    scene = pushed(friction=None, elements=2, EA=5e4)
    run, other = (scene.run(0.45, **SETTINGS | {"integrator": name}) for name in ("radau", integrator))
    assert [event["what"] for event in run.report["events"]] == [event["what"] for event in other.report["events"]]
    assert np.abs(run["load.position"] - other["load.position"]).max() < 1e-4


@pytest.mark.parametrize("restitution", [0.0, 0.5])
def test_agrees_with_a_bumper_on_a_cable(restitution):
    """Beside a sheave of 1 cm and a rope of 1 cm beyond it, to which the difference is in proportion."""
    rope, cable, line = on_rope_and_cable(0.01)
    runs = []
    for scene in (rope, cable):
        scene.rigid_body("load", mass=20, inertia=(1, 1, 1), position=line.point(rope.bodies, 6.0).tolist(),
                         velocity=(4, 0, 0))
        scene.slide("load", along="line", s=6.0, name="trolley")
        scene.surface("plate", fu.Plane(normal=(-1, 0, 0)), at=(7.0, 0, 0))
        scene.contact("load", "plate", restitution=restitution, name="bumper")
        runs.append(scene.run(0.5, **SETTINGS | {"tol": 1e-6}))
    events = [[event["what"] for event in run.report["events"]] for run in runs]
    assert events[0] == events[1] and events[0]
    assert np.abs(runs[0]["load.position"] - runs[1]["load.position"]).max() < 1e-3
    assert runs[0]["energy.dissipated"][-1] == pytest.approx(runs[1]["energy.dissipated"][-1], rel=2e-3)
    assert np.abs(runs[0].energy_balance().relative).max() < 1e-6


def test_momentum_passes_to_what_carries_the_sheave():
    """A rope over a sheave on a free body, with bodies at its ends; another on the rope strikes a plate of the first.
    """
    scene = fu.Scene(gravity=(0, 0, 0))
    for name, mass, start, speed in (("A", 2.0, (-0.2, -1.5, 0), -0.2), ("B", 2.5, (0.2, -1.5, 0), -0.2),
                                     ("C", 3.0, (0, 0, 0), -0.2), ("D", 0.3, (0.2, -0.5, 0), 1.8)):
        scene.rigid_body(name, mass=mass, inertia=(1, 1, 0.1), position=start, velocity=(0.3, speed, 0))
    for name in "AB":
        scene.spring(name, "C", stiffness=100.0, length=2.0)
    scene.rope("rope", route=[fu.Anchor("A"), fu.Sheave("top", at="C", radius=0.2, side="right"), fu.Anchor("B")],
               tension=50.0, elements=3, **rope_of(2e4, 0.1, 0, 1e-4))
    scene.slide("D", along="rope", name="trolley")
    scene.surface("plate", fu.Plane(normal=(0, -1, 0)), on="C", at=(0, -0.36, 0))
    scene.contact("D", "plate", restitution=0.5, name="bumper")
    run = scene.run(0.12, **SETTINGS | {"tol": 1e-7, "output_step": 0.02})
    assert run.report["events"][0]["name"] == "bumper"
    found = np.array([momenta(scene, run, k) for k in range(len(run.time))])
    assert np.abs(found - found[0]).max() < 1e-6 * np.abs(found).max()


def test_resumed_bit_for_bit(tmp_path):
    """A run is paused where the rider is at the bumper."""
    scene, settings = pushed(), SETTINGS | {"duration": 0.5, "output_step": 0.02}
    whole = scene.run(**settings)
    resumed = killed_and_resumed(scene, tmp_path / "run.nc", 20, **settings)
    assert all(np.array_equal(whole[name], resumed[name], equal_nan=True) for name in whole)


def test_without_a_bumper_the_run_ends_at_the_sheave():
    scene = pushed(friction=None).without("bumper")
    with pytest.raises(fu.RopeLeftError, match=r'slide "trolley" .* reaches sheave "top"') as caught:
        scene.run(1.0, **SETTINGS)
    assert not slide_events(caught.value.run)
