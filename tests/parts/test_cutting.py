"""Chains of elements that much is attached to are cut into pieces: the same motion and rest, at a linear cost."""

import numpy as np
import pytest
from funicular import catenary
from funicular.model import cutting
from funicular.model.build import build
from test_catenary import line55


def scene(spans=3):
    return catenary.scene(line55(spans=spans), (3.0, 6.0))


def uncut(monkeypatch):
    monkeypatch.setattr(cutting, "MAX_ATTACHMENTS", 10**6)


def work(made):
    """Return the operations that a factorisation takes for the chains, their columns of the border, and the border."""
    sizes = np.diff(made.chains)
    columns = np.bincount(made.newton.strips[:, 1], minlength=len(sizes))
    return float((sizes * made.width * (made.width + 2 * columns)).sum() + made.newton.operations)


def test_motion_and_rest_are_those_of_whole_chains(monkeypatch):
    runs, rests = [], []
    for whole in (False, True):
        if whole:
            uncut(monkeypatch)
        made = scene()
        made.force("contact", s=60.0, value=(0, 500, 0))
        rests.append(made.equilibrium()["contact.position"])
        runs.append(made.run(duration=0.1, step=2e-3, integrator="genalpha", spectral_radius=0.5,
                             initial=scene().equilibrium())["contact.position"])
    assert rests[0] == pytest.approx(rests[1], abs=1e-7)
    assert runs[0] == pytest.approx(runs[1], abs=1e-8)


def test_chains_are_cut_and_the_work_is_linear(monkeypatch):
    models = [build(scene(spans)) for spans in (4, 8, 16)]
    assert all(len(model.chains) > 8 for model in models)
    at = [work(model) for model in models]
    assert at[2] / at[1] < 2.2
    uncut(monkeypatch)
    whole = [work(build(scene(spans))) for spans in (4, 8)]
    assert whole[1] / whole[0] > 3
    assert whole[1] > 3 * at[1]


def test_few_attachments_leave_a_chain_whole():
    model = build(scene(2))
    assert len(model.chains) - 1 <= 3
