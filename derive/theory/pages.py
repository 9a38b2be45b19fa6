"""Pages of elements: properties, cost, convergence, and formulas with each law."""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path
from typing import Any

from ..catalogue import families
from ..codegen.family import Family
from ..spec import Element
from .document import DERIVE, Composer, Document
from .provenance import operations

CASES = Path(__file__).with_name("cases.json")
COUNTERPART = {"beam12p": "beam24", "cable8p": "cable12"}
"""The spatial element that has the same kinematics in the plane, and so the same figures where a case is planar."""
PLANAR_CASES = ("elastica, P L²/EI up to 10", "the same with stretch", "rolled up by an end moment",
                "stout cantilever, ν 0.3, large load", "elastic catenary")


@cache
def cases() -> dict[str, Any]:
    """Return the published cases with the figures of each element, as data."""
    return dict(json.loads(CASES.read_text(encoding="utf-8")))


def columns(element: str) -> list[int]:
    """Return the columns of the cases that are about an element, or about its spatial counterpart."""
    name = COUNTERPART.get(element, element)
    return [k for k, column in enumerate(cases()["columns"], 1)
            if name in column or (name == "beam24" and k > 2)]


def figures(element: str) -> list[list[str]]:
    """Return the table of figures of an element: head and rows."""
    of = columns(element)
    rows = [[row[0], *(row[k] or "not run" for k in of)] for row in cases()["published"]
            if element not in COUNTERPART or row[0] in PLANAR_CASES]
    return [["case", *(cases()["columns"][k - 1] for k in of)], *rows]


def laws(element: Element) -> list[Family]:
    """Return the families of an element's laws."""
    return [f for f in families().values() if f.role == "law" and f.element is element]


def element_page(name: str) -> Document:
    """Return the page of an element."""
    family = families()[name]
    element = family.element
    assert element is not None
    composer = Composer(name, f"{element.doc[0].upper()}{element.doc[1:]}. Source: {element.source}.")
    composer.add(f"elements/{name}", {"element": name})
    composer.add_text(_convergence(name), {})
    composer.add_text(_cost(element), {})
    composer.add("elements/elements", {"element": name})
    done: set[str] = set()
    for law in laws(element):
        assert law.traits is not None
        if (law.traits.kind not in done and not law.traits.takes_shape) or law.traits.kind == "structural":
            done.add(law.traits.kind)
            composer.add(f"laws/{law.traits.kind}/{law.traits.kind}", {"law": law.name})
    return composer.document


def _convergence(name: str) -> str:
    head, *rows = figures(name)
    table = "\n".join("| " + " | ".join(row) + " |" for row in (head, ["---"] * len(head), *rows))
    other = (f"The figures are those of `{COUNTERPART[name]}`. In the plane both have the same kinematics and the same "
             "results, to rounding.\n" if name in COUNTERPART else "")
    return ("# Convergence\n\nError against the published or converged value, with the number of elements in "
            f"brackets, then the order in the mesh.\n{other}\n{table}\n\nOrigin: "
            f"`{cases()['origin']}`, which names references and tests.\n")


def _cost(element: Element) -> str:
    rows = []
    for law in laws(element):
        own = f"{law.name}"
        rows.append(f"| `{law.law}` | {operations(own, 'energy')} | {operations(own, 'elastic_force')} | "
                    f"{operations(own, 'elastic_tangent')} |")
    return ("# Laws and cost\n\nArithmetic operations of one call, counted in the programs of the kernels.\n\n"
            "| law | energy | force | tangent |\n|---|---|---|---|\n" + "\n".join(rows) + "\n")


__all__ = ["DERIVE", "cases", "columns", "element_page", "figures", "laws"]
