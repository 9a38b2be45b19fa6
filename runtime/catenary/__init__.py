"""The catenary over a railway and the pantographs below it: built, formed, run, and judged by the contact force."""

from .assessment import assess, contacts, losses, low_pass, plot_droppers, plot_force, plot_uplift, uplift
from .form import Form, form, scene
from .head import Head
from .jointed import JointedPantograph, Limb
from .line import Line
from .pantograph import Pantograph
from .passing import add_pantograph
from .wires import Droppers, End, SteadyArm, Wire, mass_damping

__all__ = ["Droppers", "End", "Form", "Head", "JointedPantograph", "Limb", "Line", "Pantograph", "SteadyArm", "Wire",
           "add_pantograph", "assess", "contacts", "form", "losses", "low_pass", "mass_damping", "plot_droppers",
           "plot_force", "plot_uplift", "scene", "uplift"]
