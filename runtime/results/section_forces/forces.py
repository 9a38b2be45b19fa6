"""Section forces: the force and moment across a cut of a cable, by balance with all loads or by the elastic law."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.quadrature import gauss
from ...errors import FunicularError, FunicularWarning, UnknownResultError, near
from ...integrators import INTEGRATORS
from ...kernels.libraries import kernels_of
from ...model.constants import grown_shape
from ...model.model import Model, per_grown
from ...parts.cable import Cable
from ...parts.cubic_segments import value as value_of
from ...parts.event import first_times
from ...parts.in_plane import in_plane
from ...parts.locations import attached
from ...parts.scene_data import SceneData
from ...parts.section_stiffness import section_stiffness
from ...parts.slide import Slide
from ...parts.validation import LENGTH_TOLERANCE, show
from ...solve.statics.rest_state import RestState
from ..recorded import Recorded
from .about_start import about
from .balance import Cuts, balanced
from .balance_limits import balanced_cables, is_cut, out_of_balance
from .cable_loads import CableLoads, Instants
from .components import balanced_components, components, labels, taut_bending
from .kinks import kinks
from .nodal_forces import element_forces
from .swings import swinging

if TYPE_CHECKING:
    import xarray
    from numpy.typing import ArrayLike  # 9 ms, for type checkers alone

DEFAULT_DIVISIONS = 8
"""Sections per element by default."""
SIDE_DISTANCE = 4 * LENGTH_TOLERANCE
"""Distance of the two sides of a jump from it, over the length of the cable."""
MAX_BLOCK = 100_000
"""Cuts or elements, over all times, that are computed together."""
METHODS = ("balance", "constitutive")
SIDES = ("after", "before")

GLOBAL = {
    "force": ("N", "force on the part before the cut"),
    "moment": ("N m", "moment on the part before the cut"),
}


def constitutive(cable: Cable, nodal_vectors: np.ndarray, cuts: Cuts, time: np.ndarray,
                 start: np.ndarray | None = None) -> tuple[np.ndarray, ...]:
    """Return force and moment (T, n, 3) by the elastic law, section axes (T, n, 3, 3), and strains (T, n, 6) at cuts.

    nodal_vectors: (T, nodes, vectors, 3); time: (T,), s; start: (1, nodes, vectors, 3) of a run by the linear model
    about it. Force and moment are along the ground's axes.
    """
    kernel = getattr(kernels_of(cable.library), f"{cable.element}_{cable.kernel_law}_section_forces")
    dim, reference, plane = cable.dim, cable.reference, cable.plane
    nodal_vectors = cable.in_plane(nodal_vectors)
    sections = np.array([section_stiffness(cable.stiffness_law, piece.section, piece.material, dim)
                         for piece in cable.uniform_pieces])
    shape = len(nodal_vectors), cuts.s.shape[1]
    element, x = np.broadcast_to(cuts.element, shape), np.broadcast_to(cuts.x, shape)
    instants = np.arange(shape[0])[:, None]
    node = cable.mesh.first_node(element)
    e = np.concatenate([nodal_vectors[instants, node], nodal_vectors[instants, node + 1]], axis=2)
    e = e.reshape(-1, *e.shape[2:])
    if start is not None:
        start = cable.in_plane(start)[0]
        start = np.concatenate([start[node], start[node + 1]], axis=2).reshape(e.shape)
    e0 = [] if reference is None else [reference[element].reshape(-1, *reference.shape[1:])]
    S = sections[0] if len(sections) == 1 else sections[cable.of_elements(cable.uniform_pieces.index)[element.ravel()]]
    lengths, places = cable.mesh.mean if cable.mesh.is_even else cable.mesh.lengths[element].ravel(), x.ravel()
    if cable.driven():
        g = cable.growth_at(time)[instants, element].ravel()
        lengths, places = g * lengths, g * places
        e0 = [grown_shape(cable, each, g) for each in e0]
        factors = per_grown(cable.kind_of_element.nodal_vectors, g)
        e, start = factors * e, None if start is None else factors * start
    force, moment, axes, strain = (
        values.reshape(*shape, *values.shape[1:])
        for values in about(lambda e: kernel.rows(x.size, lengths, places, e, S, *e0), start, e))
    return (force, moment, axes, strain) if plane is None else (plane.out(force), plane.out(moment), plane.out(axes),
                                                                strain)


def cut_forces(scene: SceneData, model: Model, at: Instants, name: str, s: np.ndarray, *, method: str = "balance",
               side: str = "after") -> dict[str, np.ndarray]:
    """Return the forces in sections of the cable ``name`` at instants.

    s: (1 or T, n) arc-lengths in m. Returns force and moment (T, n, 3), along the axes of the model, and the components
    (T, n) of `components.labels`. Raises SceneError, see `out_of_balance`.
    """
    cable, number = scene.cables[name], list(scene.cables).index(name)
    of = model.cables[number]
    cuts = Cuts(of, s, side == "after")
    nodal = at.value(f"{name}.nodal_vectors")
    start = None if at.start is None else at.start(f"{name}.nodal_vectors")
    force, moment, axes, strain = constitutive(cable, nodal, cuts, at.time, start)
    if scene.branches:
        more, bending = _of_branches(scene, at, cable, cuts, axes[..., 0, :], strain[..., 0])
        force, moment = force + more, moment + bending
    if scene.working_curves:
        force = force + _of_working_curves(scene, at, cable, cuts, strain[..., 0])[..., None] * axes[..., 0, :]
    if method == "constitutive":
        return {"force": force, "moment": moment} | components(cable, force, moment, axes, strain)
    if (refusal := out_of_balance(scene, model, number, at.is_rest)) is not None:
        raise refusal
    concerned = balanced_cables(scene, model, number, at.is_rest)
    if len(at.time) > 1 and is_cut(model, concerned):
        each = [cut_forces(scene, model, at.one(k), name, s if len(s) == 1 else s[k : k + 1], side=side)
                for k in range(len(at.time))]  # wet parts change with time
        return {key: np.concatenate([found[key] for found in each]) for key in each[0]}
    loads = CableLoads(scene, model, at, concerned)
    forces = element_forces(model, at, loads, number)
    balance_force, balance_moment, change = balanced(cable, of, forces, loads, number, cuts)
    growth = forces.growth[np.arange(len(at.time))[:, None], cuts.element]
    taut = moment if cable.is_curved else taut_bending(  # a curved wire pulled straight has a moment
        cable, balance_force, change, axes, cuts, growth, lambda: kinks(scene, cable, of, forces, loads, number))
    return balanced_components(cable, (balance_force, balance_moment), (force, moment), taut, axes, strain, cuts,
                               growth)


def _of_branches(scene: SceneData, at: Instants, cable: Cable, cuts: Cuts, tangent: np.ndarray,
                 strain: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return force and moment (T, n, 3) of the branches beside the law of a cable, linear over each element; moments
    that change along it have a shear force. tangent: (T, n, 3); strain: (T, n), of the axis.
    """
    force, moment = np.zeros_like(tangent), np.zeros_like(tangent)
    length = cable.mesh.each_length(cuts.element)
    place: np.ndarray = 2 * cuts.x / length - 1
    instants = np.arange(len(at.time))[:, None]
    for branch in (each for each in scene.branches.values() if each.cable == cable.name):
        result = at.value(branch.stress)
        result = result.reshape(len(at.time), cable.n_elements, 2, 3 if branch.bends else 1)
        ends = result[instants, cuts.element]
        first, second = ends[:, :, 0], ends[:, :, 1]
        value = first + (second - first) * ((1 + np.sqrt(3) * place) / 2)[..., None]  # through the points of Gauss
        if branch.bends:
            slope = (second - first) * (np.sqrt(3) / np.multiply(length, 1 + strain))[..., None]
            moment, force = moment + value, force + np.cross(tangent, slope)
        else:
            force = force + value * tangent
    return force, moment


def _of_working_curves(scene: SceneData, at: Instants, cable: Cable, cuts: Cuts, strain: np.ndarray) -> np.ndarray:
    """Return the change (T, n) of the axial force by working curves, N; strain (T, n): of the axis.

    The highest strain is linear between the points of an element, and constant beyond them.
    """
    change = np.zeros_like(strain)
    x: np.ndarray = cuts.x / cable.mesh.each_length(cuts.element)
    x, element = np.broadcast_to(x, strain.shape), np.broadcast_to(cuts.element, strain.shape)
    instants = np.arange(len(at.time))[:, None]
    for curve in (each for each in scene.working_curves.values() if each.cable == cable.name):
        highest = at.value(f"{curve.name}.highest_strain").reshape(len(at.time), cable.n_elements, -1)
        places = (1 + gauss(highest.shape[2])[0]) / 2
        k = np.clip(np.searchsorted(places, x) - 1, 0, len(places) - 2)
        share = np.clip((x - places[k]) / (places[k + 1] - places[k]), 0, 1)
        top = (1 - share) * highest[instants, element, k] + share * highest[instants, element, k + 1]
        for piece in cable.uniform_pieces:
            assert piece.section.tension_table is not None  # as the law has one
            first, of = piece.section.tension_table.numbers(), (piece.first <= element) & (element < piece.end)
            change[of] = curve.force_at(first, strain[of], top[of]) - value_of(first, strain[of])
    return change


def along_ground(model: Model, name: str, found: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Return section forces with force and moment along the ground's axes; components stay."""
    return found | model.results(name, {each: found[each] for each in GLOBAL})


def of_run(run: Recorded, name: str, s: np.ndarray, chosen: Any = slice(None), *, method: str = "balance",
           side: str = "after") -> dict[str, np.ndarray]:
    """Return `cut_forces` of a run at the chosen times; s: (1 or T, n)."""
    scene, model = in_plane(run.scene), run.model
    time = run.time[chosen]
    numbers = np.arange(len(run.time))[chosen]
    found: list[dict[str, np.ndarray]] = []
    block = max(1, MAX_BLOCK // max(1, s.shape[1], sum(cable.elements for cable in run.scene.cables.values())))
    for first in range(0, len(time), block):
        part = numbers[first : first + block]
        found.append(cut_forces(scene, model, _instants(run, part), name,
                                s if len(s) == 1 else s[first : first + block], method=method, side=side))
    return along_ground(model, name, {key: np.concatenate([each[key] for each in found]) for key in found[0]})


def _instants(run: Recorded, numbers: np.ndarray) -> Instants:
    model, kept = run.model, {}
    chosen = slice(numbers[0], numbers[-1] + 1) if numbers[-1] - numbers[0] + 1 == len(numbers) else numbers

    def value(name: str) -> np.ndarray:
        if name not in kept:
            kept[name] = model.as_in_model(name, run[name][chosen])
        return kept[name]

    q, v = np.zeros((len(numbers), model.n_q)), np.zeros((len(numbers), model.n_dof))
    for cable in model.cables:
        for into, kind in ((q, "nodal_vectors"), (v, "nodal_velocity")):
            into[:, cable.coordinates] = value(f"{cable.name}.{kind}")[..., : model.dim].reshape(len(numbers), -1)
    for derivative, into in enumerate((q, v)):
        into[:, model.driven] = model.driven_in(run.time[chosen], derivative)
    start = partial(at_start, run) if of_linear_model(run) else None
    return Instants(run.time[chosen], q, v, value, start=start, happened=first_times(run.report.get("events", ())))


def of_linear_model(run: Recorded) -> bool:
    """Return whether the cables of a run have the forces of the linear model about its start."""
    method = INTEGRATORS.get(run.report.get("integrator", ""))
    return method is not None and method.is_linear


def at_start(run: Recorded, name: str) -> np.ndarray:
    """Return the first row (1, ...) of a result, along the axes of the model."""
    return run.model.as_in_model(name, run[name][:1])


def of_equilibrium(state: RestState, name: str, s: np.ndarray, *, method: str = "balance",
                   side: str = "after") -> dict[str, np.ndarray]:
    """Return `cut_forces` of a state of rest: T = 1; s: (1, n)."""
    return along_ground(state.model, name, cut_forces(in_plane(state.scene), state.model, rest_instants(state), name, s,
                                                      method=method, side=side))


def rest_instants(state: RestState) -> Instants:
    """Return a state of rest as one instant, with its parts of the loads."""
    return Instants(np.zeros(1), state.static_state["q"][None], np.zeros((1, state.model.n_dof)),
                    lambda quantity: state.model.as_in_model(quantity, state[quantity][None]), state.load_fraction,
                    state.gravity_fraction, is_rest=True)


def jumps(scene: SceneData, name: str) -> np.ndarray:
    """Return the arc-lengths of attachments fixed to a cable, between its ends, in order."""
    cable = scene.cables[name]
    beside = SIDE_DISTANCE * cable.length
    return np.array(sorted({s for s in attached(scene, name) if beside < s < cable.length - beside}))


def with_sides(cable: Cable, s: np.ndarray, places: np.ndarray) -> np.ndarray:
    """Return s (n,), sorted, with a point on either side of each of the places (..., m): (..., n + 2 m)."""
    beside = SIDE_DISTANCE * cable.length
    sides = np.clip(np.concatenate([places - beside, places + beside], axis=-1), 0.0, cable.length)
    return np.sort(np.concatenate([np.broadcast_to(s, (*sides.shape[:-1], len(s))), sides], axis=-1), axis=-1)


def no_cable(scene: SceneData, name: Any) -> UnknownResultError:
    """Return the error of a name that is not a cable's."""
    rope = scene.ropes.get(getattr(name, "name", name))
    if rope is not None:
        return UnknownResultError(f"{rope.where} is no cable: its tension is a result of its sheaves, "
                                  f'"{rope.sheaves[0].name}.tension_on" and the like')
    return UnknownResultError(f'there is no cable "{name}"; {near(name, scene.cables)}')


def check_words(name: str, method: str, side: str) -> None:
    """Raise FunicularError for unknown words of section forces."""
    for word, value, known in (("method", method, METHODS), ("side", side, SIDES)):
        if value not in known:
            raise FunicularError(f'section forces of "{name}": {word} must be '
                                 + " or ".join(f'"{each}"' for each in known) + f", got {value!r}")


def dataset(state: Recorded | RestState, cable: Cable | str, s: ArrayLike | Slide | None = None, *,
            method: str = "balance", side: str = "after") -> xarray.Dataset:
    """See `Run.section_forces`; of an equilibrium without the time."""
    import xarray  # 0.5 s, for those who ask for it

    scene, name = state.scene, cable.name if isinstance(cable, Cable) else cable
    if name not in scene.cables:
        raise no_cable(scene, name)
    check_words(name, method, side)
    drawn, over_time = scene.cables[name], not isinstance(state, RestState)
    s, follows = _places(state, drawn, s, over_time)
    compute: Callable[..., dict[str, np.ndarray]] = of_run if over_time else of_equilibrium
    values = compute(state, name, s, method=method, side=side)
    if method == "constitutive" and (swing := swinging(drawn, s, lambda at: compute(
            state, name, at, method=method)["tension"])):
        warnings.warn(swing, FunicularWarning, stacklevel=3)
    label = GLOBAL | labels(drawn)
    coords: dict[str, Any] = {"xyz": ["x", "y", "z"]}
    of_s = {"units": "m", "long_name": "undeformed arc-length"}
    if not isinstance(state, RestState):
        coords["time"] = ("time", state.time, {"units": "s", "long_name": "time"})
    if follows:
        coords["s"] = ("time", s[:, 0], of_s) if over_time else ((), s[0, 0], of_s)
    else:
        coords["s"] = ("s", s[0], of_s)
    dims = ("time",) * over_time + ("s",) * (not follows) + ("xyz",)
    index = (slice(None) if over_time else 0, 0 if follows else slice(None))
    return xarray.Dataset(
        {key: (dims[: value[index].ndim], value[index], {"units": label[key][0], "long_name": label[key][1]})
         for key, value in values.items()},
        coords, {"cable": name, "element": drawn.element, "law": drawn.law, "method": method, "side": side})


def _places(state: Recorded | RestState, cable: Cable, s: Any, over_time: bool) -> tuple[np.ndarray, bool]:
    """Return arc-lengths (1 or T, n) for the argument s, and whether they follow a slide."""
    scene, name = state.scene, cable.name
    if s is None:
        places = jumps(scene, name)
        if not over_time:
            riders = [state[f"{slide.name}.s"] for slide in scene.slides.values() if slide.along == name]
            riders += [state[f"{crossing.name}.{s_of}"] for crossing in scene.crossings.values()
                       for of, s_of in ((crossing.a, "s"), (crossing.b, "s_b")) if of == name]
            places = np.append(places, riders)
        return np.unique(with_sides(cable, cable.divided(DEFAULT_DIVISIONS), places))[None], False
    slide = scene.slides.get(getattr(s, "name", s)) if isinstance(getattr(s, "name", s), str) else None
    if slide is not None:
        if slide.along != name:
            raise FunicularError(f'section forces of "{name}": slide "{slide.name}" is on cable "{slide.along}"')
        return np.clip(np.atleast_1d(state[f"{slide.name}.s"])[:, None], 0.0, cable.length), True
    try:
        s = np.atleast_1d(np.asarray(s, dtype=float))
    except (TypeError, ValueError):
        raise FunicularError(f'section forces of "{name}": s must be arc-lengths in m, or a slide on it, '
                             f"got {s!r}") from None
    off = (s < -LENGTH_TOLERANCE * cable.length) | (s > (1 + LENGTH_TOLERANCE) * cable.length) | ~np.isfinite(s)
    if s.ndim != 1 or off.any():
        wrong = show(float(s[off][0]), "m") if s.ndim == 1 else f"an array of shape {s.shape}"
        raise FunicularError(f'section forces of "{name}": s must lie on the cable, in [0, {cable.length:.9g}] m, '
                             f"got {wrong}")
    return s[None], False
