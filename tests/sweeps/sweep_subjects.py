"""Scenes and functions that the tests of sweeps compute, importable by worker processes."""

import os
import signal
import time
from pathlib import Path

import funicular as fu
import xarray

ALONE = {"workers": 0, "progress": False}
SHORT = {"duration": 0.02, "output_step": 0.005, "tol": 1e-3}
E_MODULUS, FRICTION = "wire.material.youngs_modulus", "trolley.friction.coefficient"
GRID = {E_MODULUS: [3e8, 4e8, 5e8], FRICTION: [0.0, 0.2]}
KEPT = ["A.position", "trolley.force.y", "wire.position"]


def same(one: xarray.Dataset, other: xarray.Dataset) -> bool:
    """Return whether two sweeps have equal results; times of points may differ."""
    return one.drop_vars("seconds").identical(other.drop_vars("seconds"))


def scene() -> fu.Scene:
    """Return the first scene on one element; a point takes some ms."""
    found = fu.load_scene("paper51").replace("wire", elements=2)
    found.run_settings = dict(SHORT)
    return found


def by_hand(youngs_modulus: float, friction: float) -> fu.Run:
    """Return one point of GRID without a sweep."""
    base = scene()
    material = fu.Material(youngs_modulus=youngs_modulus, shear_modulus=0.2e9, density=4200.0)
    base = base.replace("wire", material=material).replace("trolley", friction=fu.Friction(coefficient=friction))
    return base.run(**SHORT)


def square(x: float, y: float) -> dict:
    """Return numbers and an array; fail where x is 2."""
    if x == 2:
        raise ZeroDivisionError("x is two")
    return {"product": x * y, "both": [x, y]}


def counted(x: int, folder: str) -> dict:
    """Append a line to a file for each computation of the point."""
    with open(Path(folder) / "computed", "a") as file:
        file.write(f"{x}\n")
    time.sleep(0.01)
    return {"twice": 2.0 * x}


def deadly(x: int, folder: str) -> dict:
    """Kill the process at x = 5, only once unless the folder has a file "always"."""
    once, always = Path(folder) / "died", Path(folder) / "always"
    if x == 5 and (always.exists() or not once.exists()):
        once.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return {"twice": 2.0 * x}
