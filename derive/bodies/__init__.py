"""Body specs, one short file each."""

from funicular.derive.bodies import planar_rigid, rigid

BODIES = {body.NAME: body for body in (rigid, planar_rigid)}
