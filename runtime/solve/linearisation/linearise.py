"""The linear model of a scene about a state of rest: x' = A x + B u, y = C x + D u."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np
from scipy.sparse import csr_array, vstack

from ...errors import SceneError
from ...model.build import build
from ...model.model import Model
from ...parts.in_plane import in_plane
from ...parts.rope import rough_sheaves
from ...parts.scene_data import SceneData
from ...parts.settings import EquilibriumSettings
from ..linear.condensation import condensed
from ..modes.contact_edges import resolve_contact_edges
from ..modes.modes import fewer_elements, go_to
from ..modes.stuck_wraps import stuck_wraps
from ..statics.balance import Balance, balance, imbalance
from ..statics.rest_state import RestState
from ..statics.static_problem import StaticState, without_waves
from ..statics.sticking_ropes import with_sticking_wraps
from .basis import basis_of
from .columns import Columns
from .equations import Equations, equations
from .inputs import inputs_of
from .kinks import refuse_kinks
from .names import Coordinate, of_parts
from .outputs import Output, Outputs

IMPROPER = 1e-9
"""Of an output's largest coefficient below which the one of a rate of an input is rounding."""
NEGLIGIBLE = 1e-12
"""Coefficient of a rate of an input that is rounding beside none."""


@dataclass(frozen=True, eq=False)
class Linearised:
    """A linear model: matrices, names and units; see `funicular.results.linear_model.LinearModel`."""

    A: np.ndarray
    B: np.ndarray
    C: np.ndarray
    D: np.ndarray
    mass: np.ndarray
    damping: np.ndarray
    stiffness: np.ndarray
    states: list[str]
    state_units: list[str]
    inputs: list[str]
    input_units: list[str]
    input_values: np.ndarray
    outputs: list[str]
    output_units: list[str]
    output_values: np.ndarray
    basis: str
    squares: np.ndarray | None
    messages: list[str] = field(default_factory=list)


def drawn_in_balance(drawn: SceneData) -> bool:
    """Return whether forces balance in a scene as its user drew it."""
    scene = in_plane(drawn)
    model = build(scene)
    without_waves(model)
    return balance(StaticState(scene, EquilibriumSettings(), model)).at_rest


def linearise(drawn: SceneData, inputs: Sequence[str], outputs: Sequence[str], about: RestState | None,
              reduce: int | None) -> Linearised:
    """Return the linear model of a scene about a state of rest, None: as drawn, in balance. Raises SceneError."""
    scene, stick = in_plane(drawn), about is not None and about.wraps == "stick"

    def model_of(each: SceneData) -> Model:
        return build(with_sticking_wraps(each) if stick else each)

    static = _at_rest(scene, model_of, about)
    model = static.model
    static.engine.vibrate(True)
    free = equations(static)
    held, sticking = _held(free, scene, stick)
    own = equations(static, held) if held.shape[0] else free
    given = inputs_of(static, scene, drawn, inputs, model_of)
    basis = basis_of(own, scene, sticking, reduce, fewer_elements(model))
    refuse_kinks(own, basis.Z)
    columns = Columns(own, held, basis, given, reduce is not None)
    results = Outputs(static, scene, of_parts(free, scene))
    named = results.find(outputs)
    C, D = _rows(columns, results, named)
    more = [f"{each.name.rpartition('.')[0]}.position" for each in given if each.is_rate]
    units = [each.unit.removesuffix("/s") for each in given if each.is_rate]
    return Linearised(columns.A, columns.B, C, D, basis.mass, basis.damping, basis.stiffness,
                      [*basis.names, *basis.rates, *more], [*basis.units, *basis.rate_units, *units],
                      [each.name for each in given], [each.unit for each in given],
                      np.array([each.value for each in given]), [each.name for each in named],
                      [each.unit for each in named], results.values(named, about), basis.said,
                      basis.squares if not np.any(basis.damping) and not more else None,
                      _messages(scene, sticking, stick, columns) + _stability(about))


def _at_rest(scene: SceneData, model_of: Callable[[SceneData], Model], about: RestState | None) -> StaticState:
    """Return the static state about which the model is, in which forces balance. Raises SceneError."""
    for contact in scene.contacts.values():
        if contact.has_friction_spring and contact.a not in scene.ropes:
            raise SceneError(contact.where, "its friction holds points by springs, whose stretch in a state of rest is "
                             "unknown, and no linear model has that", "leave its friction_coefficient out")
    model = model_of(scene)
    without_waves(model)
    static = StaticState(scene, EquilibriumSettings(), model)
    if about is None:
        left = balance(static)
    else:
        go_to(static, about, about.wraps == "stick", "linearise")
        left = imbalance(static, csr_array(condensed(static.tangent(), model)[0]))
    if not left.at_rest:
        raise _not_at_rest(left)
    if about is None or not any(contact.cable >= 0 for contact in model.contacts):
        return static
    resolve_contact_edges(model, scene, about.static_state["q"])
    static = StaticState(scene, EquilibriumSettings(), model)
    static.restore(about.static_state)
    return static


def _not_at_rest(left: Balance) -> SceneError:
    return SceneError("linearise", f"the state is not at rest: {left}", "take about=scene.equilibrium()")


def _stability(about: RestState | None) -> list[str]:
    """Return a message on a state that is not stable."""
    return [] if about is None or about.stable else [f"the model is about a state that is {about.stability}"]


def _held(free: Equations, scene: SceneData, stick: bool) -> tuple[csr_array, list[str]]:
    """Return the rows (rows, coordinates) that sticking friction holds, and the names of its coordinates."""
    size = len(free.kept)
    rough = {name: "slide" for name, slide in scene.slides.items()
             if slide.friction is not None and slide.friction.static_friction > 0 and not slide.is_driven}
    rough |= {name: "joint" for name, joint in scene.joints.items()
              if joint.friction is not None and joint.friction.static_friction > 0}
    held: list[Coordinate] = [each for each in of_parts(free, scene) if each.name.rpartition(".")[0] in rough]
    missing = set(rough) - {each.name.rpartition(".")[0] for each in held}
    if missing:
        name = min(missing)
        raise SceneError(f'linearise: {rough[name]} "{name}"', "its friction sticks, between parts of which one is no "
                         "rigid body", 'take model="regularised"')
    rows = csr_array(np.array([each.row for each in held]).reshape(len(held), size))
    if stick and rough_sheaves(scene.ropes.values()):
        wraps = stuck_wraps(free.model, free.static.engine.state()["q"], size)
        rows = csr_array(vstack([rows, wraps]))
    return rows, [each.name for each in held]


def _messages(scene: SceneData, sticking: Sequence[str], stick: bool, columns: Columns) -> list[str]:
    """Return what the model holds, linearises or leaves out."""
    found = [f'friction holds "{name}", which has no part in the motion' for name in sticking]
    creeping = [f'"{name}"' for name, part in (scene.slides | scene.joints).items()
                if part.friction is not None and part.friction.creeps and not part.is_driven]
    if creeping:
        found.append(f"regularised friction of {', '.join(creeping)} is linear in the speed, as below the velocity of "
                     "its law")
    wraps = rough_sheaves(scene.ropes.values())
    if wraps and not stick:
        found.append(f"ropes slide on {', '.join(wraps)} as at a speed below the velocity of the law of friction")
    if any(fluid.waves is not None for fluid in scene.fluids.values()):
        found.append("the model leaves out the waves of fluids")
    return found + columns.messages


def _rows(columns: Columns, results: Outputs, named: Sequence[Output]) -> tuple[np.ndarray, np.ndarray]:
    """Return C and D. Raises SceneError for outputs that depend on rates of an input."""
    N = columns.A.shape[0]
    both = results.derivatives(named, columns.directions(0))
    both[:, N:] += results.direct(named, columns.inputs)
    if any(each.moves for each in columns.inputs):
        least = IMPROPER * np.max(np.abs(both), axis=1, initial=0.0)[:, None] + NEGLIGIBLE
        for order in (1, 2):
            rates = np.abs(results.derivatives(named, columns.directions(order)))
            for row, k in np.argwhere(rates > least):
                if columns.inputs[k].moves:  # the static response beyond the modes is without rates
                    raise _improper(named[row].name, columns.inputs[k].name, order)
    return both[:, :N], both[:, N:]


def _improper(output: str, given: str, order: int) -> SceneError:
    return SceneError("linearise", f'output "{output}" depends on the {("rate", "second rate")[order - 1]} of input '
                      f'"{given}", which a model in states and inputs does not have',
                      "leave one of the two out, or drive by a velocity" if order == 1 else "leave one of the two out")
