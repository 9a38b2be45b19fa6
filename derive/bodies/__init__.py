"""Body specs, one short file each; what can ride a slide."""

from . import planar_rigid, rigid
from .body import Body, Rider
from .point import POINTS

__all__ = ["BODIES", "RIDERS", "Body", "Rider"]

BODIES: dict[str, Body] = {rigid.NAME: rigid, planar_rigid.NAME: planar_rigid}
RIDERS: dict[str, Rider] = {**BODIES, **POINTS}
