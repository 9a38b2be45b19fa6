"""Body specs, one short file each; what can ride a slide."""

from . import planar_rigid, rigid
from .point import POINTS

BODIES = {body.NAME: body for body in (rigid, planar_rigid)}
RIDERS = BODIES | POINTS
