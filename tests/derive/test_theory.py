"""The theory agrees with the kernels: formulas are read from the emitted text, evaluated and compared.

The slide on one cable and the page of one element are quick. The whole document and the pages of all families are slow.
"""

import itertools
import json
import re
import shutil
import subprocess
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from funicular.cli.main import app
from funicular.derive.catalogue import families
from funicular.derive.elements import ELEMENTS
from funicular.derive.theory import check, command, contents, pages, proofs
from funicular.derive.theory.document import evaluate, unused
from funicular.derive.theory.html import equations, html
from funicular.derive.theory.markdown import blocks
from funicular.derive.theory.notation.evaluate import Definitions, Evaluation
from funicular.derive.theory.notation.latex import display, latex
from funicular.derive.theory.notation.mathml import mathml, to_latex
from funicular.derive.theory.notation.parse import FormulaError, parse
from funicular.derive.theory.scopes import programs_of
from funicular.derive.theory.tex import tex
from typer.testing import CliRunner
from validation import recorded

TOP = Path(__file__).parents[2]
SLIDE = "slide_cable12_point"


@pytest.fixture(scope="module")
def slide():
    """Return the document of a slide, measured, with its texts."""
    made = contents.page(SLIDE)
    check.measure(made)
    return made, html(made), tex(made)


# --- from end to end --------------------------------------------------------------------------------------------


def test_formulas_of_the_slide_read_back_from_both_texts_are_the_kernels(slide):
    made, page, source = slide
    assert check.faults(made, page, source) == []
    measured = {f.kernel: f.deviation for _, f in made.formulas() if f.kernel}
    outputs = {(kernel, a.name) for kernel in ("constraint", "terms", "residual", "tangent")
               for a in programs_of(SLIDE)[kernel].outputs} - {("constraint", "C_s"), ("constraint", "s_step"),
                                                               ("terms", "C")}
    assert measured.keys() == outputs, "every output of the slide's kernels stands in the chapter"
    assert max(measured.values()) < 1e-12


def test_every_definition_is_needed_by_a_formula_that_is_compared(slide):
    assert unused(slide[0]) == []


@pytest.mark.parametrize(("text", "wrong", "output"), [
    ('<mo form="infix">+</mo>', f'<mo form="infix">{chr(0x2212)}</mo>', "terms.H"),
    ("<mn>3</mn>", "<mn>4</mn>", "N"),
])
def test_a_changed_formula_is_found(slide, text, wrong, output):
    made, page, source = slide
    name = next(f.identifier for _, f in made.formulas() if f.line.output == output
                or (output == "N" and f.line.latex.startswith("N_{1}")))
    formula = re.search(rf'<math id="{name}".*?</math>', page).group()
    assert text in formula
    changed = page.replace(formula, formula.replace(text, wrong, 1))
    assert any("not the same formula" in fault for fault in check.faults(made, changed, source))
    trees = check.read_html(changed)
    found = evaluate(made, trees)
    off = {f.line.output for _, f in made.formulas() if found.get(f.identifier, 0) > 1e-6}
    assert off >= ({output} if output != "N" else {"constraint.C", "terms.H", "residual.phi"})


def test_a_formula_that_is_missing_from_a_text_is_found(slide):
    made, page, source = slide
    first = next(f.identifier for _, f in made.formulas())
    faults = check.faults(made, page.replace(f'<math id="{first}"', "<math"), source.replace(f"% {first}\n", ""))
    assert faults == [f"{first} is missing from the page", f"{first} is missing from the LaTeX"]


@pytest.mark.parametrize("name", ["cable8p", "cable8p_green_linear"])
def test_the_chapters_of_an_element_agree_with_its_kernels(name):
    made = contents.page(name)
    check.measure(made)
    assert check.faults(made, html(made), tex(made)) == []
    assert unused(made) == []


def test_the_command_writes_a_page_and_says_that_it_agrees(tmp_path):
    result = CliRunner().invoke(app, ["theory", "planar_spring", "-o", str(tmp_path / "new")])
    assert result.exit_code == 0, result.output
    assert "every formula agrees with the kernels" in result.output
    assert {p.name for p in (tmp_path / "new").iterdir()} == {"planar_spring.html", "planar_spring.tex"}


def test_an_unknown_name_is_refused_with_near_ones(tmp_path):
    result = CliRunner().invoke(app, ["theory", "cable21", "-o", str(tmp_path)])
    assert result.exit_code == 1
    assert "cable12" in result.stderr
    assert list(tmp_path.iterdir()) == []


# --- the texts --------------------------------------------------------------------------------------------------


def test_the_page_stands_alone_and_its_links_lead_somewhere(slide):
    stands_alone(slide[1])


def stands_alone(page: str) -> None:
    root = ElementTree.fromstring(page.removeprefix("<!DOCTYPE html>"))
    names = [e.get("id") for e in root.iter() if e.get("id")]
    assert len(names) == len(set(names))
    links = [e.get("href") for e in root.iter("a")]
    assert links
    assert {link[1:] for link in links if link.startswith("#")} <= set(names)
    assert not {e.tag for e in root.iter()} & {"script", "link", "img", "iframe"}
    assert not re.search(r"@import|url\(|src=", page)


def test_the_latex_has_its_braces_and_environments_in_pairs_and_no_unknown_command(slide):
    structurally_sound(slide[2])


KNOWN = set("""
documentclass usepackage setlength setcounter newcommand newsavebox sbox noindent begin end hspace ifdim wd linewidth
resizebox usebox else fi hfill par smallskip footnotesize raggedright allowdisplaybreaks emergencystretch title author
date maketitle tableofcontents section subsection subsubsection paragraph texttt textbf emph allowbreak item hline
newenvironment is wrap shown trace formulabox displaystyle left right frac sqrt sum int partial mathbf mathrm mathsf
boldsymbol widetilde operatorname dot ddot bar hat cdot times otimes to lvert rvert prime ast text quad textbackslash
textasciitilde textasciicircum textless textgreater textsuperscript circ surd parindent parskip dots href alpha beta
gamma delta varepsilon zeta eta theta kappa lambda mu nu xi pi rho sigma tau phi varphi chi psi omega Gamma Delta
Theta Lambda Xi Pi Sigma Phi Psi Omega le ge pm
""".split())


def structurally_sound(source: str) -> None:
    plain = re.sub(r"(?<!\\)%.*", "", source.replace("\\\\", " "))
    depth = list(itertools.accumulate({"{": 1, "}": -1}[c] for c in re.findall(r"(?<!\\)[{}]", plain)))
    assert min(depth) >= 0
    assert depth[-1] == 0
    open_ones = []
    for kind, name in re.findall(r"\\(begin|end)\{(\w+)\}", plain.split("\\newenvironment")[1].split("\n", 1)[1]):
        if kind == "begin":
            open_ones.append(name)
        else:
            assert open_ones.pop() == name
    assert open_ones == []
    assert set(re.findall(r"\\([a-zA-Z]+)", plain)) <= KNOWN
    assert source.isascii()


def test_a_letter_that_latex_does_not_have_is_refused():
    with pytest.raises(ValueError, match="no LaTeX for ☃"):
        tex(contents.Composer("☃", "").document)


# --- numbers ----------------------------------------------------------------------------------------------------


def test_the_motion_decides_the_sign_of_eq_34():
    numbers = proofs.sign_of_34().numbers
    assert abs(numbers["differences"] - numbers["right"]) < 1e-7
    assert abs(numbers["differences"] - numbers["print"]) > 1


def test_eq_16_as_printed_gives_no_unit_vector():
    numbers = proofs.length_of_16().numbers
    assert numbers["printed 2"] < 0.7
    assert abs(numbers["here 2"] - 1) < 1e-15


def test_published_axial_masses_are_15_times_too_large():
    assert list(proofs.axial_mass().numbers.values()) == pytest.approx([15.0] * 3)


def test_accelerations_jump_at_nodes_of_cubic_cables_alone():
    numbers = proofs.jump_at_node().numbers
    assert numbers["cable12 W"] > 1
    assert max(numbers["cable12 H"], numbers["cable18 H"], numbers["cable18 W"]) < 1e-13


def test_figures_of_elements_are_those_of_the_benchmarks():
    table = json.loads((TOP / "derive/theory/cases.json").read_text(encoding="utf-8"))
    laws = ("cable12 engineering_exact", "cable18 engineering_exact", "beam24 continuum", "beam24 poisson_split",
            "beam24 structural")
    for case, (_, *cells) in zip(table["cases"], table["published"], strict=True):
        for law, text in zip(laws, cells, strict=True):
            of = [row for row in recorded() if row["variant"] == law and row["case"].startswith(case)]
            if found := re.match(r"([\d.e-]+)", text):
                worst = max(of, key=lambda row: row["error"])
                digits = len(found[1].partition("e")[0].replace(".", "").lstrip("0")) - 1
                assert float(found[1]) == float(f"{worst['error']:.{digits}e}"), f"{case}, {law}"
                mesh = re.match(r".*? \((\d+)\)(?:, ([\d.]+))?", text)
                assert mesh is None or worst["mesh"].startswith(f"{mesh[1]} elements"), f"{case}, {law}"
                order = re.search(r"order ([\d.]+)", worst["mesh"])
                assert mesh is None or not mesh[2] or float(mesh[2]) == pytest.approx(float(order[1]), abs=0.5)
    assert {row[0] for row in table["published"]} >= set(pages.PLANAR_CASES)


@pytest.mark.parametrize("element", sorted(ELEMENTS))
def test_each_element_has_its_figures_and_a_text(element):
    head, *rows = pages.figures(element)
    assert len(head) > 1
    assert len(rows) >= 5
    titles = [b.text for b in blocks((TOP / f"derive/elements/{element}.md").read_text(encoding="utf-8"))
              if b.kind == "heading"]
    assert titles == ["What it is", "Take it", "It cannot"]


# --- notation ---------------------------------------------------------------------------------------------------

FORMULAS = [
    r"\mathbf{C} = \mathbf{A}_{t}^{\mathsf{T}} \mathbf{r}_{p}",
    r"\mathbf{Q}_{k} = -\left( \frac{\partial U}{\partial \mathbf{e}} \right)^{\mathsf{T}}",
    r"\mathbf{m} = \int_{V} \rho \mathbf{N} \mathbf{N}^{\mathsf{T}} \, \mathrm{d} V",
    r"\lvert \mathbf{r}_{g}^{\prime} \rvert = \begin{cases} x & x < \frac{1}{4} \\ y & \text{else} \end{cases}",
    r"x = \operatorname{sin} \left( \xi_{r,x1} + \mathrm{inv}_{C,sl} \right) + \sum_{k = 1}^{n} N_{k} \mathbf{e}_{k}",
    r"\mathbf{C}^{\ast} = \left. \mathbf{C} \right|_{\mathbf{e} \to \mathbf{e} + t \mathbf{v}, s \to s + t \dot{s}}",
    r"\boldsymbol{\omega} = \frac{\mathrm{d}^{2} \boldsymbol{\theta}_{0}}{\mathrm{d} t^{2}} \times \widetilde{q}",
    r"\mathbf{y} = \left( \mathbf{I} + \widetilde{\boldsymbol{\theta}}_{1,0} \right) \mathrm{arm} \; \mathrm{inv}_{l}",
    r"\mathbf{x}_{1}^{0} = \mathbf{J}^{-1} \otimes \begin{bmatrix} 1 & -2.5 \\ \ddot{c} & 10^{12} \end{bmatrix}",
]


@pytest.mark.parametrize("text", FORMULAS)
def test_formulas_survive_both_texts(text):
    tree = parse(text)
    assert parse(latex(tree)) == tree
    assert parse(to_latex(mathml(tree))) == tree


def test_a_long_sum_goes_over_lines_and_is_read_back_as_one():
    terms = [rf"\mathbf{{c}}_{{{k}}} \left( a_{{{k}}} - b_{{{k}}} \right)" for k in range(40)]
    tree = parse(rf"\mathbf{{f}} = {' - '.join(terms)}")
    assert display(tree).count(r"\wrap") > 2
    assert parse(display(tree)) == tree
    assert parse(to_latex(mathml(tree))) == tree


@pytest.mark.parametrize("text", [r"\frac{1}{2", r"x = ", r"x + \left( y", r"\snow x", r"\begin{bmatrix} 1 & 2"])
def test_what_is_no_formula_is_refused(text):
    with pytest.raises(FormulaError):
        parse(text)


def value(text: str, **values) -> np.ndarray:
    """Return the value of a formula; x and y are numbers, v and w vectors."""
    known = {f"!{k}" if np.ndim(v) else k: np.array(v, dtype=object)[:, None] if np.ndim(v) else v
             for k, v in values.items()}
    found = Evaluation(Definitions(), known)(parse(text))
    return np.array(found, dtype=float)


def test_derivatives_of_formulas_nest():
    x, y = 0.7, 1.3
    assert value(r"\frac{\partial^{2} \left( x^{3} y \right)}{\partial x^{2}}", x=x, y=y) == pytest.approx(6 * x * y)
    mixed = r"\frac{\partial \left( \frac{\partial \left( \operatorname{sin} \left( x y \right) \right)}{\partial y} " \
            r"\right)}{\partial x}"
    assert value(mixed, x=x, y=y) == pytest.approx(np.cos(x * y) - x * y * np.sin(x * y))
    root = value(r"\frac{\partial \sqrt{x}}{\partial x}".replace(r"\sqrt{x}", r"\left( \sqrt{x} \right)"), x=x)
    assert root == pytest.approx(0.5 / np.sqrt(x))
    v, w = [1.0, 2.0, -0.5], [0.3, -1.0, 2.0]
    assert np.allclose(value(r"\frac{\partial \left( \mathbf{v} \times \mathbf{w} \right)}{\partial \mathbf{w}}", v=v,
                             w=w), [[0, 0.5, 2], [-0.5, 0, -1], [-2, 1, 0]])
    unit = r"\frac{\partial \left( \lvert \mathbf{v} \rvert \right)}{\partial \mathbf{v}}"
    assert np.allclose(value(unit, v=v), np.array([v]) / np.linalg.norm(v))


def test_what_nothing_defines_is_named():
    with pytest.raises(LookupError, match="nothing defines y"):
        value("x + y", x=1.0)


# --- everything -------------------------------------------------------------------------------------------------


@pytest.mark.slow
def test_the_whole_theory_is_complete_and_its_texts_are_sound():
    """The test of the site builds the same texts and compares their formulas with the kernels."""
    made = command.document(command.WHOLE)
    assert unused(made) == []
    assert list(equations(made)) == list(range(1, 39)), "every equation of the paper, and no other"
    page = html(made)
    stands_alone(page)
    structurally_sound(tex(made))
    assert "generated/beam24_continuum.c:0" not in page, "every kernel is found in its file"


@pytest.mark.slow
@pytest.mark.parametrize("name", {family.role: name for name, family in families().items()}.values())
def test_the_page_of_a_family_of_each_role_agrees_with_its_kernels(name, tmp_path):
    """The whole theory goes over all families."""
    _, faults = command.build(name, tmp_path)
    assert faults == []


@pytest.mark.slow
@pytest.mark.skipif(not shutil.which("pdflatex"), reason="no pdflatex (Debian: texlive-latex-recommended)")
@pytest.mark.parametrize("name", ["theory", "cable12"])
def test_the_latex_compiles(name, tmp_path):
    command.build(name, tmp_path)
    for _ in range(2):  # the second run has the table of contents
        done = subprocess.run(["pdflatex", "-interaction=nonstopmode", "-halt-on-error", f"{name}.tex"], cwd=tmp_path,
                              capture_output=True, text=True, errors="replace", check=False)
        assert done.returncode == 0, done.stdout[-2000:]
    assert (tmp_path / f"{name}.pdf").stat().st_size > 100_000


@pytest.mark.parametrize("e", [0.3, np.float64(0.3), np.array([[0.3]]), np.array([[0.3]], dtype=object)])
@pytest.mark.parametrize("text", [r"\frac{1}{2} e^{2} \boldsymbol{\kappa}", r"\frac{e^{2}}{2} \boldsymbol{\kappa}",
                                  r"\frac{1}{2} \boldsymbol{\kappa} e^{2}", r"e \frac{1}{2} e \boldsymbol{\kappa}"])
def test_powers_in_products(text, e):
    """A power belongs to the letter before it, in the text and in its printed form."""
    kappa = np.array([[2.0], [-3.0]], dtype=object)
    tree = parse(text)
    for each in (tree, parse(latex(tree)), parse(to_latex(mathml(tree)))):
        found = Evaluation(Definitions(), {"e": e, "!kappa": kappa})(each)
        assert found.ravel().tolist() == pytest.approx([0.09, -0.135], rel=1e-15)
    slope = parse(rf"\frac{{\partial \left( {text} \right)}}{{\partial e}}")
    moved = Evaluation(Definitions(), {"e": 0.3, "!kappa": kappa})(slope)
    assert moved.ravel().tolist() == pytest.approx([0.6, -0.9], rel=1e-15)


@pytest.mark.parametrize(("text", "says"), [(r"\mathbf{A}^{2}", "no power 2 of a matrix of 2 by 2"),
                                            (r"\mathbf{v}^{2}", "no power 2 of a matrix of 2 by 1"),
                                            (r"\mathbf{v}^{-1}", "no power -1 of a matrix of 2 by 1")])
def test_powers_of_matrices_are_inverses_or_none(text, says):
    values = {"!A": np.array([[2.0, 1.0], [0.0, 4.0]]), "!v": np.array([[1.0], [2.0]])}
    with pytest.raises(TypeError, match=says):
        Evaluation(Definitions(), values)(parse(text))
    inverse = Evaluation(Definitions(), values)(parse(r"\mathbf{A}^{-1}"))
    assert inverse.astype(float) == pytest.approx(np.linalg.inv(values["!A"]))
