"""The linear model of motion about the start, with the generalised-alpha method."""

from __future__ import annotations

from ..base.deferred import dataclass
from .genalpha import GeneralisedAlpha


@dataclass(frozen=True)
class Linear(GeneralisedAlpha):
    """Motion about the configuration at the start, with constant mass, damping and stiffness of cables and joints.

    A step needs no matrix of its own, and no nonlinear element: for motions that are small beside the spans, such as
    those of a contact wire. Springs that go slack, contacts that wander, slides without friction, bodies and loads are
    exact; steps of a fixed size end neither where a spring goes slack nor where a rider passes a node. Each slide takes
    a solution or two more a step: beyond ten on a cable another integrator is cheaper. The error of the model is of the
    second order in the motion; it is estimated in every eighth row of output. In time it is the generalised-alpha
    method over the free coordinates.
    """

    name = "linear"
    takes_modal_bodies = False
    is_linear = True
