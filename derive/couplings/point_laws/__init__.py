"""Laws of the force between two points, one a file.

A file here is a law by being here: its name is the law's, its `LAW` says what the law is.
"""

from importlib import import_module
from pkgutil import iter_modules

from ...spec import PointLaw

LAWS: dict[str, PointLaw] = {file.name: import_module(f".{file.name}", __name__).LAW for file in iter_modules(__path__)}
