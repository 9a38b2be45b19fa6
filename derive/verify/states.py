"""Sample inputs of the kernels: ordinary states with finite rotation and strain, the same on every machine.

Sizes are stout and of order one, so that no term hides below the rounding of another.
"""

from __future__ import annotations

import numpy as np
import sympy as sp

from ..laws import kernels as law_kernels
from ..spec import Element, Family, x
from .exact import ExactProgram
from .motion import RIDERS, exponential
from .numbers import Numbers
from .references import curved as verify_curved
from .references.element import Shape
from .relations.joint import samples

SEEDS = (20050401, 20050705)  # days on which the paper was received and accepted
LENGTH, HEIGHT, WIDTH = 0.7, 0.31, 0.23


def states(family: Family, exact: Numbers) -> list[dict[str, np.ndarray]]:
    """States of a family: values by argument name, with `rectangle` and the second rates that only paths use.

    Constants that one kernel makes for another (m, A) come from the 50-digit programs: a fault in the compiled one
    then shows up there and nowhere else.
    """
    from .relations import modal as verify_modal
    from .relations import moves as verify_moves
    from .relations import spring as verify_spring

    found = []
    for seed in SEEDS:
        random = np.random.default_rng(seed)
        state: dict[str, np.ndarray] = {}
        if family.dim:
            found.append((verify_spring.sample if family.role == "spring" else samples)(family, random))
            continue
        dim = family.element.dim if family.element else RIDERS[family.rider].dim
        if family.element:
            state |= element_state(family.element, random)
            if family.role != "law" or not _takes_shape(exact):
                del state["e0"]
        if family.rider:
            near = on_axis(family.element, state) if family.element else random.normal(size=dim)
            state |= RIDERS[family.rider].sample(random, near)
            state |= {"mass": np.float64(1.7), "J": _inertia(random), "a": random.normal(size=len(state["w"]))}
            state["m"] = random.normal(size=len(state["w"]) - dim)
        state |= following(family, state, random.spawn(1)[0])
        if family.element and family.rider:
            state["director"] = director(family.element, state, random)
        state["f"] = random.normal(size=dim)
        if family.role in ("element", "law"):
            state |= _constants(family, exact, state, random)
        if family.role == "modal":
            state |= verify_modal.sample(random, dim)
        if family.role == "body":
            state |= verify_moves.sample(random, RIDERS[family.rider])
        if family.role == "element":
            state |= loads(family.element, random)
        found.append(state)
    if family.dim:
        return found
    rest = found[0] | at_rest(family)
    if family.role == "modal":
        rest |= {name: 0 * rest[name] for name in verify_modal.RATES}
        rest |= verify_modal.integrals(rest)
    if family.role == "body":
        rest["step"] = 0 * rest["step"]
    if family.law and family.law.endswith("_curved"):
        rest["e0"] = rest["e"]
        rest |= _from_kernels(family, exact, rest)
    return [*found, rest]


def following(family: Family, state: dict[str, np.ndarray], random: np.random.Generator) -> dict[str, np.ndarray]:
    """The end of a step, far enough from its start to tell differences from derivatives."""
    found = {}
    if family.element:
        e = state["e"] @ rotation(random, family.element.dim, angle=0.3).T
        found["e_next"] = e + 0.05 * random.normal(size=e.shape)
        found["x_next"] = np.float64(state["x"] + 0.1 * LENGTH)
    if family.rider:
        rider = RIDERS[family.rider]
        found["b_next"] = rider.moved(np, state["b"], 0.2 * random.normal(size=rider.n_velocity))
    return found


def _takes_shape(exact: Numbers) -> bool:
    """Whether a kernel asks for the stress-free shape."""
    return any(a.name == "e0" for program in exact.programs.values() for a in program.inputs)


def at_rest(family: Family) -> dict[str, np.ndarray]:
    """Straight, undeformed, on the joint at zero rotation: where square roots and inverses have their easy limits."""
    state: dict[str, np.ndarray] = {}
    if family.element:
        state["e"] = reference(family.element, LENGTH)
        state["x"] = np.float64(LENGTH / 2)
    if family.rider:
        rider = RIDERS[family.rider]
        state |= rider.at_rest(LENGTH / 2 * np.eye(rider.dim)[0])
        state["director"] = np.eye(rider.dim)[1]
    return state


def director(element: Element, state: dict[str, np.ndarray], random: np.random.Generator) -> np.ndarray:
    """A direction off the tangent, neither of unit length nor normal to it."""
    tangent = on_axis(element, state, 1)
    tangent /= np.linalg.norm(tangent)
    normal = np.linalg.qr(np.stack([tangent, *random.normal(size=(element.dim - 1, element.dim))], axis=1))[0][:, 1]
    return 0.6 * tangent + 1.3 * normal


def on_axis(element: Element, state: dict[str, np.ndarray], order: int = 0) -> np.ndarray:
    """Point of the centreline at the state's x, or a derivative there."""
    return Shape(element, state["l"])((state["x"], 0, 0), (order, 0, 0)).astype(float) @ state["e"]


def section(height: float = HEIGHT, width: float = WIDTH) -> np.ndarray:
    """Moments of a rectangle, in the order of the kernels' argument."""
    powers = ((0, 0), (2, 0), (0, 2), (4, 0), (2, 2), (0, 4))
    return np.array([height ** (a + 1) / 2**a / (a + 1) * width ** (b + 1) / 2**b / (b + 1) for a, b in powers])


def reference(element: Element, l: float) -> np.ndarray:
    """Nodal vectors of the straight undeformed element along x."""
    rows = []
    for ratio in element.node_ratios:
        for vector in element.nodal_vectors:
            slope = vector.partition("_")[2]
            row = np.zeros(3)
            if not slope:
                row[0] = float(ratio) * l
            elif len(slope) == 1:
                row["xyz".index(slope)] = 1.0
            rows.append(row[: element.dim])
    return np.array(rows)


def rotation(random: np.random.Generator, dim: int, angle: float | None = None) -> np.ndarray:
    """A rotation matrix: by a random vector, or by an angle about a random axis."""
    if dim == 2:
        turn = random.normal() if angle is None else angle
        return np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    vector = random.normal(size=3)
    vector *= 1.0 if angle is None else angle / np.linalg.norm(vector)
    q = exponential(np, vector)
    v = np.array([[0, -q[3], q[2]], [q[3], 0, -q[1]], [-q[2], q[1], 0]])
    return np.eye(3) + 2 * (q[0] * v + v @ v)


def element_state(element: Element, random: np.random.Generator) -> dict[str, np.ndarray]:
    """A bent, stretched, sheared and turned element with its rates, and the data of the section and the law."""
    dim, n = element.dim, element.n_vectors
    mild = 3 / max(int(sp.degree(b, x)) for b in element.basis)  # curvatures of the same size for any degree
    e = reference(element, LENGTH) @ rotation(random, dim).T
    per_node = len(element.nodal_vectors)
    for k in range(len(element.nodes)):
        e[k * per_node : (k + 1) * per_node] @= rotation(random, dim, angle=0.4 * mild).T
    e += random.normal(size=(n, dim)) * 0.15 * mild**2
    e[element.is_position] += random.normal(size=dim)
    of_shape, = random.spawn(1)  # its own stream: the other samples are the same with and without
    e0 = reference(element, LENGTH) @ rotation(of_shape, dim).T
    e0 += of_shape.normal(size=(n, dim)) * 0.1 * mild**2
    return {
        "l": np.float64(LENGTH), "rectangle": np.array([HEIGHT, WIDTH]), "section": section(), "e": e, "e0": e0,
        "v": random.normal(size=(n, dim)), "vdot": random.normal(size=(n, dim)),
        "x": np.float64(LENGTH * random.uniform(0.2, 0.8)), "density": np.float64(2.9), "g": random.normal(size=dim),
        "tau": np.float64(0.37), "rate": np.float64(2.3),
        "at": np.array([0.3 * LENGTH, 0.4 * HEIGHT, -0.3 * WIDTH]),
    }


def _constants(family: Family, exact: Numbers, state: dict, random: np.random.Generator) -> dict[str, np.ndarray]:
    dim = family.element.dim
    made = {"a": random.normal(size=(family.element.n_vectors, dim))}
    if family.role == "law":
        made |= section_stiffness(family.like, dim, state["section"], random)
        if "algorithmic_force" in exact.programs:
            strains = exact.programs["algorithmic_force"].outputs[1].size
            made |= {"weight": np.float64(0.6), "known": random.spawn(1)[0].normal(size=strains)}
    return made | _from_kernels(family, exact, state | made)


def _from_kernels(family: Family, exact: Numbers, state: dict) -> dict[str, np.ndarray]:
    """Constants that kernels make for others."""
    made, s = {}, exact.state(state)
    for kernel, output in (("stiffness", "A"), ("mass", "m")):
        if kernel in exact.programs:
            made[output] = exact(kernel, s)[output].astype(float)
    if "stiffness_at" in exact.programs:
        points = [exact("stiffness_at", s, at=at, D=D) for at, D in verify_curved.weighted_points(family.element, s)]
        straight = ExactProgram(law_kernels.Kernels(family.element, "continuum").set_up())([s["l"], s["S"]])["A"]
        made["A"] = np.concatenate([straight, sum(p["A"] for p in points), points[0]["G0"]]).astype(float)
    return made


def section_stiffness(law: str, dim: int, moments: np.ndarray, random: np.random.Generator) -> dict[str, np.ndarray]:
    """Argument S of a law; for a continuum also elastic constants, D over the section and D_axis on the axis alone."""
    if law == "structural":
        return {"S": random.uniform(1, 4, 9 if dim == 3 else 4)}
    if not law.startswith("continuum"):
        upper = [0.6 * moments[0]] if law.endswith("_assumed") else []
        return {"S": 53.0 * np.array([*moments[:2], *upper])}
    pairs = dim * (dim - 1) // 2
    D, on_axis_alone = (np.concatenate([random.uniform(40, 60, dim), random.uniform(5, 15, pairs),
                                        random.uniform(10, 20, pairs)]) for _ in range(2))
    return {"S": np.outer(D, moments) + np.outer(on_axis_alone, moments * [1, 0, 0, 0, 0, 0]), "D": D,
            "D_axis": on_axis_alone}


def loads(element: Element, random: np.random.Generator) -> dict[str, np.ndarray]:
    """Components of a follower force and of a moment, as many as the element takes."""
    local = element.dim if element.dim == 2 or element.director else 1
    return {"c": random.normal(size=local), "M": random.normal(size=1 if element.dim == 2 else 3)}


def _inertia(random: np.random.Generator) -> np.ndarray:
    root = random.normal(size=(3, 3))
    return root @ root.T + np.eye(3)
