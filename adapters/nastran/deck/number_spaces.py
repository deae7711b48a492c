"""What the numbers of cards count: elements, properties, grids, ..., asked of their definitions."""

from collections.abc import Mapping

from .card_definition import Card

SPACES = {
    "EID": "element",
    "PID": "property",
    "MID": "material",
    "ID": "grid",
    "CID": "coordinate",
    "SID": "set",
}
"""By the name that the guide gives to the first field."""


def space_of(name: str, definitions: Mapping[str, Card]) -> str:
    """Return a value of `SPACES`, another word for other numbers, "" where that is not known."""
    card = definitions.get(name)
    if card is None or not card.layout:
        return ""
    if card.elements:
        return "element"
    if any(name in other.properties.split() for other in definitions.values()):
        return "property"
    first = (*card.fields, *card.repeated)[0].name
    return SPACES.get(first, first)
