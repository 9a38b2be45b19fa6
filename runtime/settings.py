"""The settings of a run."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar

from funicular.errors import near
from funicular.validation import Part, positive, within
from pydantic import Field, PlainValidator, model_validator

INTEGRATORS = ("genalpha",)

Duration = Annotated[float, positive("s")]


def _integrator(value: Any) -> str:
    if value not in INTEGRATORS:
        raise ValueError(f'"{value}" is not known', near(value, INTEGRATORS))
    return value


class RunSettings(Part):
    """How a scene is run.

    duration in s; tol: the error aimed at in positions, relative to the largest motion in the scene, by which
    the step is chosen; step: a fixed step in s instead; output_step in s, a hundredth of the duration if not
    given; spectral_radius of the integrator at infinity: 1 keeps and 0 removes the fastest vibrations; save: the
    file to write, or None.
    """

    kind: ClassVar[str] = "run"
    duration: Duration
    tol: Annotated[float, positive()] = 1e-4
    step: Duration | None = None
    output_step: Duration = Field(default_factory=lambda data: data["duration"] / 100)
    integrator: Annotated[str, PlainValidator(_integrator)] = "genalpha"
    spectral_radius: Annotated[float, within(0, 1, ends=True)] = 0.9
    save: str | None = None

    @model_validator(mode="after")
    def _steps_fit(self) -> RunSettings:
        for name in ("step", "output_step"):
            value = getattr(self, name)
            if value is not None and value > self.duration:
                raise ValueError(f"{name} must not exceed the duration {self.duration:g} s, got {value:g} s")
        return self
