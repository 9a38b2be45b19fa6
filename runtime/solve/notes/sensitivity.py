"""How much small errors grow in a motion: what is compressed while it moves buckles or falls over, and the way in which
it does so depends on the least difference.

A straight cable under a compression N deflects as exp(rate t): rate² = k² (N - E I k²) / (rho A) of a wave number k,
the largest at k² = N / (2 E I). A body that a joint pushes with the force N towards its centre of mass, at the distance
l of it, falls over with rate² = N l / I less what its spin about that line resists, (I_s omega / 2 I)² (I about the
joint). The exponents are sums of the rates over the output times. Of a cable's a part counts alone: it bends, and then
bears less. Both parts are measured, over scenes that were compared with their references (tests/benchmarks/choice.py).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ...base.rotations import rotate
from ...engine import Engine, outputs_by_name
from ...model.joints import JointModel
from ...model.loops import joints_in_loops
from ...model.middle_strain import stretches
from ...model.model import BodyModel, CableModel, Model
from ...model.states import attachment_points, body_rates, body_state, joint_state
from ...parts.cable import Cable
from ...parts.joint import Joint
from ...parts.scene_data import SceneData
from ...parts.section_stiffness import compressive_stiffness
from ...parts.settings import RunSettings

SIMPSON_RULE = (0.0, 0.5, 1.0), (1 / 6, 4 / 6, 1 / 6)
"""Simpson's rule on an element, as fractions of its length; the factors of the exponents below were measured with
it."""
CABLE_EXPONENT_FACTOR, BODY_EXPONENT_FACTOR = 0.115, 1.0
"""Effective fraction of the exponents of cables and of bodies, see above."""
MIN_GROWTH_EXPONENT = 0.7
"""Effective exponent above which errors grow."""
MIN_ROWS = 10
"""Output times below which motion between them is not assessed."""
ERROR_REPORT_RATIO = 1.15
"""Ratio of the expected error to the allowed one above which a note reports it."""
FIXED_STEP_ERROR_LIMIT = 5e-3
"""Error of a fixed step that a note reports, as a fraction of the largest motion."""
MAX_REPORTED_EXPONENT = 5.0
"""Largest exponent that a note reports: errors are then as large as the motion."""
SATURATED_EXPONENT = 500.0
"""Exponent at which any error exceeds any motion."""
GROWTH_TEXT = "small differences grow"
"""Text of notes on sensitive motion."""
TOPPLING_JOINTS = "spherical", "revolute", "universal"
"""Kinds of joints about which a body can fall over."""


class Sensitivity:
    """By what errors grow, in each cable and at each joint on which a body stands.

    found: by the name of a cable, or of a joint, in messages: the exponents, of each element of a cable; the time until
    which they are summed, and that from which on errors grow, -1 if they do not, in s; how many times there were.
    """

    def __init__(self, scene: SceneData, model: Model):
        self._scene, self._model = scene, model
        loops = joints_in_loops(model)
        self._joints = [(k, joint, scene.joints[joint.name]) for k, joint in enumerate(model.joints)
                        if joint.slide is None and not loops[k] and _lets_fall(scene.joints[joint.name])]
        self.found: dict[str, Any] = {}

    def see(self, rows: dict[str, np.ndarray]) -> None:
        """Take further output rows."""
        for cable in self._model.cables:
            self._add(self._scene.cables[cable.name].where, rows["time"],
                      CABLE_EXPONENT_FACTOR * self._of_cable(cable, rows["q"]))
        for k, joint, part in self._joints:
            self._add(part.where, rows["time"], BODY_EXPONENT_FACTOR * self._of_joint(k, joint, rows))

    @property
    def worst(self) -> tuple[float, str, float]:
        """Return the largest exponent that counts, the part that it is of, and from when on errors grow there, s."""
        return max(((max(exponents), name, since) for name, (exponents, _, since, rows) in self.found.items()
                    if rows >= MIN_ROWS), default=(0.0, "", -1.0))

    @property
    def cables(self) -> list[Cable]:
        """Return the cables of the scene."""
        return list(self._scene.cables.values())

    def notes(self) -> list[str]:
        """Return nothing: what the exponents tell depends on the errors of the steps, see `sensitive`."""
        return []

    def _add(self, name: str, time: np.ndarray, rates: np.ndarray) -> None:
        """Add rates (times, exponents) to the exponents of a part, 1/s."""
        exponents, until, since, rows = self.found.get(name, ([0.0] * rates.shape[1], 0.0, -1.0, 0))
        grown = np.array(exponents) + np.cumsum(rates * np.diff(time, prepend=until)[:, None], axis=0)
        begun = np.flatnonzero(grown.max(axis=1) > MIN_GROWTH_EXPONENT)
        if since < 0 and len(begun):
            since = float(time[begun[0]])
        self.found[name] = [grown[-1].tolist(), float(time[-1]), since, rows + len(time)]

    def _of_cable(self, cable: CableModel, q: np.ndarray) -> np.ndarray:
        """Return (times, elements): the rates at which elements of a cable buckle, 1/s."""
        part = self._scene.cables[cable.name]
        vectors = q[:, cable.coordinates].reshape(-1, *cable.shape)
        strain = stretches(cable, vectors[:, :-1], vectors[:, 1:], np.arange(cable.n_elements), SIMPSON_RULE) - 1
        E, moments = part.material.youngs_modulus, part.section.moments()
        EA = compressive_stiffness(part.traits.membrane, part.section, part.material)
        EI = E * (moments[1] if self._model.dim == 2 else min(moments[1:3]))
        mass = part.material.density * part.section.mass_moments()[0]
        N = EA * np.maximum(-strain, 0.0)
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):  # of a rope without stiffness
            k = np.clip(np.nan_to_num(np.sqrt(N / (2 * EI)), posinf=np.inf), np.pi / part.length,
                        np.pi / cable.mesh.lengths)
            return np.nan_to_num(np.sqrt(np.maximum(k**2 * (N - EI * k**2), 0.0) / mass))

    def _of_joint(self, k: int, joint: JointModel, rows: dict[str, np.ndarray]) -> np.ndarray:
        """Return (times, 1): the larger rate at which a body at one of its ends falls over, 1/s."""
        on_b = joint_state(joint, outputs_by_name("joint", rows["joint"][:, k]))["force"]
        found = np.zeros((len(on_b), 1))
        for end, force in zip(joint.attachments, (-on_b, on_b), strict=True):
            body = self._model.bodies[end.body] if end.body >= 0 else None
            if body is not None and body.shape is None:
                point = attachment_points(self._model, end, rows["q"])
                found = np.maximum(found, _falling(self._model, body, point, force, rows)[:, None])
        return found


def sensitive(engine: Engine, settings: RunSettings, found: Sensitivity) -> list[str]:
    """Return a note where the errors of the steps, which grow in the motion, may become more than is allowed."""
    exponent, where, since = found.worst
    total = engine.statistics["sum_of_local_error_estimates_m"]
    fixed, motion = settings.step is not None, engine.controlled_motion
    allowed = FIXED_STEP_ERROR_LIMIT * motion if fixed else settings.tol * motion + max(engine.absolute_tol, 0.0)
    if not (engine.moves and exponent >= MIN_GROWTH_EXPONENT
            and total * np.exp(min(exponent, SATURATED_EXPONENT)) > ERROR_REPORT_RATIO * allowed):
        return []
    grown = total * np.exp(min(exponent, MAX_REPORTED_EXPONENT))
    may = f"{min(grown / motion, 1.0):.1g} of the largest motion, or more" if fixed else _times(grown / allowed)
    what = "is compressed while it moves, and buckles" if where in [part.where for part in found.cables] else (
        "pushes a body that falls over")
    return [f"{where} {what}: from t = {since:.3g} s on {GROWTH_TEXT}, and errors may become {may}. "
            f"Give estimate=True, which measures them, or a smaller {'step' if fixed else 'tol'}, or more damping"]


def _times(ratio: float) -> str:
    """Return how much more than what tol allows an error is, in words."""
    return "more than tol allows" if ratio < 2 else f"{float(f'{ratio:.1g}'):.0f} times what tol allows, or more"


def _lets_fall(joint: Joint) -> bool:
    return joint.joint_kind in TOPPLING_JOINTS and not joint.is_driven


def _falling(model: Model, body: BodyModel, point: np.ndarray, force: np.ndarray,
             rows: dict[str, np.ndarray]) -> np.ndarray:
    """Return (times,): the rate at which a body falls over that a force (times, 3) on a point of it pushes, 1/s."""
    state = body_state(model, body, rows["q"])
    turns = body_rates(model, body, state["orientation"], rows["v"])["angular_velocity"]
    arm = state["position"] + rotate(state["orientation"], body.centre) - point
    length = np.linalg.norm(arm, axis=1)
    if length[0] == 0:
        return np.zeros(len(length))
    conjugate = state["orientation"] * np.array([1.0, -1.0, -1.0, -1.0])
    along = rotate(conjugate[0], arm[0] / length[0])  # in body axes
    own = float(along @ body.inertia @ along)
    across = (float(np.trace(body.inertia)) - own) / 2 + body.mass * length**2
    push = np.einsum("ti,ti->t", force, arm)
    return np.sqrt(np.maximum(push / across - (own * (turns @ along) / (2 * across)) ** 2, 0.0))
