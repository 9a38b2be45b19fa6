"""A spatial scene with one of each kind that pictures draw."""

import funicular as fu


def spatial() -> fu.Scene:
    """Return a rope from a moving support to the head of a boom, with a car, a load on a hook and a guy spring."""
    scene = fu.Scene(gravity=(0, 0, -9.81))
    rope = scene.cable("rope", start=(0, 0, 0), end=(10, 4, 3), elements=8, element="cable12",
                       section=fu.Circle(radius=0.02),
                       material=fu.Material(youngs_modulus=1e9, poisson_ratio=0.3, density=2000))
    boom = scene.cable("boom", start=(10, 4, 0), end=(10, 4, 3), elements=4, element="beam24", law="structural",
                       section=fu.Tube(outer_radius=0.08, inner_radius=0.07), up=(1, 0, 0),
                       material=fu.Material(youngs_modulus=7e10, poisson_ratio=0.3, density=2700))
    scene.motion(rope, s=0, displacement=(fu.Ramp(start=0, end=1, after=0.4), 0, 0))
    scene.clamp(boom, s=0)
    scene.joint("spherical", ("rope", rope.length), ("boom", 3.0), name="head")
    scene.rigid_body("car", mass=5, inertia=(0.1, 0.2, 0.2), position=rope.point(4.0),
                     shape=fu.Box(size=(0.5, 0.3, 0.2)))
    scene.slide("car", along=rope, s=4.0, name="trolley")
    scene.rigid_body("load", mass=10, inertia=(0.3, 0.3, 0.3), position=rope.point(4.0) - (0, 0, 1.2),
                     shape=fu.Sphere(radius=0.3))
    scene.joint("spherical", "car", ("load", (0, 0, 1.2)), name="hook")
    scene.spring("load", (4, -3, -2), stiffness=60, damping=5, name="guy")
    scene.force("boom", s=3.0, value=(0, 300, 0), scale=fu.Harmonic(amplitude=1, frequency=1), name="wind")
    scene.distributed_force("rope", value=(0, 8, 0), name="side")
    return scene


STEEL = fu.Material(youngs_modulus=6e9, density=7000, poisson_ratio=0.3)


def hoist(held: bool = False) -> fu.Scene:
    """Return two weights on a rope over a sheave that turns; held: its ends at the ground instead, frictionless."""
    scene = fu.Scene(gravity=(0, -9.81, 0))
    ends = (-0.25, -2.5, 0), (1.9, -2.3348, 0)
    for name, mass, place in () if held else (("C", 4.4, ends[0]), ("L", 4.0, ends[1])):
        scene.rigid_body(name, mass=mass, inertia=(0.1, 0.1, 0.1), position=place)
    anchors = [fu.Anchor(at=place) for place in ends] if held else [fu.Anchor("C"), fu.Anchor("L")]
    turning = {} if held else {"inertia": 0.01, "friction": 0.2}
    top = fu.Sheave("top", at=(0, 0, 0), radius=0.25, side="right", **turning)
    scene.rope("rope", route=[anchors[0], top, anchors[1]], section=fu.Circle(radius=2e-3), material=STEEL, elements=3,
               tension=42.0)
    return scene


def tackle() -> fu.Scene:
    """Return a load in a block of two falls, and a counterweight, whose attachments are beside their mass centres."""
    scene = fu.Scene(gravity=(0, -9.81, 0))
    scene.rigid_body("hook", mass=40, inertia=(0.3, 0.3, 0.3), position=(0, -3.1, 0))
    scene.rigid_body("W", mass=20.5, inertia=(0.1, 0.1, 0.1), position=(0.6, -2, 0))
    scene.rope("line", route=[fu.Anchor(at=(-0.2, 0, 0)),
                              fu.Sheave("block", at=("hook", (0, 0.1, 0)), radius=0.2, side="left"),
                              fu.Sheave("top", at=(0.4, 0, 0), radius=0.2, side="right", inertia=0.02, friction=0.1),
                              fu.Anchor("W", (0, 0.15, 0))],
               section=fu.Circle(radius=2e-3), material=STEEL, elements=2, tension=200.0)
    return scene


def belt() -> fu.Scene:
    """Return a flat belt on two pulleys."""
    scene = fu.Scene(gravity=(0, 0, 0))
    pulley = {"radius": 0.1, "side": "left", "inertia": 0.25, "friction": fu.Friction(coefficient=0.5)}
    scene.rope("belt", closed=True, route=[fu.Sheave("driver", at=(0, 0, 0), **pulley),
                                           fu.Sheave("driven", at=(0.314159, 0, 0), **pulley)],
               section=fu.Rectangle(height=2e-3, width=0.05), elements=1, length=1.1938052,
               material=fu.Material(youngs_modulus=7.6e7, density=8724.21, poisson_ratio=0.3))
    return scene


def riser() -> fu.Scene:
    """Return a line of two bare pieces and a buoyant one from below the water to its surface, above a bed, with a load
    that walks along it and grows.
    """
    scene = fu.Scene(gravity=(0, -9.81, 0))
    bare, buoyant = (fu.Material(youngs_modulus=2e8, poisson_ratio=0.3, density=density) for density in (2000, 500))
    pieces = [fu.Piece(length=length, section=fu.Circle(radius=radius), material=material, elements=elements) for
              length, radius, material, elements in ((20, 0.1, bare, 14), (12, 0.3, buoyant, 10), (18, 0.1, bare, 12))]
    scene.cable("riser", start=(0, -20, 0), end=(38, 2, 0), element="cable12", shape="hanging", rest="straight",
                pieces=pieces)
    scene.pin("riser", s=0)
    scene.pin("riser", s=50)
    scene.fluid("sea", density=1000, surface=0.0)
    scene.drag("riser", normal=1.2)
    scene.surface("bed", fu.Plane(point=(0, -25, 0), normal=(0, 1, 0)))
    scene.contact("riser", "bed", stiffness=1e5, radius=0.1)
    scene.force("riser", s=fu.Ramp(start=0, end=1.0, before=20, after=40), value=(0, -2e3, 0), name="walk",
                scale=fu.Ramp(start=0, end=1.0))
    return scene


def sea() -> fu.Scene:
    """Return a line from a bed to the surface of a sea of three waves, two of them askew."""
    scene = fu.Scene(gravity=(0, -9.81, 0))
    scene.cable("line", start=(-8, -10, 0), end=(4, 0, 0), elements=6, element="cable12",
                section=fu.Circle(radius=0.1),
                material=fu.Material(youngs_modulus=1e8, poisson_ratio=0.3, density=1500))
    scene.pin("line", s=0)
    scene.pin("line", s=scene.cables["line"].length)
    scene.fluid("sea", density=1025, surface=0.5, depth=12.0, waves=[
        fu.Wave(amplitude=0.7, period=3.5, phase=0.3), fu.Wave(amplitude=0.3, period=2.5, direction=(1, 0, 1)),
        fu.Wave(amplitude=0.2, period=2.0, direction=(0, 0, 1))])
    scene.drag("line", normal=1.2)
    return scene
