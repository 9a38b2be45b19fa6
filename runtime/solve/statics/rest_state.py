"""A state of rest: the result of a search for equilibrium, and the start of a run or of modes."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Self

import numpy as np

from ...base.named_arrays import NamedArrays
from ...errors import EquilibriumError, SceneError, UnknownResultError, near
from ...model.driven_dofs import DrivenDofs
from ...model.kinds import COUPLINGS
from ...model.model import Model
from ...model.part_states import States, numbers_at_rest, part_states
from ...model.rope_model import RopeModel
from ...model.rope_rates import follow
from ...model.states import attachment_points
from ...parts.joint import Joint
from ...parts.part import Part
from ...parts.paths import path_of, value_at
from ...parts.plane import called
from ...parts.rope import Rope
from ...parts.scene_data import SceneData
from ...parts.validation import show
from .ropes_at_rest import with_ropes_at_rest
from .stability import Stability
from .static_problem import StaticState
from .sticking_ropes import held_friction
from .turns import prescribed_angles

VALUE_ROUNDING = 1e-12
"""Rounding error of an adjusted value, as a fraction of it."""
POSITION_TOLERANCE = 1e-6
"""Distance of two equal positions, as a fraction of the scene's size."""
MAX_CREEPING = 0.9
"""Regularised friction over its limit with which ropes begin to creep, at most: at twice its velocity."""

SIGNAL_START_REMEDY = "let its signal start at the value of the state, or take the equilibrium of this scene"


def in_loads(fraction: float) -> str:
    """Return the load fraction in words."""
    return "all loads" if fraction == 1 else f"{fraction:.6g} times the loads"


DRIVEN = "lengths, stiffnesses and temperatures"
"""Kind of the quantities in a `layout` that belong to no node or body."""


def layout(scene: SceneData) -> dict[str, list[Any]]:
    """Return the properties that two scenes share if a state of one is a state of the other."""
    found: dict[str, list[Any]] = {
        "cables": [(c.name, c.element, c.elements, c.length, *c.uneven_nodes, *c.doubled)
                   for c in scene.cables.values()],
        "plane": [called(scene.plane)], "bodies": list(scene.bodies),
        DRIVEN: [f"{what} of {where}" for where, what in DrivenDofs.of(scene, 0).driven]}
    for kind in COUPLINGS:
        if kind.has_state:
            found[kind.group] = [_without_ends(part) for part in scene.group(kind.group)]
    return found


def _without_ends(part: Part) -> Any:
    """Return the name of a part, with what determines the number of its unknowns: the kind of a joint, the elements and
    zones of a rope.
    """
    name = part.given_name or part.kind
    if isinstance(part, Rope):
        return name, part.elements_of_spans, [(each.name, getattr(each, "n_zones", 0), each.turns_round)
                                              for each in part.wheels]
    return (name, part.joint_kind) if isinstance(part, Joint) else name


def _without_mesh(cable: tuple[Any, ...]) -> tuple[Any, ...]:
    """Return the name, element and length of a cable in a layout."""
    name, element, _, length, *_ = cable
    return name, element, length


@dataclass
class CriticalPoint:
    """A point of a load path at which stability changes or the load turns.

    load_fraction: of the loads; kind: "limit", where the load stops rising or falling, or "bifurcation", where another
    path of equilibria crosses this one; directions: the change of the number of unstable directions beyond it; state:
    of rest at this point.
    """

    load_fraction: float
    kind: str
    directions: int
    state: RestState = field(repr=False)


@dataclass
class Relaxation:
    """The course of a damped motion to rest.

    steps: of the motion; resets: how often all velocities were set to zero; energies: in J at the resets, elastic, of
    weight and of loads, which rise only where the scene was pushed off an unstable branch, or with follower loads;
    residuals: the largest residual forces at the resets in N.
    """

    steps: int = 0
    resets: int = 0
    energies: list[float] = field(default_factory=list, repr=False)
    residuals: list[float] = field(default_factory=list, repr=False)

    def note(self, energy: float, residual: float) -> None:
        """Add a state with all velocities zero."""
        self.energies.append(energy)
        self.residuals.append(residual)

    def __str__(self) -> str:
        """Return it in words, as messages do."""
        return (f"came to rest by {self.steps} steps of a damped motion, whose velocities were set to zero "
                f"{self.resets} times; {self.residuals[-1]:.3g} N were left over")


@dataclass
class Adjustment:
    """The parameters of a scene whose state of rest has given values.

    values: the parameters found, by path; targets: the given values of the state, by name; found: those reached;
    jacobian (targets, parameters): derivatives of the state's values by the parameters, at the state; iterations: of
    Newton's method on the parameters; misfits: the largest distance from a target at each iteration, over its scale
    (the scene's size for a position, else the larger of target and first value).
    """

    values: dict[str, float]
    targets: dict[str, float]
    found: dict[str, float]
    jacobian: np.ndarray = field(repr=False)
    iterations: int
    misfits: list[float] = field(repr=False)


@dataclass(repr=False)
class RestState(NamedArrays):
    """A state of rest of a scene.

    All quantities of a `Run` by name, without the time: ``state["wire.nodal_vectors"]`` (node, vector, 3),
    ``state["A.position"]``, ``state["drive.traction"]``, ``state["wire@0.force"]`` ... Rates are zero. load_fraction:
    applied fraction of all loads, 1 except along a path and in an `EquilibriumError`; iterations of Newton's method;
    residual: the largest residual force in N; stability: see `Stability`; path: the states of rest up to this one in
    their order, each under its load_fraction, from which a curve of load and displacement is drawn; critical_points of
    that path; gravity_fraction: applied fraction of gravity, 1 where scale_gravity is off; messages: what the search
    passed, adjusted or left out; relaxation: the motion by which `Scene.relax` found the state, else None; turned: the
    angles of motions and driven joints in rad by label, with whole turns; adjustment: the parameters found for given
    values of the state, else None; ``scene`` then has these values; impending: the motion that ropes are about to
    begin, "hoisting" or "lowering", with their friction at its limit, else None; wraps: whether ropes "stick" to their
    sheaves, or "slip" without friction; held: by the names of sheaves to which they stick, friction over its limit at
    the ends of the zones (zones + 1,), positive against sliding in the order of the rope.
    """

    scene: SceneData
    model: Model
    static_state: dict[str, np.ndarray]
    reaction: np.ndarray
    load_fraction: float
    iterations: int
    residual: float
    stability: Stability
    gravity_fraction: float
    couplings: dict[str, np.ndarray]
    heading: np.ndarray | None = field(default=None, repr=False)
    quantities: dict[str, np.ndarray] = field(default_factory=dict)
    path: list[RestState] = field(default_factory=list, repr=False)
    critical_points: list[CriticalPoint] = field(default_factory=list)
    messages: list[str] = field(default_factory=list)
    layout: dict[str, list[Any]] = field(default_factory=dict, repr=False)
    turned: dict[str, float] = field(default_factory=dict, repr=False)
    relaxation: Relaxation | None = None
    impending: str | None = None
    wraps: str = "slip"
    held: dict[str, np.ndarray] = field(default_factory=dict, repr=False)
    adjustment: Adjustment | None = None

    @classmethod
    def of(cls, problem: StaticState, stability: Stability, heading: np.ndarray | None = None) -> Self:
        """Read the static state of a problem under the present load; heading: of the path there."""
        left = problem.residual()
        units = np.where(problem.weight > 0, problem.weight, np.inf)
        engine = problem.engine
        scene = problem.scene.as_drawn
        state = cls(scene, problem.model, problem.keep(), engine.reaction(), problem.fraction,
                    problem.iterations, float(np.max(np.abs(left) / units, initial=0.0)), stability,
                    problem.fraction if problem.settings.scale_gravity else 1.0,
                    numbers_at_rest(engine), heading)
        state.quantities = state._quantities()
        state.path, state.layout, state.turned = [state], layout(scene), problem.turns.reached
        state.impending, state.wraps = problem.settings.impending, problem.settings.wraps
        state.held = held_friction(problem.model, engine) if problem.settings.sticks else {}
        return state

    def __repr__(self) -> str:
        """Return stability, load and number of results in a line."""
        stable = "stable" if self.stable else f"{self.unstable_directions} unstable directions"
        return (f"<funicular.Equilibrium: {stable}, under {in_loads(self.load_fraction)}, "
                f"{len(self.quantities)} results>")

    @property
    def adjusted(self) -> dict[str, float]:
        """Return the values of the parameters that the search for the state adjusted, by path; empty without any."""
        return {} if self.adjustment is None else dict(self.adjustment.values)

    @property
    def unstable_directions(self) -> int:
        """Return the number of independent directions that lower the energy, with follower loads of divergence."""
        return self.stability.unstable

    @property
    def neutral_directions(self) -> int:
        """Return the number of independent directions that keep the energy: free motions."""
        return self.stability.neutral

    @property
    def stable(self) -> bool:
        """Return whether no direction lowers the energy; False also where the count failed."""
        return self.stability.known and self.stability.unstable == 0

    def check_stable(self, cause: str = "") -> None:
        """Raise EquilibriumError where the state is known to be unstable; cause: continues the message."""
        if self.stability.unstable and not self.stability.bound:
            other = ("equilibrium() searches in another way" if self.relaxation is not None else
                     "take relax(), a damped motion, or seek_stable=False, which returns this state")
            raise EquilibriumError(
                f"no stable equilibrium was found: the state of rest found is {self.stability}{cause}; {other}, "
                "or draw the scene nearer to its rest; the state is kept in .state", self, self.load_fraction)

    def keys(self) -> list[str]:
        """Return the names of all quantities."""
        return list(self.quantities)

    def __len__(self) -> int:
        """Return the number of quantities."""
        return len(self.quantities)

    def __bool__(self) -> bool:
        """Return True, whatever the number of quantities."""
        return True

    def __getitem__(self, name: str) -> np.ndarray:
        """Return a quantity by its name. Raises UnknownResultError naming the near ones."""
        if name not in self.quantities:
            raise UnknownResultError(f'no result "{name}"; {near(name, self.quantities)}')
        return self.quantities[name]

    def check_fits(self, scene: SceneData, any_mesh: bool = False) -> None:
        """Raise SceneError where the state is of a scene with other parts; supports and loads may be others.

        any_mesh: cables may have other meshes, of the same element.
        """
        for kind, here in layout(scene).items():
            held = self.layout[kind]
            if any_mesh and kind == DRIVEN:
                continue
            if any_mesh and kind == "cables" and [_without_mesh(c) for c in here] == [_without_mesh(c) for c in held]:
                continue
            if here != held:
                raise SceneError("scene", f"the state to start from belongs to another scene: its {kind} are "
                                 f"{held}, those of this scene {here}", "take an equilibrium of this scene")

    def check_adjusted(self, scene: SceneData) -> None:
        """Raise SceneError where the scene lacks the values that were adjusted for the state, as it would not rest."""
        for name, value in self.adjusted.items():
            here = value_at(scene, path_of(scene, name, "adjust"))
            if here is None or abs(here - value) > VALUE_ROUNDING * abs(value):
                raise SceneError("scene", f"the state to start from is at rest with the adjusted value {name} = "
                                 f"{value:.9g}, this scene has {here}", "take the state's own scene: rest.scene")

    def check_supports(self, model: Model, scene: SceneData) -> None:
        """Raise SceneError where supports or ends of joints, as drawn or prescribed at t = 0, are at other positions in
        a freshly built model of a scene than in this state.
        """
        q, size = self.static_state["q"][None], max(float(np.abs(model.q).max(initial=0.0)), 1.0)
        for was, joint in zip(self.model.joints, model.joints, strict=True):
            if not joint.is_of_scene:
                continue
            was_open, is_open = (np.subtract(*(attachment_points(of, end, q)[0] for end in each.attachments))
                                 for of, each in ((self.model, was), (model, joint)))
            moved = float(np.linalg.norm(is_open - was_open))
            if "distance" in joint.kernel:
                moved = max(moved, abs(joint.base - was.base))
            if moved > POSITION_TOLERANCE * size:
                raise SceneError("scene", f'the state to start from has an end of the joint "{joint.name}" '
                                 f"{moved:.3g} m from where it is here", "take an equilibrium of this scene")
        if model.ropes:
            self._check_ropes(with_ropes_at_rest(model, scene), model.ropes, size)
        if model.cables:
            own = slice(0, model.cables[-1].coordinates.stop)
            fixed = model.unknown_of_dof[own] == -1
            fixed[[motion.dof for motion in model.motions if motion.dof < own.stop]] = False
            moved = np.abs(self.static_state["q"][own] - model.q[own]) * model.weight[own] * fixed
            if np.max(moved) > POSITION_TOLERANCE * max(cable.mesh.total for cable in model.cables):
                raise SceneError("scene", f"the state to start from has a support {np.max(moved):.3g} m from where it "
                                 "is here", "take an equilibrium of this scene")
        self._check_prescribed(model, scene)

    def _check_ropes(self, drawn: np.ndarray, ropes: list[RopeModel], size: float) -> None:
        """Raise SceneError where ends of ropes, or their stress-free lengths, are others in this scene."""
        for rope in ropes:
            moved = float(np.abs(self.static_state["q"] - drawn)[rope.held].max(initial=0.0))
            if moved > POSITION_TOLERANCE * size:
                raise SceneError("scene", f'the state to start from has an end of rope "{rope.part.name}", or the '
                                 f"stress-free length there, {moved:.3g} m from where it is here",
                                 "take an equilibrium of this scene")

    def _check_prescribed(self, model: Model, scene: SceneData) -> None:
        """Raise SceneError where motions or angles of joints prescribe other values at t = 0 than the state has."""
        for label, angle in prescribed_angles(scene, model).items():
            if abs(angle - self.turned.get(label, angle)) > POSITION_TOLERANCE * (1 + abs(angle)):
                raise SceneError("scene", f'the angle of "{label}" is {show(angle, "rad")} at t = 0, but the state to '
                                 f'start from has {show(self.turned[label], "rad")}', SIGNAL_START_REMEDY)
        driven = model.q[model.driven]
        if np.any(np.abs(driven - self.static_state["q"][model.driven]) > POSITION_TOLERANCE * (1 + np.abs(driven))):
            raise SceneError("scene", "a length, a stiffness or a temperature that a signal prescribes is at t = 0 "
                             "another than in the state to start from", SIGNAL_START_REMEDY)
        others = {*model.driven, *(turn for rope in model.ropes for _, turn in rope.turns)}  # of turns the rates matter
        moved = {dof: abs(value - self.static_state["q"][dof]) * model.weight[dof]
                 for dof, value in model.prescribed_at(0.0).items() if dof not in others}
        lengths = [*(cable.mesh.total for cable in model.cables), *(rope.route.length for rope in model.ropes)]
        if moved and (most := max(moved.values())) > POSITION_TOLERANCE * max(lengths):
            raise SceneError("scene", f"a motion begins {show(most, 'm')} from where the state to start from has it",
                             SIGNAL_START_REMEDY)

    def start(self, model: Model, scene: SceneData) -> None:
        """Put a freshly built model of the scene into this state. Raises SceneError where supports are elsewhere."""
        self.check_supports(model, scene)
        model.q = self.static_state["q"].copy()
        model.place_slides(self.static_state["s"])
        for rope in model.ropes:
            follow(model, rope)
        self._creep(model)

    def _creep(self, model: Model) -> None:
        """Let ropes creep on sheaves with regularised friction as fast as for the friction that holds them at rest."""
        for sheave in model.sheaves:
            if sheave.name in self.held and not sheave.sticks:
                part = np.clip(self.held[sheave.name], -MAX_CREEPING, MAX_CREEPING)
                w = sheave.slip_velocity * part / np.sqrt(1 - part**2)
                length = model.q[sheave.s[-1]] - model.q[sheave.s[0]] + sheave.closing
                model.v[sheave.s] = -w * length / (sheave.radius * self[f"{sheave.name}.wrap_angle"])

    def _quantities(self) -> dict[str, np.ndarray]:
        kept = self.static_state
        at = States.at_rest(kept["q"][None], kept["s"][None], self.reaction[None],
                            {kind: numbers[None] for kind, numbers in self.couplings.items()})
        found = part_states(self.model, self.scene, at).by_label()
        for cable in self.model.cables:
            found[cable.name]["position"] = found[cable.name]["nodal_vectors"][:, :, cable.vectors.index("r")]
        return {f"{label}.{name}": value[0] for label, values in found.items() for name, value in values.items()}
