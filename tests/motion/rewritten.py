"""Scenes in other units, by the units in the schema of scene files."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping
from functools import cache
from typing import Any

import funicular as fu
from funicular.parts.scene_text import as_toml
from funicular.scene.schema import scene_schema

Powers = tuple[float, float, float]
"""Of length, mass and time."""
NUMBER = (0.0, 0.0, 0.0)
BASE: dict[str, Powers] = {"m": (1, 0, 0), "kg": (0, 1, 0), "s": (0, 0, 1), "N": (1, 1, -2), "Pa": (-1, 1, -2),
                           "Hz": (0, 0, -1), "K": NUMBER, "rad": NUMBER, "1": NUMBER}
RAISED = {"²": 2, "³": 3, "⁴": 4}
SAID = re.compile(r"\bin ([^ ,.]+(?: [^ ,.]+)?)$")
"""A unit at the end of a description in the schema."""
DRIVES = {("motion", "displacement"): "m", ("joint", "distance"): "m", ("slide", "drive"): "m",
          ("slide", "velocity"): "m/s", ("force", "s"): "m", ("cable", "rest_length"): "m",
          ("spring", "length"): "m", ("spring", "stiffness"): "N/m", ("rope", "velocity"): "rad/s",
          ("rope", "torque"): "N m"}
"""Units of signals, also of items of a part, which the schema does not know."""
PER_LENGTH = "contact", "crossing"
"""Parts whose stiffness has a unit of its exponent, and of what touches."""


def powers_of(unit: str) -> Powers:
    """Return the powers in a unit such as "kg m²/s"."""
    found = [0.0, 0.0, 0.0]
    for sign, part in zip((1, -1), unit.split("/"), strict=False):
        for word in part.split():
            base, power = (word[:-1], RAISED[word[-1]]) if word[-1] in RAISED else (word, 1)
            found = [old + sign * power * new for old, new in zip(found, BASE[base], strict=True)]
    return found[0], found[1], found[2]


def in_units(scene: fu.Scene, length: float, mass: float, time: float) -> fu.Scene:
    """Return the scene in other units, given by their number per metre, kilogram and second."""
    per = length, mass, time
    tables = tomllib.loads(scene.to_toml())
    made = {}
    for kind, value in tables.items():
        rule = _schema()["properties"][kind]
        if kind == "gravity":
            made[kind] = _converted(value, rule, NUMBER, per)
        else:
            made[kind] = [_of_part(kind, table, rule["items"]["properties"], per, scene) for table in value]
    return fu.Scene.from_toml("\n".join(_lines(made)))


@cache
def _schema() -> dict[str, Any]:
    return scene_schema()


def _lines(tables: Mapping[str, Any]) -> list[str]:
    lines = [f"gravity = {as_toml(tables['gravity'])}"]
    for kind, parts in tables.items():
        if kind != "gravity":
            for part in parts:
                lines += [f"[[{kind}]]", *(f"{name} = {as_toml(value)}" for name, value in part.items())]
    return lines


def _of_part(kind: str, table: Mapping[str, Any], rules: Mapping[str, Any], per: Powers,
             scene: fu.Scene) -> dict[str, Any]:
    """Return the table of a part in other units."""
    units = {name: powers_of(unit) for (of, name), unit in DRIVES.items() if of == kind}
    if kind == "joint":
        units["velocity"] = powers_of("m/s" if table["kind"] in ("prismatic", "distance") else "rad/s")
    made = {name: _converted(value, rules[name], units.get(name, NUMBER), per, units) for name, value in table.items()}
    if kind in PER_LENGTH:
        along = 1.0 if kind == "contact" and table["a"] in scene.cables else 0.0
        for name, exponent in (("stiffness", table["exponent"]), ("tangential_stiffness", 1.0)):
            if name in table:
                made[name] = table[name] * _factor((1.0 - exponent - along, 1.0, -2.0), per)
    return made


def _factor(powers: Powers, per: Powers) -> float:
    return per[0] ** powers[0] * per[1] ** powers[1] * per[2] ** powers[2]


def _converted(value: Any, rule: Any, powers: Powers, per: Powers, units: Mapping[str, Powers] | None = None) -> Any:
    """Return a value of a scene file in other units; rule: its schema; powers: its unit, if the schema has none; units:
    those of its entries by name.
    """
    units = units or {}
    rule = _ruling(value, rule)
    if isinstance(value, dict):
        return {name: _converted(each, rule["properties"][name], units.get(name, powers), per, units)
                for name, each in value.items()}
    said = SAID.search(rule.get("description", ""))
    powers = powers_of(said[1]) if said else powers
    if isinstance(value, list):
        return [_converted(each, rule.get("items", {}), powers, per, units) for each in value]
    if isinstance(value, float) and powers != NUMBER:
        return value * _factor(powers, per)
    return value


def _ruling(value: Any, rule: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return the schema of a value after references and alternatives."""
    if isinstance(value, dict) and not rule.keys() & {"$ref", "anyOf", "oneOf", "properties"}:
        return _ruling(value, {"$ref": "#/$defs/signal"})  # within lists, of which the schema says no more
    if "$ref" in rule:
        return _ruling(value, _schema()["$defs"][rule["$ref"].removeprefix("#/$defs/")])
    for each in rule.get("anyOf", rule.get("oneOf", ())):
        if _fits(value, found := _ruling(value, each)):
            return {"description": rule.get("description", "")} | found
    return rule


def _fits(value: Any, rule: Mapping[str, Any]) -> bool:
    """Return whether a value is of the kind of a schema, for tables by their entry of the kind."""
    if isinstance(value, dict):
        rules = rule.get("properties", {})
        return value.keys() <= rules.keys() and all(rules[name].get("const", each) == each
                                                    for name, each in value.items())
    return rule.get("type") == {float: "number", int: "number", list: "array", str: "string"}[type(value)]
