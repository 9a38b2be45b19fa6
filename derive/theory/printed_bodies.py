"""Formulas of bodies and joints, in the plane and in space."""

from __future__ import annotations

from .lift import Lift, only
from .markdown import Line
from .notation.latex import latex
from .printed import rider
from .scopes import Scope, programs_of

OMEGA = r"\widetilde{\boldsymbol{\omega}}"


def _planar(scope: Scope) -> bool:
    return (scope.family.facts.get("dim") or scope.family.dim) == 2


def attitude(scope: Scope) -> list[Line]:
    """Return the axes of a body from its attitude."""
    first = rider(scope)[0]
    return [first, Line(r"\mathbf{A} = \mathbf{A}_{0}")]


def rigid_inertia(scope: Scope) -> list[Line]:
    """Return the inertia force and the kinetic energy of a rigid body."""
    turn = (r"J \dot{\boldsymbol{\omega}}" if _planar(scope) else
            r"\mathbf{J} \dot{\boldsymbol{\omega}} + \boldsymbol{\omega} \times \left( \mathbf{J} "
            r"\boldsymbol{\omega} \right)")
    spin = (r"J \boldsymbol{\omega}^{2}" if _planar(scope) else
            r"\boldsymbol{\omega} \cdot \left( \mathbf{J} \boldsymbol{\omega} \right)")
    return [Line(rf"\mathbf{{f}}_{{a}} = \begin{{bmatrix}} m \ddot{{\mathbf{{R}}}} \\ {turn} \end{{bmatrix}}",
                 output="inertia_force.f"),
            Line(r"T = \frac{1}{2} m \left( \dot{\mathbf{R}} \cdot \dot{\mathbf{R}} \right) + \frac{1}{2} "
                 rf"\left( {spin} \right)", output="kinetic_energy.T")]


def modal_mass(scope: Scope) -> list[Line]:
    """Return M_rr, and the column of a mode in M_rf."""
    if _planar(scope):
        coupling = r"\mathbf{A} \widetilde{1} \mathbf{S}_{0}"
        inertia = r"\operatorname{tr} \left( \mathbf{X}_{0} \right)"
    else:
        coupling = r"-\mathbf{A} \widetilde{\mathbf{S}_{0}}"
        inertia = r"\operatorname{tr} \left( \mathbf{X}_{0} \right) \mathbf{I} - \mathbf{X}_{0}"
    return [Line(rf"\mathbf{{B}} = {coupling}"), Line(rf"\mathbf{{J}} = {inertia}"),
            Line(r"\mathbf{M}_{rr} = \begin{bmatrix} m \mathbf{I} & \mathbf{B} \\ \mathbf{B}^{\mathsf{T}} & \mathbf{J} "
                 r"\end{bmatrix}", output="mass_matrix.M"),
            Line(r"\mathbf{M}_{rf} = \begin{bmatrix} \mathbf{A} \mathbf{s} \\ \operatorname{axial} \left( "
                 r"\mathbf{Y}_{0}^{\mathsf{T}} \right) \end{bmatrix}", output="mode_mass.M")]


def modal_inertia(scope: Scope) -> list[Line]:
    """Return inertia less weight in the rows of the frame and of a mode, and the kinetic energy."""
    force = rf"\mathbf{{W}} \mathbf{{S}}_{{0}} + 2 {OMEGA} \mathbf{{S}}_{{1}} + \mathbf{{S}}_{{2}}"
    turned = (r"\mathbf{X}_{0} \mathbf{W}^{\mathsf{T}} + 2 \mathbf{X}_{1} " + OMEGA
              + r"^{\mathsf{T}} + \mathbf{X}_{2}")
    trace = r"\operatorname{tr} \left( %s \right)"
    mode = " + ".join([r"\mathbf{s} \cdot \mathbf{a}_{0}", trace % r"\mathbf{W} \mathbf{Y}_{0}^{\mathsf{T}}",
                       "2 " + trace % (OMEGA + r" \mathbf{Y}_{1}^{\mathsf{T}}"), trace % r"\mathbf{Y}_{2}"])
    spin = r"\boldsymbol{\omega} \operatorname{axial} \left( \mathbf{X}_{1} \right)" if _planar(scope) else (
        r"\boldsymbol{\omega} \cdot \operatorname{axial} \left( \mathbf{X}_{1} \right)")
    energy = (r"\frac{1}{2} m \left( \mathbf{v} \cdot \mathbf{v} \right) + \frac{1}{2} "
              + trace % (OMEGA + r" \mathbf{X}_{0} " + OMEGA + r"^{\mathsf{T}}")
              + r" + \frac{1}{2} X_{\mathrm{rates}} + \mathbf{v} \cdot \left( " + OMEGA
              + r" \mathbf{S}_{0} + \mathbf{S}_{1} \right) + " + spin)
    return [Line(rf"\mathbf{{f}}_{{r}} = \begin{{bmatrix}} m \left( \ddot{{\mathbf{{R}}}} - \mathbf{{g}} \right) + "
                 rf"\mathbf{{A}} \left( {force} \right) \\ \mathbf{{S}}_{{0}} \times \mathbf{{a}}_{{0}} + "
                 rf"\operatorname{{axial}} \left( {turned} \right) \end{{bmatrix}}", output="inertia_force.f"),
            Line(rf"f_{{f}} = {mode}", output="mode_force.f"),
            Line(r"\mathbf{v} = \mathbf{A}^{\mathsf{T}} \dot{\mathbf{R}}"),
            Line(rf"T = {energy}", output="kinetic_energy.T")]


# --- joints -----------------------------------------------------------------------------------------------------


def turned_axes(scope: Scope) -> list[Line]:
    """Return the axes of both frames after small turns, those that the joint needs."""
    used = {s for line in joint_equations(scope) for s in _axes_in(line.latex)}
    return [Line(rf"\mathbf{{{a}}}_{{{n}}} = \left( \mathbf{{I}} + \widetilde{{\boldsymbol{{\theta}}_{{{n}}}}} \right) "
                 rf"\mathbf{{{a}}}_{{{n}}}^{{0}}") for a, n in sorted(used, key=lambda s: (s[1], s[0]))]


def _axes_in(text: str) -> set[tuple[str, str]]:
    return {(a, n) for a in "xyz" for n in "12" if rf"\mathbf{{{a}}}_{{{n}}}" in text}


def joint_equations(scope: Scope) -> list[Line]:
    """Return the equations of a joint, lifted from the program of its kernel."""
    lift = Lift(only(programs_of(scope.family.name)["force"], "phi"), scope.family.dim or 3)
    lines = [Line(latex(e)) for _, equations in lift.stages() for e in equations]
    phi = next(e for name, e in lift.outputs() if name == "phi")
    return [*lines, Line(rf"\boldsymbol{{\Phi}} = {latex(phi.sides[1])}", output="force.phi")]


def joint_jacobian(scope: Scope) -> list[Line]:
    """Return the derivatives of the equations, and those of the force."""
    by = [r"\mathbf{gap}", r"\boldsymbol{\theta}_{1}", r"\boldsymbol{\theta}_{2}"]
    columns = " & ".join(rf"\frac{{\partial \boldsymbol{{\Phi}}}}{{\partial {q}}}" for q in by)
    return [Line(rf"\mathbf{{J}} = \begin{{bmatrix}} {columns} \end{{bmatrix}}", output="force.J")]


BODY_PRINTERS = {"attitude": attitude, "rigid_inertia": rigid_inertia, "modal_mass": modal_mass,
                 "modal_inertia": modal_inertia, "turned_axes": turned_axes, "joint_equations": joint_equations,
                 "joint_jacobian": joint_jacobian}
