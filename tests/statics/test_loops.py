"""What differs in direction or at points is printed once, and is the same program."""

import numpy as np
import sympy as sp
from funicular.derive.codegen.loops import sections
from funicular.derive.codegen.program import Program


def lines(program: Program) -> str:
    return "\n".join(line for section in sections(program) for line in section.lines)


def vectors(dim: int = 3) -> tuple[Program, np.ndarray]:
    """A program with enough in it that loops are worth their while."""
    program = Program("p", "", "")
    a, b = program.input("a", (dim,), "1", ""), program.input("b", (dim,), "1", "")
    program.stage("vectors")
    c = program.vector("c", a + b)
    return program, program.vector("d", 2 * c - a)


def test_a_vector_is_one_line():
    program, d = vectors()
    program.output("f", d, "1", "")
    assert lines(program).splitlines() == [
        "fu_real c[3], d[3];", "FU_EACH(i, 3, c[i] = a[i] + b[i];)", "FU_EACH(i, 3, d[i] = -a[i] + 2.0*c[i];)",
        "FU_EACH(i, 3, f[i] = d[i];)"]


def test_a_symmetric_block_is_its_upper_half_and_its_diagonal():
    program, d = vectors()
    s = program.define("s", d.dot(d))
    block = np.array([[program.define(f"B_{x}{y}", d[i] * d[j] + (s if i == j else 0)) if i <= j else 0
                       for j, y in enumerate("xyz")] for i, x in enumerate("xyz")])
    program.output("K", np.triu(block) + np.triu(block, 1).T, "1", "")
    text = lines(program)
    assert "FU_UPPER(i, j, 3, B[i][j] = d[i]*d[j];)" in text
    assert "FU_EACH(i, 3, B[i][i] += s;)" in text
    assert "FU_UPPER(i, j, 3, K[3*i + j] = B[i][j]; K[3*j + i] = B[i][j];)" in text, "written on both sides"


def test_components_that_are_not_alike_stay_apart():
    program = Program("p", "", "")
    a = program.input("a", (3,), "1", "")
    program.stage("cross product")
    program.output("f", program.vector("c", np.cross(a, [1, 2, 3])), "1", "")
    assert "FU_" not in lines(program)


def test_points_are_one_block_with_weights_up_and_down():
    program = Program("p", "", "")
    a, w = program.input("a", (5,), "1", ""), program.input("w", (), "1", "")
    program.stage("points")
    weights = [program.define(f"w_{k}", (k + sp.Rational(1, 3)) * w) for k in range(3)]
    total = 0
    strains = [program.define(f"c_{g}", a[g] - w) for g in range(5)]
    for g in range(5):
        x = program.define(f"x_{g}", 1 / (strains[g] * w + 1))
        y = program.define(f"y_{g}", x * weights[min(g, 4 - g)])
        z = program.define(f"z_{g}", x * y + w)
        total = total + program.define(f"u_{g}", y * z)
    program.output("f", [total], "1", "")
    text = lines(program)
    assert """FU_EACH(g, 5,
    x[g] = 1.0/(c[g]*w + 1.0);
    y[g] = w_at[g < 2 ? g : 4 - g]*x[g];
    z[g] = w + x[g]*y[g];
    u[g] = y[g]*z[g];)""" in text
    assert "f[0] = u[0] + u[1] + u[2] + u[3] + u[4];" in text
