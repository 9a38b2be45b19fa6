"""Expectations on runs and messages that several test files share."""

import re

import numpy as np
import pytest
from funicular import EndOfCableError, Run, Scene, SceneError

INTEGRATORS = ("explicit", "radau", "genalpha")


def refused(message: str, error=SceneError):
    """Return the context that expects this error with its whole message."""
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
    """Return the largest error of the energy balance, relative to the energy exchanged."""
    return largest(run.energy_balance().relative)


def unaccounted(run: Run) -> float:
    """Return the largest unexplained energy since the start, J."""
    return largest(run.energy_balance().residual)


def drift(run: Run) -> float:
    """Return the range of the unexplained energy, J."""
    return float(np.ptp(run.energy_balance().residual))


def slide_events(run: Run) -> list[str]:
    """Return the words of the events of a run's slides, in order."""
    return [event["what"] for event in run.report["events"]]
