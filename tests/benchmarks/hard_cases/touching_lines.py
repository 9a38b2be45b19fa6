"""Lines in contact: a light collector that chatters under a wire, a rope thrown on a rope."""


import numpy as np
from funicular import Circle, Material, Scene

from .case import Subject, balance, error, reference, simulate

HERE = Subject()
WIRE = Material(youngs_modulus=1e11, poisson_ratio=0.3, density=9000)
ROPE = Material(youngs_modulus=1e7, poisson_ratio=0.4, density=1000, damping_time=1e-4)
INTEGRATORS = "genalpha", "explicit", "radau"


def chatter() -> Scene:
    """A head of 20 g moves along a wire of 5 kN at 40 m/s, from 2 cm below it, under 30 N: it loses contact again and
    again.
    """
    scene = Scene(gravity=(0, 0, 0))
    scene.cable("wire", start=(0, 0, 0), end=(20, 0, 0), elements=20, element="cable8p", section=Circle(radius=5e-3),
                material=WIRE, rest_length=20 / (1 + 5e3 / (1e11 * np.pi * 25e-6)))
    scene.pin("wire", s=0.0)
    scene.pin("wire", s=scene.cables["wire"].length)
    scene.rigid_body("carriage", mass=100.0, inertia=(1, 1, 1), position=(4, -1, 0), velocity=(40, 0, 0))
    scene.rigid_body("head", mass=0.02, inertia=(1, 1, 1), position=(4, -0.025, 0), velocity=(40, 0, 0))
    scene.joint("prismatic", (4, -1, 0), "carriage", axis=(1, 0, 0), velocity=40)
    scene.joint("prismatic", "carriage", "head", axis=(0, 1, 0))
    scene.force("head", value=(0, 30, 0))
    scene.crossing("wire", "head", stiffness=2e5, damping=0.01, name="contact")
    return scene


def thrown() -> Scene:
    """A free rope falls across a slack one, with rotation, and slides off it."""
    scene = Scene()
    scene.cable("lower", start=(-0.5, 0, 0), end=(0.5, 0, 0), rest_length=1.05, shape="hanging", rest="straight",
                elements=8, element="cable12", section=Circle(radius=0.01), material=ROPE)
    scene.pin("lower", s=0.0)
    scene.pin("lower", s=1.05)
    scene.cable("upper", start=(0.1, 0.2, -0.6), end=(0.3, 0.2, 0.4), elements=6, element="cable12",
                section=Circle(radius=0.01), material=ROPE, velocity=(0, -1, 0.3), angular_velocity=(0, 2, 0))
    scene.crossing("upper", "lower", stiffness=2e4, damping=0.05, name="contact")
    return scene


SCENES = {"chatter": (chatter, 0.1), "thrown": (thrown, 0.2)}


def touched(name: str, integrator: str):
    """Return a run with a small tolerance, since small differences decide contacts, and its figures."""
    scene, duration = SCENES[name]
    run = simulate(scene(), duration, integrator=integrator, tol=1e-5)
    found = {"error": error(run, reference(*SCENES[name])), "balance": balance(run), "steps": run.report["steps"]}
    return run, found | {"touches": sum(event["what"] == "came into contact" for event in run.report["events"])}


@HERE.case("a light collector chatters on a wire", integrators=INTEGRATORS, error=1e-4, balance=1e-6, touches=(12, 18))
def chattering(integrator):
    return touched("chatter", integrator)[1]


@HERE.case("a rope is thrown on a rope", integrators=INTEGRATORS, error=1e-4, balance=1e-4, touches=(3, 3))
def falling_across(integrator):
    return touched("thrown", integrator)[1]
