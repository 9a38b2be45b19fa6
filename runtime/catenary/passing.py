"""Pantographs that pass below a catenary: put there, with the contact and what a run of them needs."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..errors import SceneError
from ..parts.cable import Cable
from ..parts.settings import overridden
from ..scene.scene import Scene
from .base import COLLECTOR, RADIUS
from .jointed import JointedPantograph
from .jointed_bodies import add_jointed
from .local_sag import mean_missing_compliance
from .pantograph import Pantograph, add_masses

RUN = {"initial": "equilibrium", "integrator": "genalpha", "spectral_radius": 0.5, "tol": 1e-6, "absolute_tol": 5e-3,
       "quantities": ["contact.position.y"], "output_step": 0.004}
"""Settings of a run where no others are given. The droppers' stiffness makes vibrations that a larger radius would let
grow from step to step; absolute_tol is such that the standard deviation of the contact force is converged in time
to less than 1 %, see tests/benchmarks/pantographs.py, and tol adds nothing to it."""

ERROR_RATE = 1.2e-3
"""m/s: what absolute_tol is at the most for the duration of a run, all of which shares in it."""

TOUCH = 1e-9
"""m: by which a collector is drawn into the wire whose arms nothing else holds up: the search for rest begins there."""

LEFT = 20.0
"""m: what a run leaves of the line before its end, at the most."""

NODES = 80
"""Of the contact wire, from its start on: on so many the mean is taken of what its elements leave of the dent."""


def add_pantograph(scene: Scene, pantograph: Pantograph | JointedPantograph, at: float, speed: float,
                   name: str = "pantograph") -> None:
    """Add a pantograph below the contact wire at x = `at` (m), which moves along x at a speed (m/s) from the start on.

    Its collector is name_1, and its base name_base; of a chain of masses those below the collector are name_2 and so
    on, of a jointed one its bodies are name_lower, name_upper, name_rod and name_carrier. Its contact is name_contact.
    The scene's runs have the settings `RUN`, and end before the first pantograph is at the end of the line, where no
    others are given. Raises SceneError.
    """
    wire = scene.cables.get("contact")
    if wire is None:
        raise SceneError("pantograph", 'there is no cable "contact"', "make the scene with funicular.catenary.scene")
    (begin, level, _), (end, *_) = wire.drawn_through[0], wire.drawn_through[-1]
    if not begin < at < end - LEFT or not 0 <= speed < np.inf:
        raise SceneError("pantograph", f"at {at:.6g} m with {speed:.6g} m/s is not on its way along the line",
                         f"begin between {begin:.6g} and {end - LEFT:.6g} m, with a speed that is not negative")
    _set_runs(scene, (end - LEFT - at) / speed if speed else 1.0)
    stiffness = 1 / (1 / pantograph.contact_stiffness + _missing(wire))
    height = float(level) - RADIUS
    if isinstance(pantograph, JointedPantograph):
        add_jointed(scene, pantograph, (at, height + TOUCH), speed, name)
    else:
        add_masses(scene, pantograph, (at, height), speed, name)
    bar: dict[str, Any] = {} if wire.dim == 2 else {"axis": (0, 0, 1), "length": COLLECTOR[2] / 2}
    scene.crossing("contact", f"{name}_1", radius=RADIUS, side=(0, 1, 0), name=f"{name}_contact", stiffness=stiffness,
                   **bar)


def _set_runs(scene: Scene, duration: float) -> None:
    """Give a scene the settings of runs that end after a duration (s), where it has no others."""
    own = "absolute_tol" in scene.run_settings
    scene.run_settings = settings = overridden(RUN, scene.run_settings)
    settings["duration"] = min(duration, settings.get("duration", duration))
    if "absolute_tol" in settings and not own:
        settings["absolute_tol"] = min(settings["absolute_tol"], ERROR_RATE * settings["duration"])


def _missing(wire: Cable) -> float:
    """Return by how much less the elements of the contact wire give way to a collector than the wire does, in m/N."""
    modulus, length = wire.material.youngs_modulus, wire.drawn_length
    tension = modulus * wire.section.area * (length / wire.length - 1)
    if tension <= 0:
        return 0.0
    nodes = wire.node_s[:NODES] * length / wire.length
    return mean_missing_compliance(tension, modulus * wire.section.second_moment_about_z, nodes)
