"""Springs with dampers between two attachments."""

from collections.abc import Callable
from typing import Annotated, Self

from pydantic import model_validator

from .driven import Driven
from .force_segments import HAS_NO_FORCE, PULLS_ALONE, ForceTable, Segment, pulling, tabulated, with_play
from .point_force import PointForce
from .signal import Signal, at_start, extremes, varying
from .validation import Flag, not_negative


class Spring(PointForce):
    """A spring with a damper between two points of cables, ropes, bodies or the ground.

    a, b: ends: ("wire", s), ("haul", s) of the material of a rope, ("A", (x, y, z)) in body axes, "A" for the origin of
        a body, or a point (x, y, z) of the ground, m
    stiffness: a number or a signal, N/m
    damping: N s/m, on the rate of the extension
    length: free of force, a number or a signal, as of a rope that a winch takes in, m; by default the distance at the
        start. Work of signals is in ``energy.external``
    tension_only: whether it has no force while it is shorter than its length; its damper then never pushes
    free_play: range of distances about its length in which neither spring nor damper acts, m
    table: tension by extension beyond the length, in the place of a stiffness
    """

    kind = "spring"
    stiffness: Annotated[float | Signal, varying(not_negative("N/m"))] | None = None
    damping: Annotated[float, not_negative("N s/m")] = 0.0
    length: Annotated[float | Signal, varying(not_negative("m"))] | None = None
    tension_only: Flag = False
    free_play: Annotated[float, not_negative("m")] = 0.0
    table: ForceTable | None = None

    @property
    def law(self) -> str:
        """Return the name of its law, that of a file in derive/couplings/point_laws."""
        if self.has_segments:
            return "spring_segment"
        return "spring" if self.length else "zero_length_spring"

    @property
    def has_segments(self) -> bool:
        """Return whether its law has several segments; a spring of zero length has tension only."""
        return self.table is not None or self.free_play > 0 or (self.tension_only and self.length != 0.0)

    def driven(self) -> dict[str, Driven]:
        """Return the quantities that its signals prescribe: the change of its length, in m, from the longest one, and
        the factor of its stiffness, of the largest one.
        """
        found = {}
        if isinstance(self.length, Signal):
            found["length"] = Driven(self.length, -extremes(self.length)[1], 1.0)
        if isinstance(self.stiffness, Signal):
            found["stiffness"] = Driven(self.stiffness, 0.0, 1 / extremes(self.stiffness)[1])
        return found

    @property
    def largest(self) -> Self:
        """Return the spring with numbers in the place of signals, the largest values of these."""
        return self._with_numbers(lambda made: extremes(made)[1])

    @property
    def as_started(self) -> Self:
        """Return the spring with numbers in the place of signals, the values at t = 0."""
        return self._with_numbers(at_start)

    def _with_numbers(self, of: Callable[[Signal], float]) -> Self:
        signals = {name: of(value) for name, value in (("length", self.length), ("stiffness", self.stiffness))
                   if isinstance(value, Signal)}
        return self.completed(signals) if signals else self

    def segments(self) -> list[Segment]:
        """Return the segments of its law."""
        if self.table is not None:
            return tabulated(self.table, self.tension_only)
        assert isinstance(self.stiffness, float), f"{self.where} has no number as its stiffness"
        if self.tension_only:
            return pulling(self.free_play / 2, self.stiffness)
        return with_play(self.free_play, self.stiffness)

    @property
    def loses_direction(self) -> bool:
        """Return whether it has a force, and so no direction, where its points meet."""
        if self.length is None or not self.has_segments:
            return self.length != 0.0
        length = at_start(self.length)
        meeting = next(segment for segment in self.as_started.segments() if length + segment.end > 0)
        return meeting.sense != HAS_NO_FORCE

    @property
    def only_pulls(self) -> bool:
        """Return whether it has tension only, by tension_only or its table."""
        return self.tension_only or (self.table is not None and all(
            segment.sense in (PULLS_ALONE, HAS_NO_FORCE) for segment in self.segments()))

    def at_distance(self, distance: float) -> Self:
        """Return the spring with its length, by default the initial distance of its points."""
        return self.completed({"length": distance}) if self.length is None else self

    @model_validator(mode="after")
    def _has_a_law(self) -> Self:
        if self.table is not None and self.stiffness is not None:
            raise ValueError("has both a stiffness and a table", "give one of them")
        if self.table is not None and self.free_play:
            raise ValueError("has both free play and a table", "write the free play into the table, as zero tension")
        if self.table is None and not self.stiffness and (self.damping == 0 or self.tension_only or self.free_play):
            needs = " with tension_only or free_play" * bool(self.tension_only or self.free_play)
            raise ValueError("has neither stiffness nor damping" if not needs else f"needs a stiffness{needs}",
                             "give one of them, or both" if not needs else "give a positive stiffness")
        if isinstance(self.stiffness, Signal) and not extremes(self.stiffness)[1] > 0:
            raise ValueError("stiffness is a signal that is never above 0", "give a positive stiffness")
        if self.table is not None:
            self.segments()
        return self
