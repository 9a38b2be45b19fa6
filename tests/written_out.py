"""The generated C with shared stages written out, so that a test can change one kernel alone."""

import re
import shutil
from pathlib import Path

from funicular.derive.catalogue import families
from funicular.derive.codegen import drift

STAGE = re.compile(r"^#define ([A-Z]\w*) \\\n((?:.* \\\n)*.*)\n", re.MULTILINE)
"""The macro of a stage: its name, and its lines, which end in a backslash but for the last."""


def stages(text: str) -> dict[str, str]:
    """Return the lines of the stages that a file defines, by name."""
    return {name: lines.replace(" \\\n", "\n") for name, lines in STAGE.findall(text)}


def written_out(text: str, known: dict[str, str]) -> str:
    """Return the text of a file with every stage, of its own or of a header, in its place."""
    known, text = known | stages(text), STAGE.sub("", text)
    while (inside := re.sub(r"^    ([A-Z]\w*)$", lambda found: known[found[1]], text, flags=re.MULTILINE)) != text:
        text = inside  # a stage may name a part of it
    return text


def copy_written_out(folder: Path) -> None:
    """Copy the generated C and its headers to a folder, each kernel with all of its stages."""
    shared: dict[str, str] = {}
    for file in drift.folder().glob("*.h"):
        shutil.copy(file, folder)
        if file.name.endswith("_stages.h"):
            shared |= stages(file.read_text(encoding="utf-8"))
    for name in families():
        text = (drift.folder() / f"{name}.c").read_text(encoding="utf-8")
        (folder / f"{name}.c").write_text(written_out(text, shared), encoding="utf-8")
