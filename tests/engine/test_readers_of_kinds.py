"""The places that read the couplings of one kind of a model: what a new kind should be compared with.

All else loops over `Model.couplings` or `COUPLINGS`. A place that is not in the table either asks the coupling
(model/coupling.py), or says here what it knows of its kind that others have not.
"""

import re
from pathlib import Path

import funicular
from funicular.model.model import Model

RUNTIME = Path(funicular.__file__).parent
PLACES = {
    "a slide has an arc-length, and attachments may be on it": [
        "model/border.py", "model/controlled.py", "model/initial_state.py", "results/recording.py",
        "results/resume_facts.py", "solve/motion/event_watcher.py", "solve/notes/coarse_slides.py",
        "solve/notes/normal_forces.py", "solve/statics/relaxation.py", "solve/statics/rest_state.py",
        "solve/statics/static_problem.py"],
    "joints close loops, in which equations are redundant; their ends and angles are prescribed": [
        "model/loops.py", "model/redundant_constraints.py", "solve/adjustment/change.py", "solve/notes/sensitivity.py",
        "solve/statics/turns.py"],
    "an instant or a frequency of fluids: their signals, tables and added mass": [
        "model/drag_forces.py", "model/knots.py", "results/section_forces/balance_limits.py",
        "solve/statics/string_loads.py"],
    "contact with surfaces: depth, ends of the surface, what a cable lies on": [
        "solve/linear/condensation.py", "solve/modes/contact_edges.py", "solve/notes/penetrations.py",
        "solve/notes/surface_ends.py", "solve/notes/unseen_contact.py", "solve/statics/lying.py",
        "solve/statics/string_start.py"],
    "derivatives of a state of rest by what a part is given; others are differenced": [
        "solve/adjustment/length_changes.py", "solve/adjustment/load_changes.py",
        "solve/adjustment/parameter_search.py"],
    "points that must not coincide, as a force or a distance has no direction there": [
        "solve/notes/coincident_points.py"],
    "results that are more than the outputs, and how a kind acts on a cable": [
        "model/part_states.py", "results/section_forces/cable_loads.py"],
    "what the integrator \"energy\" cannot do beside couplings without step equations": [
        "solve/motion/integrator_choice.py"],
}


def kinds_of_model():
    """Return the names of the properties of a model that hold the couplings of one kind, but for the loads."""
    return [name for name, value in vars(Model).items() if hasattr(value, "func") and name != "loads"]


def test_places_that_read_one_kind_are_known():
    pattern = re.compile(rf"\b_?model\.({'|'.join(kinds_of_model())})\b(?! import)")
    found = {path.relative_to(RUNTIME).as_posix() for path in RUNTIME.rglob("*.py")
             if pattern.search(re.sub(r"^from .*$", "", path.read_text(), flags=re.MULTILINE))}
    known = {place for places in PLACES.values() for place in places}
    new = sorted(found - known)
    assert not new, f"{new}: let these ask the coupling, or add them to PLACES with what they know of its kind"
    assert not known - found, f"{sorted(known - found)} read no kind any more: take them from PLACES"
