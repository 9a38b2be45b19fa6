"""Other scenes and runs that must have the motion of a given one: the same scene moved, reordered, in other units..."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterable
from dataclasses import dataclass

import funicular as fu
import numpy as np
from funicular.parts.part import Part
from funicular.rotations import rotate, turned_by
from turned_scenes import turned_scene

Vectors = np.ndarray


@dataclass(frozen=True)
class Frame:
    """Where and in which units another scene has the ground's axes and origin of the given one.

    rotation: vector in rad; shift: in m of the given scene; length and time: units of the other scene in those of the
    given one.
    """

    rotation: tuple[float, float, float] = (0.0, 0.0, 0.0)
    shift: tuple[float, float, float] = (0.0, 0.0, 0.0)
    length: float = 1.0
    time: float = 1.0

    def moved(self, scene: fu.Scene) -> fu.Scene:
        """Return the scene, turned and shifted."""
        return turned_scene(scene, self.rotation, self.shift)

    def back(self, points: Vectors) -> Vectors:
        """Return points (..., 3) of the other scene as they are in the given one, in m."""
        return rotate(turned_by(-np.array(self.rotation)), points * self.length - np.array(self.shift))

    def axes(self) -> Vectors:
        """Return (3, 3): the ground's axes of the given scene along those of the other one, as rows."""
        return rotate(turned_by(np.array(self.rotation)), np.eye(3))


@dataclass(frozen=True)
class Route:
    """A scene with the motion of a given one, seen in a frame; reversed: names of cables whose nodes count from the
    other end.
    """

    scene: fu.Scene
    frame: Frame = Frame()
    reversed: tuple[str, ...] = ()


def points(run: fu.Run, route: Route) -> dict[str, Vectors]:
    """Return by name of cables and bodies (time, points, 3): nodes, and of bodies the origin and a point on each of
    three lines, which lie along the given ground's axes as drawn, at the radius of gyration.
    """
    found = {}
    for name in route.scene.cables:
        nodes = run[f"{name}.nodal_vectors"][:, :, 0]
        found[name] = nodes[:, ::-1] if name in route.reversed else nodes
    for name, body in route.scene.bodies.items():
        lever = np.sqrt(np.trace(body.inertia) / body.mass)
        turned, at = run[f"{name}.orientation"], run[f"{name}.position"]
        in_body = rotate(np.multiply(body.orientation, (1, -1, -1, -1)), route.frame.axes())
        arms = np.stack([rotate(turned, arm) for arm in in_body], axis=1)
        found[name] = at[:, None] + lever * np.concatenate([0 * arms[:, :1], arms], axis=1)
    return {name: route.frame.back(each) for name, each in found.items()}


def apart(one: dict[str, Vectors], other: dict[str, Vectors]) -> float:
    """Return the largest distance of two motions over the largest motion."""
    assert one.keys() == other.keys()
    largest = max(np.linalg.norm(each - each[:1], axis=-1).max() for each in one.values())
    return max(np.linalg.norm(each - other[name], axis=-1).max() for name, each in one.items()) / largest


def simulate(scene: fu.Scene, duration: float, **settings) -> fu.Run:
    """Return a run with 20 times of output; its notes stand in the report."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", fu.FunicularWarning)
        return scene.run(duration, **{"output_step": duration / 20, "progress": False} | settings)


def in_other_order(parts: Iterable[Part]) -> list[Part]:
    """Return parts of a scene in another order in which they can be added: each kind backwards."""
    kinds: dict[str, list[Part]] = {}
    for part in parts:
        kinds.setdefault(part.group, []).insert(0, part.as_made())
    return [part for kind in kinds.values() for part in kind]


def reordered(scene: fu.Scene) -> Route | None:
    """The same parts in another order."""
    parts = in_other_order(scene.parts())
    return Route(scene.with_parts(parts)) if any(len(scene.group(part.group)) > 1 for part in parts) else None


def moving(**frame) -> Callable[[fu.Scene], Route]:
    """Return the route of a scene turned and shifted as a whole."""
    def moved(scene: fu.Scene) -> Route:
        there = Frame(**frame)
        return Route(there.moved(scene), there)

    return moved


ROUTES: dict[str, Callable[[fu.Scene], Route | None]] = {
    "reordered": reordered,
    "shifted": moving(shift=(1.0, 2.0, 0.0)),
    "turned": moving(rotation=(0.0, 0.0, 0.7)),
    "moved": moving(rotation=(0.3, -0.7, 1.1), shift=(1.0, 2.0, -3.0)),
}
"""Ways to write a scene anew; None of a scene that has no such."""
