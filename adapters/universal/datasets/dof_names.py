"""Response and reference of a function: by their numbers, or where they lack, by their names."""

import re
from itertools import pairwise

from ..text.number_fields import text

Dof = tuple[int, int]
"""Node and signed direction: 1, 2, 3 translations, 4, 5, 6 rotations, 0 not known."""

_COLUMNS = (0, 5, 15, 20, 30, 41, 51, 55, 66, 76, 80)
_NUMBERED = (0, 5, 6, 8, 9)  # type, response node and direction, reference node and direction
_DOF = re.compile(
    r"(?<![\w.])(\d+)\s*:?\s*([+-]?)(R?[XYZ])([+-]?)(?![A-Za-z0-9])"
    r"|(?<![\w.+-])(\d+):([+-]?[1-6])(?!\w)",
    re.IGNORECASE,
)


def dofs_of(line: bytes, ids: tuple[str, ...]) -> tuple[int, tuple[Dof, Dof], tuple[Dof, Dof]]:
    """Return function type, the dofs as numbered, and the dofs completed from the names.

    Parameters
    ----------
    line : bytes
        The sixth line of the header.
    ids : tuple of str
        The five text lines before it.

    Raises
    ------
    ValueError
        The line does not hold the numbers.
    """
    padded = line.ljust(80)
    parts = [padded[a:b].strip() for a, b in pairwise(_COLUMNS)]
    words = line.split()
    try:
        numbers = [int(parts[k] or 0) for k in _NUMBERED]
    except ValueError:
        numbers = []
    if not (numbers and (numbers[2] or numbers[4])) and len(words) == len(parts):
        parts = words  # written without regard to columns
        numbers = [int(parts[k]) for k in _NUMBERED]
    if not numbers:
        raise ValueError(text(line))
    numbered = (numbers[1], numbers[2]), (numbers[3], numbers[4])
    if numbered[0][1] and numbered[1][1]:
        return numbers[0], numbered, numbered
    return numbers[0], numbered, _by_name(numbered, (text(parts[4]), text(parts[7])), ids)


def _by_name(
    numbered: tuple[Dof, Dof], names: tuple[str, str], ids: tuple[str, ...]
) -> tuple[Dof, Dof]:
    """Fill in a direction that the numbers leave out from the names, where they tell it."""
    found = list(numbered)
    for side in (0, 1):
        by_entity = [_dof(m) for m in _DOF.finditer(names[side])]
        if not found[side][1] and len(by_entity) == 1:
            found[side] = by_entity[0]
    for line in ids:
        both = [_dof(m) for m in _DOF.finditer(line)]
        if len(both) == 2:
            found = [f if f[1] else b for f, b in zip(found, both, strict=True)]
            break
    return found[0], found[1]


def _dof(match: re.Match[str]) -> Dof:
    if match[5]:
        return int(match[5]), int(match[6])
    letters = match[3].upper()
    direction = "XYZ".index(letters[-1]) + (4 if letters[0] == "R" else 1)
    return int(match[1]), -direction if "-" in (match[2], match[4]) else direction
