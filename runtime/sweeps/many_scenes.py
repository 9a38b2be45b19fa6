"""Many scenes on several threads: the C engine runs without Python's lock."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Iterator
from functools import partial
from itertools import islice
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from ..base.stages import Stages
from ..errors import FunicularError, SceneError
from ..integrators import AUTO
from ..parts.settings import RunSettings
from ..parts.validation import shown
from ..results.run import Run
from ..scene.scene import Scene
from ..solve.linear.threads import available, one_blas_thread
from ..solve.motion.trial_cache import TrialCache
from .abandonment import Abandonment
from .in_step import MAX_GROUP, Ended, in_step

if TYPE_CHECKING:
    from concurrent.futures import Future

Result: TypeAlias = Run | dict[str, np.ndarray] | FunicularError

GROUPS_PER_THREAD = 3
"""Groups of scenes of each thread that are taken in advance, so that a thread finds another one while the caller waits.
"""
GROUP_SECONDS = 0.1
"""Time of the scenes that one thread runs in step."""

SINGLE_RUN_SETTINGS = ("save", "resume", "progress")
"""Arguments of `Scene.run` that name a file or a display, which many scenes would share."""


def run_many(scenes: Iterable[Scene | Callable[[], Scene]], *, threads: int | None = None,
             keep: Iterable[str] | None = None, **settings: Any) -> Iterator[Result]:
    """Run scenes on several threads at once; yields the result of each in the order of the scenes.

    scenes: scenes, or functions without arguments that return one, which are called on the threads. About
    ``3 * threads`` of them are taken in advance, of short runs up to 16 times as many, so that memory does not grow
    with their number. threads: scenes that run at once, by default one for each processor. keep: names of results such
    as ``["A.position"]``. settings: as for `Scene.run`, without save, resume and progress.

    Yields, for each scene, its `Run`, bit for bit that of ``scene.run(**settings)`` with the same integrator; with
    ``keep`` a dict of its arrays by these names, and ``"time"``. The first scene is run before the others: an
    integrator that loses its trial there is not tried again with scenes of its shape, see `solve.motion.trial_cache`. A
    scene that fails yields its `FunicularError`, without a traceback, and the others go on. Where the iteration ends
    early, also after Ctrl-C, the remaining scenes are not run. Raises SceneError for settings that no scene can take,
    and any other error of a function in ``scenes``.

    >>> import funicular as fu
    >>> scene = fu.load_scene("paper51")
    >>> heavier = (scene.replace("A", mass=mass) for mass in (1.0, 2.0))
    >>> for kept in fu.run_many(heavier, duration=0.1, tol=1e-3, keep=["A.position"]):
    ...     print(kept["A.position"].shape)
    (51, 3)
    (51, 3)
    """
    for name in SINGLE_RUN_SETTINGS:
        if name in settings:
            raise SceneError("run_many", f'"{name}" belongs to one run', "use the results that the iteration yields")
    if isinstance(scenes, Scene):
        raise SceneError("run_many", "takes many scenes, got one", "give a list, or call run of the scene")
    RunSettings(**{"duration": 1.0} | {name: value for name, value in settings.items() if name != "initial"})
    threads = available() if threads is None else threads
    if isinstance(threads, bool) or not isinstance(threads, int) or threads < 1:
        raise SceneError("run_many", f"threads must be a whole number from 1 on, got {shown(threads)}")
    if isinstance(keep, str):
        raise SceneError("run_many", f"keep must be names of results, got {shown(keep)}", f"give [{keep!r}]")
    return _results(iter(scenes), threads, None if keep is None else list(keep), settings)


def _bare(error: FunicularError) -> FunicularError:
    """Return an error without its tracebacks and those of its causes, which keep the engine in memory."""
    link: BaseException | None = error
    while link is not None:
        link.__traceback__ = None
        link = link.__cause__ or link.__context__
    return error


def _results(scenes: Iterator[Scene | Callable[[], Scene]], threads: int, keep: list[str] | None,
             settings: dict[str, Any]) -> Iterator[Result]:
    """Yield the results in order; nothing starts before the first is asked for."""
    abandonment = Abandonment()

    def begun(of: Scene | Callable[[], Scene]) -> Stages[Run]:
        scene = of() if callable(of) else of
        if not isinstance(scene, Scene):
            raise SceneError("run_many", f"{shown(scene)} is not a scene", "give scenes, or functions that return one")
        if scene.run_settings.get("save") is not None:
            raise SceneError("run", '"save" in the scene\'s settings names a file of one run',
                             "leave it out where many scenes run")
        return scene._in_stages(settings | {"threads": 1}, False, abandonment.watch, trials, timed=keep is None)

    def results(group: list[Scene | Callable[[], Scene]]) -> list[Ended[Result]]:
        return [_kept(*ended, keep) for ended in in_step(partial(begun, of) for of in group)]

    trials = TrialCache(is_open=settings.get("integrator") in (None, AUTO) and settings.get("step") is None)
    from concurrent.futures import ThreadPoolExecutor, wait  # which one scene does without

    waiting: deque[Future[list[Ended[Result]]]] = deque()
    length = 1
    with one_blas_thread, ThreadPoolExecutor(threads, "funicular") as pool:
        try:
            while group := [*islice(scenes, length)]:
                waiting.append(pool.submit(results, group))
                if trials.is_open:  # the others use the trial of the first scene, for any number of threads
                    wait(waiting)
                    trials.is_open = False
                if len(waiting) >= GROUPS_PER_THREAD * threads:
                    ended = waiting.popleft().result()
                    yield from _of(ended)
                    length = max(1, min(MAX_GROUP, int(GROUP_SECONDS / max(max(each.seconds for each in ended), 1e-9))))
            while waiting:
                yield from _of(waiting.popleft().result())
        finally:
            abandonment.begin()
            pool.shutdown(wait=False, cancel_futures=True)


def _kept(result: Run | Exception, seconds: float, keep: list[str] | None) -> Ended[Result]:
    """Return what is yielded of the end of a run: its arrays of these names, or all of it."""
    found: Result | Exception = result
    if isinstance(result, Run) and keep is not None:
        try:
            found = {"time": result.time} | {name: result[name] for name in keep}
        except FunicularError as error:
            found = error
    return Ended(_bare(found) if isinstance(found, FunicularError) else found, seconds)


def _of(ended: list[Ended[Result]]) -> Iterator[Result]:
    """Yield the results of runs. Raises the errors that are none of a scene."""
    for result, _ in ended:
        if isinstance(result, Exception) and not isinstance(result, FunicularError):
            raise result
        yield result
