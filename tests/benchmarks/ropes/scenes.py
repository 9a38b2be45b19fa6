"""Scenes of the runs of ropes against reference solutions."""

from __future__ import annotations

from math import cos, pi, sin

import funicular as fu

GRAVITY = 9.81
Found = dict[str, float]


def rope_of(EA: float, rho: float, EI: float, damping_time: float = 0.0) -> dict[str, object]:
    """Return section and material of a rope with these stiffnesses in N and N m² and this mass in kg/m."""
    radius = 2 * (EI / EA) ** 0.5 if EI else 1e-6
    area = pi * radius**2
    return {"section": fu.Circle(radius=radius),
            "material": fu.Material(youngs_modulus=EA / area, density=rho / area, poisson_ratio=0.3,
                                    damping_time=damping_time)}


def weight(scene: fu.Scene, name: str, mass: float, x: float, y: float) -> None:
    """Add a weight, a point of a mass."""
    scene.rigid_body(name, mass=mass, inertia=(mass,) * 3, position=(x, y, 0))


def swing(mass: float, load: float, R: float, side: float, free: float, angle: float) -> fu.Scene:
    """Return a scene with a counterweight at (-R, -side) and a load at the free length on a tangent at an angle."""
    scene = fu.Scene(gravity=(0, -GRAVITY, 0))
    weight(scene, "counterweight", mass, -R, -side)
    weight(scene, "load", load, R * cos(angle) + free * sin(angle), R * sin(angle) - free * cos(angle))
    return scene


def over_one(scene: fu.Scene, R: float, ends: tuple[str, str], *, elements: int = 2,
             tension: float | None = None, given: dict[str, object], **sheave: object) -> None:
    """Add a rope from one body to another over a sheave at the origin; given: `rope_of`, and a length."""
    scene.rope("rope", route=[fu.Anchor(ends[0]), fu.Sheave("top", at=(0, 0, 0), radius=R, side="right", **sheave),
                              fu.Anchor(ends[1])], elements=elements, tension=tension, **given)


def over_a_peg(rho: float, EA: float, damping_time: float, elements: int = 1, *, start: float = -0.7,
               pegs: tuple[fu.Sheave, ...] = (), mirrored: bool = False) -> fu.Scene:
    """Return a pendulum of 1 kg on a rope of 2 m from the origin, let go at an angle, and a peg on its way, or others.

    mirrored: about the y axis.
    """
    length, mass, sign = 2.0, 1.0, -1 if mirrored else 1
    scene = fu.Scene(gravity=(0, -GRAVITY, 0))
    weight(scene, "load", mass, sign * length * sin(start), -length * cos(start))
    peg = fu.Sheave("peg", at=(sign * 0.3, -1, 0), radius=0.1, side="right" if mirrored else "left", contact=False)
    scene.rope("rope", route=[fu.Anchor(at=(0, 0, 0)), *(pegs or (peg,)), fu.Anchor("load")], elements=elements,
               length=length / (1 + mass * GRAVITY * cos(start) / EA), **rope_of(EA, rho, 0, damping_time))
    return scene


def on_rope_and_cable(end: float, radius: float = 0.01) -> tuple[fu.Scene, fu.Scene, fu.Rope]:
    """Return a scene with a heavy rope "line" of 10 m that goes on over a small sheave for a length `end`, one with a
    pinned cable of its elements without that, and the rope.
    """
    wrap, made = 0.5, rope_of(8e5, 0.5, 0, 2e-3)
    rope, cable = fu.Scene(), fu.Scene()
    off = (10 + radius * sin(wrap), radius * (cos(wrap) - 1))
    last = (off[0] + end * cos(wrap), off[1] - end * sin(wrap), 0)
    line = rope.rope("line", route=[fu.Anchor(at=(0, 0, 0)),
                                    fu.Sheave("top", at=(10, -radius, 0), radius=radius, side="right"),
                                    fu.Anchor(at=last)], tension=3e3, elements=[4, 1], **made)
    free = 10 / line.drawn(rope.bodies).stretch
    cable.cable("line", start=(0, 0, 0), end=(10, 0, 0), rest_length=free, elements=4, element="cable8p",
                strain="engineering", membrane="assumed", **made)
    for s in (0.0, free):
        cable.pin("line", s=s)
    return rope, cable, line
