"""Element specs, one short file each."""

from funicular.derive.elements.beam12p import BEAM12P
from funicular.derive.elements.beam24 import BEAM24
from funicular.derive.elements.cable8p import CABLE8P
from funicular.derive.elements.cable12 import CABLE12
from funicular.derive.elements.cable18 import CABLE18

ELEMENTS = {e.name: e for e in (BEAM24, CABLE12, CABLE18, BEAM12P, CABLE8P)}
