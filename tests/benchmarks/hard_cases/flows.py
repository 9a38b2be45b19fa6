"""Wind and water: light lines in a storm, a sudden gust, a fall that drag stops at once, inertia dominated by water."""


from funicular import Circle, Harmonic, Material, Scene, TableSignal

from .case import Subject, compared, figures, simulate

HERE = Subject()
LINE = {"element": "cable12", "strain": "engineering"}


def storm() -> Scene:
    """10 m of a nylon line of 2 mm and 3.6 g/m between two points, released from the horizontal in a wind of 40 m/s:
    drag is 40 times its weight and overdamps the motion, until the line snaps taut.
    """
    scene = Scene()
    line = scene.cable("line", start=(0, 0, 0), end=(10, 0, 0), rest_length=10.2, elements=10,
                       section=Circle(radius=1e-3),
                       material=Material(youngs_modulus=2e9, poisson_ratio=0.0, density=1140), **LINE)
    scene.pin(line, s=0.0)
    scene.pin(line, s=line.length)
    scene.fluid("wind", density=1.25, velocity=(3, 0, 40))
    scene.drag(line, normal=1.2, tangential=0.02)
    return scene


def gust() -> Scene:
    """A heavier line at rest in still air, on which a wind of 30 m/s starts within a microsecond, and ends."""
    scene = Scene()
    line = scene.cable("line", start=(0, 0, 0), end=(0, -5, 0), elements=6, section=Circle(radius=5e-3),
                       material=Material(youngs_modulus=1e9, poisson_ratio=0.0, density=1500), **LINE)
    scene.pin(line, s=0.0)
    scene.fluid("wind", density=1.25, velocity=(0, 0, 30), scale=TableSignal(
        time=[0, 0.1, 0.100001, 0.3, 0.300001, 1], value=[0, 0, 1, 1, 0, 0], interpolation="linear"))
    scene.drag(line, normal=1.2)
    return scene


def parachute() -> Scene:
    """A body that falls from rest and reaches its terminal speed, 1 mm/s, after a ten-thousandth of a second."""
    scene = Scene()
    scene.rigid_body("A", mass=1.0, inertia=(1e-3,) * 3, position=(0, 0, 0))
    scene.fluid("syrup", density=1000)
    scene.drag("A", area=19620.0)
    return scene


def feather() -> Scene:
    """A line of a hundredth of the density of water, in oscillating water, which has nearly all the inertia."""
    scene = Scene(gravity=(0, 0, 0))
    line = scene.cable("line", start=(0, 0, 0), end=(1, 0.2, 0), elements=6, section=Circle(radius=0.01),
                       material=Material(youngs_modulus=1e6, poisson_ratio=0.0, density=10), **LINE)
    scene.pin(line, s=0.0)
    scene.fluid("sea", density=1000, velocity=(0, 1, 0.5), scale=Harmonic(amplitude=0.2, frequency=2.0))
    scene.drag(line, normal=1.0, added_mass=1.0)
    return scene


@HERE.case("light line in a storm", balance=1e-3, slow=("genalpha", "energy"),
           error={"genalpha": 0.03, "energy": 0.02, "explicit": 1e-4, "radau": 1e-3})
def light_line(integrator):
    return compared(storm, 0.5, integrator, output_step=0.05)[1]


@HERE.case("gust that comes at once", error=1e-3, balance=1e-3)
def sudden_gust(integrator):
    return compared(gust, 0.5, integrator, output_step=0.05)[1]


@HERE.case("drag that stops a fall at once", speed=(0.00099999, 0.00100001), balance=1e-3)
def stopped(integrator):
    run = simulate(parachute(), 1.0, integrator=integrator, output_step=0.1)
    return figures(run) | {"speed": float(-run["A.velocity"][-1, 1])}


@HERE.case("nearly all inertia is the water's", error=1e-3, balance=1e-3, slow=["genalpha", "energy", "explicit"])
def light_in_water(integrator):
    return compared(feather, 0.5, integrator, output_step=0.05)[1]
