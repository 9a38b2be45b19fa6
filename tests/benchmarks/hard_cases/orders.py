"""Orders of convergence, in time and in mesh, measured.

In time an order is that between two steps. In mesh, cubic elements: 4 for a smooth motion (the error of positions of
Hermite cubics in bending, h^4 in L2 and at nodes); 3 with a rider, whose point force makes r_xxx discontinuous inside
an element: the error of the bending energy is of order h^1.5, and that of the position under the force its square, h^3
(Strang & Fix 1973, 1.6 and 3.4; the theoretical order is that of the mean over positions of the rider).
"""

from functools import cache

import numpy as np
from funicular import Circle, Material, Ramp, Scene

from .case import Subject, simulate
from .crossings import rider

HERE = Subject()
IN_TIME = {"genalpha": (1.25e-4, 6.25e-5), "energy": (1.25e-4, 6.25e-5), "explicit": (0.02 / 28, 5e-4),
           "radau": (5e-4, 2.5e-4)}
"""Two fixed steps of each method, small enough for the order to show and large enough for rounding not to."""


def quantities(run) -> dict[str, np.ndarray]:
    """Nodal vectors, their rates, multipliers."""
    return {"positions": run["wire.nodal_vectors"], "velocities": run["wire.nodal_velocity"],
            "multipliers": run["A_on_wire.multiplier"]}


@cache
def exact():
    return quantities(simulate(rider(0.25, 1.0, elements=3), 0.5, integrator="explicit", tol=1e-12, output_step=0.02))


@HERE.case("order in time", **{name: {"genalpha": (1.8, 2.3), "energy": (1.8, 2.3), "explicit": (7.5, 8.9),
                                      "radau": (4.7, 5.3)}
                               for name in ("positions", "velocities", "multipliers")})
def in_time(integrator):
    """Return orders of the quantities of an output; a node is crossed on the way."""
    errors = []
    for step in IN_TIME[integrator]:
        run = simulate(rider(0.25, 1.0, elements=3), 0.5, integrator=integrator, output_step=0.02, step=step)
        errors.append({name: np.abs(values - exact()[name]).max() for name, values in quantities(run).items()})
    coarse, fine = IN_TIME[integrator]
    return {name: float(np.log(errors[0][name] / errors[1][name]) / np.log(coarse / fine)) for name in errors[0]}


def loaded(elements: int, on_rider: bool) -> Scene:
    """Return a strip with a load that starts smoothly: distributed, or on a rider of 1 m/s."""
    scene = Scene(gravity=(0, 0, 0))
    scene.cable("wire", start=(0, 0, 0), end=(1, 0, 0), elements=elements, element="cable12", strain="engineering",
                section=Circle(radius=0.02), material=Material(youngs_modulus=1e7, poisson_ratio=0.3, density=1000))
    scene.pin("wire", s=0.0)
    scene.pin("wire", s=1.0)
    load = Ramp(start=0.0, end=0.1)
    if on_rider:
        scene.rigid_body("A", mass=0.5, inertia=(1e-3,) * 3, position=(0.2, 0, 0), velocity=(1, 0, 0))
        scene.slide("A", along="wire", s=0.2)
        scene.force("A", value=(0, -5, 0), scale=load)
    else:
        scene.distributed_force("wire", value=(0, -20, 0), scale=load)
    return scene


def in_mesh(on_rider: bool):
    def measure(_):
        """Return orders of the middle node, or the rider, root mean square over time, against a mesh twice as fine as
        the finest.
        """
        runs = [simulate(loaded(n, on_rider), 0.3, integrator="explicit", tol=1e-9, output_step=0.003)
                for n in (2, 4, 8, 16, 32)]
        paths = [run["A.position"] if on_rider else run["wire.nodal_vectors"][:, n // 2, 0]
                 for n, run in zip((2, 4, 8, 16, 32), runs, strict=True)]
        errors = np.array([np.sqrt(np.mean((path - paths[-1])**2)) for path in paths[:-1]])
        orders = np.log2(errors[:-1] / errors[1:])
        return {f"{n} elements": float(e) for n, e in zip((2, 4, 8, 16), errors, strict=True)} | {
            "order": float(orders[-1]), "order before": float(orders[-2])}

    return measure


HERE.case("order in mesh, smooth", integrators=["explicit"], slow=["explicit"], order=(3.7, 4.5))(in_mesh(False))
HERE.case("order in mesh, a rider", integrators=["explicit"], slow=["explicit"], order=(2.7, 4.5))(in_mesh(True))
