"""The subject of a sweep: a scene, whose parts and settings get other values, or a function of the parameters."""

from __future__ import annotations

import hashlib
import inspect
import time
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from copy import copy
from dataclasses import dataclass, field, fields
from functools import cached_property, partial
from typing import Any, ClassVar, NamedTuple, Protocol

import numpy as np

from ..base.interruptions import interruptible, uninterrupted
from ..base.stages import Stages
from ..errors import FunicularError, FunicularWarning, SceneError, near
from ..parts.paths import Path, Variants, check_each_once, path_of
from ..parts.settings import RunSettings, overridden
from ..parts.validation import shown
from ..results.run import Run
from ..scene.scene import Scene
from ..solve.linear.threads import one_blas_thread
from .abandonment import Watch
from .identity import identity_of, identity_of_scene
from .in_step import Ended, in_step
from .parameters import SWEEP, Points
from .silence import silence
from .stored_points import Keep, StoredPoint, of_dict

FAILED = "failed"
RETURNED = "returned"
"""The status of a point whose function returned numbers."""

MAX_CHECKED = 1000
"""Points that are checked before the work, 1 ms each; and values of each parameter of a grid."""
MAX_KEPT_PARTS = 20_000
"""Parts of checked scenes that are kept for their runs."""


class Outcome(NamedTuple):
    """The outcome of a point.

    stored: None where it failed; status: that of its run, "returned" where a function gave numbers, or "failed";
    message: the reason of the failure, else the notes of the run; seconds: wall time.
    """

    stored: StoredPoint | None
    status: str
    message: str
    seconds: float


class Subject(Protocol):
    """Computes the outcomes of points; it is sent to the processes that compute.

    takes_threads: whether threads of one process compute points at once.
    """

    takes_threads: ClassVar[bool]

    @property
    def digest(self) -> str:
        """Return the digest of scene or function and settings, which must be the same in a resumed sweep."""

    def compute(self, points: Sequence[Mapping[str, Any]], watch: Watch | None = None) -> list[Outcome]:
        """Return the outcomes of points, each a value by parameter; watch: of runs in threads. Raises KeyboardInterrupt
        alone, and what watch raises.
        """


@dataclass(frozen=True)
class SceneSubject:
    """A scene with run_settings, whose parameters are paths into it; checked: scenes of points, by their values."""

    takes_threads: ClassVar[bool] = True
    scene: Scene
    paths: Mapping[str, Path]
    keep: Keep
    checked: dict[tuple[Any, ...], Scene] = field(default_factory=dict, repr=False, compare=False)

    def __getstate__(self) -> dict[str, Any]:
        """Return the state for pickling: other processes make their own scenes."""
        return {each.name: getattr(self, each.name) for each in fields(self)} | {"checked": {}}

    @classmethod
    def of(cls, scene: Scene, parameters: Sequence[str], keep: Keep) -> SceneSubject:
        """Return the subject of a scene. Raises SceneError for wrong paths and results."""
        keep.check(scene)
        paths = {name: path_of(scene, name) for name in parameters}
        check_each_once(paths.values())
        return cls(scene, paths, keep)

    @property
    def digest(self) -> str:
        """Return the digest of the scene's text, and of the functions of its events."""
        return hashlib.sha256(identity_of_scene(self.scene).encode()).hexdigest()

    def scene_at(self, point: Mapping[str, Any]) -> Scene:
        """Return the scene with the values of a point. Raises SceneError."""
        with silence:  # warnings stand in the scene's messages
            return self._variants.at({self.paths[name]: value for name, value in point.items()})

    @cached_property
    def _variants(self) -> Variants[Scene]:
        return Variants(self.scene, self.paths.values())

    def check(self, points: Points) -> None:
        """Refuse a sweep with a scene that cannot be simulated. Raises SceneError that names the point.

        Few points are all checked. Of many: each value of a grid's parameters with the first ones of the others, the
        smallest and the largest value of all parameters of samples, and points spread over all of them. The first ones
        are kept for `compute`.
        """
        most = MAX_KEPT_PARTS // max(len([*self.scene.parts()]), 1)
        for number in _to_check(points):
            point = points.point(number)
            try:
                scene = self.scene_at(point)
                RunSettings(**scene.run_settings)
                scene.check()
            except SceneError as error:
                values = ", ".join(f"{name} = {value:.9g}" if isinstance(value, float) else f"{name} = {value}"
                                   for name, value in point.items())
                raise error.inside(f"{SWEEP} at {values}") from None
            if len(self.checked) < most:
                self.checked[tuple(point.values())] = scene

    def own_times(self, points: Points) -> int | None:
        """Return the largest number of output times of a point, None where all points have the same times."""
        swept = {path.entries[0]: points.columns[name] for name, path in self.paths.items() if path.head == "run"}
        of_run = {name: column[0].item() for name, column in swept.items()}
        settings = RunSettings(**overridden(self.scene.run_settings, of_run))
        duration = swept.get("duration", np.array([settings.duration]))
        given = np.array([settings.output_step]) if "output_step" in settings.model_fields_set else None
        output = swept.get("output_step", given)
        stops = any(event.action == "stop" for event in self.scene.events.values())
        if len(duration) == 1 and (output is None or len(output) == 1) and not stops:
            return None
        if output is None:  # a part of the duration, as `RunSettings` has it
            return round(settings.duration / settings.output_step) + 2
        if points.is_grid or 1 in (len(duration), len(output)):
            return int(np.ceil(duration.max() / output.min())) + 2
        return int(np.ceil((duration / output).max())) + 2

    def compute(self, points: Sequence[Mapping[str, Any]], watch: Watch | None = None) -> list[Outcome]:
        """Return the outcomes of points, each a value by path."""
        def made(point: Mapping[str, Any]) -> Scene:
            return self.checked.pop(tuple(point.values()), None) or self.scene_at(point)

        return _outcomes(made, points, self.keep, watch)


@dataclass(frozen=True)
class FunctionSubject:
    """A function that takes the parameters as keywords and returns a Scene, a Run, or a dict of numbers and arrays."""

    takes_threads: ClassVar[bool] = False  # it may hold Python's lock, and change what other calls of it use
    function: Callable[..., Any]
    keep: Keep
    settings: Mapping[str, Any]

    @classmethod
    def of(cls, function: Callable[..., Any], parameters: Sequence[str], keep: Keep,
           settings: Mapping[str, Any]) -> FunctionSubject:
        """Return the subject of a function; settings: of the runs of scenes that it returns. Raises SceneError."""
        try:
            signature = inspect.signature(function)
        except (TypeError, ValueError):
            return cls(function, keep, settings)
        known = [name for name, each in signature.parameters.items()
                 if each.kind in (each.POSITIONAL_OR_KEYWORD, each.KEYWORD_ONLY)]
        takes_all = any(each.kind is each.VAR_KEYWORD for each in signature.parameters.values())
        for name in parameters:
            if name not in known and not takes_all:
                raise SceneError(SWEEP, f'the function takes no parameter "{name}"', near(name, known))
        try:
            signature.bind(**dict.fromkeys(parameters))
        except TypeError as error:
            raise SceneError(SWEEP, f"the function cannot be called with {', '.join(parameters)} alone: {error}",
                             "give it a default, or sweep it with one value") from None
        return cls(function, keep, settings)

    @property
    def digest(self) -> str:
        """Return the digest of the function, of the values that it uses, and of the settings."""
        text = identity_of(self.function)
        return hashlib.sha256(f"{text}\n{sorted(self.settings.items())!r}".encode()).hexdigest()

    def compute(self, points: Sequence[Mapping[str, Any]], watch: Watch | None = None) -> list[Outcome]:
        """Return the outcomes of points, each a value by keyword."""
        return _outcomes(self._made, points, self.keep, watch)

    def _made(self, point: Mapping[str, Any]) -> Any:
        """Return the result of the function at a point; a scene with the settings of the sweep."""
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", FunicularWarning)
            made = self.function(**point)
        if not isinstance(made, Scene):
            return made
        if not self.keep.wanted:
            self.keep.check(made)
        return _with_settings(made, self.settings)


def subject_of(subject: Any, parameters: Sequence[str], keep: Keep, settings: Mapping[str, Any]) -> Subject:
    """Return the subject of a sweep; settings: of its runs, instead of the scene's own. Raises SceneError."""
    if isinstance(subject, Scene):
        return SceneSubject.of(_with_settings(subject, settings), parameters, keep)
    if callable(subject):
        return FunctionSubject.of(subject, parameters, keep, settings)
    raise SceneError(SWEEP, f"the subject must be a scene or a function, got {shown(subject)}",
                     'of a scene file give fu.load_scene("FILE.toml")')


def _with_settings(scene: Scene, settings: Mapping[str, Any]) -> Scene:
    """Return a copy of a scene with the settings of a sweep, and without the file that the scene names."""
    made = copy(scene)
    made.run_settings = {name: value for name, value in overridden(scene.run_settings, settings).items()
                         if name != "save"}
    return made


def _outcomes(make: Callable[[Mapping[str, Any]], Any], points: Sequence[Mapping[str, Any]],
              keep: Keep, watch: Watch | None) -> list[Outcome]:
    """Return the outcomes of points; make: returns a scene to run, a run, or results by name; watch: of the runs.

    An error of one point does not stop the others; Ctrl-C does, as KeyboardInterrupt.
    """
    made = [_attempt(make, point, keep) for point in points]
    with uninterrupted(), one_blas_thread, interruptible():  # for all runs at once: each would set and reset it
        ends = in_step(partial(_begun, each, watch, keep.takes_runs) for each in made if isinstance(each, Scene))
        ran = [_of_run(ends, keep) if isinstance(each, Scene) else each for each in made]
    return [each for each in ran if isinstance(each, Outcome)]


def _begun(scene: Scene, watch: Watch | None, timed: bool) -> Stages[Run]:
    """Return the work of a run, after its checks; it raises KeyboardInterrupt where it is interrupted."""
    work = scene._in_stages({}, False, watch or False, timed=timed)

    def whole() -> Stages[Run]:
        run = yield from work
        if run.status == "interrupted":
            raise KeyboardInterrupt
        return run

    return whole()


def _of_run(ends: Iterator[Ended[Run]], keep: Keep) -> Outcome | Scene:
    """Return the outcome of the next one of runs."""
    with silence:  # warnings stand in the report
        result, seconds = next(ends)

    def ended(result: Run | Exception) -> Run:
        if isinstance(result, Exception):
            raise result
        return result

    found = _attempt(ended, result, keep)
    return found._replace(seconds=found.seconds + seconds) if isinstance(found, Outcome) else found


def _attempt(act: Callable[[Any], Any], given: Any, keep: Keep) -> Outcome | Scene:
    """Return the outcome of a point from the result of a function; a scene as it is, to be run later."""
    begin = time.perf_counter()
    try:
        made = act(given)
        if isinstance(made, Scene):
            return made
        if isinstance(made, Run):
            if made.status == "interrupted":  # one that a function returned
                raise KeyboardInterrupt
            if not keep.wanted:
                raise SceneError(SWEEP, "names no results to keep", 'give keep=["A.position", ...]')
            stored, status, message = keep.take(made), made.status, "; ".join(made.report["messages"])
        elif isinstance(made, Mapping):
            stored, status, message = of_dict(made, keep), RETURNED, ""
        else:
            raise SceneError(SWEEP, "the function must return a Scene, a Run, or a dict of numbers and arrays, got "
                             + shown(made))
    except Exception as error:  # of any kind: the other points go on
        message = str(error) if isinstance(error, FunicularError) else f"{type(error).__name__}: {error}"
        return Outcome(None, FAILED, message.removesuffix(": "), time.perf_counter() - begin)
    return Outcome(stored, status, message, time.perf_counter() - begin)


def _to_check(points: Points) -> list[int]:
    """Return the numbers of the points to check before the work, each once."""
    if points.number <= MAX_CHECKED:
        return list(range(points.number))
    found: dict[int, None] = {}
    if points.is_grid:
        for axis, size in enumerate(points.shape):
            stride = int(np.prod(points.shape[axis + 1:], dtype=int))
            found |= dict.fromkeys(stride * k for k in range(min(size, MAX_CHECKED)))
    else:
        for values in points.columns.values():
            if values.dtype.kind in "if":
                found |= {int(values.argmin()): None, int(values.argmax()): None}
    spread = np.linspace(0, points.number - 1, MAX_CHECKED).astype(int)
    return [*(found | dict.fromkeys(spread.tolist()))]
