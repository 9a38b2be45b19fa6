"""A state of rest: what a search for equilibrium finds, and a run or modes start from."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Self

import numpy as np

from ...base.named_arrays import NamedArrays
from ...errors import EquilibriumError, SceneError, UnknownResultError, near
from ...model.kinds import COUPLINGS
from ...model.model import Model
from ...model.part_states import States, numbers_at_rest, part_states
from ...model.states import attachment_points
from ...parts.joint import Joint
from ...parts.part import Part
from ...parts.paths import path_of, value_at
from ...parts.plane import called
from ...parts.scene_data import SceneData
from ...parts.validation import show
from .stability import Stability
from .static_problem import StaticState
from .turns import prescribed_angles

VALUE_ROUNDING = 1e-12
"""Rounding error of an adjusted value, as a fraction of it."""
POSITION_TOLERANCE = 1e-6
"""Distance of two equal positions, as a fraction of the scene's size."""

SIGNAL_START_REMEDY = "let its signal start at the value of the state, or take the equilibrium of this scene"


def in_loads(fraction: float) -> str:
    """Return how much of the loads is on, in words."""
    return "all loads" if fraction == 1 else f"{fraction:.6g} times the loads"


def layout(scene: SceneData) -> dict[str, list]:
    """Return what must be the same in two scenes for a state of one to be a state of the other."""
    found: dict[str, list] = {
        "cables": [(c.name, c.element, c.elements, c.length, *c.uneven_nodes) for c in scene.cables.values()],
        "plane": [called(scene.plane)], "bodies": list(scene.bodies)}
    for kind in COUPLINGS:
        if kind.has_state:
            found[kind.group] = [_without_ends(part) for part in scene.group(kind.group)]
    return found


def _without_ends(part: Part) -> str | tuple[str, str]:
    """Return the name of a part, of a joint with its kind, which says how many unknowns it has."""
    name = part.given_name or part.kind
    return (name, part.joint_kind) if isinstance(part, Joint) else name


def _without_mesh(cable: tuple) -> tuple:
    """Return the name, element and length of a cable in a layout."""
    name, element, _, length, *_ = cable
    return name, element, length


@dataclass
class CriticalPoint:
    """A point of a load path at which stability changes or the load turns.

    load_fraction: of the loads; kind: "limit", where the load stops rising or falling, or "bifurcation", where another
    path of equilibria crosses this one; directions: how many more directions are unstable beyond it; state: there.
    """

    load_fraction: float
    kind: str
    directions: int
    state: RestState = field(repr=False)


@dataclass
class Relaxation:
    """How a scene came to rest by a damped motion.

    steps: of the motion; resets: how often all velocities were set to zero; energies: elastic, of weight and of loads,
    at the resets, J, which never rise but where the scene was pushed off an unstable branch, or where loads turn with
    what they act on; residuals: the largest forces left over there, N.
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
    """What was changed in a scene so that its state of rest has given values.

    values: the parameters found, by path; targets: the values of the state asked for, by name; found: those reached;
    jacobian (targets, parameters): derivatives of the state's values by the parameters, at the state; iterations: of
    Newton's method on the parameters; misfits: at its states, the largest distance from a target over the scale of that
    (the scene's size of a position, the larger of target and first value of what else there is).
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
    how much of the load is on, 1 but in the `EquilibriumError` that says how far it got, and along a path; iterations
    of Newton; residual: the largest force left over, in N; stability: see `Stability`; path: the states of rest on the
    way, each under its load_fraction of all loads, in their order, this one last: what a curve of load and displacement
    is drawn from; critical_points of that path; gravity_fraction: how much of gravity is on, all of it where
    scale_gravity is off; messages: what the search passed, adjusted or left out; relaxation: how `Scene.relax` came to
    the state, else None; turned: the angles of motions and driven joints that it has, whole turns counted, in rad by
    label; adjustment: what the search changed in the scene for given values of the state, else None; ``scene`` is the
    one with the values found, then.
    """

    scene: SceneData
    model: Model
    static_state: dict
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
    layout: dict[str, list] = field(default_factory=dict, repr=False)
    turned: dict[str, float] = field(default_factory=dict, repr=False)
    relaxation: Relaxation | None = None
    adjustment: Adjustment | None = None

    @classmethod
    def of(cls, problem: StaticState, stability: Stability, heading: np.ndarray | None = None) -> Self:
        """Read the static state of a problem, under the load that is on; heading: of the path there."""
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
        return state

    def __repr__(self) -> str:
        """Return how the state is and how many results it has, in a line."""
        stable = "stable" if self.stable else f"{self.unstable_directions} unstable directions"
        return (f"<funicular.Equilibrium: {stable}, under {in_loads(self.load_fraction)}, "
                f"{len(self.quantities)} results>")

    @property
    def adjusted(self) -> dict[str, float]:
        """Return the values of the parameters that the search for the state adjusted, by path; empty without any."""
        return {} if self.adjustment is None else dict(self.adjustment.values)

    @property
    def unstable_directions(self) -> int:
        """Return how many independent directions lower the energy; of loads that turn: in how many the state diverges.
        """
        return self.stability.unstable

    @property
    def neutral_directions(self) -> int:
        """Return how many independent directions leave the energy as it is: what is free to move."""
        return self.stability.neutral

    @property
    def stable(self) -> bool:
        """Return whether no direction lowers the energy; False also where that could not be counted."""
        return self.stability.known and self.stability.unstable == 0

    def check_stable(self, cause: str = "") -> None:
        """Raise EquilibriumError where the state is known to be unstable; cause: as the message goes on."""
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
            if any_mesh and kind == "cables" and [_without_mesh(c) for c in here] == [_without_mesh(c) for c in held]:
                continue
            if here != held:
                raise SceneError("scene", f"the state to start from is of another scene: its {kind} are "
                                 f"{held}, here they are {here}", "take an equilibrium of this scene")

    def check_adjusted(self, scene: SceneData) -> None:
        """Raise SceneError where the scene lacks the values that were adjusted for the state, as it would not rest."""
        for name, value in self.adjusted.items():
            here = value_at(scene, path_of(scene, name, "adjust"))
            if here is None or abs(here - value) > VALUE_ROUNDING * abs(value):
                raise SceneError("scene", f"the state to start from is at rest with {name} = {value:.9g}, to which it "
                                 f"was adjusted, here it is {here}", "take the state's own scene: rest.scene")

    def check_supports(self, model: Model, scene: SceneData) -> None:
        """Raise SceneError where supports or ends of joints are elsewhere in a freshly built model of a scene than they
        are in this state, drawn there or prescribed to be there at t = 0.
        """
        q, size = self.static_state["q"][None], max(float(np.abs(model.q).max(initial=0.0)), 1.0)
        for was, joint in zip(self.model.joints, model.joints, strict=True):
            if joint.slide is not None:
                continue
            was_open, is_open = (np.subtract(*(attachment_points(of, end, q)[0] for end in each.attachments))
                                 for of, each in ((self.model, was), (model, joint)))
            moved = float(np.linalg.norm(is_open - was_open))
            if "distance" in joint.kernel:
                moved = max(moved, abs(joint.base - was.base))
            if moved > POSITION_TOLERANCE * size:
                raise SceneError("scene", f'the state to start from has an end of the joint "{joint.name}" '
                                 f"{moved:.3g} m from where it is here", "take an equilibrium of this scene")
        if model.cables:
            own = slice(0, model.cables[-1].coordinates.stop)
            fixed = model.unknown_of_dof[own] == -1
            fixed[[motion.dof for motion in model.motions if motion.dof < own.stop]] = False
            moved = np.abs(self.static_state["q"][own] - model.q[own]) * model.weight[own] * fixed
            if np.max(moved) > POSITION_TOLERANCE * max(cable.mesh.total for cable in model.cables):
                raise SceneError("scene", f"the state to start from has a support {np.max(moved):.3g} m from where it "
                                 "is here", "take an equilibrium of this scene")
        self._check_prescribed(model, scene)

    def _check_prescribed(self, model: Model, scene: SceneData) -> None:
        """Raise SceneError where motions or angles of joints prescribe other values at t = 0 than the state has."""
        for label, angle in prescribed_angles(scene, model).items():
            if abs(angle - self.turned.get(label, angle)) > POSITION_TOLERANCE * (1 + abs(angle)):
                raise SceneError("scene", f'the angle of "{label}" is {show(angle, "rad")} at t = 0, but the state to '
                                 f'start from has {show(self.turned[label], "rad")}', SIGNAL_START_REMEDY)
        moved = {dof: abs(value - self.static_state["q"][dof]) * model.weight[dof]
                 for dof, value in model.prescribed_at(0.0).items()}
        if moved and (most := max(moved.values())) > POSITION_TOLERANCE * max(
                cable.mesh.total for cable in model.cables):
            raise SceneError("scene", f"a motion begins {show(most, 'm')} from where the state to start from has it",
                             SIGNAL_START_REMEDY)

    def start(self, model: Model, scene: SceneData) -> None:
        """Put a freshly built model of the scene into this state. Raises SceneError where supports are elsewhere."""
        self.check_supports(model, scene)
        model.q = self.static_state["q"].copy()
        model.place_slides(self.static_state["s"])

    def _quantities(self) -> dict[str, np.ndarray]:
        kept = self.static_state
        at = States.at_rest(kept["q"][None], kept["s"][None], self.reaction[None],
                            {kind: numbers[None] for kind, numbers in self.couplings.items()})
        found = part_states(self.model, self.scene, at).by_label()
        for cable in self.model.cables:
            found[cable.name]["position"] = found[cable.name]["nodal_vectors"][:, :, cable.vectors.index("r")]
        return {f"{label}.{name}": value[0] for label, values in found.items() for name, value in values.items()}
