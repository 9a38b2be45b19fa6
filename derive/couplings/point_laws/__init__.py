"""Laws of the force between two points, one a file.

Every file here is a law with the name of the file; its `LAW` describes it.
"""

from importlib import import_module
from pkgutil import iter_modules

from ...codegen.family import PointLawFamily
from ...spec import PointLaw
from ..point_law import families_of

LAWS: dict[str, PointLaw] = {file.name: import_module(f".{file.name}", __name__).LAW for file in iter_modules(__path__)}


def families() -> list[PointLawFamily]:
    """Return the families of all laws."""
    return [family for name, law in LAWS.items() for family in families_of(name, law)]
