"""funicular: very flexible cables and the bodies that slide on them. SI units everywhere."""

from types import ModuleType as _ModuleType
from typing import TYPE_CHECKING as _TYPE_CHECKING
from typing import Any as _Any

from .cli import start as _start  # noqa: F401  first: handles Ctrl-C during the other imports
from .errors import ConvergenceError as ConvergenceError
from .errors import EndOfCableError as EndOfCableError
from .errors import EquilibriumError as EquilibriumError
from .errors import FunicularError as FunicularError
from .errors import FunicularWarning as FunicularWarning
from .errors import ResultFileError as ResultFileError
from .errors import RopeLeftError as RopeLeftError
from .errors import SceneError as SceneError
from .errors import UnknownResultError as UnknownResultError
from .parts.end_stops import Buffer as Buffer
from .parts.end_stops import HardStop as HardStop
from .parts.flow_profile import PowerProfile as PowerProfile
from .parts.flow_profile import TableProfile as TableProfile
from .parts.force_segments import ForceTable as ForceTable
from .parts.friction import Friction as Friction
from .parts.listed import *  # noqa: F403  the kinds of parts
from .parts.material import Material as Material
from .parts.piece import Piece as Piece
from .parts.polar import Polar as Polar
from .parts.rope_items import Anchor as Anchor
from .parts.rope_items import Block as Block
from .parts.rope_items import Drum as Drum
from .parts.rope_items import Sheave as Sheave
from .parts.section import Circle as Circle
from .parts.section import GeneralSection as GeneralSection
from .parts.section import Rectangle as Rectangle
from .parts.section import Tube as Tube
from .parts.settings import EquilibriumSettings as EquilibriumSettings
from .parts.settings import RunSettings as RunSettings
from .parts.signal import Harmonic as Harmonic
from .parts.signal import Pulse as Pulse
from .parts.signal import Ramp as Ramp
from .parts.signal import TableSignal as TableSignal
from .parts.solids import Box as Box
from .parts.solids import Cylinder as Cylinder
from .parts.solids import MeshShape as MeshShape
from .parts.solids import Sphere as Sphere
from .parts.surface_shapes import Capsule as Capsule
from .parts.surface_shapes import HeightField as HeightField
from .parts.surface_shapes import Plane as Plane
from .parts.tapered import tapered as tapered
from .parts.tension_table import TensionTable as TensionTable
from .parts.velocity_table import VelocityTable as VelocityTable
from .parts.wave import Wave as Wave
from .parts.wave import jonswap as jonswap
from .results.combination import combine as combine
from .results.run import Run as Run
from .scene.file import bundled_scenes as bundled_scenes
from .scene.file import load_run as load_run
from .scene.file import load_scene as load_scene
from .scene.scene import Scene as Scene
from .sweeps.many_scenes import run_many as run_many

if not _TYPE_CHECKING:  # type checkers read the imports, those of parts/listed.py included
    __all__ = ["__version__", *(name for name, value in globals().items()  # noqa: F405
                                if not name.startswith("_") and not isinstance(value, _ModuleType))]

LAZY = {"Choice": "choice.choice", "Equilibrium": "results.equilibrium", "InitialState": "model.initial_state",
        "LinearModel": "results.linear_model", "LogUniform": "sweeps.parameters", "Modes": "solve.modes.modes",
        "Simulation": "results.simulation", "Uniform": "sweeps.parameters", "load_sweep": "sweeps.dataset",
        "read_moordyn": "exchange.moordyn", "sweep": "sweeps.sweep", "sweep_cost": "sweeps.sweep"}
"""Modules of names whose imports (SciPy, xarray) take as long as all others, imported on first use."""


def __dir__() -> list[str]:
    """Return the public names."""
    return sorted({*__all__, *LAZY, "__all__", "__doc__", "__file__", "__name__", "__path__", "__version__"})


def __getattr__(name: str) -> _Any:
    if name in LAZY:
        from importlib import import_module

        return getattr(import_module(f".{LAZY[name]}", __name__), name)
    if name == "__version__":  # the metadata take a tenth of the import
        from importlib.metadata import version

        return version("funicular")
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
