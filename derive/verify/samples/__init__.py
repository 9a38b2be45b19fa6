"""Sample inputs of the kernels: ordinary states with finite rotation and strain, the same on every machine.

Sizes are stout and of order one, so that no term hides below the rounding of another.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from ...codegen.family import Family
from ..numbers import Numbers, State
from . import body, crossing, drag, element, frame, joint, law, modal, point_law, resistance, slide

SEEDS = (20050401, 20050705)  # days on which the paper was received and accepted


class Sampler(NamedTuple):
    """How a role is sampled: sample(family, exact, random), and at_rest(family, exact, first sample) where that is
    another case.
    """

    sample: Callable[[Any, Numbers, np.random.Generator], State]
    at_rest: Callable[[Any, Numbers, State], State] | None = None


OF_ROLE = {
    "element": Sampler(element.sample, element.at_rest), "law": Sampler(law.sample, law.at_rest),
    "slide": Sampler(slide.sample, slide.at_rest), "body": Sampler(body.sample, body.at_rest),
    "modal": Sampler(modal.sample, modal.at_rest), "frame": Sampler(frame.sample), "joint": Sampler(joint.sample),
    "resistance": Sampler(resistance.sample), "drag": Sampler(drag.sample),
    "crossing": Sampler(crossing.sample),
    "point_law": Sampler(point_law.sample)}


def states(family: Family, exact: Numbers) -> list[State]:
    """Return states of a family: values by argument name, with `rectangle` and the second rates that only paths use.

    Constants that one kernel makes for another (m, A) come from the 50-digit programs: a fault in the compiled one
    then shows up there and nowhere else.
    """
    sampler = OF_ROLE[family.role]
    found = [sampler.sample(family, exact, np.random.default_rng(seed)) for seed in SEEDS]
    return found if sampler.at_rest is None else [*found, sampler.at_rest(family, exact, found[0])]
