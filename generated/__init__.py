"""Generated kernels: C, a Python face in `kernels`, and manifest.json. Written by `funicular derive`."""


def described(manifest: dict) -> dict[str, dict]:
    """The kernels of a manifest by name, with name, shape, unit and doc of their inputs and outputs.

    Raises KeyError for an argument that it does not have.
    """
    every = manifest["arguments"]
    return {name: entry | {of: [every[k] for k in entry[of]] for of in ("inputs", "outputs")}
            for name, entry in manifest["kernels"].items()}
