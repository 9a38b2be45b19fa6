"""Ropes that unload along another curve than that of first loading."""

from __future__ import annotations

from itertools import pairwise
from typing import Annotated, ClassVar

import numpy as np
from pydantic import model_validator

from .cubic_segments import giving_way, numbers, value
from .part import Part
from .quantity import Quantity
from .tension_table import MAX_POINTS
from .validation import Name, Reference, bounded, check_function, list_of, not_negative, one_of, show

ENDS = np.array([0.0, 1.0])
MOST_BEND = {"linear": 0.0, "quadratic": 1.0, "exponential": 10.0}
"""Shapes of working curves, and the largest bend of each."""


class WorkingCurve(Part):
    """Unloading and reloading of a rope of fibres below the highest strain that it has had (the Syrope model).

    On first loading the force is the ``tension_table`` N₀ of the cable. Below the highest strain H of a point the rope
    unloads, and reloads, along a working curve: from the strain ``permanent`` times H without force, where it is slack,
    it rises to N₀(H). Beyond H it follows the table again. With x from 0 to 1 between both strains the force is N₀(H)
    times x with form="linear", x (1 - bend + bend x) with "quadratic" and (exp(bend x) - 1)/(exp(bend) - 1) with
    "exponential".

    A curve by ``strain`` and ``force`` is one that was measured, from the strain without force to the highest one, on
    the table. From another highest strain the same curve is scaled in both directions: the rule for partial cycles.

    The area between both curves, which the first loading up to H has cost, is in ``energy.dissipated``. A cycle below H
    costs nothing. ``scene.relaxation`` of the same cable adds losses there, and the higher stiffness of fast changes;
    it acts in a slack rope, too, which then pushes until the branch has relaxed.

    A run begins with the highest strain of its state, or with that of ``highest_tension``. Statics has the rope on its
    first loading, or on the working curve from ``highest_tension``. Modes are small vibrations about a state, along the
    working curve. A state of a run (`Run.at`) remembers the highest strains.

    Source: Falkenberg, Åhjem & Yang, OTC-27761-MS (2017).

    cable: cable8p or cable12 with membrane="tabulated" and a table from strain 0 on
    permanent: permanent strain as a share of the highest one, from 0 to below 1
    form: of the working curve, "linear", "quadratic" or "exponential"
    bend: of the shape, from 0, which is straight, to 1 with "quadratic" and 10 with "exponential"
    strain: of a measured curve, in the place of the three above; increasing, at most 20
    force: of a measured curve, N, increasing from 0
    highest_tension: N, highest tension before the start, of the whole cable
    """

    kind = "working_curve"
    group = "working_curves"
    positional = ("cable",)
    results: ClassVar = {
        "tension": Quantity(("time", "{part}.point"), "N", "axial force of the rope at five points of each element"),
        "strain": Quantity(("time", "{part}.point"), "1", "strain there"),
        "highest_strain": Quantity(("time", "{part}.point"), "1", "highest strain there so far"),
    }
    name: Name | None = None
    cable: Reference
    permanent: Annotated[float, bounded("", lambda x: 0 <= x < 1, "be from 0 to below 1", minimum=0,
                                        exclusiveMaximum=1)] | None = None
    form: Annotated[str, one_of(tuple(MOST_BEND))] = "linear"
    bend: Annotated[float, not_negative()] = 0.0
    strain: Annotated[tuple[float, ...], list_of("", least=2)] | None = None
    force: Annotated[tuple[float, ...], list_of("N", least=2)] | None = None
    highest_tension: Annotated[float, not_negative("N")] = 0.0

    @model_validator(mode="after")
    def _is_a_curve(self) -> WorkingCurve:
        if self.strain is None and self.force is None:
            if self.permanent is None:
                raise ValueError("needs permanent, or strain and force", "give the permanent strain as a share of the "
                                 "highest one, or a measured curve")
            if self.bend > 0 and self.form == "linear":
                raise ValueError(f'bend needs form="quadratic" or "exponential", got {self.bend:g} with "linear"')
            if self.bend > (most := MOST_BEND[self.form]):
                raise ValueError(f'bend must be from 0 to {most:g} with form="{self.form}", got {self.bend:g}')
            return self
        if self.strain is None or self.force is None:
            raise ValueError("strain and force belong together, got one of them", "give both")
        if self.permanent is not None or self.bend or self.form != "linear":
            raise ValueError("permanent, form and bend are given beside strain and force, which say the same",
                             "leave out the ones or the others")
        _check_measured(self.strain, self.force)
        return self

    @property
    def permanent_share(self) -> float:
        """Return the permanent strain as a share of the highest one."""
        if self.strain is not None:
            return self.strain[0] / self.strain[-1]
        assert self.permanent is not None  # by the check above
        return self.permanent

    def shape(self) -> np.ndarray:
        """Return the numbers of the segments of the shape, from 0 to 1; below 0 the rope is slack."""
        return numbers(*giving_way(*self._points()))

    def _points(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return places, values and slopes of the shape."""
        if self.strain is not None and self.force is not None:
            from scipy.interpolate import PchipInterpolator  # slow to import

            strain, force = np.array(self.strain), np.array(self.force)
            x, y = (strain - strain[0]) / (strain[-1] - strain[0]), force / force[-1]
            return x, y, PchipInterpolator(x, y).derivative()(x)
        if self.form == "exponential" and self.bend > 0:
            x = np.linspace(0, 1, MAX_POINTS)
            rise = np.expm1(self.bend)
            return x, np.expm1(self.bend * x) / rise, self.bend * np.exp(self.bend * x) / rise
        return ENDS, ENDS, 1 + self.bend * np.array([-1.0, 1.0])

    def force_at(self, first: np.ndarray, strain: np.ndarray, highest: np.ndarray) -> np.ndarray:
        """Return the force in N at strains and highest strains, arrays; first: numbers of the table of the cable."""
        low = self.permanent_share * highest
        with np.errstate(divide="ignore", invalid="ignore"):
            below = value(first, highest) * value(self.shape(), (strain - low) / (highest - low))
        return np.where((strain < highest) & (highest > 0), below, value(first, strain))


def _check_measured(strain: tuple[float, ...], force: tuple[float, ...]) -> None:
    """Raise ValueError unless these are an unloading curve."""
    check_function(strain, "strain", "", force, "force")
    if len(strain) > MAX_POINTS:
        raise ValueError(f"has {len(strain)} points, at most {MAX_POINTS} are possible",
                         "give fewer points where the force is straight")
    if strain[0] < 0:
        raise ValueError(f"strain must not be negative, got {strain[0]:g}",
                         "a rope that has been stretched is not shorter than before")
    if force[0] != 0:
        raise ValueError(f"force must begin at 0, got {show(force[0], 'N')}",
                         "add the point of the permanent strain, at which the rope becomes slack")
    for before, after in pairwise(force):
        if not after > before:
            raise ValueError(f"force must increase with strain, got {show(after, 'N')} after {show(before, 'N')}")
