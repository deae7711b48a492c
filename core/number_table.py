"""Tuned numbers in sight: each with unit, meaning and source, in one frozen table a room.

A table is a frozen dataclass whose fields are made by `number`, and its one instance, in a module
``*_numbers`` of the room or, of one kind of effect alone, in its file. What may stand as a literal
elsewhere: counts of directions and degrees of freedom, and the constants of formulas.
"""

from dataclasses import field
from typing import TypeVar

T = TypeVar("T")
ROUNDING = "double precision"
SURVEYS = "pytest tests/core/identification"
SENSITIVITY = "python -m benchmarks.discovery.sensitivity {}"


def number(value: T, unit: str, meaning: str, source: str = SENSITIVITY) -> T:
    """Return a field of a table: a number or a tuple of numbers.

    Parameters
    ----------
    value : float, int or tuple
    unit, meaning : str
        The unit may be what a share is of.
    source : str
        Publication, physical reason, or the command that calibrates it, ``{}`` for its name.
    """
    said = {"unit": unit, "meaning": meaning, "source": source}
    return field(default=value, metadata=said)
