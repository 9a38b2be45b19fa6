"""Written by `python tests/scene_stub.py` from the fields of the parts: change those, and run it again."""

import os
from collections.abc import Callable, Sequence
from inspect import Signature
from typing import Any, TypeAlias

import numpy as np

from .branch import Relaxation, WireFriction
from .cable import Cable
from .contact import Contact
from .crossing import Crossing
from .drag import Drag
from .end_stops import Stop
from .event import Event
from .flow_profile import Profile
from .fluid import Fluid
from .force_segments import ForceTable
from .friction import Friction
from .ice import Ice
from .joint import Joint
from .load import DistributedForce, Force, Moment
from .material import Material
from .modal_body import ModalBody
from .part import Part
from .piece import Piece
from .point_mass import PointMass
from .polar import Polar
from .rigid_body import RigidBody
from .rope import Rope
from .rope_items import Anchor, Block, Drum, Sheave
from .scene_data import SceneData
from .section import Section
from .signal import Signal
from .slide import Slide
from .solids import Solid
from .spring import Spring
from .support import Clamp, Motion, Pin, Tie
from .surface import Surface
from .velocity_table import VelocityTable
from .wave import Wave
from .working_curve import WorkingCurve

Numbers: TypeAlias = Sequence[float] | np.ndarray
Points: TypeAlias = Sequence[Numbers] | np.ndarray
Named: TypeAlias = Part | str
Place: TypeAlias = Named | Numbers | tuple[Named, float] | tuple[Named, Numbers]
Scale: TypeAlias = Signal | float

def signature(kind: type[Part]) -> Signature: ...

class SceneMethods(SceneData):
    def cable(
        self,
        name: str,
        *,
        start: Numbers | None = None,
        end: Numbers | None = None,
        points: Points | None = None,
        curve: Callable[..., Any] | None = None,
        shape: str | None = None,
        elements: int | None = None,
        nodes: Numbers | None = None,
        library: str | os.PathLike[str] | None = None,
        element: str = "beam24",
        law: str | None = None,
        strain: str | None = None,
        curvature: str | None = None,
        membrane: str | None = None,
        pieces: Sequence[Piece | dict[str, Any]] | None = None,
        section: Section | None = None,
        material: Material | None = None,
        up: Numbers = (0.0, 1.0, 0.0),
        rest: str = "drawn",
        rest_length: Scale | None = None,
        temperature: Scale | None = None,
        velocity: Numbers = (0.0, 0.0, 0.0),
        angular_velocity: Numbers = (0.0, 0.0, 0.0),
    ) -> Cable:
        """Add a Cable, which see."""

    def point_mass(
        self,
        on: Named,
        *,
        s: float,
        mass: float,
        name: str | None = None,
    ) -> PointMass:
        """Add a PointMass, which see."""

    def pin(
        self,
        cable: Named,
        *,
        s: float,
    ) -> Pin:
        """Add a Pin, which see."""

    def clamp(
        self,
        cable: Named,
        *,
        s: float,
        fix: str = "section",
        direction: Numbers | None = None,
    ) -> Clamp:
        """Add a Clamp, which see."""

    def motion(
        self,
        cable: Named,
        *,
        s: float,
        displacement: Sequence[Scale | str | None] | None = None,
        rotation: tuple[Numbers, Scale] | None = None,
    ) -> Motion:
        """Add a Motion, which see."""

    def tie(
        self,
        cable: Named,
        *,
        s: float,
        to: Named,
        at: float,
        rotation: str = "rigid",
        name: str | None = None,
    ) -> Tie:
        """Add a Tie, which see."""

    def rigid_body(
        self,
        name: str,
        *,
        mass: float,
        inertia: Numbers | Points,
        position: Numbers,
        orientation: Numbers = (1.0, 0.0, 0.0, 0.0),
        centre: Numbers = (0.0, 0.0, 0.0),
        velocity: Numbers = (0.0, 0.0, 0.0),
        angular_velocity: Numbers = (0.0, 0.0, 0.0),
        shape: Solid | None = None,
    ) -> RigidBody:
        """Add a RigidBody, which see."""

    def modal_body(
        self,
        name: str,
        *,
        start: Numbers | None = None,
        end: Numbers | None = None,
        section: Section | None = None,
        material: Material | None = None,
        up: Numbers = (0.0, 1.0, 0.0),
        elements: int = 10,
        element: str = "beam24",
        law: str | None = None,
        modes: int = 5,
        boundary: str = "free",
        data: str | os.PathLike[str] | None = None,
        orthogonal: bool = True,
        position: Numbers | None = None,
        orientation: Numbers = (1.0, 0.0, 0.0, 0.0),
        damping_ratio: float = 0.0,
        velocity: Numbers = (0.0, 0.0, 0.0),
        angular_velocity: Numbers = (0.0, 0.0, 0.0),
    ) -> ModalBody:
        """Add a ModalBody, which see."""

    def rope(
        self,
        name: str,
        *,
        route: Sequence[Anchor | Block | Drum | Sheave | dict[str, Any]],
        section: Section,
        material: Material,
        closed: bool = False,
        elements: int | Sequence[int] = 4,
        tension: float | None = None,
        length: float | Sequence[float] | None = None,
        element: str = "cable8p",
        mass: bool = True,
        temperature: float | None = None,
    ) -> Rope:
        """Add a Rope, which see."""

    def joint(
        self,
        kind: str,
        a: Place,
        b: Place,
        *,
        axis: Numbers | None = None,
        second_axis: Numbers | None = None,
        up: Numbers | None = None,
        angle: Scale | None = None,
        distance: Scale | None = None,
        velocity: Scale | None = None,
        length: float | None = None,
        friction: Friction | float | None = None,
        radius: float | None = None,
        normal_force: float | None = None,
        name: str | None = None,
    ) -> Joint:
        """Add a Joint, which see."""

    def slide(
        self,
        body: Named | tuple[Named, float] | Numbers,
        *,
        along: Named,
        body_s: float | None = None,
        s: float | None = None,
        at: Numbers = (0.0, 0.0, 0.0),
        frame: str = "point",
        roll: str = "free",
        up: Numbers | None = None,
        drive: Scale | None = None,
        velocity: Scale | None = None,
        friction: Friction | float | None = None,
        at_start: str | Stop = "error",
        at_end: str | Stop = "error",
        name: str | None = None,
    ) -> Slide:
        """Add a Slide, which see."""

    def force(
        self,
        on: Named,
        *,
        value: Numbers,
        scale: Scale = 1.0,
        when: str | None = None,
        until: str | None = None,
        s: Scale | None = None,
        offsets: Numbers = (0.0,),
        shares: Numbers | None = None,
        at: Numbers | None = None,
        follower: bool = False,
        name: str | None = None,
    ) -> Force:
        """Add a Force, which see."""

    def distributed_force(
        self,
        cable: Named,
        *,
        value: Numbers,
        scale: Scale = 1.0,
        when: str | None = None,
        until: str | None = None,
        start: float | None = None,
        stop: float | None = None,
        follower: bool = False,
        name: str | None = None,
    ) -> DistributedForce:
        """Add a DistributedForce, which see."""

    def moment(
        self,
        on: Named,
        *,
        value: Numbers,
        scale: Scale = 1.0,
        when: str | None = None,
        until: str | None = None,
        s: float | None = None,
        name: str | None = None,
    ) -> Moment:
        """Add a Moment, which see."""

    def spring(
        self,
        a: Place,
        b: Place,
        *,
        stiffness: Scale | None = None,
        damping: float = 0.0,
        length: Scale | None = None,
        tension_only: bool = False,
        free_play: float = 0.0,
        table: ForceTable | dict[str, Numbers] | None = None,
        name: str | None = None,
    ) -> Spring:
        """Add a Spring, which see."""

    def fluid(
        self,
        name: str | None = None,
        *,
        density: float,
        surface: float | None = None,
        velocity: Numbers = (0.0, 0.0, 0.0),
        scale: Scale = 1.0,
        profile: Profile | None = None,
        table: VelocityTable | dict[str, Any] | None = None,
        waves: Sequence[Wave | dict[str, Any]] | None = None,
        depth: float | None = None,
    ) -> Fluid:
        """Add a Fluid, which see."""

    def drag(
        self,
        on: Named,
        *,
        fluid: Named | None = None,
        start: float | None = None,
        stop: float | None = None,
        normal: float = 0.0,
        tangential: float = 0.0,
        diameter: float | None = None,
        displaced_area: float | None = None,
        lift: float = 0.0,
        area: float = 0.0,
        coefficient: float | None = None,
        polar: Polar | dict[str, Any] | None = None,
        span: Numbers | None = None,
        chord: Numbers | None = None,
        at: Numbers | None = None,
        volume: float = 0.0,
        height: float | None = None,
        added_mass: float | Numbers | Points | None = None,
        added_mass_tangential: float = 0.0,
        added_mass_form: str = "lagrange",
        name: str | None = None,
    ) -> Drag:
        """Add a Drag, which see."""

    def ice(
        self,
        cable: Named,
        *,
        thickness: Scale,
        density: float = 900.0,
        start: float | None = None,
        stop: float | None = None,
        diameter: float | None = None,
        name: str | None = None,
    ) -> Ice:
        """Add a Ice, which see."""

    def working_curve(
        self,
        cable: Named,
        *,
        permanent: float | None = None,
        form: str = "linear",
        bend: float = 0.0,
        strain: Numbers | None = None,
        force: Numbers | None = None,
        highest_tension: float = 0.0,
        name: str | None = None,
    ) -> WorkingCurve:
        """Add a WorkingCurve, which see."""

    def relaxation(
        self,
        cable: Named,
        *,
        stiffness: float,
        time: float,
        name: str | None = None,
    ) -> Relaxation:
        """Add a Relaxation, which see."""

    def wire_friction(
        self,
        cable: Named,
        *,
        stiffness: float,
        moment: float,
        name: str | None = None,
    ) -> WireFriction:
        """Add a WireFriction, which see."""

    def crossing(
        self,
        a: Named | Sequence[Named],
        b: Named | Sequence[Named] | None = None,
        *,
        stiffness: float,
        at: Numbers | None = None,
        axis: Numbers | None = None,
        length: float | None = None,
        radius: float | None = None,
        exponent: float = 1.0,
        damping: float = 0.0,
        friction: Friction | float | None = None,
        tangential_stiffness: float | None = None,
        side: Numbers | None = None,
        name: str | None = None,
    ) -> Crossing | list[Crossing]:
        """Add a Crossing, which see."""

    def surface(
        self,
        name: str,
        shape: Part | dict[str, Any],
        *,
        on: Named | None = None,
        at: Numbers = (0.0, 0.0, 0.0),
        inside: bool = False,
    ) -> Surface:
        """Add a Surface, which see."""

    def contact(
        self,
        a: Named | Sequence[Named],
        b: Named | Sequence[Named],
        *,
        stiffness: float | None = None,
        exponent: float = 1.0,
        damping: float = 0.0,
        friction: Friction | float | None = None,
        tangential_stiffness: float | None = None,
        radius: float | None = None,
        start: float | None = None,
        stop: float | None = None,
        restitution: float | None = None,
        rest_velocity: float = 0.001,
        points: Points | None = None,
        name: str | None = None,
    ) -> Contact | list[Contact]:
        """Add a Contact, which see."""

    def event(
        self,
        name: str | None = None,
        *,
        quantity: str | None = None,
        s: float | None = None,
        value: float = 0.0,
        function: Callable[..., Any] | None = None,
        direction: str = "both",
        action: str = "record",
    ) -> Event:
        """Add a Event, which see."""
