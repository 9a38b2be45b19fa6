"""funicular: very flexible cables and the bodies that slide on them. SI units everywhere."""

from typing import Any

from .cli import start as command_start  # noqa: F401  first: handles Ctrl-C during the other imports
from .errors import (
    ConvergenceError,
    EndOfCableError,
    EquilibriumError,
    FunicularError,
    FunicularWarning,
    ResultFileError,
    SceneError,
    UnknownResultError,
    check_renamed,
)
from .parts.cable import Cable
from .parts.contact import Contact
from .parts.crossing import Crossing
from .parts.drag import Drag
from .parts.end_stops import Buffer, HardStop
from .parts.event import Event
from .parts.flow_profile import PowerProfile, TableProfile
from .parts.fluid import Fluid
from .parts.force_segments import ForceTable
from .parts.friction import Friction
from .parts.joint import Joint
from .parts.load import DistributedForce, Force, Moment
from .parts.material import Material
from .parts.modal_body import ModalBody
from .parts.polar import Polar
from .parts.rigid_body import RigidBody
from .parts.section import Circle, GeneralSection, Rectangle, Tube
from .parts.settings import EquilibriumSettings, RunSettings
from .parts.signal import Harmonic, Pulse, Ramp, TableSignal
from .parts.slide import Slide
from .parts.solids import Box, Cylinder, MeshShape, Sphere
from .parts.spring import Spring
from .parts.support import Clamp, Motion, Pin, Tie
from .parts.surface import Surface
from .parts.surface_shapes import Capsule, HeightField, Plane
from .parts.velocity_table import VelocityTable
from .results.combination import combine
from .results.run import Run
from .scene.file import bundled_scenes, load_run, load_scene
from .scene.scene import Scene
from .sweeps.many_scenes import run_many

__all__ = [
    "Box", "Buffer", "Cable", "Capsule", "Circle", "Clamp", "Contact", "ConvergenceError", "Crossing", "Cylinder",
    "DistributedForce", "Drag", "EndOfCableError", "EquilibriumError", "EquilibriumSettings", "Event", "Fluid",
    "Force", "ForceTable", "Friction", "FunicularError", "FunicularWarning", "GeneralSection", "HardStop",
    "Harmonic", "HeightField", "Joint", "Material", "MeshShape", "ModalBody", "Moment", "Motion", "Pin", "Plane",
    "Polar", "PowerProfile", "Pulse", "Ramp", "Rectangle", "ResultFileError", "RigidBody", "Run", "RunSettings",
    "Scene", "SceneError", "Slide", "Sphere", "Spring", "Surface", "TableProfile", "TableSignal", "Tie", "Tube",
    "UnknownResultError", "VelocityTable", "__version__", "bundled_scenes", "combine", "load_run", "load_scene",
    "run_many",
]
LAZY = {"Choice": "choice.choice", "Equilibrium": "results.equilibrium", "InitialState": "model.initial_state",
        "LogUniform": "sweeps.parameters", "Modes": "solve.modes.modes", "Uniform": "sweeps.parameters",
        "load_sweep": "sweeps.dataset", "sweep": "sweeps.sweep", "sweep_cost": "sweeps.sweep"}
"""Modules of names whose imports (SciPy, xarray) take as long as all others, imported on first use."""


def __dir__() -> list[str]:
    """Return the public names."""
    return sorted({*__all__, *LAZY, "__all__", "__doc__", "__file__", "__name__", "__path__", "__version__"})


def __getattr__(name: str) -> Any:
    if name in LAZY:
        from importlib import import_module

        return getattr(import_module(f".{LAZY[name]}", __name__), name)
    if name == "__version__":  # the metadata take a tenth of the import
        from importlib.metadata import version

        return version("funicular")
    check_renamed(f"module {__name__!r}", name, __all__)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
