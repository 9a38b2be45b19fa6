"""Catenaries of railways with one-sided contact: a collector that chatters, droppers that are all slack."""

import numpy as np
from funicular import Pulse, Scene, catenary

from .case import Subject, balance, simulate

HERE = Subject()
IMPLICIT = "genalpha", "radau"


def span() -> Scene:
    """Return one span with three droppers."""
    return catenary.scene(catenary.Line(
        spans=1, span=30.0, height=1.2, support=500e3,
        contact=catenary.Wire(mass=1.35, tension=22e3, axial_stiffness=15e6, bending_stiffness=179),
        messenger=catenary.Wire(mass=1.08, tension=16e3, axial_stiffness=11.64e6, bending_stiffness=111),
        droppers=catenary.Droppers(at=[5.0, 15.0, 25.0], stiffness=100e3)), (1.25, 2.5))


@HERE.case("a light collector chatters on a stiff wire", integrators=IMPLICIT, slow=["radau"],
           losses=(5, 1000), balance=1e-5, penetration=5e-3, pull=0.0, impulse=2e-3)
def chatter(integrator):
    """A collector of 0.5 kg under 40 N, which starts 2 mm below the wire with 20 times the usual stiffness, at 60 m/s.
    """
    scene = span()
    light = catenary.Pantograph(masses=[0.5], stiffness=[50], damping=[1], uplift=40, contact_stiffness=1e6)
    catenary.add_pantograph(scene, light, 2.0, 60.0)
    scene = scene.replace("pantograph_1", position=(2.0, scene.bodies["pantograph_1"].position[1] - 2e-3, 0.0))
    rest = span().equilibrium()
    start = {f"{name}.nodal_vectors": rest[f"{name}.nodal_vectors"] for name in scene.cables}
    run = simulate(scene, 0.3, initial=start, integrator=integrator, tol=1e-7, absolute_tol=1e-5,
                   quantities=["contact.position.y", "pantograph_1.position.y"], output_step=1e-4)
    force = run["pantograph_contact.normal_force"]
    moved = 0.5 * np.diff(run["pantograph_1.velocity"][[0, -1], 1])[0]
    height = run["pantograph_1.position"][:, 1]
    spring = np.trapezoid(50 * (height - run["pantograph_base.position"][:, 1] - 0.5), run.time)
    damper = 1 * (height[-1] - height[0])
    given = 40 * run.time[-1] - spring - damper - moved
    return {"losses": len(catenary.losses(run)), "balance": balance(run), "steps": run.report["steps"],
            "penetration": float(run["pantograph_contact.penetration"].max()), "pull": float(-force.min()),
            "impulse": float(abs(np.trapezoid(force, run.time) / given - 1))}


SETTINGS = {"genalpha": {"tol": 1e-4, "spectral_radius": 0.5}, "energy": {"step": 2e-4}, "radau": {"tol": 1e-4}}


@HERE.case("all droppers slack at once", integrators=tuple(SETTINGS), slow=["energy"],
           **{"slack at once": (3, 3), "taut again": (700, 850), "push": 0.0,
              "balance": {"genalpha": 2e-5, "energy": 1e-11, "radau": 1e-4}})
def lifted(integrator):
    """The contact wire is lifted by 1.5 times its weight for 0.4 s, and falls into its droppers."""
    scene = span()
    push = Pulse(start=0.05, end=0.45, rise=0.05)
    scene.distributed_force("contact", value=(0, 1.5 * 1.35 * 9.81, 0), scale=push)
    run = simulate(scene, 1.5, initial="equilibrium", integrator=integrator, output_step=2e-3,
                   **SETTINGS[integrator])
    pulls = np.stack([run[f"dropper_1_{k}.tension"] for k in (1, 2, 3)])
    after = run.time > 0.45
    return {"slack at once": int((pulls == 0).sum(axis=0).max()),
            "taut again": float(pulls[:, after].max(axis=1).min()), "push": float(-pulls.min()),
            "balance": balance(run), "steps": run.report["steps"]}
