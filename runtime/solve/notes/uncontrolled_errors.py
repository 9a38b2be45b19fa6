"""Errors that the error of positions, by which steps are chosen, does not include."""

from __future__ import annotations

import numpy as np

from ...engine import Engine, outputs_by_name
from ...integrators import AUTO, GeneralisedAlpha, stable_at
from ...model.model import SlideModel
from ...parts.scene_data import SceneData
from ...parts.settings import RunSettings
from .fast_turns import FastTurns
from .note import Note, Rows
from .supersonic_loads import outrunning

MIN_REVERSALS, MIN_REVERSAL_RATE = 5, 0.1
"""A normal force vibrates if it changes its sign this number of times, and in this fraction of the output intervals. A
zip line whose rider rebounds from its buffer has 11 reversals in 500 intervals and errs by 0.02 tol; released wires
have 7 and 13 in 40."""


class NormalForces(Note):
    """How often the force on the rider of each slide with friction reversed between two output times, the number of
    output times, and the last force in N.
    """

    measures = (SlideModel,)

    def prepare(self) -> None:
        """Select the parts to measure."""
        self._slides = [(k, slide.name) for k, slide in enumerate(self.model.slides)
                        if _has_friction(self.scene, slide.name)]

    def see(self, rows: Rows) -> None:
        """Measure further output rows."""
        for k, name in self._slides:
            rider = outputs_by_name("slide", rows["slide"][:, k])["force"]
            count, times, last = self.found.get(name, (0, 0, [0.0, 0.0, 0.0]))
            force = np.concatenate([[last], rider])
            count += int(np.sum(np.sum(force[1:] * force[:-1], axis=1) < 0))
            self.found[name] = [count, times + len(rows["time"]), force[-1].tolist()]

    @property
    def vibrating(self) -> list[str]:
        """The slides whose normal force vibrates about zero; the friction then depends on each reversal."""
        return [name for name, (count, times, _) in self.found.items()
                if count >= max(MIN_REVERSALS, MIN_REVERSAL_RATE * times)]


def _has_friction(scene: SceneData, name: str) -> bool:
    """Return whether a slide has friction that depends on its normal force."""
    friction = scene.slides[name].friction
    return friction is not None and bool(friction.coefficient or friction.rolling)


def uncontrolled_errors(scene: SceneData, engine: Engine, settings: RunSettings, turns: FastTurns | None,
                        forces: NormalForces | None) -> list[str]:
    """Return a note where the steps of "genalpha" or "radau" were chosen without errors that may be large."""
    if settings.step is not None or not engine.moves:
        return []
    vibrating = [] if forces is None else _of_vibrating(engine, forces.vibrating)
    if engine.integrator == "radau":
        return vibrating
    if engine.integrator == GeneralisedAlpha.name:
        return _of_genalpha(scene, engine, settings, turns) or vibrating
    return []


def _of_genalpha(scene: SceneData, engine: Engine, settings: RunSettings, turns: FastTurns | None) -> list[str]:
    """Friction, unless "auto" allows for it, bodies that turn fast, slides that outrun the waves of their cable."""
    rubs = settings.integrator != AUTO or settings.spectral_radius is not None
    fast = [] if turns is None else turns.uncontrolled(engine.statistics["steps"], settings.tol)
    errors = [*(f'the friction of slide "{name}"' for name in scene.slides if rubs and _has_friction(scene, name)),
              *(f'how fast body "{name}" turns' for name in fast),
              *(f'the shock before slide "{name}", which is faster than waves in its cable'
                for name in outrunning(scene))]
    if not errors:
        return []
    return [f'integrator "{engine.integrator}" chooses its steps by the error of positions alone, which does not see '
            f'{", nor ".join(errors)}: errors may be 10 times tol and more. Take '
            f'integrator="{stable_at(fixed_step=False).name}", or give estimate=True, which measures them']


def _of_vibrating(engine: Engine, vibrating: list[str]) -> list[str]:
    """Friction under a normal force that vibrates: the method damps vibrations that its steps do not resolve."""
    if not vibrating:
        return []
    slides = " and ".join(f'"{name}"' for name in vibrating)
    return [f"the normal force at slide {slides} vibrates about zero, and friction with it: steps of integrator "
            f'"{engine.integrator}" need not resolve these vibrations, and errors may be 10 times tol and more. Take '
            'integrator="explicit", give the cable more damping, or give estimate=True, which measures the errors']
