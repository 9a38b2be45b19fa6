"""The linear model of a scene about a state of rest: x' = A x + B u, y = C x + D u."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from scipy.sparse import block_array, csc_array, csr_array, vstack
from scipy.sparse.linalg import splu

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
from .basis import Basis, basis_of
from .equations import Equations, equations
from .inputs import Input, inputs_of
from .kinks import refuse_kinks
from .names import Coordinate, of_parts
from .outputs import Directions, Outputs

IMPROPER = 1e-9
"""Of an output's largest coefficient below which the one of a rate of an input is rounding."""


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
    n, more = len(basis.names), [f"{each.name.rpartition('.')[0]}.position" if "." in each.name else each.name
                                 for each in given if each.is_rate]
    units = [each.unit.removesuffix("/s") for each in given if each.is_rate]
    return Linearised(columns.A, columns.B, C, D, basis.mass, basis.damping, basis.stiffness,
                      [*basis.names, *basis.rates, *more], [*basis.units, *basis.rate_units, *units],
                      [each.name for each in given], [each.unit for each in given],
                      np.array([each.value for each in given]), [each.name for each in named],
                      [each.unit for each in named], results.values(named), basis.said,
                      basis.squares if not np.any(basis.damping) and not more else None,
                      _messages(scene, sticking, columns) + _stability(about))


def _at_rest(scene: SceneData, model_of: Callable[[SceneData], Model], about: RestState | None) -> StaticState:
    """Return the static state about which the model is, in which forces balance. Raises SceneError."""
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
    rough = {slide.name: "slide" for slide in scene.slides.values()
             if slide.friction is not None and slide.friction.static_friction > 0 and not slide.is_driven}
    rough |= {joint.name: "joint" for joint in scene.joints.values()
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


def _messages(scene: SceneData, sticking: Sequence[str], columns: Columns) -> list[str]:
    """Return what the model holds, linearises or leaves out."""
    found = [f'friction holds "{name}", which has no part in the motion' for name in sticking]
    creeping = [f'"{part.name}"' for part in (*scene.slides.values(), *scene.joints.values())
                if part.friction is not None and part.friction.creeps and not (
                    hasattr(part, "drive") and part.is_driven)]
    if creeping:
        found.append(f"regularised friction of {', '.join(creeping)} is linear in the speed, as below the velocity of "
                     "its law")
    if any(fluid.waves is not None for fluid in scene.fluids.values()):
        found.append("the model leaves out the waves of fluids")
    return found + columns.messages


class Columns:
    """State space, and the motion of all coordinates by states and inputs.

    With p the input of what is prescribed, or its integral: x = Z y + P p. P moves Z' M P = 0, so that accelerations of
    p have no force on y. Forces by p' are taken up by w = y' - E p.
    """

    def __init__(self, own: Equations, held: csr_array, basis: Basis, inputs: Sequence[Input], static_part: bool):
        """held: rows that friction holds; static_part: whether to add the static response beyond the modes."""
        self.own, self.held, self.basis, self.inputs = own, held, basis, inputs
        self.messages: list[str] = []
        Z, n, m = basis.Z, len(basis.names), len(inputs)
        self.rates = [k for k, each in enumerate(inputs) if each.is_rate]
        self.residual = np.array([each.residual for each in inputs]).reshape(m, own.static.engine.unknowns).T
        self.c = np.array([each.c for each in inputs]).reshape(m, own.model.n_dof).T
        self.r = own.over_coordinates(self.residual)
        self.inertia, self.drag = self._prescribed()
        self.P = self._particular()
        inverse = np.linalg.inv(basis.mass) if n else np.zeros((0, 0))
        jumps = np.zeros((n, m))
        if basis.rows is None:
            jumps = inverse @ (Z.T @ (own.M @ self.P + self.inertia))
            self.P -= Z @ jumps
            jumps[:] = 0.0
        else:
            self._keep_names(inverse)
            jumps[:, self.rates] = -(inverse @ (Z.T @ (own.M @ self.P + self.inertia)))[:, self.rates]
        k = self.r + own.K @ self.P
        self.f0 = -Z.T @ k
        self.f1 = -Z.T @ (own.D @ self.P + self.drag)
        self.f1[np.abs(self.f1) < 1e-12 * np.max(np.abs(self.f0), initial=0.0)] = 0.0
        if static_part and m:
            self.P = self.P + self._static_response(k)
        self.E = inverse @ self.f1
        self.E[:, self.rates] = jumps[:, self.rates]
        self._assemble(inverse)

    def _keep_names(self, inverse: np.ndarray) -> None:
        """Let coordinates of joints and slides be those of the whole motion where inputs are velocities, whose jumps
        E takes up; of positions, which would cause a force by their second rate, P has no force of inertia.
        """
        own, Z, rows = self.own, self.basis.Z, self.basis.rows
        assert rows is not None, "of coordinates with names"
        named = rows @ self.P
        by_inertia = inverse @ (Z.T @ (own.M @ self.P + self.inertia))
        by_inertia[:, self.rates] = named[:, self.rates]
        self.P -= Z @ by_inertia

    def _prescribed(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the forces on coordinates by accelerations and by velocities of what is prescribed, (coordinates, m).
        """
        engine, T = self.own.static.engine, self.own.dofs
        inertia, drag = (np.zeros((len(self.own.kept), len(self.inputs))) for _ in range(2))
        kept, still = self.own.static.keep(), np.zeros(self.own.model.n_dof)
        for k in np.flatnonzero(self.c.any(axis=0)):
            forces = []
            for v, a in ((still, self.c[:, k]), (still, still), (1e-6 * self.c[:, k], still), (-1e-6 * self.c[:, k], still)):
                engine.set_rates(v, a)
                forces.append(engine.forces_in_motion())
            inertia[:, k] = T.T @ (forces[0] - forces[1])
            drag[:, k] = T.T @ (forces[2] - forces[3]) / 2e-6
        self.own.static.restore(kept, prescribe=False)
        return inertia, drag

    def _particular(self) -> np.ndarray:
        """Return P (coordinates, m) with C P = -g of the constraints."""
        own = self.own
        P = np.zeros((len(own.kept), len(self.inputs)))
        moving = [k for k, each in enumerate(self.inputs) if each.moves]
        if not moving:
            return P
        n = own.model.n_band + own.model.n_border_dof
        driven = np.array([n + c.unknown + j for c in own.model.couplings if c.is_driven
                           for j in range(c.n_coordinates)], dtype=int)
        full = own.static.tangent().tocsr()
        rows = np.concatenate([own.forces, driven])
        constraints = full[rows][:, own.kept].toarray()
        g = self.residual[rows][:, moving]
        if self.held.shape[0]:
            constraints = np.concatenate([constraints, self.held.toarray()])
            g = np.concatenate([g, np.zeros((self.held.shape[0], len(moving)))])
        sizes = np.linalg.norm(constraints, axis=1)
        used = sizes > 0
        P[:, moving] = np.linalg.lstsq(constraints[used] / sizes[used, None], -g[used] / sizes[used, None], rcond=None)[0]
        P[np.abs(P) < 1e-14] = 0.0
        return P

    def _static_response(self, k: np.ndarray) -> np.ndarray:
        """Return the static response (coordinates, m) to the inputs across all modes that are kept."""
        own, Z = self.own, self.basis.Z
        across = csc_array(own.M @ Z)
        whole = block_array([[own.K, own.C.T, across], [own.C, None, None], [across.T, None, None]], format="csc")
        right = np.zeros((whole.shape[0], k.shape[1]))
        right[: k.shape[0]] = -(k - across @ (Z.T @ k))
        try:
            return np.asarray(splu(whole).solve(right)[: k.shape[0]])
        except RuntimeError:
            self.messages.append("the static response beyond the modes is left out: the stiffness has directions "
                                 "without any, beyond the modes that are kept")
            return np.zeros_like(k)

    def _assemble(self, inverse: np.ndarray) -> None:
        """Compute A and B; maps of y, y', y'' by states and inputs, and by the first and second rates of inputs."""
        n, m, basis = len(self.basis.names), len(self.inputs), self.basis
        q = len(self.rates)
        N = 2 * n + q
        f0, f1 = self.f0, self.f1
        A, B = np.zeros((N, N)), np.zeros((N, m))
        A[:n, n : 2 * n] = np.eye(n)
        A[n : 2 * n, :n], A[n : 2 * n, n : 2 * n] = -inverse @ basis.stiffness, -inverse @ basis.damping
        A[n : 2 * n, 2 * n :] = inverse @ f0[:, self.rates]
        direct = f0.copy()
        direct[:, self.rates] = f1[:, self.rates]
        direct -= basis.damping @ self.E
        B[:n], B[n : 2 * n] = self.E, inverse @ direct
        for row, k in enumerate(self.rates):
            B[2 * n + row, k] = 1.0
        self.A, self.B = A + 0.0, B + 0.0

    def directions(self, rates: int) -> tuple[Directions, list[int]]:
        """Return the motions by states and inputs (rates 0), or by the first and second rates of inputs, and the inputs
        of the columns.
        """
        n, m, N = len(self.basis.names), len(self.inputs), self.A.shape[0]
        is_rate = np.array([each.is_rate for each in self.inputs], dtype=bool)
        position = ~is_rate
        y, yd, ydd = (np.zeros((n, N + m)) for _ in range(3))
        p, pd, pdd = (np.zeros((m, N + m)) for _ in range(3))
        if rates == 0:
            y[:, :n] = np.eye(n)
            yd[:, n : 2 * n], yd[:, N:] = np.eye(n), self.E
            ydd[:, :N], ydd[:, N:] = self.A[n : 2 * n], self.B[n : 2 * n]
            for row, k in enumerate(self.rates):
                p[k, 2 * n + row], pd[k, N + k] = 1.0, 1.0
            p[position, N + np.flatnonzero(position)] = 1.0
        elif rates == 1:
            ydd[:, N:] = self.E
            pd[position, N + np.flatnonzero(position)] = 1.0
            pdd[is_rate, N + np.flatnonzero(is_rate)] = 1.0
        else:
            pdd[position, N + np.flatnonzero(position)] = 1.0
        if rates:
            y, yd, ydd, p, pd, pdd = (each[:, N:] for each in (y, yd, ydd, p, pd, pdd))
        return self._directions((y, yd, ydd), (p, pd, pdd)), list(range(m))

    def _directions(self, y: tuple[np.ndarray, ...], p: tuple[np.ndarray, ...]) -> Directions:
        own, Z = self.own, self.basis.Z
        x, xd, xdd = (Z @ each + self.P @ of for each, of in zip(y, p, strict=True))
        unknowns = np.zeros((own.static.engine.unknowns, x.shape[1]))
        unknowns[own.kept] = x
        force = own.M @ xdd + self.inertia @ p[2] + own.D @ xd + self.drag @ p[1] + own.K @ x + self.r @ p[0]
        if own.columns.shape[1]:
            columns = own.columns.toarray()
            if self.held.shape[0]:
                columns = np.concatenate([columns, self.held.T.toarray()], axis=1)
            unknowns[own.forces] = _least_squares(columns, -force)[: len(own.forces)]
        laws = self.residual[own.laws] @ p[0] + own.law_stiffness @ x + own.law_damping @ xd
        unknowns[own.laws] = -laws
        T = own.dofs
        return Directions(unknowns, self.c @ p[0], T @ x + self.c @ p[0], T @ xd + self.c @ p[1], T @ xdd + self.c @ p[2],
                          np.array([x, xd, xdd]))


def _least_squares(columns: np.ndarray, right: np.ndarray) -> np.ndarray:
    """Return the least forces by their columns, each scaled to one."""
    size = np.linalg.norm(columns, axis=0)
    size[size == 0] = 1.0
    return np.asarray(np.linalg.lstsq(columns / size, right, rcond=None)[0] / size[:, None])


def _rows(columns: Columns, results: Outputs, named: Sequence[Any]) -> tuple[np.ndarray, np.ndarray]:
    """Return C and D. Raises SceneError for outputs that depend on rates of an input."""
    N = columns.A.shape[0]
    both = results.derivatives(named, columns.directions(0)[0])
    both[:, N:] += results.direct(named, columns.inputs)
    if columns.inputs and (columns.P.any() or columns.c.any() or columns.E.any()):
        for order in (1, 2):
            along, of = columns.directions(order)
            rates = results.derivatives(named, along)
            for row, k in np.argwhere(np.abs(rates) > IMPROPER * np.max(np.abs(both), axis=1, initial=0.0)[:, None] + 1e-12):
                moved = columns.inputs[of[k]]
                if not moved.moves:  # of the static response beyond the modes, which is without rates
                    continue
                raise SceneError("linearise", f'output "{named[row].name}" depends on the {"rate" if order == 1 else "second rate"} '
                                 f'of input "{moved.name}", which a model in states and inputs does not have',
                                 "leave one of the two out, or drive by a velocity")
    return both[:, :N], both[:, N:]
