"""What the error of positions, by which "genalpha" chooses its steps, does not tell of."""

from __future__ import annotations

from ..engine import Engine
from ..integrators import stable_at
from ..parts.scene_data import SceneData
from ..parts.settings import RunSettings
from .fast_riders import outrunning
from .fast_turns import FastTurns


def unseen_errors(scene: SceneData, engine: Engine, settings: RunSettings, turns: FastTurns) -> list[str]:
    """Return a note where "genalpha" chose its steps in a scene with friction, with bodies that turn fast, or with
    slides that outrun the waves of their cable.
    """
    if engine.integrator != "genalpha" or settings.step is not None or not engine.moves:
        return []
    rubbing = [slide.name for slide in scene.slides.values()
               if slide.friction is not None and (slide.friction.coefficient or slide.friction.rolling)]
    turning = turns.unseen(engine.statistics["steps"], settings.tol)
    unseen = [*(f'the friction of slide "{name}"' for name in rubbing),
              *(f'how fast body "{name}" turns' for name in turning),
              *(f'the shock before slide "{name}", which is faster than waves in its cable'
                for name in outrunning(scene))]
    if not unseen:
        return []
    return [f'integrator "genalpha" chooses its steps by the error of positions alone, which does not see '
            f'{", nor ".join(unseen)}: errors may be 10 times tol and more. Take '
            f'integrator="{stable_at(fixed_step=False).name}", or give estimate=True, which measures them']
