"""Forces between two points: a new law needs a spec and a part."""

import math
from dataclasses import replace

import funicular as fu
import mpmath
import numpy as np
import pytest
import sympy as sp
from funicular.derive.codegen import rendering
from funicular.derive.couplings.point_law import families_of
from funicular.derive.couplings.point_laws import LAWS
from funicular.derive.spec import PointLaw
from funicular.derive.verify.command import prepare, uncovered, verify
from funicular.derive.verify.exact import DIGITS
from funicular.derive.verify.report import Report
from funicular.generated import kernels
from funicular.kernels.elements import manifest, point_law
from funicular.parts.kinds import KINDS
from funicular.parts.point_force import PointForce
from numpy.testing import assert_allclose
from pages import page

GAP, RATE = np.array([0.3, -0.4, 1.2]), np.array([0.7, 0.2, -0.5])
KINDS_OF_FORCE = [kind for kind in KINDS if issubclass(kind, PointForce)]


def magnet(damped: bool = False) -> PointLaw:
    """Return the law of derive/README.md, or a law of the distance with a damper along the gap."""
    space: dict = {}
    exec(page("derive/README.md").of("A force between two points", "python")[0], space)
    law = space["LAW"]
    return law if not damped else replace(
        law, parameters=law.parameters | {"damping": ("N s/m", "along the gap")}, damping="damping",
        measures=lambda p, gap, c: [p.define("distance", sp.sqrt(gap.dot(gap)))],
        energy=lambda p, e, c: -c.strength * p.define("inv_sum", 1 / (e[0] + c.radius)))


def verified(family, folder, broken=("", "")):
    """Derive a law into a folder, change its text, and return the findings of the verification."""
    made = rendering.derive(replace(family, modules=("couplings.point_law",)))
    for name, text in rendering.render([made], [family.name], lambda _: None).items():
        assert name != f"{family.name}.c" or broken[0] in text
        (folder / name).write_text(text.replace(*broken) if broken[0] and name == f"{family.name}.c" else text)
    report = Report()
    with mpmath.workdps(DIGITS):
        subject = prepare(family, folder, folder)
        report.missing(uncovered(family, subject.programs))
        for item in verify(subject):
            report.add(family.name, item)
    return report


@pytest.mark.parametrize("damped", [False, True])
@pytest.mark.parametrize("dim", [3, 2])
@pytest.mark.slow_cases("2-True", "3-False")
def test_a_new_law_is_derived_and_verified_by_its_spec_alone(tmp_path, damped, dim):
    family = next(family for family in families_of("magnet", magnet(damped)) if family.dim == dim)
    report = verified(family, tmp_path)
    assert report.failures == 0, report.first_failure
    assert {f.kernel.removeprefix(family.name + "_") for f in report.findings} == {
        "energy", "force", "tangent", "discrete_force", *(["dissipation"] if damped else [])}


def test_a_wrong_sign_is_found(tmp_path):
    family, _ = families_of("magnet", magnet())
    report = verified(family, tmp_path, ("f[0] = tension", "f[0] = -tension"))
    failed = {f.kernel for f in report.findings if f.failed}
    assert failed == {"magnet_force", "magnet_tangent", "magnet_discrete_force"}


def test_a_law_that_knows_directions_is_found(tmp_path):
    law = replace(magnet(), energy=lambda p, gap, c: c.strength * gap[0] ** 2 + c.radius * gap[1] ** 2)
    _, planar = families_of("magnet", law)
    report = verified(planar, tmp_path)
    broken = {text for _, text, error, ceiling in report.invariances if not error <= ceiling}
    assert broken >= {"energy turns with the gap", "force turns with the gap", "no moment on the pair of points"}


def test_a_damper_without_its_parameter_is_refused():
    with pytest.raises(ValueError, match='the damper\'s parameter "drag" is not among strength, radius'):
        replace(magnet(), damping="drag")


@pytest.mark.parametrize("energy", [lambda p, gap, c: sp.sin(gap.dot(gap)) * c.strength,
                                    lambda p, gap, c: sp.Piecewise((gap.dot(gap), c.radius < gap.dot(gap)), (0, True))])
def test_an_energy_without_a_discrete_gradient_is_refused(energy):
    family, _ = families_of("magnet", replace(magnet(), energy=energy))
    with pytest.raises(ValueError, match="a discrete gradient goes through sums, products, quot"):
        family.build()


def test_springs_follow_their_formula():
    stiffness, damping, length = 5.3, 0.7, 0.4
    distance = np.linalg.norm(GAP)
    unit = GAP / distance
    tension = stiffness * (distance - length) + damping * unit @ RATE
    assert_allclose(kernels.spring_force([stiffness, damping, length], GAP, RATE), tension * unit, rtol=1e-14)
    assert_allclose(kernels.spring_energy([stiffness, damping, length], GAP),
                    stiffness * (distance - length) ** 2 / 2, rtol=1e-14)
    assert_allclose(kernels.spring_dissipation([stiffness, damping, length], GAP, RATE), damping * (unit @ RATE) ** 2,
                    rtol=1e-14)
    assert_allclose(kernels.zero_length_spring_force([stiffness, damping], GAP, RATE), stiffness * GAP + damping * RATE,
                    rtol=1e-14)
    met = kernels.zero_length_spring_force([stiffness, damping], 0 * GAP, RATE)
    assert_allclose(met, damping * RATE, rtol=1e-14)


def complete(kind, **given):
    """Return a part of a kind with ones for its required fields."""
    needed = {name: 1.0 for name, field in kind.model_fields.items() if field.is_required() and name not in "ab"}
    if kind is fu.parts.spring.Spring:
        needed["stiffness"] = 1.0  # or a table, so that the field by itself is not required
    return kind(a="A", b=(0, 1, 0), **needed | given).at_distance(1.0)


@pytest.mark.parametrize("part", [*map(complete, KINDS_OF_FORCE), complete(fu.parts.spring.Spring, length=0)],
                         ids=lambda part: part.law)
def test_parts_have_the_parameters_of_their_laws_in_the_same_units(part):
    spatial, planar = (point_law(prefix + part.law) for prefix in ("", "planar_"))
    assert spatial == planar
    for name, unit in spatial.parameters.items():
        assert isinstance(getattr(part, name), float)
        with pytest.raises(fu.SceneError, match=rf"{name} must be finite, got inf {unit.replace('^2', '²')}$"):
            complete(type(part), **{name: math.inf})


def test_every_law_is_that_of_a_part():
    parts = {complete(kind).law for kind in KINDS_OF_FORCE} | {"zero_length_spring", "spring_segment"}
    assert parts == set(LAWS)
    assert set(manifest()["point_laws"]) == {prefix + law for law in LAWS for prefix in ("", "planar_")}


def test_a_law_without_kernels_is_refused():
    with pytest.raises(ValueError, match='no kernels of a point law "magnetism": write its spec in derive/couplings'):
        point_law("magnetism")
