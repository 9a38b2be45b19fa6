"""The page of functions, classes and methods of the package, from their signatures and docstrings."""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterable, Iterator

import funicular
from funicular import catenary
from funicular.model.initial_state import InitialState
from funicular.results.equilibrium import Equilibrium
from funicular.results.error_estimate import ErrorEstimate
from funicular.results.linear_model import LinearModel
from funicular.results.run import EnergyBalance, Run
from funicular.results.viewable import Viewable
from funicular.scene.described import DescribedScene
from funicular.solve.motion.event_handler import State
from funicular.solve.statics.rest_state import Adjustment, Relaxation, RestState
from funicular.solve.statics.stability import Stability
from funicular.sweeps.cost import SweepCost
from funicular.sweeps.parameters import LogUniform, Uniform

from .markdown import anchor, prose, table

HEAD = """# Functions and methods

Printed by `python -m funicular.guides.site.printed` from signatures and docstrings: change those. The [parts of a
scene](parts.md) have a page of their own.
"""

FUNCTIONS = ("load_scene", "load_run", "combine", "run_many", "sweep", "sweep_cost", "load_sweep", "bundled_scenes",
             "tapered", "read_moordyn")
CLASSES: dict[str, tuple[type, ...]] = {
    "Scene": (funicular.Scene, DescribedScene), "Run": (Run,), "Equilibrium": (Equilibrium, RestState),
    "Modes": (funicular.Modes,), "Simulation": (funicular.Simulation,), "Linear model": (LinearModel,),
    "Choice": (funicular.Choice,), "Pictures": (Viewable,)}
"""Titles of sections, and the classes whose methods they list; the first four have those of `Viewable`, too."""

OTHERS = (InitialState, State, Stability, Relaxation, Adjustment, EnergyBalance, ErrorEstimate, SweepCost, Uniform,
          LogUniform)
"""Classes without methods that users call."""

INTERNAL = re.compile(r"_|check_|of$|start$|put$|(from_recording|heading|overview|sketch|summary_rows|facts)$")
"""Names that users do not need."""


def methods_page() -> str:
    """Return the page as Markdown."""
    titles = ["Functions", *CLASSES, "Catenaries", "Other classes", "Errors"]
    lines = [HEAD, *(f"- [{title}](#{anchor(title)})" for title in titles), "", "## Functions", ""]
    for name in FUNCTIONS:
        lines += _described(f"fu.{name}", getattr(funicular, name))
    for title, classes in CLASSES.items():
        lines += [f"## {title}", ""]
        lines += [line for owner in classes for line in (prose(owner), "")]
        for owner in classes:
            lines += _members(title, owner, also=classes[0])
    lines += ["## Catenaries", ""]
    for name in catenary.__all__:
        lines += _described(f"catenary.{name}", getattr(catenary, name))
    lines += ["## Other classes", ""]
    for each in OTHERS:
        lines += [f"### {each.__name__}", "", prose(each), ""]
    return "\n".join([*lines, "## Errors", "", *_errors()]).rstrip() + "\n"


def _members(title: str, owner: type, also: type) -> Iterator[str]:
    """Yield the lines on a class's own methods and properties; also: the class whose members come first."""
    for name, member in vars(owner).items():
        taken = owner is not also and name in vars(also)
        if INTERNAL.match(name) or taken or (title != "Pictures" and name in vars(Viewable)):
            continue
        if isinstance(member, property | staticmethod | classmethod) or inspect.isfunction(member):
            yield from _described(f"{title.lower()}.{name}", getattr(owner, name))


def _described(name: str, thing: object) -> Iterable[str]:
    """Return heading, arguments and docstring of a function, a class or a property."""
    written = [f"`{name}{_arguments(thing)}`", ""] if callable(thing) else []
    return [f"### {name}", "", *written, prose(thing), ""]


def _arguments(thing: object) -> str:
    """Return the parameters in brackets, without types."""
    parameters = inspect.signature(thing).parameters.values()  # type: ignore[arg-type]  # of what is callable
    bare = [each.replace(annotation=inspect.Parameter.empty) for each in parameters if each.name not in ("self", "cls")]
    return re.sub(r"<[^>]*>", "...", str(inspect.Signature(bare)))


def _errors() -> list[str]:
    """Return the table of errors and warnings."""
    return table(("error", "is"), [
        (f"`fu.{each.__name__}`", prose(each).split("\n\n")[0].replace("\n", " ")) for name in sorted(dir(funicular))
        if inspect.isclass(each := getattr(funicular, name)) and issubclass(each, Exception)])
