"""Hypothesis strategies of small scenes with all kinds of parts, over many decades of size, with some invalid values.
"""

import tomllib
import warnings

import funicular as fu
import numpy as np
from funicular.errors import FunicularError
from funicular.parts.scene_text import as_toml
from hypothesis import strategies as st

NESTED: list = []
for _ in range(10_000):
    NESTED = [NESTED]

NUMBERS = [0, -1, 1, 0.5, 1e8, 10**8, 10**12, 2**63, 1e60, -1e60, 1e-300, 5e-324, 1e308, float("inf"), float("nan"),
           10**400, 10**5000, -(10**5000)]
WORDS = ["", "x", "A", "wire", "\0", "ä-1", "a" * 10_000, "continuum", "stick", "all", "/", "wire.position.y"]
SHALLOW = [True, [], {}, [[]], [1], [1, 2, 3], ["a", "b", "c"], [1e300] * 3, [1e-300] * 3,
           [[1, 2, 3]] * 3, {"form": []}, {"form": {}}, {"form": "ramp", "start": [], "end": 1},
           {"shape": []}, {"stop": []}, {"stop": {}}, ["A", [1, 2]], ["wire", []], [{"form": []}] * 3,
           {"axis": [0, 0, 1], "angle": {"form": []}}, [[0, 0, 1], {"form": 1}]]
DATA = [*SHALLOW, NESTED, [10**5000] * 3, {"form": NESTED}, ["A", NESTED], ["wire", 10**5000], [NESTED] * 3]
OBJECTS = [None, b"x", 1j, object(), print, lambda u: (u, u, u), np.zeros((3, 3, 3)), np.array("x"), np.array([]),
           {1, 2}, range(3)]

in_files = st.sampled_from([*NUMBERS[:-2], *WORDS, *SHALLOW])
"""Nonsense that TOML can write."""

nonsense = st.sampled_from([*NUMBERS, *WORDS, *DATA, *OBJECTS])


def decades(low: float, high: float):
    """A positive number with a uniformly distributed logarithm."""
    return st.floats(low, high, allow_nan=False).map(lambda power: float(f"{10**power:.3g}"))


def vectors(size: float, planar: bool = False):
    """Three numbers of about a size; in the plane the last one is 0."""
    number = st.sampled_from([0.0, 1.0, -1.0, 0.3]).map(lambda x: x * size)
    return st.tuples(number, number, st.just(0.0) if planar else number)


@st.composite
def signals(draw, size: float, time: float, from_zero: bool = False):
    """A signal of about a size over about a time; from_zero: for a motion, which starts at 0."""
    value = size * draw(st.sampled_from([0.0, 1.0, -0.1]))
    kinds = [fu.Ramp(start=0, end=time, after=value), fu.Pulse(start=0, end=time, height=value),
             fu.Harmonic(amplitude=value, frequency=1 / time),
             fu.TableSignal(time=[0, time, 3 * time], value=[0, value, -value]),
             fu.TableSignal(time=[0, time], value=[0, value], interpolation="linear")]
    return draw(st.sampled_from(kinds if from_zero else [*kinds, value]))


SPATIAL, PLANAR = ("beam24", "cable12", "cable18"), ("beam12p", "cable8p")
LAWS = {"beam24": ({}, {"law": "poisson_split"}, {"law": "structural"}), "beam12p": ({}, {"law": "structural"})}
LAWS |= {name: ({}, {"strain": "engineering"}) for name in ("cable18",)}
LAWS |= {name: ({}, {"strain": "engineering"}, {"curvature": "linear"}) for name in ("cable12", "cable8p")}


@st.composite
def parts(draw):
    """(time in s, gravity, parts) of a scene; each part is the method that adds it with its keywords."""
    planar = draw(st.booleans())
    size, time = draw(decades(-4, 4)), draw(decades(-4, 2))
    gravity = draw(st.sampled_from([(0, 0, 0), (0, -9.81, 0), (0, -size / time**2, 0)]))
    density, thin = draw(decades(-1, 4)), draw(decades(-4, -0.7))
    E = draw(decades(2, 12))
    material = fu.Material(youngs_modulus=E, density=density, poisson_ratio=draw(st.sampled_from([0.0, 0.3, -0.5])),
                           damping_time=draw(st.sampled_from([0.0, 1e-3 * time])),
                           mass_damping=draw(st.sampled_from([0.0, 1 / time])))
    section = draw(st.sampled_from([fu.Circle(radius=thin * size), fu.Rectangle(height=thin * size, width=thin * size),
                                    fu.Tube(outer_radius=thin * size, inner_radius=0.8 * thin * size)]))
    mass = density * section.area * size * draw(decades(-3, 3))
    force, rate = mass * size / time**2, size / time
    numbers = {"planar": planar, "size": size, "time": time, "mass": mass, "force": force, "rate": rate}
    made = []
    cables = draw(st.integers(0, 2))
    for k in range(cables):
        element = draw(st.sampled_from(PLANAR if planar else SPATIAL))
        at = (size, 0.0, 0.0) if k and draw(st.booleans()) else (0.0, 0.5 * size * k, 0.0)
        end = (at[0] + size, at[1], 0.0)
        shape = {"start": at, "end": end}
        if draw(st.integers(0, 3)) == 0:
            middle = (at[0] + 0.5 * size, at[1] - 0.1 * size, 0.0)
            shape = {"points": [at, middle, end], "rest": draw(st.sampled_from(["drawn", "straight"]))}
        elif draw(st.integers(0, 3)) == 0:
            shape["rest_length"] = size * draw(st.sampled_from([0.99, 1.02]))
        made.append(("cable", {"name": ("wire", "rope")[k], "element": element, "elements": draw(st.integers(1, 3)),
                               "section": section, "material": material, "up": (0, 1, 0), **shape,
                               **draw(st.sampled_from(LAWS[element])),
                               "velocity": draw(vectors(draw(st.sampled_from([0.0, rate])), planar))}))
        length = shape.get("rest_length", size)
        for s in (0.0, length):
            made += draw(st.sampled_from([[], [("pin", {"cable": made[-1][1].get("name", "wire"), "s": s})]])
                         if draw(st.booleans()) else supports(("wire", "rope")[k], s, numbers))
    if cables == 2 and draw(st.booleans()):
        made.append(("tie", {"cable": "wire", "s": size, "to": "rope", "at": 0.0,
                              "rotation": draw(st.sampled_from(["rigid", "free"]))}))
    for k in range(draw(st.integers(0 if cables else 1, 2))):
        made += draw(bodies("AB"[k], 0.3 + 0.2 * k, numbers, material, section))
        if cables and draw(st.integers(0, 2)):
            made += draw(slides("AB"[k], (0.3 + 0.2 * k) * size, numbers))
        if draw(st.integers(0, 2)) == 0:
            made += draw(joints("AB"[k], (0.3 + 0.2 * k) * size, numbers))
    if cables == 2 and draw(st.integers(0, 3)) == 0:
        made.append(("slide", {"body": ("rope", 0.0), "along": "wire", "s": size}))
    for _ in range(draw(st.integers(0, 2))):
        made += draw(loads(numbers))
    return time, gravity, made


@st.composite
def supports(draw, cable: str, s: float, numbers: dict):
    turn = {"rotation": ((0, 0, 1), draw(signals(1.0, numbers["time"], True)))} if draw(st.booleans()) else {}
    move = {"displacement": (draw(signals(0.1 * numbers["size"], numbers["time"], True)), 0, 0)}
    return draw(st.sampled_from([
        [("clamp", {"cable": cable, "s": s, "fix": draw(st.sampled_from(["section", "all"]))})],
        [("motion", {"cable": cable, "s": s, **(turn if turn and draw(st.booleans()) else move | turn)})]]))


@st.composite
def bodies(draw, name: str, place: float, numbers: dict, material, section):
    size, planar = numbers["size"], numbers["planar"]
    state = {"velocity": draw(vectors(numbers["rate"], planar)),
             "angular_velocity": (0, 0, draw(st.sampled_from([0.0, 1.0])) / numbers["time"])}
    if draw(st.integers(0, 4)) == 0:
        return [("modal_body", {"name": name, "start": (place * size, 0, 0), "end": (place * size, -size, 0),
                                "section": section, "material": material, "elements": 2, "modes": 2,
                                "element": "beam12p" if planar else "beam24", "law": "structural", "up": (1, 0, 0),
                                "boundary": draw(st.sampled_from(["free", "attached"])), **state})]
    inertia = numbers["mass"] * size**2 * draw(decades(-6, 0))
    return [("rigid_body", {"name": name, "mass": numbers["mass"], "inertia": (inertia, inertia, inertia),
                            "position": (place * size, 0, 0),
                            "centre": draw(st.sampled_from([(0, 0, 0), (0, -0.1 * size, 0)])), **state})]


@st.composite
def slides(draw, body: str, s: float, numbers: dict):
    size, time = numbers["size"], numbers["time"]
    stops = st.sampled_from(["error", "leave", fu.HardStop(restitution=0.5),
                             fu.Buffer(length=0.1 * size, stiffness=numbers["force"] / size)])
    more = draw(st.sampled_from([
        {}, {"drive": fu.Ramp(start=0, end=time, before=s, after=1.1 * s)},
        {"velocity": draw(signals(0.1 * size / time, time))},
        {"friction": fu.Friction(coefficient=0.2, static_coefficient=0.3, model="stick")},
        {"friction": fu.Friction(coefficient=0.1, viscous=numbers["force"] / numbers["rate"],
                                 velocity=1e-3 * numbers["rate"])}]))
    if not {"drive", "velocity"} & set(more):
        more |= {"at_start": draw(stops), "at_end": draw(stops)}
    frame = draw(st.sampled_from([{}, {"frame": "tangent"}, {"frame": "tangent", "roll": "fixed"},
                                  {"frame": "section"}]))
    return [("slide", {"body": body, "along": "wire", "s": s, "name": f"trolley_{body}", **frame, **more})]


@st.composite
def joints(draw, body: str, x: float, numbers: dict):
    size, time = numbers["size"], numbers["time"]
    point, below = (x, 0.0, 0.0), (x, -size, 0.0)
    z = (0, 0, 1)
    kind = draw(st.sampled_from([
        {"kind": "spherical", "b": point}, {"kind": "revolute", "b": point, "axis": z},
        {"kind": "revolute", "b": point, "axis": z, "angle": draw(signals(1.0, time, True))},
        {"kind": "universal", "b": point, "axis": z, "second_axis": (1, 0, 0)},
        {"kind": "prismatic", "b": point, "axis": (1, 0, 0)},
        {"kind": "prismatic", "b": point, "axis": (1, 0, 0), "velocity": draw(signals(0.1 * size / time, time))},
        {"kind": "cylindrical", "b": point, "axis": (1, 0, 0)}, {"kind": "weld", "b": point},
        {"kind": "distance", "b": below}, {"kind": "distance", "b": below, "distance": size}]))
    return [("joint", {"a": body, **kind})]


@st.composite
def loads(draw, numbers: dict):
    size, time, force, planar = (numbers[name] for name in ("size", "time", "force", "planar"))
    scale = draw(signals(1.0, time))
    value = draw(vectors(force * draw(st.sampled_from([1.0, 10.0])), planar))
    follower = draw(st.booleans())
    turn = (0.0, 0.0, 0.1 * force * size)
    return [draw(st.sampled_from([
        ("force", {"on": "A", "value": value, "scale": scale, "follower": follower}),
        ("force", {"on": "wire", "s": 0.4 * size, "value": value, "scale": scale, "follower": follower}),
        ("distributed_force", {"cable": "wire", "value": tuple(v / size for v in value), "scale": scale}),
        ("moment", {"on": "A", "value": turn, "scale": scale}),
        ("moment", {"on": "wire", "s": size, "value": turn, "scale": scale}),
        ("spring", {"a": "A", "b": (0.0, size, 0.0), "stiffness": force / size, "damping": 0.1 * force * time / size}),
        ("spring", {"a": ("wire", 0.5 * size), "b": "A", "stiffness": force / size, "length": 0.1 * size}),
        ("event", {"quantity": "A.position.y", "value": -0.1 * size, "action": draw(st.sampled_from(["record", "stop"]))
                   }),
        ("event", {"quantity": "wire.velocity.y", "s": size}), ("event", {"quantity": "trolley_A.s", "value": size})]))]


def build(gravity, made) -> fu.Scene:
    """Return the scene of all accepted parts; refused ones are left out. Other errors pass."""
    scene = fu.Scene(gravity=gravity)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", fu.FunicularWarning)
        for method, keywords in made:
            try:
                getattr(scene, method)(**keywords)
            except FunicularError:
                pass
    return scene


@st.composite
def scenes(draw, spoilt: bool = True):
    """(time in s, scene); spoilt: occasionally with an invalid keyword of one part."""
    time, gravity, made = draw(parts())
    if spoilt and draw(st.integers(0, 3)) == 0:
        k = draw(st.integers(0, len(made) - 1))
        method, keywords = made[k]
        made[k] = method, keywords | {draw(st.sampled_from(sorted(keywords))): draw(nonsense)}
    return time, build(gravity, made)


@st.composite
def texts(draw):
    """The text of a scene file with one invalid value."""
    tables = tomllib.loads(draw(scenes(spoilt=False))[1].to_toml())
    _spoil(draw, tables)
    return "\n".join(f"{name} = {as_toml(value)}" for name, value in tables.items()) + "\n"


def _spoil(draw, into: dict | list) -> None:
    """Replace a nested value."""
    places = sorted(into) if isinstance(into, dict) else range(len(into))
    if not len(places):
        return
    place = draw(st.sampled_from(places))
    if isinstance(into[place], dict | list) and draw(st.integers(0, 3)):
        _spoil(draw, into[place])
    else:
        into[place] = draw(in_files)
