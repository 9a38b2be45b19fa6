"""Searches for values of equilibria, and their derivatives by differences of whole scenes."""

import numpy as np
from funicular.parts.in_plane import in_plane
from funicular.parts.settings import EquilibriumSettings
from funicular.results.equilibrium import Equilibrium
from funicular.results.targets import reader
from funicular.solve.adjustment import parameter_search
from funicular.solve.adjustment.parameter_changes import Changes
from funicular.solve.adjustment.parameter_search import ParameterSearch
from funicular.solve.adjustment.parameters import Parameters
from funicular.solve.statics.static import equilibrium


def search_of(scene, paths, to):
    """Return a search for these values at the equilibrium of the scene."""
    settings = EquilibriumSettings(adjust=dict.fromkeys(paths, "free"), to=dict.fromkeys(to, 0.0))
    rest = equilibrium(in_plane(scene), settings, None, Equilibrium)
    search = ParameterSearch(Parameters(scene, settings.adjust), settings, Equilibrium, reader(rest, to))
    return search, search.begin(rest)


def found_of(search, at):
    """Return the paths of the parameters with known columns of the residual, in order."""
    found = Changes(at.problem, dict(enumerate(search.parameters.paths)), search.reader).found
    return [path.text for k, path in enumerate(search.parameters.paths) if k in found]


def by_scenes(search, at, monkeypatch, step=1e-4):
    """Return dx/dp and dg/dp by differences of scenes with two steps, extrapolated; steps below 1e-4 make reactions
    rounding.
    """
    ends = []
    with monkeypatch.context() as patch:
        patch.setattr(parameter_search, "Changes", NoChanges)
        for h in (step, 2 * step):
            patch.setattr(parameter_search, "DIFFERENCE_STEP", h)
            ends.append(search.linear(at))
    return [(4 * near - far) / 3 for near, far in zip(*ends, strict=True)]


def apart(found, wanted):
    """Return (n,) distances of columns (rows, n), relative to the largest number of each, which must exist."""
    scales = np.max(np.abs(wanted), axis=0)
    assert (scales > 0).all(), scales
    return np.max(np.abs(found - wanted), axis=0) / scales


class NoChanges(Changes):
    """Changes that leave all parameters to differences of scenes."""

    def __init__(self, problem, paths, reader):
        super().__init__(problem, {}, reader)
