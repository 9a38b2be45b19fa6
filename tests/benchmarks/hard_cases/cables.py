"""Cables alone: steel beside rubber, slack that becomes taut, buckling under compression, free fall, whips."""


import numpy as np
from funicular import Circle, Material, Ramp, Scene

from .case import BALANCE, HELD, SHAKEN, Subject, compared, positions

HERE = Subject()
STEEL = Material(youngs_modulus=210e9, poisson_ratio=0.3, density=7850)
RUBBER = Material(youngs_modulus=2e6, poisson_ratio=0.49, density=1100)
THIN = Circle(radius=0.5e-3)
CORD = Circle(radius=5e-3)
KIND = {"element": "cable12", "strain": "engineering"}


def steel_and_rubber() -> Scene:
    """A wire of 1 mm over 100 m, stretched by 0.1 %, with a rubber cord of 2 m hinged to its middle and released from
    the horizontal; 1 kg slides down the wire. EA/L differ by a factor of 20, bending stiffnesses by 2, wave speeds by
    120.
    """
    scene = Scene()
    wire = scene.cable("wire", start=(0, 0, 0), end=(100, -5, 0), rest_length=100.0, elements=20, section=THIN,
                       material=STEEL, **KIND)
    cord = scene.cable("cord", start=(50, -2.5, 0), end=(50, -2.5, 2), elements=6, section=CORD, material=RUBBER,
                       up=(1, 0, 0), **KIND)
    scene.pin(wire, s=0.0)
    scene.pin(wire, s=wire.length)
    scene.tie(cord, s=0.0, to=wire, at=wire.length / 2, rotation="free", name="hook")
    scene.rigid_body("A", mass=1.0, inertia=(1e-3,) * 3, position=wire.point(12.0), velocity=10 * wire.axes[0])
    scene.slide("A", along=wire, s=12.0)
    return scene


def slack() -> Scene:
    """1 m of steel rope over a span of 0.9 m, released as an arch above its supports: it falls through and snaps taut.
    """
    scene = Scene()
    scene.cable("rope", curve=lambda u: (0.9 * u, 0.19 * np.sin(np.pi * u), 0), rest="straight", elements=8,
                section=Circle(radius=2e-3), material=Material(youngs_modulus=2e8, poisson_ratio=0.3, density=7850,
                                                               damping_time=1e-4), **KIND)
    scene.pin("rope", s=0.0)
    scene.pin("rope", s=scene.cables["rope"].length)
    return scene


def buckling() -> Scene:
    """A strip compressed by 2 % of its length in 0.2 s, ten times Euler's load; a tenth of its weight selects the side.
    """
    scene = Scene(gravity=(0, -1, 0))
    scene.cable("strip", start=(0, 0, 0), end=(1, 0, 0), elements=8, section=Circle(radius=0.02),
                material=Material(youngs_modulus=1e8, poisson_ratio=0.3, density=1000), **KIND)
    scene.clamp("strip", s=0.0)
    scene.motion("strip", s=1.0, displacement=(Ramp(start=0.0, end=0.2, after=-0.02), 0, 0))
    return scene


def falling() -> Scene:
    """A free bent cord with a straight stress-free shape."""
    scene = Scene()
    scene.cable("cord", curve=lambda u: (np.cos(3 * u), np.sin(3 * u), 0.5 * u**2), rest="straight", elements=8,
                up=(0, 0, 1), section=CORD, material=RUBBER, **KIND)
    return scene


def whip() -> Scene:
    """A cord hangs as a narrow loop from two points at one height; one end is released (its tip outruns free fall,
    turns over and cracks).
    """
    scene = Scene()
    loop = [(0.0, 0.0, 0), (0.0, -0.3, 0), (0.01, -0.42, 0), (0.06, -0.47, 0), (0.11, -0.42, 0), (0.12, -0.3, 0),
            (0.12, 0.0, 0)]
    scene.cable("cord", points=loop, rest="straight", elements=12, section=CORD,
                material=Material(youngs_modulus=1e6, poisson_ratio=0.49, density=1100), **KIND)
    scene.pin("cord", s=0.0)
    return scene


SCENES = {"steel and rubber": (steel_and_rubber, 0.6), "slack goes taut": (slack, 0.5), "buckling": (buckling, 0.3),
          "free fall": (falling, 0.5), "whip": (whip, 0.5)}


@HERE.case("a steel wire of 100 m and a rubber cord", error=2e-4, balance=BALANCE, residual=HELD, gap=HELD)
def metal_and_rubber(integrator):
    return compared(*SCENES["steel and rubber"], integrator)[1]


@HERE.case("a slack cable goes taut", error=2e-3, balance=SHAKEN, pull=(20, 30))
def going_taut(integrator):
    """`pull`: the largest force at a pin over the weight."""
    run, found = compared(*SCENES["slack goes taut"], integrator)
    weight = 7850 * np.pi * 2e-3**2 * run.scene.cables["rope"].length * 9.81
    return found | {"pull": float(np.linalg.norm(run["rope@0.force"], axis=1).max()) / weight}


@HERE.case("compression that buckles", error=5e-4, balance=BALANCE, sideways=(0.05, 0.2))
def pushed(integrator):
    """`sideways`: m."""
    run, found = compared(*SCENES["buckling"], integrator)
    return found | {"sideways": float(-positions(run)[:, :, 1].min())}


@HERE.case("a bent cable falls free", error=1e-4, balance=BALANCE, fall=1e-12)
def free_fall(integrator):
    """`fall`: of the centre of mass beside g t²/2, m."""
    run, found = compared(*SCENES["free fall"], integrator)
    cord = run.scene.cables["cord"]
    r, r_x = (run["cord.nodal_vectors"][:, :, k] for k in (0, 1))
    centre = ((r[:, 1:] + r[:, :-1]) / 2 - np.diff(r_x, axis=1) * cord.length / cord.elements / 12).mean(axis=1)
    exact = centre[0] - [0, 1, 0] * (9.81 / 2 * run.time[:, None] ** 2)
    return found | {"fall": float(np.abs(centre - exact).max())}


@HERE.case("a cable that whips", error={"genalpha": 6e-4, "energy": 2e-4, "explicit": 4e-6, "radau": 3e-4},
           balance=SHAKEN, outruns=(2, 3), slow=["energy"])
def cracking(integrator):
    """`outruns`: speed of the tip over that of a free fall as deep."""
    run, found = compared(*SCENES["whip"], integrator)
    tip, speed = run["cord.nodal_vectors"][:, -1, 0], np.linalg.norm(run["cord.nodal_velocity"][:, -1, 0], axis=1)
    return found | {"outruns": float(speed.max() / np.sqrt(2 * 9.81 * np.ptp(tip[:, 1])))}
