"""Inputs of a run: the signals of a model that they give."""

from __future__ import annotations

from collections.abc import Sequence

from ...engine import Engine
from ...errors import SceneError
from ...model.breakpoints import driving_signals
from ...model.model import Model
from ...parts.inputs import Input, Term, terms_of


def take_inputs(model: Model, engine: Engine, inputs: Sequence[Input], use: str) -> None:
    """Give an engine that is not started the inputs of its model's scene; use: of the inputs, in messages.

    Raises SceneError for an input that acts beside other functions of time, or on nothing.
    """
    if not inputs:
        return
    driving = driving_signals(model) | {drag.signal for drag in model.drags if drag.has_inertia}
    numbers = {id(each.held): k for k, each in enumerate(inputs)}
    signals, used = [], set[int]()
    for number, each in enumerate(model.signals):
        if each.of is None or each.of.is_known:
            continue
        try:
            terms = list(terms_of(each.of))
        except ValueError as error:
            raise SceneError(use, f"an input {error.args[0]}", "drive other directions by numbers") from None
        used |= {id(term.held) for term in terms}
        signals.append((number, number in driving, sum(term.factor for term in terms if term.held is None),
                        [_numbered(term, numbers) for term in terms if term.held is not None]))
    for given in inputs:
        if id(given.held) not in used:
            raise SceneError(use, f'nothing depends on the input "{given.path}"', "leave it out")
    engine.take_inputs([given.held.start for given in inputs], signals)


def _numbered(term: Term, numbers: dict[int, int]) -> tuple[int, int, float]:
    return numbers[id(term.held)], term.order, term.factor
