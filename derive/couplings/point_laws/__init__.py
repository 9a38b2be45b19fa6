"""Laws of the force between two points, one a file.

Every file here is a law with the name of the file; its `LAW` describes it.
"""

from importlib import import_module
from pkgutil import iter_modules

from ...spec import PointLaw

LAWS: dict[str, PointLaw] = {file.name: import_module(f".{file.name}", __name__).LAW for file in iter_modules(__path__)}
