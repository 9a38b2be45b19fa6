"""Every pair of a feature of a scene and a question works, or is refused before any work.

The factors are those of `paired_scenes.py`, the integrators and the questions of `paired_questions.py`. A slow test
covers all pairs of levels with the quick questions; the default run asks some of them at every level, and the others of
every element. A pair works if a row with it gives finite numbers without a RuntimeWarning.
"""

import inspect
import re
import tempfile
import warnings
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from functools import cache
from pathlib import Path

import funicular as fu
import matplotlib
import paired_questions
import pytest
from covering import CoveringArray, Level, Row, all_pairs, smallest
from funicular.integrators import AUTO, INTEGRATORS
from funicular.parts.end_stops import STOPS as ALL_STOPS
from funicular.parts.flow_profile import PROFILES as ALL_PROFILES
from funicular.parts.kinds import PARTS
from funicular.parts.section import SECTIONS as ALL_SECTIONS
from funicular.parts.signal import SIGNALS as ALL_SIGNALS
from funicular.parts.solids import SOLIDS as ALL_SOLIDS
from funicular.parts.surface_shapes import SURFACE_SHAPES
from funicular.results.equilibrium import Equilibrium
from funicular.results.modes import Modes
from funicular.results.run import Run
from funicular.solve.statics import static
from paired_questions import QUESTIONS, Asked
from paired_scenes import FACTORS, PROFILES, SECTIONS, SIGNALS, SOLIDS, STOPS, SURFACES, build, laws

PICTURES = ("plots", "plots_of_run", "film_of_run", "picture_of_run", "page_of_run", "page_of_scene", "page_of_rest",
            "files_for_paraview")
SEARCHES = ("adjusted", "errors", "from_another_run", "loads_in_steps", "modes_as_drawn", "load_path", "relaxed",
            "from_relaxed", "swept")
"""Questions that take long: pictures; searches with many steps, several runs or states of rest of a scene."""
QUICK = [question for question in QUESTIONS if question not in (*PICTURES, *SEARCHES)]
BROAD = ("motion", "saved", "forces_in_sections", "rest", "modes_at_rest", "text")
"""Quick questions through which the results of all others go."""
MIN_LOAD_STEP = 0.1
"""Load steps below this fraction are not taken: each halving of them takes seconds in scenes that are too difficult."""

EVERY = FACTORS | {"integrator": [AUTO, *INTEGRATORS]}
NEUTRAL = {factor: levels if factor == "element" else levels[:1] for factor, levels in EVERY.items()}

NOT_ASKED = {
    "add", "add_pairs", "animation", "as_drawn", "attachments", "check", "events", "replaced", "start", "summary_rows",
    "changed", "check_name", "check_stable", "fluids_of", "copied", "dim", "drawn", "free_name", "free_names",
    "from_toml", "group", "libraries", "masses_on", "part_named", "parts", "plane", "plane_axes", "put", "rubbing",
    "supports", "touching", "with_parts",  # what the methods above are made of
    "from_recording", "items", "line", "model", "of", "route_of", "sketch", "view",
    "adjustment", "check_adjusted", "check_fits", "check_supports", "heading", "neutral_directions", "relaxation",
    "rope_tensions", "stable", "unstable_directions", "about"}
"""Methods of scenes and results that no question calls by name: parts of those that are called, or plain data."""

WORKS, REFUSED, TOLD = "", "refused", "told"
FREE = "runs round freely"
"""What the error says where a closed rope has no state of rest without friction."""


@pytest.fixture(autouse=True)
def few_load_steps(monkeypatch):
    monkeypatch.setattr(static, "MIN_LOAD_STEP", MIN_LOAD_STEP)


@contextmanager
def strict() -> Iterator[None]:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", fu.FunicularWarning)
        warnings.simplefilter("error", RuntimeWarning)
        yield


def outcome(row: Row) -> str:
    """Return the outcome of a row: accepted, refused, or an error that must not occur."""
    with tempfile.TemporaryDirectory() as place, strict():
        try:
            scene = build(row, Path(place))
            if "question" in row:
                levels = frozenset((factor, level) for factor, level in row.items() if factor in FACTORS)
                QUESTIONS[row["question"]](Asked(scene, row["integrator"], Path(place), levels))
            else:
                _begin(scene, row["integrator"]) if is_picky(row) else scene.check()
        except fu.EquilibriumError as error:
            return f"{TOLD}: {error}"
        except fu.ConvergenceError as error:
            told = "energy grew without a source" in str(error) and "is too large" in str(error)
            return f"{TOLD if told else type(error).__name__}: {error}"
        except fu.EndOfCableError as error:
            return f"{type(error).__name__}: {error}"
        except fu.FunicularError as error:
            return f"{REFUSED}: {error}"
        except Exception as error:
            return f"{type(error).__name__}: {error}"
    return WORKS


def _begin(scene: fu.Scene, integrator: str) -> None:
    scene.run(1e-6, output_step=1e-6, integrator=integrator, progress=False)


def is_picky(row: Row) -> bool:
    """Return whether the integrator of a row refuses some scenes."""
    return row["integrator"] == "energy"


def same(one: str, other: str) -> bool:
    """Return whether two outcomes have one cause: errors of one kind, and refusals at one part of the scene."""
    parts = 2 if one.startswith(REFUSED) else 1
    return one.split(":")[:parts] == other.split(":")[:parts]


TOLD_SHARE, TOLD_SHARES = 0.05, {"from_relaxed": 0.4}
"""How many rows may find no equilibrium, of those that work: a damped motion of 3,000 steps does not bring 7 of 26
scenes with slack ropes and released beams to rest, nor do 10,000 steps.
"""

GUESSES = 4
"""How many sets of factors are tried before all levels of a row are left out one by one."""

CAUSES: dict[frozenset[Level], str] = {}
"""Smallest sets of levels that were found so far, of any question, with the errors that they end in."""


def _known(row: Row, found: str) -> frozenset[Level] | None:
    """Return a set of levels in a row that has led to the same refusal before."""
    if not found.startswith(REFUSED):
        return None
    return next((levels for levels, error in CAUSES.items() if error == found and levels <= row.items()), None)


def _guesses(found: str) -> list[frozenset[str]]:
    """Return sets of factors that led to an error of the same cause, the most frequent first, up to `GUESSES`."""
    return [factors for factors, _ in Counter(frozenset(dict(levels)) for levels, error in CAUSES.items()
                                              if same(error, found)).most_common(GUESSES)]


def answered(array: CoveringArray, neutral: dict[str, list[str]],
             most_told: float = TOLD_SHARE) -> dict[frozenset[Level], str]:
    """Answer all rows of an array; return the errors by minimal set of levels.

    A few rows may find no equilibrium, where the scene is too difficult and not the combination. A belt without
    friction has none.
    """
    errors, counts = {}, Counter()
    for row in array.rows():
        found = outcome(row)
        counts["free" if FREE in found else found.partition(":")[0]] += 1
        if found == WORKS or found.startswith(TOLD):
            array.worked(row)
        else:
            levels = _known(row, found) or smallest(row, neutral, lambda row: same(found, outcome(row)),  # noqa: B023
                                                    _guesses(found))
            CAUSES[levels] = found
            array.refuse(levels)
            if not found.startswith(REFUSED):
                errors[levels] = found
    assert counts[TOLD] <= 1 + most_told * counts[WORKS], counts
    return errors


@cache
def descriptions() -> tuple[CoveringArray, dict[frozenset[Level], str]]:
    """Return the array of all scenes and integrators, described and checked, with the errors that occur.

    Pairs of element and law that the project does not offer are excluded.
    """
    array = CoveringArray(EVERY)
    for element, of in laws().items():
        for law in set(FACTORS["law"]) - {"default", *of}:
            array.refuse(frozenset({("element", element), ("law", law)}))
    return array, answered(array, NEUTRAL)


def asked(questions: Sequence[str], of: Sequence[str] | None = None) -> dict[frozenset[Level], str]:
    """Return the errors of questions for all pairs of levels, or for those of the question with some factors."""
    factors = EVERY | {"question": list(questions)}
    array = CoveringArray(factors, [pair for pair in all_pairs(factors)
                                    if of is None or {factor for factor, _ in pair} - set(of) == {"question"}])
    for levels in descriptions()[0].refused:
        array.refuse(levels)
    most_told = max(TOLD_SHARES.get(question, TOLD_SHARE) for question in questions)
    errors = answered(array, NEUTRAL | {"question": questions[:1]}, most_told)
    assert frozenset() not in array.refused, "it is never answered"
    return errors


def told(errors: dict[frozenset[Level], str]) -> str:
    return "\n".join(f"{dict(levels)}: {error}" for levels, error in errors.items())


def test_scenes_are_described_or_refused():
    array, errors = descriptions()
    assert not errors, told(errors)
    assert min(map(len, array.refused)) == 2


def check_with_each_level(question: str) -> None:
    matplotlib.use("Agg")
    errors = asked([question], of=list(EVERY))
    assert not errors, told(errors)


@pytest.mark.parametrize("question", BROAD)
def test_each_question_with_each_level(question):
    check_with_each_level(question)


def test_every_quick_question_of_every_element():
    errors = asked([question for question in QUICK if question not in BROAD], of=["element"])
    assert not errors, told(errors)


@pytest.mark.slow
@pytest.mark.usefixtures("quick_pictures")
class TestPictures:
    """A class is tested beside others of its file, by another process."""

    @pytest.mark.parametrize("question", PICTURES)
    def test_each_with_each_level(self, question):
        check_with_each_level(question)


@pytest.mark.slow
class TestSearches:
    @pytest.mark.parametrize("question", SEARCHES)
    def test_each_with_each_level(self, question):
        check_with_each_level(question)


@pytest.mark.slow
class TestAll:
    def test_every_pair(self):
        errors = asked(QUICK)
        assert not errors, told(errors)


def test_every_kind_in_the_lists_of_the_project_is_here():
    """A new kind needs a value in `paired_scenes.py`; laws, elements, joints and integrators enter through their
    lists.
    """
    for here, there in ((SECTIONS, ALL_SECTIONS), (SIGNALS, ALL_SIGNALS), (SOLIDS, ALL_SOLIDS),
                        (PROFILES, ALL_PROFILES), (STOPS, ALL_STOPS), (SURFACES, SURFACE_SHAPES)):
        assert here.keys() == there.by_tag.keys()


def test_every_kind_of_part_is_in_some_scene(tmp_path):
    neutral, kinds = {factor: levels[0] for factor, levels in EVERY.items()}, set()
    for factor, levels in FACTORS.items():
        for level in levels:
            with strict(), suppress(fu.FunicularError):  # of another element
                kinds |= {part.kind for part in build(neutral | {factor: level}, tmp_path).parts()}
    assert kinds == PARTS.keys()


def test_every_method_of_a_scene_and_its_results_is_asked():
    methods = {name for kind in (fu.Scene, Run, Equilibrium, Modes) for name in dir(kind)
               if not name.startswith("_") and callable(getattr(kind, name))}
    names = set(re.findall(r"\.(\w+)", inspect.getsource(paired_questions)))
    assert methods - names - PARTS.keys() - NOT_ASKED == set()
