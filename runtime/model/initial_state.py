"""Initial states of runs, given as arrays by the names of results."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from ..errors import SceneError, near
from ..parts.cable import Cable
from ..parts.modal_body import ModalBody
from ..parts.plane import called
from ..parts.rigid_body import RigidBody
from ..parts.scene_data import SceneData
from ..parts.validation import LENGTH_TOLERANCE, show, shown
from .bodies import configuration_of, velocity_of
from .model import BodyModel, CableModel, Model
from .rope_model import RopeModel
from .rope_rates import follow
from .unknowns import as_supports_leave

CABLE = ("nodal_vectors", "nodal_velocity")
POINTS = ("position", "velocity")
"""Positions and velocities of the nodes of a cable, an alternative to its nodal vectors and their rates."""
BODY = ("position", "orientation", "velocity", "angular_velocity")
MODAL = (*BODY, "modal_coordinates", "modal_velocities")
SLIDE = ("s",)
ROPE = ("coordinates", "coordinate_rates")
WORKING_CURVE = ("highest_strain",)
TIE_TOLERANCE = 1e-7
"""Error of ties in a state of `radau`, whose iteration stops there, as a fraction of the largest change."""


class InitialState(Mapping[str, np.ndarray]):
    """A state of cables, bodies, slides and ropes by the names of results, for ``scene.run(initial=...)``.

    ``state["wire.nodal_vectors"]`` (node, vector, 3), ``state["wire.nodal_velocity"]``, or of cables without directors
    ``state["wire.position"]`` and ``state["wire.velocity"]`` (node, 3): slopes are then those of the cubic spline
    through the nodes over the undeformed arc-length. Of bodies position, orientation, velocity, angular_velocity,
    modal_coordinates, modal_velocities; of slides s; of ropes coordinates and coordinate_rates; of working curves
    highest_strain. Units are those of the results. Other quantities are as drawn; rates of ropes that are not given
    follow from those of bodies.
    """

    def __init__(self, arrays: Mapping[str, Any], time: float | None = None, unstretched: Sequence[str] = (),
                 slipped: Sequence[str] = (), aside: Sequence[str] = ()):
        """Check and store the arrays. Raises SceneError for values that are no numbers.

        time: of the run that they are from, in s; unstretched: names of contacts, crossings and branches whose springs
        were stretched in that run; slipped: names of sheaves on which ropes without mass had slipped; aside: of those
        in whose grooves they lay beside the middle.
        """
        self.time, self._unstretched, self._slipped, self._aside = time, unstretched, slipped, aside
        self._arrays = {}
        for name, values in arrays.items():
            try:
                array = np.array(values, dtype=float)
            except (TypeError, ValueError):
                raise SceneError("initial", f'"{name}" must be an array of numbers, got {shown(values)}') from None
            if not np.isfinite(array).all():
                raise SceneError("initial", f'"{name}" must be finite')
            self._arrays[str(name)] = array

    def __getitem__(self, name: str) -> np.ndarray:
        """Return an array by its name."""
        return self._arrays[name]

    def __iter__(self) -> Iterator[str]:
        """Iterate over the names."""
        return iter(self._arrays)

    def __len__(self) -> int:
        """Return the number of arrays."""
        return len(self._arrays)

    def __repr__(self) -> str:
        """Return the names and the time of the state."""
        of = "" if self.time is None else f" of t = {self.time:g} s"
        return f"<funicular.InitialState{of}: {', '.join(self)}>"

    @property
    def messages(self) -> list[str]:
        """Return messages about the state for the report of a run."""
        found = []
        if self.time is not None:
            found = [f"starts from a state of another run, at its t = {self.time:.6g} s: signals begin anew at t = 0"]
        if self._unstretched:
            names = ", ".join(f'"{name}"' for name in self._unstretched)
            found.append(f"the springs of {names} begin unstretched, which were stretched in that run: errors "
                         "may be larger than tol. To continue that run, give it save and resume=True")
        return found

    def check_fits(self, scene: SceneData) -> None:
        """Raise SceneError for a name of nothing in the scene."""
        known = [*names_of(scene), *(f"{cable}.{quantity}" for cable in scene.cables for quantity in POINTS)]
        for name in self:
            if name not in known:
                raise SceneError("initial", f'"{name}" is no part of a state of this scene', near(name, known))

    def start(self, model: Model, scene: SceneData) -> None:
        """Set a freshly built model of the scene to this state. Raises SceneError."""
        if self._slipped:
            raise SceneError("initial", f'a rope without mass had slipped on sheave "{self._slipped[0]}" until then, '
                             "and a state does not tell how far", "continue that run by save and resume=True")
        if self._aside:
            raise SceneError("initial", f'a rope without mass lay on sheave "{self._aside[0]}" beside the middle of '
                             "its groove, and a state does not tell where", "continue that run by save and resume=True")
        if model.plane_axes is not None:
            InitialState({name: model.as_in_model(name, values) for name, values in self.items()},
                         self.time)._start(model, scene)
        else:
            self._start(model, scene)

    def _start(self, model: Model, scene: SceneData) -> None:
        """Set a model to this state, given along its axes. Raises SceneError."""
        drawn, moving = model.q.copy(), model.v.copy()
        for cable in model.cables:
            self._place_cable(model, cable, scene.cables[cable.name])
        for rope in model.ropes:
            self._place_rope(model, rope)
        for body in model.bodies:
            self._place_body(model, body, scene.bodies[body.name])
        for rope in model.ropes:
            if f"{rope.part.name}.{ROPE[1]}" not in self:
                follow(model, rope)
        _check_supports(model, model.q - drawn, "places", "m")
        _check_supports(model, model.v - moving, "moves", "m/s")
        for slide in model.slides:
            if (s := self.get(f"{slide.name}.s")) is not None:
                slide.place_at(float(_of_shape(s, (), f"{slide.name}.s")), model)
        for name in scene.working_curves:
            if (highest := self.get(f"{name}.{WORKING_CURVE[0]}")) is not None:
                curves = [curve for curve in model.working_curves if curve.name == name]
                points = sum(curve.highest.size for curve in curves)
                of_each = np.split(_of_shape(highest, (points,), f"{name}.{WORKING_CURVE[0]}"), len(curves))
                for curve, values in zip(curves, of_each, strict=True):
                    curve.highest = values

    def _place_cable(self, model: Model, cable: CableModel, drawn: Cable) -> None:
        for whole, points, into in zip(CABLE, POINTS, (model.q, model.v), strict=True):
            name = f"{cable.name}.{whole}"
            if name in self:
                vectors = _of_shape(self[name], (*cable.shape[:2], 3), name)
            elif f"{cable.name}.{points}" in self:
                name = f"{cable.name}.{points}"
                vectors = _along_spline(_of_shape(self[name], (cable.shape[0], 3), name), cable, drawn, name)
            else:
                continue
            _check_plane(vectors, model, name)
            into[cable.coordinates] = vectors[..., : cable.shape[2]].ravel()

    def _place_rope(self, model: Model, rope: RopeModel) -> None:
        for quantity, into, unit in zip(ROPE, (model.q, model.v), ("m", "m/s"), strict=True):
            name = f"{rope.part.name}.{quantity}"
            if name not in self:
                continue
            values, at = _of_shape(self[name], rope.q.shape, name), rope.coordinates
            fixed = rope.fixed.copy()
            if rope.supply >= 0 and quantity == ROPE[0]:
                fixed[rope.supply - rope.first] = False  # no length is given
            held = rope.held - rope.first  # a prescribed rotation follows its signal
            off = np.abs(values - into[at])[held[fixed[held]]]
            if np.any(off > LENGTH_TOLERANCE * rope.route.length):
                raise SceneError("initial", f'"{name}" has an end of the rope, or the arc-length there, '
                                 f"{show(float(off.max()), unit)} off the value as drawn, which an anchor keeps",
                                 "give a state that fits, or draw the anchors elsewhere")
            into[at] = np.where(fixed, into[at], values)

    def _place_body(self, model: Model, body: BodyModel, drawn: RigidBody | ModalBody) -> None:
        given = {name: self[f"{body.name}.{name}"] for name in BODY if f"{body.name}.{name}" in self}
        modes = {name: _of_shape(self[f"{body.name}.{name}"], (body.modes,), f"{body.name}.{name}")
                 for name in MODAL[len(BODY):] if f"{body.name}.{name}" in self}
        if not given and not modes:
            return
        q, v = _frame(body, drawn, given, model)
        if body.modes:
            q[-body.modes:] = modes.get("modal_coordinates", q[-body.modes:])
            v[-body.modes:] = modes.get("modal_velocities", v[-body.modes:])
        model.q[body.configuration : body.configuration + len(q)] = q
        model.v[body.dof : body.dof + len(v)] = v


def names_of(scene: SceneData) -> Iterator[str]:
    """Yield the names of all arrays of the states of a scene."""
    yield from (f"{cable}.{quantity}" for cable in scene.cables for quantity in CABLE)
    for name, body in scene.bodies.items():
        yield from (f"{name}.{quantity}" for quantity in (MODAL if isinstance(body, ModalBody) else BODY))
    yield from (f"{slide}.{quantity}" for slide in scene.slides for quantity in SLIDE)
    yield from (f"{rope}.{quantity}" for rope in scene.ropes for quantity in ROPE)
    yield from (f"{curve}.{quantity}" for curve in scene.working_curves for quantity in WORKING_CURVE)


def _frame(body: BodyModel, drawn: RigidBody | ModalBody, given: dict[str, np.ndarray],
           model: Model) -> tuple[np.ndarray, np.ndarray]:
    """Return configuration and velocities of a body that does not start as drawn."""
    position, orientation = drawn.frame
    at = {"position": position, "orientation": orientation, "velocity": np.array(drawn.velocity),
          "angular_velocity": np.array(drawn.angular_velocity)}
    given = {name: _of_shape(values, at[name].shape, f"{body.name}.{name}") for name, values in given.items()}
    moved = RigidBody(name=body.name, mass=body.mass, inertia=np.eye(3).tolist(), centre=body.centre.tolist(),
                      **{name: values.tolist() for name, values in (at | given).items()})
    if model.dim == 2:
        for what in moved.off_plane():
            own = ", in whose axes it is" * (model.plane_axes is not None)
            raise SceneError("initial", f"{body.name}: {what}, but the scene lies in {_plane(model)}{own}")
    modes = np.zeros(body.modes)
    return (np.concatenate([configuration_of(moved, model.dim), modes]),
            np.concatenate([velocity_of(moved, model.dim), modes]))


def _along_spline(points: np.ndarray, cable: CableModel, drawn: Cable, name: str) -> np.ndarray:
    """Return (node, vector, 3): points of nodes, and derivatives of the spline through them by arc-length."""
    orders = {"r": 0, "r_x": 1, "r_xx": 2}
    if not set(cable.vectors) <= set(orders):
        raise SceneError("initial", f'"{name}" does not determine the rotations of the sections of {drawn.where}',
                         f'give "{cable.name}.nodal_vectors" or "{cable.name}.nodal_velocity"')
    from scipy.interpolate import CubicSpline  # slow to import, and most runs do without

    s = cable.mesh.node_s
    ends = "not-a-knot" if len(s) > 2 else "natural"
    spline = CubicSpline(s, points, bc_type=ends)
    return np.stack([spline(s, orders[vector]) for vector in cable.vectors], axis=1)


def _of_shape(values: np.ndarray, shape: tuple[int, ...], name: str) -> np.ndarray:
    """Return the values. Raises SceneError where they have another shape."""
    if values.shape != shape:
        raise SceneError("initial", f'"{name}" must have the shape {shape}, got {values.shape}')
    return values


def _check_plane(vectors: np.ndarray, model: Model, name: str) -> None:
    if model.dim == 2 and np.any(vectors[..., 2]):
        raise SceneError("initial", f'"{name}" leaves {_plane(model)}, in which the scene lies')


def _plane(model: Model) -> str:
    """Return the name of the plane of a planar model in messages."""
    return called(None if model.plane_axes is None else model.plane_axes.plane)


def _check_supports(model: Model, change: np.ndarray, does: str, unit: str) -> None:
    """Raise SceneError where a state violates pins, clamps, motions or ties; change (n_dof,): from the state as drawn.

    Every dof of a cable is linear in the unknowns: fixed dofs must not change, tied ones must follow their unknowns.
    """
    if not model.cables:
        return
    cables = slice(0, model.cables[-1].coordinates.stop)
    change = change[cables]
    expected = as_supports_leave(change, model.unknown_of_dof[cables], model.combinations)
    wrong, largest = (np.abs(each) * model.weight[cables] for each in (change - expected, change))
    longest = max(cable.mesh.total for cable in model.cables)
    if np.any(wrong > max(LENGTH_TOLERANCE * longest, TIE_TOLERANCE * largest.max())):
        dof = int(np.argmax(wrong))
        where, k = next((node.where, k) for nodes in model.nodes.values() for k, node in enumerate(nodes)
                        if node.first <= dof < node.first + node.vectors.size)
        raise SceneError("initial", f"the state {does} node {k} of {where} by {show(float(wrong[dof]), unit)} "
                         "where a support or tie keeps it", "give a state that fits, or draw the supports elsewhere")
