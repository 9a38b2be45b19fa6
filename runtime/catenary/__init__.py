"""The catenary over a railway and the pantographs below it: built, formed, run, and judged by the contact force."""

from .form import Form, form
from .line import Line
from .pantograph import Pantograph, add_pantograph
from .scenes import scene
from .wires import Droppers, SteadyArm, Wire, mass_damping

__all__ = ["Droppers", "Form", "Line", "Pantograph", "SteadyArm", "Wire", "add_pantograph", "form", "mass_damping",
           "scene"]
