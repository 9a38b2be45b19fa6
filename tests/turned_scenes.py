"""Rotated scenes, and differences between the results of two runs of one motion."""

import numpy as np
from funicular.base.rotations import rotate, turned_by
from funicular.parts.in_plane import into_plane
from funicular.parts.plane import Plane

UPRIGHT = ((np.pi / 2, 0, 0), (0, 0, 0))
"""Rotation vector in rad and shift in m: from y up to z up."""
ASKEW = ((0.3, -0.7, 1.1), (1, 2, -3))

GAUGED = (".multiplier",)
"""Results that depend on the choice of axes across a cable."""


def turned_scene(scene, rotation, shift):
    """Return a scene moved as a rigid body: rotated by a vector in rad, then shifted in m."""
    axes = rotate(turned_by(np.array(rotation)), np.eye(3))  # rows: the new ground's axes, seen from the old one
    axes = np.where(np.abs(axes) < 1e-15, 0.0, axes)
    made = into_plane(scene, Plane(axes, -axes @ shift))
    made.plane_axes = made.drawn = None
    made.run_settings = dict(scene.run_settings)
    return made


def differences(planar, spatial, scenes=None):
    """Return by name the largest difference of results, relative to 1 or the largest size of each.

    scenes: those of both runs, if they have no text. Nodal vectors are those of both; orientations may differ in sign.
    """
    found, scenes = {}, scenes or (planar.scene, spatial.scene)
    for name in spatial:
        if name.endswith(GAUGED):
            continue
        one, other = np.asarray(planar[name]), np.asarray(spatial[name])
        if "nodal_v" in name:
            one, other = _of_both([scene.cables[name.partition(".")[0]] for scene in scenes], one, other)
        if name.endswith(".orientation"):
            one = one * np.sign(np.sum(one * other, axis=-1, keepdims=True))
        assert one.shape == other.shape, name
        found[name] = np.abs(one - other).max(initial=0.0) / max(1.0, np.abs(other).max(initial=0.0))
    return found


def _of_both(cables, one, other):
    """Return the nodal vectors that both cables have."""
    vectors = [list(cable.kind_of_element.nodal_vectors) for cable in cables]
    same_height = np.allclose(cables[0].axes_at(0.0)[1], cables[1].axes_at(0.0)[1])
    both = [each for each in vectors[0] if each in ("r", "r_x") or same_height]
    return tuple(values[..., [own.index(each) for each in both], :]
                 for values, own in zip((one, other), vectors, strict=True))
