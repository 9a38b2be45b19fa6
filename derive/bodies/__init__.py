"""Body specs, one short file each; what can ride a slide."""

from funicular.derive.bodies import planar_rigid, rigid
from funicular.derive.bodies.point import POINTS

BODIES = {body.NAME: body for body in (rigid, planar_rigid)}
RIDERS = BODIES | POINTS
