"""What tests expect of runs and of messages, where more than one test file does."""

import re

import numpy as np
import pytest
from funicular import EndOfCableError, Run, Scene, SceneError

INTEGRATORS = ("explicit", "radau", "genalpha")


def refused(message: str, error=SceneError):
    """Return the context that expects this error with the whole message, so that no part of it can get lost."""
    return pytest.raises(error, match="^" + re.escape(message) + "$")


def to_the_end(scene: Scene, *args, **settings) -> tuple[Run, str]:
    """Return a run that must leave its cable, and its message."""
    try:
        scene.run(*args, **settings)
    except EndOfCableError as stopped:
        return stopped.run, str(stopped)
    raise AssertionError("the slide was to run off its cable")


def largest(difference) -> float:
    """Return the largest magnitude among numbers."""
    return float(np.abs(difference).max())


def energy_error(run: Run) -> float:
    """Return the largest error of the energy balance, as a part of the energy exchanged."""
    return largest(run.energy_balance().relative)


def unaccounted(run: Run) -> float:
    """Return the most energy that is not accounted for since the start, in J."""
    return largest(run.energy_balance().residual)


def drift(run: Run) -> float:
    """Return by how much the energy that is not accounted for changes, in J."""
    return float(np.ptp(run.energy_balance().residual))


def slide_events(run: Run) -> list[str]:
    """Return the words of the events of a run's slides, in order."""
    return [event["what"] for event in run.report["events"]]
