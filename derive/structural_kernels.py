"""The kernels of the structural law: the signatures of law_kernels.py, and stiffness(l, e0, S).

Energy, forces and tangents go through the parts of a configuration (laws/structural.py): r_x at three places, moved
along x, y, z, and the two frames, turned about their own axes. Second derivatives by turns do not commute; the
directors' own derivatives put that right, and the result is symmetric.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
import sympy as sp
from funicular.derive.gram import DIRECTIONS
from funicular.derive.gram_tangent import from_others
from funicular.derive import spec as sym
from funicular.derive.laws.section_frame import SectionFrame, spatial
from funicular.derive.laws.structural import REFERENCE_DOC, Configuration, Structural
from funicular.derive.spec import Element
from funicular.derive.stages import Derivation, Program

ZERO = sp.S.Zero


def build(element: Element, law: str) -> list[Program]:
    """Every kernel of the law on an element."""
    kernels = Kernels(element)
    return [kernels.stiffness(), kernels.energy(), kernels.elastic_force(), kernels.elastic_tangent(),
            kernels.damping_force(), kernels.damping_tangent(), kernels.dissipation(), kernels.section_forces()]


class Kernels:
    """Programs of the law on an element."""

    def __init__(self, element: Element):
        self.element, self.law = element, Structural(element)

    def _program(self, kernel: str, doc: str) -> Program:
        return Program(f"{self.element.name}_{self.law.name}_{kernel}", doc, self.law.source)

    def _inputs(self, program: Program, *names: str) -> tuple:
        """Inputs l, e, A, or l, e, v, A, tau."""
        shape = (self.element.n_vectors, self.element.dim)
        about = {"e": ("m, 1", "nodal vectors (eq 1)"), "v": ("m/s, 1/s", "rates of the nodal vectors")}
        length = program.input("l", (), "m", "length of the element")
        vectors = [program.input(name, shape, *about[name]) for name in names]
        return (length, *vectors, self.law.constants(program))

    def _tau(self, program: Program) -> sp.Symbol:
        return program.input("tau", (), "s", "retardation time of the Kelvin-Voigt law")

    def _configuration(self, program: Program, e: np.ndarray, length: sp.Symbol) -> Configuration:
        program.stage("frames, strains")
        return Configuration(self.law, program, e, program.define("w", 1 / length))

    def stiffness(self) -> Program:
        """The law's constants."""
        p = self._program("stiffness", "constants of the law from the stiffness of the section and the reference")
        self.law.set_up(p)
        return p

    def energy(self) -> Program:
        """Half of strains times resultants."""
        p = self._program("energy", "elastic energy")
        length, e, A = self._inputs(p, "e")
        strains = self.law.from_reference(p, A, self._configuration(p, e, length).strains)
        resultants = self.law.resultants(self._stiffness(p, A, length), strains)
        p.output("U", [sum(s * r for s, r in zip(strains, resultants, strict=True)) / 2], "J", "elastic energy")
        return p

    def elastic_force(self) -> Program:
        """dU/de."""
        p = self._program("elastic_force", "dU/de, minus the elastic force Q_k")
        length, e, A = self._inputs(p, "e")
        configuration = self._configuration(p, e, length)
        forces = Forces(configuration, self._elastic(p, A, self._stiffness(p, A, length), configuration))
        p.output("f", forces.nodal(), "N, N m", "dU/de")
        return p

    def elastic_tangent(self) -> Program:
        """d2U/de2."""
        p = self._program("elastic_tangent", "d2U/de2")
        length, e, A = self._inputs(p, "e")
        configuration = self._configuration(p, e, length)
        stiffness = self._stiffness(p, A, length)
        tangent = Tangent(configuration, self._elastic(p, A, stiffness, configuration))
        tangent.add_material(stiffness)
        p.output("K", tangent.nodal(), "N/m, N, N m", "d2U/de2, symmetric")
        return p

    def damping_force(self) -> Program:
        """tau times the elastic law on the rates of strain."""
        p = self._program("damping_force", "minus the Kelvin-Voigt damping force Q_d")
        length, e, v, A = self._inputs(p, "e", "v")
        configuration = self._configuration(p, e, length)
        rates = Velocity(configuration, v).strains()
        resultants = self._resultants(p, self._stiffness(p, A, self._tau(p) * length), rates)
        p.output("f", Forces(configuration, resultants).nodal(), "N, N m", "-Q_d")
        return p

    def damping_tangent(self) -> Program:
        """df/de + rate df/dv of the damping force f."""
        p = self._program("damping_tangent", "df/de + rate df/dv of the damping force f = -Q_d")
        length, e, v, A = self._inputs(p, "e", "v")
        tau = self._tau(p)
        rate = p.input("rate", (), "1/s", "dv/de of the integrator")
        configuration = self._configuration(p, e, length)
        velocity = Velocity(configuration, v)
        stiffness = self._stiffness(p, A, tau * length)
        tangent = Tangent(configuration, self._resultants(p, stiffness, velocity.strains()))
        tangent.add_material(stiffness, velocity, rate)
        p.output("K", tangent.nodal(), "N/m, N, N m", "df/de + rate df/dv")
        return p

    def dissipation(self) -> Program:
        """Rates of strain times viscous resultants."""
        p = self._program("dissipation", "power dissipated by the damping force")
        length, e, v, A = self._inputs(p, "e", "v")
        rates = Velocity(self._configuration(p, e, length), v).strains()
        power = self._resultants(p, self._stiffness(p, A, self._tau(p) * length), rates)
        p.output("P", [sum(a * b for a, b in zip(rates, power, strict=True))], "W", "dissipated power, never negative")
        return p

    def section_forces(self) -> Program:
        """What passes through the section at x from the side of greater x."""
        p = self._program("section_forces", "force and moment resultants of a section")
        length, x = p.input("l", (), "m", "length of the element"), p.input("x", (), "m", "arc-length from its start")
        shape = (self.element.n_vectors, self.element.dim)
        e, S = p.input("e", shape, "m, 1", "nodal vectors (eq 1)"), self.law.section_stiffness(p)
        e0 = p.input("e0", shape, "m, 1", REFERENCE_DOC)
        now, before = self._configuration(p, e, length).strains, self._configuration(p, e0, length).strains
        p.stage("strains from the reference")
        strains = [p.define(f"d_{name}", a - b) for name, a, b in zip(self.law.names, now, before, strict=True)]
        p.stage("strains at x")
        strain = self.law.at(p, S, length, p.define("X", 2 * x / length - 1), strains)
        p.stage("axes of the section")
        shapes = [N.subs({sym.x: x, sym.l: length}) for N in self.law.director_shapes]
        nodal = {name.partition("_")[2]: spatial(e[k]) for k, name in enumerate(self.element.names)}
        directors = [sum((N * nodal.get(f"{d}{n + 1}", spatial([0, 0, 1])) for n, N in enumerate(shapes)), spatial([]))
                     for d in "yz"]
        axes = SectionFrame(p, "", *(p.vector(f"r_{d}", v) for d, v in zip("yz", directors, strict=True))).t
        stiffness = self.law.spatial_stiffness(S)
        resultant = [p.define(f"N{i + 1}", k * s) for i, (k, s) in enumerate(zip(stiffness, strain, strict=True))]
        p.output("force", np.array(resultant[:3]).dot(axes), "N", "resultant of the stress, global axes")
        p.output("moment", np.array(resultant[3:]).dot(axes), "N m", "its moment about the axis, global axes")
        p.output("axes", axes, "1", "rows: normal of the section t1, t2 along r_y, t3 = t1 x t2")
        p.output("strain", strain, "1, 1/m", "axial, shear along y and z, twist, curvature about y and z")
        return p

    def _stiffness(self, program: Program, A: np.ndarray, scale: sp.Expr) -> list[sp.Expr]:
        """Stage: section stiffness, and what the bubbles take off, times l, or another scale."""
        program.stage("stiffness of the element")
        return [program.define(f"S_{i}", scale * A[i]) for i in range(self.law.n_stiffness)]

    def _elastic(self, program: Program, A: np.ndarray, stiffness, configuration: Configuration) -> list[sp.Expr]:
        return self._resultants(program, stiffness, self.law.from_reference(program, A, configuration.strains))

    def _resultants(self, program: Program, stiffness, strains) -> list[sp.Expr]:
        program.stage("resultants")
        return [program.define(f"n_{name}", r)
                for name, r in zip(self.law.names, self.law.resultants(stiffness, strains), strict=True)]


class Velocity:
    """Rates of a configuration's parts and strains when the nodal vectors move with v."""

    def __init__(self, configuration: Configuration, v: np.ndarray):
        program, law = configuration.program, configuration.law
        program.stage("spins of the frames, rates of the strains")
        at = {name.partition("_")[2]: spatial(v[k]) for k, name in enumerate(law.element.names)}
        slopes = [at["x1"], spatial(configuration.half_way(v, "_rate")), at["x2"]]
        self.directors = [(at[f"y{n}"], at.get(f"z{n}", spatial([0, 0, 0]))) for n in (1, 2)]
        self.configuration, rates = configuration, dict.fromkeys(configuration.parts, ZERO)
        spins = [[program.define(f"spin{n + 1}_{k + 1}", s) for k, s in enumerate(frame.spin(*self.directors[n]))]
                 for n, frame in enumerate(configuration.frames)]
        speeds = [*(slope[j] for slope in slopes for j in law.axes), *(spin[k] for spin in spins for k in law.spins)]
        for speed, motion in zip(speeds, configuration.motions, strict=True):
            rates = {s: rates[s] + speed * motion[s] for s in rates}
        for frame, spin, directors in zip(configuration.frames, spins, self.directors, strict=True):
            rates |= {s: value for s, value in frame.rates(spin, *directors).items() if s not in rates}
        self.rate = Derivation(program, "v", {s: program.define(f"v_{s.name}", r) for s, r in rates.items()})

    def strains(self) -> list[sp.Expr]:
        """Rates of the strains."""
        configuration, program = self.configuration, self.configuration.program
        n = len(configuration.strains) - 2 * len(configuration.law.across)
        found = [self.rate(s) for s in configuration.strains[:n]]
        for _, terms in across(configuration):
            found.append(sum((gradient.dot(self.directors[node][i]) for node, i, gradient in terms), ZERO))
        return [program.define(f"rate_{name}", r) for name, r in zip(configuration.law.names, found, strict=True)]


def across(configuration: Configuration) -> Iterator[tuple[int, list[tuple[int, int, np.ndarray]]]]:
    """Strains of the section: index, and gradients as (node, director, vector)."""
    law = configuration.law
    first = len(configuration.strains) - 2 * len(law.across)
    for n, directors in enumerate(configuration.directors):
        for p, (i, j) in enumerate(law.across):
            own = [(n, i - 1, directors[j - 1])]
            yield first + n * len(law.across) + p, own if i == j else [*own, (n, j - 1, directors[i - 1])]


class Forces:
    """Generalised forces of resultants: on r_x at the three places, moments on the frames, forces on the directors.

    V is the sum of resultants times strains, the resultants held: its derivatives by a motion of the parts are the
    forces.
    """

    def __init__(self, configuration: Configuration, resultants: Sequence[sp.Expr]):
        self.configuration, self.program, self.law = configuration, configuration.program, configuration.law
        self.resultants, n = resultants, len(self.law.axes)
        self.program.stage("forces on the parts")
        middle = np.array([*resultants[n:2 * n], *resultants[3 * n:3 * n + len(self.law.spins)]])
        self.scalars = [s for s in (*configuration.mean, *configuration.gibbs) if s.is_Symbol]
        self.middle = np.array([[self.program.define(f"d_{strain}_{s.name}", d)
                                 for s, d in zip(self.scalars, row, strict=True)] for strain, row in
                                zip(configuration.middle, self.by(self.scalars, configuration.middle), strict=True)])
        self.by_scalar = [self.program.define(f"V_{s.name}", d)
                          for s, d in zip(self.scalars, middle.dot(self.middle), strict=True)]
        self.by_part = self._by_part()
        along = [sum((d * motion[s] for s, d in self.by_part.items()), ZERO) for motion in configuration.motions]
        self.slopes = [self.program.vector(f"f_x{tag}", along[place * n:(place + 1) * n])
                       for place, tag in enumerate("1m2")]
        self.moments = [np.array([self.program.define(f"moment{node + 1}_{k + 1}", along[configuration.turn(node, k)])
                                  if k in self.law.spins else ZERO for k in range(3)]) for node in range(2)]
        self.directors = [frame.forces(self.program, str(node + 1), self.moments[node])
                          for node, frame in enumerate(configuration.frames)]

    @property
    def held(self) -> dict[sp.Symbol, sp.Expr]:
        """Resultants, which V does not differentiate."""
        return {r: ZERO for r in self.resultants if r.is_Symbol}

    def by(self, scalars: Sequence[sp.Symbol], values: Sequence[sp.Expr]) -> np.ndarray:
        """Derivatives of values (n,) by some of the scalars of the middle, the others and the resultants held."""
        fixed = self.held | dict.fromkeys(self.scalars, ZERO)
        return np.stack([Derivation(self.program, f"d_{s.name}", fixed | {s: sp.S.One}).array(np.array(values))
                         for s in scalars], axis=-1)

    def _by_part(self) -> dict[sp.Symbol, sp.Expr]:
        """dV by each scalar part."""
        configuration, n = self.configuration, len(self.law.axes)
        by_scalar, values = dict(zip(self.scalars, self.by_scalar, strict=True)), {}
        for i in self.law.axes:
            values |= {configuration.along[node][i]: self.resultants[2 * n * node + i] for node in range(2)}
            values |= {p[i]: by_scalar[configuration.mean[i]] / 2 for p in configuration.between}
        return values | {g: by_scalar[g] for g in configuration.gibbs if g.is_Symbol}

    def nodal(self) -> np.ndarray:
        """Stage: forces on the nodal vectors."""
        own = {("x", 0): self.slopes[0], ("x", 1): self.slopes[1], ("x", 2): self.slopes[2]}
        own |= {(name, n): force for n, forces in enumerate(self.directors)
                for name, force in zip("yz", forces, strict=True)}
        for index, terms in across(self.configuration):
            for node, i, gradient in terms:
                own["yz"[i], node] = own["yz"[i], node] + self.resultants[index] * gradient
        self.program.stage("forces on the nodal vectors")
        element = self.law.element
        f = np.array([self.program.vector(f"f_{name}", sum(c * spatial(own[slot]) for slot, c in terms)[: element.dim])
                      for name, terms in zip(element.names, self.slots, strict=True)])
        f[0] = -sum(f[k] for k, position in enumerate(element.is_position) if position and k)
        return f

    @property
    def slots(self) -> list[list[tuple[tuple[str, int], sp.Expr]]]:
        """What each nodal vector moves: r_x at a place, or a director of a node; and how much."""
        found = []
        for k, name in enumerate(self.law.element.names):
            vector, node = name.partition("_")[2][:-1], int(name[-1]) - 1
            scale = self.configuration.w if not vector else 1
            terms = [] if vector in ("y", "z") else [(("x", 1), self.law.half_way[k] * scale)]
            found.append([*terms, *([((vector, 2 * node if vector == "x" else node), sp.S.One)] if vector else [])])
        return found


class Tangent(Forces):
    """Derivatives of the forces: first over the motions of the parts, then over the nodal vectors.

    `parts` (motions, motions) is the derivative of the force along a motion (row) by a motion (column), `late` that by
    the rate of a spin.
    """

    def __init__(self, configuration: Configuration, resultants: Sequence[sp.Expr]):
        super().__init__(configuration, resultants)
        self.program.stage("derivatives at constant resultants, over motions of the parts")
        count, first = len(configuration.motions), configuration.turn(0, self.law.spins[0])
        self.parts = np.full((count, count), ZERO, dtype=object)
        forces = np.array([*(f for slope in self.slopes for f in slope),
                           *(moment[k] for moment in self.moments for k in self.law.spins)])
        hessian = self._hessian()
        for column in range(first, count):
            motion = configuration.motions[column]
            of_mean = [(motion[a] + motion[b]) / 2 for a, b in zip(*configuration.between, strict=True) if a.is_Symbol]
            moved = [*of_mean, *(motion[g] for g in configuration.gibbs if g.is_Symbol)]
            by_scalar = {v: self.program.define(f"dV_{s.name}_{column}", sum(h * m for h, m in zip(row, moved, strict=True)))
                         for v, s, row in zip(self.by_scalar, self.scalars, hessian, strict=True)}
            rate = Derivation(self.program, f"turn{column}", self.held | motion | by_scalar)
            for row in range(column + 1):
                self.parts[row, column] = self.program.define(f"P_{row}_{column}", rate(forces[row]))
        self._mirror(first)
        self.velocity, self.late, self.across = None, None, {}

    def _mirror(self, first: int) -> None:
        """Motions commute but for the spins of one frame, of which (k, l) and (l, k) differ by the third."""
        for row in range(len(self.parts)):
            for column in range(max(first, row + 1), len(self.parts)):
                self.parts[column, row] = self.parts[row, column]
        if len(self.law.spins) == 3:
            for node, moment in enumerate(self.moments):
                for k in range(3):
                    row, column = sorted((self.configuration.turn(node, k), self.configuration.turn(node, (k + 1) % 3)))
                    sign = 1 if k < 2 else -1
                    self.parts[column, row] = self.parts[row, column] + sign * moment[(k + 2) % 3]

    def _hessian(self) -> np.ndarray:
        """Of V by the scalars; it is linear in the mean components."""
        n = sum(m.is_Symbol for m in self.configuration.mean)
        H = np.full((len(self.scalars), len(self.scalars)), ZERO, dtype=object)
        H[:, n:] = self.by(self.scalars[n:], self.by_scalar)
        for i in range(len(H)):
            for j in range(max(i, n), len(H)):
                H[i, j] = H[j, i] = self.program.define(f"V_{self.scalars[i].name}_{self.scalars[j].name}", H[i, j])
        return H

    def add_material(self, stiffness: Sequence[sp.Expr], velocity: Velocity | None = None, rate=None) -> None:
        """Stages: what the resultants change by, for the elastic law, or the viscous one at a velocity."""
        self.program.stage("strains by motions of the parts")
        B = self._strain_motions()
        moved = B
        if velocity:
            moved = np.array([[self.program.define("Bv", velocity.rate(b) + rate * b) for b in row] for row in B])
        self.program.stage("resultants by motions of the parts")
        first = self.configuration.turn(0, self.law.spins[0])
        self.parts = self._add_form(self.parts, B, stiffness, moved, "K")
        if velocity:
            self.late = self._add_form(np.full((len(B[0]), len(B[0]) - first), ZERO, dtype=object), B, stiffness,
                                       B[:, first:], "L")
        self.velocity = velocity
        terms, dim = dict(across(self.configuration)), self.law.element.dim
        for q, own in terms.items():
            unit = [sp.Integer(i == q) for i in range(self.law.n_strains)]
            column = self.law.resultants(stiffness, unit)
            for node, i, gradient in own:
                change = gradient
                if velocity:
                    pair = self.configuration.directors[node]
                    other = next(d for d in range(2) if pair[d] is gradient)
                    change = velocity.directors[node][other] + rate * gradient
                for p in terms:
                    if column[p] != 0:
                        scaled = self.program.vector(f"t_{self.law.names[p]}_{self.law.names[q]}", column[p] * change)
                        for to, j, along in terms[p]:
                            key = ("yz"[j], to), ("yz"[i], node)
                            self.across[key] = self.across.get(key, 0) + np.outer(along[:dim], scaled[:dim])

    def _add_form(self, K: np.ndarray, B: np.ndarray, stiffness, columns: np.ndarray, name: str) -> np.ndarray:
        """K + B' C columns, entry by entry; B' C B is symmetric."""
        C = np.array([[self.program.define("C", r) for r in self.law.resultants(stiffness, column)]
                      for column in columns.T]).T
        form = np.full(K.shape, ZERO, dtype=object)
        for i, j in np.ndindex(*K.shape):
            form[i, j] = (form[j, i] if columns is B and j < i else
                          self.program.define(f"{name}_{i}_{j}", B[:, i].dot(C[:, j])))
        return np.array([[self.program.define("sum", a + b) for a, b in zip(*rows, strict=True)]
                         for rows in zip(K, form, strict=True)])

    def _strain_motions(self) -> np.ndarray:
        """Strains by motions of the parts: (strains, motions); those of the section do not see them."""
        configuration, n = self.configuration, len(self.law.axes)
        B = np.full((self.law.n_strains, len(configuration.motions)), ZERO, dtype=object)
        for column, motion in enumerate(configuration.motions):
            of_mean = [self.program.define("moved", (motion[a] + motion[b]) / 2)
                       for a, b in zip(*configuration.between, strict=True) if a.is_Symbol]
            moved = [*of_mean, *(motion[g] for g in configuration.gibbs if g.is_Symbol)]
            values = [self.program.define(f"B_{row}_{column}", v) for row, v in enumerate(self.middle.dot(np.array(moved)))]
            for i in self.law.axes:
                for node in range(2):
                    B[2 * n * node + i, column] = motion[configuration.along[node][i]]
                B[n + i, column] = values[i]
            B[3 * n:3 * n + len(self.law.spins), column] = values[n:]
        return B

    def nodal(self) -> np.ndarray:
        """Stages: over directors, then over the nodal vectors -> (n, n)."""
        symmetric = self.velocity is None
        self.program.stage("over r_x at the three places and directors")
        places = [("x", place) for place in range(3)]
        slots = places + [(d, n) for n in range(2) for d in "yz"[: self.law.element.dim - 1]]
        K = {}
        for column, to in enumerate(slots):
            turning = [self._turning(to, j) for j in self.law.axes]
            for row, of in enumerate(slots):
                if not symmetric or row <= column:
                    K[of, to] = self._block(of, to, turning, symmetric and of == to)
        return self._over_nodes(K, symmetric)

    def _turning(self, slot: tuple[str, int], j: int) -> dict:
        """A unit motion of r_x or a director: rates of the frame it belongs to, derivatives of the forces on the parts."""
        configuration, program = self.configuration, self.program
        vector, n = slot
        if vector == "x":
            changes, frame = self.parts[:, configuration.stretch(n, j)], {}
        else:
            unit = spatial([int(i == j) for i in range(3)])
            pair = (unit, 0 * unit) if vector == "y" else (0 * unit, unit)
            spin = configuration.frames[n].spin(*pair)
            spin = np.array([program.define(f"W{k + 1}_{vector}{n + 1}_{DIRECTIONS[j]}", s) for k, s in enumerate(spin)])
            columns = [configuration.turn(n, k) for k in self.law.spins]
            changes = self.parts[:, columns].dot(spin[list(self.law.spins)])
            if self.velocity:
                late = np.array([program.define("dW", self.velocity.rate(spin[k])) for k in self.law.spins])
                changes = changes + self.late[:, np.array(columns) - configuration.turn(0, self.law.spins[0])].dot(late)
            frame = configuration.frames[n].rates(spin, *pair)
        return {"changes": [program.define("change", c) for c in changes], "frame": frame, "node": n}

    def _block(self, of: tuple[str, int], to: tuple[str, int], turning: list[dict], symmetric: bool) -> np.ndarray:
        configuration, program, dim = self.configuration, self.program, self.law.element.dim
        name = f"K_{of[0]}{of[1] + 1}_{to[0]}{to[1] + 1}"
        block = np.full((dim, dim), ZERO, dtype=object)
        for j, moved in enumerate(turning):
            if of[0] == "x":
                block[:, j] = [moved["changes"][configuration.stretch(of[1], i)] for i in range(dim)]
                continue
            node = of[1]
            rates = dict.fromkeys(configuration.frames[node].rates(*np.zeros((3, 3), dtype=int)), ZERO)
            if moved["frame"] and moved["node"] == node:
                rates |= moved["frame"]
            rates |= {self.moments[node][k]: moved["changes"][configuration.turn(node, k)] for k in self.law.spins}
            rate = moved.setdefault("rate", {}).setdefault(node, Derivation(program, f"by_{to[0]}{to[1] + 1}_{j}", rates))
            force = self.directors[node]["yz".index(of[0])]
            block[:, j] = [rate(force[i]) for i in range(dim)]
        block = block + self.across.get((of, to), np.zeros((dim, dim), dtype=int))
        for index, terms in across(configuration):
            if (of, to) in {(("yz"[a], n), ("yz"[b], n)) for n, a, _ in terms for b in self._partner(terms, a)}:
                block = block + self.resultants[index] * np.eye(dim, dtype=int)
        found = np.array([[program.define(f"{name}_{DIRECTIONS[i]}{DIRECTIONS[j]}", block[i, j])
                           if not symmetric or i <= j else ZERO for j in range(dim)] for i in range(dim)])
        return np.triu(found) + np.triu(found, 1).T if symmetric else found

    @staticmethod
    def _partner(terms, a: int) -> list[int]:
        """Directors in whose direction the gradient of a strain of the section by director a changes."""
        return [b for _, b, _ in terms if b != a] or [a]

    def _over_nodes(self, K: dict, symmetric: bool) -> np.ndarray:
        element, program = self.law.element, self.program
        program.stage("over the nodal vectors")
        n, dim = element.n_vectors, element.dim
        nodal = np.full((n, n, dim, dim), ZERO, dtype=object)
        for j in range(1, n):
            for k in range(j if symmetric else 1, n):
                block = sum(a * b * (K[s, t] if (s, t) in K else K[t, s].T)
                            for s, a in self.slots[j] for t, b in self.slots[k])
                name = f"K_{element.names[j]}_{element.names[k]}"
                nodal[j, k] = [[program.define(f"{name}_{DIRECTIONS[p]}{DIRECTIONS[q]}", block[p, q])
                                if not symmetric or j != k or p <= q else ZERO for q in range(dim)] for p in range(dim)]
                if symmetric and j == k:
                    nodal[j, j] = np.triu(nodal[j, j]) + np.triu(nodal[j, j], 1).T
                if symmetric:
                    nodal[k, j] = nodal[j, k].T
        return from_others(element, program, nodal, symmetric)
