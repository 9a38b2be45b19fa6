"""The result of a choice: the scene, the chosen models with reasons, and the errors and costs of alternatives."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Generic

from ..parts.settings import RunSettings
from ..results.equilibrium import Equilibrium
from .motion import MOTION
from .remeshing import CableModel, S


def of_unchanged(names: list[str]) -> str:
    """Return the sentence on quantities that did not change."""
    error = ("the error of the shape at rest is relative to the extent of the scene" if names == [MOTION] else
            "their error is not estimated")
    return f"{' and '.join(names)} did not change in the short runs: {error}"


@dataclass(frozen=True)
class Alternative:
    """A considered model of a cable with estimates of its error, over the largest change, and of its CPU seconds."""

    cable: str
    model: CableModel
    error: float
    cost: float
    chosen: bool
    why: str


@dataclass
class Choice(Generic[S]):
    """The models for a tolerance.

    scene: an ordinary scene with the chosen models, whose run settings have the integrator and its tolerance; tol: the
    tolerance asked for; time_tol: that of the integrator; models: by cable; error: the upper estimate, over the largest
    change of a quantity; cost: estimated CPU seconds of a run; kept: whether the error is within the tolerance;
    reasons: in sentences; table: the alternatives; probes: the number of short runs; seconds: CPU time of the choice;
    given: cables whose element or mesh was given: their errors are not in the estimate; planar: the sentence on a
    spatial scene that was chosen planar, else empty; mesh_error: the part of the error due to the mesh; unchanged:
    quantities that did not change, whose error cannot be estimated; unresolved: sentences on short waves that no mesh
    resolves; rest: the state of rest of the last short run, on its mesh.
    """

    scene: S
    tol: float
    time_tol: float
    integrator: str
    models: dict[str, CableModel]
    error: float
    cost: float
    kept: bool
    reasons: list[str]
    alternatives: list[Alternative] = field(default_factory=list)
    probes: int = 0
    seconds: float = 0.0
    given: list[str] = field(default_factory=list)
    planar: str = ""
    mesh_error: float = 0.0
    unchanged: list[str] = field(default_factory=list)
    unresolved: list[str] = field(default_factory=list)
    rest: Equilibrium | None = field(default=None, repr=False)

    @property
    def table(self) -> list[dict[str, Any]]:
        """Return the alternatives as rows, those of a cable together, the chosen one marked."""
        return [{"cable": each.cable, "element": each.model.element, "law": each.model.law,
                 "elements": each.model.elements, "error": each.error, "cost_s": each.cost, "chosen": each.chosen,
                 "why": each.why} for each in self.alternatives]

    def settings_of(self, settings: RunSettings) -> RunSettings:
        """Return the settings of a run of the chosen scene."""
        return settings.model_copy(update={"tol": self.time_tol, "integrator": self.integrator, "model": "given"})

    def messages(self) -> list[str]:
        """Return the messages of a run on the choice."""
        kept = "" if self.kept or self.unresolved else f"; no model at hand keeps it, the estimate is {self.error:.1e}"
        given = f"; elements of {', '.join(self.given)} are kept as given, without an estimate" if self.given else ""
        still = of_unchanged(self.unchanged) if self.unchanged else ""
        return [f"model chosen {self.heading}{kept}{given}", *filter(None, (self.planar, still)), *self.unresolved]

    def facts(self) -> dict[str, Any]:
        """Return the entries of a run's report on the choice."""
        return {"tol": self.tol, "integrator": self.integrator, "error": self.error, "cost_s": self.cost,
                "kept": self.kept, "models": {name: str(model) for name, model in self.models.items()},
                "reasons": list(self.reasons), "alternatives": self.table, "probes": self.probes,
                "seconds": self.seconds, "given": list(self.given)}

    @property
    def heading(self) -> str:
        """Return the choice in a line."""
        models = "; ".join(f"{name}: {model}" for name, model in self.models.items())
        time = f"integrator {self.integrator}, its tol {self.time_tol:.2g}"
        return f"for tol = {self.tol:g}: {models or 'no cables'}; {time}"

    def __str__(self) -> str:
        """Return the choice, its reasons, and the table of alternatives."""
        lines = [f"Chosen {self.heading}", *(f"- {reason}" for reason in self.reasons), ""]
        header = ("", "cable", "model", "error", "CPU s", "why")
        rows = [("*" * each.chosen, each.cable, str(each.model), f"{each.error:.1e}", f"{each.cost:.2g}", each.why)
                for each in self.alternatives]
        widths = [max(len(row[k]) for row in (header, *rows)) for k in range(len(header))]
        lines += ["  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip()
                  for row in (header, *rows)]
        lines.append(f"Errors and times are estimates, from {self.probes} short runs in {self.seconds:.2g} s of CPU.")
        return "\n".join(lines)


