"""Records of measurements of benchmarks and tests: files of JSON, one per script, with a table by name.

    {"TABLE": {"measured": "2026-11-24", "conditions": "...", "rows": [{...}, ...]}, ...}

A row stands on one line, so that a difference of two records shows the figures that changed. Numbers keep four digits.
"""

from __future__ import annotations

import json
import math
import os
import platform
import re
import sys
from datetime import date
from functools import cache
from importlib import metadata
from pathlib import Path
from typing import Any

FOLDER = Path(__file__).with_name("measured")


@cache
def load(file: Path) -> dict[str, dict[str, Any]]:
    """Return the tables of a record, none for a missing file."""
    return json.loads(file.read_text(encoding="utf-8")) if file.exists() else {}


def save(file: Path, tables: dict[str, dict[str, Any]]) -> None:
    """Write the tables of a record, one row on each line."""
    parts = []
    for name, table in tables.items():
        head = "".join(f"  {json.dumps(key)}: {json.dumps(value, ensure_ascii=False)},\n"
                       for key, value in table.items() if key != "rows")
        rows = ",\n".join(f"   {json.dumps(row, ensure_ascii=False)}" for row in table["rows"])
        parts.append(f' {json.dumps(name)}: {{\n{head}  "rows": [\n{rows}\n  ]\n }}')
    file.write_text("{\n" + ",\n".join(parts) + "\n}\n", encoding="utf-8")
    load.cache_clear()


def record(file: Path, table: str, rows: list[dict[str, Any]], add: bool = False) -> None:
    """Put the rows of a table into a record, replacing its rows or, with ``add``, after them."""
    tables = dict(load(file))
    before = tables[table]["rows"] if add else []
    tables[table] = {"measured": date.today().isoformat(), "conditions": conditions(),
                     "rows": before + [{key: plain(value) for key, value in row.items()} for row in rows]}
    save(file, tables)


def plain(value: Any) -> Any:
    """Return a value in JSON: numbers with four digits, null for NaN."""
    if isinstance(value, bool | str) or value is None:
        return value
    if hasattr(value, "item"):
        return plain(value.item())
    if isinstance(value, float):
        return float(f"{value:.4g}") if math.isfinite(value) else None
    return value if isinstance(value, int) else str(value)


def conditions() -> str:
    """Return machine, load and versions, and the options of the running script."""
    given = " ".join(sys.argv[1:])
    given = re.sub(r" ?--(json|out|plots?|cache)( [^-]\S*)?", "", given).strip()
    load_of = f", load {os.getloadavg()[0]:.1f}" if hasattr(os, "getloadavg") else ""
    found = (f"{processor()}, {os.cpu_count()} cores{load_of}; Python {platform.python_version()}, funicular "
             f"{metadata.version('funicular')}")
    return found + (f"; {given}" if given and Path(sys.argv[0]).parent.name == "benchmarks" else "")


def processor() -> str:
    """Return the name of the processor, if the system has it."""
    info = Path("/proc/cpuinfo")
    names = [line.partition(":")[2].strip() for line in info.read_text(encoding="utf-8").splitlines()
             if line.startswith("model name")] if info.exists() else []
    return names[0] if names else platform.processor() or platform.machine()
