"""Small vibrations about a state: natural frequencies and their shapes, constraints included."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, field

import numpy as np
from scipy.linalg import eig, eigh, null_space
from scipy.sparse import csc_array, diags_array, vstack

from ...base.named_arrays import NamedArrays
from ...base.rotations import rotate
from ...engine import Engine
from ...errors import FunicularWarning, SceneError, UnknownResultError, near
from ...model.build import build
from ...model.model import BodyModel, Model
from ...model.rope_states import rope_motion
from ...model.states import body_state, modal_state, spatial
from ...parts.rope import rough_sheaves
from ...parts.scene_data import SceneData
from ...parts.settings import EquilibriumSettings
from ..linear.condensation import condensed, fastest
from ..linear.spectrum import EIGENVALUE_ROUNDING, STIFFNESS_ROUNDING, IncompleteError, Pencil, basis
from ..statics.balance import balance
from ..statics.rest_state import RestState
from ..statics.stability import count
from ..statics.static_problem import StaticState, units_of, without_waves
from ..statics.sticking_ropes import with_sticking_wraps
from .contact_edges import resolve_contact_edges
from .stuck_wraps import stuck_wraps

ASYMMETRY_ROUNDING, MIN_ASYMMETRY = 1e-9, 1e-13
"""Asymmetry due to rounding, as a fraction of the stiffness of two coordinates, and of the largest; loads that turn
cause more."""

MAX_DENSE_UNKNOWNS = 600
"""Unknowns up to which LAPACK computes all modes."""

LOST_EIGENVALUE_RATIO, BLURRED_EIGENVALUE_RATIO = 1e-9, 1e-4
"""Fractions of the largest eigenvalue below which LAPACK loses others, and below which it finds 12 digits at most."""

MAX_UNSYMMETRIC_DEGREES = 3000
"""Degrees of freedom up to which modes with an unsymmetric stiffness are computed, all at once."""

STRAIN_STEP = 1e-6
"""Strain of the cables by which the geometric part of the stiffness is differenced."""

FREQUENCY_TOLERANCE, HIDDEN_FREQUENCY_RATIO = 1e-3, 5e-2
"""Relative change by rounding above which a frequency is uncertain; for zero, as a fraction of the lowest frequency."""


@dataclass
class Modes(NamedArrays):
    """The n lowest natural vibrations, complete, by rising frequency.

    angular_frequency (n,) in rad/s, 0 for a mode that grows; frequency (n,) in Hz; growth_rate (n,) in 1/s, 0 for a
    mode that vibrates. uncertainty (n,) in rad/s: the change of an angular frequency by rounding of the stiffness; one
    that is not larger is given as 0. Shapes by name, largest displacement 1 m: ``modes["wire.nodal_vectors"]`` (n,
    node, vector, 3), ``modes["A.displacement"]``, ``modes["A.rotation"]`` (n, 3), about body axes; of a modal body
    these are the frame's, and ``modes["link.nodes"]`` (n, node, 3) the displacements of its nodes. Of a rope
    ``modes["rope.displacement"]`` (n, point, 3) are those of its points, ``modes["rope.s"]`` (n, point) the lengths of
    material that pass them, and ``modes["top.angle"]`` (n,) the rotation of a sheave. messages: what was
    left out, and what is uncertain.
    """

    angular_frequency: np.ndarray
    growth_rate: np.ndarray
    shapes: dict[str, np.ndarray]
    uncertainty: np.ndarray
    messages: list[str] = field(default_factory=list)

    @property
    def frequency(self) -> np.ndarray:
        """Return the frequencies (n,) in Hz."""
        return self.angular_frequency / (2 * np.pi)

    def keys(self) -> list[str]:
        """Return the names of all shapes."""
        return list(self.shapes)

    def __getitem__(self, name: str) -> np.ndarray:
        """Return a shape by its name. Raises UnknownResultError naming the near ones."""
        if name not in self.shapes:
            raise UnknownResultError(f'no shape "{name}"; {near(name, self.shapes)}')
        return self.shapes[name]

    def __len__(self) -> int:
        """Return the number of modes; that of names is ``len(modes.keys())``."""
        return len(self.angular_frequency)


def modes(scene: SceneData, n: int, about: RestState | None = None, as_drawn: bool = False,
          stick: bool = False) -> Modes:
    """Return the n lowest modes about a state, as drawn if none is given; damping and friction are left out.

    as_drawn: also where forces do not balance as drawn, which is refused otherwise. stick: whether ropes stick to the
    sheaves on which they have friction. ``messages`` and a FunicularWarning report what is left out or uncertain.
    Raises SceneError.
    """
    model = build(with_sticking_wraps(scene) if about is not None and about.wraps == "stick" else scene)
    without_waves(model)
    if about is not None:
        resolve_contact_edges(model, scene, about.static_state["q"])
    static = StaticState(scene, EquilibriumSettings(), model)
    engine = static.engine
    notes = _begin(static, about, as_drawn, stick)
    engine.vibrate(True)
    K, constraints = condensed(engine.matrix(0.0, 0.0, 1.0), model)
    size = K.shape[0]
    if stick and rough_sheaves(scene.ropes.values()):
        constraints = vstack([constraints, stuck_wraps(model, engine.state()["q"], size)], format="csc")
    M = engine.matrix(1.0, 0.0, 0.0)[:size, :size]
    possible = size - constraints.shape[0]
    if n > possible:
        raise SceneError("modes", f"the scene has {possible} degrees of freedom, {n} modes were asked for",
                         "ask for fewer modes" + ", or take more elements" * bool(model.cables))
    _refuse_what_is_out_of_range(scene, model, K, M)
    squares, vectors, error, after = solve_modes(K, M, constraints, n, fewer_elements(model))
    strained = _rounded_shape(engine, model, K)
    error += np.abs(np.sum(vectors * (strained @ vectors), axis=0)) / np.sum(vectors * (M @ vectors), axis=0)
    after = min(after, np.min(squares.real, initial=np.inf, where=squares.real > error))
    squares, vectors, error = squares[:n], vectors[:, :n], error[:n]
    dofs = np.array([engine.spread(np.append(x, np.zeros(model.n_band + model.n_border_dof + model.n_extra - len(x))))
                     for x in vectors.T])
    found = _named(model, engine.state()["q"], np.where(np.abs(squares) <= error, 0.0, squares), dofs, error)
    found.messages += notes + _unstable(found, about, K, constraints, static)
    found.messages += _without_friction(scene, stick)
    found.messages += _uncertain(found, np.sqrt(max(after, 0.0)), fewer_elements(model))
    for message in found.messages:
        warnings.warn(message, FunicularWarning, stacklevel=3)
    return found


def go_to(static: StaticState, about: RestState, stick: bool, who: str) -> None:
    """Go to a state of rest; who: "modes" or "linearise", in messages. Raises SceneError, see `modes`."""
    state = f"the state that {'modes are' if who == 'modes' else 'the model is'} about"
    if about.impending is not None:
        raise SceneError(who, f'{state} has ropes at the limit of friction, "{about.impending}", which '
                         f"{'modes do' if who == 'modes' else 'linear models do'} not have",
                         "take an equilibrium without impending")
    if about.wraps == "stick" and not stick:
        raise SceneError(who, f"{state} has ropes that stick to their sheaves, without which it is not at rest",
                         'take wraps="stick", or an equilibrium with wraps="slip"')
    about.check_supports(static.model, static.scene)
    own = static.keep()
    if any(values.shape != own[name].shape for name, values in about.static_state.items()):
        raise SceneError("scene", f"{state} has other hard contacts", "take an equilibrium of this scene")
    static.restore(about.static_state)


def _begin(static: StaticState, about: RestState | None, as_drawn: bool, stick: bool) -> list[str]:
    """Go to the state of the modes; return the messages on it. Raises SceneError, see `modes`."""
    if about is not None:
        go_to(static, about, stick, "modes")
        return []
    left = balance(static)
    if left.at_rest:
        return []
    if not as_drawn:
        raise SceneError("modes", f"the scene as drawn is not in balance: {left}",
                         "take about=scene.equilibrium() (--equilibrium in a shell), or as_drawn=True (--as-drawn) for "
                         "the modes of what is not at rest")
    return [f"these are modes of the scene as drawn, which is not in balance: {left}; joints and slides bear nothing, "
            "so that what swings by its weight has 0 Hz"]


def _unstable(modes: Modes, about: RestState | None, K: csc_array, constraints: csc_array,
              static: StaticState) -> list[str]:
    """Return a message where the modes are about a state that is not stable."""
    growing = np.flatnonzero(modes.growth_rate)
    if about is not None and not (about.stable or growing.size):
        return [f"the modes are about a state that is {about.stability}"]
    if not growing.size:
        return []
    known = about.stability if about is not None and about.stability.known else count(
        K, constraints, units_of(static.weight, static.model))
    state = f"the state is {known}" if known.unstable else "the state is unstable"
    which = ", ".join(str(k + 1) for k in growing[:5]) + ", ..." * (len(growing) > 5)
    grows = "mode {} grows" if growing.size == 1 else "modes {} grow"
    return [f"{state}; {grows.format(which)}, by up to {modes.growth_rate.max():.4g} 1/s"]


def fewer_elements(model: Model) -> str:
    """Return the advice to take fewer elements, to precede another one; empty for a scene without cables."""
    return "take fewer elements, or " if model.cables else ""


def _without_friction(scene: SceneData, stick: bool) -> list[str]:
    """Return messages on friction that is left out, and on sheaves to which ropes stick."""
    slides = [f'"{slide.name}"' for slide in scene.slides.values() if slide.friction and not slide.is_driven]
    joints = [f'"{joint.name}"' for joint in scene.joints.values() if joint.friction]
    wraps = rough_sheaves(scene.ropes.values())
    contacts = [f'"{contact.name}"' for contact in scene.contacts.values()
                if contact.a in scene.ropes and contact.friction_coefficient]
    return [f"modes {do} {what}{'s' * (len(names) > 1)} {', '.join(names)}"
            for do, what, names in (("leave out the friction of", "slide", slides),
                                    ("leave out the friction of", "joint", joints),
                                    ("leave out the friction of", "contact", contacts),
                                    ("have ropes that stick to" if stick else "leave out the friction of", "sheave",
                                     wraps)) if names]


def _rounded_shape(engine: Engine, model: Model, K: csc_array) -> csc_array:
    """Return the change of the stiffness by rounded coordinates, which strain the cables by `STIFFNESS_ROUNDING`.

    The tension of this strain is negligible beside EA, but not beside the bending stiffness of a long thin cable.
    """
    undeformed = engine.state()
    stretched = undeformed["q"].copy()
    for cable in model.cables:
        stretched[cable.coordinates] *= 1 + STRAIN_STEP
    engine.set_state(0.0, **undeformed | {"q": stretched}, prescribe=True)
    change = condensed(engine.matrix(0.0, 0.0, 1.0), model)[0] - K
    engine.set_state(0.0, **undeformed, prescribe=True)
    return STIFFNESS_ROUNDING / STRAIN_STEP * change


def _uncertain(modes: Modes, lowest: float, fewer: str) -> list[str]:
    """Return messages on frequencies that rounding of the stiffness hides or changes; lowest: the lowest angular
    frequency above zero.
    """
    notes, w, error = [], np.maximum(modes.angular_frequency, modes.growth_rate), modes.uncertainty
    zero = (w == 0) & (error > HIDDEN_FREQUENCY_RATIO * lowest)
    if zero.any():
        notes.append(f"rounding of the stiffness hides frequencies below {error[zero].max() / (2 * np.pi):.3g} Hz: "
                    f"{np.count_nonzero(zero)} of those given as 0 may be higher; {fewer}look for a "
                    "part that is far stiffer or far lighter than the others")
    vague = (w > 0) & (error > FREQUENCY_TOLERANCE * w)
    if vague.any():
        numbers = ", ".join(str(k + 1) for k in np.flatnonzero(vague)[:5]) + ", ..." * bool(np.count_nonzero(vague) > 5)
        notes.append(f"rounding of the stiffness may change the frequencies of modes {numbers} by up to "
                    f"{100 * np.max(error[vague] / w[vague]):.2g} %; {fewer}look for a part that is "
                    "far stiffer or far lighter than the others")
    return notes


def _refuse_what_is_out_of_range(scene: SceneData, model: Model, K: csc_array, M: csc_array) -> None:
    """Raise SceneError unless inertia and stiffness are finite, and the inertia positive, except for arc-lengths of
    slides.
    """
    n = model.n_band + model.n_border_dof
    inertia = M.diagonal()[:n]
    stiffness = np.asarray(abs(K).max(axis=1).todense()).ravel()[:n] if n else np.zeros(0)
    for what, values, least in (("inertia", inertia, np.finfo(float).tiny), ("stiffness", stiffness, 0.0)):
        wrong = ~(np.isfinite(values) & (values >= least))
        if wrong.any():
            at = int(np.argmax(wrong))
            raise SceneError(f"modes: {_owner(scene, model, at)}", f"its {what} comes to {values[at]:.3g}: the size of "
                             "its section, its length or its material is beyond the range of double precision",
                             "take them nearer to each other")


def _owner(scene: SceneData, model: Model, unknown: int) -> str:
    """Return the part to which an unknown belongs."""
    dof = int(np.argmax(model.unknown_of_dof == unknown))
    for name, nodes in model.nodes.items():
        if dof < model.cables[list(model.nodes).index(name)].coordinates.stop and nodes:
            return scene.cables[name].where
    return next(scene.bodies[body.name].where for body in reversed(model.bodies) if body.dof <= dof)


def solve_modes(K: csc_array, M: csc_array, constraints: csc_array, n: int, fewer: str
           ) -> tuple[np.ndarray, np.ndarray, np.ndarray, float]:
    """Return at least the n smallest squares of frequencies of K x = w² M x on constraints x = 0 (n,), their vectors
    (coordinates, n), the rounding errors of the squares (n,), and the next square, infinite if that is not known.

    fewer: an advice for messages, see `fewer_elements`.
    """
    symmetric = is_symmetric(K)
    pencil = Pencil(K, M, constraints)
    if not symmetric and pencil.degrees > MAX_UNSYMMETRIC_DEGREES:
        raise SceneError("modes", "the stiffness is not symmetric, because loads turn with what they act on, and the "
                         f"scene has {pencil.degrees} degrees of freedom: such modes are computed for up to "
                         f"{MAX_UNSYMMETRIC_DEGREES}", f"{fewer}take loads of fixed direction")
    try:
        if not symmetric:
            return *_unsymmetric(K, M, constraints, n, pencil), np.inf
        return _small(K, M, constraints, n, pencil) if K.shape[0] <= MAX_DENSE_UNKNOWNS else pencil.lowest(n)
    except (IncompleteError, ArithmeticError, RuntimeError, ValueError, np.linalg.LinAlgError):
        raise SceneError("modes", f"rounding of the stiffness hides the {n} lowest modes: stiffness and inertia of the "
                         "scene are too different", f"{fewer}look for a part that is far stiffer, far "
                         "lighter or far thinner than the others") from None


def _small(K: csc_array, M: csc_array, constraints: csc_array, n: int, pencil: Pencil
           ) -> tuple[np.ndarray, np.ndarray, np.ndarray, float]:
    """Return the same by LAPACK, unless some are lost in the rounding of the largest eigenvalue, such as zeros."""
    free = null_space(constraints.toarray()) if constraints.shape[0] else np.eye(K.shape[0])
    k, m = free.T @ (K @ free), free.T @ (M @ free)
    try:
        squares, x = eigh((k + k.T) / 2, (m + m.T) / 2, subset_by_index=(0, n - 1))
    except (ValueError, np.linalg.LinAlgError):
        return pencil.lowest(n)
    smallest, largest, vectors = np.abs(squares).min(), fastest(K, M), free @ x
    if smallest <= LOST_EIGENVALUE_RATIO * largest:
        return pencil.lowest(n)
    if smallest <= BLURRED_EIGENVALUE_RATIO * largest:
        return *pencil.refined(squares, vectors), np.inf
    error = np.maximum(pencil.unit * pencil.uncertainty(vectors / pencil.scale[:, None]), EIGENVALUE_ROUNDING * largest)
    return squares, vectors, error, np.inf


def is_symmetric(K: csc_array) -> bool:
    """Return whether a stiffness is symmetric beyond rounding."""
    largest = np.sqrt(np.asarray(abs(K).max(axis=1).todense()).ravel()) if K.shape[0] else np.zeros(0)
    over = 1 / np.where(largest > 0, largest, 1.0)
    apart = abs(K - K.T).tocoo()
    least = MIN_ASYMMETRY * np.max(largest, initial=0.0) ** 2
    return not np.any(apart.data > ASYMMETRY_ROUNDING / (over[apart.row] * over[apart.col]) + least)


def _unsymmetric(K: csc_array, M: csc_array, constraints: csc_array, n: int, pencil: Pencil
                 ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the same for loads that turn; squares may be complex, for modes that grow while they vibrate."""
    by = diags_array(pencil.scale)
    free = basis(pencil.C)
    squares, x = eig(free.T @ (by @ (K / pencil.unit) @ by @ free), free.T @ (pencil.M @ free))
    order = np.argsort(squares.real)[:n]
    x = free @ x[:, order].real
    error = np.maximum(pencil.uncertainty(x), EIGENVALUE_ROUNDING * np.abs(squares).max())
    return pencil.unit * squares[order], pencil.scale[:, None] * x, pencil.unit * error


def _named(model: Model, q: np.ndarray, squares: np.ndarray, dofs: np.ndarray, error: np.ndarray) -> Modes:
    """Return the modes with shapes by part, of dofs (n, n_dof) about the configuration q."""
    roots = np.sqrt(squares.astype(complex))
    size = np.abs(roots)  # sqrt(square + error) - sqrt(square)
    uncertainty = error / (size + np.sqrt(size**2 + error))
    shapes = {}
    modal = [body for body in model.bodies if body.modes]
    for k, mode in enumerate(dofs):
        largest = max([np.abs(mode[list(node.dofs("r"))]).max() for nodes in model.nodes.values() for node in nodes]
                      + [np.abs(mode[b.dof : b.dof + model.dim]).max() for b in model.bodies]
                      + [np.abs(_nodes(model, body, q, mode[None])).max() for body in modal]
                      + [np.abs(mode[rope.lengths]).max(initial=0.0) for rope in model.ropes], default=0.0)
        dofs[k] = mode / (largest or np.abs(mode).max() or 1.0)
    for cable in model.cables:
        vectors = spatial(cable.nodal(dofs))
        shapes[f"{cable.name}.nodal_vectors"] = vectors
        shapes[f"{cable.name}.displacement"] = vectors[:, :, cable.vectors.index("r")]
    for body in model.bodies:
        turn = dofs[:, body.dof + model.dim : body.dof + (6 if model.dim == 3 else 3)]
        shapes[f"{body.name}.displacement"] = spatial(dofs[:, body.dof : body.dof + model.dim])
        shapes[f"{body.name}.rotation"] = turn if model.dim == 3 else np.pad(turn, ((0, 0), (2, 0)))
    for body in modal:
        shapes[f"{body.name}.nodes"] = _nodes(model, body, q, dofs)
    for rope in model.ropes:
        shapes |= {f"{rope.part.name}.{key}": value for key, value in rope_motion(model, rope, q, dofs).items()}
        shapes |= {f"{wheel.name}.angle": dofs[:, turn] if turn >= 0 else np.zeros(len(dofs))
                   for wheel, turn in rope.turns}
    if (axes := model.plane_axes) is not None:
        for name, values in shapes.items():
            part, _, quantity = name.rpartition(".")
            shapes[name] = axes.out(part, quantity, values, moves=True)
    return Modes(np.abs(roots.real), np.abs(roots.imag), shapes, uncertainty)


def _nodes(model: Model, body: BodyModel, q: np.ndarray, dofs: np.ndarray) -> np.ndarray:
    """Return (n, node, 3): displacements of the nodes of a modal body from the configuration q."""
    assert body.shape is not None, "a rigid body has no modes"
    at = body.dof + model.dim
    turn = dofs[:, at : at + 3] if model.dim == 3 else np.pad(dofs[:, at : at + 1], ((0, 0), (2, 0)))
    at += 3 if model.dim == 3 else 1
    fields, state = body.shape.fields, body_state(model, body, q[None])
    orientation, eta = state["orientation"][0], modal_state(model, body, state, q[None])["modal_coordinates"][0]
    strained = np.einsum("tk,kni->tni", dofs[:, at : at + body.modes], fields.modes)
    frame = spatial(dofs[:, None, body.dof : body.dof + model.dim])
    bent = fields.nodes + np.einsum("k,kni->ni", eta, fields.modes)
    return np.asarray(frame + rotate(orientation, np.cross(turn[:, None], bent) + strained))
