"""Formulas of bodies and joints, in the plane and in space."""

from __future__ import annotations

from ..codegen.family import PointLawFamily
from .lift import Lift, only
from .markdown import Line
from .notation.latex import latex
from .printed import moved_along, rider, starred
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


# --- frames -----------------------------------------------------------------------------------------------------


def frame_axes(scope: Scope) -> list[Line]:
    """Return the axes of the frame of two vectors."""
    first = Line(r"\mathbf{i} = \frac{\mathbf{a}}{\lvert \mathbf{a} \rvert}")
    if _planar(scope):
        return [first, Line(r"\mathbf{j} = 1 \times \mathbf{i}"),
                Line(r"\mathbf{A} = \begin{bmatrix} \mathbf{i} & \mathbf{j} \end{bmatrix}", output="axes.A")]
    across = r"\mathbf{i} \times \mathbf{b}"
    return [first, Line(rf"\mathbf{{k}} = \frac{{{across}}}{{\lvert {across} \rvert}}"),
            Line(r"\mathbf{j} = \mathbf{k} \times \mathbf{i}"),
            Line(r"\mathbf{A} = \begin{bmatrix} \mathbf{i} & \mathbf{j} & \mathbf{k} \end{bmatrix}", output="axes.A")]


def frame_turn(scope: Scope) -> list[Line]:
    """Return the turn of the frame by the entries of both vectors."""
    def by(axis: str, vector: str) -> str:
        return rf"\frac{{\partial \mathbf{{{axis}}}}}{{\partial \mathbf{{{vector}}}}}"

    if _planar(scope):
        row = " & ".join(rf"\mathbf{{j}}^{{\mathsf{{T}}}} {by('i', v)}" for v in "ab")
        return [Line(rf"\mathbf{{T}} = \begin{{bmatrix}} {row} \end{{bmatrix}}", output="axes.T")]
    parts = [" + ".join(rf"\widetilde{{\mathbf{{{axis}}}}} {by(axis, v)}" for axis in "ijk") for v in "ab"]
    lines = [Line(rf"\mathbf{{T}}_{{{v}}} = \frac{{1}}{{2}} \left( {part} \right)")
             for v, part in zip("ab", parts, strict=True)]
    return [*lines, Line(r"\mathbf{T} = \begin{bmatrix} \mathbf{T}_{a} & \mathbf{T}_{b} \end{bmatrix}",
                         output="axes.T")]


# --- joints -----------------------------------------------------------------------------------------------------


def turned_axes(scope: Scope) -> list[Line]:
    """Return the axes of both frames after small turns, those that the joint needs."""
    used = {s for line in joint_equations(scope) for s in _axes_in(line.latex)}
    return [Line(rf"\mathbf{{{a}}}_{{{n}}} = {_turned(n)} {_turned(f'{n},0')} \mathbf{{{a}}}_{{{n}}}^{{0}}")
            for a, n in sorted(used, key=lambda s: (s[1], s[0]))]


def _turned(sub: str) -> str:
    return rf"\left( \mathbf{{I}} + \widetilde{{\boldsymbol{{\theta}}_{{{sub}}}}} \right)"


def _axes_in(text: str) -> set[tuple[str, str]]:
    return {(a, n) for a in "xyz" for n in "12" if rf"\mathbf{{{a}}}_{{{n}}}" in text}


def joint_equations(scope: Scope) -> list[Line]:
    """Return the equations of a joint, lifted from the program of its kernel."""
    lift = Lift(only(programs_of(scope.family.name)["force"], "phi"), scope.family.dim or 3)
    lines = [Line(latex(e)) for _, equations in lift.stages() for e in equations]
    phi = next(e for name, e in lift.outputs() if name == "phi")
    return [*lines, Line(rf"\boldsymbol{{\Phi}} = {latex(phi.sides[1])}", output="force.phi")]


def joint_jacobian(scope: Scope) -> list[Line]:
    """Return the derivatives of the equations and of the force, and both second derivatives in time."""
    def columns(of: str, *by: str) -> str:
        row = " & ".join(rf"\frac{{\partial {of}}}{{\partial {q}}}" for q in by)
        return rf"\begin{{bmatrix}} {row} \end{{bmatrix}}"

    J = columns(r"\boldsymbol{\Phi}", r"\mathbf{gap}", r"\boldsymbol{\theta}_{1}", r"\boldsymbol{\theta}_{2}")
    K = columns(r"\mathbf{g}", r"\mathbf{gap}", r"\boldsymbol{\theta}_{1,0}", r"\boldsymbol{\theta}_{2,0}")
    return [Line(rf"\mathbf{{J}} = {J}", output="force.J"), Line(r"\mathbf{g} = \mathbf{J}^{\mathsf{T}} \mathbf{f}"),
            Line(rf"\mathbf{{K}} = {K}", output="force.K")]


def joint_motion(scope: Scope) -> list[Line]:
    """Return the rate of the equations at rest, and their second derivative along the motion of both frames."""
    used = {s for line in joint_equations(scope) for s in _axes_in(line.latex)}
    drive = {"c_{0}": r"c_{0} + \zeta", "c_{1}": r"c_{1} - \zeta c_{2} - \frac{1}{2} \zeta^{2} c_{1}",
             "c_{2}": r"c_{2} + \zeta c_{1} - \frac{1}{2} \zeta^{2} c_{2}"}
    text = " ".join(line.latex for line in joint_equations(scope))
    drive = {name: value for name, value in drive.items() if name in text}
    moved = {r"\mathbf{gap}": r"\mathbf{gap} + t \dot{\mathbf{gap}}"}
    for a, n in sorted(used, key=lambda s: (s[1], s[0])):
        spin = rf"\widetilde{{\boldsymbol{{\omega}}}}_{{{n}}}"
        turned = rf"\left( \mathbf{{I}} + t {spin} + \frac{{1}}{{2}} t^{{2}} {spin} {spin} \right)"
        moved[rf"\mathbf{{{a}}}_{{{n}}}"] = rf"{turned} \mathbf{{{a}}}_{{{n}}}^{{0}}"
    lines = []
    if drive:
        every = ", ".join(rf"{name} \to {starred(name)}" for name in drive)
        lines = [Line(r"\zeta = t \dot{c} + \frac{1}{2} t^{2} \ddot{c}"),
                 *(Line(rf"{starred(name)} = {value}") for name, value in drive.items()),
                 Line(rf"\boldsymbol{{\Phi}}^{{0}} = \left. \boldsymbol{{\Phi}} \right|_{{{every}}}"),
                 Line(r"\boldsymbol{\Phi}_{t} = \frac{\mathrm{d} \boldsymbol{\Phi}^{0}}{\mathrm{d} t}",
                      output="motion.phi_t")]
    along = moved_along(moved | drive, r"\boldsymbol{\Phi}")
    defined = {line.latex for line in lines}
    return [*lines, *(line for line in along if line.latex not in defined),
            Line(r"\mathbf{Q}_{d} = \frac{\mathrm{d}^{2} \boldsymbol{\Phi}^{\ast}}{\mathrm{d} t^{2}}",
                 output="motion.Q_d")]


def spring_extension(scope: Scope) -> list[Line]:
    """Return extension, energy, dissipated power, force and its derivatives of a spring, or of a segment of one."""
    gap, rate = r"\mathbf{gap}", r"\dot{\mathbf{gap}}"
    assert isinstance(scope.family, PointLawFamily), f"{scope.family.name} is no law of a force between two points"
    parameters = scope.family.point_law.parameters
    if "length" in parameters or "reference" in parameters:
        e, de, length = r"\varepsilon", r"\dot{\varepsilon}", "L" if "length" in parameters else "L_{0}"
        lines = [Line(rf"{e} = \lvert {gap} \rvert - {length}"),
                 Line(rf"{de} = \frac{{{gap} \cdot {rate}}}{{\lvert {gap} \rvert}}")]
        squares = rf"{e}^{{2}}", rf"{de}^{{2}}"
        tension = rf"k {e} + c {de}" if "tension" not in parameters else rf"T_{{0}} + k {e} + c {de}"
        force = rf"\left( {tension} \right) \left( \frac{{\partial {e}}}{{\partial {gap}}} \right)^{{\mathsf{{T}}}}"
    else:
        lines = []
        squares = rf"\left( {gap} \cdot {gap} \right)", rf"\left( {rate} \cdot {rate} \right)"
        force = rf"k {gap} + c {rate}"
    before = rf"U_{{0}} + T_{{0}} {e} + " if "tension" in parameters else ""
    return [*lines, Line(rf"U = {before}\frac{{1}}{{2}} k {squares[0]}", output="energy.U"),
            Line(f"P = c {squares[1]}", output="dissipation.P"), Line(rf"\mathbf{{F}} = {force}", output="force.f"),
            Line(rf"\mathbf{{K}} = \frac{{\partial \mathbf{{F}}}}{{\partial {gap}}}", output="tangent.K"),
            Line(rf"\mathbf{{D}} = \frac{{\partial \mathbf{{F}}}}{{\partial {rate}}}", output="tangent.D")]


BODY_PRINTERS = {"attitude": attitude, "rigid_inertia": rigid_inertia, "modal_mass": modal_mass,
                 "frame_axes": frame_axes, "frame_turn": frame_turn, "modal_inertia": modal_inertia,
                 "turned_axes": turned_axes, "joint_equations": joint_equations,
                 "joint_jacobian": joint_jacobian, "joint_motion": joint_motion,
                 "spring_extension": spring_extension}
