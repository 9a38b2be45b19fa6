"""Spec files of a user's element: variants of the planar cable."""

from pathlib import Path

SPEC = '''
from funicular.derive.spec import Element, x, y, z

MINE = Element(
    name="mine8p",
    dim=2,
    basis=(1, x, x**2, x**3),
    nodal_vectors=("r", "r_x"),
    director="",
    laws=("green_linear",),
    doc="planar cable",
    source="a test",
)
'''
LAW = '''
import sympy as sp
from funicular.derive.laws.cable.cable import Cable


class Own(Cable):
    """A cable with the green strain and the linear curvature, but for what stands below."""

    name, stiffness_of = "own", "green_linear"

    def __init__(self, gram):
        super().__init__(gram, "green", "linear")
'''


def spec(path: Path, *changes: tuple[str, str], law: str = "") -> Path:
    """Return a spec file: a variant of the planar cable with its own law."""
    text = SPEC
    if law:
        text = LAW + law + text.replace('("green_linear",)', "(Own,)")
    for old, new in changes:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    file = path / "mine.py"
    file.write_text(text, encoding="utf-8")
    return file
