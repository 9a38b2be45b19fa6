"""Beam with the strains of Reissner and Simo: stretch, shear, curvature and twist of a section, free of locking.

The section's frame t is made of the directors r_y, r_z. With r_x cubic and the directors linear in x, the strains

    stretch, shear  m_i = r_x . t_i      at the nodes and, turned, half way; quadratic in between,
    twist, curvature                     constant: the rotation vector from node to node over l,
    of the section  r_y.r_y/2, r_z.r_z/2, r_y.r_z   at the nodes, linear in between,

have the number that the element can have (18 in space, 9 in the plane): no locking and no hourglass modes. Half way,
the frame is that of half the rotation between the nodes. Its Gibbs vector g = tan(angle/2) axis comes from the two
frames.

Rotations are linear, and so forbid the linear curvature of a beam under shear force. An inner bubble of rotation,
amplitude beta (1 - X^2), takes it up; it is condensed: exact for Timoshenko's beam under end loads. It turns the
section, too: where it leaves a part a_i of the shear m_i half way, r_x is stretched by s there, not by m_1,

    s^2 = m_1^2 + c_2^2 m_2^2 + c_3^2 m_3^2      c_i^2 = 4/5 (1 - a_i^2),

4/5 for the mean of the bubble's square over the element. With m_1 a taut element could turn its chord away and lengthen
for the bubble's bending alone; with s it is as stable as a string. The shears half way are 2 m_i/(1 + m_1/s): the
bubble's angle by twice the tangent of its half, for its sine would let a chord turn back and rest there.

Strains are counted from those of a reference e0, which may be curved; x is its arc-length. Section constants of order:
EA, GA_y, GA_z, GJ, EI_yy, EI_zz, stiffness against r_y.r_y, r_z.r_z, r_y.r_z, and EA_t of the torque that goes with
stretch and the tension that goes with twist, as in ropes of helical wires; planar EA, GA, EI, r_y.r_y.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cached_property

import numpy as np
import sympy as sp

from ...algebra.tangent_frame import spatial
from ...codegen.program import Program
from ...spec import Element, LawTraits, l, x, y, z
from .. import stress_free
from .section_frame import SectionFrame, turned

NAME = "structural"
DOC = "beam with Reissner's strains, its section's frame from the directors, free of locking"
SOURCE = ("Reissner, ZAMP 23 (1972) 795-804; Simo, CMAME 49 (1985) 55-70; Nachbagauer, Gruber & Gerstmayr, "
          "J. Comput. Nonlinear Dyn. 8 (2013) 021004; rotation between nodes: Crisfield & Jelenic, Proc. R. Soc. A 455 "
          "(1999) 1125-1147")
TRAITS = LawTraits("structural", takes_shape=True)

X = sp.Symbol("X")
PLACES = (-1, 0, 1)  # X of the first node, half way, the second node
LAGRANGE = [sp.interpolate([(p, int(p == q)) for p in PLACES], X) for q in PLACES]
BUBBLE = 1 - X**2


def _mean(f: sp.Expr) -> sp.Expr:
    return sp.integrate(sp.expand(f), (X, -1, 1)) / 2


MEAN = [_mean(f) for f in LAGRANGE]
QUADRATIC = sp.Matrix(3, 3, lambda i, j: _mean(LAGRANGE[i] * LAGRANGE[j]))
BUBBLE_WITH_STRAIN = [_mean(f * BUBBLE) for f in LAGRANGE]
BUBBLE_SQUARED = _mean(BUBBLE**2)
BUBBLE_AS_STRAIN = BUBBLE_SQUARED / _mean(BUBBLE)  # the parabola through 0, this, 0 has the mean of its square
BUBBLE_CURVATURE = _mean((2 * BUBBLE.diff(X)) ** 2)  # times 1/l^2
LINEAR = sp.Matrix(2, 2, lambda i, j: _mean((1 + PLACES[2 * i] * X) * (1 + PLACES[2 * j] * X) / 4))


def arc(square: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
    """Return arctan(t)/t as a quotient, from t^2: Gauss's continued fraction; off by 1e-6 at 45 degrees, 2e-4 at 90."""
    t2, fraction = sp.Symbol("t2"), sp.Integer(9)
    for n in (4, 3, 2, 1):
        fraction = 2 * n - 1 + n**2 * t2 / fraction
    above, below = sp.fraction(sp.cancel(1 / fraction))
    return tuple(sp.horner(part).subs(t2, square) for part in (above, below))


class Structural:
    """Strains of the section and their resultants."""

    name, doc, source = NAME, DOC, SOURCE

    def __init__(self, element: Element):
        self.element = element
        self.axes = range(element.dim)
        self.spins = range(3) if element.dim == 3 else (2,)
        self.across = ((1, 1), (2, 2), (1, 2)) if element.dim == 3 else ((1, 1),)
        self.shears = self.axes[1:]
        self.couplings = range(int(element.dim == 3))  # of stretch and twist

    # --- constants ------------------------------------------------------------------------------------------

    @property
    def n_section(self) -> int:
        """Return the length of S."""
        return len(self.axes) + len(self.spins) + len(self.across) + len(self.couplings)

    @property
    def n_stiffness(self) -> int:
        """Return the number of constants of S, and of what the bubble takes off each shear."""
        return self.n_section + len(self.shears)

    @property
    def n_constants(self) -> int:
        """Return the length of A without the reference: stiffness, and how much of each shear half way is stretch."""
        return self.n_stiffness + len(self.shears)

    @property
    def n_strains(self) -> int:
        """Return the number of strains: stretch and shears at three places, curvatures, strains of the section at both
        nodes.
        """
        return 3 * len(self.axes) + len(self.spins) + 2 * len(self.across)

    def section_stiffness(self, program: Program) -> np.ndarray:
        """Declare the input S (n_section,), the stiffness of the section, and return it."""
        if self.element.dim == 3:
            return program.input("S", self.n_section, "N, N m^2",
                                 "section stiffness: EA, GA_y, GA_z, GJ, EI_yy, EI_zz; against r_y.r_y/2, r_z.r_z/2, "
                                 "r_y.r_z; EA_t, torque by stretch and tension by twist")
        return program.input("S", self.n_section, "N, N m^2", "section stiffness: EA, GA, EI; against r_y.r_y/2")

    def constants(self, program: Program) -> np.ndarray:
        """Declare the input A and return it: S, stiffness that the bubble takes off the shears, shares of stretch,
        strains of the reference.
        """
        return program.input("A", self.n_constants + self.n_strains, "N, N m^2, 1, 1/m",
                             f"constants from {self.element.name}_{NAME}_stiffness")

    def set_up(self, program: Program) -> None:
        """Declare the inputs l, e0 and S, and the output A."""
        length = program.input("l", (), "m", "length of the element")
        e0 = stress_free.shape(program, self.element)
        S = self.section_stiffness(program)
        program.stage("stiffness that the bubble takes off the shears")
        bubble = [program.define(f"bubble_{i}", self._condensed(S, i, length)) for i in self.shears]
        shares = self.shares(program, S, length)
        program.stage("strains of the reference")
        configuration = Configuration(self, program, e0, program.define("w", 1 / length), shares)
        program.output("A", [*S, *bubble, *shares, *configuration.strains], "N, N m^2, 1, 1/m",
                       "S, stiffness that the bubble takes off the shears, shares of stretch in the shears half way, "
                       "reference strains")

    def shares(self, program: Program, S: Sequence[sp.Expr] | np.ndarray, length: sp.Expr) -> list[sp.Expr]:
        """Return how much of each shear half way is stretch, since the bubble turns the section."""
        program.stage("stretch of the bubble")
        left = [program.define(f"left_{i}", 1 - S[i] * BUBBLE_SQUARED / self._bubble_stiffness(S, i, length))
                for i in self.shears]
        return [program.define(f"share_{i}", sp.sqrt(BUBBLE_AS_STRAIN * (1 - c**2)))
                for i, c in zip(self.shears, left, strict=True)]

    def bending(self, S: Sequence[sp.Expr] | np.ndarray, shear: int) -> sp.Expr:
        """Return the stiffness of the bending that goes with a shear: about z with y, about y with z."""
        return S[len(self.axes) + list(self.spins).index(3 - shear)]

    def _condensed(self, S: Sequence[sp.Expr] | np.ndarray, shear: int, length: sp.Expr) -> sp.Expr:
        return S[shear] ** 2 / self._bubble_stiffness(S, shear, length)

    def _bubble_stiffness(self, S: Sequence[sp.Expr] | np.ndarray, shear: int, length: sp.Expr) -> sp.Expr:
        """Return the stiffness of the amplitude beta, over l."""
        return S[shear] * BUBBLE_SQUARED + self.bending(S, shear) * BUBBLE_CURVATURE / length**2

    def bubble(self, S: np.ndarray, shear: int, length: sp.Expr, strain: Sequence[sp.Expr]) -> sp.Expr:
        """Return the amplitude beta that makes the energy least, for the shear strains at the three places."""
        return S[shear] * _times(BUBBLE_WITH_STRAIN, strain) / self._bubble_stiffness(S, shear, length)

    # --- the energy, a quadratic form in the strains ----------------------------------------------------------

    def from_reference(self, program: Program, A: np.ndarray, strains: Sequence[sp.Expr]) -> list[sp.Expr]:
        """Return strains less those of the reference."""
        program.stage("strains from the reference")
        return [program.define(f"d_{name}", s - A[self.n_constants + i])
                for i, (name, s) in enumerate(zip(self.names, strains, strict=True))]

    @cached_property
    def names(self) -> list[str]:
        """Return the names of the strains."""
        return ([f"e{i + 1}_{place}" for place in ("1", "m", "2") for i in self.axes]
                + [f"k{k + 1}" for k in self.spins]
                + [f"e{'xyz'[i]}{'xyz'[j]}_{n}" for n in (1, 2) for i, j in self.across])

    def resultants(self, stiffness: Sequence[sp.Expr], strains: Sequence[sp.Expr]) -> list[sp.Expr]:
        """Return the derivatives of the form by the strains, times l; linear in the strains."""
        n, m = len(self.axes), len(self.spins)
        found: list[sp.Expr] = [sp.S.Zero] * self.n_strains
        for i in self.axes:
            at = [strains[place * n + i] for place in range(3)]
            for place in range(3):
                found[place * n + i] = stiffness[i] * _times(QUADRATIC.row(place), at)
            if i in self.shears:
                taken = stiffness[self.n_section + i - 1] * _times(BUBBLE_WITH_STRAIN, at)
                for place in range(3):
                    found[place * n + i] -= BUBBLE_WITH_STRAIN[place] * taken
        for k in range(m):
            found[3 * n + k] = stiffness[n + k] * strains[3 * n + k]
        for p in range(len(self.across)):
            at = [strains[3 * n + m + node * len(self.across) + p] for node in range(2)]
            for node in range(2):
                found[3 * n + m + node * len(self.across) + p] = stiffness[n + m + p] * _times(LINEAR.row(node), at)
        for k in self.couplings:
            coupling = stiffness[self.n_section - 1 - k]
            for place in range(3):
                found[place * n] += coupling * MEAN[place] * strains[3 * n + k]
            found[3 * n + k] += coupling * _times(MEAN, strains[:3 * n:n])
        return found

    def at(self, program: Program, S: np.ndarray, length: sp.Expr, at: sp.Expr,
           strains: Sequence[sp.Expr]) -> tuple[list[sp.Expr], np.ndarray]:
        """Return axial strain, shears, twist, curvatures at X, the bubble's among them, and its turn, a Gibbs vector in
        the section's frame; zero out of the plane.
        """
        n = len(self.axes)
        found, turn = [sp.S.Zero] * 6, np.full(3, sp.S.Zero)
        for k in self.spins:
            found[3 + k] = strains[3 * n + list(self.spins).index(k)]
        for i in self.axes:
            places = strains[i:3 * n:n]
            found[i] = _times([f.subs(X, at) for f in LAGRANGE], places)
            if i in self.shears:
                # a rotation about z takes from the shear along y, one about y adds to that along z
                sign = 1 if i == 1 else -1
                bubble = program.define(f"bubble_{i}", self.bubble(S, i, length, places))
                found[i] -= bubble * BUBBLE.subs(X, at)
                found[6 - i] += sign * bubble * (2 / length) * BUBBLE.diff(X).subs(X, at)
                turn[3 - i] = program.define(f"turn_{3 - i + 1}", sign * bubble * BUBBLE.subs(X, at) / 2)
        return [program.define(f"at_{'ek'[i // 3]}{i % 3 + 1}", f) for i, f in enumerate(found)], turn

    def at_section(self, S: Sequence[sp.Expr] | np.ndarray, strain: Sequence[sp.Expr]) -> list[sp.Expr]:
        """Return tension, shear forces, torque and bending moments from the strains `at` a section."""
        stiffness = S[:6] if self.element.dim == 3 else [S[0], S[1], *[sp.S.Zero] * 3, S[2]]
        found = [k * s for k, s in zip(stiffness, strain, strict=True)]
        for k in self.couplings:
            coupling = S[self.n_section - 1 - k]
            found[0], found[3] = found[0] + coupling * strain[3], found[3] + coupling * strain[0]
        return found

    @property
    def director_shapes(self) -> list[sp.Expr]:
        """Return the shape functions of r_y at the nodes, as they stand at r_y: linear in x."""
        return [sp.diff(N, y) for name, N in zip(self.element.names, self.element.shape_functions, strict=True)
                if name.startswith("r_y")]

    @cached_property
    def half_way(self) -> list[sp.Expr]:
        """Return r_x half way by the nodal vectors, positions counted in lengths: derivatives of the shape functions.
        """
        at = {x: l / 2, y: 0, z: 0}
        return [sp.cancel(sp.diff(N, x).subs(at) * (l if position else 1))
                for N, position in zip(self.element.shape_functions, self.element.is_position, strict=True)]


def _times(row: Sequence[sp.Expr], values: Sequence[sp.Expr]) -> sp.Expr:
    return sum((c * v for c, v in zip(row, values, strict=True)), sp.S.Zero)


class Configuration:
    """Frames and strains of an element, through the components of r_x in the frames and the rotation between them.

    `parts` are these scalars and the frames: a motion is known by the rates that it gives to them.
    """

    def __init__(self, law: Structural, program: Program, e: np.ndarray, w: sp.Expr,
                 shares: Sequence[sp.Expr] | np.ndarray):
        self.law, self.program, self.w, self.shares = law, program, w, shares
        names = [name.partition("_")[2] for name in law.element.names]  # 1, x1, y1, z1, 2, x2, ...
        at = {name: spatial(e[k]) for k, name in enumerate(names)}
        self.directors = [(at[f"y{n}"], at.get(f"z{n}", spatial([0, 0, 1]))) for n in (1, 2)]
        self.slopes = [at["x1"], spatial(self.half_way(e)), at["x2"]]
        self.frames = [SectionFrame(program, str(n + 1), *directors) for n, directors in enumerate(self.directors)]
        self.along = [self._components(f"q{n + 1}", frame, self.slopes[2 * n]) for n, frame in enumerate(self.frames)]
        self.between = [self._components(f"p{n + 1}", frame, self.slopes[1]) for n, frame in enumerate(self.frames)]
        self.gibbs = self._gibbs()
        self.mean = np.array([program.define(f"mean{i + 1}", (self.between[0][i] + self.between[1][i]) / 2)
                              for i in range(3)])
        self.middle = self._middle()
        self.strains = [*(self.along[0][i] for i in law.axes), *self.middle[: len(law.axes)],
                        *(self.along[1][i] for i in law.axes), *self.middle[len(law.axes):], *self._across()]

    def half_way(self, e: np.ndarray, tag: str = "") -> np.ndarray:
        """Return r_x half way, through the chord, from nodal vectors or their rates."""
        positions = self.law.element.is_position
        chord = [self.program.vector(f"chord{tag}{k}", (e[k] - e[0]) * self.w) if v and k else e[k]
                 for k, v in enumerate(positions)]
        return self.program.vector(f"xm{tag}", sum(self.law.half_way[k] * chord[k] for k in range(1, len(chord))
                                                   if self.law.half_way[k] != 0))

    def _components(self, name: str, frame: SectionFrame, vector: np.ndarray) -> np.ndarray:
        return np.array([self.program.define(f"{name}_{i + 1}", vector.dot(t)) for i, t in enumerate(frame.t)])

    def _gibbs(self) -> np.ndarray:
        """Return tan(angle/2) times the axis of the rotation from the first frame to the second, in either."""
        turn = [[a.dot(b) for b in self.frames[1].t] for a in self.frames[0].t]
        inverse = self.program.define("inv_turn", 1 / (1 + sum(turn[i][i] for i in range(3))))
        return np.array([self.program.define(f"g{i + 1}", inverse * (turn[i - 1][i - 2] - turn[i - 2][i - 1]))
                         for i in range(3)])

    def _middle(self) -> list[sp.Expr]:
        """Return stretch and shears half way, and the curvatures.

        (t_1 + t_2)/2 is the frame of half the rotation, its part across the axis shorter by cos(angle/2).
        """
        define, g = self.program.define, self.gibbs
        square = define("gg", g.dot(g))
        secant = define("secant", sp.sqrt(1 + square))
        along = define("along", g.dot(self.mean) * define("inv_secant", 1 / (1 + secant)))
        above, below = arc(square)
        per_length = define("arc", 2 * self.w * above * define("inv_arc", 1 / below))
        self.components = m = [define(f"m{i + 1}", secant * self.mean[i] - g[i] * along) for i in self.law.axes]
        shared = [define(f"shared{i + 1}", share * m[i]) for i, share in zip(self.law.shears, self.shares, strict=True)]
        stretch = define("stretch", sp.sqrt(m[0] ** 2 + sum(c**2 for c in shared)))
        cosine = define("cosine", m[0] * define("inv_stretch", 1 / stretch))
        larger = define("larger", 1 / (sp.Rational(1, 2) + cosine / 2))
        return [stretch, *(define(f"shear{i + 1}", larger * m[i]) for i in self.law.shears),
                *(define(f"k{k + 1}", per_length * g[k]) for k in self.law.spins)]

    def _across(self) -> list[sp.Expr]:
        pairs = [(self.directors[n][i - 1], self.directors[n][j - 1], i == j)
                 for n in range(2) for i, j in self.law.across]
        return [self.program.define("across", a.dot(b) / (2 if same else 1)) for a, b, same in pairs]

    # --- motions --------------------------------------------------------------------------------------------

    @property
    def parts(self) -> list[sp.Symbol]:
        """Return what motions move: frames, components of r_x, the rotation between the frames."""
        values = [*(f.t for f in self.frames), *self.along, *self.between, self.gibbs]
        return [s for v in values for s in v.ravel() if s.is_Symbol]

    @cached_property
    def motions(self) -> list[dict[sp.Symbol, sp.Expr]]:
        """Return the rates of the parts when r_x at each place moves along x, y, z, then under unit spins of each
        frame.
        """
        return ([m for place in range(3) for m in self._stretches(place)]
                + [m for node in range(2) for m in self._turns(node)])

    def stretch(self, place: int, axis: int) -> int:
        """Return the index of a motion of r_x."""
        return place * len(self.law.axes) + axis

    def turn(self, node: int, spin: int) -> int:
        """Return the index of a spin about an axis of the frame, which may be any of `spins`."""
        return 3 * len(self.law.axes) + node * len(self.law.spins) + list(self.law.spins).index(spin)

    def _stretches(self, place: int) -> list[dict[sp.Symbol, sp.Expr]]:
        moved = self.between if place == 1 else [self.along[place // 2]]
        frames = self.frames if place == 1 else [self.frames[place // 2]]
        return [self._complete((s, t[j]) for values, frame in zip(moved, frames, strict=True)
                               for s, t in zip(values, frame.t, strict=True)) for j in self.law.axes]

    def _turns(self, node: int) -> list[dict[sp.Symbol, sp.Expr]]:
        found = []
        for k in self.law.spins:
            rates = [(self.frames[node].t, turned(k, self.frames[node].t)),
                     (self.along[node], turned(k, self.along[node])),
                     (self.between[node], turned(k, self.between[node])), (self.gibbs, self._gibbs_rate(node, k))]
            found.append(self._complete(pair for parts, values in rates
                                        for pair in zip(parts.ravel(), values.ravel(), strict=True)))
        return found

    def _gibbs_rate(self, node: int, k: int) -> np.ndarray:
        """Return the rate of a Gibbs vector, from quaternions (1, g) and (1, spin/2): (+-(spin + g (g.spin)) + g x
        spin)/2, minus for the first node.
        """
        g, sign = self.gibbs, 2 * node - 1
        unit = np.array([sp.Integer(i == k) for i in range(3)])
        rate = (sign * (unit + g[k] * g) + turned(k, g)) / 2
        return np.array([self.program.define(f"dg{i + 1}_{node + 1}{k + 1}", r) for i, r in enumerate(rate)])

    def _complete(self, rates: Iterable[tuple[sp.Symbol, sp.Expr]]) -> dict[sp.Symbol, sp.Expr]:
        return dict.fromkeys(self.parts, sp.S.Zero) | {s: v for s, v in rates if sp.sympify(s).is_Symbol}
