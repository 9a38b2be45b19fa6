"""Generated kernels: C, a Python face in `kernels`, and manifest.json. Written by `funicular derive`."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any


def described(manifest: dict[str, Any], families: Iterable[str] | None = None) -> dict[str, dict[str, Any]]:
    """Return the kernels of a manifest by name: doc, source, family, inputs, outputs, operations.

    Each input and output has name, shape, unit and doc. families: those wanted, all by default. Raises KeyError for an
    argument or a family that the manifest lacks.
    """
    def argument(key: str) -> dict[str, Any]:
        name, _, shape = key.partition(" ")[0].rstrip("]").partition("[")
        sizes = [int(n) for n in shape.split("x")] if shape else []
        return {"name": name, "shape": sizes, **manifest["arguments"][key]}

    found = {}
    for family in manifest["kernels"] if families is None else families:
        for suffix, entry in manifest["kernels"][family].items():
            inputs, outputs = ([argument(key) for key in keys.split(", ") if key]
                               for keys in entry["arguments"].split(" -> "))
            found[f"{family}_{suffix}"] = {"source": manifest["families"][family]["source"], **entry, "family": family,
                                           "inputs": inputs, "outputs": outputs}
    return found
