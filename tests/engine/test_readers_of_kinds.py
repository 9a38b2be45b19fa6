"""The places that read the couplings of one kind, of a model or of a scene: the list to go through for a new kind.

All other code loops over `Model.couplings`, `COUPLINGS` or `scene.parts()`. A new place asks all couplings
(model/coupling.py) or all parts, or enters a table here with the property of its kind that it reads.
"""

import re
from pathlib import Path

import funicular
from funicular.checks.placement import WATCHABLE
from funicular.model.controlled import COUNTED
from funicular.model.coupling import CouplingModel
from funicular.model.kinds import COUPLINGS
from funicular.model.model import Model
from funicular.parts.kinds import KINDS

RUNTIME = Path(funicular.__file__).parent
PLACES = {
    "a slide has an arc-length, and attachments may be on it": [
        "model/border.py", "model/controlled.py", "model/initial_state.py", "results/recording.py",
        "results/resume_facts.py", "solve/motion/event_handler.py", "solve/notes/coarse_slides.py",
        "solve/notes/uncontrolled_errors.py", "solve/statics/relaxation.py", "solve/statics/rest_state.py",
        "solve/statics/static_problem.py"],
    "coordinates of slides and joints as states of a linear model, contact that a search for rest has resolved": [
        "solve/linearisation/equations.py", "solve/linearisation/linearise.py", "solve/linearisation/names.py"],
    "joints close loops, in which equations are redundant; their ends and angles are prescribed": [
        "model/redundant_constraints.py", "solve/adjustment/change.py", "solve/notes/sensitivity.py",
        "solve/statics/turns.py"],
    "the force of a joint, which presses on its friction": ["solve/notes/creep.py"],
    "accelerations of pieces of a cable, whose tangents joints keep parallel": [
        "results/section_forces/nodal_forces.py"],
    "an instant or a frequency of fluids: their signals, tables and added mass": [
        "model/drag_forces.py", "model/breakpoints.py", "results/section_forces/balance_limits.py",
        "solve/motion/inputs.py", "solve/statics/string_start.py"],
    "forces of branches and working curves within elements, which a balance does not know": [
        "results/section_forces/balance_limits.py"],
    "highest strains of ropes in a state": ["model/initial_state.py"],
    "highest strains stay as they are in a search for rest": ["solve/statics/relaxation.py"],
    "contact with surfaces: depth, ends of the surface, what a cable lies on": [
        "solve/linear/condensation.py", "solve/modes/contact_edges.py", "solve/notes/penetrations.py",
        "solve/notes/surface_ends.py", "solve/notes/coarse_contact.py", "solve/statics/lying.py",
        "solve/statics/string_start.py"],
    "derivatives of a state of rest by what a part is given; others are differenced": [
        "solve/adjustment/length_changes.py", "solve/adjustment/load_changes.py",
        "solve/adjustment/parameter_search.py"],
    "ropes: their points on sheaves, and the constraints there": [
        "model/rope_rates.py", "model/rope_states.py", "solve/modes/stuck_wraps.py",
        "results/section_forces/ropes.py", "solve/motion/integrator_choice.py", "solve/statics/held_wraps.py",
        "solve/statics/ropes_at_rest.py", "solve/statics/sticking_ropes.py"],
    "points that must not coincide, as a force or a distance has no direction there": [
        "solve/notes/coincident_points.py"],
    "fleet angles, against what sheaves in space take": ["solve/notes/fleet_angles.py"],
    "compression of ropes beside sheaves that they have left": ["solve/notes/slack_ropes.py"],
    "results that are more than the outputs, and how a kind acts on a cable": [
        "model/part_states.py", "results/section_forces/cable_loads.py"],
    "what the integrator \"energy\" cannot do beside couplings without step equations": [
        "solve/motion/integrator_choice.py"],
}


SCENE_PLACES = {
    "friction": [
        "choice/indicators.py", "results/rope_tensions.py", "solve/linearisation/linearise.py", "solve/modes/modes.py",
        "solve/motion/integrator_choice.py",
        "solve/notes/creep.py", "solve/notes/uncontrolled_errors.py", "solve/statics/static.py",
        "solve/statics/sticking_ropes.py"],
    "points that move along a cable: slides and crossings": [
        "choice/chooser.py", "choice/probes.py", "results/animation/curves.py", "results/animation/references.py",
        "results/animation/sources.py", "results/charts.py", "results/section_forces/forces.py",
        "results/trajectories.py", "solve/motion/event_handler.py", "solve/motion/run.py",
        "solve/notes/coarse_slides.py", "solve/notes/diagnosis.py", "solve/notes/supersonic_loads.py"],
    "loads and flows at a point or along a cable": [
        "choice/candidates.py", "choice/planar.py", "choice/remeshing.py", "results/section_forces/cable_loads.py",
        "solve/motion/stopping_distance.py"],
    "connections of bodies by joints": [
        "solve/notes/coarse_meshes.py", "solve/notes/coincident_points.py", "solve/notes/sensitivity.py",
        "solve/statics/turns.py"],
    "joints that are coordinates, and parts with kinks of their forces": [
        "solve/linearisation/names.py", "solve/linearisation/outputs.py"],
    "surfaces, and depths below them": [
        "solve/notes/penetrations.py", "solve/notes/surface_ends.py", "solve/notes/coarse_contact.py",
        "solve/statics/lying.py", "solve/statics/string_start.py"],
    "pictures of each kind": ["results/animation/marks.py"],
    "ropes: their pictures, their meshes, places on them, forces in their sections": [
        "choice/motion.py", "export/scene_image.py", "parts/locations.py", "results/animation/clips.py",
        "results/animation/frames.py",
        "results/animation/ropes.py", "results/error_estimate.py", "results/pictures.py",
        "results/section_forces/ropes.py"],
    "forces of supports, as the ends of ropes have them": ["results/targets.py"],
    "ropes, and friction, stops and frames of slides, which the linear model does not have": [
        "solve/motion/linear_model.py"],
    "parameters that are adjusted": [
        "solve/adjustment/adjustment.py", "solve/adjustment/length_changes.py",
        "solve/adjustment/parameter_changes.py", "solve/adjustment/parameter_search.py",
        "solve/adjustment/parameters.py"],
    "working curves: their forces in sections and highest strains, and what they exclude": [
        "results/section_forces/balance_limits.py", "results/section_forces/forces.py",
        "solve/motion/linear_model.py"],
    "branches: their forces in sections, and springs that are stretched in a state": [
        "results/run.py", "results/section_forces/balance_limits.py", "results/section_forces/forces.py"],
    "the plane of a scene: quantities that events watch": ["parts/in_plane.py"],
}
"""Places that read a group of couplings of a scene, by what they read; one module a kind in model/ and checks/, and
applications, know their kinds by definition."""
OWN_MODULES = ("model/", "checks/", "guides/", "bench/", "cosserat_bench/", "catenary/")
FRICTION = {"slide", "joint", "crossing", "contact"}
"""Kinds of parts with friction, which the places under "friction" know."""
ALONG_CABLES = {"slide", "crossing", "contact"}
"""Types of couplings that act at places of a cable that move, which the places under "points that move" know; contact
and its hard form act along the whole cable and ask for nothing there."""


def kinds_of_model():
    """Return the names of the properties of a model that hold the couplings of one kind, but for the loads."""
    return [name for name, value in vars(Model).items() if hasattr(value, "func") and name != "loads"]


def readers(pattern):
    """Return the modules, relative to the package, whose text has a pattern outside of imports."""
    return {path.relative_to(RUNTIME).as_posix() for path in RUNTIME.rglob("*.py")
            if re.search(pattern, re.sub(r"^from .*$", "", path.read_text(), flags=re.MULTILINE))}


def check_readers(found, table):
    known = {place for places in table.values() for place in places}
    new = sorted(found - known)
    assert not new, f"{new}: let these ask all couplings or parts, or add them to the table with what they read"
    assert not known - found, f"{sorted(known - found)} read no kind any more: take them from the table"


def test_places_that_read_one_kind_of_a_model_are_known():
    check_readers(readers(rf"\b_?model\.({'|'.join(kinds_of_model())})\b(?! import)"), PLACES)


def test_places_that_read_one_kind_of_a_scene_are_known():
    groups = {kind.group for kind in COUPLINGS}
    found = readers(rf"\bscene\.(as_drawn\.)?({'|'.join(groups)})\b")
    check_readers({place for place in found if not place.startswith(OWN_MODULES)}, SCENE_PLACES)


def test_kinds_with_friction_are_those_that_the_readers_know():
    found = {kind.kind for kind in KINDS if "friction" in kind.model_fields}
    assert found == FRICTION, f"{found ^ FRICTION}: check {SCENE_PLACES['friction']}"


def test_couplings_along_cables_are_those_that_the_readers_know():
    places = SCENE_PLACES["points that move along a cable: slides and crossings"]
    found = {kind.name for kind in COUPLINGS if "along" in vars(models_of(kind.name))}
    assert found == ALONG_CABLES, f"{found ^ ALONG_CABLES}: check {places}"


def models_of(name):
    """Return the class of the models of a kind: `slide` is `SlideModel`."""
    wanted = name.replace("_", " ").title().replace(" ", "") + "Model"
    return next(each for each in descendants(CouplingModel) if each.__name__ == wanted)


def descendants(kind):
    return {kind}.union(*(descendants(each) for each in kind.__subclasses__()))


def test_every_kind_of_part_is_exported():
    missing = [kind.__name__ for kind in KINDS if kind.__name__ not in funicular.__all__]
    assert not missing, f"{missing}: runtime/__init__.py exports the names of parts/listed.py"


def test_kinds_with_coordinates_have_error_estimates_and_thresholds():
    kinds = {kind.kind for kind in KINDS if kind.group in ("cables", "bodies", "slides")}
    assert kinds == {*COUNTED}, f"{kinds ^ {*COUNTED}}: COUNTED of runtime/model/controlled.py"
    assert kinds == {*WATCHABLE}, f"{kinds ^ {*WATCHABLE}}: WATCHABLE of runtime/checks/placement.py"
