"""Errors that the error of positions, by which steps are chosen, does not include."""

from __future__ import annotations

from ...engine import Engine
from ...integrators import stable_at
from ...parts.scene_data import SceneData
from ...parts.settings import RunSettings
from .normal_forces import has_friction
from .row_notes import RowNotes
from .supersonic_loads import outrunning


def uncontrolled_errors(scene: SceneData, engine: Engine, settings: RunSettings, seen: RowNotes) -> list[str]:
    """Return a note where the steps of "genalpha" or "radau" were chosen without errors that may be large."""
    if settings.step is not None or not engine.moves:
        return []
    found = {"genalpha": _of_genalpha, "radau": _of_radau}.get(engine.integrator)
    return [] if found is None else found(scene, engine, settings, seen)


def _of_genalpha(scene: SceneData, engine: Engine, settings: RunSettings, seen: RowNotes) -> list[str]:
    """Friction, bodies that turn fast, slides that outrun the waves of their cable."""
    errors = [*(f'the friction of slide "{name}"' for name in scene.slides if has_friction(scene, name)),
              *_turning(engine, settings, seen),
              *(f'the shock before slide "{name}", which is faster than waves in its cable'
                for name in outrunning(scene))]
    return _beyond_positions(engine, errors)


def _turning(engine: Engine, settings: RunSettings, seen: RowNotes) -> list[str]:
    """Return in words how the bodies turn that turn fast for a method of second order."""
    return [f'how fast body "{name}" turns' for name in seen.turns.unseen(engine.statistics["steps"], settings.tol)]


def _beyond_positions(engine: Engine, errors: list[str]) -> list[str]:
    """Return a note on errors that the error of positions does not include, if there are any."""
    if not errors:
        return []
    return [f'integrator "{engine.integrator}" chooses its steps by the error of positions alone, which does not see '
            f'{", nor ".join(errors)}: errors may be 10 times tol and more. Take '
            f'integrator="{stable_at(fixed_step=False).name}", or give estimate=True, which measures them']


def _of_radau(scene: SceneData, engine: Engine, settings: RunSettings, seen: RowNotes) -> list[str]:
    """Friction under a normal force that vibrates: the method damps vibrations that its steps do not resolve."""
    slides = " and ".join(f'"{name}"' for name in seen.normal_forces.vibrating)
    if not slides:
        return []
    return [f"the normal force at slide {slides} vibrates about zero, and friction with it: steps of integrator "
            '"radau" need not resolve these vibrations, and errors may be 10 times tol and more. Take '
            'integrator="explicit", give the cable more damping, or give estimate=True, which measures the errors']
