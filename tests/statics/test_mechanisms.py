"""Mechanisms: published benchmarks, over-constrained loops, initial gaps."""

import numpy as np
import pytest
from funicular import Circle, FunicularWarning, Material, Scene, SceneError
from numpy.testing import assert_allclose

Z = (0, 0, 1)
G = 9.81


def turned(angle):
    return np.cos(angle / 2), 0, 0, np.sin(angle / 2)


# ---- T1: seven bodies in the plane, ten hinges, one degree of freedom


SQUEEZER = (-0.0617138900142764496, 0.0, 0.455279819163070380, 0.222668390165885885, 0.487364979543842550,
            -0.222668390165885885, 1.23054744454982119)
"""Consistent angles at the start: beta, Theta, gamma, Phi, delta, Omega, epsilon."""

SQUEEZED = (15.81077119629904, -15.75637105984298, 0.04082224013073101, -0.5347301163226948, 0.5244099658805304,
            0.5347301163226948, 1.048080741042263)


def squeezer() -> Scene:
    """Andrews' squeezer; Schiehlen 1990, Hairer & Wanner 1996 VII.7, IVP test set (Mazzia & Magherini 2008)."""
    beta, theta, gamma, phi, delta, omega, epsilon = SQUEEZER

    def point(origin, angle, at):
        c, s = np.cos(angle), np.sin(angle)
        return origin + np.array([c * at[0] - s * at[1], s * at[0] + c * at[1], 0])

    O, A, B, C = (0, 0, 0), (-0.06934, -0.00227, 0), (-0.03635, 0.03273, 0), (0.014, 0.072, 0)
    bodies = {  # mass, moment of inertia, origin and angle of its axes, centre of mass in them
        "K1": (0.04325, 2.194e-6, O, beta, (0.00092, 0)),
        "K2": (0.00365, 4.410e-7, point(O, beta, (0.007, 0)), beta + theta, (-0.0115, 0)),
        "K3": (0.02373, 5.255e-6, B, gamma, (0.01043, -0.01874)),
        "K4": (0.00706, 5.667e-7, point(A, delta, (0.04, 0)), phi + delta, (0, 0.01421 - 0.02)),
        "K5": (0.07050, 1.169e-5, A, delta, (0.02308, 0.00916)),
        "K6": (0.00706, 5.667e-7, point(A, epsilon, (0, -0.04)), omega + epsilon, (0.02 - 0.01421, 0)),
        "K7": (0.05498, 1.912e-5, A, epsilon, (-0.00449, -0.01228))}

    def on(name, x, y):
        return name, (x - bodies[name][4][0], y - bodies[name][4][1], 0)

    scene, crank_end = Scene(gravity=(0, 0, 0)), on("K2", -0.028, 0)
    for name, (mass, inertia, origin, angle, centre) in bodies.items():
        scene.rigid_body(name, mass=mass, inertia=(inertia / 2, inertia / 2, inertia),
                         position=point(origin, angle, centre), orientation=turned(angle))
    for a, b in ((O, on("K1", 0, 0)), (on("K1", 0.007, 0), on("K2", 0, 0)), (crank_end, on("K3", 0, -0.035)),
                 (crank_end, on("K4", 0, -0.02)), (crank_end, on("K6", 0.02, 0)), (B, on("K3", 0, 0)),
                 (A, on("K5", 0, 0)), (A, on("K7", 0, 0)), (on("K5", 0.04, 0), on("K4", 0, 0)),
                 (on("K7", 0, -0.04), on("K6", 0, 0))):
        scene.joint("revolute", a, b, axis=Z)
    scene.spring(on("K3", 0.02, -0.018), C, stiffness=4530, length=0.07785)
    scene.moment("K1", value=(0, 0, 0.033))
    return scene


@pytest.mark.parametrize(("integrator", "tol", "off"), [("explicit", 1e-5, 3e-9), ("radau", 1e-6, 1e-8)])
def test_andrews_squeezer(integrator, tol, off, validated):
    """The crank makes 2.5 turns in 30 ms."""
    run = squeezer().run(0.03, tol=tol, integrator=integrator, output_step=1e-4)
    turn = [np.unwrap(2 * np.arctan2(run[f"K{k}.orientation"][:, 3], run[f"K{k}.orientation"][:, 0]),
                      period=2 * np.pi)[-1] for k in range(1, 8)]
    beta, to_crank, gamma, to_5, delta, to_7, epsilon = turn
    found = [beta, to_crank - beta, gamma, to_5 - delta, delta, to_7 - epsilon, epsilon]
    validated("Bodies and mechanisms", "Andrews' squeezer, at 30 ms", "seven angles", SQUEEZED, found, unit="rad",
              scale=1.0, bound=off, source="IVP test set", variant=f"{integrator}, tol {tol:g}")
    assert max(run[f"{name}.residual"].max() for name in run.scene.joints) < 1e-11
    assert len(run.report["messages"]) == 3  # in space, each of three loops has three equations too many


# ---- T2: four-bars that pass positions where all bars lie on one line


def four_bars(n: int, speed=1.0, angle=np.pi / 2) -> Scene:
    """Return n parallelograms of bars of 1 m and 1 kg side by side; speed (m/s) of their upper side."""
    scene, inertia = Scene(), (1e-3, 1 / 12, 1 / 12)
    along = np.array([np.cos(angle), np.sin(angle), 0])
    velocity = speed * np.array([along[1], -along[0], 0])
    step = np.array([1, 0, 0])
    for k in range(n + 1):
        scene.rigid_body(f"leg{k}", mass=1, inertia=inertia, position=along / 2 + k * step, orientation=turned(angle),
                         velocity=velocity / 2, angular_velocity=(0, 0, -speed))
        scene.joint("revolute", (k, 0, 0), (f"leg{k}", (-0.5, 0, 0)), axis=Z, name=f"foot{k}")
    for k in range(n):
        scene.rigid_body(f"bar{k}", mass=1, inertia=inertia, position=along + (k + 0.5) * step, velocity=velocity)
        for side, at in (("left", -0.5), ("right", 0.5)):
            leg = f"leg{k + (side == 'right')}"
            scene.joint("revolute", (leg, (0.5, 0, 0)), (f"bar{k}", (at, 0, 0)), axis=Z, name=f"{side}{k}")
    return scene


@pytest.mark.parametrize(("integrator", "tol", "off"), [("explicit", 1e-7, 3e-7), ("radau", 1e-5, 1e-5)])
def test_two_four_bars_pass_singular_positions(integrator, tol, off, validated):
    """IFToMM benchmark A02; all bars are collinear several times in 10 s."""
    run = four_bars(2).run(10, tol=tol, integrator=integrator, output_step=0.1)
    validated("Bodies and mechanisms", "two four-bars through singular positions, at 10 s", "position of the coupler",
              [0.3284581115, 0.9445185382, 0], run["bar0.position"][-1] - [0.5, 0, 0], unit="m", scale=1.0, bound=off,
              source="IFToMM benchmark A02", variant=f"{integrator}, tol {tol:g}")
    assert np.sum(np.diff(np.sign(run["bar0.position"][:, 1])) != 0) >= 6
    energy = run["energy.kinetic"] + run["energy.potential"]
    assert np.ptp(energy) < 1e-5 * run["energy.kinetic"].max()
    assert max(run[f"{name}.residual"].max() for name in run.scene.joints) < 1e-9


# ---- T3


@pytest.mark.parametrize(("integrator", "tol", "off"), [("explicit", 1e-8, 3e-9), ("radau", 1e-6, 3e-7)])
def test_a_pendulum_after_10_s(integrator, tol, off, validated):
    """IFToMM benchmark A01: a point mass, 1 m from its pivot, released from the horizontal."""
    scene = Scene()
    scene.rigid_body("A", mass=1, inertia=(1, 1, 1), position=(-1, 0, 0))
    scene.joint("distance", "A", (0, 0, 0), name="string")
    run = scene.run(10, tol=tol, integrator=integrator, output_step=0.1)
    validated("Bodies and mechanisms", "pendulum released level, at 10 s", "position",
              [-0.2750874626, -0.9614192051, 0], run["A.position"][-1], unit="m", scale=1.0, bound=off,
              source="IFToMM benchmark A01", variant=f"{integrator}, tol {tol:g}")
    # string: its force on the ground is 3 m g sin, by energy and centripetal force
    pull = 3 * G * run["A.position"] * -run["A.position"][:, 1:2]
    assert_allclose(run["string.force"], pull, atol=1e-4)


# ---- over-constrained


def door(hinges=2, **given) -> Scene:
    scene = Scene()
    scene.rigid_body("door", mass=20.0, inertia=(5, 2, 7), position=(0.5, 0, 0), angular_velocity=(0, 1, 0),
                     velocity=(0, 0, -0.5))
    for k in range(hinges):
        at = (0, 0.8 * (-1) ** k, 0)
        scene.joint("revolute", at, ("door", (-0.5, at[1], 0)), axis=(0, 1, 0), name=f"hinge{k}", **given)
    return scene


@pytest.mark.parametrize("integrator", ["explicit", "radau", "genalpha"])
def test_a_door_on_two_hinges(integrator):
    run = door().run(1.0, integrator=integrator)
    assert run.report["messages"] == [
        'over-constrained: 5 of the 5 equations of joint "hinge1" follow from those of joint "hinge0" and are left '
        "out, without force or moment of their own"]
    assert np.abs(run["hinge1.force"]).max() == 0
    one = door(1).run(1.0, integrator=integrator)
    assert_allclose(run["door.position"], one["door.position"], atol=1e-12)
    assert_allclose(run["hinge0.moment"], one["hinge0.moment"], atol=1e-9)
    assert run["hinge1.residual"].max() < 1e-9


@pytest.mark.filterwarnings("ignore:joint")
def test_hinges_that_do_not_fit_together_are_refused():
    scene = door(1)
    scene.joint("revolute", (2e-4, -0.8, 0), ("door", (-0.5, -0.8, 0)), axis=(0, 1, 0), name="off")
    with pytest.raises(SceneError, match=r'"hinge0" and "off" constrain the same motion, but .*: 0.0002 \(m or'):
        scene.run(0.1)


def test_a_four_bar_in_space_moves_as_one_with_ball_joints():
    """A revolute, a spherical, a universal and a revolute joint: no redundant constraint."""
    over, free = four_bars(1), Scene()
    for body in over.bodies.values():
        free.add(body)
    axes = {"revolute": {"axis": Z}, "spherical": {}, "universal": {"axis": (1, 0, 0), "second_axis": Z}}
    for kind, joint in zip(("revolute", "spherical", "universal", "revolute"), over.joints.values(), strict=True):
        free.joint(kind, joint.a, joint.b, name=joint.name, **axes[kind])
    runs = [scene.run(1.0, tol=1e-8) for scene in (over, free)]
    assert (len(runs[0].report["messages"]), runs[1].report["messages"]) == (1, [])
    for name in ("bar0.position", "foot0.force", "foot1.force"):
        assert_allclose(runs[1][name], runs[0][name], atol=2e-6)


def test_what_drives_twice_is_refused():
    scene = door(1)
    scene.rigid_body("leaf", mass=1.0, inertia=(1, 1, 1), position=(1.5, 0, 0))
    scene.joint("revolute", ("door", (0.5, 0, 0)), ("leaf", (-0.5, 0, 0)), axis=(0, 1, 0), angle=0.0, name="fold")
    scene.joint("cylindrical", ("leaf", (0, 0, 0)), (1.5, 0, 0), axis=(0, 1, 0), angle=0.0, name="spin")
    with pytest.raises(SceneError, match=r'is over-constrained: joints .*"fold" and "spin" drive or constrain'):
        scene.run(0.1)


def test_a_joint_between_places_that_are_held_is_refused():
    scene = Scene()
    for name, y in (("a", 1.0), ("b", -1.0)):
        scene.cable(name, start=(0, 0, 0), end=(0, y, 0), elements=2, element="cable12", up=(0, 0, 1),
                    section=Circle(radius=0.01), material=Material(youngs_modulus=1e7, poisson_ratio=0, density=1e3))
        scene.pin(name, s=0.0)
    scene.joint("spherical", ("a", 0.0), ("b", 0.0), name="knot")
    with pytest.raises(SceneError, match=r'joint "knot" between points that supports fix already; leave that out'):
        scene.run(0.1)


def test_a_start_in_a_singular_position_is_refused():
    with pytest.raises(SceneError, match=r"scene: starts in a singular position: joints .*foot0.* same motion there"):
        four_bars(1, angle=0.0).run(0.1)
    four_bars(1, angle=1e-3).run(0.01)


# ---- gaps


@pytest.mark.parametrize("integrator", ["explicit", "genalpha"])
def test_a_small_gap_is_closed(integrator):
    scene = Scene()
    scene.rigid_body("A", mass=1.0, inertia=(1, 1, 1), position=(0, -1, 0))
    scene.rigid_body("B", mass=1.0, inertia=(1, 1, 1), position=(1, -1, 0))
    scene.joint("spherical", (0, 0, 0), ("A", (0, 1, 0)))
    with pytest.warns(FunicularWarning, match="its ends are 0.0005 m apart at the start"):
        scene.joint("weld", ("A", (0.5, 0, 0)), ("B", (-0.5, 0.0005, 0)), name="weld")
    run = scene.run(0.1, integrator=integrator)
    assert run["weld.residual"].max() < 1e-11
    note, = (note for note in run.report["messages"] if note.startswith("gaps"))
    assert note.startswith("gaps of joints were closed at the start: things moved by up to 0.000")
    assert 1e-4 < float(note.split()[-2]) < 5e-4
