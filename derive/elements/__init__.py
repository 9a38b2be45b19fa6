"""Element specs, one short file each."""

from funicular.derive.elements.beam24 import BEAM24

ELEMENTS = {e.name: e for e in (BEAM24,)}
