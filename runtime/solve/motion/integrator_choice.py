"""The choice of a run's integrator by the demands of the scene."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from ...base.deferred import dataclass
from ...engine import Engine
from ...errors import SceneError
from ...integrators import AUTO, INTEGRATORS, Demands, Explicit, Integrator, Radau, stable_at
from ...kernels.libraries import of_library
from ...model.breakpoints import longest_step_in_waves
from ...model.model import Model
from ...model.taut_ropes import TautPointModel
from ...parts.joint import Joint
from ...parts.rope import rough_sheaves
from ...parts.rope_items import Sheave
from ...parts.scene_data import SceneData
from ...parts.settings import RunSettings
from ...parts.slide import Slide
from ...parts.validation import show
from ..linear.condensation import with_entries, without_forces
from ..notes.supersonic_loads import outrunning
from .stopping_distance import stopping_share

POWER_ITERATIONS = 20
"""Number of power iterations."""
GOLDEN_RATIO = (1 + math.sqrt(5)) / 2

MAX_DENSE_UNKNOWNS = 120
"""Unknowns up to which matrices are arrays: assembly of sparse ones takes longer than products with zeros."""


MAX_TRIAL_COST_RATIO = 4.0
"""Ratio of expected costs, implicit over explicit, up to which the implicit method runs a trial."""

FRICTION_TRIAL_MARGIN = 1.5
"""Cost of the explicit method over that of an implicit one up to which it is taken with kinks of friction, which the
implicit method resolves less well."""

MIN_TRIAL_EVALUATIONS = 3000.0
"""Lower bound of the explicit method's evaluations of eq 38 for a trial against it."""


LOW_ORDER_TOL = 1e-3
"""The tol from which on the method of low order is the first choice: it is cheaper at errors above 1e-3 of the
motion."""

LOW_ORDER_TOL_FRACTION = {False: 0.7, True: 0.4}
"""Fraction of tol for the method of low order, without and with friction: its error can exceed its tol
(tests/benchmarks/choice.py).
"""

MAX_TOL_WITH_FRICTION = 1.2e-3
"""Largest tolerance of that method with friction: the energy of stiff cables can grow without bounds in larger steps.
"""

MAX_LOW_ORDER_COST_RATIO = 4.0
"""Upper bound of the cost of the method of low order over the expected cost of radau."""

LOW_ORDER_EVALUATIONS_PER_RADIAN = 42.0
"""Evaluations of eq 38 that genalpha needs per radian of the overall motion at tol = 1
(tests/benchmarks/exudyn_side_by_side.py); they grow with the square root of 1/tol."""

RADAU_COST_MARGIN = 1.3
"""Cost of radau over the expected cost of genalpha above which genalpha replaces it."""

MIN_LOW_ORDER_TOL = 1e-5
"""Smallest tol at which genalpha may replace radau."""

MIN_LOW_ORDER_EVALUATIONS = 1500.0
"""Lower bound of the explicit method's evaluations of eq 38 for a first trial of the method of low order."""

FAST_TURN_RATIO = 10.0
"""Rate of a turning body over that of the overall motion above which the error control of the method of low order
misses its errors."""

MAX_STOPPING_SHARE = 0.02
"""Distance over which drag stops cables, over their length, up to which vibrations do not grow over the run."""


@dataclass(frozen=True)
class Rival:
    """Another integrator for a run, the work in evaluations of eq 38 from which on it replaces the first, and its
    rival.
    """

    method: Integrator
    cost: float
    rival: Rival | None = None


def choose(settings: RunSettings, scene: SceneData, model: Model, engine: Engine,
           resumed: str | None) -> tuple[Integrator, str, Rival | None]:
    """Return the first integrator of a run, the reason, and the rival that replaces it if that is cheaper.

    resumed: the name of the integrator of a resumed run. Raises SceneError where the integrator that was asked for
    cannot run the scene.
    """
    if not _is_free(settings):
        return *_asked_for(settings, scene, model, engine), None
    if resumed in INTEGRATORS:
        return INTEGRATORS[resumed].of(friction=has_friction(scene)), "as the run began", None
    demands = demands_of(settings, scene, model, engine)
    found = cheapest(demands, settings.duration)
    if not suits_low_order(demands, scene, model):
        return found
    if demands.tol >= LOW_ORDER_TOL:
        return begin_with_low_order(demands, settings.duration, *found)
    return end_with_low_order(demands, settings.duration, *found) if model.slides else found


def _is_free(settings: RunSettings) -> bool:
    """Return whether settings leave the integrator to the scene."""
    return settings.integrator == AUTO and settings.step is None and settings.spectral_radius is None


def tol_of(settings: RunSettings, scene: SceneData, method: Integrator) -> float:
    """Return the tolerance of a run's steps: its tol, or less where the method of low order was chosen automatically.
    """
    if not _is_free(settings) or method.name != stable_at(fixed_step=True).name:
        return settings.tol
    friction = has_friction(scene)
    return min(settings.tol * LOW_ORDER_TOL_FRACTION[friction], MAX_TOL_WITH_FRICTION if friction else math.inf)


def _asked_for(settings: RunSettings, scene: SceneData, model: Model, engine: Engine) -> tuple[Integrator, str]:
    """Return the integrator that the settings determine, directly or by the step, and the reason."""
    check_step_in_waves(settings, scene)
    if settings.integrator != AUTO:
        chosen = INTEGRATORS[settings.integrator].of(settings.spectral_radius, has_friction(scene))
        check(chosen, scene, model, engine)
        return chosen, "as asked for"
    fixed = stable_at(fixed_step=True).of(settings.spectral_radius, has_friction(scene))
    if settings.step is not None:
        return fixed, f"the step is fixed: {fixed.name} is stable at any"
    return fixed, f"spectral_radius is given, which is {fixed.name}'s"


def cheapest(demands: Demands, duration: float) -> tuple[Integrator, str, Rival | None]:
    """Return the integrator with the lowest expected cost, or worth a trial, the reason, and its rival.

    The cost by stability is certain, the cost by the motion is an estimate: of two similar ones the latter is tried.
    """
    said = {one: cost for one in INTEGRATORS.values() if (cost := one.cost(demands)) is not None}
    stable, limited = stable_at(fixed_step=False), min(said, key=lambda one: (one.stability is None, said[one][0]))
    why, sure = ", ".join(text for _, text in said.values()), said[limited][0]
    if said[stable][0] > sure * MAX_TRIAL_COST_RATIO:
        return limited.of(), why, None
    worth = sure * duration >= MIN_TRIAL_EVALUATIONS
    if not worth and said[stable][0] > sure:
        return limited.of(), why, None
    most = sure * duration / (FRICTION_TRIAL_MARGIN if demands.friction else 1.0)
    return stable.of(), why, Rival(limited.of(), most) if worth else None


def suits_low_order(demands: Demands, scene: SceneData, model: Model) -> bool:
    """Return whether the error of positions that genalpha estimates is decisive: not with moving supports, which may
    excite vibrations without end, unless a fluid damps these; bodies that turn fast or outrun their cable's waves, nor
    without cables and ropes.
    """
    fastest = max((float(np.linalg.norm(body.angular_velocity)) for body in scene.bodies.values()), default=0.0)
    return (bool(model.cables or model.ropes) and (not model.motions or stopping_share(scene) <= MAX_STOPPING_SHARE)
            and fastest <= FAST_TURN_RATIO * demands.slow and not outrunning(scene))


def begin_with_low_order(demands: Demands, duration: float, method: Integrator, why: str,
                         rival: Rival | None) -> tuple[Integrator, str, Rival | None]:
    """Return genalpha on trial, the reason, and the method chosen without it as rival; that method itself where the
    explicit one is cheap.

    The cost of the explicit method is certain, that of radau is an estimate.
    """
    explicit, radau = Explicit.cost(demands)[0], Radau.cost(demands)[0]
    if explicit * duration < MIN_LOW_ORDER_EVALUATIONS:
        return method, why, rival
    low = stable_at(fixed_step=True).of(friction=demands.friction)
    most = duration * min(explicit, MAX_LOW_ORDER_COST_RATIO * radau)
    return low, f"{why}; tol is loose: {low.name} has the cheapest steps", Rival(method, most, rival)


def end_with_low_order(demands: Demands, duration: float, method: Integrator, why: str,
                       rival: Rival | None) -> tuple[Integrator, str, Rival | None]:
    """Return the method chosen without genalpha, the reason, and genalpha as its rival where the method is radau, which
    takes many steps at any tol where slides pass many nodes.

    The rival is replaced where it costs four times the estimate.
    """
    tol = LOW_ORDER_TOL_FRACTION[demands.friction] * demands.tol
    expected = duration * LOW_ORDER_EVALUATIONS_PER_RADIAN * demands.slow / math.sqrt(tol)
    most = RADAU_COST_MARGIN * expected
    if not isinstance(method, Radau) or demands.tol < MIN_LOW_ORDER_TOL or (rival is not None and rival.cost < most):
        return method, why, rival
    last = Rival(method, 4.0 * expected) if rival is None or rival.cost > 4.0 * expected else rival
    return method, why, Rival(stable_at(fixed_step=True).of(friction=demands.friction), most, last)


def demands_of(settings: RunSettings, scene: SceneData, model: Model, engine: Engine) -> Demands:
    """Return the demands of a scene on an integrator."""
    frequency, decay = fastest_rates(model, engine)
    decay = max(decay, *(regularised_decay(scene, part) for part in scene.rubbing), 0.0)
    return Demands(frequency, decay, slowest_rate(scene, model, settings.duration), has_friction(scene), settings.tol)


def has_friction(scene: SceneData) -> bool:
    """Return whether a scene has friction by the forces of constraints, or of ropes on sheaves."""
    return any(part.friction is not None and part.friction.sliding for part in scene.rubbing) or any(
        contact.is_hard and contact.friction_coefficient for contact in scene.contacts.values()) or any(
        rough_sheaves(scene.ropes.values()))


def check_step_in_waves(settings: RunSettings, scene: SceneData) -> None:
    """Raise SceneError for a fixed step that goes over waves."""
    for fluid in scene.fluids.values():
        if settings.step is not None and settings.step > (longest := longest_step_in_waves([fluid])):
            raise SceneError(fluid.where, f"has waves that a step of {show(settings.step, 's')} goes over",
                             f"take a step of at most {show(longest, 's')}, a quarter of the shortest period")


def check(integrator: Integrator, scene: SceneData, model: Model, engine: Engine) -> None:
    """Raise SceneError for what an integrator cannot run."""
    who = f'integrator "{integrator.name}"'
    for body in model.bodies:
        if body.modes and not integrator.takes_modal_bodies:
            raise SceneError(scene.bodies[body.name].where, f"{who} does not support modal bodies",
                             f"{_take_another('takes_modal_bodies')}, with a small tol")
    for slide in scene.slides.values():
        if integrator.takes_friction_and_stops:
            break
        if slide.friction is not None or (slide.at_start, slide.at_end) != ("error", "error"):
            raise SceneError(slide.where, f"{who} supports neither friction nor ends of cables",
                             _take_another("takes_friction_and_stops"))
    for joint in scene.joints.values():
        if joint.friction is not None and not integrator.takes_friction_and_stops:
            raise SceneError(joint.where, f"{who} does not support friction of joints",
                             _take_another("takes_friction_and_stops"))
    for crossing in scene.crossings.values():
        if integrator.needs_discrete_gradient and crossing.friction is not None and crossing.friction.sticks:
            raise SceneError(crossing.where, f"{who} does not support friction of crossings that sticks",
                             "take model=\"regularised\", or another integrator")
    for contact in scene.contacts.values():
        if contact.is_hard and contact.friction_coefficient and not integrator.takes_friction_and_stops:
            raise SceneError(contact.where, f"{who} does not support friction of hard contacts",
                             _take_another("takes_friction_and_stops"))
        on = scene.surfaces[contact.b].on
        if contact.is_hard and on is not None and integrator.needs_discrete_gradient:
            raise SceneError(contact.where, f'{who} has no discrete gradient of a hard contact with a surface that '
                             f'moves, and "{contact.b}" is on body "{on}"', "take another integrator")
    if integrator.needs_discrete_gradient:
        _check_ropes(integrator, scene)
        _check_gradients(integrator, scene, model, engine)


def _take_another(capability: str) -> str:
    """Return the end of a message with the integrators that have a capability."""
    able = [one.name for one in INTEGRATORS.values() if getattr(one, capability)]
    return f"take another integrator: {', '.join(able[:-1])} or {able[-1]}"


def _check_ropes(integrator: Integrator, scene: SceneData) -> None:
    """Raise SceneError for ropes without equations over a step that conserves energy."""
    who, another = f'integrator "{integrator.name}"', "take another integrator"
    for rope in scene.ropes.values():
        if not rope.mass:
            raise SceneError(rope.where, f"{who} does not support ropes without mass", another)
        if getattr(integrator, "spectral_radius", 1.0) < 1:
            raise SceneError(rope.where, f"{who} has no algorithmic dissipation of ropes",
                             "take spectral_radius = 1, or another integrator")
        for item in rope.wheels:
            if isinstance(item, Sheave) and not item.contact:
                raise SceneError(rope.where, f"{who} does not support {item.where}, which the rope touches in a run",
                                 f"draw the rope on it, or {another}")


def _check_gradients(integrator: Integrator, scene: SceneData, model: Model, engine: Engine) -> None:
    """Raise SceneError for parts without a discrete gradient, or without the algorithmic dissipation asked for."""
    who = f'integrator "{integrator.name}"'
    for cable in model.cables:
        if not of_library(cable.library)[cable.element].laws[cable.law].discrete_gradient:
            raise SceneError(scene.cables[cable.name].where, f'{who} has no discrete gradient of the law "{cable.law}"',
                             "take another law, or another integrator")
    if getattr(integrator, "spectral_radius", 1.0) < 1:
        for cable in [model.cables[i] for i in engine.without_algorithmic_force()]:
            raise SceneError(scene.cables[cable.name].where,
                             f'{who} has no algorithmic dissipation of the law "{cable.law}"',
                             "take spectral_radius = 1, another law, or another integrator")
    own = [model.couplings[k] for k in engine.without_step_equations()]
    tied = {joint.name for joint in model.joints if joint.slide is not None}
    for joint in (each for each in model.joints if each.joins_pieces and each in own):
        raise SceneError(scene.cables[joint.name].where, f"{who} has no discrete gradient of the joint of its pieces",
                         "give them one axial stiffness and thermal_expansion, or take another integrator")
    labels = dict.fromkeys(coupling.name for coupling in own if coupling.name not in tied)
    parts = [*(part for part in scene.parts() if part.given_name in labels),
             *(part for part, slide in zip(scene.slides.values(), model.slides, strict=True)
               if not slide.rider_is_rigid or slide.drive >= 0 or part.frame != "point")]
    for part in parts:
        raise SceneError(part.where, f"{who} has no discrete gradient of it", "take another integrator")


def regularised_decay(scene: SceneData, part: Slide | Joint) -> float:
    """Return the rate in 1/s at which a slow rider under its weight, or the lighter body of a joint under its normal
    force, approaches the creep speed of regularised friction.
    """
    friction = part.friction
    if friction is None or friction.sticks or part.is_driven:
        return 0.0
    pressed = float(np.linalg.norm(scene.gravity))
    if isinstance(part, Joint) and part.normal_force is not None:
        pressed = part.normal_force / min(scene.bodies[end.on].mass for end in (part.a, part.b) if end.on is not None)
    return friction.sliding * pressed / friction.velocity


def slowest_rate(scene: SceneData, model: Model, duration: float) -> float:
    """Return the rate of the overall motion in rad/s: the largest of a pendulum of the scene's size, of a passage
    through the scene, and of the run.
    """
    points = [node.vector("r") for nodes in model.nodes.values() for node in nodes]
    points += [model.q[b.configuration : b.configuration + model.dim] for b in model.bodies]
    points += [place for rope in model.ropes for span in rope.spans for place in span.places(model.q)]
    if model.ropes:
        points += [np.array(point.attachments[0].u[: model.dim]) for point in model.of(TautPointModel)
                   if point.attachments[0].body < 0]
    size = float(np.max(np.ptp(points, axis=0)))
    if size == 0.0:
        return 1.0 / duration
    speed = max((float(np.linalg.norm(body.velocity)) for body in scene.bodies.values()), default=0.0)
    return float(max(np.sqrt(np.linalg.norm(scene.gravity) / size), speed / size, 1.0 / duration))


def fastest_rates(model: Model, engine: Engine) -> tuple[float, float]:
    """Return the highest frequency in rad/s and rate of decay in 1/s of the state at the start, without slides and
    joints, whose constraints only lower them.
    """
    engine.set_state(0.0)
    n = model.n_band + model.n_border_dof
    if n == 0:
        return 0.0, 0.0
    matrix: Callable[[float, float, float], Any] = engine.dense_matrix if n <= MAX_DENSE_UNKNOWNS else engine.matrix
    by_mass: Callable[[np.ndarray], np.ndarray]
    mass = matrix(1.0, 0.0, 0.0)[:n, :n]
    full = matrix(0.0, 0.0, 1.0)
    if wheels := [*model.sheaves, *model.drums]:
        on_wheels = [n + k for wheel in wheels for k in wheel.force_unknowns]
        by_mass = _on_wheels(mass, with_entries(full[on_wheels][:, :n]))
    elif n <= MAX_DENSE_UNKNOWNS:
        by_mass = np.linalg.inv(mass).dot
    else:
        from scipy.sparse.linalg import splu  # slow to import, and small scenes do without

        by_mass = splu(mass.tocsc(), permc_spec="NATURAL").solve
    stiffness = without_forces(full, slice(n), model)
    decay = 0.0
    if model.is_damped:
        damping = without_forces(matrix(0.0, 1.0, 1.0), slice(n), model) - stiffness
        decay = _largest(damping, mass, by_mass)
    return math.sqrt(_largest(stiffness, mass, by_mass)), decay


def _on_wheels(mass: Any, rows: Any) -> Callable[[np.ndarray], np.ndarray]:
    """Return the product with the inverse of a mass (n, n) on the constraints rows x = 0 (k, n) of tangent points.

    Without these a straight span may flow along its nodes, and has no mass then. mass, rows: arrays or sparse.
    """
    k, n = rows.shape
    if isinstance(mass, np.ndarray):
        return np.linalg.inv(np.block([[mass, rows.T], [rows, np.zeros((k, k))]]))[:n, :n].dot
    from scipy.sparse import block_array, csc_array  # slow to import, and small scenes do without
    from scipy.sparse.linalg import splu

    solve = splu(csc_array(block_array([[mass, rows.T], [rows, None]]))).solve
    return lambda x: solve(np.append(x, np.zeros(k)))[:n]


def _largest(matrix: Any, mass: Any, by_mass: Callable[[np.ndarray], np.ndarray]) -> float:
    """Return about the largest absolute eigenvalue of the symmetric part of a matrix relative to the mass, some per
    cent low, by power iteration.

    matrix, mass: (n, n), arrays or sparse; by_mass: returns mass^-1 times (n,).
    """
    symmetric = (matrix + matrix.T) / 2
    x = np.modf(GOLDEN_RATIO * np.arange(1, matrix.shape[0] + 1))[0] - 0.5  # a start with all eigenvectors in it
    for _ in range(POWER_ITERATIONS - 1):
        x = by_mass(symmetric.dot(x))
        size = math.sqrt(x.dot(x))
        if size == 0.0:
            return 0.0
        x /= size
    pushed = symmetric.dot(x)
    return math.sqrt(by_mass(pushed).dot(pushed) / x.dot(mass.dot(x)))
