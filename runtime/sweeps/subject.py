"""What is swept: a scene, whose parts and settings get other values, or a function of the parameters."""

from __future__ import annotations

import hashlib
import inspect
import time
import warnings
from collections.abc import Callable, Mapping, Sequence
from copy import copy
from dataclasses import dataclass
from typing import Any, Protocol

from ..errors import FunicularWarning, SceneError, near
from ..parts.paths import Path, changed, check_each_once, path_of, unit_of
from ..parts.settings import RunSettings, overridden
from ..parts.validation import shown
from ..results.run import Run
from ..scene.scene import Scene
from .identity import identity_of, identity_of_scene
from .parameters import SWEEP
from .points import RETURNED, Outcome, failure, outcome_of, run_points
from .stored_points import Keep, of_dict


class Subject(Protocol):
    """Makes the outcomes of points; it is sent to the processes that compute."""

    @property
    def digest(self) -> str:
        """Return the digest of what a sweep that goes on must have been started with."""

    def compute(self, points: Sequence[Mapping[str, Any]]) -> list[Outcome]:
        """Return the outcomes of points, each a value by parameter. Raises KeyboardInterrupt alone."""


@dataclass(frozen=True)
class SceneSubject:
    """A scene, with paths into it as parameters."""

    scene: Scene
    paths: Mapping[str, Path]
    keep: Keep

    @classmethod
    def of(cls, scene: Scene, parameters: Sequence[str], keep: Keep) -> SceneSubject:
        """Return the subject of a scene with run_settings. Raises SceneError for wrong paths and results."""
        keep.check(scene)
        paths = {name: path_of(scene, name) for name in parameters}
        check_each_once(paths.values())
        return cls(scene, paths, keep)

    @property
    def digest(self) -> str:
        """Return the digest of the scene's text, and of the functions that it watches."""
        return hashlib.sha256(identity_of_scene(self.scene).encode()).hexdigest()

    def scene_at(self, point: Mapping[str, Any]) -> Scene:
        """Return the scene with the values of a point. Raises SceneError."""
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", FunicularWarning)  # they stand in the scene's messages
            return changed(self.scene, {self.paths[name]: value for name, value in point.items()})

    def settings_at(self, point: Mapping[str, Any]) -> RunSettings:
        """Return the settings of the run at a point. Raises SceneError."""
        of_run = {path.entries[0]: point[name] for name, path in self.paths.items() if path.head == "run"}
        return RunSettings(**overridden(self.scene.run_settings, of_run))

    def check(self, point: Mapping[str, Any]) -> Scene:
        """Return the scene at a point, checked as far as that is possible without running it. Raises SceneError."""
        scene = self.scene_at(point)
        RunSettings(**scene.run_settings)
        scene.check()
        return scene

    def unit(self, name: str, point: Mapping[str, Any]) -> str:
        """Return the unit of a parameter, looked up in the scene of a point."""
        return unit_of(self.scene_at(point), self.paths[name])

    def compute(self, points: Sequence[Mapping[str, Any]]) -> list[Outcome]:
        """Return the outcomes of points, each a value by path."""
        outcomes: list[Outcome | None] = []
        scenes = []
        for point in points:
            begin = time.perf_counter()
            try:
                scenes.append(self.scene_at(point))
                outcomes.append(None)
            except SceneError as error:
                outcomes.append(failure(error, begin))
        ran = iter(run_points(scenes, self.keep))
        return [next(ran) if outcome is None else outcome for outcome in outcomes]


@dataclass(frozen=True)
class FunctionSubject:
    """A function that takes the parameters as keywords and returns a Scene, a Run, or a dict of numbers and arrays."""

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
        """Return the digest of the function, of the values that it takes from around it, and of the settings."""
        text = identity_of(self.function)
        return hashlib.sha256(f"{text}\n{sorted(self.settings.items())!r}".encode()).hexdigest()

    def compute(self, points: Sequence[Mapping[str, Any]]) -> list[Outcome]:
        """Return the outcomes of points, each a value by keyword."""
        scenes: list[Scene] = []
        outcomes = [self._called(point, scenes) for point in points]
        ran = iter(run_points(scenes, self.keep))
        return [next(ran) if outcome is None else outcome for outcome in outcomes]

    def _called(self, point: Mapping[str, Any], scenes: list[Scene]) -> Outcome | None:
        """Return the outcome at a point; None where the function made a scene, which is added to those to run."""
        begin = time.perf_counter()
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", FunicularWarning)
                made = self.function(**point)
            if isinstance(made, Scene):
                scenes.append(self._with_settings(made))
                return None
            if isinstance(made, Run):
                if not self.keep.wanted:
                    raise SceneError(SWEEP, "names no results to keep", 'give keep=["A.position", ...]')
                return outcome_of(made, self.keep, begin)
            if isinstance(made, Mapping):
                return Outcome(of_dict(made, self.keep), RETURNED, "", time.perf_counter() - begin)
            raise SceneError(SWEEP, "the function must return a Scene, a Run, or a dict of numbers and arrays, got "
                             + shown(made))
        except Exception as error:  # whatever it is, the other points go on
            return failure(error, begin)

    def _with_settings(self, scene: Scene) -> Scene:
        """Return a scene that the function made with the settings of the sweep; its own ones stay as they are."""
        if not self.keep.wanted:
            self.keep.check(scene)
        made = copy(scene)
        made.run_settings = _unsaved(scene, self.settings)
        return made


def _unsaved(scene: Scene, settings: Mapping[str, Any]) -> dict[str, Any]:
    """Return the settings of a scene's runs with those of a sweep, without the file that the scene names."""
    return {name: value for name, value in overridden(scene.run_settings, settings).items() if name != "save"}


def subject_of(subject: Any, parameters: Sequence[str], keep: Keep, settings: Mapping[str, Any]) -> Subject:
    """Return the subject of a sweep; settings: of its runs, instead of the scene's own. Raises SceneError."""
    if isinstance(subject, Scene):
        given = copy(subject)
        given.run_settings = _unsaved(subject, settings)
        return SceneSubject.of(given, parameters, keep)
    if callable(subject):
        return FunctionSubject.of(subject, parameters, keep, settings)
    raise SceneError(SWEEP, f"the subject must be a scene or a function, got {shown(subject)}",
                     'of a scene file give fu.load_scene("FILE.toml")')
