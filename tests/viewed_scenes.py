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
