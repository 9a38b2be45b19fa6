"""Element specs, one short file each."""

from .beam12p import BEAM12P
from .beam24 import BEAM24
from .cable8p import CABLE8P
from .cable12 import CABLE12
from .cable18 import CABLE18

ELEMENTS = {e.name: e for e in (BEAM24, CABLE12, CABLE18, BEAM12P, CABLE8P)}
