"""funicular: very flexible cables and the bodies that slide on them. SI units everywhere."""

from typing import Any

from funicular.ends import Buffer, HardStop
from funicular.errors import (
    ConvergenceError,
    EndOfCableError,
    EquilibriumError,
    FunicularError,
    FunicularWarning,
    ResultFileError,
    SceneError,
    UnknownResultError,
)
from funicular.friction import Friction
from funicular.materials import Material
from funicular.results import Run, load_run
from funicular.scene import Scene
from funicular.scene_file import bundled_scenes, load_scene
from funicular.sections import Circle, GeneralSection, Rectangle, Tube
from funicular.signals import Harmonic, Pulse, Ramp, TableSignal

__all__ = [
    "Buffer",
    "Circle",
    "ConvergenceError",
    "EndOfCableError",
    "EquilibriumError",
    "Friction",
    "FunicularError",
    "FunicularWarning",
    "GeneralSection",
    "HardStop",
    "Harmonic",
    "Material",
    "Pulse",
    "Ramp",
    "Rectangle",
    "ResultFileError",
    "Run",
    "Scene",
    "SceneError",
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
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
