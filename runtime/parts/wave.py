"""Waves on a fluid: linear ones, and those that make a sea by JONSWAP's spectrum."""

import math
from typing import Annotated, Any

import numpy as np
from pydantic import BeforeValidator, Field

from ..base.rotations import unit
from ..engine import MAX_WAVES
from ..errors import SceneError
from .part import Part
from .validation import Vector, direction, finite, items, positive, shown

PEAK_WIDTHS = 0.07, 0.09
"""Of JONSWAP's peak, below and above it, relative to its frequency."""
SPECTRUM = 0.4, 6.0
"""Frequencies of the spectrum over that of its peak: beyond them is less than 1e-3 of the energy."""
Direction = Annotated[Vector, direction()]


class Wave(Part):
    """A linear wave: the elevation ``amplitude cos(k direction . r - 2 π t/period + phase)`` above the still level.

    The period is that at a fixed place: a current does not change the length.

    amplitude: half of the height, m
    period: s
    direction: in which it runs, level
    phase: rad
    """

    kind = "wave"
    positional = ("amplitude",)
    amplitude: Annotated[float, positive("m")]
    period: Annotated[float, positive("s")]
    direction: Direction = (1.0, 0.0, 0.0)
    phase: Annotated[float, finite("rad")] = 0.0

    @property
    def frequency(self) -> float:
        """Return its angular frequency, rad/s."""
        return 2 * math.pi / self.period

    @property
    def ahead(self) -> np.ndarray:
        """Return the unit vector (3,) along its direction."""
        return unit(np.array(self.direction))

    def wave_number(self, gravity: float, depth: float | None) -> float:
        """Return k of the dispersion relation omega² = g k tanh(k depth), 1/m; depth None: infinite."""
        deep = self.frequency**2 / gravity
        if depth is None:
            return deep
        k = max(deep, self.frequency / math.sqrt(gravity * depth))
        for _ in range(50):
            tanh = math.tanh(k * depth)
            change = (k * tanh - deep) / (tanh + k * depth * (1 - tanh**2))
            k -= change
            if abs(change) <= 1e-15 * k:
                break
        return k


def _listed(value: Any) -> list[Any]:
    if (given := items(value, 1)) is None or len(given) > MAX_WAVES:
        raise ValueError(f"must be a list of 1 to {MAX_WAVES} waves, got {shown(value)}",
                         "give them as waves=[fu.Wave(...), ...], or fu.jonswap(...)")
    return given


Waves = Annotated[tuple[Wave, ...], Field(json_schema_extra={"minItems": 1, "maxItems": MAX_WAVES}),
                  BeforeValidator(_listed)]


def jonswap(*, significant_height: float, peak_period: float, peakedness: float = 3.3, components: int = 100,
            seed: int = 0, direction: tuple[float, float, float] = (1.0, 0.0, 0.0)) -> list[Wave]:
    """Return waves of equal energy whose spectrum is JONSWAP's (Hasselmann et al. 1973).

    The frequencies are the medians of parts of equal energy of the spectrum, the phases are even in a circle by a
    random generator: the same arguments make the same waves. The variance of the elevation is
    significant_height²/16.

    significant_height: m
    peak_period: s
    peakedness: γ, 1 for the spectrum of Pierson and Moskowitz
    components: number of waves
    seed: of the phases
    direction: in which they run, level

    Raises SceneError.

    >>> import funicular as fu
    >>> sea = fu.jonswap(significant_height=2.0, peak_period=8.0, components=50)
    >>> len(sea), round(sum(wave.amplitude**2 / 2 for wave in sea), 12)
    (50, 0.25)
    """
    for name, given, units in (("significant_height", significant_height, "m"), ("peak_period", peak_period, "s")):
        if not 0 < given < math.inf:
            raise SceneError("jonswap", f"{name} must be positive, got {given:g} {units}")
    if not (peakedness >= 1 and 1 <= components <= MAX_WAVES):
        raise SceneError("jonswap", f"peakedness must be at least 1 and components from 1 to {MAX_WAVES}, got "
                         f"{peakedness} and {components}")
    x = np.linspace(*SPECTRUM, 20001)  # frequency over that of the peak
    width = np.where(x <= 1, *PEAK_WIDTHS)
    density = x**-5 * np.exp(-1.25 * x**-4) * peakedness ** np.exp(-((x - 1) ** 2) / (2 * width**2))
    energy = np.append(0.0, np.cumsum((density[1:] + density[:-1]) / 2))
    medians = np.interp((np.arange(components) + 0.5) / components, energy / energy[-1], x)
    phases = np.random.default_rng(seed).uniform(0, 2 * np.pi, components)
    amplitude = significant_height / 4 * math.sqrt(2 / components)
    return [Wave(amplitude=amplitude, period=peak_period / float(x), direction=direction, phase=float(phase))
            for x, phase in zip(medians, phases, strict=True)]
