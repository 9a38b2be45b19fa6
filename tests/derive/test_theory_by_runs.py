"""Chapters without kernels, hard contact and catenaries: their formulas, read from the texts, against runs, equilibria
and functions of the package.
"""

import funicular as fu
import numpy as np
import pytest
from funicular import catenary
from funicular.catenary.local_sag import missing_compliance
from funicular.derive.theory.document import text_of
from funicular.derive.theory.markdown import blocks
from funicular.derive.theory.notation.evaluate import Definitions, Evaluation
from funicular.derive.theory.notation.parse import parse
from funicular.derive.theory.notation.tree import Equation
from test_catenary import X, line55
from test_jointed_pantograph import DEFAULT


def formulas(chapter):
    """Return the formulas of a chapter by their left sides."""
    return {line.latex.split(" = ")[0]: parse(line.latex)
            for block in blocks(text_of(chapter)) if block.kind == "formula" for line in block.lines}


def value(chapter, name, /, among=(), **values):
    """Return the value of the right side of a formula; `among` holds the other definitions of the chapter."""
    found, definitions = formulas(chapter), Definitions()
    for other in among:
        assert isinstance(found[other], Equation)
        definitions.add(found[other])
    columns = {key: np.array(each, dtype=object).reshape(-1, 1) if np.ndim(each) == 1 else each
               for key, each in values.items()}
    result = Evaluation(definitions, columns | {"pi": np.pi})(found[name].sides[-1])
    return result.astype(float) if isinstance(result, np.ndarray) else float(result)


HARD = "couplings/hard_contact"
CATENARY = "theory/catenary"
RADIUS, MASS, INERTIA, RESTITUTION = 0.1, 1.3, 4e-3, 0.7


def struck(friction, spin):
    """Return a run of a spinning ball with a horizontal speed that falls on level ground, up to its first impact."""
    scene = fu.Scene(gravity=(0, -9.81, 0))
    scene.surface("ground", fu.Plane())
    scene.rigid_body("ball", mass=MASS, inertia=(INERTIA,) * 3, position=(0, 0.6, 0), velocity=(2, 0, 0),
                     angular_velocity=(0, 0, spin))
    scene.contact("ball", "ground", restitution=RESTITUTION, friction=friction, radius=RADIUS, name="foot")
    return scene.run(duration=0.4, tol=1e-8, output_step=0.01, progress=False)


@pytest.mark.parametrize(("friction", "spin"), [(0.25, -30.0), (0.25, 60.0), (0.9, 0.0)])
def test_an_impact_of_a_ball(friction, spin):
    run = struck(friction, spin)
    fall = -np.sqrt(2 * 9.81 * 0.5)
    G = value(HARD, "G", m=MASS)
    tangential = value(HARD, "G_{t}", m=MASS, rho=RADIUS, J=INERTIA)
    p = value(HARD, "p", varepsilon=RESTITUTION, u_1=fall, G=G)
    u = value(HARD, r"\mathbf{u}_{2}", **{"!u_1": fall, "!G": G, "!p": p})
    assert u == pytest.approx(value(HARD, "u_{3}", varepsilon=RESTITUTION, u_1=fall), rel=1e-14)
    w = 2.0 + RADIUS * spin  # of the lowest point
    slides = {"w_1": abs(w), "mu": friction, "p": p, "G_t": tangential}
    p_t = value(HARD, "p_{t}", **slides)
    after = np.sign(w) * value(HARD, "w_{2}", among=["p_{t}"], **slides)
    k = int(np.argmax(run["ball.velocity"][:, 1] > 0))
    assert run["ball.velocity"][k, 0] == pytest.approx(2.0 - np.sign(w) * p_t / MASS, rel=1e-7)
    assert run["ball.angular_velocity"][k, 2] == pytest.approx(spin - np.sign(w) * RADIUS * p_t / INERTIA, rel=1e-7)
    assert run["ball.velocity"][k, 1] == pytest.approx(u - 9.81 * (run.time[k] - np.sqrt(2 * 0.5 / 9.81)), rel=1e-6)
    speeds = run["ball.velocity"][k, 0] + RADIUS * run["ball.angular_velocity"][k, 2]
    assert speeds == pytest.approx(after, abs=1e-7)
    lost = (value(HARD, "E_{1}", varepsilon=RESTITUTION, u_1=fall, G=G)
            + value(HARD, "E_{2}", among=["p_{t}", "w_{2}"], **slides))
    assert run["energy.dissipated"][k] == pytest.approx(lost, rel=1e-6)
    assert value(HARD, "E", **{"!p": [p], "!u_1": [fall], "!u_2": [u]}) == pytest.approx(
        value(HARD, "E_{1}", varepsilon=RESTITUTION, u_1=fall, G=G), rel=1e-14)


def test_forces_of_droppers_on_strings():
    line = line55()
    depths, force = line.droppers.depths, line.strings.forces
    x = [0.0, *X, 55.0]
    slopes = [0.0, *(value(CATENARY, "s_{k}", **{"d_k+1": depths[k + 1], "d_k": depths[k], "x_k+1": X[k + 1],
                                                 "x_k": X[k]}) for k in range(8)), 0.0]
    for k in range(9):
        ends = x[k] - x[k + 1] if k == 0 else x[k], 2 * 55.0 - x[k + 1] if k == 8 else x[k + 2]
        found = value(CATENARY, "F_{k}", **{"m": 1.35, "m_c": 0.165, "g": 9.81, "T": 22e3, "s_k": slopes[k + 1],
                                            "s_k-1": slopes[k], "x_k+1": ends[1], "x_k-1": ends[0]})
        assert found == pytest.approx(force[k], rel=1e-12)


def test_height_of_the_messenger_on_strings():
    line = line55()
    strings, x = line.strings, 21.75
    loads = {f"P_{k + 1}": strings.forces[k] + 9.81 * (0.195 + 0.117 * strings.distances[k]) for k in range(9)}
    shares = {f"N_{k + 1}": x * (55 - at) / 55 if x < at else at * (55 - x) / 55 for k, at in enumerate(X)}
    found = value(CATENARY, "y", n=9.0, T_1=16e3, w=9.81 * 1.08, x=x, L=55.0, **loads, **shares)
    assert line.height + found == pytest.approx(strings.heights[3], rel=1e-6)


def test_arms_of_staggers():
    form = catenary.form(line55(2, stagger=0.2), (0.25, 0.5))
    found = value(CATENARY, "F_{a}", among=["l"], B=179.0, T=22e3, a=0.2, L=55.0)
    assert -catenary.scene(form).equilibrium()["steady_arm_1.force"][2] == pytest.approx(found, rel=1e-3)


def test_what_elements_leave_of_a_dent():
    nodes, at, bending, tension = np.linspace(0, 40, 401), 20.03, 195.0, 20e3
    fine = {"T": tension, "B": bending, "x": at, "L": 40.0}
    exact = value(CATENARY, "c", among=["l"], **fine)
    missing = missing_compliance(tension, bending, nodes[::10], np.array([at]))[0]
    assert missing == pytest.approx(0.03 * 1.0 / tension, rel=0.5)  # the rule of thumb of the text
    shapes, stiffness = np.array([0.5]), (exact - missing) * 4  # any pair that gives way as elements do
    assert value(CATENARY, "c_{m}", among=["l", "c", "c_{h}"], **fine,
                 **{"!s": shapes, "!K": np.array([[1 / stiffness]])}) == pytest.approx(missing, rel=1e-9)
    assert value(CATENARY, "k_{m}", k=1e5, c_m=missing) == pytest.approx(1 / (1e-5 + missing), rel=1e-14)
    assert abs(missing_compliance(tension, bending, nodes, np.array([at]))[0]) < 1e-2 * missing  # as long as the dent


def test_force_and_mass_of_a_pantograph():
    moving = {}
    for k, (body, (_, speed, rate)) in enumerate(DEFAULT.places().items(), start=1):
        limb = getattr(DEFAULT, body)
        moving |= {f"m_{k}": limb.mass, f"J_{k}": limb.inertia, f"!v_{k}": speed, f"v_{k}": float(speed[1]),
                   f"omega_{k}": rate}
    moving |= {"n": 5.0, "v": float(DEFAULT.rates()[1]), "M": DEFAULT.moment_at(), "g": 9.81}
    assert value(CATENARY, "F_{0}", **moving) == pytest.approx(DEFAULT.static_force(), rel=1e-13)
    moving["m_1"] = DEFAULT.lower.mass
    whole = value(CATENARY, "m_{2}", **moving) + DEFAULT.lower.mass
    assert whole - DEFAULT.collector.mass == pytest.approx(DEFAULT.equivalent().masses[1], rel=1e-13)


def test_the_filter_and_the_statistics():
    step, at = 0.004, {"f_0": 20.0, "t_s": 0.004}
    time = np.arange(2500) * step
    for frequency in (5.0, 20.0, 40.0):
        passed = catenary.low_pass(np.cos(2 * np.pi * frequency * time), step)[500:2000]
        gain = value(CATENARY, "A", among=["q", "q_{0}"], f=frequency, **at)
        measured = np.hypot(*(2 * np.mean(passed * wave(2 * np.pi * frequency * time[500:2000]))
                              for wave in (np.cos, np.sin)))
        assert measured == pytest.approx(gain, rel=2e-3, abs=1e-6)
    assert value(CATENARY, "A", among=["q", "q_{0}"], f=20.0, **at) == pytest.approx(np.sqrt(0.5), rel=1e-14)
    force = np.random.default_rng(0).uniform(50, 150, 40)
    given = {"n": 40.0, **{f"F_{k + 1}": f for k, f in enumerate(force)}}
    mean = value(CATENARY, "F_{m}", **given)
    sigma = value(CATENARY, r"\sigma", F_m=mean, **given)
    assert (mean, sigma) == pytest.approx((force.mean(), force.std()), rel=1e-13)
    extremes = [value(CATENARY, rf"F_{{\mathrm{{{each}}}}}", F_m=mean, sigma=sigma) for each in ("max", "min")]
    assert extremes == pytest.approx([mean + 3 * sigma, mean - 3 * sigma], rel=1e-14)
