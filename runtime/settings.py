"""The settings of a run."""

from __future__ import annotations

from typing import Annotated, ClassVar

from funicular.validation import Part, one_of, positive, within
from pydantic import Field, model_validator

INTEGRATORS = ("auto", "genalpha")

Duration = Annotated[float, positive("s")]


class RunSettings(Part):
    """How a scene is run.

    duration in s; tol: the error aimed at in positions, relative to the largest motion in the scene, by which
    the step is chosen; step: a fixed step in s instead, divided where need be so that steps end on output times;
    output_step in s, a hundredth of the duration if not given; integrator: "auto" takes the best there is, today
    genalpha; spectral_radius of the integrator at infinity: 1 keeps and 0 removes the fastest vibrations; save:
    the file to write, or None.
    """

    kind: ClassVar[str] = "run"
    duration: Duration
    tol: Annotated[float, positive()] = 1e-4
    step: Duration | None = None
    output_step: Duration = Field(default_factory=lambda data: data["duration"] / 100)
    integrator: Annotated[str, one_of(INTEGRATORS)] = "auto"
    spectral_radius: Annotated[float, within(0, 1, ends=True)] = 0.9
    save: str | None = None

    @model_validator(mode="after")
    def _steps_fit(self) -> RunSettings:
        for name in ("step", "output_step"):
            value = getattr(self, name)
            if value is not None and value > self.duration:
                raise ValueError(f"{name} must not exceed the duration {self.duration:g} s, got {value:g} s")
        return self
