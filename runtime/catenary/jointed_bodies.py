"""The bodies and joints of a jointed pantograph in a scene."""

from __future__ import annotations

import numpy as np

from ..parts.solids import Box, Cylinder
from ..scene.scene import Scene
from .base import COLLECTOR, add_base
from .jointed import JointedPantograph, Limb

HINGES = (("base", "lower", "pivot"), ("lower", "upper", "knee"), ("base", "rod", "rod_base"),
          ("rod", "upper", "rod_top"), ("upper", "carrier", "head"))
"""Bodies that turn on each other, and where."""

RADII = {"lower": 0.04, "upper": 0.03, "rod": 0.02, "carrier": 0.02}
"""m: of arms and rods as they are drawn."""

LEVER = 0.25
"""m: the suspension's spring as it is drawn reaches so far below the head: its length does not vanish."""


def add_jointed(scene: Scene, pantograph: JointedPantograph, place: tuple[float, float], speed: float,
                name: str) -> None:
    """Add the bodies of a pantograph to a scene, with its collector at (x, y) in m, at a speed (m/s) along x."""
    gravity = -scene.gravity[1]
    pivot = np.array(place) - pantograph.centres["collector"]
    add_base(scene, name, (float(pivot[0]), float(pivot[1])), speed)
    _add_bodies(scene, pantograph, pivot, speed, name)

    def at(body: str, point: tuple[float, float] | np.ndarray) -> tuple[str, tuple[float, float, float]]:
        """Return the attachment of a point as drawn (2,) on a body."""
        x, y = np.array(point) - (0.0 if body == "base" else pantograph.centres[body])
        return _called(name, body), (float(x), float(y), 0.0)

    joints = pantograph.joints | {"pivot": np.zeros(2)}
    for first, second, point in HINGES:
        scene.joint("revolute", at(first, joints[point]), at(second, joints[point]), axis=(0, 0, 1),
                    name=f"{name}_{point}")
    scene.joint("distance", at("lower", joints["guide_low"]), at("carrier", joints["guide_top"]), name=f"{name}_guide")
    collector, carrier = _called(name, "collector"), _called(name, "carrier")
    scene.joint("prismatic", carrier, collector, axis=(0, 1, 0), name=f"{name}_suspension_guide")
    pressed = pantograph.static_force(gravity=gravity) + gravity * pantograph.collector.mass
    drop = np.array([0.0, pantograph.reach + LEVER])
    scene.spring(at("carrier", pantograph.centres["collector"] - drop), collector, name=f"{name}_suspension",
                 stiffness=pantograph.suspension_stiffness, damping=pantograph.suspension_damping,
                 length=float(drop[1]) + pressed / pantograph.suspension_stiffness)
    if pantograph.damper:
        on_base, on_arm = pantograph.damper_at
        scene.spring(at("base", on_base), at("lower", on_arm), stiffness=0.0, damping=pantograph.damper,
                     name=f"{name}_damper")
    scene.moment(_called(name, "lower"), value=(0, 0, pantograph.moment_at(gravity)), name=f"{name}_moment")
    if pantograph.aerodynamic:
        scene.force(carrier, value=(0, pantograph.aerodynamic * speed**2, 0), name=f"{name}_lift")


def _called(name: str, body: str) -> str:
    return f"{name}_1" if body == "collector" else f"{name}_{body}"


def _add_bodies(scene: Scene, pantograph: JointedPantograph, pivot: np.ndarray, speed: float, name: str) -> None:
    joints = pantograph.joints
    axes = {"lower": (np.zeros(2), joints["knee"]), "upper": (joints["rod_top"], joints["head"]),
            "rod": (joints["rod_base"], joints["rod_top"]), "carrier": (joints["head"], joints["guide_top"])}
    for body, centre in pantograph.centres.items():
        limb: Limb = getattr(pantograph, body)
        shape: Box | Cylinder = Box(size=COLLECTOR)
        if body in axes:
            start, end = axes[body]
            middle = (start + end) / 2 - centre
            shape = Cylinder(radius=RADII[body], length=float(np.linalg.norm(end - start)), axis=(*(end - start), 0.0),
                             at=(*middle, 0.0))
        x, y = pivot + centre
        scene.rigid_body(_called(name, body), mass=limb.mass, inertia=(limb.inertia,) * 3,
                         position=(float(x), float(y), 0.0), velocity=(speed, 0, 0), shape=shape)
