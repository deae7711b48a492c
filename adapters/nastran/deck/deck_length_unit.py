"""The deck's length unit, where the deck says it."""

import re
from collections.abc import Iterable, Iterator

from .bulk import Bulk
from .logical_lines import Line

_NAMES = {
    "m": "m", "meter": "m", "meters": "m", "metre": "m", "metres": "m",
    "mm": "mm", "millimeter": "mm", "millimeters": "mm", "millimetre": "mm", "millimetres": "mm",
    "in": "in", "inch": "in", "inches": "in", "ft": "ft", "foot": "ft", "feet": "ft",
}  # fmt: skip
_COMMENT = re.compile(r"\b(?:units?|length(?:\s+units?)?)\s*[:=]\s*(?P<rest>.*)$", re.IGNORECASE)


def find_length_unit(lines: Iterable[Line], bulk: Bulk) -> tuple[str | None, tuple[str, ...]]:
    """Return the length unit that comments, PARAM UNITSYS or DTI UNITS declare, and warnings.

    Comments such as ``$ units: mm, t, N, s`` or ``$* ... LENGTH : mm`` count. Where two
    statements disagree none is taken and a warning says so.
    """
    found: dict[str, str] = {}
    for line in lines:
        if "$" not in line.text:
            continue
        match = _COMMENT.search(line.text)
        unit = _first_unit(match["rest"]) if match else None
        if unit:
            found.setdefault(unit, f"the comment on line {line.number}")
    for where, text in _declared(bulk):
        unit = _first_unit(text)
        if unit:
            found.setdefault(unit, where)
    if len(found) > 1:
        said = "; ".join(f"{where} says {unit}" for unit, where in found.items())
        return None, (f"the deck's length unit is not clear: {said}",)
    return next(iter(found), None), ()


def _declared(bulk: Bulk) -> Iterator[tuple[str, str]]:
    """Where bulk data declares units, and the text that names the length unit."""
    for card in bulk.listed("PARAM"):
        if card.n == "UNITSYS":
            yield "PARAM UNITSYS", "-".join(str(card.v1).split("-")[1:])
    for card in bulk.listed("DTI"):
        if card.name == "UNITS":
            yield "DTI UNITS", str(card.length)


def _first_unit(text: str) -> str | None:
    words = re.split(r"[\s,;/()\[\]-]+", text.strip().lower())
    return next((_NAMES[word] for word in words if word in _NAMES), None)
