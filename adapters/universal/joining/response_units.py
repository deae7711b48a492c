"""What the responses of a survey are, and what turns them into one quantity and unit."""

import re
from collections import Counter
from collections.abc import Sequence
from functools import lru_cache

from ....core.data.length_units import METRES
from ..datasets.functions import Head58

MOTION = {8: "displacement", 11: "velocity", 12: "acceleration"}
DERIVATIVE = {"displacement": 0, "velocity": 1, "acceleration": 2}
_MOTION_UNITS = {
    **{unit: ("displacement", size) for unit, size in (*METRES.items(), ("um", 1e-6))},
    **{f"{unit}/s": ("velocity", size) for unit, size in METRES.items()},
    **{f"{unit}/s^2": ("acceleration", size) for unit, size in METRES.items()},
    **dict.fromkeys(("g", "gn"), ("acceleration", 9.80665)),
}
_FORCE_UNITS = {"n": 1.0, "kn": 1e3, "lbf": 4.4482216152605, "lb": 4.4482216152605}
_PER_FORCE = re.compile(r"/\s*\(?(kN|N|lbf?)\)?\s*$")


def quantity_of(head: Head58) -> str | None:
    """Return what the response is, by its type or else its unit; None where neither tells."""
    by_unit = _motion(head.ordinate.unit)
    return MOTION.get(head.ordinate.quantity) or (by_unit[0] if by_unit else None)


def highest_quantity(heads: Sequence[Head58]) -> str | None:
    """Return the quantity that all responses can be multiplied up to; None: nobody says."""
    known = {q for q in map(quantity_of, heads) if q is not None}
    return max(known, key=DERIVATIVE.__getitem__, default=None)


def factors(
    heads: Sequence[Head58], length_unit: str | None, where: str, warnings: list[str]
) -> list[float]:
    """Return what brings each response to the test's length unit (else metres) per newton.

    Responses are scaled by the unit they are labelled with, because that is what their numbers
    are in; without a label they are taken in the unit of the test.
    """
    scale = 1.0 / METRES[length_unit] if length_unit else 1.0
    found: list[float] = []
    changed: Counter[tuple[str, float]] = Counter()
    unknown = 0
    for head in heads:
        motion = _MOTION_UNITS.get(_plain(_PER_FORCE.sub("", head.ordinate.unit)))
        per = _PER_FORCE.search(head.ordinate.unit)
        force = _FORCE_UNITS.get(_plain(head.denominator.unit))
        if force is None:
            force = _FORCE_UNITS[per[1].lower()] if per else 1.0
        if motion is None or motion[0] != (quantity_of(head) or motion[0]):
            unknown += 1
            found.append(1.0)
            continue
        found.append(motion[1] * scale / force)
        if abs(found[-1] - 1.0) > 1e-9:
            changed[f"{head.ordinate.unit} per {head.denominator.unit}", found[-1]] += 1
    if changed and unknown:
        warnings.append(
            f"{where}: {unknown} of {len(heads)} responses do not say their unit and are taken in "
            "the unit of the test"
        )
    for (unit, factor), count in changed.items():
        warnings.append(
            f"{where}: {count} response(s) in {unit} were multiplied by {factor:.6g} to be in "
            f"{length_unit or 'm'} and N"
        )
    return found


@lru_cache(maxsize=64)
def _motion(unit: str) -> tuple[str, float] | None:
    """Quantity and size in metres of a unit such as ``mm/s^2`` or ``g/N``."""
    return _MOTION_UNITS.get(_plain(_PER_FORCE.sub("", unit)))


def _plain(unit: str) -> str:
    """Return a unit in one spelling: ``m/s^2`` for m/s2, m/s**2, m/s/s, (m/s^2)."""
    word = unit.strip("()[] ").lower().replace(" ", "").replace("²", "^2").replace("**", "^")
    word = word.replace("/s/s", "/s^2").replace("sec", "s").replace("µ", "u")
    return re.sub(r"s2$", "s^2", word)
