"""What integrator "energy" asks of a scene: a discrete gradient of all that acts."""

from __future__ import annotations

from ..engine import Engine
from ..errors import SceneError
from ..kernels.libraries import of_library
from ..model.model import Model
from ..parts.scene_data import SceneData
from .integrators import EnergyMomentum


def check_conserves(model: Model, scene: SceneData, engine: Engine, method: EnergyMomentum) -> None:
    """Raise SceneError for what has no discrete gradient, or lacks the algorithmic dissipation that is asked for."""
    for body in model.bodies:
        if body.modes:
            raise SceneError(scene.bodies[body.name].where, 'integrator "energy" does not know modal bodies',
                             'take "radau" with a small tol, or "genalpha"')
    for cable in model.cables:
        if not of_library(cable.library)[cable.element].laws[cable.law].discrete_gradient:
            raise SceneError(scene.cables[cable.name].where,
                             f'integrator "energy" has no discrete gradient of the law "{cable.law}"',
                             "take another law, or another integrator")
    if method.spectral_radius < 1:
        for cable in [model.cables[i] for i in engine.without_algorithmic_force()]:
            raise SceneError(scene.cables[cable.name].where,
                             f'integrator "energy" has no algorithmic dissipation of the law "{cable.law}"',
                             "take spectral_radius = 1, another law, or another integrator")
    for slide in scene.slides.values():
        if slide.friction is not None or (slide.at_start, slide.at_end) != ("error", "error"):
            raise SceneError(slide.where, 'integrator "energy" knows neither friction nor ends of cables',
                             "take another integrator: genalpha, radau and explicit do")
    parts = [*(scene.joints[joint.name] for joint in model.joints if joint.slide is None),
             *(slide for slide, of in zip(scene.slides.values(), model.slides, strict=True)
               if not of.rider_is_rigid or of.drive >= 0 or slide.frame != "point")]
    for part in parts:
        raise SceneError(part.where, 'integrator "energy" has no discrete gradient of it',
                         "take another integrator: genalpha and radau know all joints")
