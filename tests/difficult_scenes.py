"""Scenes that contain all terms of a Newton matrix: rotating bodies, joints, friction, modes."""

import numpy as np
from funicular import Anchor, Buffer, Circle, Friction, Harmonic, Material, Ramp, Rectangle, Scene, Sheave


def rider() -> Scene:
    """Return a damped cable with a fast rotating rider, whose riding point is off its centre."""
    scene = Scene()
    scene.cable("wire", start=(0, 0, 0), end=(1.5, 0, 0), elements=3, section=Rectangle(height=0.05, width=0.04),
                material=Material(youngs_modulus=0.4e9, poisson_ratio=0.3, density=4200, damping_time=1e-4,
                                  mass_damping=0.7))
    scene.pin("wire", s=0.0)
    scene.rigid_body("A", mass=1.0, inertia=(0.02, 0.03, 0.04), position=(0.25, -0.1, 0.05), velocity=(1, 0.2, 0.1),
                     angular_velocity=(30, -20, 40))
    scene.slide("A", along="wire", s=0.25, at=(0, 0.1, -0.05))
    return scene


def loaded() -> Scene:
    """Return follower loads, springs between points of cables, bodies and the ground, and a fast rotating body."""
    scene = rider()
    scene.force("wire", s=1.2, value=(3, -20, 5), follower=True,
                scale=Harmonic(amplitude=1.0, frequency=3.0, offset=2.0))
    scene.distributed_force("wire", value=(0, 4, 8), start=0.2, stop=1.1, follower=True)
    scene.moment("wire", s=1.5, value=(1.0, 2.0, -3.0))
    scene.force("A", at=(0.1, 0.2, -0.1), value=(10, 20, -5))
    scene.force("A", at=(0.1, 0.2, -0.1), value=(4, -7, 6), follower=True)
    scene.moment("A", value=(0.5, -0.2, 0.3))
    scene.spring(("wire", 1.5), ("A", (0.1, 0, 0.2)), stiffness=700.0, damping=5.0, length=0.5)
    scene.spring(("wire", 0.3), (0.2, 1.0, 0.1), stiffness=300.0, damping=2.0)
    scene.spring("A", ("wire", 0.9), stiffness=90.0, damping=1.0, length=0.0)
    return scene


def planar() -> Scene:
    """Return the planar form of `loaded`."""
    scene = Scene()
    scene.cable("wire", start=(0, 0, 0), end=(1.5, 0, 0), elements=3, element="beam12p",
                section=Rectangle(height=0.05, width=0.04),
                material=Material(youngs_modulus=0.4e9, poisson_ratio=0.3, density=4200, damping_time=1e-4))
    scene.clamp("wire", s=0.0)
    scene.rigid_body("A", mass=1.0, inertia=(0.02, 0.03, 0.04), position=(0.25, -0.1, 0), velocity=(1, 0.2, 0),
                     angular_velocity=(0, 0, 40))
    scene.slide("A", along="wire", s=0.25, at=(0, 0.1, 0))
    scene.force("wire", s=1.2, value=(3, -20, 0), follower=True)
    scene.moment("wire", s=1.5, value=(0, 0, -3.0))
    scene.force("A", at=(0.1, 0.2, 0), value=(10, 20, 0))
    scene.force("A", at=(0.1, 0.2, 0), value=(4, -7, 0), follower=True)
    scene.moment("A", value=(0, 0, 0.3))
    scene.spring(("wire", 1.5), ("A", (0.1, 0, 0)), stiffness=700.0, damping=5.0, length=0.5)
    return scene


def frame() -> Scene:
    """Return two legs joined at an angle, a clamp whose tangent keeps one unknown, a tied cable, and moving nodes."""
    scene = Scene()
    steel = Material(youngs_modulus=1e8, poisson_ratio=0.3, density=4200)
    square = Rectangle(height=0.05, width=0.05)
    scene.cable("leg", start=(0, 0, 0), end=(0, 1, 0), elements=2, section=square, material=steel, up=(0, 0, 1))
    scene.cable("arm", start=(0, 1, 0), end=(1, 1.2, 0.3), elements=2, section=square, material=steel)
    scene.cable("rope", start=(0.2, 0.1, 1), end=(1, 1.2, 0.3), elements=3, element="cable12", section=square,
                material=steel)
    scene.motion("leg", s=0.0,
                 displacement=(0, Ramp(start=0, end=0.5, after=0.1), Harmonic(amplitude=0.1, frequency=2.0)),
                 rotation=((0, 1, 0), Ramp(start=0, end=1)))
    scene.tie("leg", s=1.0, to="arm", at=0.0)
    scene.tie("arm", s=scene.cables["arm"].length, to="rope", at=scene.cables["rope"].length, rotation="free")
    scene.clamp("rope", s=0.0)
    return scene


def star() -> Scene:
    """Return three damped cables that meet in different directions, two of them rigidly, with a rider and a spring."""
    scene = Scene()
    steel = Material(youngs_modulus=1e8, poisson_ratio=0.3, density=4200, damping_time=1e-4)
    square = Rectangle(height=0.05, width=0.05)
    legs = (("a", (0, 0, 0), "beam24"), ("b", (2, 1, 0), "beam24"), ("c", (1.5, -1, 1), "cable12"))
    for name, start, element in legs:
        scene.cable(name, start=start, end=(1, 0, 0), elements=3, element=element, section=square, material=steel)
        scene.pin(name, s=0.0)
    scene.tie("a", s=1.0, to="b", at=scene.cables["b"].length)
    scene.tie("a", s=1.0, to="c", at=scene.cables["c"].length, rotation="free")
    scene.rigid_body("A", mass=1.0, inertia=(0.02, 0.03, 0.04), position=(0.9, -0.1, 0.05), velocity=(1, 0.2, 0.1))
    scene.slide("A", along="a", s=0.9, at=(0, 0.1, -0.05))
    scene.spring(("a", 1.0), (1.0, 1.0, 0.1), stiffness=300.0, damping=2.0)
    return scene


def modal() -> Scene:
    """Return two modal bodies that spin and vibrate, one damped, beside a rider."""
    scene = rider()
    rubber = Material(youngs_modulus=2e5, poisson_ratio=0.3, density=1100)
    scene.modal_body("link", start=(0, 1, 0), end=(0.3, 1.4, 0.2), section=Rectangle(height=0.1, width=0.08),
                     material=rubber, elements=4, modes=4, damping_ratio=0.05, velocity=(1, 2, 3),
                     angular_velocity=(5, -15, 10))
    scene.modal_body("arm", start=(1, 1, 0), end=(1.5, 1, 0), section=Rectangle(height=0.1, width=0.08), elements=4,
                     material=rubber, modes=3, boundary="attached", velocity=(-1, 0, 1), angular_velocity=(1, 2, -2))
    return scene


def modal_in_the_plane() -> Scene:
    """Return a modal body beside planar parts."""
    scene = planar()
    scene.modal_body("arm", start=(1, 1, 0), end=(1.5, 1, 0), section=Rectangle(height=0.1, width=0.08), elements=4,
                     element="beam12p", material=Material(youngs_modulus=2e5, poisson_ratio=0.3, density=1100), modes=3,
                     velocity=(-1, 0, 0), angular_velocity=(0, 0, 15))
    return scene


def jointed() -> Scene:
    """Return every kind of joint in a chain of rotating bodies, some driven, between the ground and a cable."""
    scene = Scene()
    scene.cable("wire", start=(0, 0, 0), end=(1.5, 0, 0), elements=3, section=Rectangle(height=0.05, width=0.04),
                material=Material(youngs_modulus=0.4e9, poisson_ratio=0.3, density=4200))
    scene.pin("wire", s=0.0)
    oblique = {"axis": (1, 0.2, 0.1)}
    kinds = [("weld", {}), ("spherical", {}), ("revolute", oblique), ("cylindrical", oblique | {"velocity": 2.0}),
             ("universal", {"axis": (0, 0, 1), "second_axis": (1, 1, 0)}), ("prismatic", oblique),
             ("revolute", oblique | {"angle": Harmonic(amplitude=0.5, frequency=2.0)}), ("distance", {}),
             ("prismatic", oblique | {"distance": Ramp(start=0, end=1)})]
    at, last = np.array([0.7, 0, 0]), ("wire", 0.7)
    for k, (kind, given) in enumerate(kinds):
        gap = np.array([0, 0, 0.3]) if kind == "distance" else 0
        scene.rigid_body(f"A{k}", mass=1.3, inertia=(0.02, 0.03, 0.04), position=at + gap + (0.1, -0.2, 0.1),
                         velocity=(0.1, 0.2, -0.3), angular_velocity=(3, -2, 4))
        scene.joint(kind, last, (f"A{k}", (-0.1, 0.2, -0.1)), **given)
        at, last = at + gap + (0.2, 0.1, 0.3), (f"A{k}", (0.1, 0.3, 0.2))
    return scene


def jointed_plane() -> Scene:
    """Return the planar form; the bodies hang from the end and the middle of a cable."""
    scene = planar()
    scene.rigid_body("B", mass=1.0, inertia=(0.02, 0.03, 0.04), position=(1.5, -0.2, 0), angular_velocity=(0, 0, 5))
    scene.rigid_body("C", mass=1.0, inertia=(0.02, 0.03, 0.04), position=(0.9, -0.3, 0), angular_velocity=(0, 0, -5))
    scene.joint("weld", ("wire", 1.5), ("B", (0, 0.2, 0)))
    scene.joint("revolute", ("wire", 0.8), ("C", (-0.1, 0.3, 0)), angle=Harmonic(amplitude=0.5, frequency=2.0))
    scene.joint("prismatic", ("C", (0.2, 0, 0)), ("A", (0.1, 0.1, 0)), axis=(-0.75, 0.3, 0))
    scene.joint("distance", ("C", (0.2, 0.1, 0)), ("B", (0.1, 0, 0)))
    return scene


def tied() -> Scene:
    """Return riders tied to the tangent, with and without roll, and to the section, one driven; cables that ride by end
    and middle.
    """
    scene = Scene()
    made = {"section": Rectangle(height=0.05, width=0.05),
            "material": Material(youngs_modulus=0.4e9, poisson_ratio=0.3, density=4200)}
    for name, element, z in (("beam", "beam24", 0.0), ("rope", "cable12", 1.0)):
        scene.cable(name, start=(0, 0, z), end=(1.5, 0, z), elements=3, element=element, **made)
        scene.pin(name, s=0.0)
    for k, (along, frame, given) in enumerate([
            ("beam", "section", {}), ("beam", "tangent", {"velocity": 2.0}), ("rope", "tangent", {}),
            ("rope", "tangent", {"roll": "fixed"}), ("rope", "point", {"velocity": 2.0})]):
        s = 0.25 + 0.17 * k
        scene.rigid_body(f"A{k}", mass=1.3, inertia=(0.02, 0.03, 0.04), position=(s, -0.1, (along == "rope") + 0.05),
                         velocity=(0.1, 0.2, -0.3), angular_velocity=(3, -2, 4))
        scene.slide(f"A{k}", along=along, s=s, at=(0, 0.1, -0.05), frame=frame, **given)
    for name, along, x, s in (("link", "beam", 1.1, 0.0), ("tail", "rope", 1.2, 0.3)):
        z = float(along == "rope")
        scene.cable(name, start=(x, s, z), end=(x, s - 1, z), elements=2, up=(1, 0, 0), **made,
                    element="beam24" if along == "beam" else "cable12")
        scene.slide((name, s), along=along, s=x)
    return scene


def resisted() -> Scene:
    """Return sliding friction and compressed buffers, of a body off its centre and of a riding cable."""
    scene = loaded()
    friction = Friction(coefficient=0.4, rolling=0.1, viscous=3.0, velocity=20.0)
    scene.rigid_body("B", mass=1.0, inertia=(0.02, 0.03, 0.04), position=(0.9, -0.1, 0.05), velocity=(1, 0.2, 0.1),
                     angular_velocity=(3, 5, -4))
    scene.slide("B", along="wire", s=0.9, at=(0, 0.1, -0.05), friction=friction,
                at_end=Buffer(length=1.0, stiffness=300.0, damping=20.0))
    scene.cable("tail", start=(1.2, 0, 0), end=(1.2, -0.5, 0.3), elements=2, element="cable12",
                section=Rectangle(height=0.05, width=0.05),
                material=Material(youngs_modulus=1e8, poisson_ratio=0.3, density=4200))
    scene.slide(("tail", 0.0), along="wire", s=1.2, friction=friction,
                at_start=Buffer(length=1.4, stiffness=500.0, damping=10.0))
    return scene


def modal_in_joints() -> Scene:
    """Return modal bodies in joints with the ground, a cable and each other, on a spring, under loads, and as riders.
    """
    scene = Scene()
    made = {"section": Rectangle(height=0.1, width=0.08), "elements": 4,
            "material": Material(youngs_modulus=2e5, poisson_ratio=0.3, density=1100)}
    scene.cable("wire", start=(0, 0, 0), end=(1.5, 0, 0), elements=3, section=Rectangle(height=0.05, width=0.04),
                material=Material(youngs_modulus=0.4e9, poisson_ratio=0.3, density=4200))
    scene.pin("wire", s=0.0)
    scene.modal_body("arm", start=(0, 1, 0), end=(0.5, 1.2, 0.1), modes=4, boundary="attached", **made)
    scene.modal_body("link", start=(0.5, 1.2, 0.1), end=(1, 1, 0), modes=5, angular_velocity=(2, -3, 4), **made)
    scene.joint("weld", (0, 1, 0), ("arm", 0.0))
    scene.joint("universal", ("arm", scene.bodies["arm"].mesh.length), ("link", 0.0), axis=(0, 0, 1),
                second_axis=(1, 1, 0))
    for name, x, frame in (("rider", 0.4, "point"), ("tied", 1.1, "tangent")):
        scene.modal_body(name, start=(x, 0, 0), end=(x, -0.4, 0.1), up=(1, 0, 0), modes=4, velocity=(1, 0, 0), **made)
        scene.slide((name, 0.0), along="wire", s=x, frame=frame)
    far = ("rider", 0.41231056256176607)
    scene.joint("prismatic", ("tied", (0, 0, 0)), far, axis=(-0.7, -0.2, 0.05))
    scene.spring(far, ("link", (0, 0.03, 0.02)), stiffness=300.0, damping=2.0)
    scene.force("link", at=(0, 0.03, 0.02), value=(3, -20, 5), scale=Harmonic(amplitude=1.0, frequency=3.0, offset=2.0))
    scene.force("arm", s=scene.bodies["arm"].mesh.length, value=(2, 4, -3), follower=True)
    scene.moment("tied", s=0.0, value=(0.5, -0.2, 0.3))
    return scene


def modal_in_planar_joints() -> Scene:
    """Return the planar form of `modal_in_joints`."""
    scene = planar()
    made = {"section": Rectangle(height=0.1, width=0.08), "elements": 4, "element": "beam12p",
            "material": Material(youngs_modulus=2e5, poisson_ratio=0.3, density=1100)}
    scene.modal_body("arm", start=(1, 1, 0), end=(1.5, 1, 0), modes=3, boundary="attached", **made)
    scene.modal_body("link", start=(1.5, 1, 0), end=(1.8, 1.4, 0), modes=3, angular_velocity=(0, 0, 4), **made)
    scene.modal_body("rider", start=(0.7, 0, 0), end=(0.7, -0.4, 0), modes=3, velocity=(1, 0, 0), **made)
    scene.slide(("rider", 0.0), along="wire", s=0.7, frame="tangent")
    scene.joint("weld", (1, 1, 0), ("arm", 0.0))
    scene.joint("revolute", ("arm", 0.5), ("link", 0.0))
    scene.spring(("rider", 0.4), ("link", 0.25), stiffness=300.0, damping=2.0)
    scene.force("link", s=0.5, value=(3, -20, 0))
    scene.force("arm", s=0.5, value=(2, 4, 0), follower=True)
    scene.moment("rider", s=0.2, value=(0, 0, 0.3))
    return scene


def reeved(*, held: str | None = None) -> Scene:
    """Return a damped rope over a sheave that turns, with friction, a held one with friction, and one without, between
    moving bodies.

    held: a body that holds the second sheave, then without friction, in the place of the ground.
    """
    scene = Scene(gravity=(0.5, -9.81, 0))
    scene.rigid_body("A", mass=4.4, inertia=(1, 1, 0.04), position=(-1.8, -1.2, 0), velocity=(0.1, 0.3, 0),
                     angular_velocity=(0, 0, 2))
    scene.rigid_body("B", mass=4.0, inertia=(1, 1, 0.05), position=(1.9, -1.0, 0), velocity=(0.3, -0.2, 0),
                     angular_velocity=(0, 0, -3))
    low: dict = {"at": (-0.5, -0.8, 0), "friction": Friction(coefficient=0.2, velocity=0.5), "zones": 2}
    if held is not None:
        scene.rigid_body(held, mass=3.0, inertia=(1, 1, 0.06), position=(-0.6, -0.9, 0), velocity=(0.1, 0.1, 0),
                         angular_velocity=(0, 0, 1))
        low = {"at": (held, (0.1, 0.1, 0))}
    scene.rope("hoist", route=[
        Anchor("A", at=(0.05, 0.1, 0)),
        Sheave("turning", at=(-1.5, 0, 0), radius=0.25, side="right", inertia=0.02, friction=0.3, zones=2),
        Sheave("low", radius=0.2, side="left", **low),
        Sheave("smooth", at=(0.9, 0.2, 0), radius=0.3, side="right"), Anchor("B", at=(0, 0.1, 0))],
        section=Circle(radius=1e-3), elements=(2, 1, 1, 2), tension=42.0,
        material=Material(youngs_modulus=6e8, poisson_ratio=0.3, density=28000, damping_time=1e-4))
    return scene


def gripped() -> Scene:
    """Return a rope over sheaves with a body that grips it, and one that a spring with a damper holds to it."""
    scene = reeved()
    rope = scene.ropes["hoist"]
    first, *_, last = scene.route_of(rope).arc_lengths(0.0)
    for name, (start, end), below in (("C", first, 0.0), ("D", last, 0.4)):
        s = start + 0.6 * (end - start)
        x, y, _ = rope.point(scene.holders, s)
        scene.rigid_body(name, mass=0.7, inertia=(1, 1, 0.03), position=(x - 0.1, y - 0.05 - below, 0),
                         velocity=(0.2, 0.1, 0), angular_velocity=(0, 0, 2))
        held = (("hoist", s), (name, (0.1, 0.05, 0)))
        if below:
            scene.spring(*held, stiffness=300.0, damping=4.0, length=0.3)
        else:
            scene.joint("spherical", *held)
    return scene


SCENES = {f.__name__: f for f in (reeved, gripped, rider, loaded, planar, frame, star, jointed, jointed_plane, tied,
                                 modal, modal_in_the_plane, modal_in_joints, modal_in_planar_joints, resisted)}
