"""What of a card may be a parameter: its reals, by the names that its layout gives them."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

Read = Callable[[int], str]
"""Text of the field at a position of one card, stripped and in capitals; "" where blank.

A position is the field number printed above the card in the guide, counted on over the
continuations: 1 is the name, 2 to 9 the data of the first line, 12 to 19 of the second, 22 to 29
of the third, whatever format the lines are written in.
"""


@dataclass(frozen=True)
class Doubt:
    """Values that an analyst doubts first.

    Parameters
    ----------
    fields : tuple of str
        Each by itself, those that are not blank.
    spread : float
        Of ln of the factor.
    lower, upper : float
        Bounds of the factor.
    binding : str
        Field that, where it is not blank, moves together with all of `fields`: a product of
        inertia has limits that follow theirs, a shear modulus that is written is no other than one
        that is left to follow.
    """

    fields: tuple[str, ...]
    spread: float
    lower: float
    upper: float
    binding: str = ""


@dataclass(frozen=True, eq=False)
class Variable:
    """Values whose position depends on what the card holds.

    Parameters
    ----------
    names : tuple of str
        To be offered: one of each kind where there may be any number.
    knows : callable
        Whether a name in capitals is one of them.
    find : callable
        Position of a name on a card; None where this card does not hold it.
    """

    names: tuple[str, ...]
    knows: Callable[[str], bool]
    find: Callable[[str, Read], int | None]


@dataclass(frozen=True, eq=False)
class Moves:
    """What is known of the values of a card beside their names.

    Parameters
    ----------
    also : mapping of str to str
        Other ways to write a name, in capitals.
    linear : tuple of str
        Values in which stiffness and mass are exactly linear.
    concentrated : tuple of str
        Values of a concentrated mass or spring, which a discovery may find wrong by itself.
    doubt : Doubt or None
        What an analyst doubts first.
    variable : Variable or None
        Values that stand where the card's own content says.
    """

    also: Mapping[str, str] = field(default_factory=dict)
    linear: tuple[str, ...] = ()
    concentrated: tuple[str, ...] = ()
    doubt: Doubt | None = None
    variable: Variable | None = None


def position_of(index: int) -> int:
    """Return the position of data field `index`, 0 being the first after the card's name."""
    return 10 * (index // 8) + index % 8 + 2


def after(position: int, steps: int) -> int:
    """Return the position `steps` data fields after another, over the line ends.

    >>> after(8, 3)
    13
    """
    return position_of(index_of(position) + steps)


def index_of(position: int) -> int:
    """Return the data field, from 0 after the card's name, at a position."""
    line, column = divmod(position, 10)
    return 8 * line + column - 2
