"""A kernel stage by stage: its program in vector notation, with the names of the program."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..codegen.program import Program
from .lift import Lift, only, scalar_name
from .markdown import Line
from .notation.latex import latex
from .scopes import Scope, State, Symbol, column, entry, programs_of


def staged_scope(scope: Scope, kernel: str, outputs: tuple[str, ...]) -> tuple[Scope, list[tuple[str, list[Line]]]]:
    """Return the scope of a kernel's own names, and its stages: titles with formulas, the outputs last."""
    program = programs_of(scope.family.name)[kernel]
    if outputs:
        program = only(program, *outputs)
    lift = Lift(program, scope.family.facts.get("dim") or scope.family.dim or _dim(scope))
    symbols = tuple(_symbols(program, lift))
    stages = [(title, [Line(latex(e)) for e in equations]) for title, equations in lift.stages()]
    last = [Line(latex(e), output=f"{kernel}.{name}") for name, e in lift.outputs()]
    return Scope(scope.family, symbols, adapted=_as(scope)), [*stages, ("outputs", last)]


def _dim(scope: Scope) -> int:
    assert scope.family.element is not None
    return scope.family.element.dim


def _as(scope: Scope) -> Any:
    return lambda _, state: scope.adapted(scope, state)


def _symbols(program: Program, lift: Lift) -> list[Symbol]:
    found = []
    for argument in program.inputs:
        symbols = np.atleast_1d(program.symbols[argument.name])
        whole = {s for s in symbols.ravel() if s in lift.vectors.component}
        for group, parts in lift.vectors.groups:
            if parts and parts[0] in whole:
                places = [tuple(int(i) for i in np.argwhere(symbols == p)[0]) for p in parts]
                found.append(Symbol(latex(group), argument.name, _taking(places)))
        if not whole:
            for place, symbol in np.ndenumerate(symbols):
                part = entry(*place) if argument.shape else lambda v: float(np.asarray(v).item())
                found.append(Symbol(latex(scalar_name(symbol.name)), argument.name, part))
    return found


def _taking(places: list[tuple[int, ...]]) -> Any:
    return lambda v: column(np.array([np.asarray(v)[place] for place in places]))


__all__ = ["State", "staged_scope"]
