"""Rods and scenarios with the attributes of cosseratbench, for tests without that package."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np

FREE, PINNED, CLAMPED = "free", "pinned", "clamped"


class Rod(SimpleNamespace):
    """A round rod, as ``cosseratbench.Rod``; conditions by their values."""

    def __init__(self, centerline, radius=0.01, youngs_modulus=1e6, start=FREE, end=FREE, **others):
        points = np.asarray(centerline, dtype=float)
        material = SimpleNamespace(youngs_modulus=youngs_modulus, density=1000.0,
                                   shear_modulus=others.pop("shear_modulus", youngs_modulus / 3))
        given = {"normal": (0.0, 0.0, 1.0), "loads": (), "rest_arc_length": None, "start_motion": None,
                 "end_motion": None, "friction": 0.0} | others
        super().__init__(centerline=tuple(map(tuple, points.tolist())), radius=radius, material=material,
                         start=SimpleNamespace(value=start), end=SimpleNamespace(value=end), **given)
        lengths = np.linalg.norm(np.diff(points, axis=0), axis=1)
        self.length = float(lengths.sum()) if self.rest_arc_length is None else self.rest_arc_length[-1]
        self.area, self.second_moment_of_area = np.pi * radius**2, np.pi * radius**4 / 4

    def directors(self, elements):
        """Return the directors of a straight rod, or of a planar rod by the normal of its plane."""
        return np.tile(np.asarray(self.normal, dtype=float), (elements, 1))


def load(force, at="end"):
    """Return a force at an end."""
    return SimpleNamespace(force=tuple(force), at=SimpleNamespace(value=at))


def motion(times, displacement=None, rotation=None, slides_along=None):
    """Return a motion of a clamped end; components without motion are empty."""
    still = tuple((0.0, 0.0, 0.0) for _ in times)
    return SimpleNamespace(times=tuple(times), displacement=still if displacement is None else displacement,
                           rotation=still if rotation is None else rotation, slides_along=slides_along)


class Scenario(SimpleNamespace):
    """A scenario, as ``cosseratbench.Scenario``."""

    def __init__(self, *rods, duration=1.0, gravity=(0.0, 0.0, 0.0), quasi_static=True, frequency=1.0, **others):
        given = {"obstacles": (), "self_contact": False} | others
        super().__init__(rods=rods, duration=duration, gravity=gravity, quasi_static=quasi_static, **given)
        self.slowest_frequency = lambda: frequency


def plane(point, normal, friction=0.0):
    """Return a fixed plane."""
    return SimpleNamespace(kind="plane", point=point, unit_normal=np.asarray(normal, dtype=float), friction=friction)


def cylinder(center, axis, radius, length, friction=0.0):
    """Return a fixed cylinder."""
    return SimpleNamespace(kind="cylinder", center=center, unit_axis=np.asarray(axis, dtype=float), radius=radius,
                           length=length, friction=friction)
