"""Planar kernels equal the spatial ones in a plane, whose other entries are zero."""

import inspect

import numpy as np
import pytest
from funicular.derive.catalogue import families
from funicular.derive.elements import ELEMENTS
from funicular.derive.verify.samples import SEEDS, states
from funicular.derive.verify.samples.element import element_state, loads
from funicular.generated import kernels

PAIRS = [("cable8p", "cable12"), ("beam12p", "beam24")]
RIDER = [0, 1, 5]  # translation in the plane and rotation about its normal, of the six velocities
PLANAR_ROUNDING = 2e-15  # of the samples' order, one: measured 6e-16


def call(name: str, state: dict) -> tuple:
    """Return the outputs of a kernel as a tuple."""
    kernel = getattr(kernels, name)
    out = kernel(*(state[argument] for argument in inspect.signature(kernel).parameters))
    return out if isinstance(out, tuple) else (out,)


def places(planar: str, spatial: str) -> np.ndarray:
    """Return the indices of the planar coordinates among the spatial ones."""
    names = ELEMENTS[spatial].names
    return np.array([3 * names.index(name) + axis for name in ELEMENTS[planar].names for axis in range(2)])


def lifted(flat: np.ndarray, at: np.ndarray, n: int) -> np.ndarray:
    """Return a planar vector among n spatial entries, zero elsewhere."""
    whole = np.zeros(n)
    whole[at] = np.ravel(flat)
    return whole


def spatial_element(planar: str, spatial: str, s: dict) -> dict:
    """Return the same element with a z axis: r_z, if present, is the unit normal of the plane."""
    element, at = ELEMENTS[spatial], places(planar, spatial)
    lift = {name: lifted(s[name], at, element.n_coordinates).reshape(-1, 3) for name in ("e", "v") if name in s}
    lift["e"][[name.startswith("r_z") for name in element.names], 2] = 1.0
    return s | lift


def spatial_body(s: dict) -> dict:
    half = np.arctan2(s["b"][3], s["b"][2]) / 2
    changes = {"b": [*s["b"][:2], 0, np.cos(half), 0, 0, np.sin(half)]}
    changes |= {name: lifted(s[name], RIDER, 6) for name in ("w", "a")} | {"m": lifted(s["m"], [2], 3)}
    return s | changes | {name: np.append(s[name], 0.0) for name in ("u", "f")}


def same(planar: np.ndarray, spatial: np.ndarray, *axes: list[int] | np.ndarray) -> None:
    """Compare at the places given for each axis; entries with one axis out of the plane must be zero, since the mirror
    image in the plane is the same state and changes their sign.
    """
    limit = PLANAR_ROUNDING * max(1.0, np.abs(planar).max())  # the samples are of order one
    np.testing.assert_allclose(spatial[np.ix_(*axes)], planar, rtol=0, atol=limit)
    outside = [np.isin(np.arange(n), at, invert=True) for n, at in zip(spatial.shape, axes, strict=True)]
    odd = np.logical_xor.reduce(np.meshgrid(*outside, indexing="ij"))
    np.testing.assert_allclose(spatial[odd], 0, atol=limit)


@pytest.mark.parametrize("number", range(3))
@pytest.mark.parametrize(("planar", "spatial"), PAIRS)
def test_slides(planar, spatial, number):
    names = [f"slide_{planar}_planar_rigid", f"slide_{spatial}_rigid"]
    s = states(families()[names[0]], None)[number] | {"mass": 1.0, "J": np.eye(3)}
    S = spatial_element(planar, spatial, spatial_body(s))
    _, tangent = call(f"{planar}_on_axis", s)
    tangent = tangent @ s["e"]
    S["director"] = np.array([-tangent[1], tangent[0], 0.0])
    at = places(planar, spatial)
    q = np.concatenate([at, ELEMENTS[spatial].n_coordinates + np.array(RIDER)])
    q_s = np.append(q, ELEMENTS[spatial].n_coordinates + 6)
    C = phi = [0, 1]
    axes = {
        "constraint": [[C], [C], [[0]], [C, C]],
        "terms": [[C], [C, q], [C], [q], [[0]], [C], [[0], q], [[0]], [[0]]],
        "residual": [[phi], [q_s]],
        "tangent": [[phi, q_s], [q_s, q_s]],
    }
    for kernel, places_of_outputs in axes.items():
        outputs = (call(f"{name}_{kernel}", state) for name, state in zip(names, (s, S), strict=True))
        for flat, whole, at_axes in zip(*outputs, places_of_outputs, strict=True):
            same(flat, whole, *at_axes)


@pytest.mark.parametrize("number", range(3))
def test_bodies(number):
    s = states(families()["planar_rigid"], None)[number]
    s["J"] = np.diag(np.diag(s["J"]))  # else the spatial body wants to leave the plane
    S, plane = spatial_body(s), [0, 1]
    axes = {
        "point": [[plane], [plane, RIDER], [plane], [plane]],
        "wrench": [[RIDER, RIDER], [plane, RIDER], [[2], RIDER]],
        "inertia_force": [[RIDER]],
        "inertia_tangent": [[RIDER, RIDER], [RIDER, RIDER]],
        "kinetic_energy": [[[0]]],
    }
    for kernel, places_of_outputs in axes.items():
        outputs = call(f"planar_rigid_{kernel}", s), call(f"rigid_{kernel}", S)
        for flat, whole, at_axes in zip(*outputs, places_of_outputs, strict=True):
            same(flat, whole, *at_axes)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("planar", "spatial"), PAIRS)
def test_loads(planar, spatial, seed):
    random = np.random.default_rng(seed)
    element, at = ELEMENTS[planar], places(planar, spatial)
    s = element_state(element, random)
    s |= loads(element, random)
    S = spatial_element(planar, spatial, s) | {"M": [0.0, 0.0, *s["M"]]}
    if ELEMENTS[spatial].director:
        S["c"] = [*s["c"], 0.0]
    else:
        s["c"][1] = 0  # along the tangent is all that a spatial cable knows
        S["c"] = s["c"][:1]
    for kernel in ("follower_force", "moment"):
        (f, K), (F, whole) = call(f"{planar}_{kernel}", s), call(f"{spatial}_{kernel}", S)
        same(f.ravel(), F.ravel(), at)
        same(K, whole, at, at)
