"""Small scenes from one level of each of several factors: a cable, its law, shape, pieces, growth, section and support,
its rider, a joint, a rope, a load, a fluid, a contact, an event, memory.

Levels come from the lists of the project. A kind in a list without an entry in a table here fails
`test_pairs_of_features.py`; with an entry, it is combined with everything else.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import funicular as fu
import numpy as np
from funicular.kernels.elements import built_in
from funicular.parts.cable_laws import possible_laws
from funicular.parts.joint import DRIVEN, ROUGH_KINDS
from funicular.parts.joint import JOINT_KINDS as JOINTS
from shared_scenes import section_of

TIME = 0.02
"""Duration of a run, s."""

SECTIONS = {"circle": fu.Circle(radius=0.01), "rectangle": fu.Rectangle(height=0.02, width=0.02),
            "tube": fu.Tube(outer_radius=0.01, inner_radius=0.006),
            "general": fu.GeneralSection(area=3e-4, second_moment_about_z=8e-9)}
SIGNALS = {"ramp": fu.Ramp(start=0, end=TIME, after=0.01), "pulse": fu.Pulse(start=0, end=TIME, height=0.01),
           "harmonic": fu.Harmonic(amplitude=0.01, frequency=20),
           "table": fu.TableSignal(time=[0, TIME, 3 * TIME], value=[0, 0.01, 0.0])}
SOLIDS = {"box": lambda folder: fu.Box(size=(0.1, 0.05, 0.05)), "sphere": lambda folder: fu.Sphere(radius=0.05),
          "cylinder": lambda folder: fu.Cylinder(radius=0.03, length=0.1),
          "mesh": lambda folder: fu.MeshShape(file=str(_tetrahedron(folder)))}
PROFILES = {"power": fu.PowerProfile(exponent=0.2, reference_height=10),
            "table": fu.TableProfile(height=[-5, 0, 5], factors=[0.5, 1.0, 1.2])}
STOPS = {"hard": fu.HardStop(restitution=0.5), "buffer": fu.Buffer(length=0.1, stiffness=100, damping=1)}
SURFACES: dict[str, Callable[[np.ndarray], object]] = {
    "plane": lambda top: fu.Plane(point=top, normal=(0, 1, 0)),
    "height_field": lambda top: fu.HeightField(x=[-2, -1, 0, 1, 2, 3, 4], heights=[float(top[1])] * 7),
    "sphere": lambda top: fu.Sphere(radius=0.3, at=top - (0, 0.3, 0)),
    "cylinder": lambda top: fu.Cylinder(radius=0.3, length=1.0, axis=(0, 0, 1), at=top - (0, 0.3, 0)),
    "capsule": lambda top: fu.Capsule(radius=0.3, length=1.0, axis=(0, 0, 1), at=top - (0, 0.3, 0)),
    "box": lambda top: fu.Box(size=(0.4, 0.2, 0.4), at=top - (0, 0.1, 0))}
"""The surface whose highest point is there; the plane z = 0 cuts each."""

DRAWN = {"straight": {}, "taut": {"rest_length": 0.995}, "hanging": {"shape": "hanging", "rest_length": 1.02},
         "curved": {"points": [(0, 0, 0), (0.5, -0.1, 0), (1, 0, 0)]},
         "bent": {"points": [(0, 0, 0), (0.5, -0.1, 0), (1, 0, 0)], "rest": "straight"},
         "uneven": {"nodes": [0, 0.2, 0.5, 1.0]}}
PIECES = {"none": (), "equal": (1.0, 1.0), "of two materials": (1.0, 2.0), "at a hinge": (1.0, 1.0)}
"""Young's moduli of the pieces of the wire, over that of its material; none: a wire without pieces."""
GROWTH: dict[str, dict] = {
    "none": {}, "temperature": {"temperature": -5.0},
    "temperature by a signal": {"temperature": fu.Ramp(start=0, end=TIME, after=-5.0)},
    "driven length": {"rest_length": fu.Ramp(start=0, end=TIME, before=1.0, after=0.999)}}
DAMPING = {"none": {}, "damping_time": {"damping_time": 1e-4}, "mass_damping": {"mass_damping": 2.0}}
STICK = fu.Friction(coefficient=0.3, model="stick")


@dataclass
class Site:
    """A growing scene: its cable, the middle of it, and a folder for files."""

    scene: fu.Scene
    folder: Path
    cable: fu.Cable
    planar: bool

    def at(self, part: float) -> float:
        """Return the arc-length at a share of the cable, m."""
        return part * self.cable.length

    def below(self, part: float, gap: float) -> np.ndarray:
        """Return the point at a distance below the cable, m."""
        return np.array(self.cable.point(self.at(part))) - (0, gap, 0)

    def body(self, name: str, position, **given) -> str:
        """Add a rigid body of 0.1 kg and return its name."""
        self.scene.rigid_body(name, mass=0.1, inertia=(1e-4, 1e-4, 1e-4), position=position, **given)
        return name

    def held(self, name: str, position, **given) -> str:
        """Add a body on springs to the ground that also hold its rotation, and return its name."""
        self.body(name, position, **given)
        for k, arm in enumerate([(0.1, 0, 0), (0, 0.1, 0), (0, 0, 0.1)][: 2 if self.planar else 3]):
            for sign in (1, -1):
                end = tuple(np.add(position, np.multiply(arm, 3 * sign)))
                self.scene.spring((name, tuple(np.multiply(arm, sign))), end, stiffness=300.0, damping=1.0,
                                  length=0.1, name=f"{name}_holds_{k}_{sign + 1}")
        return name

    def cross_cable(self, name: str, y: float) -> fu.Cable:
        """Add a taut cable of the same element below the middle, across in space, parallel in the plane; return it."""
        x, _, _ = self.below(0.5, 0)
        ends = {"start": (x - 0.4, y, 0), "end": (x + 0.4, y, 0)} if self.planar else {
            "start": (x, y, -0.4), "end": (x, y, 0.4)}
        other = self.scene.cable(name, **ends, elements=2, element=self.cable.element, rest_length=0.795, up=(0, 1, 0),
                                 section=fu.Circle(radius=0.01), material=self.cable.material)
        self.scene.pin(other, s=0)
        self.scene.pin(other, s=other.length)
        return other


# ---- supports of the cable's start

SUPPORTS: dict[str, Callable[[Site], object]] = {
    "pin": lambda on: on.scene.pin("wire", s=0),
    "clamp": lambda on: on.scene.clamp("wire", s=0),
    "clamp all": lambda on: on.scene.clamp("wire", s=0, fix="all"),
    "clamp at an angle": lambda on: on.scene.clamp("wire", s=0, direction=(1, 0.2, 0)),
    "motion, turned": lambda on: on.scene.motion("wire", s=0, rotation=((0, 0, 1), SIGNALS["ramp"])),
    "motion, free along": lambda on: on.scene.motion("wire", s=0, displacement=("free", SIGNALS["ramp"], 0)),
    **{f"motion by {form}": lambda on, signal=signal: on.scene.motion("wire", s=0, displacement=(0, signal, 0))
       for form, signal in SIGNALS.items()}}


def _tied(on: Site, rotation: str) -> None:
    """Tie another cable to the end of the wire, which a spring holds as well."""
    end = on.cable.point(on.cable.length)
    other = on.scene.cable("rope", start=end, end=(1.5, 0, 0), elements=2, element=on.cable.element, up=(0, 1, 0),
                           rest_length=0.4975, section=fu.Circle(radius=0.01), material=on.cable.material)
    on.scene.pin(other, s=other.length)
    on.scene.spring(("wire", on.cable.length), (1, 0.3, 0), stiffness=1e4, name="hangs")
    on.scene.tie(on.cable, s=on.cable.length, to=other, at=0.0, rotation=rotation)


ENDS = {"pin": lambda on: on.scene.pin("wire", s=on.cable.length), **{
    f"tie, {rotation}": partial(_tied, rotation=rotation) for rotation in ("rigid", "free")}}


# ---- riders

def _rides(on: Site, **given) -> None:
    on.scene.slide(on.held("A", on.below(0.4, 0)), along="wire", s=on.at(0.4), name="trolley", **given)


def _modal_rider(on: Site, boundary: str) -> None:
    top = on.below(0.4, 0)
    on.scene.modal_body("A", start=top, end=top - (0, 0.3, 0), section=fu.Circle(radius=0.01), elements=2, modes=2,
                        material=fu.Material(youngs_modulus=1e8, poisson_ratio=0.3, density=500), law="structural",
                        element="beam12p" if on.planar else "beam24", boundary=boundary, up=(1, 0, 0))
    on.scene.spring("A", tuple(np.add(top, (-0.5, -0.1, 0))), stiffness=300, name="holds_A")
    at = (-0.15, 0, 0) if boundary == "free" else (0, 0, 0)  # whose frame is at its mass centre
    on.scene.slide("A", at=at, along="wire", s=on.at(0.4), name="trolley")


def _hanging_cable(on: Site) -> None:
    top = on.below(0.4, 0)
    on.scene.cable("hanger", start=top, end=top - (0, 0.3, 0), elements=2, element=on.cable.element, up=(1, 0, 0),
                   section=fu.Circle(radius=0.01), material=on.cable.material)
    on.scene.spring(("hanger", 0.0), tuple(np.add(top, (-0.5, 0, 0))), stiffness=300, name="holds_hanger")
    on.scene.slide(("hanger", 0.0), along="wire", s=on.at(0.4), name="trolley")


def _at_its_end(on: Site, end: object) -> None:
    at = on.cable.length
    on.scene.slide(on.held("A", on.below(0.95, 0), velocity=(0.1, 0, 0)), along="wire", s=0.95 * at, name="trolley",
                   at_start=end, at_end=end)


RIDERS: dict[str, Callable[[Site], object]] = {
    "none": lambda on: None,
    "point": _rides,
    "tangent": partial(_rides, frame="tangent"),
    "tangent, fixed": partial(_rides, frame="tangent", roll="fixed"),
    "section": partial(_rides, frame="section"),
    "drive": lambda on: _rides(on, drive=fu.Ramp(start=0, end=TIME, before=on.at(0.4), after=on.at(0.42))),
    "velocity": partial(_rides, velocity=SIGNALS["harmonic"]),
    "brake by a signal": partial(_rides, friction=fu.Friction(coefficient=0.2, model="stick", scale=SIGNALS["ramp"])),
    "regularised friction": partial(_rides, friction=fu.Friction(coefficient=0.2, viscous=0.1, rolling=0.01)),
    "sticking friction": partial(_rides, friction=STICK),
    "eyelet": lambda on: on.scene.slide(tuple(on.below(0.4, 0)), along="wire", s=on.at(0.4), name="trolley"),
    "cable": _hanging_cable,
    **{f"modal, {boundary}": partial(_modal_rider, boundary=boundary) for boundary in ("free", "attached")},
    **{f"{stop} stop": partial(_at_its_end, end=end) for stop, end in STOPS.items()},
    **{f"{word} at the end": partial(_at_its_end, end=word) for word in ("error", "leave")}}


# ---- joints

AXES = {"revolute": {"axis": (0, 0, 1)}, "universal": {"axis": (0, 0, 1), "second_axis": (1, 0, 0)},
        "prismatic": {"axis": (0, 1, 0)}, "cylindrical": {"axis": (0, 1, 0)}}


def _rough_joint(on: Site, kind: str, friction: object = None, **given) -> None:
    """Join a body below the cable to the ground by a joint with friction."""
    place = tuple(on.below(0.6, 0.2))
    on.held("J", place)
    on.scene.joint(kind, place, "J", **AXES[kind], friction=friction or fu.Friction(coefficient=0.2, velocity=0.01),
                   name="joint", **{} if kind == "prismatic" else {"radius": 0.02}, **given)


def _joint(on: Site, kind: str, driven: bool) -> None:
    """Join a body below the cable to it, or, if driven, to the ground."""
    place, above = tuple(on.below(0.6, 0.2)), tuple(on.below(0.6, 0))
    on.held("J", place)
    signal = {DRIVEN[kind]: fu.Ramp(start=0, end=TIME, before=0.2, after=0.21) if kind == "distance" else
              SIGNALS["ramp"]} if driven else {}
    other = (above if kind == "distance" else place) if driven else ("wire", on.at(0.6))
    ends = (other, "J") if driven or kind == "distance" else (other, ("J", (0, 0.2, 0)))
    tangent_alone = not on.planar and not on.cable.kind_of_element.director
    up = {"up": (0, 1, 0)} if tangent_alone and not driven and (kind in AXES or kind == "weld") else {}
    on.scene.joint(kind, *ends, **AXES.get(kind, {}), **signal, **up, name="joint")


JOINED: dict[str, Callable[[Site], object]] = {
    "none": lambda on: None,
    **{kind: partial(_joint, kind=kind, driven=False) for kind in JOINTS},
    **{f"rough {kind}": partial(_rough_joint, kind=kind) for kind in ROUGH_KINDS},
    "brake": partial(_rough_joint, kind="revolute", normal_force=5.0),
    "joint that sticks": partial(_rough_joint, kind="revolute", friction=STICK),
    "brake that sticks": partial(_rough_joint, kind="prismatic", friction=STICK, normal_force=5.0),
    **{f"driven {kind}": partial(_joint, kind=kind, driven=True) for kind in DRIVEN}}


# ---- ropes

ROUGH = fu.Friction(coefficient=0.2)
STUCK = fu.Friction(coefficient=0.2, model="stick")
OF_ROPE = {"section": fu.Circle(radius=0.002),
           "material": fu.Material(youngs_modulus=1e7, poisson_ratio=0.3, density=1000, damping_time=1e-4)}


def _rope(on: Site, carried: bool = False, first: object = None, also: Callable[[Site], object] | None = None,
          mass: bool = True, **given) -> None:
    """Hang a body on a rope from the ground, or from a drum, over a sheave beside the cable, which a held body may
    carry.
    """
    x, y, _ = on.below(1.0, 0)
    on.body("load", (x + 1.6, y - 1.0, 0))
    at = (on.held("post", (x + 1.4, y, 0)), (0, 0.05, 0)) if carried else (x + 1.4, y, 0)
    element = {} if on.planar else {"element": "cable12"}
    first = first or fu.Anchor(at=(x + 0.8, y - 0.8, 0))
    on.scene.rope("hoist", route=[first, fu.Sheave("top", at=at, radius=0.2, **given), fu.Anchor("load")],
                  elements=2, tension=0.981, mass=mass, **element, **OF_ROPE)
    if also is not None:
        also(on)


def _on_the_cable(on: Site) -> None:
    """Hang a body on a rope from the ground over a sheave in the middle of the cable."""
    s = on.cable.length / 2
    x, y, z = on.cable.point(s)
    on.body("load", (x + 0.1, y - 1.0, z))
    element = {} if on.planar else {"element": "cable12"}
    on.scene.rope("hoist", route=[fu.Anchor(at=(x - 0.1, y - 0.8, z)), fu.Sheave(
        "top", at=("wire", s), radius=0.1, side="right"), fu.Anchor("load")], elements=2, tension=0.981, **element,
        **OF_ROPE)


def _belt(on: Site) -> None:
    """Drive a belt around two sheaves beside the cable."""
    x, y, _ = on.below(1.0, 0)
    element = {} if on.planar else {"element": "cable12"}
    route = [fu.Sheave("driver", at=(x + 1.4, y, 0), radius=0.2, side="left", friction=STUCK, zones=1,
                       velocity=SIGNALS["ramp"]),
             fu.Sheave("driven", at=(x + 2.4, y, 0), radius=0.1, side="left", friction=STUCK, zones=1, inertia=1e-3,
                       damping=0.1)]
    on.scene.rope("belt", route=route, closed=True, elements=2, tension=5.0, **element, **OF_ROPE)


def _drum(**given) -> fu.Drum:
    """Return a drum below the sheave beside the cable."""
    return fu.Drum("winch", at=(1.8, -0.8, 0), radius=0.1, side="right", length_in_store=2.0, **given)


def _blown(on: Site) -> None:
    """Blow at the rope."""
    on.scene.fluid("air", density=1.2, velocity=(3.0, 0, 0))
    on.scene.drag("hoist", fluid="air", normal=1.2, name="wind_on_rope")


def _leant(on: Site, friction: object = 0.2) -> None:
    """Hold a rough bollard beside the rope's first span."""
    x, y, _ = on.below(1.0, 0)
    on.scene.surface("bollard_side", fu.Cylinder(1.0, 1.0), on=on.held("bollard", (x + 0.104, y + 0.071, 0)))
    on.scene.contact("hoist", "bollard_side", stiffness=1e3, damping=0.1, radius=0.002, friction=friction,
                     name="lean")


ROPES: dict[str, Callable[[Site], object]] = {
    "none": lambda on: None,
    "rope": _rope,
    "rope on a rough sheave": partial(_rope, friction=ROUGH, zones=3),
    "rope that sticks": partial(_rope, friction=STUCK, zones=2),
    "rope on a sheave that turns": partial(_rope, friction=ROUGH, zones=2, inertia=1e-3),
    "rope on a driven sheave": partial(_rope, friction=ROUGH, zones=2, velocity=SIGNALS["ramp"]),
    "rope over a body": partial(_rope, carried=True),
    "rope on the cable": _on_the_cable,
    "rope on a drum": partial(_rope, first=_drum(velocity=SIGNALS["ramp"])),
    "rope on a drum over a body": partial(_rope, carried=True, first=_drum()),
    "loaded rope": partial(_rope, also=lambda on: on.scene.force("hoist", s=0.1, value=(0.0, -0.1, 0))),
    "rope on a rough body": partial(_rope, also=_leant),
    "rope that sticks to a body": partial(_rope, also=partial(_leant, friction=STUCK)),
    "rope in a wind": partial(_rope, also=_blown),
    "belt": _belt,
    "rope without mass": partial(_rope, mass=False),
    "rope without mass over a body": partial(_rope, mass=False, carried=True, friction=STUCK,
                                             first=_drum(velocity=SIGNALS["ramp"]))}


# ---- loads and springs

def _sprung(on: Site, **given) -> None:
    on.held("B", tuple(on.below(0.7, 0.3)))
    on.scene.spring(("wire", on.at(0.7)), "B", name="spring", **given)


def _pushed_when_falling(on: Site) -> None:
    on.scene.event("falling", quantity="wire.velocity.y", s=on.cable.node_s[1], value=-1e-3)
    on.scene.force("wire", s=on.at(0.3), value=(0, -20, 0), when="falling")


LOADS: dict[str, Callable[[Site], object]] = {
    "none": lambda on: None,
    **{f"force by {form}": lambda on, signal=signal: on.scene.force("wire", s=on.at(0.3), value=(0, -20, 0),
                                                                    scale=signal) for form, signal in SIGNALS.items()},
    "force": lambda on: on.scene.force("wire", s=on.at(0.3), value=(0, -1, 0)),
    "following force": lambda on: on.scene.force("wire", s=on.at(0.3), value=(1, 0, 0), follower=True),
    "moving force": lambda on: on.scene.force("wire", s=SIGNALS["ramp"], offsets=(0, 0.1), value=(0, -20, 0)),
    "line load": lambda on: on.scene.distributed_force("wire", value=(0, -1, 0), start=0.1, stop=on.at(0.5)),
    "following line load": lambda on: on.scene.distributed_force("wire", value=(1, 0, 0), follower=True),
    "moment": lambda on: on.scene.moment("wire", s=on.at(0.3), value=(0, 0, 0.01)),
    "force on a body": lambda on: on.scene.force(on.held("B", tuple(on.below(0.7, 0.3))), value=(1, 0, 0),
                                                 at=(0, 0.05, 0), follower=True),
    "ice": lambda on: on.scene.ice("wire", thickness=fu.Ramp(start=0, end=TIME, before=0, after=0.002), diameter=0.02),
    "point mass": lambda on: on.scene.point_mass("wire", s=on.at(0.3), mass=0.2),
    "moment on a body": lambda on: on.scene.moment(on.held("B", tuple(on.below(0.7, 0.3))), value=(0, 0, 0.01)),
    "spring": partial(_sprung, stiffness=50, damping=0.5, length=0.2),
    "spring that pulls": partial(_sprung, stiffness=50, damping=0.5, length=0.29, tension_only=True),
    "spring with play": partial(_sprung, stiffness=50, length=0.3, free_play=0.01),
    "spring by table": partial(_sprung, length=0.25, table=fu.ForceTable(extension=[0, 0.1], tension=[0, 5])),
    "spring of driven length": partial(_sprung, stiffness=50, length=fu.Ramp(start=0, end=TIME, before=0.2,
                                                                             after=0.21)),
    "spring of driven stiffness": partial(_sprung, length=0.2, stiffness=fu.Ramp(start=0, end=TIME, before=5, after=9)),
    "force by an event": _pushed_when_falling,
    "spring without length": partial(_sprung, stiffness=5, length=0.0)}


# ---- fluids

def _drag(on: Site, fluid: dict | None = None, **given) -> None:
    on.scene.fluid("water", density=300, **fluid or {"velocity": (0.3, 0, 0)})
    on.scene.drag("wire", **{"normal": 1.2, "tangential": 0.02} | given, name="drag")


def _mass_drag(on: Site, **given) -> None:
    on.scene.fluid("water", density=300, velocity=(0.3, 0, 0))
    on.scene.drag(on.scene.point_mass("wire", s=on.at(0.45), mass=0.1), area=0.01, volume=1e-5, name="drag", **given)


def _body_drag(on: Site, **given) -> None:
    on.scene.fluid("water", density=300, velocity=(0.3, 0, 0))
    span = {"span": (0, 0, 1)} if {"lift", "polar"} & given.keys() else {}
    on.scene.drag(on.held("D", tuple(on.below(0.8, 0.3))), area=0.01, name="drag", **span, **given)


POLAR = fu.Polar(angle=np.linspace(-np.pi, np.pi, 5), drag=[1.0, 0.8, 0.5, 0.8, 1.0], lift=[0.0, -0.1, 0.0, 0.1, 0.0],
                 moment=[0.0, 0.1, 0.0, -0.1, 0.0])
"""It turns the chord into the flow."""

BODY_POLAR = fu.Polar(angle=[-np.pi, 0, np.pi], drag=[1.0, 0.5, 1.0], lift=[0.0, 0.2, 0.0])
FLUIDS: dict[str, Callable[[Site], object]] = {
    "none": lambda on: None,
    "drag": _drag,
    "added mass": partial(_drag, added_mass=1.0, added_mass_tangential=0.1),
    "added mass by Morison": partial(_drag, added_mass=1.0, added_mass_tangential=0.1, added_mass_form="morison"),
    "lift": partial(_drag, lift=0.3),
    "polar": lambda on: _drag(on, {"velocity": (0, 0.3, 0)}, normal=0.0, polar=POLAR, chord=(0, -1, 0.1)),
    "current that changes": partial(_drag, fluid={"velocity": (0.3, 0, 0), "scale": SIGNALS["harmonic"]},
                                    added_mass=1.0),
    "waves": partial(_drag, fluid={"surface": 0.5, "depth": 4.0, "waves": [fu.Wave(0.05, period=1.5)]}, added_mass=0.5),
    "table of velocities": partial(_drag, fluid={"table": fu.VelocityTable(
        interpolation="linear", time=[0, 0.5, 1.0], y=[-2, 0, 2], velocity=0.2 * np.ones((3, 3, 3)) * [1, 0, 0])}),
    **{f"profile by {form}": partial(_drag, fluid={"velocity": (0.3, 0, 0), "profile": profile})
       for form, profile in PROFILES.items()},
    "drag of a point mass": _mass_drag,
    "added mass of a point mass": partial(_mass_drag, added_mass=0.5),
    "drag of a body": partial(_body_drag, coefficient=0.5, volume=1e-5, at=(0, 0.01, 0)),
    "added mass of a body": partial(_body_drag, added_mass=0.5, volume=1e-5),
    "added mass of a body by Morison": partial(_body_drag, added_mass=0.5, volume=1e-5, added_mass_form="morison"),
    "polar of a body": partial(_body_drag, polar=BODY_POLAR, chord=(1, 0, 0)),
    "lift of a body": partial(_body_drag, lift=0.2)}


# ---- contact and crossings

def _bed(on: Site, shape: str, **given) -> None:
    """Place a surface in contact with the cable below its middle."""
    on.scene.surface("bed", SURFACES[shape](on.below(0.5, 0.0099)))
    on.scene.contact("wire", "bed", **{"stiffness": 2e3, "damping": 0.1, "name": "lying", "radius": 0.01} | given)


def _foot(on: Site, shape: str, **given) -> None:
    """Place a held body on a surface beside the cable."""
    top = np.array([3.0, -0.5, 0.0])
    on.scene.surface("floor", SURFACES[shape](top))
    on.held("T", (3.0, -0.4 if "restitution" in given else -0.4001, 0.0))
    on.scene.contact("T", "floor", **{"points": [(0, -0.1, 0)], "name": "foot"} | given)


def _bar(on: Site, on_body: bool, **given) -> None:
    x, y, _ = on.below(0.5, 0.0199)
    across = {} if on.planar else {"axis": (0, 0, 1), "length": 0.3}
    body = {"b": on.held("C", (x, y, 0.0))} if on_body else {"at": (x, y, 0.0)}
    on.scene.crossing("wire", **body, **across, radius=0.02, stiffness=2e3, name="crossing", **given)


def _crossed(on: Site, **given) -> None:
    across = on.cross_cable("across", on.below(0.5, 0.0199)[1])
    on.scene.crossing("wire", across, stiffness=2e3, name="crossing", radius=0.02, **given)


TOUCHING: dict[str, Callable[[Site], object]] = {
    "none": lambda on: None,
    **{f"cable on {shape}": partial(_bed, shape=shape) for shape in SURFACES},
    **{f"body on {shape}": partial(_foot, shape=shape, stiffness=2e3, damping=0.1) for shape in SURFACES},
    **{f"hard on {shape}": partial(_foot, shape=shape, restitution=0.3) for shape in SURFACES},
    "cable on rough plane": partial(_bed, shape="plane", friction=0.3),
    "body on rough plane": partial(_foot, shape="plane", stiffness=2e3, friction=0.3, exponent=1.5, radius=0.01,
                                   tangential_stiffness=1e3),
    "hard on rough plane": partial(_foot, shape="plane", restitution=0.3, friction=0.3),
    "bar": partial(_bar, on_body=False),
    "bar on a body": partial(_bar, on_body=True, friction=0.2, exponent=1.5, damping=0.1),
    "cables": _crossed,
    "cables that stick": partial(_crossed, friction=STICK)}


# ---- events, and pictures of bodies

def _drawn_body(on: Site, kind: str) -> None:
    on.held("P", (0.5, 1.0, 0.0), shape=SOLIDS[kind](on.folder))


EVENTS: dict[str, Callable[[Site], object]] = {
    "none": lambda on: None,
    "record": lambda on: on.scene.event(quantity="wire.velocity.y", s=on.at(1.0), value=-1e-3),
    "stop": lambda on: on.scene.event(quantity="wire.velocity.y", s=0.0, value=0.5, action="stop", direction="rising"),
    "function": lambda on: on.scene.event(function=lambda time, state: time - TIME / np.pi, name="later"),
    **{f"drawn {kind}": partial(_drawn_body, kind=kind) for kind in SOLIDS}}


def laws() -> dict[str, list[str]]:
    """Return the laws of each element."""
    return {element: possible_laws(kind) for element, kind in built_in().items()}


def _fibres(on: Site) -> None:
    """Add a taut rope of fibres below the middle, with working curves."""
    x, y, _ = on.below(0.5, 3.0)
    rope = on.scene.cable("fibres", start=(x - 0.4, y, 0), end=(x + 0.4, y, 0), elements=2, rest_length=0.795,
                          element="cable8p" if on.planar else "cable12", membrane="tabulated", up=(0, 1, 0),
                          section=fu.Circle(radius=0.01, tension_table=fu.TensionTable(strain=(0, 0.1),
                                                                                       force=(0, 1e3))),
                          material=fu.Material(youngs_modulus=3e7, poisson_ratio=0.3, density=1000))
    on.scene.pin(rope, s=0)
    on.scene.pin(rope, s=rope.length)
    on.scene.working_curve(rope, permanent=0.3)


MEMORY: dict[str, Callable[[Site], object]] = {
    "none": lambda on: None, "relaxation": lambda on: on.scene.relaxation("wire", stiffness=1e3, time=TIME),
    "wire_friction": lambda on: on.scene.wire_friction("wire", stiffness=0.2, moment=0.01),
    "working_curve": _fibres}

FACTORS: dict[str, list[str]] = {
    "element": ["cable12", *sorted(built_in().keys() - {"cable12"})],
    "law": ["default", *dict.fromkeys(law for of in laws().values() for law in of)],
    "drawn": [*DRAWN], "pieces": [*PIECES], "growth": [*GROWTH], "section": [*SECTIONS],
    "damping": [*DAMPING], "support": [*SUPPORTS], "end": [*ENDS],
    "rider": [*RIDERS], "joint": [*JOINED], "rope": [*ROPES], "load": [*LOADS], "fluid": [*FLUIDS],
    "touch": [*TOUCHING], "event": [*EVENTS], "memory": [*MEMORY]}
"""By factor its levels, the first of which is neutral."""

ADDED = {"memory": MEMORY, "support": SUPPORTS, "end": ENDS, "rider": RIDERS, "joint": JOINED, "rope": ROPES,
         "load": LOADS, "fluid": FLUIDS, "touch": TOUCHING, "event": EVENTS}


def _made_of(section: object, material: fu.Material, row: dict[str, str]) -> dict:
    """Return the section, material and mesh of the wire, or its pieces."""
    if ratios := PIECES[row["pieces"]]:
        modulus = material.youngs_modulus
        return {"pieces": [fu.Piece(
            length=length, section=section, elements=elements, hinge=k > 0 and row["pieces"] == "at a hinge",
            material=material.remade({"youngs_modulus": ratio * modulus}))
            for k, (length, elements, ratio) in enumerate(zip((0.4, 0.6), (1, 2), ratios, strict=True))]}
    mesh = {} if "nodes" in DRAWN[row["drawn"]] else {"elements": 3}
    return {"section": section, "material": material} | mesh


def build(row: dict[str, str], folder: Path) -> fu.Scene:
    """Return the scene of a row of levels. Raises FunicularError if it is refused."""
    scene = fu.Scene(gravity=(0, -9.81, 0))
    section, law = SECTIONS[row["section"]], {} if row["law"] == "default" else {"law": row["law"]}
    helical = (row["element"], row["law"]) == ("beam24", "structural")
    if row["section"] == "general" and row["element"].startswith("beam"):
        section = fu.GeneralSection(area=3e-4, second_moment_about_z=8e-9, torsion_constant=1.5e-8,
                                    shear_factors=(0.9, 0.9),
                                    torque_per_tension=1e-3 * helical)
    section = section_of(row["law"], section)
    material = fu.Material(youngs_modulus=1e7, poisson_ratio=0.0, density=1000, thermal_expansion=1e-4,
                           **DAMPING[row["damping"]])
    shape = DRAWN[row["drawn"]] | GROWTH[row["growth"]]
    line = shape if "points" in shape else {"start": (0, 0, 0), "end": (1, 0, 0)} | shape
    wire = scene.cable("wire", **line, **_made_of(section, material, row), element=row["element"], **law)
    on = Site(scene, folder, wire, planar=wire.dim == 2)
    for factor, levels in ADDED.items():
        levels[row[factor]](on)
    scene.run_settings = {"duration": TIME, "tol": 1e-2, "output_step": TIME / 2}
    return scene


def random_row(seed: int) -> dict[str, str]:
    """Return a row for `build` with a random element, and random levels of three other factors, without ropes, whose
    pairs with all levels are tested elsewhere.
    """
    rng = np.random.default_rng(seed)
    row = {factor: levels[0] for factor, levels in FACTORS.items()}
    some = rng.choice([factor for factor in FACTORS if factor not in ("element", "law", "rope")], 3, replace=False)
    return row | {factor: str(rng.choice(FACTORS[factor])) for factor in ("element", *some)}


def _tetrahedron(folder: Path) -> Path:
    path = folder / "solid.stl"
    corners = np.array([(0, 0, 0), (0.1, 0, 0), (0, 0.1, 0), (0, 0, 0.1)])
    faces = "".join("facet normal 0 0 0\nouter loop\n" + "".join("vertex {} {} {}\n".format(*corners[k]) for k in face)
                    + "endloop\nendfacet\n" for face in [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)])
    path.write_text(f"solid body\n{faces}endsolid body\n", encoding="utf-8")
    return path
