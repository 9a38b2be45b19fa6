"""Body specs, one short file each; riders of slides."""

from . import planar_rigid, rigid
from .body import Body, Rider
from .point import POINTS

__all__ = ["BODIES", "RIDERS", "Body", "Rider"]

BODIES: dict[str, Body] = {rigid.NAME: rigid, planar_rigid.NAME: planar_rigid}
RIDERS: dict[str, Rider] = {**BODIES, **POINTS}
