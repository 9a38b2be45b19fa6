"""Growth of small errors in a motion: parts under compression buckle or fall over while they move, in a direction that
depends on the smallest difference.

A straight cable under a compression N deflects as exp(rate t): rate² = k² (N - E I k²) / (rho A) of a wave number k,
the largest at k² = N / (2 E I). A body that a joint pushes with the force N towards its centre of mass, at the distance
l of it, falls over with rate² = N l / I - (I_s omega / 2 I)², with the stabilising spin about that line (I about the
joint). The exponents are sums of the rates over the output times. Only a fraction of a cable's exponent counts, as a
bent cable bears less. Both fractions are measured on scenes with references (tests/benchmarks/choice.py).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...base.rotations import rotate
from ...engine import Engine, outputs_by_name
from ...model.joints import JointModel
from ...model.middle_strain import stretches
from ...model.model import BodyModel, CableModel, Model
from ...model.redundant_constraints import joints_in_loops
from ...model.states import attachment_points, body_rates, body_state, joint_state
from ...parts.cable import Cable
from ...parts.section_stiffness import compressive_stiffness
from ...parts.settings import RunSettings
from .note import LineStiffness, Note, Rows, allowed_error, intervals

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
MAX_REPORTED_EXPONENT = 5.0
"""Largest exponent that a note reports: errors are then as large as the motion."""
SATURATED_EXPONENT = 500.0
"""Exponent at which any error exceeds any motion."""
GROWTH_TEXT = "small differences grow"
"""Text of notes on sensitive motion."""
TOPPLING_JOINTS = "spherical", "revolute", "universal"
"""Kinds of joints about which a body can fall over."""


class _Strut(NamedTuple):
    """A cable, and its stiffness in N against compression."""

    cable: CableModel
    part: Cable
    of: LineStiffness
    stiffness: float

    @classmethod
    def find(cls, cable: CableModel, part: Cable, dim: int) -> _Strut:
        """Return that of a cable in a scene of a dimension."""
        return cls(cable, part, LineStiffness.of(part, dim),
                   max(compressive_stiffness(part.traits.membrane, piece.section, piece.material)
                       for piece in part.uniform_pieces))

    def rates(self, q: np.ndarray) -> np.ndarray:
        """Return (times, elements): the rates in 1/s at which elements of the cable buckle."""
        cable, length, (_, EI, _, mass) = self.cable, self.part.length, self.of
        nodal = cable.strained(q)
        ends = nodal[:, cable.mesh.first], nodal[:, cable.mesh.last]
        strain = stretches(cable, *ends, np.arange(cable.n_elements), SIMPSON_RULE) - 1
        if self.stiffness * -strain.min() <= np.min(EI) * (np.pi / length) ** 2:  # not even in one wave along the cable
            return np.zeros(strain.shape)
        N = self.stiffness * np.maximum(-strain, 0.0)
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):  # of a rope without stiffness
            k = np.clip(np.nan_to_num(np.sqrt(N / (2 * EI)), posinf=np.inf), np.pi / length,
                        np.pi / cable.mesh.lengths)
            return np.asarray(np.nan_to_num(np.sqrt(np.maximum(k**2 * (N - EI * k**2), 0.0) / mass)))


class Sensitivity(Note):
    """The exponents by which errors grow, in each element of a cable or at each joint on which a body stands; the time
    in s until which they are summed, that from which on errors grow, -1 if they do not, and the number of output times.

    Its note depends on the errors of the steps, see `sensitive`.
    """

    measures = (CableModel, JointModel)

    def prepare(self) -> None:
        """Select the joints about which a body can fall over, and find the stiffnesses of the cables."""
        self._cables = [_Strut.find(cable, self.scene.cables[cable.name], self.model.dim)
                        for cable in self.model.cables]
        loops, parts = joints_in_loops(self.model), self.scene.joints
        self._joints = [(k, joint, parts[joint.name]) for k, joint in enumerate(self.model.joints)
                        if joint.is_of_scene and not loops[k] and parts[joint.name].joint_kind in TOPPLING_JOINTS
                        and not parts[joint.name].is_driven]

    def see(self, rows: Rows) -> None:
        """Measure further output rows."""
        for strut in self._cables:
            self._add(strut.part.where, rows["time"], CABLE_EXPONENT_FACTOR * strut.rates(rows["q"]))
        for k, joint, hinge in self._joints:
            self._add(hinge.where, rows["time"], BODY_EXPONENT_FACTOR * self._of_joint(k, joint, rows))

    @property
    def worst(self) -> tuple[float, str, float]:
        """The largest exponent of all parts, its part, and the time in s from which on errors grow there."""
        return max(((max(exponents), name, since) for name, (exponents, _, since, rows) in self.found.items()
                    if rows >= MIN_ROWS), default=(0.0, "", -1.0))

    @property
    def cables(self) -> list[Cable]:
        """The cables of the scene."""
        return list(self.scene.cables.values())

    def _add(self, name: str, time: np.ndarray, rates: np.ndarray) -> None:
        """Add rates (times, exponents) in 1/s to the exponents of a part."""
        exponents, until, since, rows = self.found.get(name, ([0.0] * rates.shape[1], 0.0, -1.0, 0))
        if rates.any():
            grown = np.array(exponents) + np.cumsum(rates * intervals(time, until)[:, None], axis=0)
            begun = np.flatnonzero(grown.max(axis=1) > MIN_GROWTH_EXPONENT)
            if since < 0 and len(begun):
                since = float(time[begun[0]])
            exponents = grown[-1].tolist()
        self.found[name] = [exponents, float(time[-1]), since, rows + len(time)]

    def _of_joint(self, k: int, joint: JointModel, rows: dict[str, np.ndarray]) -> np.ndarray:
        """Return (times, 1): the larger rate in 1/s at which a body at one of its ends falls over."""
        on_b = joint_state(joint, outputs_by_name("joint", rows["joint"][:, k]))["force"]
        found = np.zeros((len(on_b), 1))
        for end, force in zip(joint.attachments, (-on_b, on_b), strict=True):
            body = self.model.bodies[end.body] if end.body >= 0 else None
            if body is not None and body.shape is None:
                point = attachment_points(self.model, end, rows["q"])
                found = np.maximum(found, _falling(self.model, body, point, force, rows)[:, None])
        return found


def sensitive(engine: Engine, settings: RunSettings, found: Sensitivity | None) -> list[str]:
    """Return a note where the errors of the steps, which grow in the motion, may become more than is allowed."""
    if found is None or (worst := found.worst)[0] < MIN_GROWTH_EXPONENT or not engine.moves:
        return []
    exponent, where, since = worst
    total = engine.statistics["sum_of_local_error_estimates_m"]
    fixed, motion, allowed = settings.step is not None, engine.controlled_motion, allowed_error(engine, settings)
    if not total * np.exp(min(exponent, SATURATED_EXPONENT)) > ERROR_REPORT_RATIO * allowed:
        return []
    grown = total * np.exp(min(exponent, MAX_REPORTED_EXPONENT))
    may = f"{min(grown / motion, 1.0):.1g} of the largest motion, or more" if fixed else _times(grown / allowed)
    what = "is compressed while it moves, and buckles" if where in [part.where for part in found.cables] else (
        "pushes a body that falls over")
    return [f"{where} {what}: from t = {since:.3g} s on {GROWTH_TEXT}, and errors may become {may}. "
            f"Give estimate=True, which measures them, or a smaller {'step' if fixed else 'tol'}, or more damping"]


def _times(ratio: float) -> str:
    """Return in words the ratio of an error to the one that tol allows."""
    return "more than tol allows" if ratio < 2 else f"{float(f'{ratio:.1g}'):.0f} times what tol allows, or more"


def _falling(model: Model, body: BodyModel, point: np.ndarray, force: np.ndarray,
             rows: dict[str, np.ndarray]) -> np.ndarray:
    """Return (times,): the rate in 1/s at which a body falls over under a force (times, 3) on one of its points."""
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
    return np.asarray(np.sqrt(np.maximum(push / across - (own * (turns @ along) / (2 * across)) ** 2, 0.0)))
