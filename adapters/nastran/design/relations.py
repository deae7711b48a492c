"""How a parameter's values are related to design variables: which card, under which name."""

from ....core.errors import InputError
from ..cards import definitions
from ..deck.movable_values import position_of
from ..fields.parameter_references import FieldRef

RELATIONS = ("DVPREL1", "DVMREL1", "DVCREL1")
"""Of properties, materials, elements; MSC Nastran Quick Reference Guide, bulk data entries."""

_NAMES = {("PELAS", "K"): "K1", ("PELAS", "GE"): "GE1", ("PELAS", "S"): "S1"}
"""Where SOL 200 calls a value otherwise; those that it knows by their position only are numbers."""


def relation_of(ref: FieldRef) -> tuple[str, str | int]:
    """Return the card that relates a value to design variables, and the value's name on it.

    Raises
    ------
    InputError
        SOL 200 moves no such value.
    """
    known = definitions()[ref.card]
    name: str | int = _NAMES.get((ref.card, ref.field), ref.field)
    if "/" in ref.field:
        name = position_of(known.reals[ref.field])
    if ref.card.startswith("MAT"):
        return "DVMREL1", name
    if known.elements:
        return "DVCREL1", name
    if ref.card.startswith("P") and ref.card != "PARAM":
        return "DVPREL1", name
    raise InputError(f"{ref} is no design variable of SOL 200")


def value_named(card: str, number: int, name: str) -> FieldRef:
    """Return the value that a relation names, by its name or by its position on the card.

    Raises
    ------
    InputError
        trueup moves no such value.
    """
    back = {(c, theirs): ours for (c, ours), theirs in _NAMES.items()}
    if not name.isdigit():
        return FieldRef(card, number, back.get((card, name.upper()), name))
    reals = definitions()[card].reals if card in definitions() else {}
    found = [field for field, index in reals.items() if position_of(index) == int(name)]
    if not found:
        raise InputError(f"field {name} of {card} {number} is no value that moves")
    return FieldRef(card, number, found[0])
