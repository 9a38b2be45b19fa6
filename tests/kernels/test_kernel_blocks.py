"""Kernels of several elements at once equal those of one element."""

import json
import platform

import numpy as np
import pytest
from funicular import Material, Rectangle, Scene
from funicular.derive.codegen import drift
from funicular.engine import Engine
from funicular.integrators import GeneralisedAlpha
from funicular.model.build import build
from shared_scenes import cable_scene, section_of

ELEMENTS = 7  # a block and a rest
SAME_BITS = platform.machine() in ("x86_64", "AMD64")  # no contraction to fused operations there
CABLE = [{"strain": strain, "curvature": curvature, "membrane": membrane} for strain in ("green", "engineering")
         for curvature in ("exact", "linear") for membrane in ("full", "assumed")]
BEAM = [{"law": "continuum"}, {"law": "structural"}]
NONLINEAR = [{"membrane": "tension_only"}, {"membrane": "tabulated"}]
STRAIGHT = {"cable12": CABLE + NONLINEAR, "cable8p": CABLE + NONLINEAR,
            "cable18": [kind for kind in CABLE if kind["curvature"] == "exact"],
            "beam24": BEAM, "beam12p": BEAM}
CURVED = {"cable12": [{"strain": "green"}, {"strain": "engineering"}], "beam24": [{"law": "continuum"}],
          "beam12p": [{"law": "continuum"}]}
CASES = [(element, law, curved) for table, curved in ((STRAIGHT, False), (CURVED, True))
         for element, laws in table.items() for law in laws]


def arc(u):
    return np.array([np.sin(u), 1.0 - np.cos(u), 0.0])


def scene(element: str, law: dict, curved: bool, uneven: bool = False) -> Scene:
    shape = {"curve": arc} if curved else {}
    up = {"up": (0, 0, 1)} if element == "beam24" and curved else {}
    section = section_of(law.get("membrane", ""), Rectangle(height=0.02, width=0.02))
    made = cable_scene(pins=(0.0,), elements=ELEMENTS, element=element, section=section,
                       material=Material(youngs_modulus=1e7, poisson_ratio=0.3, density=1000, damping_time=1e-2),
                       **shape, **up, **law)
    cable = made.cables["wire"]
    return made.replace(cable, nodes=cable.length * (cable.node_s / cable.length) ** 1.5) if uneven else made


@pytest.mark.parametrize("uneven", [False, True])
@pytest.mark.parametrize(("element", "law", "curved"), CASES)
def test_blocks_give_what_single_elements_give(element, law, curved, uneven):
    model = build(scene(element, law, curved, uneven))
    rng = np.random.default_rng(5)
    model.v[:] = 0.1 * rng.standard_normal(model.n_dof)
    found = []
    for blocks in (True, False):
        engine = Engine(model, blocks=blocks)
        engine.start(duration=1.0, output_step=0.1, tol=1e-4, step=0.0, method=GeneralisedAlpha(0.8), first_step=1e-3)
        assert engine.in_blocks[0] in (blocks, False)
        found.append(engine.linearise(1e-3, 1e-3 * np.random.default_rng(6).standard_normal(engine.unknowns)))
    for several, single in zip(*found, strict=True):
        if SAME_BITS:
            np.testing.assert_array_equal(several, single)
        else:
            np.testing.assert_allclose(several, single, rtol=1e-12, atol=1e-12 * np.abs(single).max())


def test_every_law_is_covered():
    families = json.loads((drift.folder() / "manifest.json").read_text(encoding="utf-8"))["families"]
    touched = {f"{c.element}_{c.law}" for case in CASES for c in build(scene(*case)).cables}
    assert touched == {name for name in families if name.partition("_")[0] in STRAIGHT and "_" in name}
