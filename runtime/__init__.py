"""funicular: very flexible cables and the bodies that slide on them. SI units everywhere."""

from typing import Any

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
from .parts.end_stops import Buffer, HardStop
from .parts.friction import Friction
from .parts.material import Material
from .parts.section import Circle, GeneralSection, Rectangle, Tube
from .parts.signal import Harmonic, Pulse, Ramp, TableSignal
from .parts.solids import Box, Cylinder, MeshShape, Sphere
from .results.run import Run
from .scene import Scene
from .scene_file import bundled_scenes, load_run, load_scene

__all__ = [
    "Box",
    "Buffer",
    "Circle",
    "ConvergenceError",
    "Cylinder",
    "EndOfCableError",
    "EquilibriumError",
    "Friction",
    "FunicularError",
    "FunicularWarning",
    "GeneralSection",
    "HardStop",
    "Harmonic",
    "Material",
    "MeshShape",
    "Pulse",
    "Ramp",
    "Rectangle",
    "ResultFileError",
    "Run",
    "Scene",
    "SceneError",
    "Sphere",
    "TableSignal",
    "Tube",
    "UnknownResultError",
    "__version__",
    "bundled_scenes",
    "load_run",
    "load_scene",
]


def __getattr__(name: str) -> Any:
    if name == "__version__":  # the metadata take a tenth of the time of the whole import
        from importlib.metadata import version

        return version("funicular")
    check_renamed(f"module {__name__!r}", name, __all__)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
