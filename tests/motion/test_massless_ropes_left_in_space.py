"""Ropes without mass in space that leave sheaves and return, in the plane of the groove and beside it: references,
twins in the plane, equations of motion of their own, momenta, ropes of small mass, rest, files, and how runs end.
"""

from collections.abc import Callable

import funicular as fu
import numpy as np
import pytest
from expectations import refused
from interrupted_runs import kill
from ropes import CASES
from ropes.massless_runs import peg as peg_of_the_case
from ropes.scenes import GRAVITY, rope_of, weight
from scipy.integrate import solve_ivp
from test_massless_ropes_in_space import momenta
from turned_scenes import ASKEW, turned_scene

EA, TAU, TENSION = 6e4, 1e-3, GRAVITY * np.cos(0.7)
SOFT = rope_of(EA, 1e-5, 0, TAU) | {"mass": False, "element": "cable12"}
PEG, RADIUS, SQUARE = np.array([0.3, -1.0, 0.0]), 0.1, np.eye(3)
START = np.array([-2 * np.sin(0.7), -2 * np.cos(0.7), 0.0])
WIDE = {"groove_width": 0.1, "max_fleet_angle": 0.3}
ASIDE, LEFT = "returned beside the middle of the groove", "left the sheave"
BRIEF = {"tol": 1e-7, "progress": False}


def pendulum(aside: float = 0.0, element: str = "cable12", tau: float = TAU, first=None, **sheave) -> fu.Scene:
    """Return a load of 1 kg on a rope of 2 m, let go beside a peg with a velocity along the axis of that."""
    scene = fu.Scene(gravity=(0, -GRAVITY, 0))
    scene.rigid_body("load", mass=1.0, inertia=(1, 1, 1), position=tuple(START), velocity=(0, 0, aside))
    peg = fu.Sheave("peg", at=tuple(PEG), radius=RADIUS, side="left", **sheave)
    given = rope_of(EA, 1e-5, 0, tau) | {"mass": False, "element": element}
    scene.rope("rope", tension=TENSION, route=[first or fu.Anchor(at=(0, 0, 0)), peg, fu.Anchor("load")], **given)
    return scene


def run_of(scene: fu.Scene, duration: float, integrator: str = "radau", **given) -> fu.Run:
    return scene.run(duration, integrator=integrator, progress=False, **{"output_step": 0.1, "tol": 1e-9} | given)


def whats(run: fu.Run) -> list[str]:
    return [event["what"] for event in run.report["events"]]


def times(run: fu.Run) -> list[float]:
    return [event["time"] for event in run.report["events"]]


# ---- in the plane of the groove

def test_a_pendulum_in_space_keeps_the_bars_of_the_peg():
    case = next(case for case in CASES if case.key == "peg")
    found = peg_of_the_case(element="cable12")
    assert len(found) == 11
    for quantity, reference in zip(case.quantities, case.reference(), strict=True):
        assert found[quantity.name] == pytest.approx(reference, abs=quantity.bar), quantity.name


def test_a_planar_pendulum_and_its_spatial_twins():
    """One in the same axes, and one that is turned."""
    plane, space, turned = (run_of(scene, 4.5, tol=1e-10) for scene in (
        pendulum(element="cable8p"), pendulum(), turned_scene(pendulum(), *ASKEW)))
    assert whats(plane) == whats(space) == whats(turned) == ["returned", LEFT] * 2
    for twin, bound in ((space, 1e-9), (turned, 1e-8)):
        assert times(twin) == pytest.approx(times(plane), abs=bound)
        assert twin["peg.wrap_angle"] == pytest.approx(plane["peg.wrap_angle"], abs=1e-8)
        assert twin["peg.material_speed"] == pytest.approx(plane["peg.material_speed"], abs=1e-6)
        assert twin["peg.tension_off"] == pytest.approx(plane["peg.tension_off"], abs=1e-4)
    for name in ("load.position", "rope.position", "rope.s"):
        assert space[name] == pytest.approx(plane[name], abs=1e-9)
    distance = [np.linalg.norm(run["load.position"] - run["rope.position"][0, 0], axis=1) for run in (plane, turned)]
    assert distance[1] == pytest.approx(distance[0], abs=1e-9)


def over_two(element: str, aside: float = 0.0) -> fu.Scene:
    """Return the pendulum over two pegs; in space their axes are askew if it swings aside."""
    axes = ((0, 0, 1), (0, 0, 1)) if not aside else ((0, 0.1, 1), (0.1, -0.1, 1))
    one, other = ({} if element == "cable8p" else {"axis": axis} for axis in axes)
    route = [fu.Anchor(at=(0, 0, 0)), fu.Sheave("one", at=(0.2, -0.7, 0), radius=0.1, side="left", **WIDE, **one),
             fu.Sheave("other", at=(0.42, -1.2, 0), radius=0.08, side="left", **WIDE, **other), fu.Anchor("load")]
    scene = fu.Scene(gravity=(0, -GRAVITY, 0))
    scene.rigid_body("load", mass=1.0, inertia=(1, 1, 1), position=tuple(START), velocity=(0, 0, aside))
    with pytest.warns(fu.FunicularWarning, match="the rope passes it without touching it as drawn"):
        scene.rope("rope", tension=TENSION, route=route, **SOFT | {"element": element})
    return scene


def test_two_pegs():
    """A part leads from one to the other while the rope touches both; in the plane, and with axes askew."""
    plane, space, askew = (run_of(over_two(*given), 3.5) for given in (("cable8p",), ("cable12",), ("cable12", 0.05)))
    assert whats(plane) == whats(space) == ["returned", "returned", LEFT, LEFT, "returned"]
    for name in ("load.position", "rope.position", "one.material_speed", "other.material_speed"):
        assert space[name] == pytest.approx(plane[name], abs=1e-9), name
    assert whats(askew) == [ASIDE, ASIDE, LEFT, "moved along the groove", LEFT, ASIDE]
    assert np.abs(askew.energy_balance().relative).max() < 1e-8


def belt(element: str, aside: float = 0.0) -> fu.Scene:
    """Return a belt over two pulleys that hold it, into which a free peg flies, as drawn beside it."""
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.rigid_body("ram", mass=2.0, inertia=(1, 1, 1), position=(0.5, -0.5, aside), velocity=(0, 1.0, 0))
    pulley = {"radius": 0.1, "side": "left", "friction": 0.5}
    scene.rope("belt", closed=True, tension=300.0, **SOFT | {"element": element}, route=[
        fu.Sheave("driver", at=(0, 0, 0), velocity=2.0, **pulley),
        fu.Sheave("peg", at="ram", radius=0.1, side="right", **WIDE),
        fu.Sheave("driven", at=(1, 0, 0), inertia=0.1, **pulley)])
    return scene


def test_a_peg_strikes_a_belt():
    """It is thrown back; its gap as drawn is .3 m, at 1 m/s."""
    plane, space, beside = (run_of(belt(*given), 0.9) for given in (("cable8p",), ("cable12",), ("cable12", 0.01)))
    assert whats(plane) == whats(space) == ["returned", LEFT] and whats(beside) == [ASIDE, LEFT]
    assert times(space)[0] == pytest.approx(0.3, abs=1e-9)
    for name in ("ram.position", "driven.angle", "belt.position", "belt.s", "peg.wrap_angle", "peg.material_speed"):
        assert space[name] == pytest.approx(plane[name], abs=1e-9), name
    assert plane["ram.velocity"][-1, 1] == pytest.approx(-1, abs=0.02)
    assert np.abs(beside.energy_balance().relative).max() < 1e-6


@pytest.mark.parametrize("integrator", ["radau", "genalpha"])
def test_a_peg_beside_a_sheave_on_which_the_rope_slips(integrator):
    """The wraps of both are in the ratio of the tensions, as in the plane."""
    runs = []
    for element in ("cable8p", "cable12"):
        scene = fu.Scene(gravity=(0, -GRAVITY, 0))
        weight(scene, "counterweight", 1.0, -0.4, -1.0)
        weight(scene, "load", 1.5, 0.35, -1.6)
        scene.rope("rope", tension=10.0, **SOFT | {"element": element}, route=[
            fu.Anchor("counterweight"), fu.Sheave("top", at=(-0.2, 0, 0), radius=0.2, side="right", friction=0.05),
            fu.Sheave("peg", at=tuple(PEG), radius=RADIUS, side="left"), fu.Anchor("load")])
        runs.append(run_of(scene, 1.0, integrator, tol=1e-9 if integrator == "radau" else 1e-7))
    plane, space = runs
    assert whats(plane) == whats(space) and whats(space) == ["slips", LEFT]
    assert space["load.position"] == pytest.approx(plane["load.position"], abs=1e-8)
    assert space["top.slip"] == pytest.approx(plane["top.slip"], abs=1e-6)
    assert np.abs(plane["top.slip"]).max() > 1


# ---- beside the plane of the groove

def geodesic(place: np.ndarray) -> tuple[float, float, float, float]:
    """Return of a taut string from a groove to a place (from its centre) length, angle of the place, angle from there
    to the foot, and distance of the foot from the axis: the closed form.
    """
    x, y, z = place
    square = x * x + y * y
    rho = np.sqrt((square + RADIUS**2 - np.sqrt((square - RADIUS**2)**2 - 4 * (RADIUS * z)**2)) / 2)
    return np.sqrt(square - rho**2 + z * z), np.arctan2(y, x), np.arccos(rho / np.sqrt(square)), rho


def around(place: np.ndarray, peg: np.ndarray, aside: float) -> tuple[float, np.ndarray, float, float]:
    """Return length, direction at the load, wrap and kink along the axis of a rope over the peg, at a place aside."""
    on, off = -peg - [0, 0, aside], place - peg - [0, 0, aside]
    (one, a, b, _), (other, c, d, rho) = geodesic(on), geodesic(off)
    wrap = np.remainder(c - d - a - b + np.pi, 2 * np.pi) - np.pi
    u = (off - [rho * np.cos(c - d), rho * np.sin(c - d), 0]) / other
    return one + RADIUS * wrap + other, u, wrap, np.arcsin(u[2]) + np.arcsin(on[2] / one)


def straight(place: np.ndarray, peg: np.ndarray) -> tuple[float, np.ndarray, float, float]:
    """Return length and direction of a straight rope, by how much it cuts the peg, and its place there."""
    length = np.linalg.norm(place)
    u = place / length
    cosine = np.hypot(*u[:2])
    next_to = (peg[:2] @ u[:2]) / cosine**2 * u - peg
    return length, u, RADIUS / cosine - np.hypot(*next_to[:2]), next_to[2]


def of_its_own(aside: float, tau: float, duration: float, axes: np.ndarray = SQUARE
               ) -> tuple[Callable[[float], np.ndarray], list[dict]]:
    """Return the place of the load by time, and the events, by equations of motion of an elastic string of its own:
    a straight line, and a geodesic over the peg, with the lengths in closed form; axes: of the groove, as columns, in
    which the motion is computed.
    """
    y, t, lies, parts, events = np.concatenate([START @ axes, [0, 0, aside] @ axes]), 0.0, None, [], []
    free, peg, gravity = 2 / (1 + TENSION / EA), PEG @ axes, [0, -GRAVITY, 0] @ axes

    def at(place: np.ndarray, lies: float | None) -> tuple[float, np.ndarray, float, float]:
        return straight(place, peg) if lies is None else around(place, peg, lies)

    while t < duration:
        def rates(t: float, y: np.ndarray, lies: float | None = lies) -> np.ndarray:
            length, u, _, _ = at(y[:3], lies)
            tension = EA * (length - free + tau * (u @ y[3:])) / free
            return np.concatenate([y[3:], -max(tension, 0.0) * u + gravity])

        def changes(t: float, y: np.ndarray, lies: float | None = lies) -> float:
            return at(y[:3], lies)[2] * (1 if lies is None else -1)

        changes.terminal, changes.direction = True, 1
        part = solve_ivp(rates, (t, duration), y, "DOP853", rtol=1e-12, atol=1e-13, events=changes, dense_output=True)
        parts.append(part)
        t, y = part.t[-1], part.y[:, -1]
        if part.status != 1:
            break
        before, after = at(y[:3], lies), straight(y[:3], peg)
        events.append({"time": t, "aside": after[3], "kink": before[3], "lost": EA / (2 * free) * (
            (before[0] - free)**2 - (after[0] - free)**2)})
        lies = after[3] if lies is None else None
    return lambda t: axes @ next(part.sol(t)[:3] for part in parts if t <= part.t[-1] + 1e-12), events


@pytest.mark.parametrize("aside", [0.02, 0.08])
def test_a_pendulum_beside_the_plane_of_the_groove_against_equations_of_its_own(aside):
    """Where the rope returns 4 and 15 mm beside the middle, and leaves with kinks of .009 and .037 rad."""
    run = run_of(pendulum(aside, **WIDE), 4.5)
    place, events = of_its_own(aside, TAU, 4.5)
    assert whats(run) == [ASIDE, LEFT] * 2
    assert times(run) == pytest.approx([event["time"] for event in events], abs=1e-7)
    assert run["load.position"] == pytest.approx(np.array([place(t) for t in run.time]), abs=5e-9)
    assert abs(events[0]["aside"]) > 0.18 * aside and abs(events[1]["kink"]) > 0.45 * aside
    on = run["peg.wrap_angle"] > 0
    assert np.abs(run["peg.fleet_angle_off"][on]).min() > 1e-4 and not run["peg.fleet_angle_off"][~on].any()
    first = on & (run.time < times(run)[1])
    wrap = run["rope.position"][first][:, 5]  # the first part has five points
    assert wrap[:, 2] == pytest.approx(events[0]["aside"], abs=1e-9)


def test_a_peg_whose_axis_is_askew_against_equations_of_its_own():
    """The straight rope meets it at a fleet angle of .06 rad, where R/cos f is R and .2 mm."""
    axis = np.array([-0.1, 0.05, 1.0]) / np.linalg.norm([-0.1, 0.05, 1.0])
    x = np.cross([0, 1, 0], axis) / np.linalg.norm(np.cross([0, 1, 0], axis))
    run = run_of(pendulum(0.05, axis=tuple(axis), **WIDE), 1.9)
    place, events = of_its_own(0.05, TAU, 1.9, np.stack([x, np.cross(axis, x), axis], axis=1))
    assert whats(run) == [ASIDE, LEFT]
    assert times(run) == pytest.approx([event["time"] for event in events], abs=1e-7)
    assert run["load.position"] == pytest.approx(np.array([place(t) for t in run.time]), abs=5e-9)
    on = run["peg.wrap_angle"] > 0
    assert np.abs(run["peg.fleet_angle_on"][on]).max() > 0.05


def test_a_kink_loses_the_energy_of_the_length_that_the_rope_loses():
    """Without damping nothing else is lost."""
    run = run_of(pendulum(0.08, tau=0.0, **WIDE), 2.0, output_step=0.01)
    _, events = of_its_own(0.08, 0.0, 2.0)
    lost = run["energy.dissipated"]
    assert events[1]["lost"] > 1e-3
    assert lost[-1] == pytest.approx(events[1]["lost"], rel=1e-3)  # vibrations along the rope differ by steps
    assert not lost[run.time < times(run)[1]].any()
    assert np.abs(run.energy_balance().relative).max() < 1e-8


def test_a_kink_after_which_the_rope_is_slack():
    """A stiff rope loses more length than its stretch; the load flies until it is taut again."""
    given = rope_of(1e7, 1e-5, 0, TAU) | {"mass": False, "element": "cable12"}
    run = run_of(pendulum(0.08, **WIDE).replace("rope", **given), 2.0, tol=1e-7)
    assert whats(run) == [ASIDE, LEFT, "taut again"]
    assert np.abs(run.energy_balance().relative).max() < 1e-6
    assert 5e-3 < np.diff(times(run))[1] < 1e-2


@pytest.mark.parametrize("rho", [1e-3, *(pytest.param(rho, marks=pytest.mark.slow) for rho in (1e-4, 1e-5))])
def test_a_rope_of_little_mass_tends_to_none(rho):
    """In proportion to its mass, until waves from the kink with which it leaves are part of the difference."""
    light = rope_of(2e4, rho, 0, 5e-3) | {"elements": 1, "mass": True}
    scene = pendulum(0.05, **WIDE)
    without = run_of(scene.replace("rope", **rope_of(2e4, 1e-5, 0, 5e-3)), 2.4)
    beside = fu.Sheave("peg", at=tuple(PEG), radius=RADIUS, side="left", contact=False, **WIDE)
    given = {"route": [fu.Anchor(at=(0, 0, 0)), beside, fu.Anchor("load")], **light}
    run = run_of(scene.replace("rope", **given), 2.4, tol=1e-5)
    assert whats(run) == ["touched the sheave", LEFT] and whats(without) == [ASIDE, LEFT]
    error = np.abs(run["load.position"] - without["load.position"]).max(axis=1)
    assert error[:18].max() < 0.5 * rho  # until it leaves
    assert error.max() < 2 * rho + 2e-5


@pytest.mark.parametrize("integrator", ["genalpha", "explicit"])
def test_integrators_agree(integrator):
    scene = pendulum(0.08, **WIDE)
    one, other = (run_of(scene, 2.0, each, tol=1e-7) for each in ("radau", integrator))
    assert whats(one) == whats(other) == [ASIDE, LEFT]
    assert times(other) == pytest.approx(times(one), abs=1e-5)
    assert other["load.position"] == pytest.approx(one["load.position"], abs=5e-6)
    assert np.abs(other.energy_balance().relative).max() < 1e-5


def test_a_turned_scene_gives_the_same():
    scene = pendulum(0.08, **WIDE)
    one, other = (run_of(each, 2.0, tol=1e-10) for each in (scene, turned_scene(scene, *ASKEW)))
    assert whats(one) == whats(other) == [ASIDE, LEFT]
    for name in ("peg.wrap_angle", "peg.fleet_angle_on", "peg.fleet_angle_off", "rope.s"):
        assert other[name] == pytest.approx(one[name], abs=1e-9), name


def struck(**sheave) -> fu.Scene:
    """Return a free body that spins, with a peg that strikes a rope between two free weights, which a spring pushes
    apart.
    """
    scene = fu.Scene(gravity=(0, 0, 0))
    for name, x in (("one", -1.0), ("other", 1.0)):
        scene.rigid_body(name, mass=1.0, inertia=(1, 1, 1), position=(x, 0, 0), velocity=(0, 0, 0.05 * x))
    scene.spring("one", "other", stiffness=20, length=7.0)
    scene.rigid_body("ram", mass=2.0, inertia=(0.3, 0.4, 0.35), position=(0.02, -0.5, 0.003), velocity=(0, 2.0, 0),
                     angular_velocity=(0.1, 0.15, 0.2))
    scene.rope("rope", tension=100.0, **rope_of(1e4, 1e-5, 0, 5e-3) | {"mass": False, "element": "cable12"}, route=[
        fu.Anchor("one"), fu.Sheave("peg", at=("ram", (0, 0.1, 0)), radius=0.1, side="right", **sheave),
        fu.Anchor("other")])
    return scene


def test_a_peg_on_a_body_that_spins_keeps_momenta():
    """Over both events, with a wrap beside the middle of a groove that tilts."""
    run = run_of(struck(**WIDE), 0.6, output_step=0.05)
    assert whats(run) == [ASIDE, LEFT]
    found = momenta(run)
    assert np.abs(found[0]).max() > 3
    assert np.abs(found - found[0]).max() < 1e-10
    assert np.ptp(run["peg.fleet_angle_off"]) > 0.06
    assert np.abs(run.energy_balance().relative).max() < 1e-8


def thrown(along: float, **sheave) -> fu.Scene:
    """Return a load that a velocity, in part along the axis, lifts off a sheave against which a rope is drawn."""
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.rigid_body("load", mass=1.5, inertia=(1, 1, 1), position=(1.0, -0.05, 0), velocity=(0, 1.0, along))
    scene.rope("hoist", tension=30.0, **SOFT, route=[
        fu.Anchor(at=(-0.3, 0, 0)), fu.Sheave("top", at=(0, -0.2, 0), radius=0.2, side="right", **sheave),
        fu.Anchor("load")])
    scene.force("load", value=(30, 0, 0))
    return scene


def test_a_rope_whose_straight_line_is_still_in_the_groove_moves_along_it():
    """By R f²/2 the line between both feet is deeper than they are; each move leaves a smaller kink."""
    run = run_of(thrown(2.0, groove_width=0.5, max_fleet_angle=0.5), 0.1, output_step=1e-3)
    assert set(whats(run)[:-2]) == {"moved along the groove"} and whats(run)[-2:] == [LEFT, "taut again"]
    assert np.abs(run.energy_balance().relative).max() < 1e-6
    on = run["top.wrap_angle"] > 0
    moved = on & (run.time > times(run)[0])
    kink = np.abs(run["top.fleet_angle_on"] + run["top.fleet_angle_off"])
    assert kink[on & ~moved].max() > 0.09 and moved.any() and kink[moved].max() < 0.01
    assert np.diff(run["energy.dissipated"]).min() > -1e-9


def test_the_speed_of_a_rope_that_passes_a_sheave():
    """That of the material next to the centre, beside its groove, while a drum hauls the rope in."""
    winch = fu.Drum("winch", at=(0, 0, 0.1), radius=0.05, side="right", length_in_store=1.0, max_fleet_angle=0.3,
                    velocity=fu.Ramp(start=0, end=0.1, after=2.0))
    run = run_of(pendulum(0.3, first=winch), 0.2, output_step=5e-4)
    assert whats(run) == [] and not run["peg.wrap_angle"].any()
    s = run["rope.s"][:, 4]  # where the first of two parts ends
    passing = np.gradient(s, run.time)
    assert np.abs(run["peg.material_speed"] + passing)[2:-2].max() < 1e-5
    assert np.abs(run["peg.material_speed"]).max() > 0.5
    centre, (before, at, after) = PEG, (run["rope.position"][:, k] for k in (3, 4, -2))
    across = np.einsum("td,td->t", at - centre, after - before)
    assert np.abs(across).max() < 1e-12


# ---- rest

def leaning(side: str, aside: float = 0.0, start: float = 0.0, element: str = "cable12") -> fu.Scene:
    """Return a load drawn aside of a peg that is beside the line to its place at rest."""
    scene = fu.Scene(gravity=(0, -GRAVITY, 0))
    scene.rigid_body("load", mass=5.0, inertia=(1, 1, 1), position=(-1, -2, aside))
    peg = fu.Sheave("peg", at=(0.05, -1, 0), radius=0.1, side=side, max_fleet_angle=0.5)
    scene.rope("rope", tension=49.0, **SOFT | {"element": element}, route=[
        fu.Anchor(at=(start, 0, aside)), peg, fu.Anchor("load")])
    return scene


def test_rest_finds_that_a_rope_touches_a_peg():
    """As in the plane; the run from there stays at rest."""
    plane, space = (leaning("left", element=element).equilibrium() for element in ("cable8p", "cable12"))
    assert plane["peg.wrap_angle"] > 0.05
    for name in ("load.position", "peg.wrap_angle", "rope.position"):
        assert space[name] == pytest.approx(plane[name], abs=1e-9)
    run = leaning("left").run(0.3, output_step=0.1, initial=space, **BRIEF)
    assert run["load.position"] == pytest.approx(np.tile(space["load.position"], (4, 1)), abs=1e-9)


def test_rest_finds_that_a_rope_leaves_a_peg():
    """The load hangs straight down from its anchor, beside the peg that its rope lies on as drawn."""
    rest = leaning("right", 0.05, 0.3).equilibrium()
    assert rest["load.position"][[0, 2]] == pytest.approx([0.3, 0.05], abs=1e-8)
    assert rest["peg.wrap_angle"] == 0 and not rest["peg.force"].any()


def test_a_rest_beside_the_middle_of_a_groove_is_refused():
    with pytest.raises(fu.EquilibriumError, match='the rope comes onto sheave "peg" beside the middle of its'):
        leaning("left", 0.005).equilibrium()


# ---- files, and states of other runs

@pytest.mark.parametrize("integrator", ["genalpha", "radau", "explicit"])
@pytest.mark.parametrize("rows", [10, 25])
def test_resumed_bit_for_bit(tmp_path, integrator, rows):
    """The place in the groove is a part of the state."""
    def scene() -> fu.Scene:
        winch = fu.Drum("winch", at=(0, 0, 0), radius=0.01, side="right", length_in_store=1.0, velocity=0.1)
        return pendulum(0.05, first=winch, **WIDE)

    settings = {"duration": 2.0, "output_step": 0.05, "tol": 1e-5, "integrator": integrator}
    kill(scene(), tmp_path / "run.nc", rows, **settings, progress=False)
    resumed = scene().run(**settings, save=tmp_path / "run.nc", resume=True, progress=False)
    whole = scene().run(**settings, progress=False)
    assert whats(whole) == [ASIDE, LEFT]
    assert all(np.array_equal(whole[name], resumed[name]) for name in whole)


def test_files_and_pictures(tmp_path):
    """The results of a file, of a scene of a file, and the rope in a picture, which is on the peg where that is."""
    scene = pendulum(0.08, **WIDE)
    run = scene.run(1.0, output_step=0.1, **BRIEF)
    run.save(tmp_path / "run.nc")
    copy = fu.Scene.from_toml(scene.to_toml())
    for other in (fu.load_run(tmp_path / "run.nc"), copy.run(1.0, output_step=0.1, **BRIEF)):
        assert all(np.array_equal(run[name], other[name]) for name in run)
    assert run["peg.wrap_angle"][-1] > 0.1
    places = run["rope.position"][-1]
    on = np.hypot(*(places[5:-5] - PEG)[:, :2].T)
    assert on == pytest.approx(RADIUS, abs=1e-9) and np.ptp(places[5:-5, 2]) < 1e-12 < np.abs(places[5, 2])
    drawn = run.animation("a run").clips[0].cables[0].position[-1]
    lying = np.abs(np.hypot(*(drawn - PEG)[:, :2].T) - RADIUS) < 1e-9
    assert lying.sum() > 3 and np.abs(drawn[lying, 2] - places[5, 2]).max() < 1e-9


def test_a_run_from_a_state_of_another():
    """A straight rope goes on; where the rope lay in a groove is no part of a state."""
    scene = pendulum(0.05, **WIDE)
    run = run_of(scene, 2.0)
    later = run_of(scene, 0.1, initial=run.at(1.9))
    assert later["load.position"][-1] == pytest.approx(run["load.position"][-1], abs=1e-8)
    with refused('initial: a rope without mass lay on sheave "peg" beside the middle of its groove, and a state does '
                 "not tell where; continue that run by save and resume=True"):
        run_of(scene, 0.1, initial=run.at(1.0))


def test_a_start_within_a_groove_beside_its_middle_is_refused():
    scene = pendulum(**WIDE)
    with pytest.raises(fu.RopeLeftError, match='without mass is on sheave "peg" at the start, beside the middle'):
        run_of(scene, 0.1, initial={"load.position": (0.5, -1.93, 0.05)})
    middle = run_of(scene, 0.01, output_step=0.01, initial={"load.position": (0.5, -1.93, 0)})
    assert middle["peg.wrap_angle"][0] > 0.05


# ---- how runs end

def test_a_rope_that_returns_beside_the_groove():
    """At 19 mm from the middle it passes beside a groove of 20 mm, and falls into one of 60 mm."""
    with pytest.raises(fu.RopeLeftError, match='returns to sheave "peg" and passes beside its groove, by more than'):
        run_of(pendulum(0.1), 1.0)
    assert whats(run_of(pendulum(0.1, groove_width=0.06), 1.0)) == [ASIDE]


def test_a_rope_that_leaves_with_a_kink_above_the_limit():
    with pytest.raises(fu.RopeLeftError, match='leaves the groove of sheave "peg" along its axis, with a kink above'):
        run_of(pendulum(0.1, groove_width=0.06, max_fleet_angle=0.04), 2.0)
    assert whats(run_of(pendulum(0.1, groove_width=0.06, max_fleet_angle=0.05), 2.0)) == [ASIDE, LEFT]


def test_a_rope_that_leaves_a_sheave_with_friction():
    with pytest.raises(fu.RopeLeftError, match='a rope leaves sheave "top", as its wrap angle reaches 0 rad'):
        run_of(thrown(0.1, friction=0.3), 0.2)


def test_a_sheave_is_met_from_its_other_side():
    """A rope that a drum has paid out meets a peg from behind as it swings back."""
    scene = fu.Scene(gravity=(0, -GRAVITY, 0))
    weight(scene, "load", 1.0, 0.1 - 0.9 * np.sin(0.7), -0.9 * np.cos(0.7))
    pays = fu.TableSignal(time=[0, 0.6, 0.7, 1.4, 1.5, 9], value=[0, 0, -12, -12, 0, 0], interpolation="linear")
    winch = fu.Drum("winch", at=(0, 0, 0), radius=0.1, side="right", length_in_store=4, velocity=pays)
    scene.rope("rope", tension=5.0, **SOFT, route=[
        winch, fu.Sheave("peg", at=(0.3, -1.1, 0), radius=0.1, side="left"), fu.Anchor("load")])
    with pytest.raises(fu.RopeLeftError, match='meets sheave "peg" from its other side'):
        run_of(scene, 4.0, tol=1e-6)
