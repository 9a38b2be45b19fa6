"""Springs with dampers between two attachments."""

from typing import Annotated, Self

from pydantic import model_validator

from .force_segments import HAS_NO_FORCE, PULLS_ALONE, ForceTable, Segment, pulling, tabulated, with_play
from .point_force import PointForce
from .validation import Flag, not_negative


class Spring(PointForce):
    """A spring with a damper between two points of cables, ropes, bodies or the ground.

    a, b: ends: ("wire", s), ("haul", s) of the material of a rope, ("A", (x, y, z)) in body axes, "A" for the origin of
        a body, or a point (x, y, z) of the ground, m
    stiffness: N/m
    damping: N s/m
    length: free of force, m; by default the distance at the start
    tension_only: whether it has no force while it is shorter than its length; its damper then never pushes
    free_play: range of distances about its length in which neither spring nor damper acts, m
    table: tension by extension beyond the length, in the place of a stiffness
    """

    kind = "spring"
    stiffness: Annotated[float, not_negative("N/m")] | None = None
    damping: Annotated[float, not_negative("N s/m")] = 0.0
    length: Annotated[float, not_negative("m")] | None = None
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

    def segments(self) -> list[Segment]:
        """Return the segments of its law."""
        if self.table is not None:
            return tabulated(self.table, self.tension_only)
        assert self.stiffness is not None, f"{self.where} has no stiffness"
        if self.tension_only:
            return pulling(self.free_play / 2, self.stiffness)
        return with_play(self.free_play, self.stiffness)

    @property
    def loses_direction(self) -> bool:
        """Return whether it has a force, and so no direction, where its points meet."""
        if self.length is None or not self.has_segments:
            return self.length != 0.0
        meeting = next(segment for segment in self.segments() if self.length + segment.end > 0)
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
        if self.table is not None:
            self.segments()
        return self
