"""`funicular sweep`: its options and its output."""

from __future__ import annotations

import sys
import time
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import FunicularError, SceneError
from ..scene.file import load_scene
from ..sweeps.cost import in_words
from ..sweeps.parameters import DRAWN, SWEEP, LogUniform, Uniform
from ..sweeps.sweep import sweep, sweep_cost

SPACINGS = ("lin", "log")


def parameter_of(text: str, method: str) -> tuple[str, Any]:
    """Return the name and the values of PATH=VALUES. Raises SceneError.

    VALUES: 1,2,3 or first:last:number, with :log for equal ratios; to draw samples low:high or low:high:log.
    """
    name, equals, said = text.partition("=")
    name, said = name.strip(), said.strip()
    if not equals or not name or not said:
        raise SceneError(f'--set "{text}"', "is not PATH=VALUES", "write such as A.mass=1,2,5 or A.mass=1:5:20")
    if ":" not in said:
        return name, [_value(each.strip()) for each in said.split(",")]
    words = [word.strip() for word in said.split(":")]
    spacing = words.pop() if words[-1] in SPACINGS else "lin"
    drawn = method in DRAWN
    numbers = [_value(word) for word in words]
    if len(words) != (2 if drawn else 3) or not all(isinstance(each, int | float) for each in numbers):
        form = "low:high" if drawn else "first:last:number"
        raise SceneError(f'--set "{text}"', f'must be {form} for the method "{method}"',
                         f"write such as {name}=1e8:1e9{'' if drawn else ':20'}, with :log behind it for equal ratios")
    try:
        return name, (LogUniform if spacing == "log" else Uniform)(*numbers) if drawn else _range(numbers, spacing)
    except SceneError as error:
        raise error.inside(f'--set "{text}"') from None


def _range(numbers: list[Any], spacing: str) -> list[Any]:
    """Return values at equal distances or ratios; whole numbers where all of them are."""
    first, last, count = numbers
    if not isinstance(count, int) or count < 1:
        raise SceneError(SWEEP, f"the number of values must be a whole number, 1 or more, got {count}")
    if spacing == "log":
        if min(first, last) <= 0:
            raise SceneError(SWEEP, "values of equal ratios must be positive")
        return [*np.geomspace(first, last, count).tolist()]
    values = np.linspace(first, last, count)
    whole = isinstance(first, int) and isinstance(last, int) and bool(np.all(values == np.round(values)))
    return [*(values.astype(int) if whole else values).tolist()]


def _value(word: str) -> Any:
    """Return a number, true or false, or the text itself."""
    if word in ("true", "false"):
        return word == "true"
    for kind in (int, float):
        try:
            return kind(word)
        except ValueError:
            continue
    return word


def parameters_of(texts: list[str], method: str) -> dict[str, Any]:
    """Return the parameters of --set options. Raises SceneError."""
    found: dict[str, Any] = {}
    for text in texts:
        name, values = parameter_of(text, method)
        if name in found:
            raise SceneError(SWEEP, f"--set {name} is given twice", "give all its values in one")
        found[name] = values
    return found


def run_sweep(scene: str, texts: list[str], output: Path, libraries: list[Path], estimate: bool,
              options: dict[str, Any], **of_work: Any) -> bool:
    """Run the command and print its result; return whether all points are in the file. Raises FunicularError.

    options: of `sweep_cost`; of_work: of `sweep` alone.
    """
    described = load_scene(scene, libraries)
    parameters = parameters_of(texts, options["method"])
    if estimate:
        print(sweep_cost(described, parameters, **options))
        return True
    begin = time.monotonic()
    dataset = sweep(described, parameters, **options, **of_work, save=output,
                    on_cost=lambda cost: print(cost, file=sys.stderr) if cost.points else None)
    message, status = dataset["message"], dataset["status"].values.ravel()
    failed = np.flatnonzero(status == "failed")
    print(f"{dataset.attrs['finished']} of {len(status)} points, {len(failed)} failed, in "
          f"{in_words(time.monotonic() - begin)}: {output}")
    if len(failed):
        why = str(message[np.unravel_index(failed[0], message.shape)].values)
        print(f"note: the first that failed, number {failed[0]}: {why}", file=sys.stderr)
    if len(failed) == len(status):
        raise FunicularError(f"{SWEEP}: all {len(failed)} points failed")
    return bool(dataset.attrs["finished"] == len(status))
