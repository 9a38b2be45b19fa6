"""A mock of the engine's recording of the bundled scene paper51, with the same shapes."""

from types import SimpleNamespace

import numpy as np
from funicular.results.quantities import Variable, labelled
from funicular.scene.scene import Scene


class FakeRecording(SimpleNamespace):
    """A `funicular.results.recording.Recording` of given arrays."""

    scene = None

    def variables(self, alone=None):
        """Return the labelled results; all of them, also of one part."""
        return labelled(self)

    @property
    def rows(self):
        """Return the rows of an engine that the code around a recording reads."""
        return {"time": self.time}

    @property
    def coords(self):
        """Return the labelled coordinates."""
        found = {"time": Variable(("time",), self.time, "s", "time"),
                 "xyz": Variable(("xyz",), np.array(["x", "y", "z"]), "1", "axis")}
        for name, cable in self.cables.items():
            node, vector = f"{name}.node", f"{name}.vector"
            found[node] = Variable((node,), cable["node_s"], "m", "undeformed arc-length of the node")
            found[vector] = Variable((vector,), np.array(cable["vector_names"]), "1", "nodal vector")
        return found


def fake_recording(scene: Scene, status: str = "completed", message: str = "", duration: float = 1.0, times: int = 101):
    """The wire swings as a half sine of 3 cm while the body rides along it at 1 m/s."""
    wire = scene.cables["wire"]
    time = np.linspace(0, duration, times)
    s = 0.25 + time
    depth, k = 0.03 * np.sin(2 * np.pi * time), np.pi / wire.length
    node_s = wire.node_s

    vectors = np.zeros((times, len(node_s), 4, 3))
    vectors[..., 0, 0] = node_s
    vectors[..., 0, 1] = -depth[:, None] * np.sin(k * node_s)
    vectors[..., 1, 0] = 1
    vectors[..., 1, 1] = -depth[:, None] * k * np.cos(k * node_s)
    vectors[..., 2, 1] = vectors[..., 3, 2] = 1

    position = np.stack([s, -depth * np.sin(k * s), np.zeros(times)], axis=1)
    velocity = np.gradient(position, time, axis=0)
    acceleration = np.gradient(velocity, time, axis=0)
    zeros = np.zeros((times, 3))
    potential = 9.81 * position[:, 1]
    elastic = 20 * depth**2 / 0.03
    dissipated = 0.01 * time
    balance_error = 1e-6 * np.sin(40 * time)
    return FakeRecording(
        status=status,
        message=message,
        time=time,
        cables={
            "wire": {
                "nodal_vectors": vectors,
                "nodal_velocity": np.gradient(vectors, time, axis=0),
                "node_s": node_s,
                "vector_names": ("r", "r_x", "r_y", "r_z"),
            }
        },
        modal={},
        parts={
            "bodies": {
                "A": {
                    "position": position,
                    "orientation": np.tile([1.0, 0, 0, 0], (times, 1)),
                    "velocity": velocity,
                    "angular_velocity": zeros,
                    "acceleration": acceleration,
                    "angular_acceleration": zeros,
                }
            },
            "slides": {
                "trolley": {
                    "s": s,
                    "s_rate": np.ones(times),
                    "s_acceleration": np.zeros(times),
                    "force": acceleration - np.array(scene.gravity),
                    "multiplier": acceleration[:, 1:],
                    "residual": np.full(times, 3e-13),
                }
            },
            "pins": {"wire@0": {"force": zeros + 5.0}, "wire@1.5": {"force": zeros + 4.0}},
        },
        energy={
            "kinetic": 1 - potential - elastic - dissipated + balance_error,
            "elastic": elastic,
            "potential": potential,
            "dissipated": dissipated,
        },
        report={
            "time_s": {"set_up": 0.01, "total": 0.03, "solve": 0.015},
            "steps": 1000,
            "rejected_steps": 2,
            "newton_iterations": 2100,
            "factorisations": np.int64(310),
            "error_estimates": [1e-6, 2e-6],
            "kernels": ["beam24_force"],
            "messages": ["the start was made consistent"],
        },
    )
