"""Scenes of cosseratbench's rods: their elements, supports and initial states.

Only attributes of ``cosseratbench.Scenario`` and ``cosseratbench.Rod`` are read: the package itself is not needed here.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.interpolate import CubicSpline

from ..base.rotations import cross
from ..parts.cable import Cable
from ..parts.material import Material
from ..parts.section import Circle, GeneralSection
from ..parts.signal import TableSignal
from ..scene.scene import Scene
from .contacts import is_plane, stand

if TYPE_CHECKING:
    from cosseratbench.scenario import Motion, Rod, Scenario

FREE, CLAMPED = "free", "clamped"
"""Values of ``cosseratbench.EndCondition``."""

SPATIAL, PLANAR, TORSION = "cable12", "cable8p", "beam24"
"""Elements of rods: without torsion in space and in a plane, and with torsion and shear."""

PLANE_TOLERANCE = 1e-9
"""Distance from a plane, over the size, up to which a vector lies in it."""

SPLINE_TOLERANCE = 1e-3
"""Distance of a table from the spline through it, over its range, up to which it stands for a smooth motion."""

MIRRORED_VALUES = 16
"""Values before a motion that starts from rest, for a rate of the spline of zero within rounding."""

LIMP_RATIO = 1e-8
"""Part of the bending stiffness that a rod without bending keeps, for solvable equations."""


@dataclass
class RodScene:
    """A scene of rods with the cable of each, and its initial state as `Scene.run` takes it."""

    scene: Scene
    cables: list[Cable]
    start: dict[str, np.ndarray] = field(default_factory=dict)


def ends_of(rod: Rod) -> list[tuple[float, str, Motion | None]]:
    """Return arc-length in m, condition and motion of both ends."""
    return [(0.0, rod.start.value, rod.start_motion), (rod.length, rod.end.value, rod.end_motion)]


def plane_normal(scenario: Scenario, rod: Rod) -> np.ndarray | None:
    """Return the unit normal (3,) of the plane of a rod's motion, by its points, loads and obstacles.

    None if there is none, or where an end is driven. For a straight rod along its loads it is the rod's own normal.
    """
    if rod.start_motion is not None or rod.end_motion is not None:
        return None
    normal = _normal(scenario.gravity, rod)
    if normal is None:
        return None
    obstacle: Any
    for obstacle in scenario.obstacles:
        flat = is_plane(obstacle)
        part = abs(float((obstacle.unit_normal if flat else obstacle.unit_axis) @ normal))
        if not (part <= PLANE_TOLERANCE if flat else part >= 1 - PLANE_TOLERANCE):
            return None
    return normal


def _normal(gravity: tuple[float, ...], rod: Rod) -> np.ndarray | None:
    """Return the unit normal (3,) of the plane of a rod's points and loads, None if there is none."""
    points = np.asarray(rod.centerline, dtype=float)
    acting = [_unit(gravity), *(_unit(load.force) for load in rod.loads)]
    given = np.vstack([points - points[0], acting])
    _, sizes, directions = np.linalg.svd(given, full_matrices=False)
    if sizes[2] > PLANE_TOLERANCE * sizes[0]:
        return None
    normal = directions[2]
    if sizes[1] <= PLANE_TOLERANCE * sizes[0]:
        along = directions[0]
        normal = np.asarray(rod.normal, dtype=float) - np.dot(rod.normal, along) * along
    nearest = int(np.argmax(np.abs(normal)))
    rounded = np.where(np.abs(normal) < PLANE_TOLERANCE, 0.0, normal) * np.sign(normal[nearest])
    return np.asarray(rounded / np.linalg.norm(rounded))


def element_of(scenario: Scenario, rod: Rod, alone: bool) -> str:
    """Return the cheapest element for a rod.

    A round rod that is straight without stress carries torsion only if both its ends are clamped, or one is driven: it
    is a beam. Others are cables, planar ones if they move in a plane and are alone in their scene. Cables neither twist
    nor shear.
    """
    ends = ends_of(rod)
    if all(condition == CLAMPED for _, condition, _ in ends) or any(motion is not None for *_, motion in ends):
        return TORSION
    return PLANAR if alone and plane_normal(scenario, rod) is not None else SPATIAL


def scene_of(scenario: Scenario, rods: list[Rod], elements: int, damping_rate: float = 0.0,
             bending: bool = True) -> RodScene:
    """Return a scene of rods of a scenario, ``rod0`` and so on, each with a number of equal elements.

    damping_rate: of damping proportional to mass, in 1/s; bending: whether rods without torsion resist bending.
    """
    made = RodScene(Scene(gravity=scenario.gravity), [])
    for number, rod in enumerate(rods):
        kind = element_of(scenario, rod, alone=len(rods) == 1)
        name = f"rod{number}"
        cable = made.scene.cable(name, elements=elements, **_drawing(scenario, rod, kind),
                                 **_stiffness(rod, kind, damping_rate, bending))
        made.cables.append(cable)
        for s, condition, motion in ends_of(rod):
            _support(made.scene, cable, s, condition, motion)
        for load in rod.loads:
            made.scene.force(cable, s=0.0 if load.at.value == "start" else rod.length, value=load.force)
        if rod.rest_arc_length is not None:
            made.start[f"{name}.nodal_vectors"] = _stretched(rod, cable)
    stand(made.scene, scenario, rods, made.cables)
    return made


def _unit(vector: tuple[float, ...]) -> np.ndarray:
    size = np.linalg.norm(vector)
    return np.asarray(vector, dtype=float) / (size if size else 1.0)


def _drawing(scenario: Scenario, rod: Rod, kind: str) -> dict[str, Any]:
    """Return the arguments of the cable's shape: through the rod's points, straight without stress."""
    points = np.asarray(rod.centerline, dtype=float)
    up = np.asarray(rod.normal, dtype=float)
    if kind == PLANAR:
        normal = plane_normal(scenario, rod)
        assert normal is not None, "planar elements are taken where there is a plane"
        up = cross(normal, points[1] - points[0])
    drawn = {"rest_length": rod.length, "up": tuple(up.tolist()), "element": kind}
    if np.linalg.svd(points - points[0], compute_uv=False)[1] <= PLANE_TOLERANCE * rod.length:
        return {"start": tuple(points[0].tolist()), "end": tuple(points[-1].tolist()), **drawn}
    return {"points": [tuple(point) for point in points.tolist()], "rest": "straight", **drawn}


def _stiffness(rod: Rod, kind: str, damping_rate: float, bending: bool) -> dict[str, Any]:
    """Return section, material and law of a rod's cable. Raises NotImplementedError."""
    given = rod.material
    moduli = {"shear_modulus": given.shear_modulus} if kind == TORSION else {"poisson_ratio": 0.0}
    if kind == TORSION and given.shear_modulus < given.youngs_modulus / 3 * (1 - PLANE_TOLERANCE):
        raise NotImplementedError("torsion of a shear modulus below a third of Young's modulus")
    material = Material(youngs_modulus=given.youngs_modulus, density=given.density, mass_damping=damping_rate,
                        **moduli)
    if kind == TORSION:
        return {"section": Circle(radius=rod.radius), "material": material, "law": "structural"}
    stiff = rod.second_moment_of_area * LIMP_RATIO
    section = Circle(radius=rod.radius) if bending else GeneralSection(
        area=rod.area, second_moment_about_y=stiff, second_moment_about_z=stiff)
    return {"section": section, "material": material, "strain": "engineering"}


def _support(scene: Scene, cable: Cable, s: float, condition: str, motion: Motion | None) -> None:
    """Hold, or drive, an end of a rod."""
    if motion is not None:
        _drive(scene, cable, s, motion)
    elif condition == CLAMPED:
        scene.clamp(cable, s=s)
    elif condition != FREE:
        scene.pin(cable, s=s)


def _drive(scene: Scene, cable: Cable, s: float, motion: Motion) -> None:
    """Move and turn a clamped end. Raises NotImplementedError."""
    displacement: list[Any] = [_signal(motion.times, each) for each in np.transpose(motion.displacement)]
    if motion.slides_along is not None:
        along = _unit(motion.slides_along)
        free = int(np.argmax(np.abs(along)))
        if abs(along[free]) < 1 - PLANE_TOLERANCE:
            raise NotImplementedError(f"an end that slides along {motion.slides_along}, which is no axis of the ground")
        displacement[free] = "free"
    turns = np.asarray(motion.rotation, dtype=float)
    largest = turns[np.argmax(np.linalg.norm(turns, axis=1))]
    axis = _unit(largest) if np.any(largest) else np.array([0.0, 0.0, 1.0])
    if np.abs(cross(axis, turns)).max() > PLANE_TOLERANCE * np.linalg.norm(largest):
        raise NotImplementedError("an end that turns about more than one axis")
    scene.motion(cable, s=s, displacement=displacement,
                 rotation=(tuple(axis.tolist()), _signal(motion.times, turns @ axis)))


def _signal(times: tuple[float, ...], values: np.ndarray) -> TableSignal | float:
    """Return values over times as a signal: a spline through smooth ones, else straight lines."""
    if not np.any(values):
        return 0.0
    t, spline = np.asarray(times), CubicSpline(times, values)
    inside = (t[:-1, None] + np.diff(t)[:, None] * np.linspace(0, 1, 9)[1:-1]).ravel()
    if np.abs(spline(inside) - np.interp(inside, t, values)).max() > SPLINE_TOLERANCE * np.ptp(values):
        return TableSignal(time=times, value=values.tolist(), interpolation="linear")
    if abs(spline(0.0, 1)) <= SPLINE_TOLERANCE * np.abs(spline(t, 1)).max():  # from rest: mirrored, exactly so
        before = slice(min(MIRRORED_VALUES, len(t) - 1), 0, -1)
        t, values = np.concatenate([-t[before], t]), np.concatenate([values[before], values])
    return TableSignal(time=t.tolist(), value=values.tolist())


def _stretched(rod: Rod, cable: Cable) -> np.ndarray:
    """Return the nodal vectors (node, vector, 3) of a rod that starts stretched.

    They follow the spline through its points over the arc-length without stress. Clamped ends keep their direction.
    """
    line = CubicSpline(rod.rest_arc_length, np.asarray(rod.centerline, dtype=float))
    names = cable.kind_of_element.nodal_vectors
    vectors, s = cable.nodal_vectors.copy(), np.linspace(0.0, rod.length, len(cable.node_s))
    drawn = vectors[:, names.index("r_x")].copy()
    vectors[1:-1, names.index("r")] = line(s[1:-1])
    vectors[:, names.index("r_x")] = line(s, 1)
    for node, (_, condition, _) in zip((0, -1), ends_of(rod), strict=True):
        if condition == CLAMPED:
            along = drawn[node] / np.linalg.norm(drawn[node])
            vectors[node, names.index("r_x")] = along * np.linalg.norm(line(s[node], 1))
    return vectors
