"""Samples of the kernels of a law."""

from __future__ import annotations

import numpy as np

from ...codegen.family import LawFamily
from ...codegen.piecewise import SEGMENT
from ...laws import kernels as law_kernels
from ...spec import MAX_SEGMENTS, LawTraits
from ..exact import ExactProgram
from ..numbers import Numbers, State
from ..references import curved_continuum
from .element import element_state, straight
from .step import following


def sample(family: LawFamily, exact: Numbers, random: np.random.Generator) -> State:
    """Return a bent element with the stiffness S of a section and the law's constants A."""
    element = family.element
    state = element_state(element, random)
    if not any(a.name == "e0" for program in exact.programs.values() for a in program.inputs):
        del state["e0"]
    state |= following(family, state, random.spawn(1)[0])
    state["f"] = random.normal(size=element.dim)
    state["a"] = random.normal(size=(element.n_vectors, element.dim))
    state |= section_stiffness(family.traits, element.dim, state["section"], random)
    if "algorithmic_force" in exact.programs:
        strains = exact.programs["algorithmic_force"].outputs[1].size
        state |= {"weight": np.float64(0.6), "relaxed_strain": random.spawn(1)[0].normal(size=strains)}
    return state | _constants(family, exact, state)


def at_rest(family: LawFamily, exact: Numbers, first: State) -> State:
    """Return the first sample, straight and undeformed; a law for curved shapes has a straight one here."""
    rest = first | straight(family.element)
    if family.traits.straight:
        rest["e0"] = rest["e"]
        rest |= _constants(family, exact, rest)
    return rest


def _constants(family: LawFamily, exact: Numbers, state: State) -> State:
    """Return the constants A that other kernels of the law make."""
    s = exact.state(state)
    if "stiffness_at" not in exact.programs:
        return {"A": exact("stiffness", s)["A"].astype(float)}
    points = [exact("stiffness_at", s, at=at, D=D) for at, D in curved_continuum.weighted_points(family.element, s)]
    of_straight = law_kernels.Kernels(family.element, family.traits.straight).set_up()
    A = ExactProgram(of_straight)([s["l"], s["S"]])["A"]
    return {"A": np.concatenate([A, sum(p["A"] for p in points), points[0]["G0"]]).astype(float)}


def section_stiffness(traits: LawTraits, dim: int, moments: np.ndarray,
                      random: np.random.Generator) -> State:
    """Return the argument S of a law; for a continuum also elastic constants, D over the section and D_axis on the axis
    alone.
    """
    if traits.kind == "structural":
        return {"S": np.array([*random.uniform(1, 4, 9), 0.5]) if dim == 3 else random.uniform(1, 4, 4)}
    if traits.kind == "cable":
        S = 53.0 * moments[:2]
        more = {"assumed": [0.6 * S[0]], "tension_only": [0.2, 0.1]}.get(traits.membrane, [])
        if traits.membrane == "tabulated":
            more = segments(S[0], random)
        return {"S": np.array([*S, *more])}
    pairs = dim * (dim - 1) // 2
    D, on_axis_alone = (np.concatenate([random.uniform(40, 60, dim), random.uniform(5, 15, pairs),
                                        random.uniform(10, 20, pairs)]) for _ in range(2))
    return {"S": np.outer(D, moments) + np.outer(on_axis_alone, moments * [1, 0, 0, 0, 0, 0]), "D": D,
            "D_axis": on_axis_alone}


def segments(EA: float, random: np.random.Generator, end: float = 0.4) -> list[float]:
    """Return cubic segments of an axial force with kinks of the slope, from strain 0."""
    starts = np.linspace(0, end, MAX_SEGMENTS - 1)
    found, integral, value = [], 0.0, 0.0
    for start, step in zip(starts, [*np.diff(starts), 0.0], strict=True):
        slope, c2, c3 = EA * random.uniform(0.5, 1.5), EA * random.uniform(-1, 1), EA * random.uniform(-5, 5)
        found += [start, integral, value, slope, c2, c3]
        integral += step * (value + step * (slope / 2 + step * (c2 / 3 + step * c3 / 4)))
        value += step * (slope + step * (c2 + step * c3))
    return [len(starts), *found, *[0.0] * SEGMENT]
