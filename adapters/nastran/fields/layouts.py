"""Where a named value stands on a card: asked of the definitions of the cards."""

import difflib
import re

from ....core.errors import InputError
from ..cards import definitions
from ..deck.card_definition import Card
from ..deck.movable_values import Moves, Read, position_of

_EVERYWHERE = {"RO": "RHO", "DENSITY": "RHO"}
"""Other ways to write the names of any card."""

_NUMBERED = re.compile(r"(?P<name>\D+)(?P<number>[1-9]\d*)")


def movable() -> dict[str, Moves]:
    """Return what is known of the cards with values that may be parameters, by name."""
    return {name: card.moves for name, card in definitions().items() if card.moves}


def canonical_field(card: str, name: str) -> str:
    """Return a field's one name, from the way a user may write it.

    Parameters
    ----------
    card : str
        Card name in capitals, one of `movable`.
    name : str
        Field name as in the guide, in any case, or a common synonym; a name without a station
        is end A where the card has stations.

    Raises
    ------
    InputError
        The card has no such value; near spellings are offered.
    """
    definition = definitions().get(card)
    if definition is None or definition.moves is None:
        raise InputError(_unknown_card(card))
    written, name = name, name.upper()
    name = definition.moves.also.get(name, _EVERYWHERE.get(name, name))
    for form in (f"{name}(A)", name):
        if _knows(definition, form):
            return form
    if name in definition.others:
        raise InputError(f"{card} {written}: this field holds a number or an option, not a value")
    names = value_names(definition)
    near = difflib.get_close_matches(name, names, n=3, cutoff=0.5)
    hint = f"did you mean {' or '.join(near)}" if near else f"it has {_list_names(names)}"
    raise InputError(f"{card} has no value {written!r}: {hint}")


def field_position(card: str, name: str, read: Read) -> int | None:
    """Return the position of a value on one card, or None where this card does not hold it.

    Parameters
    ----------
    card, name : str
        In their canonical form.
    read : callable
        Gives the text of the card's fields, for values whose position depends on them.
    """
    definition = definitions()[card]
    if name in definition.reals:
        return position_of(definition.reals[name])
    if definition.repeated_reals:
        return _repeated(definition, name, read)
    variable = definition.moves.variable if definition.moves else None
    return variable.find(name, read) if variable else None


def _knows(card: Card, name: str) -> bool:
    variable = card.moves.variable if card.moves else None
    match = _NUMBERED.fullmatch(name)
    return (
        name in card.reals
        or (match is not None and match["name"] in card.repeated_reals)
        or (variable is not None and variable.knows(name))
    )


def value_names(card: Card) -> tuple[str, ...]:
    """Names of a card's values, one of each kind where there may be any number."""
    more = card.moves.variable.names if card.moves and card.moves.variable else ()
    return (*card.reals, *more, *(f"{n}{k}" for k in (1, 2, 3) for n in card.repeated_reals))


def _list_names(names: tuple[str, ...]) -> str:
    return ", ".join(names[:12]) + (", ..." if len(names) > 12 else "")


def _unknown_card(card: str) -> str:
    if card in definitions() and "MID" in definitions()[card].others:
        return f"{card} has no value to move: name the material, such as MAT1 1 E"
    near = difflib.get_close_matches(card, movable(), n=3, cutoff=0.6)
    hint = f"did you mean {' or '.join(near)}"
    if not near:
        hint = "cards with values to move are " + ", ".join(sorted(movable()))
    return f"no parameter can be taken from a card {card!r}: {hint}"


def _repeated(card: Card, name: str, read: Read) -> int | None:
    """Position of ``T2``, the second T of a repetition; None where that is not there."""
    match = _NUMBERED.fullmatch(name)
    if not match:
        return None
    stride = len(card.repeated)
    start = len(card.fields) + stride * (int(match["number"]) - 1)
    there = any(read(position_of(start + k)) for k in range(stride))
    return position_of(start + card.repeated_reals[match["name"]]) if there else None
