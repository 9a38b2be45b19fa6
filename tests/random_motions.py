"""Scenes of an engineer, of random kinds and numbers: each seed gives one, with its duration."""

from __future__ import annotations

import math
from dataclasses import dataclass

import funicular as fu
import numpy as np


@dataclass
class Motion:
    """A scene, its duration in s, and a description."""

    scene: fu.Scene
    duration: float
    kind: str


def motion(seed: int) -> Motion:
    """Return the scene of a seed. The kinds in `MOTIONS` alternate."""
    rng = np.random.default_rng(seed)
    kind = list(MOTIONS)[seed % len(MOTIONS)]
    scene = fu.Scene(gravity=(0, -9.81, 0))
    duration = MOTIONS[kind](scene, rng)
    return Motion(scene, duration, kind)


def decade(rng, low: float, high: float) -> float:
    """Return a number whose logarithm is uniformly distributed between those of two others."""
    return float(f"{math.exp(rng.uniform(math.log(low), math.log(high))):.3g}")


def cable(scene, rng, name: str, start, end, slack: float = 1.0, soft: bool = False, **given) -> fu.Cable:
    """Add a cable of 2 to 5 elements in the plane or in space; slack: its length over the distance of its ends."""
    planar = scene.dim == 2 if scene.cables else rng.random() < 0.6
    element = rng.choice(["cable8p", "cable8p", "beam12p"] if planar else ["cable12", "cable12", "beam24"])
    distance = math.dist(start, end)
    given = {"strain": "engineering"} | given if element.startswith("cable") else {"law": "structural"}
    section = fu.Circle(radius=distance * decade(rng, 0.003, 0.02))
    material = fu.Material(youngs_modulus=decade(rng, 1e6, 1e7 if soft else 1e10), density=decade(rng, 800, 8000),
                           poisson_ratio=0.3, damping_time=float(rng.choice([0.0, 1e-4, 2e-3])))
    if slack > 1.0:
        given |= {"shape": "hanging"}
    return scene.cable(name, start=start, end=end, elements=int(rng.integers(2, 6)), element=str(element),
                       section=section, material=material, rest_length=slack * distance, **given)


def body(scene, rng, name: str, position, mass: float = 1.0, **given) -> fu.RigidBody:
    """Add a compact body of about this mass."""
    mass *= decade(rng, 0.3, 3.0)
    inertia = tuple(mass * 0.01 * float(x) for x in rng.uniform(0.8, 1.2, 3))
    return scene.rigid_body(name, mass=mass, inertia=inertia, position=tuple(map(float, position)), **given)


def friction(rng) -> dict:
    """Return no friction, or friction that is regularised or sticks."""
    kind = rng.integers(3)
    coefficient = float(rng.uniform(0.05, 0.4))
    return [{}, {"friction": coefficient},
            {"friction": fu.Friction(coefficient=coefficient, model="stick")}][kind]


def rider_on_a_wire(scene, rng) -> float:
    """A body slides along a taut or slack cable between two pins."""
    wire = cable(scene, rng, "wire", (0, 0, 0), (4, float(rng.uniform(-1, 0)), 0),
                 slack=float(rng.choice([0.995, 0.999, 1.02])))
    scene.pin(wire, s=0)
    scene.pin(wire, s=wire.length)
    s = float(rng.uniform(0.2, 0.4)) * wire.length
    place, low = np.asarray(wire.point(s)), float(rng.choice([0.0, 0.2]))
    body(scene, rng, "A", place - (0, low, 0), mass=decade(rng, 0.1, 3))
    stop = {} if rng.random() < 0.5 else {"at_end": fu.HardStop(restitution=0.5)}
    scene.slide("A", along=wire, s=s, at=(0, low, 0), name="trolley", **friction(rng), **stop)
    return decade(rng, 0.4, 1.0)


def cantilever(scene, rng) -> float:
    """A beam with a body at its end is let go."""
    rod = cable(scene, rng, "rod", (0, 0, 0), (1, 0, 0))
    scene.clamp(rod, s=0)
    body(scene, rng, "tip", (1, 0, 0), mass=decade(rng, 0.01, 1))
    scene.joint("spherical" if rng.random() < 0.5 or scene.dim == 3 else "weld", (rod, 1.0), "tip")
    if rng.random() < 0.5:
        scene.force("tip", value=(0, 0, 0) if rng.random() < 0.1 else (0, decade(rng, 1, 30), 0),
                    scale=fu.Ramp(start=0, end=0.1))
    return decade(rng, 0.3, 1.0)


def linkage(scene, rng) -> float:
    """One to three bodies hang on joints; the first one may be driven."""
    at, kind = np.zeros(3), str(rng.choice(["revolute", "spherical"]))
    before: object = (0.0, 0.0, 0.0)
    for k in range(int(rng.integers(1, 4))):
        angle = rng.uniform(-0.9, 0.9)
        half = 0.5 * decade(rng, 0.3, 1.0) * np.array([math.sin(angle), -math.cos(angle), 0.0])
        link = body(scene, rng, f"link{k}", at + half)
        given = {"axis": (0, 0, 1)} if kind == "revolute" else {}
        if k == 0 and kind == "revolute" and rng.random() < 0.3:
            given["velocity"] = fu.Harmonic(amplitude=float(rng.uniform(0.5, 3)), frequency=float(rng.uniform(0.5, 2)))
        scene.joint(kind, before, (link, tuple(map(float, -half))), **given)
        before, at = (link, tuple(map(float, half))), at + 2 * half
    return decade(rng, 0.5, 1.5)


def on_springs(scene, rng) -> float:
    """A body between springs: linear ones, some that pull alone or have play."""
    body(scene, rng, "A", (0, 0, 0), velocity=tuple(map(float, rng.uniform(-2, 2, 3))))
    for k, end in enumerate([(1, 1, 0), (-1, 1, 0.3), (0.2, -1, 0), (0, 0.5, 1)][: int(rng.integers(2, 5))]):
        law = [{}, {"tension_only": True}, {"free_play": 0.1}][int(rng.integers(3))]
        scene.spring("A", end, stiffness=decade(rng, 50, 5e3), damping=float(rng.choice([0.0, 1.0])),
                     length=float(np.linalg.norm(end)) * float(rng.uniform(0.7, 1.1)), name=f"spring{k}", **law)
    return decade(rng, 0.5, 2.0)


def top(scene, rng) -> float:
    """A body that turns fast and freely, or about a point."""
    mass = decade(rng, 0.3, 3)
    spin = decade(rng, 3, 100)
    scene.rigid_body("top", mass=mass, inertia=(0.02 * mass, 0.03 * mass, 0.04 * mass), position=(0, 0.2, 0),
                     angular_velocity=(0.1 * spin, spin, 0.02 * spin))
    if rng.random() < 0.5:
        scene.joint("spherical", (0, 0, 0), ("top", (0, -0.2, 0)))
    return decade(rng, 0.3, 1.0)


def thrown_on_ground(scene, rng) -> float:
    """A body falls onto a plane, a box or a ball, by penalty or hard."""
    shape = [fu.Plane(), fu.Box(size=(10, 1, 10), at=(0, -0.5, 0)), fu.Sphere(radius=5.0, at=(0, -5, 0))]
    scene.surface("ground", shape[int(rng.integers(3))])
    points = [(-0.1, -0.1, -0.1), (0.1, -0.1, -0.1), (0.0, -0.1, 0.1)]
    body(scene, rng, "A", (0, 0.13 + decade(rng, 0.005, 0.3), 0), velocity=(float(rng.uniform(0, 2)), 0, 0))
    law = {"restitution": float(rng.choice([0.0, 0.5]))} if rng.random() < 0.5 else {
        "stiffness": decade(rng, 5e3, 1e5), "damping": float(rng.choice([0.0, 0.5]))}
    friction = {} if rng.random() < 0.5 else {"friction": float(rng.uniform(0.1, 0.5))}
    scene.contact("A", "ground", radius=0.02, points=points[: int(rng.integers(1, 4))], **law, **friction)
    return decade(rng, 0.3, 0.8)


def rope_on_ground(scene, rng) -> float:
    """A short rope falls onto a plane."""
    rope = cable(scene, rng, "rope", (0, 0.15, 0), (1, 0.2, 0), soft=True, velocity=(float(rng.uniform(0, 1)), 0, 0))
    scene.surface("ground", fu.Plane())
    friction = {} if rng.random() < 0.5 else {"friction": float(rng.uniform(0.1, 0.5))}
    scene.contact(rope, "ground", stiffness=decade(rng, 5e3, 5e4), damping=1.0, **friction)
    return decade(rng, 0.25, 0.5)


def rope_over_bar(scene, rng) -> float:
    """A cable that is pinned at its ends falls onto a bar."""
    rope = cable(scene, rng, "rope", (0, 0, 0), (2, 0, 0), soft=True)
    scene.pin(rope, s=0)
    scene.pin(rope, s=rope.length)
    across = {} if scene.dim == 2 else {"axis": (0, 0, 1), "length": 0.5}
    scene.crossing(rope, at=(float(rng.uniform(0.8, 1.2)), -0.1, 0), radius=0.05, side=(0, 1, 0),
                   stiffness=decade(rng, 1e3, 1e5), damping=0.2, **friction(rng), **across)
    return decade(rng, 0.2, 0.5)


def swinging_rope(scene, rng) -> float:
    """A rope with a body at its end swings from a pin, in air or in water."""
    rope = cable(scene, rng, "rope", (0, 0, 0), (1.5, -0.5, 0), soft=True)
    scene.pin(rope, s=0)
    if rng.random() < 0.7:
        body(scene, rng, "A", (1.5, -0.5, 0), mass=decade(rng, 0.05, 2))
        scene.joint("spherical", (rope, rope.length), "A")
    if rng.random() < 0.5:
        scene.fluid("fluid", density=float(rng.choice([1.2, 1000.0])), velocity=(float(rng.uniform(-3, 3)), 0, 0))
        scene.drag(rope, normal=1.2, tangential=0.05, **({"added_mass": 1.0} if rng.random() < 0.5 else {}))
    return decade(rng, 0.3, 1.0)


def slack_rope(scene, rng) -> float:
    """A rope that resists no compression jerks a body that is thrown."""
    section = fu.Circle(radius=decade(rng, 0.003, 0.01))
    rope = scene.cable("rope", start=(0, 0, 0), end=(1, 0, 0), elements=int(rng.integers(2, 5)), element="cable8p",
                       strain="engineering", membrane="tension_only", section=section,
                       material=fu.Material(youngs_modulus=decade(rng, 1e6, 1e8), density=1000, poisson_ratio=0.3,
                                            damping_time=float(rng.choice([0.0, 1e-3]))))
    scene.pin(rope, s=0)
    body(scene, rng, "A", (1, 0, 0), velocity=(float(rng.uniform(-2, 2)), float(rng.uniform(-1, 3)), 0))
    scene.joint("spherical", (rope, 1.0), "A")
    return decade(rng, 0.2, 0.6)


def shaken_cable(scene, rng) -> float:
    """A taut cable one of whose ends moves."""
    wire = cable(scene, rng, "wire", (0, 0, 0), (3, 0, 0), slack=0.998)
    scene.pin(wire, s=0)
    amplitude = decade(rng, 0.01, 0.1)
    move = [fu.Harmonic(amplitude=amplitude, frequency=float(rng.uniform(0.5, 8))),
            fu.Ramp(start=0, end=0.2, after=amplitude)][int(rng.integers(2))]
    scene.motion(wire, s=wire.length, displacement=(0, move, 0))
    return decade(rng, 0.3, 0.8)


MOTIONS = {made.__name__: made for made in (
    rider_on_a_wire, cantilever, linkage, on_springs, top, thrown_on_ground, rope_on_ground, rope_over_bar,
    swinging_rope, slack_rope, shaken_cable)}
"""The kinds of scenes; a further one is a function here."""
