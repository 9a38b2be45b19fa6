"""Moving loads (M1, M2, M4, M5). The rider keeps its speed by itself: deflections are so small that no force acts along
the beam, and the rider is pushed transversely alone.
"""

import numpy as np
from funicular import Circle, Material, Scene
from scipy.integrate import solve_ivp

from .case import INTEGRATORS, Subject, simulate

HERE = Subject()
WITH_LINEAR = *INTEGRATORS, "linear"
L, RADIUS, E, DENSITY = 1.0, 1e-2, 1e9, 1000.0
AREA, EI = np.pi * RADIUS**2, E * np.pi / 4 * RADIUS**4
DEFLECTION_RATIO = 1e-6
"""Static deflection of the beam under the load, over its length."""


def crossing(alpha: float, mu: float, elements: int):
    """A load F on a rider of mu times the beam's mass, over a simply supported beam; alpha: v L/π sqrt(ρA/EI).

    Returns t v/L and the deflection at mid-span over F L³/48EI.
    """
    speed, force = alpha * np.pi / L * np.sqrt(EI / (DENSITY * AREA)), 48 * EI / L**2 * DEFLECTION_RATIO
    scene = Scene(gravity=(0, 0, 0))
    beam = scene.cable("beam", start=(0, 0, 0), end=(L, 0, 0), elements=elements, element="cable12", curvature="linear",
                       section=Circle(radius=RADIUS), material=Material(youngs_modulus=E, poisson_ratio=0.0,
                                                                        density=DENSITY))
    scene.pin(beam, s=0.0)
    scene.pin(beam, s=L)
    mass = mu * DENSITY * AREA * L
    scene.rigid_body("A", mass=mass, inertia=(1e-3 * mass,) * 3, position=(0, 0, 0), velocity=(speed, 0, 0))
    scene.slide("A", along=beam, s=0.0)
    scene.force("A", value=(0, -force, 0))
    return scene, L / speed


def measured(alpha: float, mu: float, at: str, exact: float):
    def measure(integrator):
        scene, duration = crossing(alpha, mu, 8)
        # tol is relative to the travel of the rider
        settings = {"tol": 1e-3 * DEFLECTION_RATIO} if integrator == "explicit" else {"step": duration / 2000}
        run = simulate(scene, 0.999 * duration, output_step=0.999 * duration / 1000, integrator=integrator, **settings)
        middle = -run["beam.nodal_vectors"][:, 4, 0, 1] / (DEFLECTION_RATIO * L)
        found = middle.max() if at == "largest" else float(np.interp(0.5 * duration, run.time, middle))
        return {"found": float(found), "published": exact, "error": float(abs(found - exact)),
                "speed lost": float(1 - run["A.velocity"][-1, 0] / run["A.velocity"][0, 0])}

    return measure


M1 = {"largest": {0.1: 1.0964535, 0.25: 1.2576098, 0.5: 1.7054452, 0.617: 1.7316740, 1.0: 1.5480737},
      "at mid crossing": {0.25: 1.0657920, 0.5: 1.3288778, 1.0: 0.5131123}}
M2 = {(0.25, 0.2): 1.31817, (0.5, 0.2): 1.82459, (0.5, 0.5): 2.02212}

for at, table in M1.items():
    for alpha, exact in table.items():
        HERE.case(f"M1, a force at α {alpha:g}, {at}", error=5e-4, integrators=WITH_LINEAR,
                  slow=["energy", "explicit", "radau"])(measured(alpha, 1e-4, at, exact))
for (alpha, mu), exact in M2.items():
    HERE.case(f"M2, a mass of {mu:g} at α {alpha:g}", error=1e-3, integrators=WITH_LINEAR,
              slow=["energy", "explicit", "radau"])(measured(alpha, mu, "largest", exact))


def arc(degrees: float, period: float):
    def measure(integrator):
        """M4: a bead on more than a quarter of a circle that is fixed at every node; the error of its radius of 1 m is
        of order h^4.
        """
        scene, elements, reach = Scene(), 24, 1.7
        turn = lambda u: (np.sin(reach * (2 * u - 1)), -np.cos(reach * (2 * u - 1)), 0)  # noqa: E731
        wire = scene.cable("arc", curve=turn, elements=elements, element="cable12", section=Circle(radius=RADIUS),
                           material=Material(youngs_modulus=E, poisson_ratio=0.0, density=DENSITY), rest="straight",
                           up=(0, 0, 1))
        for s in wire.node_s:
            scene.clamp(wire, s=s, fix="all")
        s = wire.length * (0.5 + np.radians(degrees) / (2 * reach))
        scene.rigid_body("A", mass=1.0, inertia=(1e-3,) * 3, position=wire.point(s))
        scene.slide("A", along=wire, s=s)
        run = simulate(scene, 0.75 * period, integrator=integrator, tol=1e-6)
        speed = np.linalg.norm(run["A.velocity"][-1])
        return {"off": float(run["A.position"][-1, 0] / speed / (0.75 * period)),
                "crossings": run.report["element_crossings"], "steps": run.report["steps"]}

    return measure


for degrees, period in ((60, 2.152874667), (90, 2.367841948)):
    HERE.case(f"M4, a bead on a fixed arc, from {degrees} degrees", off=(-1e-5, 1e-5),
              slow=["genalpha", "energy"])(arc(degrees, period))


def on_a_string(kappa: float, exact: float):
    """M5: a mass m at v on a taut string of nearly no mass, κ = T L / m v²; y over m g L/T near the far end, which it
    reaches at an angle, beside that of a massless string, which is `exact` at the end itself.
    """
    def rate(t, y):  # t = v t/L, y over m g L/T
        return y[1], kappa * (1 - y[0] / max(t * (1 - t), 1e-12))

    def measure(integrator):
        tension, mass, length, elements, reach = 1000.0, 1.0, 1.0, 40, 0.95
        speed, stretch, load = np.sqrt(tension * length / (kappa * mass)), 1e-3, 1e-3 * tension
        area = np.pi * 1e-6
        scene = Scene(gravity=(0, 0, 0))
        string = scene.cable("string", start=(0, 0, 0), end=(length, 0, 0), rest_length=length / (1 + stretch),
                             elements=elements, element="cable12", strain="engineering", section=Circle(radius=1e-3),
                             material=Material(youngs_modulus=tension / (stretch * area), poisson_ratio=0.0,
                                               density=1e-3 * mass / (area * length)))
        scene.pin(string, s=0.0)
        scene.pin(string, s=string.length)
        scene.rigid_body("A", mass=mass, inertia=(1e-3,) * 3, position=(0, 0, 0), velocity=(speed, 0, 0))
        scene.slide("A", along=string, s=0.0)
        scene.force("A", value=(0, -load, 0))
        run = simulate(scene, reach * length / speed, integrator=integrator, tol=1e-6)
        way = solve_ivp(rate, (1e-9, 1 - 1e-9), (0, 0), rtol=1e-10, atol=1e-12, dense_output=True).sol
        tau = run.time * speed / length
        y = -run["A.position"][:, 1] / (load * length / tension)
        # a cubic element has no kink under the rider: most of the error
        return {"error": float(np.abs(y - way(tau)[0])[tau > 0.05].max()), "at the end": float(way(1 - 1e-9)[0]),
                "published": exact, "largest": float(y.max())}

    return measure


for kappa, exact in ((4, 0.156189), (2, 0.333333), (10, -0.032075)):
    HERE.case(f"M5, a mass on a string, κ {kappa}", integrators=["genalpha", "linear"], slow=["genalpha"],
              error=0.05)(on_a_string(kappa, exact))
