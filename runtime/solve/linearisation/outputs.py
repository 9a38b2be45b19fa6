"""Outputs of a linear model: results of parts and their derivatives in directions of motion about a state of rest.

Derivatives are those of the functions that make the results of a run: central differences, by positions, forces and
accelerations with steps h and h/2, of the fourth order, and by velocities with a step so small that laws with a square
of the speed have no part.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...engine import OUTPUTS
from ...errors import UnknownResultError, near
from ...model.kinds import COUPLINGS
from ...model.part_states import States, part_states
from ...model.rope_states import moved
from ...parts.kinds import KINDS
from ...parts.paths import COMPONENTS, label_of
from ...parts.scene_data import SceneData
from ..statics.rest_state import RestState
from ..statics.static_problem import StaticState
from .inputs import Input, eliminated
from .names import Coordinate

STEP, RATE_STEP = 1e-3, 1e-7
"""Largest change of a coordinate, m or rad, and of a rate, m/s or rad/s, of differences."""
SMALL_STEP = 1e-7
"""The same of positions for laws that are smooth at small distances alone, such as contact by penalty."""
SMOOTH = {"bodies", "cables", "joints", "slides"}
"""Groups whose results are smooth functions of positions, forces and accelerations."""
SUPPORTS = {"pins", "clamps", "motions", "ties", "ropes"}
"""Groups whose results are reactions."""


@dataclass(frozen=True, eq=False)
class Directions:
    """k directions: changes of unknowns and, of what is prescribed, of dofs, of velocities and of accelerations.

    unknowns (unknowns, k); dofs, prescribed, moved_dofs, all, rates, accelerations (n_dof, k); coordinates: x, x', x''
    (3, coordinates, k).
    """

    unknowns: np.ndarray
    dofs: np.ndarray
    moved_dofs: np.ndarray
    rates: np.ndarray
    accelerations: np.ndarray
    coordinates: np.ndarray

    @property
    def count(self) -> int:
        """Return the number of directions."""
        return int(self.unknowns.shape[1])


@dataclass(frozen=True)
class Output:
    """An output: its name, label and quantity, and the entry of the quantity; unit; order and coordinate of a rate."""

    name: str
    label: str
    quantity: str
    entry: tuple[int, ...]
    unit: str
    coordinate: Coordinate | None = None
    order: int = 0


class Outputs:
    """The outputs of a state of rest by name."""

    def __init__(self, static: StaticState, scene: SceneData, coordinates: Sequence[Coordinate]):
        """scene: of the static state; coordinates: of parts, which are outputs, too."""
        self.static, self.scene = static, scene
        self.model, self.engine = static.model, static.engine
        self.kept = static.keep()
        self.coordinates = {each.name: (each, 0) for each in coordinates}
        self.coordinates |= {each.rate: (each, 1) for each in coordinates}
        for each in coordinates:
            if each.name.endswith(".s"):
                self.coordinates[f"{each.name}_acceleration"] = each, 2
        numbers = self._numbers((list(OUTPUTS), True))
        at_rest = self._states([(self.kept["q"], self.kept["s"])], None, [numbers])
        self.base = part_states(self.model, scene, at_rest).by_label()
        for cable in self.model.cables:
            self.base[cable.name]["position"] = self._points(cable.name, self.base)
        self.of_motion = {*scene.cables, *scene.bodies}

    def _points(self, cable: str, values: dict[str, dict[str, np.ndarray]]) -> np.ndarray:
        """Return positions of the nodes of a cable."""
        model = next(each for each in self.model.cables if each.name == cable)
        return values[cable]["nodal_vectors"][:, :, model.vectors.index("r")]

    def find(self, names: Sequence[str]) -> list[Output]:
        """Return the outputs of these names; a vector is its components. Raises UnknownResultError."""
        return [output for name in names for output in self._find(name)]

    def _find(self, name: str) -> list[Output]:
        if name in self.coordinates:
            of, order = self.coordinates[name]
            return [Output(name, "", "", (), of.unit + ("", "/s", "/s²")[order], of, order)]
        label = max((each for each in self.base if name.startswith(f"{each}.")), key=len, default="")
        quantity, *entries = name[len(label) + 1:].split(".") if label else [""]
        if not label or quantity not in self.base[label]:
            known = [f"{each}.{key}" for each, of in self.base.items() for key in of] + list(self.coordinates)
            raise UnknownResultError(f'linearise: no output "{name}"; {near(name, known)}')
        values = self.base[label][quantity][0]
        entry = tuple(COMPONENTS[each] if each in COMPONENTS else int(each) if each.isdecimal() else -1
                      for each in entries)
        if len(entry) > values.ndim or any(not 0 <= k < n for k, n in zip(entry, values.shape, strict=False)):
            raise UnknownResultError(f'linearise: "{label}.{quantity}" has entries {values.shape}, without '
                                     f'"{".".join(entries)}"; name x, y, z or a number below the size')
        unit = self._unit(label, quantity)
        rest = values.shape[len(entry):]
        if not rest:
            return [Output(name, label, quantity, entry, unit)]
        if rest == (3,):
            return [Output(f"{name}.{axis}", label, quantity, (*entry, k), unit) for axis, k in COMPONENTS.items()]
        size = " x ".join(str(n) for n in rest)
        raise UnknownResultError(f'linearise: output "{name}" has {size} numbers, which depend on the mesh or on the '
                                 f'part; name one, such as "{name}.{".".join(["0"] * len(rest))}"')

    def _unit(self, label: str, quantity: str) -> str:
        """Return the unit of a result."""
        if quantity == "position":
            return "m"
        parts = [each for part in self.scene.parts() for each in (part, *getattr(part, "wheels", ()))]
        own = [each for each in parts if label in (each.given_name, getattr(each, "label", None))]
        found = next((each.results[quantity].units for each in own if quantity in getattr(each, "results", {})), None)
        if found is None:
            found = next((each.results[quantity].units for kind in KINDS for each in (kind, *kind.parts_within)
                          if quantity in each.results), "")
        return found

    def values(self, outputs: Sequence[Output], about: RestState | None) -> np.ndarray:
        """Return the outputs (n,) at rest, of a state or as drawn; coordinates of joints are zero there."""
        return np.array([self._value(output, about) for output in outputs])

    def _value(self, output: Output, about: RestState | None) -> float:
        if output.coordinate is None:
            name = f"{output.label}.{output.quantity}"
            if about is not None and name in about.quantities:
                return float(about.quantities[name][output.entry])
            return float(self.base[output.label][output.quantity][(0, *output.entry)])
        label, _, quantity = output.name.rpartition(".")
        return float(self.base[label][quantity][0]) if quantity == "s" else 0.0

    def derivatives(self, outputs: Sequence[Output], along: Directions) -> np.ndarray:
        """Return (outputs, k): derivatives of outputs in k directions."""
        found = np.zeros((len(outputs), along.count))
        for row, output in enumerate(outputs):
            if output.coordinate is not None:
                found[row] = output.coordinate.row @ along.coordinates[output.order]
        labels = {output.label for output in outputs if output.coordinate is None}
        if not labels or not along.count:
            return found
        kinked = self._labels_of_kinked_laws(labels)
        moved = {label: of for each, step in ((labels - kinked, STEP), (kinked, SMALL_STEP)) if each
                 for label, of in self._by_motion(each, along, step).items()}
        speeds = self._by_rates(labels, along)
        for row, output in enumerate(outputs):
            if output.coordinate is None:
                for part in (moved, speeds):
                    if output.quantity in part.get(output.label, {}):
                        values = part[output.label][output.quantity]
                        found[row] += values.reshape(along.count, -1)[:, _flat(values, output.entry)]
        return found

    def _labels_of_kinked_laws(self, labels: set[str]) -> set[str]:
        """Return the labels whose results come from laws that change at small distances, as where contact ends."""
        scene = self.scene
        segments = any(getattr(force, "has_segments", False) for force in scene.point_forces.values())
        has_kinks = segments or bool(scene.contacts or scene.crossings or scene.ropes)
        smooth = SMOOTH if has_kinks else SMOOTH | SUPPORTS
        return labels - {label_of(part) for part in scene.parts() if part.group in smooth}

    def direct(self, outputs: Sequence[Output], inputs: Sequence[Input]) -> np.ndarray:
        """Return (outputs, inputs): derivatives of outputs by inputs with state and forces as they are."""
        found = np.zeros((len(outputs), len(inputs)))
        asked = [row for row, output in enumerate(outputs) if output.coordinate is None
                 and output.label not in self.of_motion]
        if not asked:
            return found
        for column, each in enumerate(inputs):
            steps = [[(above - below) / (2 * side.step) for above, below in zip(
                *(self._outputs_of(state, [outputs[row] for row in asked]) for state in (side.above, side.below)),
                strict=True)] for side in each.sides]
            if steps:
                found[asked, column] = eliminated([np.array(step) for step in steps])
        return found

    def _outputs_of(self, static: StaticState, outputs: Sequence[Output]) -> list[float]:
        """Return outputs at rest in a state with an input changed; reactions are part of the forces of the motion."""
        engine, kept = static.engine, static.keep()
        numbers = {kind: engine.static_outputs(kind)[None] for kind in OUTPUTS}
        at = States.at_rest(kept["q"][None], kept["s"][None], engine.forces_in_motion()[None], numbers)
        values = {label: part_states(static.model, static.scene, at, alone=label).by_label()[label]
                  for label in {output.label for output in outputs}}
        return [float(values[output.label][output.quantity][(0, *output.entry)]) for output in outputs]

    def _by_motion(self, labels: set[str], along: Directions, step: float) -> dict[str, dict[str, np.ndarray]]:
        """Return the derivatives by positions, forces and accelerations; step: the largest change of a coordinate.

        Results are linear in forces and accelerations: directions without a change of position take two states of four.
        """
        size = np.abs(self._spread(along)).max(axis=0, initial=0.0)
        steps, needs = step / np.maximum(size, step), self._needs(labels)
        parts = [self._differences(labels, needs, along, np.flatnonzero(size > 0), steps, (1.0, -1.0, 0.5, -0.5))]
        others = (size == 0) & (along.unknowns.any(axis=0) | along.accelerations.any(axis=0))
        parts.append(self._differences(labels, needs, along, np.flatnonzero(others), steps, (1.0, -1.0)))
        found: dict[str, dict[str, np.ndarray]] = {}
        for columns, of_labels in parts:
            for label, of in of_labels.items():
                for name, values in of.items():
                    whole = found.setdefault(label, {}).setdefault(name, np.zeros((along.count, *values.shape[1:])))
                    whole[columns] = values
        return found

    def _differences(self, labels: set[str], needs: tuple[list[str], bool], along: Directions, columns: np.ndarray,
                     steps: np.ndarray, sides: Sequence[float]) -> tuple[np.ndarray, dict[str, dict[str, np.ndarray]]]:
        """Return some columns and the derivatives in their directions, of states at these shares of the steps."""
        if not len(columns):
            return columns, {}
        still, places, numbers = np.zeros(self.model.n_dof), [], []
        over = np.concatenate([side * steps[columns] for side in sides])
        number = np.tile(columns, len(sides))
        dofs = over[:, None] * along.moved_dofs[:, number].T
        accelerations = over[:, None] * along.accelerations[:, number].T
        q = moved(self.model, self.kept["q"], dofs)
        if any(needs):
            for k, (column, h) in enumerate(zip(number, over, strict=True)):
                self._go(h * along.unknowns[:, column], h * along.dofs[:, column])
                self.engine.set_rates(still, accelerations[k])
                places.append(self.engine.state()["s"])
                numbers.append(self._numbers(needs))
            self.static.restore(self.kept, prescribe=False)
        else:
            places = [self.kept["s"]] * len(over)
        rates = [(still, each) for each in accelerations]
        at = self._results(labels, self._states(list(zip(q, places, strict=True)), rates, numbers))
        return columns, {label: {name: _derivative(values, len(columns), steps[columns]) for name, values in of.items()}
                         for label, of in at.items()}

    def _by_rates(self, labels: set[str], along: Directions) -> dict[str, dict[str, np.ndarray]]:
        """Return the derivatives by velocities."""
        needs, still = self._needs(labels), np.zeros(self.model.n_dof)
        steps = np.ones(along.count)
        if labels <= self.of_motion or not self._depends_on_rates(needs, along):
            needs = [], False
        else:
            steps = RATE_STEP / np.maximum(np.abs(along.rates).max(axis=0, initial=0.0), 1.0)
        rows, rates = [], []
        numbers: list[tuple[dict[str, np.ndarray], np.ndarray]] = []
        for column, h in zip(np.tile(np.arange(along.count), 2), np.concatenate([steps, -steps]), strict=True):
            rows.append((self.kept["q"], self.kept["s"]))
            rates.append((h * along.rates[:, column], still))
            if any(needs):
                self.engine.set_rates(*rates[-1])
                numbers.append(self._numbers(needs))
        self.static.restore(self.kept, prescribe=False)
        at = self._results(labels, self._states(rows, rates, numbers))
        n = along.count
        return {label: {name: (values[:n] - values[n:]) / (2 * _over(steps, values)) for name, values in of.items()}
                for label, of in at.items()}

    def _depends_on_rates(self, needs: tuple[list[str], bool], along: Directions) -> bool:
        """Return whether outputs of couplings or reactions change in a motion in all directions at once."""
        still = np.zeros(self.model.n_dof)
        whole = along.rates @ np.random.default_rng(2).uniform(0.5, 1.0, along.count)
        found = []
        for v in (still, whole):
            self.engine.set_rates(v, still)
            numbers, reaction = self._numbers(needs)
            found.append(np.concatenate([reaction, *(each.ravel() for each in numbers.values())]))
        self.static.restore(self.kept, prescribe=False)
        return bool(np.any(found[0] != found[1]))

    def _results(self, labels: set[str], at: States) -> dict[str, dict[str, np.ndarray]]:
        found = {label: part_states(self.model, self.scene, at, alone=label).by_label()[label] for label in labels}
        for label in labels & set(self.scene.cables):
            found[label]["position"] = self._points(label, found)
        return found

    def _spread(self, along: Directions) -> np.ndarray:
        """Return the changes of dofs and coordinates, (n, k)."""
        return np.concatenate([along.dofs, along.coordinates[0]])

    def _go(self, unknowns: np.ndarray, dofs: np.ndarray) -> None:
        """Move the state from rest by unknowns and prescribed dofs."""
        q = self.kept["q"]
        if dofs.any():
            q = q.copy()
            q[: len(dofs)] += dofs[: len(q)]
        self.engine.set_state(0.0, **self.kept | {"q": q}, prescribe=False)
        self.engine.move(unknowns)

    def _needs(self, labels: set[str]) -> tuple[list[str], bool]:
        """Return the kinds of couplings and whether the reactions of supports have part in results of labels."""
        groups = {part.group for part in self.scene.parts() if label_of(part) in labels}
        known = {label_of(part) for part in self.scene.parts()}
        if labels - known or "ropes" in groups:  # parts within a rope
            return list(OUTPUTS), True
        kinds = [kind.name for kind in COUPLINGS if kind.name in OUTPUTS and (
            kind.group in groups or ("slides" in groups and kind.name == "joint"))]
        return kinds, bool(groups & SUPPORTS)

    def _numbers(self, needs: tuple[list[str], bool]) -> tuple[dict[str, np.ndarray], np.ndarray]:
        """Return the outputs of couplings by kind and the reactions that results need."""
        kinds, reacts = needs
        return ({kind: self.engine.outputs_in_motion(kind) for kind in kinds},
                self.engine.forces_in_motion() if reacts else np.zeros(0))

    def _states(self, rows: Sequence[tuple[np.ndarray, np.ndarray]],
                rates: Sequence[tuple[np.ndarray, np.ndarray]] | None,
                numbers: Sequence[tuple[dict[str, np.ndarray], np.ndarray]] = ()) -> States:
        n, still = len(rows), self.model.n_dof
        v, a = (np.array([each[k] for each in rates]) if rates else np.zeros((n, still)) for k in range(2))
        by_kind, reaction = {}, np.zeros((n, still))
        for kind in OUTPUTS:
            if numbers and kind in numbers[0][0]:
                by_kind[kind] = np.array([each[0][kind] for each in numbers])
            else:
                one = self.engine.static_outputs(kind)
                by_kind[kind] = np.broadcast_to(one, (n, *one.shape))
        if numbers and len(numbers[0][1]):
            reaction = np.array([each[1] for each in numbers])
        return States(np.array([row[0] for row in rows]), v, a, np.array([row[1] for row in rows]), reaction, by_kind)


def _flat(values: np.ndarray, entry: tuple[int, ...]) -> int:
    """Return the number of an entry of results (k, ...) among those of one state."""
    return int(np.ravel_multi_index(entry, values.shape[1:])) if entry else 0


def _over(steps: np.ndarray, values: np.ndarray) -> np.ndarray:
    return steps.reshape(-1, *[1] * (values.ndim - 1))


def _derivative(values: np.ndarray, n: int, steps: np.ndarray) -> np.ndarray:
    """Return derivatives from results at steps h, -h and, if there are, h/2, -h/2 of n directions."""
    coarse = (values[:n] - values[n : 2 * n]) / (2 * _over(steps, values))
    if len(values) == 2 * n:
        return np.asarray(coarse)
    fine = (values[2 * n : 3 * n] - values[3 * n :]) / _over(steps, values)
    return np.asarray((4 * fine - coarse) / 3)
