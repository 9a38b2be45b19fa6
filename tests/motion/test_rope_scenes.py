"""Numbers in the headers of bundled scenes of ropes are those that the scenes give."""

import re
from pathlib import Path

import funicular as fu
import numpy as np
import pytest

HEADER = r"rises by ([\d.]+) m/s².*?are ([\d.]+) N in the haul, ([\d.]+) N in the fall .*?, and ([\d.]+) N in the"


def test_block_and_tackle():
    """The header gave the ones of a rope without mass: 0.43672 m/s², and tensions that were 2 N lower."""
    text = (Path(fu.__file__).parent / "scenes" / "block_and_tackle.toml").read_text(encoding="utf-8")
    said = re.search(HEADER, text.replace("\n#", ""), re.DOTALL)
    run = fu.load_scene("block_and_tackle").run(progress=False)
    found = [2 * (run["block.position"][-1, 1] + 10) / run.time[-1] ** 2,
             *(run[name][-1] for name in ("upper.tension_off", "upper.tension_on", "lower.tension_on"))]
    assert [float(number) for number in said.groups()] == pytest.approx(found, rel=1e-4)


def test_tower_crane():
    """At the tolerance of the scene the load is within 5e-5 m of a run at a hundredth of it."""
    text = (Path(fu.__file__).parent / "scenes" / "tower_crane.toml").read_text(encoding="utf-8").replace("\n#", "")
    run = fu.load_scene("tower_crane").run(progress=False)
    swings = run["load.position"][370:, 0] - run["trolley.position"][370:, 0]
    wound, tension = run["winch.length_in_store"], run["winch.tension"]
    said = re.search(r"takes ([\d.]+) kW at most and winds ([\d.]+) m .*? is ([\d.]+) to ([\d.]+) kN.*?by ([\d.]+) m",
                     text)
    assert [float(number) for number in said.groups()] == pytest.approx([
        run["winch.power"].max() / 1e3, wound[-1] - wound[0], tension.min() / 1e3, tension.max() / 1e3,
        abs(swings).max()], rel=3e-3)
    assert abs(run.energy_balance().relative).max() < 1e-5
    assert not run.report["messages"]


@pytest.mark.slow
def test_slewing_crane():
    """At its tolerance the load is within 1e-4 m of a run on elements of half the length; at half of it within 2e-6 m.
    """
    path = Path(fu.__file__).parent / "scenes" / "slewing_crane.toml"
    text, run = path.read_text(encoding="utf-8").replace("\n#", ""), fu.load_scene("slewing_crane").run(progress=False)
    load, trolley, tension = run["load.position"], run["trolley.position"], run["winch.tension"] / 1e3
    swing = np.linalg.norm((load - trolley)[:, [0, 2]], axis=1)
    yaw = [np.unwrap(2 * np.arctan2(*run[f"{name}.orientation"][:, [2, 0]].T)) for name in ("jib", "load")]
    said = re.search(r"by ([\d.]+) degrees.*?rises by ([\d.]+) m; .*?takes ([\d.]+) kW.*?winds ([\d.]+) m.*?is "
                     r"([\d.]+) to ([\d.]+) kN.*?swings by ([\d.]+) m.*?by ([\d.]+) rad", text)
    assert [float(number) for number in said.groups()] == pytest.approx([
        np.degrees(yaw[0][-1]), np.ptp(load[:, 1]), run["winch.power"].max() / 1e3,
        np.ptp(run["winch.length_in_store"]), tension.min(), tension.max(), swing.max(),
        np.abs(yaw[1] - yaw[0]).max()], rel=1e-2)
    assert abs(run.energy_balance().relative).max() < 1e-5
    assert max(run[f"hook_{k}.residual"].max() for k in range(1, 8)) < 1e-10
    assert not run.report["messages"]


def test_the_slewing_crane_starts_at_rest():
    """In the first 2 s nothing moves; in the next second the jib turns with all that it carries."""
    scene = fu.load_scene("slewing_crane")
    run = scene.run(duration=3.0, output_step=1.0, progress=False)
    assert np.abs(run["load.position"][2] - run["load.position"][0]).max() < 1e-6
    assert run["jib.orientation"][-1, 2] == pytest.approx(np.sin(0.05 / 12 / 2), rel=1e-3)
    assert run["hook_1.tension_on"] == pytest.approx(12267.8, rel=1e-3)


@pytest.mark.slow
def test_elevator():
    """At the tolerance of the scene bodies are within 1.3e-4 m of a run at a thousandth of it on half the elements."""
    text = (Path(fu.__file__).parent / "scenes" / "elevator.toml").read_text(encoding="utf-8").replace("\n#", "")
    run = fu.load_scene("elevator").run(progress=False)
    car, angle = run["car.position"][:, 1], run["traction.angle"]
    on, off = (run[f"traction.tension_{side}"][20:] for side in ("on", "off"))
    power = run["traction.torque"] * np.gradient(angle, run.time)
    said = re.search(r"up to ([\d.]+) m/s.*?at most ([\d.]+) kW.*?has ([\d.]+) to ([\d.]+) kN .*?and ([\d.]+) to "
                     r"([\d.]+) kN.*?at most ([\d.]+); the groove holds ([\d.]+)\..*?stops ([\d.]+) mm", text)
    assert [float(number) for number in said.groups()] == pytest.approx([
        np.gradient(np.gradient(car, run.time), run.time).max(), -power.min() / 1e3, on.min() / 1e3, on.max() / 1e3,
        off.min() / 1e3, off.max() / 1e3, (on / off).max(), np.exp(0.2 * run["traction.wrap_angle"].min()),
        1e3 * (car[0] - 0.35 * angle[-1] - car[-1])], rel=5e-3)
    assert run["lower.tension_on"].min() > 2e3
    assert abs(run.energy_balance().relative).max() < 2e-5
    assert not run.report["messages"]


@pytest.mark.slow
def test_aerial_tramway():
    """At its tolerance bodies are within 1e-2 m of a run on elements of a third and a quarter of the length."""
    text = (Path(fu.__file__).parent / "scenes" / "aerial_tramway.toml").read_text(encoding="utf-8").replace("\n#", "")
    with pytest.warns(fu.FunicularWarning, match='friction of "driver" is left out'):
        run = fu.load_scene("aerial_tramway").run(progress=False)
    on, off = run["driver.tension_on"], run["driver.tension_off"]
    power = run["driver.torque"] * np.gradient(run["driver.angle"], run.time)
    turn = 2 * np.degrees(np.arctan2(run["cabin.orientation"][:, 3], run["cabin.orientation"][:, 0]))
    said = re.search(r"at most ([\d.]+) kW, and the grip at most ([\d.]+) kN.*?at most ([\d.]+) kN and ([\d.]+) kN, "
                     r"in a ratio of at most ([\d.]+); friction holds ([\d.]+)\..*?up to ([\d.]+) degrees", text)
    assert [float(number) for number in said.groups()] == pytest.approx([
        -power.min() / 1e3, np.linalg.norm(run["grip.force"], axis=1).max() / 1e3, off.max() / 1e3, on.max() / 1e3,
        (off / on).max(), np.exp(0.25 * run["driver.wrap_angle"].min()), np.abs(turn).max()], rel=5e-3)
    moved = (run["carriage.position"] - run["carriage.position"][0]) @ [0.96, 0.28, 0]
    assert moved[-1] == pytest.approx(100.0, abs=0.1)
    assert np.ptp(run["haul.s"][:, 0]) == pytest.approx(100.0, abs=0.3)  # the material flows past the nodes
    assert run["grip.residual"].max() < 1e-9
    assert abs(run.energy_balance().relative).max() < 5e-5  # 2.4e-5
