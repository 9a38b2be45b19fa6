"""The scene: its description (scene/described.py), runs and analyses."""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from functools import partial
from typing import TYPE_CHECKING, Any, Never, Self, cast

from ..base.interruptions import interruptible, uninterrupted, was_interrupted
from ..base.stages import Stages, at_once
from ..errors import (
    EquilibriumError,
    FunicularWarning,
    ResultFileError,
    SceneError,
    enough_memory,
    near,
)
from ..parts.in_plane import in_plane
from ..parts.settings import (
    EquilibriumSettings,
    LinearSettings,
    ModeSettings,
    RelaxationSettings,
    RunSettings,
    overridden,
)
from ..parts.validation import show, shown
from ..results.run import Run, raise_where_stopped
from ..results.viewable import Viewable
from ..solve.linear.threads import one_blas_thread
from ..solve.motion.progress import progress_bar
from .described import DescribedScene

if TYPE_CHECKING:
    # Model, solvers and results import SciPy, which would double the time of `import funicular`; checks take a tenth of
    # it. So the methods that need them import them.
    from numpy.typing import ArrayLike

    from ..choice.choice import Choice
    from ..export.program import Exported
    from ..parts.inputs import Input
    from ..results.equilibrium import Equilibrium
    from ..results.linear_model import LinearModel
    from ..results.modes import Modes
    from ..results.simulation import Simulation
    from ..results.streaming import Stream
    from ..solve.motion.run import Start
    from ..solve.motion.trial_cache import TrialCache
    from ..view.animation import Animation

SYNONYMS = {"dt": "step", "time_step": "step", "timestep": "step", "h": "step", "t_end": "duration", "tend": "duration",
            "end_time": "duration", "time": "duration", "rtol": "tol", "tolerance": "tol", "solver": "integrator",
            "method": "integrator", "output": "save", "path": "save", "file": "save", "dt_out": "output_step",
            "output_dt": "output_step", "n_threads": "threads"}
"""Names of the settings of a run in other programs."""
MAX_NAMED = 12
"""Number of parts of a kind that a notebook names."""


class Scene(Viewable, DescribedScene):
    """Cables, bodies, their couplings, supports and loads.

    ``gravity`` in m/s²; ``temperature`` of cables, K; ``cables``, ``bodies``, ``ropes``, ``joints``, ``slides``,
    ``ties``, ``loads``, ``point_forces``, ``events`` are dicts by name; ``pins``, ``clamps`` and ``motions`` are lists,
    all read-only: methods add parts, `replace` and `without` make other scenes. ``messages`` lists adjustments;
    ``run_settings``, ``equilibrium_settings`` and ``relax_settings`` hold the settings of the scene's file; ``title``,
    of pictures, is by default the name of this file without the ending.
    """

    def _check_for(self, settings: RunSettings) -> None:
        """Check the scene for a run of these settings. Raises SceneError."""
        from ..checks.whole_scene import check_start_as_drawn  # likewise

        self.check()
        if settings.initial == "drawn":
            check_start_as_drawn(self)

    def run(
        self,
        duration: float | None = None,
        *,
        tol: float | None = None,
        absolute_tol: float | None = None,
        quantities: Sequence[str] | None = None,
        step: float | None = None,
        output_step: float | None = None,
        integrator: str | None = None,
        spectral_radius: float | None = None,
        model: str | None = None,
        initial: str | Equilibrium | Mapping[str, ArrayLike] | None = None,
        threads: int | None = None,
        save: str | os.PathLike[str] | None = None,
        resume: bool = False,
        progress: bool | Callable[[float], None] | None = None,
        estimate: bool | None = None,
        **unknown: Never,
    ) -> Run:
        """Simulate the scene for ``duration`` (s); see `RunSettings` for the settings and their defaults.

        By default settings are those of the scene's file. model: "auto" chooses elements, laws and meshes of cables,
        where they were not given, and the integrator, so that the total error stays below tol, see `choose`; cables
        without elements are always chosen so. ``run.report["choice"]`` gives the choice and its reasons, ``run.scene``
        is the chosen scene. initial: "drawn", "equilibrium" or "relaxed" (found first), a state of `equilibrium` or
        `relax`, with the velocities drawn, a state ``run.at(time)`` of another run, or arrays by the names of results
        such as ``{"wire.nodal_vectors": ...}``, see `InitialState`. save: a netCDF file, written during the run, with a
        checkpoint (the same name and ``.state``) that stays when the run is killed or interrupted; results are read
        from the file on demand. resume: continue from the checkpoint, with the same numbers. progress: a bar (True),
        none (False), a bar in a terminal (None), or a function of the time reached.

        During the run the BLAS of NumPy and SciPy uses one thread in the whole process; computations with large
        matrices in other threads take longer.

        Raises SceneError, ResultFileError, EquilibriumError; EndOfCableError, RopeLeftError and ConvergenceError, whose
        ``run`` holds the results so far. Ctrl-C returns the results so far, with a `FunicularWarning`.
        """
        _refuse_unknown("run", unknown, (*RunSettings.keywords(), "resume", "progress"))
        given = {"duration": duration, "tol": tol, "absolute_tol": absolute_tol, "quantities": quantities, "step": step,
                 "output_step": output_step, "integrator": integrator, "spectral_radius": spectral_radius,
                 "threads": threads, "save": save, "estimate": estimate, "model": model, "initial": initial}
        return self._run(given, resume, progress)

    def _run(self, settings_given: Mapping[str, Any], resume: bool, progress: bool | Callable[[float], None] | None,
             trials: TrialCache | None = None) -> Run:
        """Return the run with these settings, None for defaults, see `run`; trials: of scenes of one shape."""
        work = self._in_stages(settings_given, resume, progress, trials)
        with uninterrupted(), one_blas_thread:
            run = at_once(work)
        if run.status == "interrupted":
            warnings.warn(run.report["message"], FunicularWarning, stacklevel=3)
        return run

    def _in_stages(self, settings_given: Mapping[str, Any], resume: bool,
                   progress: bool | Callable[[float], None] | None, trials: TrialCache | None = None,
                   timed: bool = True) -> Stages[Run]:
        """Return the work of a run, see `_run`, after its checks; Ctrl-C must not interrupt it between its parts.

        timed: whether the report is to have the times of slides and joints.
        """
        scene, settings, state, chosen = self._settled(
            {name: value for name, value in settings_given.items() if value is not None})
        scene._check_for(settings)
        _check_resume(resume, settings)
        return scene._simulated(settings, state, resume, progress, chosen, trials, timed)

    def _settled(self, given: dict[str, Any]) -> tuple[Self, RunSettings, Start | None, Choice[Self] | None]:
        """Return the scene of a run with these settings, chosen and adjusted, the settings, the state to start from,
        and the choice.
        """
        initial = given.get("initial")
        state = None if initial is None or isinstance(initial, str) else _state(self, initial)
        if state is not None:
            given["initial"] = "state" if isinstance(initial, Mapping) else "equilibrium"
        settings = RunSettings(**overridden(self.run_settings, given))
        if "save" not in given and self.run_settings.get("save") is not None:
            settings = settings.model_copy(update={"save": self.run_settings.get("save")})  # as the file has it
        if settings.initial == "state" and state is None:
            raise SceneError("run", 'initial = "state" needs a state', "give what run.at() or equilibrium() returned")
        chosen = self._chosen_for(settings)
        scene, settings = (self, settings) if chosen is None else (chosen.scene, chosen.settings_of(settings))
        scene, state = scene._adjusted(settings, state)
        return scene, settings, state, chosen

    def _driven(self, given: Mapping[str, Any], inputs: Sequence[str],
                use: str) -> tuple[Self, RunSettings, Start | None, list[Input]]:
        """Return the scene of a run with these settings, None for defaults, and with inputs, checked, the settings, the
        state to start from, and the inputs; use: of the inputs, in messages.
        """
        from ..parts.inputs import with_inputs  # for these runs alone

        scene, settings, state, chosen = self._settled({k: v for k, v in given.items() if v is not None})
        driven, found = with_inputs(scene, inputs, use)
        driven._check_for(settings)
        if settings.initial in ("equilibrium", "relaxed") and state is None:
            state = _at_rest(settings.initial, driven, None if chosen is None else chosen.rest)
        return driven, settings, state, found

    def _adjusted(self, settings: RunSettings, state: Start | None) -> tuple[Self, Start | None]:
        """Return the scene and the state at the start of a run, adjusted where the scene's file adjusts parameters."""
        if state is not None or settings.initial != "equilibrium" or not self.equilibrium_settings.get("adjust"):
            return self, state
        rest = self.equilibrium()
        return cast(Self, rest.scene), rest

    def choose(self, tol: float | None = None, *, duration: float | None = None, quantities: Sequence[str] = (),
               free: str = "unset", initial: str | None = None, integrator: str | None = None,
               unequal: bool = False) -> Choice[Self]:
        """Choose element, law and mesh of each cable, and the integrator, so that a run errs by less than ``tol``.

        tol: of the error of model, mesh and time, relative to the largest change, with the finest model available as
        the reference; by default that of the scene's file, or 1e-3. quantities: names of results such as "A.position"
        or "trolley.force", by default the motion of all cables and bodies. free: "unset" chooses what was not
        given, the number of elements of cables without ``elements``, element and law of cables without ``element``;
        "all" chooses all. duration in s, initial and integrator are those of the run, by default of the scene's file.
        unequal: elements of unequal lengths are tried, too, and taken where they save a third.

        Short runs on coarse meshes and error indicators decide. The choice has the chosen ``scene``, ``reasons``, and
        ``table``, the alternatives with their estimated errors and costs; print it. Raises SceneError.
        """
        given = {"tol": tol, "duration": duration, "initial": initial, "integrator": integrator}
        given = {name: value for name, value in given.items() if value is not None}
        settings = RunSettings(**{"tol": 1e-3} | overridden(self.run_settings, given))
        if isinstance(quantities, str):
            raise SceneError("choose", f"quantities must be a list of names, got {quantities!r}")
        return self._choose(settings, quantities, free, unequal)

    def _chosen_for(self, settings: RunSettings) -> Choice[Self] | None:
        """Return the choice where a run requests one, or cables lack elements; else None."""
        if settings.model == "auto":
            return self._choose(settings, settings.quantities or (), "unset")
        if not any(cable.is_open for cable in self.cables.values()):
            return None
        chosen = self._choose(settings, settings.quantities or (), "unset")
        warnings.warn(chosen.messages()[0], FunicularWarning, stacklevel=5)  # it was not requested
        return chosen

    def _choose(self, settings: RunSettings, quantities: Sequence[str], free: str,
                unequal: bool = False) -> Choice[Self]:
        """Return the choice for a run with these settings."""
        from ..choice.choosing import choose  # runs, which bring SciPy
        from ..choice.probes import Runner

        def simulate(scene: Self, settings: RunSettings, rest: Equilibrium | None) -> Run:
            scene._check_for(settings)
            with uninterrupted(), one_blas_thread:
                run = at_once(scene._simulated(settings, rest, False, False))
            if run.status == "interrupted":
                raise KeyboardInterrupt
            return run

        return choose(self, settings, quantities, free, Runner(simulate, partial(_at_rest, settings.initial)), unequal)

    def _simulated(self, settings: RunSettings, state: Start | None, resume: bool,
                   progress: bool | Callable[[float], None] | None, chosen: Choice[Self] | None = None,
                   trials: TrialCache | None = None, timed: bool = True) -> Stages[Run]:
        """Return the run with these settings, from a state or as the settings say, in stages. Raises EndOfCableError,
        RopeLeftError and ConvergenceError.
        """
        with self._saving(settings, resume) as stream, enough_memory():
            from ..results.recording import recorded  # brings SciPy and the engine
            from ..solve.motion.run import simulate

            given = state
            if settings.initial in ("equilibrium", "relaxed") and state is None:
                with interruptible():
                    state = _at_rest(settings.initial, self, None if chosen is None else chosen.rest)
            flat = in_plane(self)
            with progress_bar(settings.duration, progress) as on_progress:
                simulation = yield from simulate(flat, settings, on_progress, initial=state, stream=stream,
                                                 trials=trials)
            recording = recorded(simulation, flat, settings, timed)
            if chosen is not None:
                recording.report["choice"] = chosen.facts()
                recording.report["messages"] = [*chosen.messages(), *recording.report["messages"]]
            run = (stream.finish(recording) if stream
                   else Run.from_recording(recording, self, settings, self.from_toml))
            if settings.estimate:
                self._estimate(run, settings, given)
                if stream:
                    stream.add_to_report(run.report)
            if was_interrupted() and run.status != "interrupted":
                warnings.warn("the interruption came after the end of the run: its results are complete",
                              FunicularWarning, stacklevel=5)
        raise_where_stopped(run)
        return run

    def _saving(self, settings: RunSettings, resume: bool) -> AbstractContextManager[Stream | None]:
        """Return the writer of the file of a run, if it has one."""
        if settings.save is None:
            return nullcontext()
        from ..results.streaming import Stream  # brings the file format, which takes 20 ms

        return Stream(settings.save, self, settings, resume, self.from_toml)

    def _estimate(self, run: Run, settings: RunSettings, state: Start | None) -> None:
        """Add the errors of steps and mesh to the report of a run, unless interrupted; state: the given start."""
        from ..results.error_estimate import error_estimate  # brings SciPy

        def again(scene: Self, changes: dict[str, Any]) -> Run:
            other = scene.copied()
            kept = {name: getattr(settings, name) for name in settings.model_fields_set - {"estimate", "save"}}
            other.run_settings = {}
            made = other.run(**kept | changes | ({} if state is None else {"initial": state}), progress=False)
            if made.status == "interrupted":
                raise KeyboardInterrupt
            return made

        if run.status != "completed":
            run.report["messages"].append(f"the run's errors are not estimated: it ended with status \"{run.status}\"")
            return
        try:
            with interruptible():
                found = error_estimate(self, run, settings, state is not None, again)
        except KeyboardInterrupt:
            run.report["messages"].append("the run's errors are not estimated: that was interrupted")
            warnings.warn(run.report["messages"][-1], FunicularWarning, stacklevel=6)
            return
        run.report["errors"] = found.as_report()
        run.report["messages"] += found.messages

    def simulation(
        self,
        inputs: Sequence[str] = (),
        *,
        duration: float | None = None,
        tol: float | None = None,
        absolute_tol: float | None = None,
        quantities: Sequence[str] | None = None,
        step: float | None = None,
        output_step: float | None = None,
        integrator: str | None = None,
        spectral_radius: float | None = None,
        model: str | None = None,
        initial: str | Equilibrium | Mapping[str, ArrayLike] | None = None,
        threads: int | None = None,
        **unknown: Never,
    ) -> Simulation:
        """Begin a run that is stepped from outside, as by a controller or another program; see `Simulation`.

        inputs: paths to loads, drives, motions and velocities of fluids, as in sweeps, whose values are given between
        steps: "push.value.x" (N), a component of a load; "push.scale"; "winch.velocity" of a driven slide or joint;
        "hinge.angle"; "wind.velocity.x". They begin with the scene's values. duration: where the end is known; it may
        be passed. Without one `step` continues as long as it is called. The other settings are those of `run`.

        >>> import funicular as fu
        >>> scene = fu.load_scene("paper51")
        >>> sim = scene.simulation(tol=1e-3)
        >>> sim.step(0.01)
        >>> sim["A.position"].shape
        (3,)

        Raises SceneError, EquilibriumError.
        """
        _refuse_unknown("simulation", unknown, (*RunSettings.keywords(), "inputs"))
        given = {"duration": duration, "tol": tol, "absolute_tol": absolute_tol, "quantities": quantities, "step": step,
                 "output_step": output_step, "integrator": integrator, "spectral_radius": spectral_radius,
                 "threads": threads, "model": model, "initial": initial}
        from ..results.simulation import Simulation  # brings SciPy

        known_end = duration is not None or "duration" in self.run_settings
        if not known_end:
            given["duration"] = 1.0 if output_step is None else 100.0 * output_step
        with enough_memory():
            driven, settings, state, found = self._driven(given, inputs, "simulation")
            return Simulation(driven, in_plane(driven), settings, state, {each.path: each for each in found}, known_end,
                              self.from_toml)

    def export_c(
        self,
        folder: str | os.PathLike[str],
        duration: float | None = None,
        *,
        tol: float | None = None,
        absolute_tol: float | None = None,
        quantities: Sequence[str] | None = None,
        step: float | None = None,
        output_step: float | None = None,
        integrator: str | None = None,
        spectral_radius: float | None = None,
        model: str | None = None,
        initial: str | Equilibrium | Mapping[str, ArrayLike] | None = None,
        inputs: Sequence[str] = (),
        **unknown: Never,
    ) -> Exported:
        """Write the run of this scene as a program in C11 to a folder, which is new, empty, or of an earlier export.

        The settings are those of `run`, the inputs those of `simulation`. The folder has the engine, the
        kernels of this scene, the packed scene, the interface ``funicular.h``, an example ``main.c``,
        ``Makefile`` and ``CMakeLists.txt``. The program needs libc, libm and threads alone. Its rows are those
        of `run`, bit for bit on one machine where compilers contract no operations and the run calls no LAPACK,
        otherwise up to rounding. Returns `Exported`: the values of a row by name, and the results that have
        none in C.

        Raises SceneError for what C cannot run: functions of events, loads and friction that events switch, elements of
        a library of the user, ropes without mass.
        """
        _refuse_unknown("export_c", unknown, (*RunSettings.keywords(), "inputs"))
        given = {"duration": duration, "tol": tol, "absolute_tol": absolute_tol, "quantities": quantities, "step": step,
                 "output_step": output_step, "integrator": integrator, "spectral_radius": spectral_radius,
                 "model": model, "initial": initial}
        with one_blas_thread, enough_memory():
            from ..export.program import write_program  # brings the engine
            from ..export.scene_image import image_of

            driven, settings, state, found = self._driven(given, inputs, "export_c")
            return write_program(folder, image_of(in_plane(driven), settings, state, found))

    def equilibrium(
        self,
        *,
        load_steps: int | None = None,
        tolerance: float | None = None,
        max_iterations: int | None = None,
        method: str | None = None,
        largest_step: float | None = None,
        seek_stable: bool | None = None,
        scale_gravity: bool | None = None,
        impending: str | None = None,
        wraps: str | None = None,
        adjust: Mapping[str, tuple[float, float] | str | None] | Sequence[str] | None = None,
        to: Mapping[str, float] | None = None,
        start: Equilibrium | None = None,
        **unknown: Never,
    ) -> Equilibrium:
        """Find the static equilibrium under all loads at t = 0; see `EquilibriumSettings` for the defaults.

        By default settings are those of the scene's file. The state is stable, unless the settings admit others, which
        are marked in ``stable``, in ``messages`` and by a `FunicularWarning`; friction of slides is omitted. start: a
        state of this scene, under the same or other loads, also on another mesh of the same elements, from which the
        search begins instead of the drawn state; method "arc_length" continues from its load_fraction in its direction,
        or, from a state under all loads, starts anew from rest without loads, and needs the same mesh.

        Ropes have no friction, but with ``impending``: of ropes that are about to move towards their first items,
        "hoisting", or towards their last ones, "lowering"; and with wraps="stick": of ropes that stay on the sheaves on
        which they have friction as they lie there as drawn, or in the state ``start``.

        adjust, to: parameters, by path with limits or "free", that are changed until the state has given values, by
        name: ``adjust={"dropper.length": "free"}, to={"wire@20.position.y": 5.3}``. The state's ``scene`` is the
        adjusted one, for runs; ``adjusted`` has the values found, ``adjustment`` details. With more parameters than
        values the change is the least. Places on a cable whose length is adjusted keep their fraction of it.

        Raises SceneError; EquilibriumError, which holds the last state.
        """
        _refuse_unknown("equilibrium", unknown, (*EquilibriumSettings.keywords(), "start"))
        given = {"load_steps": load_steps, "tolerance": tolerance, "max_iterations": max_iterations, "method": method,
                 "largest_step": largest_step, "seek_stable": seek_stable, "scale_gravity": scale_gravity,
                 "impending": impending, "wraps": wraps, "adjust": adjust, "to": to}
        settings = EquilibriumSettings(**self.equilibrium_settings | {k: v for k, v in given.items() if v is not None})
        any_mesh = settings.method != "arc_length"  # which needs the direction of its path
        begin = None if start is None else _equilibrium_state(self, start, anew=True, any_mesh=any_mesh)
        self.check()

        from ..results.equilibrium import Equilibrium  # brings SciPy
        from ..solve.statics.static import equilibrium

        with uninterrupted(), one_blas_thread, enough_memory(), interruptible():
            if settings.adjust is None:
                return equilibrium(in_plane(self), settings, begin, Equilibrium)

            from ..results.targets import reader
            from ..solve.adjustment.adjustment import adjusted

            return adjusted(self, settings, begin, Equilibrium, reader)

    def relax(self, *, tol: float | None = None, max_steps: int | None = None, **unknown: Never) -> Equilibrium:
        """Find a state of rest by dynamic relaxation, a damped motion from the drawn state.

        See `RelaxationSettings` for the defaults.

        For states that no path of equilibria reaches: slack cables that fall into their shape, riders that run to the
        lowest point of a cable or that friction holds, buckled rods, hanging mechanisms. Drawn velocities are omitted.
        The state is like one of `equilibrium`, with the history in ``relaxation``. By default settings are those of the
        scene's file. Raises SceneError for loads and drives that change with time, and for friction that creeps;
        EquilibriumError, which names the largest residual and holds the state.
        """
        _refuse_unknown("relax", unknown, RelaxationSettings.keywords())
        given = {"tol": tol, "max_steps": max_steps}
        settings = RelaxationSettings(**self.relax_settings | {k: v for k, v in given.items() if v is not None})
        self.check()

        from ..checks.whole_scene import check_comes_to_rest
        from ..results.equilibrium import Equilibrium  # brings SciPy
        from ..solve.statics.relaxation import relax

        check_comes_to_rest(self)
        with uninterrupted(), one_blas_thread, enough_memory(), interruptible():
            return relax(in_plane(self), settings, Equilibrium)

    def modes(self, n: int, about: Equilibrium | None = None, *, as_drawn: bool = False, wraps: str = "slip") -> Modes:
        """Return the ``n`` lowest natural frequencies and shapes, about a state of `equilibrium`, or about the drawn
        state if forces balance there.

        as_drawn: also without balance; then joints and slides bear no forces, and a pendulum has 0 Hz. Damping and
        friction are omitted; frequencies below rounding and unstable states are reported, as in `Modes`. wraps: whether
        ropes "slip" without friction on their sheaves, or "stick" to those on which they have friction, which then turn
        with them. Raises SceneError, which names the residual force.
        """
        settings = ModeSettings(n=n, wraps=wraps)
        state = None if about is None else _equilibrium_state(self, about)
        self.check()

        from ..results.modes import Modes  # brings SciPy
        from ..solve.modes.modes import modes

        with uninterrupted(), one_blas_thread, enough_memory(), interruptible():
            return Modes.of(modes(in_plane(self), settings.n, state, as_drawn, settings.wraps == "stick"), self, state)

    def linearise(self, inputs: Sequence[str] = (), outputs: Sequence[str] = (), about: Equilibrium | None = None, *,
                  reduce: int | None = None) -> LinearModel:
        """Return the linear model x' = A x + B u, y = C x + D u of small motions about a state of rest, with damping.

        inputs: paths as in a sweep: "gravity.x", values and scales of loads ("push.value.x"), displacements and
        rotations of motions, drives of joints and slides ("winch.velocity"), velocities of fluids. outputs: names of
        results, of a vector or one of its entries ("A.position.x", "hinge.force", "wire.position.10.y"), and of the
        states of joints and slides ("hinge.angle"). u and y are changes from the state. about: a state of
        `equilibrium`; by default the scene as drawn if forces balance there, else its equilibrium. reduce: the number
        of modes that are kept, the lowest; the others respond to inputs without delay.

        States are joint angles, displacements and s of slides where these determine the motion, else modal coordinates,
        and their rates; constraints are eliminated. Friction that sticks holds its coordinate. Raises SceneError, with
        the residual force of a state that is not at rest, at a kink of forces, for inputs that are none, and for
        outputs that depend on rates of an input; UnknownResultError for unknown outputs.
        """
        given, asked = _names("linearise", "inputs", inputs), _names("linearise", "outputs", outputs)
        settings = LinearSettings(reduce=reduce)
        state = None if about is None else _equilibrium_state(self, about)
        self.check()

        from ..results.linear_model import LinearModel  # brings SciPy
        from ..solve.linearisation.linearise import drawn_in_balance, linearise

        with uninterrupted(), one_blas_thread, enough_memory(), interruptible():
            at_rest = state is not None or drawn_in_balance(self)
        state = state if at_rest else self.equilibrium()
        scene = cast(Scene, state.scene) if state is not None and not at_rest and state.adjusted else self
        with uninterrupted(), one_blas_thread, enough_memory(), interruptible():
            found = linearise(scene, given, asked, state, settings.reduce)
        return LinearModel.of(found, scene, state)

    def animation(self, title: str | None = None) -> Animation:
        """Return pictures of the scene as drawn; see `Viewable.animation`."""
        from ..results.animation.clips import of_scene  # brings SciPy

        return of_scene(self, title or self.title or "scene")

    def overview(self) -> list[tuple[str, str]]:
        """Return the contents of the scene for a notebook; see `Viewable.overview`."""
        found = [("gravity", show(self.gravity, "m/s²"))]
        if self.temperature is not None:
            warm = self.temperature
            found.append(("temperature", f"{warm:g} K" if isinstance(warm, float) else warm.form))
        for kind, names in self._names().items():
            more = f" and {len(names) - MAX_NAMED} more" if len(names) > MAX_NAMED else ""
            found.append((kind, ", ".join(names[:MAX_NAMED]) + more))
        return found + [("note", message) for message in self.messages]


def _refuse_unknown(method: str, unknown: Iterable[str], known: Collection[str]) -> None:
    """Raise SceneError for unknown keywords of a method."""
    for name in unknown:
        meant = SYNONYMS.get(name)
        raise SceneError(method, f'"{name}" is not known here',
                         f'did you mean "{meant}"?' if meant in known else near(name, known))


def _names(method: str, kind: str, given: Any) -> list[str]:
    """Return names given as texts. Raises SceneError for what are none."""
    if isinstance(given, str) or not isinstance(given, Sequence) or not all(isinstance(each, str) for each in given):
        raise SceneError(method, f"{kind} must be a list of names, got {shown(given)}",
                         f'write such as {kind}=["{given}"]' if isinstance(given, str) else None)
    return list(given)


def _check_resume(resume: bool, settings: RunSettings) -> None:
    """Raise SceneError for a resume that is no bool, and ResultFileError without a file to continue."""
    if not isinstance(resume, bool):
        raise SceneError("run", f"resume must be true or false, got {shown(resume)}")
    if resume and settings.save is None:
        raise ResultFileError("run: there is nothing to resume without a file of results; name it with save")


def _at_rest(initial: str, scene: Scene, start: Equilibrium | None) -> Equilibrium:
    """Return the state of rest at the start of a run, by its name in the settings.

    start: a state from which the search begins if it fits, on any mesh. Raises SceneError, EquilibriumError.
    """
    if initial == "relaxed":
        return scene.relax()
    if start is not None and not scene.equilibrium_settings and _fits(scene, start):
        try:
            return scene.equilibrium(start=start)
        except EquilibriumError:  # the path from the drawn state may still succeed
            pass
    state = scene.equilibrium()
    state.check_stable()
    return state


def _fits(scene: Scene, start: Equilibrium) -> bool:
    """Return whether a search for equilibrium can begin at a state."""
    try:
        start.check_fits(scene, any_mesh=True)
    except SceneError:
        return False
    return True


def _state(scene: Scene, given: Equilibrium | Mapping[str, ArrayLike]) -> Start:
    """Return a state to start a run from, checked against the scene. Raises SceneError."""
    from ..model.initial_state import InitialState  # brings SciPy

    if not isinstance(given, Mapping):
        return _equilibrium_state(scene, given)
    state = given if isinstance(given, InitialState) else InitialState(given)
    state.check_fits(scene)
    return state


def _equilibrium_state(scene: Scene, state: Equilibrium, *, anew: bool = False, any_mesh: bool = False) -> Equilibrium:
    """Return a state to start from, checked against the scene.

    anew: of a search, possibly for other adjusted values; any_mesh: also of another mesh.
    """
    from ..results.equilibrium import Equilibrium  # already loaded where a state exists

    if not isinstance(state, Equilibrium):
        raise SceneError("scene", "the state to start from must be one that equilibrium() returned, got "
                         + shown(state))
    state.check_fits(scene, any_mesh)
    if not anew:
        state.check_adjusted(scene)
    return state
