"""Messages on the failure of a run and on the errors of its results: place, likely cause and remedy."""

from __future__ import annotations

import numpy as np

from ...engine import Engine
from ...integrators import INTEGRATORS, stable_at
from ...model.contacts import HardContactModel
from ...model.model import CableModel, Model, SlideModel
from ...model.redundant_constraints import redundant
from ...model.ropes import SpanModel
from ...model.taut_ropes import TautPointModel
from ...parts.rope_route import MIN_WRAP
from ...parts.scene_data import SceneData
from ...parts.settings import RunSettings
from .folds import FOLDED_CHORD
from .note import FIXED_STEP_ERROR_LIMIT

RESULTS_KEPT = "results up to that time are kept"
ROPE_LEFT = (
    ('a rope leaves sheave "{name}", as its wrap angle reaches {wrap:g} rad,',
     "move the sheave into the way of the rope, leave it out, or stop before by an event"),
    ('a rope lifts off {kind} "{name}", as its tension is not above rho v² and its weight there, for the mass rho of a '
     "length at the speed v,", "take a higher tension or a lower speed, or stop before by an event"),
    ('a rope leaves the groove of {kind} "{name}", as a span is too short for its fleet angle f: not above 3 R tan f,',
     "turn the axis, keep what is at the ends of the span apart, or stop before by an event"),
    ('a span of rope "{name}" becomes too short to be modelled',
     "keep what is at the ends of the span apart, or stop before by an event"),
    *(("{reached},",
       "give the rope less way, take a point farther away, or stop before by an event"),) * 2,
    ('drum "{name}" has run empty', "give a greater length_in_store, or stop before by an event"),
    ('a rope without mass meets sheave "{name}" from its other side',
     "give a sheave on that side, or stop before by an event"),
    ('the length of rope "{name}" at the start differs from that as drawn by more than half a turn around a wheel, so '
     "that its turns are not known,", "draw the scene nearer to this start, or resume the run that it is from"),
    ('a rope returns to sheave "{name}" and passes beside its groove, by more than half of groove_width,',
     "guide the rope, give a greater groove_width, or stop before by an event"),
    ('a rope leaves the groove of sheave "{name}" along its axis, with a kink above max_fleet_angle,',
     "turn the axis, give a greater max_fleet_angle, or stop before by an event"),
    ('a rope without mass is on sheave "{name}" at the start, beside the middle of its groove: where it lies along the '
     "axis is not known,", "draw the scene at this start, or resume the run that it is from"))
"""Why a run with a rope ended, and what helps, by the reasons of engine/equations/run.h."""
EMPTY = 6
"""The reason of a drum."""
GRIP = EMPTY - 2
"""The reason of a span at whose first end a point arrives that a joint or a spring holds, or a slide; at its last end
one more."""

MAX_PLAUSIBLE_STRETCH = 3.0
"""Messages name elements that are longer than this multiple of their undeformed length."""

COORDINATE_ROUNDING = 4e-16
"""Lower bound of the error control, as a fraction of the largest coordinate (engine/equations/step_control.c)."""

MIN_MOTION = 1e-9
"""Motion below this fraction of the largest coordinate may be rest (engine/run/start.c)."""
MIN_ENERGY_EXCHANGE = 0.01
"""Lower bound of the exchanged energy, as a fraction of the kinetic energy: bodies that turn freely exchange less."""

CONTINUOUS_CURVATURE_ELEMENT = "cable18"
"""The element whose curvature is continuous at nodes."""
MANY_NODE_PASSAGES, NODE_PASSAGES_PER_STEP = 100, 0.02
"""Node passages of slides in a run, and per step, above which a message reports them."""

ENERGY_ERROR_LIMIT, LOOSE_ENERGY_ERROR_LIMIT = 0.01, 0.05
"""Unexplained energy above which a note reports it, as a fraction of the energy exchanged; the second limit holds for
loose tolerances."""


def stopped(model: Model, engine: Engine, status: str, settings: RunSettings) -> str:
    """Return the message of a run that found no acceptable step, lost a joint or whose energy grew."""
    when = f"t = {engine.time:.6g} s of {settings.duration:.6g} s"
    cause, dof, coupling = engine.failure
    _, q, v, _ = engine.now()
    where, (state, folded) = describe_dof(model, dof, coupling), condition(model, dof, q, v)
    of_a_body = coupling is None and _node(model, dof) is None
    if status == "unstable":
        grown, _, exchanged, in_motion, _ = engine.balance
        exchanged = max(exchanged, in_motion)
        return (f"energy grew without a source at {when}: {grown:.3g} J, where {exchanged:.3g} J were exchanged; "
                f"fastest is {where} ({state}); {RESULTS_KEPT}. {_too_large(engine, settings)}")
    if cause is None and status == "no_convergence":
        return (f"no step could be made at {when}: to pass an event there it would have to be shorter than 1e-12 of "
                f"the duration; {RESULTS_KEPT}. Look at slides, stops and events that act at the same instant")
    if doubled := redundant(model, engine):
        return (f"no step converged at {when}: {doubled} constrain nearly the same motion; {RESULTS_KEPT}. "
                "Leave one of them out, or attach the body at points farther apart")
    if status == "singular" or cause == "matrix":
        why, remedy = ("", "Look at its mass and inertia, and at its joints") if of_a_body else (
            ", as where a cable's tangent vanishes or its director lies along it",
            "Look at the masses and at up, or take more elements there")
        return (f"the equations are singular at {when}, first at {where} ({state}): a joint or the mass matrix is "
                f"degenerate{why}; {RESULTS_KEPT}. {remedy}")
    assert cause is not None, "a step that failed has a cause"
    what = {"iteration": f"the iteration does not converge, with the largest correction at {where}",
            "error": f"the error exceeds what tol allows, most at {where}",
            "lost_rider": f"{where} has lost its point on the cable",
            "not_finite": f"{where} diverges",
            "self_locking": _self_locking(model, coupling, where),
            "not_known": f"{where} has lost its contact state"}[cause]
    counts = engine.statistics
    gone = f" after {counts['steps']} steps down to {counts['smallest_step_s']:.2g} s" if counts["steps"] else ""
    if cause == "not_known":
        return (f"no force is known at {when}: {what}; {RESULTS_KEPT}. A crossing has no closest points where its "
                "lines are parallel near each other, or wind around each other: keep them at an angle. A line that "
                "moves around an end of the other changes sides: begin with them in contact, or make them longer")
    if settings.step is not None and INTEGRATORS[engine.integrator].stability is not None:
        remedy = _too_large(engine, settings)
    elif cause == "self_locking" and _is_force(model, coupling):
        remedy = "Take a smaller stiffness or tol, or give it damping"
    elif cause == "self_locking":
        remedy = "Take a smaller coefficient, or the point nearer to the centre of mass"
    elif folded:
        remedy = f"The cable folds up there: take more elements{damping(model, dof)}"
    else:
        remedy = ("Look at loads, masses and stiffnesses there; else try a smaller "
                  f"{'tol' if settings.step is None else 'step'}{damping(model, dof, coupling)}")
    return f"no step converged at {when}{gone}: {what} ({state}); {RESULTS_KEPT}. {remedy}"


def _too_large(engine: Engine, settings: RunSettings) -> str:
    size = f"tol {settings.tol:g}" if settings.step is None else f"step {settings.step:g} s"
    coarsest = 0.0 if settings.step is not None else settings.absolute_tol or 0.0
    if coarsest and coarsest > settings.tol * engine.controlled_motion:
        size = f"absolute_tol {coarsest:.3g} m"
    others = "" if settings.step is None else ", or none, so that tol chooses it"
    stable = ""
    if INTEGRATORS[engine.integrator].stability is not None:
        stable = f', or integrator="{stable_at(settings.step is not None).name}"'
    elif INTEGRATORS[engine.integrator].loses_energy_by_spectral_radius and settings.spectral_radius == 1:
        stable = (", or a spectral_radius below 1, as at 1 nothing damps the vibrations that joints excite from step "
                  'to step; integrator="energy" needs no damping')
    return f'The {size} is too large for integrator "{engine.integrator}": take a smaller one{others}{stable}'


def _is_force(model: Model, coupling: int | None) -> bool:
    """Return whether a failure is of a coupling with a force law and without a constraint."""
    return coupling is not None and not isinstance(model.couplings[coupling], SlideModel | HardContactModel)


def _self_locking(model: Model, coupling: int | None, where: str) -> str:
    """Return a text on the coupling whose friction has no solution."""
    if coupling is not None and isinstance(model.couplings[coupling], HardContactModel):
        return (f"no normal and friction forces continue the motion of {where}: friction is self-locking, or contact "
                "states alternate without end")
    if _is_force(model, coupling):
        return f"{where} alternates between two states at one instant without end"
    return f"friction is self-locking at {where}: friction increases the normal force of the rider on the cable"


def rope_left(model: Model, number: int, reason: int) -> tuple[str, str]:
    """Return in words why a run with a rope ended, and what helps, by the number of a coupling and a reason."""
    coupling = model.couplings[number]
    cause, remedy = ROPE_LEFT[reason]
    held: dict[str, str] = {}
    if reason in (GRIP, GRIP + 1):
        assert isinstance(coupling, SpanModel | SlideModel)
        held = {"reached": coupling.reached(reason - GRIP)}
    kind, wrap = coupling.type, MIN_WRAP
    if isinstance(coupling, TautPointModel):
        kind, wrap = "drum" if coupling.is_end else "sheave", 0.0
    return cause.format(name=coupling.name, kind=kind, wrap=wrap, **held), remedy


def describe_dof(model: Model, dof: int, coupling: int | None = None) -> str:
    """Return the part and place of a dof, or the coupling with this number."""
    if coupling is not None:
        failed = model.couplings[coupling]
        if not isinstance(failed, SlideModel):
            return f'{failed.type.removeprefix("hard_").replace("_", " ")} "{failed.name}"'
        return f'slide "{failed.name}" on {failed.line.where}'
    if (found := _node(model, dof)) is not None:
        cable, node = found
        return f'cable "{cable.name}" at s = {cable.mesh.node_s[node]:.6g} m'
    for rope in model.ropes:
        if rope.coordinates.start <= dof < rope.coordinates.stop:
            return f'rope "{rope.part.name}"'
    return [f'body "{body.name}"' for body in model.bodies if body.dof <= dof][-1]


def damping(model: Model, dof: int, coupling: int | None = None) -> str:
    """Return the end of a remedy: the damping of the part of a dof, or of a slide's cable; empty for a rigid body."""
    found, failed = _node(model, dof), None if coupling is None else model.couplings[coupling]
    cable = found and found[0]
    if isinstance(failed, SlideModel):
        cable = model.cables[failed.cable] if failed.cable >= 0 else None
    if cable:
        return f", or {'a larger ' if cable.tau else ''}damping_time in the material"
    bodies = [body for body in model.bodies if body.dof <= dof]
    return ", or a larger damping_ratio of the body" if bodies and bodies[-1].modes else ""


def condition(model: Model, dof: int, q: np.ndarray, v: np.ndarray) -> tuple[str, bool]:
    """Return a text on the state at a dof, and whether its cable is folded there."""
    speed = f"{abs(v[dof]) * model.weight[dof]:.3g} m/s"
    if (found := _node(model, dof)) is None:
        return speed, False
    cable, node = found
    r, end = cable.nodal(q)[:, 0], int(cable.mesh.boundary_of_node[node])
    stretch = (np.linalg.norm(r[cable.mesh.last] - r[cable.mesh.first], axis=1) / cable.mesh.lengths)[
        max(end - 1, 0) : end + 1]
    worst = stretch[np.argmax(np.abs(np.log(np.maximum(stretch, 1e-300))))]
    fair = FOLDED_CHORD < worst < MAX_PLAUSIBLE_STRETCH
    notes = "" if fair else f"its elements there are {worst:.3g} times their length at rest, "
    return notes + speed, bool(worst <= FOLDED_CHORD)


def _node(model: Model, dof: int) -> tuple[CableModel, int] | None:
    """Return the cable and the number of the node of a dof; None for a body's."""
    for cable in model.cables:
        if cable.coordinates.start <= dof < cable.coordinates.stop:
            return cable, (dof - cable.first) // (cable.shape[1] * cable.shape[2])
    return None


def notes(engine: Engine, settings: RunSettings) -> list[str]:
    """Return notes on a completed run whose results are coarse."""
    counts, notes = engine.statistics, []
    if settings.step is not None and counts["rejected_steps"]:
        notes.append(f"{counts['rejected_steps']} times no step of {settings.step:g} s was possible: it was divided, "
                    f"down to {counts['smallest_step_s']:.3g} s")
    rounded, motion = COORDINATE_ROUNDING * engine.extent, counts["largest_motion_m"]
    if settings.step is None and MIN_MOTION * engine.extent < motion < rounded / settings.tol:
        notes.append(f"positions are rounded to {rounded:.2g} m so far from the origin, which is more than tol = "
                    f"{settings.tol:g} allows: draw the scene nearer to it")
    if not engine.moves:
        return notes
    notes += _coarse_for_little_motion(engine, settings)
    error = counts["sum_of_local_error_estimates_m"] / counts["largest_motion_m"]
    if settings.step is not None and error > FIXED_STEP_ERROR_LIMIT:
        notes.append(f"the estimated errors of the steps sum up to {error:.2g} of the largest motion: take a smaller "
                    "step, or none, so that tol chooses it")
    return notes + unexplained(engine, settings)


def _coarse_for_little_motion(engine: Engine, settings: RunSettings) -> list[str]:
    """Return a note where the default absolute tolerance exceeds tol times the motion."""
    allowed, motion = engine.absolute_tol, engine.controlled_motion
    if settings.step is not None or settings.absolute_tol is not None or allowed <= settings.tol * motion:
        return []
    return [f"errors of {allowed:.2g} m were allowed for the size of the scene, beside a largest motion of "
            f"{motion:.2g} m: give absolute_tol, in m, if that is too much"]


def trapped(scene: SceneData, engine: Engine) -> list[str]:
    """Return a note where slides that tie a frame passed many nodes, at which the curvature jumps."""
    names = [f'"{slide.name}"' for slide in scene.slides.values()
             if slide.frame != "point" and (slide.along in scene.ropes or
                                          scene.cables[slide.along].element != CONTINUOUS_CURVATURE_ELEMENT)]
    if not names:
        return []
    counts = engine.statistics
    if counts["element_crossings"] < max(MANY_NODE_PASSAGES, NODE_PASSAGES_PER_STEP * counts["steps"]):
        return []
    return [f"slides passed nodes {counts['element_crossings']} times in {counts['steps']} steps: the curvature of "
            f"their cables or ropes jumps there and drives the frame of {' or '.join(names)} back to the node. Take "
            f'more elements, or on a cable element="{CONTINUOUS_CURVATURE_ELEMENT}", whose curvature is continuous']


def unexplained(engine: Engine, settings: RunSettings) -> list[str]:
    """Return a note where the energy balance of the scene does not close."""
    grown, lost, exchanged, in_motion, rounding = engine.balance
    off, fixed = max(grown, lost), settings.step is not None
    quiet = ENERGY_ERROR_LIMIT if fixed else min(max(ENERGY_ERROR_LIMIT, 100 * settings.tol), LOOSE_ENERGY_ERROR_LIMIT)
    if not off > quiet * max(exchanged, MIN_ENERGY_EXCHANGE * in_motion) + rounding:
        return []
    what = ("went that neither damping nor friction nor impacts took", "came that nothing did work for")[grown > lost]
    damps = INTEGRATORS[engine.integrator].loses_energy_by_spectral_radius and settings.spectral_radius != 1
    damped = ", or a spectral_radius nearer to 1" if lost > grown and damps else ""
    part = f"{off / exchanged:.2g} of the {exchanged:.3g} J exchanged" if exchanged > off else "all that was exchanged"
    return [f"the energy balance is off by up to {off:.3g} J, {part}: energy {what}. The integration makes this error: "
            f"take a smaller {'step, or none, so that tol chooses it' if fixed else 'tol'}{damped}"]
