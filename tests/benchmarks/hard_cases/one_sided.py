"""One-sided springs, and a cable without stiffness in compression: sudden slack, chatter, free play."""


import numpy as np
from funicular import Circle, Material, Scene, TableSignal

from .case import BALANCE, Subject, compared

HERE = Subject()


def droppers() -> Scene:
    """A wire under nine tension-only droppers is lifted as a whole and released: all become slack at once, and taut
    again.
    """
    scene = Scene()
    wire = scene.cable("wire", start=(0, 0, 0), end=(20, 0, 0), elements=20, element="cable12", strain="engineering",
                       section=Circle(radius=6e-3), rest_length=20 / (1 + 7e-4),
                       material=Material(youngs_modulus=1e11, poisson_ratio=0.3, density=8900, damping_time=1e-4))
    length = wire.rest_length
    for s in (0.0, length):
        scene.pin(wire, s=s)
    for k in range(1, 10):
        scene.spring((2 * k, 1.0, 0), (wire, k / 10 * length), name=f"dropper_{k}", stiffness=1e4, damping=5.0,
                     length=0.99, tension_only=True)
    lift = TableSignal(time=[0, 0.1, 0.2, 0.3], value=[0, 1, 1, 0], interpolation="cubic")
    scene.distributed_force(wire, start=0.0, stop=length, value=(0, 40.0, 0), scale=lift)
    return scene


def chatter() -> Scene:
    """10 g bounce on a tension-only spring of 100 kN/m: flights of 40 ms at first, and ever shorter ones."""
    scene = Scene()
    scene.rigid_body("m", mass=0.01, inertia=(1e-6,) * 3, position=(0, -1, 0), velocity=(0, -0.2, 0))
    scene.spring((0, 0, 0), "m", name="wire", stiffness=1e5, damping=3.0, length=1.0, tension_only=True)
    return scene


def free_play() -> Scene:
    """1 g rattles between a body of 10 kg on a spring, and one of 20 kg, with a free play of 2 mm to each."""
    scene = Scene(gravity=(0, 0, 0))
    scene.rigid_body("A", mass=10.0, inertia=(1,) * 3, position=(0, 0, 0))
    scene.rigid_body("m", mass=1e-3, inertia=(1e-7,) * 3, position=(0.1, 0, 0), velocity=(0.5, 0, 0))
    scene.rigid_body("B", mass=20.0, inertia=(1,) * 3, position=(0.2, 0, 0), velocity=(0.02, 0, 0))
    scene.spring((-1, 0, 0), "A", stiffness=2e3, length=0.99, name="support")
    for a, b in (("A", "m"), ("m", "B")):
        scene.spring(a, b, name=f"{a}{b}", stiffness=1e4, damping=0.05, length=0.1, free_play=2e-3)
    return scene


def thrown() -> Scene:
    """A rope of 1 m with nearly no stiffness in compression, taut between supports, is thrown up, and one support
    approaches: it flies slack, and snaps taut.
    """
    scene = Scene()
    rope = scene.cable("rope", start=(0, 0, 0), end=(1, 0, 0), elements=8, element="cable12", membrane="tension_only",
                       section=Circle(radius=6e-3), rest_length=1 / 1.001,
                       material=Material(youngs_modulus=2e8, poisson_ratio=0.3, density=872, damping_time=1e-4))
    scene.pin(rope, s=0.0)
    nearer = TableSignal(time=[0, 0.1, 0.25, 0.35], value=[0, -0.1, -0.1, 0.0], interpolation="cubic")
    scene.motion(rope, s=rope.length, displacement=(nearer, 0, 0))
    throw = TableSignal(time=[0, 0.05, 0.1], value=[0, 1, 0], interpolation="cubic")
    scene.distributed_force(rope, start=0.0, stop=rope.length, value=(0, 4.0, 0), scale=throw)
    return scene


SCENES = {"droppers": (droppers, 0.8), "chatter": (chatter, 0.25), "free play": (free_play, 0.3),
          "thrown": (thrown, 0.4)}


def with_events(name: str, integrator: str) -> tuple:
    """A run with the default tolerance and its figures, with the number of events."""
    run, found = compared(*SCENES[name], integrator)
    return run, found | {"events": len(run.events)}


@HERE.case("all droppers slack at once, and taut again", error=5e-4, balance=BALANCE, all_slack=(1, 1), taut=(9, 9))
def slack_at_once(integrator):
    """`all_slack`: whether all are slack at some time; `taut`: the largest number that pull at one time afterwards."""
    run, found = with_events("droppers", integrator)
    tension = np.array([run[f"dropper_{k}.tension"] for k in range(1, 10)])
    slack = (tension == 0.0).all(axis=0)
    later = tension[:, int(np.argmax(slack)):] > 0.0
    return found | {"all_slack": float(slack.any()), "taut": float(later.sum(axis=0).max())}


@HERE.case("10 g chatter on a stiff spring that pulls alone", error=1e-3, balance=BALANCE, pushes=0.0,
           events=(30, 50))
def chattering(integrator):
    """`pushes`: the largest force with which the spring pushes, N."""
    run, found = with_events("chatter", integrator)
    return found | {"pushes": float(-run["wire.tension"].min())}


@HERE.case("1 g rattles in a free play", error=5e-4, balance=BALANCE, events=(50, 60))
def rattling(integrator):
    return with_events("free play", integrator)[1]


@HERE.case("a rope that bears no compression is thrown slack", error=1e-3, balance=BALANCE, slack=(8, 8),
           events=(2, 20))
def thrown_slack(integrator):
    """`slack`: the largest number of slack elements, of 8."""
    run, found = with_events("thrown", integrator)
    return found | {"slack": float(run.slack_elements("rope").sum("element").max())}
