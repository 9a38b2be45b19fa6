"""The catenary over a railway and the pantographs below it: built, formed, run, and judged by the contact force."""

from .form import Form, form
from .line import Droppers, Line, SteadyArm, Wire
from .pantograph import Pantograph, add_pantograph
from .scenes import scene

__all__ = ["Droppers", "Form", "Line", "Pantograph", "SteadyArm", "Wire", "form", "scene"]
