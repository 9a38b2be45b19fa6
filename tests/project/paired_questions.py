"""Questions to a scene, a run, an equilibrium and modes, each as a function of a scene."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable, Hashable
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import funicular as fu
import jsonschema
import numpy as np
import pytest
from covering import Level
from funicular.results import streaming
from funicular.results.equilibrium import Equilibrium
from funicular.scene.file import loads
from funicular.scene.schema import scene_schema
from interrupted_runs import Killed, failing
from matplotlib import pyplot
from packed_runs import expected, image, opened, rows
from paired_scenes import TIME

VALIDATOR = jsonschema.Draft7Validator(scene_schema())


@dataclass
class Asked:
    """A scene, the integrator of its runs, a folder for files, and the levels of the scene."""

    scene: fu.Scene
    integrator: str
    folder: Path
    levels: frozenset[Level]

    def new_run(self, **settings) -> fu.Run:
        """Return a run after a check that all numbers are finite."""
        run = self.scene.run(integrator=self.integrator, progress=False, **settings)
        finite(run)
        return run

    def run(self) -> fu.Run:
        """Return the run by the settings of the scene, computed once for equal scenes and integrators."""
        return once((self.levels, self.integrator), self.new_run)

    def equilibrium(self) -> Equilibrium:
        """Return the equilibrium, computed once for equal scenes."""
        return once(self.levels, self.scene.equilibrium)


FOUND: dict[Hashable, Any] = {}
"""Runs and states of rest of scenes by their levels, or why there is none."""


def once(key: Hashable, compute: Callable[[], Any]) -> Any:
    """Return what is computed, or raise its error again, computed once for each key."""
    if key not in FOUND:
        try:
            FOUND[key] = compute()
        except fu.FunicularError as error:
            FOUND[key] = error
    if isinstance(found := FOUND[key], fu.FunicularError):
        raise found
    return found


def finite(found) -> None:
    """Check that all arrays of a result are finite; arc-lengths and positions may be NaN without contact."""
    for name in found.keys():
        if name.rpartition(".")[2] not in ("first", "last", "s", "s_b", "gap"):
            assert np.isfinite(found[name]).all(), f"{name} is not finite"


def same(one: fu.Run, other: fu.Run) -> None:
    """Check that two runs have the same bits."""
    assert list(one.keys()) == list(other.keys())
    for name in one.keys():
        assert np.array_equal(one[name], other[name], equal_nan=True), f"{name} differs"


def data(toml: str) -> str:
    """Return a scene file without the comment on the lost function of an event."""
    return re.sub(r'# event "\w+" watches a function, .*\n\n', "", toml)


def drawn(figure) -> None:
    """Close a figure."""
    assert figure.axes
    pyplot.close(figure)


# ---- runs

def motion(on: Asked) -> None:
    run = on.run()
    assert run.status in ("completed", "event")
    assert run.summary() and run.overview() and run.dataset.sizes["time"] == len(run.time)
    run.energy_balance()


def fixed_steps(on: Asked) -> None:
    on.scene.run_settings.pop("tol")
    on.new_run(step=TIME / (1000 if on.integrator == "explicit" else 300))


def from_rest(on: Asked) -> None:
    on.equilibrium()  # raises the error of a scene without one, which is sought once for all questions
    on.new_run(initial="equilibrium")


def from_relaxed(on: Asked) -> None:
    on.scene.relax_settings = {"max_steps": 3000}
    on.new_run(initial="relaxed")


def from_another_run(on: Asked) -> None:
    run = on.run()
    on.scene.run(integrator=on.integrator, progress=False, initial=run.at(float(run.time[-1])))


def from_arrays(on: Asked) -> None:
    vectors = on.scene.cables["wire"].nodal_vectors
    on.new_run(initial={"wire.nodal_vectors": vectors, "wire.nodal_velocity": 0 * vectors})


def named_quantities(on: Asked) -> None:
    on.new_run(quantities=["wire.position.y"])


def on_threads(on: Asked) -> None:
    same(on.new_run(threads=2), on.run())


def many(on: Asked) -> None:
    run = on.run()
    (other,) = fu.run_many([on.scene], integrator=run.report["integrator"])
    if isinstance(other, fu.FunicularError):
        raise other
    fu.combine([run, other], mass=[1.0, 2.0])


def errors(on: Asked) -> None:
    run = on.new_run(estimate=True)
    assert "errors" in run.report or any("errors are not estimated" in text for text in run.report["messages"])


def saved(on: Asked) -> None:
    run, path = on.run(), on.folder / "run.nc"
    run.save(path)
    loaded = fu.load_run(path)
    same(loaded, run)
    assert loaded.scene.to_toml() == data(run.scene_toml)
    loaded.section_forces("wire")


def resumed(on: Asked) -> None:
    """Kill a run near its third row, and resume it."""
    settings = {"integrator": on.integrator, "save": on.folder / "resumed.nc", "output_step": TIME / 8}
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(streaming, "CHECKPOINT_INTERVAL", -1.0)
        failing(patch, 15, Killed())
        with suppress(Killed):  # an event may end it before
            on.scene.run(**settings, progress=False)
    same(on.scene.run(**settings, resume=True, progress=False), on.new_run(output_step=TIME / 8))


# ---- results and pictures

def stepped(on: Asked) -> None:
    """Step a scene as its run does, return to a state in between, and go on."""
    run, sim = on.run(), on.scene.simulation(integrator=on.integrator)
    for k in range(1, min(3, len(run.time))):
        kept = sim.state
        sim.step()
        sim.state = kept
        sim.step()
        assert sim.time == run.time[k]
        for name, values in run.items():
            assert sim[name].tobytes() == values[k].tobytes(), name


def packed(on: Asked) -> None:
    """Write a scene as a program, and run its packed scene here: the rows are those of the run, up to the rounding of
    LAPACK.
    """
    run = on.run()
    on.scene.export_c(on.folder / "program", integrator=on.integrator)
    made = opened(image(on.scene, integrator=on.integrator))
    found, wanted = rows(made), expected(run, [name for name, _ in made.values()])
    assert found.shape == wanted.shape
    assert np.abs(found - wanted).max() <= 1e-6 * (1 + np.abs(wanted).max())


def forces_in_sections(on: Asked) -> None:
    run = on.run()
    for name in on.scene.cables:
        for method in ("constitutive", "balance"):
            forces = run.section_forces(name, method=method)
            assert np.isfinite(forces["tension"]).all()
        run.slack_elements(name)


def forces_at_a_slide(on: Asked) -> None:
    """Return section forces at a slide, or along the cable in a scene without slides."""
    run = on.run()
    for slide in on.scene.slides.values():
        run.section_forces(slide.along, slide)
    if not on.scene.slides:
        run.section_forces("wire")


def page_of_run(on: Asked) -> None:
    run = on.run()
    assert run.save_html(on.folder / "run.html", run).stat().st_size > 1000


def plots_of_run(on: Asked) -> None:
    assert on.run().save_plots(on.folder, forces=True)


def film_of_run(on: Asked) -> None:
    assert on.run().save_video(on.folder / "run.gif", speed=TIME / 0.1, colour="tension").stat().st_size > 1000


def files_for_paraview(on: Asked) -> None:
    assert list(on.run().save_vtk(on.folder / "vtk").iterdir() if (on.folder / "vtk").is_dir() else [1])


def picture_of_run(on: Asked) -> None:
    assert on.run().save_png(on.folder / "run.png").stat().st_size > 1000


def page_of_scene(on: Asked) -> None:
    on.scene.save_html(on.folder / "scene.html")
    assert on.scene.overview()


def plots(on: Asked) -> None:
    """Draw the scene, its equilibrium and its modes."""
    drawn(on.scene.plot())
    state = on.equilibrium()
    drawn(state.plot())
    drawn(on.scene.modes(2, about=state).plot())


# ---- statics and modes

def rest(on: Asked) -> None:
    found = on.equilibrium()
    finite(found)
    assert found.overview()


def forces_at_rest(on: Asked) -> None:
    found = on.equilibrium()
    for name in on.scene.cables:
        for method in ("constitutive", "balance"):
            assert np.isfinite(found.section_forces(name, method=method)["tension"]).all()
        found.slack_elements(name)


def page_of_rest(on: Asked) -> None:
    on.equilibrium().save_html(on.folder / "rest.html")


def load_path(on: Asked) -> None:
    found = on.scene.equilibrium(method="arc_length", largest_step=0.5)
    found.load_path.save_html(on.folder / "path.html")
    finite(found)


def loads_in_steps(on: Asked) -> None:
    finite(on.scene.equilibrium(load_steps=2, start=on.equilibrium()))


def relaxed(on: Asked) -> None:
    finite(on.scene.relax(max_steps=3000))


def adjusted(on: Asked) -> None:
    """Change the density of the cable until a node lies a little lower."""
    path, node = "wire.material.density", 1
    s = float(on.scene.cables["wire"].mesh.node_s[node])
    height = float(on.equilibrium()["wire.position"][node, 1]) - 1e-4
    found = on.scene.equilibrium(adjust=[path], to={f"wire@{s!r}.position.y": height})
    assert path in found.adjusted


def modes_at_rest(on: Asked) -> None:
    found = on.scene.modes(3, about=on.equilibrium())
    assert np.isfinite(found.frequency).all() and found.overview()


def modes_as_drawn(on: Asked) -> None:
    found = on.scene.modes(3, as_drawn=True)
    assert np.isfinite(found.frequency).all()
    found.save_html(on.folder / "modes.html")


def linear_models(on: Asked) -> None:
    """All that loads or drives the scene acts on positions and forces of its parts."""
    scene = on.scene
    inputs = ["gravity.x", *(f"{name}.value.y" for name in scene.loads),
              *(f"{name}.velocity.x" for name in scene.fluids)]
    inputs += [f"{part.name}.{drive}" for part in (*scene.joints.values(), *scene.slides.values())
               for drive in ("angle", "distance", "drive", "velocity") if getattr(part, drive, None) is not None]
    inputs += [f"{motion.label}.displacement.y" for motion in scene.motions
               if motion.displacement is not None and motion.displacement[1] is not None]
    names = [name for name, values in on.equilibrium().items() if values.shape == (3,) and name.endswith(
        (".position", ".force", ".velocity")) and np.isfinite(values).all()]
    found = scene.linearise(inputs, [] if scene.joints or scene.slides else names, on.equilibrium())
    for matrix in (found.A, found.B, found.C, found.D, found.poles, found.response(1.234)):
        assert np.isfinite(matrix).all()
    assert len(found.states) == len(found.state_units) == len(found.A)


# ---- scenes

def text(on: Asked) -> None:
    toml = on.scene.to_toml()
    assert loads(toml, "copy").to_toml() == data(toml)


def schema(on: Asked) -> None:
    VALIDATOR.validate(tomllib.loads(on.scene.to_toml()))


def replaced(on: Asked) -> None:
    other = on.scene.replace("wire", material=fu.Material(youngs_modulus=2e7, poisson_ratio=0.0, density=900))
    other.run(integrator=on.integrator, progress=False)


def without_a_part(on: Asked) -> None:
    """Remove the rider of the cable, or a joint or a support in a scene without riders."""
    part, *_ = (*on.scene.slides.values(), *on.scene.joints.values(), *on.scene.pins)
    on.scene.without(part).run(integrator=on.integrator, progress=False)


def remeshed(on: Asked) -> None:
    finer = on.scene.remeshed(lambda cable: 2 * cable.elements)
    finer.run(integrator=on.integrator, progress=False)


def chosen(on: Asked) -> None:
    assert on.scene.choose(tol=0.1, integrator=on.integrator).reasons


def swept(on: Asked) -> None:
    fu.sweep(on.scene, {"wire.material.density": [900.0, 1100.0]}, keep=["wire.position.y"], workers=0,
             integrator=on.integrator)


QUESTIONS: dict[str, Callable[[Asked], None]] = {question.__name__: question for question in (
    motion, fixed_steps, from_rest, from_relaxed, from_another_run, from_arrays, named_quantities, on_threads, many,
    errors, saved, resumed, stepped, packed, forces_in_sections, forces_at_a_slide, page_of_run, plots_of_run,
    film_of_run, files_for_paraview, picture_of_run, page_of_scene, plots, rest, forces_at_rest, page_of_rest,
    load_path, loads_in_steps, relaxed, adjusted, modes_at_rest, modes_as_drawn, linear_models, text, schema,
    replaced, without_a_part, remeshed, chosen, swept)}
