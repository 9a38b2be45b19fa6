"""Wires, droppers and steady arms of a catenary."""

from __future__ import annotations

from typing import Annotated, Any

import numpy as np
from pydantic import model_validator

from ..errors import SceneError
from ..parts.part import Part
from ..parts.schemas import checked
from ..parts.signal import Signal
from ..parts.validation import Flag, finite, list_of, not_negative, positive, shown, vector

MODULUS = 1e11
"""Pa: Young's modulus of wires in scenes; their area follows from it, so that EA, EI and mass are as given."""


class Wire(Part):
    """A wire under tension.

    mass in kg/m, of the wire under its tension; tension in N, horizontal, at rest; axial_stiffness EA in N;
    bending_stiffness EI in N m²; mass_damping in 1/s and damping_time in s, see `damping_ratio`; thermal_expansion in
    1/K, for scenes with a temperature.
    """

    mass: Annotated[float, positive("kg/m")]
    tension: Annotated[float, positive("N")]
    axial_stiffness: Annotated[float, positive("N")]
    bending_stiffness: Annotated[float, positive("N m²")]
    mass_damping: Annotated[float, not_negative("1/s")] = 0.0
    damping_time: Annotated[float, not_negative("s")] = 0.0
    thermal_expansion: Annotated[float, finite("1/K")] | None = None

    @property
    def stretch(self) -> float:
        """Return the length under the tension over the undeformed one."""
        return 1 + self.tension / self.axial_stiffness

    @property
    def wave_speed(self) -> float:
        """Return the speed of transverse waves, those of a string, in m/s."""
        return float(np.sqrt(self.tension / self.mass))

    def damping_ratio(self, frequency: float | np.ndarray) -> float | np.ndarray:
        """Return the damping ratio of transverse waves of a frequency f, in Hz.

        mass_damping α gives α / (4 π f). damping_time τ damps strains of the material: in waves of the wavenumber k
        that is bending, EI k² beside the tension N, and the ratio is π f τ EI k² / (N + EI k²).
        """
        omega = 2 * np.pi * np.asarray(frequency, dtype=float)
        # m ω² = N k² + EI k⁴
        half = self.tension / (2 * self.bending_stiffness)
        square = np.sqrt(half**2 + self.mass * omega**2 / self.bending_stiffness) - half
        bending = self.bending_stiffness * square
        return (self.mass_damping / (2 * omega)
                + omega * self.damping_time * bending / (2 * (self.tension + bending)))


def _sag(value: Any) -> float | tuple[float, ...]:
    """Return a depth in m, or one for each dropper."""
    if isinstance(value, list | tuple | np.ndarray):
        return vector(value, "m", len(value))
    return vector([value], "m", 1)[0]


class Droppers(Part):
    """The droppers of a span: springs in tension alone.

    at: m from the first mast of the span, increasing; none in a span without droppers. stiffness in N/m, of each; or
    axial_stiffness EA in N, for a stiffness of EA over the length. sag: depth of the contact wire at each dropper below
    that at the outer ones, in m, negative above it; one number: that of a parabola between the outer ones. mass in
    kg/m; messenger_clamp and contact_clamp in kg. A dropper's own mass is on the messenger, on which a slack one hangs.
    thermal_expansion in 1/K, for scenes with a temperature, by default 0.
    """

    at: Annotated[tuple[float, ...], list_of("m", least=0)]
    stiffness: Annotated[float, positive("N/m")] | None = None
    axial_stiffness: Annotated[float, positive("N")] | None = None
    sag: Annotated[float | tuple[float, ...], checked(_sag, {"type": ["number", "array"]})] = 0.0
    mass: Annotated[float, not_negative("kg/m")] = 0.0
    messenger_clamp: Annotated[float, not_negative("kg")] = 0.0
    contact_clamp: Annotated[float, not_negative("kg")] = 0.0
    thermal_expansion: Annotated[float, finite("1/K")] = 0.0

    @model_validator(mode="after")
    def _fits(self) -> Droppers:
        if (self.stiffness is None) == (self.axial_stiffness is None):
            raise ValueError("have no stiffness" if self.stiffness is None else "have two stiffnesses",
                             "give stiffness (N/m, of each) or axial_stiffness (N, times one over the length)")
        for k in range(1, len(self.at)):
            if not self.at[k] > self.at[k - 1]:
                raise ValueError(f"must stand in order along the span: dropper {k + 1} is at {self.at[k]:.9g} m, "
                                 f"dropper {k} at {self.at[k - 1]:.9g} m", "sort them, and give each place once")
        if isinstance(self.sag, tuple) and len(self.sag) != len(self.at):
            raise ValueError(f"have {len(self.at)} places and {len(self.sag)} sags", "give one for each, or one number")
        if not isinstance(self.sag, tuple) and self.sag and len(self.at) < 3:
            raise ValueError(f"are {len(self.at)}: no parabola has its depth between them", "give a sag for each")
        return self

    def growth(self, temperature: float | Signal | None) -> float:
        """Return the factor of their lengths at a temperature in K. Raises SceneError."""
        if temperature is None or not self.thermal_expansion:
            return 1.0
        if isinstance(temperature, Signal):
            raise SceneError("catenary", "temperature is a signal, but droppers take a number alone by their "
                             "thermal_expansion", "leave thermal_expansion of the droppers out: they are short beside "
                             "the wires")
        factor = 1.0 + self.thermal_expansion * temperature
        if not factor > 0:
            raise SceneError("catenary", f"droppers must keep a positive length, got {factor:.6g} times the one at 0 K",
                             "give temperature in K above that of the form, thermal_expansion in 1/K")
        return factor

    def stiffness_of(self, length: float) -> float:
        """Return the stiffness of a dropper of some length (m), in N/m."""
        if self.stiffness is not None:
            return self.stiffness
        assert self.axial_stiffness is not None, "droppers have one of the stiffnesses"
        return self.axial_stiffness / length

    @property
    def depths(self) -> np.ndarray:
        """Return the sag at each dropper, in m."""
        if isinstance(self.sag, tuple):
            return np.array(self.sag)
        x = np.array(self.at)
        if not self.sag:
            return np.zeros(len(x))
        middle, half = (x[0] + x[-1]) / 2, (x[-1] - x[0]) / 2
        return np.asarray(self.sag * (1 - ((x - middle) / half) ** 2))


class SteadyArm(Part):
    """The support of the contact wire at a mast: in a planar line a vertical spring without force at rest.

    stiffness in N/m, vertical. In a line with staggers there is also a rod without mass that pulls the wire to its
    side, level at rest, of this length in m to its hinge: as the wire rises, its pull has a part downwards.
    """

    stiffness: Annotated[float, not_negative("N/m")] = 0.0
    length: Annotated[float, positive("m")] = 1.0


class End(Part):
    """An end of both wires of a line, at its first or last mast.

    weights: whether balance weights pull both wires there with their tensions, at any temperature, and the ends move
    along the track; else these are held. height: of the anchor of the contact wire, which turns freely there, over the
    wire at the outer droppers, in m; without it the wire is level there and free to rise, as in a longer line.
    """

    weights: Flag = False
    height: Annotated[float, finite("m")] | None = None


def mass_damping(ratio: float, frequency: float) -> float:
    """Return the mass damping in 1/s that gives a mode of a frequency (Hz) a damping ratio.

    Other modes have ratios in inverse proportion to their frequencies. Raises SceneError.
    """
    if not (0 <= ratio < 1 and 0 < frequency < np.inf):
        raise SceneError("mass_damping", f"needs a ratio from 0 to 1 and a positive frequency, got {shown(ratio)} and "
                         f"{shown(frequency)} Hz")
    return float(4 * np.pi * frequency * ratio)
