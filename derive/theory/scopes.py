"""Meanings of the symbols of a chapter: the inputs of its kernels, at random points.

Samples are those of `funicular verify`: bent, stretched, turned; sizes of order one.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache, cached_property
from typing import Any

import numpy as np

from ..catalogue import families
from ..codegen.family import CouplingFamily, Family, PointLawFamily, SlideFamily
from ..codegen.piecewise import NUMERICAL, CubicIntegral, CubicSlope, CubicValue
from ..codegen.program import Argument, Program
from ..verify import numbers as verify_numbers
from ..verify.samples import states
from ..verify.samples.shapes import reference
from .notation.evaluate import Definitions, Evaluation
from .notation.parse import parse
from .notation.tree import Name

TOLERANCE = 1e-12
"""Of a printed formula against the compiled kernel, relative to the largest entry of the output."""

State = dict[str, Any]
MAX_LEGEND_ROWS = 6
"""Largest number of symbols of one argument with their own rows in a legend."""
_OTHERS = {"rectangle": ("height and width of the section's rectangle", "m"),
           "D": ("elastic constants, the same all over the section", "N/m^2")}


@dataclass(frozen=True)
class Symbol:
    """A symbol in LaTeX, the argument of the kernels that it is, and the part of it."""

    latex: str
    argument: str
    part: Callable[[np.ndarray], Any]
    blocks: int = 0
    words: str = ""

    @property
    def name(self) -> Name:
        """Return the symbol as it stands in formulas."""
        found = parse(self.latex)
        assert isinstance(found, Name)
        return found


def _key(latex: str) -> str:
    name = parse(latex)
    assert isinstance(name, Name)
    return name.key


def number(v: np.ndarray) -> float:
    """Return the only entry."""
    return float(np.asarray(v).item())


def column(v: np.ndarray) -> np.ndarray:
    """Return all entries, one below the other, row by row; one entry alone is a number."""
    flat = np.asarray(v, dtype=object).reshape(-1, 1)
    return flat if flat.size > 1 else flat.item()


def matrix(v: np.ndarray) -> np.ndarray:
    """Return it as it is."""
    return np.asarray(v, dtype=object)


def entry(*index: int) -> Callable[[np.ndarray], float]:
    """Return what takes one entry."""
    return lambda v: float(np.asarray(v)[index])


def row(k: int) -> Callable[[np.ndarray], Any]:
    """Return what takes one row as a column."""
    return lambda v: column(np.asarray(v)[k])


def entries(first: int, last: int) -> Callable[[np.ndarray], Any]:
    """Return what takes a run of entries as a column."""
    return lambda v: column(np.asarray(v)[first:last])


@cache
def programs_of(family: str) -> dict[str, Program]:
    """Return the programs of a family by the name without the family's."""
    return {p.name.removeprefix(f"{family}_"): p.prune() for p in families()[family].build()}


@cache
def samples_of(family: str) -> list[State]:
    """Return the states at which the formulas of a family are evaluated."""
    exact = verify_numbers.exact(family, list(programs_of(family).values()))
    return states(families()[family], exact)


def compiled(family: str, kernel: str, state: Mapping[str, Any]) -> dict[str, np.ndarray]:
    """Return the outputs of a compiled kernel of this installation, by name."""
    from ...generated import kernels

    program = programs_of(family)[kernel]
    values = getattr(kernels, program.name)(*(state[a.name] for a in program.inputs))
    values = values if isinstance(values, tuple) else (values,)
    return {a.name: np.asarray(v) for a, v in zip(program.outputs, values, strict=True)}


@dataclass(frozen=True)
class Scope:
    """A family of kernels whose inputs the symbols of a chapter are.

    adapted   changes a sample before it is used, as where a constant of the section is to be known to the formulas
    constants values of symbols that no kernel takes, from a sample
    """

    family: Family
    symbols: tuple[Symbol, ...]
    adapted: Callable[[Scope, State], State] = lambda scope, state: state
    constants: Callable[[Scope, State], dict[str, Any]] = lambda scope, state: {}

    @cached_property
    def states(self) -> list[State]:
        """Return the sample states, the ordinary ones."""
        return [self.adapted(self, dict(state)) for state in samples_of(self.family.name)[:2]]

    @cached_property
    def arguments(self) -> dict[str, Argument]:
        """Return what the programs of the family say of their inputs, by name."""
        return {a.name: a for p in programs_of(self.family.name).values() for a in p.inputs}

    def legend(self) -> list[list[str]]:
        """Return a row for each symbol: symbol, argument, what it is, unit; many of one argument share a row."""
        rows = []
        for argument in dict.fromkeys(s.argument for s in self.symbols):
            of = [s for s in self.symbols if s.argument == argument]
            known = self.arguments.get(argument)
            if known is None and argument not in _OTHERS:
                continue  # of kernels that another family has for this one
            about = (known.doc, known.unit) if known else _OTHERS[argument]
            if len(of) > MAX_LEGEND_ROWS:
                of_them = f"${of[0].latex}$ to ${of[-1].latex}$"
                rows.append([of_them, f"`{argument}`", *about])
            else:
                rows += [[f"${s.latex}$", f"`{argument}`", *about] for s in of]
        return rows

    def definitions(self) -> Definitions:
        """Return the place for definitions, with what of the inputs has blocks."""
        return Definitions(blocks={s.name.key: s.blocks for s in self.symbols if s.blocks})

    def evaluation(self, definitions: Definitions, state: State) -> Evaluation:
        """Return what evaluates formulas at a state."""
        values = {s.name.key: s.part(state[s.argument]) for s in self.symbols if s.argument in state}
        dim = self.family.facts.get("dim") or self.family.dim or (self.family.element.dim if self.family.element else 3)
        constants = {r"\mathbf{I}": np.eye(dim).astype(object), "t": 0.0} | self.constants(self, state)
        return Evaluation(definitions, values | {_key(latex): value for latex, value in constants.items()})


# --- the scopes of the chapters ---------------------------------------------------------------------------------

_PLACE = (Symbol("x", "at", entry(0)), Symbol("y", "at", entry(1)), Symbol("z", "at", entry(2)))
_BAR = (Symbol("l", "l", number), Symbol("h", "rectangle", entry(0)), Symbol("b", "rectangle", entry(1)))


def _nodal(dim: int, latex: str, argument: str) -> Symbol:
    return Symbol(latex, argument, column, dim)


def _counts(scope: Scope, state: State) -> dict[str, Any]:
    element = scope.family.element
    assert element is not None
    return {"n": float(element.n_vectors)}


def element_scope(name: str) -> Scope:
    """Return the scope of an element's own kernels."""
    family = families()[name]
    dim = family.facts["dim"]
    rows = ("A", "I_{yy}", "I_{zz}", "I_{yyyy}", "I_{yyzz}", "I_{zzzz}")
    return Scope(family, (*_BAR, *_PLACE, Symbol(r"\rho", "density", number), _nodal(dim, r"\mathbf{e}", "e"),
                          Symbol(r"\mathbf{g}", "g", column), _nodal(dim, r"\ddot{\mathbf{e}}", "a"),
                          *(Symbol(s, "section", entry(k)) for k, s in enumerate(rows)),
                          Symbol(r"\mathbf{c}", "c", column), Symbol(r"\boldsymbol{\mu}", "M", column)),
                 constants=_counts)


def _with_constants(scope: Scope, state: State) -> State:
    """Return the sample with one elastic law all over the section, and the constants A that the kernels make of it."""
    traits = scope.family.traits
    if traits and traits.kind == "continuum" and traits.takes_shape:
        return state  # its constants are a sum over points
    if "D" in state:
        state["S"] = np.outer(state["D"], state["section"])
    return state | {"A": compiled(scope.family.name, "stiffness", state)["A"]}


def law_scope(name: str) -> Scope:
    """Return the scope of a law on an element."""
    family = families()[name]
    element, traits = family.element, family.traits
    assert element is not None and traits is not None
    dim = element.dim
    shape = [_nodal(dim, r"\mathbf{e}_{0}", "e0")] if traits.takes_shape else []
    common = (*_BAR, *shape, _nodal(dim, r"\mathbf{e}", "e"), _nodal(dim, r"\dot{\mathbf{e}}", "v"),
              Symbol(r"\tau", "tau", number), Symbol("c", "rate", number))
    if traits.kind == "cable":
        own = [Symbol(r"\mathrm{EA}", "S", entry(0)), Symbol(r"\mathrm{EI}", "S", entry(1))]
        if traits.membrane == "assumed":
            own.append(Symbol(r"\mathrm{EA}_{u}", "S", entry(2)))
        if traits.membrane == "tension_only":
            own += [Symbol(r"\rho", "S", entry(2)), Symbol(r"\varepsilon_{t}", "S", entry(3))]
    elif traits.kind == "structural":
        return Scope(family, (*common, Symbol("x", "x", number)), constants=_of_law)
    else:
        axes = range(1, dim + 1)
        pairs = [(i, j) for i in axes for j in axes if i < j]
        names = [f"D_{{{i}{i}}}" for i in axes] + [f"D_{{{i}{j}}}" for i, j in pairs] + [f"G_{{{i}{j}}}"
                                                                                         for i, j in pairs]
        own = [Symbol(s, "D", entry(k)) for k, s in enumerate(names)]
        own += [Symbol(f"S_{{{k},{m}}}", "S", entry(k - 1, m - 1)) for k in range(1, len(names) + 1)
                for m in range(1, 7)]
    return Scope(family, (*common, *own, Symbol("x", "x", number)), adapted=_with_constants, constants=_of_law)


def _of_law(scope: Scope, state: State) -> dict[str, Any]:
    element = scope.family.element
    assert element is not None
    known = _counts(scope, state) | {"y": 0.0, "z": 0.0}
    if scope.family.traits and scope.family.traits.takes_shape:
        return known
    return known | {r"\mathbf{e}_{0}": column(reference(element, float(state["l"])))}


def slide_scope(name: str) -> Scope:
    """Return the scope of the slide of a rider on an element."""
    family = families()[name]
    element = family.element
    assert element is not None
    dim = element.dim
    cable: tuple[Symbol, ...] = (Symbol("l", "l", number), Symbol("s", "x", number), _nodal(dim, r"\mathbf{e}", "e"),
                                 _nodal(dim, r"\dot{\mathbf{e}}", "v"))
    if ends_of(family):
        n = element.n_coordinates
        cable = (_nodal(dim, r"\mathbf{e}", "e"), Symbol(r"\dot{\mathbf{e}}", "v", entries(0, n), dim),
                 *(Symbol(rf"\dot{{s}}_{{{k + 1}}}", "v", entry(n + k)) for k in range(len(ends_of(family)))))
    rider = (Symbol(r"\mathbf{R}", "b", entries(0, dim)), Symbol(r"\mathbf{u}", "u", column),
             Symbol(r"\dot{\mathbf{R}}", "w", entries(0, dim)), *_attitude(family))
    if family.rider not in ("point", "planar_point"):
        rider = (*rider, Symbol(r"\boldsymbol{\omega}", "w", entries(dim, 6)))
    return Scope(family, (*cable, *rider, Symbol(r"\mathbf{d}", "director", column),
                          Symbol(r"\mathbf{f}", "f", column)), constants=_on_rope if ends_of(family) else _at_rest)


def ends_of(family: Family) -> list[str]:
    """Return the material coordinates of nodes that are coordinates of a slide's cable: of a rope, else none."""
    return ["s_{1}", "s_{2}"] if isinstance(family, SlideFamily) and family.flows else []


def _on_rope(scope: Scope, state: State) -> dict[str, Any]:
    """Return also the material coordinates of a slide and of both nodes, counted from the first one."""
    return _at_rest(scope, state) | {"s": float(state["x"]), "s_{1}": 0.0, "s_{2}": float(state["l"])}


def _attitude(family: Family) -> tuple[Symbol, ...]:
    dim = family.facts["dim"]
    if family.rider in ("point", "planar_point"):
        return ()
    if dim == 2:
        return Symbol("c", "b", entry(2)), Symbol(r"\sigma", "b", entry(3))
    return Symbol("q_{0}", "b", entry(3)), Symbol(r"\mathbf{q}", "b", entries(4, 7))


def _at_rest(scope: Scope, state: State) -> dict[str, Any]:
    turns = {2: 0.0, 3: np.zeros((3, 1)).astype(object)}[scope.family.facts["dim"]]
    more = _counts(scope, state) if scope.family.element else {}
    return more | {r"\boldsymbol{\theta}": turns, r"\boldsymbol{\theta}_{0}": turns, "y": 0.0, "z": 0.0}


def body_scope(name: str) -> Scope:
    """Return the scope of a rigid body."""
    family = families()[name]
    dim = family.facts["dim"]
    return Scope(family, (Symbol("m", "mass", number), *_inertia(dim),
                          Symbol(r"\mathbf{R}", "b", entries(0, dim)), *_attitude(family),
                          Symbol(r"\mathbf{u}", "u", column), Symbol(r"\dot{\mathbf{R}}", "w", entries(0, dim)),
                          Symbol(r"\boldsymbol{\omega}", "w", entries(dim, 6)),
                          Symbol(r"\ddot{\mathbf{R}}", "a", entries(0, dim)),
                          Symbol(r"\dot{\boldsymbol{\omega}}", "a", entries(dim, 6)),
                          Symbol(r"\mathbf{f}", "f", column)), constants=_at_rest)


def _inertia(dim: int) -> tuple[Symbol, ...]:
    return (Symbol(r"\mathbf{J}", "J", matrix),) if dim == 3 else (Symbol("J", "J", entry(2, 2)),)


def modal_scope(name: str) -> Scope:
    """Return the scope of a modal body."""
    moments = [Symbol(rf"\mathbf{{S}}_{{{k}}}", f"S{k or ''}", column) for k in range(3)]
    moments += [Symbol(rf"\mathbf{{X}}_{{{k}}}", f"X{k or ''}", matrix) for k in range(3)]
    moments += [Symbol(rf"\mathbf{{Y}}_{{{k}}}", f"Y{k or ''}", matrix) for k in range(3)]
    body = body_scope(name)
    return Scope(body.family, (*(s for s in body.symbols if s.argument != "J"), *moments,
                               Symbol(r"\mathbf{s}", "s", column), Symbol(r"\mathbf{g}", "g", column),
                               Symbol(r"X_{\mathrm{rates}}", "X11", number)), constants=_at_rest)


def _column_of(k: int) -> Callable[[np.ndarray], Any]:
    return lambda v: column(np.asarray(v)[:, k])


def joint_scope(name: str) -> Scope:
    """Return the scope of a joint between two frames."""
    family = families()[name]
    axes = [Symbol(rf"\mathbf{{{a}}}_{{{n}}}^{{0}}", f"A{n}", _column_of(k))
            for n in (1, 2) for k, a in enumerate("xyz"[: family.dim])]
    return Scope(family, (Symbol(r"\mathbf{gap}", "gap", column), *axes,
                          *(Symbol(f"c_{{{k}}}", "c", entry(k)) for k in range(3)),
                          Symbol(r"\mathbf{f}", "f", column), Symbol(r"\dot{\mathbf{gap}}", "gap_rate", column),
                          Symbol(r"\dot{c}", "c_rate", entry(0)), Symbol(r"\ddot{c}", "c_rate", entry(1)),
                          *(Symbol(rf"\boldsymbol{{\omega}}_{{{n}}}", f"omega{n}", column) for n in (1, 2))),
                 constants=_no_turn)


def frame_scope(name: str) -> Scope:
    """Return the scope of the frame of two vectors."""
    vectors = [Symbol(rf"{mark}{{\mathbf{{{v}}}}}" if mark else rf"\mathbf{{{v}}}", f"{v}{suffix}", column)
               for v in "ab" for mark, suffix in (("", ""), (r"\dot", "_rate"), (r"\ddot", "_second"))]
    return Scope(families()[name], (*vectors, Symbol(r"\mathbf{m}", "m", column)))


def _no_turn(scope: Scope, state: State) -> dict[str, Any]:
    turn = {2: 0.0, 3: np.zeros((3, 1)).astype(object)}[scope.family.dim or 3]
    return {rf"\boldsymbol{{\theta}}_{{{sub}}}": turn for sub in ("1", "2", "1,0", "2,0")}


PARAMETERS = {"stiffness": "k", "damping": "c", "length": "L", "reference": "L_{0}", "tension": "T_{0}",
              "energy": "U_{0}"}
"""What parameters of forces between two points are called in formulas; others by their number."""


def point_law_scope(name: str) -> Scope:
    """Return the scope of a force between two points."""
    family = families()[name]
    assert isinstance(family, PointLawFamily), f"{name} is no law of a force between two points"
    parameters = [Symbol(PARAMETERS.get(parameter, f"p_{{{k}}}"), "parameters", entry(k))
                  for k, parameter in enumerate(family.point_law.parameters)]
    return Scope(family, (*parameters, Symbol(r"\mathbf{gap}", "gap", column),
                          Symbol(r"\dot{\mathbf{gap}}", "gap_rate", column)))


def resistance_scope(name: str) -> Scope:
    """Return the scope of friction and buffers."""
    letters = (r"\mu", r"\mu_{v}", "v_{0}", r"\delta", "N_{0}")
    friction = [Symbol(s, "friction", entry(k)) for k, s in enumerate(letters)]
    buffer = [Symbol(s, "buffer", entry(k)) for k, s in enumerate(("k", "c", "x", r"\sigma"))]
    return Scope(families()[name], (Symbol(r"\mathbf{t}", "t", column), Symbol(r"\mathbf{w}", "u", column),
                                    Symbol(r"\mathbf{f}", "f", column), *friction, *buffer))


def branch_scope(name: str) -> Scope:
    """Return the scope of branches beside the law of a cable."""
    return Scope(families()[name], tuple(Symbol(rf"\mathbf{{{letter}}}", letter, column) for letter in "abn"))


def working_curve_scope(name: str) -> Scope:
    """Return the scope of working curves of a rope."""
    return Scope(families()[name], (Symbol(r"\mathbf{a}", "a", column), Symbol("e", "e", number),
                                    Symbol("H", "highest", number), Symbol("p", "permanent", number),
                                    Symbol("n", "n", number)), constants=_of_tables)


def _of_tables(scope: Scope, state: State) -> dict[str, Any]:
    """Return integrals, values and slopes of the tables of a working curve at their places."""
    integral, value, slope = (NUMERICAL[kind.c_name] for kind in (CubicIntegral, CubicValue, CubicSlope))
    first, shape, e, H, p = (state[name] for name in ("first", "shape", "e", "highest", "permanent"))
    x = (e - p * H) / ((1 - p) * H)
    return {"N_{H}": value(first, H), "N_{e}": value(first, e), "W_{e}": integral(first, e),
            r"N_{e}^{\prime}": slope(first, e), "g": value(shape, x), r"g^{\prime}": slope(shape, x),
            "G": integral(shape, x)}


def drag_scope(name: str) -> Scope:
    """Return the scope of drag."""
    return Scope(families()[name], (Symbol(r"\mathbf{t}", "t", column), Symbol(r"\mathbf{w}", "w", column),
                                    *(Symbol(s, "c", entry(k)) for k, s in enumerate(("c_{n}", "c_{t}", "w_{0}"))),
                                    *(Symbol(s, "c_lift", entry(k)) for k, s in enumerate(("c_{l}", "w_{l}"))),
                                    *(Symbol(s, "c_point", entry(k)) for k, s in enumerate(("c_{p}", "w_{p}"))),
                                    *(Symbol(s, "c_foil", entry(k)) for k, s in enumerate(("c_{f}", "w_{f}"))),
                                    *(Symbol(s, "coefficients", entry(k)) for k, s in enumerate(
                                        ("C_{D}", "C_{D,1}", "C_{L}", "C_{L,1}"))),
                                    Symbol(r"\mathbf{d}", "d", column),
                                    *(Symbol(s, "c_section", entry(k)) for k, s in enumerate(("c_{b}", "b", "w_{b}"))),
                                    *(Symbol(s, "polar", entry(k)) for k, s in enumerate(
                                        ("C_{d}", "C_{d,1}", "C_{l}", "C_{l,1}", "C_{m}", "C_{m,1}"))),
                                    Symbol(r"\dot{\mathbf{t}}", "t_rate", column),
                                    *(Symbol(rf"\mathbf{{{letter}}}", letter, column) for letter in "avU"),
                                    Symbol(r"\mathbf{U}_{1}", "U_rate", column), Symbol(r"\mathbf{G}", "G", matrix),
                                    *(Symbol(s, "wet", entry(k)) for k, s in enumerate(
                                        ("c", "c_{1}", "c_{2}", "c_{0}"))),
                                    Symbol(r"\mathbf{z}", "up", column), Symbol("m_{d}", "displaced", number),
                                    *(Symbol(s, "m", entry(k)) for k, s in enumerate(("m_{n}", "m_{t}"))),
                                    Symbol(r"\mathbf{s}", "s", column), Symbol(r"\mathbf{A}", "A", matrix),
                                    Symbol(r"\mathbf{C}", "C", matrix),
                                    Symbol(r"\boldsymbol{\omega}", "omega", column),
                                    Symbol("u", "u", entry(0)), Symbol(r"\delta", "delta", entry(0)),
                                    *_wave_symbols()))


def _wave_symbols() -> tuple[Symbol, ...]:
    """Return the symbols of a wave at a point."""
    return (Symbol(r"\mathbf{x}", "place", column), Symbol(r"\tau", "time", number), Symbol(r"\mathbf{k}", "k", column),
            *(Symbol(s, "wave", entry(k)) for k, s in enumerate(("a", r"\omega", r"\varphi", "k", "q"))),
            Symbol(r"\gamma", "cosine", number), Symbol(r"\sigma", "sine", number), Symbol("P", "grow", number),
            Symbol("z", "height", number), Symbol(r"\eta", "eta", number), Symbol(r"\dot{\eta}", "eta_t", number),
            Symbol(r"\boldsymbol{\eta}_{r}", "eta_r", column), Symbol("D", "inv_depth", number),
            Symbol(r"\dot{Z}", "Z_t", number), Symbol(r"\mathbf{Z}_{r}", "Z_r", column))


def crossing_scope(name: str) -> Scope:
    """Return the scope of contact of lines at their closest points."""
    family = families()[name]
    assert isinstance(family, CouplingFamily), f"{name} is no coupling"
    letters = (r"\rho", r"\sigma", "k_{1}", "k_{2}", r"\lambda", "p_{0}", r"\mu", "v_{0}")
    law = [Symbol(s, "c", entry(k)) for k, s in enumerate(letters)]
    rows = [Symbol(latex, argument, row(k)) for argument, names in (
        ("t", (r"\mathbf{a}", r"\mathbf{b}")), ("k", (r"\boldsymbol{\kappa}_{a}", r"\boldsymbol{\kappa}_{b}")),
        ("w", (r"\dot{\mathbf{a}}", r"\dot{\mathbf{b}}")), ("t_0", (r"\mathbf{a}_{0}", r"\mathbf{b}_{0}")),
        ("t_rate", (r"\mathbf{a}_{1}", r"\mathbf{b}_{1}"))) for k, latex in enumerate(names[:family.dim - 1])]
    of_spring = [Symbol(latex, argument, entry(k)) for argument, names in (
        ("e", ("e_{a}", "e_{b}")), ("x", ("x_{1}", "x_{2}")), ("v", ("y_{1}", "y_{2}")),
        ("s_rate", ("c_{a}", "c_{b}"))) for k, latex in enumerate(names[:family.dim - 1])]
    return Scope(family, (Symbol(r"\mathbf{d}", "d", column), *rows, Symbol(r"\mathbf{u}", "u", column), *law,
                          *of_spring, Symbol("h", "h", number), Symbol(r"\mathbf{d}_{0}", "d_0", column),
                          Symbol(r"\mathbf{d}_{1}", "d_rate", column), Symbol("r_{0}", "r_0", number),
                          Symbol("k_{t}", "k_t", number),
                          Symbol(r"\mu_{t}", "mu", number)))


def surface_scope(name: str) -> Scope:
    """Return the scope of surfaces and contact with them."""
    vectors = [Symbol(rf"\mathbf{{{letter}}}", argument, column)
               for letter, argument in (("y", "y"), ("m", "normal"), ("a", "axis"), ("n", "n"), ("x", "x"), ("w", "w"))]
    numbers = [Symbol(letter, argument, number) for letter, argument in (
        ("R", "radius"), ("d", "depth"), ("v", "depth_rate"), ("k_{t}", "k_t"), (r"\mu", "mu"), ("v_{0}", "v0"))]
    return Scope(families()[name], (*vectors, *numbers, Symbol("k", "law", entry(0)), Symbol("c", "law", entry(1)),
                                    Symbol("p", "normal_force", entry(0))))


def span_scope(name: str) -> Scope:
    """Return the scope of a span of a rope: an element whose ends flow along the rope."""
    family = families()[name]
    dim = family.facts["dim"]
    stiffness = [Symbol(rf"\mathrm{{EA}}{sub}" if k != 1 else r"\mathrm{EI}", "A", entry(k))
                 for k, sub in enumerate(("", "", "_{u}"))]
    ends = [Symbol(rf"\{accent}{{s}}_{{{k + 1}}}", argument, entry(k))
            for accent, argument in (("dot", "s_rate"), ("ddot", "s_acc")) for k in range(2)]
    return Scope(family, (Symbol("l", "l", number), _nodal(dim, r"\mathbf{e}", "e"),
                          _nodal(dim, r"\dot{\mathbf{e}}", "v"), _nodal(dim, r"\ddot{\mathbf{e}}", "a"), *ends,
                          Symbol(r"\rho", "rho", number), Symbol(r"\mathbf{g}", "g", column), *stiffness,
                          Symbol(r"\tau", "tau", number), Symbol("c", "part", number), Symbol("u", "u", number),
                          Symbol(r"\mathbf{h}", "F", column)), constants=_of_span)


def _of_span(scope: Scope, state: State) -> dict[str, Any]:
    return _counts(scope, state) | {"x": float(state["xi"] * state["l"])}


def sheave_scope(name: str) -> Scope:
    """Return the scope of a rope on a sheave or a drum."""
    vectors = [Symbol(latex, argument, column) for latex, argument in (
        (r"\mathbf{x}", "x"), (r"\dot{\mathbf{x}}", "x_rate"), (r"\ddot{\mathbf{x}}", "x_acc"),
        (r"\mathbf{t}", "slope"), (r"\dot{\mathbf{t}}", "slope_rate"), (r"\boldsymbol{\lambda}", "f"),
        (r"\mathbf{t}_{1}", "slope"), (r"\mathbf{t}_{2}", "span_slope"),
        (r"\mathbf{c}", "c"), (r"\dot{\mathbf{c}}", "c_rate"), (r"\ddot{\mathbf{c}}", "c_acc"), (r"\mathbf{g}", "g"))]
    ends = [Symbol(f"{latex}_{{{k + 1}}}", argument, entry(k)) for latex, argument in (
        (r"\phi", "phi"), (r"\dot{\phi}", "phi_rate"), (r"\ddot{\phi}", "phi_acc"), (r"\dot{s}", "s_rate"),
        (r"\ddot{s}", "s_acc")) for k in range(2)]
    numbers = [Symbol(latex, argument, number) for latex, argument in (
        ("R", "R"), ("l", "l"), (r"\sigma", "sense"), (r"\rho", "rho"), (r"\tau", "tau"), ("f", "tension"),
        (r"\dot{\psi}", "spin"), (r"\ddot{\psi}", "spin_acc"), ("u", "u"), (r"\dot{u}", "u_rate"), ("w", "winds"),
        (r"\lambda_{w}", "wound"), (r"\lambda_{s}", "span_stretch"))]
    return Scope(families()[name], (*vectors, *ends, *numbers, Symbol(r"\mathrm{EA}", "A", entry(0)),
                                    Symbol(r"\mathrm{EI}", "A", entry(1))))


def tangent_point_scope(name: str) -> Scope:
    """Return the scope of the tangent point of a rope on a sheave in space."""
    vectors = [Symbol(latex, argument, column) for latex, argument in (
        (r"\mathbf{x}", "x"), (r"\dot{\mathbf{x}}", "x_rate"), (r"\mathbf{d}", "chord"),
        (r"\dot{\mathbf{d}}", "chord_rate"), (r"\mathbf{t}", "slope"), (r"\dot{\mathbf{t}}", "slope_rate"),
        (r"\mathbf{w}", "weight"), (r"\mathbf{a}", "axis"), (r"\dot{\mathbf{a}}", "axis_rate"),
        (r"\boldsymbol{\lambda}", "f"))]
    numbers = [Symbol(latex, argument, number) for latex, argument in (
        ("R", "R"), ("l", "l"), (r"\rho", "rho"), ("w", "w"), (r"\dot{w}", "w_rate"), (r"\ddot{w}", "w_acc"),
        ("g", "g"), ("b", "b"), (r"\dot{b}", "b_rate"), (r"\mathrm{EA}", "EA"), ("N_{0}", "limit"),
        (r"\beta", "by_chord"))]
    ends = [Symbol(rf"{latex}_{{{k + 1}}}", argument, entry(k)) for latex, argument in (
        (r"\dot{s}", "s_rate"), (r"\ddot{s}", "s_acc"), (r"\phi", "phi"), (r"\dot{\phi}", "phi_rate"),
        (r"\ddot{\phi}", "phi_acc"), (r"\dot{\Omega}", "omega_acc"), ("I", "inertia")) for k in range(2)]
    ends += [Symbol(rf"{latex}_{{{k + 1}}}", argument, entry(k)) for latex, argument in (
        (r"\Omega", "omega"), ("v", "c_rate"), ("a", "c_acc"), ("g", "gravity")) for k in range(3)]
    spin = Symbol(r"\dot{\psi}", "spin", number), Symbol(r"\dot{I}_{1}", "growth", number)
    return Scope(families()[name], (*vectors, *numbers, *ends, *spin))


def rope_point_scope(name: str) -> Scope:
    """Return the scope of a material point of a rope."""
    nodes = [Symbol(rf"{accent.format(letter)}_{{{node + 1}}}", argument, row(2 * node + k))
             for accent, argument in ((r"\mathbf{{{}}}", "e"), (r"\dot{{\mathbf{{{}}}}}", "v"))
             for node in range(2) for k, letter in enumerate("rt")]
    ends = [Symbol(rf"{letter}_{{{k + 1}}}", argument, entry(k))
            for letter, argument in (("s", "s"), (r"\dot{s}", "s_rate")) for k in range(2)]
    shares = [Symbol(letter, "share", entry(k)) for k, letter in enumerate("ab")]
    return Scope(families()[name], (*nodes, *ends, *shares, Symbol("S", "S", number),
                                    Symbol(r"\mathbf{f}", "f", column)))


def taut_rope_scope(name: str) -> Scope:
    """Return the scope of a rope without mass."""
    numbers = [Symbol(latex, argument, number) for latex, argument in (
        ("h", "rise"), (r"\mathrm{EA}", "EA"), (r"\tau", "tau"), ("r", "ratio"), ("x", "x"))]
    ends = [Symbol(latex, argument, entry(k)) for latex, argument, k in (
        ("d_{1}", "d", 0), ("d_{2}", "d", 1), ("w_{1}", "w", 0), ("w_{2}", "w", 1), ("L", "lengths", 0),
        ("w", "lengths", 1), (r"\dot{L}", "rates", 0), (r"\dot{w}", "rates", 1), ("L_{0p}", "past", 0),
        ("L_{p}", "past", 1), ("k_{1}", "weights", 0), ("k_{2}", "weights", 1))]
    return Scope(families()[name], (Symbol(r"\mathbf{d}", "d", column), *numbers, *ends))


def taut_part_scope(name: str) -> Scope:
    """Return the scope of a straight part of a rope without mass in space."""
    ends = [Symbol(rf"{latex}_{{{k + 1}}}", argument, entry(k)) for latex, argument in (
        ("b", "angle"), (r"\rho", "reach"), ("w", "aside"), ("R", "R")) for k in range(2)]
    wheel = [Symbol(latex, argument, number) for latex, argument in (
        ("I", "inertia"), (r"\dot{\psi}", "own"), (r"\dot{\Omega}", "acc"))]
    vectors = [Symbol(latex, argument, column) for latex, argument in (
        (r"\mathbf{d}", "d"), (r"\mathbf{a}", "axis"), (r"\boldsymbol{\omega}", "omega"))]
    return Scope(families()[name], (*vectors, *ends, *wheel, Symbol(r"\mathbf{A}_{1}", "one", matrix),
                                    Symbol(r"\mathbf{A}_{2}", "other", matrix)))


def scope(role: str, name: str) -> Scope:
    """Return the scope of a family: the function of this module called as its role makes it."""
    found: Scope = globals()[f"{role}_scope"](name)
    return found
